// Vertices off the surface: chords of an arc are best when they are half inside and half outside.
//
// A round: cut the polygons along the diagonals nearest to the input; for samples of the triangles find the nearest
// points of the input, for samples of the input the nearest points of the triangles (a cap that the coarse mesh leaves
// out shows only there). Each pair says: along the input's normal there, the coarse point, a weighted mean of three
// vertices, should move by so much. The sum of squares becomes least by a factorization over the vertices, with a weak
// spring against sliding along the surface. A step is kept if the measured distances agree; else half of it is tried.
// At the end what turned away or met something is taken back.
// Lengths are scaled so that the input's box has diagonal 1.
#include "remeshing/placement.h"

#include <certa/surface_check.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/parallel.h"
#include "core/random.h"
#include "core/triangle_tree.h"
#include "core/vector3.h"
#include "remeshing/triangulate.h"
#include "remeshing/walker.h"

namespace certa::remeshing {
namespace {

using core::NearestPoint;
using core::TriangleTree;

constexpr double least_agreement = 0.25;  // cosine between the normals of the two ends of a pair
constexpr double sideways = 0.7;          // cosine between the way to the nearest point and the normal there
constexpr double input_share = 0.1;       // of the samples of the input in the weight of all
constexpr double samples_per_side = 6.0, curve_weight = 0.3;  // of samples of creases and the boundary
constexpr int half_steps = 5;

/// The point of triangle `triangle` with weights w, and what is over there.
struct Pair {
    Index triangle = no_index;
    std::array<double, 3> w{};
    Point3 normal;          // of the input
    double along = 0.0;     // from the input to the coarse mesh, along the normal
    double distance = 0.0;  // to the nearest point
    double weight = 0.0;    // sums to 1; 0 where the sheets do not correspond
};

struct Curve {
    std::vector<Point3> points;
    std::vector<Triangle> segments;  // (a, b, b)
    std::unique_ptr<TriangleTree> tree;
};

Point3 unit(const Point3& v) {
    const double length = norm(v);
    return length > 0.0 ? (1.0 / length) * v : Point3{};
}

/// x^p; fast where p is an even whole number.
double raise(double x, double p) {
    if (p == 2.0) return x * x;
    if (p == 4.0) return (x * x) * (x * x);
    if (p == 6.0) return (x * x) * (x * x) * (x * x);
    return std::pow(x, p);
}

class Placement {
public:
    Placement(const TriangleMesh& input, std::span<const FeatureEdge> features, CoarseMesh& mesh,
              const PlacementOptions& options, const RunControl& control)
        : input_(input), mesh_(mesh), options_(options), control_(control) {
        scale_input();
        for (Point3& p : mesh_.points) p = scale_ * (p - origin_);
        initial_ = mesh_.points;
        tree_ = std::make_unique<TriangleTree>(input_.positions, input_.triangles);
        walker_ = std::make_unique<Walker>(input_.positions, input_.triangles);
        for (const Triangle& t : input_.triangles) {
            const Point3 &a = position(t[0]), &b = position(t[1]), &c = position(t[2]);
            const Point3 area = cross(b - a, c - a);
            areas_.push_back(0.5 * norm(area));
            normals_.push_back(unit(area));
        }
        build_curves(features);
    }

    PlacementReport run() {
        PlacementReport report;
        measure(2.0);
        report.rms_before = rms_, report.largest_before = largest_;
        const std::uint32_t all = options_.rounds + options_.peak_rounds;
        for (std::uint32_t round = 0; round < all && !control_.cancelled(); ++round) {
            const bool is_peak = round >= options_.rounds;
            if (round == options_.rounds) objective_ = power_mean(options_.peak_power);
            control_.report("placement", double(round) / all);
            if (improve(is_peak ? options_.peak_power : 2.0)) {
                ++report.rounds;
            } else if (is_peak || options_.peak_rounds == 0) {
                break;
            } else {
                round = options_.rounds - 1;
            }
        }
        if (all > 0) take_back_damage();
        report.farthest = farthest_of_polygons();
        report.rms_after = rms_ / scale_, report.largest_after = largest_ / scale_;
        report.rms_before /= scale_, report.largest_before /= scale_;
        if (control_.cancelled()) report.outcome = Outcome::cancelled;
        finish();
        return report;
    }

private:
    const Point3& position(VertexId v) const { return input_.positions[index_of(v)]; }

