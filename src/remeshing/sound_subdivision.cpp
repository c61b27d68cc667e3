// Between the smooth surface and the coarse polygons (stage 10 of remesh).
//
// Plan: round by round. The same round without averaging gives every vertex a place on its polygon of the round before,
// where nothing is broken that was not broken there. Damage is looked for by the code that mending uses; vertices of
// what is broken, and those around, go half of the way back, from the fourth time on all of it. A quad that is broken
// even then is cut into its two triangles, on which the places lie exactly; a triangle, a piece of which may turn away
// from the input right below it though the whole does not, is not subdivided, nor are its sides; and where that does
// not help its neighbours are not either. All this only grows, so it ends; at the latest where nothing is subdivided.
// Looking is dear: after the first time only at polygons that have changed and what their boxes meet, until nothing is
// broken there; then at everything again.
#include "remeshing/sound_subdivision.h"

#include <certa/distance.h>
#include <certa/io.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "core/vector3.h"
#include "remeshing/missed_creases.h"
#include "remeshing/stitch.h"
#include "remeshing/subdivision.h"
#include "remeshing/text.h"
#include "remeshing/triangulate.h"

namespace certa::remeshing {
namespace {

/// What becomes of a polygon.
enum class Treatment : std::uint8_t { whole, cut, coarse };

/// The input's creases that no curve follows, and their corners: they are no features of a coarse mesh.
core::TriangleTree short_creases(const WorkMesh& mesh) {
    std::vector<Triangle> segments;
    for (const Index e : mesh.minor_edges) {
        const Index h = mesh.edge_halfedges[e];
        segments.push_back({VertexId{mesh.start_of(h)}, VertexId{mesh.end_of(h)}, VertexId{mesh.end_of(h)}});
    }
    for (const Index v : mesh.minor_corners) segments.push_back({VertexId{v}, VertexId{v}, VertexId{v}});
    return {mesh.points, segments};
}

class Round {
public:
    /// `cover`: of the bound on the distance, so far creases may be from the result.
    Round(const CoarseMesh& mesh, const std::vector<std::uint8_t>& stays, const Judge& judge,
          const SubdivisionRule& rule, double cover, const RunControl& control)
        : mesh_(mesh), judge_(judge), input_(rule.input), error_(rule.error), cover_(cover), control_(control) {
        const WorkMesh* input = rule.input;
        for (const std::uint8_t s : stays) treatments_.push_back(s != 0 ? Treatment::coarse : Treatment::whole);
        if (input != nullptr && !(input->minor_edges.empty() && input->minor_corners.empty()))
            short_creases_.emplace(short_creases(*input));
        around_.resize(mesh.points.size());
        const std::vector<Index> names = names_of(mesh);
        for (Index q = 0; q < mesh.polygon_count(); ++q)
            for (const Index v : mesh.polygon(q)) around_[names.empty() ? v : names[v]].push_back(q);
        names_ = names;
    }

    /// Empty: nothing could be subdivided.
    std::optional<CoarseMesh> run() {
        constexpr int most_looks = 90, patience = 60;
        build();
        bool is_full = true;
        for (int look = 0; look < most_looks; ++look) {
            if (is_full) std::fill(has_changed_.begin(), has_changed_.end(), 1);
            is_apart_ = is_far_off_ = false;
            std::vector<Index> broken = find_broken();
            if (control_.cancelled()) return result_;
            if (broken.empty() && is_full) broken = find_missed_creases();
            if (broken.empty() && is_full) broken = find_far();
            std::fill(has_changed_.begin(), has_changed_.end(), 0);
            const bool reacts = react(broken, look >= patience);
            if (is_full && !reacts) {
                if (!is_apart_) break;
                // Where smoothing elsewhere has lowered the distance that is allowed: all of it back, half of the way
                // each time; the surface of the round before, at least.
                const double most = *std::max_element(part_.begin(), part_.end());
                if (most == 0.0) return std::nullopt;
                for (double& part : part_) part = most > 0.2 ? 0.5 * part : 0.0;
                continue;
            }
            is_full = !reacts;
            if (look + 1 == most_looks) return std::nullopt;
        }
        if (std::all_of(treatments_.begin(), treatments_.end(), [](Treatment t) { return t == Treatment::coarse; }))
            return std::nullopt;
        return result_;
    }
    bool is_held(Index v) const { return part_[v] < 1.0; }
    /// Of a polygon of the round: that of the mesh.
    Index parent(Index q) const { return parents_[q]; }
    bool stays(Index q) const { return treatments_[q] == Treatment::coarse; }

private:
    std::vector<Index> names_of(const CoarseMesh& mesh) const {
        return judge_.is_cut_open ? stitched_vertices(mesh) : std::vector<Index>();
    }

