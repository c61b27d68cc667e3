#pragma once
// The bound of Theorem 13, made homogeneous and computable (docs/curvature-bounds.md has the proof).
#include "curvature/cells.h"

namespace certa::curvature {

/// What the bound needs of a triangle, whatever the curvature.
struct TriangleShape {
    double circumradius = 0.0;      ///< infinite without area
    double containing = 0.0;        ///< radius of the smallest circle around it
    double covering = 0.0;          ///< largest distance of its points from the nearest corner
    std::array<double, 3> tilts{};  ///< the sine of the angle between normals at corner i is at most K times this
    std::array<double, 3> sides{};  ///< opposite corner i
};
std::vector<TriangleShape> build_shapes(const Surface& surface, const RunControl& control);

/// What follows for a triangle inscribed in a surface whose principal curvatures are at most kappa.
struct TriangleBound {
    bool holds = false;    ///< kappa covering <= 1/2 and sine < 1; else the rest is meaningless
    double height = 0.0;   ///< distance from the surface
    double stretch = 1.0;  ///< largest factor of the projection, 1 / (1 - kappa height)
    double bend = 0.0;     ///< K = kappa stretch: largest second derivative of the distance on the triangle
    double sine = 0.0;     ///< of the largest angle between the normals anywhere on the triangle
    std::array<double, 3> sines{}, middles{};  ///< at corner i; along the side opposite
};
TriangleBound bound_triangle(const TriangleShape& shape, double kappa);

/// Adds up the bound over a set B of faces (its relative interior), in the surface's units.
class BoundSum {
public:
    BoundSum(const Surface& surface, const Cells& cells, const std::vector<TriangleShape>& shapes, double kappa)
        : surface_(surface), cells_(cells), shapes_(shapes), kappa_(kappa) {}

    /// `faces`: those of B; `holds` tells whether a face is in B.
    template <class Holds>
    void add_region(const std::vector<Index>& faces, const Holds& holds);

    /// In the input's units.
    ApproximationBound result(bool estimated) const;

private:
    TriangleBound bound_of(Index face) const { return bound_triangle(shapes_[face], kappa_); }
    std::size_t corner_of(Index face, Index vertex) const {
        const auto& corners = surface_.faces[face];
        return corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
    }
    void add_face(const TriangleShape& shape, const TriangleBound& bound, double area);
    void add_inner_edge(Index h, const std::array<bool, 2>& ends_on_border);
    void add_rim_edge(const TriangleBound& bound, std::size_t side, double length);
    void add_inner_vertex(Index vertex);

    const Surface& surface_;
    const Cells& cells_;
    const std::vector<TriangleShape>& shapes_;
    double kappa_;
    double gaussian_ = 0.0, mean_ = 0.0, tensor_ = 0.0, swapped_ = 0.0;
    bool holds_ = true;
    double squared_radii_ = 0.0, rim_radii_ = 0.0, epsilon_ = 0.0, diameter_ = 0.0, height_ = 0.0, sine_ = 0.0;
    double area_ = 0.0, edge_mass_ = 0.0, vertex_mass_ = 0.0, rim_length_ = 0.0, rim_angle_ = 0.0;
};

template <class Holds>
void BoundSum::add_region(const std::vector<Index>& faces, const Holds& holds) {
    constexpr std::array<std::size_t, 3> next{1, 2, 0}, previous{2, 0, 1};
    const auto on_border = [&](Index v) {
        for (const Index f : surface_.vertex_faces[v])
            if (!holds(f)) return true;
        return (surface_.flags[v] & (vertex_flags::border | vertex_flags::excluded)) != 0;
    };
    for (const Index f : faces) {
        const auto& corners = surface_.faces[f];
        const TriangleBound bound = bound_of(f);
        add_face(shapes_[f], bound, surface_.face_geometry[f].area);
        const std::array<bool, 3> border{on_border(corners[0]), on_border(corners[1]), on_border(corners[2])};
        if (border[0] || border[1] || border[2]) rim_radii_ += shapes_[f].circumradius;
        for (std::size_t i = 0; i < 3; ++i) {
            const Index h = surface_.face_hinges[f][i];
            const Hinge& hinge = surface_.hinges[h];
            const Index across = surface_.across(f, h);
            if (across == no_index || !holds(across))
                add_rim_edge(bound, i, hinge.length);
            else if (hinge.left == f)
                add_inner_edge(h, {border[next[i]], border[previous[i]]});
            // Inner vertices once: from their first face.
            if (!border[i] && surface_.vertex_faces[corners[i]].front() == f) add_inner_vertex(corners[i]);
        }
    }
}

}  // namespace certa::curvature
