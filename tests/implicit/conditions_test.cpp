// Each condition of the theorem fails when what it rests on is falsified: signs, marks, degrees.
#include "implicit/conditions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>

#include "implicit/refine.h"

namespace certa::implicit {
namespace {

class Conditions : public testing::Test {
protected:
    Conditions()
        : tape_(parse_expression("q = x^2+y^2\n(q+z^2+0.84)^2-4*q")),
          tree_(*Grid::around({-2.03, -2.03, -2.03}, {1.97, 1.97, 1.97})) {}

    /// Refines until the conditions hold.
    void SetUp() override {
        Field field(tape_);
        ASSERT_FALSE(classify(tree_, tape_, limits_, {}));
        clusters_ = find_clusters(tree_);
        for (;;) {
            triangulation_ = std::make_unique<Triangulation>(tree_, field, signs_);
            growth_ = grow(*triangulation_);
            const Findings found = check();
            if (found.offenders.empty()) break;
            ASSERT_FALSE(split_all(tree_, found.offenders, tape_, limits_, {}));
            clusters_ = find_clusters(tree_);
        }
    }

    Findings check() const { return check_conditions(tree_, *triangulation_, growth_, clusters_, tape_, {}); }

    expression::Tape tape_;
    Octree tree_;
    Limits limits_{1'000'000, 20};
    std::vector<Triangulation::PointSign> signs_;
    std::vector<Cluster> clusters_;
    std::unique_ptr<Triangulation> triangulation_;
    Growth growth_;
};

TEST_F(Conditions, HoldForTheTorus) {
    const Findings found = check();
    EXPECT_EQ(found.condition, nullptr);
    ASSERT_EQ(found.components.size(), 1u);
    EXPECT_EQ(found.components[0].euler(), 0);
    EXPECT_EQ(found.components[0].degree8, 0);
    EXPECT_EQ(found.components[0].inner_sign, -1);
}

TEST_F(Conditions, ADegreeThatIsOffIsFound) {
    for (Cluster& cluster : clusters_) {
        if (cluster.sign > 0) continue;
        cluster.degree8 += 8;
        EXPECT_STREQ(check().condition, "degree");
        EXPECT_FALSE(check().offenders.empty());
        cluster.degree8 -= 8;
    }
    EXPECT_EQ(check().condition, nullptr);
}

// Every mark is needed or harmless, never silently missed: without it W changes, and where a tetrahedron with both
// signs loses a point the collapse fails.
TEST_F(Conditions, AMissingMarkNextToTheSurfaceIsFound) {
    std::size_t found = 0;
    for (const auto& t : triangulation_->tetrahedra()) {
        if (triangulation_->sign(t[0]) == triangulation_->sign(t[1])) continue;
        growth_.marked[t[0]] = 0;
        EXPECT_STREQ(check().condition, "collapse");
        growth_.marked[t[0]] = 1;
        if (++found == 5) break;
    }
    EXPECT_EQ(found, 5u);
}

// Replaying the order of marks, each point passes the test of its link; in another order some does not.
TEST_F(Conditions, TheOrderOfMarksIsACertificate) {
    LinkTest test(triangulation_->point_count());
    std::vector<char> marked(triangulation_->point_count(), 0);
    for (const std::uint32_t point : growth_.order) {
        ASSERT_TRUE(test.may_join(*triangulation_, marked, point));
        marked[point] = 1;
    }
    EXPECT_EQ(marked, growth_.marked);
    std::fill(marked.begin(), marked.end(), 0);
    bool all = true;
    for (auto point = growth_.order.rbegin(); point != growth_.order.rend(); ++point) {
        all = all && test.may_join(*triangulation_, marked, *point);
        marked[*point] = 1;
    }
    EXPECT_FALSE(all);
}

// Condition 0 and 2: no point of a critical leaf and none of the box is ever marked.
TEST_F(Conditions, CriticalLeavesAndTheBoxStayOutside) {
    std::size_t critical = 0;
    for (std::size_t i = 0; i < triangulation_->active_leaves().size(); ++i) {
        const Cell& cell = tree_.cell(triangulation_->active_leaves()[i]);
        for (const auto& t : triangulation_->tetrahedra_of(i)) {
            for (const std::uint32_t point : t) {
                if (cell.is_critical()) {
                    EXPECT_FALSE(growth_.marked[point]);
                    EXPECT_EQ(triangulation_->sign(point), cell.known.sign);
                    ++critical;
                }
                EXPECT_FALSE(growth_.marked[point] && tree_.on_boundary(tree_.points()[point]));
            }
        }
    }
    EXPECT_GT(critical, 0u);
}

// The triangulation is conforming: a triangle of an inner tetrahedron belongs to two, and all are positive.
TEST_F(Conditions, TheTriangulationConforms) {
    std::map<std::array<std::uint32_t, 3>, int> faces;
    for (const auto& t : triangulation_->tetrahedra()) {
        __int128 d[3][3];
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t a = 0; a < 3; ++a)
                d[i][a] = static_cast<std::int64_t>(tree_.points()[t[i + 1]][a]) -
                          static_cast<std::int64_t>(tree_.points()[t[0]][a]);
        }
        const double volume =
            static_cast<double>(d[0][0]) * static_cast<double>(d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
            static_cast<double>(d[0][1]) * static_cast<double>(d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
            static_cast<double>(d[0][2]) * static_cast<double>(d[1][0] * d[2][1] - d[1][1] * d[2][0]);
        ASSERT_GT(volume, 0);
        for (std::size_t skip = 0; skip < 4; ++skip) {
            std::array<std::uint32_t, 3> face{};
            for (std::size_t i = 0, n = 0; i < 4; ++i) {
                if (i != skip) face[n++] = t[i];
            }
            std::sort(face.begin(), face.end());
            ++faces[face];
        }
    }
    for (const auto& [face, count] : faces) {
        ASSERT_LE(count, 2);
        ASSERT_TRUE(count == 2 || !(growth_.marked[face[0]] || growth_.marked[face[1]] || growth_.marked[face[2]]));
    }
}

// Limits met while leaves are split: what doubles carry is one of precision, all others are the caller's.
TEST(Limit, IsNamedAsWhatItIs) {
    const expression::Tape tape(parse_expression("x^2+y^2+z^2-1"));
    Octree tree(*Grid::around({-2, -2, -2}, {2, 2, 2}));
    std::uint32_t leaf = 0;
    while (tree.cell(leaf).depth < tree.max_depth()) leaf = tree.split(leaf);
    using Reason = ImplicitObstacle::Reason;
    const auto reason = [&](std::uint64_t cells, int depth, bool late) {
        Limits limits{cells, depth};
        if (late) limits.deadline = std::chrono::steady_clock::now() - std::chrono::seconds(1);
        const auto found = split_all(tree, {leaf}, tape, limits, {});
        EXPECT_TRUE(found && found->leaves == std::vector<std::uint32_t>{leaf});
        return found ? found->reason : Reason::cancelled;
    };
    EXPECT_EQ(reason(1'000'000, tree.max_depth(), false), Reason::precision);
    EXPECT_EQ(reason(1'000'000, 12, false), Reason::budget);
    EXPECT_EQ(reason(200, tree.max_depth(), false), Reason::budget);
    EXPECT_EQ(reason(1'000'000, tree.max_depth(), true), Reason::budget);
}

}  // namespace
}  // namespace certa::implicit
