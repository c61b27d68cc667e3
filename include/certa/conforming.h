#pragma once
// Part I: conforming Delaunay tetrahedral meshes of piecewise linear complexes, and their checker.
#include <certa/error.h>
#include <certa/mesh.h>
#include <certa/run_control.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace certa {

/// Where protecting balls are placed before anything else.
enum class Protection : std::uint8_t {
    needed,  ///< nowhere at first; points by mirroring, balls only where that did not end (docs/lazy-protection.md)
    sharp,   ///< all vertices, and edges where two faces meet at less than 90 degrees (thesis, Part I, 1.4.2)
    all,     ///< the whole 1-skeleton (thesis, Part I, 1.1-1.3)
};

/// What `conform` is asked for; the command and Python have the same names.
struct ConformOptions {
    Protection protection = Protection::needed;
    bool gabriel = false;          ///< also empty the diametral ball of every constraint triangle (thesis, Part I, 1.6)
    double alpha = 0.4;            ///< radius of a protecting ball over the local feature size, in (0, 0.5)
    bool merge_coplanar = false;   ///< one facet from exactly coplanar neighbours of equal marker
    bool triangulate = false;      ///< cut non-planar facets into triangles instead of refusing them
    bool repair = false;           ///< fix what has one obvious meaning, see ConformResult::repairs
    bool keep_outside = false;     ///< emit region 0 up to the convex hull
    Length planarity{1e-9, true};  ///< largest distance of a facet's point from the facet's plane
    Length min_feature{1e-12, true};  ///< stop with Outcome::below_min_feature below this length
    std::optional<std::uint64_t> max_points =
        std::nullopt;  ///< stop with Outcome::over_budget above this number of vertices
};

/// Counts and times of one run; every length in the input's unit, every time in seconds.
struct ConformStatistics {
    std::size_t input_points = 0, segments = 0, facets = 0;
    std::size_t missing_segments = 0, missing_facets = 0;  ///< in the Delaunay triangulation of the input points
    std::size_t steiner_on_segments = 0, steiner_in_facets = 0;
    std::size_t protecting_balls = 0, restarts = 0;
    double max_displacement = 0.0;  ///< largest distance of a Steiner point from its segment's line or facet's plane
    std::vector<std::pair<std::string, double>> stage_seconds;
};

/// A conforming Delaunay mesh with the origin of each of its elements, or why there is none.
struct ConformResult {
    Outcome outcome = Outcome::done;
    TetMesh mesh;                ///< input points first, unchanged and in order, then Steiner points
    std::vector<Edge> segments;  ///< all segments: the given ones in order, then the remaining sides of facets
    std::vector<double> region_attributes;  ///< per region, from its seed, else 0
    std::vector<double> ball_radii;  ///< per vertex: of the protecting ball around it, else 0; empty without balls
    std::vector<Defect> warnings, repairs;
    std::vector<Defect> obstacles;  ///< unless done: what stopped the run, and where
    ConformStatistics statistics;
};

/// Makes the conforming Delaunay tetrahedral mesh of a piecewise linear complex.
///
/// Input:      finite, distinct points; facets planar within `planarity` that meet only in common vertices, segments,
///             isolated segments and isolated points; any angles; open, internal, dangling, nested, non-manifold
///             welcome. A point that lies exactly on a facet without being listed there is adopted as an isolated point
///             of it, a segment that lies exactly in a facet as an isolated segment (warnings say so).
/// Result:     see ConformResult. Regions are numbered from 1 in the order of their lowest input vertex;
///             region 0 is left out unless `keep_outside`, or nothing bounded exists (a warning says so).
/// Errors:     InputError with every violation found.
/// Guarantee:  Outcome::done means that the four promises of docs/conventions.md hold on the doubles of the result;
///             check_conforming decides them independently.
/// Cost:       about O(n log n) on real models; deterministic for any number of threads.
/// Source:     thesis, Part I; the default protection goes beyond it, see docs/lazy-protection.md.
ConformResult conform(const PiecewiseLinearComplex& complex, const ConformOptions& options = {},
                      const RunControl& control = {});

/// What `repair` and `triangulate` make of a complex before anything else.
struct RepairedComplex {
    PiecewiseLinearComplex complex;      ///< the input's points first, unchanged; facet i < input's count stays facet i
    std::vector<FacetId> facet_sources;  ///< per facet of `complex`: the input's facet it is, or is a part of
    std::vector<Defect> repairs;         ///< what was done, element by element, with the numbers of the moment
};

