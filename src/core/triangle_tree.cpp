// Nearest points by a tree of boxes, four to a node, split at the medians of the centroids along the longest sides.
//
// The point of a triangle nearest to p (regions of Ericson 2004, 5.1.5) is returned with its weights; quotients that
// rounding or a triangle without area would make meaningless fall back to the sides. The four boxes of a node are
// judged at once, in single precision: they are larger by more than its rounding, so that nothing is missed.
#include "core/triangle_tree.h"

#include <algorithm>

#include "core/vector3.h"

namespace certa::core {
namespace {

/// Boxes in [-1, 1] grow by this; rounding points of [-4, 4] to floats moves them by less.
constexpr double margin = 1e-6;
using Lanes = float __attribute__((vector_size(16)));

Lanes load(const std::array<float, 4>& values) { return Lanes{values[0], values[1], values[2], values[3]}; }

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

/// What is left of p across the direction of e.
Point3 across(const Point3& p, const Point3& e) {
    const double square = dot(e, e);
    const Point3 once = p - (dot(p, e) / square) * e;
    return once - (dot(once, e) / square) * e;
}

/// In the frame of the longest side and the height over it: errors are those of lengths, however low the triangle is.
NearestPoint nearest_on_sliver(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
    const NearestPoint on_sides = nearest_on_sides(p, a, b, c);
    const std::array<Point3, 3> corners{a, b, c};
    std::size_t first = 0;
    double longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 side = corners[(i + 1) % 3] - corners[i];
        if (dot(side, side) > longest) longest = dot(side, side), first = i;
    }
    const Point3 &origin = corners[first], side = corners[(first + 1) % 3] - origin,
                 other = corners[(first + 2) % 3] - origin;
    const Point3 height = across(other, side);
    if (!(dot(height, height) > 0.0)) return on_sides;
    const double top = dot(across(p - origin, side), height) / dot(height, height);
    const double end = (dot(p - origin, side) - top * dot(other, side)) / longest;
    if (!(top > 0.0 && end > 0.0 && top + end < 1.0)) return on_sides;
    std::array<double, 3> weights{};
    weights[first] = 1.0 - top - end, weights[(first + 1) % 3] = end, weights[(first + 2) % 3] = top;
    const NearestPoint inside = on_weights(p, a, b, c, weights);
    return inside.squared_distance < on_sides.squared_distance ? inside : on_sides;
}

Point3 lowest(const Point3& p, const Point3& q) { return {std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)}; }
Point3 highest(const Point3& p, const Point3& q) {
    return {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)};
}

}  // namespace

NearestPoint find_nearest_on_triangle(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
    const Point3 ab = b - a, ac = c - a, ap = p - a;
    // In a sliver the signs below say little.
    const Point3 n = cross(ab, ac);
    const double longest = std::max(dot(ab, ab), dot(ac, ac));
    if (!(dot(n, n) > 1e-4 * longest * longest)) return nearest_on_sliver(p, a, b, c);
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

/// A triangle while the tree is built.
struct TriangleTree::Place {
    std::array<float, 3> middle{};
    std::uint32_t id = 0;
    Box box;
};

TriangleTree::TriangleTree(std::span<const Point3> positions, std::span<const Triangle> triangles) {
    if (triangles.empty()) return;
    std::vector<Place> places(triangles.size());
    const auto corner = [&](std::uint32_t t, std::size_t i) -> const Point3& {
        return positions[index_of(triangles[t][i])];
    };
    Box all{corner(0, 0), corner(0, 0)};
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const Point3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
        places[t].id = t;
        places[t].box = {lowest(a, lowest(b, c)), highest(a, highest(b, c))};
        all = {lowest(all.low, places[t].box.low), highest(all.high, places[t].box.high)};
    }
    middle_ = 0.5 * all.low + 0.5 * all.high;
    const Point3 size = all.high - all.low;
    const double half = 0.5 * std::max({size.x, size.y, size.z});
    if (half > 1e-150) scale_ = 1.0 / half;
    for (Place& place : places)
        place.middle = reduced((1.0 / 3.0) * (corner(place.id, 0) + corner(place.id, 1) + corner(place.id, 2)));
    nodes_.reserve(triangles.size() / 2 + 1);
    nodes_.emplace_back();
    build(places, 0, 0);
    triangles_.resize(triangles.size());
    place_of_.resize(triangles.size());
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        const std::uint32_t t = places[i].id;
        triangles_[i] = {corner(t, 0), corner(t, 1), corner(t, 2), t};
        place_of_[t] = i;
    }
}

