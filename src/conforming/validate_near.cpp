// Within rounding, but not touching: points near segments and facets, segments that run along facets.
//
// Decided in doubles, with a tolerance of 16 units in the last place of the coordinates at hand (plus, for a facet,
// what its own points deviate from its plane): see docs/limitations.md for what that means. For two triangles, nearly
// always neighbours in one plane, the signed distances of one's corners from the other's sides settle the matter.
#include "conforming/validate_near.h"

#include <algorithm>
#include <cmath>

#include "core/vector3.h"
#include "exact/orientation.h"

namespace certa::conforming {
namespace {

using exact::drop_axis;
using exact::orient2d;
using exact::orient3d;
using exact::Point2;

bool has_side(const Complex& complex, std::uint32_t segment, std::uint32_t facet) {
    const auto facets = complex.segment_facets[segment];
    return std::binary_search(facets.begin(), facets.end(), facet);
}

/// Both lists ascending.
bool have_common(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        if (a[i] == b[j]) return true;
        a[i] < b[j] ? ++i : ++j;
    }
    return false;
}

/// Distance of p from segment ab when it is nearest to its inside, further than `near` from the ends.
std::optional<double> distance_to_inside(const Point3& a, const Point3& b, const Point3& p, double near) {
    const Point3 d = b - a, e = p - a;
    const double t = dot(e, d) / dot(d, d);
    if (!(t > 0.0 && t < 1.0) || norm(e) <= near || distance(p, b) <= near) return std::nullopt;
    return norm(e - t * d);
}

/// A point in the plane of a frame.
Point2 flat(const Frame& frame, const Point3& p) {
    const Point3 d = p - frame.origin;
    return {dot(d, frame.u), dot(d, frame.v)};
}

/// Signed distances of three points from the sides of a triangle, in its owner's frame, positive inside.
struct Depths {
    std::array<std::array<double, 3>, 3> from_side{};

    /// A side has all points outside, or inside by no more than `near`.
    bool are_separated(double near) const {
        return std::any_of(from_side.begin(), from_side.end(),
                           [&](const auto& d) { return d[0] <= near && d[1] <= near && d[2] <= near; });
    }
    bool may_be_near_side(int point, double near) const {
        return std::any_of(from_side.begin(), from_side.end(),
                           [&](const auto& d) { return std::abs(d[point]) <= near; });
    }
};

class NearTester {
public:
    NearTester(const Complex& complex, const Pieces& pieces, std::vector<Finding>& findings)
        : complex_(complex), pieces_(pieces), findings_(findings) {}

    void test_triangles(std::uint32_t a, std::uint32_t b) {
        const double near = std::max(pieces_.near[pieces_.owners[a]], pieces_.near[pieces_.owners[b]]);
        const auto b_close = close_corners(a, b), a_close = close_corners(b, a);
        const auto any = [](const std::array<bool, 3>& close) { return close[0] || close[1] || close[2]; };
        if (!any(b_close) && !any(a_close)) return;
        const Depths in_a = depths(a, b), in_b = depths(b, a);
        const bool apart = in_a.are_separated(near) || in_b.are_separated(near);
        test_triangle(a, b, b_close, &in_a, near, apart);
        test_triangle(b, a, a_close, &in_b, near, apart);
    }

    /// Pairs of which at least one is no triangle.
    void test_others(std::uint32_t a, std::uint32_t b) {
        const Simplex& s = pieces_.simplices[a];
        if (s.size == 1) return;
        if (s.size == 3) {
            test_triangle(a, b, close_corners(a, b), nullptr, 0.0, false);
            return;
        }
        for (int i = 0; i < pieces_.simplices[b].size; ++i) {
            const std::uint32_t v = pieces_.simplices[b].vertices[i];
            if (v != s.vertices[0] && v != s.vertices[1]) is_near_sides(a, b, v);
        }
    }

private:
    const Point3& at(std::uint32_t v) const { return complex_.points[v]; }
    const Frame& frame_of(std::uint32_t piece) const { return complex_.frames[pieces_.owners[piece]]; }

