// Generators of crowds of facets and of layered geology (see generators.h).
//
// Validity is by construction: tetrahedra come out of one lattice jittered by less than it takes to turn a tetrahedron
// over; surfaces are graphs over one plane triangulation made with exact integer tests; disjoint facets stay in
// disjoint cells; horizons are ordered graphs over one triangulation and share exactly what touches.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

#include "core/random.h"
#include "mesh/generator_parts.h"
#include "mesh/generators.h"

namespace certa::generators {

using core::Random;

namespace {

std::vector<std::uint32_t> shuffled(std::uint32_t count, Random& random) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    return order;
}

/// Adds each triangle once, whatever its rotation or orientation.
class UniqueTriangles {
public:
    explicit UniqueTriangles(PiecewiseLinearComplex& complex) : complex_(complex) {}
    void add(VertexId a, VertexId b, VertexId c) {
        std::array<VertexId, 3> key{a, b, c};
        std::sort(key.begin(), key.end());
        if (seen_.insert(key).second) add_facet(complex_, {{a, b, c}});
    }

private:
    PiecewiseLinearComplex& complex_;
    std::set<std::array<VertexId, 3>> seen_;
};

/// Triangulates points sorted by (x, y) by joining each to the part of the hull that it sees. Exact: integers below
/// 2^30.
std::vector<std::array<std::uint32_t, 3>> sweep_triangulation(const std::vector<std::array<std::int64_t, 2>>& points) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    const auto turn = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        return (points[b][0] - points[a][0]) * (points[c][1] - points[a][1]) -
               (points[b][1] - points[a][1]) * (points[c][0] - points[a][0]);
    };
    std::vector<std::uint32_t> lower, upper;  // hull chains from the leftmost to the newest point
    for (std::uint32_t p = 0; p < points.size(); ++p) {
        // On the lower chain the new point is seen where it lies to the right, on the upper one where it lies to the
        // left.
        while (lower.size() >= 2 && turn(lower[lower.size() - 2], lower.back(), p) < 0) {
            triangles.push_back({lower[lower.size() - 2], p, lower.back()});
            lower.pop_back();
        }
        while (upper.size() >= 2 && turn(upper[upper.size() - 2], upper.back(), p) > 0) {
            triangles.push_back({upper[upper.size() - 2], upper.back(), p});
            upper.pop_back();
        }
        lower.push_back(p);
        upper.push_back(p);
    }
    return triangles;
}

}  // namespace

PiecewiseLinearComplex make_glued_tetrahedra(std::uint32_t count, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    // Twice as many tetrahedra as wanted: six to a cell.
    const auto n = std::max(1u, static_cast<std::uint32_t>(std::ceil(std::cbrt(count / 3.0))));
    std::map<std::uint32_t, VertexId> ids;
    const auto id = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        const auto [entry, fresh] = ids.try_emplace((z * (n + 1) + y) * (n + 1) + x, VertexId{});
        if (fresh) {
            // The heights of the lattice's tetrahedra are 0.707 and more; two points move by at most 0.35 together.
            entry->second = add_point(
                complex, {x + random.uniform(-0.1, 0.1), y + random.uniform(-0.1, 0.1), z + random.uniform(-0.1, 0.1)});
        }
        return entry->second;
    };
    UniqueTriangles faces(complex);
    const std::vector<std::uint32_t> order = shuffled(6 * n * n * n, random);
    constexpr std::array<std::array<int, 3>, 6> paths{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (std::uint32_t k = 0; k < std::min<std::size_t>(count, order.size()); ++k) {
        const std::uint32_t cell = order[k] / 6;
        std::array<std::uint32_t, 3> at{cell % n, cell / n % n, cell / n / n};
        std::array<VertexId, 4> v{id(at[0], at[1], at[2])};
        for (int i = 0; i < 3; ++i) {
            ++at[paths[order[k] % 6][i]];
            v[i + 1] = id(at[0], at[1], at[2]);
        }
        faces.add(v[0], v[1], v[2]);
        faces.add(v[0], v[1], v[3]);
        faces.add(v[0], v[2], v[3]);
        faces.add(v[1], v[2], v[3]);
    }
    return complex;
}

PiecewiseLinearComplex make_flat_cloud(std::uint32_t n, double height, std::uint64_t seed) {
    Random random(seed);
    std::set<std::array<std::int64_t, 2>> chosen;
    while (chosen.size() < n) {
        chosen.insert(
            {static_cast<std::int64_t>(random.below(1u << 26)), static_cast<std::int64_t>(random.below(1u << 26))});
    }
    const std::vector<std::array<std::int64_t, 2>> points(chosen.begin(), chosen.end());
    PiecewiseLinearComplex complex;
    for (const auto& [x, y] : points) {
        add_point(complex,
                  {static_cast<double>(x) * 0x1p-26, static_cast<double>(y) * 0x1p-26, height * random.uniform()});
    }
    for (const auto& [a, b, c] : sweep_triangulation(points))
        add_facet(complex, {{VertexId{a}, VertexId{b}, VertexId{c}}});
    return complex;
}

