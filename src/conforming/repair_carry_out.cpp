// Carries out a repair plan: points go into segments wherever those occur, in order along them; polygons are added to
// facets. A segment that was given on its own becomes a chain in its place in the list.
#include <algorithm>
#include <map>

#include "conforming/repair.h"
#include "core/vector3.h"

namespace certa::conforming {
namespace {

using Chain = std::vector<std::uint32_t>;

/// The points between the ends of each split segment, by its lower and upper end, from the lower end on.
std::map<std::pair<std::uint32_t, std::uint32_t>, Chain> order_splits(const RepairPlan& plan, const Complex& complex,
                                                                      const std::vector<Point3>& points) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Chain> chains;
    for (const auto& [segment, v] : plan.splits) {
        const auto [a, b] = std::minmax(complex.segments[segment][0], complex.segments[segment][1]);
        if (v != a && v != b) chains[{a, b}].push_back(v);
    }
    for (auto& [ends, chain] : chains) {
        const Point3 a = points[ends.first], d = points[ends.second] - a;
        const auto key = [&](std::uint32_t v) { return std::make_pair(dot(points[v] - a, d), v); };
        std::sort(chain.begin(), chain.end(), [&](auto v, auto w) { return key(v) < key(w); });
        chain.erase(std::unique(chain.begin(), chain.end()), chain.end());
    }
    return chains;
}

void merge_points(const RepairPlan& plan, EditableComplex& edited) {
    std::vector<std::uint32_t> place(edited.points.size());
    for (std::uint32_t v = 0; v < place.size(); ++v) place[v] = v;
    for (const auto& [from, to] : plan.merges) place[from] = to;
    for (auto& [a, b] : edited.segments) {
        a = place[a];
        b = place[b];
    }
    for (EditableFacet& facet : edited.facets) {
        for (Chain& polygon : facet.polygons) {
            for (std::uint32_t& v : polygon) v = place[v];
        }
    }
}

/// A facet without rings is nothing: what it had inside goes too.
void trim_facet(EditableFacet& facet) {
    bool has_ring = false;
    for (Chain& polygon : facet.polygons) {
        if (polygon.size() < 3) continue;
        trim_spikes(polygon);
        if (polygon.size() < 3) polygon.clear();
        has_ring = has_ring || !polygon.empty();
    }
    std::erase_if(facet.polygons, [&](const Chain& polygon) { return polygon.empty() || !has_ring; });
    if (!has_ring) facet.holes.clear();
}

}  // namespace

bool trim_spikes(Chain& ring) {
    const std::size_t size = ring.size();
    Chain kept;
    for (const std::uint32_t v : ring) {
        if (kept.size() >= 2 && kept[kept.size() - 2] == v) {
            kept.pop_back();
        } else {
            kept.push_back(v);
        }
    }
    // The same across the end of the list.
    std::size_t first = 0, last = kept.size();
    while (last - first >= 3) {
        if (kept[first] == kept[last - 2]) {
            last -= 2;
        } else if (kept[first + 1] == kept[last - 1]) {
            first += 2;
        } else {
            break;
        }
    }
    ring.assign(kept.begin() + static_cast<std::ptrdiff_t>(first), kept.begin() + static_cast<std::ptrdiff_t>(last));
    return ring.size() != size;
}

PiecewiseLinearComplex carry_out(const RepairPlan& plan, const PiecewiseLinearComplex& input, const Complex& complex) {
    EditableComplex edited = take_apart(input);
    edited.points.insert(edited.points.end(), plan.new_points.begin(), plan.new_points.end());
    if (!plan.merges.empty()) merge_points(plan, edited);
    for (const std::uint32_t f : plan.trims) trim_facet(edited.facets[f]);
    const auto chains = order_splits(plan, complex, edited.points);
    /// a, the points between a and b; without b.
    const auto walk = [&](std::uint32_t a, std::uint32_t b) {
        Chain result{a};
        const auto found = chains.find(std::minmax(a, b));
        if (found == chains.end()) return result;
        result.insert(result.end(), found->second.begin(), found->second.end());
        if (a > b) std::reverse(result.begin() + 1, result.end());
        return result;
    };
    std::vector<std::array<std::uint32_t, 2>> segments;
    std::vector<std::int32_t> markers;
    for (std::size_t s = 0; s < edited.segments.size(); ++s) {
        Chain chain = walk(edited.segments[s][0], edited.segments[s][1]);
        chain.push_back(edited.segments[s][1]);
        for (std::size_t i = 1; i < chain.size(); ++i) {
            segments.push_back({chain[i - 1], chain[i]});
            markers.push_back(edited.segment_markers[s]);
        }
    }
    edited.segments = std::move(segments);
    edited.segment_markers = std::move(markers);
    for (EditableFacet& facet : edited.facets) {
        std::vector<Chain> polygons;
        for (const Chain& polygon : facet.polygons) {
            if (polygon.size() == 1) polygons.push_back(polygon);
            if (polygon.size() == 2) {
                Chain chain = walk(polygon[0], polygon[1]);
                chain.push_back(polygon[1]);
                for (std::size_t i = 1; i < chain.size(); ++i) polygons.push_back({chain[i - 1], chain[i]});
            }
            if (polygon.size() < 3) continue;
            Chain& ring = polygons.emplace_back();
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Chain part = walk(polygon[i], polygon[(i + 1) % polygon.size()]);
                ring.insert(ring.end(), part.begin(), part.end());
            }
        }
        facet.polygons = std::move(polygons);
    }
    for (const auto& [facet, polygon] : plan.polygons) edited.facets[facet].polygons.push_back(polygon);
    return put_together(edited, input);
}

}  // namespace certa::conforming
