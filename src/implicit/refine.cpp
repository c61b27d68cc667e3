// Classification by generations of equal depth, evaluated in parallel, decided in order.
//
// A singular point (f and its gradient both 0) keeps one leaf open at every depth, a singular curve many more. So as
// not to spend the whole budget on a generation that cannot settle, one open leaf is followed downwards first
// (`probe`): where it stays open to the last depth that doubles carry, the answer is known. A surface that crosses the
// box is found from two proved signs at points of one face of the box.
#include "implicit/refine.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace certa::implicit {
namespace {

using Reason = ImplicitObstacle::Reason;

void certify(Octree& tree, const std::vector<std::uint32_t>& ids, const expression::Tape& tape,
             const RunControl& control) {
    core::parallel_for(ids.size(), 64, control, [&](std::size_t begin, std::size_t end) {
        Field field(tape);
        for (std::size_t i = begin; i < end && !control.cancelled(); ++i) {
            Cell& cell = tree.cell(ids[i]);
            const Certainty found = field.certify(tree.region_of(cell), tree.free_axes(cell));
            if (found.sign != 0) cell.known.sign = found.sign;
            if (found.slope != 0 && cell.known.slope == 0) {
                cell.known.slope = found.slope;
                cell.known.axis = found.axis;
            }
            cell.known.defined = cell.known.defined || found.defined;
        }
    });
}

bool is_open(const Octree& tree, const Cell& cell) {
    return !cell.is_settled() || (cell.known.sign == 0 && !tree.is_clipped() && tree.touches_boundary(cell));
}

/// Of a clipped box, a leaf that some derivative would settle if it did not touch the box: the surface is, or seems,
/// tangent to it.
Reason reason_of(const Octree& tree, const Cell& cell, Field& field) {
    if (!cell.known.defined) return Reason::undefined;
    if (!tree.touches_boundary(cell)) return Reason::singular;
    if (tree.is_clipped())
        return field.certify(tree.region_of(cell)).slope != 0 ? Reason::tangent_to_box : Reason::singular;
    return cell.is_settled() ? Reason::meets_box : Reason::singular;
}

/// Both signs are proved at corners of the leaf's face in the boundary of the box.
bool crosses_box(const Octree& tree, const Cell& cell, Field& field) {
    const Coordinate size = tree.size_of(cell), side = tree.grid().side();
    for (std::size_t a = 0; a < 3; ++a) {
        const bool low = cell.low[a] == 0, high = cell.low[a] + size == side;
        if (!low && !high) continue;
        const std::size_t u = (a + 1) % 3, v = (a + 2) % 3;
        int seen = 0;
        for (unsigned q = 0; q < 4; ++q) {
            GridPoint p = cell.low;
            if (!low) p[a] = side;
            p[u] += (q & 1u) * size;
            p[v] += (q >> 1) * size;
            const int sign = field.sign_on(tree.grid().region(p, p));
            if (sign != 0 && seen == -sign) return true;
            if (sign != 0) seen = sign;
        }
    }
    return false;
}

/// The centre of a leaf, moved onto the faces of the box that the leaf touches.
GridPoint foot_of(const Octree& tree, const Cell& cell) {
    GridPoint p = tree.center_of(cell);
    for (std::size_t a = 0; a < 3; ++a) {
        if (cell.low[a] == 0) p[a] = 0;
        if (cell.low[a] + tree.size_of(cell) == tree.grid().side()) p[a] = tree.grid().side();
    }
    return p;
}

/// How far an open leaf seems from staying open, in units of its size: where f, or the derivatives that would settle
/// it, are smallest. A guess in doubles that decides only where to look.
double promise(const Octree& tree, const Cell& cell, Field& field) {
    const double size = interval::width(tree.region_of(cell)[0]);
    const bool settled = cell.known.slope != 0;  // open because it touches the box: what counts is f on the box
    const Point3 place = tree.grid().place(tree.is_clipped() || settled ? foot_of(tree, cell) : tree.center_of(cell));
    if (settled) return std::fabs(field.value(place)) / size;
    const auto& jet = field.jet(place);
    const unsigned axes = tree.free_axes(cell);
    double square = 0;
    for (std::size_t a = 0; a < 3; ++a) square += ((axes >> a) & 1u) * jet.gradient[a] * jet.gradient[a];
    return std::fabs(jet.value) / size + std::sqrt(square);
}

/// Follows the most promising open leaves downwards; one that is open at the last depth.
std::optional<Cell> probe(const Octree& tree, const Cell& start, int max_depth, Field& field) {
    std::vector<Cell> work{start};
    for (int budget = 200; budget > 0 && !work.empty(); --budget) {
        const Cell parent = work.back();
        work.pop_back();
        const Coordinate half = tree.size_of(parent) / 2;
        std::vector<std::pair<double, Cell>> open;
        for (unsigned c = 0; c < 8; ++c) {
            Cell child;
            child.low = {parent.low[0] + (c & 1u) * half, parent.low[1] + ((c >> 1) & 1u) * half,
                         parent.low[2] + ((c >> 2) & 1u) * half};
            child.depth = static_cast<std::int8_t>(parent.depth + 1);
            child.known = field.certify(tree.region_of(child), tree.free_axes(child));
            if (parent.known.slope != 0) child.known.slope = parent.known.slope;
            if (!is_open(tree, child)) continue;
            if (child.depth >= max_depth) return child;
            open.emplace_back(promise(tree, child, field), child);
        }
        std::stable_sort(open.begin(), open.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
        for (const auto& [score, child] : open) work.push_back(child);
    }
    return std::nullopt;
}

/// Solves the symmetric system a d = b with a positive definite a, by Cramer's rule.
std::array<double, 3> solve(const double (&a)[3][3], const double (&b)[3]) {
    const auto determinant = [](const double(&m)[3][3]) {
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    };
    const double whole = determinant(a);
    std::array<double, 3> d{};
    for (int k = 0; k < 3; ++k) {
        double m[3][3];
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) m[i][j] = j == k ? b[i] : a[i][j];
        }
        d[static_cast<std::size_t>(k)] = determinant(m) / whole;
    }
    return d;
}

