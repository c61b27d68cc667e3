// Branch and bound over pieces of triangles. A piece P is done when an upper bound of the distances of its points is
// small enough; else it is cut. Two upper bounds:
//
// Convexity: the distance to one triangle t is a convex function, so over P it is largest at a corner of P.
//
// Covering projection: project along the normal n of P. Start at a polygon near P and walk over every side that meets
// P. Suppose that every polygon met is a simple counter-clockwise polygon in projection, and that every side met has
// one polygon beyond it. Then the projections cover P, if they meet it at all: what they cover is closed, and open in
// P, because around a point on a side or at a corner the walk has visited all polygons there, each turning forward. A
// triangulation of a polygon covers at least its simple projection. So each x in P has a point of `to` straight above
// or below it, and the largest height over P, an affine function on each triangle clipped to P, is an upper bound. P is
// shrunk a little first, so that a crease along its side does no harm; the shrinking is added to the bound.
//
// Signs that rounding may have spoilt count against the bound, heights get a margin for it.
#include "verify/distance_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/vector3.h"

namespace certa::verify {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double rounding = 1e-13;  // coordinates are at most 1: hundreds of operations stay far below this
constexpr double inflation = 1e-13;

struct Piece {
    std::array<Point3, 3> p;
    std::uint32_t hint = no_index;  // a triangle of `to` that may be near
    double slack = 0.0;
    std::uint32_t polygon = 0;
};
struct Verdict {
    double upper = infinite;
    double lower = 0.0;
    Point3 place;
    std::uint32_t hint = no_index;
};
/// A point in the frame of a piece: in its plane, and above it.
struct Projected {
    double u = 0.0, v = 0.0, height = 0.0;
};

double turn(const Projected& a, const Projected& b, const Projected& c) {
    return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}
/// A turn that rounding cannot have made: coordinates are good to 2e-15.
double least_turn(const Projected& a, const Projected& b, const Projected& c) {
    return 1e-14 * (std::abs(b.u - a.u) + std::abs(b.v - a.v) + std::abs(c.u - a.u) + std::abs(c.v - a.v));
}
bool surely_left(const Projected& a, const Projected& b, const Projected& c) {
    return turn(a, b, c) > least_turn(a, b, c);
}
bool surely_right(const Projected& a, const Projected& b, const Projected& c) {
    return turn(a, b, c) < -least_turn(a, b, c);
}
/// The segments surely have no point in common.
bool surely_apart(const Projected& a, const Projected& b, const Projected& c, const Projected& d) {
    return (surely_left(a, b, c) && surely_left(a, b, d)) || (surely_right(a, b, c) && surely_right(a, b, d)) ||
           (surely_left(c, d, a) && surely_left(c, d, b)) || (surely_right(c, d, a) && surely_right(c, d, b));
}

/// Simple and counter-clockwise, beyond doubt. Corners without a turn are fine, spikes are not.
bool surely_simple(const std::vector<Projected>& ring) {
    const std::size_t n = ring.size();
    if (n == 3) return surely_left(ring[0], ring[1], ring[2]);
    constexpr std::size_t largest = 32;
    if (n > largest) return false;
    double area = 0.0, doubt = 0.0;
    for (std::size_t i = 1; i + 1 < n; ++i) {
        area += turn(ring[0], ring[i], ring[i + 1]);
        doubt += least_turn(ring[0], ring[i], ring[i + 1]);
    }
    if (!(area > doubt)) return false;
    for (std::size_t i = 0; i < n; ++i) {
        const Projected &a = ring[i], &b = ring[(i + 1) % n], &c = ring[(i + 2) % n];
        const double along = (b.u - a.u) * (c.u - b.u) + (b.v - a.v) * (c.v - b.v);
        const bool is_spike = !surely_left(a, b, c) && !surely_right(a, b, c) && !(along > 0.0);
        if (is_spike) return false;
        for (std::size_t j = i + 2; j < n; ++j) {
            if (i == 0 && j + 1 == n) continue;
            if (!surely_apart(a, b, ring[j], ring[(j + 1) % n])) return false;
        }
    }
    return true;
}

/// A triangle in its own plane, shrunk towards its incentre.
class Window {
public:
    /// `shrinking`: no point may move farther.
    Window(const std::array<Point3, 3>& p, double shrinking) {
        const Point3 normal = cross(p[1] - p[0], p[2] - p[0]);
        const double sides[3] = {distance(p[1], p[2]), distance(p[2], p[0]), distance(p[0], p[1])};
        const double length = norm(normal), perimeter = sides[0] + sides[1] + sides[2];
        if (!(length > 1e-7 * perimeter * perimeter)) return;  // too thin for a plane
        is_valid_ = true;
        origin_ = p[0];
        n_ = (1.0 / length) * normal;
        u_ = (1.0 / sides[2]) * (p[1] - p[0]);
        v_ = cross(n_, u_);
        centre_ = (1.0 / perimeter) * (sides[0] * p[0] + sides[1] * p[1] + sides[2] * p[2]);
        double reach = 0.0;
        for (const Point3& corner : p) reach = std::max(reach, distance(corner, centre_));
        const double factor = 1.0 - std::min(0.5, shrinking / reach);
        shrinking_ = (1.0 - factor) * reach;
        for (std::size_t i = 0; i < 3; ++i) corners_[i] = project(centre_ + factor * (p[i] - centre_));
        for (std::size_t i = 0; i < 3; ++i) {
            const Projected &a = corners_[i], &b = corners_[(i + 1) % 3];
            const double size = std::hypot(b.u - a.u, b.v - a.v);
            lines_[i] = {-(b.v - a.v) / size, (b.u - a.u) / size, 0.0};
            lines_[i].offset = -(lines_[i].u * a.u + lines_[i].v * a.v);
        }
    }

