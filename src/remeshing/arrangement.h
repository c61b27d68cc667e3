#pragma once
// The graph that lines and features draw on the surface, from comparisons of numbers on edges only (remesh, stage 8).
#include "remeshing/network.h"

namespace certa::remeshing {

/// Arms of a node in counter-clockwise order: half-edges of the graph that leave it. Half-edge 2 e leaves edge e's node
/// a, 2 e + 1 its node b.
struct GraphNode {
    Point3 point;
    SurfacePlace place;  ///< on the work mesh
    VertexKind kind = VertexKind::smooth;
    Index curve = no_index;
    std::vector<Index> arms;
};

/// A piece of a line or of a feature curve between two nodes.
struct GraphEdge {
    Index a = no_index, b = no_index;  ///< no_index: deleted
    Index line = no_index;             ///< or
    Index curve = no_index;
    double from = 0.0, to = 0.0;  ///< places along the line (chord number and part) or curve (edge number and part)
    bool alive() const { return a != no_index; }
};

class Graph {
public:
    std::vector<GraphNode> nodes;
    std::vector<GraphEdge> edges;

    Index tail(Index h) const { return h % 2 == 0 ? edges[h / 2].a : edges[h / 2].b; }
    Index head(Index h) const { return tail(h ^ 1U); }
    /// The half-edge behind h around the face to its left.
    Index next(Index h) const;
    void delete_edge(Index e);
    /// Makes one edge of the two at a node with two arms of the same line or curve.
    void join_at(Index node);
    /// A new node on an edge.
    Index split(Index e, const Point3& point, const SurfacePlace& place, double at);
    /// The faces as cycles of half-edges; those outside the boundary are left out.
    std::vector<std::vector<Index>> trace_faces(const WorkMesh& mesh) const;
};

struct ArrangementRule {
    double crease_error = 0.0;    ///< sagitta that a straight side may have over a crease ...
    double boundary_error = 0.0;  ///< ... and over the boundary
};

/// Nodes and edges: crossings of the two families, of lines with features, corners, and as many points of features as
/// their curvature asks for. Ends that dangle are trimmed, nodes without a turn are dropped.
Graph build_graph(const Network& network, const ArrangementRule& rule);
/// Removes faces of one or two sides and parallel edges, so that faces are simple polygons.
void simplify_graph(Graph& graph, const Network& network);
/// A point along a line: chord number and part of it.
Point3 point_along(const Network& network, Index line, double at, SurfacePlace& place);
/// A point along a feature curve: edge number and part of it.
Point3 point_along_curve(const WorkMesh& mesh, Index curve, double at, SurfacePlace& place);

}  // namespace certa::remeshing
