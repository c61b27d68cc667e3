// Nearest points by a tree of boxes, split at the median of the centroids along the longest side.
//
// The point of a triangle nearest to p (regions of Ericson 2004, 5.1.5) is returned with its weights; quotients that
// rounding or a triangle without area would make meaningless fall back to the sides. Descent is nearer child first.
#include "core/triangle_tree.h"

#include <algorithm>

#include "core/vector3.h"

namespace certa::core {
namespace {

constexpr std::uint32_t leaf_size = 4;

/// The parameter of the point of ab nearest to p.
double clamp_quotient(double numerator, double denominator) {
    return denominator > 0.0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0;
}

NearestPoint on_weights(const Point3& p, const Point3& a, const Point3& b, const Point3& c,
                        const std::array<double, 3>& w) {
    NearestPoint nearest;
    nearest.weights = w;
    nearest.point = w[0] * a + w[1] * b + w[2] * c;
    const Point3 d = p - nearest.point;
    nearest.squared_distance = dot(d, d);
    return nearest;
}

NearestPoint nearest_on_sides(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
    const double ab = clamp_quotient(dot(p - a, b - a), dot(b - a, b - a));
    const double bc = clamp_quotient(dot(p - b, c - b), dot(c - b, c - b));
    const double ca = clamp_quotient(dot(p - c, a - c), dot(a - c, a - c));
    const NearestPoint candidates[3] = {on_weights(p, a, b, c, {1.0 - ab, ab, 0.0}),
                                        on_weights(p, a, b, c, {0.0, 1.0 - bc, bc}),
                                        on_weights(p, a, b, c, {ca, 0.0, 1.0 - ca})};
    return *std::min_element(candidates, candidates + 3, [](const NearestPoint& l, const NearestPoint& r) {
        return l.squared_distance < r.squared_distance;
    });
}

double squared_distance_to_box(const Point3& p, const Point3& low, const Point3& high) {
    const double x = std::max({low.x - p.x, 0.0, p.x - high.x});
    const double y = std::max({low.y - p.y, 0.0, p.y - high.y});
    const double z = std::max({low.z - p.z, 0.0, p.z - high.z});
    return x * x + y * y + z * z;
}

Point3 lowest(const Point3& p, const Point3& q) { return {std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)}; }
Point3 highest(const Point3& p, const Point3& q) {
    return {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)};
}

}  // namespace

NearestPoint find_nearest_on_triangle(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
    const Point3 ab = b - a, ac = c - a, ap = p - a;
    // In a sliver the signs below say little; a needle's sides are as near as its inside, up to its width.
    const Point3 n = cross(ab, ac);
    if (!(dot(n, n) > 1e-20 * dot(ab, ab) * dot(ac, ac))) return nearest_on_sides(p, a, b, c);
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return on_weights(p, a, b, c, {1.0, 0.0, 0.0});
    const Point3 bp = p - b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) return on_weights(p, a, b, c, {0.0, 1.0, 0.0});
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        const double t = clamp_quotient(d1, d1 - d3);
        return on_weights(p, a, b, c, {1.0 - t, t, 0.0});
    }
    const Point3 cp = p - c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) return on_weights(p, a, b, c, {0.0, 0.0, 1.0});
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        const double t = clamp_quotient(d2, d2 - d6);
        return on_weights(p, a, b, c, {1.0 - t, 0.0, t});
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        const double t = clamp_quotient(d4 - d3, (d4 - d3) + (d5 - d6));
        return on_weights(p, a, b, c, {0.0, 1.0 - t, t});
    }
    const double sum = va + vb + vc;
    if (!(va > 0.0 && vb > 0.0 && vc > 0.0)) return nearest_on_sides(p, a, b, c);
    const double v = vb / sum, w = vc / sum;
    return on_weights(p, a, b, c, {std::max(0.0, 1.0 - v - w), v, w});
}

TriangleTree::TriangleTree(std::span<const Point3> positions, std::span<const Triangle> triangles) {
    triangles_.resize(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        triangles_[i] = {positions[index_of(triangles[i][0])], positions[index_of(triangles[i][1])],
                         positions[index_of(triangles[i][2])], i};
    }
    nodes_.reserve(triangles.size() + 1);
    if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
    place_of_.resize(triangles.size());
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) place_of_[triangles_[i].id] = i;
}

std::uint32_t TriangleTree::build(std::uint32_t begin, std::uint32_t end) {
    const auto id = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Node node;
    node.begin = begin, node.end = end;
    node.low = node.high = triangles_[begin].a;
    const auto middle_of = [](const Entry& e) { return e.a + e.b + e.c; };  // three times the centroid
    Point3 low = middle_of(triangles_[begin]), high = low;
    for (std::uint32_t i = begin; i < end; ++i) {
        const Entry& e = triangles_[i];
        node.low = lowest(node.low, lowest(e.a, lowest(e.b, e.c)));
        node.high = highest(node.high, highest(e.a, highest(e.b, e.c)));
        low = lowest(low, middle_of(e)), high = highest(high, middle_of(e));
    }
    if (end - begin > leaf_size) {
        const Point3 size = high - low;
        double Point3::*axis = &Point3::x;
        if (size.y > size.x) axis = &Point3::y;
        if (size.z > size.*axis) axis = &Point3::z;
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                         [&](const Entry& l, const Entry& r) {
                             const double lm = middle_of(l).*axis, rm = middle_of(r).*axis;
                             return lm != rm ? lm < rm : l.id < r.id;
                         });
        build(begin, middle);
        node.second = build(middle, end);
    }
    nodes_[id] = node;
    return id;
}

NearestPoint TriangleTree::find_nearest(const Point3& p, std::uint32_t hint, double limit) const {
    NearestPoint best;
    if (nodes_.empty()) return best;
    best.squared_distance = limit * limit;
    const auto offer = [&](const Entry& e) {
        NearestPoint found = find_nearest_on_triangle(p, e.a, e.b, e.c);
        if (!(found.squared_distance < best.squared_distance)) return;
        best = found;
        best.triangle = e.id;
    };
    if (hint != no_index) offer(triangles_[place_of_[hint]]);
    struct Waiting {
        std::uint32_t node = 0;
        double squared_distance = 0.0;
    };
    std::array<Waiting, 96> stack;
    std::size_t top = 0;
    stack[top++] = {0, squared_distance_to_box(p, nodes_[0].low, nodes_[0].high)};
    while (top > 0) {
        const Waiting waiting = stack[--top];
        if (!(waiting.squared_distance < best.squared_distance)) continue;
        const Node& node = nodes_[waiting.node];
        if (node.second == 0) {
            for (std::uint32_t i = node.begin; i < node.end; ++i) offer(triangles_[i]);
            continue;
        }
        Waiting first{waiting.node + 1, 0.0}, second{node.second, 0.0};
        first.squared_distance = squared_distance_to_box(p, nodes_[first.node].low, nodes_[first.node].high);
        second.squared_distance = squared_distance_to_box(p, nodes_[second.node].low, nodes_[second.node].high);
        if (second.squared_distance < first.squared_distance) std::swap(first, second);
        stack[top++] = second;
        stack[top++] = first;
    }
    return best;
}

}  // namespace certa::core
