// The classical rival and cross-check of W: leaves on which no two gradients are orthogonal hold pieces of the surface
// that the signs at corners determine.
//
// Plan: subdivide until every leaf has a sign or small normal variation, and a sign if it touches the box; balance the
// leaves without a sign 2:1 over faces, edges and corners; on every smallest square join the sign changes, negative
// points being cut off (on squares with four changes the surface is a graph over the square, so that either way is
// right); fill the loops on each leaf with disks.
#include "implicit/subdivision.h"

#include <algorithm>
#include <map>

#include "core/assert.h"
#include "core/index_map.h"
#include "core/parallel.h"
#include "core/union_find.h"
#include "core/vector3.h"
#include "implicit/octree.h"

namespace certa::implicit {
namespace {

using Reason = ImplicitObstacle::Reason;

class Subdivision {
public:
    Subdivision(const Expression& function, const Grid& grid, const ImplicitOptions& options, const RunControl& control)
        : tape_(function), tree_(grid), field_(tape_), control_(control) {
        max_cells_ = options.max_cells.value_or(std::uint64_t{1} << 31);
        const auto deepest = static_cast<std::uint64_t>(tree_.max_depth());
        max_depth_ = static_cast<int>(std::min(options.max_depth.value_or(deepest), deepest));
        result_.low = grid.place(GridPoint{0, 0, 0});
        result_.high = grid.place(GridPoint{grid.side(), grid.side(), grid.side()});
    }

    ImplicitResult run() {
        if (subdivide() && balance()) {
            mesh();
            measure();
            result_.outcome = Outcome::done;
            result_.isotopic = true;
            result_.verdict = result_.components.empty() ? ImplicitVerdict::empty : ImplicitVerdict::certified;
        }
        result_.statistics.cells = result_.statistics.evaluations = tree_.cells().size();
        for (const std::uint32_t leaf : tree_.leaves()) {
            ++result_.statistics.leaves;
            result_.statistics.open_leaves += tree_.cell(leaf).known.sign == 0 ? 1 : 0;
        }
        return std::move(result_);
    }

private:
    bool is_open(const Cell& cell) const {
        return cell.known.sign == 0 && (cell.known.slope == 0 || tree_.touches_boundary(cell));
    }

    void certify(const std::vector<std::uint32_t>& ids) {
        core::parallel_for(ids.size(), 64, control_, [&](std::size_t begin, std::size_t end) {
            Field field(tape_);
            for (std::size_t i = begin; i < end; ++i) {
                Cell& cell = tree_.cell(ids[i]);
                const Certainty found = field.certify_variation(tree_.region_of(cell));
                if (found.sign != 0) cell.known.sign = found.sign;
                if (found.slope != 0) cell.known.slope = 1;
                cell.known.defined = cell.known.defined || found.defined;
            }
        });
    }

    bool stop(Reason reason, const std::vector<std::uint32_t>& leaves) {
        result_.outcome = reason == Reason::cancelled ? Outcome::cancelled
                          : reason == Reason::budget  ? Outcome::over_budget
                                                      : Outcome::undecided;
        for (const std::uint32_t leaf : leaves) {
            if (result_.obstacles.size() == 1000) break;
            const Cell& cell = tree_.cell(leaf);
            result_.obstacles.push_back(
                {reason, tree_.grid().place(cell.low), tree_.grid().place(tree_.high_of(cell))});
        }
        result_.obstacle_count = leaves.size();
        if (leaves.empty()) result_.obstacles.push_back({reason, result_.low, result_.high});
        return false;
    }

    bool split(const std::vector<std::uint32_t>& leaves, std::vector<std::uint32_t>& children) {
        if (control_.cancelled()) return stop(Reason::cancelled, {});
        if (tree_.cells().size() + 8 * leaves.size() > max_cells_) return stop(Reason::budget, leaves);
        for (const std::uint32_t leaf : leaves) {
            const Cell& cell = tree_.cell(leaf);
            if (cell.depth < max_depth_) continue;
            return stop(!cell.known.defined                                     ? Reason::undefined
                        : cell.known.slope != 0 && tree_.touches_boundary(cell) ? Reason::meets_box
                                                                                : Reason::singular,
                        {leaf});
        }
        children.clear();
        for (const std::uint32_t leaf : leaves) {
            const std::uint32_t first = tree_.split(leaf);
            for (std::uint32_t c = 0; c < 8; ++c) children.push_back(first + c);
        }
        certify(children);
        return true;
    }

    bool subdivide() {
        std::vector<std::uint32_t> generation{0}, open;
        certify(generation);
        for (;;) {
            open.clear();
            for (const std::uint32_t id : generation) {
                if (is_open(tree_.cell(id))) open.push_back(id);
            }
            if (open.empty()) return true;
            control_.report("subdivide", 0.5);
            if (!split(open, generation)) return false;
        }
    }

    /// A leaf without a sign is split when one of at most a quarter of its size touches it.
    bool balance() {
        for (std::vector<std::uint32_t> children;;) {
            std::vector<std::uint32_t> large;
            for (const std::uint32_t leaf : tree_.leaves()) {
                if (tree_.cell(leaf).known.sign == 0) add_large_neighbours(leaf, large);
            }
            std::sort(large.begin(), large.end());
            large.erase(std::unique(large.begin(), large.end()), large.end());
            if (large.empty()) return true;
            if (!split(large, children)) return false;
        }
    }
    void add_large_neighbours(std::uint32_t leaf, std::vector<std::uint32_t>& large) const {
        const Cell& cell = tree_.cell(leaf);
        tree_.visit_around_corners(cell, [&](std::uint32_t other) {
            if (tree_.cell(other).known.sign == 0 && tree_.cell(other).depth + 1 < cell.depth) large.push_back(other);
        });
    }

