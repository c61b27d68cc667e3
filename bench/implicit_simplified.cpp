// What certainty costs in triangles: meshes simplified to an error within W, and the same simplification without W
// (docs/performance.md). A row per surface and error: triangles of the raw mesh, within W, without W, their ratio, the
// smallest angle in degrees and CPU seconds of the whole job within W, and what the independent checker says.
#include <certa/implicit.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "core/vector3.h"
#include "implicit/simplify.h"

namespace {

double cpu() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double smallest_angle(const certa::TriangleMesh& mesh) {
    double smallest = 180;
    for (const certa::Triangle& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto at = [&](std::size_t k) { return mesh.positions[index_of(t[(i + k) % 3])]; };
            const certa::Point3 a = at(1) - at(0), b = at(2) - at(0);
            smallest = std::min(smallest, std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / M_PI);
        }
    }
    return smallest;
}

void compare(const char* name, const char* text, double half, double error) {
    const certa::Expression function = certa::parse_expression(text);
    const certa::Point3 low{-1.01 * half, -1.01 * half, -1.01 * half}, high{0.99 * half, 0.99 * half, 0.99 * half};
    certa::ImplicitResult raw = certa::mesh_implicit(function, low, high);
    const std::size_t count = raw.mesh.triangles.size();
    certa::implicit::Surface surface;
    surface.mesh = std::move(raw.mesh);
    surface.component_of_triangle = std::move(raw.triangle_components);
    const certa::implicit::Surface free =
        certa::implicit::simplify(surface, nullptr, certa::expression::Tape(function), {error}, {});
    certa::ImplicitOptions options;
    options.error = error;
    options.certificate = true;
    const double start = cpu();
    const certa::ImplicitResult within = certa::mesh_implicit(function, low, high, options);
    const double seconds = cpu() - start;
    const bool ok = certa::check_implicit(within.mesh, text, within.certificate).ok();
    std::printf("| %s | %g | %zu | %zu | %zu | %.3f | %.1f | %.1f | %s |\n", name, error, count,
                within.mesh.triangles.size(), free.mesh.triangles.size(),
                static_cast<double>(within.mesh.triangles.size()) / static_cast<double>(free.mesh.triangles.size()),
                smallest_angle(within.mesh), seconds, ok ? "verified" : "REJECTED");
    std::fflush(stdout);
}

}  // namespace

int main() {
    const char *torus = "(x^2+y^2+z^2+0.84)^2-4*(x^2+y^2)", *tangle = "x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8";
    std::puts("| surface | error | raw | within W | without W | ratio | angle | s | check |");
    for (const double error : {0.05, 0.02, 0.01, 0.005}) compare("torus", torus, 2, error);
    for (const double error : {0.1, 0.03, 0.01}) compare("tangle cube", tangle, 3, error);
    compare("sphere", "x^2+y^2+z^2-1", 2, 0.02);
}
