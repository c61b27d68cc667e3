#pragma once
// The dyadic grid that carries octree and triangulation: integer coordinates whose places are exact doubles.
#include <certa/types.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "expression/jet.h"

namespace certa::implicit {

using interval::Interval;
using Region = expression::Place<Interval>;  ///< a box of space

/// 0 ... 2^resolution along each axis.
using Coordinate = std::uint32_t;
using GridPoint = std::array<Coordinate, 3>;

/// The user's box, enlarged by at most 2^-20 of its size on each side so that every grid point is a triple of doubles.
class Grid {
public:
    /// Empty when the box is so far from the origin, for its size, that doubles cannot carry a useful grid in it.
    static std::optional<Grid> around(const Point3& low, const Point3& high);

    /// Grid points per side: 2^resolution. Cells of depth d are 2^(resolution - d) wide; their centres are grid points
    /// up to depth resolution - 1.
    int resolution() const { return resolution_; }
    Coordinate side() const { return Coordinate{1} << resolution_; }

    double place(int axis, Coordinate i) const { return scaled(axis, i, 0, 0); }
    Point3 place(const GridPoint& p) const { return {place(0, p[0]), place(1, p[1]), place(2, p[2])}; }
    /// The point a + (b - a) t / 2^bits, exact when is_exact() says so.
    double between(int axis, Coordinate a, Coordinate b, unsigned t, int bits) const {
        const std::int64_t step = static_cast<std::int64_t>(b) - static_cast<std::int64_t>(a);
        return scaled(axis, a, step * static_cast<std::int64_t>(t), bits);
    }
    /// Whether `between` with this many bits is exact for every t, for grid points that are multiples of 2^zeros.
    bool is_exact(int bits, int zeros) const { return bits_ + resolution_ + bits - zeros <= 53; }

    Region region(const GridPoint& low, const GridPoint& high) const {
        Region box;
        for (int a = 0; a < 3; ++a) box[a] = Interval(place(a, low[a]), place(a, high[a]));
        return box;
    }

    /// The box is [first, first + count] 2^exponent on each axis.
    const std::array<std::int64_t, 3>& first() const { return first_; }
    const std::array<std::int64_t, 3>& count() const { return count_; }
    const std::array<int, 3>& exponent() const { return exponent_; }

private:
    /// (first_ 2^resolution + count_ i + count_ more / 2^bits) 2^(exponent_ - resolution).
    double scaled(int axis, Coordinate i, std::int64_t more, int bits) const {
        const auto a = static_cast<std::size_t>(axis);
        const auto whole = static_cast<__int128>(first_[a]) * side() + static_cast<__int128>(count_[a]) * i;
        const __int128 sum = whole * (std::int64_t{1} << bits) + static_cast<__int128>(count_[a]) * more;
        return std::ldexp(static_cast<double>(sum), exponent_[a] - resolution_ - bits);
    }

    std::array<std::int64_t, 3> first_{}, count_{};  ///< the box is [first, first + count] 2^exponent
    std::array<int, 3> exponent_{};
    int resolution_ = 0;
    int bits_ = 0;  ///< of the largest |first| and |first + count|
};

}  // namespace certa::implicit
