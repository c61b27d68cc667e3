#pragma once
// Triangles of the input in place of faces of the graph: what is left to do where no polygon will.
#include <optional>

#include "core/triangle_tree.h"
#include "remeshing/polygons.h"
#include "remeshing/region_mesh.h"

namespace certa::remeshing {

/// A graph and the polygons made of it.
struct Layout {
    const Network& network;
    const Graph& graph;
    const std::vector<std::vector<Index>>& faces;
    const std::vector<Index>& nodes;  ///< of the graph, per vertex of the polygons; vertices beyond have none
};

/// What replaces the faces of a region. Corners below `outer.size()` are vertices of the polygons around it, in the
/// order of `outer`; the others those of `inner`.
struct RegionPatch {
    std::vector<Index> outer;
    std::vector<RegionVertex> inner;
    std::vector<std::array<Index, 3>> triangles;
    std::vector<FeatureEdge> feature_edges;  ///< between corners
};

/// The polygons as triangles, to find the one below a point.
struct Ground {
    explicit Ground(const CoarseMesh& mesh);
    const CoarseMesh& polygons;
    std::vector<Index> faces;  ///< per triangle: of the graph
    core::TriangleTree tree;
};

class RegionPatcher {
public:
    explicit RegionPatcher(const Layout& layout);

    /// The pieces of the work mesh's triangles that lie well inside the faces, and a strip between them and the sides
    /// of the polygons around. Nothing where that is no ring: then the region has to grow.
    ///
    /// Guarantee: the patch has the topology of the region. Its shape has to be judged.
    /// `clearance`: how far it keeps from those sides, in sides.
    std::optional<RegionPatch> make(const Ground& ground, const std::vector<Index>& faces, double clearance);
    /// Faces that share a node with some of these, and these.
    std::vector<Index> grow(const std::vector<Index>& faces) const;
    /// Whether all faces of the components that these lie in are there.
    bool is_whole(const std::vector<Index>& faces) const;
    Index face_count() const { return static_cast<Index>(layout_.faces.size()); }
    const std::vector<Index>& faces_at(Index node) const { return node_faces_[node]; }
    Index face_beside(Index halfedge) const { return owners_[halfedge]; }

private:
    enum State : std::uint8_t { unknown, inside, outside, border };
    struct Mark {
        Index edge = no_index;
        double t = 0.0;
        bool inside_high = false;
    };
    using Loop = std::vector<Index>;

    std::optional<std::vector<Loop>> find_outer_loops(const CoarseMesh& polygons, std::int64_t& characteristic) const;
    void mark_border();
    Complex crossing_in_plane(Index crossing, Index face) const;
    void mark_line(Index halfedge);
    void mark_curve(Index halfedge);
    void seed();
    void flood();
    RegionMesh take_whole_components() const;
    RegionMesh take_inside(double side) const;
    void keep_clear(const Ground& ground, const std::vector<Loop>& outer, double margin, RegionMesh& region) const;
    std::vector<std::array<std::size_t, 3>> find_crease_pairs(const Loop& outer, const Loop& inner,
                                                              const RegionMesh& region, bool& fits) const;
    bool add_strip(const CoarseMesh& polygons, const Loop& outer, const Loop& inner, const RegionMesh& region,
                   const std::vector<Point3>& normals, RegionPatch& patch) const;
    void reset();
    void set(Index vertex, State state) {
        if (states_[vertex] == unknown) touched_.push_back(vertex);
        states_[vertex] = state;
    }

    Layout layout_;
    const WorkMesh& mesh_;
    std::vector<Index> owners_;  ///< per half-edge of the graph: the face to its left
    std::vector<std::vector<Index>> node_faces_;
    std::vector<Index> corner_offsets_, corners_;  ///< of the work mesh, by vertex
    std::vector<std::vector<Index>> component_faces_;
    std::vector<Index> face_components_;

    // Of the region at hand.
    std::vector<std::uint8_t> in_region_;  ///< per face of the graph
    std::vector<Index> region_;
    std::vector<std::uint8_t> states_;  ///< per vertex of the work mesh
    std::vector<Index> touched_;
    std::vector<Mark> marks_;
    std::vector<Index> blocked_edges_, cut_faces_;  ///< sorted
    std::vector<BorderPiece> pieces_;
    std::vector<Reference> seeds_;  ///< beside creases that are border
};

}  // namespace certa::remeshing
