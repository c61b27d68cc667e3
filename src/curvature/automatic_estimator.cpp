// `--estimator auto`: an estimator and a size from the noise that the data shows.
//
// Noise is the median, over a sample of vertices, of what a polynomial of degree 4 leaves over in three rings, in mean
// edge lengths: creases and corners are few and do not move a median. The thresholds come from the torus experiments of
// docs/performance.md: without noise small jets are best by far, and useless with it; kernels take moderate noise; wide
// jets take more.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "curvature/estimators.h"
#include "curvature/jet.h"

namespace certa::curvature {
namespace {

constexpr double clean = 0.01, moderate = 0.03, strong = 0.065;  // residual over mean edge length

std::string text_of(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.3g", value);
    return buffer;
}

/// The largest number of rings over which polynomials of degree 4 leave hardly more than noise; 3 if none does.
std::uint64_t widest_window(const Surface& surface, const Cells& cells, double noise) {
    constexpr double tolerance = 1.18;
    std::uint64_t rings = 3;
    while (rings < 9 && estimate_noise(surface, cells, rings + 1) <= tolerance * noise) ++rings;
    return rings;
}

}  // namespace

double estimate_noise(const Surface& surface, const Cells& cells, std::uint64_t rings) {
    constexpr std::size_t sample = 400;
    RingWalker walker(surface, cells);
    JetFitter fitter(surface);
    std::vector<double> residuals;
    const std::size_t stride = std::max<std::size_t>(1, surface.used_vertices / sample);
    for (std::size_t v = 0; v < surface.used_vertices; v += stride) {
        if (surface.flags[v] & (vertex_flags::border | vertex_flags::non_manifold)) continue;
        const std::span<const Index> points = walker.collect(static_cast<Index>(v), rings);
        const JetFit fit = fitter.fit(static_cast<Index>(v), points, 4, false);
        if (fit.ok && fit.points >= 18) residuals.push_back(fit.residual);
    }
    if (residuals.empty() || !(surface.statistics.mean_edge_length > 0.0)) return 0.0;
    const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
    std::nth_element(residuals.begin(), middle, residuals.end());
    return *middle / surface.statistics.mean_edge_length;
}

CurvatureOptions choose_estimator(const Surface& surface, const Cells& cells, const CurvatureOptions& options,
                                  CurvatureStatistics& statistics) {
    CurvatureOptions chosen = options;
    const double noise = estimate_noise(surface, cells, 3);
    statistics.noise = noise;
    const std::string found = "noise is " + text_of(noise) + " mean edge lengths: ";
    if (noise < clean) {
        chosen.estimator = Estimator::jet, chosen.jet_degree = 4, chosen.rings = 2;
        statistics.choice = found + "below " + text_of(clean) + " jets of degree 4 over 2 rings are the most accurate";
        return chosen;
    }
    const std::uint64_t rings = noise < moderate ? 3 : widest_window(surface, cells, noise);
    if (rings >= (noise < strong ? 5U : 4U)) {
        chosen.estimator = Estimator::jet, chosen.jet_degree = 4, chosen.rings = rings;
        statistics.choice = found + "jets of degree 4 over " + std::to_string(rings) +
                            " rings, the widest window that they fit, average most";
    } else {
        chosen.estimator = Estimator::normal_cycle, chosen.neighborhood = Neighborhood::ball;
        chosen.weight = Weight::kernel2;
        chosen.radius = {6.0 * surface.statistics.mean_edge_length / surface.diagonal, true};
        statistics.choice = found + (noise < moderate ? "little" : "too much for the windows that jets fit") +
                            "; the normal cycle under kernel2 over balls of 6 mean edge lengths is the most accurate";
    }
    return chosen;
}

}  // namespace certa::curvature
