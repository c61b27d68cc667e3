// Generators of sharp contacts, boxes and plates (see generators.h). Coordinates come from the platform-independent
// generator of core; those that go through trigonometric functions may differ by an ulp between platforms.
//
// Validity is by construction: pages lie in half-planes around one axis, slivers in disjoint cones, holes and isolated
// pieces of a plate in disjoint cells.
#include "mesh/generators.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/random.h"
#include "mesh/generator_parts.h"

namespace certa::generators {

using core::Random;

PiecewiseLinearComplex make_moved(PiecewiseLinearComplex complex, std::uint64_t rotation_seed,
                                  const Point3& translation) {
    Random random(rotation_seed);
    // A uniformly random unit quaternion by rejection.
    double w = 0, x = 0, y = 0, z = 0, square = 0;
    do {
        w = random.uniform(-1, 1), x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
        square = w * w + x * x + y * y + z * z;
    } while (square > 1.0 || square < 1e-3);
    const double s = 2.0 / square;
    const auto move = [&](Point3& p) {
        p = {(1 - s * (y * y + z * z)) * p.x + s * (x * y - w * z) * p.y + s * (x * z + w * y) * p.z + translation.x,
             s * (x * y + w * z) * p.x + (1 - s * (x * x + z * z)) * p.y + s * (y * z - w * x) * p.z + translation.y,
             s * (x * z - w * y) * p.x + s * (y * z + w * x) * p.y + (1 - s * (x * x + y * y)) * p.z + translation.z};
    };
    for (Point3& p : complex.positions) move(p);
    for (Point3& p : complex.facet_holes) move(p);
    for (Point3& p : complex.region_holes) move(p);
    for (RegionSeed& seed : complex.region_seeds) move(seed.place);
    return complex;
}

PiecewiseLinearComplex make_fan(std::uint32_t pages, double width, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    const VertexId bottom = add_point(complex, {0, 0, 0}), top = add_point(complex, {0, 0, 1});
    for (std::uint32_t i = 0; i < pages; ++i) {
        // One page per equal part of the width, away from the ends of the part.
        const double angle = width * (i + random.uniform(0.1, 0.9)) / pages;
        const double r = random.uniform(0.4, 1.6), q = random.uniform(0.4, 1.6);
        const double low = random.uniform(-0.4, 0.4), high = random.uniform(0.6, 1.4);
        const VertexId a = add_point(complex, {r * std::cos(angle), r * std::sin(angle), low});
        const VertexId b = add_point(complex, {q * std::cos(angle), q * std::sin(angle), high});
        add_facet(complex, {{bottom, a, b, top}});
    }
    return complex;
}

PiecewiseLinearComplex make_book(std::uint32_t pages, double width) {
    PiecewiseLinearComplex complex;
    const VertexId bottom = add_point(complex, {0, 0, 0}), top = add_point(complex, {0, 0, 1});
    for (std::uint32_t i = 0; i < pages; ++i) {
        const double angle = pages > 1 ? width * i / (pages - 1) : 0.0;
        const VertexId a = add_point(complex, {std::cos(angle), std::sin(angle), 0});
        const VertexId b = add_point(complex, {std::cos(angle), std::sin(angle), 1});
        add_facet(complex, {{bottom, a, b, top}});
    }
    return complex;
}

PiecewiseLinearComplex make_cone(std::uint32_t slivers, double width, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    const VertexId apex = add_point(complex, {0, 0, 0});
    const auto cells = static_cast<std::uint32_t>(std::ceil(std::sqrt(slivers)));
    const double side = std::numbers::sqrt2 * std::tan(width / 2);  // square inside the cone's disc at height 1
    for (std::uint32_t i = 0; i < slivers; ++i) {
        const double cx = (i % cells + 0.5) / cells - 0.5, cy = (i / cells + 0.5) / cells - 0.5;
        const double turn = random.uniform(0, std::numbers::pi), reach = random.uniform(0.15, 0.48) / cells;
        const double dx = reach * std::cos(turn), dy = reach * std::sin(turn);
        const auto add = [&](double x, double y) {
            const double scale = random.uniform(0.6, 1.4) / std::sqrt(1 + side * side * (x * x + y * y));
            return add_point(complex, {scale * side * x, scale * side * y, scale});
        };
        const VertexId a = add(cx - dx, cy - dy), b = add(cx + dx, cy + dy);
        add_facet(complex, {{apex, a, b}});
    }
    return complex;
}

PiecewiseLinearComplex make_star(std::uint32_t segments, double longest, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    const VertexId center = add_point(complex, {0, 0, 0});
    for (std::uint32_t i = 0; i < segments; ++i) {
        const Point3 d = random_direction(random);
        const double length = longest > 1.0 ? random.uniform(1.0, longest) : 1.0;
        complex.segments.push_back({center, add_point(complex, {length * d.x, length * d.y, length * d.z})});
    }
    return complex;
}

PiecewiseLinearComplex make_umbrella(std::uint32_t gores, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    const VertexId apex = add_point(complex, {0, 0, 1});
    std::vector<VertexId> rim;
    for (std::uint32_t i = 0; i < gores; ++i) {
        const double angle = 2 * std::numbers::pi * (i + random.uniform(0.1, 0.9)) / gores;
        const double r = random.uniform(0.7, 1.3);
        rim.push_back(add_point(complex, {r * std::cos(angle), r * std::sin(angle), random.uniform(0.3, 0.6)}));
    }
    for (std::uint32_t i = 0; i < gores; ++i) add_facet(complex, {{apex, rim[i], rim[(i + 1) % gores]}});
    const VertexId joint = add_point(complex, {0, 0, -0.5}), foot = add_point(complex, {0, 0, -1});
    complex.segments.push_back({apex, joint});
    for (std::uint32_t i = 0; i < 3; ++i) {
        const double angle = 2 * std::numbers::pi * (i + random.uniform(0.1, 0.9)) / 3;
        const double r = random.uniform(0.05, 0.3);
        const VertexId tip = add_point(complex, {r * std::cos(angle), r * std::sin(angle), random.uniform(-0.9, -0.6)});
        add_facet(complex, {{joint, foot, tip}});
    }
    return complex;
}

PiecewiseLinearComplex make_wedge(double angle, bool closed) {
    PiecewiseLinearComplex complex;
    const double c = std::cos(angle), s = std::sin(angle);
    const VertexId a = add_point(complex, {0, 0, 0}), b = add_point(complex, {0, 0, 1});
    if (!closed) {
        add_facet(complex, {{a, b, add_point(complex, {1, 0, 0.4})}});
        add_facet(complex, {{b, a, add_point(complex, {c, s, 0.6})}});
        return complex;
    }
    const VertexId p = add_point(complex, {1, 0, 0}), q = add_point(complex, {1, 0, 1});
    const VertexId r = add_point(complex, {c, s, 0}), t = add_point(complex, {c, s, 1});
    add_facet(complex, {{a, p, q, b}});
    add_facet(complex, {{a, b, t, r}});
    add_facet(complex, {{p, r, t, q}});
    add_facet(complex, {{a, r, p}});
    add_facet(complex, {{b, q, t}});
    return complex;
}

PiecewiseLinearComplex make_cube(std::uint32_t n, bool triangles) {
    PiecewiseLinearComplex complex;
    std::map<std::array<std::uint32_t, 3>, VertexId> ids;
    const auto id = [&](std::array<std::uint32_t, 3> at) {
        const auto [entry, fresh] = ids.try_emplace(at, VertexId{});
        if (fresh) {
            const auto scale = static_cast<double>(n);
            entry->second = add_point(complex, {at[0] / scale, at[1] / scale, at[2] / scale});
        }
        return entry->second;
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (const std::uint32_t level : {0u, n}) {
            for (std::uint32_t i = 0; i < n; ++i) {
                for (std::uint32_t j = 0; j < n; ++j) {
                    const auto corner = [&](std::uint32_t di, std::uint32_t dj) {
                        std::array<std::uint32_t, 3> at{};
                        at[axis] = level;
                        at[(axis + 1) % 3] = i + di;
                        at[(axis + 2) % 3] = j + dj;
                        return id(at);
                    };
                    std::vector<VertexId> ring{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                    if (level == 0) std::reverse(ring.begin(), ring.end());  // outward
                    if (triangles) {
                        add_facet(complex, {{ring[0], ring[1], ring[2]}});
                        add_facet(complex, {{ring[0], ring[2], ring[3]}});
                    } else {
                        add_facet(complex, {ring});
                    }
                }
            }
        }
    }
    return complex;
}

PiecewiseLinearComplex make_nested_cubes(std::uint32_t count) {
    PiecewiseLinearComplex complex;
    const VertexId origin = add_point(complex, {0, 0, 0});
    // Each box is the image of the one before by a matrix of dyadic numbers that maps the cube's octant into its
    // inside.
    std::array<Point3, 3> axes{Point3{1, 0, 0}, Point3{0, 1, 0}, Point3{0, 0, 1}};
    for (std::uint32_t level = 0; level < count; ++level) {
        std::array<VertexId, 8> v;
        for (std::uint32_t k = 0; k < 8; ++k) {
            Point3 p;
            for (std::uint32_t i = 0; i < 3; ++i) {
                if (k >> i & 1) p = {p.x + axes[i].x, p.y + axes[i].y, p.z + axes[i].z};
            }
            v[k] = k == 0 ? origin : add_point(complex, p);
        }
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t a = 1u << (i + 1) % 3, b = 1u << (i + 2) % 3, up = 1u << i;
            add_facet(complex, {{v[0], v[b], v[a | b], v[a]}});
            add_facet(complex, {{v[up], v[up | a], v[up | a | b], v[up | b]}});
        }
        const auto mix = [](const Point3& p, const Point3& q, const Point3& r) {
            return Point3{0.5 * p.x + 0.125 * (q.x + r.x), 0.5 * p.y + 0.125 * (q.y + r.y),
                          0.5 * p.z + 0.125 * (q.z + r.z)};
        };
        axes = {mix(axes[0], axes[1], axes[2]), mix(axes[1], axes[2], axes[0]), mix(axes[2], axes[0], axes[1])};
    }
    return complex;
}

PiecewiseLinearComplex make_plate(std::uint32_t holes, std::uint32_t segments, std::uint32_t points,
                                  std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    std::vector<VertexId> outline;
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        outline.push_back(add_point(complex, {double(x), double(y), 0}));
    }
    std::vector<std::vector<VertexId>> polygons{outline};
    std::vector<Point3> hole_points;
    const std::uint32_t count = holes + segments + points;
    const auto cells = static_cast<std::uint32_t>(std::ceil(std::sqrt(count + 1)));
    std::vector<std::uint32_t> order(cells * cells);
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    for (std::uint32_t i = 0; i < count; ++i) {
        const double x = (order[i] % cells + 0.5) / cells, y = (order[i] / cells + 0.5) / cells;
        const double turn = random.uniform(0, 2 * std::numbers::pi);
        const auto sides = i < holes ? 3 + static_cast<std::uint32_t>(random.below(4)) : i < holes + segments ? 2u : 1u;
        std::vector<VertexId> polygon;
        for (std::uint32_t k = 0; k < sides; ++k) {
            const double angle = turn + 2 * std::numbers::pi * k / sides, r = random.uniform(0.2, 0.45) / cells;
            polygon.push_back(add_point(complex, {x + r * std::cos(angle), y + r * std::sin(angle), 0}));
        }
        polygons.push_back(polygon);
        if (sides >= 3) hole_points.push_back({x, y, 0});
    }
    add_facet(complex, polygons, hole_points);
    return complex;
}

