// Between the smooth surface and the coarse polygons (stage 10 of remesh).
//
// Plan: the same rounds without averaging give every vertex a place on its coarse polygon, where nothing is broken that
// was not broken before. Damage is looked for by the code that mending uses; vertices of what is broken, and those
// around, go half of the way back, after some rounds all of it.
#include "remeshing/sound_subdivision.h"

#include <algorithm>

#include "core/vector3.h"
#include "remeshing/subdivision.h"

namespace certa::remeshing {

CoarseMesh subdivide_soundly(const CoarseMesh& mesh, std::uint64_t rounds, const Judge& judge,
                             SubdivisionReport& report, const RunControl& control) {
    report = {};
    CoarseMesh smooth = mesh, flat = mesh;
    for (std::uint64_t round = 0; round < rounds; ++round) {
        smooth = subdivide(smooth);
        flat = subdivide(flat, false);
    }
    if (rounds == 0) return smooth;
    constexpr int most_rounds = 12;
    std::vector<double> part(smooth.points.size(), 1.0);
    CoarseMesh trial;
    for (int round = 0; round < most_rounds; ++round) {
        trial = smooth;
        for (std::size_t v = 0; v < part.size(); ++v)
            trial.points[v] = flat.points[v] + part[v] * (smooth.points[v] - flat.points[v]);
        const Damage damage = find_damage(judge, trial, control);  // cuts quads in two where that helps
        report.broken = damage.polygons.size();
        if (damage.polygons.empty() || control.cancelled()) break;
        std::vector<bool> near(part.size(), false);
        for (const Index q : damage.polygons)
            for (const Index v : trial.polygon(q)) near[v] = true;
        std::vector<bool> held = near;
        for (std::size_t q = 0; q < smooth.polygon_count(); ++q) {
            const auto ring = smooth.polygon(q);
            if (std::any_of(ring.begin(), ring.end(), [&](Index v) { return near[v]; }))
                for (const Index v : ring) held[v] = true;
        }
        bool moves = false;
        for (std::size_t v = 0; v < part.size(); ++v) {
            if (!held[v] || part[v] == 0.0) continue;
            part[v] = round < 4 ? 0.5 * part[v] : 0.0;
            moves = true;
        }
        if (!moves) break;
    }
    report.held = static_cast<std::size_t>(std::count_if(part.begin(), part.end(), [](double p) { return p < 1.0; }));
    return trial;
}

}  // namespace certa::remeshing
