// From triangles as they come to a surface with one side (remesh, stage 1; thesis 4.1.5 for what features do).
//
// Plan: drop what is no triangle, merge equal points; pair half-edges; turn faces alike, component by component; give
// every fan of faces at a vertex a vertex of its own; then features, wedges between them, and intrinsic angles. Lengths
// are enlarged by one global amount, far below the mean edge, until no triangle is flat (Sharp and Crane 2020): angles
// and layouts exist then for whatever is in the file.
#include "remeshing/work_mesh.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "core/index_map.h"
#include "core/union_find.h"
#include "remeshing/text.h"

namespace certa::remeshing {
namespace {

[[noreturn]] void refuse(DefectKind kind, ElementKind element, std::size_t index, const Point3& place,
                         const std::string& message) {
    throw InputError({{kind, {{element, static_cast<std::uint32_t>(index)}}, place, message}});
}

/// A repair: what was done to how many things, and where the first one is.
void note_repair(RemeshStatistics& statistics, std::size_t count, const std::string& one, const std::string& many,
                 const Point3& first) {
    if (count == 0) return;
    statistics.notes.push_back(std::to_string(count) + ' ' + (count == 1 ? one : many) + ", " +
                               (count == 1 ? "at " : "the first at ") + text_of(first));
}

constexpr double largest_coordinate = 1e50;  // lengths to the sixth power and their inverses are numbers

void check_input(const TriangleMesh& mesh) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Point3& p = mesh.positions[v];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            refuse(DefectKind::non_finite_coordinate, ElementKind::vertex, v, {},
                   "vertex " + std::to_string(v + 1) + " has a coordinate that is no finite number");
        if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > largest_coordinate)
            refuse(DefectKind::coordinate_out_of_range, ElementKind::vertex, v, p,
                   "vertex " + std::to_string(v + 1) +
                       " has a coordinate beyond 1e50, which cannot be remeshed reliably: choose another unit");
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const VertexId v : mesh.triangles[t])
            if (index_of(v) >= mesh.positions.size())
                refuse(DefectKind::index_out_of_range, ElementKind::triangle, t, {},
                       "triangle " + std::to_string(t + 1) + " names vertex " + std::to_string(index_of(v) + 1ULL) +
                           " of " + std::to_string(mesh.positions.size()));
    if (mesh.triangles.empty())
        throw InputError({{DefectKind::empty_input, {}, {}, "there are no triangles: nothing to remesh"}});
    Point3 low = mesh.positions[index_of(mesh.triangles[0][0])], high = low;
    for (const Triangle& t : mesh.triangles)
        for (const VertexId v : t) {
            const Point3& p = mesh.positions[index_of(v)];
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (extent > 0.0 && extent < 1.0 / largest_coordinate)
        throw InputError({{DefectKind::coordinate_out_of_range,
                           {},
                           low,
                           "the surface is smaller than 1e-50 and cannot be remeshed reliably: choose another unit"}});
}

}  // namespace

std::vector<Index> merge_points(const std::vector<Point3>& points) {
    std::vector<Index> order(points.size()), first(points.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](Index v) { return std::array{points[v].x, points[v].y, points[v].z}; };
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
        const auto ka = key(a), kb = key(b);
        return ka != kb ? ka < kb : a < b;
    });
    for (std::size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    return first;
}

