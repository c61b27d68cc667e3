// The protected area (thesis, Part I, 1.1.3), piece by piece.
//
// 1. Segments: centre-, h- and leaving points in order along each; per covered segment and per half-plane of a facet
// that
//    starts there, one p-point for each h-point. They are numbered so that facets and balls that share one find it.
// 2. Facets: at every ball centred on a facet, the sectors of the facet between consecutive rays (segments) around the
//    centre. Rays are ordered by exact orientation tests along a coordinate axis; whether a sector belongs to the facet
//    is known from the sides. Each sector becomes up to two right-angled triangles and its isosceles rest, cut by
//    SOS-points.
#include "conforming/protected_area.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <certa/error.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "conforming/extended_vector.h"
#include "delaunay/flat_facet.h"
#include "exact/orientation.h"

namespace certa::conforming {

using delaunay::Projection;
using exact::Point2;
namespace {

constexpr long double pi = std::numbers::pi_v<long double>;
// Isosceles angles stay below 90 degrees by this much, so that rounding cannot make them right or obtuse.
constexpr long double angle_margin = 1e-6L;

/// Two neighbouring balls on a segment: where their radical plane cuts it, and the radius of their common circle.
struct Lens {
    long double distance = 0.0L, radius = 0.0L;
};
Lens lens_between(const Ball& left, long double left_distance, const Ball& right, long double right_distance) {
    const long double d = right_distance - left_distance, r = left.radius, q = right.radius;
    const long double offset = 0.5L * (d + (r - q) * (r + q) / d);
    return {left_distance + offset, std::sqrt(std::max(0.0L, (r - offset) * (r + offset)))};
}

/// A ray of a facet from a ball's centre along a segment, with what the facet's sector on one side of it starts with.
struct Ray {
    std::uint32_t point = no_index;  // p-point, or leaving point
    std::uint32_t h = no_index;      // h-point, or no_index if the segment is not covered
    long double angle = 0.0L;        // between the segment and `point`, seen from the centre
};

class AreaBuilder {
public:
    AreaBuilder(const Complex& complex, const FacetInterior& interior, const ProtectingBalls& balls)
        : complex_(complex), interior_(interior), balls_(balls) {
        area_.balls = balls.balls;
        area_.ball_centers.assign(balls.balls.size(), no_index);
        area_.input_points = static_cast<std::uint32_t>(complex.points.size());
        for (std::uint32_t f = 0; f < complex.facet_sides.size(); ++f) normals_.push_back(facet_normal(f));
        for (std::uint32_t v = 0; v < complex.points.size(); ++v) {
            if (balls.vertex_balls[v] != no_index) area_.ball_centers[balls.vertex_balls[v]] = v;
        }
    }

    ProtectedArea build() && {
        lenses_.offsets.reserve(complex_.segments.size() + 1);
        for (std::uint32_t s = 0; s < complex_.segments.size(); ++s) place_along(s);
        first_p_.assign(complex_.segments.size() + 1, 0);
        for (std::uint32_t s = 0; s < complex_.segments.size(); ++s) place_p_points(s);
        for (std::uint32_t f = 0; f < complex_.facet_sides.size(); ++f) {
            shields_.clear();
            right_angled_.clear();
            fill_facet(f);
            area_.shields.push_row(shields_);
            area_.right_angled.push_row(right_angled_);
        }
        return std::move(area_);
    }

private:
    struct Spoke {  // a side of the current facet at one of its vertices
        std::uint32_t vertex, segment;
        std::uint8_t cover;
    };

    std::uint32_t add(const NewPoint& point) {
        area_.points.push_back(point);
        return area_.input_points + static_cast<std::uint32_t>(area_.points.size() - 1);
    }

    /// The frame's normal with more digits: points are placed to an ulp also in slivers.
    Vector facet_normal(std::uint32_t f) const {
        Vector sum;
        for (const auto& [a, b, c] : interior_.triangles[f]) {
            const Point3& origin = complex_.points[a];
            sum = sum + cross(difference(complex_.points[b], origin), difference(complex_.points[c], origin));
        }
        const long double size = length(sum);
        return size > 0.0L ? (1.0L / size) * sum : Vector(complex_.frames[f].normal);
    }

