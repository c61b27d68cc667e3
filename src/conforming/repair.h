#pragma once
// Private side of repair_complex (certa/conforming.h): its steps.
#include <certa/conforming.h>

#include "conforming/complex.h"
#include "conforming/repair_edit.h"

namespace certa::conforming {

struct CleanedComplex {
    PiecewiseLinearComplex complex;
    std::vector<Defect> repairs;
};

/// Mends what validate_structure finds: points that coincide become one, sides and segments without length go, facets
/// without area and repeated ones become empty. Points and facets keep their numbers. Needs a buildable input.
CleanedComplex clean_structure(const PiecewiseLinearComplex& input);

/// Cuts facets that are not planar within `planarity` into the triangles of their Delaunay triangulation.
RepairedComplex triangulate_facets(const PiecewiseLinearComplex& input, double planarity);

/// Points to put into segments, polygons to add to facets, and words about both.
struct RepairPlan {
    std::vector<Point3> new_points;                                              ///< numbered after the existing ones
    std::vector<std::pair<std::uint32_t, std::uint32_t>> splits;                 ///< segment, point
    std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> polygons;  ///< facet, one or two points
    std::vector<Defect> repairs;
    bool empty() const { return splits.empty() && polygons.empty(); }
};

/// What mends T-junctions, or, when there are none, crossings.
RepairPlan plan_repairs(const PiecewiseLinearComplex& input, const Complex& complex, const ConformOptions& options);

/// The input with the plan carried out.
PiecewiseLinearComplex carry_out(const RepairPlan& plan, const PiecewiseLinearComplex& input, const Complex& complex);

}  // namespace certa::conforming
