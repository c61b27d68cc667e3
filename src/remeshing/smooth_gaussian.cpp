// Smoothing as in the thesis (4.1.3): the tensors convolved with a Gaussian, coefficient by coefficient, clipped at
// features (4.1.5).
//
// Plan: on the surface instead of in a parameterization. Around each wedge, neighbours are visited in order of their
// distance along edges, up to two and a half standard deviations; their deviators are turned into the wedge's frame on
// the way. Wedges are one-sided, so the walk does not pass features; a wedge at a feature counts as the mean of its
// neighbours off features, which lie on its own side.
#include <algorithm>
#include <queue>

#include "core/parallel.h"
#include "remeshing/connection.h"
#include "remeshing/field.h"

namespace certa::remeshing {
namespace {

struct Tensor {
    Complex deviator;
    double trace = 0.0;
};

/// Values of wedges at features: means of neighbours off them.
void replace_at_features(const WorkMesh& mesh, const Laplacian& connection, std::vector<Tensor>& tensors) {
    const std::vector<Tensor> own = tensors;
    for (Index w = 0; w < mesh.wedge_count(); ++w) {
        if (mesh.wedge_closed[w]) continue;
        Tensor sum;
        double count = 0.0;
        for (std::uint64_t k = connection.offsets[w]; k < connection.offsets[w + 1]; ++k) {
            const Index n = connection.columns[k];
            if (!mesh.wedge_closed[n]) continue;
            sum.deviator += connection.transports[k] * own[n].deviator;
            sum.trace += own[n].trace;
            count += 1.0;
        }
        if (count > 0.0) tensors[w] = {sum.deviator / count, sum.trace / count};
    }
}

/// The walk around one wedge after the other.
class Convolution {
public:
    Convolution(const WorkMesh& mesh, const Laplacian& connection, const std::vector<double>& lengths, double deviation,
                const std::vector<Tensor>& tensors)
        : mesh_(mesh),
          connection_(connection),
          lengths_(lengths),
          deviation_(deviation),
          tensors_(tensors),
          reached_(tensors.size()) {}

    Tensor at(Index wedge) {
        ++stamp_;
        reached_[wedge] = {stamp_, 0.0, 1.0};
        queue_.push({0.0, wedge});
        const Point3& middle = mesh_.points[mesh_.wedge_vertices[wedge]];
        Tensor sum;
        double total = 0.0;
        while (!queue_.empty()) {
            const auto [d, w] = queue_.top();
            queue_.pop();
            if (d > reached_[w].distance) continue;
            const Complex turn = reached_[w].turn;
            const double away = distance(mesh_.points[mesh_.wedge_vertices[w]], middle) / deviation_;
            const double weight = connection_.mass[w] * std::exp(-0.5 * away * away);
            sum.deviator += weight * turn * tensors_[w].deviator;
            sum.trace += weight * tensors_[w].trace;
            total += weight;
            for (std::uint64_t k = connection_.offsets[w]; k < connection_.offsets[w + 1]; ++k) {
                const Index n = connection_.columns[k];
                const double reach = d + lengths_[k];
                Reached& there = reached_[n];
                if (reach > 2.5 * deviation_ || (there.stamp == stamp_ && there.distance <= reach)) continue;
                there = {stamp_, reach, turn * connection_.transports[k]};
                queue_.push({reach, n});
            }
        }
        if (!(total > 0.0)) return tensors_[wedge];
        return {sum.deviator / total, sum.trace / total};
    }

private:
    struct Reached {
        std::uint32_t stamp = 0;
        double distance = 0.0;
        Complex turn = 1.0;  ///< into the frame of the wedge in the middle
    };
    using Entry = std::pair<double, Index>;

    const WorkMesh& mesh_;
    const Laplacian& connection_;
    const std::vector<double>& lengths_;
    double deviation_;
    const std::vector<Tensor>& tensors_;
    std::vector<Reached> reached_;
    std::uint32_t stamp_ = 0;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

void smooth_by_gaussian(const WorkMesh& mesh, DirectionField& field, double deviation, const RunControl& control) {
    field.smoothing = deviation;
    const Laplacian connection = build_laplacian(mesh);
    const Index count = mesh.wedge_count();
    std::vector<Tensor> tensors(count);
    // What has no curvature of its own but a direction that was suggested counts next to nothing.
    const double least = 1e-6 / mesh.diagonal;
    for (Index w = 0; w < count; ++w)
        tensors[w] = {(0.5 * (field.k_max[w] - field.k_min[w]) + least) * field.measured[w],
                      field.k_max[w] + field.k_min[w]};
    replace_at_features(mesh, connection, tensors);
    field.squares.resize(count);
    std::vector<Tensor> smooth = tensors;
    if (deviation > 0.0) {
        std::vector<double> lengths(connection.columns.size());
        for (Index w = 0; w < count; ++w)
            for (std::uint64_t k = connection.offsets[w]; k < connection.offsets[w + 1]; ++k)
                lengths[k] = distance(mesh.points[mesh.wedge_vertices[w]],
                                      mesh.points[mesh.wedge_vertices[connection.columns[k]]]);
        core::parallel_for(count, std::max<std::size_t>(64, count / 64), control,
                           [&](std::size_t begin, std::size_t end) {
                               Convolution convolution(mesh, connection, lengths, deviation, tensors);
                               for (std::size_t w = begin; w < end && !control.cancelled(); ++w)
                                   smooth[w] = convolution.at(static_cast<Index>(w));
                           });
    }
    for (Index w = 0; w < count; ++w) {
        const double half = std::abs(smooth[w].deviator);
        field.squares[w] = mesh.diagonal * smooth[w].deviator;
        field.k_max[w] = 0.5 * smooth[w].trace + half;
        field.k_min[w] = 0.5 * smooth[w].trace - half;
    }
    finish_directions(mesh, field);
}

}  // namespace certa::remeshing
