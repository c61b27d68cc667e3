// Asks the processor, not the C library, how it rounds: the operands are volatile, so that no compiler answers instead.
// Round to nearest is recognised by two sums that each other mode gets wrong on one side, for both signs.
#include "interval/environment.h"

#include <certa/error.h>

namespace certa::interval {

bool is_environment_sound() {
    volatile double one = 1.0, quarter_up = 0x1p-54, three_quarters_up = 0x1.8p-53;
    const bool up = one + quarter_up == 1.0 && one + three_quarters_up == 0x1.0000000000001p0;
    const bool down = -one - quarter_up == -1.0 && -one - three_quarters_up == -0x1.0000000000001p0;
    volatile double smallest_normal = 0x1p-1022, half = 0.5, denormal = 0x1p-1074, large = 0x1p1000;
    const bool kept = smallest_normal * half == 0x1p-1023 && denormal * large == 0x1p-74;
    return up && down && kept;
}

void require_sound_environment() {
    if (is_environment_sound()) return;
    throw InternalError(
        "the floating-point environment has been changed (rounding mode, flush-to-zero or denormals-are-zero): nothing "
        "can be proved. Restore it, and do not link code compiled with -ffast-math. If you did neither, please report "
        "this");
}

}  // namespace certa::interval
