// Mending by regions of the graph's faces.
//
// Each round makes the whole result anew from the same polygons and a set of faces: connected faces are a region, which
// the input inside replaces, thinned out. Sides of the region are cut where they pass edges of the input; the polygons
// around take over those corners that are left. Then everything is judged. Broken polygons beside a region are cut
// otherwise, then go back to where they were before placement; those for which that does not help, and all others, join
// the set. Where a patch is broken though nothing beside it is, it is not thinned out any more, and where that has not
// helped its region grows. All of this only grows, so it ends: at the latest when whole components are the input.
#include "remeshing/mend.h"

#include <certa/distance.h>
#include <certa/io.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "core/parallel.h"
#include "core/vector3.h"
#include "remeshing/flat_triangles.h"
#include "remeshing/missed_creases.h"
#include "remeshing/pair_triangles.h"
#include "remeshing/templates.h"
#include "remeshing/thin_out.h"

namespace certa::remeshing {
namespace {

/// Vertices of the input that thinning has to leave.
std::vector<std::uint8_t> fixed_vertices(const WorkMesh& mesh) {
    std::vector<std::uint8_t> is_fixed(mesh.points.size(), 0);
    for (Index v = 0; v < mesh.points.size(); ++v) is_fixed[v] = mesh.is_corner[v] ? 1 : 0;
    for (const Index v : mesh.minor_corners) is_fixed[v] = 1;
    return is_fixed;
}

/// Vertices that other sheets have copies of: where whole sheets are thinned out, each by itself, they stay.
std::vector<std::uint8_t> copied_vertices(const WorkMesh& mesh) {
    std::map<Index, Index> copies;
    if (mesh.is_cut_open)
        for (const Index source : mesh.point_sources) ++copies[source];
    std::vector<std::uint8_t> is_copied(mesh.points.size(), 0);
    for (Index v = 0; v < mesh.points.size() && mesh.is_cut_open; ++v)
        is_copied[v] = copies[mesh.point_sources[v]] > 1 ? 1 : 0;
    return is_copied;
}

class Mender {
public:
    Mender(const Layout& layout, const Judge& judge, const MendingRule& rule, CoarseMesh& mesh,
           const RunControl& control)
        : layout_(layout),
          mesh_(layout.network.mesh()),
          judge_(judge),
          rule_(rule),
          control_(control),
          base_(join(mesh)),
          out_(mesh),
          is_fixed_(fixed_vertices(mesh_)),
          is_copied_(copied_vertices(mesh_)),
          patcher_(layout) {
        in_set_.assign(patcher_.face_count(), 0);
        is_at_node_.assign(layout.nodes.size(), 0);
        is_cut_.assign(patcher_.face_count(), 0);
        for (std::size_t q = 0; q < base_.polygon_count(); ++q) {
            const auto ring = base_.polygon(q);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Index a = ring[i], b = ring[(i + 1) % ring.size()];
                sides_.push_back({std::min(a, b), std::max(a, b)});
            }
        }
        std::sort(sides_.begin(), sides_.end());
        for (const Index f : layout.open) {
            if (!std::binary_search(layout.filled.begin(), layout.filled.end(), f)) in_set_[f] = 1;
            open_in_patch_[patch_beside(layout.graph, layout.network, layout.faces[f].front())].push_back(f);
        }
    }

    void fill() {
        assemble();
        out_ = std::move(result_);
    }
    MendingReport run() {
        MendingReport report;
        for (;; ++report.rounds) {
            if (control_.cancelled()) break;
            assemble();
            if (!widen(report)) break;
            if (report.rounds % 8 == 7) control_.report("mending", 0.95);
        }
        if (!rule_.all_triangles && !regions_.empty()) pair_in_regions();
        report.regions = regions_.size();
        for (const Region& region : regions_) report.faces += region.faces.size(), report.triangles += region.triangles;
        for (std::size_t f = 0; f < in_set_.size(); ++f) report.cut_faces += in_set_[f] == 0 ? is_cut_[f] : 0;
        std::vector<Index> own = result_.corners;
        std::erase_if(own, [&](Index v) { return v >= base_.points.size(); });
        std::sort(own.begin(), own.end());
        report.first_added = static_cast<Index>(std::unique(own.begin(), own.end()) - own.begin());
        leave_out_unused(result_);
        out_ = std::move(result_);
        return report;
    }

private:
    static constexpr std::size_t most_tries = 8;  ///< in one place, before a region grows all around
    /// A place where nothing is thinned out.
    struct Ball {
        Point3 center;
        double radius = 0.0;
        std::size_t tries = 1, last_round = 0;
        bool holds(const Point3& p) const { return dot(p - center, p - center) <= radius * radius; }
    };
    /// A ball that holds a polygon.
    struct Around {
        Point3 center;
        double radius = 0.0;
        bool meets(const Around& other) const { return distance(center, other.center) < radius + other.radius; }
    };
    struct Region {
        std::vector<Index> faces;
        bool is_whole = false;
        std::size_t triangles = 0;
    };

