// Folds and contacts of a coarse mesh.
//
// Contacts: a segment meets a triangle as orientations say; triangles that share a corner meet elsewhere exactly if the
// side opposite to it in one meets the other; triangles that share a side, if they lie in one plane on the same side of
// it. A quad is two surfaces, one for each diagonal: as long as both are sound, or one is clearly the one that
// everybody would take, it stays a quad. If one is not, it becomes two triangles on the other.
#include "remeshing/damage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.h"
#include "core/vector3.h"
#include "exact/orientation.h"
#include "remeshing/stitch.h"
#include "remeshing/triangulate.h"

namespace certa::remeshing {
namespace {

using exact::orient3d;
using Triple = std::array<Index, 3>;

int area_axis(const Point3& a, const Point3& b, const Point3& c) {
    for (int axis = 0; axis < 3; ++axis)
        if (exact::orient2d(exact::drop_axis(a, axis), exact::drop_axis(b, axis), exact::drop_axis(c, axis)) != 0)
            return axis;
    return -1;
}

/// p, q and the triangle in one plane.
bool meets_in_plane(const Point3& p, const Point3& q, const std::array<Point3, 3>& t, int axis) {
    const auto side = [&](const Point3& a, const Point3& b, const Point3& c) {
        return exact::orient2d(exact::drop_axis(a, axis), exact::drop_axis(b, axis), exact::drop_axis(c, axis));
    };
    const auto is_in_box = [&](const Point3& a, const Point3& b, const Point3& c) {
        const exact::Point2 u = exact::drop_axis(a, axis), v = exact::drop_axis(b, axis), w = exact::drop_axis(c, axis);
        return std::min(u.x, v.x) <= w.x && w.x <= std::max(u.x, v.x) && std::min(u.y, v.y) <= w.y &&
               w.y <= std::max(u.y, v.y);
    };
    int inside = 0;
    const int turn = side(t[0], t[1], t[2]);
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 &a = t[i], &b = t[(i + 1) % 3];
        const int ap = side(a, b, p), aq = side(a, b, q), pa = side(p, q, a), pb = side(p, q, b);
        if (ap * aq < 0 && pa * pb < 0) return true;
        if ((ap == 0 && is_in_box(a, b, p)) || (aq == 0 && is_in_box(a, b, q)) || (pa == 0 && is_in_box(p, q, a)) ||
            (pb == 0 && is_in_box(p, q, b)))
            return true;
        inside += ap == turn ? 1 : 0;
    }
    return inside == 3;
}

bool segment_meets(const Point3& p, const Point3& q, const std::array<Point3, 3>& t, int axis) {
    const int at_p = orient3d(t[0], t[1], t[2], p), at_q = orient3d(t[0], t[1], t[2], q);
    if (at_p * at_q > 0) return false;
    if (at_p == 0 && at_q == 0) return meets_in_plane(p, q, t, axis);
    int low = 1, high = -1;
    for (std::size_t i = 0; i < 3; ++i) {
        const int turn = orient3d(p, q, t[i], t[(i + 1) % 3]);
        low = std::min(low, turn), high = std::max(high, turn);
    }
    return !(low < 0 && high > 0);
}

/// A way to fill a polygon.
struct Filling {
    std::vector<Triple> triangles;
    int folds = 0, contacts = 0;
    int badness() const { return 100 * folds + contacts; }
};

double needle_weight(const std::array<Point3, 3>& p) {
    const double longest = std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
    const double shape = longest > 0.0 ? norm(cross(p[1] - p[0], p[2] - p[0])) / (longest * longest) : 0.0;
    return shape < 0.01 ? 1e-14 * longest * (1.0 - 100.0 * shape) : 0.0;
}

class Finder {
public:
    Finder(const Judge& judge, CoarseMesh& mesh, const RunControl& control)
        : judge_(judge), mesh_(mesh), control_(control) {}

    Damage run() {
        Damage damage;
        for (int round = 0; round < 4 && !control_.cancelled(); ++round) {
            list_fillings();
            find_folds();
            if (judge_.is_embedded) find_contacts();
            const std::size_t split = split_quads();
            damage.split += split;
            if (split == 0) break;
        }
        for (Index q = 0; q < fillings_.size(); ++q) {
            const auto best =
                std::min_element(fillings_[q].begin(), fillings_[q].end(),
                                 [](const Filling& a, const Filling& b) { return a.badness() < b.badness(); });
            if (best->badness() == 0) continue;
            damage.polygons.push_back(q);
            damage.folds += best->folds > 0 ? 1 : 0;
            damage.contacts += best->contacts > 0 ? 1 : 0;
        }
        return damage;
    }

private:
    static constexpr std::size_t most_listed = 6;  ///< corners of polygons that are judged on all ways to fill them
    static constexpr double clear = 1.5;           ///< by so much nearer is what everybody takes
    const Point3& at(Index v) const { return mesh_.points[v]; }
    std::array<Point3, 3> points(const Triple& t) const { return {at(t[0]), at(t[1]), at(t[2])}; }

