// Compiles regions and clips triangles by them (thesis, definitions 5 and 7 for any Borel set that can be said).
//
// Boxes become six half-spaces, so that set algebra has balls, half-spaces, sets of faces and predicates as leaves. The
// area of a triangle inside is half the integral of x dy - y dx along the border of the part inside: that border is
// made of pieces of the triangle's sides and of the circles and lines in which the triangle's plane meets the
// primitives. Each curve is split at its crossings with all others; a piece belongs to the border when membership
// differs on its two sides, which is decided by evaluating the algebra with that primitive held true and then false.
// Primitives with the same border are held together.
#include "curvature/region.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace certa::curvature {
namespace {

using Vector2 = std::array<double, 2>;
constexpr double pi = std::numbers::pi;

double dot2(const Vector2& a, const Vector2& b) { return a[0] * b[0] + a[1] * b[1]; }
double cross2(const Vector2& a, const Vector2& b) { return a[0] * b[1] - a[1] * b[0]; }
Vector2 minus(const Vector2& a, const Vector2& b) { return {a[0] - b[0], a[1] - b[1]}; }
Vector2 mix(const Vector2& a, const Vector2& b, double t) {
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
}

[[noreturn]] void refuse(const std::string& message) {
    throw InputError({{DefectKind::option_out_of_range, {{ElementKind::option, 0}}, {}, message}});
}

bool finite(const Point3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

double squared_distance_to_segment(const Point3& p, const Point3& a, const Point3& b) {
    const Point3 d = b - a;
    const double length2 = dot(d, d);
    const double t = length2 > 0.0 ? std::clamp(dot(p - a, d) / length2, 0.0, 1.0) : 0.0;
    const Point3 q = p - (a + t * d);
    return dot(q, q);
}

double squared_distance_to_triangle(const Point3& p, const std::array<Point3, 3>& c) {
    const Point3 n = cross(c[1] - c[0], c[2] - c[0]);
    bool above = true;
    double nearest = squared_distance_to_segment(p, c[2], c[0]);
    for (std::size_t i = 0; i < 3; ++i) {
        above = above && dot(n, cross(c[(i + 1) % 3] - c[i], p - c[i])) >= 0.0;
        if (i < 2) nearest = std::min(nearest, squared_distance_to_segment(p, c[i], c[i + 1]));
    }
    if (!above || dot(n, n) == 0.0) return nearest;
    const double height = dot(n, p - c[0]);
    return height * height / dot(n, n);
}

}  // namespace

CompiledRegion::CompiledRegion(const Region& region, const Surface& surface) : surface_(surface) {
    compile(region, surface);
    for (std::size_t i = 0; i < primitives_.size(); ++i) {
        Primitive& p = primitives_[i];
        p.twin = i;
        for (std::size_t j = 0; j < i && p.twin == i; ++j) {
            const Primitive& q = primitives_[j];
            if (q.kind != p.kind || q.twin != j) continue;
            if (p.kind == Region::Kind::ball && p.point == q.point && p.radius == q.radius) p.twin = j;
            if (p.kind == Region::Kind::half_space && norm(cross(p.normal, q.normal)) < 1e-14 &&
                std::abs(dot(p.point - q.point, q.normal)) <= 1e-15 * (norm(p.point) + norm(q.point)))
                p.twin = j, p.opposite = dot(p.normal, q.normal) < 0.0;
        }
    }
}

std::size_t CompiledRegion::add_primitive(Primitive primitive) {
    primitives_.push_back(std::move(primitive));
    nodes_.push_back({primitives_.back().kind, primitives_.size() - 1, {}});
    return nodes_.size() - 1;
}

std::size_t CompiledRegion::add_half_space(const Point3& point, const Point3& normal) {
    Primitive primitive;
    primitive.kind = Region::Kind::half_space;
    primitive.point = point;
    primitive.normal = normal;
    return add_primitive(std::move(primitive));
}

std::size_t CompiledRegion::compile(const Region& region, const Surface& surface) {
    const auto scaled = [&](const Point3& p) {
        return Point3{std::ldexp(p.x, -surface.exponent), std::ldexp(p.y, -surface.exponent),
                      std::ldexp(p.z, -surface.exponent)};
    };
    // Parents come before their parts: the root is node 0.
    const std::size_t id = nodes_.size();
    Primitive primitive;
    primitive.kind = region.kind;
    switch (region.kind) {
        case Region::Kind::everything:
            nodes_.push_back({});
            return id;
        case Region::Kind::ball:
            if (!finite(region.center) || !(region.radius >= 0.0) || !std::isfinite(region.radius))
                refuse("the region's ball needs a finite centre and a radius of at least 0");
            primitive.point = scaled(region.center);
            primitive.radius = std::ldexp(region.radius, -surface.exponent);
            return add_primitive(std::move(primitive));
        case Region::Kind::half_space: {
            if (!finite(region.center) || !finite(region.corner) || region.corner == Point3{})
                refuse("the region's half-space needs a finite point and a normal that is not 0");
            return add_half_space(scaled(region.center), unit_or_zero(region.corner));
        }
        case Region::Kind::box: {
            const Point3 &low = region.center, &high = region.corner;
            if (!finite(low) || !finite(high) || low.x > high.x || low.y > high.y || low.z > high.z)
                refuse("the region's box needs its lower corner first");
            nodes_.push_back({Region::Kind::both, 0, {}});
            const Point3 a = scaled(low), b = scaled(high);
            std::vector<std::size_t> sides{add_half_space(a, {-1, 0, 0}), add_half_space(a, {0, -1, 0}),
                                           add_half_space(a, {0, 0, -1}), add_half_space(b, {1, 0, 0}),
                                           add_half_space(b, {0, 1, 0}),  add_half_space(b, {0, 0, 1})};
            nodes_[id].parts = std::move(sides);
            return id;
        }
        case Region::Kind::faces: {
            has_faces_ = true;
            std::vector<Index> sorted_of;
            std::vector<bool> named;
            for (const Index f : region.faces) {
                if (f >= named.size()) named.resize(std::size_t{f} + 1);
                named[f] = true;
            }
            std::size_t found = 0;
            primitive.faces.resize(surface.faces.size());
            for (std::size_t f = 0; f < surface.faces.size(); ++f) {
                const Index source = surface.face_sources[f];
                if (source < named.size() && named[source]) primitive.faces[f] = true, ++found;
            }
            const auto largest = region.faces.empty() ? 0 : *std::max_element(region.faces.begin(), region.faces.end());
            if (!region.faces.empty() && largest >= surface.statistics.triangles + surface.statistics.repeated_vertices)
                throw InputError({{DefectKind::index_out_of_range,
                                   {{ElementKind::triangle, largest}},
                                   {},
                                   "the region names face " + std::to_string(largest + std::uint64_t{1}) + " of " +
                                       std::to_string(surface.statistics.triangles)}});
            return add_primitive(std::move(primitive));
        }
        case Region::Kind::predicate:
            if (!region.predicate) refuse("the region's predicate is empty");
            has_predicates_ = true;
            primitive.predicate = region.predicate;
            return add_primitive(std::move(primitive));
        case Region::Kind::complement:
        case Region::Kind::both:
        case Region::Kind::either: {
            if (region.kind == Region::Kind::complement && region.parts.size() != 1)
                refuse("a complement has exactly one part");
            nodes_.push_back({region.kind, 0, {}});
            std::vector<std::size_t> parts;
            for (const Region& part : region.parts) parts.push_back(compile(part, surface));
            nodes_[id].parts = std::move(parts);
            return id;
        }
    }
    return id;
}

bool CompiledRegion::primitive_holds(const Primitive& p, const Point3& point, Index face) const {
    switch (p.kind) {
        case Region::Kind::ball: {
            const Point3 d = point - p.point;
            return dot(d, d) <= p.radius * p.radius;
        }
        case Region::Kind::half_space:
            return dot(point - p.point, p.normal) <= 0.0;
        case Region::Kind::faces:
            return face != no_index && p.faces[face];
        case Region::Kind::predicate: {
            const auto back = [&](double x) { return std::ldexp(x, surface_.exponent); };
            return p.predicate({back(point.x), back(point.y), back(point.z)});
        }
        default:
            return true;
    }
}

bool CompiledRegion::evaluate(std::size_t node, const Point3& point, Index face,
                              const std::vector<signed char>* forced) const {
    const Node& n = nodes_[node];
    switch (n.kind) {
        case Region::Kind::everything:
            return true;
        case Region::Kind::complement:
            return !evaluate(n.parts[0], point, face, forced);
        case Region::Kind::both:
            return std::all_of(n.parts.begin(), n.parts.end(),
                               [&](std::size_t part) { return evaluate(part, point, face, forced); });
        case Region::Kind::either:
            return std::any_of(n.parts.begin(), n.parts.end(),
                               [&](std::size_t part) { return evaluate(part, point, face, forced); });
        default:
            if (forced != nullptr && (*forced)[n.primitive] >= 0) return (*forced)[n.primitive] == 1;
            return primitive_holds(primitives_[n.primitive], point, face);
    }
}

void CompiledRegion::crossings(const Point3& a, const Point3& b, std::vector<double>& parameters) const {
    parameters.clear();
    const Point3 d = b - a;
    const auto take = [&](double t) {
        if (t > 0.0 && t < 1.0) parameters.push_back(t);
    };
    for (const Primitive& p : primitives_) {
        if (p.kind == Region::Kind::ball) {
            const Point3 from = a - p.point;
            const double dd = dot(d, d), ad = dot(from, d), rest = dot(from, from) - p.radius * p.radius;
            const double under = ad * ad - dd * rest;
            if (!(under > 0.0) || !(dd > 0.0)) continue;
            const double root = std::sqrt(under), big = ad > 0.0 ? -(ad + root) : root - ad;
            take(big / dd);
            if (big != 0.0) take(rest / big);
        } else if (p.kind == Region::Kind::half_space) {
            const double at_a = dot(a - p.point, p.normal), at_b = dot(b - p.point, p.normal);
            if ((at_a < 0.0) != (at_b < 0.0) && at_a != at_b) take(at_a / (at_a - at_b));
        }
    }
    std::sort(parameters.begin(), parameters.end());
}

bool CompiledRegion::cuts(const Primitive& p, const std::array<Point3, 3>& corners) const {
    if (p.kind == Region::Kind::half_space) {
        bool below = false, above = false;
        for (const Point3& c : corners) {
            const double side = dot(c - p.point, p.normal);
            below = below || side < 0.0, above = above || side > 0.0;
        }
        return below && above;
    }
    if (p.kind != Region::Kind::ball) return false;
    bool all = true;
    for (const Point3& c : corners) all = all && primitive_holds(p, c, no_index);
    return !all && squared_distance_to_triangle(p.point, corners) < p.radius * p.radius;
}

/// One triangle being clipped, in its own plane.
struct CompiledRegion::Cut {
    const CompiledRegion& region;
    Index face;
    Point3 origin, u, v;
    std::array<Vector2, 3> corners{};
    std::vector<Curve> curves;
    std::vector<signed char> forced;  ///< constant primitives; -1: evaluate

