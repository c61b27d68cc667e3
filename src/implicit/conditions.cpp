// The conditions of the theorem (docs/implicit-theorem.md), each with the leaves that break it.
//
// Plan: tetrahedra with both signs; frontier faces, each evaluated once and in parallel; components of W with the Euler
// characteristic of their surface, counted on edges, triangles and tetrahedra with both signs; components of the
// complement, by union of unmarked points and of leaves that are not triangulated; the tree in which both alternate,
// from the outside inwards; sums of degrees up that tree.
#include "implicit/conditions.h"

#include <algorithm>
#include <bit>
#include <map>
#include <memory>

#include "core/assert.h"
#include "core/parallel.h"
#include "core/union_find.h"

namespace certa::implicit {
namespace {

using Face = std::array<std::uint32_t, 3>;  ///< sorted points; fewer than three: the last ones repeat

/// Written out: comparing arrays calls memcmp.
int compare(const Face& a, const Face& b) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
    }
    return 0;
}

struct FrontierFace {
    Face face;
    std::uint32_t leaf;
    bool operator<(const FrontierFace& other) const {
        const int order = compare(face, other.face);
        return order != 0 ? order < 0 : leaf < other.leaf;
    }
};

bool is_mixed(const Triangulation& t, const Triangulation::Tetrahedron& tetrahedron) {
    const int sign = t.sign(tetrahedron[0]);
    return std::any_of(tetrahedron.begin() + 1, tetrahedron.end(), [&](std::uint32_t p) { return t.sign(p) != sign; });
}

class Checker {
public:
    Checker(const Octree& tree, const Triangulation& t, const Growth& growth, const std::vector<Cluster>& clusters,
            std::vector<ProvedFace>& proved)
        : tree_(tree),
          t_(t),
          growth_(growth),
          clusters_(clusters),
          proved_(proved),
          bad_(t.active_leaves().size(), 0) {}

    Findings run(const expression::Tape& tape, const RunControl& control) {
        check_mixed();
        check_frontier(tape, control);
        if (findings_.condition == nullptr) {
            find_components();
            find_regions();
            check_degrees();
        }
        add_obstructing_leaves();
        for (std::size_t i = 0; i < bad_.size(); ++i) {
            if (bad_[i]) findings_.offenders.push_back(t_.active_leaves()[i]);
        }
        return std::move(findings_);
    }

private:
    void fail(const char* condition, std::uint32_t active_leaf) {
        if (findings_.condition == nullptr) findings_.condition = condition;
        bad_[active_leaf] = 1;
    }
    bool marked(std::uint32_t point) const { return growth_.marked[point] != 0; }

    /// A critical leaf keeps its points out of W. Where it is larger than a leaf that needs one of them, smaller ones
    /// would not help: it is split too, and its children may have slopes.
    void add_obstructing_leaves() {
        std::vector<Coordinate> needed(t_.point_count(), 0);  // size of the smallest leaf that needs the point
        for (std::size_t i = 0; i < bad_.size(); ++i) {
            if (!bad_[i]) continue;
            const Coordinate size = tree_.size_of(tree_.cell(t_.active_leaves()[i]));
            for (const auto& t : t_.tetrahedra_of(i)) {
                for (const std::uint32_t p : t) {
                    if (!t_.may_join(p) && (needed[p] == 0 || size < needed[p])) needed[p] = size;
                }
            }
        }
        for (std::size_t i = 0; i < bad_.size(); ++i) {
            const Cell& cell = tree_.cell(t_.active_leaves()[i]);
            if (bad_[i] || !cell.is_critical()) continue;
            const Coordinate size = tree_.size_of(cell);
            for (const auto& t : t_.tetrahedra_of(i)) {
                for (const std::uint32_t p : t) {
                    if (needed[p] != 0 && needed[p] < size) bad_[i] = 1;
                }
            }
        }
    }

