// A thicker W (docs/implicit-theorem.md, "any mesh"). The W of a proof is as thick as the proof needed it. Here the
// sign of f is forgotten on regular leaves near the zero set, so that W may grow into them and its frontier is proved
// anew.
//
// Plan: split critical leaves, which W never enters, where they are in the way; forget; grow, check the conditions.
// Where they fail, leaves nearby remember their signs; where nothing is left to remember, the offenders are split, as
// in the main loop. If a limit is met or it takes too many rounds the tree is put back.
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
        for (int round = 0; round < most_rounds && !from_.is_too_large() && !from_.control.cancelled(); ++round) {
            from_.control.report("certify", 0.99);
            forget();
            Triangulation triangulation(tree_, field_, from_.signs);
            Growth growth = grow(triangulation);
            Findings findings =
                check_conditions(tree_, triangulation, growth, clusters_, from_.tape, from_.control, proved_);
            if (from_.control.cancelled()) break;
            if (findings.offenders.empty())
                return ProvedW{std::move(triangulation), std::move(growth), std::move(findings)};
            if (!mend(findings.offenders)) break;
        }
        tree_ = before;
        return std::nullopt;
    }

private:
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
