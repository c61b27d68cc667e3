// f = g h: the zero set is that of g and that of h, so where these are apart, components and genera of f are those of
// the factors together (docs/implicit-theorem.md, "products"). Near each other, f is nearly singular, the factors are
// not: spheres at a distance of 1e-6 take some hundred boxes this way and cannot be told from touching ones by f alone.
//
// Plan: prove each pair of surfaces apart, depth first, so that touching surfaces are found at once; certify the
// factors; certify the product as a whole within a budget that the factors suggest, since only that gives an isotopy;
// else join the meshes of the factors.
#include "implicit/product.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "expression/jet.h"
#include "expression/node.h"
#include "implicit/certificate.h"
#include "implicit/engine.h"
#include "implicit/octree.h"

namespace certa::implicit {
namespace {

using expression::hessian_index;
using expression::Jet;
using expression::Op;
using Reason = ImplicitObstacle::Reason;
using Clock = std::chrono::steady_clock;

/// Proves on boxes that g and h are not 0 at the same point.
class Separation {
public:
    Separation(const expression::Tape& g, const expression::Tape& h) : g_{g}, h_{h} {}

    /// g or h has no zero on the box, or some combination g - t h has none: t makes the gradients cancel at the centre,
    /// as they can where the surfaces are nearly parallel.
    bool is_apart(const Grid& grid, const GridPoint& low, const GridPoint& high) {
        const Region box = grid.region(low, high);
        if (g_.field.sign_on(box) != 0 || h_.field.sign_on(box) != 0) return true;
        expression::Place<Interval> center, offset;
        for (std::size_t a = 0; a < 3; ++a) {
            center[a] = Interval(interval::middle(box[a]));
            offset[a] = box[a] - center[a];
        }
        const auto t = ratio({center[0].lo, center[1].lo, center[2].lo});
        if (!t) return false;
        g_.tape.count_enclosures(2);
        h_.tape.count_enclosures(2);
        const std::array<Interval, 6> bend_g = g_.jets.evaluate<2>(box).hessian,
                                      bend_h = h_.jets.evaluate<2>(box).hessian;
        const Jet<Interval>&at_g = g_.jets.evaluate<1>(center), &at_h = h_.jets.evaluate<1>(center);
        const Interval factor(*t);
        Interval sum = at_g.value - factor * at_h.value;
        for (std::size_t a = 0; a < 3; ++a) sum = sum + (at_g.gradient[a] - factor * at_h.gradient[a]) * offset[a];
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = i; j < 3; ++j) {
                const auto k = static_cast<std::size_t>(hessian_index[i][j]);
                const Interval product = i == j ? interval::sqr(offset[i]) * Interval(0.5) : offset[i] * offset[j];
                sum = sum + (bend_g[k] - factor * bend_h[k]) * product;
            }
        }
        return interval::sign_of(sum) != 0;
    }

    bool is_defined(const Region& box) { return g_.field.certify(box).defined && h_.field.certify(box).defined; }

private:
    std::optional<double> ratio(const Point3& place) {
        const std::array<double, 3> g = g_.field.jet(place).gradient;
        const std::array<double, 3> h = h_.field.jet(place).gradient;
        const double t = (g[0] * h[0] + g[1] * h[1] + g[2] * h[2]) / (h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
        return std::isfinite(t) ? std::optional<double>(t) : std::nullopt;
    }

    struct Function {
        explicit Function(const expression::Tape& of) : tape(of), field(of), jets(of) {}
        const expression::Tape& tape;
        Field field;
        expression::Workspace<Interval> jets;
    };
    Function g_, h_;
};

class Product {
public:
    Product(const Expression& function, const std::vector<Expression>& factors, const Grid& grid,
            const ImplicitOptions& options, const RunControl& control)
        : function_(function), factors_(factors), grid_(grid), options_(options), control_(control) {
        const auto deepest = static_cast<std::uint64_t>(grid.resolution() - 1);
        max_depth_ = static_cast<int>(std::min(options.max_depth.value_or(deepest), deepest));
        budget_ = options.max_cells.value_or(std::uint64_t{1} << 31);
        for (const Expression& factor : factors) tapes_.emplace_back(factor);
    }