    bool is_valid() const { return is_valid_; }
    double shrinking() const { return shrinking_; }
    const Point3& centre() const { return centre_; }
    Projected project(const Point3& p) const {
        const Point3 d = p - origin_;
        return {dot(u_, d), dot(v_, d), dot(n_, d)};
    }

    /// False only if the segment surely misses the window.
    bool may_meet(const Projected& a, const Projected& b) const {
        double first = 0.0, last = 1.0;
        for (const Line& line : lines_) {
            const double at_a = line.at(a) + inflation, at_b = line.at(b) + inflation;
            if (at_a < 0.0 && at_b < 0.0) return false;
            if (at_a >= 0.0 && at_b >= 0.0) continue;
            const double cut = at_a / (at_a - at_b);
            if (at_a < 0.0) {
                first = std::max(first, cut - 1e-9);
            } else {
                last = std::min(last, cut + 1e-9);
            }
        }
        return first <= last;
    }

    /// The part of a triangle inside the window, its lines moved outwards by `growth`: largest |height|, negative if
    /// there is no such part.
    double largest_height(const std::array<Projected, 3>& t, double growth) const {
        std::array<Projected, 9> polygon{t[0], t[1], t[2]}, next;
        std::size_t size = 3;
        for (const Line& line : lines_) {
            std::size_t kept = 0;
            for (std::size_t i = 0; i < size; ++i) {
                const Projected &a = polygon[i], &b = polygon[(i + 1) % size];
                const double at_a = line.at(a) + growth, at_b = line.at(b) + growth;
                if (at_a >= 0.0) next[kept++] = a;
                if ((at_a >= 0.0) != (at_b >= 0.0)) {
                    const double s = std::clamp(at_a / (at_a - at_b), 0.0, 1.0);
                    next[kept++] = {a.u + s * (b.u - a.u), a.v + s * (b.v - a.v), a.height + s * (b.height - a.height)};
                }
            }
            polygon = next;
            size = kept;
            if (size == 0) return -1.0;
        }
        double largest = 0.0;
        for (std::size_t i = 0; i < size; ++i) largest = std::max(largest, std::abs(polygon[i].height));
        return largest;
    }

private:
    struct Line {
        double u = 0.0, v = 0.0, offset = 0.0;
        double at(const Projected& p) const { return u * p.u + v * p.v + offset; }
    };
    bool is_valid_ = false;
    Point3 origin_, u_, v_, n_, centre_;
    double shrinking_ = 0.0;
    std::array<Projected, 3> corners_;
    std::array<Line, 3> lines_;
};

/// Judges pieces; one for each thread.
class Judge {
public:
    Judge(const PolygonSurface& to, const core::TriangleTree& tree)
        : to_(to), tree_(tree), visited_(to.polygon_count(), 0) {}

