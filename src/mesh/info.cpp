// Counts, box and surface topology of a document (include/certa/info.h).
// Plan: half-edges of all polygons are sorted by their vertex pair, so that the polygons around an edge are neighbours;
// union-find over corners gives fans (non-manifold vertices), over polygons components, and over polygons with a parity
// bit whether orientations can be made to agree. Tetrahedra are measured in info_tetrahedra.cpp.
#include <certa/info.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/union_find.h"
#include "core/vector3.h"
#include "mesh/info_parts.h"

namespace certa {
namespace {

/// One side of a polygon, from its corner `corner` to the next.
struct HalfEdge {
    std::uint32_t low, high;  // vertices in increasing order
    std::uint32_t polygon;
    std::uint32_t corner, next_corner;  // indices into complex.corners
    bool forward;                       // walked from low to high
};

/// Union-find where every element also knows its parity relative to the root.
class ParityForest {
public:
    explicit ParityForest(std::size_t size) : parent_(size), parity_(size, 0) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }
    /// Declares the parity between a and b; false if it contradicts what is known.
    bool join(std::uint32_t a, std::uint32_t b, bool differ) {
        const auto [root_a, parity_a] = find(a);
        const auto [root_b, parity_b] = find(b);
        if (root_a == root_b) return (parity_a != parity_b) == differ;
        parent_[root_b] = root_a;
        parity_[root_b] = static_cast<unsigned char>((parity_a != parity_b) != differ);
        return true;
    }

private:
    std::pair<std::uint32_t, bool> find(std::uint32_t i) {
        std::uint32_t root = i;
        unsigned char parity = 0;
        while (parent_[root] != root) {
            parity ^= parity_[root];
            root = parent_[root];
        }
        unsigned char rest = parity;
        while (parent_[i] != i) {  // path compression: every element on the way points to the root
            const std::uint32_t next = parent_[i];
            const unsigned char step = parity_[i];
            parent_[i] = root;
            parity_[i] = rest;
            rest ^= step;
            i = next;
        }
        return {root, parity != 0};
    }
    std::vector<std::uint32_t> parent_;
    std::vector<unsigned char> parity_;
};

std::span<const VertexId> corners_of(const PiecewiseLinearComplex& complex, std::size_t polygon) {
    return {complex.corners.data() + complex.polygon_offsets[polygon],
            complex.corners.data() + complex.polygon_offsets[polygon + 1]};
}

std::vector<HalfEdge> sorted_half_edges(const PiecewiseLinearComplex& complex) {
    std::vector<HalfEdge> edges;
    edges.reserve(complex.corners.size());
    for (std::uint32_t p = 0; p < complex.polygon_count(); ++p) {
        const std::uint32_t first = complex.polygon_offsets[p], end = complex.polygon_offsets[p + 1];
        if (end - first < 3) continue;
        for (std::uint32_t c = first; c < end; ++c) {
            const std::uint32_t next = c + 1 < end ? c + 1 : first;
            const std::uint32_t a = index_of(complex.corners[c]), b = index_of(complex.corners[next]);
            if (a != b) edges.push_back({std::min(a, b), std::max(a, b), p, c, next, a < b});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& s, const HalfEdge& t) {
        return std::pair(s.low, s.high) != std::pair(t.low, t.high)
                   ? std::pair(s.low, s.high) < std::pair(t.low, t.high)
                   : s.corner < t.corner;
    });
    return edges;
}

/// Joins what meets at an edge: corners into fans, polygons into components and orientations.
struct Joins {
    explicit Joins(const PiecewiseLinearComplex& complex)
        : fans(complex.corners.size()),
          polygons(complex.polygon_count()),
          orientations(complex.polygon_count()),
          boundary(complex.positions.size()) {}
    core::UnionFind fans, polygons;
    ParityForest orientations;
    core::UnionFind boundary;  // vertices, along boundary edges
    bool orientations_agree = true;
};

void join_at_edge(std::span<const HalfEdge> around, Joins& joins, SurfaceInfo& info) {
    ++info.edges;
    const HalfEdge& first = around[0];
    if (around.size() == 1) {
        ++info.boundary_edges;
        joins.boundary.unite(first.low, first.high);
    } else if (around.size() > 2) {
        ++info.non_manifold_edges;
    } else {
        const HalfEdge& second = around[1];
        const bool same_direction = first.forward == second.forward;
        if (same_direction) ++info.inconsistent_edges;
        if (!joins.orientations.join(first.polygon, second.polygon, same_direction)) joins.orientations_agree = false;
    }
    const auto corner_at_low = [](const HalfEdge& e) { return e.forward ? e.corner : e.next_corner; };
    const auto corner_at_high = [](const HalfEdge& e) { return e.forward ? e.next_corner : e.corner; };
    for (const HalfEdge& other : around.subspan(1)) {
        joins.polygons.unite(first.polygon, other.polygon);
        joins.fans.unite(corner_at_low(first), corner_at_low(other));
        joins.fans.unite(corner_at_high(first), corner_at_high(other));
    }
}

/// Vertices used by polygons, and those among them with more than one fan.
void count_fans(const PiecewiseLinearComplex& complex, core::UnionFind& fans, SurfaceInfo& info) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> vertex_fans;  // (vertex, representative corner)
    vertex_fans.reserve(complex.corners.size());
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const std::uint32_t first = complex.polygon_offsets[p], end = complex.polygon_offsets[p + 1];
        for (std::uint32_t c = first; c < end && end - first >= 3; ++c)
            vertex_fans.emplace_back(index_of(complex.corners[c]), fans.find(c));
    }
    std::sort(vertex_fans.begin(), vertex_fans.end());
    vertex_fans.erase(std::unique(vertex_fans.begin(), vertex_fans.end()), vertex_fans.end());
    for (std::size_t i = 0; i < vertex_fans.size();) {
        std::size_t j = i;
        while (j < vertex_fans.size() && vertex_fans[j].first == vertex_fans[i].first) ++j;
        ++info.vertices;
        if (j - i > 1) ++info.non_manifold_vertices;
        i = j;
    }
}

