// The mesher with its inner limits open: the guarantee path forced by tiny budgets, and the invariants that the thesis
// proves for its own schemes (Part I: Lemmas 1 and 2, Propositions 3 and 5), judged on the finished triangulation.
#include "conforming/engine.h"

#include <gtest/gtest.h>

#include <string>

#include "conforming/build_complex.h"
#include "conforming/facet_interior.h"
#include "conforming/growth.h"
#include "conforming/local_feature_size.h"
#include "conforming/protected_area.h"
#include "conforming/recovery.h"
#include "core/vector3.h"
#include "mesh/generators.h"

namespace certa::conforming {
namespace {

struct Named {
    std::string name;
    PiecewiseLinearComplex complex;
};

std::vector<Named> sharp_complexes() {
    std::vector<Named> all;
    for (const std::uint64_t seed : {1, 2}) {
        const std::string s = " seed " + std::to_string(seed);
        all.push_back({"fan in 90 degrees" + s, generators::make_fan(4, 1.57, seed)});
        all.push_back({"fan in 5 degrees" + s, generators::make_fan(4, 0.2, seed)});
        all.push_back({"cone" + s, generators::make_cone(4, 0.8, seed)});
        all.push_back({"mixture" + s, generators::make_mixture(seed)});
        all.push_back({"glued tetrahedra" + s, generators::make_glued_tetrahedra(4, seed)});
    }
    all.push_back({"nested cubes", generators::make_nested_cubes(2)});
    return all;
}

void expect_verified(const ConformResult& result, const PiecewiseLinearComplex& complex) {
    ASSERT_EQ(result.outcome, Outcome::done)
        << (result.obstacles.empty() ? "no obstacle" : result.obstacles.front().message);
    const ConformingCheck check = check_conforming(result.mesh, complex);
    EXPECT_TRUE(check.ok()) << check.violations.front().promise << ": " << check.violations.front().message;
}

TEST(Guarantee, TinyBudgetsRestartWithBallsAndStillConform) {
    std::size_t restarted = 0;
    for (const Named& named : sharp_complexes()) {
        SCOPED_TRACE(named.name);
        AttemptLimits limits;
        limits.owner_budget = 1;
        limits.total_budget = 0;
        const ConformResult result = mesh_complex(named.complex, {}, limits, {});
        expect_verified(result, named.complex);
        if (result.statistics.restarts > 0) {
            ++restarted;
            EXPECT_GT(result.statistics.protecting_balls, 0u);
        }
    }
    EXPECT_GE(restarted, 4u);
}

TEST(Guarantee, TheLastStageProtectsEverything) {
    for (const Named& named : sharp_complexes()) {
        SCOPED_TRACE(named.name);
        AttemptLimits limits;
        limits.owner_budget = 1;
        limits.restarts_before_all = 0;
        const ConformResult forced = mesh_complex(named.complex, {}, limits, {});
        expect_verified(forced, named.complex);
        if (forced.statistics.restarts == 0) continue;
        const ConformResult all = mesh_complex(named.complex, {.protection = Protection::all}, {}, {});
        EXPECT_EQ(forced.mesh.positions, all.mesh.positions);
    }
}

TEST(Guarantee, TrialsOfSplitRulesNeverAddPoints) {
    for (const Named& named : sharp_complexes()) {
        SCOPED_TRACE(named.name);
        AttemptLimits none, all;
        none.facets_for_trials = 0;
        all.added_for_trials = 1;
        const ConformResult plain = mesh_complex(named.complex, {}, none, {});
        const ConformResult tried = mesh_complex(named.complex, {}, all, {});
        expect_verified(tried, named.complex);
        EXPECT_LE(tried.mesh.positions.size(), plain.mesh.positions.size());
    }
}

TEST(Guarantee, TheProtectedSetGrowsUntilNothingIsLeft) {
    const Complex complex = build_complex(generators::make_nested_cubes(3));
    ProtectedSet set = protect_nothing(complex);
    const auto size = [&] {
        std::size_t n = 0;
        for (const std::uint8_t flag : set.vertices) n += flag;
        for (const std::uint8_t flag : set.segments) n += flag;
        return n;
    };
    const std::vector<Obstruction> obstructions{{{ElementKind::segment, 0}, no_index, {}, ""}};
    std::size_t before = size(), rounds = 0;
    while (grow_protected_set(set, complex, obstructions)) {
        ASSERT_GT(size(), before);
        before = size();
        ASSERT_LT(++rounds, 1000u);
    }
    EXPECT_EQ(size(), complex.points.size() + complex.segments.size());
}

// One run of the thesis's algorithm with everything that the invariants speak of.
struct ThesisRun {
    explicit ThesisRun(const PiecewiseLinearComplex& input, bool all)
        : complex(build_complex(input)), interior(build_facet_interior(complex)), mesh(complex) {
        const LocalFeatureSize feature_size(complex, interior);
        const ProtectingBalls balls = build_protecting_balls(
            complex, feature_size, all ? protect_all(complex) : protect_sharp(complex, interior));
        area = build_protected_area(complex, interior, balls);
        std::vector<Point3> points = complex.points;
        for (const NewPoint& p : area.points) points.push_back(p.position);
        initial_points = points.size();
        delaunay::Delaunay3 triangulation;
        triangulation.build(points);
        mesh.reset(std::move(triangulation), &area, PieceRule::gabriel);
        options.mirroring = false;
        Recovery recovery(mesh, &area, options, control);
        end = recovery.run({});
    }
    Complex complex;
    FacetInterior interior;
    ProtectedArea area;
    MeshState mesh;
    RecoveryOptions options;
    RunControl control;
    RecoveryResult end;
    std::size_t initial_points = 0;
};

// Lemma 1.
void expect_gabriel_shields(const ThesisRun& run) {
    const auto& points = run.mesh.triangulation.positions();
    for (const Piece& piece : run.mesh.pieces) {
        if (piece.rule != PieceRule::gabriel) continue;
        for (const Point3& p : points) {
            ASSERT_FALSE(encroaches(p, points[piece.a], points[piece.b], run.mesh.rounding));
        }
    }
}

// Lemma 2.
void expect_empty_balls(const ThesisRun& run) {
    for (std::size_t v = run.initial_points; v < run.mesh.triangulation.size(); ++v) {
        const Point3& p = run.mesh.triangulation.positions()[v];
        for (const Ball& ball : run.area.balls) {
            ASSERT_GE(distance(p, ball.center), ball.radius * (1.0 - 1e-9) - run.mesh.rounding);
        }
    }
}

// Proposition 3. Shields that were split have their halves' triangles.
void expect_gabriel_isosceles_triangles(const ThesisRun& run) {
    const auto& points = run.mesh.triangulation.positions();
    for (const Piece& piece : run.mesh.pieces) {
        if (!piece.shield) continue;
        const std::uint32_t center = run.area.ball_centers[piece.ball];
        ASSERT_TRUE(run.mesh.triangulation.has_face(center, piece.a, piece.b));
        for (std::size_t v = 0; v < points.size(); ++v) {
            if (v == center || v == piece.a || v == piece.b) continue;
            ASSERT_FALSE(
                delaunay::is_inside_diametral_ball(points[v], points[center], points[piece.a], points[piece.b]))
                << "vertex " << v;
        }
    }
}

// Proposition 5, up to its limit: the triangles' vertices lie on each other's diametral spheres by construction.
void expect_right_angled_triangles(const ThesisRun& run) {
    for (const RightTriangle& t : run.area.right_angled.values) {
        ASSERT_TRUE(run.mesh.triangulation.has_face(t.points[0], t.points[1], t.points[2]));
    }
}

TEST(Thesis, InvariantsHoldAtTheEnd) {
    for (const Named& named : sharp_complexes()) {
        for (const bool all : {false, true}) {
            SCOPED_TRACE(named.name + (all ? ", all" : ", sharp"));
            const ThesisRun run(named.complex, all);
            ASSERT_EQ(run.end.outcome, Outcome::done);
            expect_gabriel_shields(run);
            expect_empty_balls(run);
            expect_gabriel_isosceles_triangles(run);
            expect_right_angled_triangles(run);
        }
    }
}

}  // namespace
}  // namespace certa::conforming
