#pragma once
// Sound enclosures of f and its gradient over boxes.
#include <array>
#include <cstdint>

#include "implicit/grid.h"
#include "interval/environment.h"

namespace certa::implicit {

/// What is proved about f on a closed box.
struct Certainty {
    std::int8_t sign = 0;   ///< of f on the whole box; 0: not proved
    std::int8_t axis = -1;  ///< a partial derivative that is proved not to vanish, -1: none
    std::int8_t slope = 0;  ///< its sign
    bool defined = false;   ///< f is proved to be defined and continuous on the box
};

/// One thread's evaluator of one function. Not to outlive the tape, which it tells how many enclosures it computed.
class Field {
public:
    /// Errors: InternalError where the calling thread's floating-point environment proves nothing.
    explicit Field(const expression::Tape& tape) : tape_(tape), workspace_(tape), doubles_(tape) {
        interval::require_sound_environment();
    }
    Field(const Field&) = delete;
    Field& operator=(const Field&) = delete;
    ~Field() { tape_.count_enclosures(count_); }

    /// Natural enclosures first, then mean values with the gradient, then with the Hessian where neither sign nor slope
    /// was found. A sign without a slope is looked at with the Hessian too: a leaf without a slope is critical and
    /// hinders the growth of W.
    /// Slopes are looked for along the given axes only, a bit each.
    Certainty certify(const Region& box, unsigned axes = 7);
    /// The sign of f if proved; else `slope` says whether `slopes`, which encloses the gradient, has small variation.
    Certainty certify_variation(const Region& box, std::array<Interval, 3>& slopes);
    /// Any two vectors of a box have a positive product (Plantinga and Vegter): two copies of each interval, as they
    /// are independent.
    static bool varies_little(const std::array<Interval, 3>& slopes) {
        return interval::sign_of(slopes[0] * slopes[0] + slopes[1] * slopes[1] + slopes[2] * slopes[2]) > 0;
    }
    /// The proved sign of f on the convex hull of points within the box; 0: not proved.
    int sign_on(const Region& box);
    /// The value of f in doubles.
    double value(const Point3& place);
    /// Value and gradient in doubles.
    const expression::Jet<double>& slope(const Point3& place) {
        return doubles_.evaluate<1>({place.x, place.y, place.z});
    }
    /// Enclosures that the tape has not been told of yet.
    std::uint64_t uncounted() const { return count_; }
    /// Value, gradient and Hessian in doubles.
    const expression::Jet<double>& jet(const Point3& place);

private:
    template <int Order>
    const expression::Jet<Interval>& enclose(const Region& box) {
        ++count_;
        return workspace_.evaluate<Order>(box);
    }
    const expression::Tape& tape_;
    std::uint64_t count_ = 0;
    expression::Workspace<Interval> workspace_;
    expression::Workspace<double> doubles_;
};

}  // namespace certa::implicit
