#pragma once
// Lines that the user draws and that lines of the network follow (outlook of remesh, stage 4).
#include "remeshing/field.h"

namespace certa::remeshing {

/// Makes `measured` run along the guides (or across them, whichever is nearer to what was measured along the whole
/// guide) up to `band` beside them, with a confidence that nothing outvotes, and what was measured within `reach`, more
/// than `band`, count less the nearer it is. Says in field.guided which family follows. Before smoothing.
void follow_guides(const WorkMesh& mesh, DirectionField& field, double band, double reach);

}  // namespace certa::remeshing
