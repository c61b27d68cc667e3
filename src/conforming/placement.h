#pragma once
// Where new points go (docs/lazy-protection.md): on segments by copied distances, in facets by mirroring.
#include <cstdint>
#include <optional>
#include <vector>

#include "conforming/mesh_state.h"

namespace certa::conforming {

/// Which distance a cut on a segment with an acute end takes over. None gives the fewest points everywhere.
enum class SplitRule : std::uint8_t {
    copy,          ///< the reference's
    middle_first,  ///< whole segments are halved, parts as with copy
    shells,        ///< a power of two
};

class Placement {
public:
    Placement(const MeshState& mesh, SplitRule rule);

    /// Where to cut a piece of a segment. With a reference: at the reference's distance from an acute end, or at its
    /// projection where no end is acute; on a power-of-two shell or in the middle when that is too near to an end.
    Point3 split_of(const Piece& piece, const Point3* reference);

    /// Where a piece of a side of f crosses the image of a segment that `witness` lies on, rotated into f about a
    /// common side; nothing where none does, or too near to an end of the piece.
    std::optional<Point3> crossing_of(const Piece& piece, std::uint32_t f, std::uint32_t witness) const;

    /// A point of facet f that looks like vertex q from the line or point where f meets an element that q lies on, and
    /// lies within `radius` of `center` (both in the plane of f); or the foot of q where it is close to the plane.
    /// Nothing when neither is there.
    std::optional<Point3> mirror(std::uint32_t f, const Point3& center, double radius, std::uint32_t q);

private:
    const MeshState& mesh_;
    SplitRule rule_;
    std::vector<std::uint8_t> acute_;  // per segment: bit 0, 1 first, second end; bit 2 known
    std::vector<std::uint32_t> facets_;

    std::optional<Point3> crossing_about(std::uint32_t axis, const Piece& piece, std::uint32_t segment) const;
    std::uint8_t acute_ends(std::uint32_t segment);
    bool is_acute(std::uint32_t segment, std::uint32_t end) const;
    std::optional<Point3> rotate(std::uint32_t f, const Point3& on_line, const Point3& direction, const Point3& center,
                                 const Point3& q) const;
    std::optional<Point3> over_common_segment(std::uint32_t f, std::uint32_t k, const Point3& center,
                                              const Point3& q) const;
    std::optional<Point3> over_common_vertex(std::uint32_t f, std::uint32_t k, const Point3& center,
                                             const Point3& q) const;
    std::optional<Point3> about_common_end(std::uint32_t f, std::uint32_t segment, const Point3& q) const;
};

}  // namespace certa::conforming