/// Goes from a place along the given axes towards one where f and its derivatives along them vanish together:
/// Gauss-Newton with a little damping on the equations f / size = 0, grad f = 0. A guess, like all of this.
Point3 towards_singular(Point3 place, double size, unsigned axes, Field& field) {
    for (int round = 0; round < 60; ++round) {
        const auto& jet = field.jet(place);
        double normal[3][3] = {}, right[3] = {};
        for (int row = 0; row < 4; ++row) {
            if (row < 3 && ((axes >> row) & 1u) == 0) continue;
            double slopes[3];
            for (int k = 0; k < 3; ++k)
                slopes[k] = ((axes >> k) & 1u) == 0 ? 0.0
                            : row == 3              ? jet.gradient[static_cast<std::size_t>(k)] / size
                                       : jet.hessian[static_cast<std::size_t>(expression::hessian_index[row][k])];
            const double value = row == 3 ? jet.value / size : jet.gradient[static_cast<std::size_t>(row)];
            for (int i = 0; i < 3; ++i) {
                right[i] -= slopes[i] * value;
                for (int j = 0; j < 3; ++j) normal[i][j] += slopes[i] * slopes[j];
            }
        }
        const double trace = normal[0][0] + normal[1][1] + normal[2][2];
        for (int i = 0; i < 3; ++i) normal[i][i] += 1e-12 * trace + 1e-300;
        const std::array<double, 3> step = solve(normal, right);
        if (!std::isfinite(step[0] + step[1] + step[2])) break;
        place = {place.x + step[0], place.y + step[1], place.z + step[2]};
        size = std::max(0.5 * size, 1e-9 * size + 1e-12);
    }
    return place;
}

/// The smallest cell around a place, if it is open.
std::optional<Cell> open_cell_at(const Octree& tree, const Point3& place, int max_depth, Field& field) {
    const double coordinates[3] = {place.x, place.y, place.z};
    Cell cell;
    cell.depth = static_cast<std::int8_t>(max_depth);
    for (int a = 0; a < 3; ++a) {
        const double low = tree.grid().place(a, 0), high = tree.grid().place(a, tree.grid().side());
        const double t = (coordinates[a] - low) / (high - low);
        if (!(t >= 0) || !(t <= 1)) return std::nullopt;
        const auto last = static_cast<Coordinate>(std::ldexp(1.0, max_depth)) - 1;
        cell.low[static_cast<std::size_t>(a)] = std::min(last, static_cast<Coordinate>(std::ldexp(t, max_depth)))
                                                << (tree.grid().resolution() - max_depth);
    }
    cell.known = field.certify(tree.region_of(cell), tree.free_axes(cell));
    if (!is_open(tree, cell)) return std::nullopt;
    return cell;
}

class Classifier {
public:
    Classifier(Octree& tree, const expression::Tape& tape, const Limits& limits, const RunControl& control)
        : tree_(tree), tape_(tape), limits_(limits), control_(control), field_(tape) {}

