#pragma once
// Options that cannot be.
#include <certa/remeshing.h>

namespace certa::remeshing {

/// Errors: InputError for what is out of range or does not go together.
void check_options(const RemeshOptions& options);

}  // namespace certa::remeshing
