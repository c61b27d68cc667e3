// Polygons with holes in a plane (remesh, stage 7: a flat region needs almost no vertices).
//
// Plan: a hole is joined to the rim around it by the shortest bridge that nothing crosses, twice walked, until one ring
// is left; ears are cut off it; then edges that are no rim are flipped until Delaunay's rule holds. Orientations are
// exact, so that triangles turn the right way; areas that do not add up tell that rims cross.
#include "remeshing/flat_faces.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/vector3.h"
#include "exact/orientation.h"
#include "remeshing/pair_triangles.h"
#include "remeshing/polygons.h"

namespace certa::remeshing {
namespace {

using exact::orient2d;
using exact::Point2;
using Ring = std::vector<Index>;
using Triple = std::array<Index, 3>;

double doubled_area(const Point2& a, const Point2& b, const Point2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
double squared_distance(const Point2& a, const Point2& b) {
    return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
}
bool is_in_box(const Point2& a, const Point2& b, const Point2& p) {
    return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
           p.y <= std::max(a.y, b.y);
}

class Filler {
public:
    Filler(std::span<const Point3> points, const Point3& normal) : points_(points) {
        const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
        axis_ = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
        is_mirrored_ = (axis_ == 0 ? normal.x : axis_ == 1 ? normal.y : normal.z) < 0.0;
    }

    std::optional<std::vector<Triple>> run(const std::vector<Ring>& rims) {
        std::vector<Index> all;
        std::vector<Ring> outer;
        std::vector<Ring> holes;
        double area = 0.0;
        for (const Ring& rim : rims) {
            if (rim.size() < 3) return std::nullopt;
            const double own = area_of(rim);
            area += own;
            (own > 0.0 ? outer : holes).push_back(rim);
            all.insert(all.end(), rim.begin(), rim.end());
        }
        std::sort(all.begin(), all.end());
        if (std::adjacent_find(all.begin(), all.end()) != all.end()) return std::nullopt;
        std::vector<std::vector<Ring>> holes_of(outer.size());
        for (Ring& hole : holes) {
            const std::size_t around = find_around(outer, at(hole.front()));
            if (around == outer.size()) return std::nullopt;
            holes_of[around].push_back(std::move(hole));
        }
        for (std::size_t i = 0; i < outer.size(); ++i)
            if (!join_holes(outer[i], holes_of[i]) || !cut_ears(outer[i])) return std::nullopt;
        double sum = 0.0;
        for (const Triple& t : triangles_) sum += doubled_area(at(t[0]), at(t[1]), at(t[2]));
        if (!(std::abs(sum - area) <= 1e-9 * sum)) return std::nullopt;
        flip();
        return std::move(triangles_);
    }

private:
    Point2 at(Index v) const {
        const Point2 p = exact::drop_axis(points_[v], axis_);
        return is_mirrored_ ? Point2{p.y, p.x} : p;
    }
    int turn(Index a, Index b, Index c) const { return orient2d(at(a), at(b), at(c)); }
    double area_of(const Ring& ring) const {
        double sum = 0.0;
        for (std::size_t i = 2; i < ring.size(); ++i) sum += doubled_area(at(ring[0]), at(ring[i - 1]), at(ring[i]));
        return sum;
    }
    bool is_inside(const Ring& ring, const Point2& p) const {
        bool inside = false;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            Point2 a = at(ring[i]), b = at(ring[(i + 1) % ring.size()]);
            if ((a.y > p.y) == (b.y > p.y)) continue;
            if (a.y > b.y) std::swap(a, b);
            if (orient2d(a, b, p) > 0) inside = !inside;
        }
        return inside;
    }
    /// The smallest of the rings around a point; their number where there is none.
    std::size_t find_around(const std::vector<Ring>& outer, const Point2& p) const {
        std::size_t best = outer.size();
        for (std::size_t i = 0; i < outer.size(); ++i)
            if (is_inside(outer[i], p) && (best == outer.size() || area_of(outer[i]) < area_of(outer[best]))) best = i;
        return best;
    }
    /// Whether a bridge from a to b touches the ring elsewhere than in its ends.
    bool is_blocked(Index a, Index b, const Ring& ring) const {
        const Point2 p = at(a), q = at(b);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index c = ring[i], d = ring[(i + 1) % ring.size()];
            if (c != a && c != b && orient2d(p, q, at(c)) == 0 && is_in_box(p, q, at(c))) return true;
            if (c == a || c == b || d == a || d == b) continue;
            const int pc = orient2d(p, q, at(c)), pd = orient2d(p, q, at(d)), cp = orient2d(at(c), at(d), p),
                      cq = orient2d(at(c), at(d), q);
            if (pc * pd < 0 && cp * cq < 0) return true;
            if ((cp == 0 && is_in_box(at(c), at(d), p)) || (cq == 0 && is_in_box(at(c), at(d), q))) return true;
        }
        return false;
    }
    /// Whether b lies strictly inside the ring's angle at a place of it.
    bool is_in_cone(const Ring& ring, std::size_t i, Index b) const {
        const Index v = ring[i], before = ring[(i + ring.size() - 1) % ring.size()],
                    after = ring[(i + 1) % ring.size()];
        const bool is_left_out = turn(v, after, b) > 0, is_left_in = turn(before, v, b) > 0;
        return turn(before, v, after) > 0 ? is_left_out && is_left_in : is_left_out || is_left_in;
    }

