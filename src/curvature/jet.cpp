// Jets (Cazals, Pouget, "Estimating differential quantities using polynomial fitting of osculating jets", 2003).
//
// Heights over the tangent plane of the vertex's normal, in units of the window's size, fitted by Householder's QR. The
// fundamental forms at the vertex's foot give curvatures; heights grow along the outward normal, so curvatures are the
// negative of the second form. Coefficients are ordered by degree: 1, u, v, u^2, uv, v^2, ...
#include "curvature/jet.h"

#include <algorithm>
#include <cmath>

#include "curvature/estimators.h"

namespace certa::curvature {

bool JetFitter::solve(std::size_t rows, std::size_t columns) {
    const auto column = [&](std::size_t c) { return matrix_.data() + c * rows; };
    double largest = 0.0;
    for (std::size_t c = 0; c < columns; ++c) {
        double* pivot = column(c);
        double square = 0.0;
        for (std::size_t r = c; r < rows; ++r) square += pivot[r] * pivot[r];
        const double length = std::sqrt(square);
        largest = std::max(largest, length);
        if (!(length > 1e-12 * largest)) return false;
        const double alpha = pivot[c] > 0.0 ? -length : length, head = pivot[c] - alpha;
        const double scale = 1.0 / (alpha * head);  // of the reflection I + scale v v^T, v = pivot with head on top
        pivot[c] = head;
        const auto reflect = [&](double* target) {
            double along = 0.0;
            for (std::size_t r = c; r < rows; ++r) along += pivot[r] * target[r];
            along *= scale;
            for (std::size_t r = c; r < rows; ++r) target[r] += along * pivot[r];
        };
        for (std::size_t other = c + 1; other < columns; ++other) reflect(column(other));
        reflect(values_.data());
        // The diagonal of R replaces the head of the reflection, which is not needed any more.
        pivot[c] = alpha;
    }
    for (std::size_t c = columns; c-- > 0;) {
        double sum = values_[c];
        for (std::size_t other = c + 1; other < columns; ++other) sum -= column(other)[c] * values_[other];
        values_[c] = sum / column(c)[c];
    }
    return true;
}

JetFit JetFitter::fit(Index vertex, std::span<const Index> points, std::uint64_t degree, bool tapered) {
    JetFit fit;
    const Point3& normal = surface_.normals[vertex];
    if (normal == Point3{}) return fit;
    const auto coefficients = [](std::uint64_t d) { return static_cast<std::size_t>((d + 1) * (d + 2) / 2); };
    while (degree > 2 && points.size() < coefficients(degree) + 2) --degree;
    const std::size_t rows = points.size(), columns = coefficients(degree);
    if (rows < columns) return fit;
    const Point3 &origin = surface_.positions[vertex], a = perpendicular_to(normal), b = cross(normal, a);
    double size = 0.0;
    for (const Index p : points) size = std::max(size, distance(surface_.positions[p], origin));
    if (!(size > 0.0)) return fit;
    matrix_.resize(rows * columns);
    values_.resize(rows);
    for (std::size_t r = 0; r < rows; ++r) {
        const Point3 d = (1.0 / size) * (surface_.positions[points[r]] - origin);
        const double u = dot(d, a), v = dot(d, b);
        // Rows are scaled by the root of the weight 1 - t^2, just short of 0 at the farthest point.
        const double weight = tapered && rows >= 2 * columns ? std::sqrt(1.0 - 0.98 * std::min(1.0, dot(d, d))) : 1.0;
        values_[r] = weight * dot(d, normal);
        matrix_[r] = weight;
        std::size_t c = 1;
        for (std::uint64_t k = 1; k <= degree; ++k) {
            // u times the terms of degree k - 1, then v times the last of them.
            const std::size_t before = c - k;
            for (std::uint64_t i = 0; i < k; ++i, ++c) matrix_[c * rows + r] = u * matrix_[(before + i) * rows + r];
            matrix_[c * rows + r] = v * matrix_[(c - k - 1) * rows + r];
            ++c;
        }
    }
    if (!solve(rows, columns)) return fit;
    double rest = 0.0;
    for (std::size_t r = columns; r < rows; ++r) rest += values_[r] * values_[r];
    fit.residual = rows > columns ? size * std::sqrt(rest / static_cast<double>(rows - columns)) : 0.0;
    fit.points = rows;
    const double fu = values_[1], fv = values_[2], fuu = 2.0 * values_[3], fuv = values_[4], fvv = 2.0 * values_[5];
    const double stretch = std::sqrt(1.0 + fu * fu + fv * fv);
    const Point3 tilted = (1.0 / stretch) * (normal - fu * a - fv * b);
    const Point3 first = unit_or_zero(a + fu * normal), second = cross(tilted, first);
    // Second form on tangent vectors: they are known by their shadows on (a, b).
    const auto form = [&](const Point3& x, const Point3& y) {
        const double xu = dot(x, a), xv = dot(x, b), yu = dot(y, a), yv = dot(y, b);
        return -(fuu * xu * yu + fuv * (xu * yv + xv * yu) + fvv * xv * yv) / (stretch * size);
    };
    const double ff = form(first, first), ss = form(second, second), fs = form(first, second);
    const double half = 0.5 * std::atan2(2.0 * fs, ff - ss);
    const Point3 along = unit_or_zero(std::cos(half) * first + std::sin(half) * second);
    const double middle = 0.5 * (ff + ss), spread = std::hypot(0.5 * (ff - ss), fs);
    fit.principal = make_principal(middle + spread, middle - spread, along, tilted);
    fit.ok = true;
    return fit;
}

namespace {

class JetEstimator : public VertexEstimator {
public:
    JetEstimator(const Surface& surface, const Cells& cells, std::uint64_t degree, std::uint64_t rings, double radius)
        : cells_(cells), walker_(surface, cells), fitter_(surface), degree_(degree), rings_(rings), radius_(radius) {}

