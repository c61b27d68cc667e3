#pragma once
// Where a coarse mesh breaks what is promised of it: polygons that turn away from the input, that meet others beyond
// what they share, or that are too far away. Decided here by own code: the checker of the result shares none of it.
#include <certa/mesh.h>
#include <certa/run_control.h>

#include <span>
#include <vector>

#include "core/triangle_tree.h"
#include "remeshing/coarse_mesh.h"

namespace certa::remeshing {

/// Whether two triangles (vertices by number; equal numbers are shared corners) have a point in common that is not on
/// what they share. Exact. Triangles without area meet nothing.
bool do_meet(std::span<const Point3> points, const std::array<Index, 3>& s, const std::array<Index, 3>& t);

/// The input as damage is judged against.
struct Judge {
    const TriangleMesh& input;
    const core::TriangleTree& tree;
    double diagonal = 0.0;
    bool is_embedded = true;   ///< contacts are forbidden: the input has none
    bool is_cut_open = false;  ///< vertices in one place will be one (stitch)
    /// Whether a triangle turns away by 90 degrees or more from all that is nearest to its middle.
    bool is_turned_away(const Point3& a, const Point3& b, const Point3& c) const;
};

struct Damage {
    std::vector<Index> polygons;  ///< that no choice of diagonals helps, sorted
    std::size_t folds = 0, contacts = 0;
    std::size_t split = 0;  ///< quads that became two triangles because only one of their diagonals is sound
};
/// Splits quads of which only one diagonal will do, and lists what remains broken.
Damage find_damage(const Judge& judge, CoarseMesh& mesh, const RunControl& control);

/// Whether any two triangles meet beyond what they share. `names`: per point; copies of one have the same.
bool has_contact(const TriangleMesh& mesh, std::span<const Index> names, const RunControl& control);

}  // namespace certa::remeshing
