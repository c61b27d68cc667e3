// Quads from two triangles and the quads between them.
//
// Plan: from each triangle walk over sides through at most two quads to another triangle; the union is a polygon with
// an even number of corners and none inside, which is cut anew as templates are. Candidates by gain, those first that
// gain most; each piece is used once a round; rounds until nothing is left to gain.
#include "remeshing/join_triangles.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "core/vector3.h"
#include "remeshing/templates.h"
#include "remeshing/triangulate.h"
#include "remeshing/work_mesh.h"

namespace certa::remeshing {
namespace {

constexpr std::size_t most_between = 2;
constexpr double least_cosine = 0.866;  ///< between the normals of the pieces and that of the whole
constexpr double least_gain = 0.3;      ///< of cost; a triangle costs 0.9 more than half a perfect quad
constexpr int most_rounds = 4;

using Ring = std::vector<Index>;

struct Candidate {
    double gain = 0.0;
    std::vector<Index> old;  ///< polygons
    std::vector<Ring> pieces;
};

class Joiner {
public:
    explicit Joiner(const CoarseMesh& mesh) : mesh_(mesh), sides_(mesh), is_used_(mesh.polygon_count(), 0) {}

    std::vector<Recut> run() {
        for (Index q = 0; q < mesh_.polygon_count(); ++q) {
            const auto ring = mesh_.polygon(q);
            if (ring.size() != 3) continue;
            way_.assign(1, q);
            walk({ring.begin(), ring.end()});
        }
        return choose(candidates_);
    }
    std::vector<Recut> run_far(const core::TriangleTree& input, double limit) {
        const auto distance_of = [&](Index a, Index b) {
            double farthest = 0.0;
            for (const double s : {0.25, 0.5, 0.75})
                farthest = std::max(
                    farthest, input.find_nearest((1.0 - s) * mesh_.points[a] + s * mesh_.points[b]).squared_distance);
            return std::sqrt(farthest);
        };
        std::vector<Candidate> far;
        for (Index q = 0; q < mesh_.polygon_count(); ++q) {
            const auto ring = mesh_.polygon(q);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Index a = ring[i], b = ring[(i + 1) % ring.size()];
                const auto& beside = sides_.beside.at(pair_key(a, b));
                if (beside[0] != q || beside[1] == no_index) continue;
                if (std::binary_search(sides_.features.begin(), sides_.features.end(), pair_key(a, b))) continue;
                const double now = distance_of(a, b);
                if (now <= limit) continue;
                Candidate candidate{now, {q, beside[1]}, {}};
                const Ring whole = unite({ring.begin(), ring.end()}, a, b, beside[1]);
                if (!whole.empty() && cut_nearer(whole, input, 0.5 * now, distance_of, candidate.pieces))
                    far.push_back(std::move(candidate));
            }
        }
        return choose(far);
    }

private:
    /// False: what is nearest to the input is not near enough, or turns away.
    template <class Distance>
    bool cut_nearer(const Ring& ring, const core::TriangleTree& input, double most, const Distance& distance_of,
                    std::vector<Ring>& pieces) const {
        std::vector<std::array<Index, 3>> triangles;
        const std::vector<Point3> points = points_of(ring);
        triangulate_polygon(mesh_.points, ring, input, triangles);
        const Point3 normal = normal_of(points);
        for (const auto& t : triangles) {
            if (dot(normal_of(points_of(t)), normal) <= 0.0) return false;
            for (std::size_t i = 0; i < 3; ++i)
                if (!sides_.beside.contains(pair_key(t[i], t[(i + 1) % 3])) && distance_of(t[i], t[(i + 1) % 3]) > most)
                    return false;
            pieces.emplace_back(t.begin(), t.end());
        }
        return true;
    }
    /// Those that gain most, a polygon in one at most.
    std::vector<Recut> choose(std::vector<Candidate>& candidates) {
        std::stable_sort(candidates.begin(), candidates.end(),
                         [](const Candidate& l, const Candidate& r) { return l.gain > r.gain; });
        std::vector<Recut> chosen;
        for (Candidate& candidate : candidates) {
            if (std::any_of(candidate.old.begin(), candidate.old.end(), [&](Index q) { return is_used_[q] != 0; }))
                continue;
            if (!add_sides(candidate)) continue;
            Recut recut;
            for (const Index q : candidate.old) {
                is_used_[q] = 1;
                recut.before.emplace_back(mesh_.polygon(q).begin(), mesh_.polygon(q).end());
            }
            recut.after = std::move(candidate.pieces);
            chosen.push_back(std::move(recut));
        }
        return chosen;
    }
    /// Goes on over every side of the last polygon of the way; `ring` is the union so far.
    void walk(const Ring& ring) {
        const auto last = mesh_.polygon(way_.back());
        for (std::size_t i = 0; i < last.size(); ++i) {
            const Index a = last[i], b = last[(i + 1) % last.size()];
            const std::uint64_t key = pair_key(a, b);
            if (std::binary_search(sides_.features.begin(), sides_.features.end(), key)) continue;
            const auto& beside = sides_.beside.at(key);
            const Index next = beside[0] == way_.back() ? beside[1] : beside[0];
            if (next == no_index || mesh_.polygon(next).size() > 4) continue;
            const bool is_end = mesh_.polygon(next).size() == 3;
            if (is_end ? next <= way_.front() : way_.size() > most_between) continue;
            if (std::find(way_.begin(), way_.end(), next) != way_.end()) continue;
            const Ring whole = unite(ring, a, b, next);
            if (whole.empty()) continue;
            way_.push_back(next);
            if (is_end) {
                consider(whole);
            } else {
                walk(whole);
            }
            way_.pop_back();
        }
    }
    /// The union over the side from a to b of `ring`; empty where it would pass a vertex twice.
    Ring unite(const Ring& ring, Index a, Index b, Index next) const {
        const auto other = mesh_.polygon(next);
        Ring whole;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            whole.push_back(ring[i]);
            if (ring[i] != a || ring[(i + 1) % ring.size()] != b) continue;
            const auto start = static_cast<std::size_t>(std::find(other.begin(), other.end(), a) - other.begin());
            if (other[(start + other.size() - 1) % other.size()] != b) return {};  // another way round
            for (std::size_t k = 1; k + 1 < other.size(); ++k) {
                const Index v = other[(start + k) % other.size()];
                if (std::find(ring.begin(), ring.end(), v) != ring.end()) return {};
                whole.push_back(v);
            }
        }
        return whole;
    }
    std::vector<Point3> points_of(std::span<const Index> ring) const {
        std::vector<Point3> points;
        for (const Index v : ring) points.push_back(mesh_.points[v]);
        return points;
    }
    static Point3 normal_of(std::span<const Point3> ring) {
        Point3 sum;
        for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum = sum + cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
        return sum;
    }
    static bool is_like(const Point3& normal, std::span<const Point3> ring) {
        for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
            const Point3 own = cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
            if (dot(own, normal) < least_cosine * norm(own) * norm(normal)) return false;
        }
        return true;
    }
    void consider(const Ring& ring) {
        const std::vector<Point3> points = points_of(ring);
        const Point3 normal = normal_of(points);
        Candidate candidate;
        for (const Index q : way_) {
            const std::vector<Point3> old = points_of(mesh_.polygon(q));
            if (!is_like(normal, old)) return;
            candidate.gain += cutting_cost(old);
        }
        for (const auto& piece : cut_into_quads(points)) {
            if (piece.size() != 4) return;
            candidate.pieces.emplace_back();
            for (const Index i : piece) candidate.pieces.back().push_back(ring[i]);
            const std::vector<Point3> corners = points_of(candidate.pieces.back());
            if (!is_like(normal, corners)) return;
            candidate.gain -= cutting_cost(corners);
        }
        if (candidate.gain < least_gain) return;
        candidate.old = way_;
        candidates_.push_back(std::move(candidate));
    }
    /// Sides of new pieces that were none of the old ones must not be there already.
    bool add_sides(const Candidate& candidate) {
        std::vector<std::uint64_t> added;
        for (const Ring& piece : candidate.pieces)
            for (std::size_t i = 0; i < piece.size(); ++i) {
                const std::uint64_t key = pair_key(piece[i], piece[(i + 1) % piece.size()]);
                const auto found = sides_.beside.find(key);
                if (found == sides_.beside.end()) {
                    added.push_back(key);
                    continue;
                }
                const auto is_old = [&](Index q) {
                    return std::find(candidate.old.begin(), candidate.old.end(), q) != candidate.old.end();
                };
                if (!is_old(found->second[0]) && !is_old(found->second[1])) return false;
            }
        for (const std::uint64_t key : added) sides_.beside[key] = {no_index, no_index};
        return true;
    }

    const CoarseMesh& mesh_;
    SideTable sides_;
    std::vector<std::uint8_t> is_used_;
    std::vector<Index> way_;
    std::vector<Candidate> candidates_;
};