    /// How much a diagonal is worth avoiding, at least and at most: by its distance from the input, and by the needles
    /// among its triangles, whose weight depends on the size that others take for the whole.
    std::array<double, 2> cost_of(const Filling& filling, Index a, Index b) const {
        double cost = 0.0;
        for (const double s : {0.25, 0.5, 0.75})
            cost +=
                2.0 * distance(at(a), at(b)) * judge_.tree.find_nearest((1.0 - s) * at(a) + s * at(b)).squared_distance;
        return with_needles(filling, cost);
    }
    std::array<double, 2> with_needles(const Filling& filling, double cost) const {
        constexpr double sizes = 8.0;
        double needles = 0.0;
        for (const Triple& t : filling.triangles)
            needles += needle_weight(points(t)) * judge_.diagonal * judge_.diagonal;
        return {cost + needles / sizes, cost + sizes * needles};
    }
    /// Which of several diagonals in the surface is the nearest one is a matter of rounding.
    double rounding_of(double lengths) const { return 1e-26 * judge_.diagonal * judge_.diagonal * lengths; }
    /// A triangle's side of its polygon: 1, -1, or 0 where it is nearly upright on it or a needle.
    int side_of(const Triple& t, const Point3& normal) const {
        constexpr double hardly = 1e-4;  // a cosine
        const Point3 own = cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
        const double forward = dot(own, normal), clearly = hardly * norm(own) * norm(normal);
        if (needle_weight(points(t)) > 0.0) return 0;
        return forward > clearly ? 1 : forward < -clearly ? -1 : 0;
    }
    void list_fillings() {
        fillings_.assign(mesh_.polygon_count(), {});
        is_doubtful_.assign(mesh_.polygon_count(), 0);
        core::parallel_for(fillings_.size(), 64, control_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t q = begin; q < end; ++q) fill(q);
        });
    }
    void fill(std::size_t q) {
        const auto ring = mesh_.polygon(q);
        auto& list = fillings_[q];
        if (ring.size() > 4 && ring.size() <= most_listed) return fill_polygon(q);
        if (ring.size() != 4) {
            list.push_back({});
            triangulate_polygon(mesh_.points, ring, judge_.tree, list[0].triangles);
            if (ring.size() == 3) return;
            // With so many corners others clip ears.
            list.push_back({});
            clip_ears(mesh_.points, ring, judge_.tree, list[1].triangles);
            return;
        }
        const Index a = ring[0], b = ring[1], c = ring[2], d = ring[3];
        Filling first{{{a, b, c}, {a, c, d}}}, second{{{a, b, d}, {b, c, d}}};
        const Point3 normal = cross(at(c) - at(a), at(d) - at(b));
        const auto faces = [&](const Filling& filling) {
            return std::all_of(filling.triangles.begin(), filling.triangles.end(), [&](const Triple& t) {
                return dot(cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])), normal) > 0.0;
            });
        };
        const bool first_faces = faces(first), second_faces = faces(second);
        if (first_faces != second_faces) {
            // With a corner that hardly turns the wrong way, or not at all, others may take the other diagonal.
            const Filling& other = first_faces ? second : first;
            is_doubtful_[q] = std::any_of(other.triangles.begin(), other.triangles.end(),
                                          [&](const Triple& t) { return side_of(t, normal) == 0; });
            list.push_back(first_faces ? std::move(first) : std::move(second));
            return;
        }
        const auto x = cost_of(first, a, c), y = cost_of(second, b, d);
        const double rounding = rounding_of(distance(at(a), at(c)) + distance(at(b), at(d)));
        if (!first_faces || y[0] <= clear * x[1] + rounding) list.push_back(std::move(second));
        if (!first_faces || x[0] <= clear * y[1] + rounding) list.push_back(std::move(first));
    }

    /// Five corners or more: all ways whose triangles look to the polygon's side, and that nobody can tell from the
    /// nearest one.
    void fill_polygon(std::size_t q) {
        const auto ring = mesh_.polygon(q);
        const std::size_t n = ring.size();
        Point3 normal;
        for (std::size_t i = 1; i + 1 < n; ++i)
            normal = normal + cross(at(ring[i]) - at(ring[0]), at(ring[i + 1]) - at(ring[0]));
        std::vector<double> costs(n * n, 0.0);  // of diagonals
        double lengths = 0.0;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i + 2; j < n; ++j) {
                if (i == 0 && j == n - 1) continue;
                costs[i * n + j] = cost_of({}, ring[i], ring[j])[0];
                lengths += distance(at(ring[i]), at(ring[j]));
            }
        struct Way {
            Filling filling;
            std::array<double, 2> cost{};
        };
        std::vector<Way> ways;
        double best = std::numeric_limits<double>::infinity();  // of those that surely look to the polygon's side
        for (const auto& cut : all_triangulations(n)) {
            Way way;
            int least = 1;
            double diagonals = 0.0;
            for (const auto& [i, j, k] : cut) {
                way.filling.triangles.push_back({ring[i], ring[j], ring[k]});
                least = std::min(least, side_of(way.filling.triangles.back(), normal));
                // Sorted corners; each diagonal belongs to two triangles.
                diagonals += 0.5 * (costs[i * n + j] + costs[j * n + k] + costs[i * n + k]);
            }
            if (least < 0) continue;
            way.cost = with_needles(way.filling, diagonals);
            if (least > 0) best = std::min(best, way.cost[1]);
            ways.push_back(std::move(way));
        }
        is_doubtful_[q] = best < std::numeric_limits<double>::infinity() ? 0 : 1;
        std::stable_sort(ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.cost[1] < b.cost[1]; });
        for (Way& way : ways)
            if (is_doubtful_[q] != 0 || way.cost[0] <= clear * best + rounding_of(lengths))
                fillings_[q].push_back(std::move(way.filling));
        if (!fillings_[q].empty()) return;
        fillings_[q].push_back({});
        triangulate_polygon(mesh_.points, ring, judge_.tree, fillings_[q][0].triangles);
    }

    void find_folds() {
        core::parallel_for(fillings_.size(), 64, control_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t q = begin; q < end; ++q)
                for (Filling& filling : fillings_[q])
                    for (const Triple& t : filling.triangles)
                        filling.folds += judge_.is_turned_away(at(t[0]), at(t[1]), at(t[2])) ? 1 : 0;
        });
    }

    void find_contacts() {
        struct Entry {
            Triple corners;
            Index polygon = 0, filling = 0;
        };
        std::vector<Entry> entries;
        std::vector<Triangle> triangles;
        std::vector<Index> names(mesh_.points.size());
        if (judge_.is_cut_open)
            names = stitched_vertices(mesh_);
        else
            std::iota(names.begin(), names.end(), 0U);
        for (Index q = 0; q < fillings_.size(); ++q)
            for (Index k = 0; k < fillings_[q].size(); ++k)
                for (const Triple& t : fillings_[q][k].triangles) {
                    entries.push_back({{names[t[0]], names[t[1]], names[t[2]]}, q, k});
                    triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
                }
        const core::TriangleTree tree(mesh_.points, triangles);
        std::vector<std::vector<Index>> met(entries.size());
        core::parallel_for(entries.size(), 64, control_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end && !control_.cancelled(); ++i) {
                const auto p = points(entries[i].corners);
                const Point3 low{std::min({p[0].x, p[1].x, p[2].x}), std::min({p[0].y, p[1].y, p[2].y}),
                                 std::min({p[0].z, p[1].z, p[2].z})};
                const Point3 high{std::max({p[0].x, p[1].x, p[2].x}), std::max({p[0].y, p[1].y, p[2].y}),
                                  std::max({p[0].z, p[1].z, p[2].z})};
                tree.visit_box(low, high, [&](Index j) {
                    if (j <= i || entries[i].polygon == entries[j].polygon) return;
                    if (do_meet(mesh_.points, entries[i].corners, entries[j].corners)) met[i].push_back(j);
                });
                std::sort(met[i].begin(), met[i].end());
            }
        });
        for (std::size_t i = 0; i < entries.size(); ++i)
            for (const Index j : met[i])
                for (const std::size_t k : {i, static_cast<std::size_t>(j)})
                    ++fillings_[entries[k].polygon][entries[k].filling].contacts;
    }

    std::size_t split_quads() {
        std::size_t split = 0;
        CoarseMesh cut = mesh_.without_polygons();
        for (Index q = 0; q < fillings_.size(); ++q) {
            const auto& list = fillings_[q];
            const bool is_bad = is_doubtful_[q] != 0 ||
                                std::any_of(list.begin(), list.end(), [](const Filling& f) { return f.badness() > 0; });
            if (mesh_.polygon(q).size() == 3 || !is_bad) {
                cut.add_polygon(mesh_.polygon(q), mesh_.parent(q));
                continue;
            }
            ++split;
            const auto best = std::min_element(
                list.begin(), list.end(), [](const Filling& a, const Filling& b) { return a.badness() < b.badness(); });
            for (const Triple& t : best->triangles) cut.add_polygon(t, mesh_.parent(q));
        }
        if (split > 0) mesh_ = std::move(cut);
        return split;
    }

    const Judge& judge_;
    CoarseMesh& mesh_;
    const RunControl& control_;
    std::vector<std::vector<Filling>> fillings_;
    std::vector<std::uint8_t> is_doubtful_;  ///< quads that are better cut
};

}  // namespace

