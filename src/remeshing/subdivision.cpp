// Linear subdivision, then averaging.
//
// A polygon with sides that are cut and others that are not becomes a fan around its middle, in which the corners
// between two cut sides have quads; a triangle becomes triangles without one.
// Averaging gives each polygon's share to each of its corners: of a quad the centroid with weight 1/4 (an angle of 90
// degrees), of a triangle the point (v + 3/2 (a + b)) / 4 with weight 1/6 (60 degrees); the vertex moves towards the
// weighted mean by a factor that depends on how many of each there are (1 where regular). On curves the same is done
// with segments: (a + 2 v + b) / 4.
#include "remeshing/subdivision.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "core/vector3.h"

namespace certa::remeshing {
namespace {

using Key = std::pair<Index, Index>;
Key key_of(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

struct Side {
    Index curve = no_index;  // of the feature
    bool is_sharp = false;   // a feature or boundary
    bool stays = false;      // not cut
    Index middle = no_index;
    int polygons = 0;
};
using Sides = std::map<Key, Side>;

Sides find_sides(const CoarseMesh& mesh) {
    Sides sides;
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        for (std::size_t i = 0; i < ring.size(); ++i) ++sides[key_of(ring[i], ring[(i + 1) % ring.size()])].polygons;
    }
    for (auto& [key, side] : sides) side.is_sharp = side.polygons != 2;
    for (const FeatureEdge& edge : mesh.feature_edges) {
        const auto found = sides.find(key_of(edge.a, edge.b));
        if (found == sides.end()) continue;
        found->second.is_sharp = true;
        found->second.curve = edge.curve;
    }
    return sides;
}

/// Sides of polygons that stay, and copies of such.
void keep_sides(const CoarseMesh& mesh, std::span<const std::uint8_t> stays, std::span<const Index> names,
                Sides& sides) {
    const auto name_of = [&](Index v) { return names.empty() ? v : names[v]; };
    std::set<Key> kept;
    for (std::size_t q = 0; q < stays.size(); ++q) {
        if (stays[q] == 0) continue;
        const auto ring = mesh.polygon(q);
        for (std::size_t i = 0; i < ring.size(); ++i)
            kept.insert(key_of(name_of(ring[i]), name_of(ring[(i + 1) % ring.size()])));
    }
    if (kept.empty()) return;
    for (auto& [key, side] : sides) side.stays = kept.count(key_of(name_of(key.first), name_of(key.second))) > 0;
}

/// The pieces of a triangle; `middles` of sides that stay are no_index.
void split_triangle(std::span<const Index> ring, const std::array<Index, 3>& middles, Index parent, CoarseMesh& fine) {
    const auto add = [&](Index a, Index b, Index c) { fine.add_polygon(std::array{a, b, c}, parent); };
    const auto cut = std::count_if(middles.begin(), middles.end(), [](Index m) { return m != no_index; });
    if (cut == 0) {
        fine.add_polygon(ring, parent);
    } else if (cut == 3) {
        add(middles[0], middles[1], middles[2]);
        for (std::size_t i = 0; i < 3; ++i) add(ring[i], middles[i], middles[(i + 2) % 3]);
    } else if (cut == 1) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (middles[i] == no_index) continue;
            add(ring[i], middles[i], ring[(i + 2) % 3]);
            add(middles[i], ring[(i + 1) % 3], ring[(i + 2) % 3]);
        }
    } else {
        const std::size_t kept = static_cast<std::size_t>(std::find(middles.begin(), middles.end(), no_index) -
                                                          middles.begin());  // from a to b; the corner beyond is c
        const Index a = ring[kept], b = ring[(kept + 1) % 3], c = ring[(kept + 2) % 3];
        const Index bc = middles[(kept + 1) % 3], ca = middles[(kept + 2) % 3];
        add(ca, bc, c);
        const auto& p = fine.points;
        if (distance(p[a], p[bc]) <= distance(p[b], p[ca]))
            add(a, b, bc), add(a, bc, ca);
        else
            add(a, b, ca), add(b, bc, ca);
    }
}

/// The same for more corners.
void split_polygon(std::span<const Index> ring, std::span<const Index> middles, Index parent, CoarseMesh& fine) {
    if (std::all_of(middles.begin(), middles.end(), [](Index m) { return m == no_index; })) {
        fine.add_polygon(ring, parent);
        return;
    }
    const std::size_t n = ring.size();
    Point3 mean;
    for (const Index v : ring) mean = mean + (1.0 / static_cast<double>(n)) * fine.points[v];
    const Index centre = fine.add_vertex(mean, {});
    for (std::size_t i = 0; i < n; ++i) {
        const Index before = middles[(i + n - 1) % n], after = middles[i];
        if (before != no_index && after != no_index) {
            fine.add_polygon(std::array{ring[i], after, centre, before}, parent);
            continue;
        }
        if (before != no_index) fine.add_polygon(std::array{before, ring[i], centre}, parent);
        fine.add_polygon(std::array{ring[i], after != no_index ? after : ring[(i + 1) % n], centre}, parent);
    }
}

