// One after the other; a polygon takes part once.
#include "remeshing/flat_triangles.h"

#include <algorithm>
#include <map>

#include "core/vector3.h"
#include "remeshing/work_mesh.h"

namespace certa::remeshing {
namespace {

constexpr double flat = 1e-9;  ///< height over length

Point3 area_of(const CoarseMesh& mesh, Index a, Index b, Index c) {
    return cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
}
/// The corner of a triangle that lies in the opposite side; 3: it has area, or corners in one place.
std::size_t flat_corner(const CoarseMesh& mesh, std::span<const Index> ring) {
    for (std::size_t i = 0; i < 3; ++i) {
        const Index a = ring[(i + 2) % 3], b = ring[i], c = ring[(i + 1) % 3];
        const Point3 side = mesh.points[c] - mesh.points[a];
        const double square = dot(side, side), along = dot(mesh.points[b] - mesh.points[a], side);
        if (along > 0.0 && along < square && norm(area_of(mesh, a, b, c)) < flat * square) return i;
    }
    return 3;
}

/// A side on a feature becomes two, where these are not there yet.
void move_feature(std::vector<FeatureEdge>& edges, Index a, Index b, Index c) {
    const auto find = [&](Index x, Index y) {
        return std::find_if(edges.begin(), edges.end(),
                            [&](const FeatureEdge& e) { return pair_key(e.a, e.b) == pair_key(x, y); });
    };
    const auto whole = find(a, c);
    if (whole == edges.end()) return;
    const Index curve = whole->curve;
    edges.erase(whole);
    for (const Index end : {a, c})
        if (find(end, b) == edges.end()) edges.push_back({end, b, curve});
}

}  // namespace

CoarseMesh without_flat_triangles(const CoarseMesh& mesh) {
    std::map<std::array<Index, 2>, Index> left_of;
    std::vector<Index> flat_ones;
    for (Index q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        for (std::size_t i = 0; i < ring.size(); ++i) left_of[{ring[i], ring[(i + 1) % ring.size()]}] = q;
        if (ring.size() == 3 && flat_corner(mesh, ring) < 3) flat_ones.push_back(q);
    }
    if (flat_ones.empty()) return mesh;
    std::vector<std::uint8_t> is_gone(mesh.polygon_count(), 0);
    CoarseMesh out = mesh.without_polygons();
    for (const Index q : flat_ones) {
        const auto ring = mesh.polygon(q);
        const std::size_t i = flat_corner(mesh, ring);
        const Index a = ring[(i + 2) % 3], b = ring[i], c = ring[(i + 1) % 3];
        const auto beyond = left_of.find({a, c});  // the triangle walks the side from c to a
        if (is_gone[q] != 0 || beyond == left_of.end() || is_gone[beyond->second] != 0) continue;
        const auto other = mesh.polygon(beyond->second);
        Point3 normal;
        for (std::size_t k = 1; k + 1 < other.size(); ++k)
            normal = normal + area_of(mesh, other[0], other[k], other[k + 1]);
        std::vector<std::array<Index, 3>> fan;
        for (std::size_t k = 0; k < other.size(); ++k)
            if (other[k] != a) fan.push_back({other[k], other[(k + 1) % other.size()], b});
        if (std::find(other.begin(), other.end(), b) != other.end() ||
            !std::all_of(fan.begin(), fan.end(),
                         [&](const auto& t) { return dot(area_of(mesh, t[0], t[1], t[2]), normal) > 0.0; }))
            continue;
        is_gone[q] = is_gone[beyond->second] = 1;
        move_feature(out.feature_edges, a, b, c);
        for (const auto& t : fan) out.add_polygon(t, mesh.parent(beyond->second));
    }
    for (Index q = 0; q < mesh.polygon_count(); ++q)
        if (is_gone[q] == 0) out.add_polygon(mesh.polygon(q), mesh.parent(q));
    return out;
}

}  // namespace certa::remeshing
