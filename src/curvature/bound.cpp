// Theorem 13 in numbers (thesis, 2.1.3 and 3.3; docs/curvature-bounds.md proves what stands here, step by step).
//
// The surface's signed distance, restricted to a triangle, vanishes at the corners and has second derivatives of at
// most K: that bounds height and tilt of the triangle. The homotopy of the thesis (3.3.2) moves the normal cycle of
// the mesh onto that of the surface; instead of the flat norm's product of suprema, the derivatives of the forms are
// integrated over what is swept, part by part: above faces, edges and vertices, and along the border.
#include "curvature/bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace certa::curvature {
namespace {

/// Single triangles need 2.6; the largest that random regions of spheres, tori and ellipsoids needed was 2.45,
/// interiors of rings 0.83 (tests/curvature/bound_test.cpp, bench/curvature_bound.cpp).
constexpr double calibrated_constant = 3.0;
constexpr std::array<std::size_t, 3> next{1, 2, 0}, previous{2, 0, 1};

/// |n - m| for unit vectors at less than a right angle with this sine.
double chord_of(double sine) { return std::sqrt(2.0 - 2.0 * std::sqrt(std::max(0.0, 1.0 - sine * sine))); }

TriangleShape shape_of(const Surface& surface, Index face) {
    const auto& v = surface.faces[face];
    TriangleShape shape;
    for (std::size_t i = 0; i < 3; ++i)
        shape.sides[i] = distance(surface.positions[v[next[i]]], surface.positions[v[previous[i]]]);
    const double area = surface.face_geometry[face].area;
    const auto& angles = surface.face_angles[face];
    if (!(area > 0.0)) {
        shape.circumradius = std::numeric_limits<double>::infinity();
        shape.tilts.fill(std::numeric_limits<double>::infinity());
        shape.containing = shape.covering = std::max({shape.sides[0], shape.sides[1], shape.sides[2]});
        return shape;
    }
    shape.circumradius = shape.sides[0] * shape.sides[1] * shape.sides[2] / (4.0 * area);
    std::size_t top = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (angles[i] > angles[top]) top = i;
    const double largest = shape.sides[top];
    // Obtuse: the circle on the largest side contains the triangle, and no point is farther than half of that side from
    // the nearest corner.
    const bool obtuse = std::cos(angles[top]) < 0.0;
    shape.containing = shape.covering = obtuse ? 0.5 * largest : shape.circumradius;
    for (std::size_t i = 0; i < 3; ++i) {
        const double b = shape.sides[next[i]], c = shape.sides[previous[i]];
        const double sine = 2.0 * area / (b * c);
        shape.tilts[i] = 0.5 * std::sqrt(b * b + c * c + 2.0 * b * c * std::abs(std::cos(angles[i]))) / sine;
    }
    return shape;
}

}  // namespace

std::vector<TriangleShape> build_shapes(const Surface& surface, const RunControl& control) {
    std::vector<TriangleShape> shapes(surface.faces.size());
    core::parallel_for(shapes.size(), 4096, control, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) shapes[f] = shape_of(surface, static_cast<Index>(f));
    });
    return shapes;
}

TriangleBound bound_triangle(const TriangleShape& shape, double kappa) {
    TriangleBound bound;
    // First by the nearest corner, which lies on the surface; then by the second derivative that follows.
    const double nearest = kappa * shape.covering;
    if (!(nearest <= 0.5)) return bound;
    const double first_bend = kappa / (1.0 - nearest);
    bound.height = std::min(shape.covering, 0.5 * first_bend * shape.containing * shape.containing);
    bound.stretch = 1.0 / (1.0 - kappa * bound.height);
    bound.bend = kappa * bound.stretch;
    double largest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        bound.sines[i] = kappa > 0.0 ? bound.bend * shape.tilts[i] : 0.0;
        largest = std::max(largest, bound.sines[i]);
    }
    for (std::size_t i = 0; i < 3; ++i)
        bound.middles[i] = 0.5 * (bound.sines[next[i]] + bound.sines[previous[i]] + bound.bend * shape.sides[i]);
    bound.sine = largest + bound.bend * shape.covering;
    bound.holds = bound.sine < 1.0 && std::max({bound.middles[0], bound.middles[1], bound.middles[2]}) < 1.0;
    return bound;
}

