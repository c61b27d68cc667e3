#pragma once
// The loops that make missing segments and facets appear: what to refine next, by which point, until nothing is
// missing.
#include <certa/error.h>
#include <certa/run_control.h>

#include <cstdint>
#include <string>
#include <vector>

#include "conforming/facet_patch.h"
#include "conforming/mesh_state.h"
#include "conforming/placement.h"

namespace certa::conforming {

struct RecoveryOptions {
    bool gabriel = false;  ///< empty diametral balls of constraint triangles
    SplitRule split_rule = SplitRule::copy;
    bool mirroring = true;         ///< false: circumcentres only, as in the thesis
    std::size_t max_points = 0;    ///< 0: no bound. Above it: over_budget
    std::size_t owner_budget = 0;  ///< 0: no bound. Steiner points that one segment or facet may get before it is stuck
    std::size_t total_budget = 0;  ///< the same for all together
};

/// Why a recovery ended before everything was there.
struct Obstruction {
    ElementRef element;               ///< the segment or facet that was being recovered
    std::uint32_t vertex = no_index;  ///< the mesh vertex in the way, if one is
    Point3 place;
    std::string reason;
};

struct RecoveryResult {
    Outcome outcome = Outcome::done;
    bool stuck = false;  ///< balls may help: over a budget of RecoveryOptions, or below the smallest feature
    std::vector<Obstruction> obstructions;                 ///< unless done
    std::size_t missing_segments = 0, missing_facets = 0;  ///< at the start
};

class Recovery {
public:
    Recovery(MeshState& mesh, const ProtectedArea* area, const RecoveryOptions& options, const RunControl& control);

    /// Refines until every segment and facet is in the mesh, or until it is clear that it will not end well.
    /// `present`: per facet, 1 where a triangle facet is a face of the mesh and marked; or empty.
    RecoveryResult run(std::span<const std::uint8_t> present);

    /// The constraint triangles of a facet: after a successful run all, else what was found last.
    void collect_triangles(std::uint32_t facet, std::vector<std::array<std::uint32_t, 3>>& triangles) const;

private:
    MeshState& mesh_;
    const ProtectedArea* area_;
    const RecoveryOptions& options_;
    const RunControl& control_;
    Placement placement_;
    FacetPatch patch_;
    RecoveryResult result_;
    std::vector<std::uint32_t> segment_points_, facet_points_;  // Steiner points per owner
    std::vector<std::uint8_t> is_center_;                       // per initial point: centre of a ball
    std::vector<std::uint32_t> encroached_;
    std::size_t initial_points_ = 0, watched_ = 0;

    bool is_over() const { return result_.outcome != Outcome::done; }
    void survey(std::span<const std::uint8_t> present);
    bool settle_plain_triangle(std::uint32_t facet);
    bool settle_facet(std::uint32_t facet);
    void settle_pieces();
    void split_missing(std::uint32_t piece);
    /// `near`: a vertex to start the search for the new point's place from, if a better one than an end is known.
    bool split(std::uint32_t piece, const Point3* reference, std::uint32_t near = no_index,
               std::uint32_t facet = no_index);
    void refine();
    void refine_triangle(const FacetPatch::Missing& missing);
    bool split_shield_of(const std::array<std::uint32_t, 3>& triangle);
    struct Blocking {
        bool found = false;
        std::uint32_t edge = 0;  // of the patch
    };
    Blocking find_blocking_piece(const std::array<std::uint32_t, 3>& triangle, const delaunay::PlanarPoint& p) const;
    bool is_unchanged(std::uint32_t edge) const;
    delaunay::PlanarPoint keep_near(const delaunay::PlanarPoint& p) const;
    void watch();
    bool insert_in_facet(const Point3& place, std::uint32_t near);
    bool insert_point(const Point3& place, std::uint32_t near, const Owner& owner, std::uint32_t& vertex);
    void fail(Outcome outcome, bool stuck, ElementRef element, std::uint32_t vertex, const Point3& place,
              const char* reason);
    void blame_crowded_owners();
    bool check_limits(const Owner& owner, const Point3& place);
};

}  // namespace certa::conforming
