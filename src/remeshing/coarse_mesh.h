#pragma once
// The coarse mesh between the stages of remeshing: polygons over points that know their place on the input surface.
// Extraction fills it (4.3), placement moves its points, templates and subdivision make other coarse meshes of it.
#include <certa/mesh.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace certa::remeshing {

using Index = std::uint32_t;

/// What a vertex is bound to. Creases and the boundary are feature curves; a corner is where curves end, meet or turn.
enum class VertexKind : std::uint8_t { smooth, crease, boundary, corner };

/// A point of the input: a face and barycentric weights of its three corners, not negative, with sum 1. On an edge or
/// at a vertex of the input any of the faces there will do.
struct SurfacePlace {
    Index face = no_index;
    std::array<double, 3> weights{1.0, 0.0, 0.0};
};

/// An edge that belongs to a feature curve: of the input (a, b are vertices of the input) or of a coarse mesh. Curves
/// are numbered once, on the input; a curve runs from corner to corner or is closed and without corner. The boundary
/// consists of feature curves like any other.
struct FeatureEdge {
    Index a = no_index, b = no_index;
    Index curve = no_index;
};

/// Polygon i owns corners[offsets[i]] ... corners[offsets[i + 1] - 1], counter-clockwise seen from outside, at least
/// three and no vertex twice. Two polygons that share an edge walk it in opposite directions; an edge of one polygon
/// is boundary. The mesh conforms: a vertex on a side of a polygon is a corner of it (a T-node is listed by the
/// polygon that it is straight in). The arrays of vertices have one entry per vertex.
struct CoarseMesh {
    std::vector<Point3> points;
    std::vector<VertexKind> kinds;
    std::vector<Index> curves;         ///< the feature curve of crease and boundary vertices; no_index for the others
    std::vector<SurfacePlace> places;  ///< where on the input the vertex belongs; its point may be off the surface
    std::vector<Index> corners;
    std::vector<Index> offsets{0};
    std::vector<FeatureEdge> feature_edges;  ///< sides of polygons that cover the feature curves of the input
    std::vector<Index> parents;              ///< per polygon: the face of the graph that it is a piece of; or empty

    std::vector<std::array<Index, 2>> joined;  ///< parents of which a polygon covers parts in common

    std::size_t polygon_count() const { return offsets.size() - 1; }
    std::span<const Index> polygon(std::size_t i) const {
        return {corners.data() + offsets[i], static_cast<std::size_t>(offsets[i + 1] - offsets[i])};
    }
    Index add_vertex(const Point3& point, const SurfacePlace& place, VertexKind kind = VertexKind::smooth,
                     Index curve = no_index) {
        points.push_back(point);
        kinds.push_back(kind);
        curves.push_back(curve);
        places.push_back(place);
        return static_cast<Index>(points.size() - 1);
    }
    void add_polygon(std::span<const Index> ring, Index parent = no_index) {
        corners.insert(corners.end(), ring.begin(), ring.end());
        offsets.push_back(static_cast<Index>(corners.size()));
        parents.push_back(parent);
    }
    Index parent(std::size_t i) const { return i < parents.size() ? parents[i] : no_index; }
    /// A copy without polygons.
    CoarseMesh without_polygons() const {
        CoarseMesh copy = *this;
        copy.corners.clear(), copy.offsets.assign(1, 0), copy.parents.clear();
        return copy;
    }
};

/// Marks, besides those that are, all vertices of polygons with a marked one.
inline void mark_around(const CoarseMesh& mesh, std::vector<std::uint8_t>& is_marked) {
    const std::vector<std::uint8_t> before = is_marked;
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        const auto corners = mesh.polygon(q);
        if (std::any_of(corners.begin(), corners.end(), [&](Index v) { return before[v] != 0; }))
            for (const Index v : corners) is_marked[v] = 1;
    }
}

}  // namespace certa::remeshing
