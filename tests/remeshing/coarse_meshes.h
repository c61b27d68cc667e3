#pragma once
// From the tests' polygon meshes to coarse meshes, and back.
#include <certa/mesh.h>

#include "remeshing/coarse_mesh.h"
#include "verify/surfaces.h"

namespace certa::remeshing {

inline CoarseMesh coarse_mesh(const PolygonMesh& mesh) {
    CoarseMesh coarse;
    for (const Point3& p : mesh.positions) coarse.add_vertex(p, {});
    for (std::size_t q = 0; q + 1 < mesh.offsets.size(); ++q) {
        std::vector<Index> ring;
        for (std::uint32_t i = mesh.offsets[q]; i < mesh.offsets[q + 1]; ++i) ring.push_back(index_of(mesh.corners[i]));
        coarse.add_polygon(ring);
    }
    return coarse;
}
inline PolygonMesh polygon_mesh(const CoarseMesh& coarse) {
    PolygonMesh mesh;
    mesh.positions = coarse.points;
    mesh.offsets = coarse.offsets;
    for (const Index v : coarse.corners) mesh.corners.push_back(VertexId{v});
    return mesh;
}

}  // namespace certa::remeshing
