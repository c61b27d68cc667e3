#pragma once
// The triangles of the work mesh inside a rim of half-edges of the graph, cut along it.
#include <optional>
#include <span>
#include <unordered_map>

#include "remeshing/region_patch.h"

namespace certa::remeshing {

/// `rim`: half-edges of the graph with the wanted side on their left, no node twice; or `whole`, faces to take without
/// a rim.
///
/// Guarantee: which pieces lie inside is decided by the order of crossings alone. Nothing where the rim closes within
/// one triangle around what is not wanted, or meets a triangle's corner in a way that says no side.
std::optional<RegionPatch> cut_surface(const Network& network, const Graph& graph, std::span<const Index> rim,
                                       std::span<const Index> whole, const CutNames& names);

/// Tells rims of disks from others.
class DiskTest {
public:
    DiskTest(const Network& network, const Graph& graph);
    /// Whether a face of the graph, which passes no node twice, is a disk with this rim: nothing else of the graph lies
    /// inside, and its characteristic is 1.
    bool operator()(std::span<const Index> rim) const;

private:
    const Network& network_;
    const Graph& graph_;
    CutNames names_;
    std::unordered_map<Index, std::vector<double>> crossings_;  ///< of lines of the graph, per edge of the work mesh
};

}  // namespace certa::remeshing