    void found(FindingKind kind, std::uint32_t first, std::uint32_t second, std::uint32_t a, std::uint32_t b) {
        findings_.push_back({kind, first, second, std::min(a, b), std::max(a, b)});
    }

    /// Which corners of b are within rounding of the plane of a.
    std::array<bool, 3> close_corners(std::uint32_t a, std::uint32_t b) const {
        const Frame& frame = frame_of(a);
        const double near = pieces_.near[pieces_.owners[a]];
        std::array<bool, 3> close{};
        for (int i = 0; i < pieces_.simplices[b].size; ++i) {
            close[i] = std::abs(dot(at(pieces_.simplices[b].vertices[i]) - frame.origin, frame.normal)) <= near;
        }
        return close;
    }

    Depths depths(std::uint32_t a, std::uint32_t b) const {
        const Frame& frame = frame_of(a);
        std::array<Point2, 3> t, p;
        for (int i = 0; i < 3; ++i) {
            t[i] = flat(frame, at(pieces_.simplices[a].vertices[i]));
            p[i] = flat(frame, at(pieces_.simplices[b].vertices[i]));
        }
        Depths result;
        for (int i = 0; i < 3; ++i) {
            const double dx = t[(i + 1) % 3].x - t[i].x, dy = t[(i + 1) % 3].y - t[i].y;
            const double scale = 1.0 / std::sqrt(dx * dx + dy * dy);
            for (int j = 0; j < 3; ++j) {
                result.from_side[i][j] = scale * (dx * (p[j].y - t[i].y) - dy * (p[j].x - t[i].x));
            }
        }
        return result;
    }

    /// Corners and sides of b against triangle a; `apart`: nothing of b is over the inside of a.
    void test_triangle(std::uint32_t a, std::uint32_t b, const std::array<bool, 3>& close, const Depths* depths,
                       double near, bool apart) {
        const Simplex &s = pieces_.simplices[a], &other = pieces_.simplices[b];
        for (int i = 0; i < other.size; ++i) {
            const std::uint32_t v = other.vertices[i];
            if (!close[i] || v == s.vertices[0] || v == s.vertices[1] || v == s.vertices[2]) continue;
            const bool sideways = depths == nullptr || depths->may_be_near_side(i, near);
            const bool near_side = sideways && is_near_sides(a, b, v);
            if (!near_side && !apart) test_above(a, b, v);
        }
        if (apart) return;
        for (int i = 0; i < (other.size == 3 ? 3 : other.size - 1); ++i) {
            const int j = i + 1 < other.size ? i + 1 : 0;
            if (close[i] && close[j]) test_along(a, b, static_cast<Feature>(first_edge + i));
        }
    }

    /// Reports v when it is within rounding of a side of a; true when it is near any, or near a corner.
    bool is_near_sides(std::uint32_t a, std::uint32_t b, std::uint32_t v) {
        const Simplex& s = pieces_.simplices[a];
        bool result = false;
        for (int i = 0; i < (s.size == 3 ? 3 : 1); ++i) {
            const auto edge = static_cast<Feature>(first_edge + i);
            const auto ends = ends_of(s, edge);
            const double near = near_of(complex_.points, ends);
            result = result || distance(at(ends[0]), at(v)) <= near;
            const auto d = distance_to_inside(at(ends[0]), at(ends[1]), at(v), near);
            if (!d || *d > near) continue;
            const std::uint32_t side = side_along(complex_, pieces_, a, edge);
            if (side == no_index) continue;
            result = true;
            // A facet that has both, such as a very flat triangle, says what is meant.
            if (have_common(complex_.point_facets[v], complex_.segment_facets[side])) continue;
            if (exact::is_between(at(ends[0]), at(ends[1]), at(v))) continue;
            found(FindingKind::point_near_segment, v, side, a, b);
        }
        return result;
    }