    void scale_input() {
        Point3 low = input_.positions.front(), high = low;
        for (const Point3& p : input_.positions) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        origin_ = 0.5 * (low + high);
        const double diagonal = distance(low, high);
        scale_ = diagonal > 0.0 ? 1.0 / diagonal : 1.0;
        for (Point3& p : input_.positions) p = scale_ * (p - origin_);
    }

    void build_curves(std::span<const FeatureEdge> features) {
        for (const FeatureEdge& edge : features) {
            if (edge.curve >= curves_.size()) curves_.resize(edge.curve + 1);
            Curve& curve = curves_[edge.curve];
            const auto first = static_cast<std::uint32_t>(curve.points.size());
            curve.points.push_back(input_.positions[edge.a]);
            curve.points.push_back(input_.positions[edge.b]);
            curve.segments.push_back({VertexId{first}, VertexId{first + 1}, VertexId{first + 1}});
        }
        for (Curve& curve : curves_) curve.tree = std::make_unique<TriangleTree>(curve.points, curve.segments);
    }
    const Curve* curve_of(Index v) const {
        if (mesh_.kinds[v] != VertexKind::crease && mesh_.kinds[v] != VertexKind::boundary) return nullptr;
        const Index c = mesh_.curves[v];
        return c < curves_.size() && !curves_[c].tree->empty() ? &curves_[c] : nullptr;
    }
    /// Vertices bound to a curve that is not there stay, as corners do.
    bool is_fixed(Index v) const {
        return v >= options_.fixed_from || (mesh_.kinds[v] != VertexKind::smooth && curve_of(v) == nullptr);
    }

    Point3 tangent_at(const Curve& curve, const Point3& p) const {
        const Index s = curve.tree->find_nearest(p).triangle;
        return unit(curve.points[2 * s + 1] - curve.points[2 * s]);
    }

    // Pairs ------------------------------------------------------------------------------------------------------

    /// The same points on the input in every round, by area and stratified.
    void sample_input(std::size_t count) {
        std::vector<double> before(areas_.size() + 1, 0.0);
        for (std::size_t t = 0; t < areas_.size(); ++t) before[t + 1] = before[t] + areas_[t];
        core::Random random(options_.seed);
        input_samples_.clear();
        for (std::size_t k = 0; k < count; ++k) {
            const double goal = (double(k) + random.uniform()) / double(count) * before.back();
            const auto after = std::upper_bound(before.begin() + 1, before.end() - 1, goal);
            const auto t = static_cast<Index>(after - before.begin() - 1);
            const double root = std::sqrt(random.uniform()), v = random.uniform();
            const Triangle& c = input_.triangles[t];
            input_samples_.push_back(
                {(1.0 - root) * position(c[0]) + root * (1.0 - v) * position(c[1]) + root * v * position(c[2]), t});
        }
        surface_samples_ = count;
        sample_curves();
        hints_of_input_samples_.assign(input_samples_.size(), no_index);
    }
    /// Points of creases and the boundary: samples of the surface miss how far these are off.
    void sample_curves() {
        double length = 0.0, done = 0.0, next = 0.5;
        for (const Curve& curve : curves_)
            for (const Triangle& s : curve.segments)
                length += distance(curve.points[index_of(s[0])], curve.points[index_of(s[1])]);
        const double step = length / (samples_per_side * double(std::max<std::size_t>(mesh_.feature_edges.size(), 1)));
        for (const Curve& curve : curves_)
            for (const Triangle& s : curve.segments) {
                const Point3 &a = curve.points[index_of(s[0])], &b = curve.points[index_of(s[1])];
                const double here = distance(a, b) / step;
                for (; next < done + here; next += 1.0) {
                    const double t = (next - done) / here;
                    const Point3 p = (1.0 - t) * a + t * b;
                    input_samples_.push_back({p, tree_->find_nearest(p).triangle});
                }
                done += here;
            }
    }

