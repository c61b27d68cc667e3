// The options of `conform`, how it is stopped, and that nothing but input and options decides the result.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <thread>

#include "conforming/conform_support.h"
#include "core/random.h"
#include "mesh/generators.h"

namespace certa::test {
namespace {

using namespace generators;

RunControl with_threads(unsigned threads) {
    RunControl control;
    control.threads = threads;
    return control;
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(ConformOptionRange, OutOfRangeIsRefused) {
    const PiecewiseLinearComplex box = make_box({0, 0, 0}, {1, 1, 1});
    const std::vector out{DefectKind::option_out_of_range};
    for (const double alpha : {0.0, -0.1, 0.5, 1.0, nan, infinity}) {
        SCOPED_TRACE(alpha);
        EXPECT_EQ(expect_refused(box, {.alpha = alpha}), out);
    }
    for (const double length : {-1e-300, -1.0, nan}) {
        SCOPED_TRACE(length);
        for (const bool relative : {false, true}) {
            EXPECT_EQ(expect_refused(box, {.planarity = {length, relative}}), out);
            EXPECT_EQ(expect_refused(box, {.min_feature = {length, relative}}), out);
        }
    }
    for (const double alpha : {0.01, 0.25, 0.499}) expect_conforms(box, {.alpha = alpha});
}

TEST(ConformInput, NothingToMeshIsRefused) {
    EXPECT_EQ(expect_refused({}), std::vector{DefectKind::empty_input});
    PiecewiseLinearComplex few;
    for (const Point3& p : {Point3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}) {
        put_point(few, p);
        EXPECT_EQ(expect_refused(few), std::vector{DefectKind::empty_input});
    }
    put_point(few, {0.3, 0.3, 0.0});
    EXPECT_EQ(expect_refused(few), std::vector{DefectKind::empty_input});
    put_facet(few, {{0, 1, 2}});
    EXPECT_EQ(expect_refused(few), std::vector{DefectKind::empty_input});
    put_point(few, {0, 0, 1e-3});
    expect_conforms(few);
}

TEST(ConformInput, BadIndicesAndCoordinatesAreRefused) {
    PiecewiseLinearComplex box = make_box({0, 0, 0}, {1, 1, 1});
    for (const double bad : {nan, infinity, -infinity}) {
        PiecewiseLinearComplex c = box;
        c.positions[3].y = bad;
        EXPECT_EQ(expect_refused(c), std::vector{DefectKind::non_finite_coordinate});
    }
    PiecewiseLinearComplex far = box;
    far.positions[3].y = 1e300;
    EXPECT_FALSE(expect_refused(far).empty());
    PiecewiseLinearComplex c = box;
    c.corners[5] = VertexId{8};
    EXPECT_EQ(expect_refused(c), std::vector{DefectKind::index_out_of_range});
    c = box;
    put_segment(c, 0, no_index);
    EXPECT_EQ(expect_refused(c), std::vector{DefectKind::index_out_of_range});
}

TEST(ConformInput, CrossingFacetsAreRefusedByName) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {2, 2, 2});
    put_box(c, {1, 1, 1}, {3, 3, 3});
    try {
        conform(c);
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
        for (const Defect& d : error.defects()) {
            if (d.kind != DefectKind::crossing_facets) continue;
            ASSERT_EQ(d.elements.size(), 2u);
            pairs.emplace(std::min(d.elements[0].index, d.elements[1].index),
                          std::max(d.elements[0].index, d.elements[1].index));
        }
        // Each of the three faces of the first box at (2, 2, 2) crosses two of the three of the second at (1, 1, 1).
        EXPECT_EQ(pairs.size(), 6u);
    }
}

// --- budget and smallest feature ---

void expect_partial(const ConformResult& result, const PiecewiseLinearComplex& complex) {
    EXPECT_FALSE(result.obstacles.empty());
    ASSERT_GE(result.mesh.positions.size(), complex.positions.size());
    EXPECT_FALSE(result.mesh.tetrahedra.empty());
    for (const Tetrahedron& t : result.mesh.tetrahedra) {
        const auto at = [&](int i) { return result.mesh.positions[index_of(t[i])]; };
        const Point3 a = at(0), b = at(1), c = at(2), d = at(3);
        const double volume = (b.x - a.x) * ((c.y - a.y) * (d.z - a.z) - (c.z - a.z) * (d.y - a.y)) -
                              (b.y - a.y) * ((c.x - a.x) * (d.z - a.z) - (c.z - a.z) * (d.x - a.x)) +
                              (b.z - a.z) * ((c.x - a.x) * (d.y - a.y) - (c.y - a.y) * (d.x - a.x));
        EXPECT_GT(volume, -1e-12);
    }
    EXPECT_FALSE(check_conforming(result.mesh, complex).ok()) << "a partial result that conforms is not partial";
}

TEST(ConformBudget, EndsWithAPlaceAndAPartialMesh) {
    const PiecewiseLinearComplex fan = make_fan(12, 0.1, 4);
    const ConformResult whole = expect_conforms(fan);
    const std::size_t needed = whole.mesh.positions.size();
    ASSERT_GT(needed, fan.positions.size() + 100);
    for (const std::size_t budget : {fan.positions.size(), fan.positions.size() + 1, needed / 2, needed - 1}) {
        SCOPED_TRACE(budget);
        const ConformOptions options{.max_points = budget};
        const ConformResult result = conform(fan, options);
        EXPECT_EQ(result.outcome, Outcome::over_budget);
        expect_well_formed(result, fan, options);
        expect_partial(result, fan);
    }
    for (const std::size_t budget : {needed, needed + 1, 10 * needed}) {
        SCOPED_TRACE(budget);
        EXPECT_TRUE(same_result(whole, expect_conforms(fan, {.max_points = budget})));
    }
}

TEST(ConformBudget, NothingToAddNeedsNone) {
    const PiecewiseLinearComplex box = make_box({0, 0, 0}, {1, 1, 1});
    EXPECT_EQ(expect_conforms(box, {.max_points = 8}).mesh.positions.size(), 8u);
}

TEST(ConformBudget, HoldsForBallsToo) {
    for (const Protection protection : {Protection::sharp, Protection::all}) {
        const PiecewiseLinearComplex fan = make_fan(8, 0.05, 4);
        for (const std::size_t budget : {18u, 60u, 300u}) {
            const ConformOptions options{.protection = protection, .max_points = budget};
            const ConformResult result = conform(fan, options);
            EXPECT_EQ(result.outcome, Outcome::over_budget);
            expect_well_formed(result, fan, options);
        }
    }
}

TEST(ConformSmallestFeature, EndsWithAPlace) {
    const PiecewiseLinearComplex fan = make_fan(12, 0.1, 4);
    for (const Length length : {Length{0.2, false}, {0.05, true}}) {
        const ConformOptions options{.min_feature = length};
        const ConformResult result = conform(fan, options);
        EXPECT_EQ(result.outcome, Outcome::below_min_feature);
        expect_well_formed(result, fan, options);
        expect_partial(result, fan);
    }
    expect_conforms(fan, {.min_feature = {1e-6, true}});
    expect_conforms(fan, {.min_feature = {0.0, false}});
}

// --- planarity, triangulate, repair ---

PiecewiseLinearComplex warped_box(double height) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {1, 1, 1});
    c.positions[7].z += height;  // tilts the top: three sides stay planar only within this
    return c;
}

