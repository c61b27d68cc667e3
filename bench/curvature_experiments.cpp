// The thesis's experiments (Part II, 2.5 and Figure 3.2), one command each: writes a mesh with curvature fields that
// `certa view` shows.
//
//   curvature_experiments torus|literal|ellipsoid|cylinder|helicoid OUT.vtu
// torus: 1,000 random points, 2 rings (Figure 2.8). literal: 10,000 points, 3 rings, open rim as in Theorem 13; prints
// the mean angle error, which agrees with the thesis, and the bias of the value, which does not. ellipsoid: 1,442
// points (Figure 2.11). cylinder: noise of a quarter of the spacing, 3 rings (Figure 2.10). helicoid: 16 samples a unit
// on rulings, 256 along the axis (Figure 3.2); prints the mass of the normal cycle for a sequence of them.
#include <certa/curvature.h>
#include <certa/io.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "mesh/generators_surfaces.h"

using namespace certa;

namespace {

/// Mean angle error of dir_min on the torus, and mean error of k_max with its sign.
void print_torus_errors(const TriangleMesh& mesh, const CurvatureResult& result, double minor) {
    double angle = 0.0, bias = 0.0;
    const auto n = static_cast<double>(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Point3 &p = mesh.positions[v], &d = result.dir_min[v];
        const double rho = std::hypot(p.x, p.y), along = std::abs(d.y * p.x - d.x * p.y) / rho;
        angle += std::acos(std::min(1.0, along)) * 180.0 / std::numbers::pi / n;
        bias += 100.0 * (result.k_max[v] * minor - 1.0) / n;
    }
    std::printf(
        "mean angle error of the smallest curvature's direction %.2f degrees, bias of the largest curvature %.1f %%\n",
        angle, bias);
}

CurvatureResult write(const std::string& path, const TriangleMesh& mesh, const CurvatureOptions& options) {
    const CurvatureResult result = compute_curvature(mesh, options);
    MeshDocument document;
    document.complex.positions = mesh.positions;
    for (const auto& [a, b, c] : mesh.triangles) add_facet(document.complex, {{a, b, c}});
    document.fields = make_fields(result);
    write_document(path, document);
    std::printf("%zu vertices, area %.6g, mean measure %.6g, mass above edges %.6g\n", mesh.positions.size(),
                result.total.area, result.total.mean, result.total.edge_mass);
    return result;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: curvature_experiments torus|literal|ellipsoid|cylinder|helicoid OUT.vtu\n");
        return 2;
    }
    const std::string name = argv[1];
    if (name == "torus") {
        const TriangleMesh mesh = generators::make_torus(2.0, 0.7, 1000, 1);
        print_torus_errors(mesh, write(argv[2], mesh, {.rings = 2}), 0.7);
    } else if (name == "literal") {
        const TriangleMesh mesh = generators::make_torus(2.0, 0.7, 10000, 1);
        print_torus_errors(mesh, write(argv[2], mesh, {.rings = 3, .rim = Rim::open}), 0.7);
    } else if (name == "ellipsoid") {
        write(argv[2], generators::make_ellipsoid(2.0, 1.2, 0.8, 1442, 1), {.rings = 2});
    } else if (name == "cylinder") {
        const double radius = 1.0, height = 4.0, points = 2000.0;
        const double spacing = std::sqrt(2.0 * std::numbers::pi * radius * height / points);
        write(argv[2], generators::make_noisy(generators::make_cylinder(radius, height, 2000, 1), 0.25 * spacing, 2),
              {.rings = 3});
    } else if (name == "helicoid") {
        for (const std::uint32_t n : {4U, 8U, 16U, 32U}) {
            const CurvatureMeasures total = compute_curvature(generators::make_helicoid(n, n * n)).total;
            std::printf("%2u samples a unit, %4u along the axis: mass %.4g\n", n, n * n,
                        total.area + total.edge_mass + total.vertex_mass);
        }
        write(argv[2], generators::make_helicoid(16, 256), {});
    } else {
        std::fprintf(stderr, "curvature_experiments: no experiment %s\n", argv[1]);
        return 2;
    }
    return 0;
}
