#pragma once
// One estimate per vertex: the interface behind which neighborhoods, weights and estimators are told apart once.
#include <memory>
#include <mutex>

#include "curvature/ball.h"
#include "curvature/cells.h"
#include "curvature/principal.h"

namespace certa::curvature {

/// What is known of a vertex, in the surface's units.
struct VertexRow {
    Sums sums;
    Principal principal;
    double mean = 0.0, gaussian = 0.0;  ///< densities
    double radius = 0.0;
    std::uint8_t flags = 0;  ///< to be added to the vertex's
};

/// Owns scratch memory: one per thread.
class VertexEstimator {
public:
    virtual ~VertexEstimator() = default;
    virtual void estimate(Index vertex, VertexRow& row) = 0;
};

/// Densities and principal curvatures from the sums, as the thesis has them.
void finish_normal_cycle(const Surface& surface, Index vertex, VertexRow& row);

/// Whether signed weights leave enough of the region: half of what a flat disc has.
bool is_safe_kernel4(double area, double radius);

/// What is shared between threads and outlives the estimators made from it.
class EstimatorFactory {
public:
    virtual ~EstimatorFactory() = default;
    virtual std::unique_ptr<VertexEstimator> make() const = 0;
};

using FactoryPointer = std::unique_ptr<EstimatorFactory>;
FactoryPointer make_ring_factory(const Surface& surface, const Cells& cells, std::uint64_t rings, Rim rim,
                                 Weight weight);
/// `radius` in the surface's units; `geodesic` and `automatic_ball` have factories of their own.
FactoryPointer make_ball_factory(const Surface& surface, const Cells& cells, double radius, Weight weight,
                                 bool all_sheets, const RunControl& control);
FactoryPointer make_automatic_ball_factory(const Surface& surface, const Cells& cells, Weight weight,
                                           const RunControl& control);
FactoryPointer make_geodesic_factory(const Surface& surface, const Cells& cells, double radius,
                                     const RunControl& control);
struct CorrectedRegion {
    std::uint64_t rings = 1;
    Rim rim = Rim::dual;
    double radius = 0.0;  ///< of balls, in the surface's units; 0: rings
    Weight weight = Weight::indicator;
};
FactoryPointer make_corrected_factory(const Surface& surface, const Cells& cells, const CorrectedRegion& region);
/// rings 0: balls of `radius`.
FactoryPointer make_jet_factory(const Surface& surface, const Cells& cells, std::uint64_t degree, std::uint64_t rings,
                                double radius);

/// Median residual of local fits of degree 4 over the mean edge length.
double estimate_noise(const Surface& surface, const Cells& cells, std::uint64_t rings);
/// What Estimator::automatic stands for on this surface; tells noise and choice in `statistics`.
CurvatureOptions choose_estimator(const Surface& surface, const Cells& cells, const CurvatureOptions& options,
                                  CurvatureStatistics& statistics);

/// Lends one object per range of a parallel loop; memory stays with the pool.
template <class T>
class Pool {
public:
    template <class Make>
    std::unique_ptr<T> take(const Make& make) {
        {
            const std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                std::unique_ptr<T> taken = std::move(free_.back());
                free_.pop_back();
                return taken;
            }
        }
        return make();
    }
    void give_back(std::unique_ptr<T> object) {
        const std::lock_guard lock(mutex_);
        free_.push_back(std::move(object));
    }

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<T>> free_;
};

}  // namespace certa::curvature