    /// The mesh of the round, smooth and flat, from the treatments; what is known of vertices stays with them.
    void build() {
        struct Known {
            double part = 1.0;
            int tries = 0;
            Point3 smooth;
        };
        const auto key_of = [](const Point3& p) { return std::array{p.x, p.y, p.z}; };
        std::map<std::array<double, 3>, Known> known;
        for (std::size_t v = 0; v < part_.size(); ++v) {
            const Known now{part_[v], tries_[v], smooth_.points[v]};
            Known& entry = known.emplace(key_of(flat_.points[v]), now).first->second;
            if (now.part < entry.part) entry = now;
        }
        CoarseMesh coarse = mesh_.without_polygons();
        std::vector<std::uint8_t> stays;
        std::vector<std::array<Index, 3>> triangles;
        for (Index q = 0; q < mesh_.polygon_count(); ++q) {
            triangles.clear();
            if (treatments_[q] == Treatment::cut)
                triangulate_polygon(mesh_.points, mesh_.polygon(q), judge_.tree, triangles);
            else
                coarse.add_polygon(mesh_.polygon(q), q);
            for (const auto& t : triangles) coarse.add_polygon(t, q);
            stays.resize(coarse.polygon_count(), treatments_[q] == Treatment::coarse ? 1 : 0);
        }
        smooth_ = subdivide(coarse, true, stays, names_);
        flat_ = subdivide(coarse, false, stays, names_);
        parents_.clear();
        for (const Index q : flat_.parents) parents_.push_back(coarse.parent(q));
        part_.assign(flat_.points.size(), 1.0), tries_.assign(flat_.points.size(), 0);
        has_changed_.assign(flat_.points.size(), 0);
        fine_names_ = names_of(flat_);
        for (Index v = 0; v < part_.size(); ++v) {
            const auto found = known.find(key_of(flat_.points[v]));
            if (found == known.end()) {
                has_changed_[v] = 1;
                if (is_on_short_crease(v)) part_[v] = 0.0;
                continue;
            }
            part_[v] = found->second.part, tries_[v] = found->second.tries;
            if (part_[v] > 0.0 && !(found->second.smooth == smooth_.points[v])) has_changed_[v] = 1;
        }
        treat_copies_alike();
    }
    bool is_on_short_crease(Index v) const {
        if (!short_creases_) return false;
        const double reach = 1e-3 * judge_.diagonal;
        return short_creases_->find_nearest(flat_.points[v]).squared_distance <= reach * reach;
    }
    /// Vertices in one place have to stay in one.
    void treat_copies_alike() {
        for (Index v = 0; v < fine_names_.size(); ++v) {
            const Index name = fine_names_[v];
            if (!(smooth_.points[v] == smooth_.points[name])) part_[name] = 0.0;
            part_[name] = std::min(part_[name], part_[v]);
        }
        for (Index v = 0; v < fine_names_.size(); ++v) {
            if (part_[v] == part_[fine_names_[v]]) continue;
            part_[v] = part_[fine_names_[v]];
            has_changed_[v] = 1;
        }
    }

    Point3 place_of(Index v) const {
        return part_[v] == 0.0 ? flat_.points[v] : flat_.points[v] + part_[v] * (smooth_.points[v] - flat_.points[v]);
    }
    bool has_changed(Index q) const {
        const auto ring = flat_.polygon(q);
        return std::any_of(ring.begin(), ring.end(), [&](Index v) { return has_changed_[v] != 0; });
    }

