#pragma once
// Shells: the closed pieces of the boundary of a tetrahedral mesh, faces being joined across the unmeshed side of their
// common edges.
#include "verify/subject.h"

namespace certa::verify {

/// Corners of a face, counter-clockwise from outside its tetrahedron.
std::array<Point3, 3> face_points(const Subject& subject, HalfFace h);
std::vector<Shell> collect_shells(const Subject& subject, const Domain& domain);
/// Winding number of a shell around p, which must not lie on it, from the faces above p.
int winding_of(const Subject& subject, const Domain& domain, const Shell& shell, const Point3& p);
/// Whether `a` encloses less than `b`, both of one sign.
bool is_smaller(const Subject& subject, const Domain& domain, const Shell& a, const Shell& b);

inline bool is_in_box(const Point3& p, const Point3& low, const Point3& high) {
    return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y && low.z <= p.z && p.z <= high.z;
}

}  // namespace certa::verify
