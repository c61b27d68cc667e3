// What each format can carry. `problems_of` lists, for one format, everything of a document that it would lose; an
// empty list means that the document can be written. The way out in a refusal comes from asking the same question of
// all other formats.
#include "io/capabilities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "io/document_parts.h"
#include "io/msh.h"

namespace certa::io {
namespace {

/// The structure of a document, found in one pass.
struct Shape {
    bool grouped = false;  // a facet of other than one polygon, or with holes
    bool small_polygons = false, triangles = false, quads = false, large_polygons = false;
    bool triangle_after_quad = false;
    bool segments = false, tetrahedra = false, region_points = false, unused_vertices = false;
    bool polygons() const { return small_polygons || triangles || quads || large_polygons; }
};

Shape find_shape(const MeshDocument& document) {
    const PiecewiseLinearComplex& complex = document.complex;
    Shape shape;
    for (std::size_t facet = 0; facet < complex.facet_count() && !shape.grouped; ++facet)
        shape.grouped = complex.facet_offsets[facet + 1] != complex.facet_offsets[facet] + 1;
    shape.grouped |= !complex.facet_holes.empty();
    std::vector<bool> used(complex.positions.size());
    for (const VertexId corner : complex.corners) used[index_of(corner)] = true;
    for (std::size_t i = 0; i < complex.polygon_count(); ++i) {
        const std::size_t degree = polygon_corners(complex, i).size();
        if (degree == 3) shape.triangle_after_quad |= shape.quads;
        (degree < 3    ? shape.small_polygons
         : degree == 3 ? shape.triangles
         : degree == 4 ? shape.quads
                       : shape.large_polygons) = true;
    }
    shape.segments = !complex.segments.empty();
    shape.tetrahedra = !document.tetrahedra.empty();
    shape.region_points = !complex.region_holes.empty() || !complex.region_seeds.empty();
    shape.unused_vertices = std::find(used.begin(), used.end(), false) != used.end();
    return shape;
}

enum Ability : unsigned {
    groups = 1U << 0,
    small_polygons = 1U << 1,
    quads = 1U << 2,
    large_polygons = 1U << 3,
    any_order = 1U << 4,
    segments = 1U << 5,
    tetrahedra = 1U << 6,
    region_points = 1U << 7,
    unused_vertices = 1U << 8,
    markers = 1U << 9,
    any_surface = small_polygons | quads | large_polygons | any_order,
};

unsigned abilities_of(Format format) {
    switch (format) {
        case Format::off:
            return any_surface | unused_vertices;
        case Format::obj:
            return any_surface | unused_vertices | segments;
        case Format::ply:
            return any_surface | unused_vertices | segments | markers;
        case Format::stl:
            return 0;
        case Format::poly:
            return any_surface | groups | unused_vertices | segments | region_points | markers;
        case Format::smesh:
            return any_surface | unused_vertices | segments | region_points | markers;
        case Format::node:
            return unused_vertices | segments | tetrahedra | markers;
        case Format::medit:
            return quads | unused_vertices | segments | tetrahedra | markers;
        case Format::vtu:
            return (any_surface & ~small_polygons) | unused_vertices | segments | tetrahedra | markers;
        case Format::msh:
            return quads | any_order | unused_vertices | segments | tetrahedra | markers;
        case Format::csv:
            return ~0U;  // fields only: the mesh stays in its own file
    }
    return 0;
}

bool has_markers(const MeshDocument& document) {
    const PiecewiseLinearComplex& complex = document.complex;
    return !complex.point_markers.empty() || !complex.segment_markers.empty() || !complex.facet_markers.empty();
}

void add_structure_problems(const MeshDocument& document, const Shape& shape, Format format,
                            std::vector<std::string>& problems) {
    const unsigned able = abilities_of(format);
    const auto need = [&](bool needed, unsigned ability, const char* what) {
        if (needed && (able & ability) == 0) problems.emplace_back(what);
    };
    need(shape.tetrahedra, tetrahedra, "tetrahedra");
    need(shape.grouped, groups, "facets of several polygons or with holes");
    need(shape.small_polygons, small_polygons, "polygons of fewer than three corners");
    need(shape.quads, quads, "polygons of four corners");
    need(shape.large_polygons, large_polygons, "polygons of more than four corners");
    need(shape.triangle_after_quad, any_order | (shape.quads ? 0U : ~0U),
         "the order of triangles after quadrilaterals");
    need(shape.segments, segments, "segments");
    need(shape.region_points, region_points, "hole points and region seeds");
    need(shape.unused_vertices, unused_vertices, "vertices that no triangle uses");
    need(has_markers(document), markers, "markers");
}

bool is_label(const Field& field) {
    constexpr std::array<std::string_view, 8> labels{"region",      "facet",        "segment",          "marker",
                                                     "source_kind", "source_index", "region_attribute", "ball_radius"};
    return std::find(labels.begin(), labels.end(), field.name) != labels.end();
}

bool is_integer(const Field& field) { return std::holds_alternative<std::vector<std::int64_t>>(field.values); }

/// Formats with one number per element: is this field that number, or one that `reference` allows to leave out?
bool fits_single_number(const MeshDocument& document, const Field& field) {
    if (is_label(field) && document.reference) return true;
    if (!is_integer(field) || field.components != 1) return false;
    switch (field.location) {
        case Location::vertices:
            return field.name == "marker";
        case Location::polygons:
            return field.name == "facet" && document.complex.facet_markers.empty();
        case Location::segments:
            return field.name == "segment" && document.complex.segment_markers.empty();
        case Location::tetrahedra:
            return field.name == "region" ||
                   (field.name == "marker" && find_integers(document, "region", Location::tetrahedra) == nullptr);
    }
    return false;
}

bool integers_within(const Field& field, std::int64_t lowest, std::int64_t highest) {
    const auto& values = std::get<std::vector<std::int64_t>>(field.values);
    return std::all_of(values.begin(), values.end(), [&](std::int64_t v) { return lowest <= v && v <= highest; });
}

bool is_one_word(std::string_view name) {
    return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c != '\x7f'; });
}

