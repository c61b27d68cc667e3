// Exact balls (thesis, definitions 5 and 7 with B a ball; docs/curvature.md: weights, connected by default, hierarchy).
//
// Connected: breadth-first over faces from the vertex, crossing an edge when it meets the ball; that reaches exactly
// the component of the surface within the ball. Each edge is integrated once, from its left face, each vertex when
// first met. All sheets: a tree of sums; faces of nodes that the sphere cuts are integrated one by one.
#include "curvature/ball.h"

#include <algorithm>

#include "core/parallel.h"

namespace certa::curvature {
namespace {

constexpr std::array<std::size_t, 3> next{1, 2, 0}, previous{2, 0, 1};

struct LocalFace {
    std::array<Point3, 3> points;
    std::array<double, 3> squares;
};

LocalFace local_face(const Surface& surface, const WeightedBall& ball, Index face) {
    LocalFace local;
    for (std::size_t i = 0; i < 3; ++i) {
        local.points[i] = ball.local(surface.positions[surface.faces[face][i]]);
        local.squares[i] = dot(local.points[i], local.points[i]);
    }
    return local;
}

double face_integral(const Surface& surface, const WeightedBall& ball, const LocalFace& local, Index face) {
    const FaceGeometry& geometry = surface.face_geometry[face];
    const double square = ball.radius() * ball.radius();
    return square * ball.over_triangle(local.points, local.squares, geometry.normal, geometry.area / square);
}

/// The side opposite corner i, from its hinge's left face.
void add_hinge(Sums& sums, const BallContext& context, const WeightedBall& ball, const LocalFace& local, Index h,
               std::size_t i) {
    const Hinge& hinge = context.surface.hinges[h];
    if (hinge.angle == 0.0) return;
    const double weight = hinge.length * ball.over_segment(local.points[next[i]], local.squares[next[i]],
                                                           local.points[previous[i]], local.squares[previous[i]]);
    if (weight == 0.0) return;
    add(sums.swapped, weight, context.tensors[h].swapped);
    add(sums.plain, weight, context.tensors[h].plain);
    sums.edge_mass += std::abs(weight * hinge.angle);
}

void add_vertex(Sums& sums, const BallContext& context, const WeightedBall& ball, Index v, double square) {
    const double weight = ball.at(square);
    sums.gaussian += weight * context.surface.defects[v];
    sums.vertex_mass += std::abs(weight) * context.cells.remainders[v].vertex_mass;
}

}  // namespace

std::vector<EdgeTensors> build_hinge_tensors(const Surface& surface, const RunControl& control) {
    std::vector<EdgeTensors> tensors(surface.hinges.size());
    core::parallel_for(tensors.size(), 4096, control, [&](std::size_t begin, std::size_t end) {
        for (std::size_t h = begin; h < end; ++h) tensors[h] = hinge_tensors(surface, surface.hinges[h]);
    });
    return tensors;
}

Sums BallWalker::sum(Index vertex, const Point3& center, double radius, Weight weight) {
    Sums sums;
    const WeightedBall ball(center, radius, weight);
    vertices_.clear(), faces_.clear(), queue_.clear();
    for (const Index f : context_.surface.vertex_faces[vertex])
        if (faces_.mark(f)) queue_.push_back(f);
    for (std::size_t k = 0; k < queue_.size(); ++k) visit(sums, ball, queue_[k]);
    return sums;
}

void BallWalker::visit(Sums& sums, const WeightedBall& ball, Index face) {
    const Surface& surface = context_.surface;
    const LocalFace local = local_face(surface, ball, face);
    sums.area += face_integral(surface, ball, local, face);
    const auto& corners = surface.faces[face];
    for (std::size_t i = 0; i < 3; ++i) {
        const Index v = corners[i];
        if (local.squares[i] <= 1.0 && vertices_.mark(v)) {
            add_vertex(sums, context_, ball, v, local.squares[i]);
            // Sheets that meet in a vertex only.
            if (surface.flags[v] & (vertex_flags::non_manifold | vertex_flags::excluded))
                for (const Index f : surface.vertex_faces[v])
                    if (faces_.mark(f)) queue_.push_back(f);
        }
        const Index h = surface.face_hinges[face][i];
        const Hinge& hinge = surface.hinges[h];
        const Index across = hinge.left == face ? hinge.right : hinge.left;
        if (across == no_index) continue;
        if (hinge.left == face) add_hinge(sums, context_, ball, local, h, i);
        if (faces_.has(across)) continue;
        const std::size_t j = next[i], k = previous[i];
        const bool meets = local.squares[j] <= 1.0 || local.squares[k] <= 1.0;
        const auto part = meets
                              ? std::array<double, 2>{0.0, 1.0}
                              : inside_unit_ball(local.points[j], local.squares[j], local.points[k], local.squares[k]);
        if (part[0] <= part[1]) faces_.mark(across), queue_.push_back(across);
    }
}

Sums SheetWalker::sum(const Point3& center, double radius, Weight weight) {
    Sums sums;
    const WeightedBall ball(center, radius, weight);
    const double square = radius * radius;
    stack_.assign(1, 0);
    while (!stack_.empty()) {
        const Index id = stack_.back();
        stack_.pop_back();
        const FaceTree::Node& node = tree_.nodes[id];
        const auto [near, far] = squared_distances(node, center);
        if (near > square) continue;
        if (far <= square && weight == Weight::indicator) {
            const Sums& whole = tree_.sums[id];
            add(sums.swapped, 1.0, whole.swapped);
            add(sums.plain, 1.0, whole.plain);
            sums.area += whole.area, sums.gaussian += whole.gaussian;
            sums.edge_mass += whole.edge_mass, sums.vertex_mass += whole.vertex_mass;
        } else if (node.left != no_index) {
            stack_.push_back(node.right);
            stack_.push_back(node.left);
        } else {
            for (Index f = node.first; f < node.last; ++f) add_owned(sums, ball, f);
        }
    }
    return sums;
}

void SheetWalker::add_owned(Sums& sums, const WeightedBall& ball, Index face) {
    const Surface& surface = context_.surface;
    const LocalFace local = local_face(surface, ball, face);
    sums.area += face_integral(surface, ball, local, face);
    for (std::size_t i = 0; i < 3; ++i) {
        if (tree_.owns_corner[face][i] && local.squares[i] <= 1.0)
            add_vertex(sums, context_, ball, surface.faces[face][i], local.squares[i]);
        const Index h = surface.face_hinges[face][i];
        if (surface.hinges[h].left == face && surface.hinges[h].right != no_index)
            add_hinge(sums, context_, ball, local, h, i);
    }
}

}  // namespace certa::curvature
