#pragma once
// Distances in extended precision: only for tolerances, never for decisions about topology. The exponent range of long
// double (or, where that is double, scaling) keeps every finite input from overflowing.
#include <certa/types.h>

#include "verify/predicates.h"

namespace certa::verify {

/// Distance of p from the segment ab.
double distance_to_segment(const Point3& p, const Point3& a, const Point3& b);

/// The plane through the mean of a facet's corners with Newell's normal.
class FacetPlane {
public:
    FacetPlane(const std::vector<Point3>& corners, const NewellNormal& normal);
    /// Infinite when the normal is zero.
    double distance(const Point3& p) const;

private:
    Vec<long double> origin_{}, normal_{};
};

}  // namespace certa::verify
