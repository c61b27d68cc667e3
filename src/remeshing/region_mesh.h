#pragma once
// The triangles of the work mesh in and around a region, cut finer, and which of the pieces lie well inside.
#include <unordered_map>

#include "remeshing/network.h"

namespace certa::remeshing {

/// A piece of the region's border in a triangle, in the triangle's own plane.
struct BorderPiece {
    Index face = no_index;
    bool is_line = false;  ///< else along an edge of the face
    Complex a, b;
};

/// A point of a face whose side of the border is known.
struct Reference {
    Index face = no_index;
    Complex place;
    bool is_inside = false;
};

struct RegionVertex {
    Point3 point;
    SurfacePlace place;
    VertexKind kind = VertexKind::smooth;
    Index curve = no_index;
    Index source = no_index;  ///< vertex of the work mesh, where it is one
};

/// Pieces that the border keeps clear of: a surface with edges in common where the work mesh has them.
struct RegionMesh {
    std::vector<RegionVertex> vertices;
    std::vector<std::array<Index, 3>> triangles;
    std::vector<FeatureEdge> feature_edges;

    /// Open sides, each as its triangle walks it.
    std::vector<std::array<Index, 2>> open_sides() const;
    /// V - E + F.
    std::int64_t characteristic() const;
    /// Keeps the largest connected part, without vertices where it only touches itself. False: nothing is left.
    bool keep_largest_part();
};

/// Cuts each of the faces into `pieces` squared and keeps those with three corners inside, on all references' word, and
/// off the border. `pieces` 1: the faces themselves; without border pieces all are kept.
RegionMesh cut_region(const WorkMesh& mesh, const std::vector<Index>& faces, const std::vector<BorderPiece>& border,
                      const std::vector<Reference>& references, Index pieces);

}  // namespace certa::remeshing
