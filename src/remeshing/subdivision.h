#pragma once
// Quad/triangle subdivision with creases: a smooth surface over the coarse mesh.
#include <span>

#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// One round. Triangles become four triangles, quads four quads, larger polygons as many quads as they have corners;
/// then all vertices are averaged. In regular regions the limit is Loop's surface over triangles and the bicubic spline
/// over quads, on feature edges and the boundary the cubic spline of the curve; corners stay. A vertex between feature
/// edges other than two is a corner whatever its kind says.
/// Not smooth: without averaging, all stays on the polygons.
/// `stays`, per polygon or empty: those polygons are not cut, nor are their sides; polygons beside them become fans.
/// `names`, per vertex or empty: vertices of one name are one, so that copies of a side are cut alike.
///
/// Result:     kinds, curves and feature edges go on; vertices keep their numbers; places are not known (face =
///             no_index); parents are the polygons of `mesh`.
/// Source:     Stam and Loop 2003, in the factored form of Warren and Schaefer 2004: linear subdivision, then weighted
///             centroids.
CoarseMesh subdivide(const CoarseMesh& mesh, bool smooth = true, std::span<const std::uint8_t> stays = {},
                     std::span<const Index> names = {});

}  // namespace certa::remeshing