bool do_meet(std::span<const Point3> points, const Triple& s, const Triple& t) {
    Triple a = s, b = t;
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = shared; j < 3; ++j)
            if (s[i] == b[j]) {
                std::swap(b[shared], b[j]);
                const auto at = std::find(a.begin() + static_cast<std::ptrdiff_t>(shared), a.end(), s[i]);
                std::swap(a[shared], *at);
                ++shared;
                break;
            }
    const std::array<Point3, 3> p{points[a[0]], points[a[1]], points[a[2]]},
        q{points[b[0]], points[b[1]], points[b[2]]};
    const int p_axis = area_axis(p[0], p[1], p[2]), q_axis = area_axis(q[0], q[1], q[2]);
    if (p_axis < 0 || q_axis < 0) return false;
    if (shared == 3) return true;
    if (shared == 2) {
        if (orient3d(p[0], p[1], p[2], q[2]) != 0) return false;
        const auto side = [&](const Point3& x) {
            return exact::orient2d(exact::drop_axis(p[0], p_axis), exact::drop_axis(p[1], p_axis),
                                   exact::drop_axis(x, p_axis));
        };
        return side(p[2]) == side(q[2]);
    }
    if (shared == 1) return segment_meets(p[1], p[2], q, q_axis) || segment_meets(q[1], q[2], p, p_axis);
    for (std::size_t i = 0; i < 3; ++i)
        if (segment_meets(p[i], p[(i + 1) % 3], q, q_axis) || segment_meets(q[i], q[(i + 1) % 3], p, p_axis))
            return true;
    return false;
}

