// Delaunay triangulations for the generators of random surfaces: incremental insertion with Lawson's flips.
//
// A closed surface needs no ghost triangles: every half-edge has a twin. On a flat torus the triangulation may start
// from a single vertex, where triangles touch themselves, so corners carry the translation of their copy of a vertex
// and a point that walks across an edge changes frames. Flips of an edge with the same triangle on both sides are left
// for the last round, which visits every edge until none is flipped. Plan: walk to the triangle of the new vertex, cut
// it into three, flip what fails; order vertices along a curve first.
#include "mesh/lawson.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/assert.h"
#include "core/morton.h"
#include "core/random.h"
#include "core/vector3.h"

namespace certa::generators {
namespace {

constexpr std::array<std::uint32_t, 3> next{1, 2, 0}, previous{2, 0, 1};

class Builder {
public:
    Builder(Triangulation start, const Chart& chart) : mesh_(std::move(start)), chart_(chart) {}

    void insert(std::uint32_t vertex) {
        // In the frame of the last triangle: its corner is close to the vertex.
        const Corner& near = mesh_.triangles[last_][0];
        Corner point{vertex, near.dx, near.dy};
        const std::uint32_t t = locate(last_, point);
        split(t, point);
        last_ = t;
    }

    Triangulation finish() {
        for (bool again = true; again;) {
            again = false;
            for (std::uint32_t h = 0; h < mesh_.twins.size(); ++h)
                if (is_to_be_flipped(h)) flip(h), again = true;
        }
        return std::move(mesh_);
    }

private:
    static Corner moved(Corner corner, std::int32_t dx, std::int32_t dy) {
        corner.dx += dx, corner.dy += dy;
        return corner;
    }
    /// Translation from the frame of the twin's triangle into that of h.
    std::array<std::int32_t, 2> shift(std::uint32_t h) const {
        const std::uint32_t g = mesh_.twins[h];
        const Corner& here = mesh_.triangles[h / 3][next[h % 3]];
        const Corner& there = mesh_.triangles[g / 3][previous[g % 3]];
        return {here.dx - there.dx, here.dy - there.dy};
    }

    std::uint32_t locate(std::uint32_t t, Corner& point) const {
        for (std::size_t steps = 0;; ++steps) {
            CERTA_ASSERT(steps < 4 * mesh_.triangles.size() + 1000);
            std::uint32_t crossed = 3;
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t i = static_cast<std::uint32_t>((k + steps) % 3);  // no walk turns in circles
                const auto& corners = mesh_.triangles[t];
                if (chart_.side(corners[next[i]], corners[previous[i]], point) < 0.0) crossed = i;
            }
            if (crossed == 3) return t;
            const auto [dx, dy] = shift(3 * t + crossed);
            point = moved(point, -dx, -dy);
            t = mesh_.twins[3 * t + crossed] / 3;
        }
    }

    void link(std::uint32_t h, std::uint32_t g) { mesh_.twins[h] = g, mesh_.twins[g] = h; }

    void split(std::uint32_t t, const Corner& point) {
        const std::array<Corner, 3> corners = mesh_.triangles[t];
        const std::array<std::uint32_t, 3> outer{mesh_.twins[3 * t], mesh_.twins[3 * t + 1], mesh_.twins[3 * t + 2]};
        const auto u = static_cast<std::uint32_t>(mesh_.triangles.size()), w = u + 1;
        mesh_.triangles.resize(w + 1);
        mesh_.twins.resize(3 * (w + 1));
        const std::array<std::uint32_t, 3> parts{t, u, w};
        // Part k keeps the edge opposite corner k; the new vertex takes that corner's place.
        for (std::uint32_t k = 0; k < 3; ++k) {
            mesh_.triangles[parts[k]] = corners;
            mesh_.triangles[parts[k]][k] = point;
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::uint32_t g = outer[k];
            if (g / 3 == t) g = 3 * parts[g % 3] + g % 3;  // glued to itself
            link(3 * parts[k] + k, g);
            // Opposite corner k + 1 of part k runs from corner k - 1 to the new vertex: shared with part k + 1.
            link(3 * parts[k] + next[k], 3 * parts[next[k]] + k);
        }
        for (std::uint32_t k = 0; k < 3; ++k) stack_.push_back(3 * parts[k] + k);
        while (!stack_.empty()) {
            const std::uint32_t h = stack_.back();
            stack_.pop_back();
            if (is_to_be_flipped(h)) flip(h);
        }
    }

