// Meshes of other programs: W grown along a mesh (docs/implicit-theorem.md, "any mesh").
//
// Plan: the usual proof first; its W decides components and genera, and holds a fine mesh. A coarse mesh leaves it:
// then the sign of f is forgotten on the leaves that the mesh crosses, so that W may grow into them (they are regular,
// and the sign is proved anew on the faces of W), critical leaves that it crosses are split, and the leaves where it
// still touches the frontier; again, at most eight times. Nothing of this needs to be right: the checker decides.
#include <certa/implicit_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/vector3.h"
#include "implicit/certificate.h"
#include "implicit/clusters.h"
#include "implicit/conditions.h"
#include "implicit/engine.h"
#include "implicit/frontier.h"
#include "implicit/growth.h"
#include "implicit/refine.h"
#include "interval/environment.h"

namespace certa {
namespace implicit {
namespace {

constexpr int most_rounds = 8, most_generations = 100;

class GuidedGrowth {
public:
    GuidedGrowth(const TriangleMesh& mesh, const Expression& function, const Grid& grid, const ImplicitOptions& options,
                 const RunControl& control)
        : mesh_(mesh), function_(function), tape_(function), tree_(grid), field_(tape_), control_(control) {
        limits_.max_cells = options.max_cells.value_or(std::uint64_t{1} << 31);
        const auto deepest = static_cast<std::uint64_t>(tree_.max_depth());
        limits_.max_depth = static_cast<int>(std::min(options.max_depth.value_or(deepest), deepest));
    }

    /// A certificate for a W that holds the mesh if possible; empty where a limit was met.
    std::string run() {
        if (classify(tree_, tape_, limits_, control_)) return {};
        // Critical leaves are split below; clusters and degrees are found anew then.
        std::size_t fewest = ~std::size_t{0};
        int vain = 0;  // rounds that brought no fewer contacts
        for (int round = 0; round < most_rounds && !control_.cancelled(); ++round) {
            if (!split_critical() || !settle()) return {};
            std::vector<std::uint32_t> contacts = contacts_with_frontier();
            vain = contacts.size() < fewest ? 0 : vain + 1;
            fewest = std::min(fewest, contacts.size());
            if (contacts.empty() || vain == 2) break;
            if (split_all(tree_, contacts, tape_, limits_, control_)) return {};
        }
        if (control_.cancelled()) return {};
        std::vector<ImplicitComponent> components;
        for (const ComponentOfW& c : findings_.components) {
            components.emplace_back();
            components.back().genus = c.genus();
        }
        return write_certificate(function_, tree_, *triangulation_, growth_, {}, mesh_, components);
    }

private:
    Corners corners(const Triangle& t) const {
        return {mesh_.positions[index_of(t[0])], mesh_.positions[index_of(t[1])], mesh_.positions[index_of(t[2])]};
    }

    /// About how far a triangle is from the zero set, its size at most.
    double deviation(const Corners& t) {
        const double size = std::max({distance(t[0], t[1]), distance(t[1], t[2]), distance(t[2], t[0])});
        double largest = 0;
        static constexpr double samples[4][3] = {{1. / 3, 1. / 3, 1. / 3}, {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}};
        for (const auto& w : samples) {
            const auto& jet = field_.slope(w[0] * t[0] + w[1] * t[1] + w[2] * t[2]);
            const double d = std::fabs(jet.value) / std::hypot(jet.gradient[0], jet.gradient[1], jet.gradient[2]);
            largest = std::max(largest, d < size ? d : size);
        }
        return 1.5 * largest;
    }

    /// Leaves that triangles of the mesh meet, or all those between them and the zero set too; each once.
    std::vector<std::uint32_t> crossed(bool with_between) {
        std::vector<std::uint32_t> result, work;
        for (const Triangle& t : mesh_.triangles) {
            const Corners c = corners(t);
            const double d = with_between ? deviation(c) : 0;
            const Point3 more{d, d, d};
            work.push_back(0);
            while (!work.empty()) {
                const std::uint32_t id = work.back();
                work.pop_back();
                const Cell& cell = tree_.cell(id);
                if (box_apart(tree_.grid().place(cell.low) - more, tree_.grid().place(tree_.high_of(cell)) + more, c))
                    continue;
                if (cell.is_leaf()) {
                    result.push_back(id);
                } else {
                    for (std::uint32_t k = 0; k < 8; ++k) work.push_back(cell.children + k);
                }
            }
        }
        std::sort(result.begin(), result.end());
        result.erase(std::unique(result.begin(), result.end()), result.end());
        return result;
    }

    /// Splits critical leaves that the mesh crosses until their pieces along it have slopes, some times.
    bool split_critical() {
        for (int generation = 0; generation < 4; ++generation) {
            std::vector<std::uint32_t> critical;
            for (const std::uint32_t leaf : crossed(false)) {
                if (tree_.cell(leaf).is_critical() && !tree_.touches_boundary(tree_.cell(leaf)))
                    critical.push_back(leaf);
            }
            if (critical.empty()) return true;
            if (split_all(tree_, critical, tape_, limits_, control_)) return false;
        }
        return true;
    }

