// The tables of options and what is derived from them: parsing, printing, help.
// Defaults are read off a default-constructed aggregate, so that they stand in one place only: the public header.
// Numbers go through from_chars and to_chars: exact, and deaf to the locale.
#include "frontend/option_table.h"

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <system_error>

namespace certa::frontend {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Bounds any_length{0.0, infinity, false, true};

constexpr std::array<std::string_view, 3> protection_names{"needed", "sharp", "all"};

constexpr std::array conform_table{
    Option<ConformOptions>{
        "protection",
        "protect",
        Choice<ConformOptions>{protection_names,
                               [](const ConformOptions& o) { return static_cast<std::size_t>(o.protection); },
                               [](ConformOptions& o, std::size_t i) { o.protection = static_cast<Protection>(i); }},
        {},
        "where protecting balls are placed before anything else: nowhere until needed, at sharp "
        "edges, or along all edges"},
    Option<ConformOptions>{"gabriel",
                           "gabriel",
                           &ConformOptions::gabriel,
                           {},
                           "also empty the diametral ball of every constraint triangle"},
    Option<ConformOptions>{"alpha",
                           "alpha",
                           &ConformOptions::alpha,
                           {0.0, 0.5, true, true},
                           "radius of a protecting ball over the local feature size"},
    Option<ConformOptions>{"merge_coplanar",
                           "merge-coplanar",
                           &ConformOptions::merge_coplanar,
                           {},
                           "make one facet of exactly coplanar neighbours with equal markers"},
    Option<ConformOptions>{"triangulate",
                           "triangulate",
                           &ConformOptions::triangulate,
                           {},
                           "cut non-planar facets into triangles instead of refusing them"},
    Option<ConformOptions>{
        "repair", "repair", &ConformOptions::repair, {}, "fix what has one obvious meaning, and say what was done"},
    Option<ConformOptions>{
        "keep_outside", "keep-outside", &ConformOptions::keep_outside, {}, "emit region 0 too, up to the convex hull"},
    Option<ConformOptions>{"planarity", "planarity", &ConformOptions::planarity, any_length,
                           "largest distance of a facet's point from the facet's plane"},
    Option<ConformOptions>{"min_feature", "min-feature", &ConformOptions::min_feature, any_length,
                           "stop, naming the elements, where something shorter would be made"},
    Option<ConformOptions>{"max_points",
                           "max-points",
                           &ConformOptions::max_points,
                           {1.0, infinity, false, true},
                           "stop above this number of vertices"},
};

constexpr std::array check_table{
    Option<ConformingCheckOptions>{"gabriel",
                                   "gabriel",
                                   &ConformingCheckOptions::gabriel,
                                   {},
                                   "also check that the diametral ball of every constraint triangle is empty"},
    Option<ConformingCheckOptions>{"merge_coplanar",
                                   "merge-coplanar",
                                   &ConformingCheckOptions::merge_coplanar,
                                   {},
                                   "the mesh was made with --merge-coplanar"},
    Option<ConformingCheckOptions>{"planarity", "planarity", &ConformingCheckOptions::planarity, any_length,
                                   "largest distance of a facet's point from the facet's plane"},
    Option<ConformingCheckOptions>{"deviation", "deviation", &ConformingCheckOptions::deviation, any_length,
                                   "largest distance of a vertex from the segment or facet that carries it"},
};

constexpr std::array<std::string_view, 3> encoding_names{"automatic", "ascii", "binary"};
constexpr std::array<std::string_view, 2> msh_version_names{"4.1", "2.2"};
constexpr std::array<std::string_view, 2> reference_names{"id", "marker"};

constexpr std::array output_table{
    Option<OutputOptions>{
        "encoding",
        "encoding",
        Choice<OutputOptions>{encoding_names,
                              [](const OutputOptions& o) { return static_cast<std::size_t>(o.encoding); },
                              [](OutputOptions& o, std::size_t i) { o.encoding = static_cast<Encoding>(i); }},
        {},
        "how numbers are stored, in formats that leave a choice"},
    Option<OutputOptions>{
        "msh_version",
        "msh-version",
        Choice<OutputOptions>{msh_version_names, [](const OutputOptions& o) { return std::size_t{o.msh_version_2}; },
                              [](OutputOptions& o, std::size_t i) { o.msh_version_2 = i == 1; }},
        {},
        "version of .msh that is written"},
    Option<OutputOptions>{
        "reference",
        "reference",
        Choice<OutputOptions>{reference_names,
                              [](const OutputOptions& o) { return static_cast<std::size_t>(o.reference); },
                              [](OutputOptions& o, std::size_t i) { o.reference = static_cast<Reference>(i); }},
        {},
        "what formats with one number per element carry: 1-based facet and segment, or the input's markers"},
};

constexpr std::array<std::string_view, 2> up_names{"y", "z"};

constexpr std::array implicit_table{
    Option<ImplicitOptions>{"max_cells",
                            "max-cells",
                            &ImplicitOptions::max_cells,
                            {64.0, infinity, false, true},
                            "stop above this number of cells of the octree"},
    Option<ImplicitOptions>{"max_depth",
                            "max-depth",
                            &ImplicitOptions::max_depth,
                            {1.0, infinity, false, true},
                            "stop where cells would be smaller than the box halved so often"},
    Option<ImplicitOptions>{"time_seconds",
                            "time",
                            &ImplicitOptions::time_seconds,
                            {1.0, infinity, false, true},
                            "begin no further round after this many seconds"},
    Option<ImplicitOptions>{"uncertified",
                            "uncertified",
                            &ImplicitOptions::uncertified,
                            {},
                            "write a guess where nothing can be certified; the file says so, and the exit code is 4"},
    Option<ImplicitOptions>{"clip",
                            "clip",
                            &ImplicitOptions::clip,
                            {},
                            "the surface may meet the box: mesh what is inside; components, genera and boundary loops "
                            "are certified, not isotopy"},
};

constexpr std::array view_table{
    Option<ViewOptions>{
        "up",
        "up",
        Choice<ViewOptions>{up_names, [](const ViewOptions& o) { return static_cast<std::size_t>(o.up); },
                            [](ViewOptions& o, std::size_t i) { o.up = static_cast<UpAxis>(i); }},
        {},
        "axis that points upwards in the first view"},
};

std::string quoted(std::string_view text) { return std::string("'").append(text).append("'"); }

[[noreturn]] void refuse(std::string_view name, std::string_view text, std::string_view expected) {
    throw OptionError(std::string(name).append(": ").append(quoted(text)).append(" is not ").append(expected));
}

void require_in_bounds(std::string_view name, std::string_view text, const Bounds& bounds, double value) {
    if (bounds.contains(value)) return;
    throw OptionError(
        std::string(name).append(": ").append(text).append(" is out of range; allowed is ").append(text_of(bounds)));
}

bool is_bounded(const Bounds& bounds) { return bounds.low > -infinity || bounds.high < infinity; }

std::string flag_of(std::string_view flag) { return std::string("--").append(flag); }

}  // namespace

