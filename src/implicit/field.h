#pragma once
// Sound enclosures of f and its gradient over boxes.
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

/// One thread's evaluator of one function.
class Field {
public:
    /// Errors: InternalError where the calling thread's floating-point environment proves nothing.
    explicit Field(const expression::Tape& tape) : workspace_(tape), doubles_(tape) {
        interval::require_sound_environment();
    }

    /// Natural enclosures first, then mean values with the gradient, then with the Hessian where neither sign nor slope
    /// was found. A sign without a slope is looked at with the Hessian too: a leaf without a slope is critical and
    /// hinders the growth of W.
    /// Slopes are looked for along the given axes only, a bit each.
    Certainty certify(const Region& box, unsigned axes = 7);
    /// The sign of f if proved; else `slope` says whether any two gradients in the box are proved to have a positive
    /// product (the small normal variation of Plantinga and Vegter).
    Certainty certify_variation(const Region& box);
    /// The proved sign of f on the convex hull of points within the box; 0: not proved.
    int sign_on(const Region& box);
    /// The value of f in doubles.
    double value(const Point3& place);
    /// Value and gradient in doubles.
    const expression::Jet<double>& slope(const Point3& place) {
        return doubles_.evaluate<1>({place.x, place.y, place.z});
    }
    /// Value, gradient and Hessian in doubles.
    const expression::Jet<double>& jet(const Point3& place);

private:
    expression::Workspace<Interval> workspace_;
    expression::Workspace<double> doubles_;
};

}  // namespace certa::implicit
