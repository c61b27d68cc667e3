// Brute force for the local feature size (thesis, Part I, Definition 3): a loop over all faces.
#include "oracle/feature_size_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace certa::oracle {

using conforming::Complex;

Vec vec(const Point3& p) { return {p.x, p.y, p.z}; }
Vec sub(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec add(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec mul(Real s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }
Real dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(const Vec& a, const Vec& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Real norm(const Vec& a) { return std::sqrt(dot(a, a)); }

Real distance_to_segment(const Vec& p, const Vec& a, const Vec& b) {
    const Vec d = sub(b, a);
    const Real t = std::clamp(dot(sub(p, a), d) / dot(d, d), Real(0), Real(1));
    return distance(p, add(a, mul(t, d)));
}

bool is_inside_facet(const Complex& complex, std::uint32_t facet, const Vec& p) {
    const auto& frame = complex.frames[facet];
    const auto flat = [&](const Vec& q) {
        const Vec d = sub(q, p);
        return std::pair(dot(d, vec(frame.u)), dot(d, vec(frame.v)));
    };
    bool inside = false;
    for (const auto& side : complex.facet_sides[facet]) {
        if (!side.boundary) continue;
        const auto [ax, ay] = flat(vec(complex.points[complex.segments[side.segment][0]]));
        const auto [bx, by] = flat(vec(complex.points[complex.segments[side.segment][1]]));
        if ((ay > 0) == (by > 0)) continue;
        if (ax + (0 - ay) * (bx - ax) / (by - ay) > 0) inside = !inside;
    }
    return inside;
}

Real distance_to_facet(const Complex& complex, std::uint32_t facet, const Vec& p) {
    const auto& frame = complex.frames[facet];
    Real best = std::numeric_limits<Real>::infinity();
    for (const auto& side : complex.facet_sides[facet]) {
        const auto& [a, b] = complex.segments[side.segment];
        best = std::min(best, distance_to_segment(p, vec(complex.points[a]), vec(complex.points[b])));
    }
    if (is_inside_facet(complex, facet, p)) {
        const std::uint32_t corner = complex.segments[complex.facet_sides[facet][0].segment][0];
        best = std::min(best, std::abs(dot(sub(p, vec(complex.points[corner])), vec(frame.normal))));
    }
    return best;
}

bool segment_contains(const Complex& complex, std::uint32_t segment, const Carrier& carrier) {
    if (!carrier.is_vertex) return carrier.index == segment;
    const auto& [a, b] = complex.segments[segment];
    return a == carrier.index || b == carrier.index;
}

bool facet_contains(const Complex& complex, std::uint32_t facet, const Carrier& carrier) {
    for (const auto& side : complex.facet_sides[facet]) {
        if (segment_contains(complex, side.segment, carrier)) return true;
    }
    const auto points = complex.facet_points[facet];
    return carrier.is_vertex && std::find(points.begin(), points.end(), carrier.index) != points.end();
}

Real feature_size(const Complex& complex, const Carrier& carrier, const Vec& p) {
    Real best = std::numeric_limits<Real>::infinity();
    for (std::uint32_t v = 0; v < complex.points.size(); ++v) {
        if (carrier.is_vertex && carrier.index == v) continue;
        best = std::min(best, distance(p, vec(complex.points[v])));
    }
    for (std::uint32_t s = 0; s < complex.segments.size(); ++s) {
        if (segment_contains(complex, s, carrier)) continue;
        const auto& [a, b] = complex.segments[s];
        best = std::min(best, distance_to_segment(p, vec(complex.points[a]), vec(complex.points[b])));
    }
    for (std::uint32_t f = 0; f < complex.facet_sides.size(); ++f) {
        if (!facet_contains(complex, f, carrier)) best = std::min(best, distance_to_facet(complex, f, p));
    }
    return best;
}

}  // namespace certa::oracle
