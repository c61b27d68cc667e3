// Accuracy of curvature estimators on surfaces with known curvatures: the thesis's experiments (Part II, 2.5) and the
// table of docs/performance.md. Random samples as described in src/mesh/generators_surfaces.h, mean over seeds.
//
//   curvature_accuracy SURFACE POINTS NOISE SEEDS METHOD...
// SURFACE: torus (radii 2 and 0.7) or ellipsoid (2, 1.2, 0.8). NOISE: fraction of sqrt(area / N), uniform in a ball.
// METHOD: rings:K:RIM, ball:X (in mean edge lengths), kernel2:X, kernel4:X, auto:WEIGHT, geodesic:X, corrected:K,
// corrected-ball:X, corrected-kernel2:X, jet:D:K, automatic. Prints per method: mean error of k_max in %, mean angle of
// dir_min in degrees with its signed bias, directions off by more than 30 degrees, angle of the normal, and
// microseconds per vertex (stage "estimate").
#include <certa/curvature.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "core/vector3.h"
#include "mesh/generators_surfaces.h"

using namespace certa;

namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

struct Truth {
    double k_max = 0.0;
    Point3 dir_min, normal;
};

Truth torus_truth(const Point3& p) {
    const double major = 2.0, minor = 0.7, rho = std::hypot(p.x, p.y), c = (rho - major) / minor, s = p.z / minor;
    const double x = p.x / rho, y = p.y / rho;
    return {1.0 / minor, {-y, x, 0.0}, {c * x, c * y, s}};
}

/// From the implicit equation: shape operator on the tangent plane.
Truth ellipsoid_truth(const Point3& p) {
    const Point3 weights{1.0 / 4.0, 1.0 / 1.44, 1.0 / 0.64};
    const Point3 gradient{weights.x * p.x, weights.y * p.y, weights.z * p.z};
    const double size = norm(gradient);
    const Point3 n = (1.0 / size) * gradient;
    const Point3 axis = std::abs(n.x) < 0.6 ? Point3{1, 0, 0} : Point3{0, 1, 0};
    Point3 u = cross(n, axis);
    u = (1.0 / norm(u)) * u;
    const Point3 v = cross(n, u);
    const auto form = [&](const Point3& a, const Point3& b) {
        return (weights.x * a.x * b.x + weights.y * a.y * b.y + weights.z * a.z * b.z) / size;
    };
    const double uu = form(u, u), vv = form(v, v), uv = form(u, v);
    const double half = 0.5 * std::atan2(2.0 * uv, uu - vv), middle = 0.5 * (uu + vv);
    const Point3 along_max = std::cos(half) * u + std::sin(half) * v;
    return {middle + std::hypot(0.5 * (uu - vv), uv), cross(n, along_max), n};
}

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == ':')
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

double mean_edge(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles)
        for (int i = 0; i < 3; ++i)
            sum += distance(mesh.positions[index_of(t[i])], mesh.positions[index_of(t[(i + 1) % 3])]);
    return sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

CurvatureOptions options_of(const std::string& method, double h) {
    const auto parts = split(method);
    const std::string& kind = parts[0];
    const auto number = [&](std::size_t i) { return parts.size() > i ? std::atof(parts[i].c_str()) : 0.0; };
    CurvatureOptions options;
    if (kind == "rings" || kind == "corrected") {
        options.rings = static_cast<std::uint64_t>(number(1));
        if (parts.size() > 2)
            options.rim = parts[2] == "half"     ? Rim::half
                          : parts[2] == "closed" ? Rim::closed
                          : parts[2] == "open"   ? Rim::open
                                                 : Rim::dual;
        if (parts.size() > 2 && parts[2] == "kernel2") options.weight = Weight::kernel2;
        if (kind == "corrected") options.estimator = Estimator::corrected;
    } else if (kind == "jet") {
        options.estimator = Estimator::jet;
        options.jet_degree = static_cast<std::uint64_t>(number(1));
        options.rings = static_cast<std::uint64_t>(number(2));
    } else if (kind == "automatic") {
        options.estimator = Estimator::automatic;
    } else if (kind == "auto") {
        options.neighborhood = Neighborhood::automatic_ball;
        options.weight = parts.size() > 1 && parts[1] == "kernel2" ? Weight::kernel2 : Weight::indicator;
    } else {
        options.neighborhood = kind == "geodesic" ? Neighborhood::geodesic : Neighborhood::ball;
        options.radius.value = number(1) * h;
        const auto ends = [&](const char* name) { return kind.find(name) != std::string::npos; };
        options.weight = ends("kernel2") ? Weight::kernel2 : ends("kernel4") ? Weight::kernel4 : Weight::indicator;
        if (ends("corrected")) options.estimator = Estimator::corrected;
    }
    return options;
}

