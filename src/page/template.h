#pragma once
// The viewer: viewer/template.html, built from viewer/src, as it was when the library was compiled.
#include <string_view>

namespace certa::page {

/// Where the data goes; occurs once in the template.
inline constexpr std::string_view data_place = "<!--certa:data-->";

std::string_view page_template();

}  // namespace certa::page
