// Our rows beside the table of the remeshers that we measure ourselves against: distance per vertex, share of quads,
// time.
//
//   remesh_bench --models FOLDER [--write FOLDER] [--no-placement] [--verbose] [NAME...]
// Models: surfaces/{ellipsoid,torus,saddle}.off, cad/{fandisk.off,rocker-arm.obj}, scan/bunny00.off in FOLDER, at the
// vertex counts of the table; NAME picks some. RMS and Hausdorff distance are over the diagonal, two-sided, from 30,000
// samples on each surface and all vertices; the bound is the proved one, for every triangulation. Seconds are CPU of
// the whole pipeline in this process, reading and measuring excepted.
#include <certa/curvature.h>
#include <certa/io.h>
#include <certa/remeshing.h>
#include <certa/surface_check.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

using namespace certa;

namespace {

struct Row {
    const char* file;
    std::uint64_t vertices;
    double rms, hausdorff;  // targets, over the diagonal
    double crease = 0.0;    // target of the mean distance of creases; 0: none
};
constexpr Row rows[] = {
    {"surfaces/ellipsoid.off", 500, 4.0e-4, 1.5e-3}, {"surfaces/ellipsoid.off", 1500, 1.35e-4, 6e-4},
    {"surfaces/torus.off", 500, 5.3e-4, 2.5e-3},     {"surfaces/torus.off", 1500, 1.85e-4, 9e-4},
    {"surfaces/saddle.off", 500, 1.25e-4, 4e-4},     {"cad/fandisk.off", 500, 1.5e-4, 2e-3, 1e-4},
    {"cad/fandisk.off", 1500, 3e-5, 5e-4, 2e-5},     {"cad/rocker-arm.obj", 1500, 3.8e-4, 3e-3},
    {"scan/bunny00.off", 1500, 3.3e-4, 2.7e-3},      {"scan/bunny00.off", 5000, 1.2e-4, 1.0e-3},
};

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
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

/// Violations by promise, "topology 1, creases 2".
std::string summary_of(const SurfaceCheck& check) {
    if (check.ok()) return "all promises kept";
    std::string text;
    for (const std::string& promise : check.promises) {
        const auto count = std::count_if(check.violations.begin(), check.violations.end(),
                                         [&](const Violation& v) { return v.promise == promise; });
        if (count > 0) text += (text.empty() ? "" : ", ") + promise + " " + std::to_string(count);
    }
    return text;
}

struct Settings {
    std::string models, write;
    bool is_verbose = false, is_placed = true;
    std::vector<std::string> names;
};

/// NAME_V.off in the folder of --write.
void write_result(const Settings& settings, const Row& row, const PolygonMesh& mesh) {
    if (settings.write.empty()) return;
    std::string name = std::strrchr(row.file, '/') + 1;
    name = name.substr(0, name.find('.')) + "_" + std::to_string(row.vertices) + ".off";
    MeshDocument document;
    document.complex.positions = mesh.positions;
    for (std::size_t q = 0; q + 1 < mesh.offsets.size(); ++q)
        add_facet(document.complex,
                  {{mesh.corners.begin() + mesh.offsets[q], mesh.corners.begin() + mesh.offsets[q + 1]}});
    write_document(settings.write + "/" + name, document);
}

void measure(const Settings& settings, const Row& row) {
    const TriangleMesh input = triangulate(read_document(settings.models + "/" + row.file)).mesh;
    RemeshOptions options;
    options.vertices = row.vertices;
    options.placement = settings.is_placed;
    const double start = cpu_seconds();
    const RemeshResult result = remesh(input, options);
    const double seconds = cpu_seconds() - start;
    if (result.mesh.offsets.size() < 2) {
        std::printf("%-24s %5lu | no result\n", row.file, static_cast<unsigned long>(row.vertices));
        return;
    }
    const SurfaceCheck check = check_surface(result.mesh, polygons_of(input));
    const SurfaceDistance& d = check.distance;
    const double quads = 100.0 * static_cast<double>(check.mesh.quads) / static_cast<double>(check.mesh.polygons);
    std::printf("%-24s %5zu %5.1f | %8.2e %8.2e | %8.2e %8.2e %8.2e | %5.2f", row.file, check.mesh.vertices, quads,
                d.rms / d.diagonal, row.rms, d.hausdorff / d.diagonal, row.hausdorff, d.hausdorff_bound / d.diagonal,
                seconds);
    if (row.crease > 0.0) std::printf(" | crease %.1e (%.0e)", check.creases.mean_distance / d.diagonal, row.crease);
    std::printf(" | %s\n", summary_of(check).c_str());
    if (settings.is_verbose)
        for (const Violation& violation : check.violations)
            std::printf("    %s: %s\n", violation.promise.c_str(), violation.message.c_str());
    write_result(settings, row, result.mesh);
    double total = 0.0;
    for (const auto& [stage, share] : result.statistics.stage_seconds) total += share;
    std::printf("    ");
    for (const auto& [stage, share] : result.statistics.stage_seconds)
        std::printf("%s %.0f %%  ", stage.c_str(), 100.0 * share / std::max(total, 1e-9));
    std::printf("\n");
    std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
    Settings settings;
    for (int i = 1; i < count; ++i) {
        if (std::strcmp(arguments[i], "--models") == 0 && i + 1 < count) {
            settings.models = arguments[++i];
        } else if (std::strcmp(arguments[i], "--write") == 0 && i + 1 < count) {
            settings.write = arguments[++i];
        } else if (std::strcmp(arguments[i], "--no-placement") == 0) {
            settings.is_placed = false;
        } else if (std::strcmp(arguments[i], "--verbose") == 0) {
            settings.is_verbose = true;
        } else {
            settings.names.push_back(arguments[i]);
        }
    }
    if (settings.models.empty()) {
        std::fputs("remesh_bench: --models FOLDER is missing\n", stderr);
        return 2;
    }
    std::printf("%-24s %5s %5s | %8s %8s | %8s %8s %8s | %5s\n", "model", "V", "quad%", "RMS", "target", "Hausd.",
                "target", "bound", "CPU s");
    for (const Row& row : rows) {
        const bool is_wanted = settings.names.empty() ||
                               std::any_of(settings.names.begin(), settings.names.end(), [&](const std::string& name) {
                                   return std::strstr(row.file, name.c_str()) != nullptr;
                               });
        if (!is_wanted) continue;
        try {
            measure(settings, row);
        } catch (const std::exception& error) {
            std::printf("%-24s %5lu | %s\n", row.file, static_cast<unsigned long>(row.vertices), error.what());
        }
    }
}