std::span<const Option<ConformOptions>> conform_options() { return conform_table; }
std::span<const Option<ConformingCheckOptions>> conforming_check_options() { return check_table; }
std::span<const Option<OutputOptions>> output_options() { return output_table; }
std::span<const Option<ViewOptions>> view_options() { return view_table; }
std::span<const Option<ImplicitOptions>> implicit_options() { return implicit_table; }

double parse_number(std::string_view name, std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        refuse(name, text, "a number");
    return value;
}

Length parse_length(std::string_view name, std::string_view text) {
    const bool relative = text.ends_with('%');
    const std::string_view digits = relative ? text.substr(0, text.size() - 1) : text;
    // A percentage is divided before it is rounded: 1e-7% is 1e-9 to the last bit.
    double value = 0.0;
    long double wide = 0.0L;
    const char* const last = digits.data() + digits.size();
    const auto [end, error] =
        relative ? std::from_chars(digits.data(), last, wide) : std::from_chars(digits.data(), last, value);
    if (relative) value = static_cast<double>(wide / 100.0L);
    if (error != std::errc() || end != last || !std::isfinite(value))
        refuse(name, text, "a length: a number in the input's unit, or a percentage of the diagonal such as 2%");
    return {value, relative};
}

std::uint64_t parse_count(std::string_view name, std::string_view text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) refuse(name, text, "a whole number");
    return value;
}

