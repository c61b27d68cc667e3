// Shortest digits, whatever the locale.
#include "remeshing/text.h"

#include <array>
#include <charconv>

namespace certa::remeshing {

std::string text_of(double value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}
std::string text_of(const Point3& p) { return "(" + text_of(p.x) + ", " + text_of(p.y) + ", " + text_of(p.z) + ")"; }

}  // namespace certa::remeshing
