// Facets that are not planar become triangles: those of the constrained Delaunay triangulation seen along the axis
// nearest to the normal, or along another one where its sides cross so seen. The first triangle takes the facet's
// place, the others follow after the last facet.
#include <algorithm>
#include <array>
#include <cmath>

#include "conforming/build_complex.h"
#include "conforming/repair.h"
#include "conforming/validate_messages.h"
#include "core/vector3.h"
#include "delaunay/flat_facet.h"

namespace certa::conforming {

using delaunay::FlatFacet;
using delaunay::FlatState;
using delaunay::Projection;
namespace {

double deviation_of(const EditableFacet& facet, const EditableComplex& complex, const Frame& frame) {
    double largest = 0.0;
    for (const auto& polygon : facet.polygons) {
        for (const std::uint32_t v : polygon) {
            largest = std::max(largest, std::abs(dot(complex.points[v] - frame.origin, frame.normal)));
        }
    }
    return largest;
}

bool is_cut(const FlatFacet& flat) {
    return flat.state != FlatState::crossing && !flat.triangles.empty() && flat.holes_outside.empty();
}

bool is_plain_quad(const EditableFacet& facet) {
    if (facet.polygons.size() != 1 || facet.polygons[0].size() != 4 || !facet.holes.empty()) return false;
    std::vector<std::uint32_t> ring = facet.polygons[0];
    std::sort(ring.begin(), ring.end());
    return std::adjacent_find(ring.begin(), ring.end()) == ring.end();
}

/// A quad that crosses itself however it is seen, as a warped sliver may: its shorter diagonal cuts it.
FlatFacet cut_quad(const EditableComplex& complex, const std::vector<std::uint32_t>& ring) {
    const auto square = [&](std::uint32_t a, std::uint32_t b) {
        const Point3 d = complex.points[b] - complex.points[a];
        return dot(d, d);
    };
    FlatFacet flat;
    if (square(ring[0], ring[2]) <= square(ring[1], ring[3]))
        flat.triangles = {{ring[0], ring[1], ring[2]}, {ring[0], ring[2], ring[3]}};
    else
        flat.triangles = {{ring[0], ring[1], ring[3]}, {ring[1], ring[2], ring[3]}};
    return flat;
}

/// The facet seen along the axis nearest to its normal. A warped facet may cross itself so seen, and not along the
/// normal; one of the other axes, by the normal's components, may see it as it is then.
FlatFacet flatten(const PiecewiseLinearComplex& input, std::uint32_t facet, const Point3& normal) {
    FlatFacet nearest = delaunay::flatten_facet(input, facet, Projection(normal));
    if (is_cut(nearest)) return nearest;
    std::array<Point3, 3> along{{{normal.x, 0.0, 0.0}, {0.0, normal.y, 0.0}, {0.0, 0.0, normal.z}}};
    std::sort(along.begin(), along.end(), [](const Point3& a, const Point3& b) { return dot(a, a) > dot(b, b); });
    for (const Point3& axis : along) {
        if (dot(axis, axis) == 0.0) continue;
        FlatFacet other = delaunay::flatten_facet(input, facet, Projection(axis));
        if (is_cut(other)) return other;
    }
    return nearest;
}

}  // namespace

RepairedComplex triangulate_facets(const PiecewiseLinearComplex& input, double planarity) {
    EditableComplex edited = take_apart(input);
    const auto count = static_cast<std::uint32_t>(edited.facets.size());
    RepairedComplex result;
    for (std::uint32_t f = 0; f < count; ++f) result.facet_sources.push_back(FacetId{f});
    for (std::uint32_t f = 0; f < count; ++f) {
        if (edited.facets[f].polygons.empty()) continue;
        const Frame frame = build_frame(input, f);
        const double deviation = deviation_of(edited.facets[f], edited, frame);
        if (deviation <= planarity) continue;
        FlatFacet flat = flatten(input, f, frame.normal);
        if (!is_cut(flat)) {
            if (!is_plain_quad(edited.facets[f])) continue;
            flat = cut_quad(edited, edited.facets[f].polygons[0]);
        }
        result.repairs.push_back({DefectKind::non_planar_facet,
                                  {{ElementKind::facet, f}},
                                  frame.origin,
                                  facet_name(f) + " deviates by " + name_number(deviation) +
                                      " from its plane and was cut into " + std::to_string(flat.triangles.size()) +
                                      " triangles"});
        const std::int32_t marker = edited.facets[f].marker;
        for (std::size_t i = 0; i < flat.triangles.size(); ++i) {
            const auto& t = flat.triangles[i];
            EditableFacet piece{{{t[0], t[1], t[2]}}, {}, marker};
            if (i == 0) {
                edited.facets[f] = std::move(piece);
            } else {
                edited.facets.push_back(std::move(piece));
                result.facet_sources.push_back(FacetId{f});
            }
        }
    }
    result.complex = put_together(edited, input);
    return result;
}

}  // namespace certa::conforming
