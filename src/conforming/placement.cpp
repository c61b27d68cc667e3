// The rules that decide how many points a mesh needs. Near an acute corner every cut copies a distance that is there
// already, so that cuts on neighbouring segments answer each other instead of cascading; a point that disturbs a facet
// is answered by its mirror image in the facet, rotated about their common line, which lies no farther from anything in
// the facet than the point itself does (the mirror lemma).
#include "conforming/placement.h"

#include <algorithm>
#include <cmath>

#include "core/vector3.h"
#include "delaunay/planar.h"

namespace certa::conforming {
namespace {

using delaunay::PlanarPoint;

constexpr std::uint8_t first_acute = 1, second_acute = 2, known = 4;
constexpr double margin = 0.1;  // of a piece: nearer to its ends no copied distance is used

double turn(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The power of two nearest to `length` in ratio.
double shell_near(double length) { return std::exp2(std::round(std::log2(length))); }

}  // namespace

Placement::Placement(const MeshState& mesh, SplitRule rule)
    : mesh_(mesh), rule_(rule), acute_(mesh.complex.segments.size(), 0) {}

bool Placement::is_acute(std::uint32_t segment, std::uint32_t end) const {
    const Complex& c = mesh_.complex;
    const auto other_end = [&](std::uint32_t s) { return c.segments[s][c.segments[s][0] == end ? 1 : 0]; };
    const Point3 direction = c.points[other_end(segment)] - c.points[end];
    const auto neighbors = c.point_segments[end];
    return std::any_of(neighbors.begin(), neighbors.end(), [&](std::uint32_t s) {
        if (s == segment) return false;
        const Point3 d = c.points[other_end(s)] - c.points[end];
        return dot(direction, d) > 1e-12 * norm(direction) * norm(d);
    });
}

std::uint8_t Placement::acute_ends(std::uint32_t segment) {
    std::uint8_t& ends = acute_[segment];
    if (ends == 0) {
        const auto& [a, b] = mesh_.complex.segments[segment];
        ends = static_cast<std::uint8_t>(known | (is_acute(segment, a) ? first_acute : 0) |
                                         (is_acute(segment, b) ? second_acute : 0));
    }
    return ends;
}

Point3 Placement::split_of(const Piece& piece, const Point3* reference) {
    const auto& [first, second] = mesh_.complex.segments[piece.owner];
    const Point3 &a = mesh_.complex.points[first], &b = mesh_.complex.points[second];
    const Point3 direction = b - a;
    const double length = norm(direction);
    const double low = mesh_.parameter_of(piece.owner, piece.a), high = mesh_.parameter_of(piece.owner, piece.b);
    const auto at = [&](double t) {
        return t < 0.5 * length ? a + (t / length) * direction : b - ((length - t) / length) * direction;
    };
    const auto fits = [&](double t) { return t > low + margin * (high - low) && t < high - margin * (high - low); };
    const double middle = low + 0.5 * (high - low);
    if (reference == nullptr) return at(middle);
    const double begin = piece.from == no_index ? 0.0 : mesh_.parameter_of(piece.owner, piece.from);
    const double end = piece.to == no_index ? length : mesh_.parameter_of(piece.owner, piece.to);
    if (rule_ == SplitRule::middle_first && low == begin && high == end) return at(middle);
    const std::uint8_t ends = acute_ends(piece.owner);
    const bool acute_begin = piece.from != no_index || (ends & first_acute) != 0;
    const bool acute_end = piece.to != no_index || (ends & second_acute) != 0;
    const double from_begin = distance(*reference, at(begin)), from_end = distance(*reference, at(end));
    const bool use_first = acute_begin && (!acute_end || from_begin <= from_end);
    const bool use_second = acute_end && !use_first;
    double t = middle;
    if (use_first) {
        t = begin + from_begin;
    } else if (use_second) {
        t = end - from_end;
    } else {
        t = dot(*reference - a, direction) / length;
    }
    const bool copied = rule_ != SplitRule::shells || !(use_first || use_second);
    if (copied && fits(t)) return at(t);
    if (use_first) {
        t = begin + shell_near(middle - begin);
    } else if (use_second) {
        t = end - shell_near(end - middle);
    }
    return at(fits(t) ? t : middle);
}

std::optional<Point3> Placement::crossing_of(const Piece& piece, std::uint32_t f, std::uint32_t witness) const {
    const Complex& c = mesh_.complex;
    std::vector<std::uint32_t> segments;
    if (witness < c.points.size()) {
        const auto row = c.point_segments[witness];
        segments.assign(row.begin(), row.end());
    } else if (mesh_.owners[witness - c.points.size()].on_segment) {
        segments.push_back(mesh_.owners[witness - c.points.size()].index);
    }
    for (const std::uint32_t s : segments) {
        for (const Side& side : c.facet_sides[f]) {
            if (s == piece.owner || s == side.segment || side.segment == piece.owner) continue;
            const auto of_s = c.segment_facets[s];
            const auto of_side = c.segment_facets[side.segment];
            const bool is_on_page = std::any_of(of_s.begin(), of_s.end(), [&](std::uint32_t k) {
                return k != f && std::find(of_side.begin(), of_side.end(), k) != of_side.end();
            });
            if (!is_on_page) continue;
            if (const auto crossing = crossing_about(side.segment, piece, s)) return crossing;
        }
    }
    return std::nullopt;
}

std::optional<Point3> Placement::crossing_about(std::uint32_t axis, const Piece& piece, std::uint32_t s) const {
    constexpr double near_end = 0.02;  // of the piece
    const Complex& c = mesh_.complex;
    const Point3& origin = c.points[c.segments[axis][0]];
    Point3 direction = c.points[c.segments[axis][1]] - origin;
    direction = (1.0 / norm(direction)) * direction;
    const auto across = [&](const Point3& p) {
        const Point3 d = p - origin;
        return d - dot(d, direction) * direction;
    };
    const Point3 &a = mesh_.triangulation.position(piece.a), &b = mesh_.triangulation.position(piece.b);
    const Point3 &begin = c.points[c.segments[s][0]], &end = c.points[c.segments[s][1]];
    if (dot(across(0.5 * (a + b)), across(0.5 * (begin + end))) <= 0.0) return std::nullopt;
    const auto flat = [&](const Point3& p) { return PlanarPoint{dot(p - origin, direction), norm(across(p))}; };
    const PlanarPoint p = flat(a), q = flat(b), u = flat(begin), v = flat(end);
    const double side_p = turn(u, v, p), side_q = turn(u, v, q);
    if ((side_p > 0.0) == (side_q > 0.0) || (turn(p, q, u) > 0.0) == (turn(p, q, v) > 0.0)) return std::nullopt;
    const double t = side_p / (side_p - side_q);
    if (t < near_end || t > 1.0 - near_end) return std::nullopt;
    return a + t * (b - a);
}

std::optional<Point3> Placement::rotate(std::uint32_t f, const Point3& on_line, const Point3& direction,
                                        const Point3& center, const Point3& q) const {
    const auto across = [&](const Point3& p) {
        const Point3 d = p - on_line;
        return d - dot(d, direction) * direction;
    };
    const Frame& frame = mesh_.complex.frames[f];
    Point3 in_plane = cross(frame.normal, direction);
    const double size = norm(in_plane);
    if (size < 0.5) return std::nullopt;
    in_plane = (dot(in_plane, across(center)) >= 0.0 ? 1.0 / size : -1.0 / size) * in_plane;
    const Point3 d = q - on_line;
    return on_line + dot(d, direction) * direction + norm(across(q)) * in_plane;
}

std::optional<Point3> Placement::over_common_segment(std::uint32_t f, std::uint32_t k, const Point3& center,
                                                     const Point3& q) const {
    const Complex& c = mesh_.complex;
    for (const Side& side : c.facet_sides[f]) {
        const auto others = c.segment_facets[side.segment];
        if (std::find(others.begin(), others.end(), k) == others.end()) continue;
        const Point3& a = c.points[c.segments[side.segment][0]];
        Point3 direction = c.points[c.segments[side.segment][1]] - a;
        direction = (1.0 / norm(direction)) * direction;
        const auto p = rotate(f, a, direction, center, q);
        // Only across an angle below 90 degrees does the image answer the point.
        if (p && dot(*p - a, q - a) - dot(*p - a, direction) * dot(q - a, direction) > 0.0) return p;
    }
    return std::nullopt;
}

std::optional<Point3> Placement::over_common_vertex(std::uint32_t f, std::uint32_t k, const Point3& center,
                                                    const Point3& q) const {
    const Complex& c = mesh_.complex;
    Point3 direction = cross(c.frames[f].normal, c.frames[k].normal);
    const double size = norm(direction);
    if (size < 1e-9) return std::nullopt;
    direction = (1.0 / size) * direction;
    const auto is_on = [&](std::uint32_t vertex, std::uint32_t facet) {
        const auto facets = c.point_facets[vertex];
        return std::find(facets.begin(), facets.end(), facet) != facets.end();
    };
    for (const Side& side : c.facet_sides[k]) {
        for (const std::uint32_t v : c.segments[side.segment]) {
            if (is_on(v, f)) return rotate(f, c.points[v], direction, center, q);
        }
    }
    return std::nullopt;
}

std::optional<Point3> Placement::about_common_end(std::uint32_t f, std::uint32_t segment, const Point3& q) const {
    const Complex& c = mesh_.complex;
    const Point3& normal = c.frames[f].normal;
    for (const std::uint32_t v : c.segments[segment]) {
        const auto facets = c.point_facets[v];
        if (std::find(facets.begin(), facets.end(), f) == facets.end()) continue;
        const Point3 d = q - c.points[v];
        const Point3 flat = d - dot(d, normal) * normal;
        const double size = norm(flat);
        if (size > 1e-6 * norm(d)) return c.points[v] + (norm(d) / size) * flat;
    }
    return std::nullopt;
}

std::optional<Point3> Placement::mirror(std::uint32_t f, const Point3& center, double radius, std::uint32_t q) {
    const Point3& place = mesh_.triangulation.position(q);
    const auto accept = [&](const std::optional<Point3>& p) { return p && distance(*p, center) < radius; };
    mesh_.find_facets(q, facets_);
    for (const std::uint32_t k : facets_) {
        if (k == f) continue;
        if (const auto p = over_common_segment(f, k, center, place); accept(p)) return p;
    }
    for (const std::uint32_t k : facets_) {
        if (k == f) continue;
        if (const auto p = over_common_vertex(f, k, center, place); accept(p)) return p;
    }
    const std::uint32_t inputs = static_cast<std::uint32_t>(mesh_.complex.points.size());
    if (facets_.empty() && q >= inputs && mesh_.owners[q - inputs].on_segment) {
        if (const auto p = about_common_end(f, mesh_.owners[q - inputs].index, place); accept(p)) return p;
    }
    // A sheet that runs close by without touching: seen from the projection, its point is straight above.
    constexpr double close_by = 0.5;
    const Frame& frame = mesh_.complex.frames[f];
    const double height = dot(place - frame.origin, frame.normal);
    if (std::abs(height) < close_by * radius && std::find(facets_.begin(), facets_.end(), f) == facets_.end()) {
        return place - height * frame.normal;
    }
    return std::nullopt;
}

}  // namespace certa::conforming
