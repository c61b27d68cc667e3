// Surfaces whose topology is known: components, genera, nesting and orientation of what is certified, measured on the
// mesh itself; and functions about which nothing may be claimed.
#include <certa/implicit.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstring>

#include "core/random.h"
#include "implicit/topology.h"

namespace certa {
namespace {

ImplicitResult mesh(const char* text, double low, double high, const ImplicitOptions& options = {}) {
    return mesh_implicit(parse_expression(text), {low, low, low}, {high, high, high}, options);
}

std::vector<int> sorted_genera(const ImplicitResult& result) {
    std::vector<int> genera;
    for (const ImplicitComponent& component : result.components) genera.push_back(component.genus);
    std::sort(genera.begin(), genera.end());
    return genera;
}

struct Known {
    const char* name;
    const char* text;
    double low, high;
    std::vector<int> genera;
};

void PrintTo(const Known& known, std::ostream* out) { *out << known.name; }

void check_known(const Known& known) {
    const ImplicitResult result = mesh(known.text, known.low, known.high, {.certificate = true});
    ASSERT_EQ(result.verdict, ImplicitVerdict::certified) << name_of(result.obstacles.front().reason);
    EXPECT_EQ(result.outcome, Outcome::done);
    EXPECT_EQ(sorted_genera(result), known.genera);
    const test::MeshTopology measured = test::measure(result.mesh);
    EXPECT_EQ(measured.flaw, "");
    EXPECT_EQ(measured.genera, known.genera);
    EXPECT_EQ(result.triangle_components.size(), result.mesh.triangles.size());
    for (const ImplicitComponent& c : result.components) EXPECT_EQ(c.degree, c.inner_sign * (c.genus - 1));
    const ImplicitCheck check = check_implicit(result.mesh, known.text, result.certificate);
    EXPECT_EQ(check.verdict, ImplicitVerdict::certified) << check.violations.front();
    EXPECT_EQ(check.genera, known.genera);
    // Vertices straddle the zero set: f changes sign within an edge's length.
    const Expression f = parse_expression(known.text);
    double worst = 0;
    for (std::size_t i = 0; i < result.mesh.positions.size(); i += 1 + result.mesh.positions.size() / 200) {
        const PointValue at = evaluate(f, result.mesh.positions[i]);
        const double slope = std::hypot(at.gradient.x, at.gradient.y, at.gradient.z);
        worst = std::max(worst, std::fabs(at.value) / (slope * measured.longest_edge));
    }
    EXPECT_LT(worst, 1.0);
}

class KnownSurface : public testing::TestWithParam<Known> {};
class KnownSurfaceLong : public testing::TestWithParam<Known> {};
TEST_P(KnownSurface, HasItsTopology) { check_known(GetParam()); }
TEST_P(KnownSurfaceLong, HasItsTopology) { check_known(GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    All, KnownSurface,
    testing::Values(Known{"sphere", "x^2+y^2+z^2-1", -2.03, 1.97, {0}},
                    Known{"sphere_with_zeros_at_corners", "x^2+y^2+z^2-1", -2, 2, {0}},
                    Known{"inverted_sphere", "1-x^2-y^2-z^2", -2.03, 1.97, {0}},
                    Known{"sphere_as_distance", "sqrt(x^2+y^2+z^2)-1", -2.03, 1.97, {0}},
                    Known{"flat_ellipsoid", "x^2+y^2+2500*z^2-1", -2.03, 1.97, {0}},
                    Known{"torus", "q = x^2+y^2\n(q+z^2+0.84)^2-4*q", -2.03, 1.97, {1}},
                    Known{"tangle_cube", "x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8", -3.03, 2.97, {5}},
                    Known{"chmutov_4", "(8*x^4-8*x^2+1)+(8*y^4-8*y^2+1)+(8*z^4-8*z^2+1)", -1.23, 1.21, {5}},
                    Known{"two_cassini", "((x-1)^2+y^2+z^2)*((x+1)^2+y^2+z^2)-0.96059601", -2.03, 1.97, {0, 0}},
                    Known{"one_cassini", "((x-1)^2+y^2+z^2)*((x+1)^2+y^2+z^2)-1.04060401", -2.03, 1.97, {0}},
                    Known{
                        "cassini_at_a_millionth", "((x-1)^2+y^2+z^2)*((x+1)^2+y^2+z^2)-0.999999", -2.03, 1.97, {0, 0}},
                    Known{"monkey_saddle", "(x^2+y^2)^2+2*(x^3-3*x*y^2)+z^2+0.05", -2.53, 2.47, {0, 0, 0}},
                    Known{"blended", "smooth_union(x^2+y^2+z^2-1, (x-1.2)^2+y^2+z^2-0.3, 0.1)", -2.53, 2.47, {0}}),
    [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(
    All, KnownSurfaceLong,
    testing::Values(Known{"shell_with_a_critical_sphere", "(x^2+y^2+z^2-1)^2-0.25", -2.03, 1.97, {0, 0}},
                    Known{"sphere_with_a_small_cavity",
                          "(x^2+y^2+z^2-1)*((x-0.31)^2+(y-0.2)^2+(z+0.1)^2-0.0001)",
                          -2.03,
                          1.97,
                          {0, 0}},
                    Known{"waves", "x^2+y^2+z^2-1+0.2*sin(9*x)*sin(9*y)*sin(9*z)", -2.03, 1.97, {0}},
                    Known{"double_torus", "(x^2*(1-x^2)-y^2)^2+z^2-0.01", -1.63, 1.57, {2}}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(CertifiedSurface, FacesLookTowardsPositiveValues) {
    EXPECT_GT(test::measure(mesh("x^2+y^2+z^2-1", -2.03, 1.97).mesh).signed_volume, 3.5);
    EXPECT_LT(test::measure(mesh("1-x^2-y^2-z^2", -2.03, 1.97).mesh).signed_volume, -3.5);
    EXPECT_EQ(mesh("1-x^2-y^2-z^2", -2.03, 1.97).components.front().inner_sign, 1);
}

TEST(CertifiedSurface, NestingIsReported) {
    const ImplicitResult shell = mesh("(x^2+y^2+z^2-1)*((x-0.2)^2+y^2+z^2-0.2)", -2.03, 1.97);
    ASSERT_EQ(shell.components.size(), 2u);
    const std::size_t inner = shell.components[0].parent ? 0 : 1;
    EXPECT_EQ(shell.components[inner].parent, std::optional<std::uint32_t>(1 - inner));
    EXPECT_FALSE(shell.components[1 - inner].parent);
    EXPECT_EQ(shell.components[1 - inner].inner_sign, -1);
    EXPECT_EQ(shell.components[inner].inner_sign, 1);
}

TEST(CertifiedSurface, SameBytesForAnyNumberOfThreads) {
    const Expression f = parse_expression("q = x^2+y^2\n(q+z^2+0.84)^2-4*q");
    RunControl one, two;
    one.threads = 1;
    two.threads = 2;
    for (const ImplicitOptions& options : {ImplicitOptions{.certificate = true}, {.certificate = true, .error = 0.1}}) {
        const ImplicitResult a = mesh_implicit(f, {-2, -2, -2}, {2.1, 2.1, 2.1}, options, one);
        const ImplicitResult b = mesh_implicit(f, {-2, -2, -2}, {2.1, 2.1, 2.1}, options, two);
        ASSERT_EQ(a.mesh.positions.size(), b.mesh.positions.size());
        EXPECT_EQ(
            std::memcmp(a.mesh.positions.data(), b.mesh.positions.data(), a.mesh.positions.size() * sizeof(Point3)), 0);
        EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
        EXPECT_EQ(a.certificate, b.certificate);
        EXPECT_EQ(a.statistics.evaluations, b.statistics.evaluations);
    }
}

TEST(EmptySurface, IsCertified) {
    for (const char* text : {"x^2+y^2+z^2+1", "x^2+y^2+z^2+1e-6", "-1", "exp(x)+y^2", "(x-9)^2+y^2+z^2-1"}) {
        const ImplicitResult result = mesh(text, -2.03, 1.97, {.certificate = true});
        EXPECT_EQ(result.verdict, ImplicitVerdict::empty) << text;
        EXPECT_EQ(check_implicit(result.mesh, text, result.certificate).verdict, ImplicitVerdict::empty) << text;
        EXPECT_TRUE(result.mesh.triangles.empty()) << text;
    }
}

struct Hopeless {
    const char* name;
    const char* text;
    double low, high;
    ImplicitObstacle::Reason reason;
    Point3 place;  ///< lies in the first obstacle
};

void PrintTo(const Hopeless& hopeless, std::ostream* out) { *out << hopeless.name; }

class HopelessSurface : public testing::TestWithParam<Hopeless> {};

TEST_P(HopelessSurface, IsUndecidedWithItsPlace) {
    const Hopeless& hopeless = GetParam();
    const ImplicitResult result = mesh(hopeless.text, hopeless.low, hopeless.high);
    ASSERT_EQ(result.verdict, ImplicitVerdict::undecided);
    EXPECT_NE(result.outcome, Outcome::done);
    EXPECT_TRUE(result.mesh.triangles.empty());
    EXPECT_TRUE(result.components.empty());
    ASSERT_FALSE(result.obstacles.empty());
    EXPECT_STREQ(name_of(result.obstacles.front().reason), name_of(hopeless.reason));
    if (std::isnan(hopeless.place.x)) return;
    const ImplicitObstacle& box = result.obstacles.front();
    const double slack = 1e-6;
    EXPECT_LE(box.low.x, hopeless.place.x + slack);
    EXPECT_LE(hopeless.place.x, box.high.x + slack);
    EXPECT_LE(box.low.y, hopeless.place.y + slack);
    EXPECT_LE(hopeless.place.y, box.high.y + slack);
    EXPECT_LE(box.low.z, hopeless.place.z + slack);
    EXPECT_LE(hopeless.place.z, box.high.z + slack);
}

using Reason = ImplicitObstacle::Reason;
constexpr double anywhere = std::numeric_limits<double>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    All, HopelessSurface,
    testing::Values(
        Hopeless{"double_cone", "(x-0.1)^2+(y-0.2)^2-(z-0.3)^2+0*x", -1.53, 1.47, Reason::singular, {0.1, 0.2, 0.3}},
        Hopeless{"pinched_spindle", "(x^2+y^2)+z^2*(z-1)*(z+1)", -2.03, 1.97, Reason::singular, {0, 0, 0}},
        Hopeless{
            "touching_spheres", "((x-1)^2+y^2+z^2-1)*((x+1)^2+y^2+z^2-1)", -2.53, 2.47, Reason::singular, {0, 0, 0}},
        Hopeless{"crossing_spheres",
                 "((x-0.5)^2+y^2+z^2-1)*((x+0.5)^2+y^2+z^2-1)",
                 -2.53,
                 2.47,
                 Reason::singular,
                 {anywhere, 0, 0}},
        Hopeless{"double_sphere", "(x^2+y^2+z^2-1)^2", -2.03, 1.97, Reason::singular, {anywhere, 0, 0}},
        Hopeless{"one_point", "x^2+y^2+z^2", -2.03, 1.97, Reason::singular, {0, 0, 0}},
        Hopeless{"zero", "0*x", -2.03, 1.97, Reason::singular, {anywhere, 0, 0}},
        Hopeless{"plane", "x+2*y-z", -2.03, 1.97, Reason::meets_box, {anywhere, 0, 0}},
        Hopeless{"touches_the_box", "x^2+y^2+z^2-1", -1, 1, Reason::meets_box, {anywhere, 0, 0}},
        // Everywhere some partial derivative is not 0, but f is C1 nowhere on the ridge x = 0.
        Hopeless{"ridge", "sqrt(x^2)+y^2+z^2-1", -2.03, 1.97, Reason::singular, {anywhere, 0, 0}},
        Hopeless{"octahedron", "sqrt(x^2)+sqrt(y^2)+sqrt(z^2)-1", -2.03, 1.97, Reason::singular, {anywhere, 0, 0}},
        Hopeless{"undefined_at_a_plane", "log(x)^2+y^2+z^2-0.1", -2.03, 1.97, Reason::undefined, {anywhere, 0, 0}},
        Hopeless{"pole", "x^2+y^2+z^2-1+1e-9/x^2", -2.03, 1.97, Reason::undefined, {anywhere, 0, 0}}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Undecided, ByBudgetDepthMemoryAndCancellation) {
    const char* tangle = "x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8";
    const ImplicitResult small = mesh(tangle, -3.03, 2.97, {.max_cells = 1000});
    EXPECT_EQ(small.verdict, ImplicitVerdict::undecided);
    EXPECT_EQ(small.outcome, Outcome::over_budget);
    EXPECT_EQ(small.obstacles.front().reason, Reason::budget);
    const ImplicitResult shallow = mesh(tangle, -3.03, 2.97, {.max_depth = 3});
    EXPECT_EQ(shallow.verdict, ImplicitVerdict::undecided);
    EXPECT_EQ(shallow.outcome, Outcome::over_budget);
    EXPECT_EQ(shallow.obstacles.front().reason, Reason::budget) << "not that it meets the box, or is singular";
    for (const std::uint64_t depth : {1, 2, 4, 5, 6, 7}) {
        const ImplicitResult sphere = mesh("x^2+y^2+z^2-1", -2.03, 1.97, {.max_depth = depth});
        if (sphere.verdict == ImplicitVerdict::undecided)
            EXPECT_EQ(sphere.obstacles.front().reason, Reason::budget) << depth;
    }
    // The same surface with a quarter of the memory that it is estimated to take, and with enough.
    const ImplicitResult tight = mesh(tangle, -3.03, 2.97, {.memory_bytes = 15'000'000});
    EXPECT_EQ(tight.verdict, ImplicitVerdict::undecided);
    EXPECT_EQ(tight.outcome, Outcome::over_budget);
    EXPECT_EQ(tight.obstacles.front().reason, Reason::budget);
    EXPECT_TRUE(tight.mesh.triangles.empty());
    EXPECT_EQ(mesh(tangle, -3.03, 2.97, {.memory_bytes = 60'000'000}).verdict, ImplicitVerdict::certified);
    const std::atomic<bool> stop{true};
    RunControl control;
    control.cancel = &stop;
    const ImplicitResult stopped = mesh_implicit(parse_expression(tangle), {-3, -3, -3}, {3, 3, 3}, {}, control);
    EXPECT_EQ(stopped.outcome, Outcome::cancelled);
}

TEST(Refused, BoxesThatMakeNoSense) {
    const Expression f = parse_expression("x^2+y^2+z^2-1");
    EXPECT_THROW(mesh_implicit(f, {1, 1, 1}, {-1, -1, -1}), InputError);
    EXPECT_THROW(mesh_implicit(f, {0, 0, 0}, {1, 1, 0}), InputError);
    EXPECT_THROW(mesh_implicit(f, {0, 0, 0}, {1, 1, NAN}), InputError);
    EXPECT_THROW(mesh_implicit(f, {1e15, 0, 0}, {1e15 + 1, 1, 1}), InputError);
    EXPECT_THROW(mesh_implicit(f, {-2, -2, -2}, {2, 2, 2}, {.max_cells = 3}), InputError);
    std::fesetround(FE_UPWARD);
    bool refused = false;
    try {
        mesh_implicit(f, {-2, -2, -2}, {2, 2, 2});
    } catch (const InternalError&) {
        refused = true;
    }
    std::fesetround(FE_TONEAREST);
    EXPECT_TRUE(refused);
}

// A random sum of bumps has some topology; it is the same for -f, on a shifted box and with the axes exchanged.
void check_on_two_grids(std::uint64_t seed) {
    const auto bumps = [seed](const Expression& x, const Expression& y, const Expression& z) {
        core::Random inner(seed);
        Expression sum = 0.4;
        for (int i = 0; i < 3; ++i) {
            const Expression r2 = pow(x - inner.uniform(-0.8, 0.8), 2) + pow(y - inner.uniform(-0.8, 0.8), 2) +
                                  pow(z - inner.uniform(-0.8, 0.8), 2);
            sum = sum - inner.uniform(0.5, 1.2) * exp(-inner.uniform(3, 8) * r2);
        }
        return sum;
    };
    const Expression x = Expression::x(), y = Expression::y(), z = Expression::z();
    const ImplicitOptions options{.max_cells = 40'000};
    const ImplicitResult a = mesh_implicit(bumps(x, y, z), {-2, -2, -2}, {2, 2, 2}, options);
    const ImplicitResult b = mesh_implicit(-bumps(y, z, x), {-2.1, -2.3, -1.9}, {1.95, 2.2, 2.4}, options);
    if (a.verdict == ImplicitVerdict::undecided || b.verdict == ImplicitVerdict::undecided) return;
    EXPECT_EQ(sorted_genera(a), sorted_genera(b)) << "seed " << seed;
    EXPECT_EQ(test::measure(a.mesh).genera, sorted_genera(a)) << "seed " << seed;
    EXPECT_EQ(test::measure(b.mesh).genera, sorted_genera(b)) << "seed " << seed;
}

TEST(RandomSurface, TopologyDoesNotDependOnTheGrid) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) check_on_two_grids(seed);
}

TEST(RandomSurfaceLong, TopologyDoesNotDependOnTheGrid) {
    for (std::uint64_t seed = 100; seed < 200; ++seed) check_on_two_grids(seed);
}

}  // namespace
}  // namespace certa
