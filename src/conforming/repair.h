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

/// Points to merge, rings to trim, points to put into segments, polygons to add to facets, and words about all of them.
struct RepairPlan {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> merges;  ///< point, the point that takes its place
    std::vector<std::uint32_t> trims;                             ///< facets with spikes, see trim_spikes
    std::vector<Point3> new_points;                               ///< numbered after the existing ones
    std::vector<std::pair<std::uint32_t, std::uint32_t>> splits;  ///< segment, point
    std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> polygons;  ///< facet, one or two points
    std::vector<Defect> repairs;
    bool empty() const { return merges.empty() && trims.empty() && splits.empty() && polygons.empty(); }
};

/// Takes out of a ring what it walks to and straight back; true when that changes it. Less than three points may be
/// left.
bool trim_spikes(std::vector<std::uint32_t>& ring);

/// What mends the first of these that there are: points within rounding of each other, spikes, T-junctions, crossings.
RepairPlan plan_repairs(const PiecewiseLinearComplex& input, const Complex& complex, const ConformOptions& options);

/// The input with the plan carried out.
PiecewiseLinearComplex carry_out(const RepairPlan& plan, const PiecewiseLinearComplex& input, const Complex& complex);

}  // namespace certa::conforming
