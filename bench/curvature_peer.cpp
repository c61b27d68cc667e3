// CGAL's jets of degree 2 over two rings at every vertex. Neighbours are compressed lists built beforehand (not timed),
// so that what is timed is collecting the rings and fitting, as in the stage of ours that it stands beside.
#include "curvature_peer.h"

#if defined(CERTA_PEER_CGAL)
#include <CGAL/Monge_via_jet_fitting.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/version.h>
#endif

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <vector>

using namespace certa;

#if defined(CERTA_PEER_CGAL)
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Fitting = CGAL::Monge_via_jet_fitting<Kernel>;

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<std::vector<std::uint32_t>> neighbors_of(const TriangleMesh& mesh) {
    std::vector<std::vector<std::uint32_t>> lists(mesh.positions.size());
    for (const Triangle& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) lists[index_of(t[i])].push_back(index_of(t[(i + 1) % 3]));
    return lists;
}

}  // namespace

bool run_peer(const TriangleMesh& mesh, PeerRun& run) {
    const auto neighbors = neighbors_of(mesh);
    std::vector<Kernel::Point_3> points;
    for (const Point3& p : mesh.positions) points.emplace_back(p.x, p.y, p.z);
    std::vector<std::uint32_t> marks(points.size()), ring;
    std::vector<Kernel::Point_3> window;
    double sum = 0.0;
    const double start = cpu_seconds();
    for (std::uint32_t v = 0; v < points.size(); ++v) {
        ring.assign(1, v);
        marks[v] = v + 1;
        for (std::size_t begin = 0, step = 0; step < 2; ++step)
            for (const std::size_t end = ring.size(); begin < end; ++begin)
                for (const std::uint32_t w : neighbors[ring[begin]])
                    if (marks[w] != v + 1) marks[w] = v + 1, ring.push_back(w);
        window.clear();
        for (const std::uint32_t w : ring) window.push_back(points[w]);
        if (window.size() < 6) continue;
        Fitting fitting;
        const Fitting::Monge_form form = fitting(window.begin(), window.end(), 2, 2);
        sum += std::max(std::abs(form.principal_curvatures(0)), std::abs(form.principal_curvatures(1)));
    }
    run.seconds = cpu_seconds() - start;
    run.name = "CGAL " CGAL_VERSION_STR " jet 2, 2 rings";
    run.mean_k_max = sum / static_cast<double>(points.size());
    return true;
}
#else
bool run_peer(const TriangleMesh&, PeerRun&) { return false; }
#endif