    Vector direction_of(std::uint32_t s) const {
        const auto& [a, b] = complex_.segments[s];
        return normalized(difference(complex_.points[b], complex_.points[a]));
    }
    long double length_of(std::uint32_t s) const {
        const auto& [a, b] = complex_.segments[s];
        return length(difference(complex_.points[b], complex_.points[a]));
    }
    Point3 place_on(std::uint32_t s, long double distance) const {
        const auto& [a, b] = complex_.segments[s];
        const Vector span = difference(complex_.points[b], complex_.points[a]);
        return (Vector(complex_.points[a]) + (distance / length(span)) * span).rounded();
    }

    /// Distance of a ball's centre along a segment that it belongs to.
    long double distance_along(std::uint32_t s, std::uint32_t ball) const {
        const Ball& b = area_.balls[ball];
        if (b.kind == BallKind::segment) return b.distance;
        return b.index == complex_.segments[s][0] ? 0.0L : length_of(s);
    }

    void place_along(std::uint32_t s) {
        chain_.assign(1, complex_.segments[s][0]);
        links_.clear();
        row_lenses_.clear();
        const auto row = balls_.segment_balls[s];
        if (row.empty()) {
            place_leaving_points(s);
        } else {
            place_covered(s, row);
        }
        area_.chains.push_row(chain_);
        area_.link_balls.push_row(links_);
        lenses_.push_row(row_lenses_);
    }

    void place_covered(std::uint32_t s, std::span<const std::uint32_t> row) {
        for (std::size_t i = 0; i + 1 < row.size(); ++i) {
            const Ball &left = area_.balls[row[i]], &right = area_.balls[row[i + 1]];
            const Lens lens = lens_between(left, distance_along(s, row[i]), right, distance_along(s, row[i + 1]));
            row_lenses_.push_back(lens);
            chain_.push_back(add({place_on(s, lens.distance),
                                  PointRole::h,
                                  s,
                                  static_cast<double>(lens.distance),
                                  {row[i], row[i + 1]}}));
            links_.push_back(row[i]);
            links_.push_back(row[i + 1]);
            if (i + 2 == row.size()) {
                chain_.push_back(complex_.segments[s][1]);
                continue;
            }
            const std::uint32_t center =
                add({right.center, PointRole::center, s, right.distance, {row[i + 1], no_index}});
            area_.ball_centers[row[i + 1]] = center;
            chain_.push_back(center);
        }
    }

    void place_leaving_points(std::uint32_t s) {
        const auto& [first, second] = complex_.segments[s];
        const std::uint32_t from = balls_.vertex_balls[first], to = balls_.vertex_balls[second];
        if (from != no_index) {
            const double radius = area_.balls[from].radius;
            chain_.push_back(add({place_on(s, radius), PointRole::leave, s, radius, {from, no_index}}));
            links_.push_back(from);
        }
        links_.push_back(no_index);
        if (to != no_index) {
            const long double distance = length_of(s) - area_.balls[to].radius;
            chain_.push_back(
                add({place_on(s, distance), PointRole::leave, s, static_cast<double>(distance), {to, no_index}}));
            links_.push_back(to);
        }
        chain_.push_back(second);
    }

    /// Half-planes in the order of the segment's sheets, left before right; in each one point per lens.
    void place_p_points(std::uint32_t s) {
        first_p_[s] = area_.input_points + static_cast<std::uint32_t>(area_.points.size());
        const auto row = balls_.segment_balls[s];
        if (row.empty()) return;
        const Vector along = direction_of(s), start(complex_.points[complex_.segments[s][0]]);
        for (const Sheet& sheet : interior_.sheets[s]) {
            const Vector left = normalized(cross(normals_[sheet.facet], along));
            for (const std::uint8_t side : {cover_left, cover_right}) {
                if (!(sheet.cover & side)) continue;
                for (std::size_t i = 0; i + 1 < row.size(); ++i) {
                    const Lens& lens = lenses_[s][i];
                    const Vector h = start + lens.distance * along;
                    const Vector p = h + (side == cover_left ? lens.radius : -lens.radius) * left;
                    add({p.rounded(), PointRole::p, sheet.facet, 0.0, {row[i], row[i + 1]}});
                }
            }
        }
    }

