#pragma once
// Measures of dual cells, one record per vertex, and sums of them over rings.
#include <span>
#include <vector>

#include "curvature/surface.h"

namespace certa::curvature {

/// What the principal directions need of a region: sums over it.
struct Sums {
    SymmetricTensor3 swapped, plain;
    double area = 0.0, gaussian = 0.0;
    double edge_mass = 0.0, vertex_mass = 0.0;
};

/// One cache line: what every region sums. `half` of the record's neighbours at a time is what makes rings fast.
struct alignas(64) CellRecord {
    SymmetricTensor3 swapped;
    double area = 0.0, gaussian = 0.0;
};
/// The rest, a second line.
struct alignas(64) CellRemainder {
    SymmetricTensor3 plain;
    double edge_mass = 0.0, vertex_mass = 0.0;
};

/// Per vertex: a third of each face around it, half of each edge, its own angle defect.
struct Cells {
    std::vector<CellRecord> records;
    std::vector<CellRemainder> remainders;
};
Cells build_cells(const Surface& surface, const RunControl& control);

/// The whole surface, summed in a fixed order.
Sums sum_all(const Cells& cells);

/// In the input's units.
SymmetricTensor3 scaled_tensor(const SymmetricTensor3& t, int exponent);
CurvatureMeasures measures_of(const Sums& sums, int exponent);

/// Marks with an epoch instead of clearing: one per thread.
class Marks {
public:
    explicit Marks(std::size_t size) : epochs_(size) {}
    void clear() {
        if (++epoch_ == 0) {
            std::fill(epochs_.begin(), epochs_.end(), 0U);
            epoch_ = 1;
        }
    }
    /// False if it was marked already.
    bool mark(Index i) {
        if (epochs_[i] == epoch_) return false;
        epochs_[i] = epoch_;
        return true;
    }
    bool has(Index i) const { return epochs_[i] == epoch_; }
    /// 1 if it was not marked yet: for loops whose branches nobody could predict.
    std::size_t mark_and_count(Index i) {
        const std::size_t fresh = epochs_[i] != epoch_;
        epochs_[i] = epoch_;
        return fresh;
    }

private:
    std::vector<std::uint32_t> epochs_;
    std::uint32_t epoch_ = 0;
};

/// Sums over rings around vertices; one per thread, no allocation per vertex once its lists have grown.
class RingWalker {
public:
    RingWalker(const Surface& surface, const Cells& cells)
        : surface_(surface), cells_(cells), vertices_(surface.positions.size()), faces_(0) {}

    Sums sum(Index vertex, std::uint64_t rings, Rim rim);
    /// Dual cells under the kernel (1 - t^2)^2, t = steps / (rings + 1).
    Sums sum_tapered(Index vertex, std::uint64_t rings);
    /// The vertices within `rings` steps, nearest first, the vertex itself in front.
    std::span<const Index> collect(Index vertex, std::uint64_t rings);
    /// The vertices within the ball around the vertex that edges inside it connect to the vertex.
    std::span<const Index> collect_ball(Index vertex, double radius);
    /// The faces of the ring: those of all vertices within rings - 1 steps. Marked: holds_face.
    const std::vector<Index>& collect_faces(Index vertex, std::uint64_t rings);
    bool holds_face(Index face) const { return faces_.has(face); }

private:
    Sums sum_faces(Index vertex, std::uint64_t rings, Rim rim);
    void add_rim_vertices(Sums& sums, Rim rim);

    /// Room for `more` vertices behind those found.
    void reserve(std::size_t more) {
        if (found_ + more > list_.size()) list_.resize(2 * (found_ + more));
    }
    void start(Index vertex);

    const Surface& surface_;
    const Cells& cells_;
    Marks vertices_, faces_;
    std::vector<Index> list_, face_list_;
    std::vector<std::size_t> ends_;  ///< of the vertices within 0, 1, ... steps
    std::size_t found_ = 0;          ///< entries of list_ in use
};

}  // namespace certa::curvature
