// A facet's triangulation is a constrained Delaunay triangulation in the facet's frame, with the pieces of its sides
// and its shields as constraints; it is made anew whenever the facet changed, from a handful of points as a rule. Ties:
// points on one circle (grids, rectangles, rims of holes) leave a choice. The mesh has made its own, so a maximal
// polygon of cocircular points counts as present when faces of the mesh tile it; these faces then replace ours.
// The same search comes first for plain triangles, whose sides may be cut.
#include "conforming/facet_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "conforming/facet_interior.h"
#include "core/vector3.h"
#include "exact/orientation.h"

namespace certa::conforming {
namespace {

using Corners = std::array<std::uint32_t, 3>;

// Tiles a counter-clockwise polygon by faces of the mesh: solve(i, j) is about the part of the polygon beyond its
// chord (i, j), whose third corner must be one of the vertices that the mesh links to that chord.
class TieSolver {
public:
    /// `sides`: per corner of the polygon, a bit for each straight side it lies on, or empty: a tile has no three
    /// corners on one side, where only rounding would tell their orientation.
    TieSolver(const MeshState& mesh, const FacetPatch& patch, const std::vector<std::uint32_t>& polygon, bool gabriel,
              std::vector<std::uint8_t> sides = {})
        : mesh_(mesh), patch_(patch), polygon_(polygon), gabriel_(gabriel), sides_(std::move(sides)) {
        for (std::uint32_t i = 0; i < polygon.size(); ++i) place_[patch.vertices[polygon[i]]] = i;
    }

    bool solve(std::uint32_t i, std::uint32_t j) {
        if (j == i + 1) return true;
        const std::uint64_t key = (static_cast<std::uint64_t>(i) << 32) | j;
        if (const auto known = apex_.find(key); known != apex_.end()) return known->second.place != no_index;
        mesh_.triangulation.find_link(patch_.vertices[polygon_[i]], patch_.vertices[polygon_[j]], link_);
        std::vector<Apex> candidates;
        for (const auto& [v, face] : link_) {
            const auto k = place_.find(v);
            if (k != place_.end() && k->second > i && k->second < j) candidates.push_back({k->second, face});
        }
        std::sort(candidates.begin(), candidates.end(), [](const Apex& l, const Apex& r) { return l.place < r.place; });
        Apex found;
        for (const Apex& apex : candidates) {
            if (fits(i, apex.place, j) && solve(i, apex.place) && solve(apex.place, j)) {
                found = apex;
                break;
            }
        }
        apex_[key] = found;
        return found.place != no_index;
    }

    bool fits(std::uint32_t i, std::uint32_t k, std::uint32_t j) const {
        const auto at = [&](std::uint32_t p) {
            return exact::Point2{patch_.points[polygon_[p]].x, patch_.points[polygon_[p]].y};
        };
        if (!sides_.empty() && (sides_[i] & sides_[k] & sides_[j]) != 0) return false;
        if (exact::orient2d(at(i), at(k), at(j)) <= 0) return false;
        return !gabriel_ || patch_.find_present({polygon_[i], polygon_[k], polygon_[j]}, true).cell != nullptr;
    }

    void collect(std::uint32_t i, std::uint32_t j, std::vector<Corners>& triangles,
                 std::vector<delaunay::FaceHandle>& faces) const {
        if (j == i + 1) return;
        const auto [k, face] = apex_.at((static_cast<std::uint64_t>(i) << 32) | j);
        triangles.push_back({polygon_[i], polygon_[k], polygon_[j]});
        faces.push_back(face);
        collect(i, k, triangles, faces);
        collect(k, j, triangles, faces);
    }

private:
    struct Apex {
        std::uint32_t place = no_index;  // none: nothing tiles what is beyond the chord
        delaunay::FaceHandle face;
    };

    const MeshState& mesh_;
    const FacetPatch& patch_;
    const std::vector<std::uint32_t>& polygon_;
    bool gabriel_;
    std::vector<std::uint8_t> sides_;
    std::unordered_map<std::uint32_t, std::uint32_t> place_;
    std::unordered_map<std::uint64_t, Apex> apex_;
    std::vector<delaunay::Delaunay3::LinkFace> link_;
};

// The outline of a set of triangles as a counter-clockwise ring; empty when it is no simple ring.
std::vector<std::uint32_t> outline_of(const std::vector<Corners>& triangles, const std::vector<Corners>& neighbors,
                                      const std::vector<std::uint32_t>& group,
                                      const std::vector<std::uint32_t>& group_of, std::uint32_t number) {
    std::unordered_map<std::uint32_t, std::uint32_t> next;
    for (const std::uint32_t t : group) {
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t n = neighbors[t][i];
            if (n != no_index && group_of[n] == number) continue;
            if (!next.emplace(triangles[t][(i + 1) % 3], triangles[t][(i + 2) % 3]).second) return {};
        }
    }
    std::vector<std::uint32_t> ring;
    const std::uint32_t start = triangles[group.front()][0];
    for (std::uint32_t v = start;;) {
        const auto step = next.find(v);
        if (step == next.end() || ring.size() > next.size()) return {};
        ring.push_back(v);
        v = step->second;
        if (v == start) break;
    }
    return ring.size() == next.size() ? ring : std::vector<std::uint32_t>{};
}

}  // namespace

