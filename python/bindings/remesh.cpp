// `remesh`: the job, then the independent checker on what it made, as the command does.
#include <certa/curvature.h>
#include <certa/remeshing.h>

#include "options.h"
#include "parts.h"

namespace certa::python {
namespace {

py::dict statistics_of(const RemeshStatistics& s) {
    py::dict out;
    out["input_vertices"] = s.input_vertices;
    out["input_triangles"] = s.input_triangles;
    out["components"] = s.components;
    out["euler_characteristic"] = s.euler_characteristic;
    out["boundary_loops"] = s.boundary_loops;
    out["feature_edges"] = s.feature_edges;
    out["feature_curves"] = s.feature_curves;
    out["corners"] = s.corners;
    out["unused_vertices"] = s.unused_vertices;
    out["degenerate_triangles"] = s.degenerate_triangles;
    out["flipped_triangles"] = s.flipped_triangles;
    out["non_manifold_edges"] = s.non_manifold_edges;
    out["split_vertices"] = s.split_vertices;
    out["wedges"] = s.wedges;
    out["trisectors"] = s.trisectors;
    out["umbilic_half_turns"] = s.umbilic_half_turns;
    out["lines_min"] = s.lines_min;
    out["lines_max"] = s.lines_max;
    out["closed_lines"] = s.closed_lines;
    out["spacing_error"] = s.spacing_error;
    out["smoothing"] = s.smoothing;
    out["rounds"] = s.rounds;
    out["mended_regions"] = s.mended_regions;
    out["mended_triangles"] = s.mended_triangles;
    out["distance_bound"] = s.distance_bound;
    out["vertices"] = s.vertices;
    out["faces"] = s.faces;
    out["triangles"] = s.triangles;
    out["quads"] = s.quads;
    out["t_nodes"] = s.t_nodes;
    out["quad_share_with_t"] = s.quad_share_with_t;
    out["quad_share_without_t"] = s.quad_share_without_t;
    out["notes"] = s.notes;
    out["stage_seconds"] = to_python(s.stage_seconds);
    return out;
}

PolygonMesh polygons_of(const TriangleMesh& mesh) {
    PolygonMesh polygons;
    polygons.positions = mesh.positions;
    for (const Triangle& t : mesh.triangles) {
        polygons.corners.insert(polygons.corners.end(), t.begin(), t.end());
        polygons.offsets.push_back(static_cast<std::uint32_t>(polygons.corners.size()));
    }
    return polygons;
}

struct RemeshRun {
    TriangulatedSurface input;
    RemeshResult result;
    std::optional<SurfaceCheck> check;
};

RemeshRun remesh_and_check(const MeshDocument& document, RemeshOptions options, bool verify,
                           const RunControl& control) {
    RemeshRun finished;
    finished.input = triangulate(document);
    options.features.insert(options.features.end(), document.complex.segments.begin(), document.complex.segments.end());
    finished.result = remesh(finished.input.mesh, options, control);
    if (!verify || finished.result.outcome != Outcome::done) return finished;
    SurfaceCheckOptions promises;
    promises.feature_angle_radians = options.feature_angle_radians;
    promises.features = options.features;
    if (options.subdivide == 0) promises.error = options.error;  // subdivision smooths: no distance is promised then
    finished.check = check_surface(finished.result.mesh, polygons_of(finished.input.mesh), promises, control);
    return finished;
}

py::list lines_to_python(std::vector<CurvatureLine>&& lines) {
    py::list out;
    for (CurvatureLine& line : lines)
        out.append(py::make_tuple(line.maximum, line.closed, take_points(std::move(line.points))));
    return out;
}

py::dict remesh_to_python(const py::object& object, const py::dict& given, const Integers& features, bool placement,
                          bool lines, bool verify, const py::object& progress, unsigned threads) {
    RemeshOptions options;
    set_options(frontend::remesh_options(), options, given);
    options.placement = placement;
    options.lines = lines;
    MeshDocument document = document_from(object);
    options.features = elements_from<Edge>(features, ElementKind::edge, document.complex.positions.size());
    RemeshRun finished =
        run({progress, threads}, [document = std::move(document), options, verify](const RunControl& control) {
            return remesh_and_check(document, options, verify, control);
        });
    RemeshResult& result = finished.result;
    py::dict out;
    out["outcome"] = name_of(result.outcome);
    out["positions"] = take_points(std::move(result.mesh.positions));
    out["corners"] = widen_ids(result.mesh.corners);
    out["polygon_offsets"] = widen_ids(result.mesh.offsets);
    out["feature_edges"] = widen_ids(result.feature_edges);
    out["feature_curves"] = widen_ids(result.feature_curves);
    out["lines"] = lines_to_python(std::move(result.lines));
    py::list umbilics;
    for (const Umbilic& u : result.umbilics)
        umbilics.append(py::make_tuple(point(u.place), finished.input.source_faces[u.face], u.half_turns));
    out["umbilics"] = umbilics;
    out["statistics"] = statistics_of(result.statistics);
    out["check"] = finished.check ? py::object(to_python(*finished.check)) : py::none();
    return out;
}

}  // namespace

void add_remesh(py::module_& module) { module.def("remesh", &remesh_to_python); }

}  // namespace certa::python
