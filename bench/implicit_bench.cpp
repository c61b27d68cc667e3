// Both engines side by side on the surfaces of a file (docs/performance.md): implicit_bench SURFACES.json [NAME...]
// One row a surface: verdict, leaves, cells, triangles and CPU seconds of the growth engine and of Plantinga and
// Vegter's; a last column says whether they agree with each other and with what the file expects.
#include <certa/implicit.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

namespace {

struct Row {
    certa::ImplicitResult result;
    double seconds = 0;
    std::vector<int> genera;
};

Row run(const nlohmann::json& surface, certa::ImplicitOptions options) {
    const auto corner = [&](std::size_t i) {
        const auto& c = surface.at("box").at(i);
        return certa::Point3{c.at(0), c.at(1), c.at(2)};
    };
    Row row;
    const std::clock_t start = std::clock();
    row.result = certa::mesh_implicit(certa::parse_expression(surface.at("f").get<std::string>()), corner(0), corner(1),
                                      options);
    row.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    for (const certa::ImplicitComponent& c : row.result.components) row.genera.push_back(c.genus);
    std::sort(row.genera.begin(), row.genera.end());
    return row;
}

void print(const Row& row) {
    std::printf(" %s | %llu | %llu | %zu | %.2f |", name_of(row.result.verdict),
                static_cast<unsigned long long>(row.result.statistics.leaves),
                static_cast<unsigned long long>(row.result.statistics.cells), row.result.mesh.triangles.size(),
                row.seconds);
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) return 2;
    const nlohmann::json file = nlohmann::json::parse(std::ifstream(arguments[1]));
    std::printf(
        "| surface | growth | leaves | cells | triangles | s | PV | leaves | cells | triangles | s | agree |\n");
    for (const auto& surface : file.at("surfaces")) {
        const std::string name = surface.at("name");
        if (count > 2 && std::find(arguments + 2, arguments + count, name) == arguments + count) continue;
        try {
            certa::ImplicitOptions options;
            options.time_seconds = 120;
            const Row growth = run(surface, options);
            options.engine = certa::ImplicitEngine::plantinga_vegter;
            options.max_cells = 1'000'000;
            const Row rival = run(surface, options);
            std::printf("| %s |", name.c_str());
            print(growth);
            print(rival);
            const bool both = growth.result.verdict != certa::ImplicitVerdict::undecided &&
                              rival.result.verdict != certa::ImplicitVerdict::undecided;
            std::printf(" %s |\n", !both ? "-" : growth.genera == rival.genera ? "yes" : "NO");
        } catch (const std::exception& error) {
            std::printf("| %s | refused: %.60s |\n", name.c_str(), error.what());
        }
        std::fflush(stdout);
    }
}
