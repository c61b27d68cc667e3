// A greedy loop over contractions.
//
// A polygon's cost is the integral of (h - l)^2, where h is the surface's height over it and l the linear function that
// is nearest to it: what placement can reach. By quadrics, fitted once, the cheapest contractions are found; those at
// the front of the queue are measured on the surface itself, where peaks count more, before they are done. Triangles
// cost something on top, quads shall stay.
#include "remeshing/coarsen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>

#include "core/vector3.h"

namespace certa::remeshing {
namespace {

constexpr double odd_cost = 0.3;       ///< of a polygon with an odd number of corners, in costs of a mean one
constexpr double least_cosine = 0.8;   ///< between the normals of a polygon before and after
constexpr double most_reflex = 0.15;   ///< sine by which a corner may turn the other way
constexpr double least_area = 0.2;     ///< of what a polygon had, that it has to keep
constexpr std::size_t most_sides = 7;  ///< at one vertex

/// Second derivatives of the height, in space.
using Tensor = std::array<double, 6>;  // xx, yy, zz, xy, yz, zx

Tensor& add(Tensor& sum, const Point3& d, double k) {
    const Tensor t{d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.y * d.z, d.z * d.x};
    for (std::size_t i = 0; i < 6; ++i) sum[i] += k * t[i];
    return sum;
}
double height(const Tensor& t, const Point3& x) {
    return 0.5 * (t[0] * x.x * x.x + t[1] * x.y * x.y + t[2] * x.z * x.z) + t[3] * x.x * x.y + t[4] * x.y * x.z +
           t[5] * x.z * x.x;
}

Point3 unit(const Point3& v) {
    const double length = norm(v);
    return length > 0.0 ? (1.0 / length) * v : Point3{};
}

using Corners = std::vector<Point3>;

Point3 mean_of(const Corners& corners) {
    Point3 sum;
    for (const Point3& p : corners) sum = sum + p;
    return (1.0 / static_cast<double>(corners.size())) * sum;
}
/// Twice the area is its length.
Point3 normal_of(const Corners& corners) {
    Point3 sum;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        sum = sum + cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    return sum;
}

/// Normal equations of a least-squares fit.
template <std::size_t Size>
struct Fit {
    std::array<std::array<double, Size>, Size> left{};
    std::array<double, Size> right{};
    double squares = 0.0;  ///< of what is fitted; after `solve`, of what is left of it

