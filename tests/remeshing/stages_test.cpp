// Stages of remeshing one by one, on fields and surfaces whose answers are known: smoothing, umbilics, samples.
#include <certa/remeshing.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

#include "core/random.h"
#include "mesh/generators_surfaces.h"
#include "remeshing/cancel_umbilics.h"
#include "remeshing/isotropic.h"
#include "remeshing/polygons.h"
#include "remeshing/trace_lines.h"

namespace certa::remeshing {
namespace {

constexpr double pi = std::numbers::pi;

/// A height field over a square or, where `round`, over a disk, on a jittered grid of n by n squares.
template <class Height>
TriangleMesh graph_of(std::uint32_t n, bool round, const Height& height) {
    TriangleMesh mesh;
    core::Random random(7);
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            const bool inner_x = i > 0 && i<n, inner_y = j> 0 && j < n;
            double x = -1.0 + (2.0 * i + (inner_x ? 0.3 * random.uniform() - 0.15 : 0.0)) / n;
            double y = -1.0 + (2.0 * j + (inner_y && 2 * j != n ? 0.3 * random.uniform() - 0.15 : 0.0)) / n;
            if (round) {
                const double u = x;
                x *= std::sqrt(1.0 - 0.5 * y * y), y *= std::sqrt(1.0 - 0.5 * u * u);
            }
            mesh.positions.push_back({x, y, height(x, y)});
        }
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const VertexId a{j * (n + 1) + i}, b{j * (n + 1) + i + 1}, c{(j + 1) * (n + 1) + i + 1},
                d{(j + 1) * (n + 1) + i};
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    return mesh;
}

struct Prepared {
    RemeshStatistics statistics;
    WorkMesh mesh;
    DirectionField field;
};
Prepared prepare(const TriangleMesh& input, double edges, bool gaussian = false, const RemeshOptions& options = {}) {
    Prepared p;
    p.mesh = build_work_mesh(input, options, p.statistics);
    p.field = measure_directions(p.mesh, {});
    if (gaussian)
        smooth_by_gaussian(p.mesh, p.field, edges * p.mesh.mean_edge, {});
    else
        smooth_directions(p.mesh, p.field, edges * p.mesh.mean_edge, {});
    return p;
}

/// The direction of k_max at a wedge, in space.
Point3 direction_at(const Prepared& p, Index wedge) {
    double angle = 0.5 * std::arg(p.field.squares[wedge]);
    while (angle < 0.0) angle += pi;
    Index c = p.mesh.wedge_first[wedge];
    while (angle >= p.mesh.corner_start[c] + p.mesh.corner_angle[c]) c = p.mesh.next_corner(c);
    const Point3& o = p.mesh.points[p.mesh.wedge_vertices[wedge]];
    const Point3 a = p.mesh.points[p.mesh.end_of(c)] - o, b = p.mesh.points[p.mesh.start_of(previous_of(c))] - o;
    const Point3 x = (1.0 / norm(a)) * a, y = b - dot(b, x) * x;
    const double opening = std::atan2(norm(y), dot(b, x));
    const double turn = opening * (angle - p.mesh.corner_start[c]) / p.mesh.corner_angle[c];
    return std::cos(turn) * x + (std::sin(turn) / norm(y)) * y;
}

/// Of x^2/a^2 + y^2/b^2 + z^2/c^2 = 1 with outward normals: the direction of k_max, and how far from an umbilic it is.
Point3 direction_on_ellipsoid(const Point3& q, const Point3& axes, double& difference) {
    const Point3 weights{1.0 / (axes.x * axes.x), 1.0 / (axes.y * axes.y), 1.0 / (axes.z * axes.z)};
    const Point3 gradient{weights.x * q.x, weights.y * q.y, weights.z * q.z};
    const Point3 n = (1.0 / norm(gradient)) * gradient;
    const Point3 aside = std::abs(n.x) < 0.7 ? Point3{1.0, 0.0, 0.0} : Point3{0.0, 1.0, 0.0};
    Point3 x = cross(n, aside);
    x = (1.0 / norm(x)) * x;
    const Point3 y = cross(n, x);
    const auto second = [&](const Point3& s, const Point3& t) {
        return (weights.x * s.x * t.x + weights.y * s.y * t.y + weights.z * s.z * t.z) / norm(gradient);
    };
    const double e = second(x, x), f = second(x, y), g = second(y, y);
    difference = std::hypot(e - g, 2.0 * f) / (e + g);
    const double angle = 0.5 * std::atan2(2.0 * f, e - g);
    return std::cos(angle) * x + std::sin(angle) * y;
}

/// A sphere of even triangles, stretched.
TriangleMesh even_ellipsoid(const Point3& axes) {
    TriangleMesh mesh = generators::make_icosphere(5);
    for (Point3& q : mesh.positions) q = {axes.x * q.x, axes.y * q.y, axes.z * q.z};
    return mesh;
}

double error_on_ellipsoid(const Prepared& p, const Point3& axes) {
    std::vector<double> errors;
    for (Index w = 0; w < p.mesh.wedge_count(); ++w) {
        double difference = 0.0;
        const Point3 truth = direction_on_ellipsoid(p.mesh.points[p.mesh.wedge_vertices[w]], axes, difference);
        if (difference < 0.1) continue;
        errors.push_back(std::acos(std::min(1.0, std::abs(dot(truth, direction_at(p, w))))) * 180.0 / pi);
    }
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 9 / 10),
                     errors.end());
    return errors[errors.size() * 9 / 10];
}