constexpr std::int64_t least_32 = std::numeric_limits<std::int32_t>::min();
constexpr std::int64_t most_32 = std::numeric_limits<std::int32_t>::max();
constexpr std::int64_t most_exact = std::int64_t{1} << 53;  // every integer up to here is a double

/// References are 32-bit integers but for those of tetrahedra.
bool fits_reference(const Field& field, std::int64_t most_of_tetrahedra) {
    if (!is_integer(field)) return true;  // left out by choice
    if (field.location == Location::tetrahedra) return integers_within(field, -most_of_tetrahedra, most_of_tetrahedra);
    return integers_within(field, least_32, most_32);
}

/// All cell fields of one name become one array.
bool agrees_with_namesakes(const MeshDocument& document, const Field& field) {
    if (field.location == Location::vertices) return true;
    const PiecewiseLinearComplex& complex = document.complex;
    const bool beside_markers =
        field.name == "marker" && (!complex.facet_markers.empty() || !complex.segment_markers.empty());
    if (beside_markers && (!is_integer(field) || field.components != 1)) return false;
    return std::all_of(document.fields.begin(), document.fields.end(), [&](const Field& other) {
        return other.location == Location::vertices || other.name != field.name ||
               (other.components == field.components && is_integer(other) == is_integer(field));
    });
}

bool fits_msh(const MeshDocument& document, const Field& field) {
    if (field.name.find_first_of("\"\n\r") != std::string::npos || field.name.empty()) return false;
    const auto* end = std::end(msh_integer_names);
    const bool reads_as_integer = std::find(std::begin(msh_integer_names), end, field.name) != end;
    if (reads_as_integer != is_integer(field) || !agrees_with_namesakes(document, field)) return false;
    if (is_integer(field)) return field.components == 1 && integers_within(field, -most_exact, most_exact);
    return field.components == 1 || field.components == 3 || field.components == 9;
}

