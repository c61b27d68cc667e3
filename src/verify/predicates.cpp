// The named predicates over the forms of forms.h, regions for searches over many points, and Newell's normal.
// Plan: single predicates; QuadricRegion (coefficients once, then a few operations per point or box); NewellNormal
// (a sum over a ring, so its rounding count depends on the ring's length).
#include "verify/predicates.h"

namespace certa::verify {

int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
    return decide<DeterminantForm>({Arrow{&a, &b}, Arrow{&a, &c}, Arrow{&a, &d}});
}
int in_circumball(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& p) {
    return decide<CircumballForm>({Arrow{&a, &b}, Arrow{&a, &c}, Arrow{&a, &d}, Arrow{&a, &p}});
}
int in_diametral_ball(const Point3& a, const Point3& b, const Point3& c, const Point3& p) {
    return decide<DiametralBallForm>({Arrow{&a, &b}, Arrow{&a, &c}, Arrow{&a, &p}});
}
int dot_sign(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
    return decide<DotForm>({Arrow{&a, &b}, Arrow{&c, &d}});
}
int determinant_sign(const Arrow& first, const Arrow& second, const Arrow& third) {
    return decide<DeterminantForm>({first, second, third});
}
int middle_side(const Point3& o, const Point3& p, const Point3& q, const Point3& a, const Point3& b, const Point3& c) {
    return decide<DeterminantSumForm>({Arrow{&o, &p}, Arrow{&o, &q}, Arrow{&o, &a}, Arrow{&o, &b}, Arrow{&o, &c}});
}
int orientation_xy(const Point3& a, const Point3& b, const Point3& p) {
    const Point3 zero{0.0, 0.0, 0.0}, up{0.0, 0.0, 1.0};
    const Point3 a0{a.x, a.y, 0.0}, b0{b.x, b.y, 0.0}, p0{p.x, p.y, 0.0};
    return decide<DeterminantForm>({Arrow{&a0, &b0}, Arrow{&a0, &p0}, Arrow{&zero, &up}});
}

namespace {

/// k of inside_value(coefficients of the given census, p).
constexpr int inside_roundings(const BallCoefficients<Census>& ball) {
    constexpr Census leaf{1, 1.0};
    return inside_value(ball, Vec<Census>{leaf, leaf, leaf}).roundings;
}
constexpr Vec<Census> leaves{{1, 1.0}, {1, 1.0}, {1, 1.0}};
constexpr int circumball_roundings = inside_roundings(circumball_of(leaves, leaves, leaves));
constexpr int diametral_ball_roundings = inside_roundings(diametral_ball_of(leaves, leaves));
constexpr int beyond_roundings = inside_roundings({{0, 0.0}, cross_of(leaves, leaves)});
/// Coefficients that were computed exactly and rounded: to extended precision and from there to double.
constexpr Census rounded{2, 1.0};
constexpr int refined_roundings = inside_roundings({rounded, {rounded, rounded, rounded}});

/// The least of a w^2 - b w for w in [low, high], and the largest |w|. Rounding is of second order at the minimum of
/// the parabola and otherwise covered by the caller's bound.
double least_on_interval(double a, double b, double low, double high) {
    const auto at = [&](double w) { return (a * w - b) * w; };
    double least = std::min(at(low), at(high));
    if (a > 0.0) least = std::min(least, at(std::clamp(b / (2.0 * a), low, high)));
    return least;
}

}  // namespace

QuadricRegion::QuadricRegion(Kind kind, const Point3& a, const Point3& b, const Point3& c, const Point3* d)
    : kind_(kind), corners_{a, b, c, d != nullptr ? *d : a} {
    const Vec<Bounded> u = bounded_difference(a, b), v = bounded_difference(a, c);
    filtered_ = is_filtered(u) && is_filtered(v);
    BallCoefficients<Bounded> ball{};
    if (kind == Kind::circumball) {
        const Vec<Bounded> w = bounded_difference(a, *d);
        filtered_ = filtered_ && is_filtered(w);
        ball = circumball_of(u, v, w);
        roundings_ = circumball_roundings;
    } else if (kind == Kind::diametral_ball) {
        ball = diametral_ball_of(u, v);
        roundings_ = diametral_ball_roundings;
    } else {
        ball.b = cross_of(u, v);
        roundings_ = beyond_roundings;
    }
    a_ = ball.a;
    b_ = ball.b;
    // 2^20 leaves 30 good bits.
    constexpr double poor = 0x1p20;
    const double size = std::max({b_.x.size, b_.y.size, b_.z.size});
    const double value = std::max({std::abs(b_.x.value), std::abs(b_.y.value), std::abs(b_.z.value)});
    if (filtered_ && (a_.size > poor * std::abs(a_.value) || size > poor * value)) refine();
}