    void estimate(Index vertex, VertexRow& row) override {
        // Windows that are too small to fit anything grow.
        JetFit fit;
        std::span<const Index> points =
            rings_ > 0 ? walker_.collect(vertex, rings_) : walker_.collect_ball(vertex, radius_);
        fit = fitter_.fit(vertex, points, degree_, true);
        for (std::uint64_t rings = 2; !fit.ok && rings <= 4; ++rings) {
            points = walker_.collect(vertex, rings);
            fit = fitter_.fit(vertex, points, 2, true);
            row.flags |= vertex_flags::fallback;
        }
        for (const Index v : points) {
            row.sums.area += cells_.records[v].area;
            row.sums.gaussian += cells_.records[v].gaussian;
        }
        if (!fit.ok) {
            row.flags |= vertex_flags::undefined;
            return;
        }
        row.principal = fit.principal;
        row.mean = fit.principal.k_min + fit.principal.k_max;
        row.gaussian = fit.principal.k_min * fit.principal.k_max;
    }

private:
    const Cells& cells_;
    RingWalker walker_;
    JetFitter fitter_;
    std::uint64_t degree_, rings_;
    double radius_;
};

class JetFactory : public EstimatorFactory {
public:
    JetFactory(const Surface& surface, const Cells& cells, std::uint64_t degree, std::uint64_t rings, double radius)
        : surface_(surface), cells_(cells), degree_(degree), rings_(rings), radius_(radius) {}
    std::unique_ptr<VertexEstimator> make() const override {
        return std::make_unique<JetEstimator>(surface_, cells_, degree_, rings_, radius_);
    }

private:
    const Surface& surface_;
    const Cells& cells_;
    std::uint64_t degree_, rings_;
    double radius_;
};

}  // namespace

FactoryPointer make_jet_factory(const Surface& surface, const Cells& cells, std::uint64_t degree, std::uint64_t rings,
                                double radius) {
    return std::make_unique<JetFactory>(surface, cells, degree, rings, radius);
}

}  // namespace certa::curvature