PiecewiseLinearComplex make_soup(std::uint32_t count, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    const auto n = static_cast<std::uint32_t>(std::ceil(std::cbrt(count)));
    for (std::uint32_t i = 0; i < count; ++i) {
        const Point3 center{i % n + 0.5, i / n % n + 0.5, i / n / n + 0.5};
        const Point3 u = random_direction(random), w = random_direction(random);
        const double along = u.x * w.x + u.y * w.y + u.z * w.z;
        Point3 v{w.x - along * u.x, w.y - along * u.y, w.z - along * u.z};
        const double scale = 1.0 / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        v = {scale * v.x, scale * v.y, scale * v.z};
        const std::uint32_t sides = 3 + static_cast<std::uint32_t>(random.below(2));
        const double squeeze = random.coin(0.3) ? 0.02 : random.uniform(0.2, 1.0);  // some are needles
        std::vector<VertexId> ring;
        for (std::uint32_t k = 0; k < sides; ++k) {
            const double angle = 2 * std::numbers::pi * (k + random.uniform(0.2, 0.8)) / sides,
                         r = random.uniform(0.3, 0.499);
            const double a = r * std::cos(angle), b = squeeze * r * std::sin(angle);
            ring.push_back(add_point(
                complex, {center.x + a * u.x + b * v.x, center.y + a * u.y + b * v.y, center.z + a * u.z + b * v.z}));
        }
        add_facet(complex, {ring});
    }
    return complex;
}

PiecewiseLinearComplex make_mixture(std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    const auto vertex = [&](double x, double y, double z) { return add_point(complex, {x, y, z}); };
    const VertexId a = vertex(0, 0, 0), b = vertex(1, 0, 0), c = vertex(1, 1, 0), d = vertex(0, 1, 0);
    const VertexId e = vertex(0, 0, 1), f = vertex(1, 0, 1), g = vertex(1, 1, 1), h = vertex(0, 1, 1);
    // The floor has a hole, isolated segments (one under the inner wall, one from a corner) and an isolated point.
    const double x = random.uniform(0.1, 0.25), y = random.uniform(0.1, 0.25), w = random.uniform(0.1, 0.2);
    const VertexId p = vertex(x, y, 0), q = vertex(x + w, y, 0), r = vertex(x + w, y + w, 0), s = vertex(x, y + w, 0);
    const VertexId i = vertex(0.8, random.uniform(0.35, 0.45), 0), j = vertex(0.85, random.uniform(0.6, 0.8), 0);
    const VertexId k = vertex(random.uniform(0.1, 0.15), 0.75, 0), l = vertex(0.95, 0.25, 0);
    add_facet(complex, {{a, d, c, b}, {p, q, r, s}, {i, j}, {k}, {b, l}, {b, d}}, {{x + w / 2, y + w / 2, 0}});
    add_facet(complex, {{e, f, g, h}, {f, h}});
    add_facet(complex, {{a, b, f, e}});
    add_facet(complex, {{b, c, g, f}});
    add_facet(complex, {{c, d, h, g}});
    add_facet(complex, {{d, a, e, h}});
    add_facet(complex, {{b, d, h, f}, {vertex(0.5, 0.5, random.uniform(0.3, 0.7))}});  // inner wall
    const VertexId tip = vertex(random.uniform(0.6, 0.7), random.uniform(0.55, 0.65), random.uniform(0.3, 0.6));
    add_facet(complex, {{i, j, tip}});                                            // on the isolated segment
    complex.segments.push_back({k, vertex(random.uniform(0.1, 0.3), 0.6, 0.5)});  // from the isolated point
    vertex(0.2, 0.4, 0.8);                                                        // isolated in space
    const VertexId m = vertex(1.5, random.uniform(-0.5, -0.2), 0.3), n = vertex(1.4, -0.6, 0.8);
    for (const auto& t : {std::array{b, f, m}, {b, f, n}, {b, m, n}, {f, m, n}})
        add_facet(complex, {{t[0], t[1], t[2]}});
    return complex;
}

