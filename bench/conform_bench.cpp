// The whole of conform() against its floor: the Delaunay triangulation of the points that come out, built once in the
// same process. CPU time of one thread; the least of several runs of each.
//
//   conform_bench [--runs N] [--million] [--merge-coplanar] [--no-smooth] [FILE...]
// Without files: layered geology with pinch-outs of about 10k, 30k, 100k, 300k and (--million) 1M facets, with the
// growth of the time from size to size, and a torus through 50k random points. Each model has a process of its own, so
// that peak memory is that model's: Google Benchmark, which repeats in one process, does not fit.
#include <certa/conforming.h>
#include <certa/io.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "delaunay/delaunay_3.h"
#include "mesh/generators.h"
#include "mesh/generators_surfaces.h"

using namespace certa;

namespace {

struct Settings {
    int runs = 3;
    bool million = false, smooth = true;
    ConformOptions options;
    std::vector<std::string> files;
};

struct Model {
    std::string name;
    std::function<PiecewiseLinearComplex()> make;
    bool of_series = false;  // the growth of the time is taken over these
};

/// What a model's process sends back.
struct Measurement {
    bool done = false;
    double facets = 0.0, conform_seconds = 0.0, delaunay_seconds = 0.0;
};

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double peak_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Shares of the stages by the wall clock: on a busy machine only roughly those of CPU time.
std::string shares_of(const ConformStatistics& statistics) {
    double sum = 0.0;
    for (const auto& stage : statistics.stage_seconds) sum += stage.second;
    std::string text;
    for (const auto& [name, seconds] : statistics.stage_seconds)
        text += ' ' + name + ' ' + std::to_string(std::lround(100.0 * seconds / sum)) + '%';
    return text;
}

/// Runs in the model's own process; prints one line.
Measurement measure(const Model& model, const Settings& settings) {
    const PiecewiseLinearComplex complex = model.make();
    RunControl control;
    control.threads = 1;
    Measurement measurement{.facets = static_cast<double>(complex.facet_count()),
                            .conform_seconds = std::numeric_limits<double>::infinity(),
                            .delaunay_seconds = std::numeric_limits<double>::infinity()};
    const double before = peak_megabytes();
    double peak = 0.0;
    ConformResult result;
    std::string shares;
    for (int run = 0; run < settings.runs; ++run) {
        result = {};
        const double start = cpu_seconds();
        result = conform(complex, settings.options, control);
        const double seconds = cpu_seconds() - start;
        if (run == 0) peak = peak_megabytes();
        if (seconds < measurement.conform_seconds) {
            measurement.conform_seconds = seconds;
            shares = shares_of(result.statistics);
        }
    }
    if (result.outcome != Outcome::done) {
        std::printf("%-18s %8.0f  not finished\n", model.name.c_str(), measurement.facets);
        return measurement;
    }
    for (int run = 0; run < settings.runs; ++run) {
        const double start = cpu_seconds();
        delaunay::Delaunay3 triangulation;
        triangulation.build(result.mesh.positions);
        measurement.delaunay_seconds = std::min(measurement.delaunay_seconds, cpu_seconds() - start);
    }
    measurement.done = true;
    std::printf("%-18s %8.0f %9zu %9zu %8.2f %8.2f %6.2f %7.0f %5.0f %s\n", model.name.c_str(), measurement.facets,
                complex.positions.size(), result.mesh.positions.size(), measurement.conform_seconds,
                measurement.delaunay_seconds, measurement.conform_seconds / measurement.delaunay_seconds, peak, before,
                shares.c_str());
    return measurement;
}

/// A model that is refused or runs out of memory ends its own process only.
Measurement measure_apart(const Model& model, const Settings& settings) {
    Measurement measurement;
    int ends[2];
    if (pipe(ends) != 0) return measurement;
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        try {
            measurement = measure(model, settings);
        } catch (const std::exception& e) {
            const std::string text = e.what();
            std::printf("%-18s refused: %s\n", model.name.c_str(), text.substr(0, text.find('\n')).c_str());
        }
        std::fflush(stdout);
        const bool sent = write(ends[1], &measurement, sizeof measurement) == sizeof measurement;
        _exit(sent ? 0 : 1);
    }
    close(ends[1]);
    if (child < 0 || read(ends[0], &measurement, sizeof measurement) != sizeof measurement) {
        measurement = {};
        std::printf("%-18s its process ended early\n", model.name.c_str());
    }
    close(ends[0]);
    if (child > 0) waitpid(child, nullptr, 0);
    return measurement;
}

std::vector<Model> generated_models(const Settings& settings) {
    // Cells a side with 10 layers; the number of facets follows within a few per cent.
    std::vector<Model> models;
    std::vector<std::uint32_t> grids{24, 41, 76, 133};
    if (settings.million) grids.push_back(244);
    for (const std::uint32_t grid : grids)
        models.push_back(
            {"geology " + std::to_string(grid), [grid] { return generators::make_geology(grid, 10, 1); }, true});
    if (settings.smooth)
        models.push_back({"torus", [] { return make_complex(generators::make_torus(2.0, 0.7, 50000, 1)); }, false});
    return models;
}

std::vector<Model> models_of(const Settings& settings) {
    if (settings.files.empty()) return generated_models(settings);
    std::vector<Model> models;
    for (const std::string& path : settings.files) {
        const std::string name = path.substr(path.find_last_of('/') + 1);
        models.push_back({name, [path] { return read_document(path).complex; }, false});
    }
    return models;
}

/// Exponents of the time over the facets, beside what n log n would have.
void print_growth(const std::vector<Measurement>& series) {
    const auto print = [](const Measurement& a, const Measurement& b) {
        const double size = std::log(b.facets / a.facets);
        std::printf("%8.0f to %8.0f facets: conform n^%.3f, delaunay n^%.3f; n log n is n^%.3f\n", a.facets, b.facets,
                    std::log(b.conform_seconds / a.conform_seconds) / size,
                    std::log(b.delaunay_seconds / a.delaunay_seconds) / size,
                    1.0 + std::log(std::log(b.facets) / std::log(a.facets)) / size);
    };
    for (std::size_t i = 1; i < series.size(); ++i) print(series[i - 1], series[i]);
    if (series.size() > 2) print(series.front(), series.back());
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--runs" && i + 1 < argc) {
            settings.runs = std::max(1, std::atoi(argv[++i]));
        } else if (argument == "--million") {
            settings.million = true;
        } else if (argument == "--merge-coplanar") {
            settings.options.merge_coplanar = true;
        } else if (argument == "--no-smooth") {
            settings.smooth = false;
        } else if (argument.rfind("--", 0) == 0) {
            std::fprintf(stderr,
                         "usage: conform_bench [--runs N] [--million] [--merge-coplanar] [--no-smooth] [FILE...]\n");
            return 2;
        } else {
            settings.files.push_back(argument);
        }
    }
    std::printf("%-18s %8s %9s %9s %8s %8s %6s %7s %5s  %s\n", "model", "facets", "points in", "out", "conform", "Dt3",
                "ratio", "peak MB", "start", "shares of stages");
    std::vector<Measurement> series;
    for (const Model& model : models_of(settings)) {
        const Measurement measurement = measure_apart(model, settings);
        if (model.of_series && measurement.done) series.push_back(measurement);
    }
    print_growth(series);
    return 0;
}
