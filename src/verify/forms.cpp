// Conversion of coordinate differences to integers, for the exact stages of the predicates.
// A finite double is m 2^e with integers m, e; all coordinates of one question are put over the smallest e that occurs.
// Every form is homogeneous, so the common factor does not change its sign. Nothing depends on the coordinates' range:
// the widest (from the smallest denormal to the largest double) gives integers of 2,100 bits.
#include "verify/forms.h"

#include <bit>

namespace certa::verify {
namespace {

/// value = mantissa 2^exponent with an odd mantissa; zero has mantissa 0.
struct Decomposed {
    std::int64_t mantissa = 0;
    int exponent = 0;
};

Decomposed decompose(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const int field = static_cast<int>((bits >> 52) & 0x7ff);
    auto mantissa = static_cast<std::int64_t>(bits & 0xfffffffffffffULL);
    if (field != 0) mantissa |= std::int64_t{1} << 52;
    if (mantissa == 0) return {};
    const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
    mantissa >>= zeros;
    return {(bits >> 63) != 0 ? -mantissa : mantissa, (field == 0 ? 1 : field) - 1075 + zeros};
}

/// to - from, when that is a double; the residue of the two-sum (Knuth) is exact unless something overflows.
bool subtract_exactly(double from, double to, double& difference) {
    difference = to - from;
    const double back = to - difference;
    return (to - (difference + back)) + (back - from) == 0.0;
}

void assign(mpz_class& result, const Decomposed& d, int lowest) {
    result = static_cast<long>(d.mantissa);
    if (d.mantissa != 0) result <<= static_cast<unsigned long>(d.exponent - lowest);
}

static_assert(sizeof(long) == 8);

}  // namespace

bool to_small_integers(const Arrow* arrows, std::size_t count, int bits, Vec<Int128>* result) {
    constexpr std::size_t most = 3 * 8;
    Decomposed parts[most];
    if (3 * count > most) return false;
    int lowest = 4096, highest = -4096;
    for (std::size_t i = 0; i < count; ++i) {
        double d[3];
        if (!subtract_exactly(arrows[i].from->x, arrows[i].to->x, d[0]) ||
            !subtract_exactly(arrows[i].from->y, arrows[i].to->y, d[1]) ||
            !subtract_exactly(arrows[i].from->z, arrows[i].to->z, d[2])) {
            return false;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            Decomposed& part = parts[3 * i + k] = decompose(d[k]);
            if (part.mantissa == 0) continue;
            const auto size = static_cast<std::uint64_t>(std::abs(part.mantissa));
            lowest = std::min(lowest, part.exponent);
            highest = std::max(highest, part.exponent + static_cast<int>(std::bit_width(size)));
        }
    }
    if (highest - lowest > bits) return false;
    const auto integer = [&](const Decomposed& d) {
        return d.mantissa == 0 ? Int128{0} : Int128{d.mantissa} * (Int128{1} << (d.exponent - lowest));
    };
    for (std::size_t i = 0; i < count; ++i) {
        result[i] = {integer(parts[3 * i]), integer(parts[3 * i + 1]), integer(parts[3 * i + 2])};
    }
    return true;
}

namespace {

/// Coordinates of a few points, decomposed, and the range of their bits.
struct Range {
    int lowest = 4096, highest = -4096;

    Decomposed add(double c) {
        const Decomposed d = decompose(c);
        if (d.mantissa == 0) return d;
        lowest = std::min(lowest, d.exponent);
        const auto size = static_cast<std::uint64_t>(std::abs(d.mantissa));
        highest = std::max(highest, d.exponent + static_cast<int>(std::bit_width(size)));
        return d;
    }
};

Limbs limbs_of(const Decomposed& d, int lowest) {
    if (d.mantissa == 0) return {};
    return {static_cast<std::uint64_t>(std::abs(d.mantissa)), d.exponent - lowest, d.mantissa < 0};
}

}  // namespace

bool to_limbs(const Arrow* arrows, std::size_t count, int bits, Vec<Limbs>* result, int& exponent) {
    constexpr std::size_t most = 8;
    Vec<Decomposed> from[most], to[most];
    if (count > most) return false;
    Range range;
    for (std::size_t i = 0; i < count; ++i) {
        const Point3 &a = *arrows[i].from, &b = *arrows[i].to;
        from[i] = {range.add(a.x), range.add(a.y), range.add(a.z)};
        to[i] = {range.add(b.x), range.add(b.y), range.add(b.z)};
    }
    // A difference needs one bit more.
    if (range.highest - range.lowest + 1 > bits) return false;
    const int low = range.lowest;
    for (std::size_t i = 0; i < count; ++i) {
        result[i] = {limbs_of(to[i].x, low) - limbs_of(from[i].x, low),
                     limbs_of(to[i].y, low) - limbs_of(from[i].y, low),
                     limbs_of(to[i].z, low) - limbs_of(from[i].z, low)};
    }
    exponent = low == 4096 ? 0 : low;
    return true;
}

bool to_limbs_over(const Arrow& arrow, int exponent, int bits, Vec<Limbs>& result) {
    Range range;
    const Point3 &a = *arrow.from, &b = *arrow.to;
    const Vec<Decomposed> from{range.add(a.x), range.add(a.y), range.add(a.z)};
    const Vec<Decomposed> to{range.add(b.x), range.add(b.y), range.add(b.z)};
    if (range.lowest < exponent || range.highest - exponent + 1 > bits) return false;
    result = {limbs_of(to.x, exponent) - limbs_of(from.x, exponent),
              limbs_of(to.y, exponent) - limbs_of(from.y, exponent),
              limbs_of(to.z, exponent) - limbs_of(from.z, exponent)};
    return true;
}

int to_integers(const Arrow* arrows, std::size_t count, Vec<mpz_class>* result) {
    int lowest = 4096;
    const auto visit = [&](const Point3& p) {
        for (const double c : {p.x, p.y, p.z}) {
            const Decomposed d = decompose(c);
            if (d.mantissa != 0) lowest = std::min(lowest, d.exponent);
        }
    };
    for (std::size_t i = 0; i < count; ++i) {
        visit(*arrows[i].from);
        visit(*arrows[i].to);
    }
    mpz_class from, to;
    const auto difference = [&](double a, double b, mpz_class& out) {
        assign(from, decompose(a), lowest);
        assign(to, decompose(b), lowest);
        out = to - from;
    };
    for (std::size_t i = 0; i < count; ++i) {
        difference(arrows[i].from->x, arrows[i].to->x, result[i].x);
        difference(arrows[i].from->y, arrows[i].to->y, result[i].y);
        difference(arrows[i].from->z, arrows[i].to->z, result[i].z);
    }
    return lowest == 4096 ? 0 : lowest;
}

}  // namespace certa::verify