    ImplicitResult run() {
        result_.low = grid_.place(GridPoint{0, 0, 0});
        result_.high = grid_.place(GridPoint{grid_.side(), grid_.side(), grid_.side()});
        for (std::size_t i = 0; i < factors_.size(); ++i) {
            for (std::size_t j = i + 1; j < factors_.size(); ++j) {
                if (!separate(i, j)) return std::move(result_);
            }
        }
        std::uint64_t cells = 0, surfaces = 0;
        for (const Expression& factor : factors_) {
            parts_.push_back(certify_whole(factor, grid_, with_time(options_), control_));
            if (parts_.back().verdict == ImplicitVerdict::undecided) return std::move(parts_.back());
            cells += parts_.back().statistics.cells;
            surfaces += parts_.back().components.empty() ? 0 : 1;
        }
        if (surfaces > 1 && !options_.clip) {  // of a clipped surface, more than the type is never claimed
            ImplicitOptions whole = with_time(options_);
            whole.max_cells = std::min(budget_, 30'000 + 20 * cells);
            ImplicitResult attempt = certify_whole(function_, grid_, whole, control_);
            if (attempt.verdict != ImplicitVerdict::undecided || attempt.outcome == Outcome::cancelled) return attempt;
        }
        join(surfaces);
        return std::move(result_);
    }

private:
    /// The options with what is left of the time.
    ImplicitOptions with_time(ImplicitOptions options) const {
        if (!options.time_seconds) return options;
        const auto spent =
            static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start_).count());
        options.time_seconds = *options.time_seconds > spent ? *options.time_seconds - spent : 1;
        return options;
    }

    bool is_late() const {
        return options_.time_seconds &&
               Clock::now() - start_ > std::chrono::seconds(std::min<std::uint64_t>(*options_.time_seconds, 1u << 30));
    }

    bool stop(Reason reason, const GridPoint& low, const GridPoint& high) {
        result_.outcome = reason == Reason::cancelled ? Outcome::cancelled
                          : reason == Reason::budget  ? Outcome::over_budget
                                                      : Outcome::undecided;
        result_.obstacles.push_back({reason, grid_.place(low), grid_.place(high)});
        result_.obstacle_count = 1;
        return false;
    }

    bool separate(std::size_t i, std::size_t j) {
        struct Box {
            GridPoint low;
            int depth;
        };
        Separation separation(tapes_[i], tapes_[j]);
        std::vector<Box> work{{{0, 0, 0}, 0}};
        for (std::uint64_t count = 1; !work.empty(); ++count) {
            const Box box = work.back();
            work.pop_back();
            const Coordinate size = grid_.side() >> box.depth;
            const GridPoint high{box.low[0] + size, box.low[1] + size, box.low[2] + size};
            if (separation.is_apart(grid_, box.low, high)) continue;
            if (box.depth == max_depth_) {
                const bool defined = separation.is_defined(grid_.region(box.low, high));
                return stop(max_depth_ < grid_.resolution() - 1 ? Reason::budget
                            : defined                           ? Reason::singular
                                                                : Reason::undefined,
                            box.low, high);
            }
            if (count > budget_) return stop(Reason::budget, box.low, high);
            if (count % 256 == 0) {
                if (control_.cancelled()) return stop(Reason::cancelled, box.low, high);
                if (is_late()) return stop(Reason::budget, box.low, high);
                control_.report("separate", 0.5);
            }
            for (unsigned c = 8; c-- > 0;)
                work.push_back({{box.low[0] + (c & 1u) * (size / 2), box.low[1] + ((c >> 1) & 1u) * (size / 2),
                                 box.low[2] + (c >> 2) * (size / 2)},
                                box.depth + 1});
        }
        return true;
    }