namespace {

/// Faces without repeated corners and without repetitions of each other.
void take_faces(WorkMesh& work, const TriangleMesh& mesh, const RemeshOptions& options, RemeshStatistics& statistics) {
    const std::vector<Index> first = joined_points(mesh);
    for (const Edge& edge : options.features) {
        if (index_of(edge[0]) >= first.size() || index_of(edge[1]) >= first.size())
            throw InputError(
                {{DefectKind::index_out_of_range, {}, {}, "a tagged edge names a vertex that is not there"}});
        work.tagged.insert(pair_key(first[index_of(edge[0])], first[index_of(edge[1])]));
    }
    for (std::size_t i = 0; i < options.guides.size(); ++i) {
        const auto [a, b] = options.guides[i];
        if (index_of(a) >= first.size() || index_of(b) >= first.size())
            throw InputError({{DefectKind::index_out_of_range,
                               {},
                               {},
                               "guide " + std::to_string(i + 1) + " names a vertex that is not there"}});
        work.guides.insert(pair_key(first[index_of(a)], first[index_of(b)]));
    }
    std::vector<std::array<Index, 4>> sorted;
    sorted.reserve(mesh.triangles.size());
    std::size_t degenerate = 0, repeated = mesh.triangles.size();  // the first ones
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::array<Index, 3> f{};
        for (std::size_t i = 0; i < 3; ++i) f[i] = first[index_of(mesh.triangles[t][i])];
        if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) {
            if (statistics.degenerate_triangles++ == 0) degenerate = t;
            continue;
        }
        std::sort(f.begin(), f.end());
        sorted.push_back({f[0], f[1], f[2], static_cast<Index>(t)});
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<Index> kept;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (i == 0 || !std::equal(sorted[i].begin(), sorted[i].begin() + 3, sorted[i - 1].begin()))
            kept.push_back(sorted[i][3]);
        else
            repeated = std::min<std::size_t>(repeated, sorted[i][3]);
    }
    std::sort(kept.begin(), kept.end());
    statistics.repeated_triangles = sorted.size() - kept.size();
    if (kept.empty())
        throw InputError({{DefectKind::empty_input,
                           {},
                           {},
                           "no triangle has corners in three different points: nothing to remesh"}});
    std::vector<Index> renamed(mesh.positions.size(), no_index);
    for (const Index t : kept) {
        std::array<Index, 3> f{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Index v = first[index_of(mesh.triangles[t][i])];
            if (renamed[v] == no_index) {
                renamed[v] = static_cast<Index>(work.points.size());
                work.points.push_back(mesh.positions[v]);
                work.point_sources.push_back(v);
            }
            f[i] = renamed[v];
        }
        work.faces.push_back(f);
        work.face_sources.push_back(t);
    }
    Point3 merged, unused;
    for (Index v = 0; v < first.size(); ++v) {
        if (first[v] != v) {
            if (statistics.merged_points++ == 0) merged = mesh.positions[v];
        } else if (renamed[v] == no_index) {
            if (statistics.unused_vertices++ == 0) unused = mesh.positions[v];
        }
    }
    note_repair(statistics, statistics.merged_points,
                "point of the input coincides with another and was merged with it",
                "points of the input coincide with others and were merged with them", merged);
    note_repair(statistics, statistics.unused_vertices, "point of the input belongs to no triangle and was left out",
                "points of the input belong to no triangle and were left out", unused);
    const auto place_of = [&](std::size_t t) {
        return t < mesh.triangles.size() ? mesh.positions[index_of(mesh.triangles[t][0])] : Point3{};
    };
    note_repair(statistics, statistics.degenerate_triangles, "triangle names a point twice and was left out",
                "triangles name a point twice and were left out", place_of(degenerate));
    note_repair(statistics, statistics.repeated_triangles, "triangle repeats another and was left out",
                "triangles repeat others and were left out", place_of(repeated));
}

/// Half-edges sorted by their ends: groups of more than one meet in an edge.
struct Group {
    std::uint64_t key;
    Index halfedge;
};
std::vector<Group> group_halfedges(const WorkMesh& work) {
    std::vector<Group> groups(3 * work.faces.size());
    for (Index h = 0; h < groups.size(); ++h) {
        const Index a = work.start_of(h), b = work.end_of(h);
        groups[h] = {(static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b), h};
    }
    std::sort(groups.begin(), groups.end(),
              [](const Group& a, const Group& b) { return a.key != b.key ? a.key < b.key : a.halfedge < b.halfedge; });
    return groups;
}

std::size_t end_of_group(const std::vector<Group>& groups, std::size_t at) {
    std::size_t end = at + 1;
    while (end < groups.size() && groups[end].key == groups[at].key) ++end;
    return end;
}