    void add(const std::array<double, Size>& row, double value, double weight) {
        for (std::size_t r = 0; r < Size; ++r) {
            right[r] += weight * value * row[r];
            for (std::size_t c = 0; c < Size; ++c) left[r][c] += weight * row[r] * row[c];
        }
        squares += weight * value * value;
    }
    /// By Gauss without pivots: the matrix is positive definite, but for directions that nothing is known of, which
    /// get 0.
    std::array<double, Size> solve() {
        constexpr double least = 1e-9;
        std::array<double, Size> scale{}, x{};
        for (std::size_t c = 0; c < Size; ++c) scale[c] = left[c][c];
        for (std::size_t c = 0; c < Size; ++c) {
            if (!(left[c][c] > least * scale[c])) {
                left[c][c] = 0.0;
                continue;
            }
            for (std::size_t r = c + 1; r < Size; ++r) {
                const double part = left[r][c] / left[c][c];
                for (std::size_t k = c; k < Size; ++k) left[r][k] -= part * left[c][k];
                right[r] -= part * right[c];
            }
            squares -= right[c] * right[c] / left[c][c];
        }
        for (std::size_t c = Size; c-- > 0;) {
            if (left[c][c] == 0.0) continue;
            x[c] = right[c];
            for (std::size_t k = c + 1; k < Size; ++k) x[c] -= left[c][k] * x[k];
            x[c] /= left[c][c];
        }
        return x;
    }
};

/// A frame in a polygon's plane.
struct Frame {
    explicit Frame(const Corners& corners) : middle(mean_of(corners)), normal(unit(normal_of(corners))) {
        const Point3 first = corners[0] - middle;
        axis = unit(first - dot(first, normal) * normal);
        other = cross(normal, axis);
    }
    Point3 middle, normal, axis, other;
};

/// The residual of a least-squares fit of 1, u and v to the height, integrated over the triangles around the middle.
/// `height_at` is told points relative to the middle; squares of residuals above `peak` count up to twice and more.
template <class Height>
double cost_of(const Corners& corners, double peak, const Height& height_at) {
    // Exact to fourth order.
    constexpr double near = 0.091576213509771, far = 0.445948490915965;
    constexpr double of_near = 0.109951743655322, of_far = 0.223381589678011;
    struct Sample {
        double u = 0.0, v = 0.0, height = 0.0, area = 0.0;
    };
    const Frame frame(corners);
    std::vector<Sample> samples;
    samples.reserve(6 * corners.size());
    Fit<3> fit;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point3 a = corners[i] - frame.middle, b = corners[(i + 1) % corners.size()] - frame.middle;
        const double area = 0.5 * norm(cross(a, b));
        for (int k = 0; k < 6; ++k) {
            const double s = k < 3 ? near : far, rest = 1.0 - 2.0 * s;
            const Point3 x = (k % 3 == 1 ? rest : s) * a + (k % 3 == 2 ? rest : s) * b;
            samples.push_back(
                {dot(x, frame.axis), dot(x, frame.other), height_at(frame, x), area * (k < 3 ? of_near : of_far)});
            const Sample& sample = samples.back();
            fit.add({1.0, sample.u, sample.v}, sample.height, sample.area);
        }
    }
    const auto plane = fit.solve();
    if (peak <= 0.0) return std::max(fit.squares, 0.0);
    double cost = 0.0;
    for (const Sample& sample : samples) {
        const double off = sample.height - plane[0] - plane[1] * sample.u - plane[2] * sample.v;
        cost += sample.area * off * off * (1.0 + off * off / peak);
    }
    return cost;
}
double estimate(const Corners& corners, const Tensor& tensor) {
    return cost_of(corners, 0.0, [&](const Frame&, const Point3& x) { return height(tensor, x); });
}

struct Candidate {
    double cost = 0.0;
    Index v = no_index, into = no_index;
    bool is_measured = false;
    std::uint32_t stamp = 0;
    Point3 place;                                                    ///< of what is left
    friend bool operator<(const Candidate& l, const Candidate& r) {  // the cheapest first
        if (l.cost != r.cost) return l.cost > r.cost;
        return l.v != r.v ? l.v > r.v : l.into > r.into;
    }
};

class Coarsener {
public:
    Coarsener(const core::TriangleTree& tree, const ArrangementRule& rule, std::span<const std::uint8_t> is_free,
              CoarseMesh& mesh)
        : tree_(tree), is_free_(is_free), mesh_(mesh), contraction_(mesh, rule) {
        stamps_.assign(mesh.points.size(), 0);
        double area = 0.0, squares = 0.0;
        for (Index q = 0; q < mesh.polygon_count(); ++q) {
            const Corners corners = corners_of(q);
            tensors_.push_back(tensor_at(q));
            costs_[0].push_back(estimate(corners, tensors_.back()));
            costs_[1].push_back(measure(corners, 0.0));
            area += 0.5 * norm(normal_of(corners));
            mean_costs_[0] += costs_[0].back() / static_cast<double>(mesh.polygon_count());
            squares += costs_[1].back();
        }
        peak_ = 4.0 * squares / area;
        for (Index q = 0; q < mesh.polygon_count(); ++q) {
            costs_[1][q] = measure(corners_of(q), peak_);
            mean_costs_[1] += costs_[1][q] / static_cast<double>(mesh.polygon_count());
        }
    }

