// Surfaces that meet the box: components, genera and loops of what is certified, measured on the mesh itself; boxes
// that are touched; certificates with every field changed.
#include <certa/implicit.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "core/random.h"

namespace certa {
namespace {

using Form = std::pair<int, int>;  ///< genus, loops
using Forms = std::vector<Form>;
using Reason = ImplicitObstacle::Reason;

struct Measured {
    std::string flaw;
    Forms forms;
};

/// Counted from triangles alone: every edge in two triangles of opposite directions, or in one and then in a face of
/// the box; every boundary vertex on two boundary edges.
Measured measure(const ImplicitResult& result) {
    const TriangleMesh& mesh = result.mesh;
    Measured measured;
    std::vector<std::uint32_t> parents(mesh.positions.size());
    std::iota(parents.begin(), parents.end(), 0u);
    const auto find = [&](std::uint32_t i) {
        while (parents[i] != i) i = parents[i] = parents[parents[i]];
        return i;
    };
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = index_of(t[i]), b = index_of(t[(i + 1) % 3]);
            if (!edges.emplace(a, b).second) measured.flaw = "a directed edge occurs twice";
            parents[find(a)] = find(b);
        }
    }
    std::map<std::uint32_t, int> euler, loops;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) ++euler[find(v)];
    for (const Triangle& t : mesh.triangles) ++euler[find(index_of(t[0]))];
    std::map<std::uint32_t, std::uint32_t> rim;
    for (const auto& [a, b] : edges) {
        const bool inner = edges.count({b, a}) != 0;
        if (inner && a > b) continue;
        --euler[find(a)];
        if (inner) continue;
        const Point3 &p = mesh.positions[a], &q = mesh.positions[b];
        if (!((p.x == q.x && (p.x == result.low.x || p.x == result.high.x)) ||
              (p.y == q.y && (p.y == result.low.y || p.y == result.high.y)) ||
              (p.z == q.z && (p.z == result.low.z || p.z == result.high.z))))
            measured.flaw = "a boundary edge lies in no face of the box";
        if (!rim.emplace(a, b).second) measured.flaw = "a boundary vertex has two loops";
    }
    while (!rim.empty()) {
        const std::uint32_t start = rim.begin()->first;
        ++loops[find(start)];
        for (std::uint32_t at = start;;) {
            const auto step = rim.find(at);
            if (step == rim.end()) {
                if (at != start) measured.flaw = "a boundary loop does not close";
                break;
            }
            at = step->second;
            rim.erase(step);
        }
    }
    for (const auto& [root, characteristic] : euler)
        measured.forms.emplace_back((2 - loops[root] - characteristic) / 2, loops[root]);
    std::sort(measured.forms.begin(), measured.forms.end());
    return measured;
}

Forms forms_of(const ImplicitResult& result) {
    Forms forms;
    for (const ImplicitComponent& c : result.components) forms.emplace_back(c.genus, c.loops);
    std::sort(forms.begin(), forms.end());
    return forms;
}

Forms forms_of(const ImplicitCheck& check) {
    Forms forms;
    for (std::size_t i = 0; i < check.genera.size(); ++i) forms.emplace_back(check.genera[i], check.loops[i]);
    return forms;
}

struct Clipped {
    const char* name;
    const char* text;
    Point3 low, high;
    Forms forms;
};
void PrintTo(const Clipped& clipped, std::ostream* out) { *out << clipped.name; }

const ImplicitOptions clipping{.certificate = true, .clip = true};

class ClippedSurface : public testing::TestWithParam<Clipped> {};
class ClippedSurfaceLong : public testing::TestWithParam<Clipped> {};

