// Constrained Delaunay triangulation on top of CGAL's, with exact predicates.
// Insidedness is parity: every boundary edge crossed on the way from infinity toggles it.
#include "delaunay/planar.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <certa/types.h>

#include <algorithm>
#include <utility>

namespace certa::delaunay {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

struct FaceInfo {
    std::uint32_t index = no_index;
    bool seen = false;
    bool inside = false;
};

using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;
using FaceHandle = Triangulation::Face_handle;

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
}

bool insert_all(Triangulation& t, std::span<const PlanarPoint> points, std::span<const PlanarEdge> edges) {
    std::vector<std::pair<Kernel::Point_2, std::uint32_t>> input;
    input.reserve(points.size());
    for (const PlanarPoint& p : points)
        input.emplace_back(Kernel::Point_2(p.x, p.y), static_cast<std::uint32_t>(input.size()));
    t.insert(input.begin(), input.end());
    if (t.number_of_vertices() != points.size() || t.dimension() != 2) return false;
    std::vector<Triangulation::Vertex_handle> handles(points.size());
    for (const auto v : t.finite_vertex_handles()) handles[v->info()] = v;
    try {
        for (const PlanarEdge& e : edges) {
            t.insert_constraint(handles[e.a], handles[e.b]);
            FaceHandle face;
            int i = 0;
            if (!t.is_edge(handles[e.a], handles[e.b], face, i)) return false;  // it runs through a point
        }
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
        return false;
    }
    return true;
}

void flood(Triangulation& t, std::span<const PlanarEdge> edges) {
    std::vector<std::uint64_t> inner;  // edges with the region on both sides
    for (const PlanarEdge& e : edges) {
        if (!e.boundary) inner.push_back(key_of(e.a, e.b));
    }
    std::sort(inner.begin(), inner.end());
    std::vector<FaceHandle> stack{t.infinite_face()};
    t.infinite_face()->info().seen = true;
    while (!stack.empty()) {
        const FaceHandle face = stack.back();
        stack.pop_back();
        for (int i = 0; i < 3; ++i) {
            const FaceHandle next = face->neighbor(i);
            if (next->info().seen) continue;
            bool toggles = face->is_constrained(i);
            if (toggles && !inner.empty()) {
                const std::uint64_t key = key_of(face->vertex(t.cw(i))->info(), face->vertex(t.ccw(i))->info());
                toggles = !std::binary_search(inner.begin(), inner.end(), key);
            }
            next->info().seen = true;
            next->info().inside = face->info().inside != toggles;
            stack.push_back(next);
        }
    }
}

}  // namespace

PlanarTriangulation triangulate_region(std::span<const PlanarPoint> points, std::span<const PlanarEdge> edges) {
    PlanarTriangulation result;
    Triangulation t;
    if (!insert_all(t, points, edges)) return result;
    flood(t, edges);
    for (const FaceHandle face : t.finite_face_handles()) {
        if (!face->info().inside) continue;
        face->info().index = static_cast<std::uint32_t>(result.triangles.size());
        result.triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    result.neighbors.assign(result.triangles.size(), {no_index, no_index, no_index});
    for (const FaceHandle face : t.finite_face_handles()) {
        if (!face->info().inside) continue;
        for (int i = 0; i < 3; ++i) {
            if (!face->is_constrained(i)) result.neighbors[face->info().index][i] = face->neighbor(i)->info().index;
        }
    }
    result.valid = true;
    return result;
}

}  // namespace certa::delaunay
