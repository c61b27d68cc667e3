// Filling documents and looking things up in them.
// Conventions that all formats share: zero means "no marker" or "no label", labels count from 1, markers of points,
// segments and facets live in the complex, markers of tetrahedra in a field.
#include "io/document_parts.h"

#include <algorithm>
#include <numeric>

namespace certa::io {
namespace {

std::vector<std::int64_t> choose(const MeshDocument& document, const char* label, Location location) {
    const std::vector<std::int64_t>* ids = find_integers(document, label, location);
    const std::vector<std::int32_t>* markers = find_markers(document.complex, location);
    const std::vector<std::int64_t>* marker_field = find_integers(document, "marker", location);
    // Without a choice at most one of them is there: check_writable refuses the others.
    const bool by_marker =
        document.reference.value_or(Reference::id) == Reference::marker && location != Location::tetrahedra;
    if (ids != nullptr && !by_marker) return *ids;
    if (markers != nullptr && !markers->empty()) return {markers->begin(), markers->end()};
    if (marker_field != nullptr) return *marker_field;
    return {};
}

}  // namespace

void make_facets_of_polygons(PiecewiseLinearComplex& complex) {
    complex.facet_offsets.resize(complex.polygon_count() + 1);
    std::iota(complex.facet_offsets.begin(), complex.facet_offsets.end(), 0U);
    complex.hole_offsets.assign(complex.polygon_count() + 1, 0U);
}

std::vector<std::int32_t> meaningful(std::vector<std::int32_t> markers) {
    if (std::all_of(markers.begin(), markers.end(), [](std::int32_t m) { return m == 0; })) return {};
    return markers;
}

std::size_t size_at(const MeshDocument& document, Location location) {
    switch (location) {
        case Location::vertices:
            return document.complex.positions.size();
        case Location::polygons:
            return document.complex.polygon_count();
        case Location::segments:
            return document.complex.segments.size();
        case Location::tetrahedra:
            return document.tetrahedra.size();
    }
    return 0;
}

const char* name_of(Location location) {
    switch (location) {
        case Location::vertices:
            return "vertices";
        case Location::polygons:
            return "polygons";
        case Location::segments:
            return "segments";
        case Location::tetrahedra:
            return "tetrahedra";
    }
    return "";
}

const Field* find_field(const MeshDocument& document, std::string_view name, Location location) {
    for (const Field& field : document.fields)
        if (field.location == location && field.name == name) return &field;
    return nullptr;
}

const std::vector<std::int64_t>* find_integers(const MeshDocument& document, std::string_view name, Location location) {
    const Field* field = find_field(document, name, location);
    return field != nullptr && field->components == 1 ? std::get_if<std::vector<std::int64_t>>(&field->values)
                                                      : nullptr;
}

void add_field(MeshDocument& document, std::string name, Location location, std::vector<std::int64_t> values) {
    document.fields.push_back({std::move(name), location, 1, std::move(values)});
}

void add_field(MeshDocument& document, std::string name, Location location, std::uint32_t components,
               std::vector<double> values) {
    document.fields.push_back({std::move(name), location, components, std::move(values)});
}

const std::vector<std::int32_t>* find_markers(const PiecewiseLinearComplex& complex, Location location) {
    switch (location) {
        case Location::vertices:
            return &complex.point_markers;
        case Location::polygons:
            return &complex.facet_markers;
        case Location::segments:
            return &complex.segment_markers;
        case Location::tetrahedra:
            break;
    }
    return nullptr;
}

ElementNumbers choose_element_numbers(const MeshDocument& document) {
    return {choose(document, "", Location::vertices), choose(document, "facet", Location::polygons),
            choose(document, "segment", Location::segments), choose(document, "region", Location::tetrahedra)};
}

}  // namespace certa::io