    /// A polygon that covers parts of several faces goes as a whole.
    void take_joined() {
        for (bool again = true; again;) {
            again = false;
            for (const auto& [f, g] : base_.joined) {
                again = again || in_set_[f] != in_set_[g];
                in_set_[f] = in_set_[g] = std::max(in_set_[f], in_set_[g]);
            }
        }
    }

    /// Connected faces of the set, each with a patch: regions without one grow until they have.
    void find_regions() {
        for (bool again = true; again;) {
            again = false;
            take_joined();
            regions_.clear();
            region_of_.assign(in_set_.size(), no_index);
            for (Index seed = 0; seed < in_set_.size(); ++seed) {
                if (in_set_[seed] == 0 || region_of_[seed] != no_index) continue;
                Region region;
                region.faces.assign(1, seed);
                const auto number = static_cast<Index>(regions_.size());
                region_of_[seed] = number;
                const auto take = [&](Index g) {
                    if (g == no_index || in_set_[g] == 0 || region_of_[g] != no_index) return;
                    region_of_[g] = number;
                    region.faces.push_back(g);
                };
                for (std::size_t at = 0; at < region.faces.size(); ++at) {
                    const Index f = region.faces[at];
                    for (const Index h : layout_.faces[f]) take(patcher_.face_beside(h ^ 1U));
                    if (!std::binary_search(layout_.open.begin(), layout_.open.end(), f)) continue;
                    // Cycles in one patch may be the rims of one part of the surface.
                    for (const Index g :
                         open_in_patch_.at(patch_beside(layout_.graph, layout_.network, layout_.faces[f].front())))
                        take(g);
                }
                std::sort(region.faces.begin(), region.faces.end());
                region.is_whole = patcher_.is_whole(region.faces);
                regions_.push_back(std::move(region));
            }
            for (Region& region : regions_) {
                if (find_patch(region) != nullptr) continue;
                again = true;
                for (const Index f : patcher_.grow_for_patch(region.faces)) take_in(f);
            }
        }
    }

    /// Into the set; all rims of a flat face at once.
    void take_in(Index f) {
        in_set_[f] = 1;
        if (!std::binary_search(layout_.filled.begin(), layout_.filled.end(), f)) return;
        for (const Index g : open_in_patch_.at(patch_beside(layout_.graph, layout_.network, layout_.faces[f].front())))
            in_set_[g] = 1;
    }

    std::vector<Point3> points_of(const RegionPatch& patch) const {
        std::vector<Point3> points;
        for (const Index v : patch.outer) points.push_back(node_point(v));
        for (const RegionVertex& v : patch.inner) points.push_back(v.point);
        return points;
    }
    /// Where a corner of a region lies on the input, whatever placement has done.
    const Point3& node_point(Index vertex) const { return layout_.graph.nodes[layout_.nodes[vertex]].point; }