TEST(Smoothing, BothMethodsKeepTheDirectionsOfTheEllipsoid) {
    const Point3 axes{1.0, 0.7, 0.4};
    const TriangleMesh input = even_ellipsoid(axes);
    const double raw = error_on_ellipsoid(prepare(input, 0.0), axes);
    const double screened = error_on_ellipsoid(prepare(input, 3.0), axes);
    const double gaussian = error_on_ellipsoid(prepare(input, 3.0, true), axes);
    std::printf("p90 in degrees: %.3f raw, screened %.3f, gaussian %.3f\n", raw, screened, gaussian);
    EXPECT_LT(screened, raw + 0.1);
    EXPECT_LT(gaussian, raw + 0.5);
    // Over ten edges the tensors of strong parts outvote weak ones, unit directions do not.
    const double far_screened = error_on_ellipsoid(prepare(input, 10.0), axes);
    const double far_gaussian = error_on_ellipsoid(prepare(input, 10.0, true), axes);
    std::printf("over ten edges: screened %.3f, gaussian %.3f\n", far_screened, far_gaussian);
    EXPECT_LT(far_screened, raw + 0.5);
    EXPECT_GT(far_gaussian, far_screened);
    // Both take noise away.
    const TriangleMesh noisy = generators::make_noisy(input, 0.001, 2);
    RemeshOptions smooth;
    smooth.feature_angle_radians = pi;
    const double none = error_on_ellipsoid(prepare(noisy, 0.0, false, smooth), axes);
    const double by_screen = error_on_ellipsoid(prepare(noisy, 3.0, false, smooth), axes);
    const double by_gaussian = error_on_ellipsoid(prepare(noisy, 3.0, true, smooth), axes);
    std::printf("with noise: %.3f before, screened %.3f, gaussian %.3f\n", none, by_screen, by_gaussian);
    EXPECT_LT(by_screen, 0.5 * none);
    EXPECT_LT(by_gaussian, 0.5 * none);
}

