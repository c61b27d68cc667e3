#pragma once
// What joins the protected set when lazy recovery did not end well (docs/lazy-protection.md, "The guarantee").
#include <cstdint>
#include <vector>

#include "conforming/protecting_balls.h"
#include "conforming/recovery.h"

namespace certa::conforming {

/// Adds the vertices and segments of the elements in the way: their own, or, where these are protected already, those
/// of ever wider rings of facets around them. Returns false when everything reachable is protected already.
bool grow_protected_set(ProtectedSet& set, const Complex& complex, const std::vector<Obstruction>& obstructions);

}  // namespace certa::conforming