    /// v is within rounding of the plane of triangle a and of none of its sides: is it over the inside?
    void test_above(std::uint32_t a, std::uint32_t b, std::uint32_t v) {
        const std::uint32_t facet = pieces_.owners[a];
        const auto own = complex_.point_facets[v];
        if (std::binary_search(own.begin(), own.end(), facet)) return;
        const auto& t = pieces_.simplices[a].vertices;
        if (orient3d(at(t[0]), at(t[1]), at(t[2]), at(v)) == 0) return;  // exactly on the plane: no matter of rounding
        const int axis = faithful_axis(at(t[0]), at(t[1]), at(t[2]));
        const auto seen = [&](std::uint32_t w) { return drop_axis(at(w), axis); };
        const int turn = orient2d(seen(t[0]), seen(t[1]), seen(t[2]));
        for (int i = 0; i < 3; ++i) {
            if (turn * orient2d(seen(t[i]), seen(t[(i + 1) % 3]), seen(v)) < 0) return;
        }
        found(FindingKind::point_near_facet, v, facet, a, b);
    }

    /// A side of b both ends of which are within rounding of the plane of triangle a: does it run over the inside?
    void test_along(std::uint32_t a, std::uint32_t b, Feature edge) {
        const std::uint32_t facet = pieces_.owners[a];
        const auto ends = ends_of(pieces_.simplices[b], edge);
        const auto& t = pieces_.simplices[a].vertices;
        const auto is_on_plane = [&](std::uint32_t v) { return orient3d(at(t[0]), at(t[1]), at(t[2]), at(v)) == 0; };
        if (is_on_plane(ends[0]) && is_on_plane(ends[1])) return;  // no matter of rounding
        if (!clip_to_piece(complex_, pieces_, a, ends, pieces_.near[facet])) return;
        const std::uint32_t side = side_along(complex_, pieces_, b, edge);
        if (side == no_index || has_side(complex_, side, facet)) return;
        found(FindingKind::segment_near_facet, side, facet, a, b);
    }

    const Complex& complex_;
    const Pieces& pieces_;
    std::vector<Finding>& findings_;
};

}  // namespace

void find_near(const Complex& complex, const Pieces& pieces, std::uint32_t piece_a, std::uint32_t piece_b,
               std::vector<Finding>& findings) {
    NearTester tester(complex, pieces, findings);
    if (pieces.simplices[piece_a].size == 3 && pieces.simplices[piece_b].size == 3) {
        tester.test_triangles(piece_a, piece_b);
    } else {
        tester.test_others(piece_a, piece_b);
        tester.test_others(piece_b, piece_a);
    }
}

std::optional<Point3> clip_to_piece(const Complex& complex, const Pieces& pieces, std::uint32_t piece,
                                    const std::array<std::uint32_t, 2>& ends, double near) {
    const Frame& frame = complex.frames[pieces.owners[piece]];
    const Point2 p = flat(frame, complex.points[ends[0]]), q = flat(frame, complex.points[ends[1]]);
    double from = 0.0, to = 1.0;
    for (int i = 0; i < 3; ++i) {
        const auto edge = static_cast<Feature>(first_edge + i);
        const auto [v, w] = ends_of(pieces.simplices[piece], edge);
        const Point2 c = flat(frame, complex.points[v]), d = flat(frame, complex.points[w]);
        const double length = std::sqrt((d.x - c.x) * (d.x - c.x) + (d.y - c.y) * (d.y - c.y));
        const auto depth = [&](const Point2& x) {
            return ((d.x - c.x) * (x.y - c.y) - (d.y - c.y) * (x.x - c.x)) / length;
        };
        const double margin = side_along(complex, pieces, piece, edge) == no_index ? 0.0 : near;
        const double start = depth(p) - margin, stop = depth(q) - margin;
        if (start <= 0.0 && stop <= 0.0) return std::nullopt;
        if (start < 0.0) from = std::max(from, start / (start - stop));
        if (stop < 0.0) to = std::min(to, start / (start - stop));
    }
    if (!(to - from > 1e-12)) return std::nullopt;
    const double t = 0.5 * (from + to);
    return (1.0 - t) * complex.points[ends[0]] + t * complex.points[ends[1]];
}

}  // namespace certa::conforming
