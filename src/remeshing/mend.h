#pragma once
// The last stage before a result: what is broken becomes input again, as little of it as will do.
#include "remeshing/damage.h"
#include "remeshing/join_triangles.h"
#include "remeshing/missed_creases.h"
#include "remeshing/region_patch.h"

namespace certa::remeshing {

struct MendingRule {
    double tolerance = 0.0;       ///< by how much triangles of the input may be thinned out, in its unit
    double side_tolerance = 0.0;  ///< the same beside the polygons around
    double crease_reach = 0.0;    ///< how far a side may be from the crease that it is; polygons around are so anyway
    double error = 0.0;           ///< polygons farther than this are broken, too; 0: any distance will do
    double reach = 0.0;           ///< how far a minor crease may be from the result; 0: as far as anything is
    CreaseRule creases = {};      ///< where no error is asked for
    bool all_triangles = false;   ///< neighbours that get more corners become triangles, else also quads
    std::vector<Recut> recuts = {};  ///< of the polygons, to be done first, where they do no harm ...
    bool all_recuts = false;         ///< ... or anyway: they have been looked at
};

struct MendingReport {
    std::size_t rounds = 0, regions = 0, faces = 0, triangles = 0;  ///< faces of the graph, and what replaces them
    std::size_t split_quads = 0, cut_faces = 0;
    Index first_added = no_index;  ///< vertex: those before are the polygons' own
    std::vector<Point3> left;      ///< where something is still broken: the input itself is
};

/// Replaces polygons that turn away, meet others or miss creases (and, on demand, that are too far) by thinned-out
/// triangles of the input, cut along the polygon's sides, whose neighbours get the corners that are left there; where
/// those fail, by more of them; where that fails, also around. In the end whole components are the input, which is
/// sound by definition.
///
/// Guarantee: topology as before; what is not listed in `left` is free of folds and contacts. Deterministic.
MendingReport mend(const Layout& layout, const Judge& judge, const MendingRule& rule, CoarseMesh& mesh,
                   const RunControl& control);

/// Puts thinned-out triangles of the input in place of the layout's open faces. Vertices keep their numbers.
void fill_open_faces(const Layout& layout, const Judge& judge, const MendingRule& rule, CoarseMesh& mesh,
                     const RunControl& control);

/// The input, thinned out: what is left where there is no network at all. `vertices`: about so many, 0 for as few as
/// the tolerance allows.
CoarseMesh thin_input(const WorkMesh& mesh, const Judge& judge, double tolerance, std::size_t vertices,
                      const RunControl& control);
/// The same for some of its components, all of whose triangles are listed. Tolerance 0: as they are.
CoarseMesh thin_part(const WorkMesh& mesh, std::span<const Index> triangles, const Judge& judge, double tolerance,
                     const RunControl& control);

/// Leaves out vertices without polygons, and feature edges that are no sides.
void leave_out_unused(CoarseMesh& mesh);

}  // namespace certa::remeshing