    const RegionPatch* find_patch(const Region& region) {
        auto found = patches_.find(region.faces);
        if (found == patches_.end()) {
            std::optional<RegionPatch> patch = patcher_.make(region.faces);
            if (patch) thin(*patch);
            found = patches_.emplace(region.faces, std::move(patch)).first;
        }
        return found->second ? &*found->second : nullptr;
    }
    void thin(RegionPatch& patch) const {
        ThinningRule rule;
        rule.tolerance = rule_.tolerance;
        rule.side_tolerance = rule_.side_tolerance;
        rule.side_share = 0.1;
        rule.side_reach = rule_.crease_reach;
        rule.joined = sides_;
        rule.is_fixed.assign(patch.outer.size() + patch.inner.size(), 1);
        for (std::size_t i = 0; i < patch.inner.size(); ++i) {
            const RegionVertex& v = patch.inner[i];
            const bool is_fixed =
                v.kind == VertexKind::corner || v.on_minor_edge || (v.source != no_index && is_fixed_[v.source] != 0) ||
                (patch.sides.empty() && v.source != no_index && is_copied_[v.source] != 0) ||
                std::any_of(kept_.begin(), kept_.end(), [&](const Ball& b) { return b.holds(v.point); });
            rule.is_fixed[patch.outer.size() + i] = is_fixed ? 1 : 0;
        }
        thin_out(patch, points_of(patch), judge_, rule, control_);
    }

    void assemble() {
        find_regions();
        result_ = base_.without_polygons();
        std::map<std::array<Index, 2>, std::vector<Index>> between;  // of sides, as the neighbour walks them
        for (Region& region : regions_) {
            const RegionPatch& patch = *find_patch(region);
            std::vector<Index> numbers = patch.outer;
            for (const Index v : patch.outer) is_at_node_[v] = 1;
            for (const RegionVertex& v : patch.inner)
                numbers.push_back(result_.add_vertex(v.point, v.place, v.kind, v.curve));
            for (const RegionSide& side : patch.sides)  // between ends that were merged nothing is left
                if (numbers[side.corners.front()] == numbers[side.corners.back()])
                    for (const Index v : side.corners) numbers[v] = numbers[side.corners.front()];
            region.triangles = 0;
            for (const auto& t : patch.triangles) {
                const std::array ring{numbers[t[0]], numbers[t[1]], numbers[t[2]]};
                if (ring[0] == ring[1] || ring[1] == ring[2] || ring[2] == ring[0]) continue;
                result_.add_polygon(ring, region.faces.front());
                ++region.triangles;
            }
            for (const FeatureEdge& e : patch.feature_edges)
                result_.feature_edges.push_back({numbers[e.a], numbers[e.b], e.curve});
            for (const RegionSide& side : patch.sides) {
                if (side.corners.size() < 3 || numbers[side.corners.front()] == numbers[side.corners.back()]) continue;
                auto& list = between[{numbers[side.corners.back()], numbers[side.corners.front()]}];
                for (std::size_t i = side.corners.size() - 2; i > 0; --i) list.push_back(numbers[side.corners[i]]);
                for (std::size_t i = 1; i < side.corners.size() && side.curve != no_index; ++i)
                    result_.feature_edges.push_back(
                        {numbers[side.corners[i - 1]], numbers[side.corners[i]], side.curve});
            }
        }
        for (Index v = 0; v < is_at_node_.size(); ++v)
            if (is_at_node_[v] != 0) result_.points[v] = node_point(v);
        add_polygons_around(between);
    }
    /// The polygons of no region, with the corners that regions have left on their sides.
    void add_polygons_around(const std::map<std::array<Index, 2>, std::vector<Index>>& between) {
        CoarseMesh changed = result_.without_polygons(), cut = changed;
        is_changed_.assign(in_set_.size(), 0);
        std::vector<Index> ring;
        for (std::size_t q = 0; q < base_.polygon_count(); ++q) {
            const Index parent = base_.parent(q);
            if (parent != no_index && in_set_[parent] != 0) continue;
            const auto old = base_.polygon(q);
            ring.clear();
            for (std::size_t i = 0; i < old.size(); ++i) {
                ring.push_back(old[i]);
                const auto found = between.find({old[i], old[(i + 1) % old.size()]});
                if (found != between.end()) ring.insert(ring.end(), found->second.begin(), found->second.end());
            }
            const bool is_cut = parent != no_index && is_cut_[parent] != 0;
            if (parent != no_index && ring.size() != old.size()) is_changed_[parent] = 1;
            (is_cut ? cut : ring.size() == old.size() ? result_ : changed).add_polygon(ring, parent);
        }
        // Corners without a turn leave too much to a reader who fills polygons: these are cut here.
        changed = rule_.all_triangles ? make_triangles(changed, judge_.tree) : make_quad_dominant(changed);
        cut = make_triangles(cut, judge_.tree);
        for (const CoarseMesh& part : {changed, cut})
            for (std::size_t q = 0; q < part.polygon_count(); ++q) result_.add_polygon(part.polygon(q), part.parent(q));
        result_ = without_flat_triangles(result_);
    }

