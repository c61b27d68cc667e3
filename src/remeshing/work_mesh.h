#pragma once
// The input as every stage sees it: oriented triangles, features, and fans of corners between features.
#include <certa/remeshing.h>

#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "core/vector3.h"
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

using Complex = std::complex<double>;

inline std::uint64_t pair_key(Index a, Index b) {
    return (static_cast<std::uint64_t>(a < b ? a : b) << 32) | (a < b ? b : a);
}

/// Half-edge 3 f + i leaves corner i of face f towards corner i + 1; corner c = 3 f + i is where it starts.
inline Index next_of(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline Index previous_of(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// A curve of feature edges from corner to corner, or closed.
struct FeatureCurve {
    std::vector<Index> vertices;  ///< closed: the first is not repeated
    std::vector<Index> edges;     ///< between consecutive vertices
    bool closed = false;
    bool boundary = false;
};

/// Triangles without orientation conflicts; every edge has one or two faces. Vertices are those of the input, but a
/// vertex where several fans met has one copy per fan.
///
/// A *wedge* is a maximal fan of corners at a vertex between feature edges: what is one-sided at features is stored per
/// wedge. Angles are intrinsic, of edge lengths that are enlarged ever so little, so that no triangle is flat.
struct WorkMesh {
    std::vector<Point3> points;
    std::vector<Index> point_sources;  ///< vertex of the input; beyond those, points that were added on long edges
    std::unordered_set<std::uint64_t> tagged;  ///< edges that are creases: keys of their ends' point_sources
    std::unordered_set<std::uint64_t> sharp;   ///< the same for those that are creases by their angle
    std::unordered_set<std::uint64_t> guides;  ///< the same for edges that lines shall follow
    std::vector<bool> is_guide;                ///< per edge; empty where there are none
    std::vector<std::array<Index, 3>> faces;
    std::vector<Index> face_sources;    ///< triangle of the input
    std::vector<Index> opposites;       ///< per half-edge; no_index at the boundary
    std::vector<Index> edges;           ///< per half-edge: its edge
    std::vector<Index> edge_halfedges;  ///< per edge: its first half-edge, which defines its direction
    std::vector<Index> edge_curves;     ///< per edge: its feature curve or no_index
    /// Per edge that was cut open, because more than two faces meet there: what it has in common with its copies;
    /// no_index for others.
    std::vector<Index> edge_twins;
    bool is_cut_open = false;  ///< at edges or vertices
    std::vector<FeatureCurve> curves;
    std::vector<bool> is_corner;  ///< per vertex
    /// What is a crease by angle but too short to be one of the curves: nothing follows it, but it must not get lost.
    std::vector<Index> minor_edges;
    std::vector<Index>
        minor_corners;              ///< vertices: corners of all creases, minor ones too, that are none of the curves'
    std::vector<Index> components;  ///< per face
    std::vector<Index> patches;     ///< per face: parts between features
    Index patch_count = 0;
    Index component_count = 0;
    std::vector<double> lengths;  ///< per edge, enlarged

    std::vector<Index> wedges;          ///< per corner
    std::vector<Index> wedge_vertices;  ///< per wedge
    std::vector<Index> wedge_first;     ///< per wedge: its first corner, counter-clockwise
    std::vector<bool> wedge_closed;
    std::vector<double> corner_start;  ///< per corner: intrinsic angle of its half-edge in the wedge's frame
    std::vector<double> corner_angle;  ///< per corner, scaled so that closed fans have 2 pi
    std::vector<Complex> apex;         ///< per face: corner 2 in the plane where corner 0 is 0 and corner 1 real

    double diagonal = 0.0, mean_edge = 0.0;
    std::int64_t euler_characteristic = 0;

    Index face_count() const { return static_cast<Index>(faces.size()); }
    Index wedge_count() const { return static_cast<Index>(wedge_vertices.size()); }
    Index start_of(Index h) const { return faces[h / 3][h % 3]; }
    Index end_of(Index h) const { return start_of(next_of(h)); }
    bool is_feature(Index h) const { return edge_curves[edges[h]] != no_index; }
    /// The next corner counter-clockwise around the vertex in the same wedge, or no_index.
    Index next_corner(Index c) const {
        const Index h = previous_of(c);
        return is_feature(h) ? no_index : opposites[h];
    }
    /// Corner i of face f in the face's own plane.
    Complex local(Index f, Index i) const {
        return i == 0 ? Complex(0.0) : i == 1 ? Complex(lengths[edges[3 * f]], 0.0) : apex[f];
    }
    /// Whether half-edge h runs in its edge's direction.
    bool along(Index h) const { return edge_halfedges[edges[h]] == h; }
    Point3 point_on(Index edge, double t) const {
        const Index h = edge_halfedges[edge];
        const Point3 &a = points[start_of(h)], &b = points[end_of(h)];
        return a + t * (b - a);
    }
};

/// Per point: the first one with the same coordinates.
std::vector<Index> merge_points(const std::vector<Point3>& points);

/// The same where merging joins open sides, as of a soup; else only points of one triangle: two vertices in one place
/// may be meant, where surfaces touch.
std::vector<Index> joined_points(const TriangleMesh& mesh);

/// Checks, orients and connects the input, finds features and wedges (stage 1). `count`: edges are short enough for a
/// result of so many vertices; 0: as they are, but for very long ones.
///
/// Errors: InputError (see remesh).
WorkMesh build_work_mesh(const TriangleMesh& mesh, const RemeshOptions& options, RemeshStatistics& statistics,
                         double count = 0.0);

/// Halves edges longer than `longest`, and their triangles with them, until none is left or there are more faces than
/// `most_faces`. The surface stays as it is.
void split_long_edges(WorkMesh& mesh, double longest, Index input_vertices, double most_faces);
/// Edges that are creases by their angle, without short groups that are noise: keys of their ends' point_sources.
/// Input: oriented faces with opposites and edges.
std::unordered_set<std::uint64_t> find_sharp_edges(const WorkMesh& mesh, const RemeshOptions& options);
/// Features by angle, boundary, and what is tagged; fills edge_curves, curves, is_corner.
void find_features(WorkMesh& mesh, const RemeshOptions& options, RemeshStatistics& statistics);
/// Fills wedges and intrinsic angles; needs features.
void build_wedges(WorkMesh& mesh);

}  // namespace certa::remeshing
