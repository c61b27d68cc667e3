// Enclosures over a box b with centre c, d = b - c (docs/implicit-theorem.md, "enclosures"):
//   natural       F(b), G(b)                           evaluation of the tape in intervals
//   first order   f(c) + G(b) d                        mean value theorem on the segment from c, b being convex
//   second order  f(c) + g(c) d + d H(b) d / 2         Taylor with Lagrange's rest; for the gradient g(c) + H(b) d
// Each encloses, so their intersection does. A mean value form needs f to be differentiable on b, twice for the second
// order: where a derivative is undefined, its enclosure is, and the form that uses it is left aside by intersect().
#include "implicit/field.h"

namespace certa::implicit {
namespace {

using expression::hessian_index;
using expression::Jet;

struct Center {
    expression::Place<Interval> point, offset;
};

Center center_of(const Region& box) {
    Center center;
    for (std::size_t a = 0; a < 3; ++a) {
        const double m = interval::middle(box[a]);
        center.point[a] = Interval(m);
        center.offset[a] = box[a] - Interval(m);
    }
    return center;
}

Interval first_order(const Interval& at_center, const std::array<Interval, 3>& slopes, const Center& center) {
    Interval sum = at_center;
    for (std::size_t a = 0; a < 3; ++a) sum = sum + slopes[a] * center.offset[a];
    return sum;
}

/// d H d / 2; squares of the offsets are never negative.
Interval second_order_rest(const std::array<Interval, 6>& hessian, const Center& center) {
    Interval sum(0.0);
    for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) {
            const Interval& h = hessian[static_cast<std::size_t>(hessian_index[i][j])];
            const Interval product =
                i == j ? interval::sqr(center.offset[static_cast<std::size_t>(i)]) * Interval(0.5)
                       : center.offset[static_cast<std::size_t>(i)] * center.offset[static_cast<std::size_t>(j)];
            sum = sum + h * product;
        }
    }
    return sum;
}

/// Narrows the slopes, and returns the value narrowed, by all forms that the Hessian on the box and the jet at its
/// centre give. The Hessian must be a copy: both come from one workspace.
Interval narrow_by_second_order(const std::array<Interval, 6>& hessian, const Jet<Interval>& middle,
                                const Center& center, const Interval& value, std::array<Interval, 3>& slopes) {
    for (int a = 0; a < 3; ++a) {
        const std::array<Interval, 3> row{hessian[static_cast<std::size_t>(hessian_index[a][0])],
                                          hessian[static_cast<std::size_t>(hessian_index[a][1])],
                                          hessian[static_cast<std::size_t>(hessian_index[a][2])]};
        Interval& slope = slopes[static_cast<std::size_t>(a)];
        slope = interval::intersect(slope, first_order(middle.gradient[static_cast<std::size_t>(a)], row, center));
    }
    const Interval second = first_order(middle.value, middle.gradient, center) + second_order_rest(hessian, center);
    return interval::intersect(value, interval::intersect(first_order(middle.value, slopes, center), second));
}

/// Notes the sign of f and the surest slope along the given axes; returns whether nothing is left to find. The theorem
/// is about C1 functions: a slope counts only where every partial derivative is proved to exist.
bool note(const Interval& value, const std::array<Interval, 3>& slopes, unsigned axes, Certainty& found) {
    if (found.sign == 0) found.sign = static_cast<std::int8_t>(interval::sign_of(value));
    const bool is_smooth =
        interval::is_defined(slopes[0]) && interval::is_defined(slopes[1]) && interval::is_defined(slopes[2]);
    if (found.slope == 0 && is_smooth) {
        double best = 0;
        for (int a = 0; a < 3; ++a) {
            if (((axes >> a) & 1u) == 0) continue;
            const Interval& slope = slopes[static_cast<std::size_t>(a)];
            const int sign = interval::sign_of(slope);
            const double margin = sign > 0 ? slope.lo : -slope.hi;
            if (sign != 0 && margin > best) {
                best = margin;
                found.axis = static_cast<std::int8_t>(a);
                found.slope = static_cast<std::int8_t>(sign);
            }
        }
    }
    return found.sign != 0 && (found.slope != 0 || axes == 0);
}

}  // namespace

double Field::value(const Point3& place) { return doubles_.evaluate<0>({place.x, place.y, place.z}).value; }

const Jet<double>& Field::jet(const Point3& place) { return doubles_.evaluate<2>({place.x, place.y, place.z}); }

Certainty Field::certify(const Region& box, unsigned axes) {
    Certainty found;
    const Jet<Interval>& natural = enclose<1>(box);
    const Interval value = natural.value;
    std::array<Interval, 3> slopes = natural.gradient;
    found.defined = interval::is_defined(value);
    if (!found.defined) return found;
    if (note(value, slopes, axes, found)) return found;
    const Center center = center_of(box);
    // A slope alone settles a leaf, but a sign spares the triangulation: all forms are tried for it. They cost little
    // beside that.
    if (found.sign == 0) {
        const Interval at_center = enclose<0>(center.point).value;
        if (note(interval::intersect(value, first_order(at_center, slopes, center)), slopes, axes, found)) return found;
    }
    const std::array<Interval, 6> hessian = enclose<2>(box).hessian;
    const Interval narrowed = narrow_by_second_order(hessian, enclose<1>(center.point), center, value, slopes);
    note(narrowed, slopes, axes, found);
    return found;
}

Certainty Field::certify_variation(const Region& box, std::array<Interval, 3>& slopes) {
    Certainty found;
    const Jet<Interval>& natural = enclose<1>(box);
    Interval value = natural.value;
    slopes = natural.gradient;
    found.defined = interval::is_defined(value);
    if (!found.defined) return found;
    const auto decide = [&] {
        found.sign = static_cast<std::int8_t>(interval::sign_of(value));
        found.slope = found.sign == 0 && varies_little(slopes) ? 1 : 0;
        return found.sign != 0 || found.slope != 0;
    };
    if (decide()) return found;
    const Center center = center_of(box);
    const std::array<Interval, 6> hessian = enclose<2>(box).hessian;
    value = narrow_by_second_order(hessian, enclose<1>(center.point), center, value, slopes);
    decide();
    return found;
}

int Field::sign_on(const Region& box) {
    const Jet<Interval>& natural = enclose<1>(box);
    const Interval value = natural.value;
    if (const int sign = interval::sign_of(value); sign != 0 || !interval::is_defined(value)) return sign;
    const std::array<Interval, 3> slopes = natural.gradient;
    const Center center = center_of(box);
    const Interval at_center = enclose<0>(center.point).value;
    if (const int sign = interval::sign_of(interval::intersect(value, first_order(at_center, slopes, center)));
        sign != 0)
        return sign;
    if (interval::sign_of(at_center) == 0) return 0;  // f(c) alone cannot be told from 0
    const std::array<Interval, 6> hessian = enclose<2>(box).hessian;
    const Jet<Interval>& middle = enclose<1>(center.point);
    return interval::sign_of(first_order(middle.value, middle.gradient, center) + second_order_rest(hessian, center));
}

}  // namespace certa::implicit
