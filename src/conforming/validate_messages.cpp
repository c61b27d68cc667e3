// Words for defects. Numbers are written by to_chars: shortest digits that read back, whatever the locale.
#include "conforming/validate_messages.h"

#include <charconv>

namespace certa::conforming {

std::string name_element(ElementKind kind, std::uint32_t index) {
    return std::string(name_of(kind)) + ' ' + std::to_string(std::uint64_t{index} + 1);
}

std::string name_number(double number) {
    char buffer[40];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, number);
    return {buffer, end};
}

std::string name_place(const Point3& place) {
    return '(' + name_number(place.x) + ", " + name_number(place.y) + ", " + name_number(place.z) + ')';
}

}  // namespace certa::conforming
