#pragma once
// Sufficient tests in doubles for triangles to keep apart, and places to look for triangles that may not.
#include <certa/types.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace certa::implicit {

using Corners = std::array<Point3, 3>;

/// True only if the two have no common point, with a margin far above the rounding of doubles: near misses count as
/// contacts. That makes these filters; what they let pass is decided exactly by the checker.
bool triangles_apart(const Corners& s, const Corners& t);
bool segment_apart(const Point3& p, const Point3& q, const Corners& t);
bool box_apart(const Point3& low, const Point3& high, const Corners& t);
/// Triangles with the corner s[0] = t[0] in common, and nothing else.
bool apart_beyond_corner(const Corners& s, const Corners& t);
/// Triangles with the edge s[0] s[1] = t[0] t[1] in common: the angle between them is not nearly 0.
bool apart_beyond_edge(const Corners& s, const Corners& t);

struct Bounds {
    Point3 low, high;
    static Bounds of(const Corners& t);
    bool meets(const Bounds& o) const {
        return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y && low.z <= o.high.z &&
               o.low.z <= high.z;
    }
};

/// Triangles by place, of very different sizes, that come and go: a triangle is kept in the cell around its middle of
/// the grid whose cells are about as large as it is.
class TriangleGrid {
public:
    /// `unit`: about the length of an edge; grids have cells of unit 2^k.
    explicit TriangleGrid(double unit) : unit_(unit) {}
    void insert(std::uint32_t id, const Bounds& box);
    void remove(std::uint32_t id, const Bounds& box);
    /// Appends all ids whose box may meet `box`, in a fixed order.
    void find(const Bounds& box, std::vector<std::uint32_t>& ids) const;

private:
    struct Key {
        int level;
        std::array<std::int32_t, 3> at;
        bool operator==(const Key&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Key& k) const;
    };
    Key key_of(const Bounds& box) const;
    double unit_;
    std::unordered_map<Key, std::vector<std::uint32_t>, Hash> cells_;
    std::array<std::size_t, 128> per_level_{};
};

}  // namespace certa::implicit