    /// The main loop of the engine, W being free to grow into the leaves that the mesh crosses.
    bool settle() {
        for (int generation = 0; generation < most_generations && !control_.cancelled(); ++generation) {
            for (const std::uint32_t leaf : crossed(true)) {
                Cell& cell = tree_.cell(leaf);
                if (cell.known.slope != 0 && !tree_.touches_boundary(cell)) cell.known.sign = 0;
            }
            triangulation_.emplace(tree_, field_, signs_);
            growth_ = grow(*triangulation_, points_along_mesh(), control_);
            findings_ = check_conditions(tree_, *triangulation_, growth_, find_clusters(tree_), tape_, control_);
            if (findings_.offenders.empty()) return true;
            if (split_all(tree_, findings_.offenders, tape_, limits_, control_)) return false;
        }
        return false;
    }

    /// Ranks: points of the leaves that the mesh crosses go first.
    std::vector<float> points_along_mesh() {
        std::vector<char> crossed_leaf(tree_.cells().size(), 0);
        std::vector<float> result(triangulation_->point_count(), 1);
        for (const std::uint32_t leaf : crossed(false)) crossed_leaf[leaf] = 1;
        for (std::size_t i = 0; i < triangulation_->active_leaves().size(); ++i) {
            if (!crossed_leaf[triangulation_->active_leaves()[i]]) continue;
            for (const auto& t : triangulation_->tetrahedra_of(i)) {
                for (const std::uint32_t p : t) result[p] = 0;
            }
        }
        return result;
    }

    std::vector<std::uint32_t> contacts_with_frontier() const {
        const Frontier frontier(tree_, *triangulation_, growth_);
        std::vector<std::uint32_t> leaves;
        for (const Triangle& t : mesh_.triangles) frontier.find_leaves(corners(t), leaves);
        // No point of a critical leaf is ever in W: those beside a contact have to become smaller, too.
        for (std::size_t i = 0, count = leaves.size(); i < count; ++i) add_critical_neighbours(leaves[i], leaves);
        std::sort(leaves.begin(), leaves.end());
        leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
        return leaves;
    }

    void add_critical_neighbours(std::uint32_t leaf, std::vector<std::uint32_t>& leaves) const {
        tree_.visit_around_corners(tree_.cell(leaf), [&](std::uint32_t other) {
            if (tree_.cell(other).is_critical() && !tree_.touches_boundary(tree_.cell(other))) leaves.push_back(other);
        });
    }

    const TriangleMesh& mesh_;
    Expression function_;
    expression::Tape tape_;
    Octree tree_;
    Field field_;
    const RunControl& control_;
    Limits limits_;
    std::vector<Triangulation::PointSign> signs_;
    std::optional<Triangulation> triangulation_;
    Growth growth_;
    Findings findings_;
};

/// Whether the guided growth may look at the mesh at all.
bool is_usable(const TriangleMesh& mesh) {
    for (const Triangle& t : mesh.triangles) {
        for (const VertexId v : t) {
            if (index_of(v) >= mesh.positions.size()) return false;
            const Point3& p = mesh.positions[index_of(v)];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
        }
    }
    return true;
}

}  // namespace
}  // namespace implicit

std::array<Point3, 2> find_box_around(const TriangleMesh& mesh) {
    if (mesh.positions.empty())
        throw InputError({{DefectKind::empty_input, {}, {}, "an empty mesh has no place: give the box"}});
    Point3 low = mesh.positions.front(), high = low;
    for (const Point3& p : mesh.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    // No power of 2 divides these: grids are not aligned with the cells of the proof then.
    const double size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    return {{{low.x - 0.1537 * size, low.y - 0.1619 * size, low.z - 0.1471 * size},
             {high.x + 0.1723 * size, high.y + 0.1511 * size, high.z + 0.1673 * size}}};
}

ImplicitMeshCheck check_mesh_against(const TriangleMesh& mesh, std::string_view function, const Point3& low,
                                     const Point3& high, const ImplicitOptions& options, const RunControl& control) {
    const Expression expression = parse_expression(function);
    ImplicitOptions plain = options;
    plain.certificate = true;
    plain.clip = false;
    plain.error.reset();
    plain.hausdorff.reset();
    const auto grid = implicit::checked_grid(low, high);
    // Of a product, too, one W for the whole: that of a factor says nothing about the others.
    const ImplicitResult result = implicit::certify_whole(expression, grid, plain, control);
    ImplicitMeshCheck check;
    if (result.verdict == ImplicitVerdict::undecided) {
        check.outcome = result.outcome;
        check.obstacles = result.obstacles;
        check.reasons.push_back("the topology of the zero set could not be proved");
    } else {
        check = judge_implicit_mesh(mesh, function, result.certificate, control);
        if (check.verdict == ImplicitMeshVerdict::undecided && check.surface_known && implicit::is_usable(mesh) &&
            !control.cancelled()) {
            const std::string guided = implicit::GuidedGrowth(mesh, expression, grid, options, control).run();
            if (!guided.empty()) {
                ImplicitMeshCheck second = judge_implicit_mesh(mesh, function, guided, control);
                // Both W are right; that which holds more of the mesh says where it leaves.
                if (second.surface_known &&
                    (second.verdict != ImplicitMeshVerdict::undecided || second.triangle_count < check.triangle_count))
                    check = std::move(second);
            }
        }
        if (control.cancelled()) check.outcome = Outcome::cancelled;
    }
    check.low = result.low;
    check.high = result.high;
    return check;
}

}  // namespace certa
