// Builds the mesher's complex from the public input.
//
// Segments are found in one pass over all sides with an open-addressing table. A facet that is one ring of distinct
// vertices (plus isolated segments and points) has its flags by definition; only facets with several rings, hole points
// or a vertex visited twice are triangulated for them. Frames use Newell's sum about the first vertex, repeated with
// twice the digits when it cancels.
#include "conforming/build_complex.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/parallel.h"
#include "delaunay/flat_facet.h"

namespace certa::conforming {

using delaunay::FlatFacet;
using delaunay::FlatSide;
using delaunay::FlatState;
using delaunay::Projection;
namespace {

/// Unordered pairs of points to segment numbers.
class SegmentTable {
public:
    explicit SegmentTable(std::size_t most) : slots_(std::bit_ceil(2 * most + 16)), mask_(slots_.size() - 1) {}

    /// The number of {a, b}; `fresh` becomes its number if it is new.
    std::uint32_t insert(std::uint32_t a, std::uint32_t b, std::uint32_t fresh) {
        const std::uint64_t key = a < b ? (std::uint64_t{a} << 32 | b) : (std::uint64_t{b} << 32 | a);
        for (std::size_t i = mix(key) & mask_;; i = (i + 1) & mask_) {
            if (slots_[i].segment == no_index) slots_[i] = {key, fresh};
            if (slots_[i].key == key) return slots_[i].segment;
        }
    }

private:
    struct Slot {
        std::uint64_t key = 0;
        std::uint32_t segment = no_index;
    };
    static std::uint64_t mix(std::uint64_t k) {
        k = (k ^ (k >> 32)) * 0x9e3779b97f4a7c15ull;
        return k ^ (k >> 29);
    }
    std::vector<Slot> slots_;
    std::size_t mask_;
};

// Newell's sum in double-double: sums and products keep the part that rounding drops.
struct Double2 {
    double hi = 0.0, lo = 0.0;
};
Double2 two_sum(double a, double b) {
    const double s = a + b, t = s - a;
    return {s, (a - (s - t)) + (b - t)};
}
Double2 operator+(Double2 a, Double2 b) {
    const Double2 s = two_sum(a.hi, b.hi);
    return two_sum(s.hi, s.lo + a.lo + b.lo);
}
Double2 operator-(Double2 a, Double2 b) { return a + Double2{-b.hi, -b.lo}; }
Double2 operator*(Double2 a, Double2 b) {
    const double p = a.hi * b.hi;
    return two_sum(p, std::fma(a.hi, b.hi, -p) + (a.hi * b.lo + a.lo * b.hi));
}

template <class Number>
struct Sum3 {
    Number x{}, y{}, z{};
};

template <class Number, class Difference>
Sum3<Number> newell(const PiecewiseLinearComplex& input, std::uint32_t polygon, Difference difference) {
    const std::uint32_t begin = input.polygon_offsets[polygon], end = input.polygon_offsets[polygon + 1];
    const auto at = [&](std::uint32_t i) { return input.positions[index_of(input.corners[i])]; };
    const Point3 origin = at(begin);
    Sum3<Number> sum;
    for (std::uint32_t i = begin + 1; i + 1 < end; ++i) {
        const Point3 p = at(i), q = at(i + 1);
        const Number ax = difference(p.x, origin.x), ay = difference(p.y, origin.y), az = difference(p.z, origin.z);
        const Number bx = difference(q.x, origin.x), by = difference(q.y, origin.y), bz = difference(q.z, origin.z);
        sum.x = sum.x + (ay * bz - az * by);
        sum.y = sum.y + (az * bx - ax * bz);
        sum.z = sum.z + (ax * by - ay * bx);
    }
    return sum;
}

double length(const Point3& p) { return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z); }
Point3 cross(const Point3& a, const Point3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Point3 operator-(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point3 scaled(const Point3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }

/// Brings the largest coordinate near 1, so that no length under- or overflows.
Point3 normalized(Point3 n) {
    const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
    if (!(largest > 0.0) || !std::isfinite(largest)) return {};
    n = {n.x / largest, n.y / largest, n.z / largest};
    return scaled(n, 1.0 / length(n));
}

/// A normal to points whose ring encloses no area: that of the widest triangle with the two most distant points.
Point3 any_normal(const PiecewiseLinearComplex& input, std::uint32_t polygon) {
    const std::uint32_t begin = input.polygon_offsets[polygon], end = input.polygon_offsets[polygon + 1];
    const auto at = [&](std::uint32_t i) { return input.positions[index_of(input.corners[i])]; };
    Point3 longest{}, widest{};
    for (std::uint32_t i = begin + 1; i < end; ++i) {
        if (length(at(i) - at(begin)) > length(longest)) longest = at(i) - at(begin);
    }
    for (std::uint32_t i = begin + 1; i < end; ++i) {
        const Point3 n = cross(longest, at(i) - at(begin));
        if (length(n) > length(widest)) widest = n;
    }
    if (length(widest) > 0.0) return normalized(widest);
    const Point3 d{std::abs(longest.x), std::abs(longest.y), std::abs(longest.z)};
    const Point3 axis = d.x <= d.y && d.x <= d.z ? Point3{1, 0, 0} : d.y <= d.z ? Point3{0, 1, 0} : Point3{0, 0, 1};
    const Point3 n = normalized(cross(longest, axis));
    return n == Point3{} ? Point3{0, 0, 1} : n;
}

/// Newell normal of one polygon, unit length.
Point3 newell_normal(const PiecewiseLinearComplex& input, std::uint32_t polygon) {
    const std::uint32_t begin = input.polygon_offsets[polygon], end = input.polygon_offsets[polygon + 1];
    if (begin == end) return {0, 0, 1};
    const Sum3<double> fast = newell<double>(input, polygon, [](double a, double b) { return a - b; });
    const Point3 n{fast.x, fast.y, fast.z};
    double reach = 0.0;
    const Point3 origin = input.positions[index_of(input.corners[begin])];
    for (std::uint32_t i = begin + 1; i < end; ++i) {
        reach = std::max(reach, length(input.positions[index_of(input.corners[i])] - origin));
    }
    // The rounding of the plain sum is below 1e-15 reach^2 per term; 1e-4 leaves 11 good digits.
    if (length(n) > 1e-4 * reach * reach && std::isfinite(length(n))) return normalized(n);
    const Sum3<Double2> slow = newell<Double2>(input, polygon, [](double a, double b) { return two_sum(a, -b); });
    const Point3 m = normalized({slow.x.hi, slow.y.hi, slow.z.hi});
    return m == Point3{} ? any_normal(input, polygon) : m;
}

std::uint32_t first_ring(const PiecewiseLinearComplex& input, std::uint32_t facet) {
    for (std::uint32_t p = input.facet_offsets[facet]; p < input.facet_offsets[facet + 1]; ++p) {
        if (input.polygon_offsets[p + 1] - input.polygon_offsets[p] >= 3) return p;
    }
    return input.facet_offsets[facet];
}

/// True when the flags need a triangulation.
bool is_involved(const PiecewiseLinearComplex& input, std::uint32_t facet, std::vector<std::uint32_t>& scratch) {
    if (input.hole_offsets[facet + 1] > input.hole_offsets[facet]) return true;
    std::size_t rings = 0;
    for (std::uint32_t p = input.facet_offsets[facet]; p < input.facet_offsets[facet + 1]; ++p) {
        const std::uint32_t begin = input.polygon_offsets[p], end = input.polygon_offsets[p + 1];
        if (end - begin < 3) continue;
        if (++rings > 1) return true;
        scratch.clear();
        for (std::uint32_t i = begin; i < end; ++i) scratch.push_back(index_of(input.corners[i]));
        if (end - begin == 3) {
            if (scratch[0] == scratch[1] || scratch[1] == scratch[2] || scratch[2] == scratch[0]) return true;
            continue;
        }
        std::sort(scratch.begin(), scratch.end());
        if (std::adjacent_find(scratch.begin(), scratch.end()) != scratch.end()) return true;
    }
    return rings != 1;
}

/// One facet that is one triangle, the common case.
bool is_triangle(const PiecewiseLinearComplex& input, std::uint32_t facet) {
    const std::uint32_t p = input.facet_offsets[facet];
    return input.facet_offsets[facet + 1] == p + 1 && input.polygon_offsets[p + 1] - input.polygon_offsets[p] == 3 &&
           input.hole_offsets[facet] == input.hole_offsets[facet + 1];
}

/// Walks over the facets and fills segments, sides and isolated points.
class SideCollector {
public:
    SideCollector(const PiecewiseLinearComplex& input, Complex& complex)
        : input_(input), complex_(complex), table_(input.segments.size() + input.corners.size()) {
        for (const Edge& e : input.segments) add_given(index_of(e[0]), index_of(e[1]));
        complex.facet_sides.offsets.reserve(input.facet_count() + 1);
        complex.facet_sides.values.reserve(input.corners.size());
        complex.facet_points.offsets.reserve(input.facet_count() + 1);
    }

    void collect(std::uint32_t facet) {
        row_.clear();
        points_.clear();
        if (is_triangle(input_, facet)) {
            collect_triangle(facet);
        } else {
            collect_polygons(facet);
        }
        complex_.facet_sides.push_row(row_);
        complex_.facet_points.push_row(points_);
    }

private:
    void add_given(std::uint32_t a, std::uint32_t b) {
        table_.insert(a, b, static_cast<std::uint32_t>(complex_.segments.size()));
        complex_.segments.push_back({a, b});
    }
    std::uint32_t segment_between(std::uint32_t a, std::uint32_t b) {
        const auto fresh = static_cast<std::uint32_t>(complex_.segments.size());
        const std::uint32_t s = table_.insert(a, b, fresh);
        if (s == fresh) complex_.segments.push_back({a, b});
        return s;
    }
    void collect_triangle(std::uint32_t facet) {
        const std::uint32_t begin = input_.polygon_offsets[input_.facet_offsets[facet]];
        const std::uint32_t v[3] = {index_of(input_.corners[begin]), index_of(input_.corners[begin + 1]),
                                    index_of(input_.corners[begin + 2])};
        for (int i = 0; i < 3; ++i) row_.push_back({segment_between(v[i], v[(i + 1) % 3]), true});
    }
    void collect_polygons(std::uint32_t facet) {
        FlatFacet flat;
        if (is_involved(input_, facet, scratch_)) {
            flat = delaunay::flatten_facet(input_, facet, Projection(complex_.frames[facet].normal));
            if (flat.state == FlatState::crossing) assume_rings(flat);
        } else {
            flat = delaunay::list_sides(input_, facet);
            assume_rings(flat);
        }
        for (const FlatSide& side : flat.sides) {
            row_.push_back({segment_between(side.ends[0], side.ends[1]), side.inside == 1});
        }
        points_ = flat.points;
    }
    static void assume_rings(FlatFacet& flat) {
        for (FlatSide& side : flat.sides) side.inside = side.on_ring ? 1 : 2;
    }

    const PiecewiseLinearComplex& input_;
    Complex& complex_;
    SegmentTable table_;
    std::vector<Side> row_;
    std::vector<std::uint32_t> points_, scratch_;
};

/// Row i of the result lists the rows of `rows` that contain i, ascending.
template <class Items>
Rows<std::uint32_t> transpose(std::size_t count, std::size_t row_count, const Items& for_each_item) {
    Rows<std::uint32_t> result;
    result.offsets.assign(count + 1, 0);
    for (std::uint32_t r = 0; r < row_count; ++r) for_each_item(r, [&](std::uint32_t i) { ++result.offsets[i + 1]; });
    for (std::size_t i = 0; i < count; ++i) result.offsets[i + 1] += result.offsets[i];
    result.values.resize(result.offsets.back());
    std::vector<std::uint32_t> next(result.offsets.begin(), result.offsets.end() - 1);
    for (std::uint32_t r = 0; r < row_count; ++r) {
        for_each_item(r, [&](std::uint32_t i) { result.values[next[i]++] = r; });
    }
    return result;
}

}  // namespace

Frame build_frame(const PiecewiseLinearComplex& input, std::uint32_t facet) {
    Frame frame;
    if (input.facet_offsets[facet] == input.facet_offsets[facet + 1]) return {{}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::uint32_t begin = input.polygon_offsets[input.facet_offsets[facet]];
    const std::uint32_t end = input.polygon_offsets[input.facet_offsets[facet + 1]];
    const Point3 first = begin < end ? input.positions[index_of(input.corners[begin])] : Point3{};
    Point3 mean{};
    for (std::uint32_t i = begin; i < end; ++i) {
        const Point3 d = input.positions[index_of(input.corners[i])] - first;
        mean = {mean.x + d.x, mean.y + d.y, mean.z + d.z};
    }
    const double count = std::max<double>(1.0, end - begin);
    frame.origin = {first.x + mean.x / count, first.y + mean.y / count, first.z + mean.z / count};
    const Point3 n = newell_normal(input, first_ring(input, facet));
    const Point3 a{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    const Point3 axis = a.x <= a.y && a.x <= a.z ? Point3{1, 0, 0} : a.y <= a.z ? Point3{0, 1, 0} : Point3{0, 0, 1};
    frame.normal = n;
    frame.u = normalized(cross(axis, n));
    frame.v = normalized(cross(n, frame.u));
    return frame;
}

Complex build_complex(const PiecewiseLinearComplex& input) {
    Complex complex;
    complex.points = input.positions;
    const std::size_t facets = input.facet_count();
    complex.frames.resize(facets);
    core::parallel_for(facets, 1024, {}, [&](std::size_t first, std::size_t last) {
        for (std::size_t f = first; f < last; ++f) {
            complex.frames[f] = build_frame(input, static_cast<std::uint32_t>(f));
        }
    });
    {
        SideCollector collector(input, complex);
        for (std::uint32_t f = 0; f < facets; ++f) collector.collect(f);
    }
    complex.facet_markers = input.facet_markers;
    complex.facet_markers.resize(facets, 0);
    complex.segment_markers = input.segment_markers;
    complex.segment_markers.resize(complex.segments.size(), 0);
    build_incidences(complex);
    return complex;
}

void build_incidences(Complex& complex) {
    const std::size_t points = complex.points.size(), facets = complex.facet_sides.size();
    complex.point_segments = transpose(points, complex.segments.size(), [&](std::uint32_t s, auto&& add) {
        add(complex.segments[s][0]);
        if (complex.segments[s][1] != complex.segments[s][0]) add(complex.segments[s][1]);
    });
    complex.segment_facets = transpose(complex.segments.size(), facets, [&](std::uint32_t f, auto&& add) {
        for (const Side& side : complex.facet_sides[f]) add(side.segment);
    });
    std::vector<std::uint32_t> seen(points, no_index);
    std::uint32_t pass = 0;
    complex.point_facets = transpose(points, facets, [&](std::uint32_t f, auto&& add) {
        // transpose() walks over all facets twice: a stamp per visit, not per facet.
        const std::uint32_t stamp = pass++;
        const auto add_once = [&](std::uint32_t v) {
            if (seen[v] != stamp) add(v);
            seen[v] = stamp;
        };
        for (const Side& side : complex.facet_sides[f]) {
            add_once(complex.segments[side.segment][0]);
            add_once(complex.segments[side.segment][1]);
        }
        for (const std::uint32_t v : complex.facet_points[f]) add_once(v);
    });
    if (points == 0) {
        complex.diagonal = 0.0;
        return;
    }
    Point3 low = complex.points[0], high = low;
    for (const Point3& p : complex.points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    complex.diagonal = std::hypot(high.x - low.x, high.y - low.y, high.z - low.z);
}

}  // namespace certa::conforming
