// A thicker W (docs/implicit-theorem.md, "any mesh"). The W of a proof is as thick as the proof needed it. Here the
// sign of f is forgotten on regular leaves near the zero set, so that W may grow into them and its frontier is proved
// anew.
//
// Plan: split critical leaves, which W never enters, where they are in the way; forget; grow, nearest first, so that
// the fronts meet far from the zero set; check the conditions. Where they fail, leaves nearby remember their signs;
// where nothing is left to remember, the offenders are split, as in the main loop. If a limit is met or it takes too
// many rounds the tree is put back.
#include "implicit/thicken.h"

#include <algorithm>
#include <cmath>

namespace certa::implicit {
namespace {

constexpr int most_rounds = 12;

class Thickener {
public:
    Thickener(const Thickening& from, double reach)
        : from_(from), tree_(from.tree), reach_(reach), field_(from.tape), clusters_(from.clusters) {}

    std::optional<ProvedW> run() {
        const Octree before = tree_;
        if (!split_critical()) return put_back(before);
        for (int round = 0; round < most_rounds && !from_.is_too_large() && !from_.control.cancelled(); ++round) {
            from_.control.report("certify", 0.99);
            forget();
            Triangulation triangulation(tree_, field_, from_.signs);
            Growth growth = grow(triangulation, distances(triangulation), from_.control);
            Findings findings =
                check_conditions(tree_, triangulation, growth, clusters_, from_.tape, from_.control, proved_);
            if (from_.control.cancelled()) break;
            if (findings.offenders.empty())
                return ProvedW{std::move(triangulation), std::move(growth), std::move(findings)};
            if (!mend(findings.offenders)) break;
        }
        return put_back(before);
    }

private:
    std::nullopt_t put_back(const Octree& before) {
        tree_ = before;
        return std::nullopt;
    }

    /// Critical leaves near the zero set get smaller, as long as that does not take too many.
    bool split_critical() {
        const std::size_t most = tree_.cells().size() / 2;
        bool any = false;
        for (int generation = 0; generation < 4 && !from_.control.cancelled(); ++generation) {
            std::vector<std::uint32_t> split;
            for (const std::uint32_t leaf : tree_.leaves()) {
                const Cell& cell = tree_.cell(leaf);
                if (cell.is_critical() && !tree_.touches_boundary(cell) && is_in_the_way(cell)) split.push_back(leaf);
            }
            if (split.empty() || 8 * split.size() > most) break;
            if (split_all(tree_, split, from_.tape, from_.limits, from_.control)) return false;
            any = true;
        }
        if (any) clusters_ = find_clusters(tree_);
        return true;
    }

    void forget() {
        state_.resize(tree_.cells().size(), 0);
        sign_.resize(tree_.cells().size(), 0);
        for (const std::uint32_t leaf : tree_.leaves()) {
            Cell& cell = tree_.cell(leaf);
            if (state_[leaf] != 0) continue;
            state_[leaf] = kept;
            if (cell.known.sign == 0 || cell.known.slope == 0 || tree_.touches_boundary(cell) || !is_near(cell))
                continue;
            sign_[leaf] = cell.known.sign;
            state_[leaf] = forgotten;
            cell.known.sign = 0;
        }
    }

    /// Leaves around offenders remember their signs; offenders without any are split.
    bool mend(const std::vector<std::uint32_t>& offenders) {
        std::vector<std::uint32_t> split;
        for (const std::uint32_t leaf : offenders) {
            bool any = false;
            tree_.visit_around_corners(tree_.cell(leaf), [&](std::uint32_t other) {
                if (state_[other] != forgotten) return;
                tree_.cell(other).known.sign = sign_[other];
                state_[other] = kept;
                any = true;
            });
            if (!any) split.push_back(leaf);
        }
        if (split.empty() || split.size() < offenders.size()) return true;
        bool critical = false;
        for (const std::uint32_t leaf : split) critical = critical || tree_.cell(leaf).is_critical();
        if (split_all(tree_, split, from_.tape, from_.limits, from_.control)) return false;
        if (critical) clusters_ = find_clusters(tree_);
        return true;
    }

    /// About how far points of leaves without a sign are from the zero set: W grows evenly, whatever the sizes of
    /// leaves.
    std::vector<float> distances(const Triangulation& triangulation) {
        std::vector<float> result(triangulation.point_count(), 0);
        for (std::uint32_t p = 0; p < result.size(); ++p) {
            if (!triangulation.may_join(p)) continue;
            const double d = distance_at(tree_.points()[p]);
            result[p] = d < HUGE_VALF ? static_cast<float>(d) : HUGE_VALF;
        }
        return result;
    }

    /// About how far a point is from the zero set.
    double distance_at(const GridPoint& p) {
        const auto& jet = field_.slope(tree_.grid().place(p));
        return std::fabs(jet.value) / std::hypot(jet.gradient[0], jet.gradient[1], jet.gradient[2]);
    }

    /// Whether some corner of a leaf is within reach of the zero set.
    bool is_in_the_way(const Cell& cell) {
        const GridPoint high = tree_.high_of(cell);
        for (unsigned c = 0; c < 8; ++c) {
            const GridPoint corner{c & 1u ? high[0] : cell.low[0], c & 2u ? high[1] : cell.low[1],
                                   c & 4u ? high[2] : cell.low[2]};
            if (distance_at(corner) <= reach_) return true;
        }
        return false;
    }

    /// Whether the zero set seems to be within reach of a leaf.
    bool is_near(const Cell& cell) {
        const Region box = tree_.region_of(cell);
        const auto& jet = field_.slope(tree_.grid().place(tree_.center_of(cell)));
        const double half = std::hypot(interval::width(box[0]), interval::width(box[1]), interval::width(box[2])) / 2;
        return std::fabs(jet.value) <= (reach_ + half) * std::hypot(jet.gradient[0], jet.gradient[1], jet.gradient[2]);
    }

    static constexpr char kept = 1, forgotten = 2;

    const Thickening& from_;
    Octree& tree_;
    double reach_;
    Field field_;
    std::vector<Cluster> clusters_;
    std::vector<char> state_;         ///< per cell: kept or forgotten; 0: a new leaf
    std::vector<std::int8_t> sign_;   ///< per forgotten cell: what it was
    std::vector<ProvedFace> proved_;  ///< of the frontier of the last round
};

}  // namespace

std::optional<ProvedW> thicken(const Thickening& from, double reach) { return Thickener(from, reach).run(); }

}  // namespace certa::implicit