bool fits(const MeshDocument& document, const Field& field, Format format) {
    const bool is_attribute = field.name == "attribute" && !is_integer(field);
    switch (format) {
        case Format::off:
        case Format::obj:
        case Format::stl:
            return false;
        case Format::poly:
        case Format::smesh:
            return is_attribute && field.location == Location::vertices;
        case Format::node:
            if (is_attribute) return field.location == Location::vertices || field.location == Location::tetrahedra;
            return fits_single_number(document, field) && fits_reference(field, most_exact);
        case Format::medit:
            return fits_single_number(document, field) &&
                   fits_reference(field, std::numeric_limits<std::int64_t>::max());
        case Format::ply:
            return is_one_word(field.name) && field.location != Location::tetrahedra &&
                   (!is_integer(field) || integers_within(field, least_32, most_32) ||
                    integers_within(field, 0, std::numeric_limits<std::uint32_t>::max()));
        case Format::vtu:
            return !field.name.empty() && agrees_with_namesakes(document, field);
        case Format::msh:
            return fits_msh(document, field);
        case Format::csv:
            return field.location == Location::vertices;
    }
    return false;
}

std::string words_for(const Field& field) { return "the field '" + field.name + "' of " + name_of(field.location); }

std::vector<std::string> problems_of(const MeshDocument& document, const Shape& shape, Format format) {
    std::vector<std::string> problems;
    add_structure_problems(document, shape, format, problems);
    for (const Field& field : document.fields)
        if (!fits(document, field, format)) problems.push_back(words_for(field));
    const bool is_complex = format == Format::poly || format == Format::smesh;
    // TetGen takes an empty list of points for "in the .node file".
    if (is_complex && document.complex.positions.empty()) problems.emplace_back("a complex without points");
    if (format == Format::csv && problems.empty()) {
        const bool any = !document.complex.point_markers.empty() || !document.fields.empty();
        if (!any) problems.emplace_back("a mesh without fields");
    }
    return problems;
}

std::string way_out(const MeshDocument& document, const Shape& shape) {
    std::string able;
    for (const Format format : {Format::off, Format::obj, Format::ply, Format::stl, Format::poly, Format::medit,
                                Format::vtu, Format::msh, Format::node}) {
        if (!problems_of(document, shape, format).empty()) continue;
        able += (able.empty() ? "" : ", ") + std::string(name_of(format));
    }
    if (able.empty()) return "no single format can carry everything; leave something out";
    return "can carry it: " + able;
}

[[noreturn]] void refuse(const std::string& name, const std::string& reason) { throw IoError(name, 0, reason); }

void check_offsets(const std::vector<std::uint32_t>& offsets, std::size_t size, const char* what,
                   const std::string& name) {
    const bool ok = !offsets.empty() && offsets.front() == 0 && offsets.back() == size &&
                    std::is_sorted(offsets.begin(), offsets.end());
    if (!ok) refuse(name, std::string("the offsets of ") + what + " do not fit their contents");
}

