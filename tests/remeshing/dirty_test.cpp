// Dirty and awkward input: a sound result or a refusal, never a result that fails its check.
//
// Every surface here goes the way of the command: remesh, then the checker on the input as `weld_surface` sees it.
#include <certa/io.h>
#include <certa/remeshing.h>
#include <certa/surface_check.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/random.h"
#include "core/vector3.h"
#include "mesh/generators_surfaces.h"

namespace certa::remeshing {
namespace {

constexpr double pi = std::numbers::pi;

/// An m by n grid of squares, two triangles each; `place` of (i, j) in [0, m] x [0, n].
template <class Place>
TriangleMesh grid(std::uint32_t m, std::uint32_t n, const Place& place) {
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= m; ++i) mesh.positions.push_back(place(i, j));
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return VertexId{j * (m + 1) + i}; };
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < m; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}
TriangleMesh moved(TriangleMesh mesh, double scale, const Point3& by) {
    for (Point3& p : mesh.positions) p = scale * p + by;
    return mesh;
}
TriangleMesh together(const std::vector<TriangleMesh>& parts) {
    TriangleMesh all;
    for (const TriangleMesh& part : parts) {
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
        for (const Triangle& t : part.triangles)
            all.triangles.push_back(
                {VertexId{first + index_of(t[0])}, VertexId{first + index_of(t[1])}, VertexId{first + index_of(t[2])}});
    }
    return all;
}
/// Points nearer than 1e-9 to each other become one.
TriangleMesh glued(TriangleMesh mesh) {
    std::vector<Point3> points;
    std::vector<VertexId> numbers;
    for (const Point3& p : mesh.positions) {
        std::uint32_t v = 0;
        while (v < points.size() && distance(points[v], p) > 1e-9) ++v;
        if (v == points.size()) points.push_back(p);
        numbers.push_back(VertexId{v});
    }
    mesh.positions = std::move(points);
    for (Triangle& t : mesh.triangles)
        for (VertexId& v : t) v = numbers[index_of(v)];
    std::erase_if(mesh.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    return mesh;
}
TriangleMesh soup(const TriangleMesh& mesh) {
    TriangleMesh out;
    for (const Triangle& t : mesh.triangles) {
        const auto v = static_cast<std::uint32_t>(out.positions.size());
        for (const VertexId corner : t) out.positions.push_back(mesh.positions[index_of(corner)]);
        out.triangles.push_back({VertexId{v}, VertexId{v + 1}, VertexId{v + 2}});
    }
    return out;
}
TriangleMesh box(double x, double y, double z) { return generators::make_box(x, y, z); }

/// Half a sphere, or the whole of it, by rings; or a disc.
TriangleMesh cap(double radius, double from, double to, std::uint32_t rings, std::uint32_t around) {
    return glued(grid(around, rings, [=](std::uint32_t i, std::uint32_t j) {
        const double t = 2.0 * pi * (i % around) / around, s = from + (to - from) * j / rings;
        return Point3{radius * std::sin(s) * std::cos(t), radius * std::sin(s) * std::sin(t), radius * std::cos(s)};
    }));
}
TriangleMesh disc(double radius, std::uint32_t rings, std::uint32_t around) {
    return glued(grid(around, rings, [=](std::uint32_t i, std::uint32_t j) {
        const double t = 2.0 * pi * (i % around) / around, r = radius * j / rings;
        return Point3{r * std::cos(t), r * std::sin(t), 0.0};
    }));
}
/// Sheets that meet in a curved edge.
TriangleMesh book(int pages, std::uint32_t fine) {
    std::vector<TriangleMesh> sheets;
    for (int k = 0; k < pages; ++k)
        sheets.push_back(grid(6 * fine, 8 * fine, [&](std::uint32_t i, std::uint32_t j) {
            const double turn = 2.0 * pi * k / pages, r = i / (6.0 * fine), z = j / (4.0 * fine) - 1.0,
                         bend = 0.3 * r * r + 0.3 * z * z;
            return Point3{r * std::cos(turn) - bend * std::sin(turn) * r,
                          r * std::sin(turn) + bend * std::cos(turn) * r, z + 0.2 * r * k} +
                   0.4 * z * z * Point3{1.0, 0.5, 0.0};
        }));
    return glued(together(sheets));
}
TriangleMesh strip(int half_twists, std::uint32_t n) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < n; ++i)
        for (const double s : {-0.3, -0.1, 0.1, 0.3}) {
            const double t = 2.0 * pi * i / n, u = 0.5 * half_twists * t;
            const double r = 1.0 + s * std::cos(u);
            mesh.positions.push_back({r * std::cos(t), r * std::sin(t), s * std::sin(u)});
        }
    const bool turns = half_twists % 2 != 0;
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return VertexId{i < n ? 4 * i + j : turns ? 3 - j : j}; };
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < 3; ++j) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}
/// In space a Klein bottle meets itself; this one is its figure-eight immersion.
TriangleMesh klein_bottle() {
    TriangleMesh mesh;
    constexpr std::uint32_t n = 40, m = 20;
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < m; ++j) {
            const double u = 2.0 * pi * i / n, v = 2.0 * pi * j / m;
            const double a = std::cos(0.5 * u), b = std::sin(0.5 * u),
                         r = 2.0 + a * std::sin(v) - b * std::sin(2.0 * v);
            mesh.positions.push_back({r * std::cos(u), r * std::sin(u), b * std::sin(v) + a * std::sin(2.0 * v)});
        }
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
        return i < n ? VertexId{m * i + j % m} : VertexId{(m - j % m) % m};
    };
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < m; ++j) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}
TriangleMesh tetrahedron() {
    TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}};
    for (const auto& t :
         {std::array{0U, 2U, 1U}, std::array{0U, 1U, 3U}, std::array{1U, 2U, 3U}, std::array{0U, 3U, 2U}})
        mesh.triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
    return mesh;
}
TriangleMesh scattered(const TriangleMesh& part, int count, double size, bool shares_space) {
    core::Random random(3);
    std::vector<TriangleMesh> parts;
    for (int k = 0; k < count; ++k) {
        const Point3 at{random.uniform(), random.uniform(), random.uniform()};
        const double side = shares_space ? 1.0 : 10.0;
        parts.push_back(moved(part, size, side * at + (shares_space ? 0.0 : 2.0 * k) * Point3{1.0, 0.0, 0.0}));
    }
    return together(parts);
}
TriangleMesh random_soup(int count, double size) {
    core::Random random(8);
    TriangleMesh mesh;
    for (int k = 0; k < count; ++k) {
        const auto v = static_cast<std::uint32_t>(mesh.positions.size());
        const Point3 at{random.uniform(), random.uniform(), random.uniform()};
        for (int i = 0; i < 3; ++i)
            mesh.positions.push_back(at + size * Point3{random.uniform(), random.uniform(), random.uniform()});
        mesh.triangles.push_back({VertexId{v}, VertexId{v + 1}, VertexId{v + 2}});
    }
    return mesh;
}
/// A cylinder whose squares are cut by a third vertex a hair's breadth from their sides.
TriangleMesh needles(double height, std::uint32_t fine) {
    TriangleMesh mesh = grid(12 * fine, 6 * fine, [=](std::uint32_t i, std::uint32_t j) {
        return Point3{std::cos(i * pi / (12.0 * fine)), std::sin(i * pi / (12.0 * fine)), j / (3.0 * fine)};
    });
    const std::vector<Triangle> before = mesh.triangles;
    mesh.triangles.clear();
    for (const Triangle& t : before) {
        const Point3 &a = mesh.positions[index_of(t[0])], &b = mesh.positions[index_of(t[1])],
                     &c = mesh.positions[index_of(t[2])];
        const VertexId m{static_cast<std::uint32_t>(mesh.positions.size())};
        mesh.positions.push_back((0.5 - 0.5 * height) * (a + b) + height * c);
        mesh.triangles.push_back({t[0], t[1], m});
        mesh.triangles.push_back({t[1], t[2], m});
        mesh.triangles.push_back({t[2], t[0], m});
    }
    return mesh;
}
/// Every other square of a board: the squares meet in vertices only.
TriangleMesh checkerboard(std::uint32_t n) {
    TriangleMesh mesh = grid(n, n, [&](std::uint32_t i, std::uint32_t j) {
        return Point3{1.0 * i, 1.0 * j, 0.1 * i * i / n + 0.05 * j * j / n};
    });
    std::vector<Triangle> kept;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if ((t / 2 % n + t / 2 / n) % 2 == 0) kept.push_back(mesh.triangles[t]);
    mesh.triangles = kept;
    return mesh;
}

