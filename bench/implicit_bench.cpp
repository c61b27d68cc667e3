// The engines side by side on the surfaces of a file (docs/performance.md): implicit_bench SURFACES.json [NAME...]
// One row a surface. Growth: verdict, leaves, cells, enclosures, triangles, CPU seconds, CPU seconds of the independent
// check. Plantinga and Vegter's and the thesis's watershed: verdict, leaves, enclosures, triangles, CPU seconds. A last
// column says whether they agree with each other. THESIS=0 in the environment leaves the watershed out.
#include <certa/implicit.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

namespace {

struct Row {
    certa::ImplicitResult result;
    double seconds = 0, check_seconds = 0;
    bool checked = false;
    std::vector<int> genera;
};

double cpu() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Row run(const nlohmann::json& surface, const certa::ImplicitOptions& options) {
    const auto corner = [&](std::size_t i) {
        const auto& c = surface.at("box").at(i);
        return certa::Point3{c.at(0), c.at(1), c.at(2)};
    };
    const std::string text = surface.at("f").get<std::string>();
    Row row;
    double start = cpu();
    row.result = certa::mesh_implicit(certa::parse_expression(text), corner(0), corner(1), options);
    row.seconds = cpu() - start;
    if (!row.result.certificate.empty()) {
        start = cpu();
        row.checked = certa::check_implicit(row.result.mesh, text, row.result.certificate).ok();
        row.check_seconds = cpu() - start;
    }
    for (const certa::ImplicitComponent& c : row.result.components) row.genera.push_back(c.genus);
    std::sort(row.genera.begin(), row.genera.end());
    return row;
}

void print(const Row& row, bool cells) {
    const auto& s = row.result.statistics;
    const auto number = [](std::uint64_t n) { std::printf(" %llu |", static_cast<unsigned long long>(n)); };
    const bool decided = row.result.verdict != certa::ImplicitVerdict::undecided;
    std::printf(" %s |", !decided
                             ? (row.result.obstacles.empty() ? "undecided" : name_of(row.result.obstacles[0].reason))
                         : row.result.verdict == certa::ImplicitVerdict::empty ? "empty"
                         : row.result.isotopic                                 ? "isotopy"
                                                                               : "type");
    number(s.leaves);
    if (cells) number(s.cells);
    number(s.evaluations);
    number(row.result.mesh.triangles.size());
    std::printf(" %.2f |", row.seconds);
    if (!cells) return;
    if (row.checked)
        std::printf(" %.2f |", row.check_seconds);
    else
        std::printf(" %s |", row.result.certificate.empty() ? "" : "REJECTED");
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) return 2;
    const nlohmann::json file = nlohmann::json::parse(std::ifstream(arguments[1]));
    const char* thesis = std::getenv("THESIS");
    const bool watershed = thesis == nullptr || *thesis != '0';
    std::printf(
        "| surface | growth | leaves | cells | enclosures | triangles | s | check s | PV | leaves | enclosures | "
        "triangles | s | thesis | leaves | enclosures | triangles | s | agree |\n");
    for (const auto& surface : file.at("surfaces")) {
        const std::string name = surface.at("name");
        if (count > 2 && std::find(arguments + 2, arguments + count, name) == arguments + count) continue;
        try {
            certa::ImplicitOptions options;
            options.time_seconds = 900;  // far above all: on a busy machine limits on time compare nothing
            options.certificate = true;
            options.clip = surface.value("clip", false) || name.find("_box") != std::string::npos ||
                           name == "schwarzP_1cell" || name == "gyroid_2pi";
            const Row growth = run(surface, options);
            std::printf("| %s |", name.c_str());
            print(growth, true);
            std::fflush(stdout);
            bool agree = true;
            for (const auto engine : {certa::ImplicitEngine::plantinga_vegter, certa::ImplicitEngine::thesis}) {
                if (options.clip || (engine == certa::ImplicitEngine::thesis && !watershed)) continue;
                certa::ImplicitOptions other;
                other.engine = engine;
                other.max_cells = engine == certa::ImplicitEngine::thesis ? 300'000 : 600'000;
                other.time_seconds = 120;
                const Row rival = run(surface, other);
                print(rival, false);
                agree = agree &&
                        (growth.result.verdict == certa::ImplicitVerdict::undecided ||
                         rival.result.verdict == certa::ImplicitVerdict::undecided || growth.genera == rival.genera);
            }
            std::printf(" %s |\n", agree ? "yes" : "NO");
        } catch (const std::exception& error) {
            std::printf("| %s | refused: %.60s |\n", name.c_str(), error.what());
        }
        std::fflush(stdout);
    }
}