/// The same for every corner to begin with.
Ring from_least(Ring ring) {
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    return ring;
}

}  // namespace

CoarseMesh recut(const CoarseMesh& mesh, const std::vector<Recut>& recuts) {
    struct Polygon {
        Ring ring;
        Index parent = no_index;
    };
    CoarseMesh out = mesh.without_polygons();
    std::vector<Polygon> polygons;
    std::map<Ring, std::size_t> numbers;  // of polygons that are there
    const auto add = [&](const Ring& ring, Index parent) {
        numbers[from_least(ring)] = polygons.size();
        polygons.push_back({ring, parent});
    };
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q)
        add({mesh.polygon(q).begin(), mesh.polygon(q).end()}, mesh.parent(q));
    for (const Recut& recut : recuts) {
        const auto is_there = [&](const Ring& ring) { return numbers.contains(from_least(ring)); };
        if (!std::all_of(recut.before.begin(), recut.before.end(), is_there)) continue;
        const Index parent = polygons[numbers.at(from_least(recut.before.front()))].parent;
        for (const Ring& ring : recut.before) {
            const auto at = numbers.find(from_least(ring));
            Polygon& polygon = polygons[at->second];
            if (polygon.parent != parent) out.joined.push_back({parent, polygon.parent});
            polygon.ring.clear();
            numbers.erase(at);
        }
        for (const Ring& ring : recut.after) add(ring, parent);
    }
    for (const Polygon& polygon : polygons)
        if (!polygon.ring.empty()) out.add_polygon(polygon.ring, polygon.parent);
    return out;
}

SideTable::SideTable(const CoarseMesh& mesh) {
    for (const FeatureEdge& e : mesh.feature_edges) features.push_back(pair_key(e.a, e.b));
    std::sort(features.begin(), features.end());
    for (Index q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const auto [at, is_new] =
                beside.try_emplace(pair_key(ring[i], ring[(i + 1) % ring.size()]), std::array{q, no_index});
            if (!is_new) at->second[1] = q;
        }
    }
}

std::vector<Recut> find_recuts(const CoarseMesh& mesh) {
    std::vector<Recut> all;
    CoarseMesh now = mesh;
    for (int round = 0; round < most_rounds; ++round) {
        std::vector<Recut> next = Joiner(now).run();
        if (next.empty()) break;
        now = recut(now, next);
        std::move(next.begin(), next.end(), std::back_inserter(all));
    }
    return all;
}

std::vector<Recut> find_far_recuts(const CoarseMesh& mesh, const core::TriangleTree& input, double limit) {
    return Joiner(mesh).run_far(input, limit);
}

}  // namespace certa::remeshing
