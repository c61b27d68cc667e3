#pragma once
// A peer for curvature_speed, in the same run on the same mesh: CGAL's Monge_via_jet_fitting where CMake found it.
// Nothing of the product depends on it.
#include <certa/mesh.h>

#include <string>

struct PeerRun {
    std::string name;
    double seconds = 0.0;  ///< CPU time of collecting two rings and fitting, all vertices
    double mean_k_max = 0.0;
};

/// False where the benchmarks were built without a peer.
bool run_peer(const certa::TriangleMesh& mesh, PeerRun& run);
