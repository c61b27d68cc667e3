// Distances of creases from sides and vertices of a coarse mesh, at samples.
//
// Curves of the input are covered by sides, or nearly so. Creases that are too short to be curves are covered where
// polygons happen to have sides; how far off is too far is for the caller to say.
#include "remeshing/missed_creases.h"

#include <certa/distance.h>
#include <certa/io.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "remeshing/templates.h"

namespace certa::remeshing {
namespace {

core::TriangleTree tree_of(const CoarseMesh& triangles) {
    std::vector<Triangle> filled;
    for (std::size_t q = 0; q < triangles.polygon_count(); ++q) {
        const auto t = triangles.polygon(q);
        filled.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
    }
    return {triangles.points, filled};
}

/// Returns how far the farthest is.
double visit_missed_creases(const WorkMesh& mesh, const Judge& judge, const CoarseMesh& result, double limit,
                            const std::function<void(const MissedCrease&)>& visit) {
    const bool has_none = mesh.minor_edges.empty() && mesh.minor_corners.empty() && mesh.curves.empty();
    if (has_none || result.polygon_count() == 0) return 0.0;
    std::vector<Triangle> edges, vertices;
    const auto id = [](Index v) { return VertexId{v}; };
    std::vector<Index> polygon_of;
    for (std::size_t q = 0; q < result.polygon_count(); ++q) {
        const auto ring = result.polygon(q);
        polygon_of.insert(polygon_of.end(), ring.size() - 2, static_cast<Index>(q));
        for (std::size_t i = 0; i < ring.size(); ++i) {
            edges.push_back({id(ring[i]), id(ring[(i + 1) % ring.size()]), id(ring[(i + 1) % ring.size()])});
            vertices.push_back({id(ring[i]), id(ring[i]), id(ring[i])});
        }
    }
    const core::TriangleTree edge_tree(result.points, edges), vertex_tree(result.points, vertices),
        surface = tree_of(make_triangles(result, judge.tree));
    double farthest = 0.0;
    const auto demand = [&](const core::TriangleTree& tree, Index& nearest, const Point3& p) {
        const core::NearestPoint found = tree.find_nearest(p, nearest);
        nearest = found.triangle;
        const double away = std::sqrt(found.squared_distance);
        farthest = std::max(farthest, away);
        if (away > limit) visit({polygon_of[surface.find_nearest(p).triangle], p, away});
    };
    Index vertex = no_index, edge = no_index;
    for (const Index v : mesh.minor_corners) demand(vertex_tree, vertex, mesh.points[v]);
    std::vector<Index> creases = mesh.minor_edges;
    for (Index e = 0; e < mesh.edge_curves.size(); ++e)
        if (mesh.edge_curves[e] != no_index) creases.push_back(e);
    double total = 0.0;
    for (const Index e : creases) total += mesh.lengths[e];
    for (const Index e : creases) {
        constexpr double samples = 20000.0;
        const double steps = 4.0 + std::ceil(samples * mesh.lengths[e] / total);
        for (double k = 0.0; k <= steps; k += 1.0) demand(edge_tree, edge, mesh.point_on(e, k / steps));
    }
    return farthest;
}

}  // namespace

std::vector<MissedCrease> find_missed_creases(const WorkMesh& mesh, const Judge& judge, const CoarseMesh& result,
                                              double limit) {
    std::vector<MissedCrease> missed;
    visit_missed_creases(mesh, judge, result, limit, [&](const MissedCrease& m) { missed.push_back(m); });
    std::stable_sort(missed.begin(), missed.end(),
                     [](const MissedCrease& l, const MissedCrease& r) { return l.distance > r.distance; });
    return missed;
}

double add_missed_creases(const WorkMesh& mesh, const Judge& judge, const CoarseMesh& result, double limit,
                          std::vector<Index>& polygons) {
    return visit_missed_creases(mesh, judge, result, limit,
                                [&](const MissedCrease& m) { polygons.push_back(m.polygon); });
}

double reach_of(const WorkMesh& mesh, const Judge& judge, const CoarseMesh& result) {
    const core::TriangleTree surface = tree_of(make_triangles(result, judge.tree));
    double square = 0.0;
    Index nearest = no_index;  // to the last vertex: the next one is mostly near
    for (const Point3& p : mesh.points) {
        const core::NearestPoint found = surface.find_nearest(p, nearest);
        nearest = found.triangle;
        square = std::max(square, found.squared_distance);
    }
    return std::sqrt(square);
}

double crease_limit(const CreaseRule& rule, const WorkMesh& mesh, const Judge& judge, const CoarseMesh& result,
                    const RunControl& control) {
    constexpr double surely = 0.95, most = 0.99, infinite = std::numeric_limits<double>::infinity();
    std::vector<Index> unused;
    const double farthest = add_missed_creases(mesh, judge, result, infinite, unused),
                 reach = reach_of(mesh, judge, result);
    if (farthest <= surely * rule.of_bound * reach || control.cancelled()) return infinite;
    PolygonMesh polygons{result.points, {}, result.offsets};
    for (const Index v : result.corners) polygons.corners.push_back(VertexId{v});
    DistanceOptions options;
    options.samples = 10000;
    const double bound = measure_distance(polygons, make_polygon_mesh(judge.input), options, control).hausdorff_bound;
    return std::max(rule.of_bound * bound, std::min(rule.of_reach * reach, most * bound));
}

}  // namespace certa::remeshing
