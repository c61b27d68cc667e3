#pragma once
// A box hierarchy over the triangles of a mesh: the point of the mesh that is nearest to a given one, and the triangles
// in a box. Coordinates should be of the order of 1 (scale by a power of two first), or squares overflow.
#include <certa/mesh.h>

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
        if (nodes_.empty()) return;
        std::array<std::uint32_t, 96> stack;
        std::size_t top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const std::uint32_t index = stack[--top];
            const Node& node = nodes_[index];
            if (node.low.x > high.x || node.low.y > high.y || node.low.z > high.z || node.high.x < low.x ||
                node.high.y < low.y || node.high.z < low.z)
                continue;
            if (node.second == 0) {
                for (std::uint32_t i = node.begin; i < node.end; ++i) visit(triangles_[i].id);
            } else {
                stack[top++] = node.second;
                stack[top++] = index + 1;
            }
        }
    }

private:
    struct Entry {
        Point3 a, b, c;
        std::uint32_t id = 0;
    };
    struct Node {
        Point3 low, high;
        std::uint32_t begin = 0, end = 0;
        std::uint32_t second = 0;  // the second child, the first one follows; 0: leaf
    };
    std::uint32_t build(std::uint32_t begin, std::uint32_t end);

    std::vector<Entry> triangles_;
    std::vector<std::uint32_t> place_of_;  // triangle -> entry
    std::vector<Node> nodes_;
};

}  // namespace certa::core
