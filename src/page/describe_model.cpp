// A document in the terms of the viewer (viewer/src/data.js reads what is written here).
// First everything that could make the viewer read beyond an array is refused; then positions are moved into a box
// around the origin and scaled by a power of two, so that single precision is relative to the model, wherever it lies
// and however small it is; then come connectivity, fields with their exact ranges, markers, and counts.
#include "page/describe_model.h"

#include <certa/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "core/vector3.h"
#include "page/json_text.h"
#include "page/shield_edges.h"

namespace certa::page {
namespace {

using Integers = std::vector<std::int64_t>;

[[noreturn]] void refuse(DefectKind kind, std::vector<ElementRef> elements, const Point3& place, std::string message) {
    throw InputError({{kind, std::move(elements), place, std::move(message)}});
}

struct Sizes {
    std::size_t vertices, polygons, segments, tetrahedra;
    std::size_t at(Location location) const {
        return std::array{vertices, polygons, segments, tetrahedra}.at(static_cast<std::size_t>(location));
    }
};
constexpr std::array<std::string_view, 4> location_names{"vertices", "polygons", "segments", "tetrahedra"};

void require_points(const ViewModel& model) {
    const std::vector<Point3>& points = model.document.complex.positions;
    if (points.empty())
        refuse(DefectKind::empty_input, {}, {}, model.name + " has no points; there is nothing to show");
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y) || !std::isfinite(points[i].z))
            refuse(DefectKind::non_finite_coordinate, {{ElementKind::vertex, static_cast<std::uint32_t>(i)}}, {},
                   model.name + ": vertex " + std::to_string(i + 1) + " has a coordinate that is no finite number");
}

template <class Elements>
void require_corners(const std::string& name, std::size_t vertices, ElementKind kind, const Elements& elements) {
    for (std::size_t i = 0; i < elements.size(); ++i)
        for (const VertexId v : elements[i])
            if (index_of(v) >= vertices)
                refuse(DefectKind::index_out_of_range,
                       {{kind, static_cast<std::uint32_t>(i)}, {ElementKind::vertex, index_of(v)}}, {},
                       name + ": " + name_of(kind) + " " + std::to_string(i + 1) + " names vertex " +
                           std::to_string(std::uint64_t{index_of(v)} + 1) + " of " + std::to_string(vertices));
}

/// Offsets begin with 0, never fall, and end with `size`.
void require_offsets(const std::string& name, const char* what, const std::vector<std::uint32_t>& offsets,
                     std::size_t size) {
    if (!offsets.empty() && offsets.front() == 0 && offsets.back() == size &&
        std::is_sorted(offsets.begin(), offsets.end()))
        return;
    refuse(DefectKind::index_out_of_range, {}, {}, name + ": the offsets of its " + what + " do not fit together");
}

void require_polygons(const ViewModel& model) {
    const PiecewiseLinearComplex& complex = model.document.complex;
    require_offsets(model.name, "polygons", complex.polygon_offsets, complex.corners.size());
    require_offsets(model.name, "facets", complex.facet_offsets, complex.polygon_count());
    require_offsets(model.name, "facet holes", complex.hole_offsets, complex.facet_holes.size());
    if (complex.hole_offsets.size() != complex.facet_offsets.size() && !complex.facet_holes.empty())
        refuse(DefectKind::index_out_of_range, {}, {}, model.name + ": the hole points are not those of its facets");
    for (std::size_t p = 0; p < complex.polygon_count(); ++p)
        for (std::uint32_t i = complex.polygon_offsets[p]; i < complex.polygon_offsets[p + 1]; ++i)
            if (index_of(complex.corners[i]) >= complex.positions.size())
                refuse(DefectKind::index_out_of_range, {{ElementKind::polygon, static_cast<std::uint32_t>(p)}}, {},
                       model.name + ": polygon " + std::to_string(p + 1) + " names vertex " +
                           std::to_string(std::uint64_t{index_of(complex.corners[i])} + 1) + " of " +
                           std::to_string(complex.positions.size()));
}

void require_length(const std::string& model, const std::string& what, std::size_t length, std::size_t expected) {
    if (length == expected) return;
    refuse(DefectKind::index_out_of_range, {}, {},
           model + ": " + what + " has " + std::to_string(length) + " numbers instead of " + std::to_string(expected));
}

