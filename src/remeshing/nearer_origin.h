#pragma once
// Surfaces far away from the origin, moved to it.
#include <certa/remeshing.h>

#include <optional>

namespace certa::remeshing {

/// A point of the surface that can be subtracted from all others without rounding; nothing where the surface is not far
/// from the origin, compared with its size, or has coordinates that are no numbers.
///
/// Errors: InputError where it is so far away that little is left of its shape.
std::optional<Point3> far_origin(const TriangleMesh& mesh);

/// `remesh` of the surface moved by -origin, and moved back. Errors name places of the surface as it was given.
RemeshResult remesh_near_origin(const TriangleMesh& mesh, const Point3& origin, const RemeshOptions& options,
                                const RunControl& control);

}  // namespace certa::remeshing
