// Products by factors: what is certified where surfaces come close, what touches, what a changed certificate claims;
// and families whose gap closes: cells grow with its logarithm.
#include <certa/implicit.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "implicit/topology.h"

namespace certa {
namespace {

using Reason = ImplicitObstacle::Reason;

ImplicitResult mesh(const std::string& text, const ImplicitOptions& options = {.certificate = true}) {
    return mesh_implicit(parse_expression(text), {-2.53, -2.53, -2.53}, {2.47, 2.47, 2.47}, options);
}

std::vector<int> genera_of(const ImplicitResult& result) {
    std::vector<int> genera;
    for (const ImplicitComponent& c : result.components) genera.push_back(c.genus);
    std::sort(genera.begin(), genera.end());
    return genera;
}

std::string spheres_at(const std::string& half_distance) {
    return "((x-" + half_distance + ")^2+y^2+z^2-1)*((x+" + half_distance + ")^2+y^2+z^2-1)";
}

void expect_certified(const std::string& text, const std::vector<int>& genera, bool isotopic) {
    const ImplicitResult result = mesh(text);
    ASSERT_EQ(result.verdict, ImplicitVerdict::certified) << text;
    EXPECT_EQ(result.isotopic, isotopic) << text;
    EXPECT_EQ(genera_of(result), genera) << text;
    EXPECT_EQ(test::measure(result.mesh).flaw, "") << text;
    EXPECT_EQ(test::measure(result.mesh).genera, genera) << text;
    const ImplicitCheck check = check_implicit(result.mesh, text, result.certificate);
    EXPECT_EQ(check.verdict, ImplicitVerdict::certified) << check.violations.front();
    EXPECT_EQ(check.isotopic, isotopic) << text;
    EXPECT_EQ(check.genera, genera) << text;
}

TEST(Product, TypeOfCloseSurfacesIsCertified) {
    expect_certified(spheres_at("1.0005"), {0, 0}, false);
    expect_certified(spheres_at("1.0000005"), {0, 0}, false);
    expect_certified("(x^2+y^2+z^2-1)*(x^2+y^2+z^2-1.0404)", {0, 0}, false);
}

TEST(Product, IsotopyIsCertifiedWhereTheWholeAllowsIt) {
    expect_certified("(x^2+y^2+z^2-1)*((x-1.4)^2+(y-1.1)^2+(z+0.9)^2-0.0001)", {0, 0}, true);
    expect_certified("-(x^2+y^2+z^2-1)*(x^2+y^2+3)/1", {0}, true);
    expect_certified("2*(x^2+y^2+z^2-1)*(x^2+0.5)", {0}, true);
}

TEST(Product, FacesLookTowardsPositiveValuesOfTheProduct) {
    EXPECT_GT(test::measure(mesh(spheres_at("1.0005")).mesh).signed_volume, 7);
    EXPECT_LT(test::measure(mesh("-3*" + spheres_at("1.0005")).mesh).signed_volume, -7);
    // A shell: the inner sphere faces inwards.
    const double shell = test::measure(mesh("(x^2+y^2+z^2-1)*(x^2+y^2+z^2-1.0404)").mesh).signed_volume;
    EXPECT_GT(shell, 0);
    EXPECT_LT(shell, 1.5);
}

TEST(Product, SurfacesThatMeetAreRefusedWithThePlace) {
    for (const char* half_distance : {"1", "0.7"}) {
        const ImplicitResult result = mesh(spheres_at(half_distance));
        ASSERT_EQ(result.verdict, ImplicitVerdict::undecided);
        EXPECT_EQ(result.obstacles.front().reason, Reason::singular);
        EXPECT_LT(std::abs(result.obstacles.front().low.x), 1e-6);
        EXPECT_LT(result.obstacles.front().high.x - result.obstacles.front().low.x, 1e-6);
    }
    EXPECT_EQ(mesh("(x^2+y^2+z^2-1)*(x-0.2)").verdict, ImplicitVerdict::undecided);
    EXPECT_EQ(mesh("(x^2+y^2+z^2-1)*(x^2+y^2+z^2-1)").verdict, ImplicitVerdict::undecided);
    EXPECT_EQ(mesh("(x^2+y^2+z^2-1)*log(x)").obstacles.front().reason, Reason::undefined);
}

TEST(Product, ClippedFactorsToo) {
    const std::string text = "(z-0.1)*(z+0.1)*(x^2+y^2+(z-1)^2-0.25)";
    const ImplicitResult result =
        mesh_implicit(parse_expression(text), {-1, -1, -1}, {1, 1, 1.2}, {.certificate = true, .clip = true});
    ASSERT_EQ(result.verdict, ImplicitVerdict::certified);
    const ImplicitCheck check = check_implicit(result.mesh, text, result.certificate);
    EXPECT_TRUE(check.ok()) << check.violations.front();
    EXPECT_EQ(check.loops, (std::vector<int>{1, 1, 1}));
    EXPECT_FALSE(check.isotopic);
}

class ProductCertificate : public testing::Test {
protected:
    void SetUp() override {
        result_ = mesh(text_);
        ASSERT_TRUE(check_implicit(result_.mesh, text_, result_.certificate).ok());
        ASSERT_FALSE(result_.isotopic);
    }
    void expect_rejected(const std::string& function, const std::string& certificate) const {
        const ImplicitCheck check = check_implicit(result_.mesh, function, certificate);
        EXPECT_EQ(check.verdict, ImplicitVerdict::undecided) << function;
        EXPECT_TRUE(check.genera.empty());
        EXPECT_FALSE(check.isotopic);
    }
    std::string replaced(const std::string& from, const std::string& to) const {
        std::string text = result_.certificate;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return at == std::string::npos ? text : text.replace(at, from.size(), to);
    }
    const std::string text_ = spheres_at("1.0005");
    ImplicitResult result_;
};

TEST_F(ProductCertificate, AcceptsTheSameProductWrittenOtherwise) {
    EXPECT_TRUE(check_implicit(result_.mesh, "-(2/3)*" + text_, result_.certificate).ok());
    EXPECT_TRUE(check_implicit(result_.mesh, "a = (x-1.0005)^2+y^2+z^2-1; b = (x+1.0005)^2+y^2+z^2-1; a*b*pi",
                               result_.certificate)
                    .ok());
}

TEST_F(ProductCertificate, RejectsOtherFunctions) {
    for (const std::string& other :
         {spheres_at("1"), spheres_at("1.1"), "0*" + text_, "x*" + text_, text_ + "*(x^2+1)", text_ + "+1e-9",
          std::string("((x+1.0005)^2+y^2+z^2-1)*((x-1.0005)^2+y^2+z^2-1)"), std::string("(x-1.0005)^2+y^2+z^2-1"),
          std::string("((x-1.0005)^2+y^2+z^2-1)*((x-1.0005)^2+y^2+z^2-1)"), "sqrt(x)*" + text_, std::string()})
        expect_rejected(other, result_.certificate);
}

TEST_F(ProductCertificate, RejectsFalseClaims) {
    expect_rejected(text_, replaced("\"version\":1", "\"version\":2"));
    expect_rejected(text_, replaced("certa implicit product", "certa implicit certificate"));
    expect_rejected(text_, replaced("\"vertices\":[", "\"vertices\":[1,"));
    expect_rejected(text_, replaced("\"vertices\":[", "\"vertices\":[-"));
    expect_rejected(text_, replaced("\"triangles\":[", "\"triangles\":[1"));
    expect_rejected(text_, replaced("\"genera\":[0]", "\"genera\":[1]"));
    expect_rejected(text_, replaced("\"marks\":[", "\"marks\":[0,0,0,"));
    expect_rejected(text_, replaced("\"exponent\":[", "\"exponent\":[1"));
    // One factor's certificate for both.
    const std::size_t first = result_.certificate.find("{\"format\":\"certa implicit certificate\"");
    const std::size_t second = result_.certificate.find("{\"format\":\"certa implicit certificate\"", first + 1);
    const std::string one = result_.certificate.substr(first, result_.certificate.rfind(',', second) - first);
    expect_rejected(text_, result_.certificate.substr(0, first) + one + "]}");
    expect_rejected(text_, result_.certificate.substr(0, first) + one + "," + one + "]}");
    expect_rejected(text_, one);
    const std::size_t whole = result_.certificate.find_last_of('}');  // a line's end behind it says nothing
    for (std::size_t length = 0; length <= whole; length += whole / 9)
        expect_rejected(text_, result_.certificate.substr(0, length));
}

TEST_F(ProductCertificate, RejectsOtherMeshes) {
    TriangleMesh mesh = result_.mesh;
    mesh.positions[0].x += 1e-12;
    const ImplicitCheck bound = check_implicit(mesh, text_, result_.certificate);
    ASSERT_FALSE(bound.ok());
    EXPECT_NE(bound.violations.front().find("digest"), std::string::npos);
    // Without digests meshes are judged by what they are.
    while (result_.certificate.find("\"mesh\":") != std::string::npos)
        result_.certificate.erase(result_.certificate.find("\"mesh\":"), 74);
    mesh = result_.mesh;
    ASSERT_TRUE(check_implicit(mesh, text_, result_.certificate).ok());
    std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
    EXPECT_FALSE(check_implicit(mesh, text_, result_.certificate).ok()) << "one triangle turned over";
    mesh = result_.mesh;
    mesh.triangles.pop_back();
    EXPECT_FALSE(check_implicit(mesh, text_, result_.certificate).ok());
    mesh = result_.mesh;
    mesh.positions.push_back({0, 0, 0});
    EXPECT_FALSE(check_implicit(mesh, text_, result_.certificate).ok());
    mesh = result_.mesh;
    mesh.triangles.back()[0] = VertexId{0};
    EXPECT_FALSE(check_implicit(mesh, text_, result_.certificate).ok()) << "a triangle between two factors";
}

// Leaves needed as the gap goes from 1e-1 to 1e-6: a constant number more for each digit.
struct Family {
    const char* name;
    std::string (*text)(int digits);
    std::vector<int> genera;
};
void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }
std::string gap(int digits) { return "1e-" + std::to_string(digits); }
std::string ovals(const std::string& level) { return "((x-1)^2+y^2+z^2)*((x+1)^2+y^2+z^2)-1" + level; }

class ClosingFamily : public testing::TestWithParam<Family> {};

TEST_P(ClosingFamily, NeedsCellsByTheLogarithmOfTheGap) {
    std::vector<std::uint64_t> leaves;
    for (int digits = 1; digits <= 6; ++digits) {
        const std::string text = GetParam().text(digits);
        const ImplicitResult result = mesh(text, {});
        ASSERT_EQ(result.verdict, ImplicitVerdict::certified) << text;
        EXPECT_EQ(genera_of(result), GetParam().genera) << text;
        leaves.push_back(result.statistics.leaves);
        EXPECT_LT(leaves.back(), 1500u + 900u * static_cast<unsigned>(digits)) << text;
    }
    // Linear in the digits: the second half of them costs no more than twice the first and a round.
    EXPECT_LT(leaves[5], 2 * leaves[2] + 2000);
}

INSTANTIATE_TEST_SUITE_P(All, ClosingFamily,
                         testing::Values(Family{"two_cassini_ovals", [](int d) { return ovals("+" + gap(d)); }, {0, 0}},
                                         Family{"closing_neck", [](int d) { return ovals("-" + gap(d)); }, {0}},
                                         Family{"tiny_component",
                                                [](int d) {
                                                    return "(x^2+y^2+z^2-1)*((x-1.4)^2+(y-1.1)^2+(z+0.9)^2-1e-" +
                                                           std::to_string(2 * d) + ")";
                                                },
                                                {0, 0}}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(ClosingSpheres, NeedCellsByTheLogarithmOfTheGap) {
    for (int digits = 2; digits <= 6; digits += 2) {
        // By the type; where the whole is certified too, that is what counts, at larger gaps.
        const std::string text = spheres_at("(1+0.5e-" + std::to_string(digits) + ")");
        const ImplicitResult result = mesh(text, {});
        ASSERT_EQ(result.verdict, ImplicitVerdict::certified) << text;
        EXPECT_EQ(genera_of(result), (std::vector<int>{0, 0}));
        if (!result.isotopic) {
            EXPECT_LT(result.statistics.leaves, 3000u) << text;
        }
    }
}

}  // namespace
}  // namespace certa
