// A facet's constrained Delaunay triangulation on exact coordinates, and what it says about the facet: which triangles
// are inside, and on how many sides of each of its sides the facet lies.
//
// Inside is combinatorial: a flood from infinity and from each hole point that rings stop and isolated segments do not.
// Delaunay matters: along a chain of points that are collinear up to rounding it leaves no sliver of chain points only,
// so two facets that share such a chain share its pieces and nothing else.
#include "delaunay/flat_facet.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace certa::delaunay {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<std::uint8_t, Kernel,
                                                           CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_tag>;
using VertexHandle = Cdt::Vertex_handle;
using FaceHandle = Cdt::Face_handle;
using VertexMap = std::unordered_map<std::uint32_t, VertexHandle>;

enum : std::uint8_t { unseen = 0, outside = 1, removed = 2 };

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
    return a < b ? (std::uint64_t{a} << 32 | b) : (std::uint64_t{b} << 32 | a);
}

/// The face and the index in it of the edge between two vertices, if there is one.
bool find_edge(const Cdt& cdt, VertexHandle a, VertexHandle b, FaceHandle& face, int& index) {
    return cdt.is_edge(a, b, face, index);
}

void flood(const Cdt& cdt, FaceHandle start, std::uint8_t mark, const std::vector<std::uint64_t>& rings) {
    if (start->info() != unseen) return;
    std::vector<FaceHandle> stack{start};
    start->info() = mark;
    while (!stack.empty()) {
        const FaceHandle face = stack.back();
        stack.pop_back();
        for (int i = 0; i < 3; ++i) {
            const FaceHandle next = face->neighbor(i);
            if (next->info() != unseen) continue;
            if (face->is_constrained(i)) {
                const auto key = key_of(face->vertex(Cdt::ccw(i))->info(), face->vertex(Cdt::cw(i))->info());
                if (std::binary_search(rings.begin(), rings.end(), key)) continue;
            }
            next->info() = mark;
            stack.push_back(next);
        }
    }
    (void)cdt;
}

/// Inserts points and sides; false when sides cross, run through points, or points coincide.
bool insert_sides(Cdt& cdt, VertexMap& handles, const FlatFacet& flat, const PiecewiseLinearComplex& input,
                  const Projection& projection) {
    const auto insert_point = [&](std::uint32_t v) {
        if (handles.contains(v)) return true;
        const Point2 p = projection(input.positions[v]);
        const auto before = cdt.number_of_vertices();
        const VertexHandle handle = cdt.insert(Kernel::Point_2(p.x, p.y));
        if (cdt.number_of_vertices() == before) return false;
        handle->info() = v;
        handles.emplace(v, handle);
        return true;
    };
    for (const FlatSide& side : flat.sides) {
        if (side.ends[0] == side.ends[1] || !insert_point(side.ends[0]) || !insert_point(side.ends[1])) return false;
    }
    for (const std::uint32_t v : flat.points) {
        if (!insert_point(v)) return false;
    }
    for (const FlatSide& side : flat.sides) cdt.insert_constraint(handles[side.ends[0]], handles[side.ends[1]]);
    return cdt.dimension() == 2;
}

void mark_faces(Cdt& cdt, FlatFacet& flat, const PiecewiseLinearComplex& input, std::uint32_t facet,
                const Projection& projection) {
    std::vector<std::uint64_t> rings;
    for (const FlatSide& side : flat.sides) {
        if (side.on_ring) rings.push_back(key_of(side.ends[0], side.ends[1]));
    }
    std::sort(rings.begin(), rings.end());
    for (const FaceHandle face : cdt.all_face_handles()) face->info() = unseen;
    flood(cdt, cdt.infinite_face(), outside, rings);
    for (std::uint32_t h = input.hole_offsets[facet]; h < input.hole_offsets[facet + 1]; ++h) {
        const Point2 p = projection(input.facet_holes[h]);
        Cdt::Locate_type type;
        int index = 0;
        const FaceHandle face = cdt.locate(Kernel::Point_2(p.x, p.y), type, index);
        bool inside = type == Cdt::FACE;
        if (type == Cdt::EDGE) {
            const auto key = key_of(face->vertex(Cdt::ccw(index))->info(), face->vertex(Cdt::cw(index))->info());
            inside = !std::binary_search(rings.begin(), rings.end(), key);
        }
        if (!inside || face->info() == outside) {
            flat.holes_outside.push_back(h);
        } else {
            flood(cdt, face, removed, rings);
        }
    }
}