TEST(ConformPlanarity, DecidesWhatIsFlat) {
    const PiecewiseLinearComplex warped = warped_box(1e-6);
    EXPECT_EQ(expect_refused(warped), std::vector{DefectKind::non_planar_facet});
    EXPECT_EQ(expect_refused(warped, {.planarity = {1e-8, false}}), std::vector{DefectKind::non_planar_facet});
    expect_conforms(warped, {.planarity = {1e-5, true}});
    expect_conforms(warped, {.planarity = {1e-5, false}});
    expect_conforms(warped_box(1e-12));
    expect_conforms(warped_box(1e-16));
}

TEST(ConformTriangulate, CutsAQuadThatCrossesItselfHoweverItIsSeen) {
    // A sliver from a remeshed surface: its short sides turn against each other along all three axes.
    PiecewiseLinearComplex c;
    c.positions = {{-0.7733102151492819, 0.8730470934518785, 0.33215071611592023},
                   {-0.7720987532825705, 0.8721244743581419, 0.33163533360847913},
                   {-0.43956729547486084, 1.0462268644048687, 0.3447046874469164},
                   {-0.4358923074009105, 1.0480159133200346, 0.3442196389460504}};
    add_facet(c, {{VertexId{0}, VertexId{1}, VertexId{2}, VertexId{3}}});
    EXPECT_EQ(expect_refused(c), std::vector{DefectKind::non_planar_facet});
    const RepairedComplex repaired = repair_complex(c, {.triangulate = true});
    ASSERT_EQ(repaired.complex.facet_count(), 2U);
    expect_conforms(repaired.complex);
    for (const FacetId f : repaired.facet_sources) EXPECT_EQ(index_of(f), 0U);
}