    /// Flat parts of regions become quads; those that would do harm are cut again.
    void pair_in_regions() {
        std::vector<Index> group;
        for (std::size_t q = 0; q < result_.polygon_count(); ++q) {
            const Index f = result_.parent(q);
            group.push_back(f != no_index && in_set_[f] != 0 ? region_of_[f] : no_index);
        }
        // Diagonals of quads are a little off the triangles for which the error was proved.
        const double height = rule_.error > 0.0 ? 0.005 * rule_.error : 0.1 * rule_.tolerance;
        std::vector<Index> unused;
        const double allowed = std::max(add_missed_creases(mesh_, judge_, result_, huge, unused),
                                        0.9 * (rule_.reach > 0.0 ? rule_.reach : reach_of(mesh_, judge_, result_)));
        for (int round = 0; round < 6 && !control_.cancelled(); ++round) {
            CoarseMesh paired = pair_triangles(result_, group, height);
            std::vector<Index> broken = find_damage(judge_, paired, control_).polygons;
            std::swap(result_, paired);
            // A side that is gone may have been a short crease.
            if (broken.empty()) add_missed_creases(mesh_, judge_, result_, allowed, broken);
            if (broken.empty()) return;
            std::swap(result_, paired);
            // Nothing is paired around what that has broken.
            const std::vector<std::uint8_t> is_bad = mark_corners(broken, paired);
            for (std::size_t q = 0; q < group.size(); ++q) {
                const auto ring = result_.polygon(q);
                if (std::any_of(ring.begin(), ring.end(), [&](Index v) { return is_bad[v] != 0; })) group[q] = no_index;
            }
        }
    }

    /// T-nodes near each other cancel where that does no harm and is not too far.
    CoarseMesh join(const CoarseMesh& mesh) const {
        if (rule_.all_recuts) return recut(mesh, rule_.recuts);
        std::vector<Recut> recuts = rule_.recuts;
        while (!recuts.empty() && !control_.cancelled()) {
            CoarseMesh joined = recut(mesh, recuts), looked_at = joined;
            std::vector<Index> damaged = find_damage(judge_, looked_at, control_).polygons;
            if (rule_.error > 0.0) add_far(looked_at, damaged);
            const std::vector<std::uint8_t> is_bad = mark_corners(damaged, looked_at);
            const std::size_t gone = std::erase_if(recuts, [&](const Recut& r) {
                return std::any_of(r.after.begin(), r.after.end(), [&](const std::vector<Index>& ring) {
                    return std::all_of(ring.begin(), ring.end(), [&](Index v) { return is_bad[v] != 0; });
                });
            });
            if (gone == 0) return joined;
        }
        return mesh;
    }
    static std::vector<std::uint8_t> mark_corners(const std::vector<Index>& polygons, const CoarseMesh& mesh) {
        std::vector<std::uint8_t> is_marked(mesh.points.size(), 0);
        for (const Index q : polygons)
            for (const Index v : mesh.polygon(q)) is_marked[v] = 1;
        return is_marked;
    }

    /// Sides that two polygons walk in the same direction, where a cut has repeated one, and sides that only one walks
    /// and that are no boundary, where what is around a region does not fit it.
    void add_odd_sides(std::vector<Index>& broken) const {
        struct Side {
            Index from = no_index, to = no_index, polygon = no_index;
            bool operator<(const Side& other) const {
                return std::tie(from, to, polygon) < std::tie(other.from, other.to, other.polygon);
            }
        };
        std::vector<Side> sides;
        for (Index q = 0; q < result_.polygon_count(); ++q) {
            const auto ring = result_.polygon(q);
            for (std::size_t i = 0; i < ring.size(); ++i) sides.push_back({ring[i], ring[(i + 1) % ring.size()], q});
        }
        std::sort(sides.begin(), sides.end());
        std::vector<std::uint64_t> boundary;
        for (const FeatureEdge& e : result_.feature_edges)
            if (mesh_.curves[e.curve].boundary) boundary.push_back(pair_key(e.a, e.b));
        std::sort(boundary.begin(), boundary.end());
        for (std::size_t i = 0; i < sides.size(); ++i) {
            const Side& side = sides[i];
            if (i > 0 && side.from == sides[i - 1].from && side.to == sides[i - 1].to) {
                broken.push_back(side.polygon), broken.push_back(sides[i - 1].polygon);
                continue;
            }
            const auto back = std::lower_bound(sides.begin(), sides.end(), Side{side.to, side.from, 0});
            if (back != sides.end() && back->from == side.to && back->to == side.from) continue;
            if (!std::binary_search(boundary.begin(), boundary.end(), pair_key(side.from, side.to)))
                broken.push_back(side.polygon);
        }
    }