    // ---- The mesh ---------------------------------------------------------------------------------------------------

    /// Of leaves that have it, else of f in doubles; 0 and NaN count as +. Which sign f really has at a corner does not
    /// matter as long as all leaves agree.
    int sign_of(std::uint32_t point) {
        signs_.resize(tree_.points().size(), 0);
        if (signs_[point] == 0) {
            const Point3 place = tree_.grid().place(tree_.points()[point]);
            const GridPoint& p = tree_.points()[point];
            const int certain = field_.sign_on(tree_.grid().region(p, p));
            signs_[point] = static_cast<std::int8_t>(certain != 0 ? certain : field_.value(place) < 0 ? -1 : 1);
        }
        return signs_[point];
    }

    void mesh() {
        for (const std::uint32_t leaf : tree_.leaves()) {
            const Cell cell = tree_.cell(leaf);
            if (cell.known.sign != 0) continue;
            next_.clear();
            for (int face = 0; face < 6; ++face) {
                GridPoint low = cell.low;
                if (face % 2 == 1) low[static_cast<std::size_t>(face / 2)] += tree_.size_of(cell);
                tree_.visit_squares(low, face / 2, face % 2, tree_.size_of(cell),
                                    [&](const GridPoint&, const auto& ring) { trace(ring); });
            }
            fill_loops();
        }
    }

    void trace(const std::vector<std::uint32_t>& ring) {
        const std::size_t count = ring.size();
        for (std::size_t q = 0; q < count; ++q) {
            if (sign_of(ring[q]) < 0 || sign_of(ring[(q + 1) % count]) > 0) continue;
            std::size_t r = (q + 1) % count;  // into a run of negative points after q, out of it after r
            while (sign_of(ring[(r + 1) % count]) < 0) r = (r + 1) % count;
            next_[vertex(ring[r], ring[(r + 1) % count])] = vertex(ring[q], ring[(q + 1) % count]);
        }
    }

    std::uint32_t vertex(std::uint32_t a, std::uint32_t b) {
        std::uint32_t id = vertices_.find(a, b);
        if (id != no_index) return id;
        id = static_cast<std::uint32_t>(result_.mesh.positions.size());
        vertices_.set(a, b, id);
        Point3 low = tree_.grid().place(tree_.points()[a]), high = tree_.grid().place(tree_.points()[b]);
        if (sign_of(a) > 0) std::swap(low, high);
        for (int i = 0; i < 30; ++i) {
            const Point3 middle = 0.5 * (low + high);
            (field_.value(middle) < 0 ? low : high) = middle;
        }
        result_.mesh.positions.push_back(0.5 * (low + high));
        return id;
    }

    void fill_loops() {
        while (!next_.empty()) {
            std::vector<std::uint32_t> loop{next_.begin()->first};
            for (auto at = next_.begin(); at != next_.end(); at = next_.find(loop.back())) {
                loop.push_back(at->second);
                next_.erase(at);
            }
            loop.pop_back();
            // Two squares of the leaf with the same two changes, at a point on one of its edges: the surface only dips
            // in, and the leaves beyond share that edge of the mesh.
            if (loop.size() < 3) continue;
            std::uint32_t middle = loop[0];
            if (loop.size() > 3) {
                Point3 sum{};
                for (const std::uint32_t v : loop) sum = sum + result_.mesh.positions[v];
                middle = static_cast<std::uint32_t>(result_.mesh.positions.size());
                result_.mesh.positions.push_back((1.0 / static_cast<double>(loop.size())) * sum);
            }
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
                if (a != middle && b != middle)
                    result_.mesh.triangles.push_back({VertexId{middle}, VertexId{b}, VertexId{a}});
            }
        }
    }

    /// Components and genera, counted: each vertex once, edges half a triangle's three.
    void measure() {
        const auto& mesh = result_.mesh;
        core::UnionFind groups(mesh.positions.size());
        for (const Triangle& t : mesh.triangles) {
            groups.unite(index_of(t[0]), index_of(t[1]));
            groups.unite(index_of(t[0]), index_of(t[2]));
        }
        std::map<std::uint32_t, std::uint32_t> number;
        std::vector<long> euler2;  // twice the Euler characteristic
        for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
            const auto [found, added] = number.emplace(groups.find(v), static_cast<std::uint32_t>(euler2.size()));
            if (added) euler2.push_back(0);
            euler2[found->second] += 2;
        }
        for (const Triangle& t : mesh.triangles) {
            result_.triangle_components.push_back(number.at(groups.find(index_of(t[0]))));
            euler2[result_.triangle_components.back()] -= 1;
        }
        for (const long twice : euler2) {
            CERTA_ASSERT(twice % 4 == 0);
            result_.components.emplace_back();
            result_.components.back().genus = static_cast<int>(1 - twice / 4);
        }
    }

    expression::Tape tape_;
    Octree tree_;
    Field field_;
    const RunControl& control_;
    std::uint64_t max_cells_ = 0;
    int max_depth_ = 0;
    std::vector<std::int8_t> signs_;
    std::map<std::uint32_t, std::uint32_t> next_;  ///< along loops on the surface of the leaf at hand
    core::PairMap vertices_;
    ImplicitResult result_;
};

}  // namespace

ImplicitResult mesh_by_subdivision(const Expression& function, const Grid& grid, const ImplicitOptions& options,
                                   const RunControl& control) {
    return Subdivision(function, grid, options, control).run();
}

}  // namespace certa::implicit
