// A libFuzzer executable; CERTA_FUZZ_TARGET is the name of its target.
#include <cstddef>
#include <cstdint>

#include "targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    certa::fuzz::run_target(CERTA_FUZZ_TARGET, {reinterpret_cast<const char*>(data), size});
    return 0;
}