namespace {

/// A smooth random function on the unit square with values around 0, mostly in [-1, 1].
class Relief {
public:
    explicit Relief(Random& random) {
        for (Wave& wave : waves_) {
            wave = {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(0, 2 * std::numbers::pi)};
        }
    }
    double operator()(double x, double y) const {
        double sum = 0.0;
        for (const Wave& wave : waves_) sum += std::sin(wave.x * x + wave.y * y + wave.phase);
        return sum / 2.0;
    }

private:
    struct Wave {
        double x = 0, y = 0, phase = 0;
    };
    std::array<Wave, 4> waves_;
};

/// A multiple of 2^-40, so that rounding in the platform's sine leaves no trace.
double snapped(double x) { return std::round(x * 0x1p40) * 0x1p-40; }

struct Geology {
    std::uint32_t grid, layers;
    PiecewiseLinearComplex complex;
    std::vector<VertexId> vertices;    // [(row * (grid + 1) + column) * (layers + 1) + horizon]
    std::vector<std::uint8_t> rising;  // per cell: which diagonal

    VertexId at(std::uint32_t column, std::uint32_t row, std::uint32_t horizon) const {
        return vertices[(std::size_t{row} * (grid + 1) + column) * (layers + 1) + horizon];
    }
};

void place_columns(Geology& g, Random& random) {
    std::vector<Relief> reliefs;
    for (std::uint32_t k = 0; k < g.layers; ++k) reliefs.emplace_back(random);
    const double least = 0.05 / g.grid;  // thinner layers pinch out
    for (std::uint32_t row = 0; row <= g.grid; ++row) {
        for (std::uint32_t column = 0; column <= g.grid; ++column) {
            const auto jitter = [&](std::uint32_t i) {                           // the box stays a box
                return i == 0 || i == g.grid ? 0.0 : random.uniform(-0.2, 0.2);  // cells stay convex below 0.25
            };
            const double x = (column + jitter(column)) / g.grid, y = (row + jitter(row)) / g.grid;
            double z = 0.0;
            g.vertices.push_back(add_point(g.complex, {x, y, z}));
            for (std::uint32_t k = 0; k < g.layers; ++k) {
                // The last layer fills the box up; the others cover about two thirds of the area.
                double thickness = 0.6 / g.layers * (0.4 + reliefs[k](x, y));
                if (k + 1 == g.layers) thickness = std::max(1.0 - z, 0.1);
                thickness = snapped(thickness);
                if (thickness < least) {
                    g.vertices.push_back(g.vertices.back());
                    continue;
                }
                z = k + 1 == g.layers ? std::max(1.0, z + thickness) : z + thickness;
                g.vertices.push_back(add_point(g.complex, {x, y, z}));
            }
        }
    }
}

void add_horizons(Geology& g) {
    for (std::uint32_t row = 0; row < g.grid; ++row) {
        for (std::uint32_t column = 0; column < g.grid; ++column) {
            const bool rising = g.rising[row * g.grid + column];
            for (int half = 0; half < 2; ++half) {
                std::array<VertexId, 3> below{};
                for (std::uint32_t k = 0; k <= g.layers; ++k) {
                    const VertexId a = g.at(column, row, k), b = g.at(column + 1, row, k);
                    const VertexId c = g.at(column + 1, row + 1, k), d = g.at(column, row + 1, k);
                    const std::array<VertexId, 3> t = rising ? (half == 0 ? std::array{a, b, c} : std::array{a, c, d})
                                                             : (half == 0 ? std::array{a, b, d} : std::array{b, c, d});
                    if (k == 0 || t != below) add_facet(g.complex, {{t[0], t[1], t[2]}});
                    below = t;
                }
            }
        }
    }
}

void add_walls(Geology& g) {
    const auto add_wall = [&](std::uint32_t c0, std::uint32_t r0, std::uint32_t c1, std::uint32_t r1) {
        for (std::uint32_t k = 0; k < g.layers; ++k) {
            const VertexId a = g.at(c0, r0, k), b = g.at(c1, r1, k), c = g.at(c1, r1, k + 1), d = g.at(c0, r0, k + 1);
            if (a == d && b == c) continue;
            if (a == d) {
                add_facet(g.complex, {{a, b, c}});
            } else if (b == c) {
                add_facet(g.complex, {{a, b, d}});
            } else {
                add_facet(g.complex, {{a, b, c, d}});
            }
        }
    };
    for (std::uint32_t i = 0; i < g.grid; ++i) {
        add_wall(i, 0, i + 1, 0);
        add_wall(g.grid, i, g.grid, i + 1);
        add_wall(i + 1, g.grid, i, g.grid);
        add_wall(0, i + 1, 0, i);
    }
}

}  // namespace

PiecewiseLinearComplex make_geology(std::uint32_t grid, std::uint32_t layers, std::uint64_t seed) {
    Random random(seed);
    Geology g{grid, layers, {}, {}, {}};
    place_columns(g, random);
    for (std::uint32_t i = 0; i < grid * grid; ++i) g.rising.push_back(random.coin());
    add_horizons(g);
    add_walls(g);
    return std::move(g.complex);
}

}  // namespace certa::generators