    /// Polygons of the round that are broken, of those that have changed and what is near them. Where all have,
    /// `result_` becomes the mesh, with quads cut where that helps.
    std::vector<Index> find_broken() {
        CoarseMesh trial = flat_.without_polygons();
        for (Index v = 0; v < part_.size(); ++v) trial.points[v] = place_of(v);
        std::vector<std::uint8_t> is_looked_at(flat_.polygon_count(), 0);
        for (Index q = 0; q < is_looked_at.size(); ++q) is_looked_at[q] = has_changed(q) ? 1 : 0;
        const bool is_all = std::find(is_looked_at.begin(), is_looked_at.end(), 0) == is_looked_at.end();
        if (!is_all) add_neighbours(trial.points, is_looked_at);
        for (Index q = 0; q < is_looked_at.size(); ++q)
            if (is_looked_at[q] != 0) trial.add_polygon(flat_.polygon(q), q);
        const Damage damage = find_damage(judge_, trial, control_);
        std::vector<Index> broken;
        for (const Index q : damage.polygons) broken.push_back(trial.parent(q));
        if (is_all) result_ = std::move(trial);
        return broken;
    }
    /// Polygons whose boxes meet those of the marked ones.
    void add_neighbours(const std::vector<Point3>& points, std::vector<std::uint8_t>& is_marked) const {
        std::vector<Triangle> triangles;
        std::vector<Index> polygon_of;
        for (Index q = 0; q < flat_.polygon_count(); ++q) {
            const auto ring = flat_.polygon(q);
            for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
                triangles.push_back({VertexId{ring[0]}, VertexId{ring[i]}, VertexId{ring[i + 1]}});
                polygon_of.push_back(q);
            }
        }
        const core::TriangleTree tree(points, triangles);
        std::vector<Index> found;
        for (Index q = 0; q < flat_.polygon_count(); ++q) {
            if (is_marked[q] == 0) continue;
            const auto ring = flat_.polygon(q);
            Point3 low = points[ring[0]], high = low;
            for (const Index v : ring) {
                const Point3& p = points[v];
                low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
                high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
            }
            tree.visit_box(low, high, [&](Index t) { found.push_back(polygon_of[t]); });
        }
        for (const Index q : found) is_marked[q] = 1;
    }

    /// Polygons of the round where creases are farther away than the distance of the surfaces, or will be after the
    /// rounds to come. The bound is asked only where that is near.
    std::vector<Index> find_missed_creases() {
        std::vector<Index> missed;
        if (input_ == nullptr) return missed;
        constexpr double all = std::numeric_limits<double>::infinity();
        const double farthest = add_missed_creases(*input_, judge_, result_, all, missed);
        double limit = 0.95 * error_;
        if (error_ == 0.0) {
            if (farthest <= reach_of(*input_, judge_, result_)) return missed;
            DistanceOptions options;
            options.samples = 10000;
            const SurfaceDistance found =
                measure_distance(as_polygons(), make_polygon_mesh(judge_.input), options, control_);
            limit = std::max({cover_ * found.hausdorff_bound, 0.999 * found.hausdorff, 0.9e-6 * judge_.diagonal});
        }
        if (farthest > limit) add_missed_creases(*input_, judge_, result_, limit, missed);
        is_apart_ = !missed.empty();
        is_far_off_ = farthest > 2.0 * limit;
        for (Index& q : missed) q = result_.parent(q);
        return missed;
    }

    /// Polygons of the round where the error is not kept.
    std::vector<Index> find_far() {
        std::vector<Index> far;
        if (error_ == 0.0) return far;
        constexpr std::uint64_t pieces = 400000;
        for (const FarPlace& place :
             find_far_places(as_polygons(), make_polygon_mesh(judge_.input), error_, pieces, control_))
            far.push_back(result_.parent(place.is_on_first ? place.polygon : place.nearest));
        is_apart_ = !far.empty();
        return far;
    }
    PolygonMesh as_polygons() const {
        PolygonMesh polygons{result_.points, {}, result_.offsets};
        for (const Index v : result_.corners) polygons.corners.push_back(VertexId{v});
        return polygons;
    }

