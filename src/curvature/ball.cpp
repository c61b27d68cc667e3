// Exact balls (thesis, definitions 5 and 7 with B a ball; docs/curvature.md: weights, connected by default, hierarchy).
//
// Connected: breadth-first over vertices inside. Around a vertex all of whose neighbours are inside the indicator is 1,
// and its dual cell's record is all that counts; other faces are taken one by one, and from those that the sphere cuts
// the walk goes on across sides that meet the ball between two ends outside. That reaches exactly the component of the
// surface within the ball. Each edge is integrated once, from its left face. Kernels take every face one by one.
// All sheets: a tree of sums; faces of nodes that the sphere cuts are integrated one by one.
#include "curvature/ball.h"

#include <algorithm>

#include "core/parallel.h"

namespace certa::curvature {

/// A face seen from a ball.
struct LocalFace {
    std::array<Point3, 3> points;
    std::array<double, 3> squares;
    std::array<SideCut, 3> sides;  ///< opposite corner i
};

namespace {

constexpr std::array<std::size_t, 3> next{1, 2, 0}, previous{2, 0, 1};

LocalFace local_face(const Surface& surface, const WeightedBall& ball, Index face) {
    LocalFace local;
    for (std::size_t i = 0; i < 3; ++i) {
        local.points[i] = ball.local(surface.positions[surface.faces[face][i]]);
        local.squares[i] = dot(local.points[i], local.points[i]);
    }
    for (std::size_t i = 0; i < 3; ++i)
        local.sides[i] = cut_side(local.points[next[i]], local.squares[next[i]], local.points[previous[i]],
                                  local.squares[previous[i]]);
    return local;
}

double face_integral(const Surface& surface, const WeightedBall& ball, const LocalFace& local, Index face) {
    const FaceGeometry& geometry = surface.face_geometry[face];
    return ball.square() * ball.over_triangle(local.points, local.squares, local.sides, geometry.normal,
                                              geometry.area * ball.per_square());
}

void add_hinge(Sums& sums, const BallContext& context, Index h, double weight) {
    add(sums.swapped, weight, context.tensors[h].swapped);
    add(sums.plain, weight, context.tensors[h].plain);
    sums.edge_mass += std::abs(weight * context.surface.hinges[h].angle);
}

/// The side opposite corner i, from its hinge's left face.
void add_side(Sums& sums, const BallContext& context, const WeightedBall& ball, const LocalFace& local, Index h,
              std::size_t i) {
    const Hinge& hinge = context.surface.hinges[h];
    if (hinge.angle == 0.0 || !local.sides[i].meets()) return;
    add_hinge(sums, context, h,
              hinge.length * ball.over_segment(local.sides[i], local.squares[next[i]], local.squares[previous[i]]));
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

void BallWalker::start(Index vertex) {
    inside_.clear(), outside_.clear(), faces_.clear();
    vertex_queue_.assign(1, vertex);
    face_queue_.clear();
    inside_.mark(vertex);
}

std::span<const FaceShare> BallWalker::collect(Index vertex, const Point3& center, double radius, Weight weight) {
    const WeightedBall ball(center, radius, weight);
    start(vertex);
    shares_.clear();
    std::size_t face = 0;
    for (std::size_t k = 0; k < vertex_queue_.size(); ++k) {
        for (const Index f : context_.surface.vertex_faces[vertex_queue_[k]])
            if (faces_.mark(f)) face_queue_.push_back(f);
        for (; face < face_queue_.size(); ++face) {
            const Index f = face_queue_[face];
            const LocalFace local = local_face(context_.surface, ball, f);
            shares_.push_back({f, face_integral(context_.surface, ball, local, f)});
            go_on(f, local);
        }
    }
    return shares_;
}

Sums BallWalker::sum(Index vertex, const Point3& center, double radius, Weight weight) {
    Sums sums;
    const WeightedBall ball(center, radius, weight);
    start(vertex);
    std::size_t face = 0;
    for (std::size_t k = 0; k < vertex_queue_.size(); ++k) {
        take_vertex(sums, ball, vertex_queue_[k]);
        for (; face < face_queue_.size(); ++face) take_face(sums, ball, face_queue_[face]);
    }
    return sums;
}

void BallWalker::take_vertex(Sums& sums, const WeightedBall& ball, Index vertex) {
    const Surface& surface = context_.surface;
    bool rim = ball.weight() != Weight::indicator;
    for (const Index w : surface.vertex_neighbors[vertex]) {
        if (inside_.has(w)) continue;
        if (!outside_.has(w)) {
            const Point3 p = ball.local(surface.positions[w]);
            if (dot(p, p) <= 1.0) {
                inside_.mark(w);
                vertex_queue_.push_back(w);
                continue;
            }
            outside_.mark(w);
        }
        rim = true;
    }
    if (rim) {
        take_rim_vertex(sums, ball, vertex);
        return;
    }
    const CellRecord& record = context_.cells.records[vertex];
    const CellRemainder& remainder = context_.cells.remainders[vertex];
    add(sums.swapped, 1.0, record.swapped);
    add(sums.plain, 1.0, remainder.plain);
    sums.area += record.area, sums.gaussian += record.gaussian;
    sums.edge_mass += remainder.edge_mass, sums.vertex_mass += remainder.vertex_mass;
}

/// Not the whole cell: thirds of the faces and halves of the edges that are inside, no difference of large numbers.
void BallWalker::take_rim_vertex(Sums& sums, const WeightedBall& ball, Index vertex) {
    const Surface& surface = context_.surface;
    const Point3 p = ball.local(surface.positions[vertex]);
    add_vertex(sums, context_, ball, vertex, dot(p, p));
    const bool whole = ball.weight() == Weight::indicator;
    for (const Index f : surface.vertex_faces[vertex]) {
        const auto& face = surface.faces[f];
        const std::size_t i = face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
        const bool before = outside_.has(face[previous[i]]), after = outside_.has(face[next[i]]);
        if (!whole || before || after) {
            if (faces_.mark(f)) face_queue_.push_back(f);
        } else {
            sums.area += surface.face_geometry[f].area / 3.0;
        }
        if (!whole || before) continue;
        // The edge to the previous corner: each hinge at the vertex is that of one face only.
        const Index h = surface.face_hinges[f][next[i]];
        const Hinge& hinge = surface.hinges[h];
        if (hinge.angle != 0.0) add_hinge(sums, context_, h, 0.5 * hinge.length);
    }
}

void BallWalker::take_face(Sums& sums, const WeightedBall& ball, Index face) {
    const Surface& surface = context_.surface;
    const LocalFace local = local_face(surface, ball, face);
    sums.area += face_integral(surface, ball, local, face);
    go_on(face, local);
    const bool whole = ball.weight() == Weight::indicator;
    for (std::size_t i = 0; i < 3; ++i) {
        // Edges inside the indicator's ball are counted from their ends.
        if (whole && local.squares[next[i]] <= 1.0 && local.squares[previous[i]] <= 1.0) continue;
        const Index h = surface.face_hinges[face][i];
        if (surface.hinges[h].left == face) add_side(sums, context_, ball, local, h, i);
    }
}

void BallWalker::go_on(Index face, const LocalFace& local) {
    const Surface& surface = context_.surface;
    for (std::size_t i = 0; i < 3; ++i) {
        const Index corner = surface.faces[face][i];
        if (local.squares[i] <= 1.0 && inside_.mark(corner)) vertex_queue_.push_back(corner);
        // Ends inside bring their faces with them.
        if (local.squares[next[i]] <= 1.0 || local.squares[previous[i]] <= 1.0 || !local.sides[i].meets()) continue;
        const Index across = surface.across(face, surface.face_hinges[face][i]);
        if (across != no_index && faces_.mark(across)) face_queue_.push_back(across);
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
        if (surface.hinges[h].left == face) add_side(sums, context_, ball, local, h, i);
    }
}

}  // namespace certa::curvature