/// Two half-edges per edge are opposite; edges of more faces stay open.
void pair_halfedges(WorkMesh& work) {
    const std::vector<Group> groups = group_halfedges(work);
    work.opposites.assign(groups.size(), no_index);
    for (std::size_t i = 0; i < groups.size();) {
        const std::size_t end = end_of_group(groups, i);
        if (end - i == 2) {
            work.opposites[groups[i].halfedge] = groups[i + 1].halfedge;
            work.opposites[groups[i + 1].halfedge] = groups[i].halfedge;
        }
        i = end;
    }
}

void count_crowded_edges(const WorkMesh& work, RemeshStatistics& statistics) {
    const std::vector<Group> groups = group_halfedges(work);
    Point3 first;
    for (std::size_t i = 0; i < groups.size();) {
        const std::size_t end = end_of_group(groups, i);
        if (end - i > 2 && statistics.non_manifold_edges++ == 0) first = work.points[work.start_of(groups[i].halfedge)];
        i = end;
    }
    note_repair(statistics, statistics.non_manifold_edges,
                "edge belongs to more than two triangles: the surface was cut open there, and the result stitched",
                "edges belong to more than two triangles: the surface was cut open there, and the result stitched",
                first);
}

/// Turns faces so that neighbours agree; of each component the fewer are turned.
void orient(WorkMesh& work, RemeshStatistics& statistics) {
    const Index count = work.face_count();
    std::vector<signed char> turned(count, -1);
    std::vector<Index> queue;
    for (Index seed = 0; seed < count; ++seed) {
        if (turned[seed] >= 0) continue;
        queue.assign(1, seed);
        turned[seed] = 0;
        std::size_t flips = 0;
        for (std::size_t at = 0; at < queue.size(); ++at) {
            const Index f = queue[at];
            for (Index h = 3 * f; h < 3 * f + 3; ++h) {
                const Index o = work.opposites[h];
                if (o == no_index) continue;
                const signed char alike = work.start_of(h) == work.end_of(o) ? turned[f] : 1 - turned[f];
                if (turned[o / 3] < 0) {
                    turned[o / 3] = alike;
                    flips += alike;
                    queue.push_back(o / 3);
                } else if (turned[o / 3] != alike) {
                    const Index t = work.face_sources[f], u = work.face_sources[o / 3];
                    const Point3& place = work.points[work.start_of(h)];
                    const std::string other = t == u ? "those around it" : "triangle " + std::to_string(u + 1ULL);
                    throw InputError(
                        {{DefectKind::open_facet,
                          {{ElementKind::triangle, t}, {ElementKind::triangle, u}},
                          place,
                          "the surface has one side only: no orientation fits triangle " + std::to_string(t + 1ULL) +
                              " and " + other + ", at " + text_of(place) + "; cut it open along a line"}});
                }
            }
        }
        const bool invert = 2 * flips > queue.size();
        if (invert)
            for (const Index f : queue) turned[f] = 1 - turned[f];
    }
    Index last = no_index;  // pieces of one triangle follow each other
    Point3 first;
    for (Index f = 0; f < count; ++f) {
        if (turned[f] != 1) continue;
        std::swap(work.faces[f][1], work.faces[f][2]);
        if (work.face_sources[f] == last) continue;
        last = work.face_sources[f];
        if (statistics.flipped_triangles++ == 0) first = work.points[work.faces[f][0]];
    }
    note_repair(statistics, statistics.flipped_triangles, "triangle was turned over to agree with those beside it",
                "triangles were turned over to agree with those beside them", first);
}

