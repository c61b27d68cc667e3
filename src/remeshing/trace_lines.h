#pragma once
// Lines of curvature at the spacing that the error allows (thesis 4.2.1; remesh, stages 5 and 6).
#include "remeshing/network.h"
#include "remeshing/proximity.h"
#include "remeshing/spacing.h"

namespace certa::remeshing {

struct TraceRule {
    double seed_below = 0.9;    ///< a seed's distance to the nearest line, in spacings, at least
    double stop_below = 0.5;    ///< a line ends closer than this to another of its family
    double gap_above = 0.75;    ///< gaps whose middle is farther than this from their sides get another line
    double feature_stop = 0.5;  ///< the same for features that run along the family
};

/// Traces both families until they cover the surface, then lengthens ends to the next line of the other family.
Network trace_lines(const WorkMesh& mesh, const DirectionField& field, const Spacing& spacing, const TraceRule& rule,
                    const RunControl& control);

}  // namespace certa::remeshing