TEST(ConformTriangulate, CutsWhatIsNotFlatAndNamesTheInputsFacets) {
    const PiecewiseLinearComplex warped = warped_box(0.25);
    EXPECT_EQ(expect_refused(warped), std::vector{DefectKind::non_planar_facet});
    const ConformOptions options{.triangulate = true};
    const ConformResult result = conform(warped, options);
    EXPECT_EQ(result.outcome, Outcome::done);
    EXPECT_FALSE(result.repairs.empty());
    for (const FacetId f : result.mesh.triangle_facets) EXPECT_LT(index_of(f), warped.facet_count());
    for (std::uint32_t f = 0; f < warped.facet_count(); ++f) EXPECT_GT(area_of(result.mesh, f), 0.9);
    const double volume = volume_of(result.mesh);  // between the two ways to cut the top
    EXPECT_GE(volume, 1.0 + 0.25 / 6 - 1e-12);
    EXPECT_LE(volume, 1.0 + 0.25 / 3 + 1e-12);
    // The same by hand: repaired first, meshed and verified then.
    const RepairedComplex repaired = repair_complex(warped, options);
    const ConformResult by_hand = expect_conforms(repaired.complex);
    EXPECT_EQ(by_hand.mesh.positions, result.mesh.positions);
    EXPECT_EQ(by_hand.mesh.tetrahedra, result.mesh.tetrahedra);
    ASSERT_EQ(by_hand.mesh.triangles, result.mesh.triangles);
    for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
        EXPECT_EQ(result.mesh.triangle_facets[t], repaired.facet_sources[index_of(by_hand.mesh.triangle_facets[t])]);
    }
}

TEST(ConformRepair, MendsWhatHasOneMeaning) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {2, 2, 2});
    put_box(c, {2, 0, 0}, {4, 2, 2});  // beside it: a wall and four points twice
    put_facet(c, {{0, 2, 3, 1}});      // a facet once more
    put_segment(c, 5, 5);              // no length
    const std::vector<DefectKind> refused = expect_refused(c);
    for (const DefectKind kind :
         {DefectKind::duplicate_point, DefectKind::repeated_facet, DefectKind::degenerate_segment})
        EXPECT_TRUE(std::find(refused.begin(), refused.end(), kind) != refused.end()) << name_of(kind);
    const ConformOptions options{.repair = true};
    const ConformResult result = conform(c, options);
    EXPECT_EQ(result.outcome, Outcome::done);
    EXPECT_FALSE(result.repairs.empty());
    EXPECT_NEAR(volume_of(result.mesh), 16.0, 1e-9);
    EXPECT_TRUE(std::equal(c.positions.begin(), c.positions.end(), result.mesh.positions.begin()));
    std::set<std::uint32_t> used;
    for (const Tetrahedron& t : result.mesh.tetrahedra) {
        for (const VertexId v : t) used.insert(index_of(v));
    }
    EXPECT_EQ(used.size(), 12u);
    expect_conforms(repair_complex(c, options).complex);
}