    Verdict judge(const Piece& piece, double enough, double shrinking) {
        Verdict verdict;
        verdict.hint = piece.hint;
        const double slack = piece.slack + rounding;
        if (piece.hint != no_index) verdict.upper = convex_bound(piece.p, to_.polygon_of(piece.hint)) + slack;
        if (verdict.upper <= enough) return verdict;
        const Window window(piece.p, shrinking);
        verdict.place = window.is_valid() ? window.centre() : (1.0 / 3.0) * (piece.p[0] + piece.p[1] + piece.p[2]);
        const core::NearestPoint nearest = tree_.find_nearest(verdict.place, piece.hint);
        verdict.hint = nearest.triangle;
        std::uint32_t near = to_.polygon_of(nearest.triangle);
        verdict.lower = piece.slack + farthest_choice(verdict.place, near);
        verdict.upper = std::min(verdict.upper, convex_bound(piece.p, near) + slack);
        if (verdict.upper > enough && verdict.lower + slack < enough && window.is_valid())
            verdict.upper = std::min(verdict.upper, covering_bound(window, near, enough - slack) + slack);
        return verdict;
    }

private:
    /// The largest distance of x from `to` over all choices of triangulations, which are free: the nearest polygon
    /// counts, each at its worst. It is what the bounds of smaller and smaller pieces tend to; that a polygon whose
    /// unchosen triangles alone are near may be overlooked makes it larger and the search stop earlier. `near` becomes
    /// that polygon.
    double farthest_choice(const Point3& x, std::uint32_t& near) {
        double least = convex_bound({x, x, x}, near);
        if (!to_.has_choices()) return least;
        const Point3 reach{least, least, least};
        tree_.visit_box(x - reach, x + reach, [&](std::uint32_t t) {
            if (to_.polygon_of(t) == near) return;
            const double other = convex_bound({x, x, x}, to_.polygon_of(t));
            if (other < least) least = other, near = to_.polygon_of(t);
        });
        return least;
    }

    /// For every triangulation of q the nearest triangle counts, among triangulations the worst.
    double convex_bound(const std::array<Point3, 3>& p, std::uint32_t q) {
        squares_.clear();
        for (const PolygonSurface::Corners& corners : to_.possible(q)) {
            const std::array<Point3, 3> t = to_.points(corners);
            double largest = 0.0;
            for (std::size_t i = 0; i < 3; ++i) {
                if (i > 0 && p[i] == p[0]) continue;
                largest = std::max(largest, core::find_nearest_on_triangle(p[i], t[0], t[1], t[2]).squared_distance);
            }
            squares_.push_back(largest);
        }
        double worst = 0.0;
        for (std::size_t k = 0; k < to_.choice_count(q); ++k) {
            double best = infinite;
            for (const std::uint32_t i : to_.choice(q, k)) best = std::min(best, squares_[i]);
            worst = std::max(worst, best);
        }
        return std::sqrt(worst) + to_.slack(q);
    }

    void project_ring(const Window& window, std::uint32_t q) {
        ring_.clear();
        for (const std::uint32_t v : to_.polygon(q)) ring_.push_back(window.project(to_.positions()[v]));
    }

