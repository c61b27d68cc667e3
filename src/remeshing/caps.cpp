// Where lines have to be closer together than curvature says (remesh, stages 8 and 9).
//
// Faces that are no disks, polygons that turn away or meet others: the surface does something there that lines have
// missed. They come closer by a constant factor each time, so that a few more networks find out how close.
#include "remeshing/caps.h"

#include <algorithm>
#include <cmath>

namespace certa::remeshing {
namespace {

void lower_to(double& cap, double other) {
    if (other > 0.0 && (cap == 0.0 || other < cap)) cap = other;
}

}  // namespace

void Caps::expect(double wanted) {
    least_error_ = 0.05 * mesh_.diagonal / wanted;
    double area = 0.0;
    for (Index f = 0; f < mesh_.face_count(); ++f) area += 0.5 * mesh_.local(f, 1).real() * mesh_.local(f, 2).imag();
    widest_ = 8.0 * std::sqrt(area / wanted);
}

std::vector<double> Caps::at(double error) const {
    std::vector<double> caps = caps_;
    caps.resize(mesh_.wedge_count(), 0.0);
    for (std::size_t w = 0; w < broken_caps_.size(); ++w) lower_to(caps[w], broken_caps_[w]);
    if (error < least_error_)
        for (double& cap : caps) lower_to(cap, widest_ * error / least_error_);
    return caps;
}

void Caps::loosen(double error) {
    if (last_error_ > 0.0 && error > last_error_)
        for (double& cap : broken_caps_) cap *= std::sqrt(error / last_error_);
    last_error_ = error;
}

void Caps::lower(Index wedge, double cap) {
    caps_.resize(mesh_.wedge_count(), 0.0);
    lower_to(caps_[wedge], cap);
}

void Caps::lower_families(Index wedge, double factor, const Spacing& spacing) {
    for (std::size_t family = 0; family < 2; ++family) {
        family_caps_[family].resize(mesh_.wedge_count(), 0.0);
        lower_to(family_caps_[family][wedge], factor * spacing.at[family][wedge]);
    }
}

void Caps::refine(const Flaws& flaws, const Graph& graph, const std::vector<std::vector<Index>>& faces,
                  const Spacing& spacing, bool all) {
    std::vector<bool> is_tied(mesh_.patch_count, true);
    for (const FlawPlace& place : flaws.places) {
        const bool is_rim = place.size > 0.0;
        if (is_rim || !all) lower_near(place, graph, spacing);
        if (is_rim) is_tied[place.patch] = false;
    }
    patch_caps_.resize(mesh_.patch_count, 0.0);
    std::vector<bool> flawed(mesh_.patch_count, false);
    std::vector<std::array<Point3, 2>> boxes(mesh_.patch_count,
                                             {Point3{1e300, 1e300, 1e300}, Point3{-1e300, -1e300, -1e300}});
    for (const Index p : flaws.patches) flawed[p] = is_tied[p];
    for (Index f = 0; f < mesh_.face_count(); ++f) {
        if (!flawed[mesh_.patches[f]]) continue;
        auto& [low, high] = boxes[mesh_.patches[f]];
        for (const Index v : mesh_.faces[f]) {
            const Point3& p = mesh_.points[v];
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    }
    for (const Index p : flaws.patches)
        if (flawed[p])
            patch_caps_[p] = patch_caps_[p] == 0.0 ? 0.4 * distance(boxes[p][0], boxes[p][1]) : 0.6 * patch_caps_[p];
    for (Index w = 0; w < mesh_.wedge_count(); ++w) {
        const Index p = mesh_.patches[mesh_.wedge_first[w] / 3];
        if (flawed[p]) lower(w, patch_caps_[p]);
    }
    if (all) lower_around(flaws.faces, graph, faces, spacing, 0.0, caps_);
}

/// So that a line passes what has no line, or one beside the node where a face meets itself.
void Caps::lower_near(const FlawPlace& place, const Graph& graph, const Spacing& spacing) {
    std::vector<std::uint8_t> is_near(mesh_.points.size(), 0);
    for (const Index n : place.nodes)
        for (const Index v : mesh_.faces[graph.nodes[n].place.face]) is_near[v] = 1;
    for (Index w = 0; w < mesh_.wedge_count(); ++w) {
        if (is_near[mesh_.wedge_vertices[w]] == 0 || mesh_.patches[mesh_.wedge_first[w] / 3] != place.patch) continue;
        const double cap = 0.6 * std::min(spacing.at[0][w], spacing.at[1][w]);
        lower(w, place.size > 0.0 ? std::min(cap, 0.7 * place.size) : cap);
    }
}

void Caps::refine_broken(const std::vector<Index>& broken, const Graph& graph,
                         const std::vector<std::vector<Index>>& faces, const Spacing& spacing) {
    before_ = broken_caps_;
    // Lines much closer than the input's vertices would follow its facets.
    lower_around(broken, graph, faces, spacing, 0.5 * mesh_.mean_edge, broken_caps_);
}

void Caps::lower_around(const std::vector<Index>& list, const Graph& graph,
                        const std::vector<std::vector<Index>>& faces, const Spacing& spacing, double least,
                        std::vector<double>& caps) const {
    caps.resize(mesh_.wedge_count(), 0.0);
    for (const Index face : list)
        for (const Index h : faces[face]) {
            const Index f = graph.nodes[graph.tail(h)].place.face;
            for (Index c = 3 * f; c < 3 * f + 3; ++c) {
                const Index w = mesh_.wedges[c];
                lower_to(caps[w], std::max(least, 0.6 * std::min(spacing.at[0][w], spacing.at[1][w])));
            }
        }
}

}  // namespace certa::remeshing