    /// Holds the corners of these polygons and of those around back; what is held already is treated otherwise. False:
    /// all that there is has been done.
    bool react(const std::vector<Index>& broken, bool hurry) {
        if (broken.empty()) return false;
        std::vector<std::uint8_t> is_near(part_.size(), 0), is_moved(part_.size(), 0);
        for (const Index q : broken)
            for (const Index v : flat_.polygon(q)) is_near[v] = 1;
        for (Index v = 0; v < fine_names_.size(); ++v) is_near[fine_names_[v]] |= is_near[v];
        for (Index v = 0; v < fine_names_.size(); ++v) is_near[v] = is_near[fine_names_[v]];
        std::vector<std::uint8_t> can_move(part_.size(), 0);  // or one around can
        for (Index q = 0; q < flat_.polygon_count(); ++q) {
            const auto ring = flat_.polygon(q);
            if (std::none_of(ring.begin(), ring.end(), [&](Index v) { return is_near[v] != 0; })) continue;
            const bool moves = std::any_of(ring.begin(), ring.end(), [&](Index v) { return part_[v] > 0.0; });
            for (const Index v : ring) is_moved[v] = part_[v] > 0.0 ? 1 : 0, can_move[v] |= moves ? 1 : 0;
        }
        std::vector<Index> stuck;
        for (const Index q : broken) {
            const auto ring = flat_.polygon(q);
            if (hurry || std::none_of(ring.begin(), ring.end(), [&](Index v) { return can_move[v] != 0; }))
                stuck.push_back(parents_[q]);
        }
        bool reacts = false;
        for (Index v = 0; v < part_.size(); ++v) {
            if (is_moved[v] == 0) continue;
            part_[v] = ++tries_[v] < 4 && !is_far_off_ ? 0.5 * part_[v] : 0.0;
            has_changed_[v] = 1;
            reacts = true;
        }
        if (is_apart_) stuck.clear();  // a coarse polygon is where its pieces are
        const std::vector<Index> treated = treat(stuck, hurry);
        if (treated.empty()) {
            treat_copies_alike();
            return reacts;
        }
        std::vector<std::array<double, 3>> moved;
        for (Index v = 0; v < part_.size(); ++v)
            if (has_changed_[v] != 0) moved.push_back({flat_.points[v].x, flat_.points[v].y, flat_.points[v].z});
        std::sort(moved.begin(), moved.end());
        build();
        for (Index v = 0; v < part_.size(); ++v) {
            const std::array key{flat_.points[v].x, flat_.points[v].y, flat_.points[v].z};
            if (std::binary_search(moved.begin(), moved.end(), key)) has_changed_[v] = 1;
        }
        std::vector<std::uint8_t> is_treated(mesh_.polygon_count(), 0);
        for (const Index q : treated) is_treated[q] = 1;
        for (Index q = 0; q < flat_.polygon_count(); ++q)
            if (is_treated[parents_[q]] != 0)
                for (const Index v : flat_.polygon(q)) has_changed_[v] = 1;
        return true;
    }

    /// The next treatment for polygons that are broken where they lie flat; those that got one, and their neighbours.
    std::vector<Index> treat(std::vector<Index> stuck, bool hurry) {
        std::sort(stuck.begin(), stuck.end());
        stuck.erase(std::unique(stuck.begin(), stuck.end()), stuck.end());
        std::vector<Index> treated;
        const auto change = [&](Index q, Treatment t) {
            if (treatments_[q] == t) return;
            treatments_[q] = t;
            treated.push_back(q);
        };
        const std::vector<Treatment> before = treatments_;
        for (const Index q : stuck) {
            if (before[q] == Treatment::whole && mesh_.polygon(q).size() > 3 && !hurry) {
                change(q, Treatment::cut);
            } else {
                if (before[q] == Treatment::coarse || hurry)
                    for (const Index g : neighbours(q)) change(g, Treatment::coarse);
                change(q, Treatment::coarse);
            }
        }
        const std::size_t count = treated.size();
        for (std::size_t i = 0; i < count; ++i)
            for (const Index g : neighbours(treated[i])) treated.push_back(g);
        return treated;
    }
    std::vector<Index> neighbours(Index q) const {
        std::vector<Index> found;
        for (const Index v : mesh_.polygon(q))
            for (const Index g : around_[names_.empty() ? v : names_[v]]) found.push_back(g);
        return found;
    }

