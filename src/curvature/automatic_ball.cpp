// A radius per vertex from the data (docs/curvature.md: fixed rings do not converge, a radius like sqrt(h) does).
//
// A ladder of radii, sqrt(2) apart, in units of the local edge length. From one rung to the next the estimate changes
// by noise where the ball is too small and by the surface's own variation where it is too large; the radius between the
// two rungs where it changes least is a balance of both (the quasi-optimality criterion, a relative of Lepski's).
// Changes are averaged over the vertex and its neighbours, or chance would choose; places on the ladder are smoothed.
// One traversal serves all rungs: for the choice, not for the estimate, a dual cell counts as a point mass at its
// vertex, and the order 2 kernel (1 - r^2 / R^2)^2 of every radius R comes from sums of 1, r^2 and r^4.
#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "curvature/estimators.h"

namespace certa::curvature {
namespace {

constexpr std::size_t rungs = 6;
constexpr double first_rung = 2.0;  // in edge lengths

double rung(double k) { return first_rung * std::pow(2.0, 0.5 * k); }

/// A tensor and an area.
struct CellMass {
    SymmetricTensor3 tensor;
    double area = 0.0;
    void add_scaled(double factor, const CellMass& other) {
        add(tensor, factor, other.tensor);
        area += factor * other.area;
    }
};

double change(const CellMass& a, const CellMass& b) {
    if (!(a.area > 0.0) || !(b.area > 0.0)) return 0.0;
    const double p = 1.0 / a.area, q = 1.0 / b.area;
    const SymmetricTensor3 &s = a.tensor, &t = b.tensor;
    const auto d = [&](double x, double y) { return (p * x - q * y) * (p * x - q * y); };
    return std::sqrt(d(s.xx, t.xx) + d(s.yy, t.yy) + d(s.zz, t.zz) +
                     2.0 * (d(s.xy, t.xy) + d(s.xz, t.xz) + d(s.yz, t.yz)));
}

/// The sums of all rungs around a vertex; one per thread.
class Ladder {
public:
    Ladder(const Surface& surface, const Cells& cells)
        : surface_(surface), cells_(cells), marks_(surface.positions.size()) {}

    /// Under the kernel, or the indicator; `edge` is the local edge length. Connected within the ball of each rung.
    std::array<CellMass, rungs> climb(Index vertex, double edge, bool kernel) {
        std::array<double, rungs> squares;
        for (std::size_t k = 0; k < rungs; ++k) squares[k] = std::pow(rung(static_cast<double>(k)) * edge, 2.0);
        marks_.clear();
        for (auto& queue : queues_) queue.clear();
        queues_[0].push_back(vertex);
        marks_.mark(vertex);
        const Point3 center = surface_.positions[vertex];
        std::array<CellMass, rungs> result;
        CellMass zeroth, second, fourth;
        for (std::size_t k = 0; k < rungs; ++k) {
            for (std::size_t i = 0; i < queues_[k].size(); ++i) {
                const Index v = queues_[k][i];
                const Point3 d = surface_.positions[v] - center;
                const double square = dot(d, d);
                const CellRecord& record = cells_.records[v];
                const CellMass cell{record.swapped, record.area};
                zeroth.add_scaled(1.0, cell);
                if (kernel) second.add_scaled(square, cell), fourth.add_scaled(square * square, cell);
                for (const Index w : surface_.vertex_neighbors[v]) enter(w, center, squares, k);
            }
            result[k] = zeroth;
            if (!kernel) continue;
            result[k].add_scaled(-2.0 / squares[k], second);
            result[k].add_scaled(1.0 / (squares[k] * squares[k]), fourth);
        }
        return result;
    }

private:
    /// A neighbour of a vertex of rung k belongs to the first rung from k on whose ball holds it.
    void enter(Index w, const Point3& center, const std::array<double, rungs>& squares, std::size_t k) {
        if (!marks_.mark(w)) return;
        const Point3 d = surface_.positions[w] - center;
        const double square = dot(d, d);
        while (k < rungs && square > squares[k]) ++k;
        if (k < rungs) queues_[k].push_back(w);
    }

