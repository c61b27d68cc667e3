// What facets cover of their planes (thesis, Part I, 1.1.3: "sectors which are included in the complex").
//
// A triangle facet is its own triangulation. Any other facet gets a constrained Delaunay triangulation of its points
// along the coordinate axis that sees it largest (exact on the input's doubles); a flood fill from infinity that
// changes sides at every boundary side separates inside from outside. Both give, per side, where the facet lies;
// gathered by segment these are the sheets.
#include "conforming/facet_interior.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <certa/error.h>

#include <algorithm>
#include <optional>
#include <string>

#include "conforming/flat_facet.h"

namespace certa::conforming {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<std::int8_t, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_tag>;

using PointTriangle = std::array<std::uint32_t, 3>;

[[noreturn]] void fail(std::uint32_t facet, const char* what) {
    throw InternalError("facet " + std::to_string(facet + 1) + " " + what +
                        " although the complex was validated; please report this");
}

/// The third corner of a facet whose sides are the three boundary sides of a triangle.
std::optional<PointTriangle> triangle_of(const Complex& complex, std::uint32_t facet) {
    const auto sides = complex.facet_sides[facet];
    if (sides.size() != 3 || complex.facet_points[facet].size() != 0) return std::nullopt;
    const auto& first = complex.segments[sides[0].segment];
    const auto& second = complex.segments[sides[1].segment];
    const std::uint32_t third = second[0] == first[0] || second[0] == first[1] ? second[1] : second[0];
    if (third == first[0] || third == first[1]) return std::nullopt;
    for (const Side& side : sides) {
        if (!side.boundary) return std::nullopt;
        for (const std::uint32_t v : complex.segments[side.segment]) {
            if (v != first[0] && v != first[1] && v != third) return std::nullopt;
        }
    }
    return PointTriangle{first[0], first[1], third};
}

CGAL::Orientation orientation(const Complex& complex, const Projection& projection, const PointTriangle& t) {
    std::array<Kernel::Point_2, 3> p;
    for (int i = 0; i < 3; ++i) {
        const Point2 q = projection(complex.points[t[i]]);
        p[i] = Kernel::Point_2(q.x, q.y);
    }
    return CGAL::orientation(p[0], p[1], p[2]);
}

void cover_triangle(const Complex& complex, std::uint32_t facet, PointTriangle t, FacetInterior& result) {
    const auto turn = orientation(complex, Projection(complex.frames[facet].normal), t);
    if (turn == CGAL::COLLINEAR) fail(facet, "has no area");
    if (turn == CGAL::CLOCKWISE) std::swap(t[0], t[1]);
    for (const Side& side : complex.facet_sides[facet]) {
        const auto& ends = complex.segments[side.segment];
        const auto at = std::find(t.begin(), t.end(), ends[0]) - t.begin();
        result.side_covers.push_back(t[(at + 1) % 3] == ends[1] ? cover_left : cover_right);
    }
    result.triangles.push_row(std::span<const PointTriangle>(&t, 1));
}

class FacetTriangulation {
public:
    FacetTriangulation(const Complex& complex, std::uint32_t facet)
        : complex_(complex), facet_(facet), projection_(complex.frames[facet].normal) {
        insert_points();
        insert_sides();
        flood();
    }

    void append_to(FacetInterior& result) const {
        for (std::size_t i = 0; i < sides_.size(); ++i) {
            const auto& [face, index] = sides_[i];  // on the left of the segment
            std::uint8_t cover = face->info() > 0 ? cover_left : 0;
            if (face->neighbor(index)->info() > 0) cover |= cover_right;
            result.side_covers.push_back(cover);
        }
        std::vector<PointTriangle> inside;
        for (const auto face : cdt_.finite_face_handles()) {
            if (face->info() <= 0) continue;
            inside.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
        }
        if (inside.empty()) fail(facet_, "encloses nothing");
        result.triangles.push_row(inside);
    }

private:
    void insert_points() {
        const auto insert = [&](std::uint32_t v) {
            const Point2 p = projection_(complex_.points[v]);
            hint_ = cdt_.insert(Kernel::Point_2(p.x, p.y), hint_ == nullptr ? Cdt::Face_handle() : hint_->face());
            hint_->info() = v;
            handles_.emplace_back(v, hint_);
        };
        std::vector<std::uint32_t> points(complex_.facet_points[facet_].begin(), complex_.facet_points[facet_].end());
        for (const Side& side : complex_.facet_sides[facet_]) {
            points.insert(points.end(), complex_.segments[side.segment].begin(), complex_.segments[side.segment].end());
        }
        std::sort(points.begin(), points.end());
        points.erase(std::unique(points.begin(), points.end()), points.end());
        for (const std::uint32_t v : points) insert(v);
        if (cdt_.number_of_vertices() != points.size()) fail(facet_, "has two points at one place of its plane");
        if (cdt_.dimension() != 2) fail(facet_, "has no area");
    }

