#pragma once
// One model of a page: what the manifest says of it, and its arrays.
#include <certa/view.h>

#include <string>

#include "page/page_arrays.h"

namespace certa::page {

/// The manifest's entry (JSON) of a model; its arrays are added to `arrays`.
///
/// Errors: InputError, see format_view.
std::string describe_model(const ViewModel& model, PageArrays& arrays);

}  // namespace certa::page