/// Splits in two halves of equal count, these again, and makes a lane of each.
TriangleTree::Box TriangleTree::build(std::span<Place> places, std::uint32_t begin, std::uint32_t node) {
    const auto halve = [](std::span<Place> part) {
        std::array<float, 3> low = part[0].middle, high = low;
        for (const Place& place : part)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], place.middle[axis]);
                high[axis] = std::max(high[axis], place.middle[axis]);
            }
        std::size_t longest = 0;
        for (std::size_t axis = 1; axis < 3; ++axis)
            if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
        const auto half = static_cast<std::ptrdiff_t>(part.size() / 2);
        std::nth_element(part.begin(), part.begin() + half, part.end(), [&](const Place& l, const Place& r) {
            return l.middle[longest] != r.middle[longest] ? l.middle[longest] < r.middle[longest] : l.id < r.id;
        });
        return part.size() / 2;
    };
    std::array<std::size_t, 5> ends{0, 0, 0, 0, places.size()};
    if (places.size() <= 4) {
        for (std::size_t lane = 1; lane < 4; ++lane) ends[lane] = std::min(lane, places.size());
    } else {
        ends[2] = halve(places);
        ends[1] = halve(places.first(ends[2]));
        ends[3] = ends[2] + halve(places.subspan(ends[2]));
    }
    Box whole{places[0].box.low, places[0].box.high};
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const std::span<Place> part = places.subspan(ends[lane], ends[lane + 1] - ends[lane]);
        const auto first = begin + static_cast<std::uint32_t>(ends[lane]);
        std::uint32_t child = no_index;
        Box box{{1.0, 1.0, 1.0}, {-1.0, -1.0, -1.0}};
        if (part.size() == 1) {
            box = part[0].box;
            child = first | leaf;
        } else if (part.size() > 1) {
            child = static_cast<std::uint32_t>(nodes_.size());
            nodes_.emplace_back();
            box = build(part, first, child);
        }
        Node& out = nodes_[node];
        out.child[lane] = child;
        const std::array<double, 3> low{(box.low.x - middle_.x) * scale_, (box.low.y - middle_.y) * scale_,
                                        (box.low.z - middle_.z) * scale_},
            high{(box.high.x - middle_.x) * scale_, (box.high.y - middle_.y) * scale_,
                 (box.high.z - middle_.z) * scale_};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out.low[axis][lane] = child == no_index ? 1e30F : static_cast<float>(low[axis] - margin);
            out.high[axis][lane] = child == no_index ? 1e30F : static_cast<float>(high[axis] + margin);
        }
        if (child != no_index) whole = {lowest(whole.low, box.low), highest(whole.high, box.high)};
    }
    return whole;
}

NearestPoint TriangleTree::find_nearest(const Point3& p, std::uint32_t hint, double limit) const {
    NearestPoint best;
    if (triangles_.empty()) return best;
    best.squared_distance = limit * limit;
    // In the boxes' unit, with room for the rounding of squares.
    const double unit = scale_ * scale_ * (1.0 + 1e-6);
    double enough = best.squared_distance * unit;
    const auto offer = [&](const Entry& e) {
        NearestPoint found = find_nearest_on_triangle(p, e.a, e.b, e.c);
        if (!(found.squared_distance < best.squared_distance)) return;
        best = found;
        best.triangle = e.id;
        enough = best.squared_distance * unit;
    };
    if (hint != no_index) offer(triangles_[place_of_[hint]]);
    const std::array<float, 3> at = reduced(p);
    struct Waiting {
        std::uint32_t node = 0;
        float squared_distance = 0.0F;
    };
    std::array<Waiting, most_waiting> stack;
    std::size_t top = 0;
    stack[top++] = {0, 0.0F};
    while (top > 0) {
        const Waiting waiting = stack[--top];
        if (!(static_cast<double>(waiting.squared_distance) < enough)) continue;
        const Node& node = nodes_[waiting.node];
        Lanes sum{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Lanes below = load(node.low[axis]) - at[axis], above = at[axis] - load(node.high[axis]);
            const Lanes outside = below > above ? below : above, zero{};
            const Lanes away = outside > zero ? outside : zero;
            sum += away * away;
        }
        // Nearest first: triangles at once, nodes later.
        std::array<std::uint32_t, 4> order{0, 1, 2, 3};
        for (std::size_t i = 1; i < 4; ++i)
            for (std::size_t k = i; k > 0 && sum[order[k]] < sum[order[k - 1]]; --k) std::swap(order[k], order[k - 1]);
        for (const std::uint32_t lane : order)
            if ((node.child[lane] & leaf) != 0 && static_cast<double>(sum[lane]) < enough)
                offer(triangles_[node.child[lane] & ~leaf]);
        for (std::size_t i = 4; i-- > 0;) {
            const std::uint32_t lane = order[i];
            if ((node.child[lane] & leaf) == 0 && static_cast<double>(sum[lane]) < enough)
                stack[top++] = {node.child[lane], sum[lane]};
        }
    }
    return best;
}

}  // namespace certa::core
