#pragma once
// What the generators share.
#include <certa/mesh.h>

#include <cmath>

#include "core/random.h"

namespace certa::generators {

inline VertexId add_point(PiecewiseLinearComplex& complex, const Point3& p) {
    complex.positions.push_back(p);
    return VertexId{static_cast<std::uint32_t>(complex.positions.size() - 1)};
}

/// Uniform on the unit sphere, by rejection.
inline Point3 random_direction(core::Random& random) {
    for (;;) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
        const double square = x * x + y * y + z * z;
        if (square > 1.0 || square < 1e-3) continue;
        const double s = 1.0 / std::sqrt(square);
        return {s * x, s * y, s * z};
    }
}

}  // namespace certa::generators
