// All patterns of T-nodes on triangles, rectangles and pentagons: pieces tile, and none has a straight corner.
#include "remeshing/templates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/random.h"
#include "core/vector3.h"
#include "remeshing/coarse_meshes.h"
#include "remeshing/cut_far.h"
#include "remeshing/flat_triangles.h"
#include "remeshing/join_triangles.h"

namespace certa::remeshing {
namespace {

/// A convex polygon with `nodes[i]` nodes in side i, evenly.
std::vector<Point3> with_nodes(const std::vector<Point3>& corners, const std::vector<int>& nodes) {
    std::vector<Point3> ring;
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (int k = 0; k <= nodes[i]; ++k) {
            const double s = k / (nodes[i] + 1.0);
            ring.push_back((1.0 - s) * corners[i] + s * corners[(i + 1) % corners.size()]);
        }
    return ring;
}
std::vector<Point3> rectangle(double width) { return {{0, 0, 0}, {width, 0, 0}, {width, 1, 0}, {0, 1, 0}}; }
std::vector<Point3> regular(int n) {
    std::vector<Point3> corners;
    for (int i = 0; i < n; ++i)
        corners.push_back({std::cos(2.0 * std::numbers::pi * i / n), std::sin(2.0 * std::numbers::pi * i / n), 0.0});
    return corners;
}
double area(const std::vector<Point3>& ring, const std::vector<Index>& piece) {
    double sum = 0.0;
    for (std::size_t i = 1; i + 1 < piece.size(); ++i)
        sum += 0.5 * cross(ring[piece[i]] - ring[piece[0]], ring[piece[i + 1]] - ring[piece[0]]).z;
    return sum;
}

struct Count {
    int quads = 0, triangles = 0;
    friend bool operator==(const Count&, const Count&) = default;
};

/// Pieces are convex without straight corners, conform, and have the polygon's area.
Count expect_tiling(const std::vector<Point3>& ring) {
    const auto pieces = cut_into_quads(ring);
    std::vector<Index> whole;
    for (Index i = 0; i < ring.size(); ++i) whole.push_back(i);
    Count count;
    double sum = 0.0;
    std::map<std::pair<Index, Index>, int> sides;  // directed
    for (const auto& piece : pieces) {
        ++(piece.size() == 4 ? count.quads : count.triangles);
        EXPECT_TRUE(piece.size() == 3 || piece.size() == 4);
        sum += area(ring, piece);
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const Index a = piece[i], b = piece[(i + 1) % piece.size()], c = piece[(i + 2) % piece.size()];
            ++sides[{a, b}];
            const Point3 in = ring[b] - ring[a], out = ring[c] - ring[b];
            EXPECT_GT(cross(in, out).z / (norm(in) * norm(out)), 1e-3) << "a straight or reflex corner";
        }
    }
    EXPECT_NEAR(sum, area(ring, whole), 1e-12);
    EXPECT_EQ(count.triangles + 2 * count.quads + 2, static_cast<int>(ring.size()));
    for (const auto& [side, times] : sides) {
        EXPECT_EQ(times, 1);
        const bool is_outer = side.second == (side.first + 1) % ring.size();
        EXPECT_EQ(sides.count({side.second, side.first}), is_outer ? 0u : 1u);
    }
    return count;
}

TEST(Templates, AllPatternsOnRectangles) {
    for (const double width : {1.0, 4.0})
        for (int pattern = 0; pattern < 256; ++pattern) {
            const std::vector<int> nodes{pattern & 3, pattern >> 2 & 3, pattern >> 4 & 3, pattern >> 6 & 3};
            SCOPED_TRACE(pattern);
            const Count count = expect_tiling(with_nodes(rectangle(width), nodes));
            // Turned by 90 degrees (of the square) it is the same pattern.
            if (width > 1.0) continue;
            const Count turned = expect_tiling(with_nodes(rectangle(width), {nodes[1], nodes[2], nodes[3], nodes[0]}));
            EXPECT_EQ(count, turned);
        }
}

TEST(Templates, AllPatternsOnTrianglesAndPentagons) {
    for (int pattern = 0; pattern < 64; ++pattern)
        expect_tiling(with_nodes(regular(3), {pattern & 3, pattern >> 2 & 3, pattern >> 4 & 3}));
    for (int pattern = 0; pattern < 32; ++pattern)
        expect_tiling(with_nodes(
            regular(5), {pattern & 1, pattern >> 1 & 1, pattern >> 2 & 1, pattern >> 3 & 1, pattern >> 4 & 1}));
}

TEST(Templates, KnownOnes) {
    const auto count = [](std::vector<int> nodes) { return expect_tiling(with_nodes(rectangle(1.5), nodes)); };
    EXPECT_EQ(count({0, 0, 0, 0}), (Count{1, 0}));
    EXPECT_EQ(count({1, 0, 0, 0}), (Count{1, 1}));
    EXPECT_EQ(count({1, 0, 1, 0}), (Count{2, 0}));  // joined straight across
    EXPECT_EQ(count({2, 0, 2, 0}), (Count{3, 0}));
    EXPECT_EQ(count({2, 0, 0, 0}), (Count{1, 2}));
    EXPECT_EQ(count({2, 0, 1, 0}), (Count{2, 1}));
}

TEST(Templates, NoPieceWithoutAreaInAThinPolygon) {
    // Six nodes in one straight side, close to the other side.
    for (const double height : {0.3, 0.1, 0.03}) {
        std::vector<Point3> ring;
        for (int i = 0; i < 6; ++i) ring.push_back({0.2 * i, 0.0, 0.0});
        ring.push_back({0.9, height, 0.0});
        ring.push_back({0.1, height, 0.0});
        double sum = 0.0;
        for (const auto& piece : cut_into_quads(ring)) {
            EXPECT_GT(area(ring, piece), 0.05 * height);
            sum += area(ring, piece);
        }
        EXPECT_NEAR(sum, 0.9 * height, 1e-12);
    }
}

TEST(Templates, LargePolygonsArePaired) {
    const Count count = expect_tiling(regular(40));
    EXPECT_GE(count.quads, 14);
}

TEST(Templates, CutAWholeMeshAndKeepItConforming) {
    // Left a square with a node in the side that it shares with two squares on the right.
    CoarseMesh mesh;
    for (const Point3& p :
         {Point3{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {0, 2, 0}, {3, 0, 0}, {3, 1, 0}, {3, 2, 0}})
        mesh.add_vertex(p, {});
    mesh.add_polygon(std::vector<Index>{0, 1, 2, 3, 4});
    mesh.add_polygon(std::vector<Index>{1, 5, 6, 2});
    mesh.add_polygon(std::vector<Index>{2, 6, 7, 3});
    mesh.feature_edges.push_back({0, 1, 0});
    const CoarseMesh quads = make_quad_dominant(mesh);
    EXPECT_EQ(quads.polygon_count(), 4u);
    EXPECT_EQ(quads.points, mesh.points);
    EXPECT_EQ(quads.feature_edges.size(), 1u);
    EXPECT_EQ(make_triangles(mesh, core::TriangleTree({}, {})).polygon_count(), 7u);
    EXPECT_EQ(limit_degree(mesh, 4).polygon_count(), 4u);
    EXPECT_EQ(limit_degree(mesh, 5).polygon_count(), 3u);
    EXPECT_EQ(limit_degree(mesh, 3).polygon_count(), 7u);
}

TEST(Templates, DegreesAreLimited) {
    CoarseMesh mesh;
    std::vector<Index> ring;
    for (const Point3& p : regular(37)) ring.push_back(mesh.add_vertex(p, {}));
    mesh.add_polygon(ring);
    for (const std::size_t most : {3u, 4u, 6u, 9u}) {
        const CoarseMesh cut = limit_degree(mesh, most);
        double sum = 0.0;
        for (std::size_t q = 0; q < cut.polygon_count(); ++q) {
            EXPECT_LE(cut.polygon(q).size(), most);
            const auto piece = cut.polygon(q);
            sum += area(cut.points, {piece.begin(), piece.end()});
        }
        EXPECT_NEAR(sum, 18.5 * std::sin(2.0 * std::numbers::pi / 37.0), 1e-12);
    }
}

/// Two rows of squares with a line more in one column: it ends at y = 1 in column 1 of the lower row, and one starts
/// there `shift` columns further: two T-nodes.
CoarseMesh shifted_rows(Index shift) {
    CoarseMesh mesh;
    std::vector<double> columns;
    for (Index i = 0; i < shift + 4; ++i) columns.push_back(i);
    std::vector<double> below = columns, above = columns;
    below.insert(below.begin() + 2, 1.5);
    above.insert(above.begin() + 2 + shift, 1.5 + shift);
    std::vector<double> between = below;
    between.insert(between.end(), above.begin(), above.end());
    std::sort(between.begin(), between.end());
    between.erase(std::unique(between.begin(), between.end()), between.end());
    std::map<std::pair<double, double>, Index> ids;
    const auto id = [&](double x, double y) {
        const auto [at, is_new] = ids.try_emplace({x, y}, 0);
        if (is_new) at->second = mesh.add_vertex({x, y, 0.0}, {});
        return at->second;
    };
    const auto add_row = [&](const std::vector<double>& bottom, double y, const std::vector<double>& top) {
        const std::vector<double>& own = y == 0.0 ? bottom : top;
        for (std::size_t i = 0; i + 1 < own.size(); ++i) {
            std::vector<Index> ring;
            const auto is_in = [&](double x) { return own[i] <= x && x <= own[i + 1]; };
            for (const double x : bottom)
                if (is_in(x)) ring.push_back(id(x, y));
            for (auto x = top.rbegin(); x != top.rend(); ++x)
                if (is_in(*x)) ring.push_back(id(*x, y + 1.0));
            mesh.add_polygon(ring, static_cast<Index>(mesh.polygon_count()));
        }
    };
    add_row(below, 0.0, between);
    add_row(between, 1.0, above);
    return mesh;
}
std::size_t triangles_of(const CoarseMesh& mesh) {
    std::size_t count = 0;
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) count += mesh.polygon(q).size() == 3 ? 1 : 0;
    return count;
}
double area(const CoarseMesh& mesh) {
    double sum = 0.0;
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        sum += area(mesh.points, {ring.begin(), ring.end()});
    }
    return sum;
}

