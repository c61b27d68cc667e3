#pragma once
// `certa check` for surface meshes.
#include <certa/surface_check.h>

#include "session.h"

namespace certa::cli {

/// Checks the polygons of one document against those of another; says and reports what was found.
ExitCode check_surface_mesh(Session& session, const MeshDocument& document, const MeshDocument& against,
                            SurfaceCheckOptions options);

Json to_json(const SurfaceDistance& distance);
Json to_json(const SurfaceCheck& check);

}  // namespace certa::cli
