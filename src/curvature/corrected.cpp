// Corrected normal current, for comparison (Lachaud, Romon, Thibert, "Corrected curvature measures", 2022).
//
// The normal cycle's jumps between faces are replaced by normals interpolated from the vertices; each face then carries
// area, mean, Gaussian and anisotropic measures in closed form. Our mean measure integrates k1 + k2; our tensor has the
// curvature along a direction as its value there, so the sign is the opposite of the paper's and nothing is swapped.
#include <algorithm>

#include "curvature/estimators.h"

namespace certa::curvature {
namespace {

struct FaceCurrent {
    double area = 0.0, mean = 0.0, gaussian = 0.0;
    SymmetricTensor3 tensor;
    Point3 vector_area;  ///< area times the face's own normal
};

FaceCurrent current_of(const Surface& surface, Index face) {
    const auto& v = surface.faces[face];
    const std::array<Point3, 3> x{surface.positions[v[0]], surface.positions[v[1]], surface.positions[v[2]]};
    const std::array<Point3, 3> u{surface.normals[v[0]], surface.normals[v[1]], surface.normals[v[2]]};
    const Point3 middle = (1.0 / 3.0) * (u[0] + u[1] + u[2]);
    const Point3 a = x[1] - x[0], b = x[2] - x[0], da = u[1] - u[0], db = u[2] - u[0];
    FaceCurrent current;
    current.vector_area = 0.5 * cross(a, b);
    current.area = dot(middle, current.vector_area);
    // (u2 - u1) x x0 + (u0 - u2) x x1 + (u1 - u0) x x2, from x0.
    current.mean = 0.5 * dot(middle, cross(da, b) - cross(db, a));
    current.gaussian = 0.5 * dot(u[0], cross(u[1], u[2]));
    // -mu(X, Y) = 1/2 [ <Y, u1 - u0> <middle, X x b> - <Y, u2 - u0> <middle, X x a> ], symmetrised;
    // <middle, X x b> = <X, b x middle>.
    const Point3 p = cross(b, middle), q = cross(a, middle);
    const auto entry = [&](double Point3::*i, double Point3::*j) {
        return 0.25 * (da.*j * p.*i - db.*j * q.*i + da.*i * p.*j - db.*i * q.*j);
    };
    current.tensor = {entry(&Point3::x, &Point3::x), entry(&Point3::x, &Point3::y), entry(&Point3::x, &Point3::z),
                      entry(&Point3::y, &Point3::y), entry(&Point3::y, &Point3::z), entry(&Point3::z, &Point3::z)};
    return current;
}

/// Over rings, or over balls where the radius is above 0.
class CorrectedEstimator : public VertexEstimator {
public:
    CorrectedEstimator(const BallContext& context, const std::vector<FaceCurrent>& currents,
                       const CorrectedRegion& region)
        : context_(context),
          currents_(currents),
          region_(region),
          rings_(context.surface, context.cells),
          balls_(region.radius > 0.0 ? std::make_unique<BallWalker>(context) : nullptr) {}

    void estimate(Index vertex, VertexRow& row) override {
        FaceCurrent sum = region_.radius > 0.0 ? over_ball(vertex, row) : over_rings(vertex);
        row.sums.area = sum.area;
        row.sums.gaussian = sum.gaussian;
        // The region's normal: that of the vertex alone is what noise turns most.
        const Point3 normal = unit_or_zero(sum.vector_area);
        if (!(sum.area > 0.0) || normal == Point3{}) {
            row.flags |= vertex_flags::undefined;
            return;
        }
        row.mean = sum.mean / sum.area;
        row.gaussian = sum.gaussian / sum.area;
        // As with the swapped tensor: what lies across a direction does not tilt out of the tangent plane along it.
        const Principal along = compute_principal_along(sum.tensor, sum.area, normal);
        row.principal = make_principal(row.mean - along.k_max, row.mean - along.k_min, along.dir_min, normal);
    }

private:
    void add_face(FaceCurrent& sum, Index f, double weight) const {
        const FaceCurrent& current = currents_[f];
        sum.area += weight * current.area, sum.mean += weight * current.mean;
        sum.gaussian += weight * current.gaussian;
        add(sum.tensor, weight, current.tensor);
        sum.vector_area = sum.vector_area + weight * current.vector_area;
    }

    FaceCurrent over_rings(Index vertex) {
        FaceCurrent sum;
        if (region_.rim == Rim::dual) {
            for (const Index v : rings_.collect(vertex, region_.rings))
                for (const Index f : context_.surface.vertex_faces[v]) add_face(sum, f, 1.0 / 3.0);
        } else {
            for (const Index f : rings_.collect_faces(vertex, region_.rings)) add_face(sum, f, 1.0);
        }
        return sum;
    }

    /// A face counts by the share of its area that is inside, weighted.
    FaceCurrent over_ball(Index vertex, VertexRow& row) {
        const auto over = [&](Weight weight) {
            FaceCurrent sum;
            for (const auto& [f, area] :
                 balls_->collect(vertex, context_.surface.positions[vertex], region_.radius, weight))
                if (area != 0.0) add_face(sum, f, area / context_.surface.face_geometry[f].area);
            return sum;
        };
        const FaceCurrent sum = over(region_.weight);
        if (region_.weight != Weight::kernel4 || is_safe_kernel4(sum.area, region_.radius)) return sum;
        row.flags |= vertex_flags::fallback;
        return over(Weight::kernel2);
    }

    const BallContext& context_;
    const std::vector<FaceCurrent>& currents_;
    const CorrectedRegion& region_;
    RingWalker rings_;
    std::unique_ptr<BallWalker> balls_;
};

class CorrectedFactory : public EstimatorFactory {
public:
    CorrectedFactory(const Surface& surface, const Cells& cells, const CorrectedRegion& region)
        : context_{surface, cells, {}}, region_(region), currents_(surface.faces.size()) {
        for (std::size_t f = 0; f < currents_.size(); ++f) currents_[f] = current_of(surface, static_cast<Index>(f));
    }
    std::unique_ptr<VertexEstimator> make() const override {
        return std::make_unique<CorrectedEstimator>(context_, currents_, region_);
    }

private:
    BallContext context_;
    CorrectedRegion region_;
    std::vector<FaceCurrent> currents_;
};

}  // namespace

FactoryPointer make_corrected_factory(const Surface& surface, const Cells& cells, const CorrectedRegion& region) {
    return std::make_unique<CorrectedFactory>(surface, cells, region);
}

}  // namespace certa::curvature
