#pragma once
// The always-on assert: a broken invariant of ours becomes an InternalError, in every build type.

namespace certa::core {

/// Throws InternalError naming the broken condition and asking for a report.
[[noreturn]] void fail_assertion(const char* condition, const char* file, int line);

}  // namespace certa::core

#define CERTA_ASSERT(condition) \
    ((condition) ? static_cast<void>(0) : ::certa::core::fail_assertion(#condition, __FILE__, __LINE__))
