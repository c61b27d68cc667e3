// Checks of the protected area (thesis, Part I, 1.1.2 and 1.1.3) from the definitions.
//
// Tolerances are relative to the radius of the ball in question plus a few ulps of the coordinates: positions are
// doubles.
#include "oracle/protection_oracle.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <tuple>

#include "oracle/feature_size_oracle.h"

namespace certa::oracle {

using namespace conforming;

namespace {

constexpr Real pi = std::numbers::pi_v<Real>;

std::string name(const Ball& b) {
    return (b.kind == BallKind::vertex ? "ball of vertex " : "ball of segment ") + std::to_string(b.index);
}

Carrier carrier_of(const Ball& b) { return {b.kind == BallKind::vertex, b.index}; }

/// A few ulps of the largest coordinate.
Real noise(const Complex& complex) {
    Real largest = 0;
    for (const Point3& p : complex.points) {
        largest = std::max({largest, std::abs(Real(p.x)), std::abs(Real(p.y)), std::abs(Real(p.z))});
    }
    return 16 * std::numeric_limits<double>::epsilon() * largest;
}

void check_cover(const Complex& complex, const ProtectingBalls& balls, const ProtectedSet& set, Findings& out) {
    for (std::uint32_t v = 0; v < complex.points.size(); ++v) {
        const bool has = balls.vertex_balls[v] != no_index;
        if (has != (set.vertices[v] != 0))
            out.add("(i) vertex " + std::to_string(v) + " has a ball: " + (has ? "yes" : "no"));
        if (has && !(balls.balls[balls.vertex_balls[v]].center == complex.points[v]))
            out.add("(ii) a vertex ball is elsewhere");
    }
    for (std::uint32_t s = 0; s < complex.segments.size(); ++s) {
        const auto row = balls.segment_balls[s];
        if (row.empty() != (set.segments[s] == 0)) out.add("(i) segment " + std::to_string(s) + " covered or not");
        if (row.empty()) continue;
        const auto& [a, b] = complex.segments[s];
        if (row.front() != balls.vertex_balls[a] || row.back() != balls.vertex_balls[b])
            out.add("(i) row does not end at ends");
        const Vec start = vec(complex.points[a]), end = vec(complex.points[b]);
        for (std::size_t i = 0; i < row.size(); ++i) {
            const Ball& ball = balls.balls[row[i]];
            if (distance_to_segment(vec(ball.center), start, end) > noise(complex))
                out.add("(ii) " + name(ball) + " off its segment");
            if (i == 0) continue;
            const Ball& before = balls.balls[row[i - 1]];
            const Real d = distance(vec(ball.center), vec(before.center));
            if (!(d < Real(ball.radius) + before.radius)) out.add("(i) gap before " + name(ball));
            if (!(distance(vec(ball.center), start) > distance(vec(before.center), start))) out.add("row out of order");
        }
    }
}

/// All pairs of balls that touch, found by sorting along x.
std::vector<std::pair<std::uint32_t, std::uint32_t>> touching_pairs(const std::vector<Ball>& balls, Real slack) {
    std::vector<std::uint32_t> order(balls.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](auto i, auto j) {
        return balls[i].center.x - balls[i].radius < balls[j].center.x - balls[j].radius;
    });
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    std::vector<std::uint32_t> active;
    for (const std::uint32_t i : order) {
        const Ball& b = balls[i];
        std::erase_if(active, [&](std::uint32_t j) {
            return balls[j].center.x + balls[j].radius * (1 + slack) < b.center.x - b.radius * (1 + slack);
        });
        for (const std::uint32_t j : active) {
            const Real d = distance(vec(b.center), vec(balls[j].center));
            if (d <= (Real(b.radius) + balls[j].radius) * (1 + slack))
                pairs.emplace_back(std::min(i, j), std::max(i, j));
        }
        active.push_back(i);
    }
    return pairs;
}

void check_pairs(const Complex& complex, const ProtectingBalls& balls, Findings& out) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> neighbours;
    for (std::uint32_t s = 0; s < complex.segments.size(); ++s) {
        const auto row = balls.segment_balls[s];
        for (std::size_t i = 0; i + 1 < row.size(); ++i) neighbours.insert(std::minmax(row[i], row[i + 1]));
    }
    std::map<std::uint32_t, std::vector<std::uint32_t>> adjacent;
    for (const auto& [i, j] : touching_pairs(balls.balls, 1e-5L)) {
        const Ball &a = balls.balls[i], &b = balls.balls[j];
        const Real d = distance(vec(a.center), vec(b.center)), sum = Real(a.radius) + b.radius;
        if (!neighbours.contains({i, j})) out.add("(iii) " + name(a) + " meets " + name(b));
        if (std::abs(d - sum) < 1e-4L * std::min(a.radius, b.radius))
            out.add("(vi) " + name(a) + " is tangent to " + name(b));
        if (!(d > std::max(a.radius, b.radius))) out.add("(vii) " + name(a) + " and " + name(b) + ": centre inside");
        adjacent[i].push_back(j);
        adjacent[j].push_back(i);
    }
    for (const auto& [i, row] : adjacent) {  // three balls in one point meet pairwise
        for (const std::uint32_t j : row) {
            for (const std::uint32_t k : row) {
                const auto& other = adjacent[j];
                if (j < k && std::find(other.begin(), other.end(), k) != other.end()) {
                    out.add("(v) three balls meet around " + name(balls.balls[i]));
                }
            }
        }
    }
}