    bool join_holes(Ring& ring, std::vector<Ring>& holes) const {
        while (!holes.empty()) {
            // The hole farthest to the right sees the ring, or a hole that has been joined.
            std::size_t next = 0, start = 0;
            for (std::size_t k = 0; k < holes.size(); ++k)
                for (std::size_t i = 0; i < holes[k].size(); ++i)
                    if (at(holes[k][i]).x > at(holes[next][start]).x) next = k, start = i;
            const Ring hole = holes[next];
            std::vector<std::pair<double, std::size_t>> places;
            for (std::size_t i = 0; i < ring.size(); ++i)
                places.push_back({squared_distance(at(ring[i]), at(hole[start])), i});
            std::sort(places.begin(), places.end());
            const auto found = std::find_if(places.begin(), places.end(), [&](const auto& place) {
                const Index v = ring[place.second];
                return is_in_cone(ring, place.second, hole[start]) && is_in_cone(hole, start, v) &&
                       !is_blocked(hole[start], v, ring) &&
                       std::none_of(holes.begin(), holes.end(),
                                    [&](const Ring& other) { return is_blocked(hole[start], v, other); });
            });
            if (found == places.end()) return false;
            const std::size_t i = found->second;
            Ring joined(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(i) + 1);
            for (std::size_t k = 0; k <= hole.size(); ++k) joined.push_back(hole[(start + k) % hole.size()]);
            joined.insert(joined.end(), ring.begin() + static_cast<std::ptrdiff_t>(i), ring.end());
            ring = std::move(joined);
            holes.erase(holes.begin() + static_cast<std::ptrdiff_t>(next));
        }
        return true;
    }
    bool is_ear(const Ring& ring, std::size_t i) const {
        const std::size_t n = ring.size();
        const Index a = ring[(i + n - 1) % n], b = ring[i], c = ring[(i + 1) % n];
        if (turn(a, b, c) <= 0) return false;
        return std::none_of(ring.begin(), ring.end(), [&](Index v) {
            return v != a && v != b && v != c && turn(a, b, v) >= 0 && turn(b, c, v) >= 0 && turn(c, a, v) >= 0;
        });
    }
    bool cut_ears(Ring ring) {
        std::size_t i = 0, failed = 0;
        while (ring.size() > 3) {
            i %= ring.size();
            if (!is_ear(ring, i)) {
                ++i;
                if (++failed > ring.size()) return false;
                continue;
            }
            failed = 0;
            const std::size_t n = ring.size();
            triangles_.push_back({ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]});
            ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
            ++i;  // not a fan around one vertex
        }
        if (turn(ring[0], ring[1], ring[2]) <= 0) return false;
        triangles_.push_back({ring[0], ring[1], ring[2]});
        return true;
    }
    /// The sum of the angles opposite to the side is above 180 degrees.
    bool is_better_flipped(const Point2& a, const Point2& b, const Point2& c, const Point2& d) const {
        const auto dot_at = [](const Point2& o, const Point2& p, const Point2& q) {
            return (p.x - o.x) * (q.x - o.x) + (p.y - o.y) * (q.y - o.y);
        };
        const double sine = doubled_area(c, a, b) * dot_at(d, b, a) + dot_at(c, a, b) * doubled_area(d, b, a);
        const double size = std::sqrt(squared_distance(c, a) * squared_distance(c, b) * squared_distance(d, a) *
                                      squared_distance(d, b));
        return sine < -1e-9 * size;
    }
    void flip() {
        constexpr int most_rounds = 200;
        for (int round = 0; round < most_rounds; ++round) {
            std::map<std::array<Index, 2>, std::array<Index, 2>> sides;  // triangle, corner where the side starts
            for (Index t = 0; t < triangles_.size(); ++t)
                for (Index i = 0; i < 3; ++i) sides[{triangles_[t][i], triangles_[t][(i + 1) % 3]}] = {t, i};
            std::vector<std::uint8_t> is_changed(triangles_.size(), 0);
            bool any = false;
            for (const auto& [side, place] : sides) {
                const auto back = sides.find({side[1], side[0]});
                if (side[0] > side[1] || back == sides.end()) continue;
                const Index t = place[0], u = back->second[0];
                if (is_changed[t] != 0 || is_changed[u] != 0) continue;
                const Index a = side[0], b = side[1], c = triangles_[t][(place[1] + 2) % 3],
                            d = triangles_[u][(back->second[1] + 2) % 3];
                if (turn(c, a, d) <= 0 || turn(d, b, c) <= 0 || !is_better_flipped(at(a), at(b), at(c), at(d)))
                    continue;
                triangles_[t] = {c, a, d}, triangles_[u] = {d, b, c};
                is_changed[t] = is_changed[u] = 1;
                any = true;
            }
            if (!any) return;
        }
    }