std::size_t length_of(const Field& field) {
    return std::visit([](const auto& values) { return values.size(); }, field.values);
}

void require_fields(const ViewModel& model, const Sizes& sizes) {
    for (const Field& field : model.document.fields) {
        if (field.components == 0) require_length(model.name, "field '" + field.name + "'", 0, 1);
        require_length(model.name, "field '" + field.name + "'", length_of(field),
                       field.components * sizes.at(field.location));
    }
    const PiecewiseLinearComplex& complex = model.document.complex;
    const auto require_markers = [&](const char* what, const std::vector<std::int32_t>& markers, std::size_t count) {
        if (!markers.empty()) require_length(model.name, what, markers.size(), count);
    };
    require_markers("the array of point markers", complex.point_markers, complex.positions.size());
    require_markers("the array of segment markers", complex.segment_markers, complex.segments.size());
    require_markers("the array of facet markers", complex.facet_markers, complex.facet_count());
}

/// Points that some element uses, else all: a stray point far away must not make the model a dot.
std::vector<Point3> framed_points(const MeshDocument& document) {
    const std::vector<Point3>& all = document.complex.positions;
    std::vector<bool> used(all.size(), false);
    for (const VertexId v : document.complex.corners) used[index_of(v)] = true;
    for (const Edge& edge : document.complex.segments)
        for (const VertexId v : edge) used[index_of(v)] = true;
    for (const Tetrahedron& tetrahedron : document.tetrahedra)
        for (const VertexId v : tetrahedron) used[index_of(v)] = true;
    std::vector<Point3> points;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (used[i]) points.push_back(all[i]);
    return points.empty() ? all : points;
}

/// The bounding box and the frame in which positions are written.
struct Frame {
    Point3 lower, upper, origin;
    double scale = 1.0;

    explicit Frame(const std::vector<Point3>& points) : lower(points.front()), upper(points.front()) {
        for (const Point3& p : points) {
            lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
            upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
        }
        // Halves first: the sum or difference of two doubles need not be one.
        origin = 0.5 * lower + 0.5 * upper;
        const Point3 half = 0.5 * upper - 0.5 * lower;
        const double largest = std::max({half.x, half.y, half.z});
        if (largest > 0.0) scale = std::ldexp(1.0, std::ilogb(largest) + (std::ilogb(largest) < 1023 ? 1 : 0));
    }
    float place(double value, double centre) const {
        // Halved for the same reason; points outside the box may be beyond single precision.
        constexpr double limit = 1e38;
        return static_cast<float>(std::clamp((0.5 * value - 0.5 * centre) / scale * 2.0, -limit, limit));
    }
};

std::vector<float> positions_in(const Frame& frame, const std::vector<Point3>& points) {
    std::vector<float> values;
    values.reserve(3 * points.size());
    for (const Point3& p : points) {
        values.push_back(frame.place(p.x, frame.origin.x));
        values.push_back(frame.place(p.y, frame.origin.y));
        values.push_back(frame.place(p.z, frame.origin.z));
    }
    return values;
}

template <class Elements>
std::vector<std::uint32_t> flattened(const Elements& elements) {
    std::vector<std::uint32_t> indices;
    for (const auto& element : elements)
        for (const VertexId v : element) indices.push_back(index_of(v));
    return indices;
}

