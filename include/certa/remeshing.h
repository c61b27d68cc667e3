#pragma once
// Part II, chapter 4: anisotropic, quad-dominant polygons along lines of curvature, on surfaces of any genus.
#include <certa/error.h>
#include <certa/mesh.h>
#include <certa/run_control.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace certa {

/// What the polygons of the result are.
enum class RemeshOutput : std::uint8_t {
    polygons,       ///< as the lines cut them: a vertex in the side of a polygon is one of its corners
    quad_dominant,  ///< quads and triangles only
    triangles,
};

/// The error that is asked for where nothing else is.
inline constexpr Length default_remesh_error{2e-3, true};

/// How directions are smoothed.
enum class SmoothingMethod : std::uint8_t {
    screened,  ///< one sparse solve for unit directions: strong parts do not outvote weak ones
    gaussian,  ///< the thesis's: tensors convolved with a Gaussian whose standard deviation is the smoothing length
};

/// Points instead of lines where curvature is alike in all directions (thesis 4.2.2).
enum class IsotropicSamples : std::uint8_t {
    needed,  ///< at umbilics whose polygon is no quad and would pass too far below them
    none,
    all,  ///< wherever polygons around umbilics, or in spherical parts, have room; lines are denser near umbilics
};

/// What `remesh` is asked for; the command and Python have the same names.
struct RemeshOptions {
    /// How fine: at most one of the three; without any, default_remesh_error.
    std::optional<Length> error = std::nullopt;  ///< bound on the distance between result and input, both ways
    std::optional<std::uint64_t> vertices = std::nullopt;
    std::optional<std::uint64_t> faces = std::nullopt;
    double isotropy = 0.0;  ///< rho of the thesis, in [0, 1]: 0 follows both curvatures, 1 none
    double feature_angle_radians = 0.69813170079773179;  ///< 40 degrees: sharper edges are creases
    std::vector<Edge> features;                          ///< edges of the input that are creases whatever their angle
    std::vector<Edge> guides;                            ///< edges of the input that lines follow without being creases
    std::optional<Length> smooth = std::nullopt;  ///< length over which directions are smoothed; chosen when empty
    SmoothingMethod smoothing_method = SmoothingMethod::screened;
    double transfer = 0.5;            ///< lines per length grow like |k|^transfer; 0.5 is the thesis's
    bool hyperbolic_spacing = false;  ///< sqrt 2 wider where curvatures have opposite signs
    IsotropicSamples isotropic_samples = IsotropicSamples::needed;
    RemeshOutput output = RemeshOutput::quad_dominant;
    std::uint64_t max_degree = 0;  ///< polygons: at most so many corners; 0: any number
    bool placement = true;         ///< move vertices to where the error is least
    std::uint64_t subdivide = 0;   ///< rounds of quad/triangle subdivision of the result
    bool lines = false;            ///< also return the lines and umbilics
};

/// A line of curvature on the input.
struct CurvatureLine {
    bool maximum = false;  ///< runs along the direction of k_max
    bool closed = false;
    std::vector<Point3> points;
};
/// Where the directions are not defined: index +1/2 (wedge) or -1/2 (trisector), seldom more.
struct Umbilic {
    Point3 place;
    std::uint32_t face = 0;  ///< triangle of the input
    int half_turns = 0;      ///< index times two
};

