#pragma once
// The input itself in place of faces of the graph: what is left to do where no polygon will.
#include <optional>
#include <span>

#include "remeshing/merge_ends.h"
#include "remeshing/polygons.h"

namespace certa::remeshing {

/// In order, each once.
void sort_unique(std::vector<Index>& list);

/// A graph and the polygons made of it.
struct Layout {
    const Network& network;
    const Graph& graph;
    const std::vector<std::vector<Index>>& faces;
    const std::vector<Index>& nodes;          ///< of the graph, per vertex of the polygons; vertices beyond have none
    const std::vector<MergedVertex>& merged;  ///< vertices whose nodes belong to others
    const std::vector<Index>& open;           ///< faces that are no disks or meet themselves, sorted: never polygons
    std::span<const Index> filled{};          ///< those of them that have triangles already, sorted, all of a patch
};

struct RegionVertex {
    Point3 point;
    SurfacePlace place;
    VertexKind kind = VertexKind::smooth;
    Index curve = no_index;
    Index source = no_index;  ///< vertex of the work mesh, where it is one
    bool on_minor_edge = false;
};

/// One side of a region between two nodes, cut where it passes edges of the input.
struct RegionSide {
    std::vector<Index> corners;  ///< of the patch, as the region walks it; the ends are outer
    Index curve = no_index;      ///< where it is a crease or boundary
};

/// What replaces the faces of a region. Corners below `outer.size()` are vertices of the polygons around it, in the
/// order of `outer`; the others those of `inner`.
struct RegionPatch {
    std::vector<Index> outer;
    std::vector<RegionVertex> inner;
    std::vector<std::array<Index, 3>> triangles;
    std::vector<FeatureEdge> feature_edges;         ///< between corners, not those on sides
    std::vector<std::array<Index, 2>> minor_edges;  ///< likewise: creases too short to be curves
    std::vector<RegionSide> sides;
};

/// Names for what a cut meets.
struct CutNames {
    std::vector<Index> vertices;          ///< of the polygons, per node of the graph
    std::vector<std::uint8_t> is_merged;  ///< per node: its vertex is that of another node, its own place is not wanted
    std::vector<std::uint8_t> is_minor;   ///< per edge of the work mesh
};

/// V - E + F.
std::int64_t characteristic_of(const RegionPatch& patch);

class RegionPatcher {
public:
    explicit RegionPatcher(const Layout& layout);

    /// The surface of the work mesh inside the faces, cut along their rim; exactly the input as long as outer corners
    /// are the graph's nodes. Nothing where the rim touches itself, or is an island in one triangle: then the region
    /// has to grow.
    ///
    /// Guarantee: the patch has the topology of the region.
    std::optional<RegionPatch> make(const std::vector<Index>& faces) const;
    /// Faces that share a node with some of these, and these.
    std::vector<Index> grow(const std::vector<Index>& faces) const;
    /// The fewest more that a region without a patch may need: those at nodes where the rim touches itself, else those
    /// all around.
    std::vector<Index> grow_for_patch(const std::vector<Index>& faces) const;
    /// Whether all faces of the components that these lie in are there.
    bool is_whole(const std::vector<Index>& faces) const;
    Index face_count() const { return static_cast<Index>(layout_.faces.size()); }
    const std::vector<Index>& faces_at(Index node) const { return node_faces_[node]; }
    Index face_beside(Index halfedge) const { return owners_[halfedge]; }

private:
    /// Half-edges with the region on the left, and the nodes that more than one of them starts from.
    std::vector<Index> rim_of(const std::vector<Index>& faces) const;
    std::vector<Index> pinches(const std::vector<Index>& rim) const;
    std::int64_t characteristic(const std::vector<Index>& faces) const;

    Layout layout_;
    const WorkMesh& mesh_;
    std::vector<Index> owners_;  ///< per half-edge of the graph: the face to its left
    CutNames names_;
    std::vector<std::vector<Index>> node_faces_;
    std::vector<std::vector<Index>> component_faces_;
    std::vector<Index> face_components_;
};

/// All of the work mesh, without a graph.
RegionPatch take_all(const WorkMesh& mesh);
/// Whole components of it, by their triangles.
RegionPatch take_part(const WorkMesh& mesh, std::span<const Index> triangles);

}  // namespace certa::remeshing
