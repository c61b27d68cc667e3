#pragma once
// The arrays of a page: base64 of little-endian numbers, each array in the smallest type that holds its numbers
// exactly.
#include <cstdint>
#include <span>
#include <string>

namespace certa::page {

class PageArrays {
public:
    /// Each stores an array and returns its reference for the manifest: {"id":3,"type":"u16","count":12}.
    std::string add(std::span<const double> values);         ///< f32 if that loses nothing, else f64
    std::string add(std::span<const float> values);          ///< f32
    std::string add(std::span<const std::int64_t> values);   ///< u8, u16, u32, i32 or i64
    std::string add(std::span<const std::uint32_t> values);  ///< u8, u16 or u32

    /// The script elements that carry the arrays.
    const std::string& elements() const { return elements_; }

private:
    template <class To, class From>
    std::string store(const char* type, std::span<const From> values);

    std::uint64_t next_id_ = 0;
    std::string elements_;
};

}  // namespace certa::page
