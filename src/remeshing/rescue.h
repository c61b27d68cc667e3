#pragma once
// The last resort for components that mending has left broken: triangles of the input, in the end all of them.
#include "remeshing/mend.h"

namespace certa::remeshing {

struct RescueRule {
    double tolerance = 0.0;    ///< by how much triangles of the input may be thinned out at first
    std::vector<Point3> left;  ///< where mending has left something broken; where nothing, only topology is compared
};

/// Replaces components whose topology is not the input's, or with polygons that turn away or meet others, by triangles
/// of the input, thinned out less and less. Returns how many components that were.
///
/// Guarantee: what is left broken consists of components that are the input's own triangles.
std::size_t rescue_components(const Layout& layout, const Judge& judge, const RescueRule& rule, CoarseMesh& mesh,
                              const RunControl& control);

}  // namespace certa::remeshing