/// What lies beyond a crease does not matter (4.1.5); without the crease it does.
TEST(Smoothing, GaussianIsClippedAtFeatures) {
    const std::uint32_t n = 60;
    RemeshOptions tagged, plain;
    for (std::uint32_t i = 0; i < n; ++i)
        tagged.features.push_back({VertexId{n / 2 * (n + 1) + i}, VertexId{n / 2 * (n + 1) + i + 1}});
    const auto below = [](double x, double y) { return 0.2 * x * x - 0.1 * (x + y) * (x + y); };
    const TriangleMesh one = graph_of(n, false, [&](double x, double y) { return below(x, std::min(y, 0.0)); });
    const TriangleMesh other = graph_of(
        n, false, [&](double x, double y) { return below(x, std::min(y, 0.0)) + (y > 0.0 ? 0.5 * y * (x + y) : 0.0); });
    const auto largest_turn = [&](const RemeshOptions& options) {
        const Prepared a = prepare(one, 4.0, true, options), b = prepare(other, 4.0, true, options);
        double largest = 0.0;
        for (Index f = 0; f < a.mesh.face_count(); ++f) {
            const bool is_below = f < a.mesh.face_count() / 2;
            for (Index c = 3 * f; c < 3 * f + 3 && is_below; ++c)
                largest = std::max(largest, std::abs(std::arg(a.field.squares[a.mesh.wedges[c]] *
                                                              std::conj(b.field.squares[b.mesh.wedges[c]]))));
        }
        return largest;
    };
    EXPECT_LT(largest_turn(tagged), 0.01);
    EXPECT_GT(largest_turn(plain), 0.1);
}

TEST(Umbilics, PolynomialAgreesWithTheIndexOnLinearFields) {
    EXPECT_EQ(type_of_linear_field(1.0, 0.0, 0.0, 1.0).half_turns, 1);    // u = z
    EXPECT_EQ(type_of_linear_field(1.0, 0.0, 0.0, -1.0).half_turns, -1);  // u = conj z
    EXPECT_EQ(type_of_linear_field(1.0, 0.0, 0.0, -1.0).separatrices, 3);
    EXPECT_EQ(type_of_linear_field(1.0, 0.0, 0.0, 1.0).separatrices, 1);
    EXPECT_EQ(type_of_linear_field(1.0, 0.0, 0.0, 0.2).separatrices, 1);
    EXPECT_EQ(type_of_linear_field(0.2, 0.0, 0.0, 1.0).separatrices, 3);  // a wedge, too
    core::Random random(5);
    int three = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const double a = random.uniform() - 0.5, b = random.uniform() - 0.5, c = random.uniform() - 0.5,
                     d = random.uniform() - 0.5;
        if (std::abs(a * d - b * c) < 1e-3) continue;
        const UmbilicType type = type_of_linear_field(a, b, c, d);
        ASSERT_EQ(type.half_turns, a * d - b * c > 0.0 ? 1 : -1) << a << ' ' << b << ' ' << c << ' ' << d;
        three += type.separatrices == 3 && type.half_turns == 1 ? 1 : 0;
    }
    EXPECT_GT(three, 100);
}

TEST(Umbilics, PolynomialAgreesWithTheIndexOnSurfaces) {
    const Prepared ellipsoid = prepare(generators::make_ellipsoid(2.0, 1.2, 0.8, 8000, 1), 5.0);
    const Prepared monkey =
        prepare(graph_of(60, false, [](double u, double v) { return 0.25 * (u * u * u - 3.0 * u * v * v); }), 5.0);
    for (const Prepared* p : {&ellipsoid, &monkey})
        for (const FieldUmbilic& u : p->field.umbilics) {
            EXPECT_TRUE(u.linear_zero);
            EXPECT_EQ(u.typed_half_turns, u.half_turns);
        }
    ASSERT_EQ(monkey.field.umbilics.size(), 1U);
    EXPECT_EQ(type_of_face(monkey.mesh, monkey.field, monkey.field.umbilics[0].face).separatrices, 3);
    RemeshOptions smooth;
    smooth.feature_angle_radians = pi;
    // Under noise a few linear zeros lie in the face next to the one that is turned around: not many.
    const Prepared noisy = prepare(generators::make_noisy(generators::make_ellipsoid(2.0, 1.2, 0.8, 8000, 1), 0.015, 2),
                                   1.0, false, smooth);
    std::size_t otherwise = 0;
    for (const FieldUmbilic& u : noisy.field.umbilics) otherwise += u.typed_half_turns != u.half_turns ? 1 : 0;
    std::printf("%zu of %zu umbilics typed otherwise\n", otherwise, noisy.field.umbilics.size());
    EXPECT_GT(noisy.field.umbilics.size(), 20U);
    EXPECT_LT(20 * otherwise, 3 * noisy.field.umbilics.size());
}

