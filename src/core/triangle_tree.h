#pragma once
// A box hierarchy over the triangles of a mesh: the point of the mesh that is nearest to a given one, and the triangles
// in a box. Coordinates should be of the order of 1 (scale by a power of two first), or squares overflow.
#include <certa/mesh.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace certa::core {

/// `point` is weights[0] a + weights[1] b + weights[2] c with weights that are not negative and sum to 1, up to
/// rounding: whatever the shape of the triangle, it is a point of it, so its distance is an upper bound.
struct NearestPoint {
    Point3 point;
    std::array<double, 3> weights{1.0, 0.0, 0.0};
    double squared_distance = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = no_index;
};

NearestPoint find_nearest_on_triangle(const Point3& p, const Point3& a, const Point3& b, const Point3& c);

/// Needs finite positions and valid indices; keeps copies of what it needs. Queries may run at the same time.
class TriangleTree {
public:
    TriangleTree(std::span<const Point3> positions, std::span<const Triangle> triangles);

    bool empty() const { return triangles_.empty(); }
    /// The nearest point; `hint`, a triangle that may be near, only saves time. The result's triangle is no_index when
    /// nothing is within `limit` (or there are no triangles).
    NearestPoint find_nearest(const Point3& p, std::uint32_t hint = no_index,
                              double limit = std::numeric_limits<double>::infinity()) const;
    /// Calls visit(triangle) for every triangle whose box meets [low, high] (and maybe a few more).
    template <class Visit>
    void visit_box(const Point3& low, const Point3& high, const Visit& visit) const {
        if (triangles_.empty()) return;
        const std::array<float, 3> from = reduced(low), to = reduced(high);
        std::array<std::uint32_t, most_waiting> stack;
        std::size_t top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& node = nodes_[stack[--top]];
            for (std::size_t lane = 4; lane-- > 0;) {
                bool meets = node.child[lane] != no_index;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    meets = meets && node.low[axis][lane] <= to[axis] && node.high[axis][lane] >= from[axis];
                if (!meets) continue;
                if ((node.child[lane] & leaf) != 0)
                    visit(triangles_[node.child[lane] & ~leaf].id);
                else
                    stack[top++] = node.child[lane];
            }
        }
    }

private:
    struct Entry {
        Point3 a, b, c;
        std::uint32_t id = 0;
    };
    /// Four boxes side by side, in single precision and a little too large.
    struct alignas(16) Node {
        std::array<std::array<float, 4>, 3> low, high;
        std::array<std::uint32_t, 4> child;  ///< a node; an entry, with `leaf`; no_index: none
    };
    struct Box {
        Point3 low, high;
    };
    struct Place;
    static constexpr std::uint32_t leaf = 1U << 31;
    static constexpr std::size_t most_waiting = 128;

    Box build(std::span<Place> places, std::uint32_t begin, std::uint32_t node);
    Box box_of(std::span<const Place> places, std::uint32_t entry) const;
    /// In the unit of the boxes: the mesh lies in [-1, 1]. Points far outside are pulled in, towards all boxes.
    std::array<float, 3> reduced(const Point3& p) const {
        const auto reduce = [&](double x, double middle) {
            return static_cast<float>(std::clamp((x - middle) * scale_, -4.0, 4.0));
        };
        return {reduce(p.x, middle_.x), reduce(p.y, middle_.y), reduce(p.z, middle_.z)};
    }

    std::vector<Entry> triangles_;
    std::vector<std::uint32_t> place_of_;  // triangle -> entry
    std::vector<Node> nodes_;
    Point3 middle_;
    double scale_ = 1.0;
};

}  // namespace certa::core
