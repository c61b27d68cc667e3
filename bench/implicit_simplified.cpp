// What certainty costs in triangles: meshes simplified to an error within W, and the same simplification without W
// (docs/performance.md): implicit_simplified SURFACES.json [NAME ERROR]...; without names, the table of that page. A
// row per surface and error: triangles of the raw mesh, within W, without W, their ratio, the largest sampled error of
// both, the smallest angle in degrees and CPU seconds of the whole job within W, and what the independent checker says.
#include <certa/implicit.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

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

/// The largest |f| / |grad f| on a grid of 45 points in every triangle.
double largest_error(const certa::TriangleMesh& mesh, const certa::expression::Tape& tape) {
    certa::implicit::Field field(tape);
    double largest = 0;
    for (const certa::Triangle& t : mesh.triangles) {
        const auto at = [&](std::size_t k) { return mesh.positions[index_of(t[k])]; };
        for (int i = 0; i <= 8; ++i) {
            for (int j = 0; i + j <= 8; ++j) {
                const auto& jet = field.slope((i / 8.0) * at(0) + (j / 8.0) * at(1) + ((8 - i - j) / 8.0) * at(2));
                largest = std::max(
                    largest, std::fabs(jet.value) / std::hypot(jet.gradient[0], jet.gradient[1], jet.gradient[2]));
            }
        }
    }
    return largest;
}

void compare(const nlohmann::json& surface, double error) {
    const std::string name = surface.at("name"), text = surface.at("f");
    const auto corner = [&](std::size_t i) {
        const auto& c = surface.at("box").at(i);
        return certa::Point3{c.at(0), c.at(1), c.at(2)};
    };
    const certa::Expression function = certa::parse_expression(text);
    const certa::expression::Tape tape(function);
    certa::ImplicitResult raw = certa::mesh_implicit(function, corner(0), corner(1));
    const std::size_t count = raw.mesh.triangles.size();
    certa::implicit::Surface start;
    start.mesh = std::move(raw.mesh);
    start.component_of_triangle = std::move(raw.triangle_components);
    const certa::implicit::Surface free = certa::implicit::simplify(start, nullptr, tape, {error}, {}).value();
    certa::ImplicitOptions options;
    options.error = error;
    options.certificate = true;
    const double begin = cpu();
    const certa::ImplicitResult within = certa::mesh_implicit(function, corner(0), corner(1), options);
    const double seconds = cpu() - begin;
    const bool ok = certa::check_implicit(within.mesh, text, within.certificate).ok();
    std::printf("| %s | %g | %zu | %zu | %zu | %.2f | %.3g / %.3g | %.1f | %.1f | %s |\n", name.c_str(), error, count,
                within.mesh.triangles.size(), free.mesh.triangles.size(),
                static_cast<double>(within.mesh.triangles.size()) / static_cast<double>(free.mesh.triangles.size()),
                largest_error(within.mesh, tape), largest_error(free.mesh, tape), smallest_angle(within.mesh), seconds,
                ok ? "verified" : "REJECTED");
    std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) return 2;
    const nlohmann::json file = nlohmann::json::parse(std::ifstream(arguments[1]));
    std::vector<std::pair<std::string, double>> rows;
    for (int i = 2; i + 1 < count; i += 2) rows.emplace_back(arguments[i], std::stod(arguments[i + 1]));
    if (rows.empty()) {
        for (const char* name : {"sphere", "torus", "tanglecube", "trefoil_tube", "chmutov_4", "bretzel2"}) {
            for (const double error : {0.1, 0.05, 0.02, 0.005}) rows.emplace_back(name, error);
        }
        for (const double error : {0.02, 0.005}) rows.emplace_back("chmutov_8", error);
    }
    std::puts("| surface | error | raw | within W | without W | ratio | errors | angle | s | check |");
    for (const auto& [name, error] : rows) {
        for (const auto& surface : file.at("surfaces")) {
            if (surface.at("name") == name) compare(surface, error);
        }
    }
}