/// Where nothing has a direction, one is chosen: indices are whole numbers, their sum is right, and always the same.
TEST(Umbilics, FieldsThatVanishOnWholeFacesHaveIndices) {
    std::vector<std::vector<Index>> faces;
    for (int repeat = 0; repeat < 2; ++repeat) {
        Prepared p = prepare(generators::make_torus(2.0, 0.7, 1000, 1), 3.0);
        for (Index w = 0; w < p.mesh.wedge_count(); ++w)
            if (p.mesh.points[p.mesh.wedge_vertices[w]].x > 0.0) p.field.squares[w] = 0.0;
        finish_directions(p.mesh, p.field);
        int sum = 0;
        faces.emplace_back();
        for (const FieldUmbilic& u : p.field.umbilics) {
            sum += u.half_turns;
            faces.back().push_back(u.face);
        }
        EXPECT_EQ(sum, 0);
        for (const Complex& z : p.field.squares) EXPECT_GT(std::norm(z), 0.0);
    }
    EXPECT_EQ(faces[0], faces[1]);
    // A plane has directions along its rim, and nothing turns.
    EXPECT_TRUE(prepare(graph_of(12, false, [](double, double) { return 0.0; }), 3.0).field.umbilics.empty());
}

TEST(Umbilics, OppositePairsThatAreNearAreCancelled) {
    RemeshOptions smooth;
    smooth.feature_angle_radians = pi;
    Prepared p = prepare(generators::make_noisy(generators::make_ellipsoid(2.0, 1.2, 0.8, 8000, 1), 0.015, 2), 1.0,
                         false, smooth);
    SpacingRule rule;
    rule.error = 4e-3 * p.mesh.diagonal;
    const Spacing spacing = compute_spacing(p.mesh, p.field, rule, {});
    const std::size_t before = p.field.umbilics.size();
    const std::vector<Complex> squares = p.field.squares;
    const std::size_t gone = cancel_umbilic_pairs(p.mesh, spacing, p.field, {});
    EXPECT_GT(before, 20U);
    std::printf("%zu umbilics before, %zu after\n", before, p.field.umbilics.size());
    EXPECT_LE(p.field.umbilics.size(), before / 3);
    EXPECT_EQ(before - p.field.umbilics.size(), 2 * gone);
    int sum = 0;
    for (Index f = 0; f < p.mesh.face_count(); ++f) sum += half_turns_of(p.mesh, p.field, f);
    EXPECT_EQ(sum, 4);
    // Far from all umbilics nothing has changed.
    std::size_t changed = 0;
    for (Index w = 0; w < p.mesh.wedge_count(); ++w) changed += p.field.squares[w] != squares[w] ? 1 : 0;
    EXPECT_LT(changed, squares.size() / 2);
    // And nothing is left to do.
    EXPECT_EQ(cancel_umbilic_pairs(p.mesh, spacing, p.field, {}), 0U);
}

