#pragma once
// A binary tree over the faces in their sorted order, with boxes and sums of what the faces own.
#include "curvature/cells.h"

namespace certa::curvature {

/// A face owns its area, the hinges whose left face it is, and the vertices for which it is the first face.
struct FaceTree {
    static constexpr Index leaf_size = 8;
    struct Node {
        Point3 low, high;
        Index first = 0, last = 0;                ///< faces
        Index left = no_index, right = no_index;  ///< children; none for leaves
    };
    std::vector<Node> nodes;                       ///< the root is node 0; none without faces
    std::vector<Sums> sums;                        ///< per node
    std::vector<std::array<bool, 3>> owns_corner;  ///< per face
};

FaceTree build_face_tree(const Surface& surface, const Cells& cells);

/// Squared distances from a point to a box: nearest and farthest point of it.
std::array<double, 2> squared_distances(const FaceTree::Node& box, const Point3& p);

}  // namespace certa::curvature
