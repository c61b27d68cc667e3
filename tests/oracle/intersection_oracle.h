#pragma once
// What two triangles with small integer coordinates have in common, by clipping in rational numbers: slow, exact, and
// nothing in common with the library's way of deciding it.
#include <array>
#include <vector>

namespace certa::oracle {

using IntegerPoint = std::array<long long, 3>;
using IntegerTriangle = std::array<IntegerPoint, 3>;

enum class Meeting {
    nothing,       ///< or common vertices and sides only
    point_inside,  ///< a vertex of one inside the other, nothing else
    side_inside,   ///< a side of one inside the other, its ends at vertices of the other or inside it, nothing else
    forbidden,     ///< everything else
};

/// How two triangles with area meet. Coordinates up to 1000.
Meeting meet(const IntegerTriangle& a, const IntegerTriangle& b);

/// The sign of det(b - a, c - a, d - a). Coordinates up to 2^30.
int volume_sign(const IntegerPoint& a, const IntegerPoint& b, const IntegerPoint& c, const IntegerPoint& d);

}  // namespace certa::oracle
