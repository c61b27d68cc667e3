#pragma once
// As much JSON as the manifest of a page needs: objects and arrays whose members are texts already.
#include <certa/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace certa::page {

/// A string literal that may stand in HTML too: `<` is escaped, and so is what is not UTF-8.
std::string json_string(std::string_view text);
/// The shortest form that reads back as the same double; `value` is finite.
std::string json_number(double value);
std::string json_number(std::uint64_t value);
std::string json_point(const Point3& point);
std::string json_list(std::span<const std::string> items);

/// An object under construction; members appear in the order of the calls.
class JsonObject {
public:
    JsonObject& set(std::string_view name, std::string_view json);
    std::string text() const { return "{" + members_ + "}"; }

private:
    std::string members_;
};

}  // namespace certa::page
