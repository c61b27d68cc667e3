#pragma once
// The certificate of a decided surface: everything that an independent program needs to verify it.
#include <certa/implicit.h>

#include <optional>
#include <string>
#include <vector>

#include "implicit/growth.h"
#include "implicit/surface.h"

namespace certa::implicit {

/// JSON as docs/formats.md describes it: function, digest of the mesh that it is for, grid, octree with what is claimed
/// of each leaf, signs that no leaf gives, the order of marks, the edges that carry the mesh's vertices, components.
std::string write_certificate(const Expression& function, const Octree& tree, const Triangulation& triangulation,
                              const Growth& growth, const Surface& surface, const TriangleMesh& mesh,
                              const std::vector<ImplicitComponent>& components,
                              std::optional<double> hausdorff = std::nullopt);

/// The certificates of the factors of a product whose meshes follow each other in one mesh.
std::string write_product_certificate(const std::vector<const ImplicitResult*>& factors);

}  // namespace certa::implicit
