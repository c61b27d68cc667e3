// Polygons that are too far from the input (remesh, stage 12): cut, then given vertices.
//
// A diagonal takes a quad apart where its corners are not in one plane. What is left is a triangle that the input
// bulges out of, or a side that does not follow it: a vertex there, on the input, and triangles around it. Far
// triangles beside far quads wait for these: often nothing is left for them to do.
#include "remeshing/cut_far.h"

#include <algorithm>
#include <cmath>

#include "core/vector3.h"
#include "remeshing/triangulate.h"
#include "remeshing/work_mesh.h"

namespace certa::remeshing {
namespace {

using Ring = std::vector<Index>;

class Cutter {
public:
    Cutter(CoarseMesh& mesh, const core::TriangleTree& input)
        : mesh_(mesh), input_(input), sides_(mesh), is_used_(mesh.polygon_count(), 0) {}

    void cut_along_diagonal(Index q) {
        const auto ring = mesh_.polygon(q);
        std::vector<std::array<Index, 3>> triangles;
        triangulate_polygon(mesh_.points, ring, input_, triangles);
        Recut recut{{{ring.begin(), ring.end()}}, {}};
        for (const auto& t : triangles) {
            recut.after.emplace_back(t.begin(), t.end());
            for (std::size_t i = 0; i < 3; ++i) {
                const Index a = t[i], b = t[(i + 1) % 3];
                const bool is_side = has_side(ring, a, b) || has_side(ring, b, a);
                if (!is_side && sides_.beside.contains(pair_key(a, b))) return;  // this edge is somewhere else already
            }
        }
        is_used_[q] = 1;
        for (const auto& t : triangles)
            for (std::size_t i = 0; i < 3; ++i)
                sides_.beside.try_emplace(pair_key(t[i], t[(i + 1) % 3]), std::array{q, q});
        recuts_.push_back(std::move(recut));
    }

    void cut_around_vertex(Index q) {
        if (is_used_[q] != 0) return;
        const auto ring = mesh_.polygon(q);
        Index beyond = no_index, from = no_index;
        double farthest = 0.0;
        bool is_waiting = false;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i], b = ring[(i + 1) % ring.size()];
            if (std::binary_search(sides_.features.begin(), sides_.features.end(), pair_key(a, b))) continue;
            const auto& both = sides_.beside.at(pair_key(a, b));
            const Index other = both[0] == q ? both[1] : both[0];
            const double far = distance_of_side(a, b);
            if (other == no_index || far <= farthest) continue;
            farthest = far;
            beyond = other, from = a;
            is_waiting = is_used_[other] != 0;
        }
        Point3 middle;
        for (const Index v : ring) middle = middle + (1.0 / static_cast<double>(ring.size())) * mesh_.points[v];
        if (farthest * farthest < 0.25 * input_.find_nearest(middle).squared_distance) beyond = no_index;
        if (beyond == no_index) {
            cut_around(q, no_index, no_index, middle);
            return;
        }
        if (is_waiting) return;
        const auto at = std::find(ring.begin(), ring.end(), from);
        const Index to = at + 1 == ring.end() ? ring.front() : at[1];
        cut_around(q, beyond, from, 0.5 * (mesh_.points[from] + mesh_.points[to]));
    }
    /// The new vertex is at a given point of the polygon. Beside a side, what is beyond that is cut, too.
    void cut_around_point(Index q, const Point3& point) {
        constexpr double beside = 0.2;  // of the side
        if (is_used_[q] != 0) return;
        const auto ring = mesh_.polygon(q);
        double nearest = beside;
        std::size_t side = ring.size();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point3 &a = mesh_.points[ring[i]], &b = mesh_.points[ring[(i + 1) % ring.size()]];
            const double length = distance(a, b), away = norm(cross(b - a, point - a)) / (length * length);
            if (!(away < nearest)) continue;
            nearest = away, side = i;
        }
        if (side == ring.size()) {
            cut_around(q, no_index, no_index, point);
            return;
        }
        const Index a = ring[side], b = ring[(side + 1) % ring.size()];
        if (std::binary_search(sides_.features.begin(), sides_.features.end(), pair_key(a, b))) return;
        const auto& both = sides_.beside.at(pair_key(a, b));
        const Index beyond = both[0] == q ? both[1] : both[0];
        if (beyond != no_index && is_used_[beyond] == 0) cut_around(q, beyond, a, point);
    }

    std::vector<Recut> take() { return std::move(recuts_); }

private:
    /// Triangles around a vertex nearest to `place` for a polygon and, where there is one, for what is beyond its side
    /// that begins in `from`.
    void cut_around(Index q, Index beyond, Index from, const Point3& place) {
        const auto ring = mesh_.polygon(q);
        Ring whole{ring.begin(), ring.end()};
        Recut recut{{whole}, {}};
        if (beyond != no_index) {
            const auto other = mesh_.polygon(beyond);
            const auto at = std::find(whole.begin(), whole.end(), from);
            const Index to = at + 1 == whole.end() ? whole.front() : at[1];
            const auto start = static_cast<std::size_t>(std::find(other.begin(), other.end(), from) - other.begin());
            if (other[(start + other.size() - 1) % other.size()] != to) return;
            Ring between;
            for (std::size_t k = 1; k + 1 < other.size(); ++k) between.push_back(other[(start + k) % other.size()]);
            for (const Index v : between)
                if (std::find(whole.begin(), whole.end(), v) != whole.end()) return;
            recut.before.emplace_back(other.begin(), other.end());
            whole.insert(at + 1, between.begin(), between.end());
            is_used_[beyond] = 1;
        }
        is_used_[q] = 1;
        const core::NearestPoint nearest = input_.find_nearest(place);
        const Index center = mesh_.add_vertex(nearest.point, {nearest.triangle, nearest.weights});
        for (std::size_t i = 0; i < whole.size(); ++i)
            recut.after.push_back({whole[i], whole[(i + 1) % whole.size()], center});
        recuts_.push_back(std::move(recut));
    }
    static bool has_side(std::span<const Index> ring, Index a, Index b) {
        for (std::size_t i = 0; i < ring.size(); ++i)
            if (ring[i] == a && ring[(i + 1) % ring.size()] == b) return true;
        return false;
    }
    double distance_of_side(Index a, Index b) const {
        double farthest = 0.0;
        for (const double s : {0.25, 0.5, 0.75})
            farthest = std::max(
                farthest, input_.find_nearest((1.0 - s) * mesh_.points[a] + s * mesh_.points[b]).squared_distance);
        return std::sqrt(farthest);
    }

    CoarseMesh& mesh_;
    const core::TriangleTree& input_;
    SideTable sides_;
    std::vector<std::uint8_t> is_used_;
    std::vector<Recut> recuts_;
};

}  // namespace

std::vector<Recut> cut_far_polygons(CoarseMesh& mesh, const std::vector<Index>& far, const core::TriangleTree& input,
                                    bool may_add) {
    Cutter cutter(mesh, input);
    for (const Index q : far)
        if (mesh.polygon(q).size() > 3) cutter.cut_along_diagonal(q);
    for (const Index q : far)
        if (may_add && mesh.polygon(q).size() == 3) cutter.cut_around_vertex(q);
    return cutter.take();
}

std::vector<Recut> cut_around_points(CoarseMesh& mesh, const std::vector<MissedCrease>& points,
                                     const core::TriangleTree& input) {
    Cutter cutter(mesh, input);
    for (const MissedCrease& missed : points) cutter.cut_around_point(missed.polygon, missed.point);
    return cutter.take();
}

}  // namespace certa::remeshing
