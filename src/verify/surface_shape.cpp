// Counting on sorted sides: components, fans around vertices, boundary loops, creases and their corners.
//
// A fan is what the polygons around a vertex form when they are joined across edges; a manifold vertex has one. Euler's
// characteristic counts fans, so that surfaces that touch in a vertex stay what they are.
#include "verify/surface_shape.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/union_find.h"
#include "core/vector3.h"

namespace certa {
namespace verify {

std::vector<PolygonSide> sort_sides(const PolygonMesh& mesh) {
    std::vector<PolygonSide> sides;
    sides.reserve(mesh.corners.size());
    for (std::uint32_t q = 0; q + 1 < mesh.offsets.size(); ++q) {
        const std::uint32_t begin = mesh.offsets[q], end = mesh.offsets[q + 1];
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t next = i + 1 == end ? begin : i + 1;
            const std::uint32_t a = index_of(mesh.corners[i]), b = index_of(mesh.corners[next]);
            sides.push_back({std::min(a, b), std::max(a, b), q, i, next, a > b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const PolygonSide& l, const PolygonSide& r) {
        if (l.low != r.low) return l.low < r.low;
        if (l.high != r.high) return l.high < r.high;
        return l.slot < r.slot;
    });
    return sides;
}

std::size_t end_of_edge(const std::vector<PolygonSide>& sides, std::size_t begin) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    return end;
}

namespace {

Point3 unit_normal(const PolygonMesh& mesh, std::uint32_t q) {
    const Point3& origin = mesh.positions[index_of(mesh.corners[mesh.offsets[q]])];
    Point3 sum;
    for (std::uint32_t i = mesh.offsets[q] + 1; i + 1 < mesh.offsets[q + 1]; ++i)
        sum = sum + cross(mesh.positions[index_of(mesh.corners[i])] - origin,
                          mesh.positions[index_of(mesh.corners[i + 1])] - origin);
    const double length = norm(sum);
    return length > 0.0 ? (1.0 / length) * sum : Point3{};
}

enum class Mark : std::uint8_t { none, angle, tagged, boundary };
struct MarkedEdge {
    std::uint32_t low = 0, high = 0;
    Mark mark = Mark::none;
    double length = 0.0;
};

double diagonal_of(const PolygonMesh& mesh) {
    Point3 low = mesh.positions.front(), high = low;
    for (const VertexId v : mesh.corners) {
        const Point3& p = mesh.positions[index_of(v)];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return distance(low, high);
}

/// Which polygon stands for a side's own in a dihedral angle: as the normals of triangles lower than 5e-4 of the
/// diagonal say nothing, the first one beyond them, out of each by the longer of its other two sides.
class BeyondSlivers {
public:
    BeyondSlivers(const PolygonMesh& mesh, const std::vector<PolygonSide>& sides)
        : mesh_(mesh), sides_(sides), least_(5e-4 * diagonal_of(mesh)), mates_(sides.size(), no_index) {
        slots_.resize(mesh.corners.size());
        for (std::uint32_t i = 0; i < sides.size(); ++i) slots_[sides[i].slot] = i;
        for (std::size_t i = 0; i < sides.size();) {
            const std::size_t end = end_of_edge(sides, i);
            if (end - i == 2) {
                mates_[i] = static_cast<std::uint32_t>(i + 1);
                mates_[i + 1] = static_cast<std::uint32_t>(i);
            }
            i = end;
        }
    }
    /// The unit normal, as if the polygons on the way had the orientation of the side's own.
    Point3 normal(std::size_t i) const {
        double sign = 1.0;
        for (int step = 0; step < 8; ++step) {
            const PolygonSide& side = sides_[i];
            const std::uint32_t begin = mesh_.offsets[side.polygon];
            if (mesh_.offsets[side.polygon + 1] - begin != 3) break;
            const std::size_t next = slots_[begin + (side.slot - begin + 1) % 3],
                              last = slots_[begin + (side.slot - begin + 2) % 3];
            if (height(i, next, last) >= least_) break;
            const std::size_t out = length(next) >= length(last) ? next : last;
            if (mates_[out] == no_index) break;
            i = mates_[out];
            if (sides_[out].is_reversed == sides_[i].is_reversed) sign = -sign;
        }
        return sign * unit_normal(mesh_, sides_[i].polygon);
    }

private:
    const Point3& low(std::size_t i) const { return mesh_.positions[sides_[i].low]; }
    const Point3& high(std::size_t i) const { return mesh_.positions[sides_[i].high]; }
    double length(std::size_t i) const { return distance(low(i), high(i)); }
    /// Over the longest of a triangle's sides.
    double height(std::size_t i, std::size_t next, std::size_t last) const {
        const double longest = std::max({length(i), length(next), length(last)});
        return longest > 0.0 ? norm(cross(high(i) - low(i), high(next) - low(next))) / longest : 0.0;
    }

    const PolygonMesh& mesh_;
    const std::vector<PolygonSide>& sides_;
    double least_;
    std::vector<std::uint32_t> mates_, slots_;
};

std::vector<MarkedEdge> mark_edges(const PolygonMesh& mesh, const SurfaceCheckOptions& options) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> tagged;
    for (const Edge& edge : options.features) tagged.insert(std::minmax(index_of(edge[0]), index_of(edge[1])));
    const std::vector<PolygonSide> sides = sort_sides(mesh);
    const double limit = std::cos(options.feature_angle_radians);
    const BeyondSlivers beyond(mesh, sides);
    std::vector<MarkedEdge> marked;
    for (std::size_t i = 0; i < sides.size();) {
        const std::size_t end = end_of_edge(sides, i);
        const PolygonSide& side = sides[i];
        Mark mark = Mark::none;
        if (end - i != 2) {
            mark = Mark::boundary;
        } else if (tagged.count({side.low, side.high}) > 0) {
            mark = Mark::tagged;
        } else {
            const double sign = side.is_reversed == sides[i + 1].is_reversed ? -1.0 : 1.0;
            const auto is_sharp = [&](const Point3& n, const Point3& m) {
                return dot(n, n) > 0.0 && dot(m, m) > 0.0 && sign * dot(n, m) < limit;
            };
            if (is_sharp(unit_normal(mesh, side.polygon), unit_normal(mesh, sides[i + 1].polygon)) &&
                is_sharp(beyond.normal(i), beyond.normal(i + 1)))
                mark = Mark::angle;
        }
        marked.push_back({side.low, side.high, mark, distance(mesh.positions[side.low], mesh.positions[side.high])});
        i = end;
    }
    return marked;
}

/// Short groups of creases by angle that nothing else holds.
void forget_noise(const PolygonMesh& mesh, std::vector<MarkedEdge>& edges) {
    core::UnionFind groups(mesh.positions.size());
    double mean = 0.0;
    std::vector<double> lengths(mesh.positions.size(), 0.0);
    std::vector<bool> is_held(mesh.positions.size(), false);
    for (const MarkedEdge& edge : edges) {
        mean += edge.length / static_cast<double>(edges.size());
        if (edge.mark != Mark::none) groups.unite(edge.low, edge.high);
    }
    for (const MarkedEdge& edge : edges) {
        if (edge.mark == Mark::none) continue;
        lengths[groups.find(edge.low)] += edge.length;
        if (edge.mark != Mark::angle) is_held[groups.find(edge.low)] = true;
    }
    const double least = std::min(0.03 * diagonal_of(mesh), 12.0 * mean);
    for (MarkedEdge& edge : edges) {
        if (edge.mark != Mark::angle) continue;
        const std::uint32_t group = groups.find(edge.low);
        if (!is_held[group] && lengths[group] < least) edge.mark = Mark::none;
    }
}

}  // namespace

Creases find_creases(const PolygonMesh& mesh, const SurfaceCheckOptions& options) {
    std::vector<MarkedEdge> edges = mark_edges(mesh, options);
    forget_noise(mesh, edges);
    Creases creases;
    struct End {
        std::uint32_t vertex = 0, other = 0;
        bool is_boundary = false;
    };
    std::vector<End> ends;
    for (const MarkedEdge& edge : edges) {
        if (edge.mark == Mark::none) continue;
        creases.edges.push_back({edge.low, edge.high});
        ends.push_back({edge.low, edge.high, edge.mark == Mark::boundary});
        ends.push_back({edge.high, edge.low, edge.mark == Mark::boundary});
    }
    std::stable_sort(ends.begin(), ends.end(), [](const End& l, const End& r) { return l.vertex < r.vertex; });
    constexpr double cosine_of_turn = 0.70710678118654752;  // 45 degrees
    for (std::size_t i = 0; i < ends.size();) {
        std::size_t j = i;
        while (j < ends.size() && ends[j].vertex == ends[i].vertex) ++j;
        bool is_corner = j - i != 2;
        if (!is_corner) {
            const Point3& at = mesh.positions[ends[i].vertex];
            const Point3 in = at - mesh.positions[ends[i].other], out = mesh.positions[ends[i + 1].other] - at;
            is_corner =
                ends[i].is_boundary != ends[i + 1].is_boundary || dot(in, out) < cosine_of_turn * norm(in) * norm(out);
        }
        if (is_corner) creases.corners.push_back(ends[i].vertex);
        i = j;
    }
    return creases;
}

}  // namespace verify

SurfaceShape compute_surface_shape(const PolygonMesh& mesh) {
    using verify::PolygonSide;
    SurfaceShape shape;
    shape.polygons = mesh.offsets.size() - 1;
    for (std::size_t q = 0; q < shape.polygons; ++q) {
        shape.triangles += mesh.offsets[q + 1] - mesh.offsets[q] == 3;
        shape.quads += mesh.offsets[q + 1] - mesh.offsets[q] == 4;
    }
    const std::vector<PolygonSide> sides = verify::sort_sides(mesh);
    core::UnionFind parts(shape.polygons), fans(mesh.corners.size()), rims(mesh.corners.size());
    const auto slot_at = [&](const PolygonSide& side, bool is_high) {  // the side's corner at its high or low vertex
        return side.is_reversed == is_high ? side.slot : side.next_slot;
    };
    for (std::size_t i = 0; i < sides.size();) {
        const std::size_t end = verify::end_of_edge(sides, i);
        ++shape.edges;
        shape.boundary_edges += end - i == 1;
        shape.non_manifold_edges += end - i > 2;
        shape.inconsistent_edges += end - i == 2 && sides[i].is_reversed == sides[i + 1].is_reversed;
        for (std::size_t j = i + 1; j < end; ++j) {
            parts.unite(sides[i].polygon, sides[j].polygon);
            for (const bool is_high : {false, true}) fans.unite(slot_at(sides[i], is_high), slot_at(sides[j], is_high));
        }
        i = end;
    }
    std::vector<std::uint32_t> component(shape.polygons, no_index), fans_of(mesh.positions.size(), 0);
    for (std::uint32_t q = 0; q < shape.polygons; ++q) {
        const std::uint32_t root = parts.find(q);
        if (component[root] == no_index) {
            component[root] = static_cast<std::uint32_t>(shape.components.size());
            shape.components.emplace_back();
        }
        component[q] = component[root];
        ComponentShape& part = shape.components[component[q]];
        ++part.euler_characteristic;
        for (std::uint32_t i = mesh.offsets[q]; i < mesh.offsets[q + 1]; ++i) {
            if (fans.find(i) != i) continue;
            ++part.euler_characteristic;
            ++fans_of[index_of(mesh.corners[i])];
        }
    }
    for (const std::uint32_t count : fans_of) {
        shape.vertices += count > 0;
        shape.non_manifold_vertices += count > 1;
    }
    // Rims: fans joined along boundary edges; a loop is a set of at least two.
    std::vector<std::uint32_t> rim_slots;
    for (std::size_t i = 0; i < sides.size();) {
        const std::size_t end = verify::end_of_edge(sides, i);
        --shape.components[component[sides[i].polygon]].euler_characteristic;
        if (end - i == 1) {
            const std::uint32_t a = fans.find(sides[i].slot), b = fans.find(sides[i].next_slot);
            rims.unite(a, b);
            rim_slots.push_back(a);
        }
        i = end;
    }
    std::vector<std::uint32_t> polygon_of(mesh.corners.size());
    for (std::uint32_t q = 0; q < shape.polygons; ++q)
        for (std::uint32_t i = mesh.offsets[q]; i < mesh.offsets[q + 1]; ++i) polygon_of[i] = q;
    std::set<std::uint32_t> loops;
    for (const std::uint32_t slot : rim_slots)
        if (loops.insert(rims.find(slot)).second) ++shape.components[component[polygon_of[slot]]].boundary_loops;
    shape.boundary_loops = loops.size();
    for (ComponentShape& part : shape.components)
        part.genus = (2 - part.euler_characteristic - static_cast<std::int64_t>(part.boundary_loops)) / 2;
    std::sort(shape.components.begin(), shape.components.end(), [](const ComponentShape& l, const ComponentShape& r) {
        if (l.genus != r.genus) return l.genus < r.genus;
        if (l.boundary_loops != r.boundary_loops) return l.boundary_loops < r.boundary_loops;
        return l.euler_characteristic < r.euler_characteristic;
    });
    return shape;
}

}  // namespace certa