    /// Id of the p-point of lens `lens` of a segment in the half-plane of `facet` on one side of it.
    std::uint32_t find_p_point(std::uint32_t s, std::uint32_t facet, std::uint8_t side, std::size_t lens) const {
        const auto lens_count = static_cast<std::uint32_t>(lenses_[s].size());
        std::uint32_t half_plane = 0;
        for (const Sheet& sheet : interior_.sheets[s]) {
            if (sheet.facet == facet) {
                half_plane += side == cover_right && (sheet.cover & cover_left) ? 1 : 0;
                return first_p_[s] + half_plane * lens_count + static_cast<std::uint32_t>(lens);
            }
            half_plane += (sheet.cover & cover_left ? 1 : 0) + (sheet.cover & cover_right ? 1 : 0);
        }
        throw InternalError("a facet is missing among the sheets of its side; please report this");
    }

    /// `lens` counts from the first end; `side` is that of the sector, seen along the segment.
    Ray covered_ray(std::uint32_t s, std::uint32_t facet, std::uint8_t side, std::size_t lens,
                    std::uint32_t ball) const {
        const Lens& l = lenses_[s][lens];
        const long double reach = std::abs(l.distance - distance_along(s, ball));
        return {find_p_point(s, facet, side, lens), area_.chains[s][2 * lens + 1], std::atan2(l.radius, reach)};
    }

    /// The ray along a segment from one of its ends.
    Ray end_ray(std::uint32_t s, std::uint32_t facet, std::uint8_t side, std::uint32_t vertex) const {
        const bool at_first = complex_.segments[s][0] == vertex;
        const auto chain = area_.chains[s];
        if (balls_.segment_balls[s].empty()) return {at_first ? chain[1] : chain[chain.size() - 2], no_index, 0.0L};
        return covered_ray(s, facet, side, at_first ? 0 : lenses_[s].size() - 1, balls_.vertex_balls[vertex]);
    }

    /// The sector of `facet` in `ball` that extends counter-clockwise by `angle` from the ray along `direction`.
    void add_sector(std::uint32_t facet, std::uint32_t ball, const Ray& from, const Ray& to, const Vector& direction,
                    long double angle) {
        const std::uint32_t center = area_.ball_centers[ball];
        if (from.h != no_index) right_angled_.push_back({{center, from.h, from.point}, ball, facet});
        add_isosceles(facet, ball, from, to, direction, angle - from.angle - to.angle);
        if (to.h != no_index) right_angled_.push_back({{center, to.point, to.h}, ball, facet});
    }

    void add_isosceles(std::uint32_t facet, std::uint32_t ball, const Ray& from, const Ray& to, const Vector& direction,
                       long double angle) {
        if (!(angle > 0.0L)) {
            throw InternalError("neighbouring sectors of facet " + std::to_string(facet + 1) +
                                " overlap; please report this");
        }
        const auto parts = static_cast<std::uint32_t>(angle / (pi / 2 - angle_margin)) + 1;
        const Vector turned = normalized(cross(normals_[facet], direction));
        std::uint32_t previous = from.point;
        for (std::uint32_t i = 1; i < parts; ++i) {
            const long double at = from.angle + angle * i / parts;
            const std::uint32_t next = add_sos_point(facet, ball, std::cos(at) * direction + std::sin(at) * turned);
            shields_.push_back({previous, next, ball, facet});
            previous = next;
        }
        shields_.push_back({previous, to.point, ball, facet});
    }

    std::uint32_t add_sos_point(std::uint32_t facet, std::uint32_t ball, const Vector& direction) {
        const Ball& b = area_.balls[ball];
        const Vector place = Vector(b.center) + static_cast<long double>(b.radius) * direction;
        return add({place.rounded(), PointRole::sos, facet, 0.0, {ball, no_index}});
    }

