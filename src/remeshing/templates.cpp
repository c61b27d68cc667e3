// The complete table of Figure 4.12, made where it is needed: for each polygon the best cut of all.
//
// A polygon with T-nodes is cut by diagonals into quads and triangles. Cost is a sum over pieces, so the best cut comes
// from dynamic programming over chains of corners (as for triangulations, with quads as a second kind of piece). On a
// rectangle with T-nodes anywhere on its sides this reproduces the thesis's conforming edges; tests go through all
// patterns. Polygons too large for that (n^4) are triangulated and their triangles paired, best pair first.
#include "remeshing/templates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/vector3.h"
#include "remeshing/triangulate.h"

namespace certa::remeshing {
namespace {

constexpr std::size_t largest_exact = 20;
constexpr double infinite = std::numeric_limits<double>::infinity();
using Piece = std::vector<Index>;

// A triangle is worth avoiding as long as the quads that do it have corners between about 30 and 150 degrees.
constexpr double quad_cost = 1.0, triangle_cost = 1.9;
constexpr double straight_cost = 20.0, reflex_cost = 1e4;

Point3 area_vector(std::span<const Point3> ring) {
    Point3 sum;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum = sum + cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
    return sum;
}

/// How bad the corner b between a and c is: 0 at a right angle, growing to straight and to a spike, jumping at reflex.
double corner_cost(const Point3& a, const Point3& b, const Point3& c, const Point3& normal) {
    const Point3 in = b - a, out = c - b;
    const double lengths = norm(in) * norm(out);
    if (!(lengths > 0.0)) return reflex_cost;
    const double sine = dot(cross(in, out), normal) / lengths, cosine = dot(in, out) / lengths;
    const double turned = std::atan2(sine, cosine);  // 0: straight on
    constexpr double nearly_straight = 0.2;          // radians
    if (turned < -nearly_straight) return reflex_cost;
    const double off = std::abs(turned - 1.5707963267948966) / 1.5707963267948966;  // 1: straight or a spike
    double cost = 0.6 * off * off * off;
    if (turned < nearly_straight) cost += straight_cost * (1.0 - turned / nearly_straight);
    return cost;
}

class Cutter {
public:
    explicit Cutter(std::span<const Point3> ring) : ring_(ring), n_(ring.size()) {
        const Point3 area = area_vector(ring);
        const double length = norm(area);
        if (length > 0.0) normal_ = (1.0 / length) * area;
    }

    std::vector<Piece> cut() {
        best_.assign(n_ * n_, {});
        for (std::size_t span = 2; span < n_; ++span)
            for (std::size_t i = 0; i + span < n_; ++i) solve(i, i + span);
        std::vector<Piece> pieces;
        collect(0, n_ - 1, pieces);
        return pieces;
    }

    double cost_of(const Piece& piece) const {
        double cost = piece.size() == 4 ? quad_cost : triangle_cost;
        cost += flatness_cost(piece);
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const Point3& a = ring_[piece[(i + piece.size() - 1) % piece.size()]];
            const Point3& c = ring_[piece[(i + 1) % piece.size()]];
            cost += piece.size() == 4 ? corner_cost(a, ring_[piece[i]], c, normal_)
                                      : triangle_corner_cost(a, ring_[piece[i]], c);
        }
        return cost;
    }

private:
    struct Best {
        double cost = 0.0;
        std::size_t k = 0, l = 0;  // the piece over (i, j): i, k, j, or i, k, l, j when l != 0
    };

    /// Pieces without area, such as corners all in one side, are the last resort.
    double flatness_cost(const Piece& piece) const {
        Point3 area;
        double longest = 0.0;
        const Point3& origin = ring_[piece[0]];
        for (std::size_t i = 1; i + 1 < piece.size(); ++i)
            area = area + cross(ring_[piece[i]] - origin, ring_[piece[i + 1]] - origin);
        for (const Index a : piece)
            for (const Index b : piece) longest = std::max(longest, dot(ring_[a] - ring_[b], ring_[a] - ring_[b]));
        constexpr double flat = 2e-3;
        const double shape = longest > 0.0 ? dot(area, normal_) / longest : 0.0;
        return shape < flat ? 0.1 * reflex_cost * (1.0 - shape / flat) : 0.0;
    }

