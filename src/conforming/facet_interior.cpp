// What facets cover of their planes (thesis, Part I, 1.1.3: "sectors which are included in the complex").
//
// A triangle facet is its own triangulation. Any other facet gets a constrained Delaunay triangulation of its points
// along the coordinate axis that sees it largest (exact on the input's doubles); a flood fill from infinity that
// changes sides at every boundary side separates inside from outside. Both give, per side, where the facet lies;
// gathered by segment these are the sheets.
#include "conforming/facet_interior.h"

#include <certa/error.h>

#include <algorithm>
#include <optional>
#include <string>

#include "delaunay/flat_facet.h"
#include "delaunay/planar.h"
#include "exact/orientation.h"

namespace certa::conforming {

using delaunay::Projection;
using exact::Point2;
namespace {

using PointTriangle = std::array<std::uint32_t, 3>;

[[noreturn]] void fail(std::uint32_t facet, const char* what) {
    throw InternalError("facet " + std::to_string(facet + 1) + " " + what +
                        " although the complex was validated; please report this");
}

/// The third corner of a facet whose sides are the three boundary sides of a triangle.
std::optional<PointTriangle> corners_of(const Complex& complex, std::uint32_t facet) {
    const auto sides = complex.facet_sides[facet];
    if (sides.size() != 3 || complex.facet_points[facet].size() != 0) return std::nullopt;
    const auto& first = complex.segments[sides[0].segment];
    const auto& second = complex.segments[sides[1].segment];
    const std::uint32_t third = second[0] == first[0] || second[0] == first[1] ? second[1] : second[0];
    if (third == first[0] || third == first[1]) return std::nullopt;
    for (const Side& side : sides) {
        if (!side.boundary) return std::nullopt;
        for (const std::uint32_t v : complex.segments[side.segment]) {
            if (v != first[0] && v != first[1] && v != third) return std::nullopt;
        }
    }
    return PointTriangle{first[0], first[1], third};
}

int orientation(const Complex& complex, const Projection& projection, const PointTriangle& t) {
    std::array<exact::Point2, 3> p;
    for (int i = 0; i < 3; ++i) {
        const Point2 q = projection(complex.points[t[i]]);
        p[i] = {q.x, q.y};
    }
    return exact::orient2d(p[0], p[1], p[2]);
}

void cover_triangle(const Complex& complex, std::uint32_t facet, const PointTriangle& t, FacetInterior& result) {
    for (const Side& side : complex.facet_sides[facet]) {
        const auto& ends = complex.segments[side.segment];
        const auto at = std::find(t.begin(), t.end(), ends[0]) - t.begin();
        result.side_covers.push_back(t[(at + 1) % 3] == ends[1] ? cover_left : cover_right);
    }
    result.triangles.push_row(std::span<const PointTriangle>(&t, 1));
}

void cover_region(const Complex& complex, std::uint32_t facet, FacetInterior& result) {
    const auto sides = complex.facet_sides[facet];
    std::vector<std::uint32_t> ids(complex.facet_points[facet].begin(), complex.facet_points[facet].end());
    for (const Side& side : sides) {
        ids.insert(ids.end(), complex.segments[side.segment].begin(), complex.segments[side.segment].end());
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    const auto local = [&](std::uint32_t id) {
        return static_cast<std::uint32_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
    };
    const Projection projection(complex.frames[facet].normal);
    std::vector<delaunay::PlanarPoint> points;
    for (const std::uint32_t id : ids) {
        const Point2 p = projection(complex.points[id]);
        points.push_back({p.x, p.y});
    }
    std::vector<delaunay::PlanarEdge> edges;
    for (const Side& side : sides) {
        const auto& [a, b] = complex.segments[side.segment];
        edges.push_back({local(a), local(b), side.boundary});
    }
    const delaunay::PlanarTriangulation region = delaunay::triangulate_region(points, edges);
    if (!region.valid) fail(facet, "has sides that cross or no area");
    if (region.triangles.empty()) fail(facet, "encloses nothing");

    std::vector<std::uint64_t> directed;  // edges of inside triangles, which lie to their left
    std::vector<PointTriangle> inside;
    for (const auto& t : region.triangles) {
        inside.push_back({ids[t[0]], ids[t[1]], ids[t[2]]});
        for (int i = 0; i < 3; ++i) directed.push_back(std::uint64_t{t[i]} << 32 | t[(i + 1) % 3]);
    }
    std::sort(directed.begin(), directed.end());
    const auto has = [&](std::uint32_t a, std::uint32_t b) {
        return std::binary_search(directed.begin(), directed.end(), std::uint64_t{a} << 32 | b);
    };
    for (const auto& e : edges) {
        result.side_covers.push_back(
            static_cast<std::uint8_t>((has(e.a, e.b) ? cover_left : 0) | (has(e.b, e.a) ? cover_right : 0)));
    }
    result.triangles.push_row(inside);
}

void gather_sheets(const Complex& complex, FacetInterior& result) {
    auto& offsets = result.sheets.offsets;
    offsets.assign(complex.segments.size() + 1, 0);
    for (const Side& side : complex.facet_sides.values) ++offsets[side.segment + 1];
    for (std::size_t s = 0; s < complex.segments.size(); ++s) offsets[s + 1] += offsets[s];
    result.sheets.values.resize(complex.facet_sides.values.size());
    std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
    for (std::uint32_t f = 0; f < complex.facet_sides.size(); ++f) {
        for (std::uint32_t i = complex.facet_sides.offsets[f]; i < complex.facet_sides.offsets[f + 1]; ++i) {
            result.sheets.values[next[complex.facet_sides.values[i].segment]++] = {f, result.side_covers[i]};
        }
    }
}

}  // namespace

std::optional<PointTriangle> triangle_of(const Complex& complex, std::uint32_t facet) {
    std::optional<PointTriangle> t = corners_of(complex, facet);
    if (!t) return std::nullopt;
    const int turn = orientation(complex, Projection(complex.frames[facet].normal), *t);
    if (turn == 0) return std::nullopt;
    if (turn < 0) std::swap((*t)[0], (*t)[1]);
    return t;
}

FacetInterior build_facet_interior(const Complex& complex) {
    FacetInterior result;
    result.side_covers.reserve(complex.facet_sides.values.size());
    for (std::uint32_t f = 0; f < complex.facet_sides.size(); ++f) {
        if (complex.facet_sides[f].empty()) {
            result.triangles.push_row({});  // merged into another one
        } else if (const auto triangle = triangle_of(complex, f)) {
            cover_triangle(complex, f, *triangle, result);
        } else {
            cover_region(complex, f, result);
        }
    }
    gather_sheets(complex, result);
    return result;
}

}  // namespace certa::conforming
