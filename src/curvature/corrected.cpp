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
};

FaceCurrent current_of(const Surface& surface, Index face) {
    const auto& v = surface.faces[face];
    const std::array<Point3, 3> x{surface.positions[v[0]], surface.positions[v[1]], surface.positions[v[2]]};
    const std::array<Point3, 3> u{surface.normals[v[0]], surface.normals[v[1]], surface.normals[v[2]]};
    const Point3 middle = (1.0 / 3.0) * (u[0] + u[1] + u[2]);
    const Point3 a = x[1] - x[0], b = x[2] - x[0], da = u[1] - u[0], db = u[2] - u[0];
    FaceCurrent current;
    current.area = 0.5 * dot(middle, cross(a, b));
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

class CorrectedEstimator : public VertexEstimator {
public:
    CorrectedEstimator(const Surface& surface, const Cells& cells, const std::vector<FaceCurrent>& currents,
                       std::uint64_t rings, Rim rim)
        : surface_(surface), currents_(currents), walker_(surface, cells), rings_(rings), rim_(rim) {}

    void estimate(Index vertex, VertexRow& row) override {
        FaceCurrent sum;
        const auto add_face = [&](Index f, double weight) {
            const FaceCurrent& current = currents_[f];
            sum.area += weight * current.area, sum.mean += weight * current.mean;
            sum.gaussian += weight * current.gaussian;
            add(sum.tensor, weight, current.tensor);
        };
        if (rim_ == Rim::dual) {
            for (const Index v : walker_.collect(vertex, rings_))
                for (const Index f : surface_.vertex_faces[v]) add_face(f, 1.0 / 3.0);
        } else {
            for (const Index f : walker_.collect_faces(vertex, rings_)) add_face(f, 1.0);
        }
        row.sums.area = sum.area;
        row.sums.gaussian = sum.gaussian;
        const Point3& normal = surface_.normals[vertex];
        if (!(sum.area > 0.0) || normal == Point3{}) {
            row.flags |= vertex_flags::undefined;
            return;
        }
        row.mean = sum.mean / sum.area;
        row.gaussian = sum.gaussian / sum.area;
        row.principal = compute_principal_along(sum.tensor, sum.area, normal);
    }

private:
    const Surface& surface_;
    const std::vector<FaceCurrent>& currents_;
    RingWalker walker_;
    std::uint64_t rings_;
    Rim rim_;
};

class CorrectedFactory : public EstimatorFactory {
public:
    CorrectedFactory(const Surface& surface, const Cells& cells, std::uint64_t rings, Rim rim)
        : surface_(surface), cells_(cells), rings_(rings), rim_(rim), currents_(surface.faces.size()) {
        for (std::size_t f = 0; f < currents_.size(); ++f) currents_[f] = current_of(surface, static_cast<Index>(f));
    }
    std::unique_ptr<VertexEstimator> make() const override {
        return std::make_unique<CorrectedEstimator>(surface_, cells_, currents_, rings_, rim_);
    }

private:
    const Surface& surface_;
    const Cells& cells_;
    std::uint64_t rings_;
    Rim rim_;
    std::vector<FaceCurrent> currents_;
};

}  // namespace

FactoryPointer make_corrected_factory(const Surface& surface, const Cells& cells, std::uint64_t rings, Rim rim) {
    return std::make_unique<CorrectedFactory>(surface, cells, rings, rim);
}

}  // namespace certa::curvature