CoarseMesh join(const CoarseMesh& mesh) { return recut(mesh, find_recuts(mesh)); }

TEST(FlatTriangles, TheCornerInASideGoesToThePolygonBeyond) {
    CoarseMesh mesh;
    for (const Point3& p : {Point3{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0.5, 1, 0}, {1, 2, 0}})
        mesh.add_vertex(p, {});
    mesh.add_polygon(std::array<Index, 4>{0, 1, 2, 3}, 0);
    mesh.add_polygon(std::array<Index, 3>{3, 2, 4}, 1);  // no area
    mesh.add_polygon(std::array<Index, 3>{4, 2, 5}, 1);
    mesh.add_polygon(std::array<Index, 3>{3, 4, 5}, 1);
    const CoarseMesh better = without_flat_triangles(mesh);
    EXPECT_EQ(better.polygon_count(), 5U);
    EXPECT_NEAR(area(better), area(mesh), 1e-12);
    for (std::size_t q = 0; q < better.polygon_count(); ++q)
        EXPECT_GT(area(better.points, {better.polygon(q).begin(), better.polygon(q).end()}), 0.1);
    mesh.feature_edges.push_back({2, 3, 7});
    const CoarseMesh creased = without_flat_triangles(mesh);
    ASSERT_EQ(creased.feature_edges.size(), 2U);
    for (const FeatureEdge& e : creased.feature_edges) EXPECT_TRUE((e.a == 4 || e.b == 4) && e.curve == 7);
}

