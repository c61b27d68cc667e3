#pragma once
// The link of a vertex: L, the part of a small sphere around it that lies inside the solid.
#include "curvature/surface.h"

namespace certa::curvature {

/// True when the faces at the vertex are closed up and consistently oriented, so that L makes sense.
bool has_solid_link(const Surface& surface, Index vertex);

/// chi(L). The integral of mu over the sphere is 4 pi - 2 pi chi(L) - perimeter(L), the perimeter being the sum of the
/// angles of the faces; for one fan around the vertex chi(L) = 1 and this is the angle defect.
int link_characteristic(const Surface& surface, Index vertex);

/// chi of the part of L with x . h >= 0.
int upper_link_characteristic(const Surface& surface, Index vertex, const Point3& h);

}  // namespace certa::curvature