PiecewiseLinearComplex make_near_facets(double distance, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    for (const double z : {0.0, distance}) {
        std::vector<VertexId> ring;
        const std::uint32_t sides = 5 + static_cast<std::uint32_t>(random.below(4));
        for (std::uint32_t k = 0; k < sides; ++k) {
            const double angle = 2 * std::numbers::pi * (k + random.uniform(0.1, 0.9)) / sides;
            const double r = random.uniform(0.4, 0.6);
            ring.push_back(add_point(complex, {r * std::cos(angle), r * std::sin(angle), z}));
        }
        add_facet(complex, {ring});
    }
    return complex;
}

PiecewiseLinearComplex make_coplanar_facets(std::uint32_t n, std::uint64_t seed) {
    Random random(seed);
    PiecewiseLinearComplex complex;
    const auto make_lines = [&] {
        std::vector<double> lines(n + 1);
        for (std::uint32_t i = 0; i <= n; ++i)
            lines[i] = (i + (i == 0 || i == n ? 0.0 : random.uniform(-0.45, 0.45))) / n;
        return lines;
    };
    const std::vector<double> xs = make_lines(), ys = make_lines();
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) add_point(complex, {xs[i], ys[j], 0});
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
            add_facet(complex, {{VertexId{a}, VertexId{a + 1}, VertexId{b + 1}, VertexId{b}}});
        }
    }
    return complex;
}

}  // namespace certa::generators