/// Lines near a guide across the field run along it; far from it, and without it, they do not.
TEST(Guides, AreFollowedByLinesNearby) {
    const std::uint32_t n = 60;
    const TriangleMesh saddle = graph_of(n, false, [](double x, double y) { return 0.3 * (x * x - y * y); });
    RemeshOptions options;
    options.vertices = 300;
    options.placement = false;
    options.lines = true;
    // Lines of the saddle run along the axes; the guide is the diagonal, jittered as the mesh is.
    const auto off_the_diagonal = [&](double& nearest, std::size_t& creases) {
        const RemeshResult result = remesh(saddle, options);
        EXPECT_EQ(result.outcome, Outcome::done);
        double sum = 0.0, length = 0.0;
        nearest = 1e300;
        creases = result.statistics.feature_curves;
        for (const bool maximum : {false, true}) {
            double own = 0.0, all = 0.0;
            for (const CurvatureLine& line : result.lines)
                for (std::size_t i = 0; i + 1 < line.points.size() && line.maximum == maximum; ++i) {
                    const Point3 a = line.points[i], d = line.points[i + 1] - a;
                    if (std::abs(a.x - a.y) > 0.1 || std::abs(a.x) > 0.8) continue;
                    own += std::hypot(d.x, d.y) *
                           std::acos(std::min(1.0, std::abs(d.x + d.y) / std::sqrt(2.0) / std::hypot(d.x, d.y)));
                    all += std::hypot(d.x, d.y);
                }
            if (all > 0.0) nearest = std::min(nearest, own / all * 180.0 / pi);
            sum += own, length += all;
        }
        return sum / length * 180.0 / pi;
    };
    double with = 0.0, without = 0.0;
    std::size_t creases = 0, creases_without = 0;
    off_the_diagonal(without, creases_without);
    for (std::uint32_t i = 4; i + 4 < n; ++i)
        options.guides.push_back({VertexId{i * (n + 1) + i}, VertexId{(i + 1) * (n + 1) + i + 1}});
    off_the_diagonal(with, creases);
    std::printf("mean angle to the guide: %.2f degrees, %.2f without\n", with, without);
    EXPECT_LT(with, 5.0);
    EXPECT_GT(without, 40.0);
    EXPECT_EQ(creases, creases_without);
}

TEST(Guides, MustBeEdges) {
    RemeshOptions options;
    options.guides.push_back({VertexId{0}, VertexId{6}});
    const TriangleMesh box = generators::make_box(1.0, 1.0, 1.0);
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Triangle& t : box.triangles)
        for (std::size_t i = 0; i < 3; ++i) edges.insert({index_of(t[i]), index_of(t[(i + 1) % 3])});
    for (std::uint32_t v = 1; v < 8; ++v)
        if (!edges.contains({0, v}) && !edges.contains({v, 0})) options.guides[0][1] = VertexId{v};
    EXPECT_THROW(remesh(box, options), InputError);
    options.guides[0][1] = VertexId{99};
    EXPECT_THROW(remesh(box, options), InputError);
}

TEST(Spacing, IsWiderInHyperbolicPartsOnDemand) {
    const Prepared p = prepare(generators::make_torus(2.0, 0.7, 4000, 1), 3.0);
    SpacingRule rule, wider;
    rule.error = wider.error = 1e-3 * p.mesh.diagonal;
    rule.growth = wider.growth = 1e9;  // point by point
    wider.hyperbolic = std::sqrt(2.0);
    const Spacing plain = compute_spacing(p.mesh, p.field, rule, {}),
                  wide = compute_spacing(p.mesh, p.field, wider, {});
    std::size_t saddles = 0, wrong = 0;
    for (Index w = 0; w < p.mesh.wedge_count(); ++w) {
        const Point3& q = p.mesh.points[p.mesh.wedge_vertices[w]];
        const double inwards = 2.0 - std::hypot(q.x, q.y);  // K < 0 where positive
        if (std::abs(inwards) < 0.2) continue;
        saddles += inwards > 0.0 ? 1 : 0;
        const double ratio = wide.at[along_min][w] / plain.at[along_min][w];
        wrong += std::abs(ratio - (inwards > 0.0 ? std::sqrt(2.0) : 1.0)) > 1e-9 ? 1 : 0;
    }
    EXPECT_LT(wrong, p.mesh.wedge_count() / 100);
    EXPECT_GT(saddles, 500U);
}