/// One vertex per fan of faces.
void split_vertices(WorkMesh& work, RemeshStatistics& statistics) {
    const Index corners = 3 * work.face_count();
    std::vector<bool> seen(corners, false), used(work.points.size(), false);
    std::vector<Index> fan;
    Point3 first;
    for (Index c = 0; c < corners; ++c) {
        if (seen[c]) continue;
        fan.assign(1, c);
        seen[c] = true;
        for (std::size_t at = 0; at < fan.size(); ++at) {
            const Index left = work.opposites[previous_of(fan[at])];
            const Index over = work.opposites[fan[at]];
            const Index right = over == no_index ? no_index : next_of(over);
            for (const Index n : {left, right}) {
                if (n == no_index || seen[n]) continue;
                seen[n] = true;
                fan.push_back(n);
            }
        }
        const Index v = work.start_of(c);
        if (!used[v]) {
            used[v] = true;
            continue;
        }
        if (statistics.split_vertices++ == 0) first = work.points[v];
        const Index copy = static_cast<Index>(work.points.size());
        work.points.push_back(Point3(work.points[v]));
        work.point_sources.push_back(work.point_sources[v]);
        for (const Index n : fan) work.faces[n / 3][n % 3] = copy;
    }
    if (statistics.non_manifold_edges > 0) return;  // mostly their ends
    note_repair(statistics, statistics.split_vertices,
                "vertex is where sheets meet in a point: it was split, and the result stitched",
                "vertices are where sheets meet in a point: they were split, and the result stitched", first);
}

void number_edges(WorkMesh& work) {
    work.edges.assign(work.opposites.size(), no_index);
    for (Index h = 0; h < work.opposites.size(); ++h) {
        if (work.edges[h] != no_index) continue;
        work.edges[h] = static_cast<Index>(work.edge_halfedges.size());
        if (work.opposites[h] != no_index) work.edges[work.opposites[h]] = work.edges[h];
        work.edge_halfedges.push_back(h);
    }
}

/// Boundary edges that were one edge.
void find_twins(WorkMesh& work) {
    std::vector<std::pair<std::uint64_t, Index>> open;
    for (Index e = 0; e < work.edge_halfedges.size(); ++e) {
        const Index h = work.edge_halfedges[e];
        if (work.opposites[h] != no_index) continue;
        open.push_back({pair_key(work.point_sources[work.start_of(h)], work.point_sources[work.end_of(h)]), e});
    }
    std::sort(open.begin(), open.end());
    work.edge_twins.assign(work.edge_halfedges.size(), no_index);
    for (std::size_t i = 0; i < open.size(); ++i) {
        const bool is_first = i == 0 || open[i].first != open[i - 1].first,
                   is_last = i + 1 == open.size() || open[i].first != open[i + 1].first;
        if (is_first && is_last) continue;
        work.edge_twins[open[i].second] = is_first ? open[i].second : work.edge_twins[open[i - 1].second];
    }
}

/// Creases and guides that are no edges of the input are refused.
void check_marks(const TriangleMesh& mesh, const RemeshOptions& options) {
    if (options.guides.empty() && options.features.empty()) return;
    const std::vector<Index> first = joined_points(mesh);
    std::unordered_set<std::uint64_t> there;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            there.insert(pair_key(first[index_of(t[i])], first[index_of(t[(i + 1) % 3])]));
    const auto check = [&](const std::vector<Edge>& edges, const std::string& name, const char* where) {
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const auto [a, b] = edges[i];
            if (there.contains(pair_key(first[index_of(a)], first[index_of(b)]))) continue;
            refuse(DefectKind::index_out_of_range, ElementKind::vertex, index_of(a), mesh.positions[index_of(a)],
                   name + " " + std::to_string(i + 1) + " joins vertices " + std::to_string(index_of(a) + 1ULL) +
                       " and " + std::to_string(index_of(b) + 1ULL) + ", which share no edge: " + where +
                       " edges of the input");
        }
    };
    check(options.features, "tagged edge", "creases are");
    check(options.guides, "guide", "guides run along");
}

void find_guides(WorkMesh& work) {
    if (work.guides.empty()) return;
    work.is_guide.resize(work.edge_halfedges.size());
    for (Index e = 0; e < work.is_guide.size(); ++e) {
        const Index h = work.edge_halfedges[e];
        work.is_guide[e] =
            work.guides.contains(pair_key(work.point_sources[work.start_of(h)], work.point_sources[work.end_of(h)]));
    }
}

