// Snapping a box outwards to a dyadic grid (docs/implicit-theorem.md, "the grid"). Along each axis the box becomes
// [first, first + count] 2^exponent with 2^exponent at most 2^-20 of the side, and is halved `resolution` times: grid
// point i is (first 2^resolution + count i) 2^(exponent - resolution), an integer of at most 53 bits times a power of
// two.
#include "implicit/grid.h"

#include <algorithm>

namespace certa::implicit {

std::optional<Grid> Grid::around(const Point3& low, const Point3& high) {
    Grid grid;
    const double lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
    for (std::size_t a = 0; a < 3; ++a) {
        const double size = highs[a] - lows[a];
        if (!(size > 0x1p-900) || !(size < 0x1p900)) return std::nullopt;
        const int exponent = std::ilogb(size) - 20;
        const double first = std::floor(std::ldexp(lows[a], -exponent)),
                     last = std::ceil(std::ldexp(highs[a], -exponent));
        if (!(std::fabs(first) < 0x1p44) || !(std::fabs(last) < 0x1p44)) return std::nullopt;
        grid.exponent_[a] = exponent;
        grid.first_[a] = static_cast<std::int64_t>(first);
        grid.count_[a] = static_cast<std::int64_t>(last) - grid.first_[a];
        const int bits = std::ilogb(std::max(std::fabs(first), std::fabs(last))) + 1;
        grid.bits_ = std::max(grid.bits_, bits);
    }
    // A power of two has one bit more than its logarithm says it needs; 2^53 itself is still exact.
    grid.resolution_ = std::min(30, 53 - grid.bits_ - 1);
    if (grid.resolution_ < 8) return std::nullopt;
    return grid;
}

}  // namespace certa::implicit