TEST(Spacing, EveningKeepsTheCountAndTheShapesOfCells) {
    const Prepared p = prepare(generators::make_torus(2.0, 0.7, 4000, 1), 3.0);
    SpacingRule rule;
    rule.error = 1e-3 * p.mesh.diagonal;
    rule.growth = 1e9;  // point by point
    rule.largest = 1e9;
    const Spacing plain = compute_spacing(p.mesh, p.field, rule, {});
    rule.evening = 0.25;
    const Spacing even = compute_spacing(p.mesh, p.field, rule, {});
    EXPECT_NEAR(expected_vertices(p.mesh, even), expected_vertices(p.mesh, plain), 1e-6);
    double factor = 0.0;
    for (Index w = 0; w < p.mesh.wedge_count(); ++w) {
        const double before = plain.at[0][w] * plain.at[1][w], after = even.at[0][w] * even.at[1][w];
        EXPECT_NEAR(even.at[0][w] * plain.at[1][w], even.at[1][w] * plain.at[0][w], 1e-9);
        if (w == 0) factor = after / std::pow(before, 0.75);
        EXPECT_NEAR(after / std::pow(before, 0.75), factor, 1e-9 * factor);
    }
}

struct Arranged {
    Network network;
    Graph graph;
    std::vector<std::vector<Index>> faces;
};
Arranged arrange(const Prepared& p, double error) {
    SpacingRule rule;
    rule.error = error * p.mesh.diagonal;
    const Spacing spacing = compute_spacing(p.mesh, p.field, rule, {});
    Arranged a{trace_lines(p.mesh, p.field, spacing, {}, {}), {}, {}};
    a.graph = build_graph(a.network, {rule.error});
    simplify_graph(a.graph, a.network);
    a.faces = a.graph.trace_faces(p.mesh);
    return a;
}

/// Lines around a torus that one crease cuts come back to it from its other side, and end there.
TEST(Lines, DoNotCloseAcrossACrease) {
    constexpr std::uint32_t around = 80, tube = 17;
    RemeshOptions options;
    for (std::uint32_t j = 0; j < tube; ++j) options.features.push_back({VertexId{j}, VertexId{(j + 1) % tube}});
    const Prepared p = prepare(generators::make_grid_torus(2.0, 0.8, around, tube), 3.0, false, options);
    const Arranged a = arrange(p, 4e-3);
    std::size_t cut = 0;
    for (const Line& line : a.network.lines()) {
        std::size_t on_crease = 0;
        for (const Index c : line.crossings) {
            const Index edge = a.network.crossing(c).edge;
            on_crease += edge != no_index && p.mesh.is_feature(p.mesh.edge_halfedges[edge]) ? 1 : 0;
        }
        EXPECT_FALSE(line.closed && on_crease > 0);
        cut += on_crease == 2 ? 1 : 0;
    }
    EXPECT_GT(cut, 5U);
    EXPECT_TRUE(find_flaws(a.graph, a.network, a.faces).empty());
}

/// The triangles that are located in a face fill it: compared by area and centre with the face's own corners.
TEST(Samples, AreLocatedInTheFaceAroundThem) {
    for (const TriangleMesh& input : {generators::make_ellipsoid(2.0, 1.2, 0.8, 20000, 1),
                                      graph_of(70, false, [](double x, double y) { return 0.3 * (x * x - y * y); })}) {
        const Prepared p = prepare(input, 3.0);
        const Arranged a = arrange(p, 1e-3);
        FaceLocator locator(a.graph, a.network, a.faces);
        std::vector<double> area(a.faces.size(), 0.0);
        std::vector<Point3> center(a.faces.size());
        core::Random random(3);
        for (Index f = 0; f < p.mesh.face_count(); ++f)
            for (int k = 0; k < 4; ++k) {
                double u = random.uniform(), v = random.uniform();
                if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
                const Index face = locator.find({f, {1.0 - u - v, u, v}});
                ASSERT_LT(face, a.faces.size());
                const auto& t = p.mesh.faces[f];
                const Point3 &x = p.mesh.points[t[0]], &y = p.mesh.points[t[1]], &z = p.mesh.points[t[2]];
                const double part = 0.125 * norm(cross(y - x, z - x));
                area[face] += part;
                center[face] = center[face] + part * ((1.0 - u - v) * x + u * y + v * z);
            }
        double total = 0.0, astray = 0.0;
        for (Index f = 0; f < a.faces.size(); ++f) {
            Point3 own, middle;
            const Point3& o = a.graph.nodes[a.graph.tail(a.faces[f][0])].point;
            for (const Index h : a.faces[f]) {
                const Point3 &s = a.graph.nodes[a.graph.tail(h)].point, &t = a.graph.nodes[a.graph.head(h)].point;
                own = own + 0.5 * cross(s - o, t - o);
                middle = middle + (1.0 / static_cast<double>(a.faces[f].size())) * s;
            }
            const double size = norm(own);
            total += size;
            if (area[f] == 0.0 || std::abs(area[f] - size) > 0.3 * size ||
                distance((1.0 / area[f]) * center[f], middle) > 0.4 * std::sqrt(size))
                astray += size;
        }
        std::printf("%zu faces, %.2f %% of their area astray\n", a.faces.size(), 100.0 * astray / total);
        EXPECT_GT(a.faces.size(), 80U);
        EXPECT_LT(astray, 0.06 * total);
    }
}