QuadricRegion QuadricRegion::circumball(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
    return {Kind::circumball, a, b, c, &d};
}
QuadricRegion QuadricRegion::diametral_ball(const Point3& a, const Point3& b, const Point3& c) {
    return {Kind::diametral_ball, a, b, c, nullptr};
}
QuadricRegion QuadricRegion::beyond(const Point3& a, const Point3& b, const Point3& c) {
    return {Kind::beyond, a, b, c, nullptr};
}

bool QuadricRegion::compute_exactly() const {
    if (state_ != Exact::unknown) return state_ == Exact::known;
    const Arrow arrows[3] = {{&corners_[0], &corners_[1]}, {&corners_[0], &corners_[2]}, {&corners_[0], &corners_[3]}};
    Vec<Limbs> v[3];
    // The largest of the forms that the coefficients end up in.
    constexpr int bits = coordinate_bits<DiametralBallForm>(Limbs::bits);
    static_assert(bits <= coordinate_bits<CircumballForm>(Limbs::bits));
    if (!to_limbs(arrows, 3, bits, v, exponent_)) {
        state_ = Exact::too_large;
        return false;
    }
    switch (kind_) {
        case Kind::circumball:
            exact_ = circumball_of(v[0], v[1], v[2]);
            break;
        case Kind::diametral_ball:
            exact_ = diametral_ball_of(v[0], v[1]);
            break;
        case Kind::beyond:
            exact_ = {Limbs(), cross_of(v[0], v[1])};
            break;
    }
    state_ = Exact::known;
    return true;
}

void QuadricRegion::refine() {
    if (!compute_exactly()) return;
    const int degree = kind_ == Kind::circumball ? 3 : kind_ == Kind::diametral_ball ? 4 : 1;  // of a; b has one more
    int exponents[4];
    long double values[4] = {exact_.a.leading(exponents[0]), exact_.b.x.leading(exponents[1]),
                             exact_.b.y.leading(exponents[2]), exact_.b.z.leading(exponents[3])};
    // A common power of two brings the largest near 1: the sign of the form stays what it is.
    int largest = -1000000;
    for (int i = 0; i < 4; ++i) {
        exponents[i] += (i == 0 ? degree : degree + 1) * exponent_;
        if (values[i] != 0.0L) largest = std::max(largest, exponents[i] + std::ilogb(values[i]));
    }
    const auto coefficient = [&](int i) {
        const auto value = static_cast<double>(std::ldexp(values[i], std::max(exponents[i] - largest, -4000)));
        return Bounded{value, std::abs(value)};
    };
    a_ = coefficient(0);
    b_ = {coefficient(1), coefficient(2), coefficient(3)};
    roundings_ = refined_roundings;
}

int QuadricRegion::decide(const Point3& p) const {
    const Arrow u{&corners_[0], &corners_[1]}, v{&corners_[0], &corners_[2]}, w{&corners_[0], &p};
    if (kind_ == Kind::beyond) return decide_exactly<DeterminantForm>({u, v, w});
    // With the coefficients at hand, when the point fits on their grid.
    if (compute_exactly()) {
        Vec<Limbs> q;
        if (to_limbs_over(w, exponent_, coordinate_bits<DiametralBallForm>(Limbs::bits), q)) {
            return inside_value(exact_, q).sign();
        }
    }
    if (kind_ == Kind::circumball) return decide_exactly<CircumballForm>({u, v, Arrow{&corners_[0], &corners_[3]}, w});
    return decide_exactly<DiametralBallForm>({u, v, w});
}

int QuadricRegion::side(const Point3& p) const {
    const Vec<Bounded> w = bounded_difference(corners_[0], p);
    if (filtered_ && is_filtered(w)) {
        const int sign = filtered_sign(inside_value(BallCoefficients<Bounded>{a_, b_}, w), roundings_);
        if (sign != 2) return sign;
    }
    return decide(p);
}

bool QuadricRegion::misses_box(const Point3& low, const Point3& high, bool closed) const {
    if (!filtered_) return false;
    const Point3& o = corners_[0];
    const double lx = low.x - o.x, ly = low.y - o.y, lz = low.z - o.z;
    const double hx = high.x - o.x, hy = high.y - o.y, hz = high.z - o.z;
    const double wx = std::max(std::abs(lx), std::abs(hx)), wy = std::max(std::abs(ly), std::abs(hy)),
                 wz = std::max(std::abs(lz), std::abs(hz));
    if (!(std::max({wx, wy, wz}) <= largest_filtered)) return false;
    const double least = least_on_interval(a_.value, b_.x.value, lx, hx) +
                         least_on_interval(a_.value, b_.y.value, ly, hy) +
                         least_on_interval(a_.value, b_.z.value, lz, hz);
    // The same count of roundings as for a point, doubled: once for the computed least value, once for the place of
    // the least (its error enters squared, but the box's corners are rounded too).
    const double size = a_.size * (wx * wx + wy * wy + wz * wz) + b_.x.size * wx + b_.y.size * wy + b_.z.size * wz;
    const double bound = 2.0 * (roundings_ + 8) * unit_roundoff * size + underflow_slack;
    return closed ? least > bound : least >= bound;
}