    /// Triangles may have sharp corners, only flat ones are bad.
    double triangle_corner_cost(const Point3& a, const Point3& b, const Point3& c) const {
        const Point3 in = b - a, out = c - b;
        const double turned = std::atan2(dot(cross(in, out), normal_), dot(in, out));
        if (turned < 0.0) return reflex_cost;
        constexpr double flat = 0.35;
        return turned < flat ? straight_cost * (1.0 - turned / flat) : 0.0;
    }

    void solve(std::size_t i, std::size_t j) {
        Best best{infinite, 0, 0};
        for (std::size_t k = i + 1; k < j; ++k) {
            const double cost = at(i, k).cost + at(k, j).cost + cost_of({id(i), id(k), id(j)});
            if (cost < best.cost) best = {cost, k, 0};
        }
        for (std::size_t k = i + 1; k + 1 < j; ++k)
            for (std::size_t l = k + 1; l < j; ++l) {
                const double chains = at(i, k).cost + at(k, l).cost + at(l, j).cost;
                if (chains + quad_cost >= best.cost) continue;
                const double cost = chains + cost_of({id(i), id(k), id(l), id(j)});
                if (cost < best.cost) best = {cost, k, l};
            }
        best_[i * n_ + j] = best;
    }
    void collect(std::size_t i, std::size_t j, std::vector<Piece>& pieces) const {
        if (j - i < 2) return;
        const Best& best = at(i, j);
        if (best.l == 0) {
            pieces.push_back({id(i), id(best.k), id(j)});
            collect(i, best.k, pieces);
            collect(best.k, j, pieces);
        } else {
            pieces.push_back({id(i), id(best.k), id(best.l), id(j)});
            collect(i, best.k, pieces);
            collect(best.k, best.l, pieces);
            collect(best.l, j, pieces);
        }
    }
    const Best& at(std::size_t i, std::size_t j) const { return best_[i * n_ + j]; }
    static Index id(std::size_t i) { return static_cast<Index>(i); }

    std::span<const Point3> ring_;
    std::size_t n_;
    Point3 normal_;
    std::vector<Best> best_;
};

/// Triangles in pairs, best pair first.
std::vector<Piece> pair_triangles(std::span<const Point3> ring) {
    std::vector<Index> all(ring.size());
    for (Index i = 0; i < all.size(); ++i) all[i] = i;
    std::vector<std::array<Index, 3>> triangles;
    triangulate_polygon(ring, all, core::TriangleTree({}, {}), triangles);
    const Cutter cutter(ring);
    struct Pair {
        double gain = 0.0;
        std::size_t first = 0, second = 0;
        Piece quad;
    };
    std::vector<Pair> pairs;
    for (std::size_t s = 0; s < triangles.size(); ++s)
        for (std::size_t t = s + 1; t < triangles.size(); ++t)
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j) {
                    const auto &a = triangles[s], &b = triangles[t];
                    if (a[i] != b[(j + 1) % 3] || a[(i + 1) % 3] != b[j]) continue;
                    Piece quad{a[i], b[(j + 2) % 3], a[(i + 1) % 3], a[(i + 2) % 3]};
                    const double gain =
                        cutter.cost_of({a[0], a[1], a[2]}) + cutter.cost_of({b[0], b[1], b[2]}) - cutter.cost_of(quad);
                    const bool has_straight_corner = cutter.cost_of(quad) > 0.9 * straight_cost;
                    if (gain > 0.0 && !has_straight_corner) pairs.push_back({gain, s, t, std::move(quad)});
                }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& l, const Pair& r) { return l.gain > r.gain; });
    std::vector<bool> is_paired(triangles.size(), false);
    std::vector<Piece> pieces;
    for (const Pair& pair : pairs) {
        if (is_paired[pair.first] || is_paired[pair.second]) continue;
        is_paired[pair.first] = is_paired[pair.second] = true;
        pieces.push_back(pair.quad);
    }
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (!is_paired[t]) pieces.push_back({triangles[t][0], triangles[t][1], triangles[t][2]});
    return pieces;
}