/// An octagon on a sphere around two points.
TEST(Samples, FacesAreTriangulatedAroundThem) {
    CoarseMesh mesh;
    std::vector<Index> ring;
    for (int i = 0; i < 8; ++i)
        ring.push_back(mesh.add_vertex({0.5 * std::cos(0.25 * pi * i), 0.5 * std::sin(0.25 * pi * i), 0.0}, {}));
    mesh.add_polygon(ring, 0);
    const std::vector<IsotropicSample> samples{{{0.1, 0.0, 0.13}, {}, 0}, {{-0.2, 0.05, 0.11}, {}, 0}};
    EXPECT_EQ(triangulate_around(samples, mesh), 2U);
    EXPECT_EQ(mesh.points.size(), 10U);
    EXPECT_EQ(mesh.polygon_count(), 10U);  // 8 + 2 vertices inside: n + 2 k - 2
    std::set<std::pair<Index, Index>> sides;
    for (std::size_t i = 0; i < mesh.polygon_count(); ++i) {
        const auto t = mesh.polygon(i);
        ASSERT_EQ(t.size(), 3U);
        EXPECT_GT(cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]).z, 0.0);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(sides.insert({t[k], t[(k + 1) % 3]}).second);
    }
    std::size_t open = 0;
    for (const auto& [s, t] : sides) open += sides.contains({t, s}) ? 0 : 1;
    EXPECT_EQ(open, 8U);
    // One that does not see the whole polygon leaves it alone.
    CoarseMesh bent;
    ring.clear();
    for (const Point3& q : {Point3{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {3, 4, 0}, {3, 1, 0}, {0, 1, 0}})
        ring.push_back(bent.add_vertex(q, {}));
    bent.add_polygon(ring, 0);
    EXPECT_EQ(triangulate_around({{{1.0, 0.5, 0.0}, {}, 0}}, bent), 0U);
    EXPECT_EQ(bent.polygon_count(), 1U);
    EXPECT_EQ(bent.points.size(), 6U);
}

/// Around the top of a dome, a spherical region, points; in planes none.
TEST(Samples, AreInSphericalPartsOnly) {
    RemeshOptions options;
    options.vertices = 200;
    options.placement = false;
    options.output = RemeshOutput::polygons;
    options.isotropic_samples = IsotropicSamples::all;
    const TriangleMesh dome = graph_of(60, true, [](double x, double y) { return 0.8 * (1.0 - x * x - y * y); });
    const RemeshResult with = remesh(dome, options);
    ASSERT_EQ(with.outcome, Outcome::done);
    EXPECT_GT(with.statistics.isotropic_samples, 0U);
    EXPECT_GE(with.statistics.triangles, 5 * with.statistics.isotropic_samples / 2);
    options.isotropic_samples = IsotropicSamples::none;
    EXPECT_EQ(remesh(dome, options).statistics.isotropic_samples, 0U);
    options.isotropic_samples = IsotropicSamples::all;
    EXPECT_EQ(remesh(generators::make_box(1.0, 2.0, 3.0), options).statistics.isotropic_samples, 0U);
}

}  // namespace
}  // namespace certa::remeshing
