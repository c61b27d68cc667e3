#pragma once
// Findings of many independent items, gathered in their order for any number of threads.
#include <certa/run_control.h>

#include <vector>

#include "core/parallel.h"
#include "verify/report.h"

namespace certa::verify {

/// Calls visit(item, findings) for 0 ... count - 1; stops early when cancelled.
template <class Visit>
void for_each_item(std::size_t count, const RunControl& control, Findings& findings, const Visit& visit) {
    constexpr std::size_t chunk = 4096;
    const std::size_t chunks = (count + chunk - 1) / chunk;
    std::vector<Findings> parts(chunks);
    core::parallel_for(chunks, 1, control, [&](std::size_t first, std::size_t last) {
        for (std::size_t c = first; c < last; ++c) {
            if (control.cancelled()) return;
            const std::size_t end = std::min(count, (c + 1) * chunk);
            for (std::size_t i = c * chunk; i < end; ++i) visit(i, parts[c]);
        }
    });
    for (Findings& part : parts) findings.append(std::move(part));
}

}  // namespace certa::verify
