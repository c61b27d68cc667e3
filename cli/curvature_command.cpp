// `certa curvature INPUT [-o OUT]`: the mesh with curvature fields, or the measures of one region.
//
// Plan: read, make the surface (polygons cut into triangles, or the boundary of tetrahedra), compute, report totals,
// write the input's own mesh with the fields added. With --region there are no fields: the report is the result.
#include <certa/curvature.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>

#include "commands.h"
#include "interrupt.h"
#include "report.h"
#include "session.h"

namespace certa::cli {
namespace {

struct CurvatureArguments {
    CommonFlags common;
    FileArgument input, output;
    CurvatureOptions options;
    frontend::OutputOptions output_options;
    std::string region;
    std::optional<std::int64_t> solid;
};

/// Formats that carry fields of vertices by name.
void require_field_format(const FileArgument& file) {
    const std::optional<Format> format = file.format ? file.format : format_of(file.path);
    if (format &&
        (*format == Format::ply || *format == Format::vtu || *format == Format::csv || *format == Format::msh))
        return;
    if (!format) return;  // told by require_writable
    throw UsageError(file.path + ": " + name_of(*format) + " cannot carry curvature fields; use .ply, .vtu or .csv");
}

/// Whole numbers that count from 1, separated by blanks or lines; `#` starts a comment.
std::vector<std::uint32_t> read_faces(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw IoError(path, 0, "cannot be read");
    std::vector<std::uint32_t> faces;
    std::string line;
    for (std::uint64_t number = 1; std::getline(file, line); ++number) {
        const char* at = line.data();
        const char* end = line.data() + std::min(line.find('#'), line.size());
        while (at != end) {
            if (*at == ' ' || *at == '\t' || *at == '\r' || *at == ',') {
                ++at;
                continue;
            }
            std::uint32_t face = 0;
            const auto [next, error] = std::from_chars(at, end, face);
            if (error != std::errc() || face == 0) throw IoError(path, number, "expected the number of a face, from 1");
            faces.push_back(face - 1);
            at = next;
        }
    }
    return faces;
}

Json json_of(const SymmetricTensor3& t) { return Json::array({t.xx, t.xy, t.xz, t.yy, t.yz, t.zz}); }

Json json_of(const CurvatureMeasures& m) {
    const TubeFormula tube = compute_tube_formula(m);
    return {{"area", m.area},
            {"mean", m.mean},
            {"gaussian", m.gaussian},
            {"tensor", json_of(m.tensor)},
            {"swapped_tensor", json_of(m.swapped_tensor)},
            {"edge_mass", m.edge_mass},
            {"vertex_mass", m.vertex_mass},
            {"tube_formula", {{"linear", tube.linear}, {"quadratic", tube.quadratic}, {"cubic", tube.cubic}}}};
}

Json json_of(const ApproximationBound& b) {
    Json json = {{"squared_radii", b.squared_radii},
                 {"rim_radii", b.rim_radii},
                 {"epsilon", b.epsilon},
                 {"mass", b.mass},
                 {"rim_mass", b.rim_mass},
                 {"max_curvature", b.max_curvature},
                 {"max_curvature_from", b.curvature_estimated ? "estimated" : "user"},
                 {"relative_height", b.relative_height},
                 {"hypothesis", b.hypothesis_holds ? "holds" : "violated"},
                 {"calibrated", b.calibrated}};
    if (b.hypothesis_holds) json["height"] = b.height, json["normal_angle_radians"] = b.normal_angle_radians;
    const auto add = [&](const char* key, const std::optional<double>& value) {
        json[key] = value ? Json(*value) : Json(nullptr);
    };
    add("gaussian", b.gaussian), add("mean", b.mean), add("tensor", b.tensor), add("swapped_tensor", b.swapped_tensor);
    return json;
}

void warn_of(Session& session, const CurvatureStatistics& s) {
    if (s.excluded_edges > 0)
        session.warn(counted(s.excluded_edges, "edge is", "edges are") +
                     " left out: the faces around do not agree on a side, so there is no signed angle");
    if (s.repeated_vertices > 0)
        session.warn(counted(s.repeated_vertices, "triangle names", "triangles name") + " a vertex twice: left out");
    if (s.flat_triangles > 0)
        session.warn(counted(s.flat_triangles, "triangle has", "triangles have") +
                     " no area: their angles count, their edges do not");
}

void say_measures(Session& session, const CurvatureMeasures& m) {
    using frontend::text_of;
    session.say("area         " + text_of(m.area));
    session.say("mean         " + text_of(m.mean) + " (integral of k1 + k2)");
    session.say("gaussian     " + text_of(m.gaussian) + " = " + text_of(m.gaussian / (2.0 * std::numbers::pi)) +
                " x 2 pi");
}

/// Options that do not go together are the command line's fault, not the mesh's.
template <class Work>
auto refusing_options(const Work& work) {
    try {
        return work();
    } catch (const InputError& error) {
        for (const Defect& defect : error.defects())
            if (defect.kind == DefectKind::option_out_of_range) throw UsageError(defect.message);
        throw;
    }
}

ExitCode measure_region(Session& session, const CurvatureArguments& arguments, const TriangulatedSurface& surface,
                        const Region& region) {
    // Faces are those of the file: a polygon stands for its triangles.
    RegionOptions options;
    options.rim = arguments.options.rim == Rim::dual ? Rim::half : arguments.options.rim;
    options.bounds = arguments.options.bounds;
    options.max_curvature = arguments.options.max_curvature;
    const RegionResult result = session.timed("curvature", [&] {
        const GracefulScope graceful;
        return refusing_options(
            [&] { return compute_region_measures(surface.mesh, region, options, session.control()); });
    });
    if (result.outcome == Outcome::cancelled) return ExitCode::interrupted;
    session.report()["region"]["text"] = arguments.region;
    session.report()["region"]["measures"] = json_of(result.measures);
    session.report()["statistics"] = record_of(result.statistics);
    if (result.bound) session.report()["region"]["bound"] = json_of(*result.bound);
    warn_of(session, result.statistics);
    say_measures(session, result.measures);
    if (result.bound) {
        const ApproximationBound& b = *result.bound;
        const std::string kappa =
            frontend::text_of(b.max_curvature) + (b.curvature_estimated ? " (estimated)" : " (given)");
        if (b.mean)
            session.say("bound        " + frontend::text_of(*b.mean) +
                        " on the mean measure of the triangles that meet the region, " +
                        (b.curvature_estimated ? "if the largest curvature is " : "proved for the largest curvature ") +
                        kappa);
        else
            session.say("bound        hypothesis violated: triangles are too large for the largest curvature " + kappa);
        session.say("calibrated   " + frontend::text_of(b.calibrated) + " (Theorem 13's form, constant not proved)");
    }
    return ExitCode::done;
}

/// Face numbers of the file as triangles of the surface.
std::vector<std::uint32_t> triangles_of(const TriangulatedSurface& surface, const std::vector<std::uint32_t>& faces,
                                        const std::string& path) {
    std::vector<bool> named;
    for (const std::uint32_t face : faces) {
        if (face >= named.size()) named.resize(std::size_t{face} + 1);
        named[face] = true;
    }
    std::vector<std::uint32_t> triangles;
    std::uint32_t largest = 0;
    for (std::size_t t = 0; t < surface.source_faces.size(); ++t) {
        const std::uint32_t source = surface.source_faces[t];
        largest = std::max(largest, source);
        if (source < named.size() && named[source]) triangles.push_back(static_cast<std::uint32_t>(t));
    }
    if (named.size() > std::size_t{largest} + 1)
        throw IoError(path, 0,
                      "names face " + std::to_string(named.size()) + " of " + std::to_string(largest + std::size_t{1}));
    return triangles;
}

void report_result(Session& session, const CurvatureResult& result) {
    Json& report = session.report();
    report["total"] = json_of(result.total);
    report["euler_characteristic"] = result.euler_characteristic;
    report["statistics"] = record_of(result.statistics);
    report["estimator"] = frontend::value_of(frontend::curvature_options()[6],
                                             CurvatureOptions{.estimator = result.statistics.estimator});
    if (result.statistics.radius > 0.0) report["radius"] = result.statistics.radius;
    if (!result.statistics.choice.empty()) {
        report["choice"] = result.statistics.choice;
        report["noise"] = result.statistics.noise;
    }
    for (const auto& [stage, seconds] : result.statistics.stage_seconds) report["stage_seconds"][stage] = seconds;
    std::size_t undefined = 0;
    for (const std::uint8_t flags : result.flags) undefined += (flags & vertex_flags::undefined) != 0;
    report["undefined_vertices"] = undefined;
    report["fallbacks"] = result.statistics.fallbacks;
}

void say_result(Session& session, const CurvatureResult& result) {
    const CurvatureStatistics& s = result.statistics;
    session.say("surface      " + counted(s.vertices, "vertex", "vertices") + ", " + counted(s.triangles, "triangle") +
                ", " + counted(s.components, "component") +
                (s.border_edges > 0 ? ", " + counted(s.border_edges, "border edge") : ", closed"));
    warn_of(session, s);
    say_measures(session, result.total);
    if (!s.choice.empty()) session.say("estimator    " + s.choice);
    if (s.radius > 0.0) session.say("radius       " + frontend::text_of(s.radius));
    if (s.fallbacks > 0)
        session.say("fallback     " + counted(s.fallbacks, "vertex", "vertices") + " with a simpler kernel or window");
    double low = 0.0, high = 0.0;
    for (std::size_t v = 0; v < result.k_min.size(); ++v)
        low = std::min(low, result.k_min[v]), high = std::max(high, result.k_max[v]);
    session.say("curvatures   " + frontend::text_of(low) + " to " + frontend::text_of(high));
}

/// The boundary of each region of a solid mesh on its own.
void report_solids(Session& session, const MeshDocument& document) {
    const std::vector<std::int64_t> regions = find_regions(document);
    if (regions.size() < 2) return;
    Json solids = Json::array();
    for (const std::int64_t region : regions) {
        const CurvatureMeasures m =
            compute_region_measures(triangulate(document, region).mesh, Region{}, {}, session.control()).measures;
        solids.push_back({{"region", region}, {"measures", json_of(m)}});
        session.detail("region " + std::to_string(region) + ": area " + frontend::text_of(m.area) + ", mean " +
                       frontend::text_of(m.mean) + ", gaussian " + frontend::text_of(m.gaussian));
    }
    session.report()["solids"] = solids;
}

ExitCode run_curvature(Session& session, const CurvatureArguments& arguments) {
    if (arguments.output.given()) {
        if (!arguments.region.empty())
            throw UsageError("--region measures one region: there is nothing to write to -o");
        require_field_format(arguments.output);
        session.require_writable(arguments.output);
    }
    MeshDocument document = session.read(arguments.input, "input");
    const std::uint64_t corners = document.complex.corners.size() + 12 * document.tetrahedra.size();
    // 10M triangles with 3 rings take 3.9 GB in the library (docs/performance.md); balls keep two tensors per edge.
    const bool rings = arguments.options.neighborhood == Neighborhood::rings;
    session.require_memory((rings ? 140 : 200) * corners + 300 * document.complex.positions.size(),
                           "curvature of this mesh");
    const TriangulatedSurface surface =
        session.timed("triangulate", [&] { return triangulate(document, arguments.solid); });
    session.report()["options"] = to_json(frontend::curvature_options(), arguments.options, 0.0);
    if (!arguments.region.empty()) {
        const Region region = frontend::parse_region(
            arguments.region, [&](const std::string& path) { return triangles_of(surface, read_faces(path), path); });
        return measure_region(session, arguments, surface, region);
    }
    const CurvatureResult result = session.timed("curvature", [&] {
        const GracefulScope graceful;
        return refusing_options([&] { return compute_curvature(surface.mesh, arguments.options, session.control()); });
    });
    if (result.outcome == Outcome::cancelled) return ExitCode::interrupted;
    report_result(session, result);
    say_result(session, result);
    if (!document.tetrahedra.empty() && !arguments.solid) report_solids(session, document);
    if (interrupt_flag()) return ExitCode::interrupted;
    if (arguments.output.given()) {
        for (Field& field : make_fields(result)) {
            std::erase_if(document.fields,
                          [&](const Field& old) { return old.location == field.location && old.name == field.name; });
            document.fields.push_back(std::move(field));
        }
        session.write(arguments.output, document, arguments.output_options);
    }
    return ExitCode::done;
}

}  // namespace

void add_curvature_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<CurvatureArguments>();
    CLI::App* command = app.add_subcommand(
        "curvature",
        "Measure principal curvatures and directions at every vertex, or the curvature measures of a region");
    command->footer(
        "Fields per vertex: area, mean (density of k1 + k2), gaussian, k_min, k_max, dir_min, dir_max, normal,\n"
        "confidence, flags (bits: 1 unused, 2 border, 4 non-manifold, 8 edge left out, 16 triangle without area,\n"
        "32 fallback, 64 undefined). Curvatures are positive on a sphere whose normals point outwards.\n"
        "Examples:\n  certa curvature part.off -o part.vtu\n"
        "  certa curvature part.off --region 'ball:0,0,0:1 & !halfspace:0,0,0.5:0,0,1' --json -");
    command->add_option("INPUT", arguments->input.path, "surface mesh or tetrahedral mesh (-: standard input)")
        ->required();
    command
        ->add_option("-o,--output", arguments->output.path,
                     "mesh with curvature fields to write (-: standard output); without it only the report is printed")
        ->type_name("OUT");
    add_format_option(*command, "--input-format", arguments->input);
    add_format_option(*command, "--output-format", arguments->output);
    add_options(*command, frontend::curvature_options(), arguments->options);
    command->get_option("--geodesic")->excludes("--ball", "--rings");
    command->get_option("--ball")->excludes("--rings");
    command
        ->add_option("--region", arguments->region,
                     "measure this one region instead: ball:x,y,z:R, box:x,y,z:x,y,z, halfspace:x,y,z:nx,ny,nz, "
                     "faces:FILE, joined by & | ! and parentheses")
        ->type_name("SPEC");
    command
        ->add_option("--solid", arguments->solid,
                     "of tetrahedral meshes: the boundary of this region only (default: of all)")
        ->type_name("REGION");
    add_options(*command, frontend::output_options().first(2), arguments->output_options);
    add_common_flags(*command, arguments->common);
    command->callback([arguments, &action] {
        action = [arguments] {
            Session session("curvature", arguments->common);
            return session.run([&] { return run_curvature(session, *arguments); });
        };
    });
}

}  // namespace certa::cli