/// Counts, choices and times of one run.
struct RemeshStatistics {
    std::size_t input_vertices = 0, input_triangles = 0, components = 0;
    std::int64_t euler_characteristic = 0;
    std::size_t boundary_loops = 0, feature_edges = 0, feature_curves = 0, corners = 0;
    std::size_t merged_points = 0;  ///< that coincide with others
    std::size_t unused_vertices = 0, flipped_triangles = 0, non_manifold_edges = 0;
    std::size_t degenerate_triangles = 0;  ///< that name a point twice
    std::size_t repeated_triangles = 0;    ///< that have the corners of another, in whatever order
    std::size_t split_vertices = 0;        ///< where several sheets met in one vertex of the input
    std::size_t wedges = 0, trisectors = 0;
    std::size_t cancelled_pairs = 0;           ///< of a wedge and a trisector, closer than the spacing: smoothed away
    std::size_t umbilics_typed_otherwise = 0;  ///< by the linear field's polynomial than by the index, which counts
    std::size_t multiple_umbilics = 0;         ///< triangles of an index beyond 1/2: tips too sharp to be cut up
    int umbilic_half_turns = 0;                ///< sum of all indices times two
    std::size_t isotropic_samples = 0;         ///< vertices that polygons are triangulated around
    std::size_t lines_min = 0, lines_max = 0, closed_lines = 0;
    /// How far vertices of the input are, at most, from the nearest line, or crease along the lines, of a family that
    /// is wanted there, in spacings; and those, per family and sector between creases, that have none within 1.3.
    double widest_gap = 0.0;
    std::size_t uncovered = 0;
    double spacing_error = 0.0;  ///< epsilon of the spacing of lines, as resolved
    double smoothing = 0.0;      ///< smoothing length, as resolved
    std::size_t rounds = 0;      ///< networks that were traced to meet what was asked for
    /// Where polygons would turn away, meet or be too far, triangles of the input stand: regions of these, and
    /// triangles.
    std::size_t mended_regions = 0, mended_triangles = 0;
    std::size_t cut_faces = 0;  ///< between lines that are triangles, so that every way to fill them keeps the error
    /// Subdivision: vertices held back nearer to their polygon, so that nothing folds or meets; rounds that were done;
    /// faces that were not subdivided in every round, because their pieces would do so wherever they lie.
    std::size_t held_vertices = 0, subdivision_rounds = 0, coarse_faces = 0;
    double distance_bound = 0.0;  ///< where an error was asked for: proved, both ways, in the input's unit
    std::size_t vertices = 0, faces = 0, triangles = 0, quads = 0;
    std::size_t t_nodes = 0;            ///< polygons' corners without a turn, before they became quads and triangles
    double quad_share_with_t = 0.0;     ///< share of polygons with four corners, T-nodes counted as corners
    double quad_share_without_t = 0.0;  ///< not counted
    std::vector<std::string> notes;     ///< repairs and what could not be had, a sentence each
    std::vector<std::pair<std::string, double>> stage_seconds;
};

/// Polygons along lines of curvature.
struct RemeshResult {
    Outcome outcome = Outcome::done;
    PolygonMesh mesh;
    std::vector<Edge> feature_edges;            ///< sides of polygons that cover creases and boundary
    std::vector<std::uint32_t> feature_curves;  ///< per feature edge: number of the curve
    std::vector<CurvatureLine> lines;
    std::vector<Umbilic> umbilics;
    RemeshStatistics statistics;
};

/// A surface whose equal points are one.
struct WeldedSurface {
    TriangleMesh mesh;
    std::vector<VertexId> numbers;  ///< per point of the input: its number in the mesh
    std::size_t merged = 0;         ///< points that are named no more
};

/// Merges equal points where that joins triangles, as `remesh` does, so that its result can be compared with a soup:
/// elsewhere the mesh stays as it is. Points keep their numbers; triangles that name a point twice then, or repeat
/// another, are left out.
WeldedSurface weld_surface(const TriangleMesh& mesh);

/// Polygons along lines of curvature.
///
/// Input:      a surface with or without boundary, of any genus and any number of components. Triangles may be turned
///             either way (they are turned alike); edges of more than two triangles become creases.
/// Result:     an oriented polygon mesh with the input's components, genus and boundary loops; creases, boundary and
///             corners of the input are covered by sides and corners of polygons.
/// Errors:     InputError empty_input, index_out_of_range, non_finite_coordinate, coordinate_out_of_range (beyond 1e50,
/// or smaller
///             than 1e-50 in all), option_out_of_range, and
///             conflicting_orientation where a component has only one side.
/// Cost:       O(n log n) in the input, tracing once per round of the search for a count; memory linear.
/// Source:     thesis, Part II chapter 4; what differs and why: docs/remesh.md.
RemeshResult remesh(const TriangleMesh& mesh, const RemeshOptions& options = {}, const RunControl& control = {});

}  // namespace certa
