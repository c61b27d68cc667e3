// `--estimator auto`: an estimator and a size from the noise that the data shows.
//
// Noise is the median, over a sample of vertices, of what a polynomial of degree 4 leaves over in three rings, in mean
// edge lengths: creases and corners are few and do not move a median. The numbers come from the experiments of
// docs/performance.md on the torus and the ellipsoid: without noise small jets are best by far, and soon useless with
// it; the corrected current under a smooth kernel takes noise of half an edge length, the more the wider it is.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "curvature/estimators.h"
#include "curvature/jet.h"

namespace certa::curvature {
namespace {

constexpr double clean = 0.002;  // residual over mean edge length
/// Radius of the kernel in mean edge lengths.
double kernel_radius(double noise) { return std::min(4.0 + 20.0 * noise, 8.0); }

std::string text_of(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.3g", value);
    return buffer;
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
    const double radius = kernel_radius(noise);
    chosen.estimator = Estimator::corrected, chosen.neighborhood = Neighborhood::ball, chosen.weight = Weight::kernel2;
    chosen.radius = {radius * surface.statistics.mean_edge_length / surface.diagonal, true};
    statistics.choice = found + "too much for small jets; the corrected normal current under kernel2 over balls of " +
                        text_of(radius) + " mean edge lengths averages it out";
    return chosen;
}

}  // namespace certa::curvature
