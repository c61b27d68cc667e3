#pragma once
// Quad/triangle subdivision with creases: a smooth surface over the coarse mesh.
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// One round. Triangles become four triangles, quads four quads, larger polygons as many quads as they have corners;
/// then all vertices are averaged. In regular regions the limit is Loop's surface over triangles and the bicubic spline
/// over quads, on feature edges and the boundary the cubic spline of the curve; corners stay. A vertex between feature
/// edges other than two is a corner whatever its kind says.
/// Not smooth: without averaging, all stays on the polygons.
///
/// Result:     kinds, curves and feature edges go on; places are not known (face = no_index).
/// Source:     Stam and Loop 2003, in the factored form of Warren and Schaefer 2004: linear subdivision, then weighted
///             centroids.
CoarseMesh subdivide(const CoarseMesh& mesh, bool smooth = true);

}  // namespace certa::remeshing