    const std::span<const Point3> points_;
    int axis_ = 0;
    bool is_mirrored_ = false;
    std::vector<Triple> triangles_;
};

/// The unit normal of patches that are flat and not folded; zero for others.
std::vector<Point3> flat_normals(const WorkMesh& mesh, double tolerance) {
    std::vector<Point3> sums(mesh.patch_count);
    std::vector<Index> firsts(mesh.patch_count, no_index);
    const auto area = [&](Index f) {
        const auto& [a, b, c] = mesh.faces[f];
        return cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
    };
    for (Index f = 0; f < mesh.face_count(); ++f) {
        sums[mesh.patches[f]] = sums[mesh.patches[f]] + area(f);
        firsts[mesh.patches[f]] = f;
    }
    for (Point3& n : sums) n = norm(n) > 0.0 ? (1.0 / norm(n)) * n : Point3{};
    std::vector<std::uint8_t> is_flat(mesh.patch_count, 1);
    for (Index f = 0; f < mesh.face_count(); ++f) {
        const Index p = mesh.patches[f];
        const Point3 n = sums[p], origin = mesh.points[mesh.faces[firsts[p]][0]], own = area(f);
        if (dot(own, n) < 0.9 * norm(own)) is_flat[p] = 0;
        for (const Index v : mesh.faces[f])
            if (std::abs(dot(mesh.points[v] - origin, n)) > tolerance) is_flat[p] = 0;
    }
    for (Index p = 0; p < mesh.patch_count; ++p)
        if (is_flat[p] == 0) sums[p] = {};
    return sums;
}

}  // namespace

std::optional<std::vector<Triple>> triangulate_between(std::span<const Point3> points, const std::vector<Ring>& rims,
                                                       const Point3& normal) {
    return Filler(points, normal).run(rims);
}

std::vector<Index> fill_flat_faces(const Network& network, const Graph& graph, const std::vector<Ring>& faces,
                                   std::span<const Index> open, std::span<const Index> nodes,
                                   std::span<const MergedVertex> merged, double tolerance, CoarseMesh& mesh) {
    std::vector<Index> filled;
    if (open.empty()) return filled;
    std::vector<Index> vertices(graph.nodes.size(), no_index);
    for (Index v = 0; v < nodes.size(); ++v) vertices[nodes[v]] = v;
    for (const MergedVertex& m : merged) vertices[nodes[m.vertex]] = m.into;
    std::map<Index, std::vector<Index>> of_patches;
    for (const Index f : open) of_patches[patch_beside(graph, network, faces[f].front())].push_back(f);
    const std::vector<Point3> normals = flat_normals(network.mesh(), tolerance);
    std::vector<Index> group(mesh.polygon_count(), no_index);
    for (const auto& [patch, list] : of_patches) {
        if (!(norm(normals[patch]) > 0.0)) continue;
        std::vector<Ring> rims;
        for (const Index f : list) {
            Ring& ring = rims.emplace_back();
            for (const Index h : faces[f]) ring.push_back(vertices[graph.tail(h)]);
            ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
            while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
        }
        const auto triangles = triangulate_between(mesh.points, rims, normals[patch]);
        if (!triangles) continue;
        for (const Triple& t : *triangles) mesh.add_polygon(t, list.front());
        group.resize(mesh.polygon_count(), patch);
        filled.insert(filled.end(), list.begin(), list.end());
    }
    std::sort(filled.begin(), filled.end());
    if (!filled.empty()) mesh = pair_triangles(mesh, group, tolerance);
    return filled;
}

}  // namespace certa::remeshing