    struct Sample {
        std::array<double, 3> w{};
        double weight = 1.0;
    };
    /// A triangular lattice at the centroids of its cells: k * k points; and, because distances are largest there, the
    /// corners and the middles of the sides with little weight.
    static std::vector<Sample> lattice(std::uint32_t least) {
        std::uint32_t k = 1;
        while (k * k < least) ++k;
        std::vector<Sample> samples;
        const auto add = [&](double u, double v, double weight) { samples.push_back({{1.0 - u - v, u, v}, weight}); };
        for (std::uint32_t i = 0; i < k; ++i)
            for (std::uint32_t j = 0; i + j < k; ++j) {
                const double u = (i + 1.0 / 3.0) / k, v = (j + 1.0 / 3.0) / k;
                add(u, v, 1.0);
                if (i + j + 1 < k) add(u + 1.0 / 3.0 / k, v + 1.0 / 3.0 / k, 1.0);
            }
        constexpr double little = 0.1;
        add(0.0, 0.0, little), add(1.0, 0.0, little), add(0.0, 1.0, little);
        add(0.5, 0.0, little), add(0.5, 0.5, little), add(0.0, 0.5, little);
        double sum = 0.0;
        for (const Sample& sample : samples) sum += sample.weight;
        for (Sample& sample : samples) sample.weight /= sum;
        return samples;
    }

