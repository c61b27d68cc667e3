#pragma once
// Part II, chapters 2 and 3: curvature measures and tensors of surfaces by the normal cycle.
//
// Conventions (docs/conventions.md): normals point outwards; a sphere with outward normals has positive curvatures; the
// mean measure integrates k1 + k2, not its half; the swapped tensor (H~ in the thesis) carries k_max along dir_min.
// Everything here scales bit for bit with powers of two: there is no absolute tolerance anywhere.
#include <certa/error.h>
#include <certa/mesh.h>
#include <certa/run_control.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace certa {

/// A symmetric bilinear form on space; plain layout: an array of these is an n x 6 array of doubles.
struct SymmetricTensor3 {
    double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
    double trace() const { return xx + yy + zz; }  ///< the sum of the eigenvalues
    friend bool operator==(const SymmetricTensor3&, const SymmetricTensor3&) = default;
};

/// The measures of one set B.
///
/// Definition: area(B); gaussian = sum of angle defects of the vertices in B; mean = sum of length(e in B) times the
///             signed dihedral angle (positive: convex), that is, the integral of k1 + k2; swapped_tensor = the same
///             sum with the projection onto e (H~: eigenvector of k1 has the eigenvalue of k2 times the area); tensor
///             (H-bar) with the projections onto the bisectors of the normals. Both traces equal `mean`.
///             The mass of the normal cycle above B is area + edge_mass + vertex_mass, with edge_mass = sum of length
///             times |angle|, and vertex_mass = sum of areas of spherical triangles (normal of p, n_i, n_i+1), which
///             is the mass where they do not fold over and an upper bound elsewhere.
/// Source:     thesis, definitions 5 and 7, Lemma 31.
struct CurvatureMeasures {
    double area = 0.0;
    double gaussian = 0.0;
    double mean = 0.0;
    SymmetricTensor3 tensor;
    SymmetricTensor3 swapped_tensor;
    double edge_mass = 0.0;
    double vertex_mass = 0.0;
};

/// Which part of the mesh's surface counts around each vertex.
enum class Neighborhood : std::uint8_t {
    rings,           ///< `rings` rings of triangles, with `rim`
    ball,            ///< exact intersection with the closed ball of radius `radius`
    automatic_ball,  ///< a ball whose radius is chosen per vertex from the data
    geodesic,        ///< points whose distance along the surface is at most `radius` (fast marching, see Errors)
};
/// What of the border of a ring region belongs to it. With R rings:
enum class Rim : std::uint8_t {
    dual,    ///< barycentric dual cells of all vertices within R steps
    half,    ///< all triangles of the R-ring, border edges at half weight, border vertices by their share of angle
    closed,  ///< border edges and vertices count in full
    open,    ///< they do not count: the relative interior, as in Theorem 13
};
/// The function that takes the place of the indicator of a ball, t being distance / radius, or of dual cells within
/// `rings` steps (kernel2 only), t being steps / (rings + 1).
enum class Weight : std::uint8_t {
    indicator,  ///< 1
    kernel2,    ///< (1 - t^2)^2, of order 2
    kernel4,    ///< (1 - t^2)^2 (1 - 2.5 t^2), of order 4 on interior points; kernel2 where its total is not safe
};
/// How curvatures are computed from the region around a vertex.
enum class Estimator : std::uint8_t {
    normal_cycle,  ///< the thesis's
    corrected,     ///< corrected normal current (Lachaud, Romon, Thibert 2022) with averaged vertex normals
    jet,           ///< least-squares polynomial of degree `jet_degree` (Cazals, Pouget 2003)
    automatic,     ///< one of them, with its size, from the noise that the data shows
};