TEST(JoinTriangles, TwoTNodesNearEachOtherCancel) {
    for (const Index shift : {0U, 1U}) {
        const CoarseMesh cut = make_quad_dominant(shifted_rows(shift));
        EXPECT_EQ(triangles_of(cut), shift > 0 ? 2U : 0U) << shift;
        const CoarseMesh joined = join(cut);
        EXPECT_EQ(triangles_of(joined), 0U) << shift;
        EXPECT_EQ(joined.points.size(), cut.points.size());
        EXPECT_NEAR(area(joined), area(cut), 1e-12);
        for (std::size_t q = 0; q < joined.polygon_count(); ++q) {
            const auto ring = joined.polygon(q);
            EXPECT_GT(area(joined.points, {ring.begin(), ring.end()}), 0.0);
        }
    }
}

TEST(JoinTriangles, TNodesFarFromEachOtherStay) {
    EXPECT_EQ(triangles_of(join(make_quad_dominant(shifted_rows(6)))), 2U);
}

TEST(JoinTriangles, IsNotDoneWhereAPolygonIsGone) {
    const CoarseMesh cut = make_quad_dominant(shifted_rows(1));
    const std::vector<Recut> recuts = find_recuts(cut);
    ASSERT_FALSE(recuts.empty());
    CoarseMesh less = cut.without_polygons();
    for (std::size_t q = 0; q < cut.polygon_count(); ++q) {
        const auto ring = cut.polygon(q);
        if (ring.size() == 4 || triangles_of(less) == 0) less.add_polygon(ring, cut.parent(q));
    }
    EXPECT_EQ(recut(less, recuts).corners, less.corners);
}

