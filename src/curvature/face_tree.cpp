// Hierarchical accumulation: a ball that contains a node's box takes the node's sums whole (docs/curvature.md).
//
// The faces are sorted along a space-filling curve already, so halving their range makes compact boxes without another
// sort. Sums are built bottom-up in a fixed order.
#include "curvature/face_tree.h"

#include <algorithm>

namespace certa::curvature {
namespace {

void add_sums(Sums& sums, const Sums& other) {
    add(sums.swapped, 1.0, other.swapped);
    add(sums.plain, 1.0, other.plain);
    sums.area += other.area, sums.gaussian += other.gaussian;
    sums.edge_mass += other.edge_mass, sums.vertex_mass += other.vertex_mass;
}

class Builder {
public:
    Builder(const Surface& surface, const Cells& cells, FaceTree& tree)
        : surface_(surface), cells_(cells), tree_(tree) {
        tree_.owns_corner.resize(surface.faces.size());
        for (std::size_t f = 0; f < surface.faces.size(); ++f)
            for (std::size_t i = 0; i < 3; ++i)
                tree_.owns_corner[f][i] = surface.vertex_faces[surface.faces[f][i]].front() == f;
    }

    Index build(Index first, Index last) {
        const auto id = static_cast<Index>(tree_.nodes.size());
        tree_.nodes.emplace_back();
        tree_.sums.emplace_back();
        FaceTree::Node node;
        node.first = first, node.last = last;
        if (last - first <= FaceTree::leaf_size) {
            fill_leaf(node, tree_.sums[id]);
        } else {
            const Index middle = first + (last - first) / 2;
            node.left = build(first, middle);
            node.right = build(middle, last);
            const FaceTree::Node &l = tree_.nodes[node.left], &r = tree_.nodes[node.right];
            node.low = {std::min(l.low.x, r.low.x), std::min(l.low.y, r.low.y), std::min(l.low.z, r.low.z)};
            node.high = {std::max(l.high.x, r.high.x), std::max(l.high.y, r.high.y), std::max(l.high.z, r.high.z)};
            add_sums(tree_.sums[id], tree_.sums[node.left]);
            add_sums(tree_.sums[id], tree_.sums[node.right]);
        }
        tree_.nodes[id] = node;
        return id;
    }

private:
    void fill_leaf(FaceTree::Node& node, Sums& sums) {
        node.low = node.high = surface_.positions[surface_.faces[node.first][0]];
        for (Index f = node.first; f < node.last; ++f) {
            for (std::size_t i = 0; i < 3; ++i) {
                const Index v = surface_.faces[f][i];
                const Point3& p = surface_.positions[v];
                node.low = {std::min(node.low.x, p.x), std::min(node.low.y, p.y), std::min(node.low.z, p.z)};
                node.high = {std::max(node.high.x, p.x), std::max(node.high.y, p.y), std::max(node.high.z, p.z)};
                if (tree_.owns_corner[f][i]) {
                    sums.gaussian += surface_.defects[v];
                    sums.vertex_mass += cells_.remainders[v].vertex_mass;
                }
                const Hinge& hinge = surface_.hinges[surface_.face_hinges[f][i]];
                if (hinge.left != f || hinge.angle == 0.0) continue;
                const EdgeTensors tensors = hinge_tensors(surface_, hinge);
                add(sums.swapped, hinge.length, tensors.swapped);
                add(sums.plain, hinge.length, tensors.plain);
                sums.edge_mass += hinge.length * std::abs(hinge.angle);
            }
            sums.area += surface_.face_geometry[f].area;
        }
    }

    const Surface& surface_;
    const Cells& cells_;
    FaceTree& tree_;
};

}  // namespace

FaceTree build_face_tree(const Surface& surface, const Cells& cells) {
    FaceTree tree;
    if (surface.faces.empty()) return tree;
    const std::size_t leaves = surface.faces.size() / (FaceTree::leaf_size / 2) + 2;
    tree.nodes.reserve(2 * leaves);
    tree.sums.reserve(2 * leaves);
    Builder(surface, cells, tree).build(0, static_cast<Index>(surface.faces.size()));
    return tree;
}

std::array<double, 2> squared_distances(const FaceTree::Node& box, const Point3& p) {
    const auto axis = [](double low, double high, double x) {
        const double near = std::max({low - x, x - high, 0.0}), far = std::max(x - low, high - x);
        return std::array<double, 2>{near * near, far * far};
    };
    const auto x = axis(box.low.x, box.high.x, p.x), y = axis(box.low.y, box.high.y, p.y);
    const auto z = axis(box.low.z, box.high.z, p.z);
    return {x[0] + y[0] + z[0], x[1] + y[1] + z[1]};
}

}  // namespace certa::curvature
