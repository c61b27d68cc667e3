#pragma once
// Which Certa this is; the source file is written at build time (cmake/BuildInfo.cmake).

namespace certa::cli {

const char* version();           ///< "0.1.0"
const char* commit();            ///< "1a2b3c4d5e6f", with "+" when files were changed; "unknown" outside a checkout
const char* library_versions();  ///< one line each: compiler, CGAL, Boost, GMP, MPFR, oneTBB, CLI11, JSON

}  // namespace certa::cli