/// A valley along x = 1, and two squares at its height 1 that bridge it from x = 0 to x = 2.
struct Bridge {
    TriangleMesh valley;
    CoarseMesh mesh;
    Bridge() {
        const auto id = [](std::uint32_t v) { return VertexId{v}; };
        for (const double y : {-1.0, 3.0})
            for (const double x : {-1.0, 1.0, 3.0}) valley.positions.push_back({x, y, std::abs(x - 1.0)});
        valley.triangles = {{id(0), id(1), id(4)}, {id(0), id(4), id(3)}, {id(1), id(2), id(5)}, {id(1), id(5), id(4)}};
        for (const double y : {0.0, 1.0, 2.0})
            for (const double x : {0.0, 2.0}) mesh.add_vertex({x, y, 1.0}, {});
    }
};

TEST(CutFar, QuadsAreCutAlongADiagonal) {
    Bridge b;
    const core::TriangleTree input(b.valley.positions, b.valley.triangles);
    b.mesh.add_polygon(std::array<Index, 4>{0, 1, 3, 2}, 0);
    b.mesh.add_polygon(std::array<Index, 4>{2, 3, 5, 4}, 1);
    const std::vector<Recut> recuts = cut_far_polygons(b.mesh, {1}, input, true);
    ASSERT_EQ(recuts.size(), 1U);
    EXPECT_EQ(b.mesh.points.size(), 6U);
    const CoarseMesh cut = recut(b.mesh, recuts);
    EXPECT_EQ(cut.polygon_count(), 3U);
    EXPECT_NEAR(area(cut), 4.0, 1e-12);
    EXPECT_TRUE(cut_far_polygons(b.mesh, {}, input, true).empty());
}

TEST(CutFar, TrianglesGetAVertexOnTheInput) {
    Bridge b;
    const core::TriangleTree input(b.valley.positions, b.valley.triangles);
    b.mesh.add_polygon(std::array<Index, 3>{0, 1, 2}, 0);
    b.mesh.add_polygon(std::array<Index, 4>{1, 3, 5, 2}, 1);
    EXPECT_TRUE(cut_far_polygons(b.mesh, {0}, input, false).empty());
    CoarseMesh mesh = b.mesh;
    const std::vector<Recut> recuts = cut_far_polygons(mesh, {0}, input, true);
    ASSERT_EQ(recuts.size(), 1U);
    ASSERT_EQ(mesh.points.size(), 7U);
    EXPECT_NEAR(mesh.points[6].z, std::abs(mesh.points[6].x - 1.0), 1e-12);
    const CoarseMesh cut = recut(mesh, recuts);
    // In the middle of the farthest side: what is beyond a side is cut, too; the boundary has nothing beyond.
    EXPECT_EQ(recuts[0].before.size(), 2U);
    EXPECT_EQ(cut.polygon_count(), 5U);
    // A feature is no side to be split: the vertex is inside of the triangle.
    b.mesh.feature_edges.push_back({1, 2, 0});
    const std::vector<Recut> inside = cut_far_polygons(b.mesh, {0}, input, true);
    ASSERT_EQ(inside.size(), 1U);
    EXPECT_EQ(inside[0].before.size(), 1U);
    EXPECT_EQ(inside[0].after.size(), 3U);
}

