// The rules that decide how many points a mesh needs. Near an acute corner every cut copies a distance that is there
// already, so that cuts on neighbouring segments answer each other instead of cascading; a point that disturbs a facet
// is answered by its mirror image in the facet, rotated about their common line, which lies no farther from anything in
// the facet than the point itself does (the mirror lemma).
#include "conforming/placement.h"

#include <algorithm>
#include <cmath>

#include "core/vector3.h"

namespace certa::conforming {
namespace {

constexpr std::uint8_t first_acute = 1, second_acute = 2, known = 4;
constexpr double margin = 0.1;  // of a piece: nearer to its ends no copied distance is used

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
    if (rule_ == SplitRule::middle_first && low == 0.0 && high == length) return at(middle);
    const std::uint8_t ends = acute_ends(piece.owner);
    const bool both = (ends & first_acute) != 0 && (ends & second_acute) != 0;
    const double from_a = distance(*reference, a), from_b = distance(*reference, b);
    const bool use_first = both ? from_a <= from_b : (ends & first_acute) != 0;
    const bool use_second = !use_first && (ends & second_acute) != 0;
    double t = middle;
    if (use_first) {
        t = from_a;
    } else if (use_second) {
        t = length - from_b;
    } else {
        t = dot(*reference - a, direction) / length;
    }
    const bool copied = rule_ != SplitRule::shells || !(use_first || use_second);
    if (copied && fits(t)) return at(t);
    if (use_first) {
        t = shell_near(middle);
    } else if (use_second) {
        t = length - shell_near(length - middle);
    }
    return at(fits(t) ? t : middle);
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
