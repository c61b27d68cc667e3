// Refuses to be compiled where floating-point arithmetic would not be IEEE: the exact predicates' filters, the checkers
// and the readers' shortest round trip all rest on it. This file has no code; every build of the library compiles it
// with the library's flags. The flag that must be *on*, -ffp-contract=off, is set on the target in CMakeLists.txt.
#include <cfloat>
#include <limits>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "Certa must not be compiled with -ffast-math or -ffinite-math-only: its results would no longer be proved"
#endif
#if FLT_EVAL_METHOD != 0
#error "Certa needs doubles that are evaluated as doubles; on 32-bit x86 compile with -msse2 -mfpmath=sse"
#endif

static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<double>::digits == 53);
