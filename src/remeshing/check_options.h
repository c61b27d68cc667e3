#pragma once
// Options that cannot be.
#include <certa/remeshing.h>

namespace certa::remeshing {

/// Errors: InputError for what is out of range or does not go together.
void check_options(const RemeshOptions& options);
/// Errors: InputError for an error that no bound can be proved for, on a surface of this diagonal.
void check_error(const RemeshOptions& options, double diagonal);

}  // namespace certa::remeshing
