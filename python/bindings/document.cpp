// Documents in and out, files among them. The object on Python's side is certa.MeshDocument: arrays that users may
// look at and change; what they mean is checked whenever one is handed over.
#include <certa/io.h>

#include "frontend/option_table.h"
#include "options.h"
#include "parts.h"

namespace certa::python {
namespace {

constexpr const char* location_names[] = {"vertices", "polygons", "segments", "tetrahedra"};

std::size_t count_at(const MeshDocument& document, Location location) {
    switch (location) {
        case Location::vertices:
            return document.complex.positions.size();
        case Location::polygons:
            return document.complex.polygon_count();
        case Location::segments:
            return document.complex.segments.size();
        default:
            return document.tetrahedra.size();
    }
}

void add_fields(MeshDocument& document, Location location, const py::dict& fields) {
    for (const auto& [name, values] : fields) {
        Field& field = document.fields.emplace_back();
        field.name = py::cast<std::string>(name);
        field.location = location;
        const auto array = py::reinterpret_borrow<py::array>(values);
        field.components = array.ndim() == 1 ? 1 : static_cast<std::uint32_t>(array.shape(1));
        if (static_cast<std::size_t>(array.shape(0)) != count_at(document, location))
            throw py::value_error("field '" + field.name + "' has " + std::to_string(array.shape(0)) + " rows for " +
                                  std::to_string(count_at(document, location)) + " " +
                                  location_names[static_cast<std::size_t>(location)]);
        if (array.dtype().kind() == 'f') {
            const Doubles doubles(array);
            field.values = std::vector<double>(doubles.data(), doubles.data() + doubles.size());
        } else {
            const Integers integers(array);
            field.values = std::vector<std::int64_t>(integers.data(), integers.data() + integers.size());
        }
    }
}

std::vector<std::int32_t> markers_from(const Integers& array, std::size_t count, const char* what) {
    const auto size = static_cast<std::size_t>(array.size());
    if (size != 0 && size != count)
        throw py::value_error(std::string(what) + ": " + std::to_string(size) + " markers for " +
                              std::to_string(count) + " elements");
    std::vector<std::int32_t> markers(size);
    for (std::size_t i = 0; i < size; ++i) {
        markers[i] = static_cast<std::int32_t>(array.data()[i]);
        if (markers[i] != array.data()[i])
            throw py::value_error(std::string(what) + ": " + std::to_string(array.data()[i]) +
                                  " is beyond 32 bits, which is what markers have");
    }
    return markers;
}

void add_shape(const py::handle& object, MeshDocument& document) {
    PiecewiseLinearComplex& complex = document.complex;
    complex.positions = points_from(py::cast<Doubles>(object.attr("positions")));
    const std::size_t count = complex.positions.size();
    const auto corners = py::cast<Integers>(object.attr("corners"));
    complex.polygon_offsets = offsets_from(py::cast<Integers>(object.attr("polygon_offsets")),
                                           static_cast<std::size_t>(corners.size()), "polygon_offsets");
    for (const std::uint32_t id : vertices_from(corners, ElementKind::polygon, count, complex.polygon_offsets, 0))
        complex.corners.push_back(VertexId{id});
    complex.facet_offsets =
        offsets_from(py::cast<Integers>(object.attr("facet_offsets")), complex.polygon_count(), "facet_offsets");
    complex.facet_holes = points_from(py::cast<Doubles>(object.attr("facet_holes")));
    complex.hole_offsets =
        offsets_from(py::cast<Integers>(object.attr("hole_offsets")), complex.facet_holes.size(), "hole_offsets");
    if (complex.hole_offsets.size() != complex.facet_offsets.size())
        throw py::value_error("hole_offsets must have one entry per facet and one more");
    complex.segments = elements_from<Edge>(py::cast<Integers>(object.attr("segments")), ElementKind::segment, count);
    document.tetrahedra =
        elements_from<Tetrahedron>(py::cast<Integers>(object.attr("tetrahedra")), ElementKind::tetrahedron, count);
}

std::optional<Format> format_from(const py::object& name) {
    if (name.is_none()) return std::nullopt;
    const auto given = py::cast<std::string>(name);
    const std::optional<Format> format = format_named(given);
    if (!format)
        throw frontend::OptionError(
            "format: '" + given +
            "' is not a format; formats are off, obj, ply, stl, poly, smesh, node, medit, vtu, msh and csv");
    return format;
}

py::dict read(const std::string& path, const py::object& format) {
    const ReadOptions options{.format = format_from(format)};
    return to_python(run({}, [path, options](const RunControl&) { return read_document(path, options); }));
}

void write(const std::string& path, const py::object& object, const py::object& format, const py::dict& given) {
    frontend::OutputOptions output;
    set_options(frontend::output_options().first(2), output, given);
    MeshDocument document = document_from(object);
    const WriteOptions options{
        .format = format_from(format), .encoding = output.encoding, .msh_version_2 = output.msh_version_2};
    run({.may_leave = false}, [path, document = std::move(document), options](const RunControl&) {
        write_document(path, document, options);
        return true;
    });
}

}  // namespace

py::dict fields_to_python(std::vector<Field>&& fields) {
    py::dict places;
    for (const char* name : location_names) places[name] = py::dict();
    for (Field& field : fields) {
        const py::ssize_t width = field.components == 1 ? 0 : static_cast<py::ssize_t>(field.components);
        auto place = places[location_names[static_cast<std::size_t>(field.location)]].cast<py::dict>();
        place[text(field.name)] = std::visit(
            [&](auto& values) {
                using Number = typename std::decay_t<decltype(values)>::value_type;
                py::array array = take<Number>(std::move(values));
                return width == 0 ? array : array.reshape({array.size() / width, width});
            },
            field.values);
    }
    return places;
}

MeshDocument document_from(py::handle object) {
    MeshDocument document;
    add_shape(object, document);
    PiecewiseLinearComplex& complex = document.complex;
    const auto markers = [&](const char* name, std::size_t count) {
        return markers_from(py::cast<Integers>(object.attr(name)), count, name);
    };
    complex.point_markers = markers("point_markers", complex.positions.size());
    complex.segment_markers = markers("segment_markers", complex.segments.size());
    complex.facet_markers = markers("facet_markers", complex.facet_count());
    complex.region_holes = points_from(py::cast<Doubles>(object.attr("region_holes")));
    const auto seeds = py::cast<Doubles>(object.attr("region_seeds"));
    for (py::ssize_t i = 0; i < seeds.shape(0); ++i)
        complex.region_seeds.push_back(
            {{seeds.at(i, 0), seeds.at(i, 1), seeds.at(i, 2)}, seeds.at(i, 3), seeds.at(i, 4)});
    const auto fields = py::cast<py::dict>(object.attr("fields"));
    for (std::size_t i = 0; i < std::size(location_names); ++i)
        if (fields.contains(location_names[i]))
            add_fields(document, static_cast<Location>(i), fields[location_names[i]].cast<py::dict>());
    const py::object reference = object.attr("reference");
    if (!reference.is_none())
        document.reference = py::cast<std::string>(reference) == "marker" ? Reference::marker : Reference::id;
    document.remark = py::cast<std::string>(object.attr("remark"));
    return document;
}

py::dict to_python(MeshDocument&& document) {
    PiecewiseLinearComplex& complex = document.complex;
    py::dict out;
    out["positions"] = take_points(std::move(complex.positions));
    out["corners"] = widen_ids(complex.corners);
    out["polygon_offsets"] = widen_ids(complex.polygon_offsets);
    out["facet_offsets"] = widen_ids(complex.facet_offsets);
    out["facet_holes"] = take_points(std::move(complex.facet_holes));
    out["hole_offsets"] = widen_ids(complex.hole_offsets);
    out["segments"] = widen_ids(complex.segments);
    out["tetrahedra"] = widen_ids(document.tetrahedra);
    out["point_markers"] = take<std::int32_t>(std::move(complex.point_markers));
    out["segment_markers"] = take<std::int32_t>(std::move(complex.segment_markers));
    out["facet_markers"] = take<std::int32_t>(std::move(complex.facet_markers));
    out["region_holes"] = take_points(std::move(complex.region_holes));
    static_assert(sizeof(RegionSeed) == 5 * sizeof(double));
    out["region_seeds"] = take<double>(std::move(complex.region_seeds), 5);
    out["fields"] = fields_to_python(std::move(document.fields));
    out["reference"] = document.reference
                           ? py::object(py::str(*document.reference == Reference::marker ? "marker" : "id"))
                           : py::none();
    out["remark"] = text(document.remark);
    py::list notes;
    for (const std::string& note : document.notes) notes.append(text(note));
    out["notes"] = notes;
    return out;
}

void add_documents(py::module_& module) {
    module.def("read", &read);
    module.def("write", &write);
}

}  // namespace certa::python