/// Splits sides and polygons; new vertices are means.
CoarseMesh split(const CoarseMesh& mesh, std::span<const std::uint8_t> stays, Sides& sides) {
    CoarseMesh fine;
    fine.points = mesh.points, fine.kinds = mesh.kinds, fine.curves = mesh.curves;
    fine.places.assign(mesh.points.size(), {});
    for (auto& [key, side] : sides) {
        if (side.stays) {
            if (side.curve != no_index) fine.feature_edges.push_back({key.first, key.second, side.curve});
            continue;
        }
        const VertexKind kind = side.polygons == 1 ? VertexKind::boundary
                                : side.is_sharp    ? VertexKind::crease
                                                   : VertexKind::smooth;
        side.middle = fine.add_vertex(0.5 * (mesh.points[key.first] + mesh.points[key.second]), {}, kind, side.curve);
        if (side.curve != no_index) {
            fine.feature_edges.push_back({key.first, side.middle, side.curve});
            fine.feature_edges.push_back({side.middle, key.second, side.curve});
        }
    }
    std::vector<Index> middles;
    for (Index q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        if (!stays.empty() && stays[q] != 0) {
            fine.add_polygon(ring, q);
            continue;
        }
        middles.clear();
        for (std::size_t i = 0; i < ring.size(); ++i)
            middles.push_back(sides.at(key_of(ring[i], ring[(i + 1) % ring.size()])).middle);
        if (ring.size() == 3)
            split_triangle(ring, {middles[0], middles[1], middles[2]}, q, fine);
        else
            split_polygon(ring, middles, q, fine);
    }
    return fine;
}

/// How far towards the mean: 1 where regular; Loop's and Catmull's extraordinary rules elsewhere.
double factor(int quads, int triangles) {
    if (quads == 0) {
        const double c = 0.375 + 0.25 * std::cos(2.0 * std::numbers::pi / triangles);
        return 5.0 / 3.0 - 8.0 / 3.0 * c * c;
    }
    if (triangles == 0) return 4.0 / quads;
    return 12.0 / (3.0 * quads + 2.0 * triangles);
}

void average(CoarseMesh& mesh) {
    const std::size_t n = mesh.points.size();
    const Sides sides = find_sides(mesh);
    std::vector<std::vector<Index>> along(n);  // neighbours on sharp sides
    for (const auto& [key, side] : sides) {
        if (!side.is_sharp) continue;
        along[key.first].push_back(key.second);
        along[key.second].push_back(key.first);
    }
    std::vector<Point3> sums(n);
    std::vector<double> weights(n, 0.0);
    std::vector<std::array<int, 2>> counts(n, {0, 0});  // quads, triangles
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        Point3 mean;
        for (const Index v : ring) mean = mean + (1.0 / static_cast<double>(ring.size())) * mesh.points[v];
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index v = ring[i], a = ring[(i + 1) % ring.size()], b = ring[(i + ring.size() - 1) % ring.size()];
            if (ring.size() == 3) {
                sums[v] = sums[v] + (1.0 / 6.0) * (0.25 * mesh.points[v] + 0.375 * (mesh.points[a] + mesh.points[b]));
                weights[v] += 1.0 / 6.0;
                ++counts[v][1];
            } else {
                sums[v] = sums[v] + 0.25 * mean;
                weights[v] += 0.25;
                ++counts[v][0];
            }
        }
    }
    std::vector<Point3> moved = mesh.points;
    for (std::size_t v = 0; v < n; ++v) {
        const bool is_corner = mesh.kinds[v] == VertexKind::corner || (!along[v].empty() && along[v].size() != 2);
        if (is_corner || weights[v] == 0.0) continue;
        if (along[v].size() == 2) {
            moved[v] = 0.5 * mesh.points[v] + 0.25 * (mesh.points[along[v][0]] + mesh.points[along[v][1]]);
            continue;
        }
        const Point3 mean = (1.0 / weights[v]) * sums[v];
        moved[v] = mesh.points[v] + factor(counts[v][0], counts[v][1]) * (mean - mesh.points[v]);
    }
    mesh.points = std::move(moved);
}

}  // namespace

CoarseMesh subdivide(const CoarseMesh& mesh, bool smooth, std::span<const std::uint8_t> stays,
                     std::span<const Index> names) {
    Sides sides = find_sides(mesh);
    keep_sides(mesh, stays, names, sides);
    CoarseMesh fine = split(mesh, stays, sides);
    if (smooth) average(fine);
    return fine;
}

}  // namespace certa::remeshing
