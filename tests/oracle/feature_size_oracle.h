#pragma once
// Local feature size by brute force over the definition: no tree, no triangulation, extended precision.
// A facet is its plane and its boundary sides; inside is decided by counting crossings.
#include <cstdint>

#include "conforming/complex.h"

namespace certa::oracle {

using Real = long double;

struct Vec {
    Real x = 0, y = 0, z = 0;
};
Vec vec(const Point3& p);
Vec sub(const Vec& a, const Vec& b);
Vec add(const Vec& a, const Vec& b);
Vec mul(Real s, const Vec& a);
Real dot(const Vec& a, const Vec& b);
Vec cross(const Vec& a, const Vec& b);
Real norm(const Vec& a);
inline Real distance(const Vec& a, const Vec& b) { return norm(sub(a, b)); }

Real distance_to_segment(const Vec& p, const Vec& a, const Vec& b);

/// Even-odd over the boundary sides of a facet, for the projection of p into its plane.
bool is_inside_facet(const conforming::Complex& complex, std::uint32_t facet, const Vec& p);

/// Distance to a facet as a set of points.
Real distance_to_facet(const conforming::Complex& complex, std::uint32_t facet, const Vec& p);

/// Where a point is, combinatorially.
struct Carrier {
    bool is_vertex = true;
    std::uint32_t index = 0;
};

/// Whether a face contains the point, from the given arrays of the complex only (no derived incidences).
bool segment_contains(const conforming::Complex& complex, std::uint32_t segment, const Carrier& carrier);
bool facet_contains(const conforming::Complex& complex, std::uint32_t facet, const Carrier& carrier);

/// Distance from p to the union of the faces that do not contain it.
Real feature_size(const conforming::Complex& complex, const Carrier& carrier, const Vec& p);

}  // namespace certa::oracle