    Point3 lift(const Vector2& p) const { return origin + p[0] * u + p[1] * v; }
    bool holds(const Vector2& p) const { return region.evaluate(0, lift(p), face, &forced); }

    /// Parameters in (0, 1) where the segment crosses curves other than `self`.
    void split_segment(const Vector2& a, const Vector2& b, std::size_t self, std::vector<double>& at) const {
        at.assign(1, 0.0);
        const Vector2 d = minus(b, a);
        const auto take = [&](double t) {
            if (t > 0.0 && t < 1.0) at.push_back(t);
        };
        for (std::size_t k = 0; k < curves.size(); ++k) {
            if (k == self) continue;
            const Curve& curve = curves[k];
            if (!curve.is_circle) {
                const double slope = dot2(curve.normal, d);
                if (slope != 0.0) take((curve.offset - dot2(curve.normal, a)) / slope);
                continue;
            }
            const Vector2 from = minus(a, curve.center);
            const double dd = dot2(d, d), ad = dot2(from, d), under = ad * ad - dd * (dot2(from, from) - curve.square);
            if (!(under > 0.0) || !(dd > 0.0)) continue;
            take((-ad - std::sqrt(under)) / dd);
            take((-ad + std::sqrt(under)) / dd);
        }
        std::sort(at.begin(), at.end());
        at.push_back(1.0);
    }

