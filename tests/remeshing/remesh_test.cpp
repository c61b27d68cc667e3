// From triangles to polygons: topology, directions, features, counts, refusals, on surfaces whose answers are known.
#include <certa/distance.h>
#include <certa/io.h>
#include <certa/remeshing.h>
#include <certa/surface_check.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>

#include "core/random.h"
#include "core/triangle_tree.h"
#include "facetted_pipe.h"
#include "mesh/generators_surfaces.h"
#include "remeshing/connection.h"
#include "remeshing/give_result.h"
#include "remeshing/polygons.h"
#include "remeshing/surface_cut.h"
#include "remeshing/trace_lines.h"

namespace certa::remeshing {
namespace {

constexpr double pi = std::numbers::pi;

/// A height field over [-1, 1]^2 on a jittered grid of n by n squares.
template <class Height>
TriangleMesh graph_of(std::uint32_t n, const Height& height) {
    TriangleMesh mesh;
    core::Random random(7);
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            const bool inner_x = i > 0 && i<n, inner_y = j> 0 && j < n;
            const double x = -1.0 + (2.0 * i + (inner_x ? 0.6 * random.uniform() - 0.3 : 0.0)) / n;
            const double y = -1.0 + (2.0 * j + (inner_y ? 0.6 * random.uniform() - 0.3 : 0.0)) / n;
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

/// What a polygon mesh is, by counting: independent of the remesher's own counts.
struct Shape {
    std::int64_t euler = 0;
    std::size_t open_edges = 0;
    bool manifold = true;  ///< no side walked twice, no corner twice in a polygon
};
Shape shape_of(const PolygonMesh& mesh) {
    Shape shape;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (std::size_t p = 0; p + 1 < mesh.offsets.size(); ++p) {
        std::vector<std::uint32_t> ring;
        for (std::uint32_t i = mesh.offsets[p]; i < mesh.offsets[p + 1]; ++i) ring.push_back(index_of(mesh.corners[i]));
        for (std::size_t k = 0; k < ring.size(); ++k)
            if (++sides[{ring[k], ring[(k + 1) % ring.size()]}] > 1) shape.manifold = false;
        std::sort(ring.begin(), ring.end());
        if (ring.size() < 3 || std::adjacent_find(ring.begin(), ring.end()) != ring.end()) shape.manifold = false;
    }
    std::int64_t edges = 0;
    for (const auto& [side, count] : sides) {
        const bool open = !sides.contains({side.second, side.first});
        shape.open_edges += open ? 1 : 0;
        edges += open || side.first < side.second ? 1 : 0;
    }
    shape.euler =
        static_cast<std::int64_t>(mesh.positions.size()) - edges + static_cast<std::int64_t>(mesh.offsets.size()) - 1;
    return shape;
}

void expect_closed(const RemeshResult& result, std::int64_t euler) {
    ASSERT_EQ(result.outcome, Outcome::done);
    const Shape shape = shape_of(result.mesh);
    EXPECT_EQ(shape.euler, euler);
    EXPECT_EQ(shape.open_edges, 0U);
    EXPECT_TRUE(shape.manifold);
}

struct Prepared {
    RemeshStatistics statistics;
    WorkMesh mesh;
    DirectionField field;
};
Prepared prepare(const TriangleMesh& input, double edges) {
    Prepared p;
    p.mesh = build_work_mesh(input, {}, p.statistics);
    p.field = measure_directions(p.mesh, {});
    smooth_directions(p.mesh, p.field, edges * p.mesh.mean_edge, {});
    return p;
}
int half_turns(const Prepared& p) {
    int sum = 0;
    for (const FieldUmbilic& u : p.field.umbilics) sum += u.half_turns;
    return sum;
}

TEST(Umbilics, IndicesSumToTheCharacteristic) {
    EXPECT_EQ(half_turns(prepare(generators::make_icosphere(3), 3.0)), 4);
    EXPECT_EQ(half_turns(prepare(generators::make_torus(2.0, 0.7, 4000, 1), 3.0)), 0);
    EXPECT_EQ(
        half_turns(prepare(generators::make_noisy(generators::make_ellipsoid(2.0, 1.2, 0.8, 3000, 1), 0.01, 2), 3.0)),
        4);
    EXPECT_EQ(half_turns(prepare(generators::make_noisy(generators::make_grid_torus(2.0, 0.7, 60, 30), 0.03, 3), 1.0)),
              0);
}

TEST(Umbilics, LieWhereTheoryPutsThem) {
    EXPECT_TRUE(prepare(generators::make_torus(2.0, 0.7, 4000, 1), 5.0).field.umbilics.empty());
    // Of the ellipsoid a > b > c: (a sqrt((a2 - b2) / (a2 - c2)), 0, c sqrt((b2 - c2) / (a2 - c2))) and reflections.
    const double a = 2.0, b = 1.2, c = 0.8;
    const Prepared p = prepare(generators::make_ellipsoid(a, b, c, 8000, 1), 5.0);
    ASSERT_EQ(p.field.umbilics.size(), 4U);
    const double x = a * std::sqrt((a * a - b * b) / (a * a - c * c)),
                 z = c * std::sqrt((b * b - c * c) / (a * a - c * c));
    for (const FieldUmbilic& u : p.field.umbilics) {
        EXPECT_EQ(u.half_turns, 1);
        const Point3 q = p.mesh.points[p.mesh.faces[u.face][0]];
        EXPECT_LT(norm(Point3{std::abs(q.x) - x, q.y, std::abs(q.z) - z}), 0.15);
    }
    // The monkey saddle has one trisector in the middle.
    const Prepared monkey =
        prepare(graph_of(60, [](double u, double v) { return 0.25 * (u * u * u - 3.0 * u * v * v); }), 5.0);
    ASSERT_EQ(monkey.field.umbilics.size(), 1U);
    EXPECT_EQ(monkey.field.umbilics[0].half_turns, -1);
    EXPECT_LT(norm(monkey.mesh.points[monkey.mesh.faces[monkey.field.umbilics[0].face][0]]), 0.1);
}

/// The real part of (x + i y)^n has an umbilic of index 1 - n / 2: as many trisectors, each in a triangle of its own.
TEST(Umbilics, HigherOnesComeApart) {
    for (const int n : {4, 5}) {
        const Prepared p = prepare(
            graph_of(40, [&](double x, double y) { return 0.05 * std::pow(std::complex<double>(x, y), n).real(); }),
            2.0);
        EXPECT_EQ(half_turns(p), 2 - n);
        for (const FieldUmbilic& u : p.field.umbilics) {
            EXPECT_EQ(std::abs(u.half_turns), 1);
            EXPECT_LT(norm(p.mesh.points[p.mesh.faces[u.face][0]]), 0.4);
        }
    }
}

/// At the tip of a spike three triangles have all of the curvature: directions could turn around one of them twice.
/// They are cut up until that cannot be, whatever the directions.
TEST(Umbilics, NoTriangleIsTurnedAroundTwice) {
    TriangleMesh spike = generators::make_icosphere(1);
    const Triangle base = spike.triangles.back();
    spike.triangles.pop_back();
    Point3 tip;
    for (const VertexId v : base) tip = tip + 3.0 * spike.positions[index_of(v)];
    const VertexId top{static_cast<std::uint32_t>(spike.positions.size())};
    spike.positions.push_back(tip);
    for (std::size_t i = 0; i < 3; ++i) spike.triangles.push_back({base[i], base[(i + 1) % 3], top});
    RemeshOptions options;
    options.feature_angle_radians = 3.2;
    Prepared p;
    p.mesh = build_work_mesh(spike, options, p.statistics);
    EXPECT_EQ(p.statistics.input_triangles, spike.triangles.size());
    core::Random random(11);
    for (int round = 0; round < 100; ++round) {
        p.field.squares.clear();
        for (Index w = 0; w < p.mesh.wedge_count(); ++w)
            p.field.squares.push_back(std::polar(1.0, 2.0 * pi * random.uniform()));
        finish_directions(p.mesh, p.field);
        EXPECT_EQ(half_turns(p), 4);
        for (const FieldUmbilic& u : p.field.umbilics) EXPECT_EQ(std::abs(u.half_turns), 1);
    }
    // What there is none of is counted and said all the same.
    p.field.umbilics.assign(1, {0, 2, {1.0, 0.0, 0.0}, false, 0});
    RemeshStatistics statistics;
    count_umbilics(p.field, p.mesh, statistics);
    EXPECT_EQ(statistics.multiple_umbilics, 1U);
    EXPECT_EQ(statistics.wedges, 0U);
    EXPECT_EQ(statistics.umbilic_half_turns, 2);
    EXPECT_EQ(statistics.notes.size(), 1U);
}

TEST(Lines, FollowTheTorus) {
    RemeshOptions options;
    options.vertices = 600;
    options.placement = false;
    options.lines = true;
    const RemeshResult result = remesh(generators::make_torus(2.0, 0.7, 10000, 1), options);
    double sum = 0.0, length = 0.0;
    std::size_t closed = 0;
    for (const CurvatureLine& line : result.lines) {
        closed += line.closed ? 1 : 0;
        for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
            const Point3 d = line.points[i + 1] - line.points[i], p = line.points[i];
            const Point3 around{-p.y / std::hypot(p.x, p.y), p.x / std::hypot(p.x, p.y), 0.0};
            if (!(norm(d) > 0.0)) continue;
            const double cosine = std::min(1.0, std::abs(dot(d, around)) / norm(d));
            sum += norm(d) * (line.maximum ? std::asin(cosine) : std::acos(cosine));
            length += norm(d);
        }
    }
    EXPECT_LT(sum / length * 180.0 / pi, 1.5);
    EXPECT_GT(closed, 10U);
    EXPECT_TRUE(result.umbilics.empty());
}

/// What the front claims, by brute force over all lines: no vertex is farther from one of each family.
TEST(Lines, CoverTheSurface) {
    for (const TriangleMesh& input :
         {generators::make_torus(2.0, 0.7, 4000, 1), generators::make_ellipsoid(2.0, 1.2, 0.8, 4000, 1),
          graph_of(40, [](double x, double y) { return 0.5 * (x * x - y * y); })}) {
        const Prepared p = prepare(input, 3.0);
        SpacingRule rule;
        rule.error = 2e-3 * p.mesh.diagonal;
        const Spacing spacing = compute_spacing(p.mesh, p.field, rule, {});
        const Network network = trace_lines(p.mesh, p.field, spacing, {}, {});
        for (const Family family : {along_max, along_min}) {
            EXPECT_EQ(network.coverage(family).uncovered, 0U);
            EXPECT_GT(network.coverage(family).farthest, 0.3);
            EXPECT_LT(network.coverage(family).farthest, 0.85);
            for (Index w = 0; w < p.mesh.wedge_count(); ++w) {
                if (!spacing.wanted[family][w]) continue;
                const Point3& at = p.mesh.points[p.mesh.wedge_vertices[w]];
                double square = 1e300;
                const auto see = [&](const Point3& a, const Point3& b) {
                    square = std::min(square, core::find_nearest_on_triangle(at, a, b, b).squared_distance);
                };
                for (const Line& line : network.lines())
                    for (std::size_t k = 0; line.family == family && k < line.faces.size(); ++k)
                        see(network.point(line.crossings[k]),
                            network.point(line.crossings[(k + 1) % line.crossings.size()]));
                for (Index e = 0; e < p.mesh.edge_curves.size(); ++e)
                    if (p.mesh.edge_curves[e] != no_index) see(p.mesh.point_on(e, 0.0), p.mesh.point_on(e, 1.0));
                ASSERT_LE(std::sqrt(square), (1.0 + 1e-9) * network.coverage(family).farthest * spacing.at[family][w]);
            }
        }
    }
}

/// Lines that run exactly through vertices and along edges are the hardest to keep apart.
TEST(Network, ChordsOfAFamilyNeverCross) {
    for (const TriangleMesh& input : {generators::make_grid_torus(2.0, 0.7, 48, 24), generators::make_icosphere(3),
                                      generators::make_torus(2.0, 0.7, 2000, 3)}) {
        const Prepared p = prepare(input, 3.0);
        SpacingRule rule;
        rule.error = 2e-3 * p.mesh.diagonal;
        const Spacing spacing = compute_spacing(p.mesh, p.field, rule, {});
        const Network network = trace_lines(p.mesh, p.field, spacing, {}, {});
        std::size_t pairs = 0, crossings = 0;
        for (Index f = 0; f < p.mesh.face_count(); ++f)
            for (Index i = network.first_chord(f); i != no_index; i = network.chord(i).next)
                for (Index j = network.chord(i).next; j != no_index; j = network.chord(j).next) {
                    const Chord &a = network.chord(i), &b = network.chord(j);
                    const bool cross = network.cross(a, b);
                    if (network.family_of(a) == network.family_of(b)) {
                        ++pairs;
                        ASSERT_FALSE(cross);
                    } else {
                        crossings += cross ? 1 : 0;
                    }
                }
        EXPECT_GT(pairs, 0U);
        EXPECT_GT(crossings, 50U);
        for (Index e = 0; e < p.mesh.edge_halfedges.size(); ++e) {
            const auto& list = network.on_edge(e);
            for (std::size_t k = 0; k + 1 < list.size(); ++k)
                ASSERT_LT(network.crossing(list[k]).t, network.crossing(list[k + 1]).t);
        }
    }
}

/// One family alone leaves rings; the check must see them, and see nothing once both are there.
TEST(Arrangement, FacesThatAreNoDisksAreFound) {
    const Prepared p = prepare(generators::make_torus(2.0, 0.7, 3000, 1), 3.0);
    SpacingRule rule;
    rule.error = 4e-3 * p.mesh.diagonal;
    const Spacing spacing = compute_spacing(p.mesh, p.field, rule, {});
    Network network = trace_lines(p.mesh, p.field, spacing, {}, {});
    Graph whole = build_graph(network, {rule.error, rule.error});
    simplify_graph(whole, network);
    const auto faces = whole.trace_faces(p.mesh);
    EXPECT_TRUE(find_flaws(whole, network, faces).empty());
    const DiskTest is_disk(network, whole);
    for (const auto& face : faces) EXPECT_TRUE(is_disk(face));
    std::size_t sides = 0;
    for (const auto& face : faces) sides += face.size();
    std::size_t edges = 0;
    for (const GraphEdge& e : whole.edges) edges += e.alive() ? 1 : 0;
    EXPECT_EQ(sides, 2 * edges);
    // Keep two lines of each family: faces remain that run around the torus.
    std::array<int, 2> kept{0, 0};
    for (Index l = 0; l < network.lines().size(); ++l)
        if (!network.lines()[l].closed ||
            ++kept[network.lines()[l].family] > (network.lines()[l].family == along_max ? 1 : 2))
            network.remove_line(l);
    Graph few = build_graph(network, {rule.error, rule.error});
    EXPECT_EQ(find_flaws(few, network, few.trace_faces(p.mesh)).patches.empty(),
              kept[along_min] > 0 && kept[along_max] > 0);
    for (Index l = 0; l < network.lines().size(); ++l)
        if (network.lines()[l].family == along_min) network.remove_line(l);
    Graph none = build_graph(network, {rule.error, rule.error});
    EXPECT_EQ(find_flaws(none, network, none.trace_faces(p.mesh)).patches.size(), 1U);
}

/// Rims that no line ties to each other: near the smaller one of a patch, one more might.
TEST(Arrangement, IslandsAreFound) {
    const Prepared p = prepare(facetted_pipe(16), 3.0);
    const Network network(p.mesh);
    const Graph graph = build_graph(network, {0.01, 0.01});
    const auto faces = graph.trace_faces(p.mesh);
    const Flaws flaws = find_flaws(graph, network, faces);
    ASSERT_EQ(flaws.patches.size(), 4U);
    ASSERT_EQ(flaws.places.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(flaws.places[i].patch, flaws.patches[i]);
        EXPECT_GT(flaws.places[i].size, 1.4);
        EXPECT_LT(flaws.places[i].size, 3.0);
    }
    // Each by itself, a rim tells whether it is that of a disk.
    const DiskTest is_disk(network, graph);
    for (const auto& face : faces) {
        const Index patch = patch_beside(graph, network, face.front());
        EXPECT_NE(is_disk(face), std::find(flaws.patches.begin(), flaws.patches.end(), patch) != flaws.patches.end());
    }
}

TEST(Remesh, KeepsGenusAndClosedness) {
    RemeshOptions options;
    options.error = Length{3e-2, true};
    options.placement = false;
    const auto check = [&](const char* name, const TriangleMesh& mesh, std::int64_t euler) {
        SCOPED_TRACE(name);
        expect_closed(remesh(mesh, options), euler);
    };
    check("torus", generators::make_torus(2.0, 0.7, 5000, 1), 0);
    check("grid torus", generators::make_grid_torus(2.0, 0.7, 40, 20), 0);
    check("ellipsoid", generators::make_ellipsoid(2.0, 1.2, 0.8, 5000, 1), 2);
    check("sphere", generators::make_icosphere(3), 2);
    check("noise", generators::make_noisy(generators::make_ellipsoid(2.0, 1.2, 0.8, 5000, 1), 0.02, 4), 2);
}

/// The bound is the library's own claim; here it is measured anew, on other samples.
TEST(Remesh, MeetsTheError) {
    const TriangleMesh input = generators::make_torus(2.0, 0.7, 5000, 1);
    PolygonMesh polygons{input.positions, {}, {0}};
    for (const Triangle& t : input.triangles) {
        polygons.corners.insert(polygons.corners.end(), t.begin(), t.end());
        polygons.offsets.push_back(static_cast<std::uint32_t>(polygons.corners.size()));
    }
    RemeshOptions options;
    options.error = Length{0.03, false};
    const RemeshResult result = remesh(input, options);
    expect_closed(result, 0);
    EXPECT_GT(result.statistics.distance_bound, 0.0);
    EXPECT_LE(result.statistics.distance_bound, 0.03);
    DistanceOptions distance;
    distance.seed = 99;
    distance.bound = false;
    EXPECT_LE(measure_distance(result.mesh, polygons, distance).hausdorff, result.statistics.distance_bound);
    // Not by cutting warped quads, nor by triangles of the input.
    EXPECT_EQ(result.statistics.mended_triangles, 0U);
    EXPECT_GT(double(result.statistics.quads), 0.85 * double(result.statistics.faces));
}

/// What was asked for is asked of the polygons that are subdivided (a count), or of the result (an error).
TEST(Remesh, SubdivisionKeepsTheError) {
    const TriangleMesh input = generators::make_torus(2.0, 0.7, 2000, 1);
    RemeshOptions options;
    options.error = Length{0.05, false};
    options.subdivide = 1;
    const RemeshResult result = remesh(input, options);
    expect_closed(result, 0);
    EXPECT_EQ(result.statistics.subdivision_rounds, 1U);
    EXPECT_GT(result.statistics.distance_bound, 0.0);
    EXPECT_LE(result.statistics.distance_bound, 0.05);
    PolygonMesh polygons{input.positions, {}, {0}};
    for (const Triangle& t : input.triangles) {
        polygons.corners.insert(polygons.corners.end(), t.begin(), t.end());
        polygons.offsets.push_back(static_cast<std::uint32_t>(polygons.corners.size()));
    }
    DistanceOptions distance;
    distance.bound = false;
    EXPECT_LE(measure_distance(result.mesh, polygons, distance).hausdorff, result.statistics.distance_bound);
    options.error.reset();
    options.vertices = 200;
    EXPECT_NEAR(static_cast<double>(remesh(input, options).statistics.vertices), 800.0, 40.0);
}

TEST(Remesh, MeetsTheCountAndIsMostlyQuads) {
    for (const std::uint64_t wanted : {300U, 900U}) {
        RemeshOptions options;
        options.placement = false;
        options.vertices = wanted;
        const RemeshResult result = remesh(generators::make_ellipsoid(2.0, 1.2, 0.8, 10000, 1), options);
        expect_closed(result, 2);
        EXPECT_NEAR(static_cast<double>(result.statistics.vertices), static_cast<double>(wanted), 0.05 * wanted);
        EXPECT_GE(result.statistics.quads, 8 * result.statistics.faces / 10);
    }
}

/// Equation 4.7: a quad is longer along the lesser curvature, by the root of their ratio.
TEST(Remesh, AspectRatiosAreThoseOfTheory) {
    constexpr double a = 2.0, b = 1.2, c = 0.8;
    RemeshOptions options;
    options.vertices = 800;
    const RemeshResult result = remesh(generators::make_ellipsoid(a, b, c, 20000, 1), options);
    ASSERT_EQ(result.outcome, Outcome::done);
    std::vector<double> errors;
    double sum = 0.0;
    for (std::size_t q = 0; q + 1 < result.mesh.offsets.size(); ++q) {
        const std::uint32_t first = result.mesh.offsets[q];
        if (result.mesh.offsets[q + 1] - first != 4) continue;
        const auto at = [&](std::uint32_t i) {
            return result.mesh.positions[index_of(result.mesh.corners[first + i])];
        };
        const double u = distance(at(0), at(1)) + distance(at(2), at(3)),
                     v = distance(at(1), at(2)) + distance(at(3), at(0));
        const Point3 p = 0.25 * (at(0) + at(1) + at(2) + at(3));
        // The ellipsoid's curvatures there.
        const double x = p.x / (a * a), y = p.y / (b * b), z = p.z / (c * c),
                     h = 1.0 / std::sqrt(x * x + y * y + z * z);
        const double volume = a * a * b * b * c * c, gauss = std::pow(h, 4) / volume;
        const double mean = std::pow(h, 3) * (a * a + b * b + c * c - dot(p, p)) / (2.0 * volume);
        const double root = std::sqrt(std::max(0.0, mean * mean - gauss)), ratio = (mean + root) / (mean - root);
        if (ratio < 2.0) continue;  // near umbilics it is not told which side is which
        errors.push_back(std::log(std::max(u, v) / std::min(u, v)) - 0.5 * std::log(ratio));
        sum += errors.back();
    }
    ASSERT_GT(errors.size(), 300U);
    const double mean = std::exp(sum / static_cast<double>(errors.size()));
    for (double& e : errors) e = std::abs(e);
    std::sort(errors.begin(), errors.end());
    const double median = std::exp(errors[errors.size() / 2]);
    std::printf("%zu quads: %.3f of theory in the mean, half within %.3f\n", errors.size(), mean, median);
    EXPECT_NEAR(mean, 1.0, 0.1);
    EXPECT_LT(median, 1.2);
}

/// Too flat for lines, too bent to be a flat face with a hole: the network has no polygon.
TEST(Remesh, NearlyFlatSheetsWithAHole) {
    for (const double height : {0.0, 5e-4, 2e-3, 1e-2}) {
        SCOPED_TRACE(height);
        TriangleMesh sheet = graph_of(40, [&](double x, double y) { return height * (x * x + y * y); });
        std::erase_if(sheet.triangles, [&](const Triangle& t) {
            return std::all_of(t.begin(), t.end(), [&](VertexId v) {
                const Point3& p = sheet.positions[index_of(v)];
                return std::max(std::abs(p.x), std::abs(p.y)) < 0.26;
            });
        });
        for (const RemeshOutput output : {RemeshOutput::quad_dominant, RemeshOutput::polygons}) {
            RemeshOptions options;
            options.output = output;
            const RemeshResult result = remesh(sheet, options);
            ASSERT_EQ(result.outcome, Outcome::done);
            const SurfaceCheck check = check_surface(result.mesh, make_polygon_mesh(sheet));
            EXPECT_TRUE(check.ok());
            EXPECT_EQ(check.mesh.boundary_loops, 2U);
        }
    }
}

TEST(Remesh, ABoxIsSixFaces) {
    RemeshOptions options;
    options.output = RemeshOutput::polygons;
    const RemeshResult result = remesh(generators::make_box(1.0, 2.0, 3.0), options);
    expect_closed(result, 2);
    EXPECT_EQ(result.mesh.positions.size(), 8U);
    EXPECT_EQ(result.statistics.faces, 6U);
    EXPECT_EQ(result.feature_edges.size(), 12U);
    EXPECT_EQ(result.statistics.corners, 8U);
}

TEST(Remesh, SpendsVerticesWhereNothingIsCurved) {
    RemeshOptions options;
    options.vertices = 600;
    for (const TriangleMesh& input : {generators::make_box(1.0, 2.0, 3.0), facetted_pipe(24)}) {
        const RemeshResult result = remesh(input, options);
        expect_closed(result, input.positions.size() == 8 ? 2 : 0);
        EXPECT_NEAR(static_cast<double>(result.statistics.vertices), 600.0, 30.0);
        EXPECT_GT(2 * result.statistics.quads, result.statistics.faces);
        EXPECT_EQ(result.statistics.mended_triangles, 0U);
    }
}

/// Thin spikes, which lines at their distance elsewhere cut off: they get closer there, and polygons stay.
TEST(Remesh, ComesCloserWherePolygonsBreak) {
    std::size_t mended = 0;
    for (const auto& spike : {std::pair{0.012, 300U}, {0.03, 150U}}) {
        const double width = spike.first;
        const auto vertices = static_cast<double>(spike.second);
        RemeshOptions options;
        options.vertices = spike.second;
        const auto height = [&](double x, double y) {
            return 0.3 * x * x - 0.2 * y * y + 1.5 * std::exp(-(x * x + y * y) / width);
        };
        const RemeshResult result = remesh(graph_of(40, height), options);
        ASSERT_EQ(result.outcome, Outcome::done);
        EXPECT_NEAR(static_cast<double>(result.statistics.vertices), vertices, 0.05 * vertices);
        mended += result.statistics.mended_triangles;
        std::printf("%zu mended triangles\n", result.statistics.mended_triangles);
    }
    EXPECT_LT(mended, 20U);
}

/// Boundary and tagged edges: sides of polygons lie on them, from end to end.
TEST(Remesh, CoversBoundaryAndTaggedEdges) {
    const std::uint32_t n = 30;
    const TriangleMesh input = graph_of(n, [](double x, double y) { return 0.5 * (x * x - y * y); });
    RemeshOptions options;
    options.error = Length{2e-3, true};
    options.placement = false;
    for (std::uint32_t i = 0; i < n; ++i)  // the row in the middle
        options.features.push_back({VertexId{n / 2 * (n + 1) + i}, VertexId{n / 2 * (n + 1) + i + 1}});
    const RemeshResult result = remesh(input, options);
    ASSERT_EQ(result.outcome, Outcome::done);
    const Shape shape = shape_of(result.mesh);
    EXPECT_EQ(shape.euler, 1);
    EXPECT_TRUE(shape.manifold);
    EXPECT_EQ(result.statistics.boundary_loops, 1U);
    std::map<std::uint32_t, std::size_t> degree;
    double rim = 0.0, row = 0.0;
    for (const Edge& e : result.feature_edges) {
        const Point3 a = result.mesh.positions[index_of(e[0])], b = result.mesh.positions[index_of(e[1])];
        ++degree[index_of(e[0])], ++degree[index_of(e[1])];
        const auto on_rim = [](const Point3& p) {
            return std::abs(std::max(std::abs(p.x), std::abs(p.y)) - 1.0) < 1e-12;
        };
        (on_rim(a) && on_rim(b) ? rim : row) += std::hypot(a.x - b.x, a.y - b.y);
    }
    EXPECT_NEAR(rim, 8.0, 1e-9);
    EXPECT_NEAR(row, 2.0, 0.1);  // jittered
    for (const auto& [vertex, count] : degree) EXPECT_GE(count, 2U);
    EXPECT_EQ(std::count_if(degree.begin(), degree.end(), [](const auto& d) { return d.second == 3; }), 2);
}

TEST(Remesh, DoesNotDependOnThreads) {
    const TriangleMesh input = generators::make_ellipsoid(2.0, 1.2, 0.8, 4000, 1);
    RemeshOptions options;
    options.vertices = 300;
    std::vector<RemeshResult> results;
    for (const unsigned threads : {1U, 2U, 1U}) {
        RunControl control;
        control.threads = threads;
        results.push_back(remesh(input, options, control));
    }
    for (const RemeshResult& result : results) {
        EXPECT_EQ(result.mesh.positions, results[0].mesh.positions);
        EXPECT_EQ(result.mesh.corners, results[0].mesh.corners);
    }
}

TEST(Remesh, TurnsTrianglesAlikeAndSaysSo) {
    TriangleMesh input = generators::make_torus(2.0, 0.7, 2000, 1);
    for (std::size_t t = 0; t < 40; ++t) std::swap(input.triangles[t][0], input.triangles[t][1]);
    RemeshOptions options;
    options.vertices = 150;
    options.placement = false;
    const RemeshResult result = remesh(input, options);
    expect_closed(result, 0);
    EXPECT_EQ(result.statistics.flipped_triangles, 40U);
}

TEST(Remesh, SaysWhatItRepairs) {
    TriangleMesh input = generators::make_torus(2.0, 0.7, 2000, 1);
    const auto [a, b, c] = input.triangles[7];
    const auto count = static_cast<std::uint32_t>(input.positions.size());
    input.positions.push_back({3.0, 0.0, 2.0});  // the tip of a fin
    input.positions.push_back({9.0, 9.0, 9.0});  // of no triangle
    input.triangles.push_back({a, b, VertexId{count}});
    input.triangles.push_back({c, a, b});
    input.triangles.push_back({b, a, c});
    input.triangles.push_back({a, a, c});
    RemeshOptions options;
    options.vertices = 150;
    options.placement = false;
    const RemeshStatistics s = remesh(input, options).statistics;
    EXPECT_EQ(s.unused_vertices, 1U);
    EXPECT_EQ(s.repeated_triangles, 2U);
    EXPECT_EQ(s.degenerate_triangles, 1U);
    EXPECT_EQ(s.non_manifold_edges, 1U);
    for (const char* what : {"1 point of the input belongs to no triangle", "2 triangles repeat others",
                             "1 triangle names a point twice", "1 edge belongs to more than two triangles"})
        EXPECT_TRUE(std::any_of(s.notes.begin(), s.notes.end(), [&](const std::string& note) {
            return note.starts_with(what);
        })) << what;
}

/// An octahedron of which the corners are drawn out into needles.
TriangleMesh make_needles(int rounds) {
    TriangleMesh mesh;
    for (int i = 0; i < 6; ++i) {
        std::array<double, 3> p{};
        p[static_cast<std::size_t>(i / 2)] = i % 2 == 0 ? 1.0 : -1.0;
        mesh.positions.push_back({p[0], p[1], p[2]});
    }
    const auto id = [](std::size_t v) { return VertexId{static_cast<std::uint32_t>(v)}; };
    for (std::size_t x : {0, 1})
        for (std::size_t y : {2, 3})
            for (std::size_t z : {4, 5}) {
                const bool even = (x + y + z) % 2 == 0;
                mesh.triangles.push_back({id(x), id(even ? y : z), id(even ? z : y)});
            }
    for (int round = 0; round < rounds; ++round) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, VertexId> middles;
        const auto middle = [&](VertexId a, VertexId b) {
            const auto [found, is_new] = middles.try_emplace(std::minmax(index_of(a), index_of(b)), id(0));
            if (is_new) {
                found->second = id(mesh.positions.size());
                const Point3 &p = mesh.positions[index_of(a)], &q = mesh.positions[index_of(b)];
                mesh.positions.push_back({0.5 * (p.x + q.x), 0.5 * (p.y + q.y), 0.5 * (p.z + q.z)});
            }
            return found->second;
        };
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const VertexId ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            for (const Triangle& t : {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}}) finer.push_back(t);
        }
        mesh.triangles = std::move(finer);
    }
    for (Point3& p : mesh.positions) p = {p.x * p.x * p.x, p.y * p.y * p.y, p.z * p.z * p.z};
    return mesh;
}

