#pragma once
// The mesh while it grows: the Delaunay triangulation, the pieces that segments and shields are cut into, who owns each
// Steiner point, and the queues of what an insertion has put in doubt.
#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

#include "conforming/complex.h"
#include "conforming/protected_area.h"
#include "core/index_map.h"
#include "delaunay/delaunay_3.h"

namespace certa::conforming {

/// What a piece must satisfy. Presence is exact; the Gabriel property is asked up to rounding.
enum class PieceRule : std::uint8_t { present, gabriel };

/// A part of a segment, or a shield edge: an edge that has to be in the triangulation.
struct Piece {
    std::uint32_t a = 0, b = 0;     ///< directed like its segment
    std::uint32_t next = no_index;  ///< the following piece of the same chain
    std::uint32_t owner = 0;        ///< segment, or facet of a shield
    std::uint32_t ball = no_index;  ///< the ball around a shield edge
    bool shield = false;
    bool queued = false;
    PieceRule rule = PieceRule::present;
    std::uint32_t from = no_index,
                  to = no_index;  ///< crossings (Placement) before and after it; none: the segment's ends
};

/// Where a Steiner point lies.
struct Owner {
    bool on_segment = false;
    std::uint32_t index = 0;
};

/// What only facets have that are not plain triangles any more.
struct FacetWork {
    std::vector<std::uint32_t> points;                    ///< Steiner and adopted points in its inside
    std::vector<std::uint32_t> shields;                   ///< pieces
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< accepted; of no use while the facet is queued
};

class MeshState {
public:
    explicit MeshState(const Complex& complex);

    /// Starts over from the triangulation of the input points, or of those and the area's, with nothing in the queues;
    /// `area` (or null) adds chains and shields.
    void reset(delaunay::Delaunay3 initial, const ProtectedArea* area, PieceRule segment_rule);

    enum class Insertion : std::uint8_t { done, occupied, too_close };
    struct Inserted {
        Insertion outcome = Insertion::done;
        std::uint32_t vertex = no_index;  ///< the new one, or the one in the way
    };
    /// Inserts a point and puts pieces and facets that it touches into the queues.
    Inserted insert(const Point3& place, std::uint32_t near, const Owner& owner);
    /// Cuts a piece at the vertex on it that was inserted last; queues what depends on it.
    void cut(std::uint32_t piece, std::uint32_t vertex);
    /// Makes a vertex on a segment the end from which pieces on both sides measure.
    void set_crossing(std::uint32_t segment, std::uint32_t vertex);
    /// The pieces with the Gabriel rule whose diametral ball a point would enter, if it were inserted.
    void find_encroached(const Point3& place, std::uint32_t near, std::vector<std::uint32_t>& found);
    /// Marks a constraint triangle, so that its facet hears of its disappearance; false where it is absent.
    bool mark(std::uint32_t facet, const std::array<std::uint32_t, 3>& triangle);

    void queue_piece(std::uint32_t piece);
    void queue_facet(std::uint32_t facet);
    std::uint32_t pop_piece();
    std::uint32_t pop_facet();
    /// Whether a piece satisfies its rule.
    bool is_satisfied(const Piece& piece) const;
    /// Facets that a vertex lies on.
    void find_facets(std::uint32_t vertex, std::vector<std::uint32_t>& facets) const;
    /// Position along its segment's line, from the first end.
    double parameter_of(std::uint32_t segment, std::uint32_t vertex) const;

    FacetWork& work_of(std::uint32_t facet);
    const FacetWork* find_work(std::uint32_t facet) const {
        return work_index_[facet] == no_index ? nullptr : &works_[work_index_[facet]];
    }
    bool is_cut(std::uint32_t segment) const { return pieces[first_pieces[segment]].next != no_index; }
    /// Records that a vertex lies on a facet that does not own it.
    void adopt(std::uint32_t facet, std::uint32_t vertex);

    const Complex& complex;
    delaunay::Delaunay3 triangulation;
    std::vector<Owner> owners;  ///< of Steiner points, from complex.points.size() on
    std::vector<Piece> pieces;
    std::vector<std::uint32_t> first_pieces;  ///< per segment
    std::deque<std::uint32_t> piece_queue, facet_queue;
    double min_feature = 0.0;
    bool heed_borders = false;  ///< queue facets also for triangles that an insertion comes near
    double rounding = 0.0;      ///< a few units in the last place of the largest coordinate

private:
    core::PairMap piece_of_edge_;
    std::vector<std::uint32_t> work_index_;
    std::deque<FacetWork> works_;
    std::vector<std::uint8_t> facet_queued_;
    std::unordered_multimap<std::uint32_t, std::uint32_t> adopted_;
    std::vector<std::uint32_t> touched_;  // pieces among the edges of a conflict zone, those that disappear first
    std::size_t removed_pieces_ = 0;
    bool gabriel_pieces_ = false;  // there are any

    std::uint32_t add_piece(const Piece& piece);
    void find_touched(const delaunay::ConflictZone& zone);
};

/// Whether p is inside the diametral ball of ab by more than rounding.
bool encroaches(const Point3& p, const Point3& a, const Point3& b, double rounding);

}  // namespace certa::conforming
