// The best triangulation of a polygon by dynamic programming over its chains (Klincsek 1980), as the cost is a sum over
// diagonals and triangles.
//
// Cost of a chain from corner i to corner j: the best apex k between them adds the triangle ijk and the two shorter
// chains. Cubic in the corners: polygons of remeshing have four or five; above `largest_exact` ears are cut instead.
#include "remeshing/triangulate.h"

#include <algorithm>
#include <limits>

#include "core/vector3.h"

namespace certa::remeshing {
namespace {

constexpr std::size_t largest_exact = 96;
using Triangles = std::vector<std::array<Index, 3>>;

class Cutter {
public:
    Cutter(std::span<const Point3> points, std::span<const Index> ring, const core::TriangleTree& input)
        : points_(points), ring_(ring), input_(input) {
        Point3 sum;
        for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum = sum + cross(at(i) - at(0), at(i + 1) - at(0));
        const double length = norm(sum);
        if (length > 0.0) normal_ = (1.0 / length) * sum;
        for (std::size_t i = 0; i < ring.size(); ++i) square_ = std::max(square_, dot(at(i) - at(0), at(i) - at(0)));
    }

    void cut_best(Triangles& out) {
        const std::size_t n = ring_.size();
        cost_.assign(n * n, 0.0);
        apex_.assign(n * n, 0);
        for (std::size_t span = 2; span < n; ++span)
            for (std::size_t i = 0; i + span < n; ++i) {
                const std::size_t j = i + span;
                double best = std::numeric_limits<double>::infinity();
                for (std::size_t k = i + 1; k < j; ++k) {
                    const double cost = cost_[i * n + k] + cost_[k * n + j] + cost_of_triangle(i, k, j);
                    if (cost < best) best = cost, apex_[i * n + j] = k;
                }
                cost_[i * n + j] = best + (span + 1 < n ? cost_of_diagonal(i, j) : 0.0);
            }
        collect(0, n - 1, out);
    }

    void cut_ears(Triangles& out) const {
        std::vector<std::size_t> left(ring_.size());
        for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
        while (left.size() > 3) {
            std::size_t best = 0;
            double best_turn = -std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < left.size(); ++i) {
                const std::size_t a = left[(i + left.size() - 1) % left.size()], b = left[i],
                                  c = left[(i + 1) % left.size()];
                if (is_ear(left, a, b, c)) {
                    best = i;
                    break;
                }
                if (turn(a, b, c) > best_turn) best = i, best_turn = turn(a, b, c);
            }
            out.push_back({ring_[left[(best + left.size() - 1) % left.size()]], ring_[left[best]],
                           ring_[left[(best + 1) % left.size()]]});
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
        }
        out.push_back({ring_[left[0]], ring_[left[1]], ring_[left[2]]});
    }

private:
    const Point3& at(std::size_t i) const { return points_[ring_[i]]; }
    double turn(std::size_t a, std::size_t b, std::size_t c) const {
        return dot(cross(at(b) - at(a), at(c) - at(a)), normal_);
    }
    bool is_ear(const std::vector<std::size_t>& left, std::size_t a, std::size_t b, std::size_t c) const {
        if (!(turn(a, b, c) > 0.0)) return false;
        return std::none_of(left.begin(), left.end(), [&](std::size_t v) {
            return v != a && v != b && v != c && turn(a, b, v) >= 0.0 && turn(b, c, v) >= 0.0 && turn(c, a, v) >= 0.0;
        });
    }
    /// Prohibitive where the triangle turns away, and nearly so where it is a needle with next to no area.
    double cost_of_triangle(std::size_t a, std::size_t b, std::size_t c) const {
        const Point3 area = cross(at(b) - at(a), at(c) - at(a));
        const double size = norm(area), forward = dot(area, normal_);
        const double longest = std::max(
            {dot(at(b) - at(a), at(b) - at(a)), dot(at(c) - at(b), at(c) - at(b)), dot(at(a) - at(c), at(a) - at(c))});
        double cost = 0.0;
        constexpr double thin = 0.02;
        if (size < thin * longest) cost += 1e3 * (1.0 - size / (thin * longest));
        if (size > 1e-6 * longest && forward < 0.1 * size) cost += forward > 0.0 ? 1e3 : 1e6;
        return cost * square_ * std::sqrt(square_);
    }
    double cost_of_diagonal(std::size_t a, std::size_t b) {
        const double length = distance(at(a), at(b));
        if (input_.empty()) return length * length * length;
        double sum = 0.0;
        for (const double s : {0.25, 0.5, 0.75}) {
            const core::NearestPoint found = input_.find_nearest((1.0 - s) * at(a) + s * at(b), nearest_);
            nearest_ = found.triangle;
            sum += found.squared_distance;
        }
        return length * sum / 3.0;
    }
    void collect(std::size_t i, std::size_t j, Triangles& out) const {
        if (j - i < 2) return;
        const std::size_t k = apex_[i * ring_.size() + j];
        out.push_back({ring_[i], ring_[k], ring_[j]});
        collect(i, k, out);
        collect(k, j, out);
    }

    std::span<const Point3> points_;
    std::span<const Index> ring_;
    const core::TriangleTree& input_;
    Point3 normal_;
    double square_ = 0.0;  // size of the polygon, squared
    std::vector<double> cost_;
    std::vector<std::size_t> apex_;
    Index nearest_ = no_index;  // of the input, to the last place that was looked at: the next one is near
};

using Cut = std::vector<std::array<std::size_t, 3>>;

/// Of the chain from corner i to corner j.
std::vector<Cut> cuts_of_chain(std::size_t i, std::size_t j) {
    if (j - i < 2) return {Cut{}};
    std::vector<Cut> cuts;
    for (std::size_t k = i + 1; k < j; ++k)
        for (const Cut& left : cuts_of_chain(i, k))
            for (const Cut& right : cuts_of_chain(k, j)) {
                Cut& cut = cuts.emplace_back(left);
                cut.insert(cut.end(), right.begin(), right.end());
                cut.push_back({i, k, j});
            }
    return cuts;
}

}  // namespace

void clip_ears(std::span<const Point3> points, std::span<const Index> ring, const core::TriangleTree& input,
               Triangles& triangles) {
    Cutter(points, ring, input).cut_ears(triangles);
}

std::vector<std::vector<std::array<std::size_t, 3>>> all_triangulations(std::size_t n) {
    return cuts_of_chain(0, n - 1);
}

void triangulate_polygon(std::span<const Point3> points, std::span<const Index> ring, const core::TriangleTree& input,
                         std::vector<std::array<Index, 3>>& triangles) {
    if (ring.size() == 3) {
        triangles.push_back({ring[0], ring[1], ring[2]});
        return;
    }
    Cutter cutter(points, ring, input);
    if (ring.size() <= largest_exact) {
        cutter.cut_best(triangles);
    } else {
        cutter.cut_ears(triangles);
    }
}

std::vector<std::array<Index, 3>> triangulate(const CoarseMesh& mesh, const core::TriangleTree& input,
                                              std::vector<Index>* polygon_of) {
    std::vector<std::array<Index, 3>> triangles;
    if (polygon_of != nullptr) polygon_of->clear();
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        triangulate_polygon(mesh.points, mesh.polygon(q), input, triangles);
        if (polygon_of != nullptr) polygon_of->resize(triangles.size(), static_cast<Index>(q));
    }
    return triangles;
}

}  // namespace certa::remeshing
