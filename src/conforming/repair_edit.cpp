// Takes a complex apart into lists that can grow and shrink, and puts it together again.
#include "conforming/repair_edit.h"

namespace certa::conforming {

EditableComplex take_apart(const PiecewiseLinearComplex& input) {
    EditableComplex edited;
    edited.points = input.positions;
    for (const Edge& e : input.segments) edited.segments.push_back({index_of(e[0]), index_of(e[1])});
    edited.segment_markers = input.segment_markers;
    edited.segment_markers.resize(input.segments.size(), 0);
    edited.facets.resize(input.facet_count());
    for (std::size_t f = 0; f < edited.facets.size(); ++f) {
        EditableFacet& facet = edited.facets[f];
        for (std::uint32_t p = input.facet_offsets[f]; p < input.facet_offsets[f + 1]; ++p) {
            auto& polygon = facet.polygons.emplace_back();
            for (std::uint32_t c = input.polygon_offsets[p]; c < input.polygon_offsets[p + 1]; ++c) {
                polygon.push_back(index_of(input.corners[c]));
            }
        }
        facet.holes.assign(input.facet_holes.begin() + input.hole_offsets[f],
                           input.facet_holes.begin() + input.hole_offsets[f + 1]);
        if (!input.facet_markers.empty()) facet.marker = input.facet_markers[f];
    }
    return edited;
}

PiecewiseLinearComplex put_together(const EditableComplex& edited, const PiecewiseLinearComplex& like) {
    PiecewiseLinearComplex result;
    result.positions = edited.points;
    for (const auto& [a, b] : edited.segments) result.segments.push_back({VertexId{a}, VertexId{b}});
    for (const EditableFacet& facet : edited.facets) {
        for (const auto& polygon : facet.polygons) {
            for (const std::uint32_t v : polygon) result.corners.push_back(VertexId{v});
            result.polygon_offsets.push_back(static_cast<std::uint32_t>(result.corners.size()));
        }
        result.facet_offsets.push_back(static_cast<std::uint32_t>(result.polygon_offsets.size() - 1));
        result.facet_holes.insert(result.facet_holes.end(), facet.holes.begin(), facet.holes.end());
        result.hole_offsets.push_back(static_cast<std::uint32_t>(result.facet_holes.size()));
        if (!like.facet_markers.empty()) result.facet_markers.push_back(facet.marker);
    }
    result.point_markers = like.point_markers;
    if (!like.point_markers.empty()) result.point_markers.resize(edited.points.size(), 0);
    if (!like.segment_markers.empty()) result.segment_markers = edited.segment_markers;
    result.region_holes = like.region_holes;
    result.region_seeds = like.region_seeds;
    return result;
}

}  // namespace certa::conforming
