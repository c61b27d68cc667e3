#pragma once
// From a point to a segment.
#include <algorithm>

#include "core/vector3.h"

namespace certa::remeshing {

inline double distance_to_segment(const Point3& p, const Point3& a, const Point3& b) {
    const Point3 d = b - a;
    const double length = dot(d, d), s = length > 0.0 ? std::clamp(dot(p - a, d) / length, 0.0, 1.0) : 0.0;
    return norm(p - a - s * d);
}

}  // namespace certa::remeshing
