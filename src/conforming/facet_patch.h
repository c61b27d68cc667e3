#pragma once
// One facet in its plane: its triangulation over what lies on it now, and which triangles the mesh misses.
#include <cstdint>
#include <span>
#include <vector>

#include "conforming/mesh_state.h"
#include "delaunay/planar.h"

namespace certa::conforming {

class FacetPatch {
public:
    enum class State : std::uint8_t {
        complete,  ///< every triangle is a face of the mesh; `triangles` is what the facet consists of
        missing,
        invalid,  ///< its sides cross in its plane up to rounding
    };

    /// Lays the facet out, triangulates it, and adopts the mesh's choice where points lie on one circle.
    /// With `gabriel`, a triangle with a vertex inside its diametral ball counts as missing.
    State build(const MeshState& mesh, std::uint32_t facet, bool gabriel);

    struct Missing {
        std::uint32_t triangle = 0;
        double radius = 0.0;
        delaunay::PlanarPoint center;
    };

    std::uint32_t facet = 0;
    std::vector<std::uint32_t> vertices;        ///< mesh vertex of each planar point
    std::vector<delaunay::PlanarPoint> points;  ///< in the facet's frame
    std::vector<std::uint32_t> pieces;          ///< parallel to `edges`
    std::vector<delaunay::PlanarEdge> edges;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< over planar points, counter-clockwise
    std::vector<delaunay::FaceHandle> faces;              ///< parallel to `triangles`; null where missing
    std::vector<Missing> missing;                         ///< largest radius first

    /// The face of the mesh that a triangle over planar points is; with `gabriel` only if its diametral ball is empty.
    delaunay::FaceHandle find_present(const std::array<std::uint32_t, 3>& triangle, bool gabriel) const;

    Point3 lift(const delaunay::PlanarPoint& p) const;
    delaunay::PlanarPoint flatten(const Point3& p) const;

private:
    const MeshState* mesh_ = nullptr;
    const Frame* frame_ = nullptr;

    void collect(const MeshState& mesh);
    bool tile_triangle(bool gabriel);
    std::vector<std::uint8_t> sides_of(const std::vector<std::uint32_t>& ring) const;
    void settle_ties(const std::vector<std::array<std::uint32_t, 3>>& neighbors, bool gabriel);
};

/// Circumcentre and radius in the plane; radius infinity for points on a line.
FacetPatch::Missing circumscribe(const delaunay::PlanarPoint& a, const delaunay::PlanarPoint& b,
                                 const delaunay::PlanarPoint& c);

}  // namespace certa::conforming
