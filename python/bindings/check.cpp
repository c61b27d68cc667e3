// `check`: the five checkers, and what they find as dictionaries. Which one is meant is decided in certa/__init__.py.
#include <certa/implicit_mesh.h>
#include <certa/io.h>

#include "options.h"
#include "parts.h"

namespace certa::python {
namespace {

py::dict distance_to_python(const SurfaceDistance& d) {
    py::dict out = record_of(d);
    out["to_second"] = record_of(d.to_second);
    out["to_first"] = record_of(d.to_first);
    return out;
}

py::dict shape_to_python(const SurfaceShape& s) {
    py::list components;
    for (const ComponentShape& part : s.components) components.append(record_of(part));
    py::dict out = record_of(s);
    out["components"] = components;
    return out;
}

PolygonMesh surface_of(const MeshDocument& document, const char* name) {
    PolygonMesh mesh = make_polygon_mesh(document);
    if (mesh.offsets.size() == 1) throw py::value_error(std::string(name) + " has no polygons: there is no surface");
    return mesh;
}

TriangleMesh triangles_of(const MeshDocument& document) {
    surface_of(document, "mesh");
    try {
        return make_triangle_mesh(document);
    } catch (const IoError& error) {  // no file is at fault here
        throw py::value_error("mesh: " + error.reason() + ", to be compared with a function");
    }
}

py::dict conforming(const py::object& object, const py::object& against, const py::dict& given, bool repair,
                    bool triangulate, const py::object& progress, unsigned threads) {
    ConformingCheckOptions options;
    set_options(frontend::conforming_check_options(), options, given);
    TetMesh mesh = make_tet_mesh(document_from(object));
    PiecewiseLinearComplex complex = document_from(against).complex;
    return to_python(run({progress, threads}, [mesh = std::move(mesh), complex = std::move(complex), options, repair,
                                               triangulate](const RunControl& control) {
        if (!repair && !triangulate) return check_conforming(mesh, complex, options, control);
        const ConformOptions repairs{.triangulate = triangulate, .repair = repair, .planarity = options.planarity};
        return check_conforming(mesh, repair_complex(complex, repairs, control).complex, options, control);
    }));
}

py::dict alone(const py::object& object, const py::dict& given, const py::object& progress, unsigned threads) {
    ConformingCheckOptions options;
    set_options(frontend::conforming_check_options(), options, given);
    TetMesh mesh = make_tet_mesh(document_from(object));
    return to_python(run({progress, threads}, [mesh = std::move(mesh), options](const RunControl& control) {
        return check_delaunay_mesh(mesh, options, control);
    }));
}

py::dict surface(const py::object& object, const py::object& against, const py::dict& given, const py::object& progress,
                 unsigned threads) {
    SurfaceCheckOptions options;
    set_options(frontend::surface_check_options(), options, given);
    PolygonMesh mesh = surface_of(document_from(object), "mesh");
    const MeshDocument reference = document_from(against);
    options.features = reference.complex.segments;
    PolygonMesh input = surface_of(reference, "against");
    return to_python(run({progress, threads},
                         [mesh = std::move(mesh), input = std::move(input), options](const RunControl& control) {
                             return check_surface(mesh, input, options, control);
                         }));
}

py::dict certificate(const py::object& object, const std::string& function, const std::string& proof,
                     const py::object& progress, unsigned threads) {
    TriangleMesh mesh = triangles_of(document_from(object));
    return to_python(run({progress, threads}, [mesh = std::move(mesh), function, proof](const RunControl& control) {
        return check_implicit(mesh, function, proof, control);
    }));
}

py::dict function(const py::object& object, const std::string& text_of_function, const py::object& box,
                  const py::object& progress, unsigned threads) {
    TriangleMesh mesh = triangles_of(document_from(object));
    std::array<Point3, 2> around = find_box_around(mesh);
    if (!box.is_none()) {
        const auto corners = py::cast<Doubles>(box);
        const double* b = corners.data();
        around = {{{b[0], b[1], b[2]}, {b[3], b[4], b[5]}}};
    }
    const ImplicitMeshCheck check =
        run({progress, threads}, [mesh = std::move(mesh), text_of_function, around](const RunControl& control) {
            return check_mesh_against(mesh, text_of_function, around[0], around[1], {}, control);
        });
    py::dict out;
    out["verdict"] = name_of(check.verdict);
    out["reasons"] = check.reasons;
    out["triangles"] = widen_ids(check.triangles);
    out["triangle_count"] = check.triangle_count;
    out["surface_known"] = check.surface_known;
    out["mesh_genera"] = check.mesh_genera;
    out["surface_genera"] = check.surface_genera;
    out["faces_positive"] = check.faces_positive;
    out["outcome"] = name_of(check.outcome);
    out["obstacles"] = to_python(check.obstacles);
    out["low"] = point(check.low);
    out["high"] = point(check.high);
    return out;
}

}  // namespace

py::dict to_python(const SurfaceCheck& check) {
    py::dict out = record_of(check);
    out["violations"] = to_python(check.violations);
    out["violation_count"] = check.violation_count;
    out["promises"] = check.promises;
    out["distance"] = distance_to_python(check.distance);
    out["mesh"] = shape_to_python(check.mesh);
    out["input"] = shape_to_python(check.input);
    out["creases"] = record_of(check.creases);
    return out;
}

py::dict to_python(const ImplicitCheck& check) {
    py::list violations;
    for (const std::string& violation : check.violations) violations.append(text(violation));
    py::dict out;
    out["violations"] = violations;
    out["violation_count"] = check.violation_count;
    out["verdict"] = name_of(check.verdict);
    out["isotopic"] = check.isotopic;
    out["hausdorff"] = to_python(check.hausdorff);
    out["genera"] = check.genera;
    out["loops"] = check.loops;
    out["leaves_checked"] = check.leaves_checked;
    out["marks_checked"] = check.marks_checked;
    out["triangles_checked"] = check.triangles_checked;
    return out;
}

void add_checks(py::module_& module) {
    module.def("check_conforming", &conforming);
    module.def("check_delaunay_mesh", &alone);
    module.def("check_surface", &surface);
    module.def("check_implicit", &certificate);
    module.def("check_mesh_against", &function);
}

}  // namespace certa::python
