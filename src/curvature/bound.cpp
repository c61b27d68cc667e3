// Theorem 13 in numbers (thesis, 2.1.3, 3.3; docs/curvature-bounds.md has the derivation).
//
// Lengths are taken in units of 1 / kappa, kappa the largest principal curvature of the smooth surface: then sup(1,
// |h|) is 1 in Theorem 25 and both sides have no unit. delta <= diameter (Lemma 28), sin alpha <= (4 / str + 2) pi_M
// where pi_M = diameter * kappa <= 1/2 (Lemma 29), masses are those of the mesh itself. The flat norm becomes a bound
// on each measure by the norms of its form and of the form's derivative.
#include "curvature/bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace certa::curvature {
namespace {

// Largest of the norms of the form (linear in the normal inside the unit ball) and of its derivative:
// n . (dn x dn) / 2 has derivative 3 dn1 dn2 dn3; the swapped one X . dp (n x Y) . dn has 2 det(dn, Y, dn) X . dp / 2
// of norm 2; the plain one has a derivative with two terms of size 1; the mean measure is a trace of three plain
// entries.
constexpr double gaussian_norm = 3.0, swapped_norm = 2.0, plain_norm = std::numbers::sqrt2;
constexpr double mean_norm = 3.0 * std::numbers::sqrt2;
/// The largest ratio of error to kappa (kappa s + sd) epsilon over rings of random tori and spheres was 0.83, for
/// single rings of a regular sphere (bench/curvature_bound.cpp).
constexpr double calibrated_constant = 3.0;

}  // namespace

TriangleShape shape_of(const Surface& surface, Index face) {
    const auto& v = surface.faces[face];
    std::array<double, 3> sides{distance(surface.positions[v[1]], surface.positions[v[2]]),
                                distance(surface.positions[v[2]], surface.positions[v[0]]),
                                distance(surface.positions[v[0]], surface.positions[v[1]])};
    TriangleShape shape;
    shape.diameter = std::max({sides[0], sides[1], sides[2]});
    for (const double angle : surface.face_angles[face])
        shape.straightness = std::max(shape.straightness, std::sin(angle));
    const double area = surface.face_geometry[face].area;
    shape.circumradius =
        area > 0.0 ? sides[0] * sides[1] * sides[2] / (4.0 * area) : std::numeric_limits<double>::infinity();
    return shape;
}

ApproximationBound evaluate_bound(const BoundTerms& terms, double max_curvature, bool estimated, int exponent) {
    ApproximationBound bound;
    const double kappa = max_curvature;
    bound.squared_radii = std::ldexp(terms.squared_radii, 2 * exponent);
    bound.rim_radii = std::ldexp(terms.rim_radii, exponent);
    bound.epsilon = std::ldexp(terms.epsilon, exponent);
    bound.max_curvature = std::ldexp(kappa, -exponent);
    bound.curvature_estimated = estimated;
    bound.mass = kappa * kappa * terms.area + kappa * terms.edge_mass + terms.vertex_mass;
    bound.rim_mass = kappa * terms.rim_length + terms.rim_angle;
    bound.relative_height = kappa * terms.diameter;
    const double sine = kappa * terms.steepness;
    bound.hypothesis_holds = bound.relative_height <= 0.5 && sine <= 1.0;
    bound.calibrated = std::ldexp(
        calibrated_constant * kappa * (kappa * terms.squared_radii + terms.rim_radii) * terms.epsilon, exponent);
    if (!bound.hypothesis_holds) return bound;
    const double delta = bound.relative_height, shrink = 1.0 / (1.0 - delta);
    const double flat = std::max(delta, std::asin(sine)) * shrink * shrink * (bound.mass + bound.rim_mass);
    bound.gaussian = gaussian_norm * flat;
    bound.mean = mean_norm * flat / bound.max_curvature;
    bound.tensor = plain_norm * flat / bound.max_curvature;
    bound.swapped_tensor = swapped_norm * flat / bound.max_curvature;
    return bound;
}

}  // namespace certa::curvature