void find_components(WorkMesh& work) {
    core::UnionFind sets(work.faces.size());
    for (Index h = 0; h < work.opposites.size(); ++h)
        if (work.opposites[h] != no_index) sets.unite(h / 3, work.opposites[h] / 3);
    work.components.resize(work.faces.size());
    std::vector<Index> numbers(work.faces.size(), no_index);
    for (Index f = 0; f < work.face_count(); ++f) {
        Index& number = numbers[sets.find(f)];
        if (number == no_index) number = work.component_count++;
        work.components[f] = number;
    }
}

/// What features leave connected.
void find_patches(WorkMesh& work) {
    core::UnionFind sets(work.faces.size());
    for (Index h = 0; h < work.opposites.size(); ++h)
        if (!work.is_feature(h)) sets.unite(h / 3, work.opposites[h] / 3);
    work.patches.resize(work.faces.size());
    std::vector<Index> numbers(work.faces.size(), no_index);
    for (Index f = 0; f < work.face_count(); ++f) {
        Index& number = numbers[sets.find(f)];
        if (number == no_index) number = work.patch_count++;
        work.patches[f] = number;
    }
}

/// Lengths, enlarged until the flattest triangle has a little height, and layouts.
void lay_out(WorkMesh& work) {
    work.lengths.resize(work.edge_halfedges.size());
    double sum = 0.0;
    for (std::size_t e = 0; e < work.lengths.size(); ++e) {
        const Index h = work.edge_halfedges[e];
        work.lengths[e] = distance(work.points[work.start_of(h)], work.points[work.end_of(h)]);
        sum += work.lengths[e];
    }
    work.mean_edge = sum / static_cast<double>(work.lengths.size());
    double slack = work.mean_edge;
    const auto side = [&](Index f, Index i) { return work.lengths[work.edges[3 * f + i]]; };
    for (Index f = 0; f < work.face_count(); ++f) {
        const double a = side(f, 0), b = side(f, 1), c = side(f, 2);
        slack = std::min({slack, a + b - c, b + c - a, c + a - b});
    }
    const double wanted = 1e-6 * work.mean_edge;
    if (slack < wanted)
        for (double& length : work.lengths) length += wanted - slack;
    work.apex.resize(work.faces.size());
    for (Index f = 0; f < work.face_count(); ++f) {
        const double a = side(f, 0), b = side(f, 1), c = side(f, 2);
        const double x = (a * a + (c - b) * (c + b)) / (2.0 * a);
        const double s = 0.5 * (a + b + c);
        const double area = std::sqrt(std::max(s * (s - a) * (s - b) * (s - c), 0.0));
        work.apex[f] = {x, std::max(2.0 * area / a, 1e-9 * a)};
    }
}

double box_diagonal(const WorkMesh& work) {
    Point3 low = work.points[0], high = low;
    for (const Point3& p : work.points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return distance(low, high);
}

/// The pieces of a face with midpoints on some of its sides (no_index: none).
void cut_face(const std::array<Index, 3>& f, const std::array<Index, 3>& middle, const std::vector<Point3>& points,
              std::vector<std::array<Index, 3>>& pieces) {
    const int marked =
        static_cast<int>(std::count_if(middle.begin(), middle.end(), [](Index m) { return m != no_index; }));
    if (marked == 3) {
        for (std::size_t i = 0; i < 3; ++i) pieces.push_back({f[i], middle[i], middle[(i + 2) % 3]});
        pieces.push_back(middle);
        return;
    }
    std::size_t i = 0;  // the side to begin with: marked, and with two marks the one before the other
    while (middle[i] == no_index || (marked == 2 && middle[(i + 1) % 3] == no_index)) ++i;
    const Index a = f[i], b = f[(i + 1) % 3], c = f[(i + 2) % 3], m = middle[i], n = middle[(i + 1) % 3];
    if (marked == 1) {
        pieces.push_back({a, m, c});
        pieces.push_back({m, b, c});
        return;
    }
    pieces.push_back({m, b, n});
    if (distance(points[a], points[n]) <= distance(points[m], points[c])) {
        pieces.push_back({a, m, n});
        pieces.push_back({a, n, c});
    } else {
        pieces.push_back({a, m, c});
        pieces.push_back({m, n, c});
    }
}

}  // namespace