TEST(ConformRepair, CrossingBoxesBecomeThreeRegions) {
    PiecewiseLinearComplex c = make_box({0, 0, 0}, {2, 2, 2});
    put_box(c, {1, 1, 1}, {3, 3, 3});
    const ConformOptions options{.repair = true};
    const RepairedComplex repaired = repair_complex(c, options);
    const ConformResult result = expect_conforms(repaired.complex);
    EXPECT_NEAR(volume_of(result.mesh), 8.0 + 8.0 - 1.0, 1e-9);
    std::set<std::uint32_t> regions;
    for (const RegionId r : result.mesh.tetrahedron_regions) regions.insert(index_of(r));
    EXPECT_EQ(regions.size(), 3u);
    const ConformResult direct = conform(c, options);
    EXPECT_TRUE(direct.mesh.tetrahedra == result.mesh.tetrahedra);
    for (const FacetId f : direct.mesh.triangle_facets) EXPECT_LT(index_of(f), 12u);
    for (std::uint32_t f = 0; f < 12; ++f) EXPECT_NEAR(area_of(direct.mesh, f), 4.0, 1e-9) << "facet " << f;
}

TEST(ConformRepair, LeavesWhatIsSoundAlone) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const PiecewiseLinearComplex c = make_mixture(seed);
        const ConformResult plain = expect_conforms(c), repaired = conform(c, {.triangulate = true, .repair = true});
        EXPECT_TRUE(repaired.repairs.empty());
        EXPECT_TRUE(same_result(plain, repaired));
    }
}

// --- stopping ---

TEST(ConformCancel, BeforeItBegins) {
    const std::atomic<bool> cancel{true};
    RunControl control;
    control.cancel = &cancel;
    const ConformResult result = conform(make_cube(10, true), {}, control);
    EXPECT_EQ(result.outcome, Outcome::cancelled);
}

TEST(ConformCancel, FromEveryStageOfTheCallback) {
    const PiecewiseLinearComplex fan = make_fan(14, 0.1, 4);
    std::size_t calls = 0;
    std::set<std::string> stages;
    const std::thread::id caller = std::this_thread::get_id();
    RunControl watch;
    watch.progress = [&](std::string_view stage, double fraction) {
        ++calls;
        stages.emplace(stage);
        EXPECT_FALSE(stage.empty());
        EXPECT_GE(fraction, 0.0);
        EXPECT_LE(fraction, 1.0);
        EXPECT_EQ(std::this_thread::get_id(), caller);
    };
    EXPECT_EQ(conform(fan, {}, watch).outcome, Outcome::done);
    EXPECT_GE(stages.size(), 3u);
    ASSERT_GE(calls, 3u);
    for (std::size_t stop = 1; stop < calls; ++stop) {
        SCOPED_TRACE(stop);
        std::atomic<bool> cancel{false};
        std::size_t call = 0;
        RunControl control;
        control.cancel = &cancel;
        std::string last;
        control.progress = [&](std::string_view stage, double) {
            last = stage;
            if (++call == stop) cancel = true;
        };
        const ConformResult result = conform(fan, {}, control);
        // The last stage may come to its end.
        if (last != "label") {
            EXPECT_EQ(result.outcome, Outcome::cancelled) << last;
        }
        expect_well_formed(result, fan);
    }
}

TEST(ConformCancel, FromAnotherThread) {
    // Far too much work for the time given: thousands of pages that look into each other.
    const PiecewiseLinearComplex fan = make_fan(300, 0.01, 4);
    for (const Protection protection : {Protection::needed, Protection::sharp}) {
        std::atomic<bool> cancel{false}, started{false};
        RunControl control;
        control.cancel = &cancel;
        control.progress = [&](std::string_view, double) { started = true; };
        std::thread stopper([&] {
            while (!started) std::this_thread::yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            cancel = true;
        });
        const ConformResult result = conform(fan, {.protection = protection}, control);
        stopper.join();
        EXPECT_EQ(result.outcome, Outcome::cancelled);
        expect_well_formed(result, fan);
    }
}