    std::vector<MergedVertex> run(std::size_t count) {
        for (Index q = 0; q < contraction_.polygon_count(); ++q) push_all(q);
        while (count > 0 && !queue_.empty()) {
            Candidate next = queue_.top();
            queue_.pop();
            if (next.stamp != stamps_[next.v] + stamps_[next.into]) continue;
            if (!next.is_measured) {
                next.is_measured = true;
                if (find_cost(next)) queue_.push(next);
                continue;
            }
            if (!contraction_.merge(next.v, next.into)) continue;
            --count;
            if (mesh_.kinds[next.into] == VertexKind::smooth) {
                const core::NearestPoint nearest = tree_.find_nearest(next.place);
                mesh_.points[next.into] = nearest.point;
                mesh_.places[next.into] = {nearest.triangle, nearest.weights};
            }
            renew(next.into);
        }
        return contraction_.write_back();
    }

private:
    /// Least squares of a quadric over points of the surface below and, but at features, around the polygon.
    Tensor tensor_at(Index q) const {
        const Corners corners = corners_of(q);
        const auto& ring = contraction_.ring(q);
        const bool is_inside =
            std::all_of(ring.begin(), ring.end(), [&](Index v) { return mesh_.kinds[v] == VertexKind::smooth; });
        const Frame frame(corners);
        const double size = norm(corners[0] - frame.middle);
        Fit<6> fit;
        const auto add_point = [&](const Point3& p) {
            const Point3 x = (1.0 / size) * (tree_.find_nearest(p).point - frame.middle);
            const double u = dot(x, frame.axis), v = dot(x, frame.other);
            fit.add({1.0, u, v, 0.5 * u * u, u * v, 0.5 * v * v}, dot(x, frame.normal), 1.0);
        };
        add_point(frame.middle);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Point3 side = 0.5 * (corners[i] + corners[(i + 1) % corners.size()]);
            for (const double s : {0.5, 1.0, 1.4}) {
                if (s > 1.0 && !is_inside) continue;
                add_point(frame.middle + s * (corners[i] - frame.middle));
                add_point(frame.middle + s * (side - frame.middle));
            }
        }
        const auto x = fit.solve();
        Tensor sum{};
        add(sum, frame.axis, (x[3] - x[4]) / size);
        add(sum, frame.other, (x[5] - x[4]) / size);
        return add(sum, frame.axis + frame.other, x[4] / size);
    }

    /// With v and `into` at `place`, once.
    Corners corners_of(Index q, Index v, Index into, const Point3& place) const {
        Corners corners;
        const auto& ring = contraction_.ring(q);
        const bool has_both = v != no_index && std::find(ring.begin(), ring.end(), into) != ring.end();
        for (const Index x : ring) {
            if (x == v && has_both) continue;
            corners.push_back(x == v || x == into ? place : mesh_.points[x]);
        }
        return corners;
    }

    Corners corners_of(Index q) const { return corners_of(q, no_index, no_index, {}); }
    /// On the surface itself.
    double measure(const Corners& corners, double peak) const {
        return cost_of(corners, peak, [&](const Frame& frame, const Point3& x) {
            return dot(tree_.find_nearest(frame.middle + x).point - frame.middle, frame.normal);
        });
    }