namespace {

/// Halves the edges that are wanted so, by their ends, and their triangles with them. False: none was.
template <class IsWanted>
bool halve_edges(WorkMesh& work, Index input_vertices, const IsWanted& is_wanted) {
    core::PairMap middles(64);
    std::vector<std::array<Index, 3>> faces;
    std::vector<Index> sources;
    const auto middle_of = [&](Index a, Index b) {
        if (!is_wanted(a, b)) return no_index;
        Index m = middles.find(a, b);
        if (m != no_index) return m;
        m = static_cast<Index>(work.points.size());
        middles.set(a, b, m);
        const Point3 middle = 0.5 * (work.points[a] + work.points[b]);
        work.points.push_back(middle);
        const Index source = input_vertices + m, sa = work.point_sources[a], sb = work.point_sources[b];
        work.point_sources.push_back(source);
        for (auto* marked : {&work.tagged, &work.sharp, &work.guides})
            if (marked->contains(pair_key(sa, sb))) {
                marked->insert(pair_key(sa, source));
                marked->insert(pair_key(source, sb));
            }
        return m;
    };
    bool any = false;
    for (std::size_t f = 0; f < work.faces.size(); ++f) {
        const auto& [a, b, c] = work.faces[f];
        const std::array<Index, 3> middle{middle_of(a, b), middle_of(b, c), middle_of(c, a)};
        if (middle == std::array{no_index, no_index, no_index}) {
            faces.push_back(work.faces[f]);
        } else {
            any = true;
            cut_face(work.faces[f], middle, work.points, faces);
        }
        sources.resize(faces.size(), work.face_sources[f]);
    }
    work.faces = std::move(faces);
    work.face_sources = std::move(sources);
    return any;
}

/// Edges opposite to where the surface is so far from flat that directions could turn around a single face more than
/// once: its angles, measured so that they are 2 pi around each vertex, differ from pi by 90 degrees or more. By the
/// point_sources of their ends.
std::unordered_set<std::uint64_t> edges_beyond_tips(const WorkMesh& work) {
    constexpr double most = 0.49 * std::numbers::pi;
    std::unordered_set<std::uint64_t> edges;
    for (Index f = 0; f < work.face_count(); ++f) {
        double excess = 0.0, largest = -1.0;
        Index tip = 0;
        for (Index i = 0; i < 3; ++i) {
            const Complex o = work.local(f, i), p = work.local(f, (i + 1) % 3), q = work.local(f, (i + 2) % 3);
            const double own = work.corner_angle[3 * f + i] - std::arg((q - o) * std::conj(p - o));
            excess += own;
            if (std::abs(own) > largest) largest = std::abs(own), tip = i;
        }
        if (std::abs(excess) < most) continue;
        const Index a = work.faces[f][(tip + 1) % 3], b = work.faces[f][(tip + 2) % 3];
        edges.insert(pair_key(work.point_sources[a], work.point_sources[b]));
    }
    return edges;
}

}  // namespace

void split_long_edges(WorkMesh& work, double longest, Index input_vertices, double most_faces) {
    if (!(longest > 0.0)) return;
    const auto is_long = [&](Index a, Index b) { return distance(work.points[a], work.points[b]) > longest; };
    for (int round = 0; round < 16 && static_cast<double>(work.faces.size()) <= most_faces; ++round)
        if (!halve_edges(work, input_vertices, is_long)) return;
}

