#pragma once
// Sides and diagonals of polygons that shrink to a vertex.
#include <optional>
#include <vector>

#include "remeshing/arrangement.h"
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// A vertex that was merged into another; both by their numbers, which stay.
struct MergedVertex {
    Index vertex = no_index, into = no_index;
};

/// `merged` as it is after `next` were merged, too.
void append_merged(std::vector<MergedVertex>& merged, const std::vector<MergedVertex>& next);

/// A coarse mesh whose vertices are merged one by one.
///
/// Guarantee: no side is repeated that was not, the topology stays; corners stay, a side on a feature keeps to the
/// rule's errors of the nodes that were on it.
class Contraction {
public:
    Contraction(CoarseMesh& mesh, const ArrangementRule& rule);

    /// Merges v into a neighbour, or, where v is smooth, into the opposite corner of a quad, which goes. A triangle on
    /// the side goes, its other two sides become one. False, and nothing happens: that must not be.
    bool merge(Index v, Index into);
    /// The polygons that this would change, those that go left out; empty: it must not be.
    std::vector<Index> changed_by(Index v, Index into) const;

    const std::vector<Index>& ring(Index polygon) const { return rings_[polygon]; }
    Index polygon_count() const { return static_cast<Index>(rings_.size()); }
    const std::vector<Index>& around(Index v) const { return around_[v]; }
    std::vector<Index> neighbours(Index v) const;
    bool is_feature_side(Index a, Index b) const;

    /// Polygons as they are now into the mesh, and what was merged into what is left at last.
    std::vector<MergedVertex> write_back();

private:
    /// A side on a feature curve, and the nodes that it has swallowed.
    struct CurveSide {
        Index other = no_index, curve = no_index;
        std::vector<Point3> passed;
    };
    const CurveSide* find_side(Index v, Index other) const;
    CurveSide* find_side(Index v, Index other) {
        return const_cast<CurveSide*>(static_cast<const Contraction*>(this)->find_side(v, other));
    }
    std::optional<CurveSide> join_sides(Index v, Index into) const;
    bool may_merge_side(Index v, Index into) const;
    Index quad_between(Index v, Index into) const;
    bool may_lose_polygon(Index x, Index v) const;
    void drop(Index q);

    CoarseMesh& mesh_;
    const ArrangementRule rule_;
    std::vector<std::vector<Index>> rings_, around_;
    std::vector<std::vector<CurveSide>> sides_;  ///< per vertex
    std::vector<MergedVertex> merged_;
};

}  // namespace certa::remeshing
