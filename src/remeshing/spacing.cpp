// Spacing of lines (thesis 4.2.1).
//
// Lines along the direction of k_max lie d(k_min) apart and the other way round (equation 4.6), with the isotropy rho
// mixed in as in the thesis. Curvature at a point says nothing about a whole gap where it passes through zero: spacing
// may grow only so fast away from where it is small, which rounds over the wedges' edges see to.
#include "remeshing/spacing.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace certa::remeshing {
namespace {

/// Wedges that share an edge, and how long it is.
class Neighbours {
public:
    explicit Neighbours(const WorkMesh& mesh) : first_(mesh.wedge_count() + 1, 0) {
        const auto for_sides = [&](const auto& visit) {
            for (Index h = 0; h < mesh.edges.size(); ++h) {
                const Index a = mesh.wedges[h], b = mesh.wedges[next_of(h)], o = mesh.opposites[h];
                // The other side of an edge has the same, unless a crease parts them.
                if (o < h && o != no_index && mesh.wedges[o] == b && mesh.wedges[next_of(o)] == a) continue;
                visit(a, b, mesh.edges[h]);
                visit(b, a, mesh.edges[h]);
            }
        };
        for_sides([&](Index a, Index, Index) { ++first_[a + 1]; });
        for (std::size_t w = 1; w < first_.size(); ++w) first_[w] += first_[w - 1];
        others_.resize(first_.back());
        std::vector<std::size_t> at(first_.begin(), first_.end() - 1);
        for_sides([&](Index a, Index b, Index e) { others_[at[a]++] = {b, mesh.lengths[e]}; });
    }
    struct Other {
        Index wedge = no_index;
        double distance = 0.0;
    };
    std::span<const Other> of(Index w) const {
        return std::span(others_).subspan(first_[w], first_[w + 1] - first_[w]);
    }

private:
    std::vector<std::size_t> first_;
    std::vector<Other> others_;
};

/// In rounds: what has become less limits its neighbours in the next. Neighbours are near in `size`, so there are few.
void limit_growth(const Neighbours& neighbours, std::vector<double>& size, double growth) {
    std::vector<Index> now(size.size()), next;
    std::vector<std::uint8_t> is_next(size.size(), 0);
    std::iota(now.begin(), now.end(), Index{0});
    for (; !now.empty(); std::swap(now, next), next.clear())
        for (const Index w : now) {
            is_next[w] = 0;
            for (const auto& [other, away] : neighbours.of(w)) {
                const double reached = size[w] + growth * away;
                if (!(reached < size[other])) continue;
                size[other] = reached;
                if (is_next[other] == 0) is_next[other] = 1, next.push_back(other);
            }
        }
}

std::vector<double> component_diagonals(const WorkMesh& mesh) {
    std::vector<Point3> low(mesh.component_count, {1e300, 1e300, 1e300}),
        high(mesh.component_count, {-1e300, -1e300, -1e300});
    for (Index f = 0; f < mesh.face_count(); ++f) {
        Point3 &l = low[mesh.components[f]], &h = high[mesh.components[f]];
        for (const Index v : mesh.faces[f]) {
            const Point3& p = mesh.points[v];
            l = {std::min(l.x, p.x), std::min(l.y, p.y), std::min(l.z, p.z)};
            h = {std::max(h.x, p.x), std::max(h.y, p.y), std::max(h.z, p.z)};
        }
    }
    std::vector<double> diagonals(mesh.component_count);
    for (Index c = 0; c < mesh.component_count; ++c) diagonals[c] = distance(low[c], high[c]);
    return diagonals;
}

/// What spacing is multiplied by so that areas a become a^(1 - evening), the number of cells staying as it is.
std::vector<double> find_evening(const WorkMesh& mesh, const Neighbours& neighbours,
                                 std::array<std::vector<double>, 2> at, const SpacingRule& rule) {
    for (auto& size : at) limit_growth(neighbours, size, rule.growth);
    double before = 0.0, after = 0.0;
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const double area = mesh.local(f, 1).real() * mesh.local(f, 2).imag();
        for (Index i = 0; i < 3; ++i) {
            const Index w = mesh.wedges[3 * f + i];
            const double cells = area / (at[0][w] * at[1][w]);
            before += cells;
            after += cells * std::pow(at[0][w] * at[1][w], rule.evening);
        }
    }
    std::vector<double> factors(mesh.wedge_count());
    for (Index w = 0; w < factors.size(); ++w)
        factors[w] = std::sqrt(after / before * std::pow(at[0][w] * at[1][w], -rule.evening));
    return factors;
}

}  // namespace

