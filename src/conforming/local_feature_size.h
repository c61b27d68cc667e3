#pragma once
// Local feature size (thesis, Part I, Definition 3): distance from a point to the union of the faces that do not
// contain it. "Contains" is combinatorial: the point is an input vertex or lies inside a known segment.
#include <certa/error.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "conforming/complex.h"
#include "conforming/facet_interior.h"

namespace certa::conforming {

/// A lower bound on the local feature size, smaller than it by a factor of at most 1 - 1e-7, and a face that gives it.
/// `nearest` is not set (index no_index) when nothing was found nearer than the limit of the query.
struct FeatureSize {
    double value = std::numeric_limits<double>::infinity();
    ElementRef nearest{ElementKind::vertex, no_index};
};

/// Answers queries in O(log n) from one box hierarchy over all faces. Keeps references to what it is built from.
/// Queries are const and touch no shared state: safe from several threads.
class LocalFeatureSize {
public:
    LocalFeatureSize(const Complex& complex, const FacetInterior& interior);

    /// lfs of an input vertex, or `limit` if that is smaller.
    FeatureSize at_vertex(std::uint32_t vertex, double limit = std::numeric_limits<double>::infinity()) const;

    /// lfs of a point inside a segment, or `limit` if that is smaller. Both ends count: they do not contain the point.
    FeatureSize on_segment(std::uint32_t segment, const Point3& place,
                           double limit = std::numeric_limits<double>::infinity()) const;

private:
    struct Node {
        Point3 low, high;
        std::uint32_t first = 0;  // leaf: first primitive; else index of the second child (the first one follows)
        std::uint32_t count = 0;  // 0: inner node
    };
    struct Primitive {
        std::array<std::uint32_t, 3> points;  // a segment repeats its second point, a point stands three times
        std::uint32_t face;                   // index of the facet, segment or vertex
        ElementKind kind;
    };
    struct Query;

    std::uint32_t build(std::vector<Point3>& centers, std::vector<std::uint32_t>& order, std::uint32_t begin,
                        std::uint32_t end);
    void search(Query& query) const;

    const Complex& complex_;
    std::vector<Primitive> primitives_;
    std::vector<Node> nodes_;
};

}  // namespace certa::conforming