    double covering_bound(const Window& window, std::uint32_t start, double enough) {
        epoch_ += 2;
        stack_.clear();
        const auto visit = [&](std::uint32_t q, bool is_turned) {  // false: reached before, the other way round
            const std::uint32_t mark = epoch_ + (is_turned ? 1 : 0);
            if (visited_[q] >= epoch_) return visited_[q] == mark;
            visited_[q] = mark;
            stack_.push_back(q);
            return true;
        };
        project_ring(window, start);
        visit(start, !surely_simple(ring_));
        double largest = 0.0;
        bool is_met = false;
        while (!stack_.empty()) {
            const std::uint32_t q = stack_.back();
            stack_.pop_back();
            const bool is_turned = visited_[q] == epoch_ + 1;
            project_ring(window, q);
            if (is_turned) std::reverse(ring_.begin(), ring_.end());
            if (!surely_simple(ring_)) return infinite;
            for (const PolygonSurface::Corners& corners : to_.possible(q)) {
                const std::array<Point3, 3> points = to_.points(corners);
                const std::array<Projected, 3> t{window.project(points[0]), window.project(points[1]),
                                                 window.project(points[2])};
                const double height = window.largest_height(t, inflation);
                if (height >= 0.0) largest = std::max(largest, height + to_.slack(q));
                is_met = is_met || window.largest_height(t, -10.0 * inflation) >= 0.0;
            }
            if (largest + window.shrinking() > enough) return infinite;
            const std::size_t n = ring_.size();
            for (std::size_t k = 0; k < n; ++k) {
                if (!window.may_meet(ring_[k], ring_[(k + 1) % n])) continue;
                const std::size_t i = is_turned ? (2 * n - 2 - k) % n : k;  // the side, as the polygon counts
                const std::uint32_t next = to_.across(q, i);
                if (next == no_index || !visit(next, is_turned != to_.walks_alike(q, i))) return infinite;
            }
        }
        return is_met ? largest + window.shrinking() : infinite;
    }

    const PolygonSurface& to_;
    const core::TriangleTree& tree_;
    std::vector<std::uint32_t> visited_, stack_;
    std::uint32_t epoch_ = 0;
    std::vector<Projected> ring_;
    std::vector<double> squares_;
};

void cut(const Piece& piece, std::uint32_t hint, std::vector<Piece>& out) {
    const auto& p = piece.p;
    const auto middle = [](const Point3& a, const Point3& b) { return 0.5 * (a + b); };
    std::array<double, 3> sides{distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])};
    const auto longest = static_cast<std::size_t>(std::max_element(sides.begin(), sides.end()) - sides.begin());
    const Point3 &a = p[longest], &b = p[(longest + 1) % 3], &c = p[(longest + 2) % 3];
    const Point3 ab = middle(a, b);
    if (sides[longest] > 1.5 * std::max(sides[(longest + 1) % 3], sides[(longest + 2) % 3]) ||
        norm(cross(b - a, c - a)) < 0.5 * sides[longest] * sides[longest]) {
        out.push_back({{a, ab, c}, hint, piece.slack, piece.polygon});
        out.push_back({{ab, b, c}, hint, piece.slack, piece.polygon});
        return;
    }
    const Point3 bc = middle(b, c), ca = middle(c, a);
    out.push_back({{a, ab, ca}, hint, piece.slack, piece.polygon});
    out.push_back({{ab, b, bc}, hint, piece.slack, piece.polygon});
    out.push_back({{ca, bc, c}, hint, piece.slack, piece.polygon});
    out.push_back({{ab, bc, ca}, hint, piece.slack, piece.polygon});
}

/// Triangles that occur in a triangulation. A sliver on a diagonal (a corner without a turn) is left out: it is within
/// its width of the diagonal, which another triangle has; at most three such are on top of each other. Their widths
/// are added to the bound.
std::vector<Piece> make_pieces(const PolygonSurface& from, double resolution, double& extra) {
    std::vector<Piece> pieces;
    for (std::size_t q = 0; q < from.polygon_count(); ++q) {
        const auto ring = from.polygon(q);
        const auto is_diagonal = [&](std::uint32_t a, std::uint32_t b) {
            const auto i = static_cast<std::size_t>(std::find(ring.begin(), ring.end(), a) - ring.begin());
            return ring[(i + 1) % ring.size()] != b && ring[(i + ring.size() - 1) % ring.size()] != b;
        };
        for (const PolygonSurface::Corners& t : from.possible(q)) {
            const std::array<Point3, 3> p = from.points(t);
            if (ring.size() > 3 && ring.size() <= 6) {
                const double sides[3] = {distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])};
                const auto longest = static_cast<std::size_t>(std::max_element(sides, sides + 3) - sides);
                const double width = norm(cross(p[1] - p[0], p[2] - p[0])) / sides[longest];
                if (width < 0.01 * resolution && is_diagonal(t[longest], t[(longest + 1) % 3])) {
                    extra = std::max(extra, 3.0 * width);
                    continue;
                }
            }
            pieces.push_back({p, no_index, from.slack(q), static_cast<std::uint32_t>(q)});
        }
    }
    return pieces;
}