/// What `compute_curvature` is asked for; the command and Python have the same names.
struct CurvatureOptions {
    Neighborhood neighborhood = Neighborhood::rings;
    std::uint64_t rings = 2;            ///< of `rings`, in [1, 100]
    Rim rim = Rim::dual;                ///< of `rings`
    Length radius{0.0, false};          ///< of `ball` and `geodesic`, above 0
    Weight weight = Weight::indicator;  ///< of balls, and of rings with rim dual
    bool all_sheets = false;            ///< balls: all of the surface inside, not only what connects to the vertex
    Estimator estimator = Estimator::normal_cycle;
    std::uint64_t jet_degree = 2;  ///< in [2, 4]
    bool measures = false;         ///< also measures beside densities
    bool tensors = false;          ///< also both tensors (measures)
    bool bounds = false;           ///< also the numbers of Theorem 13; needs rings
    /// Largest principal curvature of the unknown smooth surface, for `bounds`; estimated when empty. In 1 / unit.
    std::optional<double> max_curvature = std::nullopt;
};

/// What is special about a vertex, as bits.
namespace vertex_flags {
inline constexpr std::uint8_t unused = 1;        ///< no triangle uses it: all its numbers are 0
inline constexpr std::uint8_t border = 2;        ///< on an edge of one triangle
inline constexpr std::uint8_t non_manifold = 4;  ///< on an edge of more than two triangles, or several fans meet
inline constexpr std::uint8_t excluded = 8;      ///< on an edge without angle: inconsistently oriented triangles
inline constexpr std::uint8_t flat_face = 16;    ///< on a triangle without area
inline constexpr std::uint8_t fallback = 32;     ///< kernel4 was not safe and kernel2 took its place
inline constexpr std::uint8_t undefined = 64;    ///< no area around it: curvatures are 0
}  // namespace vertex_flags

/// The numbers of Theorem 13 for one set B, made homogeneous in length (docs/curvature-bounds.md).
struct ApproximationBound {
    double squared_radii = 0.0;       ///< s: sum of squared circumradii of B's triangles
    double rim_radii = 0.0;           ///< sd: sum of circumradii of those that touch the border of B
    double epsilon = 0.0;             ///< largest circumradius
    double mass = 0.0;                ///< of the normal cycle above B, lengths in units of 1 / max_curvature
    double rim_mass = 0.0;            ///< of its boundary, likewise
    double max_curvature = 0.0;       ///< kappa
    bool curvature_estimated = true;  ///< kappa comes from the data, not from the user: nothing is proved then
    double relative_height = 0.0;     ///< pi_M: largest triangle diameter times kappa
    /// Every triangle's points lie within 1 / (2 kappa) of a corner, and the bound on its angle is below a right angle.
    bool hypothesis_holds = false;
    double height = 0.0;                ///< bound on the distance of B from the surface
    double normal_angle_radians = 0.0;  ///< bound on the angle between the normals of B and of the surface
    /// Bounds on the error of the measures of B (tensors: operator norm), proved in docs/curvature-bounds.md for meshes
    /// closely inscribed in a surface whose curvatures are at most kappa; empty unless hypothesis_holds.
    std::optional<double> gaussian, mean, tensor, swapped_tensor;
    /// C kappa^2 (s + sd / kappa) epsilon: Theorem 13's form, with a constant calibrated on analytic surfaces, not
    /// proved. Bounds the mean measure and the tensors; per area: divide by area.
    double calibrated = 0.0;
};

/// What was found in the mesh and left out of the measures, and times.
struct CurvatureStatistics {
    std::size_t vertices = 0, triangles = 0, edges = 0;
    std::size_t border_edges = 0, non_manifold_edges = 0, excluded_edges = 0;
    std::size_t non_manifold_vertices = 0, unused_vertices = 0;
    std::size_t flat_triangles = 0;     ///< without area: no area, no edge terms, but angles
    std::size_t repeated_vertices = 0;  ///< triangles that name a vertex twice: left out
    std::size_t components = 0;
    double mean_edge_length = 0.0;
    double noise = 0.0;                             ///< automatic: residual of local fits over the mean edge length
    Estimator estimator = Estimator::normal_cycle;  ///< the one that was used
    std::string choice;                             ///< automatic: what was chosen and why
    double radius = 0.0;                            ///< of balls: as resolved; automatic_ball: the median
    std::size_t fallbacks = 0;                      ///< vertices where kernel4 gave way to kernel2
    std::vector<std::pair<std::string, double>> stage_seconds;
};

