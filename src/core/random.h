#pragma once
// Deterministic random numbers: the same on every platform, unlike the distributions of the standard library.
#include <cstdint>

namespace certa::core {

/// SplitMix64 (Steele, Lea, Flood 2014): one 64-bit state, full period, good enough for test data and shuffles.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15ull;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }
    /// A multiple of 2^-53 in [0, 1).
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// In [0, bound), bound > 0.
    std::uint64_t below(std::uint64_t bound) {
        const std::uint64_t reject = -bound % bound;  // leaves a multiple of bound
        for (;;) {
            const std::uint64_t r = next();
            if (r >= reject) return r % bound;
        }
    }
    bool coin(double probability = 0.5) { return uniform() < probability; }

private:
    std::uint64_t state_;
};

}  // namespace certa::core
