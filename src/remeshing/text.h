#pragma once
// Numbers and places in notes and refusals.
#include <certa/types.h>

#include <string>

namespace certa::remeshing {

/// The fewest digits that mean this number.
std::string text_of(double value);
std::string text_of(const Point3& p);

}  // namespace certa::remeshing
