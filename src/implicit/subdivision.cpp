// The classical rival and cross-check of W: subdivision until gradients vary little (Plantinga and Vegter), here with
// a linear interpolation on T in place of marching cubes and balance (docs/implicit-theorem.md, "the second engine").
//
// Plan: subdivide until every leaf has a sign or small normal variation, and a sign if it touches the box; choose
// values at the points of T; split leaves on which the gradients of f and of the interpolation do not vary little
// together; march on the tetrahedra.
#include "implicit/subdivision.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "core/assert.h"
#include "core/parallel.h"
#include "core/union_find.h"
#include "implicit/octree.h"
#include "implicit/surface.h"

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
        if (options.time_seconds && *options.time_seconds < 1'000'000'000)
            deadline_ = std::chrono::steady_clock::now() + std::chrono::seconds(*options.time_seconds);
        result_.low = grid.place(GridPoint{0, 0, 0});
        result_.high = grid.place(GridPoint{grid.side(), grid.side(), grid.side()});
    }

    ImplicitResult run() {
        if (subdivide() && tame_interpolation()) {
            mesh();
            measure();
            result_.outcome = Outcome::done;
            result_.isotopic = true;
            result_.verdict = result_.components.empty() ? ImplicitVerdict::empty : ImplicitVerdict::certified;
        }
        result_.statistics.cells = tree_.cells().size();
        result_.statistics.evaluations = tape_.enclosures() + field_.uncounted();
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
        slopes_.resize(tree_.cells().size());
        core::parallel_for(ids.size(), 64, control_, [&](std::size_t begin, std::size_t end) {
            Field field(tape_);
            for (std::size_t i = begin; i < end && !control_.cancelled(); ++i) {
                Cell& cell = tree_.cell(ids[i]);
                const Certainty found = field.certify_variation(tree_.region_of(cell), slopes_[ids[i]]);
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
        if (tree_.cells().size() + 8 * leaves.size() > max_cells_ || std::chrono::steady_clock::now() > deadline_)
            return stop(Reason::budget, leaves);
        for (const std::uint32_t leaf : leaves) {
            const Cell& cell = tree_.cell(leaf);
            if (cell.depth < max_depth_) continue;
            return stop(max_depth_ < tree_.max_depth()                          ? Reason::budget
                        : !cell.known.defined                                   ? Reason::undefined
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
            if (control_.cancelled()) return stop(Reason::cancelled, {});
            if (open.empty()) return true;
            control_.report("subdivide", 0.5);
            if (!split(open, generation)) return false;
        }
    }

    // ---- The interpolation ------------------------------------------------------------------------------------------

    /// Splits leaves until on each one without a sign the gradients of f and of the interpolation vary little together.
    /// Only what a split may have changed is looked at again: children, and leaves at least as large next to them.
    bool tame_interpolation() {
        std::vector<std::uint32_t> open = open_leaves(), children;
        for (;;) {
            if (!settle_points(open)) return false;
            std::vector<char> tame(open.size(), 0);
            core::parallel_for(open.size(), 64, control_, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end && !control_.cancelled(); ++i) tame[i] = is_tame(open[i]) ? 1 : 0;
            });
            std::vector<std::uint32_t> wild, changed;
            for (std::size_t i = 0; i < open.size(); ++i) {
                if (tame[i]) continue;
                wild.push_back(open[i]);
                tree_.visit_around_corners(tree_.cell(open[i]), [&](std::uint32_t leaf) { changed.push_back(leaf); });
            }
            if (wild.empty()) {
                // In the end, all at once: then the theorem holds whatever was looked at before.
                std::vector<std::uint32_t> all = open_leaves();
                if (open.size() == all.size()) return true;
                open = std::move(all);
                continue;
            }
            ++result_.statistics.rounds;
            if (!split(wild, children)) return false;
            changed.insert(changed.end(), children.begin(), children.end());
            std::sort(changed.begin(), changed.end());
            changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
            std::erase_if(changed, [&](std::uint32_t leaf) {
                return !tree_.cell(leaf).is_leaf() || tree_.cell(leaf).known.sign != 0;
            });
            open = resettle_doubtful() ? open_leaves() : std::move(changed);
        }
    }

    /// Signs of points that are not proved may be those of new leaves: whether some value changed.
    bool resettle_doubtful() {
        bool turned = false;
        for (std::uint32_t p = 0; p < values_.size(); ++p) {
            if (values_[p].proved || values_[p].value == 0) continue;
            const double before = values_[p].value;
            settle(p, field_);
            turned = turned || values_[p].value != before;
        }
        return turned;
    }

    std::vector<std::uint32_t> open_leaves() const {
        std::vector<std::uint32_t> open;
        for (const std::uint32_t leaf : tree_.leaves()) {
            if (tree_.cell(leaf).known.sign == 0) open.push_back(leaf);
        }
        return open;
    }

    /// Calls visit(face, centre of the leaf, centre of the square, ring) for the smallest squares of a leaf, all of
    /// which must have ids.
    template <class Visit>
    void visit_faces(const Cell& cell, const Visit& visit) const {
        const std::uint32_t apex = tree_.points().find(tree_.center_of(cell));
        for (int face = 0; face < 6; ++face) {
            GridPoint low = cell.low;
            if (face % 2 == 1) low[static_cast<std::size_t>(face / 2)] += tree_.size_of(cell);
            tree_.visit_squares(low, face / 2, face % 2, tree_.size_of(cell),
                                [&](const GridPoint& center, const auto& ring) {
                                    visit(face, apex, tree_.points().find(center), ring);
                                });
        }
    }

    /// Ids for the points of T in open leaves; values of the interpolation at them.
    bool settle_points(const std::vector<std::uint32_t>& open) {
        std::vector<char> used;
        const auto use = [&](std::uint32_t point) {
            if (used.size() <= point) used.resize(std::max<std::size_t>(tree_.points().size(), point + 1), 0);
            used[point] = 1;
        };
        for (const std::uint32_t leaf : open) {
            const Cell cell = tree_.cell(leaf);
            use(tree_.points().insert(tree_.center_of(cell)));
            for (int face = 0; face < 6; ++face) {
                GridPoint low = cell.low;
                if (face % 2 == 1) low[static_cast<std::size_t>(face / 2)] += tree_.size_of(cell);
                tree_.visit_squares(low, face / 2, face % 2, tree_.size_of(cell),
                                    [&](const GridPoint& center, const auto& ring) {
                                        use(tree_.points().insert(center));
                                        for (const std::uint32_t point : ring) use(point);
                                    });
            }
        }
        values_.resize(tree_.points().size());
        core::parallel_for(used.size(), 256, control_, [&](std::size_t begin, std::size_t end) {
            Field field(tape_);
            for (std::size_t p = begin; p < end && !control_.cancelled(); ++p) {
                if (used[p] && values_[p].value == 0) settle(static_cast<std::uint32_t>(p), field);
            }
        });
        return !control_.cancelled() || stop(Reason::cancelled, {});
    }

    /// The value of f in doubles, or next to nothing where it does not have the sign that the point has: the proved
    /// one, that of a leaf around it, or else any.
    void settle(std::uint32_t point, Field& field) {
        const GridPoint& p = tree_.points()[point];
        const double value = field.value(tree_.grid().place(p));
        int sign = field.sign_on(tree_.grid().region(p, p));
        PointValue& known = values_[point];
        known.proved = sign != 0;
        for (unsigned octant = 0; octant < 8 && sign == 0; ++octant) {
            GridPoint q = p;
            bool inside = true;
            for (unsigned a = 0; a < 3; ++a) {
                const bool below = ((octant >> a) & 1u) != 0;
                if (below ? p[a] == 0 : p[a] == tree_.grid().side()) inside = false;
                if (below) --q[a];
            }
            if (inside) sign = tree_.cell(tree_.leaf_at(q)).known.sign;
        }
        if (sign == 0) sign = value < 0 ? -1 : 1;
        known.value = sign * value > 0 && std::isfinite(value) ? value : sign * 0x1p-900;
    }
    int sign_of(std::uint32_t point) const { return values_[point].value < 0 ? -1 : 1; }

    /// Whether the hull of the enclosure of grad f on a leaf and of the gradients of the interpolation on its
    /// tetrahedra varies little.
    bool is_tame(std::uint32_t leaf) const {
        std::array<Interval, 3> slopes = slopes_[leaf];
        visit_faces(tree_.cell(leaf), [&](int face, std::uint32_t apex, std::uint32_t middle, const auto& ring) {
            for (std::size_t i = 0; i < ring.size(); ++i)
                add_gradient(static_cast<std::size_t>(face / 2), {apex, middle, ring[i], ring[(i + 1) % ring.size()]},
                             slopes);
        });
        return Field::varies_little(slopes);
    }

    Interval step(std::size_t axis, std::uint32_t a, std::uint32_t b) const {
        const auto place = [&](std::uint32_t p) {
            return Interval(tree_.grid().place(static_cast<int>(axis), tree_.points()[p][axis]));
        };
        return place(b) - place(a);
    }
    Interval rise(std::uint32_t a, std::uint32_t b) const {
        return Interval(values_[b].value) - Interval(values_[a].value);
    }

    /// From the centre of the leaf to that of the square along `axis`, along the side of the square, and from its
    /// centre to the side.
    void add_gradient(std::size_t axis, const std::array<std::uint32_t, 4>& t, std::array<Interval, 3>& slopes) const {
        const auto [apex, middle, a, b] = t;
        std::size_t along = (axis + 1) % 3, across = (axis + 2) % 3;
        if (tree_.points()[a][along] == tree_.points()[b][along]) std::swap(along, across);
        std::array<Interval, 3> gradient;
        gradient[axis] = rise(apex, middle) / step(axis, apex, middle);
        gradient[along] = rise(a, b) / step(along, a, b);
        gradient[across] = (rise(middle, a) - gradient[along] * step(along, middle, a)) / step(across, middle, a);
        for (std::size_t i = 0; i < 3; ++i) slopes[i] = interval::hull(slopes[i], gradient[i]);
    }

    void mesh() {
        SurfaceBuilder builder(tree_, field_);
        for (const std::uint32_t leaf : open_leaves()) {
            visit_faces(tree_.cell(leaf), [&](int, std::uint32_t apex, std::uint32_t middle, const auto& ring) {
                for (std::size_t i = 0; i < ring.size(); ++i) {
                    const std::array<std::uint32_t, 4> t{apex, middle, ring[i], ring[(i + 1) % ring.size()]};
                    builder.add(t, {sign_of(t[0]), sign_of(t[1]), sign_of(t[2]), sign_of(t[3])}, 0);
                }
            });
        }
        result_.mesh = std::move(builder.take().mesh);
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
    std::chrono::steady_clock::time_point deadline_ = std::chrono::steady_clock::time_point::max();
    struct PointValue {
        double value = 0;  ///< of the interpolation; 0: none yet
        bool proved = false;
    };
    std::vector<PointValue> values_;               ///< per point
    std::vector<std::array<Interval, 3>> slopes_;  ///< per cell: an enclosure of grad f
    ImplicitResult result_;
};

}  // namespace

ImplicitResult mesh_by_subdivision(const Expression& function, const Grid& grid, const ImplicitOptions& options,
                                   const RunControl& control) {
    return Subdivision(function, grid, options, control).run();
}

}  // namespace certa::implicit