TEST(Remesh, CreasesAreThoseOfTheInputBeforeItsEdgesAreHalved) {
    // Halves of the needles' triangles are slivers, whose normals say nothing.
    const TriangleMesh input = make_needles(4);
    RemeshOptions options;
    options.error = Length{0.01, true};
    const RemeshResult result = remesh(input, options);
    SurfaceCheckOptions check;
    check.error = options.error;
    const SurfaceCheck found = check_surface(result.mesh, make_polygon_mesh(input), check);
    EXPECT_TRUE(found.violations.empty()) << found.violations.front().message;
    EXPECT_GT(found.creases.corners, 20U);
}

TEST(Remesh, AnErrorBelowTheInputsFacetsIsKeptByTheInput) {
    const TriangleMesh input = generators::make_torus(2.0, 0.7, 800, 1);
    for (const double error : {1e-4, 1e-6, 1e-9}) {
        RemeshOptions options;
        options.error = Length{error, true};
        const RemeshResult result = remesh(input, options);
        EXPECT_EQ(result.outcome, Outcome::done) << error;
        EXPECT_LE(result.mesh.positions.size(), 2 * input.positions.size()) << error;
        SurfaceCheckOptions check;
        check.error = options.error;
        const SurfaceCheck found = check_surface(result.mesh, make_polygon_mesh(input), check);
        EXPECT_TRUE(found.violations.empty()) << found.violations.front().message;
    }
    RemeshOptions options;
    options.error = Length{1e-11, true};
    EXPECT_THROW(remesh(input, options), InputError);
}

