// `check`: the four checkers, and what they find as dictionaries. Which one is meant is decided in certa/__init__.py.
#include <certa/implicit_mesh.h>
#include <certa/io.h>

#include "options.h"
#include "parts.h"

namespace certa::python {
namespace {

py::dict side_to_python(const OneSidedDistance& d) {
    py::dict out;
    out["mean"] = d.mean;
    out["rms"] = d.rms;
    out["largest"] = d.largest;
    out["largest_place"] = point(d.largest_place);
    out["bound"] = d.bound;
    return out;
}

py::dict distance_to_python(const SurfaceDistance& d) {
    py::dict out;
    out["to_second"] = side_to_python(d.to_second);
    out["to_first"] = side_to_python(d.to_first);
    out["rms"] = d.rms;
    out["hausdorff"] = d.hausdorff;
    out["hausdorff_bound"] = d.hausdorff_bound;
    out["diagonal"] = d.diagonal;
    out["is_tight"] = d.is_tight;
    return out;
}

py::dict shape_to_python(const SurfaceShape& s) {
    py::list components;
    for (const ComponentShape& part : s.components) {
        py::dict entry;
        entry["genus"] = part.genus;
        entry["boundary_loops"] = part.boundary_loops;
        entry["euler_characteristic"] = part.euler_characteristic;
        components.append(entry);
    }
    py::dict out;
    out["vertices"] = s.vertices;
    out["edges"] = s.edges;
    out["polygons"] = s.polygons;
    out["triangles"] = s.triangles;
    out["quads"] = s.quads;
    out["components"] = components;
    out["boundary_edges"] = s.boundary_edges;
    out["boundary_loops"] = s.boundary_loops;
    out["non_manifold_edges"] = s.non_manifold_edges;
    out["non_manifold_vertices"] = s.non_manifold_vertices;
    out["inconsistent_edges"] = s.inconsistent_edges;
    return out;
}

py::dict creases_to_python(const CreaseCover& c) {
    py::dict out;
    out["edges"] = c.edges;
    out["corners"] = c.corners;
    out["length"] = c.length;
    out["mean_distance"] = c.mean_distance;
    out["largest_distance"] = c.largest_distance;
    out["largest_place"] = point(c.largest_place);
    out["corner_distance"] = c.corner_distance;
    return out;
}

/// The polygons of a document that are faces: of three corners or more.
PolygonMesh surface_of(const MeshDocument& document, const char* name) {
    PolygonMesh mesh;
    const PiecewiseLinearComplex& complex = document.complex;
    mesh.positions = complex.positions;
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const auto begin = complex.corners.begin() + complex.polygon_offsets[p],
                   end = complex.corners.begin() + complex.polygon_offsets[p + 1];
        if (end - begin < 3) continue;
        mesh.corners.insert(mesh.corners.end(), begin, end);
        mesh.offsets.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
    if (mesh.offsets.size() == 1) throw py::value_error(std::string(name) + " has no polygons: there is no surface");
    return mesh;
}

TriangleMesh triangles_of(const MeshDocument& document) {
    const PolygonMesh surface = surface_of(document, "mesh");
    TriangleMesh mesh;
    mesh.positions = surface.positions;
    for (std::size_t p = 0; p + 1 < surface.offsets.size(); ++p) {
        if (surface.offsets[p + 1] - surface.offsets[p] != 3)
            throw py::value_error("polygon " + std::to_string(p + 1) +
                                  " of the mesh is no triangle: functions are for triangles");
        const VertexId* corner = surface.corners.data() + surface.offsets[p];
        mesh.triangles.push_back({corner[0], corner[1], corner[2]});
    }
    return mesh;
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

py::dict function(const py::object& object, const std::string& text_of_function, const Doubles& box,
                  const py::object& progress, unsigned threads) {
    TriangleMesh mesh = triangles_of(document_from(object));
    const double* b = box.data();
    const Point3 low{b[0], b[1], b[2]}, high{b[3], b[4], b[5]};
    const ImplicitMeshCheck check =
        run({progress, threads}, [mesh = std::move(mesh), text_of_function, low, high](const RunControl& control) {
            return check_mesh_against(mesh, text_of_function, low, high, {}, control);
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
    py::dict out;
    out["violations"] = to_python(check.violations);
    out["violation_count"] = check.violation_count;
    out["promises"] = check.promises;
    out["distance"] = distance_to_python(check.distance);
    out["mesh"] = shape_to_python(check.mesh);
    out["input"] = shape_to_python(check.input);
    out["creases"] = creases_to_python(check.creases);
    out["folded_polygons"] = check.folded_polygons;
    out["contacts"] = check.contacts;
    out["possible_contacts"] = check.possible_contacts;
    out["input_contacts"] = check.input_contacts;
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
    module.def("check_surface", &surface);
    module.def("check_implicit", &certificate);
    module.def("check_mesh_against", &function);
}

}  // namespace certa::python