std::vector<Point3> points_of(const CoarseMesh& mesh, std::span<const Index> ring) {
    std::vector<Point3> points;
    for (const Index v : ring) points.push_back(mesh.points[v]);
    return points;
}

/// The diagonal that leaves the better corners on both sides and halves of about the same size.
std::pair<std::size_t, std::size_t> find_best_diagonal(std::span<const Point3> ring) {
    const std::size_t n = ring.size();
    const Point3 area = area_vector(ring);
    const double length = norm(area);
    const Point3 normal = length > 0.0 ? (1.0 / length) * area : Point3{};
    std::pair<std::size_t, std::size_t> best{0, n / 2};
    double best_cost = infinite;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 2; j < n; ++j) {
            if (i == 0 && j + 1 == n) continue;
            double cost = 0.0;
            for (const auto& [a, b] : {std::pair{i, j}, std::pair{j, i}}) {
                cost += corner_cost(ring[(a + n - 1) % n], ring[a], ring[b], normal);
                cost += corner_cost(ring[b], ring[a], ring[(a + 1) % n], normal);
            }
            const double inner = static_cast<double>(j - i) - 0.5 * static_cast<double>(n);
            cost += 0.2 * std::abs(inner);
            if (cost < best_cost) best_cost = cost, best = {i, j};
        }
    return best;
}

}  // namespace

std::vector<std::vector<Index>> cut_into_quads(std::span<const Point3> ring) {
    if (ring.size() == 3) return {{0, 1, 2}};
    if (ring.size() > largest_exact) return pair_triangles(ring);
    return Cutter(ring).cut();
}

double cutting_cost(std::span<const Point3> piece) {
    return Cutter(piece).cost_of(piece.size() == 3 ? Piece{0, 1, 2} : Piece{0, 1, 2, 3});
}

CoarseMesh make_quad_dominant(const CoarseMesh& mesh) {
    CoarseMesh result = mesh.without_polygons();
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        for (Piece& piece : cut_into_quads(points_of(mesh, ring))) {
            for (Index& corner : piece) corner = ring[corner];
            result.add_polygon(piece, mesh.parent(q));
        }
    }
    return result;
}

CoarseMesh make_triangles(const CoarseMesh& mesh, const core::TriangleTree& input) {
    CoarseMesh result = mesh.without_polygons();
    std::vector<Index> polygon_of;
    const auto triangles = triangulate(mesh, input, &polygon_of);
    for (std::size_t t = 0; t < triangles.size(); ++t) result.add_polygon(triangles[t], mesh.parent(polygon_of[t]));
    return result;
}

CoarseMesh limit_degree(const CoarseMesh& mesh, std::size_t most) {
    CoarseMesh result = mesh.without_polygons();
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        const auto whole = mesh.polygon(q);
        std::vector<Piece> waiting{{whole.begin(), whole.end()}};
        while (!waiting.empty()) {
            const Piece ring = std::move(waiting.back());
            waiting.pop_back();
            if (ring.size() <= std::max<std::size_t>(most, 3)) {
                result.add_polygon(ring, mesh.parent(q));
                continue;
            }
            const auto [i, j] = find_best_diagonal(points_of(mesh, ring));
            const auto at = [&](std::size_t k) { return ring.begin() + static_cast<std::ptrdiff_t>(k); };
            Piece outer(at(j), ring.end());
            outer.insert(outer.end(), ring.begin(), at(i) + 1);
            waiting.push_back(std::move(outer));
            waiting.push_back({at(i), at(j) + 1});
        }
    }
    return result;
}

}  // namespace certa::remeshing
