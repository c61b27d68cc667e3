#pragma once
// What the two halves of compute_info share.
#include <certa/info.h>

namespace certa::mesh {

TetrahedraInfo compute_tetrahedra_info(const MeshDocument& document);

}  // namespace certa::mesh