    /// Does something about what is broken. False: nothing is, or nothing can be done about it.
    bool widen(MendingReport& report) {
        const Damage damage = find_damage(judge_, result_, control_);
        report.split_quads = damage.split;
        std::vector<Index> broken = damage.polygons;
        add_odd_sides(broken);
        std::vector<Index> apart;
        if (rule_.reach > 0.0) {
            add_missed_creases(mesh_, judge_, result_, 0.9 * rule_.reach, apart);
        } else if (broken.empty()) {
            // Not before all else is sound, which lowers the bound.
            const double limit = crease_limit(rule_.creases, mesh_, judge_, result_, control_);
            if (limit < huge) add_missed_creases(mesh_, judge_, result_, limit, apart);
        }
        if (rule_.error > 0.0) add_far(result_, apart);
        // Where the input is, a crease may be nearer, but not what keeps no error.
        std::vector<Index> too_far;
        bool has_changed = cut(apart, rule_.error > 0.0 ? too_far : broken);
        sort_unique(broken);
        const std::vector<Around> outside = help_outside(broken, too_far);
        has_changed = has_changed || !outside.empty();
        broken.insert(broken.end(), too_far.begin(), too_far.end());
        sort_unique(broken);
        report.left.clear();
        for (const Index q : broken) report.left.push_back(result_.points[result_.polygon(q)[0]]);
        std::map<Index, std::vector<Index>> broken_patches;
        for (const Index q : broken) {
            const Index f = result_.parent(q);
            if (f == no_index || region_of_[f] == no_index) continue;
            // It may be sound once what it meets is.
            const Around own = around(q);
            if (std::none_of(outside.begin(), outside.end(), [&](const Around& other) { return own.meets(other); }))
                broken_patches[region_of_[f]].push_back(q);
        }
        for (const auto& [r, polygons] : broken_patches) {
            const Region& region = regions_[r];
            if (region.is_whole) continue;
            has_changed = true;
            std::vector<Index> near_border;
            bool is_stuck = false;
            for (const Index q : polygons) {
                const std::size_t tries = keep(q, report.rounds);
                if (tries > 2) near_border.push_back(q);
                is_stuck = is_stuck || tries > most_tries;
            }
            patches_.erase(region.faces);
            for (const Index g : faces_around(region, near_border, is_stuck)) take_in(g);
        }
        return has_changed;
    }

    Around around(Index q) const {
        const auto ring = result_.polygon(q);
        Around ball;
        for (const Index v : ring)
            ball.center = ball.center + (1.0 / static_cast<double>(ring.size())) * result_.points[v];
        for (const Index v : ring) ball.radius = std::max(ball.radius, distance(ball.center, result_.points[v]));
        return ball;
    }