    /// +1 if the region lies on the primitive's inner side of its border at p only, -1 on the outer side only, else 0.
    int border_side(const Vector2& p, std::size_t primitive) {
        const auto with = [&](bool inner) {
            std::vector<signed char>& f = forced;
            std::vector<signed char> kept = f;
            for (std::size_t i = 0; i < f.size(); ++i)
                if (region.primitives_[i].twin == primitive) f[i] = inner != region.primitives_[i].opposite ? 1 : 0;
            const bool result = holds(p);
            f = std::move(kept);
            return result;
        };
        return static_cast<int>(with(true)) - static_cast<int>(with(false));
    }

    bool in_triangle(const Vector2& p) const {
        for (std::size_t i = 0; i < 3; ++i)
            if (cross2(minus(corners[(i + 1) % 3], corners[i]), minus(p, corners[i])) < 0.0) return false;
        return true;
    }

    double along_sides() const {
        double sum = 0.0;
        std::vector<double> at;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vector2 &a = corners[i], &b = corners[(i + 1) % 3];
            split_segment(a, b, curves.size(), at);
            for (std::size_t k = 0; k + 1 < at.size(); ++k)
                if (at[k] < at[k + 1] && holds(mix(a, b, 0.5 * (at[k] + at[k + 1]))))
                    sum += 0.5 * cross2(a, b) * (at[k + 1] - at[k]);
        }
        return sum;
    }

