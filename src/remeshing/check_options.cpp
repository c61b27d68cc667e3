// What a reader of the documentation would not do.
#include "remeshing/check_options.h"

#include <certa/io.h>

#include "remeshing/text.h"

namespace certa::remeshing {
namespace {

[[noreturn]] void refuse_option(const std::string& message) {
    throw InputError({{DefectKind::option_out_of_range, {}, {}, message}});
}

}  // namespace

void check_options(const RemeshOptions& options) {
    const int goals = options.error.has_value() + options.vertices.has_value() + options.faces.has_value();
    if (goals > 1) refuse_option("error, vertices and faces exclude each other: give one of them");
    if (options.error && !(options.error->value > 0.0)) refuse_option("error must be above 0");
    if ((options.vertices && *options.vertices < 4) || (options.faces && *options.faces < 4))
        refuse_option("a surface needs four vertices and faces at least");
    if (!(options.isotropy >= 0.0 && options.isotropy <= 1.0)) refuse_option("isotropy must lie in [0, 1]");
    if (!(options.transfer >= 0.0 && options.transfer <= 2.0)) refuse_option("transfer must lie in [0, 2]");
    constexpr double least_angle = 1.7453e-5;  // 0.001 degrees: what is flat bends by less, as coordinates are rounded
    if (!(options.feature_angle_radians >= least_angle && options.feature_angle_radians <= 3.1415926535897936))
        refuse_option("feature_angle must be between 0.001 and 180 degrees");
    if (options.smooth && !(options.smooth->value >= 0.0)) refuse_option("smooth must not be below 0");
    if (!options.guides.empty() && options.smoothing_method != SmoothingMethod::screened)
        refuse_option("guides need the smoothing method screened, which can hold directions fast");
    if (options.max_degree != 0 && options.max_degree < 3) refuse_option("max_degree must be 3 at least, or 0");
    if (options.max_degree != 0 && options.output != RemeshOutput::polygons)
        refuse_option("max_degree is for the output polygons: others have three corners, or four");
}

void check_error(const RemeshOptions& options, double diagonal) {
    constexpr double least = 1e-10;  // coordinates have sixteen digits, bounds cost some of them
    if (!options.error || !(options.error->resolve(diagonal) < least * diagonal)) return;
    refuse_option("an error below 1e-10 of the diagonal cannot be proved: ask for " + text_of(least * diagonal) +
                  " or more");
}

}  // namespace certa::remeshing
