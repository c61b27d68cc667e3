#pragma once
// One input facet laid flat: its constrained Delaunay triangulation seen along a coordinate axis.
// Dropping a coordinate keeps the other two as they are, so that every decision is exact on the input's doubles.
#include <certa/mesh.h>

#include <cstdint>
#include <span>
#include <vector>

#include "exact/orientation.h"

namespace certa::delaunay {

using exact::Point2;

/// Drops the coordinate along which a plane is seen largest; what is left is counter-clockwise about the normal.
/// Nearly equal normals choose the same axis: ties up to 1e-6 go to x, then y.
class Projection {
public:
    explicit Projection(const Point3& normal);
    Point2 operator()(const Point3& p) const;
    int axis() const { return axis_; }

private:
    int axis_ = 2;
    bool flipped_ = false;
};

/// A distinct side of a facet, in order of first appearance.
struct FlatSide {
    std::array<std::uint32_t, 2> ends{};
    bool on_ring = false;        ///< part of a closed ring, not only an isolated segment
    std::uint8_t inside = 0;     ///< how many of its two sides belong to the facet
    std::uint32_t repeated = 0;  ///< further appearances
};

enum class FlatState : std::uint8_t { done, crossing };

struct FlatFacet {
    FlatState state =
        FlatState::done;  ///< crossing: sides cross or run through points; nothing below `points` is known
    std::vector<FlatSide> sides;
    std::vector<std::uint32_t> points;                    ///< isolated points that are the end of no side
    std::vector<std::uint8_t> points_inside;              ///< one per entry of `points`
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< inside, counter-clockwise about the normal
    std::vector<std::uint32_t> holes_outside;  ///< indices into facet_holes that lie on a side or outside all rings
};

/// Fills sides and points only; needs valid indices, nothing else.
FlatFacet list_sides(const PiecewiseLinearComplex& input, std::uint32_t facet);

/// Lays facet `facet` flat. Never throws on bad geometry: see FlatState.
FlatFacet flatten_facet(const PiecewiseLinearComplex& input, std::uint32_t facet, const Projection& projection);

}  // namespace certa::delaunay