    /// What was nearest before, and its neighbours; where they are not near, or never were, whatever is.
    NearestPoint find_near(const Point3& x, Index hint) const {
        constexpr double near = 3.0;  // root mean squares
        if (may_walk_ && hint != no_index)
            if (const auto found = walker_->find(x, hint); found && found->squared_distance < near * near * rms_ * rms_)
                return *found;
        return tree_->find_nearest(x, hint);
    }
    void pair_coarse_samples() {
        const std::size_t per_triangle = lattice_.size();
        double area = 0.0;
        for (const double a : coarse_areas_) area += a;
        pairs_.resize(triangles_.size() * per_triangle);
        hints_.resize(pairs_.size(), no_index);
        core::parallel_for(triangles_.size(), 32, control_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) {
                const auto& c = triangles_[t];
                for (std::size_t s = 0; s < per_triangle; ++s) {
                    Pair& pair = pairs_[t * per_triangle + s];
                    Index& hint = hints_[t * per_triangle + s];  // of the last round
                    if (hint == no_index && s > 0) hint = hints_[t * per_triangle + s - 1];
                    pair.triangle = static_cast<Index>(t);
                    pair.w = lattice_[s].w;
                    const Point3 x = pair.w[0] * mesh_.points[c[0]] + pair.w[1] * mesh_.points[c[1]] +
                                     pair.w[2] * mesh_.points[c[2]];
                    const NearestPoint nearest = find_near(x, hint);
                    hint = nearest.triangle;
                    fill(pair, x, nearest.point, std::sqrt(nearest.squared_distance), normals_[hint]);
                    pair.weight *= (1.0 - input_share) * coarse_areas_[t] / area * lattice_[s].weight;
                }
            }
        });
    }
    void pair_input_samples() {
        std::vector<Triangle> triangles;
        for (std::size_t i = 0; i < nearest_count_; ++i) {
            const auto& t = triangles_[i];
            triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
        }
        const TriangleTree coarse(mesh_.points, triangles);
        const std::size_t first = pairs_.size();
        pairs_.resize(first + input_samples_.size());
        core::parallel_for(input_samples_.size(), 256, control_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) {
                const auto& [p, face] = input_samples_[s];
                Index& hint = hints_of_input_samples_[s];
                NearestPoint nearest = coarse.find_nearest(p, hint < triangles.size() ? hint : no_index);
                hint = nearest.triangle;
                if (options_.both_diagonals && other_[hint] != no_index) nearest = farther(p, nearest, other_[hint]);
                Pair& pair = pairs_[first + s];
                pair.triangle = nearest.triangle;
                pair.w = nearest.weights;
                fill(pair, nearest.point, p, std::sqrt(nearest.squared_distance), normals_[face]);
                if (s >= surface_samples_) pair.weight = curve_weight;
                pair.weight *= input_share / double(surface_samples_);
            }
        });
    }
    /// The nearest point, or that on the quad's other two triangles, whichever is farther.
    NearestPoint farther(const Point3& p, const NearestPoint& nearest, Index first) const {
        NearestPoint best;
        best.squared_distance = std::numeric_limits<double>::infinity();
        for (const Index t : {first, first + 1}) {
            const auto& c = triangles_[t];
            NearestPoint other =
                core::find_nearest_on_triangle(p, mesh_.points[c[0]], mesh_.points[c[1]], mesh_.points[c[2]]);
            other.triangle = t;
            if (other.squared_distance < best.squared_distance) best = other;
        }
        return best.squared_distance > nearest.squared_distance ? best : nearest;
    }
    void fill(Pair& pair, const Point3& coarse, const Point3& input, double distance, const Point3& normal) const {
        pair.normal = normal;
        pair.along = dot(normal, coarse - input);
        pair.distance = distance;
        pair.weight = dot(normal, coarse_normals_[pair.triangle]) >= least_agreement ? 1.0 : 0.0;
        // Beside creases and the boundary the distance goes sideways.
        if (distance > 1e-9 && std::abs(pair.along) < sideways * distance) {
            pair.normal = (1.0 / distance) * (coarse - input);
            pair.along = distance;
        }
    }

    /// All pairs for the mesh as it is, and the objective.
    void measure(double power) {
        triangles_ = triangulate(mesh_, *tree_, &polygon_of_);
        nearest_count_ = triangles_.size();
        if (options_.both_diagonals) add_other_diagonals();
        if (lattice_.empty()) {
            lattice_ = lattice(options_.samples_per_triangle);
            sample_input(nearest_count_ * 6);
        }
        coarse_areas_.clear(), coarse_normals_.clear();
        for (const auto& t : triangles_) {
            const Point3 area = cross(mesh_.points[t[1]] - mesh_.points[t[0]], mesh_.points[t[2]] - mesh_.points[t[0]]);
            coarse_areas_.push_back(0.5 * norm(area));
            coarse_normals_.push_back(unit(area));
        }
        pair_coarse_samples();
        may_walk_ = true;
        pair_input_samples();
        rms_ = power_mean(2.0);
        largest_ = 0.0;
        for (const Pair& pair : pairs_) largest_ = std::max(largest_, pair.distance);
        objective_ = power == 2.0 ? rms_ : power_mean(power);
    }
    std::vector<double> farthest_of_polygons() const {
        std::vector<double> farthest(mesh_.polygon_count(), 0.0);
        for (const Pair& pair : pairs_) {
            double& most = farthest[polygon_of_[pair.triangle]];
            most = std::max(most, pair.distance / scale_);
        }
        return farthest;
    }
    /// The triangles of quads on the diagonals that are not the nearest, after all others.
    void add_other_diagonals() {
        other_.assign(nearest_count_, no_index);
        std::size_t next = 0;
        for (std::size_t q = 0; q < mesh_.polygon_count(); ++q) {
            const auto ring = mesh_.polygon(q);
            const std::size_t first = next;
            next += ring.size() - 2;
            if (ring.size() != 4) continue;
            const auto& t = triangles_[first];
            const bool on_02 = std::find(t.begin(), t.end(), ring[0]) != t.end() &&
                               std::find(t.begin(), t.end(), ring[2]) != t.end() &&
                               std::find(triangles_[first + 1].begin(), triangles_[first + 1].end(), ring[0]) !=
                                   triangles_[first + 1].end() &&
                               std::find(triangles_[first + 1].begin(), triangles_[first + 1].end(), ring[2]) !=
                                   triangles_[first + 1].end();
            const std::size_t s = on_02 ? 1 : 0;
            const std::array<Index, 3> l{ring[s], ring[s + 1], ring[s + 2]}, r{ring[s], ring[s + 2], ring[(s + 3) % 4]};
            const auto area = [&](const std::array<Index, 3>& c) {
                return cross(mesh_.points[c[1]] - mesh_.points[c[0]], mesh_.points[c[2]] - mesh_.points[c[0]]);
            };
            const Point3 normal =
                cross(mesh_.points[ring[2]] - mesh_.points[ring[0]], mesh_.points[ring[3]] - mesh_.points[ring[1]]);
            if (dot(area(l), normal) <= 0.0 || dot(area(r), normal) <= 0.0) continue;
            other_[first] = other_[first + 1] = static_cast<Index>(triangles_.size());
            triangles_.push_back(l), triangles_.push_back(r);
            polygon_of_.resize(triangles_.size(), static_cast<Index>(q));
        }
    }
    double power_mean(double power) const {
        double sum = 0.0, largest = 0.0, weights = 0.0;
        for (const Pair& pair : pairs_) largest = std::max(largest, pair.weight > 0.0 ? pair.distance : 0.0);
        if (largest == 0.0) return 0.0;
        for (const Pair& pair : pairs_) {
            sum += pair.weight * raise(pair.distance / largest, power);
            weights += pair.weight;
        }
        return largest * std::pow(sum / weights, 1.0 / power);
    }

    // One step ---------------------------------------------------------------------------------------------------

    bool improve(double power) {
        const std::vector<Point3> start = mesh_.points;
        const double before = objective_;
        const std::vector<Point3> step = solve(power);
        if (step.empty()) return false;
        std::vector<double> lengths(start.size(), 1.0);
        const double scale = largest_;
        const bool is_local = options_.both_diagonals && power > 2.0;
        const std::vector<double> shares = is_local ? shares_of_polygons(power, scale) : std::vector<double>{};
        for (int i = 0; i < half_steps; ++i) {
            for (std::size_t v = 0; v < start.size(); ++v) mesh_.points[v] = start[v] + lengths[v] * step[v];
            return_to_curves();
            undo_folds(start);
            measure(power);
            if (objective_ < before) return true;
            shorten(lengths, power, scale, shares);
        }
        mesh_.points = start;
        measure(power);
        return false;
    }

    /// What each polygon has of the sum that the objective is.
    std::vector<double> shares_of_polygons(double power, double scale) const {
        std::vector<double> shares(mesh_.polygon_count(), 0.0);
        for (const Pair& pair : pairs_)
            shares[polygon_of_[pair.triangle]] += pair.weight * raise(pair.distance / scale, power);
        return shares;
    }
    /// Half of the step: for peaks, only where a polygon has got worse, lest one place that nothing helps stop all.
    void shorten(std::vector<double>& lengths, double power, double scale, const std::vector<double>& before) const {
        if (before.empty()) {
            for (double& length : lengths) length *= 0.5;
            return;
        }
        const std::vector<double> after = shares_of_polygons(power, scale);
        std::vector<std::uint8_t> is_worse(lengths.size(), 0);
        for (std::size_t q = 0; q < after.size(); ++q)
            if (after[q] > before[q])
                for (const Index v : mesh_.polygon(q)) is_worse[v] = 1;
        for (std::size_t v = 0; v < lengths.size(); ++v)
            if (is_worse[v] != 0) lengths[v] *= 0.4;
    }

    using Block = std::array<double, 6>;  // symmetric: xx xy xz yy yz zz
    static Point3 times(const Block& m, const Point3& p) {
        return {m[0] * p.x + m[1] * p.y + m[2] * p.z, m[1] * p.x + m[3] * p.y + m[4] * p.z,
                m[2] * p.x + m[4] * p.y + m[5] * p.z};
    }
    static void add_outer(Block& m, double s, const Point3& n) {
        m[0] += s * n.x * n.x, m[1] += s * n.x * n.y, m[2] += s * n.x * n.z;
        m[3] += s * n.y * n.y, m[4] += s * n.y * n.z, m[5] += s * n.z * n.z;
    }
    /// The damped Gauss-Newton step; empty when nothing is to be done.
    std::vector<Point3> solve(double power) {
        assemble(power);
        const std::size_t n = mesh_.points.size();
        std::vector<int> first(n + 1, 0);  // of a vertex's unknowns
        for (std::size_t v = 0; v < n; ++v) first[v + 1] = first[v] + freedom_[v];
        // What a vertex may do: nothing, slide along a line, anything.
        const auto axis = [&](std::size_t v, int i) {
            if (freedom_[v] == 1) return tangents_[v];
            return Point3{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
        };
        std::vector<Eigen::Triplet<double>> entries;
        const auto add = [&](Index a, Index b, const Block& block) {
            for (int i = 0; i < freedom_[a]; ++i)
                for (int j = 0; j < freedom_[b]; ++j)
                    entries.emplace_back(first[a] + i, first[b] + j, dot(axis(a, i), times(block, axis(b, j))));
        };
        for (Index v = 0; v < n; ++v) add(v, v, diagonal_[v]);
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            const auto& c = triangles_[t];
            std::size_t slot = 0;
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = i + 1; j < 3; ++j) {
                    const Block& block = blocks_[t][slot++];
                    add(std::max(c[i], c[j]), std::min(c[i], c[j]), block);  // the lower half
                }
        }
        Eigen::SparseMatrix<double> matrix(first[n], first[n]);
        matrix.setFromTriplets(entries.begin(), entries.end());
        Eigen::VectorXd right(first[n]);
        for (std::size_t v = 0; v < n; ++v)
            for (int i = 0; i < freedom_[v]; ++i) right[first[v] + i] = dot(axis(v, i), right_[v]);
        if (right.size() == 0 || right.isZero(0.0)) return {};
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
        if (factors.info() != Eigen::Success) return {};
        const Eigen::VectorXd found = factors.solve(right);
        if (!found.allFinite()) return {};
        std::vector<Point3> step(n);
        for (std::size_t v = 0; v < n; ++v)
            for (int i = 0; i < freedom_[v]; ++i) step[v] = step[v] + found[first[v] + i] * axis(v, i);
        limit(step);
        return step;
    }

    void assemble(double power) {
        const std::size_t n = mesh_.points.size();
        blocks_.assign(triangles_.size(), {});
        diagonal_.assign(n, {});
        right_.assign(n, {});
        std::vector<Point3> mean_normals(n);
        std::vector<double> masses(n, 0.0);
        double largest = 0.0;
        for (const Pair& pair : pairs_)
            if (pair.weight > 0.0) largest = std::max(largest, pair.distance);
        for (const Pair& pair : pairs_) {
            if (pair.weight == 0.0) continue;
            double weight = pair.weight;
            if (power > 2.0) weight *= 0.02 + raise(pair.distance / largest, power - 2.0);
            const auto& c = triangles_[pair.triangle];
            auto& block = blocks_[pair.triangle];
            std::size_t slot = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                right_[c[i]] = right_[c[i]] - (weight * pair.w[i] * pair.along) * pair.normal;
                mean_normals[c[i]] = mean_normals[c[i]] + (weight * pair.w[i]) * pair.normal;
                masses[c[i]] += weight * pair.w[i] * pair.w[i];
                add_outer(diagonal_[c[i]], weight * pair.w[i] * pair.w[i], pair.normal);
                for (std::size_t j = i + 1; j < 3; ++j)
                    add_outer(block[slot++], weight * pair.w[i] * pair.w[j], pair.normal);
            }
        }
        freedom_.assign(n, 3);
        tangents_.assign(n, {});
        for (std::size_t v = 0; v < n; ++v) {
            const Point3 normal = unit(mean_normals[v]);
            const double spring = options_.anchor * masses[v];
            for (const std::size_t i : {0u, 3u, 5u}) diagonal_[v][i] += spring + 1e-9 * masses[v] + 1e-30;
            add_outer(diagonal_[v], -spring, normal);
            if (is_fixed(static_cast<Index>(v))) {
                freedom_[v] = 0;
            } else if (const Curve* curve = curve_of(static_cast<Index>(v))) {
                freedom_[v] = 1;
                tangents_[v] = tangent_at(*curve, mesh_.points[v]);
            }
        }
    }
    /// No vertex moves farther than a quarter of its shortest side.
    void limit(std::vector<Point3>& step) const {
        std::vector<double> shortest(step.size(), 1.0);
        for (std::size_t q = 0; q < mesh_.polygon_count(); ++q) {
            const auto ring = mesh_.polygon(q);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Index a = ring[i], b = ring[(i + 1) % ring.size()];
                const double length = distance(mesh_.points[a], mesh_.points[b]);
                shortest[a] = std::min(shortest[a], length), shortest[b] = std::min(shortest[b], length);
            }
        }
        for (std::size_t v = 0; v < step.size(); ++v) {
            const double length = norm(step[v]);
            if (length > 0.25 * shortest[v]) step[v] = (0.25 * shortest[v] / length) * step[v];
        }
    }

    void return_to_curves() {
        for (Index v = 0; v < mesh_.points.size(); ++v)
            if (const Curve* curve = curve_of(v); curve != nullptr && !is_fixed(v))
                mesh_.points[v] = curve->tree->find_nearest(mesh_.points[v]).point;
    }

    /// Halves the step of the corners of a polygon of which a triangle has turned away from the input; then undoes it.
    void undo_folds(const std::vector<Point3>& start) {
        std::vector<Point3> below(triangles_.size());  // mean normal of the input at the triangle's pairs
        for (const Pair& pair : pairs_) below[pair.triangle] = below[pair.triangle] + pair.weight * pair.normal;
        const auto agreement = [&](std::size_t t, const std::vector<Point3>& points) {
            const auto& c = triangles_[t];
            const Point3 area = cross(points[c[1]] - points[c[0]], points[c[2]] - points[c[0]]);
            return dot(unit(area), unit(below[t]));
        };
        for (int round = 0; round < 8; ++round) {
            bool is_folded = false;
            std::vector<std::uint8_t> is_moved_back(start.size(), 0);
            for (std::size_t t = 0; t < triangles_.size(); ++t) {
                const double now = agreement(t, mesh_.points);
                if (now >= 0.5 || now >= agreement(t, start) - 1e-9) continue;
                is_folded = true;
                for (const Index v : triangles_[t]) is_moved_back[v] = 1;
            }
            if (!is_folded) return;
            for (std::size_t v = 0; v < start.size(); ++v)
                if (is_moved_back[v]) mesh_.points[v] = round < 6 ? 0.5 * (mesh_.points[v] + start[v]) : start[v];
        }
    }

    /// Triangles that turn away from the input, and those that meet others beyond what they share.
    std::vector<Index> find_damage() const {
        std::vector<Index> bad;
        PolygonMesh cut;
        cut.positions = mesh_.points;
        for (std::size_t t = 0; t < nearest_count_; ++t) {
            const auto& c = triangles_[t];
            for (const Index v : c) cut.corners.push_back(VertexId{v});
            cut.offsets.push_back(static_cast<std::uint32_t>(cut.corners.size()));
            const Point3 middle = (1.0 / 3.0) * (mesh_.points[c[0]] + mesh_.points[c[1]] + mesh_.points[c[2]]);
            if (dot(normals_[tree_->find_nearest(middle).triangle], coarse_normals_[t]) <= 0.0)
                bad.push_back(static_cast<Index>(t));
        }
        for (const auto& [s, t] : find_contacts(cut, control_)) bad.insert(bad.end(), {s, t});
        return bad;
    }

    /// What steps and new diagonals together have spoilt goes half of the way back to where it was before placement,
    /// then all of it; where it was spoilt before, vertices go between their neighbours. The least damage counts.
    void take_back_damage() {
        constexpr int rounds = 12;
        std::vector<Index> damage = find_damage();
        std::vector<Point3> best = mesh_.points;
        std::size_t least = damage.size();
        for (int round = 0; round < rounds && !damage.empty() && !control_.cancelled(); ++round) {
            std::vector<std::uint8_t> is_bad = mark_vertices(damage);
            for (int ring = 2; ring < round; ring += 3) widen(is_bad);
            if (round < 4) {
                for (std::size_t v = 0; v < is_bad.size(); ++v)
                    if (is_bad[v] != 0)
                        mesh_.points[v] = round < 2 ? 0.5 * (mesh_.points[v] + initial_[v]) : initial_[v];
            } else {
                put_between_neighbours(is_bad);
            }
            return_to_curves();
            measure(2.0);
            damage = find_damage();
            if (damage.size() >= least) continue;
            least = damage.size();
            best = mesh_.points;
        }
        if (mesh_.points == best) return;
        mesh_.points = best;
        measure(2.0);
    }
    std::vector<std::uint8_t> mark_vertices(const std::vector<Index>& triangles) const {
        std::vector<std::uint8_t> is_marked(mesh_.points.size(), 0);
        for (const Index t : triangles)
            for (const Index v : triangles_[t]) is_marked[v] = 1;
        return is_marked;
    }
    void widen(std::vector<std::uint8_t>& is_marked) const {
        const std::vector<std::uint8_t> before = is_marked;
        for (const auto& t : triangles_)
            if (before[t[0]] + before[t[1]] + before[t[2]] > 0)
                for (const Index v : t) is_marked[v] = 1;
    }
    void put_between_neighbours(const std::vector<std::uint8_t>& is_marked) {
        std::vector<Point3> sums(mesh_.points.size());
        std::vector<double> counts(mesh_.points.size(), 0.0);
        for (const auto& t : triangles_)
            for (std::size_t i = 0; i < 3; ++i) {
                sums[t[i]] = sums[t[i]] + mesh_.points[t[(i + 1) % 3]] + mesh_.points[t[(i + 2) % 3]];
                counts[t[i]] += 2.0;
            }
        for (Index v = 0; v < is_marked.size(); ++v) {
            if (is_marked[v] == 0 || mesh_.kinds[v] != VertexKind::smooth || is_fixed(v)) continue;
            const Point3 middle = 0.5 * (mesh_.points[v] + (1.0 / counts[v]) * sums[v]);
            mesh_.points[v] = tree_->find_nearest(middle).point;
        }
    }

    void finish() {
        for (Index v = 0; v < mesh_.points.size(); ++v) {
            const NearestPoint nearest = tree_->find_nearest(mesh_.points[v]);
            mesh_.places[v] = {nearest.triangle, nearest.weights};
            mesh_.points[v] = (1.0 / scale_) * mesh_.points[v] + origin_;
        }
    }

    TriangleMesh input_;  // scaled
    CoarseMesh& mesh_;    // scaled until finish()
    const PlacementOptions options_;
    const RunControl& control_;
    Point3 origin_;
    double scale_ = 1.0;
    std::unique_ptr<TriangleTree> tree_;
    std::unique_ptr<Walker> walker_;
    bool may_walk_ = false;  // after the first search
    std::vector<double> areas_;
    std::vector<Point3> normals_;
    std::vector<Curve> curves_;
    std::vector<Point3> initial_;

    std::vector<std::array<Index, 3>> triangles_;  // of the coarse mesh, in this round
    std::size_t nearest_count_ = 0;                ///< so many are on the nearest diagonals
    std::vector<Index> polygon_of_;
    std::vector<Index> other_;  ///< of those: the first of two on the quad's other diagonal
    std::vector<double> coarse_areas_;
    std::vector<Point3> coarse_normals_;
    std::vector<Sample> lattice_;
    std::vector<std::pair<Point3, Index>> input_samples_;  // of the surface, then of the curves
    std::size_t surface_samples_ = 0;
    std::vector<Index> hints_, hints_of_input_samples_;
    std::vector<Pair> pairs_;
    double rms_ = 0.0, largest_ = 0.0, objective_ = 0.0;

    std::vector<std::array<Block, 3>> blocks_;  // of a triangle's sides 01, 02, 12
    std::vector<Block> diagonal_;
    std::vector<Point3> right_, tangents_;
    std::vector<std::uint8_t> freedom_;
};

}  // namespace

PlacementReport place_vertices(const TriangleMesh& input, std::span<const FeatureEdge> features, CoarseMesh& mesh,
                               const PlacementOptions& options, const RunControl& control) {
    if (mesh.points.empty() || input.triangles.empty()) return {};
    return Placement(input, features, mesh, options, control).run();
}

}  // namespace certa::remeshing
