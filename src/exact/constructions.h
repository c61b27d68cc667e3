#pragma once
// Points of intersection, computed exactly and rounded once.
#include <certa/types.h>

#include <array>
#include <optional>

namespace certa::exact {

/// Where the line through a and b meets the plane through p, q, r; nothing when it is parallel to it.
std::optional<Point3> line_plane_point(const Point3& a, const Point3& b, const Point3& p, const Point3& q,
                                       const Point3& r);

/// Where the lines (a, b) and (c, d), which lie in one plane, meet; nothing when they are parallel.
std::optional<Point3> line_line_point(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

}  // namespace certa::exact