    /// What is broken and in no region: with a region's corners on its sides, the best triangles may be better than a
    /// template's; beside these corners, which are on the input, others may have to be there, too. Else, and what
    /// is too far, it is taken into the set. Returns where that was.
    std::vector<Around> help_outside(const std::vector<Index>& broken, const std::vector<Index>& too_far) {
        std::vector<Around> places;
        std::vector<Index> faces;
        std::vector<std::uint8_t> is_helped(in_set_.size(), 0);
        for (const Index q : too_far) {
            const Index f = result_.parent(q);
            if (f == no_index || in_set_[f] != 0) continue;
            places.push_back(around(q));
            take_in(f);
        }
        for (const Index q : broken) {
            const Index f = result_.parent(q);
            if (f == no_index || in_set_[f] != 0) continue;
            places.push_back(around(q));
            faces.push_back(f);
            const bool may_cut = is_changed_[f] != 0 && is_cut_[f] == 0;
            if (may_cut || (is_helped[f] == 0 && return_to_nodes(q))) is_helped[f] = 1;
            if (may_cut) is_cut_[f] = 1;
        }
        for (const Index f : faces)
            if (is_helped[f] == 0) take_in(f);
        return places;
    }
    /// False: no corner is one of a region, or all are where the input is already.
    bool return_to_nodes(Index q) {
        const auto ring = result_.polygon(q);
        const auto is_returned = [&](Index v) { return v < is_at_node_.size() && is_at_node_[v] != 0; };
        if (std::none_of(ring.begin(), ring.end(), is_returned)) return false;
        bool any = false;
        for (const Index v : ring) {
            if (v >= is_at_node_.size() || is_at_node_[v] != 0) continue;
            is_at_node_[v] = 1;
            any = true;
        }
        return any;
    }

    /// Nothing is thinned out any more at this polygon, each time somewhat farther around it. How often it has been.
    std::size_t keep(Index q, std::size_t round) {
        const auto ring = result_.polygon(q);
        for (Ball& ball : kept_)
            if (std::all_of(ring.begin(), ring.end(), [&](Index v) { return ball.holds(result_.points[v]); })) {
                if (ball.last_round == round) return ball.tries;
                ball.last_round = round;
                ball.radius *= 1.5;
                return ++ball.tries;
            }
        const Around ball = around(q);
        kept_.push_back({ball.center, 1.5 * ball.radius, 1, round});
        return kept_.back().tries;
    }

    /// The region and what touches its border where polygons of its patch are broken; or all around.
    std::vector<Index> faces_around(const Region& region, const std::vector<Index>& polygons, bool all) const {
        std::vector<Index> grown = region.faces;
        for (const Index q : polygons)
            for (const Index v : result_.polygon(q))
                if (v < layout_.nodes.size()) {
                    const auto& around = patcher_.faces_at(layout_.nodes[v]);
                    grown.insert(grown.end(), around.begin(), around.end());
                }
        std::sort(grown.begin(), grown.end());
        grown.erase(std::unique(grown.begin(), grown.end()), grown.end());
        return all ? patcher_.grow(grown) : grown;
    }

    static PolygonMesh as_polygons(const CoarseMesh& coarse) {
        PolygonMesh mesh{coarse.points, {}, coarse.offsets};
        for (const Index v : coarse.corners) mesh.corners.push_back(VertexId{v});
        return mesh;
    }
    /// Polygons where the error is not kept.
    void add_far(const CoarseMesh& mesh, std::vector<Index>& apart) const {
        constexpr std::uint64_t pieces = 200000;
        for (const FarPlace& place :
             find_far_places(as_polygons(mesh), make_polygon_mesh(judge_.input), rule_.error, pieces, control_))
            apart.push_back(place.is_on_first ? place.polygon : place.nearest);
    }
    /// What is too far is cut along its best diagonals first; triangles are broken. True: something was cut.
    bool cut(const std::vector<Index>& apart, std::vector<Index>& broken) {
        std::vector<std::uint8_t> is_cut_now(is_cut_.size(), 0);
        bool has_cut = false;
        for (const Index q : apart) {
            const Index f = result_.parent(q);
            const bool may_cut = result_.polygon(q).size() > 3 && f != no_index && in_set_[f] == 0;
            if (may_cut && is_cut_[f] == 0) {
                is_cut_[f] = is_cut_now[f] = 1;
                has_cut = true;
            } else if (!may_cut || is_cut_now[f] == 0) {
                broken.push_back(q);
            }
        }
        return has_cut;
    }

    const Layout& layout_;
    const WorkMesh& mesh_;
    const Judge& judge_;
    const MendingRule& rule_;
    static constexpr double huge = std::numeric_limits<double>::infinity();
    const RunControl& control_;
    const CoarseMesh base_;
    CoarseMesh& out_;
    const std::vector<std::uint8_t> is_fixed_, is_copied_;
    RegionPatcher patcher_;

