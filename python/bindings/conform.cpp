// `conform`: the job, then the independent checker on what it made, as the command does.
#include <certa/conforming.h>
#include <certa/io.h>

#include "options.h"
#include "parts.h"

namespace certa::python {
namespace {

/// The input after `repair` and `triangulate`: it is what the mesh conforms to and is checked against.
struct Mended {
    PiecewiseLinearComplex complex;
    std::vector<FacetId> facet_sources;
    std::vector<Defect> repairs;
};

Mended mend(PiecewiseLinearComplex&& complex, ConformOptions& options, const RunControl& control) {
    if (!options.repair && !options.triangulate) return {std::move(complex), {}, {}};
    RepairedComplex repaired = repair_complex(complex, options, control);
    options.repair = options.triangulate = false;
    return {std::move(repaired.complex), std::move(repaired.facet_sources), std::move(repaired.repairs)};
}

struct ConformRun {
    Mended input;
    ConformResult result;
    std::optional<ConformingCheck> check;
};

ConformRun conform_and_check(PiecewiseLinearComplex&& complex, ConformOptions options, bool verify,
                             const RunControl& control) {
    ConformRun finished;
    finished.input = mend(std::move(complex), options, control);
    if (control.cancelled()) return finished;
    finished.result = conform(finished.input.complex, options, control);
    if (!verify || finished.result.outcome != Outcome::done) return finished;
    const ConformingCheckOptions promises{
        .gabriel = options.gabriel, .merge_coplanar = options.merge_coplanar, .planarity = options.planarity};
    finished.check = check_conforming(finished.result.mesh, finished.input.complex, promises, control);
    if (!finished.check->ok() && !control.cancelled())
        throw InternalError("the result failed its own check: " + finished.check->violations.front().promise + ": " +
                            finished.check->violations.front().message);
    return finished;
}

py::dict mesh_to_python(TetMesh&& mesh) {
    py::dict out;
    out["positions"] = take_points(std::move(mesh.positions));
    out["tetrahedra"] = widen_ids(mesh.tetrahedra);
    out["tetrahedron_regions"] = widen_ids(mesh.tetrahedron_regions);
    out["triangles"] = widen_ids(mesh.triangles);
    out["triangle_facets"] = widen_ids(mesh.triangle_facets);
    out["edges"] = widen_ids(mesh.edges);
    out["edge_segments"] = widen_ids(mesh.edge_segments);
    const std::size_t count = mesh.vertex_sources.size();
    std::vector<std::uint8_t> origins(count);
    std::vector<std::uint32_t> indices(count);
    for (std::size_t i = 0; i < count; ++i) {
        origins[i] = static_cast<std::uint8_t>(mesh.vertex_sources[i].origin);
        indices[i] = mesh.vertex_sources[i].index;
    }
    out["vertex_origins"] = take<std::uint8_t>(std::move(origins));
    out["vertex_source_indices"] = widen_ids(indices);
    return out;
}

py::dict conform_to_python(const py::object& object, const py::dict& given, bool verify, const std::string& reference,
                           const py::object& progress, unsigned threads) {
    ConformOptions options;
    set_options(frontend::conform_options(), options, given);
    PiecewiseLinearComplex complex = document_from(object).complex;
    ConformRun finished =
        run({progress, threads}, [complex = std::move(complex), options, verify](const RunControl& control) mutable {
            return conform_and_check(std::move(complex), options, verify, control);
        });
    ConformResult& result = finished.result;
    MeshDocument document =
        make_document(result.mesh, finished.input.complex, reference == "marker" ? Reference::marker : Reference::id,
                      result.region_attributes);
    if (result.outcome != Outcome::done)
        document.remark = std::string("partial result, not conforming: ") + name_of(result.outcome);
    result.repairs.insert(result.repairs.begin(), finished.input.repairs.begin(), finished.input.repairs.end());
    py::dict out = mesh_to_python(std::move(result.mesh));
    out["document"] = to_python(std::move(document));
    out["outcome"] = name_of(result.outcome);
    out["segments"] = widen_ids(result.segments);
    out["region_attributes"] = take<double>(std::move(result.region_attributes));
    out["facet_sources"] = widen_ids(finished.input.facet_sources);
    out["warnings"] = to_python(result.warnings);
    out["repairs"] = to_python(result.repairs);
    out["obstacles"] = to_python(result.obstacles);
    out["statistics"] = statistics_of(result.statistics);
    out["check"] = finished.check ? py::object(to_python(*finished.check)) : py::none();
    MeshDocument input;
    input.complex = std::move(finished.input.complex);
    out["input"] = to_python(std::move(input));
    return out;
}

}  // namespace

py::dict to_python(const ConformingCheck& check) {
    py::dict out = record_of(check);
    out["violations"] = to_python(check.violations);
    out["violation_count"] = check.violation_count;
    return out;
}

void add_conform(py::module_& module) { module.def("conform", &conform_to_python); }

}  // namespace certa::python
