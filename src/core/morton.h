#pragma once
// Position along a Z-shaped curve through space (Morton 1966): neighbours in the order are mostly neighbours in space.
#include <algorithm>
#include <cstdint>

namespace certa::core {

/// Two zeros before each of the lowest 21 bits.
constexpr std::uint64_t spread_bits(std::uint64_t bits) {
    bits = (bits | bits << 32) & 0x1f00000000ffffULL;
    bits = (bits | bits << 16) & 0x1f0000ff0000ffULL;
    bits = (bits | bits << 8) & 0x100f00f00f00f00fULL;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3ULL;
    return (bits | bits << 2) & 0x1249249249249249ULL;
}

/// The code of three numbers below 2^21.
constexpr std::uint64_t morton_code_of_bits(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

/// The code of a point of the unit cube; what lies outside is moved to its boundary.
inline std::uint64_t morton_code(double x, double y, double z) {
    const auto bits = [](double t) { return static_cast<std::uint64_t>(std::clamp(t, 0.0, 1.0) * 2097151.0); };
    return morton_code_of_bits(bits(x), bits(y), bits(z));
}

}  // namespace certa::core
