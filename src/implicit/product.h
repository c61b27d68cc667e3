#pragma once
// Products of functions: each factor certified by itself, and the surfaces proved to be apart.
#include <certa/implicit.h>

#include <vector>

#include "implicit/grid.h"

namespace certa::implicit {

/// The factors of a product that depend on x, y or z, from left to right; signs and constants that are proved not to be
/// 0 are left out. Empty where the function is no product of 2 to 16 such factors.
std::vector<Expression> factors_of(const Expression& function);

/// Certifies a product: whole, if that is cheap, else its type by its factors (docs/implicit-theorem.md, "products").
ImplicitResult mesh_product(const Expression& function, const std::vector<Expression>& factors, const Grid& grid,
                            const ImplicitOptions& options, const RunControl& control);

}  // namespace certa::implicit
