#pragma once
// How results look in the JSON report and in the summary. Keys are the C++ names; ids of elements are 1-based, as in
// files.
#include <certa/conforming.h>
#include <certa/info.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "frontend/option_table.h"
#include "frontend/result_fields.h"

namespace certa::cli {

using Json = nlohmann::ordered_json;

Json to_json(const Point3& point);

/// The plain members of a result under their names.
template <class Record>
Json record_of(const Record& record) {
    Json result = Json::object();
    frontend::visit_fields(record, [&](const char* name, const auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Point3>)
            result[name] = to_json(value);
        else
            result[name] = value;
    });
    return result;
}

Json to_json(const std::vector<ElementRef>& elements);
Json to_json(const Defect& defect);
Json to_json(const std::vector<Defect>& defects);
Json to_json(const std::vector<Violation>& violations);
Json to_json(const ConformStatistics& statistics);
Json to_json(const ConformingCheck& check);
Json to_json(const DocumentInfo& info);

/// "repair" for "repairs".
const char* label_of(const char* key);
/// "0.31 s"
std::string text_of_seconds(double seconds);
/// Digits in groups of three: "12,946".
std::string text_of_count(std::size_t count);
/// "1 facet", "12 facets"
std::string counted(std::size_t count, const std::string& noun);
std::string counted(std::size_t count, const std::string& singular, const std::string& plural);
std::string joined(const std::vector<std::string>& parts);

/// What an option with a spelling of its own says: a number where the text is one (angles, which are spelled in
/// degrees, in the radians that their names promise), nothing where it is empty, else the text.
Json spelled_value(const std::string& name, const std::string& text);

/// Options as resolved: lengths in the input's unit beside what was given.
template <class Options>
Json to_json(std::span<const frontend::Option<Options>> table, const Options& options, double diagonal) {
    Json result = Json::object();
    for (const auto& option : table) {
        const std::string name(option.name);
        std::visit(
            [&](const auto& member) {
                using Kind = std::decay_t<decltype(member)>;
                if constexpr (std::is_same_v<Kind, Length Options::*>) {
                    result[name] = (options.*member).resolve(diagonal);
                } else if constexpr (std::is_same_v<Kind, std::optional<std::uint64_t> Options::*>) {
                    result[name] = options.*member ? Json(*(options.*member)) : Json(nullptr);
                } else if constexpr (std::is_same_v<Kind, frontend::Choice<Options>>) {
                    result[name] = frontend::value_of(option, options);
                } else if constexpr (std::is_same_v<Kind, frontend::Spelled<Options>>) {
                    result[name] = spelled_value(name, member.get(options));
                } else {
                    result[name] = options.*member;
                }
            },
            option.member);
    }
    return result;
}

}  // namespace certa::cli