void BoundSum::add_face(const TriangleShape& shape, const TriangleBound& bound, double area) {
    squared_radii_ += shape.circumradius * shape.circumradius;
    epsilon_ = std::max(epsilon_, shape.circumradius);
    diameter_ = std::max({diameter_, shape.sides[0], shape.sides[1], shape.sides[2]});
    area_ += area;
    height_ = std::max(height_, bound.height), sine_ = std::max(sine_, bound.sine);
    holds_ = holds_ && bound.holds;
    const double a = chord_of(bound.sine), bend = bound.bend, g = bound.stretch;
    const double by_height = bound.height * bend * bend;
    gaussian_ += area * a * bend * bend;
    mean_ += area * (2.0 / 3.0 * by_height + a * bend * (2.0 + 4.0 * g) / 3.0);
    tensor_ += area * (1.0 / 3.0 * by_height + a * bend * (1.0 + 2.0 * g) / 2.0);
    swapped_ += area * (2.0 / 3.0 * by_height + a * bend * (1.0 + 2.0 * g) / 3.0);
}

void BoundSum::add_inner_edge(Index h, const std::array<bool, 2>& ends_on_border) {
    const Hinge& hinge = surface_.hinges[h];
    const double angle = std::abs(hinge.angle), mass = hinge.length * angle;
    const TriangleBound left = bound_of(hinge.left), right = bound_of(hinge.right);
    holds_ = holds_ && left.holds && right.holds;
    const auto side_of = [&](Index f) {
        return surface_.face_hinges[f][0] == h ? std::size_t{0} : surface_.face_hinges[f][1] == h ? 1 : 2;
    };
    const std::size_t i = side_of(hinge.left), j = side_of(hinge.right);
    const double a = chord_of(std::max(left.middles[i], right.middles[j]));
    const TriangleBound& flatter = left.height <= right.height ? left : right;
    edge_mass_ += mass;
    gaussian_ += mass * 0.5 * a * flatter.bend;
    const double length_term = mass * (flatter.height * flatter.bend / 3.0 + a * (2.0 + flatter.stretch) / 3.0);
    mean_ += length_term, tensor_ += length_term, swapped_ += length_term;
    for (std::size_t end = 0; end < 2; ++end) {
        if (!ends_on_border[end]) continue;
        const Index v = surface_.faces[hinge.left][end == 0 ? next[i] : previous[i]];
        rim_angle_ += angle;
        gaussian_ += 0.5 * angle *
                     chord_of(std::max(left.sines[corner_of(hinge.left, v)], right.sines[corner_of(hinge.right, v)]));
    }
}

void BoundSum::add_rim_edge(const TriangleBound& bound, std::size_t side, double length) {
    const double a = chord_of(bound.middles[side]);
    rim_length_ += length;
    gaussian_ += length * 0.5 * a * bound.bend;
    const double length_term = length * 0.5 * (bound.height * bound.bend + a * (1.0 + bound.stretch));
    mean_ += length_term, tensor_ += length_term, swapped_ += length_term;
}

void BoundSum::add_inner_vertex(Index vertex) {
    double sine = 0.0;
    for (const Index f : surface_.vertex_faces[vertex]) sine = std::max(sine, bound_of(f).sines[corner_of(f, vertex)]);
    vertex_mass_ += cells_.remainders[vertex].vertex_mass;
    gaussian_ += chord_of(sine) * cells_.remainders[vertex].vertex_mass;
}

ApproximationBound BoundSum::result(bool estimated) const {
    ApproximationBound bound;
    const int exponent = surface_.exponent;
    bound.squared_radii = std::ldexp(squared_radii_, 2 * exponent);
    bound.rim_radii = std::ldexp(rim_radii_, exponent);
    bound.epsilon = std::ldexp(epsilon_, exponent);
    bound.max_curvature = std::ldexp(kappa_, -exponent);
    bound.curvature_estimated = estimated;
    bound.mass = kappa_ * kappa_ * area_ + kappa_ * edge_mass_ + vertex_mass_;
    bound.rim_mass = kappa_ * rim_length_ + rim_angle_;
    bound.relative_height = kappa_ * diameter_;
    bound.calibrated =
        std::ldexp(calibrated_constant * kappa_ * (kappa_ * squared_radii_ + rim_radii_) * epsilon_, exponent);
    bound.hypothesis_holds = holds_;
    if (!holds_) return bound;
    bound.height = std::ldexp(height_, exponent);
    bound.normal_angle_radians = std::asin(sine_);
    bound.gaussian = gaussian_;
    bound.mean = std::ldexp(mean_, exponent);
    bound.tensor = std::ldexp(tensor_, exponent);
    bound.swapped_tensor = std::ldexp(swapped_, exponent);
    return bound;
}

}  // namespace certa::curvature