    const Surface& surface_;
    const Cells& cells_;
    Marks marks_;
    std::array<std::vector<Index>, rungs> queues_;
};

class AutomaticBallEstimator : public VertexEstimator {
public:
    AutomaticBallEstimator(const BallContext& context, Weight weight, const std::vector<double>& radii)
        : context_(context), walker_(context), weight_(weight), radii_(radii) {}
    void estimate(Index vertex, VertexRow& row) override {
        row.radius = radii_[vertex];
        row.sums = walker_.sum(vertex, context_.surface.positions[vertex], row.radius, weight_);
        finish_normal_cycle(context_.surface, vertex, row);
    }

private:
    const BallContext& context_;
    BallWalker walker_;
    Weight weight_;
    const std::vector<double>& radii_;
};

class AutomaticBallFactory : public EstimatorFactory {
public:
    AutomaticBallFactory(const Surface& surface, const Cells& cells, Weight weight, const RunControl& control)
        : context_{surface, cells, build_hinge_tensors(surface, control)},
          weight_(weight),
          radii_(surface.positions.size()) {
        // The order-4 kernel's own sums are not monotonous in the radius: its ladder is that of order 2.
        if (weight_ == Weight::kernel4) weight_ = Weight::kernel2;
        choose(control);
    }
    std::unique_ptr<VertexEstimator> make() const override {
        return std::make_unique<AutomaticBallEstimator>(context_, weight_, radii_);
    }

private:
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
        Pool<Ladder> pool;
        constexpr std::size_t slice = 65536;
        for (std::size_t start = 0; start < n; start += slice) {
            control.report("choose radii", static_cast<double>(start) / static_cast<double>(n));
            if (control.cancelled()) return;
            core::parallel_for(std::min(slice, n - start), 256, control, [&](std::size_t begin, std::size_t end) {
                auto ladder = pool.take([&] { return std::make_unique<Ladder>(surface, context_.cells); });
                for (std::size_t v = start + begin; v < start + end; ++v) {
                    const auto vertex = static_cast<Index>(v);
                    edges[v] = local_edge(vertex);
                    const auto sums = ladder->climb(vertex, edges[v], weight_ != Weight::indicator);
                    for (std::size_t k = 1; k < rungs; ++k)
                        changes[v][k - 1] = static_cast<float>(edges[v] * change(sums[k - 1], sums[k]));
                }
                pool.give_back(std::move(ladder));
            });
        }
        const std::vector<double> chosen = smoothed(find_least(changes, control), control);
        for (std::size_t v = 0; v < n; ++v) radii_[v] = rung(chosen[v]) * edges[v];
    }

    /// Per vertex, the place on the ladder between the rungs where the estimate changes least.
    std::vector<double> find_least(const std::vector<std::array<float, rungs - 1>>& changes,
                                   const RunControl& control) const {
        const Surface& surface = context_.surface;
        std::vector<double> places(changes.size());
        core::parallel_for(changes.size(), 4096, control, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                std::array<double, rungs - 1> average{};
                const auto take = [&](Index w) {
                    for (std::size_t k = 0; k + 1 < rungs; ++k) average[k] += static_cast<double>(changes[w][k]);
                };
                take(static_cast<Index>(v));
                for (const Index w : surface.vertex_neighbors[v]) take(w);
                const auto least = std::min_element(average.begin(), average.end()) - average.begin();
                places[v] = static_cast<double>(least) + 0.5;
            }
        });
        return places;
    }

    /// Radii that jump between neighbours would show as patches.
    std::vector<double> smoothed(std::vector<double> places, const RunControl& control) const {
        constexpr int rounds = 4;
        std::vector<double> next(places.size());
        for (int round = 0; round < rounds; ++round) {
            core::parallel_for(places.size(), 4096, control, [&](std::size_t begin, std::size_t end) {
                for (std::size_t v = begin; v < end; ++v) {
                    double sum = places[v], count = 1.0;
                    for (const Index w : context_.surface.vertex_neighbors[v]) sum += places[w], count += 1.0;
                    next[v] = sum / count;
                }
            });
            places.swap(next);
        }
        return places;
    }

    BallContext context_;
    Weight weight_;
    std::vector<double> radii_;
};

}  // namespace

FactoryPointer make_automatic_ball_factory(const Surface& surface, const Cells& cells, Weight weight,
                                           const RunControl& control) {
    return std::make_unique<AutomaticBallFactory>(surface, cells, weight, control);
}

}  // namespace certa::curvature