TEST(Remesh, TrianglesAreTheLeastDegree) {
    RemeshOptions options;
    options.output = RemeshOutput::polygons;
    options.max_degree = 3;
    const RemeshResult result = remesh(generators::make_torus(2.0, 0.7, 800, 1), options);
    EXPECT_EQ(result.statistics.quads, 0U);
    EXPECT_EQ(result.statistics.triangles, result.statistics.faces);
}

/// A path as long as conjugate gradients would take rounds to pass it.
TEST(Connection, SolvesWhereIterationDoesNotGetThere) {
    constexpr std::size_t n = 20000;
    Laplacian path;
    path.offsets.assign(1, 0);
    for (std::size_t i = 0; i < n; ++i) {
        for (const std::size_t j : {i - 1, i + 1}) {
            if (j >= n) continue;
            path.columns.push_back(static_cast<Index>(j));
            path.weights.push_back(1.0);
            path.transports.push_back(std::polar(1.0, i < j ? 0.1 : -0.1));
        }
        path.offsets.push_back(path.columns.size());
        path.diagonal.push_back(i == 0 || i + 1 == n ? 1.0 : 2.0);
    }
    std::vector<double> screen(n, 0.0);
    std::vector<Complex> right(n), u(n);
    screen[0] = 1.0, right[0] = 1.0;
    solve(path, screen, right, u, {});
    for (const std::size_t i : {std::size_t{1}, n / 2, n - 1})
        EXPECT_LT(std::abs(u[i] - std::polar(1.0, -0.1 * static_cast<double>(i))), 1e-6) << i;
}

