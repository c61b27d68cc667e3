// Filling documents and looking things up in them.
// Conventions that all formats share: zero means "no marker" or "no label", labels count from 1, markers of points,
// segments and facets live in the complex, markers of tetrahedra in a field.
#include "io/document_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

bool is_zero(std::int64_t v) { return v == 0; }
bool is_zero(double v) { return v == 0.0 && !std::signbit(v); }

bool is_zero(const NumberArray& values) {
    return std::visit([](const auto& v) { return std::all_of(v.begin(), v.end(), [](auto x) { return is_zero(x); }); },
                      values);
}
std::size_t size_of(const NumberArray& values) {
    return std::visit([](const auto& v) { return v.size(); }, values);
}

bool fits_markers(const NumberArray& values, std::uint32_t components) {
    const auto* integers = std::get_if<std::vector<std::int64_t>>(&values);
    return integers != nullptr && components == 1 &&
           std::all_of(integers->begin(), integers->end(), [](std::int64_t v) {
               return v >= std::numeric_limits<std::int32_t>::min() && v <= std::numeric_limits<std::int32_t>::max();
           });
}
std::vector<std::int32_t> as_markers(const NumberArray& values) {
    const auto& integers = std::get<std::vector<std::int64_t>>(values);
    return meaningful({integers.begin(), integers.end()});
}

/// The marker array of a location, const or not like the complex.
template <class Complex>
auto* select_markers(Complex& complex, Location location) {
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
    return decltype(&complex.point_markers){nullptr};
}

/// Appends what a kind of cell has under a name, as numbers of type T; zeros if it has nothing.
template <class T>
void append_part(const MeshDocument& document, std::string_view name, std::uint32_t components, Location location,
                 std::vector<T>& values) {
    const std::vector<std::int32_t>* markers = name == "marker" ? find_markers(document.complex, location) : nullptr;
    if (const Field* field = find_field(document, name, location)) {
        const auto& own = std::get<std::vector<T>>(field->values);
        values.insert(values.end(), own.begin(), own.end());
    } else if (markers != nullptr && !markers->empty()) {
        values.insert(values.end(), markers->begin(), markers->end());
    } else {
        values.insert(values.end(), size_at(document, location) * components, T{});
    }
}

}  // namespace

void add_cell_array(MeshDocument& document, const std::string& name, std::uint32_t components,
                    std::array<NumberArray, 3> parts) {
    constexpr std::array<std::string_view, 3> labels{"region", "facet", "segment"};
    const bool markers = name == "marker" && std::all_of(parts.begin(), parts.end(), [&](const NumberArray& part) {
                             return fits_markers(part, components);
                         });
    const bool is_label = std::find(labels.begin(), labels.end(), name) != labels.end();
    const bool all_zero =
        std::all_of(parts.begin(), parts.end(), [](const NumberArray& part) { return is_zero(part); });
    for (std::size_t k = 0; k < parts.size(); ++k) {
        if (size_of(parts[k]) == 0) continue;
        if (is_zero(parts[k]) && (markers || (is_label ? name != labels[k] : !all_zero))) continue;
        std::vector<std::int32_t>* target = markers ? select_markers(document.complex, cell_locations[k]) : nullptr;
        if (target != nullptr)
            *target = as_markers(parts[k]);
        else
            document.fields.push_back({name, cell_locations[k], components, std::move(parts[k])});
    }
}

void add_vertex_array(MeshDocument& document, const std::string& name, std::uint32_t components, NumberArray values) {
    if (name == "marker" && fits_markers(values, components))
        document.complex.point_markers = as_markers(values);
    else
        document.fields.push_back({name, Location::vertices, components, std::move(values)});
}

std::vector<std::string> cell_array_names(const MeshDocument& document) {
    std::vector<std::string> names;
    const auto add = [&](const std::string& name) {
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    };
    for (const Field& field : document.fields)
        if (field.location != Location::vertices) add(field.name);
    if (!document.complex.facet_markers.empty() || !document.complex.segment_markers.empty()) add("marker");
    return names;
}

std::uint32_t cell_array_components(const MeshDocument& document, std::string_view name) {
    for (const Location location : cell_locations)
        if (const Field* field = find_field(document, name, location)) return field->components;
    return 1;
}

NumberArray merged_cell_array(const MeshDocument& document, std::string_view name) {
    bool is_double = false;
    for (const Location location : cell_locations)
        if (const Field* field = find_field(document, name, location))
            is_double = std::holds_alternative<std::vector<double>>(field->values);
    const std::uint32_t components = cell_array_components(document, name);
    NumberArray merged;
    if (!is_double) merged = std::vector<std::int64_t>();
    for (const Location location : cell_locations)
        std::visit([&](auto& values) { append_part(document, name, components, location, values); }, merged);
    return merged;
}

void make_facets_of_polygons(PiecewiseLinearComplex& complex) {
    complex.facet_offsets.resize(complex.polygon_count() + 1);
    std::iota(complex.facet_offsets.begin(), complex.facet_offsets.end(), 0U);
    complex.hole_offsets.assign(complex.polygon_count() + 1, 0U);
}

std::string remark_line(const MeshDocument& document) {
    std::string line;
    for (const char c : document.remark) {
        const char printable = c >= ' ' ? c : ' ';
        // XML ends a comment at two dashes, Gmsh a section at a dollar sign.
        const bool is_special = printable == '$' || (printable == '-' && line.ends_with('-'));
        line += is_special ? '_' : printable;
    }
    return line;
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
    return select_markers(complex, location);
}

ElementNumbers choose_element_numbers(const MeshDocument& document) {
    return {choose(document, "", Location::vertices), choose(document, "facet", Location::polygons),
            choose(document, "segment", Location::segments), choose(document, "region", Location::tetrahedra)};
}

}  // namespace certa::io