bool Judge::is_turned_away(const Point3& a, const Point3& b, const Point3& c) const {
    constexpr double least_cosine = 1e-4;  // needles beside a right angle: others may round to the other side
    const Point3 normal = cross(b - a, c - a);
    const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    if (norm(normal) <= 1e-9 * longest) return false;  // a needle has no side
    const Point3 x = (1.0 / 3.0) * (a + b + c);
    const core::NearestPoint nearest = tree.find_nearest(x);
    const double reach = std::sqrt(nearest.squared_distance) + 1e-13 * diagonal;
    const Point3 size{reach, reach, reach};
    bool is_away = true;
    tree.visit_box(x - size, x + size, [&](Index t) {
        if (!is_away) return;
        const Triangle& c3 = input.triangles[t];
        const Point3 &p = input.positions[index_of(c3[0])], &q = input.positions[index_of(c3[1])],
                     &r = input.positions[index_of(c3[2])];
        if (core::find_nearest_on_triangle(x, p, q, r).squared_distance > reach * reach) return;
        const Point3 below = cross(q - p, r - p);
        if (dot(below, normal) > least_cosine * norm(below) * norm(normal)) is_away = false;
    });
    return is_away;
}

Damage find_damage(const Judge& judge, CoarseMesh& mesh, const RunControl& control) {
    return Finder(judge, mesh, control).run();
}

bool has_contact(const TriangleMesh& mesh, std::span<const Index> names, const RunControl& control) {
    const core::TriangleTree tree(mesh.positions, mesh.triangles);
    std::vector<std::uint8_t> met(mesh.triangles.size(), 0);
    core::parallel_for(mesh.triangles.size(), 256, control, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && !control.cancelled(); ++i) {
            const Triangle& s = mesh.triangles[i];
            const Triple a{index_of(s[0]), index_of(s[1]), index_of(s[2])};
            const Point3 &p = mesh.positions[a[0]], &q = mesh.positions[a[1]], &r = mesh.positions[a[2]];
            const Point3 low{std::min({p.x, q.x, r.x}), std::min({p.y, q.y, r.y}), std::min({p.z, q.z, r.z})};
            const Point3 high{std::max({p.x, q.x, r.x}), std::max({p.y, q.y, r.y}), std::max({p.z, q.z, r.z})};
            tree.visit_box(low, high, [&](Index j) {
                if (j <= i) return;
                const Triangle& t = mesh.triangles[j];
                const Triple b{index_of(t[0]), index_of(t[1]), index_of(t[2])};
                Triple named = b;
                for (Index& v : named)
                    for (const Index u : a)
                        if (names[u] == names[v]) v = u;
                if (do_meet(mesh.positions, a, named)) met[i] = 1;
            });
        }
    });
    return std::find(met.begin(), met.end(), 1) != met.end();
}

}  // namespace certa::remeshing
