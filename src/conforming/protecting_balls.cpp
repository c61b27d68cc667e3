// Construction of the protecting balls (thesis, Part I, 1.3) for any set of vertices and segments to protect.
//
// Balls at vertices have radius alpha lfs. A segment is covered gap by gap: a ball in the middle of each gap between
// consecutive balls, as large as the local feature size allows but never reaching further than halfway into its
// neighbours, until the gaps are closed. Radii shrink only with the feature size, so two balls that are not neighbours
// on a segment never meet (1.3, proof of Proposition 10), whatever part of the complex is protected.
#include "conforming/protecting_balls.h"

#include <algorithm>
#include <cmath>

#include "conforming/extended_vector.h"

namespace certa::conforming {
namespace {

// Neighbours whose overlap or gap is below this part of the smallest radius count as tangent (condition vi) ...
constexpr double tangency = 1e-3;
// ... and the new ball is shrunk by this part, which leaves a gap that the next ball covers generously.
constexpr double shrinking = 1e-2;

/// Direction in the facet's plane perpendicular to a segment, and how exactly the input's doubles define it.
struct Sheetwise {
    Vector direction;
    long double rounding = 0.0L;
};

/// The facet's point farthest from the segment's line decides: it defines the plane best.
Sheetwise sheet_direction(const Complex& complex, const FacetInterior& interior, std::uint32_t segment,
                          std::uint32_t facet, std::uint8_t cover) {
    const auto& [first, second] = complex.segments[segment];
    const Point3& origin = complex.points[first];
    const Vector along = normalized(difference(complex.points[second], origin));
    Vector widest;
    for (const auto& triangle : interior.triangles[facet]) {
        for (const std::uint32_t v : triangle) {
            const Vector d = difference(complex.points[v], origin);
            const Vector across = d - dot(d, along) * along;
            if (dot(across, across) > dot(widest, widest)) widest = across;
        }
    }
    const Vector left = cross(Vector(complex.frames[facet].normal), along);
    const long double width = length(widest);
    const bool opposite = (dot(widest, left) > 0) != ((cover & cover_left) != 0);
    const long double largest = std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)}) + width;
    // Each coordinate is known to half an ulp; a few such errors, seen from the segment at the distance of the point.
    const long double span = length(difference(complex.points[second], origin));
    const long double noise = 8.0L * std::numeric_limits<double>::epsilon() * largest * (1.0L / width + 1.0L / span);
    return {(opposite ? -1.0L / width : 1.0L / width) * widest, noise};
}

class BallBuilder {
public:
    BallBuilder(const Complex& complex, const LocalFeatureSize& feature_size, const ProtectedSet& set,
                const BallOptions& options, const RunControl& control)
        : complex_(complex), feature_size_(feature_size), set_(set), options_(options), control_(control) {}

    ProtectingBalls build() && {
        result_.vertex_balls.assign(complex_.points.size(), no_index);
        for (std::uint32_t v = 0; v < complex_.points.size() && go_on(v); ++v) {
            if (set_.vertices[v]) place_at_vertex(v);
        }
        for (std::uint32_t s = 0; s < complex_.segments.size() && go_on(s); ++s) {
            row_.clear();
            if (set_.segments[s]) cover(s);
            result_.segment_balls.push_row(row_);
        }
        return std::move(result_);
    }

private:
    bool go_on(std::uint32_t count) {
        if (count % 1024 == 0 && result_.outcome == Outcome::done && control_.cancelled()) {
            result_.outcome = Outcome::cancelled;
        }
        return result_.outcome == Outcome::done;
    }

    /// Adds a ball unless it breaks a limit; says which face came too near.
    bool add(const Ball& ball, const FeatureSize& size) {
        const bool small = !(ball.radius > 0.0) || ball.radius < options_.min_radius;
        const bool many = result_.balls.size() >= options_.max_balls;
        if (small || many) {
            result_.outcome = small ? Outcome::below_min_feature : Outcome::over_budget;
            const auto kind = ball.kind == BallKind::vertex ? ElementKind::vertex : ElementKind::segment;
            result_.obstacle = BallObstacle{{kind, ball.index}, size.nearest, ball.center, ball.radius};
            return false;
        }
        result_.balls.push_back(ball);
        return true;
    }

    void place_at_vertex(std::uint32_t v) {
        // A lone point has no feature near it; the diagonal (or, without any, one unit) keeps the radius finite.
        const double limit = complex_.diagonal > 0.0 ? complex_.diagonal : 1.0;
        const FeatureSize size = feature_size_.at_vertex(v, limit);
        const Ball ball{complex_.points[v], options_.alpha * size.value, BallKind::vertex, v, 0.0};
        if (add(ball, size)) result_.vertex_balls[v] = static_cast<std::uint32_t>(result_.balls.size() - 1);
    }