    bool may_move(Index v) const { return v < is_free_.size() && is_free_[v] != 0; }
    void push(Index v, Index into) {
        if (!may_move(v) || !may_move(into)) return;
        const bool is_free = mesh_.kinds[v] == VertexKind::smooth && mesh_.kinds[into] == VertexKind::smooth;
        Candidate candidate{0.0, v, into, false, stamps_[v] + stamps_[into], mesh_.points[into]};
        if (is_free) candidate.place = 0.5 * (mesh_.points[v] + mesh_.points[into]);
        if (find_cost(candidate)) queue_.push(candidate);
    }
    /// False: it must not be.
    bool find_cost(Candidate& candidate) const {
        const auto& [v, into] = std::tie(candidate.v, candidate.into);
        const auto &of_v = contraction_.around(v), &of_into = contraction_.around(into);
        if (of_v.size() + of_into.size() > most_sides + 2) return false;
        std::vector<Index> changed = contraction_.changed_by(v, into), before = of_v;
        if (changed.empty()) return false;
        for (const Index q : of_into)
            if (std::find(of_v.begin(), of_v.end(), q) == of_v.end()) changed.push_back(q), before.push_back(q);
        const std::size_t kind = candidate.is_measured ? 1 : 0;
        const double of_odd = odd_cost * mean_costs_[kind];
        candidate.cost = mesh_.kinds[v] != VertexKind::smooth ? curve_cost(v, into) : 0.0;
        for (const Index q : before)
            candidate.cost -= costs_[kind][q] + (contraction_.ring(q).size() % 2 == 1 ? of_odd : 0.0);
        for (const Index q : changed) {
            const Corners after = corners_of(q, v, into, candidate.place);
            if (!is_sound(corners_of(q), after)) return false;
            candidate.cost += candidate.is_measured ? measure(after, peak_) : estimate(after, tensors_[q]);
            candidate.cost += after.size() % 2 == 1 ? of_odd : 0.0;
        }
        return true;
    }
    /// What a curve's new side is off, over a strip as wide as a polygon.
    double curve_cost(Index v, Index into) const {
        double sum = 0.0;
        for (const Index x : contraction_.neighbours(v)) {
            if (x == into || !contraction_.is_feature_side(v, x)) continue;
            const Point3 &a = mesh_.points[into], &b = mesh_.points[x], &p = mesh_.points[v];
            const double length = distance(a, b), off = length > 0.0 ? norm(cross(b - a, p - a)) / length : 0.0;
            sum += off * off * length * length;
        }
        return sum;
    }
    static bool is_sound(const Corners& before, const Corners& after) {
        const Point3 was = normal_of(before), is = normal_of(after), normal = unit(is);
        if (dot(normal, unit(was)) < least_cosine || norm(is) < least_area * norm(was)) return false;
        for (std::size_t i = 0; i < after.size(); ++i) {
            const Point3 in = unit(after[i] - after[(i + after.size() - 1) % after.size()]);
            const Point3 out = unit(after[(i + 1) % after.size()] - after[i]);
            if (dot(cross(in, out), normal) < -most_reflex) return false;
        }
        return true;
    }

    void push_all(Index q) {
        const std::vector<Index> ring = contraction_.ring(q);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            push_both(ring[i], ring[(i + 1) % ring.size()]);
            if (ring.size() == 4 && i < 2) push_both(ring[i], ring[i + 2]);
        }
    }
    /// Of two that may both move, one way will do.
    void push_both(Index a, Index b) {
        const bool is_free = mesh_.kinds[a] == VertexKind::smooth && mesh_.kinds[b] == VertexKind::smooth;
        push(std::max(a, b), std::min(a, b));
        if (!is_free) push(std::min(a, b), std::max(a, b));
    }
    /// All that has to do with the polygons around a vertex.
    void renew(Index v) {
        std::vector<Index> near, far;
        for (const Index q : contraction_.around(v)) {
            costs_[0][q] = estimate(corners_of(q), tensors_[q]);
            costs_[1][q] = measure(corners_of(q), peak_);
            near.insert(near.end(), contraction_.ring(q).begin(), contraction_.ring(q).end());
        }
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        for (const Index x : near) {
            ++stamps_[x];
            far.insert(far.end(), contraction_.around(x).begin(), contraction_.around(x).end());
        }
        std::sort(far.begin(), far.end());
        far.erase(std::unique(far.begin(), far.end()), far.end());
        for (const Index q : far) push_all(q);
    }

    const core::TriangleTree& tree_;
    const std::span<const std::uint8_t> is_free_;
    CoarseMesh& mesh_;
    Contraction contraction_;
    std::vector<Tensor> tensors_;               ///< per polygon, as it was at first
    std::array<std::vector<double>, 2> costs_;  ///< per polygon: estimated, measured
    std::array<double, 2> mean_costs_{};
    double peak_ = 0.0;
    std::vector<std::uint32_t> stamps_;  ///< per vertex: how often what is around it has changed
    std::priority_queue<Candidate> queue_;
};

}  // namespace

std::vector<MergedVertex> coarsen(const core::TriangleTree& tree, const ArrangementRule& rule, std::size_t count,
                                  std::span<const std::uint8_t> is_free, CoarseMesh& mesh) {
    return Coarsener(tree, rule, is_free, mesh).run(count);
}

}  // namespace certa::remeshing