    std::vector<std::uint8_t> in_set_;      ///< per face of the graph: the input takes its place
    std::vector<std::uint8_t> is_cut_;      ///< likewise: triangles do
    std::vector<std::uint8_t> is_changed_;  ///< likewise: its polygon has got corners of a region
    std::vector<std::uint8_t> is_at_node_;  ///< per vertex: it is where the input is, not where it was placed
    std::map<Index, std::vector<Index>> open_in_patch_;
    std::vector<std::array<Index, 2>> sides_;  ///< of all polygons, the lower number first, sorted
    std::vector<Ball> kept_;
    std::vector<Region> regions_;
    std::vector<Index> region_of_;  ///< per face
    std::map<std::vector<Index>, std::optional<RegionPatch>> patches_;
    CoarseMesh result_;
};

}  // namespace

void leave_out_unused(CoarseMesh& mesh) {
    std::vector<std::array<Index, 2>> sides;
    std::vector<Index> numbers(mesh.points.size(), no_index);
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i], b = ring[(i + 1) % ring.size()];
            sides.push_back({std::min(a, b), std::max(a, b)});
            numbers[a] = 0;
        }
    }
    std::sort(sides.begin(), sides.end());
    std::erase_if(mesh.feature_edges, [&](const FeatureEdge& e) {
        return !std::binary_search(sides.begin(), sides.end(), std::array{std::min(e.a, e.b), std::max(e.a, e.b)});
    });
    Index count = 0;
    for (Index v = 0; v < numbers.size(); ++v) {
        if (numbers[v] == no_index) continue;
        numbers[v] = count;
        mesh.points[count] = mesh.points[v];
        mesh.kinds[count] = mesh.kinds[v];
        mesh.curves[count] = mesh.curves[v];
        mesh.places[count++] = mesh.places[v];
    }
    mesh.points.resize(count), mesh.kinds.resize(count), mesh.curves.resize(count), mesh.places.resize(count);
    for (Index& v : mesh.corners) v = numbers[v];
    for (FeatureEdge& e : mesh.feature_edges) e.a = numbers[e.a], e.b = numbers[e.b];
}

MendingReport mend(const Layout& layout, const Judge& judge, const MendingRule& rule, CoarseMesh& mesh,
                   const RunControl& control) {
    return Mender(layout, judge, rule, mesh, control).run();
}

void fill_open_faces(const Layout& layout, const Judge& judge, const MendingRule& rule, CoarseMesh& mesh,
                     const RunControl& control) {
    if (layout.open.size() != layout.filled.size()) Mender(layout, judge, rule, mesh, control).fill();
}

namespace {

CoarseMesh thin(RegionPatch patch, const WorkMesh& mesh, const Judge& judge, double tolerance, std::size_t vertices,
                const RunControl& control) {
    std::vector<Point3> points;
    for (const RegionVertex& v : patch.inner) points.push_back(v.point);
    ThinningRule rule;
    rule.tolerance = tolerance;
    rule.least_vertices = vertices;
    const std::vector<std::uint8_t> is_fixed = fixed_vertices(mesh), is_copied = copied_vertices(mesh);
    for (const RegionVertex& v : patch.inner)
        rule.is_fixed.push_back(v.source == no_index ? 0 : is_fixed[v.source] | is_copied[v.source]);
    if (tolerance > 0.0) thin_out(patch, points, judge, rule, control);
    CoarseMesh out;
    for (const RegionVertex& v : patch.inner) out.add_vertex(v.point, v.place, v.kind, v.curve);
    for (const auto& t : patch.triangles) out.add_polygon(t);
    out.feature_edges = patch.feature_edges;
    return out;
}

}  // namespace

CoarseMesh thin_input(const WorkMesh& mesh, const Judge& judge, double tolerance, std::size_t vertices,
                      const RunControl& control) {
    return thin(take_all(mesh), mesh, judge, tolerance, vertices, control);
}

CoarseMesh thin_part(const WorkMesh& mesh, std::span<const Index> triangles, const Judge& judge, double tolerance,
                     const RunControl& control) {
    return thin(take_part(mesh, triangles), mesh, judge, tolerance, 0, control);
}

}  // namespace certa::remeshing