std::string text_of(double value) {
    std::array<char, 32> buffer;
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), end};
}

std::string text_of(const Length& length) {
    if (!length.relative_to_diagonal) return text_of(length.value);
    // 100 times the value need not be a double: the fewest digits that come back as the same fraction.
    std::array<char, 32> buffer;
    for (int digits = 1; digits <= 17; ++digits) {
        const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), length.value * 100.0,
                                                std::chars_format::general, digits);
        const std::string text = std::string(buffer.data(), end) + "%";
        if (parse_length("", text).value == length.value) return text;
    }
    return text_of(length.value * 100.0) + "%";
}

std::string text_of(const Bounds& bounds) {
    if (bounds.high == infinity)
        return std::string(bounds.low_open ? "above " : "at least ").append(text_of(bounds.low));
    std::string text = bounds.low_open ? "(" : "[";
    text.append(text_of(bounds.low)).append(", ").append(text_of(bounds.high));
    return text.append(bounds.high_open ? ")" : "]");
}

template <class Options>
void set_option(const Option<Options>& option, Options& options, std::string_view text) {
    const std::string name = flag_of(option.flag);
    std::visit(
        [&](const auto& member) {
            using Kind = std::decay_t<decltype(member)>;
            if constexpr (std::same_as<Kind, bool Options::*>) {
                if (!text.empty()) refuse(name, text, "expected: this option takes no value");
                options.*member = true;
            } else if constexpr (std::same_as<Kind, double Options::*>) {
                const double value = parse_number(name, text);
                require_in_bounds(name, text, option.bounds, value);
                options.*member = value;
            } else if constexpr (std::same_as<Kind, Length Options::*>) {
                const Length value = parse_length(name, text);
                require_in_bounds(name, text, option.bounds, value.value);
                options.*member = value;
            } else if constexpr (std::same_as<Kind, std::optional<std::uint64_t> Options::*>) {
                const std::uint64_t value = parse_count(name, text);
                require_in_bounds(name, text, option.bounds, static_cast<double>(value));
                options.*member = value;
            } else if constexpr (std::same_as<Kind, Spelled<Options>>) {
                member.set(options, name, text);
            } else {
                for (std::size_t i = 0; i < member.names.size(); ++i)
                    if (member.names[i] == text) return member.set(options, i);
                refuse(name, text, "one of " + value_name_of(option));
            }
        },
        option.member);
}

template <class Options>
std::string value_of(const Option<Options>& option, const Options& options) {
    return std::visit(
        [&](const auto& member) -> std::string {
            using Kind = std::decay_t<decltype(member)>;
            if constexpr (std::same_as<Kind, bool Options::*>) {
                return options.*member ? "on" : "off";
            } else if constexpr (std::same_as<Kind, std::optional<std::uint64_t> Options::*>) {
                return options.*member ? std::to_string(*(options.*member)) : std::string();
            } else if constexpr (std::same_as<Kind, Choice<Options>>) {
                return std::string(member.names[member.get(options)]);
            } else if constexpr (std::same_as<Kind, Spelled<Options>>) {
                return member.get(options);
            } else {
                return text_of(options.*member);
            }
        },
        option.member);
}

