// Arrays as script elements that no browser runs. Numbers are written as the machine holds them, which the viewer takes
// for little-endian.
#include "page/page_arrays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "io/base64.h"
#include "page/json_text.h"

namespace certa::page {
namespace {

static_assert(std::endian::native == std::endian::little, "the viewer reads little-endian arrays");

bool fits_single(double value) { return std::isnan(value) || static_cast<double>(static_cast<float>(value)) == value; }

template <class To>
bool all_fit(std::int64_t low, std::int64_t high) {
    return low >= std::int64_t{std::numeric_limits<To>::min()} && high <= std::int64_t{std::numeric_limits<To>::max()};
}

}  // namespace

template <class To, class From>
std::string PageArrays::store(const char* type, std::span<const From> values) {
    std::vector<To> converted(values.size());
    std::transform(values.begin(), values.end(), converted.begin(), [](From value) { return static_cast<To>(value); });
    const std::string id = json_number(next_id_++);
    elements_ += "<script type=\"text/plain\" id=\"certa-array-" + id + "\">";
    io::encode_base64({reinterpret_cast<const char*>(converted.data()), converted.size() * sizeof(To)}, elements_);
    elements_ += "</script>\n";
    return JsonObject()
        .set("id", id)
        .set("type", json_string(type))
        .set("count", json_number(std::uint64_t{values.size()}))
        .text();
}

std::string PageArrays::add(std::span<const double> values) {
    if (std::all_of(values.begin(), values.end(), fits_single)) return store<float>("f32", values);
    return store<double>("f64", values);
}

std::string PageArrays::add(std::span<const float> values) { return store<float>("f32", values); }

std::string PageArrays::add(std::span<const std::int64_t> values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (values.empty() || all_fit<std::uint8_t>(*low, *high)) return store<std::uint8_t>("u8", values);
    if (all_fit<std::uint16_t>(*low, *high)) return store<std::uint16_t>("u16", values);
    if (all_fit<std::uint32_t>(*low, *high)) return store<std::uint32_t>("u32", values);
    if (all_fit<std::int32_t>(*low, *high)) return store<std::int32_t>("i32", values);
    return store<std::int64_t>("i64", values);
}

std::string PageArrays::add(std::span<const std::uint32_t> values) {
    const std::uint32_t high = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
    if (high <= std::numeric_limits<std::uint8_t>::max()) return store<std::uint8_t>("u8", values);
    if (high <= std::numeric_limits<std::uint16_t>::max()) return store<std::uint16_t>("u16", values);
    return store<std::uint32_t>("u32", values);
}

}  // namespace certa::page