struct Case {
    const char* name;
    TriangleMesh mesh;
    bool is_refused = false;
};

/// `fine`: 1 or 2, triangles per length.
std::vector<Case> make_cases(std::uint32_t fine) {
    const TriangleMesh sphere = generators::make_icosphere(1 + fine), ball = generators::make_icosphere(fine);
    const TriangleMesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{VertexId{0}, VertexId{1}, VertexId{2}}}};
    TriangleMesh flipped = tetrahedron();
    std::swap(flipped.triangles[2][0], flipped.triangles[2][1]);
    TriangleMesh line = one, point = one;
    line.positions[2] = {2, 0, 0};
    for (Point3& p : point.positions) p = {1, 2, 3};
    TriangleMesh twice = grid(8, 8, [](std::uint32_t i, std::uint32_t j) { return Point3{1.0 * i, 1.0 * j, 0.0}; });
    twice.triangles.insert(twice.triangles.end(), twice.triangles.begin(), twice.triangles.end());
    const TriangleMesh sheet = grid(12, 12, [](std::uint32_t i, std::uint32_t j) {
        return Point3{0.1 * i, 0.1 * j, 0.02 * i * j};
    });
    return {
        {"one triangle", one},
        {"two triangles", grid(1, 1,
                               [](std::uint32_t i, std::uint32_t j) {
                                   return Point3{1.0 * i, 1.0 * j, 0.3 * i * j};
                               })},
        {"two triangles at a vertex", glued(together({one, moved(one, -1.0, {})}))},
        {"a line", line},
        {"a point", point, true},
        {"Moebius band", strip(1, 30 * fine), true},
        {"band of two half twists", strip(2, 30 * fine)},
        {"band of three half twists", strip(3, 45 * fine), true},
        {"Klein bottle", klein_bottle(), true},
        {"triangles twice", twice},
        {"sheets twice", together({sheet, sheet})},
        {"sheets twice, glued", glued(together({sheet, moved(sheet, 1.0, {1e-12, 0, 0})}))},
        {"cubes at an edge", glued(together({box(1, 1, 1), moved(box(1, 1, 1), 1.0, {1, 1, 0})}))},
        {"cubes at a vertex", glued(together({box(1, 1, 1), moved(box(1, 1, 1), 1.0, {1, 1, 1})}))},
        {"cubes at a face", glued(together({box(1, 1, 1), moved(box(1, 1, 1), 1.0, {1, 0, 0})}))},
        {"cubes at a face, not glued", together({box(1, 1, 1), moved(box(1, 1, 1), 1.0, {1, 0, 0})})},
        {"cubes at an edge, soup", soup(together({box(1, 1, 1), moved(box(1, 1, 1), 1.0, {1, 1, 0})}))},
        {"box in a box", together({box(3, 3, 3), moved(box(1, 1, 1), 1.0, {1, 1, 1})})},
        {"sphere in a sphere", together({ball, moved(ball, 0.7, {})})},
        {"spheres that cross", together({ball, moved(ball, 1.0, {0.7, 0.1, 0.2})})},
        {"spheres at a vertex", glued(together({sphere, moved(sphere, 1.0, 2.0 * sphere.positions[0])}))},
        {"sphere and its equator's disc",
         glued(together({cap(1, 0.0, 0.5 * pi, 4 * fine, 20 * fine), cap(1, 0.5 * pi, pi, 4 * fine, 20 * fine),
                         disc(1, 4 * fine, 20 * fine)}))},
        {"book of three", book(3, fine)},
        {"book of five", book(5, fine)},
        {"book of three, soup", soup(book(3, fine))},
        {"checkerboard", checkerboard(6 * fine)},
        {"dozens of tetrahedra", scattered(tetrahedron(), fine == 1 ? 8 : 300, 0.05, false)},
        {"dozens of tetrahedra in each other", scattered(tetrahedron(), 40 * fine, 0.3, true)},
        {"random triangles", random_soup(30 * fine, 0.4)},
        {"tiny triangles", random_soup(30, 1e-9)},
        {"needles", needles(1e-6, fine)},
        {"needles of 1e-12", needles(1e-12, fine)},
        {"thin plate", box(1, 1e-3, 1e-6)},
        {"far away", moved(sphere, 1.0, {1e8, -1e8, 1e8})},
        {"too far away", moved(sphere, 1e-3, {1e9, 0, 0}), true},
        {"far away on a plane", moved(sheet, 1.0, {3e7, 0, -1e7})},
        {"large", moved(sphere, 1e40, {})},
        {"small", moved(sphere, 1e-40, {})},
        {"flipped tetrahedron", flipped},
        {"noise", generators::make_noisy(ball, 0.3, 4)},
        {"spike", glued(grid(24, 24,
                             [](std::uint32_t i, std::uint32_t j) {
                                 const double t = 2.0 * pi * (i % 24) / 24, r = 1e-3 * j;
                                 return Point3{r * std::cos(t), r * std::sin(t), -1.0 * j};
                             }))},
    };
}