    double along_line(std::size_t self) {
        const Curve& curve = curves[self];
        // The part inside the triangle, walked with the inner side on the left.
        std::vector<Vector2> ends;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vector2 &a = corners[i], &b = corners[(i + 1) % 3];
            const double at_a = dot2(curve.normal, a) - curve.offset, at_b = dot2(curve.normal, b) - curve.offset;
            if ((at_a < 0.0) != (at_b < 0.0)) ends.push_back(mix(a, b, at_a / (at_a - at_b)));
        }
        if (ends.size() != 2) return 0.0;
        const Vector2 along{-curve.normal[1], curve.normal[0]};
        if (dot2(along, minus(ends[1], ends[0])) < 0.0) std::swap(ends[0], ends[1]);
        std::vector<double> at;
        split_segment(ends[0], ends[1], self, at);
        double sum = 0.0;
        for (std::size_t k = 0; k + 1 < at.size(); ++k)
            if (at[k] < at[k + 1])
                sum += border_side(mix(ends[0], ends[1], 0.5 * (at[k] + at[k + 1])), curve.primitive) * 0.5 *
                       cross2(ends[0], ends[1]) * (at[k + 1] - at[k]);
        return sum;
    }

    /// Angles where the circle crosses a line given by normal . x = offset.
    static void cross_line(const Curve& circle, const Vector2& normal, double offset, std::vector<double>& angles) {
        const double length = std::hypot(normal[0], normal[1]), radius = std::sqrt(circle.square);
        const double cosine = (offset - dot2(normal, circle.center)) / (length * radius);
        if (!(std::abs(cosine) < 1.0)) return;
        const double middle = std::atan2(normal[1], normal[0]), half = std::acos(cosine);
        angles.push_back(middle + half);
        angles.push_back(middle - half);
    }

    double along_circle(std::size_t self) {
        const Curve& circle = curves[self];
        std::vector<double> angles;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vector2 &a = corners[i], &b = corners[(i + 1) % 3];
            const Vector2 normal{b[1] - a[1], a[0] - b[0]};
            cross_line(circle, normal, dot2(normal, a), angles);
        }
        for (std::size_t k = 0; k < curves.size(); ++k) {
            if (k == self) continue;
            const Curve& other = curves[k];
            if (!other.is_circle) {
                cross_line(circle, other.normal, other.offset, angles);
                continue;
            }
            // The radical line of the two circles.
            const Vector2 normal{2.0 * (other.center[0] - circle.center[0]),
                                 2.0 * (other.center[1] - circle.center[1])};
            if (normal == Vector2{}) continue;
            cross_line(
                circle, normal,
                dot2(other.center, other.center) - other.square - dot2(circle.center, circle.center) + circle.square,
                angles);
        }
        for (double& angle : angles) {
            while (angle < 0.0) angle += 2.0 * pi;
            while (angle >= 2.0 * pi) angle -= 2.0 * pi;
        }
        std::sort(angles.begin(), angles.end());
        if (angles.empty()) angles.push_back(0.0);
        angles.push_back(angles.front() + 2.0 * pi);
        const double radius = std::sqrt(circle.square);
        double sum = 0.0;
        for (std::size_t k = 0; k + 1 < angles.size(); ++k) {
            const double from = angles[k], to = angles[k + 1], middle = 0.5 * (from + to);
            if (!(to > from)) continue;
            const Vector2 p{circle.center[0] + radius * std::cos(middle), circle.center[1] + radius * std::sin(middle)};
            if (!in_triangle(p)) continue;
            const int side = border_side(p, circle.primitive);
            if (side == 0) continue;
            sum += side * 0.5 * radius *
                   (radius * (to - from) + circle.center[0] * (std::sin(to) - std::sin(from)) -
                    circle.center[1] * (std::cos(to) - std::cos(from)));
        }
        return sum;
    }
};