/// Per vertex, in input order; arrays that were not asked for are empty.
struct CurvatureResult {
    Outcome outcome = Outcome::done;
    std::vector<double> area;      ///< of the region (weighted by the kernel)
    std::vector<double> mean;      ///< density of k1 + k2
    std::vector<double> gaussian;  ///< density of k1 k2
    std::vector<double> k_min, k_max;
    std::vector<Point3> dir_min, dir_max, normal;  ///< unit, right-handed up to sign; normal points outwards
    std::vector<double> confidence;                ///< of the directions, in [0, 1]; 0 at umbilics and where undefined
    std::vector<std::uint8_t> flags;
    std::vector<double> radius;                                                  ///< automatic_ball: what was chosen
    std::vector<SymmetricTensor3> tensor, swapped_tensor;                        ///< measures, not densities
    std::vector<double> mean_measure, gaussian_measure, edge_mass, vertex_mass;  ///< measures
    std::vector<ApproximationBound> bounds;
    CurvatureMeasures total;                ///< of the whole surface
    std::int64_t euler_characteristic = 0;  ///< V - E + F of the triangles used
    CurvatureStatistics statistics;
};

/// Curvatures of a triangulated surface at every vertex.
///
/// Definition: k_min <= k_max, their directions and the normal are the eigen-structure of the swapped tensor of the
///             region around the vertex, divided by the region's area; which eigenvector is the normal is decided by
///             both tensors and the normals of the triangles (thesis, 2.5, where the remedy is only suggested).
/// Input:      finite coordinates. Open surfaces bound no solid: border edges have no angle, border vertices the defect
///             pi - angles. Around edges of more than two triangles the wedges of the solid count where the orientation
///             alternates, else the edge is left out. Nothing needs to be closed, connected or manifold.
/// Result:     see CurvatureResult.
/// Errors:     InputError empty_input, index_out_of_range, non_finite_coordinate, option_out_of_range.
/// Guarantee:  total.gaussian = 2 pi chi on closed manifolds up to rounding; same bits for any number of threads.
///             Scaling by 2^k scales every result exactly (tests/curvature). `geodesic` is first-order accurate in the
///             distance only.
/// Cost:       O(n log n) to sort, then O(region) per vertex, with no allocation per vertex.
/// Source:     thesis, 2.1-2.5; what differs and why: docs/curvature.md.
CurvatureResult compute_curvature(const TriangleMesh& mesh, const CurvatureOptions& options = {},
                                  const RunControl& control = {});

/// A set of points of space: primitives joined by set algebra.
struct Region {
    /// Primitives, and sets made of `parts`.
    enum class Kind : std::uint8_t { everything, ball, box, half_space, faces, predicate, complement, both, either };
    Kind kind = Kind::everything;
    Point3 center, corner;             ///< ball: centre. box: lower and upper corner. half_space: point and outward
                                       ///< normal: the points x with (x - center) . corner <= 0. All closed.
    double radius = 0.0;               ///< ball
    std::vector<std::uint32_t> faces;  ///< faces: 0-based triangles
    std::function<bool(const Point3&)> predicate;  ///< approximated by bisection, see RegionOptions::tolerance
    std::vector<Region> parts;                     ///< complement: one; both, either: any number
};
///@{
/// The closed ball, box, or half-space {x : (x - point) . outward_normal <= 0}; the triangles with these 0-based
/// numbers.
///
/// Input: lengths and places in the mesh's unit; the normal need not be unit. compute_region_measures refuses what
///        makes no sense.
Region make_ball_region(const Point3& center, double radius);
Region make_box_region(const Point3& lower, const Point3& upper);
Region make_half_space_region(const Point3& point, const Point3& outward_normal);
Region make_face_region(std::vector<std::uint32_t> faces);
///@}

///@{
/// What is not in the region; what is in all of the regions (of none: everything); what is in any of them (of none:
/// nothing).
Region make_complement(Region region);
Region make_intersection(std::vector<Region> regions);
Region make_union(std::vector<Region> regions);
///@}

/// What `compute_region_measures` is asked for.
struct RegionOptions {
    Rim rim = Rim::half;           ///< of face sets: half, closed or open
    Length tolerance{1e-4, true};  ///< predicates: triangles and edges are bisected down to this length
    bool bounds = false;           ///< also the numbers of Theorem 13, for the triangles that meet the region
    std::optional<double> max_curvature = std::nullopt;  ///< as in CurvatureOptions
};