    bool is_to_be_flipped(std::uint32_t h) const {
        const std::uint32_t g = mesh_.twins[h];
        if (g / 3 == h / 3) return false;
        const auto& a = mesh_.triangles[h / 3];
        const auto [dx, dy] = shift(h);
        return chart_.in_circle(a[0], a[1], a[2], moved(mesh_.triangles[g / 3][g % 3], dx, dy));
    }

    /// Replaces the edge (b, c) of triangles (a, b, c) and (d, c, b) by (a, d); leaves the outer edges on the stack.
    void flip(std::uint32_t h) {
        const std::uint32_t g = mesh_.twins[h], t = h / 3, s = g / 3, i = h % 3, j = g % 3;
        const auto [dx, dy] = shift(h);
        const Corner a = mesh_.triangles[t][i], b = mesh_.triangles[t][next[i]], c = mesh_.triangles[t][previous[i]];
        const Corner d = moved(mesh_.triangles[s][j], dx, dy);
        std::uint32_t ca = mesh_.twins[3 * t + next[i]], ab = mesh_.twins[3 * t + previous[i]];
        std::uint32_t bd = mesh_.twins[3 * s + next[j]], dc = mesh_.twins[3 * s + previous[j]];
        // Outer edges may be glued to each other; follow them to their new places: t = (a, b, d), s = (a, d, c).
        const std::uint32_t new_ab = 3 * t + 2, new_bd = 3 * t, new_dc = 3 * s, new_ca = 3 * s + 1;
        const auto renamed = [&](std::uint32_t x) {
            if (x == 3 * t + next[i]) return new_ca;
            if (x == 3 * t + previous[i]) return new_ab;
            if (x == 3 * s + next[j]) return new_bd;
            if (x == 3 * s + previous[j]) return new_dc;
            return x;
        };
        ca = renamed(ca), ab = renamed(ab), bd = renamed(bd), dc = renamed(dc);
        mesh_.triangles[t] = {a, b, d};
        mesh_.triangles[s] = {a, d, c};
        link(new_ab, ab), link(new_bd, bd), link(new_dc, dc), link(new_ca, ca);
        link(3 * t + 1, 3 * s + 2);
        stack_.insert(stack_.end(), {new_ab, new_bd, new_dc, new_ca});
    }

    Triangulation mesh_;
    const Chart& chart_;
    std::vector<std::uint32_t> stack_;
    std::uint32_t last_ = 0;
};

std::vector<std::uint32_t> order_by(const std::vector<std::uint64_t>& keys, const std::vector<bool>& left_out) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t v = 0; v < keys.size(); ++v)
        if (!left_out[v]) order.push_back(v);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
    return order;
}

class FlatTorus : public Chart {
public:
    FlatTorus(const std::vector<std::array<double, 2>>& points, double width, double height)
        : points_(points), width_(width), height_(height) {}
    double side(const Corner& a, const Corner& b, const Corner& p) const override {
        const auto u = minus(b, a), v = minus(p, a);
        return u[0] * v[1] - u[1] * v[0];
    }
    bool in_circle(const Corner& a, const Corner& b, const Corner& c, const Corner& d) const override {
        const auto p = minus(a, d), q = minus(b, d), r = minus(c, d);
        const auto square = [](const std::array<double, 2>& v) { return v[0] * v[0] + v[1] * v[1]; };
        const double pq = p[0] * q[1] - p[1] * q[0], qr = q[0] * r[1] - q[1] * r[0], rp = r[0] * p[1] - r[1] * p[0];
        const double terms = square(p) * std::abs(qr) + square(q) * std::abs(rp) + square(r) * std::abs(pq);
        // Beyond rounding only, or flips might go on forever.
        return square(p) * qr + square(q) * rp + square(r) * pq > 1e-14 * terms;
    }

private:
    std::array<double, 2> minus(const Corner& a, const Corner& b) const {
        return {points_[a.vertex][0] - points_[b.vertex][0] + (a.dx - b.dx) * width_,
                points_[a.vertex][1] - points_[b.vertex][1] + (a.dy - b.dy) * height_};
    }
    const std::vector<std::array<double, 2>>& points_;
    double width_, height_;
};