    /// The sign of the other factors and of the constants next to a component, as doubles say.
    int rest_sign(std::size_t part, std::uint32_t component, Field& whole) {
        Field own(tapes_[part]);
        const ImplicitResult& from = parts_[part];
        double votes = 0;
        for (std::size_t t = 0; t < from.mesh.triangles.size(); ++t) {
            if (from.triangle_components[t] != component) continue;
            const Point3& p = from.mesh.positions[index_of(from.mesh.triangles[t][0])];
            const double f = whole.value(p), g = own.value(p);
            if (f != 0 && g != 0) votes += (f < 0) == (g < 0) ? 1 : -1;
        }
        return votes < 0 ? -1 : 1;
    }

    void join(std::uint64_t surfaces) {
        result_.verdict = surfaces == 0 ? ImplicitVerdict::empty : ImplicitVerdict::certified;
        result_.isotopic = surfaces < 2 && !options_.clip;
        for (const expression::Tape& tape : tapes_) result_.statistics.evaluations += tape.enclosures();
        const expression::Tape tape(function_);
        Field whole(tape);
        std::vector<const ImplicitResult*> parts;
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            const ImplicitResult& part = parts_[k];
            std::vector<int> turns;
            for (std::uint32_t c = 0; c < part.components.size(); ++c) {
                turns.push_back(rest_sign(k, c, whole));
                result_.components.push_back({part.components[c].genus, 0, 0, std::nullopt, part.components[c].loops});
            }
            const auto first_vertex = static_cast<std::uint32_t>(result_.mesh.positions.size());
            const auto first_component = static_cast<std::uint32_t>(result_.components.size() - turns.size());
            result_.mesh.positions.insert(result_.mesh.positions.end(), part.mesh.positions.begin(),
                                          part.mesh.positions.end());
            for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
                Triangle triangle = part.mesh.triangles[t];
                for (VertexId& v : triangle) v = VertexId{index_of(v) + first_vertex};
                if (turns[part.triangle_components[t]] < 0) std::swap(triangle[1], triangle[2]);
                result_.mesh.triangles.push_back(triangle);
                result_.triangle_components.push_back(first_component + part.triangle_components[t]);
            }
            ImplicitStatistics& sum = result_.statistics;
            sum.evaluations += part.statistics.evaluations;
            sum.cells += part.statistics.cells;
            sum.leaves += part.statistics.leaves;
            sum.open_leaves += part.statistics.open_leaves;
            sum.clusters += part.statistics.clusters;
            sum.rounds += part.statistics.rounds;
            sum.tetrahedra += part.statistics.tetrahedra;
            parts.push_back(&part);
        }
        if (options_.certificate) result_.certificate = write_product_certificate(parts);
    }

    const Expression& function_;
    const std::vector<Expression>& factors_;
    const Grid& grid_;
    const ImplicitOptions& options_;
    const RunControl& control_;
    const Clock::time_point start_ = Clock::now();
    int max_depth_ = 0;
    std::uint64_t budget_ = 0;
    std::vector<expression::Tape> tapes_;
    std::vector<ImplicitResult> parts_;
    ImplicitResult result_;
};

}  // namespace

std::vector<Expression> factors_of(const Expression& function) {
    std::vector<Expression> factors;
    std::vector<expression::NodePointer> work{function.node()};
    while (!work.empty()) {
        const expression::NodePointer node = work.back();
        work.pop_back();
        if (!node->depends_on_place) {
            const Interval value = expression::enclosure_of_constant(node);
            if (interval::sign_of(value) == 0) return {};
        } else if (node->op == Op::multiply) {
            work.push_back(node->second);
            work.push_back(node->first);
        } else if (node->op == Op::negate) {
            work.push_back(node->first);
        } else {
            factors.emplace_back(node);
            if (factors.size() > 16) return {};
        }
    }
    if (factors.size() < 2) factors.clear();
    return factors;
}

ImplicitResult mesh_product(const Expression& function, const std::vector<Expression>& factors, const Grid& grid,
                            const ImplicitOptions& options, const RunControl& control) {
    return Product(function, factors, grid, options, control).run();
}

}  // namespace certa::implicit