double chord_of(double curvature, double largest, const SpacingRule& rule) {
    const double k = std::abs(curvature);
    const double floor = 0.5 * rule.error;
    if (!(k > 0.0)) return largest;
    double chord = 0.0;
    if (rule.transfer == 0.5) {
        chord = k * rule.error >= 1.0 ? 2.0 / k : 2.0 * std::sqrt(rule.error * (2.0 / k - rule.error));
    } else {
        // Density |k|^P, such that curvature 1 / diagonal keeps its spacing.
        const double unit = 1.0 / largest;
        chord = std::sqrt(8.0 * rule.error / unit) * std::pow(k / unit, -rule.transfer);
    }
    return std::clamp(chord, floor, largest);
}

Spacing compute_spacing(const WorkMesh& mesh, const DirectionField& field, const SpacingRule& rule,
                        const std::vector<double>& caps) {
    Spacing spacing;
    const double half = 0.5 * rule.isotropy;
    const std::vector<double> diagonals = component_diagonals(mesh);
    for (auto& at : spacing.at) at.resize(mesh.wedge_count());
    for (Index w = 0; w < mesh.wedge_count(); ++w) {
        const double largest = rule.largest * diagonals[mesh.components[mesh.wedge_first[w] / 3]];
        const double low = std::abs(field.k_min[w]), high = std::abs(field.k_max[w]);
        const double wider = field.k_min[w] * field.k_max[w] < 0.0 ? rule.hyperbolic : 1.0;
        const double across_max = chord_of(half * high + (1.0 - half) * low, largest, rule);
        const double across_min = chord_of(half * low + (1.0 - half) * high, largest, rule);
        spacing.at[along_max][w] = rule.balance * std::min(largest, wider * across_max);
        spacing.at[along_min][w] = std::min(largest, wider * across_min) / rule.balance;
    }
    spacing.curved.resize(mesh.wedge_count());
    for (Index w = 0; w < mesh.wedge_count(); ++w) {
        const double largest = rule.largest * diagonals[mesh.components[mesh.wedge_first[w] / 3]];
        spacing.curved[w] = std::max(spacing.at[0][w], spacing.at[1][w]) < 0.999 * largest;
    }
    const Neighbours neighbours(mesh);
    std::vector<double> evening;
    if (rule.evening > 0.0) evening = find_evening(mesh, neighbours, spacing.at, rule);
    for (std::size_t family = 0; family < 2; ++family) {
        const std::vector<double> raw = spacing.at[family];
        for (Index w = 0; w < evening.size(); ++w) {
            const double largest = rule.largest * diagonals[mesh.components[mesh.wedge_first[w] / 3]];
            spacing.at[family][w] = std::min(largest, evening[w] * raw[w]);
        }
        const std::vector<double> even = spacing.at[family];
        if (rule.near_umbilics < 1.0)
            for (const FieldUmbilic& u : field.umbilics)
                for (Index c = 3 * u.face; c < 3 * u.face + 3; ++c) {
                    const Index w = mesh.wedges[c];
                    spacing.at[family][w] = rule.near_umbilics * even[w];
                }
        for (Index w = 0; w < caps.size(); ++w)
            if (caps[w] > 0.0) spacing.at[family][w] = std::min(spacing.at[family][w], caps[w]);
        const std::vector<double>& most = rule.most[family];
        for (Index w = 0; w < most.size(); ++w)
            if (most[w] > 0.0) spacing.at[family][w] = std::min(spacing.at[family][w], most[w]);
        limit_growth(neighbours, spacing.at[family], rule.growth);
        spacing.wanted[family].resize(raw.size());
        for (Index w = 0; w < mesh.wedge_count(); ++w) {
            const double largest = rule.largest * diagonals[mesh.components[mesh.wedge_first[w] / 3]];
            spacing.wanted[family][w] = raw[w] < 0.999 * largest && raw[w] < 4.0 * spacing.at[family][w];
            const bool is_guided = !field.guided.empty() && field.guided[w] == family;
            const bool is_capped = (!caps.empty() && caps[w] > 0.0) || (!most.empty() && most[w] > 0.0);
            if (is_guided || is_capped) spacing.wanted[family][w] = true;
        }
    }
    return spacing;
}

double expected_vertices(const WorkMesh& mesh, const Spacing& spacing) {
    double sum = 0.0;
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const double area = 0.5 * mesh.local(f, 1).real() * mesh.local(f, 2).imag();
        for (Index i = 0; i < 3; ++i) {
            const Index w = mesh.wedges[3 * f + i];
            sum += area / 3.0 / (spacing.at[0][w] * spacing.at[1][w]);
        }
    }
    return sum;
}

}  // namespace certa::remeshing
