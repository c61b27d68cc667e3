#pragma once
// Whether a mesh is the surface of sign changes of a complex, exactly.
#include <certa/mesh.h>

#include <string>
#include <vector>

#include "verify/implicit_complex.h"

namespace certa::verify {

/// What is wrong with the mesh: each vertex must lie exactly, strictly inside, on the edge that the certificate names,
/// an edge with both signs; each such edge carries one vertex; in each tetrahedron with both signs the triangles are
/// one disk between its edges' vertices, facing the positive side; there are no others. `either_way`: each connected
/// component of the mesh faces the positive or the negative side.
std::vector<std::string> check_mesh_on_complex(const TriangleMesh& mesh, const ImplicitComplex& complex,
                                               const ImplicitCertificate& certificate, bool either_way = false);

}  // namespace certa::verify
