// The checker of certificates: what is wrong is found, whatever is changed in certificate, mesh or function. A change
// may leave a proof a proof; then what is proved is still true.
#include <certa/implicit.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "expression/random_expression.h"
#include "verify/implicit_function.h"
#include "verify/quick_enclosures.h"

namespace certa {
namespace {

constexpr const char* sphere = "x^2+y^2+z^2-1";

class Checked : public testing::Test {
protected:
    void SetUp() override {
        result_ =
            mesh_implicit(parse_expression(sphere), {-2.03, -2.03, -2.03}, {1.97, 1.97, 1.97}, {.certificate = true});
        ASSERT_EQ(result_.verdict, ImplicitVerdict::certified);
    }
    ImplicitCheck check() const { return check_implicit(result_.mesh, sphere, result_.certificate); }
    /// The certificate with the first occurrence of a text replaced.
    std::string replaced(const std::string& from, const std::string& to) const {
        std::string text = result_.certificate;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos);
        return text.replace(at, from.size(), to);
    }
    void expect_rejected(const std::string& certificate, const char* reason) const {
        const ImplicitCheck check = check_implicit(result_.mesh, sphere, certificate);
        EXPECT_EQ(check.verdict, ImplicitVerdict::undecided);
        ASSERT_FALSE(check.violations.empty());
        EXPECT_NE(check.violations.front().find(reason), std::string::npos) << check.violations.front();
    }
    ImplicitResult result_;
};

TEST_F(Checked, AcceptsWhatIsRight) {
    const ImplicitCheck good = check();
    EXPECT_TRUE(good.ok()) << good.violations.front();
    EXPECT_EQ(good.genera, std::vector<int>{0});
    EXPECT_EQ(good.triangles_checked, result_.mesh.triangles.size());
    EXPECT_TRUE(check_implicit(result_.mesh, "r = x*x + y*y + z*z\n(r - 1)  # the same", result_.certificate).ok());
    EXPECT_TRUE(check_implicit(result_.mesh, "2*(x^2+y^2+z^2-1)", result_.certificate).ok()) << "the same surface";
}

TEST_F(Checked, MemoryIsEstimatedFromTheLeavesOfTheLargestOctree) {
    const std::uint64_t bytes = 3000 * result_.statistics.leaves + result_.certificate.size();
    EXPECT_EQ(estimate_check_memory(result_.certificate), bytes);
    const std::string two = result_.certificate + "{\"octree\":\"aa\"}";
    EXPECT_EQ(estimate_check_memory(two), bytes + two.size() - result_.certificate.size());
    EXPECT_EQ(estimate_check_memory(""), 0u);
    EXPECT_EQ(estimate_check_memory("\"octree\""), 8u);
    EXPECT_EQ(estimate_check_memory("\"octree\":\"(abc"), 3000u * 3 + 14);
}

TEST_F(Checked, RejectsOtherFunctions) {
    for (const char* other : {"1-x^2-y^2-z^2", "x^2+y^2+z^2-2", "(x-0.5)^2+y^2+z^2-1", "x^2+y^2-1",
                              "x^2+y^2+z^2-1+1/(x-0.3)", "x", "", "x +", "min(x, y)", "x^y", "foo(x)", "x y"}) {
        EXPECT_FALSE(check_implicit(result_.mesh, other, result_.certificate).ok()) << other;
    }
}

TEST_F(Checked, IsForTheMeshThatItNames) {
    const TriangleMesh good = result_.mesh;
    const auto expect_other = [&](const char* what) {
        const ImplicitCheck other = check();
        ASSERT_FALSE(other.ok()) << what;
        EXPECT_NE(other.violations.front().find("digest"), std::string::npos) << what;
        result_.mesh = good;
    };
    result_.mesh.positions[7].x = std::nextafter(good.positions[7].x, 9.0);
    expect_other("a coordinate by its last bit");
    std::swap(result_.mesh.triangles[0], result_.mesh.triangles[1]);
    expect_other("two triangles exchanged");
    result_.mesh.positions.push_back({0, 0, 0});
    expect_other("an extra vertex");
    const std::size_t at = result_.certificate.find("\"mesh\":\"") + 8;
    result_.certificate[at] = result_.certificate[at] == '0' ? '1' : '0';
    expect_other("another digest");
}

TEST_F(Checked, RejectsOtherMeshes) {
    const TriangleMesh good = result_.mesh;
    result_.certificate.erase(result_.certificate.find("\"mesh\":"), 74);  // judged by what it is, not by its digest
    ASSERT_TRUE(check().ok());
    result_.mesh.positions[7].x = std::nextafter(good.positions[7].x, 9.0);
    EXPECT_NE(check().violations.front().find("vertex 8"), std::string::npos);
    result_.mesh = good;
    std::swap(result_.mesh.triangles[5][0], result_.mesh.triangles[5][1]);
    EXPECT_FALSE(check().ok()) << "a triangle turned over";
    result_.mesh = good;
    result_.mesh.triangles.pop_back();
    EXPECT_FALSE(check().ok()) << "a hole";
    result_.mesh = good;
    result_.mesh.triangles.push_back(good.triangles[3]);
    EXPECT_FALSE(check().ok()) << "a triangle twice";
    result_.mesh = good;
    result_.mesh.triangles[0][1] = VertexId{4000000};
    EXPECT_FALSE(check().ok()) << "an index out of range";
    result_.mesh = good;
    std::swap(result_.mesh.positions[0], result_.mesh.positions[1]);
    EXPECT_FALSE(check().ok()) << "two vertices exchanged";
    result_.mesh = good;
    result_.mesh.positions.push_back({0, 0, 0});
    EXPECT_FALSE(check().ok()) << "an extra vertex";
    result_.mesh = good;
    result_.mesh.positions[0].y = NAN;
    EXPECT_FALSE(check().ok()) << "no number";
    EXPECT_FALSE(check_implicit({}, sphere, result_.certificate).ok());
}

TEST_F(Checked, RejectsFalseClaims) {
    expect_rejected(replaced("\"genera\":[0]", "\"genera\":[1]"), "other genera");
    expect_rejected(replaced("\"version\":1", "\"version\":2"), "another version");
    expect_rejected(replaced("\"marks\":[", "\"marks\":[0,0,0,"), "no cone");
    expect_rejected(replaced("\"marks\":", "\"signs\":"), "unknown key");
    expect_rejected(replaced("\"negative_points\":[", "\"negative_points\":[1,"), "not three numbers");
    expect_rejected(replaced("\"octree\":\"(", "\"octree\":\"(("), "");
    expect_rejected(replaced("\"resolution\":30", "\"resolution\":29"), "");
    expect_rejected(result_.certificate + "x", "after the end");
    expect_rejected("", "cannot be read");
    expect_rejected("{}", "cannot be read");
    // A critical leaf around the origin ('c' + 7 s ...) that claims a slope, and one that claims the other sign.
    const std::size_t at = result_.certificate.find("\"octree\":\"") + 10;
    std::size_t critical = result_.certificate.find('a', at);
    ASSERT_LT(critical, result_.certificate.find('"', at)) << "negative, without slope";
    for (const char other : {'b', 'o', 'h', 'u'}) {
        std::string text = result_.certificate;
        text[critical] = other;
        EXPECT_FALSE(check_implicit(result_.mesh, sphere, text).ok()) << other;
    }
}

TEST_F(Checked, AMissingMarkOrAnotherOrderIsFound) {
    const std::size_t first = result_.certificate.find("\"marks\":[") + 9;
    const std::size_t last = result_.certificate.find(']', first);
    std::vector<std::string> numbers;
    for (std::size_t at = first; at < last;) {
        const std::size_t end = std::min(last, result_.certificate.find(',', at));
        numbers.push_back(result_.certificate.substr(at, end - at));
        at = end + 1;
    }
    const auto with_marks = [&](const std::vector<std::string>& marks) {
        std::string text = result_.certificate.substr(0, first);
        for (std::size_t i = 0; i < marks.size(); ++i) text += (i == 0 ? "" : ",") + marks[i];
        return text + result_.certificate.substr(last);
    };
    EXPECT_TRUE(check_implicit(result_.mesh, sphere, with_marks(numbers)).ok());
    EXPECT_FALSE(check_implicit(result_.mesh, sphere, with_marks({numbers.begin() + 3, numbers.end()})).ok());
    std::vector<std::string> reversed;
    for (std::size_t i = numbers.size(); i >= 3; i -= 3)
        reversed.insert(reversed.end(), numbers.begin() + static_cast<std::ptrdiff_t>(i) - 3,
                        numbers.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_FALSE(check_implicit(result_.mesh, sphere, with_marks(reversed)).ok());
}

// Any byte changed, any tail cut off: no crash, and nothing that is accepted is false.
TEST_F(Checked, SurvivesRandomDamage) {
    core::Random random(20);
    std::size_t rejected = 0;
    for (int i = 0; i < 150; ++i) {
        std::string text = result_.certificate;
        const std::size_t at = random.below(text.size());
        if (random.coin(0.2))
            text.resize(at);
        else
            text[at] = static_cast<char>("0123456789,[]{}\"()abcdefghijklmnopqrstu-"[random.below(41)]);
        const ImplicitCheck check = check_implicit(result_.mesh, sphere, text);
        if (!check.ok())
            ++rejected;
        else
            EXPECT_EQ(check.genera, std::vector<int>{0});
    }
    EXPECT_GT(rejected, 100u);
}

// The two readers of expressions, and their arithmetic, agree on the sign of random functions at random points.
TEST(TwoReaders, Agree) {
    core::Random random(7);
    const auto compare = [&](const std::string& text) {
        const verify::ImplicitFunction function(text);
        verify::Enclosures enclosures(function);
        const Expression expression = parse_expression(text);
        for (int i = 0; i < 5; ++i) {
            const Point3 p{random.uniform(0.1, 2), random.uniform(0.1, 2), random.uniform(0.1, 2)};
            const PointValue at = evaluate(expression, p);
            if (!std::isfinite(at.value) || std::fabs(at.value) < 1e-9 || std::fabs(at.value) > 1e100) continue;
            const verify::BoxOfDoubles box{{p.x, p.y, p.z}, {p.x, p.y, p.z}};
            EXPECT_TRUE(enclosures.proves_sign(box, at.value > 0 ? 1 : -1)) << text;
            EXPECT_FALSE(enclosures.proves_sign(box, at.value > 0 ? -1 : 1)) << text;
            const double slopes[3] = {at.gradient.x, at.gradient.y, at.gradient.z};
            for (int axis = 0; axis < 3; ++axis) {
                if (!std::isfinite(slopes[axis]) || std::fabs(slopes[axis]) < 1e-6) continue;
                EXPECT_TRUE(enclosures.proves_slope(box, axis, slopes[axis] > 0 ? 1 : -1)) << text << " axis " << axis;
            }
        }
    };
    for (const char* text :
         {"-x^2^2*--y^(1/3)+2^3^2*z^0.5-x^0+pi^2.5e0", "x^-2^2 - y*-z", "x - y - z/2/3",
          "a = x\n  b=a*a # twice\n\nb +\n a", "a = x; b = y;\r\nf = (a\n - b) * 3.", ".5*x^(1+1)-1e-2*y",
          "smooth_union(x, y, 1e-1) - smooth_difference(y, z, .2)", "smooth_intersection(x-1, y, 0.1)",
          "sqrt(x)*exp(-y)+log(z)-tan(x/4)+atan(y)", "sinh(x)-cosh(y)+tanh(z)", "x^1.7-y^0.3"})
        compare(text);
    for (int i = 0; i < 100; ++i) compare(format_expression(test::random_expression(random, 8)));
}

// What is 0 everywhere has no sign, however it is rounded: neither as it stands nor as a derivative.
TEST(QuickEnclosures, ClaimNoSignOfWhatIsZero) {
    core::Random random(11);
    for (const char* text :
         {"(x+1)-1-x", "x/3-x*(1/3)", "sqrt(x*x+1)^2-x*x-1", "exp(log(x+9))-x-9", "(x+y)^2-x^2-2*x*y-y^2",
          "sin(x)^2+cos(x)^2-1", "x^3*x^-2-x", "tan(x)-sin(x)/cos(x)", "x^1.5-x*sqrt(x)"}) {
        const verify::ImplicitFunction function(text);
        verify::QuickEnclosures quick(function);
        for (int i = 0; i < 100; ++i) {
            verify::BoxOfDoubles box{};
            for (std::size_t a = 0; a < 3; ++a) {
                box.low[a] = random.uniform(0.1, 1.5);
                box.high[a] = box.low[a] + (i % 3 == 0 ? 0.0 : random.uniform(0, 1e-7));
            }
            for (int axis = -1; axis < 3; ++axis) {
                EXPECT_FALSE(quick.proves_directly(box, axis, 1)) << text << " axis " << axis;
                EXPECT_FALSE(quick.proves_directly(box, axis, -1)) << text << " axis " << axis;
            }
        }
    }
}

// Signs of values and derivatives that are claimed of a box hold, by the derivatives of the library, at its points.
TEST(QuickEnclosures, ClaimsHoldAtPoints) {
    int claims = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        core::Random random(seed);
        const Expression f = test::random_expression(random, 3 + static_cast<int>(random.below(10)));
        const verify::ImplicitFunction function(format_expression(f));
        verify::QuickEnclosures quick(function);
        const double size = random.coin(0.5) ? 0.3 : 0.02;
        verify::BoxOfDoubles box{};
        for (std::size_t a = 0; a < 3; ++a) {
            box.low[a] = random.uniform(-1.5, 1.5);
            box.high[a] = box.low[a] + size * random.uniform();
        }
        int claimed[4] = {};
        for (int axis = -1; axis < 3; ++axis) {
            for (const int sign : {1, -1}) {
                if (quick.proves_directly(box, axis, sign)) claimed[axis + 1] = sign;
            }
            claims += claimed[axis + 1] != 0 ? 1 : 0;
        }
        for (int i = 0; i < 20; ++i) {
            double p[3];
            for (std::size_t a = 0; a < 3; ++a) p[a] = box.low[a] + (box.high[a] - box.low[a]) * random.uniform();
            const PointValue at = evaluate(f, {p[0], p[1], p[2]});
            const double values[4] = {at.value, at.gradient.x, at.gradient.y, at.gradient.z};
            for (int k = 0; k < 4; ++k) {
                if (claimed[k] == 0) continue;
                EXPECT_GT(values[k] * claimed[k], -1e-9 * std::fabs(values[k]) - 1e-12) << format_expression(f);
            }
        }
    }
    EXPECT_GT(claims, 300);
}

}  // namespace
}  // namespace certa
