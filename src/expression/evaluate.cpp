// Evaluation of one point, for users: builds the tape each time. The engines keep their tape and workspace (jet.h).
#include <certa/implicit.h>

#include "expression/jet.h"

namespace certa {

PointValue evaluate(const Expression& function, const Point3& place) {
    const expression::Tape tape(function);
    expression::Workspace<double> workspace(tape);
    const expression::Jet<double>& jet = workspace.evaluate<1>({place.x, place.y, place.z});
    return {jet.value, {jet.gradient[0], jet.gradient[1], jet.gradient[2]}};
}

}  // namespace certa