void set_polygons(JsonObject& entry, const PiecewiseLinearComplex& complex, const Frame& frame, PageArrays& arrays) {
    const std::size_t count = complex.polygon_count();
    if (count == 0) return;
    std::vector<std::uint32_t> corners;
    for (const VertexId v : complex.corners) corners.push_back(index_of(v));
    entry.set("corners", arrays.add(std::span<const std::uint32_t>(corners)));
    const std::uint32_t degree = complex.polygon_offsets[1];
    bool equal = degree > 2;
    for (std::size_t p = 0; p < count; ++p)
        equal = equal && complex.polygon_offsets[p + 1] - complex.polygon_offsets[p] == degree;
    bool single = complex.facet_holes.empty() && complex.facet_count() == count;
    for (std::size_t f = 0; single && f < count; ++f) single = complex.facet_offsets[f] == f;
    // Hole points and facets of several rings need the offsets, whatever the polygons.
    if (equal && (single || degree != 3))
        entry.set("degree", json_number(std::uint64_t{degree}));
    else
        entry.set("offsets", arrays.add(std::span<const std::uint32_t>(complex.polygon_offsets)));
    if (single) return;
    entry.set("facets", arrays.add(std::span<const std::uint32_t>(complex.facet_offsets)));
    std::vector<std::string> places, owners;
    for (std::size_t f = 0; f + 1 < complex.hole_offsets.size(); ++f)
        for (std::uint32_t h = complex.hole_offsets[f]; h < complex.hole_offsets[f + 1]; ++h) {
            const Point3& p = complex.facet_holes[h];
            places.push_back(
                json_point({double{frame.place(p.x, frame.origin.x)}, double{frame.place(p.y, frame.origin.y)},
                            double{frame.place(p.z, frame.origin.z)}}));
            owners.push_back(json_number(std::uint64_t{f}));
        }
    if (places.empty()) return;
    entry.set("facet_holes", json_list(places)).set("facet_hole_owners", json_list(owners));
}

/// A field as the viewer takes it: one component or three.
std::string describe_field(const std::string& name, Location location, std::uint32_t components, const auto& values,
                           PageArrays& arrays) {
    using Number = typename std::decay_t<decltype(values)>::value_type;
    constexpr bool is_label = std::is_same_v<Number, std::int64_t>;
    JsonObject entry;
    entry.set("name", json_string(name))
        .set("location", json_string(location_names.at(static_cast<std::size_t>(location))));
    entry.set("components", json_number(std::uint64_t{components})).set("kind", is_label ? "\"label\"" : "\"number\"");
    double low = 0.0, high = 0.0;
    bool any = false;
    for (const Number value : values) {
        const double number = static_cast<double>(value);
        if (!std::isfinite(number)) continue;
        low = any ? std::min(low, number) : number;
        high = any ? std::max(high, number) : number;
        any = true;
    }
    entry.set("min", json_number(low)).set("max", json_number(high));
    entry.set("array", arrays.add(std::span<const Number>(values)));
    return entry.text();
}

void add_field(std::vector<std::string>& entries, const Field& field, PageArrays& arrays) {
    std::visit(
        [&](const auto& values) {
            if (field.components == 1 || field.components == 3) {
                entries.push_back(describe_field(field.name, field.location, field.components, values, arrays));
                return;
            }
            for (std::uint32_t c = 0; c < field.components; ++c) {
                std::decay_t<decltype(values)> one;
                for (std::size_t i = c; i < values.size(); i += field.components) one.push_back(values[i]);
                entries.push_back(describe_field(field.name + "_" + std::to_string(c), field.location, 1, one, arrays));
            }
        },
        field.values);
}

std::vector<std::string> describe_fields(const MeshDocument& document, PageArrays& arrays) {
    std::vector<std::string> entries;
    for (const Field& field : document.fields) add_field(entries, field, arrays);
    const PiecewiseLinearComplex& complex = document.complex;
    const auto add_markers = [&](Location location, const Integers& markers) {
        if (!markers.empty()) entries.push_back(describe_field("marker", location, 1, markers, arrays));
    };
    add_markers(Location::vertices, {complex.point_markers.begin(), complex.point_markers.end()});
    add_markers(Location::segments, {complex.segment_markers.begin(), complex.segment_markers.end()});
    Integers of_polygons;
    if (!complex.facet_markers.empty())
        for (std::size_t f = 0; f < complex.facet_count(); ++f)
            of_polygons.resize(complex.facet_offsets[f + 1], complex.facet_markers[f]);
    add_markers(Location::polygons, of_polygons);
    return entries;
}

/// Number of different values of a label, "none" left out; nothing without it.
std::optional<std::uint64_t> label_count(const MeshDocument& document, std::string_view name, Location location) {
    for (const Field& field : document.fields) {
        const Integers* values = std::get_if<Integers>(&field.values);
        if (values == nullptr || field.name != name || field.location != location || field.components != 1) continue;
        std::set<std::int64_t> distinct(values->begin(), values->end());
        distinct.erase(0);
        return distinct.size();
    }
    return std::nullopt;
}

