#pragma once
// The radial triangulation T of an octree, built around the leaves where the sign of f is open.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "implicit/octree.h"

namespace certa::implicit {

/// Definition: every smallest square of the octree is coned from its centre over its boundary with hanging points,
/// every leaf
///             from its centre over its squares (thesis, Part III, 1.7.2, without balance). An edge or square is
///             subdivided if and only if its midpoint is a corner of a leaf, so leaves agree on what they share.
/// Result:     the tetrahedra of all active leaves: those that share a point with an open leaf (no sign known). The
/// star
///             of every point of an open leaf is complete. Signs of points: the sign proved on a leaf around it, else
///             that of f at the point, 0 and NaN counting as +.
class Triangulation {
public:
    /// `signs` keeps what was evaluated at points between builds; it grows with the points of the tree.
    struct PointSign {
        std::int8_t sign = 0;  ///< 0: not evaluated yet
        bool proved = false;
    };
    /// `whole`: all leaves are active, and every point of no critical leaf may join.
    Triangulation(Octree& tree, Field& field, std::vector<PointSign>& signs, bool whole = false);
    /// The same after some leaves were split (once each, their children not), from what was built before: only leaves
    /// that got a new corner are built anew. Leaves that were active stay so, children of active leaves are.
    Triangulation(Octree& tree, Field& field, std::vector<PointSign>& signs, const Triangulation& previous,
                  std::span<const std::uint32_t> split);

    using Tetrahedron = std::array<std::uint32_t, 4>;  ///< positively oriented; the leaf's centre first

    std::span<const std::uint32_t> active_leaves() const { return active_; }
    std::span<const Tetrahedron> tetrahedra() const { return tetrahedra_; }
    std::span<const Tetrahedron> tetrahedra_of(std::size_t active) const {
        return std::span(tetrahedra_).subspan(offsets_[active], offsets_[active + 1] - offsets_[active]);
    }
    bool is_active(std::uint32_t leaf) const { return is_active_[leaf] != 0; }
    /// Position among the active leaves of a tetrahedron's leaf.
    std::uint32_t leaf_of(std::size_t tetrahedron) const { return leaf_of_[tetrahedron]; }

    std::size_t point_count() const { return sign_.size(); }
    int sign(std::uint32_t point) const { return sign_[point]; }
    /// Points that may join W: of an open leaf, of no critical leaf, not on the boundary of the box unless that clips.
    bool may_join(std::uint32_t point) const { return may_join_[point] != 0; }
    /// The faces of the box that hold a point (Octree::box_faces); 0 unless the box clips.
    unsigned box_faces(std::uint32_t point) const { return box_faces_.empty() ? 0 : box_faces_[point]; }
    /// Whether the star of a point, or a sign in it, may differ from the triangulation that this one was made from.
    bool is_changed(std::uint32_t point) const { return changed_[point] != 0; }
    /// Tetrahedra around a point that may join.
    std::span<const std::uint32_t> around(std::uint32_t point) const {
        return std::span(around_).subspan(around_offsets_[point], around_offsets_[point + 1] - around_offsets_[point]);
    }

private:
    void choose_active(Octree& tree);
    void inherit_active(const Octree& tree, const Triangulation& previous, std::span<const std::uint32_t> split);
    void build_rest(Octree& tree, Field& field, std::vector<PointSign>& signs, const Triangulation* previous);
    void build_leaf(Octree& tree, std::uint32_t leaf);
    void settle_signs(const Octree& tree, Field& field, std::vector<PointSign>& signs);
    void settle_sign(const Octree& tree, Field& field, int proved, std::uint32_t point, PointSign& known);
    void note_changes();
    void choose_candidates(const Octree& tree);
    void index_stars();

    std::vector<std::uint32_t> active_, leaf_of_, offsets_, around_, around_offsets_;
    std::vector<char> is_active_, may_join_;
    std::vector<char> is_new_;  ///< per active leaf: built anew
    std::vector<char> changed_;
    bool whole_ = false;
    bool turned_ = false;  ///< a sign of a known point turned out to be the other
    std::vector<std::int8_t> sign_;
    std::vector<std::uint8_t> box_faces_;
    std::vector<Tetrahedron> tetrahedra_;
};

}  // namespace certa::implicit
