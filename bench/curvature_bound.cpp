// Theorem 13's short form against the truth: the largest ratio of error to kappa (kappa s + sd) epsilon, and the proved
// bound's largest ratio, over interiors of rings on random tori and on spheres (docs/curvature-bounds.md).
//
//   curvature_bound POINTS SEEDS
// The smooth measure of the projection of a triangle is integrated at three points, with the projection's Jacobian
// cos(angle) / ((1 + d k1) (1 + d k2)), d the signed distance.
#include <certa/curvature.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <vector>

#include "core/vector3.h"
#include "mesh/generators_surfaces.h"

using namespace certa;

namespace {

/// A torus, or a unit sphere where major is 0 and minor is 1.
struct Smooth {
    double major, minor;
    double largest_curvature() const {
        return major > 0.0 ? std::max(1.0 / minor, 1.0 / (major - minor)) : 1.0 / minor;
    }
    /// (k1 + k2) times the projection's Jacobian from a triangle with unit normal n.
    double density(const Point3& q, const Point3& n) const {
        const double rho = std::hypot(q.x, q.y);
        const Point3 centre = major > 0.0 ? Point3{major * q.x / rho, major * q.y / rho, 0.0} : Point3{};
        const Point3 away = q - centre;
        const double length = norm(away), d = length - minor;
        const Point3 normal = (1.0 / length) * away;
        const double c = major > 0.0 ? (rho - major) / length : 1.0;
        const double k1 = 1.0 / minor, k2 = major > 0.0 ? c / (major + minor * c) : 1.0 / minor;
        return (k1 + k2) * dot(n, normal) / ((1.0 + d * k1) * (1.0 + d * k2));
    }
};

double smooth_mean(const TriangleMesh& mesh, std::size_t t, const Smooth& smooth) {
    std::array<Point3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.positions[index_of(mesh.triangles[t][i])];
    const Point3 twice = cross(p[1] - p[0], p[2] - p[0]);
    const double area = 0.5 * norm(twice);
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
        sum += area / 3.0 * smooth.density(0.5 * (p[i] + p[(i + 1) % 3]), (0.5 / area) * twice);
    return sum;
}

void compare(const char* name, const TriangleMesh& mesh, const Smooth& smooth) {
    std::vector<std::vector<std::uint32_t>> around(mesh.positions.size());
    std::vector<double> truth(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        truth[t] = smooth_mean(mesh, t, smooth);
        for (const VertexId v : mesh.triangles[t]) around[index_of(v)].push_back(t);
    }
    for (const std::uint64_t rings : {1U, 2U, 3U, 6U}) {
        CurvatureOptions options{.rings = rings, .rim = Rim::open, .measures = true, .bounds = true};
        options.max_curvature = smooth.largest_curvature();
        const CurvatureResult result = compute_curvature(mesh, options);
        double shorter = 0.0, proved = 0.0;
        std::size_t holds = 0;
        for (std::size_t v = 0; v < mesh.positions.size(); v += 1 + mesh.positions.size() / 500) {
            std::set<std::uint32_t> faces(around[v].begin(), around[v].end());
            for (std::uint64_t k = 1; k < rings; ++k) {
                const std::set<std::uint32_t> inner = faces;
                for (const std::uint32_t t : inner)
                    for (const VertexId w : mesh.triangles[t])
                        faces.insert(around[index_of(w)].begin(), around[index_of(w)].end());
            }
            double exact = 0.0;
            for (const std::uint32_t t : faces) exact += truth[t];
            const double error = std::abs(result.mean_measure[v] - exact);
            shorter = std::max(shorter, error / result.bounds[v].calibrated);
            if (result.bounds[v].mean) proved = std::max(proved, error / *result.bounds[v].mean), ++holds;
        }
        std::printf("%-24s %llu rings: error / calibrated <= %.4f, error / proved <= %.5f (%zu hold)\n", name,
                    static_cast<unsigned long long>(rings), shorter, proved, holds);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto points = static_cast<std::uint32_t>(argc > 1 ? std::atoi(argv[1]) : 3000);
    const int seeds = argc > 2 ? std::atoi(argv[2]) : 2;
    compare("icosphere, 2,562", generators::make_icosphere(4), {0.0, 1.0});
    for (int seed = 1; seed <= seeds; ++seed) {
        compare("torus 2, 0.7", generators::make_torus(2.0, 0.7, points, static_cast<std::uint64_t>(seed)), {2.0, 0.7});
        compare("torus 1, 0.8", generators::make_torus(1.0, 0.8, points, static_cast<std::uint64_t>(seed)), {1.0, 0.8});
        compare("sphere, random", generators::make_ellipsoid(1, 1, 1, points, static_cast<std::uint64_t>(seed)),
                {0.0, 1.0});
    }
    return 0;
}
