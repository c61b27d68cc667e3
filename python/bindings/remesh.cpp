// `remesh`: the job, then the independent checker on what it made, as the command does.
#include <certa/curvature.h>
#include <certa/remeshing.h>

#include "options.h"
#include "parts.h"

namespace certa::python {
namespace {

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
    const WeldedSurface welded = weld_surface(finished.input.mesh);  // what the result is a result of
    for (Edge& edge : promises.features)
        for (VertexId& v : edge)
            if (index_of(v) < welded.numbers.size()) v = welded.numbers[index_of(v)];
    finished.check = check_surface(finished.result.mesh, make_polygon_mesh(welded.mesh), promises, control);
    return finished;
}

py::list lines_to_python(std::vector<CurvatureLine>&& lines) {
    py::list out;
    for (CurvatureLine& line : lines)
        out.append(py::make_tuple(line.maximum, line.closed, take_points(std::move(line.points))));
    return out;
}

py::dict remesh_to_python(const py::object& object, const py::dict& given, const Integers& features,
                          const Integers& guides, bool placement, bool lines, bool verify, const py::object& progress,
                          unsigned threads) {
    RemeshOptions options;
    set_options(frontend::remesh_options(), options, given);
    options.placement = placement;
    options.lines = lines;
    MeshDocument document = document_from(object);
    options.features = elements_from<Edge>(features, ElementKind::edge, document.complex.positions.size());
    options.guides = elements_from<Edge>(guides, ElementKind::edge, document.complex.positions.size());
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