TEST(ConformCancel, ExceptionsOfTheCallbackPass) {
    RunControl control;
    std::size_t calls = 0;
    control.progress = [&](std::string_view, double) {
        if (++calls == 2) throw std::runtime_error("enough");
    };
    EXPECT_THROW(conform(make_fan(8, 0.1, 4), {}, control), std::runtime_error);
    expect_conforms(make_fan(8, 0.1, 4));
}

// --- determinism ---

TEST(ConformDeterminism, ThreadsAndRepetitionChangeNothing) {
    std::vector<PiecewiseLinearComplex> complexes{make_fan(10, 0.1, 1),     make_geology(8, 3, 2),
                                                  make_mixture(3),          make_glued_tetrahedra(60, 4),
                                                  make_plate(20, 10, 5, 5), make_cube(6, true)};
    put_point(complexes[4], {0.5, 0.5, 1.0});
    for (std::size_t i = 0; i < complexes.size(); ++i) {
        SCOPED_TRACE(i);
        const std::vector<ConformOptions> all{{}, {.merge_coplanar = true}, {.gabriel = true, .keep_outside = true}};
        for (const ConformOptions& options : all) {
            if (options.gabriel && i == 0) continue;
            const ConformResult one = conform(complexes[i], options, with_threads(1));
            for (const unsigned threads : {1u, 2u, 4u, 0u})
                EXPECT_TRUE(same_result(one, conform(complexes[i], options, with_threads(threads)))) << threads;
        }
    }
}

/// Other blocks in use between the runs: nothing may depend on addresses.
TEST(ConformDeterminism, TheHeapDoesNotMatter) {
    core::Random random(1);
    std::vector<std::vector<char>> blocks(400);
    std::vector<PiecewiseLinearComplex> complexes;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        complexes.push_back(make_fan(static_cast<std::uint32_t>(4 + seed), 5.0, seed));
        complexes.push_back(make_glued_tetrahedra(30, seed));
        complexes.push_back(make_umbrella(9, seed));
    }
    for (std::size_t i = 0; i < complexes.size(); ++i) {
        SCOPED_TRACE(i);
        const ConformResult one = conform(complexes[i]);
        for (int repetition = 0; repetition < 4; ++repetition) {
            for (int k = 0; k < 100; ++k) {
                std::vector<char>& block = blocks[random.below(blocks.size())];
                std::vector<char>(random.below(k % 4 == 0 ? 200'000 : 3000)).swap(block);
            }
            EXPECT_TRUE(same_result(one, conform(complexes[i])));
        }
    }
}

TEST(ConformDeterminism, ThesisSchemes) {
    for (const Protection protection : {Protection::sharp, Protection::all}) {
        for (const PiecewiseLinearComplex& c : {make_fan(4, 0.5, 1), make_mixture(2)}) {
            const ConformResult one = conform(c, {.protection = protection, .max_points = 60'000}, with_threads(1));
            const ConformResult two = conform(c, {.protection = protection, .max_points = 60'000}, with_threads(2));
            EXPECT_TRUE(same_result(one, two));
        }
    }
}

/// The order of facets and points is not geometry: whatever it is, the mesh conforms.
TEST(ConformDeterminism, AnyOrderOfTheInputConforms) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE(seed);
        const PiecewiseLinearComplex whole = seed % 3 == 0   ? make_geology(4, 2, seed)
                                             : seed % 3 == 1 ? make_fan(7, 0.1, seed)
                                                             : make_mixture(seed);
        core::Random random(seed);
        std::vector<std::uint32_t> order(whole.positions.size());
        std::iota(order.begin(), order.end(), 0u);
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
        PiecewiseLinearComplex shuffled = whole;
        for (std::size_t i = 0; i < order.size(); ++i) shuffled.positions[order[i]] = whole.positions[i];
        for (VertexId& v : shuffled.corners) v = VertexId{order[index_of(v)]};
        for (Edge& e : shuffled.segments) e = {VertexId{order[index_of(e[1])]}, VertexId{order[index_of(e[0])]}};
        expect_conforms(shuffled);
    }
}

}  // namespace
}  // namespace certa::test
