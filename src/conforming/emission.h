#pragma once
// From a conforming triangulation to the mesh that users get: labels, regions, what is left out.
#include <certa/conforming.h>

#include "conforming/mesh_state.h"
#include "conforming/recovery.h"

namespace certa::conforming {

/// Fills mesh, segments, region attributes, warnings and the statistics about Steiner points.
///
/// Input:  a finished recovery. Errors: InputError for seeds with different attributes in one region; InternalError
/// where
///         a constraint triangle is absent.
void emit_mesh(MeshState& mesh, const Recovery& recovery, const PiecewiseLinearComplex& input,
               const ConformOptions& options, ConformResult& result);

/// The same without promises, for runs that did not finish: all cells, and the constraint triangles and edges that are
/// there.
void emit_partial(MeshState& mesh, const Recovery& recovery, ConformResult& result);

}  // namespace certa::conforming
