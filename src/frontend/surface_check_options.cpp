// The options of `check` for surface meshes.
#include <array>
#include <numbers>

#include "frontend/option_table.h"

namespace certa::frontend {
namespace {

constexpr double degrees = std::numbers::pi / 180.0;

[[noreturn]] void out_of_range(std::string_view name, std::string_view text, std::string_view allowed) {
    throw OptionError(
        std::string(name).append(": ").append(text).append(" is out of range; allowed is ").append(allowed));
}

constexpr std::array surface_check_table{
    Option<SurfaceCheckOptions>{
        "error",
        "error",
        Spelled<SurfaceCheckOptions>{"LENGTH",
                                     [](const SurfaceCheckOptions& o) { return o.error ? text_of(*o.error) : ""; },
                                     [](SurfaceCheckOptions& o, std::string_view name, std::string_view text) {
                                         o.error = parse_length(name, text);
                                         if (!(o.error->value > 0.0)) out_of_range(name, text, "above 0");
                                     }},
        {},
        "surfaces: promised bound on the distance, both ways (number or % of the diagonal)"},
    Option<SurfaceCheckOptions>{
        "feature_angle_radians",
        "feature-angle",
        Spelled<SurfaceCheckOptions>{
            "DEG", [](const SurfaceCheckOptions& o) { return text_of(o.feature_angle_radians / degrees); },
            [](SurfaceCheckOptions& o, std::string_view name, std::string_view text) {
                const double value = parse_number(name, text);
                if (!(value > 0.0 && value <= 180.0)) out_of_range(name, text, "above 0, at most 180");
                o.feature_angle_radians = value * degrees;
            }},
        {},
        "surfaces: an edge of INPUT whose faces turn by more is a crease"},
    Option<SurfaceCheckOptions>{
        "crease_tolerance",
        "crease-tolerance",
        Spelled<SurfaceCheckOptions>{
            "LENGTH",
            [](const SurfaceCheckOptions& o) { return o.crease_tolerance ? text_of(*o.crease_tolerance) : ""; },
            [](SurfaceCheckOptions& o, std::string_view name, std::string_view text) {
                o.crease_tolerance = parse_length(name, text);
                if (!(o.crease_tolerance->value >= 0.0)) out_of_range(name, text, "0 or above");
            }},
        {},
        "surfaces: how far a crease may be from the mesh's edges (default: error, or the distance found)"},
    Option<SurfaceCheckOptions>{
        "samples",
        "samples",
        Spelled<SurfaceCheckOptions>{"N",
                                     [](const SurfaceCheckOptions& o) { return std::to_string(o.distance.samples); },
                                     [](SurfaceCheckOptions& o, std::string_view name, std::string_view text) {
                                         o.distance.samples = parse_count(name, text);
                                         if (o.distance.samples > 1000000000)
                                             out_of_range(name, text, "at most 1000000000");
                                     }},
        {},
        "surfaces: points on each that distances are measured from, beside all vertices"},
};

}  // namespace

std::span<const Option<SurfaceCheckOptions>> surface_check_options() { return surface_check_table; }

}  // namespace certa::frontend