/// Reads triangles, flags and places of isolated points off the marked triangulation.
bool read_marks(const Cdt& cdt, const VertexMap& handles, FlatFacet& flat) {
    for (FlatSide& side : flat.sides) {
        FaceHandle face;
        int index = 0;
        if (!find_edge(cdt, handles.at(side.ends[0]), handles.at(side.ends[1]), face, index)) return false;
        side.inside = static_cast<std::uint8_t>((face->info() == unseen) + (face->neighbor(index)->info() == unseen));
    }
    for (const std::uint32_t v : flat.points) {
        flat.points_inside.push_back(handles.at(v)->face()->info() == unseen);
    }
    for (const FaceHandle face : cdt.finite_face_handles()) {
        if (face->info() != unseen) continue;
        flat.triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    return true;
}

}  // namespace

Projection::Projection(const Point3& normal) {
    const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
    const double enough = (1.0 - 1e-6) * std::max({x, y, z});
    axis_ = x >= enough ? 0 : y >= enough ? 1 : 2;
    flipped_ = (axis_ == 0 ? normal.x : axis_ == 1 ? normal.y : normal.z) < 0.0;
}

Point2 Projection::operator()(const Point3& p) const {
    const Point2 q = exact::drop_axis(p, axis_);
    return flipped_ ? Point2{q.y, q.x} : q;
}

FlatFacet list_sides(const PiecewiseLinearComplex& input, std::uint32_t facet) {
    FlatFacet flat;
    std::unordered_map<std::uint64_t, std::uint32_t> index;
    std::unordered_map<std::uint32_t, bool> is_end;
    std::vector<std::uint32_t> loose;
    for (std::uint32_t p = input.facet_offsets[facet]; p < input.facet_offsets[facet + 1]; ++p) {
        const std::uint32_t begin = input.polygon_offsets[p], end = input.polygon_offsets[p + 1];
        const std::uint32_t n = end - begin;
        if (n == 1) loose.push_back(index_of(input.corners[begin]));
        const std::uint32_t sides = n == 1 ? 0 : n == 2 ? 1 : n;
        for (std::uint32_t i = 0; i < sides; ++i) {
            const std::uint32_t a = index_of(input.corners[begin + i]);
            const std::uint32_t b = index_of(input.corners[begin + (i + 1) % n]);
            const auto [it, fresh] = index.emplace(key_of(a, b), static_cast<std::uint32_t>(flat.sides.size()));
            if (fresh) flat.sides.push_back({.ends = {a, b}});
            FlatSide& side = flat.sides[it->second];
            side.on_ring = side.on_ring || n > 2;
            side.repeated += fresh ? 0 : 1;
            is_end[a] = is_end[b] = true;
        }
    }
    for (const std::uint32_t v : loose) {
        if (is_end.emplace(v, true).second) flat.points.push_back(v);
    }
    return flat;
}

FlatFacet flatten_facet(const PiecewiseLinearComplex& input, std::uint32_t facet, const Projection& projection) {
    FlatFacet flat = list_sides(input, facet);
    Cdt cdt;
    VertexMap handles;
    bool fine = false;
    try {
        fine = insert_sides(cdt, handles, flat, input, projection);
    } catch (const Cdt::Intersection_of_constraints_exception&) {
        fine = false;
    }
    if (fine) {
        mark_faces(cdt, flat, input, facet, projection);
        fine = read_marks(cdt, handles, flat);
    }
    if (!fine) {
        flat.state = FlatState::crossing;
        flat.triangles.clear();
        flat.points_inside.clear();
    }
    return flat;
}

}  // namespace certa::delaunay