FacetPatch::Missing circumscribe(const delaunay::PlanarPoint& a, const delaunay::PlanarPoint& b,
                                 const delaunay::PlanarPoint& c) {
    const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    const double area = 2.0 * (bx * cy - by * cx);
    FacetPatch::Missing circle;
    if (area == 0.0) {
        circle.radius = std::numeric_limits<double>::infinity();
        return circle;
    }
    const double b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
    const double ux = (cy * b2 - by * c2) / area, uy = (bx * c2 - cx * b2) / area;
    circle.center = {a.x + ux, a.y + uy};
    circle.radius = std::hypot(ux, uy);
    return circle;
}

Point3 FacetPatch::lift(const delaunay::PlanarPoint& p) const {
    return frame_->origin + p.x * frame_->u + p.y * frame_->v;
}

delaunay::PlanarPoint FacetPatch::flatten(const Point3& p) const {
    const Point3 d = p - frame_->origin;
    return {dot(d, frame_->u), dot(d, frame_->v)};
}

void FacetPatch::collect(const MeshState& mesh) {
    vertices.clear();
    points.clear();
    pieces.clear();
    edges.clear();
    std::vector<std::array<std::uint32_t, 2>> ends;
    for (const Side& side : mesh.complex.facet_sides[facet]) {
        for (std::uint32_t id = mesh.first_pieces[side.segment]; id != no_index; id = mesh.pieces[id].next) {
            pieces.push_back(id);
            edges.push_back({0, 0, side.boundary});
            ends.push_back({mesh.pieces[id].a, mesh.pieces[id].b});
        }
    }
    const FacetWork* work = mesh.find_work(facet);
    if (work != nullptr) {
        for (const std::uint32_t id : work->shields) {
            pieces.push_back(id);
            edges.push_back({0, 0, false});
            ends.push_back({mesh.pieces[id].a, mesh.pieces[id].b});
        }
    }
    for (const auto& [a, b] : ends) {
        vertices.push_back(a);
        vertices.push_back(b);
    }
    const auto isolated = mesh.complex.facet_points[facet];
    vertices.insert(vertices.end(), isolated.begin(), isolated.end());
    if (work != nullptr) vertices.insert(vertices.end(), work->points.begin(), work->points.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto local = [&](std::uint32_t v) {
        return static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
    };
    for (std::size_t i = 0; i < edges.size(); ++i) {
        edges[i].a = local(ends[i][0]);
        edges[i].b = local(ends[i][1]);
    }
    points.reserve(vertices.size());
    for (const std::uint32_t v : vertices) points.push_back(flatten(mesh.triangulation.position(v)));
}

delaunay::FaceHandle FacetPatch::find_present(const Corners& triangle, bool gabriel) const {
    const std::uint32_t a = vertices[triangle[0]], b = vertices[triangle[1]], c = vertices[triangle[2]];
    const delaunay::Delaunay3& mesh = mesh_->triangulation;
    const delaunay::FaceHandle face = mesh.find_face(a, b, c);
    if (!gabriel || face.cell == nullptr) return face;
    const std::array<std::uint32_t, 2> apexes = mesh.apexes_of(face);
    const bool is_entered = std::any_of(apexes.begin(), apexes.end(), [&](std::uint32_t v) {
        return v != no_index && delaunay::is_inside_diametral_ball(mesh.position(v), mesh.position(a), mesh.position(b),
                                                                   mesh.position(c));
    });
    return is_entered ? delaunay::FaceHandle{} : face;
}

void FacetPatch::settle_ties(const std::vector<Corners>& neighbors, bool gabriel) {
    constexpr double tie = 1e-8;  // of the radius; a generous group costs a search, never a wrong answer
    std::vector<std::uint32_t> group_of(triangles.size(), no_index);
    const std::vector<Corners> before = triangles;
    for (std::uint32_t seed = 0; seed < before.size(); ++seed) {
        if (faces[seed].cell != nullptr || group_of[seed] != no_index) continue;
        const Missing circle = circumscribe(points[before[seed][0]], points[before[seed][1]], points[before[seed][2]]);
        std::vector<std::uint32_t> group{seed};
        group_of[seed] = seed;
        for (std::size_t i = 0; i < group.size(); ++i) {
            for (const std::uint32_t n : neighbors[group[i]]) {
                if (n == no_index || group_of[n] == seed) continue;
                const bool on_circle = std::all_of(before[n].begin(), before[n].end(), [&](std::uint32_t p) {
                    const double d = std::hypot(points[p].x - circle.center.x, points[p].y - circle.center.y);
                    return std::abs(d - circle.radius) <= tie * circle.radius;
                });
                if (!on_circle) continue;
                group_of[n] = seed;
                group.push_back(n);
            }
        }
        if (group.size() < 2) continue;
        const std::vector<std::uint32_t> ring = outline_of(before, neighbors, group, group_of, seed);
        if (ring.size() != group.size() + 2) continue;
        TieSolver solver(*mesh_, *this, ring, gabriel);
        if (!solver.solve(0, static_cast<std::uint32_t>(ring.size() - 1))) continue;
        std::vector<Corners> tiles;
        std::vector<delaunay::FaceHandle> tile_faces;
        solver.collect(0, static_cast<std::uint32_t>(ring.size() - 1), tiles, tile_faces);
        for (std::size_t i = 0; i < group.size(); ++i) {
            triangles[group[i]] = tiles[i];
            faces[group[i]] = tile_faces[i];
        }
    }
}

// For a triangle: per planar point of a ring, a bit for each side that it lies on.
std::vector<std::uint8_t> FacetPatch::sides_of(const std::vector<std::uint32_t>& ring) const {
    const auto sides = mesh_->complex.facet_sides[facet];
    std::vector<std::uint8_t> of_point(vertices.size(), 0), result;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        for (std::size_t s = 0; s < sides.size(); ++s) {
            if (sides[s].segment != mesh_->pieces[pieces[e]].owner) continue;
            of_point[edges[e].a] |= static_cast<std::uint8_t>(1u << s);
            of_point[edges[e].b] |= static_cast<std::uint8_t>(1u << s);
        }
    }
    for (const std::uint32_t p : ring) result.push_back(of_point[p]);
    return result;
}

