#pragma once
// The complex as the mesher sees it: deduplicated segments, facets as sets of flagged sides, incidences both ways.
// Immutable once built; indices equal those of the public result (points, segments, facets).
#include <certa/mesh.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace certa::conforming {

/// Lists of different lengths in one array: row i is values[offsets[i]] ... values[offsets[i + 1] - 1].
template <class T>
struct Rows {
    std::vector<std::uint32_t> offsets{0};
    std::vector<T> values;
    std::size_t size() const { return offsets.size() - 1; }
    std::span<const T> operator[](std::size_t i) const {
        return {values.data() + offsets[i], values.data() + offsets[i + 1]};
    }
    void push_row(std::span<const T> row) {
        values.insert(values.end(), row.begin(), row.end());
        offsets.push_back(static_cast<std::uint32_t>(values.size()));
    }
};

/// A segment as part of a facet. On a boundary side the facet lies on one side only; otherwise on both
/// (an isolated segment, or a line along which another facet is attached). Crossing a boundary side in the facet's
/// plane changes between inside and outside: with no point on it, that is all there is to know about a facet.
struct Side {
    std::uint32_t segment = 0;
    bool boundary = true;
};

/// Orthonormal frame of a facet's plane: origin, two axes, Newell normal.
struct Frame {
    Point3 origin, u, v, normal;
};

struct Complex {
    std::vector<Point3> points;
    std::vector<std::array<std::uint32_t, 2>> segments;  // given ones first, in order; then sides by first appearance
    Rows<Side> facet_sides;
    Rows<std::uint32_t> facet_points;           // isolated points of each facet (on none of its sides)
    std::vector<Frame> frames;                  // one per facet
    std::vector<std::int32_t> facet_markers;    // one per facet
    std::vector<std::int32_t> segment_markers;  // one per segment; 0 where the input gives none

    std::vector<std::uint8_t> dropped_segments;  // empty, or one per segment: 1 where merging took a side away
    std::vector<std::uint32_t> ignored_points;   // sorted: they repeat another point and belong to nothing
    bool is_dropped(std::uint32_t segment) const { return !dropped_segments.empty() && dropped_segments[segment] != 0; }

    bool is_ignored(std::uint32_t point) const {
        return std::binary_search(ignored_points.begin(), ignored_points.end(), point);
    }

    // Derived incidences.
    Rows<std::uint32_t> point_segments;  // segments that end at a point
    Rows<std::uint32_t> segment_facets;  // facets that have a segment as a side
    Rows<std::uint32_t> point_facets;    // facets that contain a point (corner or isolated)

    double diagonal = 0.0;  // of the bounding box
};

/// Fills the derived incidences and the diagonal from the first group of arrays.
void build_incidences(Complex& complex);

}  // namespace certa::conforming