namespace {

int newell_roundings(std::size_t corners) {
    constexpr int cross = cross_of(leaves, leaves).x.roundings;
    return cross + static_cast<int>(corners);
}

std::vector<Arrow> fan_arrows(const std::vector<Point3>& ring) {
    std::vector<Arrow> arrows;
    arrows.reserve(ring.size());
    for (std::size_t i = 1; i < ring.size(); ++i) arrows.push_back({&ring[0], &ring[i]});
    return arrows;
}

/// Twice the vector area of a closed polygon, over 2^(2 exponent).
Vec<mpz_class> exact_area(const std::vector<Point3>& ring, int& exponent) {
    const std::vector<Arrow> arrows = fan_arrows(ring);
    std::vector<Vec<mpz_class>> v(arrows.size());
    exponent = to_integers(arrows.data(), arrows.size(), v.data());
    Vec<mpz_class> sum;
    for (std::size_t i = 0; i + 1 < v.size(); ++i) {
        const Vec<mpz_class> part = cross_of(v[i], v[i + 1]);
        sum.x += part.x;
        sum.y += part.y;
        sum.z += part.z;
    }
    return sum;
}

/// The leading 64 bits of value / 2^shift.
long double leading_bits(const mpz_class& value, long shift) {
    mpz_class rest = abs(value);
    if (shift > 0) {
        rest >>= static_cast<unsigned long>(shift);
    } else {
        rest <<= static_cast<unsigned long>(-shift);
    }
    const auto bits = static_cast<long double>(mpz_get_ui(rest.get_mpz_t()));
    return sgn(value) < 0 ? -bits : bits;
}

}  // namespace

NewellNormal::NewellNormal(std::vector<Point3> ring) : ring_(std::move(ring)) {
    if (ring_.size() < 3) {
        filtered_ = false;
        return;
    }
    for (std::size_t i = 1; i + 1 < ring_.size(); ++i) {
        const Vec<Bounded> u = bounded_difference(ring_[0], ring_[i]), v = bounded_difference(ring_[0], ring_[i + 1]);
        filtered_ = filtered_ && is_filtered(u) && is_filtered(v);
        bounded_ = bounded_ + cross_of(u, v);
    }
    filtered_ = filtered_ && ring_.size() < (std::size_t{1} << 19);
    constexpr int cross = cross_of(leaves, leaves).x.roundings;
    if (filtered_) roundings_ = newell_roundings(ring_.size()) + cross + 3;
}

const Vec<mpz_class>& NewellNormal::exact() const {
    if (!exact_) {
        int exponent = 0;
        exact_ = std::make_unique<Vec<mpz_class>>(ring_.size() < 3 ? Vec<mpz_class>{} : exact_area(ring_, exponent));
    }
    return *exact_;
}

Vec<long double> NewellNormal::direction() const {
    const Vec<mpz_class>& n = exact();
    const auto bits = [](const mpz_class& c) {
        return c == 0 ? 0 : static_cast<long>(mpz_sizeinbase(c.get_mpz_t(), 2));
    };
    const long shift = std::max({bits(n.x), bits(n.y), bits(n.z)}) - 64;
    if (shift == -64) return {};
    const Vec<long double> v{leading_bits(n.x, shift), leading_bits(n.y, shift), leading_bits(n.z, shift)};
    return (1.0L / std::sqrt(dot_of(v, v))) * v;
}

int NewellNormal::side(const Arrow& first, const Arrow& second) const {
    if (filtered_) {
        const Vec<Bounded> a = bounded_difference(*first.from, *first.to);
        const Vec<Bounded> b = bounded_difference(*second.from, *second.to);
        if (is_filtered(a) && is_filtered(b)) {
            const int sign = filtered_sign(dot_of(bounded_, cross_of(a, b)), roundings_);
            if (sign != 2) return sign;
        }
    }
    const Arrow arrows[2] = {first, second};
    Vec<mpz_class> w[2];
    to_integers(arrows, 2, w);
    return sgn(dot_of(exact(), cross_of(w[0], w[1])));
}

mpz_class NewellNormal::area_along(const std::vector<Point3>& polygon, int& exponent) const {
    if (polygon.size() < 3) return 0;
    return dot_of(exact(), exact_area(polygon, exponent));
}

int NewellNormal::turn(const std::vector<Point3>& polygon) const {
    int exponent = 0;
    return sgn(area_along(polygon, exponent));
}

int NewellNormal::compare_areas(const std::vector<Point3>& first, const std::vector<Point3>& second) const {
    int e1 = 0, e2 = 0;
    mpz_class a1 = area_along(first, e1), a2 = area_along(second, e2);
    if (e1 > e2) a1 <<= static_cast<unsigned long>(2 * (e1 - e2));
    if (e2 > e1) a2 <<= static_cast<unsigned long>(2 * (e2 - e1));
    return cmp(a1, a2) > 0 ? 1 : cmp(a1, a2) < 0 ? -1 : 0;
}

}  // namespace certa::verify
