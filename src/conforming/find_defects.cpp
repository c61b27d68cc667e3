// The validator as a public function. Its loops do not know the caller's thread count: a limit around them does.
#include <tbb/global_control.h>

#include <optional>

#include "conforming/validate.h"

namespace certa {

ComplexDefects find_defects(const PiecewiseLinearComplex& complex, const ConformOptions& options,
                            const RunControl& control) {
    std::optional<tbb::global_control> threads;
    if (control.threads > 0) threads.emplace(tbb::global_control::max_allowed_parallelism, control.threads);
    conforming::ValidationReport report = conforming::validate(complex, options, control);
    return {std::move(report.defects), report.defect_count, std::move(report.notes)};
}

}  // namespace certa