double CompiledRegion::area_inside(Index face) const {
    const double area = surface_.face_geometry[face].area;
    if (area == 0.0) return 0.0;
    const auto& f = surface_.faces[face];
    const std::array<Point3, 3> corners{surface_.positions[f[0]], surface_.positions[f[1]], surface_.positions[f[2]]};
    const Point3 middle = (1.0 / 3.0) * (corners[0] + corners[1] + corners[2]);
    std::vector<bool> cut(primitives_.size());
    bool any = false;
    for (std::size_t i = 0; i < primitives_.size(); ++i) any = (cut[i] = cuts(primitives_[i], corners)) || any;
    if (!any) return holds(middle, face) ? area : 0.0;
    const Point3 u = unit_or_zero(corners[1] - corners[0]), v = cross(surface_.face_geometry[face].normal, u);
    // The origin in the triangle, so that the terms of the line integrals are as small as its area.
    Cut work{*this, face, middle, u, v, {}, {}, std::vector<signed char>(primitives_.size(), -1)};
    for (std::size_t i = 0; i < 3; ++i) work.corners[i] = {dot(corners[i] - middle, u), dot(corners[i] - middle, v)};
    for (std::size_t i = 0; i < primitives_.size(); ++i) {
        const Primitive& p = primitives_[i];
        if (!cut[i]) {
            // The same for all of the triangle: at its inside, not at a corner or side that lies on the border.
            work.forced[i] = primitive_holds(p, middle, face) ? 1 : 0;
            continue;
        }
        if (p.twin != i) continue;
        Curve curve;
        curve.primitive = i;
        curve.is_circle = p.kind == Region::Kind::ball;
        if (curve.is_circle) {
            const Point3 d = p.point - middle;
            const double height = dot(d, surface_.face_geometry[face].normal);
            curve.center = {dot(d, u), dot(d, v)};
            curve.square = p.radius * p.radius - height * height;
            if (!(curve.square > 0.0)) {
                work.forced[i] = 0;
                continue;
            }
        } else {
            curve.normal = {dot(p.normal, u), dot(p.normal, v)};
            curve.offset = dot(p.point - middle, p.normal);
        }
        work.curves.push_back(curve);
    }
    double sum = work.along_sides();
    for (std::size_t k = 0; k < work.curves.size(); ++k)
        sum += work.curves[k].is_circle ? work.along_circle(k) : work.along_line(k);
    return std::clamp(sum, 0.0, area);
}

}  // namespace certa::curvature