void build_wedges(WorkMesh& work) {
    const Index corners = 3 * work.face_count();
    work.wedges.assign(corners, no_index);
    work.corner_start.resize(corners);
    work.corner_angle.resize(corners);
    work.wedge_vertices.clear();
    work.wedge_first.clear();
    work.wedge_closed.clear();
    for (Index c = 0; c < corners; ++c) {
        if (work.wedges[c] != no_index) continue;
        // Clockwise to the first corner behind a feature, or once around.
        Index first = c;
        bool closed = false;
        while (!work.is_feature(first)) {
            first = next_of(work.opposites[first]);
            if (first == c) {
                closed = true;
                break;
            }
        }
        const Index wedge = work.wedge_count();
        work.wedge_vertices.push_back(work.start_of(c));
        work.wedge_first.push_back(first);
        work.wedge_closed.push_back(closed);
        double total = 0.0;
        Index at = first;
        do {
            const Index f = at / 3, i = at % 3;
            const Complex o = work.local(f, i), p = work.local(f, (i + 1) % 3), q = work.local(f, (i + 2) % 3);
            work.wedges[at] = wedge;
            work.corner_start[at] = total;
            work.corner_angle[at] = std::arg((q - o) * std::conj(p - o));
            total += work.corner_angle[at];
            at = work.next_corner(at);
        } while (at != no_index && at != first);
        if (!closed) continue;
        const double scale = 2.0 * std::numbers::pi / total;
        at = first;
        do {
            work.corner_start[at] *= scale;
            work.corner_angle[at] *= scale;
            at = work.next_corner(at);
        } while (at != first);
    }
}

/// Lines are sown at vertices: for `count` of their crossings, edges shorter than lines will be apart.
double longest_edge(const WorkMesh& work, double count) {
    const double longest = 0.04 * box_diagonal(work);
    if (count == 0.0) return longest;
    double area = 0.0;
    for (const auto& [a, b, c] : work.faces)
        area += 0.5 * norm(cross(work.points[b] - work.points[a], work.points[c] - work.points[a]));
    return std::min(longest, 0.6 * std::sqrt(area / count));
}

/// From triangles to all of it.
void connect(WorkMesh& work, const RemeshOptions& options, RemeshStatistics& statistics) {
    pair_halfedges(work);
    orient(work, statistics);
    pair_halfedges(work);
    split_vertices(work, statistics);
    number_edges(work);
    find_twins(work);
    work.is_cut_open = statistics.split_vertices > 0;
    find_guides(work);
    find_components(work);
    lay_out(work);
    work.diagonal = box_diagonal(work);
    work.euler_characteristic = static_cast<std::int64_t>(work.points.size()) -
                                static_cast<std::int64_t>(work.lengths.size()) +
                                static_cast<std::int64_t>(work.faces.size());
    statistics.components = work.component_count;
    statistics.euler_characteristic = work.euler_characteristic;
    find_features(work, options, statistics);
    find_patches(work);
    build_wedges(work);
}

/// Creases by angle are those of the input as it is: in halves of its triangles angles may mean less.
void find_creases(WorkMesh& soup, const RemeshOptions& options) {
    WorkMesh whole = soup;
    RemeshStatistics unused;
    pair_halfedges(whole);
    orient(whole, unused);
    pair_halfedges(whole);
    number_edges(whole);
    whole.diagonal = box_diagonal(whole);
    soup.sharp = find_sharp_edges(whole, options);
}

WorkMesh build_work_mesh(const TriangleMesh& mesh, const RemeshOptions& options, RemeshStatistics& statistics,
                         double count) {
    constexpr int most_rounds = 12;
    check_input(mesh);
    WorkMesh soup;
    statistics.input_vertices = mesh.positions.size();
    statistics.input_triangles = mesh.triangles.size();
    take_faces(soup, mesh, options, statistics);
    check_marks(mesh, options);
    // Needles come apart into ever more of them.
    const double most_faces = count == 0.0 ? 1e300 : 4.0 * static_cast<double>(soup.faces.size()) + 20.0 * count;
    const auto input_vertices = static_cast<Index>(mesh.positions.size());
    count_crowded_edges(soup, statistics);
    find_creases(soup, options);
    split_long_edges(soup, longest_edge(soup, count), input_vertices, most_faces);
    const RemeshStatistics before = statistics;
    for (int round = 0;; ++round) {
        WorkMesh work = soup;
        statistics = before;
        connect(work, options, statistics);
        const std::unordered_set<std::uint64_t> edges = edges_beyond_tips(work);
        if (edges.empty() || round == most_rounds) return work;
        halve_edges(soup, input_vertices, [&](Index a, Index b) {
            return edges.contains(pair_key(soup.point_sources[a], soup.point_sources[b]));
        });
    }
}

}  // namespace certa::remeshing
