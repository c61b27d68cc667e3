#pragma once
// Private side of repair_complex (certa/conforming.h): its first step by itself.
#include <certa/conforming.h>

namespace certa::conforming {

struct CleanedComplex {
    PiecewiseLinearComplex complex;
    std::vector<Defect> repairs;
};

/// Mends what validate_structure finds: points that coincide become one, sides and segments without length go, facets
/// without area and repeated ones become empty. Points and facets keep their numbers. Needs a buildable input.
CleanedComplex clean_structure(const PiecewiseLinearComplex& input);

}  // namespace certa::conforming