const std::vector<Case>& cases(std::uint32_t fine) {
    static const std::array lists{make_cases(1), make_cases(2)};
    return lists[fine - 1];
}

void expect_sound_or_refused(const Case& c, const std::optional<std::uint64_t>& vertices) {
    SCOPED_TRACE(vertices ? "by vertices" : "by error");
    RemeshOptions options;
    options.vertices = vertices;
    if (!vertices) options.error = default_remesh_error;
    bool is_refused = false;
    try {
        const RemeshResult result = remesh(c.mesh, options);
        ASSERT_EQ(result.outcome, Outcome::done);
        SurfaceCheckOptions check_options;
        check_options.error = options.error;
        const SurfaceCheck check =
            check_surface(result.mesh, make_polygon_mesh(weld_surface(c.mesh).mesh), check_options);
        for (std::size_t i = 0; i < std::min<std::size_t>(2, check.violations.size()); ++i)
            ADD_FAILURE() << check.violations[i].promise << ": " << check.violations[i].message;
    } catch (const InputError& error) {
        is_refused = true;
        EXPECT_FALSE(error.defects().empty());
    }
    EXPECT_EQ(is_refused, c.is_refused);
}

std::string name_of_case(const testing::TestParamInfo<std::size_t>& info) {
    std::string name = cases(1)[info.param].name;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
}

