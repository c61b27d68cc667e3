#pragma once
// Random expressions with shared parts, for property tests.
#include <certa/implicit.h>

#include "core/random.h"

namespace certa::test {

/// About `size` operations on x, y, z and constants; every operation of the language occurs.
Expression random_expression(core::Random& random, int size);

}  // namespace certa::test
