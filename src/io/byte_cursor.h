#pragma once
// Reading binary numbers of either byte order from memory, with a check before every step.
#include <certa/error.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace certa::io {

/// The same number with its bytes in reverse order.
template <class T>
T byte_swapped(T value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    return std::bit_cast<T>(bytes);
}

/// Walks over bytes that live longer than the cursor.
class ByteCursor {
public:
    ByteCursor(std::string_view bytes, const std::string& name, std::endian order)
        : bytes_(bytes), name_(name), swap_(order != std::endian::native) {}

    template <class T>
    T read(const char* what) {
        need(sizeof(T), what);
        T value;
        std::memcpy(&value, bytes_.data() + position_, sizeof(T));
        position_ += sizeof(T);
        return swap_ ? byte_swapped(value) : value;
    }

    /// Checks that `count` things of `bytes_each` bytes follow, without overflow.
    void need_all(std::uint64_t count, std::uint64_t bytes_each, const char* what) const {
        if (bytes_each > 0 && count > left() / bytes_each)
            fail(std::to_string(count) + " " + what + " do not fit into the " + std::to_string(left()) +
                 " bytes that follow: the file is truncated or the count is wrong");
    }

    void skip(std::uint64_t bytes, const char* what) {
        need(bytes, what);
        position_ += static_cast<std::size_t>(bytes);
    }
    std::size_t left() const { return bytes_.size() - position_; }
    std::size_t position() const { return position_; }
    void move_to(std::size_t position) { position_ = position; }
    std::string_view bytes() const { return bytes_; }
    const std::string& name() const { return name_; }
    [[noreturn]] void fail(const std::string& reason) const { throw IoError(name_, 0, reason); }

private:
    void need(std::uint64_t bytes, const char* what) const {
        if (bytes > left()) fail(std::string("the file ends where ") + what + " was expected");
    }

    std::string_view bytes_;
    std::string name_;
    std::size_t position_ = 0;
    bool swap_;
};

}  // namespace certa::io
