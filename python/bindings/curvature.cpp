// `curvature`: of all vertices, as the fields that files would carry, or the measures of one region.
#include <certa/curvature.h>

#include <algorithm>

#include "options.h"
#include "parts.h"

namespace certa::python {
namespace {

py::array_t<double> tensor_to_python(const SymmetricTensor3& t) {
    return py::array_t<double>(py::ssize_t{6}, std::array{t.xx, t.xy, t.xz, t.yy, t.yz, t.zz}.data());
}

py::dict measures_to_python(const CurvatureMeasures& m) {
    py::dict out;
    out["area"] = m.area;
    out["gaussian"] = m.gaussian;
    out["mean"] = m.mean;
    out["tensor"] = tensor_to_python(m.tensor);
    out["swapped_tensor"] = tensor_to_python(m.swapped_tensor);
    out["edge_mass"] = m.edge_mass;
    out["vertex_mass"] = m.vertex_mass;
    return out;
}

py::dict bound_to_python(const ApproximationBound& b) {
    py::dict out;
    out["squared_radii"] = b.squared_radii;
    out["rim_radii"] = b.rim_radii;
    out["epsilon"] = b.epsilon;
    out["mass"] = b.mass;
    out["rim_mass"] = b.rim_mass;
    out["max_curvature"] = b.max_curvature;
    out["curvature_estimated"] = b.curvature_estimated;
    out["relative_height"] = b.relative_height;
    out["hypothesis_holds"] = b.hypothesis_holds;
    out["height"] = b.height;
    out["normal_angle_radians"] = b.normal_angle_radians;
    out["gaussian"] = to_python(b.gaussian);
    out["mean"] = to_python(b.mean);
    out["tensor"] = to_python(b.tensor);
    out["swapped_tensor"] = to_python(b.swapped_tensor);
    out["calibrated"] = b.calibrated;
    return out;
}

/// With what the choice of a size has found.
py::dict statistics_with_choice(const CurvatureStatistics& s) {
    py::dict out = statistics_of(s);
    out["noise"] = s.noise;
    out["choice"] = s.choice;
    out["radius"] = s.radius;
    out["fallbacks"] = s.fallbacks;
    return out;
}

std::optional<std::int64_t> region_number(const py::object& solid) {
    if (solid.is_none()) return std::nullopt;
    return py::cast<std::int64_t>(solid);
}

CurvatureOptions options_from(const py::dict& given) {
    CurvatureOptions options;
    const auto asked = [&](const char* name) { return given.contains(name) && !given[name].is_none(); };
    if (asked("ball") && asked("geodesic"))
        throw frontend::OptionError("ball and geodesic exclude each other: give one of them");
    set_options(frontend::curvature_options(), options, given);
    return options;
}

py::dict curvature(const py::object& object, const py::dict& given, const py::object& solid, const py::object& progress,
                   unsigned threads) {
    const CurvatureOptions options = options_from(given);
    MeshDocument document = document_from(object);
    const std::optional<std::int64_t> number = region_number(solid);
    auto [surface, result] =
        run({progress, threads}, [document = std::move(document), number, options](const RunControl& control) {
            TriangulatedSurface made = triangulate(document, number);
            CurvatureResult curvatures = compute_curvature(made.mesh, options, control);
            return std::pair{std::move(made), std::move(curvatures)};
        });
    py::dict out;
    out["fields"] = fields_to_python(make_fields(result))["vertices"];
    out["outcome"] = name_of(result.outcome);
    out["triangles"] = widen_ids(surface.mesh.triangles);
    out["source_faces"] = widen_ids(surface.source_faces);
    out["total"] = measures_to_python(result.total);
    out["euler_characteristic"] = result.euler_characteristic;
    out["statistics"] = statistics_with_choice(result.statistics);
    out["statistics"]["estimator"] =
        frontend::value_of(*std::find_if(frontend::curvature_options().begin(), frontend::curvature_options().end(),
                                         [](const auto& option) { return option.name == "estimator"; }),
                           CurvatureOptions{.estimator = result.statistics.estimator});
    return out;
}

/// The triangles of the polygons that `faces` lists.
Region faces_region(const TriangulatedSurface& surface, const Integers& faces, std::size_t count) {
    std::vector<bool> named(count);
    for (const std::uint32_t face : vertices_from(faces, ElementKind::polygon, count, {}, 1)) named[face] = true;
    std::vector<std::uint32_t> triangles;
    for (std::size_t t = 0; t < surface.source_faces.size(); ++t)
        if (named[surface.source_faces[t]]) triangles.push_back(static_cast<std::uint32_t>(t));
    return make_face_region(std::move(triangles));
}

Region region_from(const py::object& region, const TriangulatedSurface& surface, const MeshDocument& document) {
    if (!py::isinstance<py::str>(region))
        return faces_region(
            surface, py::cast<Integers>(region),
            document.tetrahedra.empty() ? document.complex.polygon_count() : document.tetrahedra.size());
    const std::string given = py::cast<std::string>(region);
    return frontend::parse_region(given, [](const std::string&) -> std::vector<std::uint32_t> {
        throw frontend::OptionError("region: faces come as an array of their indices, not as a file");
    });
}

py::dict region_measures(const py::object& object, const py::dict& given, const py::object& solid,
                         const py::object& region, const py::object& progress, unsigned threads) {
    const CurvatureOptions asked = options_from(given);
    const MeshDocument document = document_from(object);
    TriangulatedSurface surface = triangulate(document, region_number(solid));
    Region place = region_from(region, surface, document);
    RegionOptions options;
    options.rim = asked.rim == Rim::dual ? Rim::half : asked.rim;
    options.bounds = asked.bounds;
    options.max_curvature = asked.max_curvature;
    const RegionResult result = run({progress, threads}, [surface = std::move(surface), place = std::move(place),
                                                          options](const RunControl& control) {
        return compute_region_measures(surface.mesh, place, options, control);
    });
    py::dict out;
    out["outcome"] = name_of(result.outcome);
    out["measures"] = measures_to_python(result.measures);
    out["bound"] = result.bound ? py::object(bound_to_python(*result.bound)) : py::none();
    out["statistics"] = statistics_with_choice(result.statistics);
    return out;
}

}  // namespace

void add_curvature(py::module_& module) {
    module.def("curvature", &curvature);
    module.def("region_measures", &region_measures);
    py::dict flags;
    flags["unused"] = vertex_flags::unused;
    flags["border"] = vertex_flags::border;
    flags["non_manifold"] = vertex_flags::non_manifold;
    flags["excluded"] = vertex_flags::excluded;
    flags["flat_face"] = vertex_flags::flat_face;
    flags["fallback"] = vertex_flags::fallback;
    flags["undefined"] = vertex_flags::undefined;
    module.attr("vertex_flags") = flags;
}

}  // namespace certa::python