    std::optional<Obstacle> run() {
        std::vector<std::uint32_t> generation{0};
        certify(tree_, generation, tape_, control_);
        for (int depth = 0;; ++depth) {
            if (control_.cancelled()) return Obstacle{Reason::cancelled, {}};
            std::vector<std::uint32_t> open;
            for (const std::uint32_t id : generation) {
                if (is_open(tree_, tree_.cell(id))) open.push_back(id);
            }
            if (open.empty()) return std::nullopt;
            control_.report("classify", std::min(0.95, 0.06 * depth));
            if (auto obstacle = look_ahead(open, depth)) return obstacle;
            if (tree_.cells().size() + 8 * open.size() > limits_.max_cells || limits_.is_late())
                return Obstacle{Reason::budget, open};
            generation.clear();
            for (const std::uint32_t id : open) {
                const std::uint32_t first = tree_.split(id);
                for (std::uint32_t c = 0; c < 8; ++c) generation.push_back(first + c);
            }
            certify(tree_, generation, tape_, control_);
        }
    }

private:
    std::optional<Obstacle> look_ahead(const std::vector<std::uint32_t>& open, int depth) {
        if (depth >= limits_.max_depth) return Obstacle{reason_at(tree_.cell(open.front())), open};
        if (depth >= 3 && !tree_.is_clipped()) {
            for (const std::uint32_t id : open) {
                const Cell& cell = tree_.cell(id);
                if (cell.known.sign != 0 || !tree_.touches_boundary(cell) || !crosses_box(tree_, cell, field_))
                    continue;
                // What is singular too is so in any box: that is said first.
                const auto singular = stuck_cell(most_promising(open));
                if (singular && reason_at(*singular) == Reason::singular)
                    return Obstacle{Reason::singular, {split_down_to(*singular)}};
                return Obstacle{Reason::meets_box, {id}};
            }
        }
        if (depth >= 6) {
            const std::uint32_t id = most_promising(open);
            std::optional<Cell> found = stuck_cell(id);
            if (!found) found = probe(tree_, tree_.cell(id), limits_.max_depth, field_);
            if (found) return Obstacle{reason_at(*found), {split_down_to(*found)}};
        }
        return std::nullopt;
    }

    /// Why a cell at the last depth is open. If smaller ones were possible that is all there is to say.
    Reason reason_at(const Cell& cell) {
        return limits_.max_depth < tree_.max_depth() ? Reason::budget : reason_of(tree_, cell, field_);
    }

    /// A smallest cell that stays open, where an iteration from a leaf leads.
    std::optional<Cell> stuck_cell(std::uint32_t id) {
        const Cell& cell = tree_.cell(id);
        const double size = interval::width(tree_.region_of(cell)[0]);
        const GridPoint start = tree_.is_clipped() ? foot_of(tree_, cell) : tree_.center_of(cell);
        const Point3 guess = towards_singular(tree_.grid().place(start), size, tree_.free_axes(cell), field_);
        return open_cell_at(tree_, guess, limits_.max_depth, field_);
    }

    /// Splits until the cell is a leaf of the tree. All of this is one chain: nothing else is certified any more.
    std::uint32_t split_down_to(const Cell& cell) {
        std::uint32_t at = tree_.leaf_at(cell.low);
        while (tree_.cell(at).depth < cell.depth) {
            tree_.split(at);
            at = tree_.leaf_at(cell.low);
        }
        tree_.cell(at).known = cell.known;
        return at;
    }

    std::uint32_t most_promising(const std::vector<std::uint32_t>& open) {
        std::uint32_t best = open.front();
        double lowest = promise(tree_, tree_.cell(best), field_);
        for (const std::uint32_t id : open) {
            const double score = promise(tree_, tree_.cell(id), field_);
            if (score < lowest) {
                lowest = score;
                best = id;
            }
        }
        return best;
    }

    Octree& tree_;
    const expression::Tape& tape_;
    const Limits& limits_;
    const RunControl& control_;
    Field field_;
};

}  // namespace

std::optional<Obstacle> classify(Octree& tree, const expression::Tape& tape, const Limits& limits,
                                 const RunControl& control) {
    return Classifier(tree, tape, limits, control).run();
}

std::optional<Obstacle> split_all(Octree& tree, const std::vector<std::uint32_t>& leaves, const expression::Tape& tape,
                                  const Limits& limits, const RunControl& control) {
    if (tree.cells().size() + 8 * leaves.size() > limits.max_cells || limits.is_late())
        return Obstacle{Reason::budget, leaves};
    std::vector<std::uint32_t> deepest, children;
    for (const std::uint32_t leaf : leaves) {
        if (tree.cell(leaf).depth >= limits.max_depth) deepest.push_back(leaf);
    }
    if (!deepest.empty())
        return Obstacle{limits.max_depth < tree.max_depth() ? Reason::budget : Reason::precision, deepest};
    for (const std::uint32_t leaf : leaves) {
        const std::uint32_t first = tree.split(leaf);
        for (std::uint32_t c = 0; c < 8; ++c) children.push_back(first + c);
    }
    certify(tree, children, tape, control);
    if (control.cancelled()) return Obstacle{Reason::cancelled, {}};
    return std::nullopt;
}

}  // namespace certa::implicit