/// Repairs a complex as ConformOptions::repair and ::triangulate say; with neither, returns it as it is.
///
/// Definition: repair: points that coincide become one (the others stay, unused); sides and segments without length and
///             repeated segments go; facets without area and repeated facets become empty; segments are split at points
///             on them or within rounding, and where they cross; facets that cross get their intersection as isolated
///             segments, and segments that pierce a facet a point of it. Points of intersection are computed exactly
///             and rounded. triangulate: a facet that is not planar becomes triangles, the first in its place, the
///             others at the end.
/// Result:     may still be invalid: overlapping coplanar facets, facets whose own rings cross and the like have no one
///             obvious meaning. `conform` refuses what is left.
/// Errors:     InputError when indices or coordinates make no sense.
/// Cost:       O(n log n) a round, at most 24 rounds; deterministic.
RepairedComplex repair_complex(const PiecewiseLinearComplex& complex, const ConformOptions& options,
                               const RunControl& control = {});

/// What makes a complex unfit for `conform`.
struct ComplexDefects {
    std::vector<Defect> defects;   ///< the first 10,000, in a fixed order
    std::size_t defect_count = 0;  ///< all
    std::vector<Defect> notes;     ///< legal, but worth a warning: what would be adopted or ignored
};

/// Finds every violation that `conform` would refuse, self-intersections among them, without meshing.
///
/// Guarantee: exact on the doubles given, up to `planarity`.
/// Cost:      O(n log n + pairs of boxes that overlap); deterministic.
ComplexDefects find_defects(const PiecewiseLinearComplex& complex, const ConformOptions& options = {},
                            const RunControl& control = {});

///@{
/// One facet per polygon of the mesh, in the same order, over the same points.
///
/// Input: any mesh; `conform` says what is wrong with it.
/// Cost:  linear.
PiecewiseLinearComplex make_complex(const PolygonMesh& mesh);
PiecewiseLinearComplex make_complex(const TriangleMesh& mesh);
///@}

/// What a mesh is held to by check_conforming and check_delaunay_mesh.
struct ConformingCheckOptions {
    bool gabriel = false;
    bool merge_coplanar =
        false;  ///< the mesh was made with merge_coplanar: its triangles name the lowest facet of each group
    Length planarity{1e-9, true};
    /// Largest distance of an added vertex from the segment or facet that carries it. When relative to the diagonal, at
    /// least 8 roundings of the largest coordinate are allowed, which far from the origin may be more.
    Length deviation{1e-12, true};
};

/// One broken promise: which, where, and the elements of the mesh that show it.
struct Violation {
    std::string promise;  ///< "delaunay", "conforming", "faithful", "labelled", "gabriel", "well-formed"
    std::vector<ElementRef> elements;
    Point3 place;
    std::string message;
};

/// What check_conforming and check_delaunay_mesh found.
struct ConformingCheck {
    std::vector<Violation> violations;  ///< at most 100 per promise are kept
    std::size_t violation_count = 0;
    bool full_hull = false;      ///< the mesh fills its convex hull: Delaunay was proved by local tests
    double max_deviation = 0.0;  ///< largest distance of a vertex from its segment or facet plane
    std::size_t tetrahedra_checked = 0, segments_checked = 0, facets_checked = 0;
    bool ok() const { return violation_count == 0; }  ///< every promise holds
};

/// Decides whether `mesh` is a conforming Delaunay mesh of `complex`.
///
/// Input:      any mesh with constraint triangles labelled by 0-based facet and edges labelled by 0-based segment, the
///             segments numbered as in ConformResult::segments. Missing edge labels: segments are looked up in the
///             mesh. A complex that `conform` accepts: where its own faces cross, the answer is for its faces one by
///             one.
/// Result:     a cancelled check counts as one violation: nothing is proved.
/// Errors:     InputError when indices or coordinates of the complex make no sense, or an option is out of range.
/// Guarantee:  exact on the doubles given; shares no code with `conform`.
/// Cost:       O(n log n); deterministic.
ConformingCheck check_conforming(const TetMesh& mesh, const PiecewiseLinearComplex& complex,
                                 const ConformingCheckOptions& options = {}, const RunControl& control = {});

/// Decides what can be said about a mesh without knowing what it was made from: its form and the Delaunay property.
///
/// Definition: check_conforming against the mesh's own constraint triangles and edges as facets and segments, whatever
///             its labels say.
/// Result:     violations of "well-formed", "delaunay" and "gabriel" only; at most 100 of each promise are counted. A
///             cancelled check counts as one violation.
/// Errors:     InputError as check_conforming.
/// Guarantee:  as check_conforming.
/// Cost:       as check_conforming, and a copy of the mesh.
ConformingCheck check_delaunay_mesh(const TetMesh& mesh, const ConformingCheckOptions& options = {},
                                    const RunControl& control = {});

}  // namespace certa
