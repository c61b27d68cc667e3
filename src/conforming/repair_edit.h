#pragma once
// A piecewise linear complex in a form that can be edited facet by facet.
#include <certa/mesh.h>

#include <cstdint>
#include <vector>

namespace certa::conforming {

struct EditableFacet {
    std::vector<std::vector<std::uint32_t>> polygons;
    std::vector<Point3> holes;
    std::int32_t marker = 0;
};

struct EditableComplex {
    std::vector<Point3> points;
    std::vector<std::array<std::uint32_t, 2>> segments;
    std::vector<std::int32_t> segment_markers;  // one per segment
    std::vector<EditableFacet> facets;
};

EditableComplex take_apart(const PiecewiseLinearComplex& input);

/// The inverse. What cannot be edited (region seeds and holes) and which markers there are comes from `like`; points
/// beyond those of `like` get marker 0.
PiecewiseLinearComplex put_together(const EditableComplex& edited, const PiecewiseLinearComplex& like);

}  // namespace certa::conforming
