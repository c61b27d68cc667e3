// Separating axes: two convex sets are apart if their projections on some axis are. For triangles it is enough to try
// normals, products of edges, and in the plane the normals of edges.
#include "implicit/separation.h"

#include <algorithm>
#include <cmath>

#include "core/vector3.h"

namespace certa::implicit {
namespace {

/// Largest coordinates and sizes decide how far rounding may reach: a thousand times more than it can.
template <std::size_t M, std::size_t N>
double tolerance_of(const std::array<Point3, M>& a, const std::array<Point3, N>& b) {
    double largest = 0;
    for (const Point3& p : a) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    for (const Point3& p : b) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    return 1e-13 * largest;
}

template <std::size_t M, std::size_t N>
bool separates(const Point3& axis, const std::array<Point3, M>& a, const std::array<Point3, N>& b, double tolerance) {
    const double length = norm(axis);
    if (!(length > 0)) return false;
    double low_a = dot(axis, a[0] - b[0]), high_a = low_a, low_b = 0, high_b = 0;
    for (std::size_t i = 1; i < M; ++i) {
        const double d = dot(axis, a[i] - b[0]);
        low_a = std::min(low_a, d);
        high_a = std::max(high_a, d);
    }
    for (std::size_t i = 1; i < N; ++i) {
        const double d = dot(axis, b[i] - b[0]);
        low_b = std::min(low_b, d);
        high_b = std::max(high_b, d);
    }
    return std::max(low_a - high_b, low_b - high_a) > tolerance * length;
}

}  // namespace

Bounds Bounds::of(const Corners& t) {
    return {
        {std::min({t[0].x, t[1].x, t[2].x}), std::min({t[0].y, t[1].y, t[2].y}), std::min({t[0].z, t[1].z, t[2].z})},
        {std::max({t[0].x, t[1].x, t[2].x}), std::max({t[0].y, t[1].y, t[2].y}), std::max({t[0].z, t[1].z, t[2].z})}};
}

bool triangles_apart(const Corners& s, const Corners& t) {
    if (!Bounds::of(s).meets(Bounds::of(t))) return true;
    const double tolerance = tolerance_of(s, t);
    const Corners e{s[1] - s[0], s[2] - s[1], s[0] - s[2]}, g{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    const Point3 m = cross(e[0], e[1]), n = cross(g[0], g[1]);
    if (separates(m, s, t, tolerance) || separates(n, s, t, tolerance)) return true;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (separates(cross(e[i], g[j]), s, t, tolerance)) return true;
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        if (separates(cross(m, e[i]), s, t, tolerance) || separates(cross(n, g[i]), s, t, tolerance)) return true;
    }
    return false;
}

bool segment_apart(const Point3& p, const Point3& q, const Corners& t) {
    const std::array<Point3, 2> s{p, q};
    const double tolerance = tolerance_of(s, t);
    const Corners g{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    const Point3 n = cross(g[0], g[1]), d = q - p;
    if (separates(n, s, t, tolerance) || separates(cross(d, n), s, t, tolerance)) return true;
    for (const Point3& edge : g) {
        if (separates(cross(d, edge), s, t, tolerance) || separates(cross(n, edge), s, t, tolerance)) return true;
    }
    return false;
}

bool box_apart(const Point3& low, const Point3& high, const Corners& t) {
    if (!Bounds{low, high}.meets(Bounds::of(t))) return true;
    std::array<Point3, 8> box;
    for (unsigned c = 0; c < 8; ++c)
        box[c] = {(c & 1u) ? high.x : low.x, (c & 2u) ? high.y : low.y, (c & 4u) ? high.z : low.z};
    const double tolerance = tolerance_of(box, t);
    const Corners g{t[1] - t[0], t[2] - t[1], t[0] - t[2]}, axes{Point3{1, 0, 0}, Point3{0, 1, 0}, Point3{0, 0, 1}};
    if (separates(cross(g[0], g[1]), box, t, tolerance)) return true;
    for (const Point3& axis : axes) {
        if (separates(axis, box, t, tolerance)) return true;
        for (const Point3& edge : g) {
            if (separates(cross(axis, edge), box, t, tolerance)) return true;
        }
    }
    return false;
}

bool apart_beyond_corner(const Corners& s, const Corners& t) {
    return segment_apart(s[1], s[2], t) && segment_apart(t[1], t[2], s);
}

bool apart_beyond_edge(const Corners& s, const Corners& t) {
    const Point3 edge = s[1] - s[0];
    const auto across = [&](const Point3& p) {
        const Point3 d = p - s[0];
        return d - (dot(d, edge) / dot(edge, edge)) * edge;
    };
    const Point3 a = across(s[2]), b = across(t[2]);
    return dot(a, b) < 0.98 * norm(a) * norm(b);
}

/// Smaller triangles share the cells of this level: else large boxes would have very many cells to look into.
constexpr int lowest = -1;

TriangleGrid::Key TriangleGrid::key_of(const Bounds& box) const {
    const double size =
        std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z, unit_ * 0x1p-50});
    const int level = std::clamp(std::ilogb(size / unit_) + 1, lowest, 60);
    const double cell = std::ldexp(unit_, level);
    const auto at = [&](double low, double high) {
        return static_cast<std::int32_t>(std::clamp(std::floor((low / 2 + high / 2) / cell), -2e9, 2e9));
    };
    return {level, {at(box.low.x, box.high.x), at(box.low.y, box.high.y), at(box.low.z, box.high.z)}};
}