class Dirty : public testing::TestWithParam<std::size_t> {};
TEST_P(Dirty, GivesASoundResultOrARefusal) { expect_sound_or_refused(cases(1)[GetParam()], 60); }
INSTANTIATE_TEST_SUITE_P(Coarse, Dirty, testing::Range<std::size_t>(0, cases(1).size()), name_of_case);

/// Polygons of many corners are filled by others in other ways: sound is what is so in all of them.
TEST(Polygons, AreSoundHoweverTheyAreFilled) {
    for (const std::uint64_t seed : {1U, 2U}) {
        const TriangleMesh input =
            generators::make_noisy(generators::make_ellipsoid(2.0, 1.2, 0.8, 1000, seed), 0.02, seed);
        RemeshOptions options;
        options.vertices = 250;
        options.output = RemeshOutput::polygons;
        const RemeshResult result = remesh(input, options);
        ASSERT_EQ(result.outcome, Outcome::done);
        const SurfaceCheck check = check_surface(result.mesh, make_polygon_mesh(input), {});
        for (const auto& violation : check.violations) ADD_FAILURE() << violation.promise << ": " << violation.message;
    }
}

/// The same, four times as fine.
class DirtyLong : public testing::TestWithParam<std::size_t> {};
TEST_P(DirtyLong, GivesASoundResultOrARefusal) {
    for (const std::optional<std::uint64_t>& vertices :
         {std::optional<std::uint64_t>{}, std::optional<std::uint64_t>{60}, std::optional<std::uint64_t>{500}})
        expect_sound_or_refused(cases(2)[GetParam()], vertices);
}
INSTANTIATE_TEST_SUITE_P(Fine, DirtyLong, testing::Range<std::size_t>(0, cases(2).size()), name_of_case);

}  // namespace
}  // namespace certa::remeshing