std::vector<Verdict> judge_all(const std::vector<Piece>& pieces, const PolygonSurface& to,
                               const core::TriangleTree& tree, double enough, double shrinking,
                               const RunControl& control) {
    std::vector<Verdict> verdicts(pieces.size());
    const std::size_t grain = std::max<std::size_t>(1024, to.polygon_count() / 16);
    core::parallel_for(pieces.size(), grain, control, [&](std::size_t begin, std::size_t end) {
        Judge judge(to, tree);
        for (std::size_t i = begin; i < end; ++i) {
            if (i % 256 == 0 && control.cancelled()) return;
            verdicts[i] = judge.judge(pieces[i], enough, shrinking);
        }
    });
    return verdicts;
}

}  // namespace

DistanceBound bound_distance(const PolygonSurface& from, const PolygonSurface& to, const core::TriangleTree& tree,
                             const BoundOptions& options, const RunControl& control) {
    DistanceBound result;
    result.lowest = options.lowest;
    double extra = 0.0;
    std::vector<Piece> pieces = make_pieces(from, options.resolution, extra), next;
    std::size_t looked_at = 0;
    while (!pieces.empty()) {
        const auto enough = [&] { return std::max(result.lowest * (1.0 + options.tolerance), options.resolution); };
        const double enough_before = enough(), shrinking = 0.25 * (enough_before - result.lowest);
        looked_at += pieces.size();
        const std::vector<Verdict> verdicts = judge_all(pieces, to, tree, enough_before, shrinking, control);
        if (control.cancelled()) {
            result.is_cancelled = true;
            return result;
        }
        for (const Verdict& verdict : verdicts)
            if (verdict.lower > result.lowest) result.lowest = verdict.lower, result.place = verdict.place;
        const double enough_now = enough();
        const bool is_over = looked_at >= options.max_pieces;
        next.clear();
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (verdicts[i].upper <= enough_now || is_over) {
                result.bound = std::max(result.bound, verdicts[i].upper);
                result.is_tight = result.is_tight && verdicts[i].upper <= enough_now;
            } else {
                cut(pieces[i], verdicts[i].hint, next);
            }
        }
        pieces.swap(next);
    }
    result.bound += extra;
    return result;
}

std::vector<FarPiece> find_far_pieces(const PolygonSurface& from, const PolygonSurface& to,
                                      const core::TriangleTree& tree, double limit, std::size_t max_pieces,
                                      const RunControl& control) {
    double extra = 0.0;
    std::vector<Piece> pieces = make_pieces(from, 0.01 * limit, extra), next;
    const double enough = limit - extra, least = 0.98 * enough;
    std::vector<FarPiece> far;
    std::size_t looked_at = 0;
    while (!pieces.empty() && !control.cancelled()) {
        looked_at += pieces.size();
        const std::vector<Verdict> verdicts = judge_all(pieces, to, tree, enough, 0.25 * (enough - least), control);
        next.clear();
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const Verdict& verdict = verdicts[i];
            if (verdict.upper <= enough) continue;
            if (verdict.lower > least || looked_at >= max_pieces)
                far.push_back({pieces[i].polygon, to.polygon_of(verdict.hint), verdict.place});
            else
                cut(pieces[i], verdict.hint, next);
        }
        pieces.swap(next);
    }
    std::stable_sort(far.begin(), far.end(), [](const auto& a, const auto& b) { return a.polygon < b.polygon; });
    return far;
}

}  // namespace certa::verify