std::size_t TriangleGrid::Hash::operator()(const Key& k) const {
    std::uint64_t h = static_cast<std::uint64_t>(k.level) * 0x9e3779b97f4a7c15ull;
    for (const std::int32_t c : k.at) h = (h ^ static_cast<std::uint32_t>(c)) * 0xbf58476d1ce4e5b9ull ^ (h >> 29);
    return static_cast<std::size_t>(h ^ (h >> 32));
}

void TriangleGrid::insert(std::uint32_t id, const Bounds& box) {
    const Key key = key_of(box);
    cells_[key].push_back(id);
    ++per_level_[static_cast<std::size_t>(key.level + 64)];
}

void TriangleGrid::remove(std::uint32_t id, const Bounds& box) {
    const Key key = key_of(box);
    const auto found = cells_.find(key);
    std::erase(found->second, id);
    if (found->second.empty()) cells_.erase(found);
    --per_level_[static_cast<std::size_t>(key.level + 64)];
}

void TriangleGrid::find(const Bounds& box, std::vector<std::uint32_t>& ids) const {
    for (int level = lowest; level <= 60; ++level) {
        if (per_level_[static_cast<std::size_t>(level + 64)] == 0) continue;
        const double cell = std::ldexp(unit_, level);
        // A triangle of this level reaches at most half a cell from its middle.
        const auto from = [&](double c) { return static_cast<std::int64_t>(std::floor((c - 0.51 * cell) / cell)); };
        const auto to = [&](double c) { return static_cast<std::int64_t>(std::floor((c + 0.51 * cell) / cell)); };
        const std::int64_t low[3] = {from(box.low.x), from(box.low.y), from(box.low.z)};
        const std::int64_t high[3] = {to(box.high.x), to(box.high.y), to(box.high.z)};
        const double count = static_cast<double>(high[0] - low[0] + 1) * static_cast<double>(high[1] - low[1] + 1) *
                             static_cast<double>(high[2] - low[2] + 1);
        const auto add = [&](const Key& key) {
            if (const auto found = cells_.find(key); found != cells_.end())
                ids.insert(ids.end(), found->second.begin(), found->second.end());
        };
        if (count > static_cast<double>(cells_.size())) {
            // Cheaper to look at all cells; in the order of ids, as the order of a hash table is nobody's.
            const std::size_t before = ids.size();
            for (const auto& [key, list] : cells_) {
                if (key.level == level) ids.insert(ids.end(), list.begin(), list.end());
            }
            std::sort(ids.begin() + static_cast<std::ptrdiff_t>(before), ids.end());
            continue;
        }
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
            for (std::int64_t j = low[1]; j <= high[1]; ++j) {
                for (std::int64_t i = low[0]; i <= high[0]; ++i)
                    add({level,
                         {static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), static_cast<std::int32_t>(k)}});
            }
        }
    }
}

}  // namespace certa::implicit
