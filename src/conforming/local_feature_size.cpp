// Local feature size by a box hierarchy (thesis, Part I, 1.3, Definition 3; the thesis used brute force).
//
// Primitives are the triangles that tile the facets, the segments, and the points that end no segment. A query skips
// the facets and segments that contain its point, by index; ends of segments that contain it are tested by themselves
// (any other vertex ends a segment that is tested). Children are visited nearest first. Distances are computed in
// double and repeated in extended precision when cancellation could cost more than 1e-8 of them; what cannot be known
// better is taken as the lower bound.
#include "conforming/local_feature_size.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace certa::conforming {
namespace {

template <class Number>
struct Triple {
    Number x, y, z;
};
template <class Number>
Triple<Number> minus(const Point3& a, const Point3& b) {
    return {Number(a.x) - b.x, Number(a.y) - b.y, Number(a.z) - b.z};
}
template <class Number>
Number dot(const Triple<Number>& a, const Triple<Number>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
Triple<Number> cross(const Triple<Number>& a, const Triple<Number>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A computed distance and how far below it the true one may be.
template <class Number>
struct Distance {
    Number value = 0, error = 0;
};

// Rounding of a coordinate difference is half a unit u each, of the products and sums below less than 8 u relative to
// the product of the lengths; 16 leaves room.
template <class Number>
constexpr Number rounding = 16 * std::numeric_limits<Number>::epsilon() / 2;

template <class Number>
Distance<Number> distance_to_point(const Point3& p, const Point3& a) {
    const auto d = minus<Number>(p, a);
    const Number value = std::sqrt(dot(d, d));
    return {value, rounding<Number> * value};
}

template <class Number>
Distance<Number> distance_to_segment(const Point3& p, Point3 a, Point3 b) {
    auto pa = minus<Number>(p, a), pb = minus<Number>(p, b);
    if (dot(pb, pb) < dot(pa, pa)) {  // measured from the nearer end
        std::swap(a, b);
        std::swap(pa, pb);
    }
    const auto ab = minus<Number>(b, a);
    const Number along = dot(pa, ab);
    if (along <= 0) return distance_to_point<Number>(p, a);
    const auto normal = cross(pa, ab);
    const Number span = std::sqrt(dot(ab, ab)), reach = std::sqrt(dot(pa, pa));
    const Number value = std::sqrt(dot(normal, normal)) / span;
    return {value, rounding<Number> * (reach + value)};
}

template <class Number>
Distance<Number> distance_to_triangle(const Point3& p, Point3 a, Point3 b, Point3 c) {
    const auto measure = [&](const Point3& q) {
        const auto d = minus<Number>(p, q);
        return dot(d, d);
    };
    for (int turn = 0; turn < 2; ++turn) {  // measured from the nearest corner
        if (measure(a) <= measure(b) && measure(a) <= measure(c)) break;
        const Point3 first = a;
        a = b, b = c, c = first;
    }
    const auto ab = minus<Number>(b, a), ac = minus<Number>(c, a), bc = minus<Number>(c, b);
    const auto pa = minus<Number>(p, a), pb = minus<Number>(p, b);
    const auto normal = cross(ab, ac);
    const bool inside = dot(cross(normal, ab), pa) >= 0 && dot(cross(normal, bc), pb) >= 0 &&
                        dot(cross(ac, normal), pa) >= 0 && dot(normal, normal) > 0;
    if (inside) {
        const Number area = std::sqrt(dot(normal, normal));
        const Number value = std::abs(dot(normal, pa)) / area;
        const Number product = std::sqrt(dot(ab, ab) * dot(ac, ac)) / area;
        return {value, rounding<Number> * (std::sqrt(dot(pa, pa)) * product + value)};
    }
    Distance<Number> best = distance_to_segment<Number>(p, a, b);
    for (const auto& d : {distance_to_segment<Number>(p, b, c), distance_to_segment<Number>(p, c, a)}) {
        if (d.value - d.error < best.value - best.error) best = d;
    }
    return best;
}

template <class Number>
Distance<Number> distance_to(const Point3& p, const Point3& a, const Point3& b, const Point3& c, ElementKind kind) {
    if (kind == ElementKind::facet) return distance_to_triangle<Number>(p, a, b, c);
    if (kind == ElementKind::segment) return distance_to_segment<Number>(p, a, b);
    return distance_to_point<Number>(p, a);
}

double lower_bound_of(const Point3& p, const Point3& a, const Point3& b, const Point3& c, ElementKind kind) {
    const Distance<double> fast = distance_to<double>(p, a, b, c, kind);
    if (fast.error <= 1e-8 * fast.value) return fast.value - fast.error;
    const Distance<long double> slow = distance_to<long double>(p, a, b, c, kind);
    const auto bound = static_cast<double>(slow.value - slow.error);
    return std::max(0.0, bound * (1.0 - 1e-15));
}

double coordinate(const Point3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

constexpr std::uint32_t leaf_size = 4;

/// Indices of faces to skip, in order.
class SkipList {
public:
    explicit SkipList(std::span<const std::uint32_t> faces) : faces_(faces) {
        if (std::is_sorted(faces.begin(), faces.end())) return;
        copy_.assign(faces.begin(), faces.end());
        std::sort(copy_.begin(), copy_.end());
        faces_ = copy_;
    }
    SkipList(const SkipList&) = delete;
    SkipList& operator=(const SkipList&) = delete;
    bool contains(std::uint32_t face) const { return std::binary_search(faces_.begin(), faces_.end(), face); }

private:
    std::vector<std::uint32_t> copy_;
    std::span<const std::uint32_t> faces_;
};

}  // namespace

struct LocalFeatureSize::Query {
    Point3 place;
    std::uint32_t vertex;  // that the place is, or no_index
    SkipList segments, facets;
    FeatureSize best;

    bool skips(const Primitive& primitive) const {
        switch (primitive.kind) {
            case ElementKind::facet:
                return facets.contains(primitive.face);
            case ElementKind::segment:
                return segments.contains(primitive.face);
            default:
                return primitive.face == vertex;
        }
    }
    void test(double distance, ElementRef face) {
        if (distance < best.value) best = {distance, face};
    }
};

LocalFeatureSize::LocalFeatureSize(const Complex& complex, const FacetInterior& interior) : complex_(complex) {
    primitives_.reserve(interior.triangles.values.size() + complex.segments.size());
    for (std::uint32_t f = 0; f < interior.triangles.size(); ++f) {
        for (const auto& t : interior.triangles[f]) primitives_.push_back({t, f, ElementKind::facet});
    }
    for (std::uint32_t s = 0; s < complex.segments.size(); ++s) {
        if (complex.is_dropped(s)) continue;
        const auto& [a, b] = complex.segments[s];
        primitives_.push_back({{a, b, b}, s, ElementKind::segment});
    }
    for (std::uint32_t v = 0; v < complex.points.size(); ++v) {
        if (complex.point_segments[v].empty() && !complex.is_ignored(v))
            primitives_.push_back({{v, v, v}, v, ElementKind::vertex});
    }
    if (primitives_.empty()) return;
    std::vector<Point3> centers(primitives_.size());
    for (std::size_t i = 0; i < primitives_.size(); ++i) {
        const auto& [a, b, c] = primitives_[i].points;
        const Point3 &p = complex.points[a], &q = complex.points[b], &r = complex.points[c];
        centers[i] = {p.x + q.x + r.x, p.y + q.y + r.y, p.z + q.z + r.z};
    }
    std::vector<std::uint32_t> order(primitives_.size());
    std::iota(order.begin(), order.end(), 0u);
    nodes_.reserve(2 * primitives_.size() / leaf_size + 16);
    build(centers, order, 0, static_cast<std::uint32_t>(order.size()));
    std::vector<Primitive> sorted(primitives_.size());
    for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = primitives_[order[i]];
    primitives_.swap(sorted);
}

std::uint32_t LocalFeatureSize::build(std::vector<Point3>& centers, std::vector<std::uint32_t>& order,
                                      std::uint32_t begin, std::uint32_t end) {
    const auto self = static_cast<std::uint32_t>(nodes_.size());
    constexpr double far = std::numeric_limits<double>::infinity();
    Node node{{far, far, far}, {-far, -far, -far}, begin, end - begin};
    const auto grow = [](Point3& low, Point3& high, const Point3& p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    };
    Point3 low = node.low, high = node.high;  // of the centres
    for (std::uint32_t i = begin; i < end; ++i) {
        for (const std::uint32_t v : primitives_[order[i]].points) grow(node.low, node.high, complex_.points[v]);
        grow(low, high, centers[order[i]]);
    }
    nodes_.push_back(node);
    if (end - begin <= leaf_size) return self;
    const Point3 extent{high.x - low.x, high.y - low.y, high.z - low.z};
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                     [&](std::uint32_t i, std::uint32_t j) {
                         const double a = coordinate(centers[i], axis), b = coordinate(centers[j], axis);
                         return a != b ? a < b : i < j;
                     });
    build(centers, order, begin, middle);
    const std::uint32_t second = build(centers, order, middle, end);
    nodes_[self].first = second;
    nodes_[self].count = 0;
    return self;
}

void LocalFeatureSize::search(Query& query) const {
    if (nodes_.empty()) return;
    const auto box_distance = [&](std::uint32_t index) {  // squared, at most 1e-15 too large in relative terms
        const Node& n = nodes_[index];
        const Point3& p = query.place;
        const double x = std::max({n.low.x - p.x, 0.0, p.x - n.high.x});
        const double y = std::max({n.low.y - p.y, 0.0, p.y - n.high.y});
        const double z = std::max({n.low.z - p.z, 0.0, p.z - n.high.z});
        return (x * x + y * y + z * z) * (1.0 - 1e-14);
    };
    struct Entry {
        std::uint32_t node;
        double squared;
    };
    std::array<Entry, 128> stack;  // halving leaves a depth below 33, one entry waits on each level
    std::size_t size = 0;
    stack[size++] = {0, box_distance(0)};
    while (size > 0) {
        const Entry entry = stack[--size];
        if (entry.squared >= query.best.value * query.best.value) continue;
        const Node& node = nodes_[entry.node];
        if (node.count == 0) {
            Entry near{entry.node + 1, box_distance(entry.node + 1)}, far{node.first, box_distance(node.first)};
            if (far.squared < near.squared) std::swap(near, far);
            stack[size++] = far;
            stack[size++] = near;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Primitive& primitive = primitives_[i];
            if (query.skips(primitive)) continue;
            const auto& [a, b, c] = primitive.points;
            query.test(
                lower_bound_of(query.place, complex_.points[a], complex_.points[b], complex_.points[c], primitive.kind),
                {primitive.kind, primitive.face});
        }
    }
}

FeatureSize LocalFeatureSize::at_vertex(std::uint32_t vertex, double limit) const {
    const Point3& place = complex_.points[vertex];
    const auto segments = complex_.point_segments[vertex];
    Query query{place,
                vertex,
                SkipList(segments),
                SkipList(complex_.point_facets[vertex]),
                {limit, {ElementKind::vertex, no_index}}};
    for (const std::uint32_t s : segments) {
        const auto& [a, b] = complex_.segments[s];
        const std::uint32_t other = a == vertex ? b : a;
        const Point3& q = complex_.points[other];
        query.test(lower_bound_of(place, q, q, q, ElementKind::vertex), {ElementKind::vertex, other});
    }
    search(query);
    return query.best;
}

FeatureSize LocalFeatureSize::on_segment(std::uint32_t segment, const Point3& place, double limit) const {
    Query query{place,
                no_index,
                SkipList({&segment, 1}),
                SkipList(complex_.segment_facets[segment]),
                {limit, {ElementKind::vertex, no_index}}};
    for (const std::uint32_t v : complex_.segments[segment]) {
        const Point3& q = complex_.points[v];
        query.test(lower_bound_of(place, q, q, q, ElementKind::vertex), {ElementKind::vertex, v});
    }
    search(query);
    return query.best;
}

}  // namespace certa::conforming
