// Edge collapses in a patch, guarded one by one.
//
// The error of a vertex is the sum of squared distances to the planes of the triangles that it stands for. A collapse
// is refused where it would change the topology (link condition), join two corners of the border, make a needle, turn a
// triangle by much or away from the input, or leave the input by more than the tolerance.
#include "remeshing/thin_out.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "remeshing/segment_distance.h"

namespace certa::remeshing {
namespace {

using Quadric = std::array<double, 10>;

void add_plane(Quadric& q, const Point3& n, double d) {
    const std::array<double, 4> p{n.x, n.y, n.z, d};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i; j < 4; ++j) q[k++] += p[i] * p[j];
}
double value_at(const Quadric& q, const Point3& p) {
    const std::array<double, 4> x{p.x, p.y, p.z, 1.0};
    double sum = 0.0;
    std::size_t k = 0;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i; j < 4; ++j) sum += q[k++] * x[i] * x[j] * (i == j ? 1.0 : 2.0);
    return std::max(sum, 0.0);
}

struct Candidate {
    double cost = 0.0;
    Index from = no_index, to = no_index;
    std::uint32_t stamp = 0;
    friend bool operator<(const Candidate& a, const Candidate& b) {  // the least first
        if (a.cost != b.cost) return a.cost > b.cost;
        return a.from != b.from ? a.from > b.from : a.to > b.to;
    }
};

class Thinner {
public:
    Thinner(RegionPatch& patch, const std::vector<Point3>& points, const Judge& judge, const ThinningRule& rule,
            const RunControl& control)
        : patch_(patch), judge_(judge), rule_(rule), control_(control), origin_(points[0]) {
        for (const Point3& p : points) points_.push_back(p - origin_);
        const std::size_t n = points.size();
        if (rule.side_tolerance > 0.0) side_scale_ = std::pow(rule.tolerance / rule.side_tolerance, 2);
        around_.resize(n), creases_.resize(n), quadrics_.resize(n), stamps_.assign(n, 0);
        for (Index t = 0; t < patch.triangles.size(); ++t)
            for (const Index v : patch.triangles[t]) around_[v].push_back(t);
        is_alive_.assign(patch.triangles.size(), 1);
        for (const FeatureEdge& e : patch.feature_edges) {
            creases_[e.a].push_back({e.b, e.curve});
            creases_[e.b].push_back({e.a, e.curve});
        }
        for (const auto& [a, b] : patch.minor_edges) {
            creases_[a].push_back({b, minor});
            creases_[b].push_back({a, minor});
        }
        side_of_.assign(n, no_index);
        for (Index k = 0; k < patch.sides.size(); ++k) {
            const auto& corners = patch.sides[k].corners;
            for (std::size_t i = 0; i < corners.size(); ++i) {
                if (i > 0 && i + 1 < corners.size()) side_of_[corners[i]] = k;
                if (i == 0) continue;
                creases_[corners[i - 1]].push_back({corners[i], first_side + k});
                creases_[corners[i]].push_back({corners[i - 1], first_side + k});
            }
            side_lengths_.push_back(distance(points[corners.front()], points[corners.back()]));
        }
        for (const auto& t : patch.triangles) {
            const Point3 area = cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]);
            if (!(norm(area) > 0.0)) continue;
            const Point3 normal = (1.0 / norm(area)) * area;
            for (const Index v : t) add_plane(quadrics_[v], normal, -dot(normal, points_[t[0]]));
        }
    }

    void run() {
        vertices_ = points_.size();
        for (Index v = 0; v < points_.size(); ++v) push(v);
        for (std::size_t count = 0; !queue_.empty(); ++count) {
            if (count % 1024 == 0 && control_.cancelled()) break;
            const Candidate next = queue_.top();
            queue_.pop();
            if (around_[next.from].empty() || next.stamp != stamps_[next.from]) continue;
            if (next.cost > rule_.tolerance * rule_.tolerance || vertices_ <= rule_.least_vertices) break;
            if (!may_collapse(next.from, next.to)) continue;
            collapse(next.from, next.to);
            --vertices_;
        }
        write_back();
    }

