// The options of `remesh`. What may be left to choose is spelled: an empty text stands for "not given".
#include <array>
#include <numbers>

#include "frontend/option_table.h"

namespace certa::frontend {
namespace {

constexpr double degrees = std::numbers::pi / 180.0;
constexpr std::array<std::string_view, 2> smoothing_names{"screened", "gaussian"};
constexpr std::array<std::string_view, 3> sample_names{"needed", "none", "all"};
constexpr std::array<std::string_view, 3> output_names{"polygons", "quad-dominant", "triangles"};

[[noreturn]] void out_of_range(std::string_view name, std::string_view text, std::string_view allowed) {
    throw OptionError(
        std::string(name).append(": ").append(text).append(" is out of range; allowed is ").append(allowed));
}

Length length_of(std::string_view name, std::string_view text, bool positive) {
    const Length length = parse_length(name, text);
    if (positive ? !(length.value > 0.0) : !(length.value >= 0.0))
        out_of_range(name, text, positive ? "above 0" : "0 or above");
    return length;
}

std::uint64_t count_of(std::string_view name, std::string_view text, std::uint64_t low, std::uint64_t high) {
    const std::uint64_t value = parse_count(name, text);
    if (value < low || value > high)
        out_of_range(name, text, "[" + std::to_string(low) + ", " + std::to_string(high) + "]");
    return value;
}

std::string text_of_count(const std::optional<std::uint64_t>& count) { return count ? std::to_string(*count) : ""; }
std::string text_of_length(const std::optional<Length>& length) { return length ? text_of(*length) : ""; }

constexpr std::uint64_t most = 0xffffffffULL;

constexpr std::array remesh_table{
    Option<RemeshOptions>{
        "error",
        "error",
        Spelled<RemeshOptions>{"LENGTH", [](const RemeshOptions& o) { return text_of_length(o.error); },
                               [](RemeshOptions& o, std::string_view name, std::string_view text) {
                                   o.error = length_of(name, text, true);
                               }},
        {},
        "largest distance between result and input (number or % of the diagonal)"},
    Option<RemeshOptions>{"vertices",
                          "vertices",
                          Spelled<RemeshOptions>{"N", [](const RemeshOptions& o) { return text_of_count(o.vertices); },
                                                 [](RemeshOptions& o, std::string_view name, std::string_view text) {
                                                     o.vertices = count_of(name, text, 4, most);
                                                 }},
                          {},
                          "number of vertices instead, within 5 % where corners and creases leave room"},
    Option<RemeshOptions>{"faces",
                          "faces",
                          Spelled<RemeshOptions>{"N", [](const RemeshOptions& o) { return text_of_count(o.faces); },
                                                 [](RemeshOptions& o, std::string_view name, std::string_view text) {
                                                     o.faces = count_of(name, text, 4, most);
                                                 }},
                          {},
                          "number of faces instead"},
    Option<RemeshOptions>{"isotropy",
                          "isotropy",
                          &RemeshOptions::isotropy,
                          {0.0, 1.0, false, false},
                          "0: spacing follows both curvatures; 1: their mean, squares instead of rectangles"},
    Option<RemeshOptions>{
        "feature_angle_radians",
        "feature-angle",
        Spelled<RemeshOptions>{"DEG", [](const RemeshOptions& o) { return text_of(o.feature_angle_radians / degrees); },
                               [](RemeshOptions& o, std::string_view name, std::string_view text) {
                                   const double value = parse_number(name, text);
                                   if (!(value > 0.0 && value <= 180.0))
                                       out_of_range(name, text, "above 0, at most 180");
                                   o.feature_angle_radians = value * degrees;
                               }},
        {},
        "an edge whose faces turn by more is a crease"},
    Option<RemeshOptions>{
        "smooth",
        "smooth",
        Spelled<RemeshOptions>{"LENGTH", [](const RemeshOptions& o) { return text_of_length(o.smooth); },
                               [](RemeshOptions& o, std::string_view name, std::string_view text) {
                                   o.smooth = length_of(name, text, false);
                               }},
        {},
        "length over which directions are smoothed (default: from the mesh and the spacing of lines)"},
    Option<RemeshOptions>{
        "smoothing_method",
        "smoothing-method",
        Choice<RemeshOptions>{
            smoothing_names, [](const RemeshOptions& o) { return static_cast<std::size_t>(o.smoothing_method); },
            [](RemeshOptions& o, std::size_t i) { o.smoothing_method = static_cast<SmoothingMethod>(i); }},
        {},
        "how: screened solves for unit directions, gaussian averages tensors as the thesis does"},
    Option<RemeshOptions>{"transfer",
                          "transfer",
                          &RemeshOptions::transfer,
                          {0.0, 2.0, false, false},
                          "density of lines goes like this power of curvature"},
    Option<RemeshOptions>{"hyperbolic_spacing",
                          "hyperbolic-spacing",
                          &RemeshOptions::hyperbolic_spacing,
                          {},
                          "lines farther apart by the root of 2 where the surface is a saddle"},
    Option<RemeshOptions>{
        "isotropic_samples",
        "isotropic-samples",
        Choice<RemeshOptions>{
            sample_names, [](const RemeshOptions& o) { return static_cast<std::size_t>(o.isotropic_samples); },
            [](RemeshOptions& o, std::size_t i) { o.isotropic_samples = static_cast<IsotropicSamples>(i); }},
        {},
        "points that polygons are triangulated around: at umbilics that need one, none, or all over spherical parts"},
    Option<RemeshOptions>{
        "output",
        "output",
        Choice<RemeshOptions>{output_names, [](const RemeshOptions& o) { return static_cast<std::size_t>(o.output); },
                              [](RemeshOptions& o, std::size_t i) { o.output = static_cast<RemeshOutput>(i); }},
        {},
        "polygons as lines cut them, quads and triangles, or triangles"},
    Option<RemeshOptions>{
        "max_degree",
        "max-degree",
        Spelled<RemeshOptions>{
            "D", [](const RemeshOptions& o) { return o.max_degree == 0 ? "" : std::to_string(o.max_degree); },
            [](RemeshOptions& o, std::string_view name, std::string_view text) {
                o.max_degree = count_of(name, text, 3, 1000);
            }},
        {},
        "of polygons: at most so many corners"},
    Option<RemeshOptions>{
        "subdivide",
        "subdivide",
        Spelled<RemeshOptions>{"N", [](const RemeshOptions& o) { return std::to_string(o.subdivide); },
                               [](RemeshOptions& o, std::string_view name, std::string_view text) {
                                   o.subdivide = count_of(name, text, 0, 8);
                               }},
        {},
        "rounds of quad/triangle subdivision of the result"},
};

}  // namespace

std::span<const Option<RemeshOptions>> remesh_options() { return remesh_table; }

}  // namespace certa::frontend
