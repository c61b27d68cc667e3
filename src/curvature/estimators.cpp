// The thesis's estimator over rings and balls (2.5, docs/curvature.md).
//
// Each factory makes one walker per thread over shared, read-only data. A kernel of order 4 takes negative weights:
// where its total is less than half of what a flat disc has (borders, thin parts), the kernel of order 2 takes its
// place.
#include "curvature/estimators.h"

#include <numbers>

namespace certa::curvature {
namespace {

class RingEstimator : public VertexEstimator {
public:
    RingEstimator(const Surface& surface, const Cells& cells, std::uint64_t rings, Rim rim, Weight weight)
        : surface_(surface), walker_(surface, cells), rings_(rings), rim_(rim), weight_(weight) {}
    void estimate(Index vertex, VertexRow& row) override {
        row.sums =
            weight_ == Weight::indicator ? walker_.sum(vertex, rings_, rim_) : walker_.sum_tapered(vertex, rings_);
        finish_normal_cycle(surface_, vertex, row);
    }

private:
    const Surface& surface_;
    RingWalker walker_;
    std::uint64_t rings_;
    Rim rim_;
    Weight weight_;
};

class RingFactory : public EstimatorFactory {
public:
    RingFactory(const Surface& surface, const Cells& cells, std::uint64_t rings, Rim rim, Weight weight)
        : surface_(surface), cells_(cells), rings_(rings), rim_(rim), weight_(weight) {}
    std::unique_ptr<VertexEstimator> make() const override {
        return std::make_unique<RingEstimator>(surface_, cells_, rings_, rim_, weight_);
    }

private:
    const Surface& surface_;
    const Cells& cells_;
    std::uint64_t rings_;
    Rim rim_;
    Weight weight_;
};

/// A walker, connected or over all sheets.
template <class Walker>
class BallEstimator : public VertexEstimator {
public:
    BallEstimator(Walker walker, const Surface& surface, double radius, Weight weight)
        : walker_(std::move(walker)), surface_(surface), radius_(radius), weight_(weight) {}
    void estimate(Index vertex, VertexRow& row) override {
        row.sums = sum(vertex, weight_);
        if (weight_ == Weight::kernel4 && !is_safe_kernel4(row.sums.area, radius_)) {
            row.sums = sum(vertex, Weight::kernel2);
            row.flags |= vertex_flags::fallback;
        }
        finish_normal_cycle(surface_, vertex, row);
    }

private:
    Sums sum(Index vertex, Weight weight) {
        if constexpr (std::is_same_v<Walker, SheetWalker>)
            return walker_.sum(surface_.positions[vertex], radius_, weight);
        else
            return walker_.sum(vertex, surface_.positions[vertex], radius_, weight);
    }
    Walker walker_;
    const Surface& surface_;
    double radius_;
    Weight weight_;
};

class BallFactory : public EstimatorFactory {
public:
    BallFactory(const Surface& surface, const Cells& cells, double radius, Weight weight, bool all_sheets,
                const RunControl& control)
        : context_{surface, cells, build_hinge_tensors(surface, control)}, radius_(radius), weight_(weight) {
        if (all_sheets) tree_ = build_face_tree(surface, cells);
    }
    std::unique_ptr<VertexEstimator> make() const override {
        if (!tree_.nodes.empty())
            return std::make_unique<BallEstimator<SheetWalker>>(SheetWalker(context_, tree_), context_.surface, radius_,
                                                                weight_);
        return std::make_unique<BallEstimator<BallWalker>>(BallWalker(context_), context_.surface, radius_, weight_);
    }

private:
    BallContext context_;
    FaceTree tree_;
    double radius_;
    Weight weight_;
};

}  // namespace

bool is_safe_kernel4(double area, double radius) { return area > 0.5 * std::numbers::pi / 8.0 * radius * radius; }

void finish_normal_cycle(const Surface& surface, Index vertex, VertexRow& row) {
    const Sums& sums = row.sums;
    if (!(sums.area > 0.0)) {
        row.flags |= vertex_flags::undefined;
        return;
    }
    row.principal = compute_principal(sums, surface.normals[vertex]);
    row.mean = sums.swapped.trace() / sums.area;
    row.gaussian = sums.gaussian / sums.area;
    if (row.principal.normal == Point3{}) row.flags |= vertex_flags::undefined;
}

FactoryPointer make_ring_factory(const Surface& surface, const Cells& cells, std::uint64_t rings, Rim rim,
                                 Weight weight) {
    return std::make_unique<RingFactory>(surface, cells, rings, rim, weight);
}

FactoryPointer make_ball_factory(const Surface& surface, const Cells& cells, double radius, Weight weight,
                                 bool all_sheets, const RunControl& control) {
    return std::make_unique<BallFactory>(surface, cells, radius, weight, all_sheets, control);
}

}  // namespace certa::curvature