/// The measures of one region.
struct RegionResult {
    Outcome outcome = Outcome::done;
    CurvatureMeasures measures;
    double undecided_area = 0.0;  ///< predicates: area of the cells that bisection left undecided
    std::optional<ApproximationBound> bound;
    CurvatureStatistics statistics;
};

/// The measures of one region, with exact clipping.
///
/// Definition: an edge counts by the length inside, a triangle by the area inside, a vertex if it is inside. A set of
///             faces is seen from both sides of each edge: an edge between a face inside and a face outside counts
///             half, a vertex by its share of angle (RegionOptions::rim changes that), which keeps measures additive.
/// Errors:     InputError as compute_curvature; option_out_of_range for radii below 0 and corners out of order.
/// Guarantee:  closed forms up to rounding, predicates excepted; m(A) + m(B) = m(A and B) + m(A or B).
/// Cost:       O(n) primitives' tests, O(k^2) in the number k of primitives where their borders meet a triangle.
/// Source:     thesis, definitions 5 and 7.
RegionResult compute_region_measures(const TriangleMesh& mesh, const Region& region, const RegionOptions& options = {},
                                     const RunControl& control = {});

/// The multiplicities of (p, h) in the normal cycle of the solid that the surface bounds, for each direction h.
///
/// Definition: mu(p, h) = chi(upper star) = 1 - chi(L with x . h >= 0), L being the part of a small sphere around p
///             inside the solid. Its integral over the sphere of directions is the angle defect of p.
/// Input:      p's triangles closed up around p and consistently oriented; h not 0 and not at a right angle to an edge
///             at p (such directions have measure 0).
/// Errors:     InputError index_out_of_range, open_facet where the surface is open at p.
/// Source:     thesis, Lemma 16.
std::vector<int> compute_multiplicities(const TriangleMesh& mesh, VertexId vertex,
                                        const std::vector<Point3>& directions);

/// Coefficients of the volume of the offset: volume(eps) = area eps + mean eps^2 / 2 + gaussian eps^3 / 3, which is the
/// volume between a convex solid's boundary and the offset at distance eps (thesis, 2.2.1, the tube formula).
struct TubeFormula {
    double linear = 0.0, quadratic = 0.0, cubic = 0.0;
    /// Volume between the surface and the offset at this distance.
    double volume(double offset) const { return offset * (linear + offset * (quadratic + offset * cubic)); }
};
/// The tube formula whose coefficients are these measures.
TubeFormula compute_tube_formula(const CurvatureMeasures& measures);

/// A surface made of triangles, and where they come from.
struct TriangulatedSurface {
    TriangleMesh mesh;                        ///< positions as in the source
    std::vector<std::uint32_t> source_faces;  ///< per triangle: the polygon, or the tetrahedron behind it
};

/// Cuts polygons into triangles by their own plane.
///
/// Result: triangles in the order of the polygons; the cut depends on the polygon only, not on where its list of
///         corners starts. Polygons of fewer than three corners are left out.
/// Cost:   linear but for large polygons; deterministic.
TriangulatedSurface triangulate(const PolygonMesh& mesh);
/// The surface of a document: its polygons, or, where there are tetrahedra, the outward boundary of the given regions
/// (field "region" of tetrahedra, else marker; none given: of all tetrahedra).
///
/// Errors: InputError empty_input where nothing is left; hole_outside_facet where a facet has hole points.
TriangulatedSurface triangulate(const MeshDocument& document, const std::optional<std::int64_t>& region = std::nullopt);
/// The regions that a document's tetrahedra name (field "region", else marker), in increasing order; empty without
/// tetrahedra.
std::vector<std::int64_t> find_regions(const MeshDocument& document);

/// The result as vertex fields of a document: area, mean, gaussian, k_min, k_max, dir_min, dir_max, normal, confidence,
/// flags, and what else was asked for.
std::vector<Field> make_fields(const CurvatureResult& result);

}  // namespace certa
