// Counts and measures of a document's tetrahedra. Orientation is decided exactly; triangles are matched by sorting.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/union_find.h"
#include "core/vector3.h"
#include "exact/orientation.h"
#include "mesh/info_parts.h"

namespace certa::mesh {
namespace {

struct SideTriangle {
    std::array<std::uint32_t, 3> vertices;  // sorted
    std::uint32_t tetrahedron;
};

std::vector<SideTriangle> sorted_triangles(const std::vector<Tetrahedron>& tetrahedra) {
    std::vector<SideTriangle> triangles;
    triangles.reserve(4 * tetrahedra.size());
    for (std::uint32_t t = 0; t < tetrahedra.size(); ++t) {
        for (int omitted = 0; omitted < 4; ++omitted) {
            SideTriangle triangle{{}, t};
            for (int k = 0, n = 0; k < 4; ++k)
                if (k != omitted) triangle.vertices[n++] = index_of(tetrahedra[t][k]);
            std::sort(triangle.vertices.begin(), triangle.vertices.end());
            triangles.push_back(triangle);
        }
    }
    std::sort(triangles.begin(), triangles.end(), [](const SideTriangle& a, const SideTriangle& b) {
        return a.vertices != b.vertices ? a.vertices < b.vertices : a.tetrahedron < b.tetrahedron;
    });
    return triangles;
}

void connect(const std::vector<Tetrahedron>& tetrahedra, TetrahedraInfo& info) {
    const std::vector<SideTriangle> triangles = sorted_triangles(tetrahedra);
    core::UnionFind components(tetrahedra.size());
    for (std::size_t i = 0; i < triangles.size();) {
        std::size_t j = i;
        for (; j < triangles.size() && triangles[j].vertices == triangles[i].vertices; ++j)
            components.unite(triangles[i].tetrahedron, triangles[j].tetrahedron);
        info.boundary_triangles += j - i == 1;
        info.non_manifold_triangles += j - i > 2;
        i = j;
    }
    for (std::uint32_t t = 0; t < tetrahedra.size(); ++t) info.components += components.find(t) == t;
}

/// The dihedral angle between the planes through (a, b, c) and (a, b, d), at the edge (a, b).
double dihedral_radians(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
    const Point3 edge = b - a, first = cross(edge, c - a), second = cross(edge, d - a);
    return std::atan2(norm(cross(first, second)), dot(first, second));
}

void measure(const std::array<Point3, 4>& p, TetrahedraInfo& info) {
    const int sign = exact::orient3d(p[0], p[1], p[2], p[3]);
    if (sign <= 0) {
        ++(sign == 0 ? info.flat : info.inverted);
        return;
    }
    info.volume += dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0])) / 6.0;
    constexpr std::array<std::array<int, 4>, 6> edges{
        {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}}};
    for (const auto& e : edges) {
        const double angle = dihedral_radians(p[e[0]], p[e[1]], p[e[2]], p[e[3]]);
        if (!std::isfinite(angle)) continue;  // so thin that the cross products underflow
        info.smallest_dihedral_radians = std::min(info.smallest_dihedral_radians, angle);
        info.largest_dihedral_radians = std::max(info.largest_dihedral_radians, angle);
    }
}

std::size_t count_regions(const MeshDocument& document) {
    for (const Field& field : document.fields) {
        if (field.name != "region" || field.location != Location::tetrahedra) continue;
        if (const auto* values = std::get_if<std::vector<std::int64_t>>(&field.values))
            return std::set<std::int64_t>(values->begin(), values->end()).size();
    }
    return 0;
}

}  // namespace

TetrahedraInfo compute_tetrahedra_info(const MeshDocument& document) {
    TetrahedraInfo info;
    info.tetrahedra = document.tetrahedra.size();
    if (document.tetrahedra.empty()) return info;
    const auto& points = document.complex.positions;
    std::vector<bool> used(points.size(), false);
    info.smallest_dihedral_radians = 4.0;  // above every angle
    for (const Tetrahedron& t : document.tetrahedra) {
        std::array<Point3, 4> corners;
        for (int k = 0; k < 4; ++k) {
            corners[k] = points[index_of(t[k])];
            used[index_of(t[k])] = true;
        }
        measure(corners, info);
    }
    if (info.flat + info.inverted == info.tetrahedra) info.smallest_dihedral_radians = 0.0;
    info.vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
    info.regions = count_regions(document);
    connect(document.tetrahedra, info);
    return info;
}

}  // namespace certa::mesh
