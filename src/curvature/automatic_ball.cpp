// A radius per vertex from the data (docs/curvature.md: fixed rings do not converge, a radius like sqrt(h) does).
//
// A ladder of radii, sqrt(2) apart, in units of the local edge length. From one rung to the next the estimate changes
// by noise where the ball is too small and by the surface's own variation where it is too large; the rung where it
// changes least is a balance of both (the quasi-optimality criterion, a relative of Lepski's). Changes are averaged
// over the vertex and its neighbours, or chance would choose.
#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "curvature/estimators.h"

namespace certa::curvature {
namespace {

constexpr std::size_t rungs = 6;
constexpr double first_rung = 2.0;  // in edge lengths

double rung(std::size_t k) { return first_rung * std::pow(2.0, 0.5 * static_cast<double>(k)); }

double change(const Sums& a, const Sums& b) {
    if (!(a.area > 0.0) || !(b.area > 0.0)) return 0.0;
    const double p = 1.0 / a.area, q = 1.0 / b.area;
    const SymmetricTensor3 &s = a.swapped, &t = b.swapped;
    const auto d = [&](double x, double y) { return (p * x - q * y) * (p * x - q * y); };
    return std::sqrt(d(s.xx, t.xx) + d(s.yy, t.yy) + d(s.zz, t.zz) +
                     2.0 * (d(s.xy, t.xy) + d(s.xz, t.xz) + d(s.yz, t.yz)));
}

/// Walks connected balls, or all sheets where there is a tree.
class AnyWalker {
public:
    AnyWalker(const BallContext& context, const FaceTree* tree) : context_(context), connected_(context) {
        if (tree != nullptr) sheets_.emplace(context, *tree);
    }
    Sums sum(Index v, double radius, Weight weight) {
        const Point3& center = context_.surface.positions[v];
        return sheets_ ? sheets_->sum(center, radius, weight) : connected_.sum(v, center, radius, weight);
    }

private:
    const BallContext& context_;
    BallWalker connected_;
    std::optional<SheetWalker> sheets_;
};

class AutomaticBallEstimator : public VertexEstimator {
public:
    AutomaticBallEstimator(const BallContext& context, const FaceTree* tree, Weight weight,
                           const std::vector<double>& radii)
        : context_(context), walker_(context, tree), weight_(weight), radii_(radii) {}
    void estimate(Index vertex, VertexRow& row) override {
        row.radius = radii_[vertex];
        row.sums = walker_.sum(vertex, row.radius, weight_);
        finish_normal_cycle(context_.surface, vertex, row);
    }

private:
    const BallContext& context_;
    AnyWalker walker_;
    Weight weight_;
    const std::vector<double>& radii_;
};

class AutomaticBallFactory : public EstimatorFactory {
public:
    AutomaticBallFactory(const Surface& surface, const Cells& cells, Weight weight, bool all_sheets,
                         const RunControl& control)
        : context_{surface, cells, build_hinge_tensors(surface, control)},
          weight_(weight),
          radii_(surface.positions.size()) {
        // The order-4 kernel's own sums are not monotonous in the radius: its ladder is that of order 2.
        if (weight_ == Weight::kernel4) weight_ = Weight::kernel2;
        if (all_sheets) tree_ = build_face_tree(surface, cells);
        choose(control);
    }
    std::unique_ptr<VertexEstimator> make() const override {
        return std::make_unique<AutomaticBallEstimator>(context_, tree_or_null(), weight_, radii_);
    }

private:
    const FaceTree* tree_or_null() const { return tree_.nodes.empty() ? nullptr : &tree_; }

    double local_edge(Index v) const {
        const Surface& surface = context_.surface;
        double sum = 0.0;
        std::size_t count = 0;
        const auto add_star = [&](Index u) {
            for (const Index w : surface.vertex_neighbors[u])
                sum += distance(surface.positions[u], surface.positions[w]), ++count;
        };
        add_star(v);
        for (const Index w : surface.vertex_neighbors[v]) add_star(w);
        return count > 0 ? sum / static_cast<double>(count) : 0.0;
    }

    void choose(const RunControl& control) {
        const Surface& surface = context_.surface;
        const std::size_t n = surface.used_vertices;
        std::vector<double> edges(n);
        std::vector<std::array<float, rungs - 1>> changes(n);
        Pool<AnyWalker> pool;
        constexpr std::size_t slice = 65536;
        for (std::size_t start = 0; start < n; start += slice) {
            control.report("choose radii", static_cast<double>(start) / static_cast<double>(n));
            if (control.cancelled()) return;
            core::parallel_for(std::min(slice, n - start), 256, control, [&](std::size_t begin, std::size_t end) {
                auto walker = pool.take([&] { return std::make_unique<AnyWalker>(context_, tree_or_null()); });
                for (std::size_t v = start + begin; v < start + end; ++v) {
                    const auto vertex = static_cast<Index>(v);
                    edges[v] = local_edge(vertex);
                    Sums before = walker->sum(vertex, rung(0) * edges[v], weight_);
                    for (std::size_t k = 1; k < rungs; ++k) {
                        const Sums sums = walker->sum(vertex, rung(k) * edges[v], weight_);
                        changes[v][k - 1] = static_cast<float>(edges[v] * change(before, sums));
                        before = sums;
                    }
                }
                pool.give_back(std::move(walker));
            });
        }
        core::parallel_for(n, 4096, control, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                std::array<double, rungs - 1> average{};
                const auto take = [&](Index w) {
                    for (std::size_t k = 0; k + 1 < rungs; ++k) average[k] += static_cast<double>(changes[w][k]);
                };
                take(static_cast<Index>(v));
                for (const Index w : surface.vertex_neighbors[v]) take(w);
                const auto least =
                    static_cast<std::size_t>(std::min_element(average.begin(), average.end()) - average.begin());
                radii_[v] = rung(least) * edges[v];
            }
        });
    }

    BallContext context_;
    FaceTree tree_;
    Weight weight_;
    std::vector<double> radii_;
};

}  // namespace

FactoryPointer make_automatic_ball_factory(const Surface& surface, const Cells& cells, Weight weight, bool all_sheets,
                                           const RunControl& control) {
    return std::make_unique<AutomaticBallFactory>(surface, cells, weight, all_sheets, control);
}

}  // namespace certa::curvature
