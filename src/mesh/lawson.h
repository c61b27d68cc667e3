#pragma once
// Incremental Delaunay triangulation of closed surfaces in charts: flat tori and the sphere.
#include <certa/mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace certa::generators {

/// A vertex, in a frame that is translated by whole periods (flat tori; 0 elsewhere).
struct Corner {
    std::uint32_t vertex = 0;
    std::int32_t dx = 0, dy = 0;
};

/// What the triangulation asks: the side of an edge, and whether an edge fails to be Delaunay.
class Chart {
public:
    virtual ~Chart() = default;
    /// Positive when p is to the left of the edge from a to b.
    virtual double side(const Corner& a, const Corner& b, const Corner& p) const = 0;
    /// True when d lies inside the circumcircle of (a, b, c), counter-clockwise.
    virtual bool in_circle(const Corner& a, const Corner& b, const Corner& c, const Corner& d) const = 0;
};

/// Triangles with the half-edge opposite each corner; half-edge 3 t + i is opposite corner i of triangle t.
struct Triangulation {
    std::vector<std::array<Corner, 3>> triangles;
    std::vector<std::uint32_t> twins;
};

/// The Delaunay triangulation of vertices 0 ... count - 1, starting from a valid triangulation of some of them.
///
/// `order` lists the vertices that `start` lacks; neighbours in it should be close to each other. Points in general
/// position, such as random ones: predicates are evaluated in doubles.
Triangulation triangulate_by_flips(Triangulation start, const std::vector<std::uint32_t>& order, const Chart& chart);

/// The flat torus with periods `width` and `height`; x in [0, width), y in [0, height).
Triangulation triangulate_flat_torus(const std::vector<std::array<double, 2>>& points, double width, double height);

/// Points of the unit sphere (Delaunay there is the convex hull); at least four, around the centre.
Triangulation triangulate_sphere(const std::vector<Point3>& points);

}  // namespace certa::generators
