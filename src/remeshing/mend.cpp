// Mending by regions of the graph's faces.
//
// Each round makes the whole result anew from the same polygons and a set of faces: connected faces are a region, which
// the input inside replaces, thinned out. Sides of the region are cut where they pass edges of the input; the polygons
// around take over those corners that are left. Then everything is judged. Broken polygons join the set; a broken patch
// is thinned out less, then not at all, then its region grows. The set only grows, so this ends: at the latest when
// whole components are the input.
#include "remeshing/mend.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/parallel.h"
#include "core/vector3.h"
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

/// Leaves out vertices without polygons, and feature edges that are no sides.
void tidy(CoarseMesh& mesh) {
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

class Mender {
public:
    Mender(const Layout& layout, const Judge& judge, const MendingRule& rule, CoarseMesh& mesh,
           const RunControl& control)
        : layout_(layout),
          mesh_(layout.network.mesh()),
          judge_(judge),
          rule_(rule),
          base_(mesh),
          out_(mesh),
          control_(control),
          is_fixed_(fixed_vertices(mesh_)),
          patcher_(layout) {
        level_.assign(patcher_.face_count(), none);
    }

    MendingReport run() {
        MendingReport report;
        for (;; ++report.rounds) {
            if (control_.cancelled()) break;
            assemble();
            if (!widen(report)) break;
            if (report.rounds % 8 == 7) control_.report("mending", 0.95);
        }
        report.regions = regions_.size();
        for (const Region& region : regions_) report.faces += region.faces.size(), report.triangles += region.triangles;
        tidy(result_);
        out_ = std::move(result_);
        return report;
    }

private:
    enum Level : std::uint8_t { none, first_try, second_try, exact };
    struct Region {
        std::vector<Index> faces;
        std::uint8_t level = first_try;
        bool is_whole = false;
        std::size_t triangles = 0;
    };

    /// Connected faces of the set, each with a patch: regions without one grow until they have.
    void find_regions() {
        for (bool again = true; again;) {
            again = false;
            regions_.clear();
            region_of_.assign(level_.size(), no_index);
            for (Index seed = 0; seed < level_.size(); ++seed) {
                if (level_[seed] == none || region_of_[seed] != no_index) continue;
                Region region;
                region.faces.assign(1, seed);
                const auto number = static_cast<Index>(regions_.size());
                region_of_[seed] = number;
                for (std::size_t at = 0; at < region.faces.size(); ++at) {
                    const Index f = region.faces[at];
                    region.level = std::max(region.level, level_[f]);
                    for (const Index h : layout_.faces[f])
                        if (const Index g = patcher_.face_beside(h ^ 1U);
                            g != no_index && level_[g] != none && region_of_[g] == no_index) {
                            region_of_[g] = number;
                            region.faces.push_back(g);
                        }
                }
                std::sort(region.faces.begin(), region.faces.end());
                region.is_whole = patcher_.is_whole(region.faces);
                regions_.push_back(std::move(region));
            }
            for (Region& region : regions_) {
                if (find_patch(region) != nullptr) continue;
                again = true;
                for (const Index f : patcher_.grow(region.faces))
                    level_[f] = std::max<std::uint8_t>(level_[f], first_try);
            }
        }
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
        const auto key = std::pair{region.faces, region.level};
        auto found = patches_.find(key);
        if (found == patches_.end()) {
            std::optional<RegionPatch> patch = patcher_.make(region.faces);
            if (patch) thin(*patch, region.level);
            found = patches_.emplace(key, std::move(patch)).first;
        }
        return found->second ? &*found->second : nullptr;
    }
    void thin(RegionPatch& patch, std::uint8_t level) const {
        constexpr std::array<double, 4> parts{0.0, 1.0, 0.3, 1e-4}, shares{0.0, 0.1, 0.03, 0.0};
        ThinningRule rule;
        rule.tolerance = parts[level] * rule_.tolerance;
        rule.side_tolerance = parts[level] * rule_.side_tolerance;
        rule.side_share = shares[level];
        rule.is_fixed.assign(patch.outer.size() + patch.inner.size(), 1);
        for (std::size_t i = 0; i < patch.inner.size(); ++i) {
            const RegionVertex& v = patch.inner[i];
            rule.is_fixed[patch.outer.size() + i] =
                v.kind == VertexKind::corner || v.on_minor_edge || (v.source != no_index && is_fixed_[v.source] != 0)
                    ? 1
                    : 0;
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
            for (const Index v : patch.outer) result_.points[v] = node_point(v);
            for (const RegionVertex& v : patch.inner)
                numbers.push_back(result_.add_vertex(v.point, v.place, v.kind, v.curve));
            for (const auto& t : patch.triangles)
                result_.add_polygon(std::array{numbers[t[0]], numbers[t[1]], numbers[t[2]]}, region.faces.front());
            for (const FeatureEdge& e : patch.feature_edges)
                result_.feature_edges.push_back({numbers[e.a], numbers[e.b], e.curve});
            for (const RegionSide& side : patch.sides) {
                if (side.corners.size() < 3) continue;
                auto& list = between[{numbers[side.corners.back()], numbers[side.corners.front()]}];
                for (std::size_t i = side.corners.size() - 2; i > 0; --i) list.push_back(numbers[side.corners[i]]);
                for (std::size_t i = 1; i < side.corners.size() && side.curve != no_index; ++i)
                    result_.feature_edges.push_back(
                        {numbers[side.corners[i - 1]], numbers[side.corners[i]], side.curve});
            }
            region.triangles = patch.triangles.size();
        }
        add_polygons_around(between);
    }
    /// The polygons of no region, with the corners that regions have left on their sides.
    void add_polygons_around(const std::map<std::array<Index, 2>, std::vector<Index>>& between) {
        CoarseMesh changed = result_.without_polygons();
        std::vector<Index> ring;
        for (std::size_t q = 0; q < base_.polygon_count(); ++q) {
            const Index parent = base_.parent(q);
            if (parent != no_index && level_[parent] != none) continue;
            const auto old = base_.polygon(q);
            ring.clear();
            for (std::size_t i = 0; i < old.size(); ++i) {
                ring.push_back(old[i]);
                const auto found = between.find({old[i], old[(i + 1) % old.size()]});
                if (found != between.end()) ring.insert(ring.end(), found->second.begin(), found->second.end());
            }
            (ring.size() == old.size() ? result_ : changed).add_polygon(ring, parent);
        }
        // Corners without a turn leave too much to a reader who fills polygons: these are cut here.
        changed = rule_.all_triangles ? make_triangles(changed, judge_.tree) : make_quad_dominant(changed);
        for (std::size_t q = 0; q < changed.polygon_count(); ++q)
            result_.add_polygon(changed.polygon(q), changed.parent(q));
    }

    /// Sides that two polygons walk in the same direction: a cut has repeated one.
    void add_repeated_sides(std::vector<Index>& broken) const {
        std::vector<std::array<Index, 3>> sides;
        for (Index q = 0; q < result_.polygon_count(); ++q) {
            const auto ring = result_.polygon(q);
            for (std::size_t i = 0; i < ring.size(); ++i) sides.push_back({ring[i], ring[(i + 1) % ring.size()], q});
        }
        std::sort(sides.begin(), sides.end());
        for (std::size_t i = 1; i < sides.size(); ++i)
            if (sides[i][0] == sides[i - 1][0] && sides[i][1] == sides[i - 1][1])
                broken.push_back(sides[i][2]), broken.push_back(sides[i - 1][2]);
    }

    /// Takes what is broken into the set. False: nothing is, or nothing can be done about it.
    bool widen(MendingReport& report) {
        const Damage damage = find_damage(judge_, result_, control_);
        report.split_quads = damage.split;
        std::vector<Index> broken = damage.polygons;
        if (!regions_.empty()) add_repeated_sides(broken);
        add_missed_creases(broken);
        if (broken.empty() && !regions_.empty()) {
            // What is allowed has shrunk with what has become exact.
            is_strict_ = true;
            reach_ = 0.0;
            add_missed_creases(broken);
        }
        if (rule_.error > 0.0) add_far(broken);
        std::sort(broken.begin(), broken.end());
        broken.erase(std::unique(broken.begin(), broken.end()), broken.end());
        bool has_changed = false;
        report.left.clear();
        std::map<Index, std::vector<Index>> broken_patches;
        for (const Index q : broken) {
            const Index f = result_.parent(q);
            report.left.push_back(result_.points[result_.polygon(q)[0]]);
            if (f == no_index) continue;
            if (level_[f] == none) {
                level_[f] = first_try;
                has_changed = true;
            } else if (region_of_[f] != no_index) {  // not one that has just joined
                broken_patches[region_of_[f]].push_back(q);
            }
        }
        for (const auto& [r, polygons] : broken_patches) {
            const Region& region = regions_[r];
            if (region.is_whole) continue;
            has_changed = true;
            if (region.level < exact) {
                for (const Index g : region.faces) level_[g] = region.level + 1;
                continue;
            }
            // Larger, it may do at the first try again.
            for (const Index g : region.faces) level_[g] = first_try;
            for (const Index g : faces_around(region, polygons, 1 + report.rounds / 10))
                level_[g] = std::max<std::uint8_t>(level_[g], first_try);
        }
        return has_changed;
    }

    /// The region and what touches its border where polygons of its patch are broken; all around, if they do not touch
    /// it.
    std::vector<Index> faces_around(const Region& region, const std::vector<Index>& polygons, std::size_t rings) const {
        std::vector<Index> grown = region.faces;
        for (const Index q : polygons)
            for (const Index v : result_.polygon(q))
                if (v < layout_.nodes.size()) {
                    const auto& around = patcher_.faces_at(layout_.nodes[v]);
                    grown.insert(grown.end(), around.begin(), around.end());
                }
        std::sort(grown.begin(), grown.end());
        grown.erase(std::unique(grown.begin(), grown.end()), grown.end());
        if (grown.size() == region.faces.size() || rings > 1) grown = patcher_.grow(grown);
        return grown;
    }

    /// Creases and minor corners that nothing of the result is near: the polygons below them.
    void add_missed_creases(std::vector<Index>& broken) {
        if (mesh_.minor_edges.empty() && mesh_.minor_corners.empty() && mesh_.curves.empty()) return;
        std::vector<Triangle> edges, vertices, filled;
        const auto id = [](Index v) { return VertexId{v}; };
        std::vector<Index> polygon_of;
        const CoarseMesh triangles = make_triangles(result_, judge_.tree);
        for (std::size_t q = 0; q < result_.polygon_count(); ++q) {
            const auto ring = result_.polygon(q);
            polygon_of.insert(polygon_of.end(), ring.size() - 2, static_cast<Index>(q));
            for (std::size_t i = 0; i < ring.size(); ++i) {
                edges.push_back({id(ring[i]), id(ring[(i + 1) % ring.size()]), id(ring[(i + 1) % ring.size()])});
                vertices.push_back({id(ring[i]), id(ring[i]), id(ring[i])});
            }
        }
        for (std::size_t q = 0; q < triangles.polygon_count(); ++q) {
            const auto t = triangles.polygon(q);
            filled.push_back({id(t[0]), id(t[1]), id(t[2])});
        }
        const core::TriangleTree edge_tree(result_.points, edges), vertex_tree(result_.points, vertices),
            surface(result_.points, filled);
        // What was near enough at first stays near enough, or each region that becomes exact would condemn the next
        // one.
        if (reach_ == 0.0)
            reach_ = rule_.reach > 0.0 ? rule_.reach
                                       : std::max(largest_distance(surface, triangles), 1e-6 * judge_.diagonal);
        // Samples find less than the bound that the check goes by: at first a quarter is left for that.
        const double square = (rule_.reach > 0.0 || is_strict_ ? 0.8 : 1.5625) * reach_ * reach_;
        const auto demand = [&](const core::TriangleTree& tree, const Point3& p) {
            if (tree.find_nearest(p).squared_distance > square)
                broken.push_back(polygon_of[surface.find_nearest(p).triangle]);
        };
        for (const Index v : mesh_.minor_corners) demand(vertex_tree, mesh_.points[v]);
        for (const Index e : mesh_.minor_edges)
            for (double s = 0.0; s <= 1.0; s += 0.125) demand(edge_tree, mesh_.point_on(e, s));
        for (Index e = 0; e < mesh_.edge_curves.size(); ++e)
            if (mesh_.edge_curves[e] != no_index)
                for (double s = 0.0; s <= 1.0; s += 0.125) demand(edge_tree, mesh_.point_on(e, s));
    }
    /// Of the input's vertices from the result, and of its triangles' middles, sides and corners from the input.
    double largest_distance(const core::TriangleTree& surface, const CoarseMesh& triangles) const {
        double square = 0.0;
        for (const Point3& p : mesh_.points) square = std::max(square, surface.find_nearest(p).squared_distance);
        for (std::size_t q = 0; q < triangles.polygon_count(); ++q) {
            const auto t = triangles.polygon(q);
            const Point3 &a = triangles.points[t[0]], &b = triangles.points[t[1]], &c = triangles.points[t[2]];
            for (const Point3& p : {(1.0 / 3.0) * (a + b + c), 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), a, b, c})
                square = std::max(square, judge_.tree.find_nearest(p).squared_distance);
        }
        return std::sqrt(square);
    }

    /// Polygons farther from the input than the error, and those below vertices of the input that are.
    void add_far(std::vector<Index>& broken) const {
        const double square = 0.95 * 0.95 * rule_.error * rule_.error;
        const CoarseMesh triangles = make_triangles(result_, judge_.tree);
        std::vector<Triangle> filled;
        std::vector<Index> polygon_of;
        for (std::size_t q = 0; q < result_.polygon_count(); ++q)
            polygon_of.insert(polygon_of.end(), result_.polygon(q).size() - 2, static_cast<Index>(q));
        std::vector<std::uint8_t> is_far(triangles.polygon_count(), 0);
        core::parallel_for(is_far.size(), 64, control_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const auto t = triangles.polygon(i);
                const Point3 &a = result_.points[t[0]], &b = result_.points[t[1]], &c = result_.points[t[2]];
                for (int u = 0; u <= 4; ++u)
                    for (int v = 0; u + v <= 4; ++v) {
                        const Point3 p = (0.25 * u) * a + (0.25 * v) * b + (0.25 * (4 - u - v)) * c;
                        if (judge_.tree.find_nearest(p).squared_distance > square) is_far[i] = 1;
                    }
            }
        });
        for (std::size_t i = 0; i < is_far.size(); ++i) {
            const auto t = triangles.polygon(i);
            filled.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
            if (is_far[i] != 0) broken.push_back(polygon_of[i]);
        }
        const core::TriangleTree surface(result_.points, filled);
        std::vector<Index> below(mesh_.points.size(), no_index);
        core::parallel_for(below.size(), 256, control_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                const core::NearestPoint nearest = surface.find_nearest(mesh_.points[v]);
                if (nearest.squared_distance > square) below[v] = polygon_of[nearest.triangle];
            }
        });
        for (const Index q : below)
            if (q != no_index) broken.push_back(q);
    }

    const Layout& layout_;
    const WorkMesh& mesh_;
    const Judge& judge_;
    const MendingRule& rule_;
    bool is_strict_ = false;
    double reach_ = 0.0;  // how far a crease may be from the nearest edge; 0: not known yet
    const CoarseMesh base_;
    CoarseMesh& out_;
    const RunControl& control_;
    const std::vector<std::uint8_t> is_fixed_;
    RegionPatcher patcher_;

    std::vector<std::uint8_t> level_;  ///< per face of the graph
    std::vector<Region> regions_;
    std::vector<Index> region_of_;  ///< per face
    std::map<std::pair<std::vector<Index>, std::uint8_t>, std::optional<RegionPatch>> patches_;
    CoarseMesh result_;
};

}  // namespace

MendingReport mend(const Layout& layout, const Judge& judge, const MendingRule& rule, CoarseMesh& mesh,
                   const RunControl& control) {
    return Mender(layout, judge, rule, mesh, control).run();
}

CoarseMesh thin_input(const WorkMesh& mesh, const Judge& judge, double tolerance, std::size_t vertices,
                      const RunControl& control) {
    RegionPatch patch = take_all(mesh);
    std::vector<Point3> points;
    for (const RegionVertex& v : patch.inner) points.push_back(v.point);
    ThinningRule rule;
    rule.tolerance = tolerance;
    rule.least_vertices = vertices;
    const std::vector<std::uint8_t> is_fixed = fixed_vertices(mesh);
    for (const RegionVertex& v : patch.inner) rule.is_fixed.push_back(v.source == no_index ? 0 : is_fixed[v.source]);
    thin_out(patch, points, judge, rule, control);
    CoarseMesh out;
    for (const RegionVertex& v : patch.inner) out.add_vertex(v.point, v.place, v.kind, v.curve);
    for (const auto& t : patch.triangles) out.add_polygon(t);
    out.feature_edges = patch.feature_edges;
    return out;
}

}  // namespace certa::remeshing