TEST(Remesh, RefusesWhatItCannotDo) {
    // A strip of five triangles with a half twist.
    TriangleMesh moebius;
    for (int i = 0; i < 5; ++i) moebius.positions.push_back({std::cos(i * 0.4 * pi), std::sin(i * 0.4 * pi), 0.1 * i});
    for (std::uint32_t i = 0; i < 5; ++i)
        moebius.triangles.push_back({VertexId{i}, VertexId{(i + 1) % 5}, VertexId{(i + 2) % 5}});
    EXPECT_THROW(remesh(moebius), InputError);
    EXPECT_THROW(remesh(TriangleMesh{}), InputError);
    TriangleMesh broken = generators::make_box(1.0, 1.0, 1.0);
    broken.positions[3].y = std::nan("");
    EXPECT_THROW(remesh(broken), InputError);
    broken = generators::make_box(1.0, 1.0, 1.0);
    broken.triangles[0][0] = VertexId{99};
    EXPECT_THROW(remesh(broken), InputError);
    for (const double unit : {1e60, 1e-60, 4e-159}) {
        const TriangleMesh far_off = generators::make_box(unit, unit, unit);
        try {
            remesh(far_off);
            ADD_FAILURE() << unit;
        } catch (const InputError& error) {
            EXPECT_EQ(error.defects().front().kind, DefectKind::coordinate_out_of_range) << unit;
        }
    }
    EXPECT_EQ(remesh(generators::make_box(1e40, 1e40, 1e40)).statistics.vertices, 8U);
    EXPECT_EQ(remesh(generators::make_box(1e-40, 1e-40, 1e-40)).statistics.vertices, 8U);
    RemeshOptions both;
    both.vertices = 100;
    both.error = Length{1.0, false};
    EXPECT_THROW(remesh(generators::make_box(1.0, 1.0, 1.0), both), InputError);
    RemeshOptions angle;
    angle.feature_angle_radians = 0.0;
    EXPECT_THROW(remesh(generators::make_box(1.0, 1.0, 1.0), angle), InputError);
    RemeshOptions degree;
    degree.max_degree = 5;
    EXPECT_THROW(remesh(generators::make_box(1.0, 1.0, 1.0), degree), InputError);
    degree.output = RemeshOutput::polygons;
    EXPECT_EQ(remesh(generators::make_box(1.0, 1.0, 1.0), degree).statistics.vertices, 8U);
    // A diagonal through the box is no edge of it.
    const TriangleMesh box = generators::make_box(1.0, 1.0, 1.0);
    for (std::uint32_t v = 1; v < 8; ++v) {
        const Point3 across = box.positions[v] - box.positions[0];
        if (across.x == 0.0 || across.y == 0.0 || across.z == 0.0) continue;
        RemeshOptions options;
        options.features.push_back({VertexId{0}, VertexId{v}});
        EXPECT_THROW(remesh(box, options), InputError);
    }
}

TEST(Remesh, CanBeCancelled) {
    std::atomic<bool> cancel{true};
    RunControl control;
    control.cancel = &cancel;
    EXPECT_EQ(remesh(generators::make_icosphere(3), {}, control).outcome, Outcome::cancelled);
}

}  // namespace
}  // namespace certa::remeshing