    void fill_facet(std::uint32_t f) {
        spokes_.clear();
        const std::uint32_t begin = complex_.facet_sides.offsets[f], end = complex_.facet_sides.offsets[f + 1];
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t s = complex_.facet_sides.values[i].segment;
            const std::uint8_t cover = interior_.side_covers[i];
            if (cover == 0) continue;
            fill_half_disks(f, s, cover);
            for (const std::uint32_t v : complex_.segments[s]) {
                if (balls_.vertex_balls[v] != no_index) spokes_.push_back({v, s, cover});
            }
        }
        std::stable_sort(spokes_.begin(), spokes_.end(),
                         [](const Spoke& a, const Spoke& b) { return a.vertex < b.vertex; });
        for (std::size_t i = 0; i < spokes_.size();) {
            std::size_t j = i;
            while (j < spokes_.size() && spokes_[j].vertex == spokes_[i].vertex) ++j;
            fill_sectors(f, std::span(spokes_).subspan(i, j - i));
            i = j;
        }
        for (const std::uint32_t v : complex_.facet_points[f]) {
            if (balls_.vertex_balls[v] != no_index) fill_disk(f, balls_.vertex_balls[v]);
        }
    }

    /// At the centres inside a covered side: one or two half-disks.
    void fill_half_disks(std::uint32_t f, std::uint32_t s, std::uint8_t cover) {
        const auto row = balls_.segment_balls[s];
        if (row.size() < 3) return;
        const Vector along = direction_of(s);
        for (std::size_t i = 1; i + 1 < row.size(); ++i) {
            if (cover & cover_left) {
                add_sector(f, row[i], covered_ray(s, f, cover_left, i, row[i]),
                           covered_ray(s, f, cover_left, i - 1, row[i]), along, pi);
            }
            if (cover & cover_right) {
                add_sector(f, row[i], covered_ray(s, f, cover_right, i - 1, row[i]),
                           covered_ray(s, f, cover_right, i, row[i]), -along, pi);
            }
        }
    }

    static std::uint8_t turned(std::uint8_t side) { return side == cover_left ? cover_right : cover_left; }

    /// The side of the segment that is to the left of the spoke, seen from its vertex.
    std::uint8_t left_of(const Spoke& spoke) const {
        return complex_.segments[spoke.segment][0] == spoke.vertex ? cover_left : cover_right;
    }
    std::uint32_t far_end(const Spoke& spoke) const {
        const auto& [a, b] = complex_.segments[spoke.segment];
        return a == spoke.vertex ? b : a;
    }

    void fill_sectors(std::uint32_t f, std::span<Spoke> spokes) {
        const std::uint32_t v = spokes[0].vertex, ball = balls_.vertex_balls[v];
        const Projection projection(complex_.frames[f].normal);
        const auto flat = [&](std::uint32_t id) {
            const Point2 p = projection(complex_.points[id]);
            return exact::Point2{p.x, p.y};
        };
        const exact::Point2 origin = flat(v);
        const auto turn = [&](const Spoke& a, const Spoke& b) {
            return exact::orient2d(origin, flat(far_end(a)), flat(far_end(b)));
        };
        if (spokes.size() > 2) {  // counter-clockwise, starting with the upper half-plane
            const auto lower = [&](const Spoke& a) {
                const auto p = flat(far_end(a));
                return p.y < origin.y || (p.y == origin.y && p.x < origin.x);
            };
            std::sort(spokes.begin(), spokes.end(), [&](const Spoke& a, const Spoke& b) {
                const bool below_a = lower(a), below_b = lower(b);
                return below_a != below_b ? below_b : turn(a, b) > 0;
            });
        }
        for (std::size_t i = 0; i < spokes.size(); ++i) {
            const Spoke &from = spokes[i], &to = spokes[(i + 1) % spokes.size()];
            const std::uint8_t left = left_of(from), right = turned(left_of(to));
            if (!(from.cover & left)) continue;
            if (!(to.cover & right)) {
                throw InternalError("the sides of facet " + std::to_string(f + 1) +
                                    " disagree about its inside; please report this");
            }
            const Vector a = difference(complex_.points[far_end(from)], complex_.points[v]);
            const Vector b = difference(complex_.points[far_end(to)], complex_.points[v]);
            long double angle = std::atan2(length(cross(a, b)), dot(a, b));
            if (spokes.size() == 1) {
                angle = 2 * pi;
            } else if (turn(from, to) < 0) {
                angle = 2 * pi - angle;
            }
            add_sector(f, ball, end_ray(from.segment, f, left, v), end_ray(to.segment, f, right, v), normalized(a),
                       angle);
        }
    }

