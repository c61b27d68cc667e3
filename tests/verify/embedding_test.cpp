// Meshes in pieces, none of them filling a hull: local tests, caps and winding numbers have to find what is wrong.
#include "verify/broken.h"

namespace certa::test {
namespace {

using Corners4 = std::array<Point3, 4>;

/// Tetrahedra without common corners, their faces as facets.
Case make_apart(const std::vector<Corners4>& pieces) {
    std::vector<Point3> positions;
    std::vector<Tetrahedron> tetrahedra;
    std::vector<std::vector<std::uint32_t>> facets;
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> labels;
    std::vector<RegionId> regions;
    for (const Corners4& piece : pieces) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), piece.begin(), piece.end());
        const auto v = [&](std::uint32_t i) { return VertexId{first + i}; };
        tetrahedra.push_back({v(0), v(1), v(2), v(3)});
        regions.push_back(RegionId{static_cast<std::uint32_t>(tetrahedra.size())});
        for (const auto& f : {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}) {
            labels.push_back(static_cast<std::uint32_t>(facets.size()));
            facets.push_back({first + f[0], first + f[1], first + f[2]});
            triangles.push_back({v(f[0]), v(f[1]), v(f[2])});
        }
    }
    Case c = make_case(positions, tetrahedra, facets, triangles, labels);
    c.mesh.tetrahedron_regions = regions;
    return c;
}

Corners4 corner_at(const Point3& p, double size) {
    return {p, {p.x + size, p.y, p.z}, {p.x, p.y + size, p.z}, {p.x, p.y, p.z + size}};
}

TEST(CheckPieces, ThatLieApart) {
    expect_fine(make_apart({corner_at({0, 0, 0}, 1), corner_at({5, 5, 5}, 1), corner_at({-3, 7, 1}, 2)}));
}

TEST(CheckPieces, SeeACornerBeyondAFace) {
    // Beyond the slanted face at (1/3, 1/3, 1/3), inside the ball around (1/2, 1/2, 1/2).
    const Case c = make_apart({corner_at({0, 0, 0}, 1), corner_at({0.5, 0.5, 0.5}, 1)});
    expect_broken(c, "delaunay");
    EXPECT_TRUE(tells(c, "vertex 5")) << text(check_conforming(c.mesh, c.complex));
    // Behind the right angle, and outside the ball of either.
    expect_fine(make_apart({corner_at({0, 0, 0}, 1), corner_at({-0.4, -0.4, -0.4}, 0.1)}));
    // Beyond the plane of the slanted face, outside the ball.
    expect_fine(make_apart({corner_at({0, 0, 0}, 1), corner_at({1.01, 1.01, 1.01}, 0.5)}));
}

TEST(CheckPieces, SeeOneInsideAnother) {
    for (const double at : {0.1, 0.2}) {
        const Case c = make_apart({corner_at({0, 0, 0}, 1), corner_at({at, at, at}, 0.01)});
        EXPECT_FALSE(check_conforming(c.mesh, c.complex).ok()) << at;
    }
    const Case chain = make_apart({corner_at({0, 0, 0}, 8), corner_at({1, 1, 1}, 2), corner_at({1.2, 1.2, 1.2}, 0.1)});
    EXPECT_FALSE(check_conforming(chain.mesh, chain.complex).ok());
}

TEST(CheckPieces, SeeThemCross) {
    EXPECT_FALSE(check_conforming(make_apart({corner_at({0, 0, 0}, 1), corner_at({0.2, 0.2, -0.5}, 1)}).mesh,
                                  make_apart({corner_at({0, 0, 0}, 1), corner_at({0.2, 0.2, -0.5}, 1)}).complex)
                     .ok());
}

}  // namespace
}  // namespace certa::test
