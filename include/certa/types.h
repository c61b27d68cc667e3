#pragma once
// Points and strong identifiers shared by every public header.
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace certa {

/// A point or vector in the input's unit. Plain layout: an array of Point3 is an n x 3 array of doubles.
struct Point3 {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    friend bool operator==(const Point3&, const Point3&) = default;
};

///@{
/// 0-based positions in the arrays of one mesh. Different kinds do not convert into each other.
enum class VertexId : std::uint32_t {};
enum class SegmentId : std::uint32_t {};
enum class FacetId : std::uint32_t {};
///@}

/// Connected component of space minus the facets; 0 is the outside.
enum class RegionId : std::uint32_t {};

/// The number that an identifier stands for.
template <class Id>
constexpr std::uint32_t index_of(Id id) {
    return static_cast<std::uint32_t>(id);
}

/// "None" for any identifier.
inline constexpr std::uint32_t no_index = std::numeric_limits<std::uint32_t>::max();

/// A length that the user gave: in the input's unit, or relative to the diagonal of the bounding box.
struct Length {
    double value = 0.0;
    bool relative_to_diagonal = false;
    /// In the input's unit, for a box of this diagonal.
    constexpr double resolve(double diagonal) const { return relative_to_diagonal ? value * diagonal : value; }
};

}  // namespace certa
