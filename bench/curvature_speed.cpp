// Speed of the stages of curvature, beside a reference loop: CPU time of the process, one thread, median of several
// runs.
//
//   curvature_speed VERTICES RUNS [THREADS [CASE]]
// A random torus (vertices in random order, as a reconstruction would give them) up to 2M vertices, a grid torus above.
// CASE: only cases whose name contains it; "peer": CGAL's jets, where the benchmarks were built with CGAL and Eigen.
// The reference is one pass over the mesh's arrays that sums the areas of its triangles: what reading the mesh costs.
#include <certa/curvature.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "core/vector3.h"
#include "curvature_peer.h"
#include "mesh/generators_surfaces.h"

using namespace certa;

namespace {

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

double reference_pass(const TriangleMesh& mesh) {
    double area = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Point3& p = mesh.positions[index_of(a)];
        area += 0.5 * norm(cross(mesh.positions[index_of(b)] - p, mesh.positions[index_of(c)] - p));
    }
    return area;
}

}  // namespace

int main(int argc, char** argv) {
    const auto vertices = static_cast<std::uint32_t>(argc > 1 ? std::atoi(argv[1]) : 100000);
    const int runs = argc > 2 ? std::atoi(argv[2]) : 5;
    RunControl control;
    control.threads = argc > 3 ? static_cast<unsigned>(std::atoi(argv[3])) : 1;
    const std::string wanted = argc > 4 ? argv[4] : "";
    const auto side = static_cast<std::uint32_t>(std::sqrt(vertices));
    const TriangleMesh mesh = vertices <= 2000000 ? generators::make_torus(2.0, 0.7, vertices, 1)
                                                  : generators::make_grid_torus(2.0, 0.7, side, side);
    const auto n = static_cast<double>(mesh.positions.size());
    const double h = compute_curvature(mesh, {}, control).statistics.mean_edge_length;
    std::vector<double> reference;
    double area = 0.0;
    for (int run = 0; run < runs; ++run) {
        const double start = cpu_seconds();
        area += reference_pass(mesh);
        reference.push_back(cpu_seconds() - start);
    }
    std::printf("%zu vertices, %zu triangles, median of %d, %u threads; reference pass %.4f us/vertex (area %.6g)\n",
                mesh.positions.size(), mesh.triangles.size(), runs, control.threads, 1e6 * median(reference) / n,
                area / runs);
    const struct {
        const char* name;
        CurvatureOptions options;
    } cases[] = {
        {"2 rings, dual", {.rings = 2}},
        {"3 rings, dual", {.rings = 3}},
        {"3 rings, half", {.rings = 3, .rim = Rim::half}},
        {"ball 2.5 h", {.neighborhood = Neighborhood::ball, .radius = {2.5 * h, false}}},
        {"ball 4 h", {.neighborhood = Neighborhood::ball, .radius = {4 * h, false}}},
        {"kernel2 4 h", {.neighborhood = Neighborhood::ball, .radius = {4 * h, false}, .weight = Weight::kernel2}},
        {"ball 4 h, sheets", {.neighborhood = Neighborhood::ball, .radius = {4 * h, false}, .all_sheets = true}},
        {"corrected, 1 ring", {.rings = 1, .estimator = Estimator::corrected}},
        {"jet 2, 2 rings", {.rings = 2, .estimator = Estimator::jet}}};
    std::printf("%-20s %12s %12s %10s\n", "case", "build us/v", "stage us/v", "x pass");
    for (const auto& c : cases) {
        if (std::string(c.name).find(wanted) == std::string::npos) continue;
        if (n > 2e6 && std::string(c.name) != "2 rings, dual" && std::string(c.name) != "3 rings, dual") continue;
        std::vector<double> build, stage;
        for (int run = 0; run < runs; ++run) {
            // The stage begins when its progress is told for the first time.
            double begin = 0.0;
            RunControl watched = control;
            watched.progress = [&](std::string_view name, double fraction) {
                if (name == "estimate" && fraction == 0.0) begin = cpu_seconds();
            };
            const double start = cpu_seconds();
            const CurvatureResult result = compute_curvature(mesh, c.options, watched);
            build.push_back(begin - start);
            stage.push_back(cpu_seconds() - begin);
        }
        std::printf("%-20s %12.3f %12.3f %10.1f\n", c.name, 1e6 * median(build) / n, 1e6 * median(stage) / n,
                    median(stage) / median(reference));
    }
    PeerRun peer;
    std::vector<double> peer_times;
    for (int run = 0; run < runs && (wanted.empty() || wanted == "peer") && n <= 2e6 && run_peer(mesh, peer); ++run)
        peer_times.push_back(peer.seconds);
    if (!peer_times.empty())
        std::printf("%-20s %12s %12.3f %10.1f   (mean k_max %.4f)\n", peer.name.c_str(), "",
                    1e6 * median(peer_times) / n, median(peer_times) / median(reference), peer.mean_k_max);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    std::printf("peak memory %.2f GB\n", static_cast<double>(usage.ru_maxrss) / 1048576.0);
    return 0;
}