TEST(CutFar, PointsGetAVertexBesideASideOrInside) {
    Bridge b;
    const core::TriangleTree input(b.valley.positions, b.valley.triangles);
    b.mesh.add_polygon(std::array<Index, 4>{0, 1, 3, 2}, 0);
    b.mesh.add_polygon(std::array<Index, 4>{2, 3, 5, 4}, 1);
    const Point3 middle{1.0, 0.5, 1.0}, off{0.9, 0.4, 1.0}, at_side{1.1, 0.95, 1.0};
    CoarseMesh mesh = b.mesh;
    const std::vector<Recut> inside = cut_around_points(mesh, {{0, middle, 0.2}, {0, off, 0.1}}, input);
    ASSERT_EQ(inside.size(), 1U) << "the first point of a polygon counts";
    EXPECT_EQ(inside[0].before.size(), 1U);
    EXPECT_EQ(inside[0].after.size(), 4U);
    EXPECT_EQ(recut(mesh, inside).polygon_count(), 5U);
    ASSERT_EQ(mesh.points.size(), 7U);
    EXPECT_LT(distance(mesh.points[6], input.find_nearest(middle).point), 1e-12);
    // Next to the side that both have: both.
    mesh = b.mesh;
    const std::vector<Recut> beside = cut_around_points(mesh, {{0, at_side, 0.1}}, input);
    ASSERT_EQ(beside.size(), 1U);
    EXPECT_EQ(beside[0].before.size(), 2U);
    EXPECT_EQ(recut(mesh, beside).polygon_count(), 6U);
    // Sides of curves are not split, and beyond the boundary there is nothing.
    mesh = b.mesh;
    EXPECT_TRUE(cut_around_points(mesh, {{0, {1.0, 0.05, 1.0}, 0.1}}, input).empty());
    mesh.feature_edges.push_back({2, 3, 0});
    EXPECT_TRUE(cut_around_points(mesh, {{0, at_side, 0.1}}, input).empty());
    EXPECT_EQ(mesh.points.size(), 6U);
}

TEST(JoinTriangles, SidesFarFromTheInputAreCutAnew) {
    // A valley along x = 1 below two quads whose common side bridges it from y = 0 to y = 1 ... at x = 1 +- 0.9.
    TriangleMesh valley;
    const auto id = [](std::uint32_t v) { return VertexId{v}; };
    for (const double y : {-1.0, 2.0})
        for (const double x : {-1.0, 1.0, 3.0}) valley.positions.push_back({x, y, std::abs(x - 1.0)});
    valley.triangles = {{id(0), id(1), id(4)}, {id(0), id(4), id(3)}, {id(1), id(2), id(5)}, {id(1), id(5), id(4)}};
    const core::TriangleTree input(valley.positions, valley.triangles);
    CoarseMesh mesh;
    for (const Point3& p : {Point3{0, 0, 1}, {1, 0, 0}, {2, 0, 1}, {2, 1, 1}, {1, 1, 0}, {0, 1, 1}})
        mesh.add_vertex(p, {});
    mesh.add_polygon(std::array<Index, 4>{0, 1, 2, 5}, 0);  // the side from 2 to 5 is 1 above the valley
    mesh.add_polygon(std::array<Index, 4>{2, 3, 4, 5}, 1);
    const std::vector<Recut> recuts = find_far_recuts(mesh, input, 0.1);
    ASSERT_EQ(recuts.size(), 1U);
    const CoarseMesh cut = recut(mesh, recuts);
    EXPECT_EQ(cut.polygon_count(), 4U);
    EXPECT_NEAR(area(cut), 2.0, 1e-12);
    bool has_bottom = false;
    for (std::size_t q = 0; q < cut.polygon_count(); ++q) {
        const auto ring = cut.polygon(q);
        for (std::size_t i = 0; i < ring.size(); ++i)
            has_bottom = has_bottom || (ring[i] == 1 && ring[(i + 1) % ring.size()] == 4);
    }
    EXPECT_TRUE(has_bottom);
    EXPECT_TRUE(find_far_recuts(mesh, input, 2.0).empty());
    mesh.feature_edges.push_back({2, 5, 0});
    EXPECT_TRUE(find_far_recuts(mesh, input, 0.1).empty());
}

TEST(JoinTriangles, NothingGoesOverACreaseOrABend) {
    CoarseMesh cut = make_quad_dominant(shifted_rows(1)), bent = cut;
    for (Index v = 0; v < cut.points.size(); ++v)
        for (Index w = 0; w < v; ++w)
            if (cut.points[v].y == 1.0 && cut.points[w].y == 1.0) cut.feature_edges.push_back({v, w, 0});
    EXPECT_EQ(triangles_of(join(cut)), 2U);
    for (Point3& p : bent.points)
        if (p.y > 1.0) p = {p.x, 1.0, 1.0};
    EXPECT_EQ(triangles_of(join(bent)), 2U);
}

}  // namespace
}  // namespace certa::remeshing