void count_polygons(const PiecewiseLinearComplex& complex, core::UnionFind& components, SurfaceInfo& info) {
    std::vector<std::vector<std::uint32_t>> vertex_sets;
    for (std::uint32_t p = 0; p < complex.polygon_count(); ++p) {
        const auto corners = corners_of(complex, p);
        if (corners.size() < 3) continue;
        ++info.polygons;
        if (components.find(p) == p) ++info.components;
        info.smallest_degree = info.polygons == 1 ? corners.size() : std::min(info.smallest_degree, corners.size());
        info.largest_degree = std::max(info.largest_degree, corners.size());
        std::vector<std::uint32_t> vertices(corners.size());
        std::transform(corners.begin(), corners.end(), vertices.begin(), index_of<VertexId>);
        std::sort(vertices.begin(), vertices.end());
        vertex_sets.push_back(std::move(vertices));
    }
    std::sort(vertex_sets.begin(), vertex_sets.end());
    for (std::size_t i = 1; i < vertex_sets.size(); ++i) info.repeated_polygons += vertex_sets[i] == vertex_sets[i - 1];
}

/// Area of all polygons and the volume that they would enclose, measured from the box's centre to keep digits.
void measure_polygons(const PiecewiseLinearComplex& complex, const Point3& centre, SurfaceInfo& info, double& volume) {
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const auto corners = corners_of(complex, p);
        if (corners.size() < 3) continue;
        const Point3 a = complex.positions[index_of(corners[0])];
        Point3 doubled{};
        for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
            const Point3 b = complex.positions[index_of(corners[i])], c = complex.positions[index_of(corners[i + 1])];
            doubled = doubled + cross(b - a, c - a);
            volume += dot(a - centre, cross(b - centre, c - centre)) / 6.0;
        }
        info.area += norm(doubled) / 2.0;
    }
}

bool has_facets_of_several_polygons(const PiecewiseLinearComplex& complex) {
    for (std::size_t f = 0; f < complex.facet_count(); ++f)
        if (complex.facet_offsets[f + 1] - complex.facet_offsets[f] > 1) return true;
    return false;
}

