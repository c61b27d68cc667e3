// Balls of the surface's own distance: fast marching from the vertex, then exact clipping of the interpolated distance.
//
// A vertex's distance is found by unfolding a triangle into the plane together with the point source that explains the
// distances of its two known vertices; that is exact while shortest paths meet no saddle vertex. Between vertices the
// distance is interpolated linearly, and the ball is where it is at most the radius. First order in the edge length.
#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "curvature/estimators.h"

namespace certa::curvature {
namespace {

constexpr std::array<std::size_t, 3> next{1, 2, 0}, previous{2, 0, 1};

/// Distance at c across the triangle whose other vertices have distances da and db, as if from a point source.
double unfolded_distance(double da, double db, double ab, double bc, double ca) {
    const double along = std::min(da + ca, db + bc);
    if (!(ab > 0.0)) return along;
    // a at the origin, b at (ab, 0), c above, the source below.
    const double cx = (ca * ca + ab * ab - bc * bc) / (2.0 * ab), sx = (da * da + ab * ab - db * db) / (2.0 * ab);
    const double c2 = ca * ca - cx * cx, s2 = da * da - sx * sx;
    if (!(c2 > 0.0) || !(s2 >= 0.0)) return along;
    const double cy = std::sqrt(c2), sy = std::sqrt(s2);
    // Where the straight path crosses the edge (a, b).
    const double crossing = (sx * cy + cx * sy) / (cy + sy);
    if (crossing < 0.0 || crossing > ab) return along;
    return std::min(along, std::hypot(cx - sx, cy + sy));
}

class GeodesicEstimator : public VertexEstimator {
public:
    GeodesicEstimator(const BallContext& context, double radius)
        : context_(context),
          radius_(radius),
          known_(context.surface.positions.size()),
          reached_(context.surface.positions.size()),
          faces_(context.surface.faces.size()),
          distances_(context.surface.positions.size()) {}

    void estimate(Index vertex, VertexRow& row) override {
        march(vertex);
        faces_.clear();
        for (const Index v : inside_) {
            row.sums.gaussian += context_.surface.defects[v];
            row.sums.vertex_mass += context_.cells.remainders[v].vertex_mass;
            for (const Index f : context_.surface.vertex_faces[v])
                if (faces_.mark(f)) add_face(row.sums, f);
        }
        finish_normal_cycle(context_.surface, vertex, row);
    }

private:
    struct Entry {
        double distance;
        Index vertex;
        bool operator<(const Entry& other) const {
            return distance != other.distance ? distance > other.distance : vertex > other.vertex;
        }
    };

    void reach(Index v, double distance) {
        if (!reached_.mark(v) && distances_[v] <= distance) return;
        distances_[v] = distance;
        heap_.push_back({distance, v});
        std::push_heap(heap_.begin(), heap_.end());
    }

    /// Distances of all vertices within the radius and of those next to them.
    void march(Index start) {
        const Surface& surface = context_.surface;
        known_.clear(), reached_.clear(), heap_.clear(), inside_.clear();
        reach(start, 0.0);
        while (!heap_.empty()) {
            std::pop_heap(heap_.begin(), heap_.end());
            const Index v = heap_.back().vertex;
            heap_.pop_back();
            if (!known_.mark(v)) continue;
            if (distances_[v] <= radius_) inside_.push_back(v);
            if (distances_[v] > radius_) continue;
            for (const Index w : surface.vertex_neighbors[v])
                if (!known_.has(w)) reach(w, distances_[v] + distance(surface.positions[v], surface.positions[w]));
            for (const Index f : surface.vertex_faces[v]) unfold(f);
        }
    }

    void unfold(Index face) {
        const Surface& surface = context_.surface;
        const auto& v = surface.faces[face];
        for (std::size_t i = 0; i < 3; ++i) {
            const Index a = v[next[i]], b = v[previous[i]], c = v[i];
            if (known_.has(c) || !known_.has(a) || !known_.has(b)) continue;
            const auto length = [&](Index p, Index q) { return distance(surface.positions[p], surface.positions[q]); };
            reach(c, unfolded_distance(distances_[a], distances_[b], length(a, b), length(b, c), length(c, a)));
        }
    }

    /// Excess over the radius; vertices that were not reached are farther than any that was.
    double excess(Index v) const { return reached_.has(v) ? distances_[v] - radius_ : radius_; }

    void add_face(Sums& sums, Index f) {
        const Surface& surface = context_.surface;
        const auto& v = surface.faces[f];
        const std::array<double, 3> x{excess(v[0]), excess(v[1]), excess(v[2])};
        const auto inside = static_cast<int>(std::count_if(x.begin(), x.end(), [](double e) { return e <= 0.0; }));
        double share = inside == 3 ? 1.0 : 0.0;
        if (inside == 1 || inside == 2) {
            // The corner that is alone on its side, and how far along its edges the level lies.
            const std::size_t i = inside == 1 ? (x[0] <= 0.0   ? 0
                                                 : x[1] <= 0.0 ? 1
                                                               : 2)
                                              : (x[0] > 0.0   ? 0
                                                 : x[1] > 0.0 ? 1
                                                              : 2);
            const double corner = x[i] / (x[i] - x[next[i]]) * (x[i] / (x[i] - x[previous[i]]));
            share = inside == 1 ? corner : 1.0 - corner;
        }
        sums.area += share * surface.face_geometry[f].area;
        for (std::size_t i = 0; i < 3; ++i) {
            const Index h = surface.face_hinges[f][i];
            const Hinge& hinge = surface.hinges[h];
            if (hinge.left != f || hinge.angle == 0.0) {
                // Its left face has no vertex inside, then neither has the edge; or it comes by itself.
                continue;
            }
            const double a = x[next[i]], b = x[previous[i]];
            const double part = a <= 0.0 && b <= 0.0 ? 1.0
                                : a > 0.0 && b > 0.0 ? 0.0
                                                     : (a <= 0.0 ? a / (a - b) : b / (b - a));
            if (part == 0.0) continue;
            add(sums.swapped, part * hinge.length, context_.tensors[h].swapped);
            add(sums.plain, part * hinge.length, context_.tensors[h].plain);
            sums.edge_mass += part * hinge.length * std::abs(hinge.angle);
        }
    }

    const BallContext& context_;
    double radius_;
    Marks known_, reached_, faces_;
    std::vector<double> distances_;
    std::vector<Entry> heap_;
    std::vector<Index> inside_;
};

class GeodesicFactory : public EstimatorFactory {
public:
    GeodesicFactory(const Surface& surface, const Cells& cells, double radius, const RunControl& control)
        : context_{surface, cells, build_hinge_tensors(surface, control)}, radius_(radius) {}
    std::unique_ptr<VertexEstimator> make() const override {
        return std::make_unique<GeodesicEstimator>(context_, radius_);
    }

private:
    BallContext context_;
    double radius_;
};

}  // namespace

FactoryPointer make_geodesic_factory(const Surface& surface, const Cells& cells, double radius,
                                     const RunControl& control) {
    return std::make_unique<GeodesicFactory>(surface, cells, radius, control);
}

}  // namespace certa::curvature