class Sphere : public Chart {
public:
    explicit Sphere(const std::vector<Point3>& points) : points_(points) {}
    double side(const Corner& a, const Corner& b, const Corner& p) const override {
        return dot(cross(points_[a.vertex], points_[b.vertex]), points_[p.vertex]);
    }
    bool in_circle(const Corner& a, const Corner& b, const Corner& c, const Corner& d) const override {
        const Point3 &p = points_[a.vertex], u = points_[b.vertex] - p, v = points_[c.vertex] - p;
        const Point3 w = points_[d.vertex] - p;
        return dot(cross(u, v), w) > 1e-14 * norm(u) * norm(v) * norm(w);
    }

private:
    const std::vector<Point3>& points_;
};

/// Four points whose tetrahedron holds the centre, as a triangulation.
Triangulation first_tetrahedron(const std::vector<Point3>& points) {
    core::Random random(1);
    const auto side = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        return dot(cross(points[a], points[b]), points[c]);
    };
    for (std::size_t attempt = 0; attempt < 100000; ++attempt) {
        std::array<std::uint32_t, 4> v;
        for (std::uint32_t& x : v) x = static_cast<std::uint32_t>(random.below(points.size()));
        // The centre is on the inner side of all four faces, well away from them.
        constexpr double margin = 1e-3;
        if (side(v[0], v[1], v[2]) < 0) std::swap(v[1], v[2]);
        if (side(v[0], v[1], v[2]) < margin || side(v[0], v[2], v[3]) < margin || side(v[0], v[3], v[1]) < margin ||
            side(v[1], v[3], v[2]) < margin)
            continue;
        Triangulation start;
        const auto corner = [&](int i) { return Corner{v[static_cast<std::size_t>(i)], 0, 0}; };
        start.triangles = {{corner(0), corner(1), corner(2)},
                           {corner(0), corner(2), corner(3)},
                           {corner(0), corner(3), corner(1)},
                           {corner(1), corner(3), corner(2)}};
        // Opposite corner i of triangle t: found by the two vertices of the edge, walked the other way.
        start.twins.resize(12);
        for (std::uint32_t h = 0; h < 12; ++h)
            for (std::uint32_t g = 0; g < 12; ++g) {
                const auto &p = start.triangles[h / 3], &q = start.triangles[g / 3];
                if (p[next[h % 3]].vertex == q[previous[g % 3]].vertex &&
                    p[previous[h % 3]].vertex == q[next[g % 3]].vertex)
                    start.twins[h] = g;
            }
        return start;
    }
    CERTA_ASSERT(false && "points of the sphere do not surround its centre");
    return {};
}

}  // namespace

Triangulation triangulate_by_flips(Triangulation start, const std::vector<std::uint32_t>& order, const Chart& chart) {
    Builder builder(std::move(start), chart);
    for (const std::uint32_t vertex : order) builder.insert(vertex);
    return builder.finish();
}

Triangulation triangulate_flat_torus(const std::vector<std::array<double, 2>>& points, double width, double height) {
    std::vector<std::uint64_t> keys;
    for (const auto& p : points) keys.push_back(core::morton_code(p[0] / width, p[1] / height, 0.0));
    std::vector<bool> left_out(points.size());
    left_out[0] = true;
    Triangulation start;
    start.triangles = {{Corner{0, 0, 0}, Corner{0, 1, 0}, Corner{0, 1, 1}},
                       {Corner{0, 0, 0}, Corner{0, 1, 1}, Corner{0, 0, 1}}};
    start.twins = {4, 5, 3, 2, 0, 1};
    // Opposite corner 0 of triangle 0: from (1,0) to (1,1), the copy of the edge from (0,1) to (0,0) of triangle 1,
    // opposite its corner 1; opposite corner 1: the diagonal, opposite corner 2 of triangle 1; opposite corner 2: from
    // (0,0) to (1,0), the copy of the edge from (1,1) to (0,1), opposite corner 0 of triangle 1.
    return triangulate_by_flips(std::move(start), order_by(keys, left_out), FlatTorus(points, width, height));
}

Triangulation triangulate_sphere(const std::vector<Point3>& points) {
    Triangulation start = first_tetrahedron(points);
    std::vector<bool> left_out(points.size());
    for (const auto& triangle : start.triangles)
        for (const Corner& corner : triangle) left_out[corner.vertex] = true;
    std::vector<std::uint64_t> keys;
    for (const Point3& p : points) keys.push_back(core::morton_code((p.x + 1) / 2, (p.y + 1) / 2, (p.z + 1) / 2));
    return triangulate_by_flips(std::move(start), order_by(keys, left_out), Sphere(points));
}

}  // namespace certa::generators