    Cdt::Vertex_handle handle(std::uint32_t v) const {
        return std::lower_bound(handles_.begin(), handles_.end(), v,
                                [](const auto& entry, std::uint32_t id) { return entry.first < id; })
            ->second;
    }

    void insert_sides() {
        try {
            for (const Side& side : complex_.facet_sides[facet_]) {
                const auto& ends = complex_.segments[side.segment];
                cdt_.insert_constraint(handle(ends[0]), handle(ends[1]));
            }
        } catch (const Cdt::Intersection_of_constraints_exception&) {
            fail(facet_, "has sides that cross");
        }
        for (const Side& side : complex_.facet_sides[facet_]) {
            const auto& ends = complex_.segments[side.segment];
            const auto from = handle(ends[0]), to = handle(ends[1]);
            Cdt::Face_handle face;
            int index = 0;
            if (!cdt_.is_edge(from, to, face, index)) fail(facet_, "has a side through one of its points");
            if (face->vertex(Cdt::ccw(index)) != from) {
                const auto other = face->neighbor(index);
                index = cdt_.mirror_index(face, index);
                face = other;
            }
            sides_.emplace_back(face, index);
            boundary_.emplace_back(key(ends[0], ends[1]), side.boundary);
        }
        std::sort(boundary_.begin(), boundary_.end());
    }

    static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
        return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    }

    bool changes_side(Cdt::Face_handle face, int index) const {
        if (!face->is_constrained(index)) return false;
        const auto k = key(face->vertex(Cdt::ccw(index))->info(), face->vertex(Cdt::cw(index))->info());
        const auto found = std::lower_bound(boundary_.begin(), boundary_.end(), std::make_pair(k, false));
        return found != boundary_.end() && found->first == k && found->second;
    }

    /// Marks faces 1 (inside) or -1 (outside).
    void flood() {
        for (const auto face : cdt_.all_face_handles()) face->info() = 0;
        std::vector<Cdt::Face_handle> stack{cdt_.infinite_face()};
        cdt_.infinite_face()->info() = -1;
        while (!stack.empty()) {
            const auto face = stack.back();
            stack.pop_back();
            for (int i = 0; i < 3; ++i) {
                const auto next = face->neighbor(i);
                const auto mark = static_cast<std::int8_t>(changes_side(face, i) ? -face->info() : face->info());
                if (next->info() == 0) {
                    next->info() = mark;
                    stack.push_back(next);
                } else if (next->info() != mark) {
                    fail(facet_, "is open");
                }
            }
        }
    }

    const Complex& complex_;
    std::uint32_t facet_;
    Projection projection_;
    Cdt cdt_;
    Cdt::Vertex_handle hint_ = nullptr;
    std::vector<std::pair<std::uint32_t, Cdt::Vertex_handle>> handles_;  // sorted by point
    std::vector<std::pair<Cdt::Face_handle, int>> sides_;                // one per side, on the left of its segment
    std::vector<std::pair<std::uint64_t, bool>> boundary_;               // side's ends, whether it is a boundary
};

void gather_sheets(const Complex& complex, FacetInterior& result) {
    auto& offsets = result.sheets.offsets;
    offsets.assign(complex.segments.size() + 1, 0);
    for (const Side& side : complex.facet_sides.values) ++offsets[side.segment + 1];
    for (std::size_t s = 0; s < complex.segments.size(); ++s) offsets[s + 1] += offsets[s];
    result.sheets.values.resize(complex.facet_sides.values.size());
    std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
    for (std::uint32_t f = 0; f < complex.facet_sides.size(); ++f) {
        for (std::uint32_t i = complex.facet_sides.offsets[f]; i < complex.facet_sides.offsets[f + 1]; ++i) {
            result.sheets.values[next[complex.facet_sides.values[i].segment]++] = {f, result.side_covers[i]};
        }
    }
}

}  // namespace

FacetInterior build_facet_interior(const Complex& complex) {
    FacetInterior result;
    result.side_covers.reserve(complex.facet_sides.values.size());
    for (std::uint32_t f = 0; f < complex.facet_sides.size(); ++f) {
        if (const auto triangle = triangle_of(complex, f)) {
            cover_triangle(complex, f, *triangle, result);
        } else {
            FacetTriangulation(complex, f).append_to(result);
        }
    }
    gather_sheets(complex, result);
    return result;
}

}  // namespace certa::conforming