/// Angles, pieces and links of one facet around one ball.
struct Fan {
    Real angle = 0;
    std::map<std::uint32_t, int> starts, ends;  // rays from the centre
};

class AreaChecker {
public:
    AreaChecker(const Complex& complex, const ProtectingBalls& balls, const ProtectedArea& area)
        : complex_(complex), balls_(balls), area_(area), noise_(noise(complex)) {}

    Findings check() && {
        check_chains();
        check_points();
        for (std::uint32_t f = 0; f < complex_.facet_sides.size(); ++f) check_facet(f);
        check_distinct();
        return std::move(out_);
    }

private:
    Vec at(std::uint32_t id) const {
        return vec(area_.is_new(id) ? area_.new_point(id).position : complex_.points[id]);
    }
    Real tolerance(const Ball& b) const { return 1e-12L * b.radius + noise_; }
    Vec center(std::uint32_t ball) const { return vec(area_.balls[ball].center); }
    void expect(bool condition, const std::string& sentence) {
        if (!condition) out_.add(sentence);
    }
    void expect_on_sphere(std::uint32_t id, std::uint32_t ball) {
        const Ball& b = area_.balls[ball];
        expect(std::abs(distance(at(id), vec(b.center)) - b.radius) <= tolerance(b),
               "point " + std::to_string(id) + " is not on the boundary of the " + name(b));
    }
    /// Of a triangle from its corners; of others from the frame, which is good to about 1e-11.
    Vec normal(std::uint32_t f) const {
        std::set<std::uint32_t> corners;
        for (const Side& side : complex_.facet_sides[f]) {
            corners.insert(complex_.segments[side.segment].begin(), complex_.segments[side.segment].end());
        }
        if (corners.size() != 3) return vec(complex_.frames[f].normal);
        std::array<Vec, 3> p;
        std::transform(corners.begin(), corners.end(), p.begin(), [&](std::uint32_t v) { return at(v); });
        const Vec n = cross(sub(p[1], p[0]), sub(p[2], p[0]));
        return mul(1 / norm(n), n);
    }
    void expect_in_facet(std::uint32_t id, std::uint32_t f, Real slack) {
        const Vec corner = vec(complex_.points[complex_.segments[complex_.facet_sides[f][0].segment][0]]);
        const Real off = std::abs(dot(sub(at(id), corner), normal(f)));
        expect(off <= slack + 4 * noise_, "point " + std::to_string(id) + " is off facet " + std::to_string(f));
        expect(is_inside_facet(complex_, f, at(id)),
               "point " + std::to_string(id) + " is outside facet " + std::to_string(f));
    }

