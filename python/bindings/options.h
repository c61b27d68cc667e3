#pragma once
// Keyword arguments from the table of options that the command has: setting them, and describing them for signatures,
// docstrings and stubs. A value goes through the table as text, so bounds and messages are the command's.
#include <pybind11/pybind11.h>

#include <numbers>
#include <string>

#include "arrays.h"
#include "frontend/option_table.h"

namespace certa::python {

/// A value as the command line would say it. Errors: TypeError for what is neither number nor text.
std::string option_text(std::string_view name, py::handle value);
/// True, False and numpy's. Errors: TypeError for anything else.
bool option_flag(std::string_view name, py::handle value);

/// Angles have their unit in their name: radians here, degrees on the command line.
template <class Options>
bool is_angle(const frontend::Option<Options>& option) {
    return option.name.ends_with("_radians") && frontend::value_name_of(option) == "DEG";
}
template <class Options>
void set_flag(const frontend::Option<Options>& option, Options& options, bool value) {
    std::visit(
        [&](const auto& member) {
            if constexpr (std::is_same_v<std::decay_t<decltype(member)>, bool Options::*>) options.*member = value;
        },
        option.member);
}

constexpr double degree = std::numbers::pi / 180.0;

/// Sets the options that `given` names. None leaves an option as it is by default.
///
/// Errors: OptionError, with the name that the option has in Python in front.
template <class Options>
void set_options(std::span<const frontend::Option<Options>> table, Options& options, const py::dict& given) {
    for (const auto& option : table) {
        const py::str name(std::string(option.name));
        if (!given.contains(name)) continue;
        const py::object value = given[name];
        if (value.is_none()) continue;
        if (frontend::is_flag(option)) {
            set_flag(option, options, option_flag(option.name, value));
            continue;
        }
        std::string text = option_text(option.name, value);
        if (is_angle(option)) text = frontend::text_of(frontend::parse_number(option.name, text) / degree);
        try {
            frontend::set_option(option, options, text);
        } catch (const frontend::OptionError& error) {
            // The message begins with the command's name of it.
            const std::string flag = "--" + std::string(option.flag);
            std::string message = error.what();
            if (message.starts_with(flag)) message.replace(0, flag.size(), option.name);
            throw frontend::OptionError(message);
        }
    }
}

/// One dictionary per option: name, flag, kind (the command's name of its value; empty for flags), default as text
/// (empty: automatic), help.
template <class Options>
py::list describe_options(std::span<const frontend::Option<Options>> table) {
    py::list rows;
    for (const auto& option : table) {
        py::dict row;
        std::string kind = frontend::value_name_of(option), standard = frontend::value_of(option, Options{});
        if (is_angle(option)) {
            kind = "RADIANS";
            standard = frontend::text_of(frontend::parse_number(option.name, standard) * degree);
        }
        row["name"] = std::string(option.name);
        row["flag"] = std::string(option.flag);
        row["kind"] = kind;
        row["default"] = standard;
        row["help"] = std::string(option.help);
        const frontend::Bounds& bounds = option.bounds;
        const bool bounded = bounds.low > -std::numeric_limits<double>::infinity() ||
                             bounds.high < std::numeric_limits<double>::infinity();
        row["bounds"] = bounded ? frontend::text_of(bounds) : std::string();
        rows.append(row);
    }
    return rows;
}

}  // namespace certa::python
