#pragma once
// Sums over exact balls around vertices: indicator or kernel weights, connected or all sheets.
#include "curvature/cells.h"
#include "curvature/face_tree.h"
#include "curvature/weights.h"

namespace certa::curvature {

/// Per hinge: both tensors per unit of length.
std::vector<EdgeTensors> build_hinge_tensors(const Surface& surface, const RunControl& control);

/// Everything that walkers of all threads read.
struct BallContext {
    const Surface& surface;
    const Cells& cells;
    std::vector<EdgeTensors> tensors;
};

struct FaceShare {
    Index face = 0;
    double area = 0.0;  ///< integral of the weight over it
};
struct LocalFace;

/// One per thread. The part of the surface in the ball that connects to the vertex (within the ball).
class BallWalker {
public:
    explicit BallWalker(const BallContext& context)
        : context_(context),
          inside_(context.surface.positions.size()),
          outside_(context.surface.positions.size()),
          faces_(context.surface.faces.size()) {}
    Sums sum(Index vertex, const Point3& center, double radius, Weight weight);
    /// The faces of that part with their weighted areas.
    std::span<const FaceShare> collect(Index vertex, const Point3& center, double radius, Weight weight);

private:
    void start(Index vertex);
    /// What a face brings with it: its corners inside, and faces across sides that pass through the ball.
    void go_on(Index face, const LocalFace& local);
    void take_vertex(Sums& sums, const WeightedBall& ball, Index vertex);
    void take_rim_vertex(Sums& sums, const WeightedBall& ball, Index vertex);
    void take_face(Sums& sums, const WeightedBall& ball, Index face);

    const BallContext& context_;
    Marks inside_, outside_, faces_;
    std::vector<Index> vertex_queue_, face_queue_;
    std::vector<FaceShare> shares_;
};

/// The same over all sheets, by a tree of sums: indicator balls cost O(radius / edge length + log n).
class SheetWalker {
public:
    SheetWalker(const BallContext& context, const FaceTree& tree) : context_(context), tree_(tree) {}
    Sums sum(const Point3& center, double radius, Weight weight);

private:
    void add_owned(Sums& sums, const WeightedBall& ball, Index face);

    const BallContext& context_;
    const FaceTree& tree_;
    std::vector<Index> stack_;
};

}  // namespace certa::curvature