    void check_chains() {
        for (std::uint32_t s = 0; s < complex_.segments.size(); ++s) {
            const auto chain = area_.chains[s];
            const auto links = area_.link_balls[s];
            const auto& [a, b] = complex_.segments[s];
            expect(chain.size() >= 2 && chain.front() == a && chain.back() == b, "a chain does not join the ends");
            expect(links.size() + 1 == chain.size(), "links do not match the chain");
            const Vec start = at(a), end = at(b);
            const bool covered = !balls_.segment_balls[s].empty();
            for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
                const Vec p = at(chain[i]), q = at(chain[i + 1]);
                expect(distance(p, start) < distance(q, start),
                       "chain of segment " + std::to_string(s) + " out of order");
                expect(distance_to_segment(p, start, end) <= noise_, "chain point off its segment");
                expect(!covered || links[i] != no_index, "a covered segment has a free link");
                if (links[i] == no_index) continue;
                const Ball& ball = area_.balls[links[i]];
                for (const Vec& x : {p, q}) {
                    expect(distance(x, vec(ball.center)) <= ball.radius + tolerance(ball), "a link leaves its ball");
                }
            }
            const std::size_t balls_here = balls_.segment_balls[s].size();
            const std::size_t ends = (balls_.vertex_balls[a] != no_index) + (balls_.vertex_balls[b] != no_index);
            expect(chain.size() == (covered ? 2 * balls_here - 1 : 2 + ends), "wrong number of points on a segment");
        }
    }

    void check_points() {
        for (std::uint32_t i = 0; i < area_.points.size(); ++i) {
            const NewPoint& p = area_.points[i];
            const std::uint32_t id = area_.input_points + i;
            const Ball& first = area_.balls[p.balls[0]];
            const Vec x = vec(p.position);
            if (p.on_segment()) {
                const Vec start = vec(complex_.points[complex_.segments[p.owner][0]]);
                expect(std::abs(distance(x, start) - p.distance) <= noise_ + 1e-12L * first.radius,
                       "distance along segment");
            } else {
                expect_in_facet(id, p.owner, 1e-12L * first.radius);
            }
            switch (p.role) {
                case PointRole::center:
                    expect(x.x == first.center.x && x.y == first.center.y, "centre elsewhere");
                    break;
                case PointRole::h: {
                    const Ball& second = area_.balls[p.balls[1]];
                    const Vec u = sub(x, vec(first.center)), v = sub(x, vec(second.center));
                    const Real r = first.radius, q = second.radius;
                    const Real power = dot(u, u) - r * r, other = dot(v, v) - q * q;
                    expect(std::abs(power - other) <= 8 * noise_ * (r + q) + 1e-12L * (r * r + q * q),
                           "h off the radical plane");
                    expect(power < 0 && other < 0, "h outside its balls");
                    break;
                }
                case PointRole::p:
                    expect_on_sphere(id, p.balls[1]);
                    [[fallthrough]];
                default:
                    expect_on_sphere(id, p.balls[0]);
            }
        }
    }

    Real angle_at(const Vec& o, std::uint32_t a, std::uint32_t b) const {
        const Vec u = sub(at(a), o), v = sub(at(b), o);
        return std::atan2(norm(cross(u, v)), dot(u, v));
    }

    void add_piece(std::map<std::uint32_t, Fan>& fans, std::uint32_t f, std::uint32_t ball, std::uint32_t a,
                   std::uint32_t b) {
        const Vec o = center(ball), n = vec(complex_.frames[f].normal);
        expect(dot(cross(sub(at(a), o), sub(at(b), o)), n) > 0,
               "a piece is not counter-clockwise in facet " + std::to_string(f));
        const Vec middle = mul(1.0L / 3, add(o, add(at(a), at(b))));
        expect(is_inside_facet(complex_, f, middle), "a piece is outside facet " + std::to_string(f));
        Fan& fan = fans[ball];
        fan.angle += angle_at(o, a, b);
        ++fan.starts[a];
        ++fan.ends[b];
    }

    /// Sum of the facet's angles around a point of it: between neighbouring sides, inside by counting crossings.
    Real facet_angle(std::uint32_t f, const Ball& ball) const {
        const Vec o = vec(ball.center), u = vec(complex_.frames[f].u), v = vec(complex_.frames[f].v);
        std::vector<Real> rays;
        for (const Side& side : complex_.facet_sides[f]) {
            const auto& [a, b] = complex_.segments[side.segment];
            for (const std::uint32_t end : {a, b}) {
                const std::uint32_t other = end == a ? b : a;
                if (!segment_contains(complex_, side.segment, carrier_of(ball))) continue;
                if (ball.kind == BallKind::vertex && other != ball.index) continue;
                const Vec d = sub(vec(complex_.points[end]), o);
                rays.push_back(std::atan2(dot(d, v), dot(d, u)));
            }
        }
        if (rays.empty()) return 2 * pi;
        std::sort(rays.begin(), rays.end());
        Real sum = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Real width = i + 1 < rays.size() ? rays[i + 1] - rays[i] : rays[0] + 2 * pi - rays[i];
            const Real middle = rays[i] + width / 2;
            const Vec d = add(mul(std::cos(middle), u), mul(std::sin(middle), v));
            if (is_inside_facet(complex_, f, add(o, mul(0.5L * ball.radius, d)))) sum += width;
        }
        return sum;
    }

    void check_facet(std::uint32_t f) {
        std::map<std::uint32_t, Fan> fans;
        std::set<std::uint32_t> isolated;
        for (const ShieldEdge& e : area_.shields[f]) {
            expect(e.facet == f, "a shield edge is filed under another facet");
            expect_on_sphere(e.a, e.ball);
            expect_on_sphere(e.b, e.ball);
            const Vec o = center(e.ball);
            expect(dot(sub(at(e.a), o), sub(at(e.b), o)) > 0, "an isosceles angle is not below 90 degrees");
            expect(area_.isosceles(e)[0] == area_.ball_centers[e.ball], "isosceles triangle without its centre");
            add_piece(fans, f, e.ball, e.a, e.b);
        }
        for (const RightTriangle& t : area_.right_angled[f]) {
            const auto& [o, a, b] = t.points;
            expect(o == area_.ball_centers[t.ball], "right-angled triangle without its centre");
            const bool a_is_h = area_.new_point(a).role == PointRole::h;
            const Vec h = at(a_is_h ? a : b), p = at(a_is_h ? b : a), u = sub(center(t.ball), h), w = sub(p, h);
            expect(std::abs(dot(u, w)) <= 8 * noise_ * (norm(u) + norm(w)) + 1e-12L * norm(u) * norm(w),
                   "angle at h is not right");
            expect_on_sphere(a_is_h ? b : a, t.ball);
            add_piece(fans, f, t.ball, a, b);
        }
        for (const auto& [ball, fan] : fans) {
            for (const auto& [id, count] : fan.starts) expect(count == 1, "two pieces start at one ray");
            for (const auto& [id, count] : fan.ends) expect(count == 1, "two pieces end at one ray");
        }
        expect_filled(f, fans);
    }

    void expect_filled(std::uint32_t f, const std::map<std::uint32_t, Fan>& fans) {
        std::size_t expected = 0;
        for (std::uint32_t i : balls_at(f)) {
            ++expected;
            const auto found = fans.find(i);
            const Real angle = found == fans.end() ? 0 : found->second.angle;
            const Ball& ball = area_.balls[i];
            const Real slack = 1e-9L + 64 * noise_ / ball.radius;
            expect(std::abs(angle - facet_angle(f, ball)) <= slack,
                   "sectors of facet " + std::to_string(f) + " in the " + name(ball) + " are not filled: " +
                       std::to_string(double(angle)) + " of " + std::to_string(double(facet_angle(f, ball))));
        }
        expect(expected == fans.size(), "facet " + std::to_string(f) + " has pieces in foreign balls");
    }

    /// Balls centred on the facet.
    std::vector<std::uint32_t> balls_at(std::uint32_t f) const {
        std::set<std::uint32_t> result;
        const auto add_vertex = [&](std::uint32_t v) {
            if (balls_.vertex_balls[v] != no_index) result.insert(balls_.vertex_balls[v]);
        };
        for (const Side& side : complex_.facet_sides[f]) {
            for (const std::uint32_t ball : balls_.segment_balls[side.segment]) result.insert(ball);
            for (const std::uint32_t v : complex_.segments[side.segment]) add_vertex(v);
        }
        for (const std::uint32_t v : complex_.facet_points[f]) add_vertex(v);
        return {result.begin(), result.end()};
    }

    void check_distinct() {
        std::set<std::tuple<double, double, double>> places;
        for (const Point3& p : complex_.points) places.emplace(p.x, p.y, p.z);
        for (const NewPoint& p : area_.points) {
            expect(places.emplace(p.position.x, p.position.y, p.position.z).second, "two points at one place");
        }
    }

    const Complex& complex_;
    const ProtectingBalls& balls_;
    const ProtectedArea& area_;
    Real noise_;
    Findings out_;
};

}  // namespace

