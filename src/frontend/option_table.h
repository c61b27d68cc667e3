#pragma once
// The options of every verb, once: name, unit, default, bounds, help. The command's help, its parsing and its report
// are made from these tables; so will be the signatures of the Python module.
#include <certa/conforming.h>
#include <certa/curvature.h>
#include <certa/implicit.h>
#include <certa/io.h>
#include <certa/remeshing.h>
#include <certa/surface_check.h>
#include <certa/view.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

namespace certa::frontend {

/// A text that is no value of the option: wrong form, out of range, unknown choice. Its message names the option.
class OptionError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// An interval of allowed numbers.
struct Bounds {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_open = false;
    bool high_open = false;
    bool contains(double value) const {
        return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
    }
};

/// One of several names, stored in Options as an enumeration.
template <class Options>
struct Choice {
    std::span<const std::string_view> names;
    std::size_t (*get)(const Options&);
    void (*set)(Options&, std::size_t);
};

/// Set and printed by functions of its own, for what no plain member says. An empty text stands for "not set"; it
/// throws OptionError for a text that is no value, with the option's flag in front.
template <class Options>
struct Spelled {
    std::string_view value_name;
    std::string (*get)(const Options&);
    void (*set)(Options&, std::string_view flag, std::string_view text);
};

/// The kinds of members that options of a verb have.
template <class Options>
struct MemberOf {
    using type = std::variant<bool Options::*, double Options::*, Length Options::*,
                              std::optional<std::uint64_t> Options::*, Choice<Options>>;
};
template <class Options>
using Member = typename MemberOf<Options>::type;

template <class Options>
struct Option {
    std::string_view name;  ///< in C++, JSON and Python
    std::string_view flag;  ///< on the command line, without the dashes
    Member<Options> member;
    Bounds bounds;
    std::string_view help;  ///< a phrase; unit, default and bounds are added by `help_of`
};

/// How the command writes results.
struct OutputOptions {
    Encoding encoding = Encoding::automatic;
    bool msh_version_2 = false;
    Reference reference = Reference::id;
};

template <>
struct MemberOf<CurvatureOptions> {
    using type = std::variant<bool CurvatureOptions::*, Choice<CurvatureOptions>, Spelled<CurvatureOptions>>;
};
template <>
struct MemberOf<RemeshOptions> {
    using type =
        std::variant<bool RemeshOptions::*, double RemeshOptions::*, Choice<RemeshOptions>, Spelled<RemeshOptions>>;
};
template <>
struct MemberOf<SurfaceCheckOptions> {
    using type = std::variant<Spelled<SurfaceCheckOptions>>;
};
template <>
struct MemberOf<OutputOptions> {
    using type = std::variant<Choice<OutputOptions>>;
};

std::span<const Option<ConformOptions>> conform_options();
std::span<const Option<ConformingCheckOptions>> conforming_check_options();
std::span<const Option<CurvatureOptions>> curvature_options();
std::span<const Option<OutputOptions>> output_options();  ///< the last one, reference, is for labelled meshes only
std::span<const Option<ViewOptions>> view_options();
std::span<const Option<ImplicitOptions>> implicit_options();
std::span<const Option<RemeshOptions>> remesh_options();
std::span<const Option<SurfaceCheckOptions>> surface_check_options();

/// "rings", "ball" or "geodesic"
std::string neighborhood_name(const CurvatureOptions& options);

/// Reads the faces that a file lists: 0-based.
using FaceReader = std::function<std::vector<std::uint32_t>(const std::string& path)>;
/// A region as `certa curvature --region` takes it: ball:x,y,z:R, box:x,y,z:x,y,z, halfspace:x,y,z:nx,ny,nz (outward
/// normal), faces:FILE, joined by & | ! and parentheses. Errors: OptionError with the place.
Region parse_region(std::string_view text, const FaceReader& read_faces);

/// "12.5" or "2%" (of the bounding box's diagonal). `name` stands for the option in the message.
Length parse_length(std::string_view name, std::string_view text);
double parse_number(std::string_view name, std::string_view text);
std::uint64_t parse_count(std::string_view name, std::string_view text);

/// The shortest text that reads back as the same number; independent of any locale.
std::string text_of(double value);
std::string text_of(const Length& length);
std::string text_of(const Bounds& bounds);

template <class Options>
bool is_flag(const Option<Options>& option) {
    return std::visit(
        [](const auto& member) { return std::is_same_v<std::decay_t<decltype(member)>, bool Options::*>; },
        option.member);
}

/// Sets one option from text. Flags take no text: an empty text sets them.
///
/// Errors: OptionError.
template <class Options>
void set_option(const Option<Options>& option, Options& options, std::string_view text);

/// The value as text; empty for "automatic".
template <class Options>
std::string value_of(const Option<Options>& option, const Options& options);

/// What the command's help prints in place of the value: "NUMBER", "LENGTH", "needed|sharp|all"; empty for flags.
template <class Options>
std::string value_name_of(const Option<Options>& option);

/// The help phrase with unit, bounds and default.
template <class Options>
std::string help_of(const Option<Options>& option);

}  // namespace certa::frontend
