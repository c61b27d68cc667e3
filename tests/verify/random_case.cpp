// Random valid meshes by brute force: O(n^5) Delaunay triangulation of a dozen points, regions grown from seeds.
#include <algorithm>
#include <map>

#include "core/random.h"
#include "verify/grid_mesh.h"
#include "verify/predicates.h"

namespace certa::test {
namespace {

using Quadruple = std::array<std::uint32_t, 4>;
using Face = std::array<std::uint32_t, 3>;

/// Integer points without five on a sphere or four in a plane, unless the triangulation below does not see them.
std::vector<Point3> random_points(core::Random& random, std::size_t count) {
    std::vector<Point3> points;
    const auto c = [&] { return static_cast<double>(random.below(4000)); };
    for (std::size_t i = 0; i < count; ++i) points.push_back({c(), c(), c()});
    return points;
}

/// Empty when a quadruple is flat or a circumsphere holds a fifth point.
std::vector<Quadruple> triangulate(const std::vector<Point3>& p) {
    std::vector<Quadruple> result;
    const auto n = static_cast<std::uint32_t>(p.size());
    for (std::uint32_t a = 0; a < n; ++a) {
        for (std::uint32_t b = a + 1; b < n; ++b) {
            for (std::uint32_t c = b + 1; c < n; ++c) {
                for (std::uint32_t d = c + 1; d < n; ++d) {
                    Quadruple t{a, b, c, d};
                    const int sign = verify::orientation(p[a], p[b], p[c], p[d]);
                    if (sign == 0) return {};
                    if (sign < 0) std::swap(t[2], t[3]);
                    bool empty = true;
                    for (std::uint32_t e = 0; e < n && empty; ++e) {
                        if (e == a || e == b || e == c || e == d) continue;
                        const int inside = verify::in_circumball(p[t[0]], p[t[1]], p[t[2]], p[t[3]], p[e]);
                        if (inside == 0) return {};
                        empty = inside < 0;
                    }
                    if (empty) result.push_back(t);
                }
            }
        }
    }
    return result;
}

constexpr std::array<std::array<std::size_t, 3>, 4> outward{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

class RandomCase {
public:
    explicit RandomCase(std::uint64_t seed) : random_(seed) {}

    Case make() {
        while (tetrahedra_.empty()) {
            points_ = random_points(random_, 5 + random_.below(9));
            tetrahedra_ = triangulate(points_);
        }
        find_neighbors();
        grow_regions();
        choose_walls();
        number_regions();
        choose_kept();
        return label();
    }

private:
    void find_neighbors() {
        std::map<Face, std::array<std::size_t, 2>> seen;
        for (std::size_t h = 0; h < 4 * tetrahedra_.size(); ++h) {
            const auto [i, fresh] = seen.try_emplace(sorted_face(h), std::array<std::size_t, 2>{h, none});
            if (!fresh) i->second[1] = h;
        }
        mates_.assign(4 * tetrahedra_.size(), none);
        for (const auto& [face, halves] : seen) {
            if (halves[1] == none) continue;
            mates_[halves[0]] = halves[1];
            mates_[halves[1]] = halves[0];
        }
    }
    Face face(std::size_t h) const {
        const Quadruple& t = tetrahedra_[h / 4];
        return {t[outward[h % 4][0]], t[outward[h % 4][1]], t[outward[h % 4][2]]};
    }
    Face sorted_face(std::size_t h) const {
        Face f = face(h);
        std::sort(f.begin(), f.end());
        return f;
    }

    /// Every tetrahedron gets the label of a random seed point, the nearest one; label 0 is the outside.
    void grow_regions() {
        const std::size_t labels = 1 + random_.below(4);
        std::vector<Point3> seeds = random_points(random_, 2 * labels);
        for (const Quadruple& t : tetrahedra_) {
            Point3 middle{};
            for (const std::uint32_t v : t) {
                middle = {middle.x + points_[v].x / 4, middle.y + points_[v].y / 4, middle.z + points_[v].z / 4};
            }
            std::size_t best = 0;
            double nearest = 1e300;
            for (std::size_t s = 0; s < seeds.size(); ++s) {
                const double dx = seeds[s].x - middle.x, dy = seeds[s].y - middle.y, dz = seeds[s].z - middle.z;
                if (dx * dx + dy * dy + dz * dz < nearest) nearest = dx * dx + dy * dy + dz * dz, best = s;
            }
            labels_.push_back(best % labels);
        }
    }

    void choose_walls() {
        walls_.assign(mates_.size(), false);
        const bool dangling = random_.coin();
        for (std::size_t h = 0; h < mates_.size(); ++h) {
            const std::size_t across = mates_[h] == none ? 0 : labels_[mates_[h] / 4];
            if (labels_[h / 4] != across || (dangling && random_.coin(0.1))) {
                walls_[h] = true;
                if (mates_[h] != none) walls_[mates_[h]] = true;
            }
        }
    }

    /// Components between walls; 0 for those that reach the hull, the others by lowest vertex.
    void number_regions() {
        component_.assign(tetrahedra_.size(), none);
        for (std::size_t start = 0; start < tetrahedra_.size(); ++start) {
            if (component_[start] != none) continue;
            Component c;
            std::vector<std::size_t> stack{start};
            component_[start] = components_.size();
            while (!stack.empty()) {
                const std::size_t t = stack.back();
                stack.pop_back();
                for (const std::uint32_t v : tetrahedra_[t]) c.lowest = std::min(c.lowest, v);
                for (std::size_t h = 4 * t; h < 4 * t + 4; ++h) {
                    if (walls_[h]) continue;
                    if (mates_[h] == none) {
                        c.outside = true;
                    } else if (component_[mates_[h] / 4] == none) {
                        component_[mates_[h] / 4] = components_.size();
                        stack.push_back(mates_[h] / 4);
                    }
                }
            }
            components_.push_back(c);
        }
        std::vector<std::size_t> order;
        for (std::size_t c = 0; c < components_.size(); ++c) {
            if (!components_[c].outside) order.push_back(c);
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return components_[a].lowest < components_[b].lowest; });
        for (std::size_t i = 0; i < order.size(); ++i) components_[order[i]].region = static_cast<std::uint32_t>(i + 1);
    }

    bool all_walls_touched() const {
        for (std::size_t h = 0; h < mates_.size(); ++h) {
            const bool here = components_[component_[h / 4]].kept;
            const bool there = mates_[h] != none && components_[component_[mates_[h] / 4]].kept;
            if (walls_[h] && !here && !there) return false;
        }
        return std::any_of(components_.begin(), components_.end(), [](const Component& c) { return c.kept; });
    }

    /// Leaves out some bounded regions and all of the outside, if every wall stays touched.
    void choose_kept() {
        const auto leave_out = [&](auto&& chosen) {
            const std::vector<Component> before = components_;
            for (Component& c : components_) c.kept = c.kept && !chosen(c);
            if (!all_walls_touched()) components_ = before;
        };
        if (random_.coin(0.7)) leave_out([](const Component& c) { return c.outside; });
        for (std::uint32_t region = 1; region <= components_.size(); ++region) {
            if (random_.coin(0.4)) leave_out([&](const Component& c) { return c.region == region; });
        }
    }

    Case label() {
        std::vector<Tetrahedron> kept;
        std::vector<RegionId> regions;
        std::vector<Point3> holes;
        std::vector<bool> told(components_.size(), false);
        for (std::size_t t = 0; t < tetrahedra_.size(); ++t) {
            const Quadruple& q = tetrahedra_[t];
            const Component& c = components_[component_[t]];
            if (c.kept) {
                kept.push_back({VertexId{q[0]}, VertexId{q[1]}, VertexId{q[2]}, VertexId{q[3]}});
                regions.push_back(RegionId{c.region});
            } else if (c.region > 0 && !told[component_[t]]) {
                told[component_[t]] = true;
                Point3 middle{};
                for (const std::uint32_t v : q) {
                    middle = {middle.x + points_[v].x / 4, middle.y + points_[v].y / 4, middle.z + points_[v].z / 4};
                }
                holes.push_back(middle);
            }
        }
        std::vector<std::vector<std::uint32_t>> facets;
        std::vector<Triangle> triangles;
        std::vector<std::uint32_t> labels;
        for (std::size_t h = 0; h < mates_.size(); ++h) {
            if (!walls_[h] || (mates_[h] != none && mates_[h] < h)) continue;
            Face f = face(h);
            if (random_.coin()) std::swap(f[0], f[1]);
            labels.push_back(static_cast<std::uint32_t>(facets.size()));
            facets.push_back({f[0], f[1], f[2]});
            triangles.push_back({VertexId{f[1]}, VertexId{f[2]}, VertexId{f[0]}});
        }
        Case result = make_case(points_, std::move(kept), facets, triangles, labels);
        result.mesh.tetrahedron_regions = std::move(regions);
        result.complex.region_holes = std::move(holes);
        return result;
    }

    static constexpr std::size_t none = ~std::size_t{0};
    struct Component {
        std::uint32_t lowest = no_index, region = 0;
        bool outside = false, kept = true;
    };
    core::Random random_;
    std::vector<Point3> points_;
    std::vector<Quadruple> tetrahedra_;
    std::vector<std::size_t> mates_, labels_, component_;
    std::vector<bool> walls_;
    std::vector<Component> components_;
};

}  // namespace

Case random_case(std::uint64_t seed) { return RandomCase(seed).make(); }

}  // namespace certa::test
