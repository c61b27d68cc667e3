#pragma once
// What the checker needs to know about products beyond their factors.
#include <certa/run_control.h>

#include <string>

#include "verify/implicit_function.h"

namespace certa::verify {

/// Proves that two functions have no common zero in a box: each part of the box misses a zero of one of them, or of a
/// combination f - t g. Returns what hinders; empty: proved.
std::string check_apart(const ImplicitFunction& f, const ImplicitFunction& g, const BoxOfDoubles& box,
                        const RunControl& control);

}  // namespace certa::verify