template <class Options>
std::string value_name_of(const Option<Options>& option) {
    return std::visit(
        [&](const auto& member) -> std::string {
            using Kind = std::decay_t<decltype(member)>;
            if constexpr (std::same_as<Kind, bool Options::*>)
                return {};
            else if constexpr (std::same_as<Kind, double Options::*>)
                return "NUMBER";
            else if constexpr (std::same_as<Kind, Length Options::*>)
                return "LENGTH";
            else if constexpr (std::same_as<Kind, std::optional<std::uint64_t> Options::*>)
                return "COUNT";
            else if constexpr (std::same_as<Kind, Spelled<Options>>)
                return std::string(member.value_name);
            else {
                std::string text;
                for (const std::string_view name : member.names) text.append(text.empty() ? "" : "|").append(name);
                return text;
            }
        },
        option.member);
}

template <class Options>
std::string help_of(const Option<Options>& option) {
    std::string text(option.help);
    if (is_flag(option)) return text;
    const bool spelled =
        std::visit([](const auto& member) { return std::same_as<std::decay_t<decltype(member)>, Spelled<Options>>; },
                   option.member);
    if (spelled) {
        const std::string value = value_of(option, Options{});
        return value.empty() ? text : text.append(" (default ").append(value).append(")");
    }
    const bool is_length = value_name_of(option) == "LENGTH";
    text.append(" (");
    if (is_length)
        text.append("number or % of the diagonal; ");
    else if (is_bounded(option.bounds))
        text.append(text_of(option.bounds)).append("; ");
    const std::string value = value_of(option, Options{});
    if (value.empty()) return text.append("no limit)");
    return text.append("default ").append(value).append(")");
}

template void set_option(const Option<ConformOptions>&, ConformOptions&, std::string_view);
template std::string value_of(const Option<ConformOptions>&, const ConformOptions&);
template std::string value_name_of(const Option<ConformOptions>&);
template std::string help_of(const Option<ConformOptions>&);
template void set_option(const Option<ConformingCheckOptions>&, ConformingCheckOptions&, std::string_view);
template std::string value_of(const Option<ConformingCheckOptions>&, const ConformingCheckOptions&);
template std::string value_name_of(const Option<ConformingCheckOptions>&);
template std::string help_of(const Option<ConformingCheckOptions>&);
template void set_option(const Option<CurvatureOptions>&, CurvatureOptions&, std::string_view);
template std::string value_of(const Option<CurvatureOptions>&, const CurvatureOptions&);
template std::string value_name_of(const Option<CurvatureOptions>&);
template std::string help_of(const Option<CurvatureOptions>&);
template void set_option(const Option<RemeshOptions>&, RemeshOptions&, std::string_view);
template std::string value_of(const Option<RemeshOptions>&, const RemeshOptions&);
template std::string value_name_of(const Option<RemeshOptions>&);
template std::string help_of(const Option<RemeshOptions>&);
template void set_option(const Option<SurfaceCheckOptions>&, SurfaceCheckOptions&, std::string_view);
template std::string value_of(const Option<SurfaceCheckOptions>&, const SurfaceCheckOptions&);
template std::string value_name_of(const Option<SurfaceCheckOptions>&);
template std::string help_of(const Option<SurfaceCheckOptions>&);
template void set_option(const Option<OutputOptions>&, OutputOptions&, std::string_view);
template std::string value_of(const Option<OutputOptions>&, const OutputOptions&);
template std::string value_name_of(const Option<OutputOptions>&);
template std::string help_of(const Option<OutputOptions>&);
template void set_option(const Option<ImplicitOptions>&, ImplicitOptions&, std::string_view);
template std::string value_of(const Option<ImplicitOptions>&, const ImplicitOptions&);
template std::string value_name_of(const Option<ImplicitOptions>&);
template std::string help_of(const Option<ImplicitOptions>&);
template void set_option(const Option<ViewOptions>&, ViewOptions&, std::string_view);
template std::string value_of(const Option<ViewOptions>&, const ViewOptions&);
template std::string value_name_of(const Option<ViewOptions>&);
template std::string help_of(const Option<ViewOptions>&);

}  // namespace certa::frontend
