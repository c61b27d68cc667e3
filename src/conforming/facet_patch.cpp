// A facet's triangulation is a constrained Delaunay triangulation in the facet's frame, with the pieces of its sides
// and its shields as constraints; it is made anew whenever the facet changed, from a handful of points as a rule. Ties:
// points on one circle (grids, rectangles, rims of holes) leave a choice. The mesh has made its own, so a maximal
// polygon of cocircular points counts as present when faces of the mesh tile it; these faces then replace ours.
#include "conforming/facet_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/vector3.h"
#include "exact/orientation.h"

namespace certa::conforming {
namespace {

using Corners = std::array<std::uint32_t, 3>;

// Tiles a polygon of cocircular points by faces of the mesh: solve(i, j) is about the part of the polygon beyond its
// chord (i, j), whose third corner must be one of the vertices that the mesh links to that chord.
class TieSolver {
public:
    TieSolver(const MeshState& mesh, const FacetPatch& patch, const std::vector<std::uint32_t>& polygon, bool gabriel)
        : mesh_(mesh), patch_(patch), polygon_(polygon), gabriel_(gabriel) {
        for (std::uint32_t i = 0; i < polygon.size(); ++i) place_[patch.vertices[polygon[i]]] = i;
    }

    bool solve(std::uint32_t i, std::uint32_t j) {
        if (j == i + 1) return true;
        const std::uint64_t key = (static_cast<std::uint64_t>(i) << 32) | j;
        if (const auto known = apex_.find(key); known != apex_.end()) return known->second != no_index;
        std::vector<std::uint32_t> link;
        mesh_.triangulation.find_link(patch_.vertices[polygon_[i]], patch_.vertices[polygon_[j]], link);
        std::vector<std::uint32_t> candidates;
        for (const std::uint32_t v : link) {
            const auto k = place_.find(v);
            if (k != place_.end() && k->second > i && k->second < j) candidates.push_back(k->second);
        }
        std::sort(candidates.begin(), candidates.end());
        std::uint32_t found = no_index;
        for (const std::uint32_t k : candidates) {
            if (fits(i, k, j) && solve(i, k) && solve(k, j)) {
                found = k;
                break;
            }
        }
        apex_[key] = found;
        return found != no_index;
    }

    bool fits(std::uint32_t i, std::uint32_t k, std::uint32_t j) const {
        const auto at = [&](std::uint32_t p) {
            return exact::Point2{patch_.points[polygon_[p]].x, patch_.points[polygon_[p]].y};
        };
        if (exact::orient2d(at(i), at(k), at(j)) <= 0) return false;
        return !gabriel_ || patch_.is_present({polygon_[i], polygon_[k], polygon_[j]}, true);
    }

    void collect(std::uint32_t i, std::uint32_t j, std::vector<Corners>& triangles) const {
        if (j == i + 1) return;
        const std::uint32_t k = apex_.at((static_cast<std::uint64_t>(i) << 32) | j);
        triangles.push_back({polygon_[i], polygon_[k], polygon_[j]});
        collect(i, k, triangles);
        collect(k, j, triangles);
    }

private:
    const MeshState& mesh_;
    const FacetPatch& patch_;
    const std::vector<std::uint32_t>& polygon_;
    bool gabriel_;
    std::unordered_map<std::uint32_t, std::uint32_t> place_;
    std::unordered_map<std::uint64_t, std::uint32_t> apex_;
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

bool FacetPatch::is_present(const Corners& triangle, bool gabriel) const {
    const std::uint32_t a = vertices[triangle[0]], b = vertices[triangle[1]], c = vertices[triangle[2]];
    if (!gabriel) return mesh_->triangulation.has_face(a, b, c);
    std::array<std::uint32_t, 2> apexes;
    if (!mesh_->triangulation.find_apexes(a, b, c, apexes)) return false;
    return std::none_of(apexes.begin(), apexes.end(), [&](std::uint32_t v) {
        return v != no_index &&
               delaunay::is_inside_diametral_ball(mesh_->triangulation.position(v), mesh_->triangulation.position(a),
                                                  mesh_->triangulation.position(b), mesh_->triangulation.position(c));
    });
}

void FacetPatch::settle_ties(const std::vector<Corners>& neighbors, std::vector<std::uint8_t>& present, bool gabriel) {
    constexpr double tie = 1e-8;  // of the radius; a generous group costs a search, never a wrong answer
    std::vector<std::uint32_t> group_of(triangles.size(), no_index);
    const std::vector<Corners> before = triangles;
    for (std::uint32_t seed = 0; seed < before.size(); ++seed) {
        if (present[seed] != 0 || group_of[seed] != no_index) continue;
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
        solver.collect(0, static_cast<std::uint32_t>(ring.size() - 1), tiles);
        for (std::size_t i = 0; i < group.size(); ++i) {
            triangles[group[i]] = tiles[i];
            present[group[i]] = is_present(tiles[i], gabriel) ? 1 : 0;
        }
    }
}

FacetPatch::State FacetPatch::build(const MeshState& mesh, std::uint32_t f, bool gabriel) {
    mesh_ = &mesh;
    facet = f;
    frame_ = &mesh.complex.frames[f];
    missing.clear();
    collect(mesh);
    delaunay::PlanarTriangulation planar = delaunay::triangulate_region(points, edges);
    if (!planar.valid) return State::invalid;
    triangles = std::move(planar.triangles);
    std::vector<std::uint8_t> present(triangles.size());
    bool complete = true;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        present[t] = is_present(triangles[t], gabriel) ? 1 : 0;
        complete = complete && present[t] != 0;
    }
    if (complete) return State::complete;
    settle_ties(planar.neighbors, present, gabriel);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        if (present[t] != 0) continue;
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
