// Between the smooth surface and the coarse polygons (stage 10 of remesh).
//
// Plan: the same rounds without averaging give every vertex a place on its coarse polygon, where nothing is broken that
// was not broken before. Damage is looked for by the code that mending uses; vertices of what is broken, and those
// around, go half of the way back, after some rounds all of it. A coarse quad that is broken even then is cut into its
// two triangles, on which the places lie exactly, and all begins anew. Where that does not help, because a piece of a
// polygon may turn away from the input right below it though the whole does not, there are fewer rounds.
#include "remeshing/sound_subdivision.h"

#include <algorithm>

#include "core/vector3.h"
#include "remeshing/subdivision.h"
#include "remeshing/triangulate.h"

namespace certa::remeshing {
namespace {

class Subdivider {
public:
    Subdivider(const CoarseMesh& coarse, std::uint64_t rounds, const Judge& judge, const WorkMesh* creases,
               const RunControl& control)
        : judge_(judge), control_(control), smooth_(coarse), flat_(coarse) {
        std::vector<Index> parents;
        for (Index q = 0; q < coarse.polygon_count(); ++q) {
            std::size_t pieces = coarse.polygon(q).size() == 3 ? 4 : coarse.polygon(q).size();
            for (std::uint64_t round = 1; round < rounds; ++round) pieces *= 4;
            parents.insert(parents.end(), pieces, q);
        }
        for (std::uint64_t round = 0; round < rounds; ++round) {
            smooth_ = subdivide(smooth_);
            flat_ = subdivide(flat_, false);
        }
        smooth_.parents = std::move(parents);
        part_.assign(smooth_.points.size(), 1.0);
        if (creases != nullptr) hold_short_creases(*creases);
    }

    /// As smooth as can be. `broken` receives the coarse polygons of what is broken all the same.
    CoarseMesh run(std::vector<Index>& broken) {
        constexpr int most_rounds = 12;
        CoarseMesh trial;
        for (int round = 0; round < most_rounds; ++round) {
            trial = smooth_;
            for (std::size_t v = 0; v < part_.size(); ++v)
                trial.points[v] = flat_.points[v] + part_[v] * (smooth_.points[v] - flat_.points[v]);
            const Damage damage = find_damage(judge_, trial, control_);  // cuts quads in two where that helps
            broken.clear();
            for (const Index q : damage.polygons) broken.push_back(trial.parent(q));
            std::sort(broken.begin(), broken.end());
            broken.erase(std::unique(broken.begin(), broken.end()), broken.end());
            if (broken.empty() || control_.cancelled() || !hold(trial, damage.polygons, round < 4)) break;
        }
        return trial;
    }
    std::size_t held() const {
        return static_cast<std::size_t>(std::count_if(part_.begin(), part_.end(), [](double p) { return p < 1.0; }));
    }

private:
    /// Creases too short to be curves, and their corners, are no features of the mesh: they would be smoothed away.
    void hold_short_creases(const WorkMesh& mesh) {
        std::vector<Triangle> segments;
        for (const Index e : mesh.minor_edges) {
            const Index h = mesh.edge_halfedges[e];
            segments.push_back({VertexId{mesh.start_of(h)}, VertexId{mesh.end_of(h)}, VertexId{mesh.end_of(h)}});
        }
        for (const Index v : mesh.minor_corners) segments.push_back({VertexId{v}, VertexId{v}, VertexId{v}});
        if (segments.empty()) return;
        const core::TriangleTree tree(mesh.points, segments);
        const double reach = 1e-3 * mesh.diagonal;
        for (std::size_t v = 0; v < part_.size(); ++v)
            if (tree.find_nearest(flat_.points[v]).squared_distance <= reach * reach) part_[v] = 0.0;
    }
    /// The corners of these polygons and of those around go back. False: they all are already.
    bool hold(const CoarseMesh& trial, const std::vector<Index>& polygons, bool halfway) {
        std::vector<bool> near(part_.size(), false);
        for (const Index q : polygons)
            for (const Index v : trial.polygon(q)) near[v] = true;
        std::vector<bool> held = near;
        for (std::size_t q = 0; q < smooth_.polygon_count(); ++q) {
            const auto ring = smooth_.polygon(q);
            if (std::any_of(ring.begin(), ring.end(), [&](Index v) { return near[v]; }))
                for (const Index v : ring) held[v] = true;
        }
        bool moves = false;
        for (std::size_t v = 0; v < part_.size(); ++v) {
            if (!held[v] || part_[v] == 0.0) continue;
            part_[v] = halfway ? 0.5 * part_[v] : 0.0;
            moves = true;
        }
        return moves;
    }

    const Judge& judge_;
    const RunControl& control_;
    CoarseMesh smooth_, flat_;
    std::vector<double> part_;  ///< per vertex, of the way from flat to smooth
};

/// The mesh with these polygons (sorted) as triangles; whether anything has changed.
bool cut_polygons(CoarseMesh& mesh, const std::vector<Index>& polygons, const Judge& judge) {
    CoarseMesh cut = mesh.without_polygons();
    std::vector<std::array<Index, 3>> triangles;
    for (Index q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        if (ring.size() == 3 || !std::binary_search(polygons.begin(), polygons.end(), q)) {
            cut.add_polygon(ring, mesh.parent(q));
            continue;
        }
        triangles.clear();
        triangulate_polygon(mesh.points, ring, judge.tree, triangles);
        for (const auto& t : triangles) cut.add_polygon(t, mesh.parent(q));
    }
    const bool has_changed = cut.polygon_count() > mesh.polygon_count();
    mesh = std::move(cut);
    return has_changed;
}

}  // namespace

CoarseMesh subdivide_soundly(const CoarseMesh& mesh, std::uint64_t rounds, const Judge& judge,
                             SubdivisionReport& report, const RunControl& control, const WorkMesh* creases) {
    constexpr int most_cuts = 1;
    report = {};
    for (report.rounds = rounds; report.rounds > 0; --report.rounds) {
        CoarseMesh coarse = mesh;
        for (int cuts = 0; cuts <= most_cuts; ++cuts) {
            Subdivider subdivider(coarse, report.rounds, judge, creases, control);
            std::vector<Index> broken;
            CoarseMesh result = subdivider.run(broken);
            report.held = subdivider.held();
            if (broken.empty() || control.cancelled()) return result;
            if (report.rounds == rounds) report.place = mesh.points[coarse.polygon(broken.front())[0]];
            if (!cut_polygons(coarse, broken, judge)) break;
        }
    }
    report.held = 0;
    return mesh;
}

}  // namespace certa::remeshing