private:
    static constexpr Index first_side = 1U << 31, minor = first_side - 1;  ///< numbers of curves
    bool is_outer(Index v) const { return v < patch_.outer.size(); }
    bool is_on_rim(Index v) const { return is_outer(v) || side_of_[v] != no_index; }
    std::vector<Index> neighbours(Index v) const {
        std::vector<Index> list;
        for (const Index t : around_[v])
            for (const Index w : patch_.triangles[t])
                if (w != v) list.push_back(w);
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        return list;
    }
    bool is_free(Index v) const {
        if (is_outer(v) || rule_.is_fixed[v] != 0) return false;
        const auto& list = creases_[v];
        return list.empty() || (list.size() == 2 && list[0].second == list[1].second);
    }
    void push(Index v) {
        ++stamps_[v];
        if (!is_free(v)) return;
        for (const Index w : neighbours(v)) {
            if (!creases_[v].empty() && w != creases_[v][0].first && w != creases_[v][1].first) continue;
            double cost = value_at(quadrics_[v], points_[w]);
            if (side_of_[v] != no_index) cost *= side_scale_;
            queue_.push({cost, v, w, stamps_[v]});
        }
    }
    bool may_collapse(Index v, Index w) const {
        const std::vector<Index> of_v = neighbours(v), of_w = neighbours(w);
        std::vector<Index> common;
        std::set_intersection(of_v.begin(), of_v.end(), of_w.begin(), of_w.end(), std::back_inserter(common));
        std::size_t shared = 0;
        for (const Index t : around_[v]) {
            const auto& c = patch_.triangles[t];
            if (std::find(c.begin(), c.end(), w) != c.end()) ++shared;
        }
        if (common.size() != shared) return false;
        if (around_[v].size() <= shared && (side_of_[v] == no_index || patch_.triangles.size() < 4)) return false;
        if (around_[w].size() + around_[v].size() < (is_on_rim(w) ? 1 : 3) + 2 * shared) return false;
        for (const Index x : common) {
            const std::size_t least = is_on_rim(x) ? 2 : 4;
            if ((is_on_rim(x) || creases_[x].empty()) && around_[x].size() < least) return false;
        }
        if (is_outer(w))
            for (const Index x : of_v)
                if (x != w && is_outer(x) && !std::binary_search(of_w.begin(), of_w.end(), x) && is_joined(w, x))
                    return false;
        if (!creases_[v].empty()) {
            const Index other = beyond(v, w);
            const bool closes = std::any_of(creases_[w].begin(), creases_[w].end(),
                                            [&](const auto& crease) { return crease.first == other; });
            double reach = 0.3 * rule_.tolerance;
            if (const Index k = side_of_[v]; k != no_index)
                reach = std::max(
                    reach, patch_.sides[k].curve == no_index ? rule_.side_share * side_lengths_[k] : rule_.side_reach);
            if (other == w || closes || distance_to_segment(points_[v], points_[w], points_[other]) > reach)
                return false;
        }
        return std::all_of(around_[v].begin(), around_[v].end(), [&](Index t) { return is_sound(t, v, w); });
    }
    bool is_joined(Index v, Index w) const {
        const Index a = patch_.outer[v], b = patch_.outer[w];
        return std::binary_search(rule_.joined.begin(), rule_.joined.end(), std::array{std::min(a, b), std::max(a, b)});
    }
    /// On the curve of v, the neighbour that w is not.
    Index beyond(Index v, Index w) const { return creases_[v][creases_[v][0].first == w ? 1 : 0].first; }
    /// Triangle t with v moved to w.
    bool is_sound(Index t, Index v, Index w) const {
        std::array<Index, 3> moved = patch_.triangles[t];
        std::array<Point3, 3> p{}, before{};
        for (std::size_t i = 0; i < 3; ++i) {
            if (moved[i] == w) return true;  // goes
            before[i] = points_[moved[i]];
            if (moved[i] == v) moved[i] = w;
            p[i] = points_[moved[i]];
        }
        const Point3 area = cross(p[1] - p[0], p[2] - p[0]), old = cross(before[1] - before[0], before[2] - before[0]);
        const auto longest = [](const std::array<Point3, 3>& q) {
            return std::max(
                {dot(q[1] - q[0], q[1] - q[0]), dot(q[2] - q[1], q[2] - q[1]), dot(q[0] - q[2], q[0] - q[2])});
        };
        const double size = norm(area), shape = size / longest(p), old_shape = norm(old) / longest(before);
        if (shape < 0.05 && !(shape > old_shape)) return false;
        if (!(dot(area, old) > 0.3 * size * norm(old))) return false;
        const Point3 middle = origin_ + (1.0 / 3.0) * (p[0] + p[1] + p[2]);
        const double reach = side_of_[v] == no_index ? rule_.tolerance : rule_.side_tolerance;
        if (judge_.tree.find_nearest(middle).squared_distance > reach * reach) return false;
        return !judge_.is_turned_away(origin_ + p[0], origin_ + p[1], origin_ + p[2]);
    }
    void collapse(Index v, Index w) {
        for (const Index t : around_[v]) {
            auto& c = patch_.triangles[t];
            if (std::find(c.begin(), c.end(), w) != c.end()) {
                is_alive_[t] = 0;
                for (const Index x : c)
                    if (x != v) std::erase(around_[x], t);
            } else {
                std::replace(c.begin(), c.end(), v, w);
                around_[w].push_back(t);
            }
        }
        around_[v].clear();
        if (!creases_[v].empty()) {
            const auto [other, curve] = creases_[v][0].first == w ? creases_[v][1] : creases_[v][0];
            for (const Index end : {w, other})
                std::erase_if(creases_[end], [&](const auto& crease) { return crease.first == v; });
            creases_[w].push_back({other, curve});
            creases_[other].push_back({w, curve});
            creases_[v].clear();
        }
        for (std::size_t i = 0; i < 10; ++i) quadrics_[w][i] += quadrics_[v][i];
        push(w);
        for (const Index x : neighbours(w)) push(x);
    }
    void write_back() {
        RegionPatch out;
        out.outer = patch_.outer;
        const Index outer = static_cast<Index>(patch_.outer.size());
        std::vector<Index> numbers(points_.size(), no_index);
        for (Index v = 0; v < outer; ++v) numbers[v] = v;
        for (Index v = outer; v < points_.size(); ++v) {
            if (around_[v].empty()) continue;
            numbers[v] = outer + static_cast<Index>(out.inner.size());
            out.inner.push_back(patch_.inner[v - outer]);
        }
        for (Index t = 0; t < patch_.triangles.size(); ++t) {
            if (is_alive_[t] == 0) continue;
            const auto& c = patch_.triangles[t];
            out.triangles.push_back({numbers[c[0]], numbers[c[1]], numbers[c[2]]});
        }
        for (Index v = 0; v < points_.size(); ++v)
            for (const auto& [w, curve] : creases_[v]) {
                if (v > w || curve >= first_side) continue;
                if (curve == minor)
                    out.minor_edges.push_back({numbers[v], numbers[w]});
                else
                    out.feature_edges.push_back({numbers[v], numbers[w], curve});
            }
        for (RegionSide& side : patch_.sides) {
            RegionSide kept{{}, side.curve};
            for (const Index v : side.corners)
                if (numbers[v] != no_index) kept.corners.push_back(numbers[v]);
            out.sides.push_back(std::move(kept));
        }
        patch_ = std::move(out);
    }

    RegionPatch& patch_;
    const Judge& judge_;
    const ThinningRule& rule_;
    const RunControl& control_;
    const Point3 origin_;  ///< quadrics lose less near zero
    std::vector<Point3> points_;
    std::vector<std::vector<Index>> around_;
    std::vector<std::vector<std::pair<Index, Index>>> creases_;  ///< per vertex: the other end, the curve
    std::vector<Index> side_of_;                                 ///< per vertex between the ends of a side
    std::vector<double> side_lengths_;
    double side_scale_ = 1.0;  ///< of costs, so that one limit does for all
    std::vector<Quadric> quadrics_;
    std::vector<std::uint32_t> stamps_;
    std::vector<std::uint8_t> is_alive_;
    std::priority_queue<Candidate> queue_;
    std::size_t vertices_ = 0;
};

}  // namespace

void thin_out(RegionPatch& patch, const std::vector<Point3>& points, const Judge& judge, const ThinningRule& rule,
              const RunControl& control) {
    if (!patch.triangles.empty()) Thinner(patch, points, judge, rule, control).run();
}

}  // namespace certa::remeshing