void check_clipped(const Clipped& clipped) {
    const ImplicitResult result = mesh_implicit(parse_expression(clipped.text), clipped.low, clipped.high, clipping);
    ASSERT_EQ(result.verdict, ImplicitVerdict::certified) << name_of(result.obstacles.front().reason);
    EXPECT_FALSE(result.isotopic);
    EXPECT_EQ(forms_of(result), clipped.forms);
    const Measured measured = measure(result);
    EXPECT_EQ(measured.flaw, "");
    EXPECT_EQ(measured.forms, clipped.forms);
    const ImplicitCheck check = check_implicit(result.mesh, clipped.text, result.certificate);
    EXPECT_EQ(check.verdict, ImplicitVerdict::certified) << check.violations.front();
    EXPECT_FALSE(check.isotopic);
    EXPECT_EQ(forms_of(check), clipped.forms);
}

TEST_P(ClippedSurface, HasItsTypeAndLoops) { check_clipped(GetParam()); }
TEST_P(ClippedSurfaceLong, HasItsTypeAndLoops) { check_clipped(GetParam()); }

constexpr const char* sphere = "x^2+y^2+z^2-1";
constexpr const char* torus = "q = x^2+y^2\n(q+z^2+0.84)^2-4*q";

INSTANTIATE_TEST_SUITE_P(
    All, ClippedSurface,
    testing::Values(Clipped{"plane", "0.31*x+0.27*y+0.83*z-0.11", {-1, -1, -1}, {1, 1, 1}, {{0, 1}}},
                    Clipped{"octant", sphere, {0, 0, 0}, {2, 2, 2}, {{0, 1}}},
                    Clipped{"quarter_of_a_sphere", sphere, {-2, 0.1, 0.1}, {2, 2, 2}, {{0, 1}}},
                    Clipped{"sphere_inside", sphere, {-2.03, -2.03, -2.03}, {1.97, 1.97, 1.97}, {{0, 0}}},
                    Clipped{"nearly_tangent", sphere, {-2, -2, -2}, {0.999, 2, 2}, {{0, 1}}},
                    Clipped{"six_caps_cut_off", sphere, {-0.8, -0.8, -0.8}, {0.8, 0.8, 0.8}, {{0, 6}}},
                    Clipped{"eight_corners",
                            sphere,
                            {-0.6, -0.6, -0.6},
                            {0.6, 0.6, 0.6},
                            {{0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 1}}},
                    Clipped{"half_torus", torus, {-2, -2, 0.05}, {2, 2, 2}, {{0, 2}}},
                    Clipped{"torus_with_one_cut", torus, {-2, -2, -2}, {1.2, 2, 2}, {{1, 1}}},
                    Clipped{"quarter_torus", torus, {0.01, 0.02, 0.03}, {2, 2, 2}, {{0, 1}}},
                    Clipped{"two_sheets", "z^2-0.25", {-1, -1, -1}, {1, 1, 1.1}, {{0, 1}, {0, 1}}},
                    Clipped{"plane_next_to_the_grid", "z-0.1", {-1, -1, -1}, {1, 1, 1.2}, {{0, 1}}},
                    Clipped{"waves", "z-0.2*sin(4*x)*cos(3*y)", {-1, -1, -1}, {1, 1, 1}, {{0, 1}}}),
    [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(
    All, ClippedSurfaceLong,
    testing::Values(
        Clipped{"schwarz_p", "cos(x)+cos(y)+cos(z)", {-3, -3, -3}, {3, 3, 3}, {{0, 6}}},
        Clipped{"gyroid",
                "sin(x)*cos(y)+sin(y)*cos(z)+sin(z)*cos(x)",
                {-3.3, -3.3, -3.3},
                {3.1, 3.1, 3.1},
                {{0, 1}, {2, 1}}},
        Clipped{"clebsch",
                "81*(x^3+y^3+z^3)-189*(x^2*y+x^2*z+y^2*x+y^2*z+z^2*x+z^2*y)+54*x*y*z+126*(x*y+x*z+y*z)-9*(x^2+y^2+z^2)"
                "-9*(x+y+z)+1",
                {-1.03, -1.03, -1.03},
                {0.97, 0.97, 0.97},
                {{3, 1}}},
        Clipped{"hyperboloid", "x^2+y^2-z^2-0.1", {-1.2, -1.2, -1.2}, {1.3, 1.3, 1.3}, {{0, 2}}},
        Clipped{"half_tangle", "x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8", {-3.03, -3.03, 0.05}, {3, 3, 3}, {{1, 4}}},
        Clipped{"cylinder", "x^2+y^2-0.5", {-1, -1, -1}, {1, 1, 1}, {{0, 2}}}),
    [](const auto& info) { return std::string(info.param.name); });

struct Touching {
    const char* name;
    const char* text;
    Point3 low, high;
    Reason reason;
    Point3 place;  ///< of the obstacle; NaN: anywhere on that axis
};
void PrintTo(const Touching& touching, std::ostream* out) { *out << touching.name; }
constexpr double any = std::numeric_limits<double>::quiet_NaN();

class TouchedBox : public testing::TestWithParam<Touching> {};

TEST_P(TouchedBox, IsRefusedWithThePlace) {
    const Touching& t = GetParam();
    const ImplicitResult result = mesh_implicit(parse_expression(t.text), t.low, t.high, clipping);
    ASSERT_EQ(result.verdict, ImplicitVerdict::undecided);
    const ImplicitObstacle& box = result.obstacles.front();
    EXPECT_STREQ(name_of(box.reason), name_of(t.reason));
    EXPECT_TRUE(result.mesh.triangles.empty());
    const double low[3] = {box.low.x, box.low.y, box.low.z}, high[3] = {box.high.x, box.high.y, box.high.z},
                 place[3] = {t.place.x, t.place.y, t.place.z};
    for (std::size_t a = 0; a < 3; ++a) {
        if (std::isnan(place[a])) continue;
        EXPECT_LE(low[a], place[a] + 1e-6);
        EXPECT_GE(high[a], place[a] - 1e-6);
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, TouchedBox,
    testing::Values(
        Touching{"sphere_at_one_face", sphere, {-2, -2, -2}, {1, 2, 2}, Reason::tangent_to_box, {1, 0, 0}},
        Touching{"sphere_at_all_faces", sphere, {-1, -1, -1}, {1, 1, 1}, Reason::tangent_to_box, {any, any, any}},
        Touching{"sphere_at_an_edge", "x^2+y^2+z^2-2", {-2, -2, -2}, {1, 1, 2}, Reason::tangent_to_box, {1, 1, 0}},
        Touching{"cylinder_along_a_line", "x^2+y^2-1", {-2, -2, -2}, {1, 2, 2}, Reason::tangent_to_box, {1, 0, any}},
        Touching{"plane_in_a_face", "x-1", {-2, -2, -2}, {1, 2, 2}, Reason::tangent_to_box, {1, any, any}},
        Touching{"plane_along_an_edge", "x+y-2", {-2, -2, -2}, {1, 1, 2}, Reason::tangent_to_box, {1, 1, any}},
        Touching{"plane_through_a_corner", "x+y+z+3", {-1, -1, -1}, {1, 1, 1}, Reason::tangent_to_box, {-1, -1, -1}},
        // Defined and continuous up to x = -1, where the derivative is not.
        Touching{"root_from_a_face", "sqrt(x+1)-z", {-1, -1, -9}, {1, 1, 9}, Reason::singular, {-1, any, 0}},
        Touching{"cone_with_its_tip_in_a_face",
                 "x^2+y^2-z^2",
                 {-1.2, -1.2, 0},
                 {1.3, 1.3, 1.3},
                 Reason::singular,
                 {0, 0, 0}},
        Touching{
            "cone_inside", "(x-0.1)^2+y^2-z^2", {-1.2, -1.2, -0.6}, {1.3, 1.3, 0.7}, Reason::singular, {0.1, 0, 0}}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(ClippedSurface, EmptyIsCertified) {
    const ImplicitResult result = mesh_implicit(parse_expression("x^2+y^2+z^2+1"), {-1, -1, -1}, {1, 1, 1}, clipping);
    EXPECT_EQ(result.verdict, ImplicitVerdict::empty);
    EXPECT_EQ(check_implicit(result.mesh, "x^2+y^2+z^2+1", result.certificate).verdict, ImplicitVerdict::empty);
}

// The type in a box does not depend on the sign of f nor on the order of the axes.
TEST(RandomClippedSurface, TypeIsThatOfTheMirrorImage) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto bumps = [seed](const Expression& x, const Expression& y, const Expression& z) {
            core::Random inner(seed);
            Expression sum = 0.5;
            for (int i = 0; i < 3; ++i) {
                const Expression r2 = pow(x - inner.uniform(-0.8, 0.8), 2) + pow(y - inner.uniform(-0.8, 0.8), 2) +
                                      pow(z - inner.uniform(-0.8, 0.8), 2);
                sum = sum - inner.uniform(0.6, 1.2) * exp(-inner.uniform(3, 6) * r2);
            }
            return sum;
        };
        const Expression x = Expression::x(), y = Expression::y(), z = Expression::z();
        const ImplicitOptions options{.max_cells = 30'000, .clip = true};
        const ImplicitResult a = mesh_implicit(bumps(x, y, z), {-0.6, -0.7, -0.5}, {0.5, 0.6, 0.8}, options);
        const ImplicitResult b = mesh_implicit(-bumps(-y, z, x), {-0.5, -0.6, -0.7}, {0.8, 0.6, 0.6}, options);
        const ImplicitResult c = mesh_implicit(-bumps(y, z, x), {-0.5, -0.6, -0.7}, {0.8, 0.5, 0.6}, options);
        if (a.verdict != ImplicitVerdict::undecided) {
            EXPECT_EQ(measure(a).forms, forms_of(a)) << seed;
        }
        if (b.verdict != ImplicitVerdict::undecided) {
            EXPECT_EQ(measure(b).forms, forms_of(b)) << seed;
        }
        if (a.verdict == ImplicitVerdict::undecided || c.verdict == ImplicitVerdict::undecided) continue;
        EXPECT_EQ(forms_of(a), forms_of(c)) << seed;
    }
}

class ClippedCertificate : public testing::Test {
protected:
    void SetUp() override {
        result_ = mesh_implicit(parse_expression(sphere), {0, 0, 0}, {2, 2, 2}, clipping);
        ASSERT_EQ(result_.verdict, ImplicitVerdict::certified);
        ASSERT_TRUE(check_implicit(result_.mesh, sphere, result_.certificate).ok());
    }
    std::string replaced(const std::string& from, const std::string& to) const {
        std::string text = result_.certificate;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return at == std::string::npos ? text : text.replace(at, from.size(), to);
    }
    void expect_rejected(const std::string& certificate, const char* reason) const {
        const ImplicitCheck check = check_implicit(result_.mesh, sphere, certificate);
        EXPECT_EQ(check.verdict, ImplicitVerdict::undecided);
        EXPECT_TRUE(check.loops.empty());
        ASSERT_FALSE(check.violations.empty()) << reason;
        EXPECT_TRUE(std::any_of(check.violations.begin(), check.violations.end(), [&](const std::string& v) {
            return v.find(reason) != std::string::npos;
        })) << check.violations.front();
    }
    /// The numbers of a list, by key.
    std::vector<std::string> list(const std::string& key) const {
        const std::size_t first = result_.certificate.find("\"" + key + "\":[") + key.size() + 4;
        std::vector<std::string> numbers;
        for (std::size_t at = first, last = result_.certificate.find(']', first); at < last;) {
            const std::size_t end = std::min(last, result_.certificate.find(',', at));
            numbers.push_back(result_.certificate.substr(at, end - at));
            at = end + 1;
        }
        return numbers;
    }
    std::string with_list(const std::string& key, const std::vector<std::string>& numbers) const {
        const std::size_t first = result_.certificate.find("\"" + key + "\":[") + key.size() + 4;
        std::string text = result_.certificate.substr(0, first);
        for (std::size_t i = 0; i < numbers.size(); ++i) text += (i == 0 ? "" : ",") + numbers[i];
        return text + result_.certificate.substr(result_.certificate.find(']', first));
    }
    ImplicitResult result_;
};

TEST_F(ClippedCertificate, RejectsFalseClaims) {
    expect_rejected(replaced("\"loops\":[1]", "\"loops\":[0]"), "other genera");
    expect_rejected(replaced("\"loops\":[1]", "\"loops\":[1,1]"), "other genera");
    expect_rejected(replaced("\"loops\":[1]", "\"loops\":[]"), "other genera");
    expect_rejected(replaced("\"genera\":[0]", "\"genera\":[1]"), "other genera");
    expect_rejected(replaced(",\n\"loops\":[1]", ""), "touches the box and claims no sign");
    expect_rejected(replaced("\"marks\":[", "\"marks\":[0,0,0,"), "no cone");
    expect_rejected(replaced("\"loops\":", "\"holes\":"), "unknown key");
    const ImplicitCheck other = check_implicit(result_.mesh, "x^2+y^2+z^2-4", result_.certificate);
    EXPECT_FALSE(other.ok()) << "a sphere that touches the faces";
}

TEST_F(ClippedCertificate, EveryLeafsClaimCounts) {
    const std::size_t first = result_.certificate.find("\"octree\":\"") + 10;
    const std::size_t last = result_.certificate.find('"', first);
    for (std::size_t at = first; at < last; at += 1 + (last - first) / 25) {
        std::string text = result_.certificate;
        for (const char c : {'a', 'h', 'k', 'u'}) {
            text[at] = c;
            if (c == result_.certificate[at]) continue;
            const ImplicitCheck check = check_implicit(result_.mesh, sphere, text);
            if (check.ok()) {
                EXPECT_EQ(forms_of(check), Forms({{0, 1}})) << "letter " << at - first << " " << c;
            }
        }
    }
}

TEST_F(ClippedCertificate, EveryMarkCounts) {
    const std::vector<std::string> marks = list("marks");
    ASSERT_GT(marks.size(), 60u);
    std::size_t rejected = 0, tried = 0;
    for (std::size_t at = 0; at + 3 <= marks.size(); at += 3 * (1 + marks.size() / 3 / 25)) {
        std::vector<std::string> fewer = marks;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(at),
                    fewer.begin() + static_cast<std::ptrdiff_t>(at) + 3);
        const ImplicitCheck check = check_implicit(result_.mesh, sphere, with_list("marks", fewer));
        ++tried;
        rejected += check.ok() ? 0 : 1;
        if (check.ok()) {
            EXPECT_EQ(forms_of(check), Forms({{0, 1}}));
        }
    }
    EXPECT_GT(2 * rejected, tried);
}

TEST_F(ClippedCertificate, SurvivesRandomDamage) {
    core::Random random(21);
    std::size_t rejected = 0;
    for (int i = 0; i < 100; ++i) {
        std::string text = result_.certificate;
        text[random.below(text.size())] =
            static_cast<char>("0123456789,[]{}\"()abcdefghijklmnopqrstu-"[random.below(41)]);
        const ImplicitCheck check = check_implicit(result_.mesh, sphere, text);
        rejected += check.ok() ? 0 : 1;
        if (check.ok()) {
            EXPECT_EQ(forms_of(check), Forms({{0, 1}}));
        }
    }
    EXPECT_GT(rejected, 60u);
}

TEST_F(ClippedCertificate, RejectsOtherMeshes) {
    result_.certificate.erase(result_.certificate.find("\"mesh\":"), 74);
    TriangleMesh mesh = result_.mesh;
    ASSERT_TRUE(check_implicit(mesh, sphere, result_.certificate).ok());
    mesh.triangles.pop_back();
    EXPECT_FALSE(check_implicit(mesh, sphere, result_.certificate).ok());
    mesh = result_.mesh;
    mesh.positions.front() = {mesh.positions.front().x + 1e-9, mesh.positions.front().y + 2e-9,
                              mesh.positions.front().z + 5e-9};
    EXPECT_FALSE(check_implicit(mesh, sphere, result_.certificate).ok());
}

}  // namespace
}  // namespace certa
