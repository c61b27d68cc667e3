#pragma once
// What a triangle mesh is, counted from its triangles alone: the oracle for results with certified topology.
#include <certa/mesh.h>

#include <string>
#include <vector>

namespace certa::test {

struct MeshTopology {
    std::string flaw;          ///< empty: closed, oriented, every edge in two triangles, every link one cycle
    std::vector<int> genera;   ///< per component, sorted
    double signed_volume = 0;  ///< positive when faces look outwards
    double longest_edge = 0;
};

MeshTopology measure(const TriangleMesh& mesh);

}  // namespace certa::test