    /// Around an isolated point of the facet.
    void fill_disk(std::uint32_t f, std::uint32_t ball) {
        const Vector& normal = normals_[f];
        const Vector u(complex_.frames[f].u), direction = normalized(u - dot(u, normal) * normal);
        const std::uint32_t first = add_sos_point(f, ball, direction);
        add_isosceles(f, ball, {first}, {first}, direction, 2 * pi);
    }

    const Complex& complex_;
    const FacetInterior& interior_;
    const ProtectingBalls& balls_;
    ProtectedArea area_;
    std::vector<Vector> normals_;         // per facet
    Rows<Lens> lenses_;                   // per segment, between consecutive balls
    std::vector<std::uint32_t> first_p_;  // per segment: id of its first p-point
    // Scratch space.
    std::vector<std::uint32_t> chain_, links_;
    std::vector<Lens> row_lenses_;
    std::vector<ShieldEdge> shields_;
    std::vector<RightTriangle> right_angled_;
    std::vector<Spoke> spokes_;
};

}  // namespace

ProtectedArea build_protected_area(const Complex& complex, const FacetInterior& interior,
                                   const ProtectingBalls& balls) {
    if (balls.outcome != Outcome::done) throw InternalError("a protected area needs all its balls; please report this");
    return AreaBuilder(complex, interior, balls).build();
}

SplitFrom choose_split(const ProtectedArea& area, std::uint32_t a, std::uint32_t b, std::uint32_t ball) {
    struct Rank {
        int order = 2;  // p-points, leaving points, others
        std::uint32_t other = no_index;
        std::uint32_t id;
    };
    const auto rank = [&](std::uint32_t id) {
        Rank r{2, no_index, id};
        if (!area.is_new(id) || id - area.input_points >= area.points.size()) return r;
        const NewPoint& point = area.new_point(id);
        if (point.role == PointRole::p) {
            r.order = 0;
            r.other = point.balls[0] == ball ? point.balls[1] : point.balls[0];
        } else if (point.role == PointRole::leave) {
            r.order = 1;
        }
        return r;
    };
    const Rank first = rank(a), second = rank(b);
    if (first.order == 2 && second.order == 2) return SplitFrom::middle;
    const auto key = [](const Rank& r) { return std::tuple(r.order, r.other, r.id); };
    return key(first) <= key(second) ? SplitFrom::first : SplitFrom::second;
}

Point3 split_on_sphere(const Point3& center, double radius, const Point3& a, const Point3& b, SplitFrom from) {
    const Vector o(center), r = normalized(difference(a, center)), q = normalized(difference(b, center));
    const auto on_sphere = [&](const Vector& direction) {
        return (o + static_cast<long double>(radius) * normalized(direction)).rounded();
    };
    if (from == SplitFrom::middle) return on_sphere(r + q);
    const long double chord = length(difference(b, a)), half = 0.5L * chord;
    const long double below = std::exp2(std::floor(std::log2(half)));
    const long double shell = half < 1.5L * below ? below : 2.0L * below;
    // Interpolation on the arc: the angle at the centre whose chord is `shell`, out of the whole one.
    const Vector& start = from == SplitFrom::first ? r : q;
    const Vector& end = from == SplitFrom::first ? q : r;
    const long double whole = 2.0L * std::asin(std::min(1.0L, half / radius));
    const long double part = 2.0L * std::asin(std::min(1.0L, 0.5L * shell / radius));
    return on_sphere(std::sin(whole - part) * start + std::sin(part) * end);
}

}  // namespace certa::conforming