// A triangle of which only sides were cut, where the mesh has all of it already: most facets, and for them there is no
// need to triangulate anything.
bool FacetPatch::tile_triangle(bool gabriel) {
    const FacetWork* work = mesh_->find_work(facet);
    if (work != nullptr && (!work->points.empty() || !work->shields.empty())) return false;
    if (!triangle_of(mesh_->complex, facet) || edges.size() != vertices.size()) return false;
    constexpr std::uint32_t none = no_index;
    std::vector<std::array<std::uint32_t, 2>> beside(vertices.size(), {none, none});
    for (const delaunay::PlanarEdge& e : edges) {
        for (const auto& [from, to] : {std::pair{e.a, e.b}, std::pair{e.b, e.a}}) {
            beside[from][beside[from][0] == none ? 0 : 1] = to;
        }
    }
    std::vector<std::uint32_t> ring{0};
    double area = 0.0;
    for (std::uint32_t last = none, v = 0;;) {
        const std::uint32_t next = beside[v][beside[v][0] == last ? 1 : 0];
        if (next == none || ring.size() > vertices.size()) return false;
        area += points[v].x * points[next].y - points[v].y * points[next].x;
        if (next == 0) break;
        ring.push_back(next);
        last = std::exchange(v, next);
    }
    if (ring.size() != vertices.size()) return false;
    if (area < 0.0) std::reverse(ring.begin(), ring.end());
    TieSolver solver(*mesh_, *this, ring, gabriel, sides_of(ring));
    const auto last = static_cast<std::uint32_t>(ring.size() - 1);
    if (!solver.solve(0, last)) return false;
    triangles.clear();
    faces.clear();
    solver.collect(0, last, triangles, faces);
    return true;
}

FacetPatch::State FacetPatch::build(const MeshState& mesh, std::uint32_t f, bool gabriel) {
    mesh_ = &mesh;
    facet = f;
    frame_ = &mesh.complex.frames[f];
    missing.clear();
    collect(mesh);
    if (tile_triangle(gabriel)) return State::complete;
    delaunay::PlanarTriangulation planar = delaunay::triangulate_region(points, edges);
    if (!planar.valid) return State::invalid;
    triangles = std::move(planar.triangles);
    faces.clear();
    bool complete = true;
    for (const Corners& t : triangles) {
        faces.push_back(find_present(t, gabriel));
        complete = complete && faces.back().cell != nullptr;
    }
    if (complete) return State::complete;
    settle_ties(planar.neighbors, gabriel);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        if (faces[t].cell != nullptr) continue;
        Missing circle = circumscribe(points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]]);
        circle.triangle = t;
        missing.push_back(circle);
    }
    std::sort(missing.begin(), missing.end(), [](const Missing& l, const Missing& r) {
        return l.radius != r.radius ? l.radius > r.radius : l.triangle < r.triangle;
    });
    return missing.empty() ? State::complete : State::missing;
}

}  // namespace certa::conforming
