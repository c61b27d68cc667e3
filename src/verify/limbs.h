#pragma once
// Integers of up to 16 limbs on the stack, over GMP's mpn functions: exact arithmetic without allocation. Callers make
// sure beforehand that nothing outgrows `bits`; forms.h computes how large their results can become.
#include <gmp.h>

#include <cstdint>
#include <cstring>

namespace certa::verify {

class Limbs {
public:
    /// Values below 2^bits are safe: products are written with a limb to spare.
    static constexpr int bits = 64 * 14;

    Limbs() = default;
    Limbs(const Limbs& other) { *this = other; }
    Limbs& operator=(const Limbs& other) {
        if (this == &other) return *this;
        size_ = other.size_;
        std::memcpy(limbs_, other.limbs_, count() * sizeof(mp_limb_t));
        return *this;
    }
    /// magnitude 2^shift, negated if asked.
    Limbs(std::uint64_t magnitude, int shift, bool negative) {
        if (magnitude == 0) return;
        const int skipped = shift / 64, rest = shift % 64;
        for (int i = 0; i < skipped; ++i) limbs_[i] = 0;
        limbs_[skipped] = magnitude << rest;
        limbs_[skipped + 1] = rest == 0 ? 0 : magnitude >> (64 - rest);
        set_size(skipped + 2, negative);
    }

    int sign() const { return size_ > 0 ? 1 : size_ < 0 ? -1 : 0; }
    /// value = result 2^exponent up to the last bit of a long double.
    long double leading(int& exponent) const {
        exponent = 0;
        if (size_ == 0) return 0.0L;
        const std::size_t n = count();
        long double result = static_cast<long double>(limbs_[n - 1]);
        exponent = static_cast<int>(n - 1) * 64;
        if (n > 1) {
            // Both limbs, rounded once by the addition; what is below them is less than a unit of the last place.
            result += static_cast<long double>(limbs_[n - 2]) * 0x1p-64L;
        }
        return size_ < 0 ? -result : result;
    }

    friend Limbs operator*(const Limbs& a, const Limbs& b) {
        Limbs r;
        if (a.size_ == 0 || b.size_ == 0) return r;
        const auto m = static_cast<mp_size_t>(a.count()), n = static_cast<mp_size_t>(b.count());
        if (m >= n) {
            mpn_mul(r.limbs_, a.limbs_, m, b.limbs_, n);
        } else {
            mpn_mul(r.limbs_, b.limbs_, n, a.limbs_, m);
        }
        r.set_size(static_cast<int>(m + n), (a.size_ < 0) != (b.size_ < 0));
        return r;
    }
    friend Limbs operator+(const Limbs& a, const Limbs& b) { return sum(a, b, b.size_ < 0); }
    friend Limbs operator-(const Limbs& a, const Limbs& b) { return sum(a, b, b.size_ > 0); }

private:
    std::size_t count() const { return static_cast<std::size_t>(size_ < 0 ? -size_ : size_); }
    void set_size(int n, bool negative) {
        while (n > 0 && limbs_[n - 1] == 0) --n;
        size_ = negative ? -n : n;
    }
    /// a + |b|, or a - |b| if `negative`.
    static Limbs sum(const Limbs& a, const Limbs& b, bool negative) {
        if (b.size_ == 0) return a;
        Limbs r;
        const auto m = static_cast<mp_size_t>(a.count()), n = static_cast<mp_size_t>(b.count());
        if (a.size_ == 0) {
            r = b;
            r.size_ = static_cast<int>(negative ? -n : n);
            return r;
        }
        const bool larger = m != n ? m > n : mpn_cmp(a.limbs_, b.limbs_, n) >= 0;
        const Limbs &high = larger ? a : b, &low = larger ? b : a;
        const auto h = larger ? m : n, l = larger ? n : m;
        if ((a.size_ < 0) == negative) {
            r.limbs_[h] = mpn_add(r.limbs_, high.limbs_, h, low.limbs_, l);
            r.set_size(static_cast<int>(h + 1), negative);
        } else {
            mpn_sub(r.limbs_, high.limbs_, h, low.limbs_, l);
            r.set_size(static_cast<int>(h), larger ? a.size_ < 0 : negative);
        }
        return r;
    }

    int size_ = 0;  // number of limbs, negative for negative values
    mp_limb_t limbs_[16];
};

static_assert(sizeof(mp_limb_t) == 8 && GMP_NUMB_BITS == 64);

}  // namespace certa::verify