/// Number of vertices whose entry in a field is not 0; nothing without the field.
std::optional<std::uint64_t> marked_count(const MeshDocument& document, std::string_view name) {
    for (const Field& field : document.fields)
        if (field.name == name && field.location == Location::vertices && field.components == 1)
            return std::visit(
                [](const auto& values) {
                    const auto zeros = std::count(values.begin(), values.end(), 0);
                    return values.size() - static_cast<std::size_t>(zeros);
                },
                field.values);
    return std::nullopt;
}

std::string describe_counts(const MeshDocument& document, std::size_t shields) {
    const PiecewiseLinearComplex& complex = document.complex;
    std::uint64_t triangles = 0, quads = 0;
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        triangles += complex.polygon_offsets[p + 1] - complex.polygon_offsets[p] == 3;
        quads += complex.polygon_offsets[p + 1] - complex.polygon_offsets[p] == 4;
    }
    JsonObject counts;
    counts.set("polygons", json_number(std::uint64_t{complex.polygon_count()}))
        .set("triangles", json_number(triangles))
        .set("quads", json_number(quads));
    counts.set("segments", json_number(std::uint64_t{complex.segments.size()}));
    counts.set("tetrahedra", json_number(std::uint64_t{document.tetrahedra.size()}));
    const auto facets = label_count(document, "facet", Location::polygons);
    if (facets || complex.facet_count() != complex.polygon_count())
        counts.set("facets", json_number(facets ? *facets : std::uint64_t{complex.facet_count()}));
    // Formats with one number per tetrahedron call the region a marker.
    auto regions = label_count(document, "region", Location::tetrahedra);
    if (!regions) regions = label_count(document, "marker", Location::tetrahedra);
    if (regions) counts.set("regions", json_number(*regions));
    const auto set_if = [&](const char* name, std::optional<std::uint64_t> count) {
        if (count) counts.set(name, json_number(*count));
    };
    set_if("added", marked_count(document, "source_kind"));
    set_if("balls", marked_count(document, "ball_radius"));
    if (shields > 0) counts.set("shields", json_number(std::uint64_t{shields}));
    set_if("umbilics", marked_count(document, "umbilic_half_turns"));
    set_if("boxes", label_count(document, "box", Location::polygons));
    set_if("clusters", label_count(document, "cluster", Location::polygons));
    return counts.text();
}

}  // namespace

std::string describe_model(const ViewModel& model, PageArrays& arrays) {
    const MeshDocument& document = model.document;
    const PiecewiseLinearComplex& complex = document.complex;
    const Sizes sizes{complex.positions.size(), complex.polygon_count(), complex.segments.size(),
                      document.tetrahedra.size()};
    require_points(model);
    require_polygons(model);
    require_corners(model.name, sizes.vertices, ElementKind::segment, complex.segments);
    require_corners(model.name, sizes.vertices, ElementKind::tetrahedron, document.tetrahedra);
    require_fields(model, sizes);

    const Frame frame(framed_points(document));
    JsonObject entry;
    entry.set("name", json_string(model.name));
    if (!document.remark.empty()) entry.set("remark", json_string(document.remark));
    if (model.is_overlay) entry.set("overlay", "true");
    const std::vector<std::uint32_t> shields = find_shield_edges(document);
    entry.set("counts", describe_counts(document, shields.size() / 2));
    entry.set("lower", json_point(frame.lower)).set("upper", json_point(frame.upper));
    entry.set("origin", json_point(frame.origin)).set("scale", json_number(frame.scale));
    const std::vector<float> positions = positions_in(frame, complex.positions);
    entry.set("positions", arrays.add(std::span<const float>(positions)));
    set_polygons(entry, complex, frame, arrays);
    if (!complex.segments.empty()) {
        const auto segments = flattened(complex.segments);
        entry.set("segments", arrays.add(std::span<const std::uint32_t>(segments)));
    }
    if (!shields.empty()) entry.set("shields", arrays.add(std::span<const std::uint32_t>(shields)));
    if (!document.tetrahedra.empty()) {
        const auto tetrahedra = flattened(document.tetrahedra);
        entry.set("tetrahedra", arrays.add(std::span<const std::uint32_t>(tetrahedra)));
    }
    const std::vector<std::string> fields = describe_fields(document, arrays);
    return entry.set("fields", json_list(fields)).text();
}

}  // namespace certa::page