std::string Findings::text() const {
    std::string all = std::to_string(count) + " findings";
    for (const std::string& s : sentences) all += "\n  " + s;
    return all;
}

Findings check_balls(const Complex& complex, const ProtectingBalls& balls, const ProtectedSet& set, bool all_faces) {
    Findings out;
    check_cover(complex, balls, set, out);
    check_pairs(complex, balls, out);
    if (!all_faces) return out;
    for (const Ball& ball : balls.balls) {
        const Real size = feature_size(complex, carrier_of(ball), vec(ball.center));
        if (!(size > ball.radius)) out.add("(iv) a face that does not contain its centre meets the " + name(ball));
    }
    return out;
}

Findings check_area(const Complex& complex, const ProtectingBalls& balls, const ProtectedArea& area) {
    return AreaChecker(complex, balls, area).check();
}

Findings check_right_triangles_gabriel(const Complex& complex, const ProtectedArea& area) {
    Findings out;
    std::vector<Vec> points;
    for (const Point3& p : complex.points) points.push_back(vec(p));
    for (const NewPoint& p : area.points) points.push_back(vec(p.position));
    const Real slack = noise(complex);
    for (const RightTriangle& t : area.right_angled.values) {
        // The right angle is at h: the circumcircle has the other two as a diameter.
        const std::uint32_t p = area.new_point(t.points[1]).role == PointRole::h ? t.points[2] : t.points[1];
        const Vec middle = mul(0.5L, add(points[t.points[0]], points[p]));
        const Real radius = 0.5L * distance(points[t.points[0]], points[p]);
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            if (distance(points[i], middle) < radius * (1 - 1e-11L) - slack) {
                out.add("point " + std::to_string(i) + " encroaches upon a right-angled triangle of facet " +
                        std::to_string(t.facet));
            }
        }
    }
    return out;
}

}  // namespace certa::oracle