struct Errors {
    double value = 0.0, angle = 0.0, bias = 0.0, normal = 0.0, microseconds = 0.0;
    std::size_t far_off = 0;
};

double angle_of_lines(const Point3& a, const Point3& b) {
    return std::atan2(norm(cross(a, b)), std::abs(dot(a, b))) * degrees;
}

void add_errors(Errors& errors, const std::vector<Truth>& truth, const CurvatureResult& result, double share) {
    for (std::size_t v = 0; v < truth.size(); ++v) {
        const double relative = (result.k_max[v] - truth[v].k_max) / truth[v].k_max;
        const double angle = angle_of_lines(result.dir_min[v], truth[v].dir_min);
        errors.value += share * 100.0 * std::abs(relative);
        errors.bias += share * 100.0 * relative;
        errors.angle += share * angle;
        errors.far_off += angle > 30.0;
        errors.normal += share * std::acos(std::clamp(dot(result.normal[v], truth[v].normal), -1.0, 1.0)) * degrees;
    }
    for (const auto& [stage, seconds] : result.statistics.stage_seconds)
        if (stage == "estimate") errors.microseconds += share * 1e6 * seconds;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 6) {
        std::fprintf(stderr, "usage: curvature_accuracy torus|ellipsoid POINTS NOISE SEEDS METHOD...\n");
        return 2;
    }
    const bool torus = std::string(argv[1]) == "torus";
    const auto points = static_cast<std::uint32_t>(std::atoi(argv[2]));
    const double noise = std::atof(argv[3]);
    const int seeds = std::atoi(argv[4]);
    std::vector<Errors> errors(static_cast<std::size_t>(argc - 5));
    std::string choice;
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto number = static_cast<std::uint64_t>(seed);
        const TriangleMesh clean = torus ? generators::make_torus(2.0, 0.7, points, number)
                                         : generators::make_ellipsoid(2.0, 1.2, 0.8, points, number);
        std::vector<Truth> truth;
        for (const Point3& p : clean.positions) truth.push_back(torus ? torus_truth(p) : ellipsoid_truth(p));
        double area = 0.0;
        for (const Triangle& t : clean.triangles)
            area += 0.5 * norm(cross(clean.positions[index_of(t[1])] - clean.positions[index_of(t[0])],
                                     clean.positions[index_of(t[2])] - clean.positions[index_of(t[0])]));
        const TriangleMesh mesh =
            noise > 0.0 ? generators::make_noisy(clean, noise * std::sqrt(area / points), number + 1000) : clean;
        const double h = mean_edge(clean);
        for (std::size_t m = 0; m < errors.size(); ++m) {
            const CurvatureResult result =
                compute_curvature(mesh, options_of(argv[5 + m], h), RunControl{.threads = 1});
            add_errors(errors[m], truth, result, 1.0 / (static_cast<double>(points) * seeds));
            if (!result.statistics.choice.empty()) choice = result.statistics.choice;
        }
    }
    std::printf("%s, %u points, noise %g, %d seeds\n", argv[1], points, noise, seeds);
    std::printf("%-16s %9s %9s %9s %8s %9s %9s\n", "method", "k_max %", "bias %", "angle", "off > 30", "normal",
                "us/vertex");
    for (std::size_t m = 0; m < errors.size(); ++m) {
        const Errors& e = errors[m];
        std::printf("%-16s %9.3f %9.3f %9.3f %8zu %9.3f %9.2f\n", argv[5 + m], e.value, e.bias, e.angle, e.far_off,
                    e.normal, e.microseconds);
    }
    if (!choice.empty()) std::printf("automatic: %s\n", choice.c_str());
    return 0;
}