    void check_mixed() {
        for (std::size_t k = 0; k < t_.tetrahedra().size(); ++k) {
            const auto& tetrahedron = t_.tetrahedra()[k];
            if (!is_mixed(t_, tetrahedron)) continue;
            for (const std::uint32_t p : tetrahedron) {
                if (!marked(p)) fail("collapse", t_.leaf_of(k));
            }
        }
    }

    /// The largest marked face of a tetrahedron outside W: up to three points.
    bool frontier_face(const Triangulation::Tetrahedron& tetrahedron, Face& face) const {
        std::size_t count = 0;
        for (const std::uint32_t p : tetrahedron) {
            if (!marked(p)) continue;
            if (count == 3) return false;  // all four: a tetrahedron of W
            face[count++] = p;
        }
        if (count == 0) return false;
        for (std::size_t i = count; i < 3; ++i) face[i] = face[count - 1];
        std::sort(face.begin(), face.end());
        return true;
    }

    void check_frontier(const expression::Tape& tape, const RunControl& control) {
        std::vector<FrontierFace> faces;
        for (std::size_t k = 0; k < t_.tetrahedra().size(); ++k) {
            const std::uint32_t leaf = t_.leaf_of(k);
            // Within a leaf where f has a sign, it has it on every face, and that is the sign of its points.
            if (tree_.cell(t_.active_leaves()[leaf]).known.sign != 0) continue;
            Face face{};
            if (!is_mixed(t_, t_.tetrahedra()[k]) && frontier_face(t_.tetrahedra()[k], face))
                faces.push_back({face, leaf});
        }
        std::sort(faces.begin(), faces.end());
        std::vector<char> holds = known_before(faces);
        // Each face once, so that the count of enclosures does not depend on how the loop is cut.
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            if (!holds[i] && (i == 0 || compare(faces[i].face, faces[i - 1].face) != 0)) open.push_back(i);
        }
        core::parallel_for(open.size(), 256, control, [&](std::size_t begin, std::size_t end) {
            Field field(tape);
            for (std::size_t k = begin; k < end && !control.cancelled(); ++k) {
                const Face& face = faces[open[k]].face;
                holds[open[k]] = field.sign_on(region_of(face)) == t_.sign(face[0]) ? 1 : 0;
            }
        });
        proved_.clear();
        for (std::size_t i = 0; i < faces.size(); ++i) {
            const bool repeated = i > 0 && compare(faces[i].face, faces[i - 1].face) == 0;
            if (repeated) holds[i] = holds[i - 1];
            if (!holds[i]) {
                fail("frontier", faces[i].leaf);
            } else if (!repeated) {
                proved_.push_back({faces[i].face, t_.sign(faces[i].face[0])});
            }
        }
    }

    /// Which of the sorted faces were proved in the round before, with the sign that they have now.
    std::vector<char> known_before(const std::vector<FrontierFace>& faces) const {
        std::vector<char> holds(faces.size(), 0);
        std::size_t k = 0;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            while (k < proved_.size() && compare(proved_[k].points, faces[i].face) < 0) ++k;
            holds[i] = k < proved_.size() && compare(proved_[k].points, faces[i].face) == 0 &&
                               proved_[k].sign == t_.sign(faces[i].face[0])
                           ? 1
                           : 0;
        }
        return holds;
    }

    /// The smallest box of the grid around a face: its convex hull lies in it.
    Region region_of(const Face& face) const {
        GridPoint low = tree_.points()[face[0]], high = low;
        for (const std::uint32_t p : face) {
            for (std::size_t a = 0; a < 3; ++a) {
                low[a] = std::min(low[a], tree_.points()[p][a]);
                high[a] = std::max(high[a], tree_.points()[p][a]);
            }
        }
        return tree_.grid().region(low, high);
    }

    void find_components() {
        core::UnionFind groups(t_.point_count());
        for (const auto& tetrahedron : t_.tetrahedra()) {
            for (std::size_t i = 0; i < 4; ++i) {
                for (std::size_t j = i + 1; j < 4; ++j) {
                    if (marked(tetrahedron[i]) && marked(tetrahedron[j])) groups.unite(tetrahedron[i], tetrahedron[j]);
                }
            }
        }
        findings_.component_of_point.assign(t_.point_count(), none);
        for (std::uint32_t p = 0; p < t_.point_count(); ++p) {
            if (!marked(p)) continue;
            const std::uint32_t root = groups.find(p);
            if (root == p) {
                findings_.component_of_point[p] = static_cast<std::uint32_t>(findings_.components.size());
                findings_.components.emplace_back();
                findings_.components.back().first_point = p;
            } else {
                findings_.component_of_point[p] = findings_.component_of_point[root];
            }
        }
        count_euler();
    }

    /// The surface has a vertex per edge with both signs, an edge per triangle and a face per tetrahedron with both
    /// signs. Each such triangle lies in two tetrahedra, in one if it lies in a face of the box: there its copies are
    /// half as many.
    void count_euler() {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
        std::vector<int> half_triangles(findings_.components.size(), 0);
        for (const auto& tetrahedron : t_.tetrahedra()) {
            if (!is_mixed(t_, tetrahedron)) continue;
            const std::uint32_t component = findings_.component_of_point[tetrahedron[0]];
            int positive = 0;
            for (std::size_t i = 0; i < 4; ++i) {
                positive += t_.sign(tetrahedron[i]) > 0 ? 1 : 0;
                for (std::size_t j = i + 1; j < 4; ++j) {
                    if (t_.sign(tetrahedron[i]) != t_.sign(tetrahedron[j]))
                        edges.emplace_back(std::minmax(tetrahedron[i], tetrahedron[j]));
                }
            }
            findings_.components[component].euler8 += 8;
            half_triangles[component] += positive == 2 ? 4 : 3;
        }
        std::sort(edges.begin(), edges.end());
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
        for (const auto& [a, b] : edges) {
            ComponentOfW& component = findings_.components[findings_.component_of_point[a]];
            const int faces = std::popcount(t_.box_faces(a) & t_.box_faces(b));
            component.euler8 += 8 >> faces;
            component.edge_points += faces == 2 ? 1 : 0;
        }
        for (std::size_t c = 0; c < half_triangles.size(); ++c) findings_.components[c].euler8 -= 4 * half_triangles[c];
        count_loops(edges);
    }

    /// Edges with both signs in the boundary of the box, united across its triangles with both signs.
    void count_loops(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges) {
        if (!tree_.is_clipped()) return;
        const auto place_of = [&](std::uint32_t a, std::uint32_t b) {
            const std::pair<std::uint32_t, std::uint32_t> edge = std::minmax(a, b);
            return static_cast<std::uint32_t>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin());
        };
        core::UnionFind groups(edges.size());
        for (const auto& t : t_.tetrahedra()) {
            for (std::size_t skip = 0; skip < 4; ++skip) {
                const std::uint32_t p = t[(skip + 1) % 4], q = t[(skip + 2) % 4], r = t[(skip + 3) % 4];
                if ((t_.box_faces(p) & t_.box_faces(q) & t_.box_faces(r)) == 0) continue;
                const std::array<std::uint32_t, 4> ring{p, q, r, p};
                std::uint32_t last = none;
                for (std::size_t i = 0; i < 3; ++i) {
                    if (t_.sign(ring[i]) == t_.sign(ring[i + 1])) continue;
                    const std::uint32_t place = place_of(ring[i], ring[i + 1]);
                    if (last != none) groups.unite(last, place);
                    last = place;
                }
            }
        }
        for (std::uint32_t i = 0; i < edges.size(); ++i) {
            if (groups.find(i) == i && (t_.box_faces(edges[i].first) & t_.box_faces(edges[i].second)) != 0)
                ++findings_.components[findings_.component_of_point[edges[i].first]].loops;
        }
    }

    std::uint32_t node_of_leaf(std::uint32_t leaf) const { return static_cast<std::uint32_t>(t_.point_count()) + leaf; }
    std::uint32_t outside() const { return static_cast<std::uint32_t>(t_.point_count() + tree_.cells().size()); }

    /// Components of the complement of W: unmarked points that share a tetrahedron, and leaves that are not
    /// triangulated with what they share a face with (none of their points is marked).
    void find_regions() {
        regions_ = std::make_unique<core::UnionFind>(t_.point_count() + tree_.cells().size() + 1);
        for (const auto& tetrahedron : t_.tetrahedra()) {
            std::uint32_t last = none;
            for (const std::uint32_t p : tetrahedron) {
                if (marked(p)) continue;
                if (last != none) regions_->unite(last, p);
                last = p;
            }
        }
        for (const std::uint32_t leaf : tree_.leaves()) {
            for (int face = 0; face < 6; ++face) unite_across(leaf, face / 2, face % 2);
        }
    }

    void unite_across(std::uint32_t leaf, int axis, int side) {
        const Cell& cell = tree_.cell(leaf);
        const std::uint32_t beyond = tree_.across(cell, axis, side);
        if (beyond == none && tree_.is_clipped()) return;
        if (beyond != none && !tree_.cell(beyond).is_leaf()) return;  // the smaller leaves beyond do it
        const bool here = t_.is_active(leaf), there = beyond != none && t_.is_active(beyond);
        if (here && there) return;
        const std::uint32_t node_there = beyond == none ? outside() : node_of_leaf(beyond);
        if (!here) regions_->unite(node_of_leaf(leaf), node_there);
        if (!here && !there) return;
        // One side is triangulated: the corners of the common face are among its points.
        GridPoint low = cell.low;
        const auto a = static_cast<std::size_t>(axis), u = (a + 1) % 3, v = (a + 2) % 3;
        if (side == 1) low[a] += tree_.size_of(cell);
        for (unsigned q = 0; q < 4; ++q) {
            GridPoint corner = low;
            corner[u] += (q & 1u) * tree_.size_of(cell);
            corner[v] += (q >> 1) * tree_.size_of(cell);
            const std::uint32_t point = tree_.points().find(corner);
            CERTA_ASSERT(point != none && !marked(point));
            regions_->unite(point, here ? node_there : node_of_leaf(leaf));
        }
    }

    void check_degrees() {
        auto& components = findings_.components;
        std::vector<std::vector<std::uint32_t>> regions_of(components.size());
        std::map<std::uint32_t, std::vector<std::uint32_t>> components_of;
        std::map<std::uint32_t, int> sign_of_region, degree_of_region;
        for (const auto& tetrahedron : t_.tetrahedra()) note_contacts(tetrahedron, regions_of, sign_of_region);
        for (std::uint32_t c = 0; c < components.size(); ++c) {
            auto& regions = regions_of[c];
            std::sort(regions.begin(), regions.end());
            regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
            CERTA_ASSERT(regions.size() == 2);  // inside and outside of a connected surface
            for (const std::uint32_t region : regions) components_of[region].push_back(c);
        }
        for (const Cluster& cluster : clusters_)
            degree_of_region[region_of_leaf(cluster.leaves.front())] += cluster.degree8;
        std::vector<std::uint32_t> order;
        std::vector<std::uint32_t> inner(components.size(), none);
        walk_inwards(regions_of, components_of, order, inner);
        CERTA_ASSERT(order.size() == components.size());
        for (std::size_t i = order.size(); i-- > 0;) {
            ComponentOfW& component = components[order[i]];
            component.degree8 += degree_of_region[inner[order[i]]];
            component.inner_sign = sign_of_region.at(inner[order[i]]);
            if (component.parent != none) components[component.parent].degree8 += component.degree8;
            if (2 * component.degree8 != -component.inner_sign * component.euler8) refine_component(order[i]);
        }
    }

    void note_contacts(const Triangulation::Tetrahedron& tetrahedron,
                       std::vector<std::vector<std::uint32_t>>& regions_of,
                       std::map<std::uint32_t, int>& sign_of_region) {
        std::uint32_t component = none, region = none;
        int sign = 0;
        for (const std::uint32_t p : tetrahedron) {
            if (marked(p)) {
                component = findings_.component_of_point[p];
            } else {
                region = regions_->find(p);
                sign = t_.sign(p);
            }
        }
        if (component == none || region == none) return;
        auto& regions = regions_of[component];
        if (regions.empty() || regions.back() != region) regions.push_back(region);
        const auto [known, added] = sign_of_region.emplace(region, sign);
        CERTA_ASSERT(added || known->second == sign);
    }

    /// Where the walk begins: around the box, or at a corner of a box that clips.
    std::uint32_t outermost_region() const {
        return tree_.is_clipped() ? region_of_leaf(tree_.leaf_at({0, 0, 0})) : regions_->find(outside());
    }

    std::uint32_t region_of_leaf(std::uint32_t leaf) const {
        if (!t_.is_active(leaf)) return regions_->find(node_of_leaf(leaf));
        const std::uint32_t corner = tree_.points().find(tree_.cell(leaf).low);
        CERTA_ASSERT(corner != none && !marked(corner));
        return regions_->find(corner);
    }

    /// Components of W from the outside inwards; `inner` is the region just inside each.
    void walk_inwards(const std::vector<std::vector<std::uint32_t>>& regions_of,
                      const std::map<std::uint32_t, std::vector<std::uint32_t>>& components_of,
                      std::vector<std::uint32_t>& order, std::vector<std::uint32_t>& inner) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> work{{outermost_region(), none}};
        for (std::size_t i = 0; i < work.size(); ++i) {
            const auto [region, around] = work[i];
            const auto found = components_of.find(region);
            if (found == components_of.end()) continue;
            for (const std::uint32_t c : found->second) {
                if (c == around) continue;
                CERTA_ASSERT(inner[c] == none);  // a tree: nothing is reached twice
                inner[c] = regions_of[c][0] == region ? regions_of[c][1] : regions_of[c][0];
                findings_.components[c].parent = around;
                order.push_back(c);
                work.emplace_back(inner[c], c);
            }
        }
    }

    /// The signs at the points miss some of the topology in V: all its open leaves are split.
    void refine_component(std::uint32_t component) {
        bool any = false;
        for (std::size_t k = 0; k < t_.tetrahedra().size(); ++k) {
            if (tree_.cell(t_.active_leaves()[t_.leaf_of(k)]).known.sign != 0) continue;
            for (const std::uint32_t p : t_.tetrahedra()[k]) {
                if (!marked(p) || findings_.component_of_point[p] != component) continue;
                fail("degree", t_.leaf_of(k));
                any = true;
            }
        }
        CERTA_ASSERT(any);
    }

    const Octree& tree_;
    const Triangulation& t_;
    const Growth& growth_;
    const std::vector<Cluster>& clusters_;
    std::vector<ProvedFace>& proved_;
    std::vector<char> bad_;
    std::unique_ptr<core::UnionFind> regions_;
    Findings findings_;
};

}  // namespace

Findings check_conditions(const Octree& tree, const Triangulation& triangulation, const Growth& growth,
                          const std::vector<Cluster>& clusters, const expression::Tape& tape, const RunControl& control,
                          std::vector<ProvedFace>& proved) {
    return Checker(tree, triangulation, growth, clusters, proved).run(tape, control);
}

Findings check_conditions(const Octree& tree, const Triangulation& triangulation, const Growth& growth,
                          const std::vector<Cluster>& clusters, const expression::Tape& tape,
                          const RunControl& control) {
    std::vector<ProvedFace> nothing;
    return check_conditions(tree, triangulation, growth, clusters, tape, control, nothing);
}

}  // namespace certa::implicit