bool is_finite(const Point3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

void check_sizes(const MeshDocument& document, const std::string& name) {
    const PiecewiseLinearComplex& complex = document.complex;
    constexpr std::size_t most = no_index;
    if (std::max({complex.positions.size(), complex.corners.size(), complex.segments.size(), document.tetrahedra.size(),
                  complex.polygon_offsets.size(), complex.facet_holes.size()}) >= most)
        refuse(name, "more than 4294967294 elements");
    check_offsets(complex.polygon_offsets, complex.corners.size(), "polygons", name);
    check_offsets(complex.facet_offsets, complex.polygon_count(), "facets", name);
    check_offsets(complex.hole_offsets, complex.facet_holes.size(), "holes of facets", name);
    if (complex.hole_offsets.size() != complex.facet_offsets.size())
        refuse(name, "the offsets of the holes of facets do not fit the facets");
    const auto check_markers = [&](const std::vector<std::int32_t>& markers, std::size_t size, const char* what) {
        if (!markers.empty() && markers.size() != size)
            refuse(name, std::to_string(markers.size()) + " markers for " + std::to_string(size) + " " + what);
    };
    check_markers(complex.point_markers, complex.positions.size(), "points");
    check_markers(complex.segment_markers, complex.segments.size(), "segments");
    check_markers(complex.facet_markers, complex.facet_count(), "facets");
}

void check_references(const MeshDocument& document, const std::string& name) {
    const PiecewiseLinearComplex& complex = document.complex;
    const std::size_t size = complex.positions.size();
    const auto check = [&](std::span<const VertexId> corners, const char* what, std::size_t element) {
        for (const VertexId corner : corners)
            if (index_of(corner) >= size)
                refuse(name, std::string(what) + " " + std::to_string(element + 1) + " names vertex " +
                                 std::to_string(index_of(corner) + 1ULL) + " of " + std::to_string(size));
    };
    for (std::size_t i = 0; i < complex.polygon_count(); ++i) {
        if (polygon_corners(complex, i).empty()) refuse(name, "polygon " + std::to_string(i + 1) + " has no corners");
        check(polygon_corners(complex, i), "polygon", i);
    }
    for (std::size_t i = 0; i < complex.segments.size(); ++i) check(complex.segments[i], "segment", i);
    for (std::size_t i = 0; i < document.tetrahedra.size(); ++i) check(document.tetrahedra[i], "tetrahedron", i);
}

void check_places(const PiecewiseLinearComplex& complex, const std::string& name) {
    const auto check = [&](const std::vector<Point3>& points, const char* what) {
        for (std::size_t i = 0; i < points.size(); ++i)
            if (!is_finite(points[i])) refuse(name, std::string(what) + " " + std::to_string(i + 1) + " is not finite");
    };
    check(complex.positions, "point");
    check(complex.facet_holes, "hole point of facets");
    check(complex.region_holes, "hole point");
    for (std::size_t i = 0; i < complex.region_seeds.size(); ++i) {
        const RegionSeed& seed = complex.region_seeds[i];
        if (!is_finite(seed.place) || !std::isfinite(seed.attribute) || !std::isfinite(seed.max_volume))
            refuse(name, "region seed " + std::to_string(i + 1) + " is not finite");
    }
}

void check_field(const MeshDocument& document, const Field& field, const std::string& name) {
    const std::string what = words_for(field);
    const std::size_t wanted = size_at(document, field.location) * field.components;
    const std::size_t given = std::visit([](const auto& values) { return values.size(); }, field.values);
    if (field.components == 0) refuse(name, what + " has no components");
    if (given != wanted)
        refuse(name, what + " has " + std::to_string(given) + " numbers instead of " + std::to_string(wanted));
    const std::vector<std::int32_t>* markers = find_markers(document.complex, field.location);
    if (field.name == "marker" && markers != nullptr && !markers->empty())
        refuse(name, what + " stands beside the markers of the complex");
    if (const auto* values = std::get_if<std::vector<double>>(&field.values))
        for (std::size_t k = 0; k < values->size(); ++k)
            if (!std::isfinite((*values)[k]))
                refuse(name, what + " is not finite at number " + std::to_string(k / field.components + 1));
}

}  // namespace

void check_consistent(const MeshDocument& document, const std::string& name) {
    check_sizes(document, name);
    check_references(document, name);
    check_places(document.complex, name);
    std::set<std::pair<Location, std::string_view>> names;
    for (const Field& field : document.fields) {
        check_field(document, field, name);
        if (!names.insert({field.location, field.name}).second) refuse(name, words_for(field) + " is there twice");
    }
}

void check_writable(const MeshDocument& document, Format format, const WriteOptions& options, const std::string& name) {
    const Shape shape = find_shape(document);
    const std::vector<std::string> problems = problems_of(document, shape, format);
    if (!problems.empty())
        refuse(name,
               std::string(name_of(format)) + " cannot carry " + problems.front() + "; " + way_out(document, shape));
    const bool has_binary =
        format == Format::ply || format == Format::stl || format == Format::vtu || format == Format::msh;
    if (options.encoding == Encoding::binary && !has_binary)
        refuse(name, std::string(name_of(format)) + " is a text format; binary are ply, stl, vtu and msh");
    if (options.msh_version_2 && format != Format::msh)
        refuse(name, "a version of msh was asked for, but not the format");
}

}  // namespace certa::io
