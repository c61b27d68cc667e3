// Meshes of any origin against functions: certified, refuted for the right reason, or left undecided; never wrong.
#include <certa/implicit_mesh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/parallel.h"
#include "core/random.h"
#include "implicit/marching_cubes.h"
#include "implicit/simplify.h"
#include "implicit/topology.h"

namespace certa {
namespace {

constexpr const char* torus = "q = x^2+y^2\n(q+z^2+0.84)^2-4*q";
constexpr const char* tangle = "x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8";
/// A torus with a hole of radius 0.01.
constexpr const char* closing = "q = x^2+y^2\n(q+z^2+0.0199)^2-4*q";

/// Grids that no coordinate plane is in, within boxes that no grid is aligned with.
TriangleMesh march(const char* function, double half, int n) {
    return test::march_cubes(parse_expression(function), {-1.01 * half, -1.03 * half, -0.98 * half},
                             {0.99 * half, 0.97 * half, 1.02 * half}, n);
}
ImplicitMeshCheck check(const TriangleMesh& mesh, const char* function, double half) {
    return check_mesh_against(mesh, function, {-1.23 * half, -1.21 * half, -1.17 * half},
                              {1.19 * half, 1.22 * half, 1.25 * half});
}
std::string reason(const ImplicitMeshCheck& check) { return check.reasons.empty() ? "" : check.reasons.front(); }

TEST(AnyMesh, CoarseMarchingCubesOfATorusIsCertified) {
    const TriangleMesh mesh = march(torus, 1.9, 16);
    const ImplicitMeshCheck found = check(mesh, torus, 1.9);
    EXPECT_STREQ(name_of(found.verdict), "certified") << reason(found);
    EXPECT_EQ(found.mesh_genera, std::vector<int>{1});
    EXPECT_TRUE(found.faces_positive);
}

TEST(AnyMesh, TheTangleCubeIsCertifiedOrRefutedAsItsMeshIs) {
    const ImplicitMeshCheck fine = check(march(tangle, 2.8, 32), tangle, 2.8);
    EXPECT_STREQ(name_of(fine.verdict), "certified") << reason(fine);
    const TriangleMesh coarse = march(tangle, 2.8, 6);
    ASSERT_NE(test::measure(coarse).genera, std::vector<int>{5});
    const ImplicitMeshCheck rough = check(coarse, tangle, 2.8);
    EXPECT_STREQ(name_of(rough.verdict), "refuted");
    EXPECT_NE(reason(rough).find("the zero set 1 component of genus 5"), std::string::npos) << reason(rough);
}

TEST(AnyMesh, AHoleThatWasMissedIsRefuted) {
    const TriangleMesh mesh = march(closing, 2.1, 64);
    ASSERT_EQ(test::measure(mesh).genera, std::vector<int>{0});
    const ImplicitMeshCheck found = check(mesh, closing, 2.1);
    EXPECT_STREQ(name_of(found.verdict), "refuted");
    EXPECT_EQ(found.surface_genera, std::vector<int>{1});
}

/// Fixture: one verified W of the torus, many meshes.
class AgainstTorus : public testing::Test {
protected:
    static void SetUpTestSuite() {
        // W of the same job: it is made thicker where the mesh may be simplified.
        ImplicitResult result = mesh_implicit(parse_expression(torus), {-2.03, -2.03, -2.03}, {1.97, 1.97, 1.97},
                                              {.certificate = true, .error = 0.05});
        certificate_ = std::move(result.certificate);
        mesh_ = std::move(result.mesh);
    }
    ImplicitMeshCheck judge(const TriangleMesh& mesh) const { return judge_implicit_mesh(mesh, torus, certificate_); }
    void expect_refuted(const TriangleMesh& mesh, const char* why) const {
        const ImplicitMeshCheck found = judge(mesh);
        EXPECT_STREQ(name_of(found.verdict), "refuted") << why;
        EXPECT_NE(reason(found).find(why), std::string::npos) << reason(found);
    }
    static std::string certificate_;
    static TriangleMesh mesh_;
};
std::string AgainstTorus::certificate_;
TriangleMesh AgainstTorus::mesh_;

TEST_F(AgainstTorus, TheSimplifiedMeshIsCertified) {
    const ImplicitMeshCheck found = judge(mesh_);
    EXPECT_STREQ(name_of(found.verdict), "certified") << reason(found);
    EXPECT_TRUE(found.faces_positive);
    EXPECT_LT(mesh_.triangles.size(), 250u) << "202 without W";
    TriangleMesh turned = mesh_;
    for (Triangle& t : turned.triangles) std::swap(t[0], t[1]);
    EXPECT_STREQ(name_of(judge(turned).verdict), "certified");
    EXPECT_FALSE(judge(turned).faces_positive);
}

TEST_F(AgainstTorus, DamageIsRefutedForItsReason) {
    TriangleMesh mesh = mesh_;
    mesh.triangles.pop_back();
    expect_refuted(mesh, "is in 1 triangles");
    mesh = mesh_;
    mesh.triangles.push_back(mesh.triangles.front());
    expect_refuted(mesh, "is in 3 triangles");
    mesh = mesh_;
    mesh.triangles[3][1] = mesh.triangles[3][0];
    expect_refuted(mesh, "triangle 4 has no area");
    mesh = mesh_;
    mesh.triangles[3][1] = VertexId{1000000};
    expect_refuted(mesh, "triangle 4 names a vertex that does not exist");
    mesh = mesh_;
    mesh.positions[index_of(mesh.triangles[0][0])].y = NAN;
    expect_refuted(mesh, "not finite");
    // A vertex pulled through the tube.
    mesh = mesh_;
    Point3& p = mesh.positions[index_of(mesh.triangles[0][0])];
    p = {-p.x, -p.y, -p.z};
    expect_refuted(mesh, "the mesh touches itself");
    expect_refuted({}, "the mesh has 0 components");
}

/// A surface of revolution that is a torus, with given radii, moved.
TriangleMesh make_torus(double major, double minor, const Point3& move, int m, int n) {
    TriangleMesh mesh;
    for (int i = 0; i < m; ++i) {
        for (int j = 0; j < n; ++j) {
            const double u = 2 * M_PI * i / m, v = 2 * M_PI * j / n + 0.1;
            const double r = major + minor * std::cos(v);
            mesh.positions.push_back(
                {r * std::cos(u) + move.x, r * std::sin(u) + move.y, minor * std::sin(v) + move.z});
            const auto at = [&](int a, int b) { return VertexId{static_cast<std::uint32_t>((a % m) * n + b % n)}; };
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

// The right topology in the wrong place is no proof and no refutation.
TEST_F(AgainstTorus, ToriElsewhereAreLeftUndecided) {
    EXPECT_STREQ(name_of(judge(make_torus(1, 0.4, {}, 240, 120)).verdict), "certified");
    EXPECT_STREQ(name_of(judge(make_torus(1, 0.01, {}, 90, 6)).verdict), "undecided") << "inside the tube";
    EXPECT_STREQ(name_of(judge(make_torus(1, 0.4, {0.7, 0, 0}, 60, 30)).verdict), "undecided");
    EXPECT_STREQ(name_of(judge(make_torus(0.1, 0.03, {1.4, 0, 0}, 20, 10)).verdict), "undecided");
    EXPECT_STREQ(name_of(judge(make_torus(0.1, 0.03, {50, 0, 0}, 20, 10)).verdict), "undecided");
    TriangleMesh two = make_torus(1, 0.4, {}, 60, 30);
    const TriangleMesh other = make_torus(0.1, 0.03, {5, 0, 0}, 20, 10);
    const auto shift = static_cast<std::uint32_t>(two.positions.size());
    two.positions.insert(two.positions.end(), other.positions.begin(), other.positions.end());
    for (const Triangle& t : other.triangles)
        two.triangles.push_back(
            {VertexId{index_of(t[0]) + shift}, VertexId{index_of(t[1]) + shift}, VertexId{index_of(t[2]) + shift}});
    expect_refuted(two, "the mesh has 2 components");
}

/// A tube of triangles around a closed curve.
template <class Curve>
TriangleMesh make_tube(const Curve& curve, double radius, int m, int n) {
    TriangleMesh mesh;
    const auto minus = [](const Point3& a, const Point3& b) { return Point3{a.x - b.x, a.y - b.y, a.z - b.z}; };
    const auto unit = [](const Point3& a) {
        const double l = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
        return Point3{a.x / l, a.y / l, a.z / l};
    };
    const auto product = [](const Point3& a, const Point3& b) {
        return Point3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    };
    for (int i = 0; i < m; ++i) {
        const double t = 2 * M_PI * i / m, h = 1e-4;
        const Point3 at = curve(t), along = unit(minus(curve(t + h), curve(t - h)));
        const Point3 side = unit(product(along, Point3{0.1, 0.2, 1})), up = product(side, along);
        for (int j = 0; j < n; ++j) {
            const double a = radius * std::cos(2 * M_PI * j / n), b = radius * std::sin(2 * M_PI * j / n);
            mesh.positions.push_back(
                {at.x + a * side.x + b * up.x, at.y + a * side.y + b * up.y, at.z + a * side.z + b * up.z});
            const auto id = [&](int p, int q) { return VertexId{static_cast<std::uint32_t>((p % m) * n + q % n)}; };
            mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    }
    return mesh;
}

// Both are tori, one knotted: genera cannot tell them apart, W does.
TEST_F(AgainstTorus, AKnottedTubeIsNeverCertifiedAsAnUnknottedOne) {
    const auto trefoil = [](double scale) {
        return [scale](double t) {
            const double r = 1 + 0.2 * scale * std::cos(3 * t);
            return Point3{r * std::cos(2 * t), r * std::sin(2 * t), 0.2 * scale * std::sin(3 * t)};
        };
    };
    for (const double scale : {1.0}) {
        const TriangleMesh knot = make_tube(trefoil(scale), 0.08, 400, 10);
        const ImplicitMeshCheck found = check_mesh_against(knot, torus, {-2.03, -2.03, -2.03}, {1.97, 1.97, 1.97});
        EXPECT_STREQ(name_of(found.verdict), "undecided") << scale << reason(found);
        EXPECT_EQ(found.mesh_genera, std::vector<int>{1}) << reason(found);
        EXPECT_GT(found.triangle_count, 0u);
    }
}

TEST(AnyMesh, NestingIsCompared) {
    const char* shell = "r = x^2+y^2+z^2\n(r-1)*(r-0.16)";
    const Point3 from{-1.51, -1.53, -1.48}, to{3.1, 1.52, 1.55}, low{-1.93, -1.87, -1.81}, high{3.31, 1.97, 1.83};
    const TriangleMesh right = test::march_cubes(parse_expression(shell), from, to, 30);
    const ImplicitMeshCheck good = check_mesh_against(right, shell, low, high);
    EXPECT_STREQ(name_of(good.verdict), "certified") << reason(good);
    EXPECT_EQ(good.mesh_genera, (std::vector<int>{0, 0}));
    // Two such spheres, none within the other.
    const char* apart = "(x^2+y^2+z^2-1)*((x-2)^2+y^2+z^2-0.16)";
    const TriangleMesh wrong = test::march_cubes(parse_expression(apart), from, to, 30);
    ASSERT_EQ(test::measure(wrong).genera, (std::vector<int>{0, 0}));
    const ImplicitMeshCheck bad = check_mesh_against(wrong, shell, low, high);
    EXPECT_STREQ(name_of(bad.verdict), "refuted");
    EXPECT_NE(reason(bad).find("nested"), std::string::npos) << reason(bad);
}

TEST(AnyMesh, WhatHasNoTopologyIsLeftUndecidedWithItsPlace) {
    const TriangleMesh mesh = march(torus, 1.9, 16);
    const ImplicitMeshCheck found =
        check_mesh_against(mesh, "x^2+y^2-z^2-x^4-y^4-z^4+0*x", {-2, -2, -2}, {2.1, 2.1, 2.1});
    EXPECT_STREQ(name_of(found.verdict), "undecided");
    EXPECT_FALSE(found.surface_known);
    EXPECT_FALSE(found.obstacles.empty());
}

// Vertices of the simplified mesh lie on the zero set, triangles are few and well shaped, and the checker agrees.
TEST(Simplified, MeshesAreCertifiedAndWellShaped) {
    struct Case {
        const char* text;
        double low, high, error;
        std::size_t most;
    };
    for (const Case& c : {Case{torus, -2.03, 1.97, 0.02, 900}, Case{tangle, -3.03, 2.97, 0.04, 2000}}) {
        const ImplicitResult result = mesh_implicit(parse_expression(c.text), {c.low, c.low, c.low},
                                                    {c.high, c.high, c.high}, {.certificate = true, .error = c.error});
        ASSERT_STREQ(name_of(result.verdict), "certified");
        const test::MeshTopology topology = test::measure(result.mesh);
        EXPECT_EQ(topology.flaw, "");
        EXPECT_GT(topology.signed_volume, 0);
        EXPECT_LT(result.mesh.triangles.size(), c.most);
        EXPECT_EQ(result.triangle_components.size(), result.mesh.triangles.size());
        const Expression f = parse_expression(c.text);
        double off = 0, thinnest = 180;
        for (const Point3& p : result.mesh.positions) {
            const PointValue at = evaluate(f, p);
            off = std::max(off, std::fabs(at.value) / std::hypot(at.gradient.x, at.gradient.y, at.gradient.z));
        }
        for (const Triangle& t : result.mesh.triangles) {
            for (std::size_t i = 0; i < 3; ++i) {
                const auto way = [&](std::size_t k) {
                    const Point3 &p = result.mesh.positions[index_of(t[i])],
                                 &q = result.mesh.positions[index_of(t[(i + k) % 3])];
                    return Point3{q.x - p.x, q.y - p.y, q.z - p.z};
                };
                const Point3 a = way(1), b = way(2);
                thinnest = std::min(thinnest, std::acos((a.x * b.x + a.y * b.y + a.z * b.z) /
                                                        std::hypot(a.x, a.y, a.z) / std::hypot(b.x, b.y, b.z)) *
                                                  180 / M_PI);
            }
        }
        EXPECT_LT(off, 1e-9);
        EXPECT_GT(thinnest, 5);
        const ImplicitCheck check = check_implicit(result.mesh, c.text, result.certificate);
        EXPECT_TRUE(check.ok()) << check.violations.front();
        EXPECT_FALSE(check.hausdorff);
    }
}

TEST(Distance, IsProvedAndAFalseClaimIsNot) {
    const char* sphere = "x^2+y^2+z^2-1";
    const ImplicitResult result = mesh_implicit(parse_expression(sphere), {-2.03, -2.03, -2.03}, {1.97, 1.97, 1.97},
                                                {.certificate = true, .hausdorff = 0.05});
    ASSERT_TRUE(result.hausdorff);
    EXPECT_EQ(*result.hausdorff, 0.05);
    double farthest = 0;
    for (const Triangle& t : result.mesh.triangles) {
        Point3 m{};
        for (const VertexId v : t) {
            const Point3& p = result.mesh.positions[index_of(v)];
            m = {m.x + p.x / 3, m.y + p.y / 3, m.z + p.z / 3};
        }
        farthest = std::max(farthest, std::fabs(std::hypot(m.x, m.y, m.z) - 1));
    }
    EXPECT_LT(farthest, 0.05);
    const ImplicitCheck good = check_implicit(result.mesh, sphere, result.certificate);
    EXPECT_TRUE(good.ok()) << good.violations.front();
    ASSERT_TRUE(good.hausdorff);
    EXPECT_EQ(*good.hausdorff, 0.05);
    // The claim is at the end: half of it, or less, is false; more is true.
    const std::size_t comma = result.certificate.rfind(','), end = result.certificate.find(']', comma);
    const int exponent = std::stoi(result.certificate.substr(comma + 1, end - comma - 1));
    for (const int change : {-8, -2, 1, 20}) {
        std::string other = result.certificate;
        other.replace(comma + 1, end - comma - 1, std::to_string(exponent + change));
        const ImplicitCheck check = check_implicit(result.mesh, sphere, other);
        EXPECT_TRUE(change > 0 || !check.ok()) << change;
        EXPECT_TRUE(!check.ok() || *check.hausdorff > farthest) << change;
    }
    // One vertex pulled out of the surface, farther than the bound.
    TriangleMesh spoilt = result.mesh;
    Point3& p = spoilt.positions[5];
    p = {1.08 * p.x, 1.08 * p.y, 1.08 * p.z};
    EXPECT_FALSE(check_implicit(spoilt, sphere, result.certificate).ok());
}

// Two theorems, two programs, one answer.
TEST(Engines, Agree) {
    struct Case {
        const char* text;
        double low, high;
    };
    for (const Case& c :
         {Case{"x^2+y^2+z^2-1", -2.03, 1.97}, Case{torus, -2.03, 1.97}, Case{tangle, -3.03, 2.97},
          Case{"((x-1)^2+y^2+z^2)*((x+1)^2+y^2+z^2)-0.96059601", -2.03, 1.97},
          Case{"(x^2+y^2+z^2-1)^2-0.25", -2.03, 1.97}, Case{"x^8+y^8+z^8-1", -2.03, 1.97},
          Case{"x^2+y^2+z^2+0.01", -2.03, 1.97}, Case{"exp(x)+exp(-x)+y^2+z^2-3+0.3*sin(5*y)", -2.03, 1.97}}) {
        const Expression f = parse_expression(c.text);
        const Point3 low{c.low, c.low, c.low}, high{c.high, c.high, c.high};
        const ImplicitResult one = mesh_implicit(f, low, high),
                             two = mesh_implicit(f, low, high,
                                                 {.max_cells = 1'000'000, .engine = ImplicitEngine::plantinga_vegter});
        ASSERT_STREQ(name_of(one.verdict), name_of(two.verdict)) << c.text;
        std::vector<int> genera;
        for (const ImplicitComponent& component : one.components) genera.push_back(component.genus);
        std::sort(genera.begin(), genera.end());
        const test::MeshTopology topology = test::measure(two.mesh);
        EXPECT_EQ(topology.flaw, "") << c.text;
        EXPECT_EQ(topology.genera, genera) << c.text;
        EXPECT_GE(topology.signed_volume, 0) << c.text;
        std::vector<int> other;
        for (const ImplicitComponent& component : two.components) other.push_back(component.genus);
        std::sort(other.begin(), other.end());
        EXPECT_EQ(other, genera) << c.text;
    }
}

// Marching on the corners of leaves, balanced 2:1, found a second component here.
TEST(Engines, AgreeWhereASquareHasFourSignChanges) {
    const Expression f = parse_expression("x*x+y*y+z*z-5/2+(8016501717251449/18014398509481984)*atan(y*z-x)");
    const ImplicitResult result = mesh_implicit(f, {-2.28292925820797, -2.13, -2.17}, {2.11, 2.0600523034029061, 2.19},
                                                {.max_cells = 300'000, .engine = ImplicitEngine::plantinga_vegter});
    ASSERT_STREQ(name_of(result.verdict), "certified");
    const test::MeshTopology topology = test::measure(result.mesh);
    EXPECT_EQ(topology.flaw, "");
    EXPECT_EQ(topology.genera, std::vector<int>{0});
}

// The same certificate, with W by the thesis's watershed.
TEST(Engines, TheWatershedCertifiesTheSame) {
    struct Case {
        const char* text;
        std::vector<int> genera;
    };
    for (const Case& c : {Case{"x^2+y^2+z^2-1", {0}}, Case{torus, {1}}, Case{"(x^2+y^2+z^2-1)^2-0.25", {0, 0}},
                          Case{"((x-1)^2+y^2+z^2)*((x+1)^2+y^2+z^2)-0.9", {0, 0}}}) {
        const ImplicitResult result = mesh_implicit(parse_expression(c.text), {-2.03, -2.03, -2.03}, {1.97, 1.97, 1.97},
                                                    {.certificate = true, .engine = ImplicitEngine::thesis});
        ASSERT_STREQ(name_of(result.verdict), "certified") << c.text;
        const ImplicitCheck check = check_implicit(result.mesh, c.text, result.certificate);
        EXPECT_TRUE(check.ok() && check.isotopic) << c.text << (check.ok() ? "" : check.violations.front());
        EXPECT_EQ(check.genera, c.genera) << c.text;
    }
}

TEST(Engines, RefuseWhatTheyCannotDo) {
    const Expression f = parse_expression("x^2+y^2+z^2-1");
    const Point3 low{-2, -2, -2}, high{2, 2, 2};
    EXPECT_THROW(mesh_implicit(f, low, high, {.hausdorff = 0.1, .clip = true}), InputError);
    EXPECT_THROW(mesh_implicit(f, low, high, {.hausdorff = 0.1, .engine = ImplicitEngine::plantinga_vegter}),
                 InputError);
    EXPECT_THROW(mesh_implicit(f, low, high, {.engine = ImplicitEngine::plantinga_vegter, .clip = true}), InputError);
    EXPECT_THROW(mesh_implicit(f, low, high, {.engine = ImplicitEngine::thesis, .clip = true}), InputError);
    EXPECT_THROW(mesh_implicit(f, low, high, {.error = 0.1, .engine = ImplicitEngine::plantinga_vegter}), InputError);
    EXPECT_THROW(mesh_implicit(f, low, high, {.error = 0.1, .clip = true}), InputError);
    EXPECT_THROW(mesh_implicit(f, low, high, {.error = 0.0}), InputError);
    EXPECT_THROW(mesh_implicit(f, low, high, {.error = 1e-300}), InputError) << "what no mesh of 8 million reaches";
    EXPECT_THROW(mesh_implicit(f, low, high, {.hausdorff = 1e-13}), InputError);
    EXPECT_THROW(mesh_implicit(f, low, high, {.hausdorff = -1.0}), InputError);
    const ImplicitResult plane = mesh_implicit(parse_expression("x+2*y-z"), low, high,
                                               {.max_cells = 20000, .engine = ImplicitEngine::plantinga_vegter});
    EXPECT_STREQ(name_of(plane.verdict), "undecided");
    EXPECT_FALSE(plane.obstacles.empty());
}

/// Triangles of a surface simplified to an error, within W and without it.
std::array<std::size_t, 2> simplified(const char* text, double half, double error) {
    const Expression f = parse_expression(text);
    const Point3 low{-1.015 * half, -1.015 * half, -1.015 * half}, high{0.985 * half, 0.985 * half, 0.985 * half};
    ImplicitResult raw = mesh_implicit(f, low, high);
    implicit::Surface start;
    start.mesh = std::move(raw.mesh);
    start.component_of_triangle = std::move(raw.triangle_components);
    const ImplicitResult within = mesh_implicit(f, low, high, {.certificate = true, .error = error});
    EXPECT_TRUE(check_implicit(within.mesh, text, within.certificate).ok()) << text;
    return {within.mesh.triangles.size(),
            implicit::simplify(start, nullptr, expression::Tape(f), {error}, {}).value().mesh.triangles.size()};
}

// What keeps W from being as thick as the mesh may be far: here the frontier, critical leaves (long), both signs
// (long).
TEST(Simplified, CertaintyTakesFewTriangles) {
    const auto [within, without] = simplified("(x^2+y^2+z^2+0.84)^2-4*(x^2+y^2)", 2, 0.02);
    EXPECT_LE(static_cast<double>(within), 1.1 * static_cast<double>(without));
}

TEST(SimplifiedLong, CertaintyTakesFewTriangles) {
    for (const double error : {0.1, 0.05, 0.02}) {
        const auto [in_torus, torus_alone] = simplified("(x^2+y^2+z^2+0.84)^2-4*(x^2+y^2)", 2, error);
        EXPECT_LE(static_cast<double>(in_torus), 1.2 * static_cast<double>(torus_alone)) << error;
        const auto [in_cube, cube_alone] = simplified(tangle, 3, error);
        EXPECT_LE(static_cast<double>(in_cube), 1.2 * static_cast<double>(cube_alone)) << error;
        const auto [in_bretzel, bretzel_alone] = simplified("(x^2*(1-x^2)-y^2)^2+z^2-0.01", 1.6, error);
        EXPECT_LE(static_cast<double>(in_bretzel), 1.2 * static_cast<double>(bretzel_alone)) << error;
    }
}

/// Components and genera as dense sampling sees them; nothing where two resolutions disagree.
std::optional<std::vector<int>> sampled_genera(const Expression& f, const Point3& low, const Point3& high, int n) {
    std::vector<int> coarse = test::measure(test::march_cubes(f, low, high, 5 * n / 8)).genera;
    if (test::measure(test::march_cubes(f, low, high, n)).genera != coarse) return std::nullopt;
    return coarse;
}

enum class Comparison { undecided, agrees, agrees_when_finer, agrees_with_other_engine };

/// Sums of bumps, some with a wave. Where sampling disagrees it may have missed what is small: it is made finer, and if
/// that does not help the other engine, which shares no theorem with the first one, has the last word.
Comparison compare_with_sampling(std::uint64_t seed) {
    core::Random random(seed);
    Expression f = 0.35;
    const Expression x = Expression::x(), y = Expression::y(), z = Expression::z();
    for (int i = 0; i < 4; ++i) {
        const Expression r2 = pow(x - random.uniform(-0.9, 0.9), 2) + pow(y - random.uniform(-0.9, 0.9), 2) +
                              pow(z - random.uniform(-0.9, 0.9), 2);
        f = f - random.uniform(-0.3, 1.2) * exp(-random.uniform(2, 7) * r2);
    }
    if (random.coin(0.5))
        f = f + 0.1 * sin(3.0 * x + random.uniform(0, 3)) * sin(3.0 * y) * exp(-1.0 * (z * z + x * x + y * y));
    const Point3 low{-2.21, -2.13, -2.17}, high{2.11, 2.23, 2.19};
    RunControl alone;
    alone.threads = 1;
    const ImplicitResult result = mesh_implicit(f, low, high, {.max_cells = 60'000}, alone);
    if (result.verdict == ImplicitVerdict::undecided) return Comparison::undecided;
    std::vector<int> genera;
    for (const ImplicitComponent& component : result.components) genera.push_back(component.genus);
    std::sort(genera.begin(), genera.end());
    for (const int n : {40, 104}) {
        const auto sampled = sampled_genera(f, low, high, n);
        if (sampled == genera) return n == 40 ? Comparison::agrees : Comparison::agrees_when_finer;
    }
    const ImplicitResult other =
        mesh_implicit(f, low, high, {.max_cells = 1'000'000, .engine = ImplicitEngine::plantinga_vegter}, alone);
    EXPECT_NE(other.verdict, ImplicitVerdict::undecided) << "unresolved: seed " << seed;
    EXPECT_EQ(test::measure(other.mesh).genera, genera) << "seed " << seed << "\n" << format_expression(f);
    return Comparison::agrees_with_other_engine;
}

/// How many of each kind, the cases being independent: one thread each.
std::array<int, 4> compare_with_sampling(std::uint64_t first, std::uint64_t end) {
    std::vector<Comparison> found(end - first);
    core::parallel_for(found.size(), 1, {}, [&](std::size_t begin, std::size_t last) {
        for (std::size_t i = begin; i < last; ++i) found[i] = compare_with_sampling(first + i);
    });
    std::array<int, 4> count{};
    for (const Comparison c : found) ++count[static_cast<std::size_t>(c)];
    return count;
}

TEST(Sampling, AgreesWithWhatIsCertified) { EXPECT_GT(compare_with_sampling(1, 3)[1], 0); }

TEST(SamplingLong, AgreesWithWhatIsCertified) {
    const std::array<int, 4> count = compare_with_sampling(1000, 2000);
    std::printf("undecided %d, agrees %d, when finer %d, with the other engine %d\n", count[0], count[1], count[2],
                count[3]);
    EXPECT_GT(count[1] + count[2] + count[3], 900);
}

}  // namespace
}  // namespace certa