    const CoarseMesh& mesh_;
    const Judge& judge_;
    const WorkMesh* input_;
    double error_, cover_;
    const RunControl& control_;
    std::optional<core::TriangleTree> short_creases_;
    std::vector<Index> names_;                ///< of the mesh's vertices where copies are one, else empty
    std::vector<std::vector<Index>> around_;  ///< polygons at each vertex, by name
    std::vector<Treatment> treatments_;

    CoarseMesh smooth_, flat_;
    std::vector<Index> parents_;  ///< per polygon of these: of the mesh
    std::vector<Index> fine_names_;
    std::vector<double> part_;  ///< per vertex, of the way from flat to smooth
    std::vector<int> tries_;
    std::vector<std::uint8_t> has_changed_;  ///< per vertex, since it was looked at
    bool is_apart_ = false;                  ///< something is too far away: a crease, or all else
    bool is_far_off_ = false;                ///< so far that halfway back will not do
    CoarseMesh result_;
};

}  // namespace

void give_report(const SubdivisionReport& report, std::uint64_t rounds, RemeshStatistics& statistics) {
    statistics.subdivision_rounds = report.rounds;
    statistics.held_vertices = report.held;
    statistics.coarse_faces = report.coarse;
    if (report.rounds == rounds && report.coarse == 0) return;
    std::string note;
    if (report.rounds < rounds)
        note = std::to_string(report.rounds) + " rounds of subdivision, not " + std::to_string(rounds);
    if (report.rounds < rounds && report.coarse > 0) note += ", and ";
    if (report.coarse > 0)
        note += std::to_string(report.coarse) + (report.coarse == 1 ? " face is" : " faces are") +
                " not subdivided in every round: pieces would turn away, meet others or be too far, first near " +
                text_of(report.place);
    statistics.notes.push_back(note);
}

CoarseMesh subdivide_soundly(const CoarseMesh& mesh, const SubdivisionRule& rule, const Judge& judge,
                             SubdivisionReport& report, const RunControl& control) {
    report = {};
    CoarseMesh now = mesh;
    std::vector<std::uint8_t> stays(mesh.polygon_count(), 0), is_coarse = stays;
    std::vector<Index> origins(mesh.polygon_count());  // polygons of the mesh, per polygon now
    std::iota(origins.begin(), origins.end(), 0U);
    std::vector<std::uint8_t> is_held;
    for (; report.rounds < rule.rounds && !control.cancelled(); ++report.rounds) {
        // Later rounds lower the distance, and with it what is allowed of creases: if that leaves no way, they may
        // fail.
        constexpr double allowed = 0.94;
        const double share = std::pow(0.85, static_cast<double>(rule.rounds - report.rounds - 1));
        std::optional<Round> round(std::in_place, now, stays, judge, rule, share * allowed, control);
        std::optional<CoarseMesh> next = round->run();
        if (!next && share < 1.0 && !control.cancelled()) {
            round.emplace(now, stays, judge, rule, allowed, control);
            next = round->run();
        }
        for (Index q = 0; q < now.polygon_count(); ++q)
            if (round->stays(q)) is_coarse[origins[q]] = 1;
        if (!next) break;
        is_held.resize(next->points.size(), 0);
        for (Index v = 0; v < is_held.size(); ++v) is_held[v] |= round->is_held(v) ? 1 : 0;
        std::vector<Index> parents;
        std::vector<std::uint8_t> stay;
        for (std::size_t q = 0; q < next->polygon_count(); ++q) {
            const Index parent = round->parent(next->parent(q));
            stay.push_back(round->stays(parent) ? 1 : 0);
            parents.push_back(origins[parent]);
        }
        now = std::move(*next);
        now.parents = parents;
        origins = std::move(parents);
        stays = std::move(stay);
    }
    report.held = static_cast<std::size_t>(std::count(is_held.begin(), is_held.end(), 1));
    report.coarse = static_cast<std::size_t>(std::count(is_coarse.begin(), is_coarse.end(), 1));
    if (report.coarse > 0) {
        const auto first = std::find(is_coarse.begin(), is_coarse.end(), 1) - is_coarse.begin();
        report.place = mesh.points[mesh.polygon(static_cast<std::size_t>(first))[0]];
    }
    return now;
}

}  // namespace certa::remeshing
