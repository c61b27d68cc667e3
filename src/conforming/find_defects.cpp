// The validator as a public function.
#include "conforming/validate.h"

namespace certa {

ComplexDefects find_defects(const PiecewiseLinearComplex& complex, const ConformOptions& options,
                            const RunControl& control) {
    conforming::ValidationReport report = conforming::validate(complex, options, control);
    return {std::move(report.defects), report.defect_count, std::move(report.notes)};
}

}  // namespace certa
