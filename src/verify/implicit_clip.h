#pragma once
// What is different where a surface may meet the box: links that are disks, loops in the faces, gradients reflected.
#include <array>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "verify/implicit_complex.h"

namespace certa::verify {

/// A triangle of T between a critical and a regular leaf, counter-clockwise seen from the regular side, with what the
/// regular leaf claims of the derivatives there.
struct SlopeTriangle {
    std::array<std::uint32_t, 3> corners;
    int axis, slope;
};

/// Adds edges from a new point, ImplicitComplex::no_point, to all points of the rim of the link of p. Returns whether p
/// may join W as far as the rim tells: it changes between inside and outside twice in the face of the box that holds p,
/// or once in each of the two; at a corner of the box, never.
bool close_rim(const ImplicitComplex& complex, std::uint32_t p, std::span<const std::uint32_t> star,
               const std::function<bool(std::uint32_t)>& inside,
               std::vector<std::pair<std::uint32_t, std::uint32_t>>& link_edges);

/// A point of T with both a sign and a neighbour of the other sign for each loop of the surface in the box's boundary.
std::vector<std::uint32_t> loops_in_box_faces(const ImplicitComplex& complex);

/// The eight copies of a boundary under reflections at the faces of the box; points in a face are their own mirror
/// images, so copies that share them are glued. Corners of the result are no points of T.
std::vector<SlopeTriangle> unfolded(const ImplicitComplex& complex, const std::vector<SlopeTriangle>& triangles);

}  // namespace certa::verify
