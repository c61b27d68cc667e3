#pragma once
// Hash map from unordered pairs of indices to an index: open addressing, insertion and lookup only.
#include <certa/types.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace certa::core {

class PairMap {
public:
    explicit PairMap(std::size_t expected = 0) { rehash(expected); }

    /// The value of pair {a, b}, or no_index.
    std::uint32_t find(std::uint32_t a, std::uint32_t b) const {
        const std::uint64_t key = key_of(a, b);
        for (std::size_t i = slot_of(key);; i = (i + 1) & mask_) {
            if (keys_[i] == key) return values_[i];
            if (keys_[i] == empty) return no_index;
        }
    }

    void set(std::uint32_t a, std::uint32_t b, std::uint32_t value) {
        if (2 * (size_ + 1) > keys_.size()) rehash(2 * size_ + 2);
        place(key_of(a, b), value);
    }

private:
    static constexpr std::uint64_t empty = ~std::uint64_t{0};
    static std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
        return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
    }
    std::size_t slot_of(std::uint64_t key) const {
        key ^= key >> 32;
        key *= 0x9e3779b97f4a7c15ULL;
        key ^= key >> 29;
        return static_cast<std::size_t>(key) & mask_;
    }
    void place(std::uint64_t key, std::uint32_t value) {
        std::size_t i = slot_of(key);
        while (keys_[i] != empty && keys_[i] != key) i = (i + 1) & mask_;
        if (keys_[i] == empty) ++size_;
        keys_[i] = key;
        values_[i] = value;
    }
    void rehash(std::size_t expected) {
        std::size_t capacity = 16;
        while (capacity < 2 * expected) capacity *= 2;
        std::vector<std::uint64_t> keys(capacity, empty);
        std::vector<std::uint32_t> values(capacity);
        keys.swap(keys_);
        values.swap(values_);
        mask_ = capacity - 1;
        size_ = 0;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (keys[i] != empty) place(keys[i], values[i]);
        }
    }

    std::vector<std::uint64_t> keys_;
    std::vector<std::uint32_t> values_;
    std::size_t mask_ = 0, size_ = 0;
};

}  // namespace certa::core
