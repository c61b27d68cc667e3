#pragma once
// The bound of Theorem 13, made homogeneous and computable (docs/curvature-bounds.md).
#include "curvature/cells.h"

namespace certa::curvature {

/// Sums over the triangles of a set B (its relative interior) in the surface's units; `holds` tells whether a face is
/// in.
struct BoundTerms {
    double squared_radii = 0.0, rim_radii = 0.0, epsilon = 0.0;  ///< s, sd, largest circumradius
    double area = 0.0, edge_mass = 0.0, vertex_mass = 0.0;       ///< of the normal cycle above B
    double rim_length = 0.0, rim_angle = 0.0;                    ///< of its boundary: segments and arcs
    double diameter = 0.0;                                       ///< largest side
    double steepness = 0.0;  ///< largest (4 / str + 2) times the diameter over triangles
};
template <class Holds>
BoundTerms sum_terms(const Surface& surface, const Cells& cells, const std::vector<Index>& faces, const Holds& holds);

/// Evaluates the bound for a given largest curvature (surface's units) and returns it in the input's units.
ApproximationBound evaluate_bound(const BoundTerms& terms, double max_curvature, bool estimated, int exponent);

struct TriangleShape {
    double circumradius = 0.0, diameter = 0.0, straightness = 0.0;  ///< straightness: the largest sine of an angle
};
TriangleShape shape_of(const Surface& surface, Index face);

template <class Holds>
BoundTerms sum_terms(const Surface& surface, const Cells& cells, const std::vector<Index>& faces, const Holds& holds) {
    constexpr std::array<std::size_t, 3> next{1, 2, 0}, previous{2, 0, 1};
    BoundTerms terms;
    const auto on_border = [&](Index v) {
        for (const Index f : surface.vertex_faces[v])
            if (!holds(f)) return true;
        return (surface.flags[v] & (vertex_flags::border | vertex_flags::excluded)) != 0;
    };
    for (const Index f : faces) {
        const TriangleShape shape = shape_of(surface, f);
        const auto& corners = surface.faces[f];
        terms.squared_radii += shape.circumradius * shape.circumradius;
        terms.epsilon = std::max(terms.epsilon, shape.circumradius);
        terms.area += surface.face_geometry[f].area;
        terms.diameter = std::max(terms.diameter, shape.diameter);
        terms.steepness = std::max(terms.steepness, (4.0 / shape.straightness + 2.0) * shape.diameter);
        const std::array<bool, 3> border{on_border(corners[0]), on_border(corners[1]), on_border(corners[2])};
        if (border[0] || border[1] || border[2]) terms.rim_radii += shape.circumradius;
        for (std::size_t i = 0; i < 3; ++i) {
            const Index h = surface.face_hinges[f][i];
            const Hinge& hinge = surface.hinges[h];
            const Index across = surface.across(f, h);
            if (across == no_index || !holds(across)) {
                terms.rim_length += hinge.length;
            } else if (hinge.left == f) {
                terms.edge_mass += hinge.length * std::abs(hinge.angle);
                if (border[next[i]]) terms.rim_angle += std::abs(hinge.angle);
                if (border[previous[i]]) terms.rim_angle += std::abs(hinge.angle);
            }
            // Interior vertices once: from their first face.
            if (!border[i] && surface.vertex_faces[corners[i]].front() == f)
                terms.vertex_mass += cells.remainders[corners[i]].vertex_mass;
        }
    }
    return terms;
}

}  // namespace certa::curvature