SurfaceInfo compute_surface_info(const PiecewiseLinearComplex& complex, const Point3& centre) {
    SurfaceInfo info;
    Joins joins(complex);
    const std::vector<HalfEdge> edges = sorted_half_edges(complex);
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t j = i;
        while (j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high) ++j;
        join_at_edge(std::span(edges).subspan(i, j - i), joins, info);
        i = j;
    }
    count_fans(complex, joins.fans, info);
    count_polygons(complex, joins.polygons, info);
    std::vector<std::uint32_t> loops;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const bool alone =
            (i == 0 || edges[i - 1].low != edges[i].low || edges[i - 1].high != edges[i].high) &&
            (i + 1 == edges.size() || edges[i + 1].low != edges[i].low || edges[i + 1].high != edges[i].high);
        if (alone) loops.push_back(joins.boundary.find(edges[i].low));
    }
    std::sort(loops.begin(), loops.end());
    info.boundary_loops = static_cast<std::size_t>(std::unique(loops.begin(), loops.end()) - loops.begin());

    double volume = 0.0;
    measure_polygons(complex, centre, info, volume);
    info.closed = info.polygons > 0 && info.boundary_edges == 0;
    info.manifold = info.polygons > 0 && info.non_manifold_edges == 0 && info.non_manifold_vertices == 0;
    info.orientable = info.manifold && joins.orientations_agree;
    if (info.closed && info.non_manifold_edges == 0 && info.inconsistent_edges == 0) info.volume = volume;
    if (info.polygons > 0 && !has_facets_of_several_polygons(complex)) {
        const auto signed_count = [](std::size_t n) { return static_cast<std::int64_t>(n); };
        info.euler_characteristic =
            signed_count(info.vertices) - signed_count(info.edges) + signed_count(info.polygons);
        // chi = sum over components of (2 - 2 genus - loops)
        if (info.orientable)
            info.genus =
                (2 * signed_count(info.components) - signed_count(info.boundary_loops) - *info.euler_characteristic) /
                2;
    }
    return info;
}

void compute_box(const std::vector<Point3>& points, DocumentInfo& info) {
    if (points.empty()) return;
    info.lower = info.upper = points.front();
    for (const Point3& p : points) {
        info.lower = {std::min(info.lower.x, p.x), std::min(info.lower.y, p.y), std::min(info.lower.z, p.z)};
        info.upper = {std::max(info.upper.x, p.x), std::max(info.upper.y, p.y), std::max(info.upper.z, p.z)};
    }
    info.diagonal = distance(info.lower, info.upper);
}

void count_points(const MeshDocument& document, DocumentInfo& info) {
    const PiecewiseLinearComplex& complex = document.complex;
    std::vector<bool> used(complex.positions.size(), false);
    const auto use = [&](VertexId v) { used[index_of(v)] = true; };
    for (const VertexId v : complex.corners) use(v);
    for (const Edge& e : complex.segments) std::for_each(e.begin(), e.end(), use);
    for (const Tetrahedron& t : document.tetrahedra) std::for_each(t.begin(), t.end(), use);
    info.points = complex.positions.size();
    info.unused_points = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));

    std::vector<Point3> sorted = complex.positions;
    const auto key = [](const Point3& p) { return std::array{p.x, p.y, p.z}; };
    std::sort(sorted.begin(), sorted.end(), [&](const Point3& a, const Point3& b) { return key(a) < key(b); });
    for (std::size_t i = 1; i < sorted.size(); ++i) info.duplicate_points += sorted[i] == sorted[i - 1];
}

}  // namespace

DocumentInfo compute_info(const MeshDocument& document) {
    const PiecewiseLinearComplex& complex = document.complex;
    DocumentInfo info;
    compute_box(complex.positions, info);
    count_points(document, info);
    info.segments = complex.segments.size();
    info.facets = complex.facet_count();
    info.facet_holes = complex.facet_holes.size();
    info.region_holes = complex.region_holes.size();
    info.region_seeds = complex.region_seeds.size();
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const std::size_t degree = corners_of(complex, p).size();
        info.isolated_points += degree == 1;
        info.isolated_segments += degree == 2;
    }
    const Point3 centre = 0.5 * (info.lower + info.upper);
    info.surface = compute_surface_info(complex, centre);
    info.tetrahedra = mesh::compute_tetrahedra_info(document);
    return info;
}

}  // namespace certa