    void cover(std::uint32_t s) {
        const auto& [first, second] = complex_.segments[s];
        const Vector start(complex_.points[first]), span = Vector(complex_.points[second]) - start;
        const auto total = static_cast<double>(length(span));
        struct Stop {
            std::uint32_t ball;
            double distance, radius;
        };
        const std::uint32_t from = result_.vertex_balls[first], to = result_.vertex_balls[second];
        // Balls to the right of the last one in row_, nearest on top: the gap before the top is worked on.
        std::vector<Stop> waiting{{to, total, result_.balls[to].radius}};
        Stop left{from, 0.0, result_.balls[from].radius};
        row_.push_back(left.ball);
        std::size_t work = 0;
        while (!waiting.empty() && go_on(static_cast<std::uint32_t>(++work))) {
            const Stop right = waiting.back();
            const double begin = left.distance + left.radius, end = right.distance - right.radius;
            if (begin > end) {
                row_.push_back(right.ball);
                left = right;
                waiting.pop_back();
                continue;
            }
            const double half = 0.5 * (end - begin), middle = begin + half;
            const Point3 center = (start + (middle / static_cast<long double>(total)) * span).rounded();
            const double smaller = std::min(left.radius, right.radius), largest = half + 0.5 * smaller;
            const FeatureSize size = feature_size_.on_segment(s, center, largest / options_.alpha);
            double radius = std::min(options_.alpha * size.value, largest);
            if (std::abs(radius - half) < tangency * std::min(smaller, half)) radius = (1.0 - shrinking) * half;
            if (!add({center, radius, BallKind::segment, s, middle}, size)) return;
            waiting.push_back({static_cast<std::uint32_t>(result_.balls.size() - 1), middle, radius});
        }
        sort_segment();
    }

    /// Renumbers the balls of the segment just covered by their distance, as they stand in row_.
    void sort_segment() {
        if (row_.size() < 3) return;
        const auto base = *std::min_element(row_.begin() + 1, row_.end() - 1);
        std::vector<Ball> sorted;
        for (std::size_t i = 1; i + 1 < row_.size(); ++i) sorted.push_back(result_.balls[row_[i]]);
        for (std::size_t i = 1; i + 1 < row_.size(); ++i) {
            result_.balls[base + i - 1] = sorted[i - 1];
            row_[i] = static_cast<std::uint32_t>(base + i - 1);
        }
    }

    const Complex& complex_;
    const LocalFeatureSize& feature_size_;
    const ProtectedSet& set_;
    const BallOptions& options_;
    const RunControl& control_;
    ProtectingBalls result_;
    std::vector<std::uint32_t> row_;
};

}  // namespace

ProtectedSet protect_nothing(const Complex& complex) {
    return {std::vector<std::uint8_t>(complex.points.size(), 0), std::vector<std::uint8_t>(complex.segments.size(), 0)};
}

ProtectedSet protect_all(const Complex& complex) {
    ProtectedSet set = protect_nothing(complex);
    for (std::uint32_t v = 0; v < complex.points.size(); ++v) set.vertices[v] = complex.is_ignored(v) ? 0 : 1;
    for (std::uint32_t s = 0; s < complex.segments.size(); ++s) set.segments[s] = complex.is_dropped(s) ? 0 : 1;
    return set;
}

ProtectedSet protect_sharp(const Complex& complex, const FacetInterior& interior) {
    ProtectedSet set = protect_all(complex);
    for (std::uint32_t s = 0; s < complex.segments.size(); ++s) {
        set.segments[s] = set.segments[s] != 0 && is_sharp_segment(complex, interior, s) ? 1 : 0;
    }
    return set;
}

void close_under_ends(ProtectedSet& set, const Complex& complex) {
    for (std::uint32_t s = 0; s < complex.segments.size(); ++s) {
        if (!set.segments[s]) continue;
        for (const std::uint32_t v : complex.segments[s]) set.vertices[v] = 1;
    }
}

bool is_sharp_segment(const Complex& complex, const FacetInterior& interior, std::uint32_t segment) {
    const auto sheets = interior.sheets[segment];
    std::size_t count = 0;
    for (const Sheet& sheet : sheets) count += (sheet.cover & cover_left ? 1 : 0) + (sheet.cover & cover_right ? 1 : 0);
    if (sheets.size() < 2 || count < 2) return false;
    if (count > 4) return true;  // five directions around a line cannot all be 90 degrees apart
    std::vector<Sheetwise> directions;
    for (const Sheet& sheet : sheets) {
        for (const std::uint8_t side : {cover_left, cover_right}) {
            if (sheet.cover & side)
                directions.push_back(sheet_direction(complex, interior, segment, sheet.facet, side));
        }
    }
    for (std::size_t i = 0; i < directions.size(); ++i) {
        for (std::size_t j = i + 1; j < directions.size(); ++j) {
            const Sheetwise &d = directions[i], &e = directions[j];
            if (dot(d.direction, e.direction) > d.rounding + e.rounding) return true;
        }
    }
    return false;
}

ProtectingBalls build_protecting_balls(const Complex& complex, const LocalFeatureSize& feature_size, ProtectedSet set,
                                       const BallOptions& options, const RunControl& control) {
    close_under_ends(set, complex);
    return BallBuilder(complex, feature_size, set, options, control).build();
}

}  // namespace certa::conforming
