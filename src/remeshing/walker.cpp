// Steps over the side that the nearest point of a triangle lies on.
#include "remeshing/walker.h"

#include <algorithm>

namespace certa::remeshing {

Walker::Walker(std::span<const Point3> positions, std::span<const Triangle> triangles)
    : positions_(positions), triangles_(triangles) {
    struct Side {
        std::uint64_t key = 0;
        Index triangle = 0, corner = 0;
    };
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    beside_.assign(triangles.size(), {no_index, no_index, no_index});
    for (Index t = 0; t < triangles.size(); ++t)
        for (Index i = 0; i < 3; ++i) {
            const std::uint64_t a = index_of(triangles[t][(i + 1) % 3]), b = index_of(triangles[t][(i + 2) % 3]);
            sides.push_back({std::min(a, b) << 32 | std::max(a, b), t, i});
        }
    std::sort(sides.begin(), sides.end(),
              [](const Side& l, const Side& r) { return l.key != r.key ? l.key < r.key : l.triangle < r.triangle; });
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        if (sides[i].key != sides[i + 1].key) continue;
        beside_[sides[i].triangle][sides[i].corner] = sides[i + 1].triangle;
        beside_[sides[i + 1].triangle][sides[i + 1].corner] = sides[i].triangle;
    }
}

std::optional<core::NearestPoint> Walker::find(const Point3& p, Index start) const {
    constexpr int most_steps = 8;
    const auto look = [&](Index t) {
        const Triangle& c = triangles_[t];
        core::NearestPoint nearest = core::find_nearest_on_triangle(
            p, positions_[index_of(c[0])], positions_[index_of(c[1])], positions_[index_of(c[2])]);
        nearest.triangle = t;
        return nearest;
    };
    core::NearestPoint best = look(start);
    for (int step = 0; step < most_steps; ++step) {
        std::size_t zeros = 0, zero = 0;
        for (std::size_t i = 0; i < 3; ++i)
            if (best.weights[i] == 0.0) ++zeros, zero = i;
        if (zeros == 0) return best;
        const Index other = zeros == 1 ? beside_[best.triangle][zero] : no_index;
        if (other == no_index) return std::nullopt;
        const core::NearestPoint next = look(other);
        if (!(next.squared_distance < best.squared_distance)) return best;
        best = next;
    }
    return std::nullopt;
}

}  // namespace certa::remeshing
