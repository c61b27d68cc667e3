// The input itself where polygons fail.
//
// Which vertices of the work mesh lie in the region is combinatorial: the region's border passes edges at places whose
// order is exact, with the region on its left. Vertices next to such places, and what uncut edges connect with them,
// are in or out. Triangles with three vertices inside that the border does not pass keep clear of it by about one
// triangle; between them and the straight sides of the polygons around runs a strip, the cheapest of all by dynamic
// programming. Creases that enter the region are sides of the strip.
#include "remeshing/region_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/vector3.h"
#include "remeshing/triangulate.h"

namespace certa::remeshing {
namespace {

void sort_unique(std::vector<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}
bool holds(const std::vector<Index>& sorted, Index x) { return std::binary_search(sorted.begin(), sorted.end(), x); }

constexpr Index inner_bit = 1U << 31;  ///< a corner inside, until the outer ones are counted

Point3 unit(const Point3& v) {
    const double length = norm(v);
    return length > 0.0 ? (1.0 / length) * v : Point3{};
}

/// Cycles of a map from each vertex to the next; empty when a vertex has two or the chain breaks.
std::optional<std::vector<std::vector<Index>>> chain_up(const std::vector<std::array<Index, 2>>& sides) {
    std::map<Index, Index> next;
    for (const auto& [a, b] : sides)
        if (!next.emplace(a, b).second) return std::nullopt;
    std::vector<std::vector<Index>> loops;
    while (!next.empty()) {
        std::vector<Index> loop;
        for (auto at = next.begin(); at != next.end(); at = next.find(loop.empty() ? no_index : loop.back())) {
            if (loop.empty()) loop.push_back(at->first);
            const Index to = at->second;
            next.erase(at);
            if (to == loop.front()) break;
            loop.push_back(to);
        }
        if (loop.size() < 3) return std::nullopt;
        loops.push_back(std::move(loop));
    }
    return loops;
}

}  // namespace

Ground::Ground(const CoarseMesh& mesh) : polygons(mesh), tree({}, {}) {
    std::vector<std::array<Index, 3>> filled;
    std::vector<Triangle> triangles;
    const core::TriangleTree none({}, {});
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        triangulate_polygon(mesh.points, mesh.polygon(q), none, filled);
        faces.resize(filled.size(), mesh.parent(q));
    }
    for (const auto& t : filled) triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
    tree = core::TriangleTree(mesh.points, triangles);
}

RegionPatcher::RegionPatcher(const Layout& layout) : layout_(layout), mesh_(layout.network.mesh()) {
    owners_.assign(2 * layout_.graph.edges.size(), no_index);
    node_faces_.resize(layout_.graph.nodes.size());
    component_faces_.resize(mesh_.component_count);
    for (Index f = 0; f < layout_.faces.size(); ++f) {
        for (const Index h : layout_.faces[f]) {
            owners_[h] = f;
            node_faces_[layout_.graph.tail(h)].push_back(f);
        }
        const Index triangle = triangle_beside(layout_.graph, layout_.network, layout_.faces[f].front());
        face_components_.push_back(mesh_.components[triangle]);
        component_faces_[face_components_.back()].push_back(f);
    }
    in_region_.assign(layout_.faces.size(), 0);
    states_.assign(mesh_.points.size(), unknown);
    corner_offsets_.assign(mesh_.points.size() + 1, 0);
    for (const auto& f : mesh_.faces)
        for (const Index v : f) ++corner_offsets_[v + 1];
    for (std::size_t v = 0; v < mesh_.points.size(); ++v) corner_offsets_[v + 1] += corner_offsets_[v];
    corners_.resize(corner_offsets_.back());
    std::vector<Index> at(corner_offsets_.begin(), corner_offsets_.end() - 1);
    for (Index c = 0; c < 3 * mesh_.face_count(); ++c) corners_[at[mesh_.start_of(c)]++] = c;
}

void RegionPatcher::reset() {
    for (const Index v : touched_) states_[v] = unknown;
    for (const Index f : region_) in_region_[f] = 0;
    touched_.clear(), region_.clear();
    marks_.clear(), blocked_edges_.clear(), cut_faces_.clear(), pieces_.clear(), seeds_.clear();
}

std::vector<Index> RegionPatcher::grow(const std::vector<Index>& faces) const {
    std::vector<Index> grown = faces;
    for (const Index f : faces)
        for (const Index h : layout_.faces[f]) {
            const auto& around = node_faces_[layout_.graph.tail(h)];
            grown.insert(grown.end(), around.begin(), around.end());
        }
    sort_unique(grown);
    return grown;
}

bool RegionPatcher::is_whole(const std::vector<Index>& faces) const {
    std::vector<Index> all;
    for (const Index f : faces) all.push_back(face_components_[f]);
    sort_unique(all);
    std::size_t count = 0;
    for (const Index c : all) count += component_faces_[c].size();
    return count == faces.size();
}

// The border on the work mesh -------------------------------------------------------------------------------------

/// A crossing in the plane of one of its faces.
Complex RegionPatcher::crossing_in_plane(Index crossing, Index face) const {
    const PerimeterPlace p = layout_.network.place(crossing, face, 0);
    const Complex a = mesh_.local(face, p.side), b = mesh_.local(face, (p.side + 1) % 3);
    return a + (p.key < 0.0 ? 1.0 + p.key : p.key) * (b - a);
}

void RegionPatcher::mark_line(Index h) {
    const GraphEdge& e = layout_.graph.edges[h / 2];
    const Line& line = layout_.network.lines()[e.line];
    const bool forward = h % 2 == 0;
    const std::size_t chords = line.faces.size();
    const auto in_plane = [&](Index node, Index face) {
        const SurfacePlace& place = layout_.graph.nodes[node].place;
        return place.weights[1] * mesh_.local(face, 1) + place.weights[2] * mesh_.local(face, 2);
    };
    for (double k = std::floor(e.from); k < e.to; k += 1.0) {
        const auto i = static_cast<std::size_t>(k);
        const Index face = line.faces[i % chords];
        cut_faces_.push_back(face);
        BorderPiece piece{face, true, crossing_in_plane(line.crossings[i % line.crossings.size()], face),
                          crossing_in_plane(line.crossings[(i + 1) % line.crossings.size()], face)};
        if (k < e.from && layout_.graph.nodes[e.a].place.face == face) piece.a = in_plane(e.a, face);
        if (k + 1.0 > e.to && layout_.graph.nodes[e.b].place.face == face) piece.b = in_plane(e.b, face);
        pieces_.push_back(piece);
    }
    for (double k = std::floor(e.from) + 1.0; k < e.to; k += 1.0) {
        const auto i = static_cast<std::size_t>(k);
        const Crossing& crossing = layout_.network.crossing(line.crossings[i % line.crossings.size()]);
        Index out = 3 * line.faces[(i - 1) % chords];
        while (mesh_.edges[out] != crossing.edge) ++out;
        const Index inner = forward ? mesh_.end_of(out) : mesh_.start_of(out);
        marks_.push_back({crossing.edge, crossing.t, inner == mesh_.end_of(mesh_.edge_halfedges[crossing.edge])});
    }
    // Ends on features or at a vertex.
    for (const bool start : {true, false}) {
        if (start ? e.from > 0.0 : line.closed || e.to < static_cast<double>(chords)) continue;
        const Crossing& crossing = layout_.network.crossing(start ? line.crossings.front() : line.crossings.back());
        if (crossing.vertex != no_index)
            set(crossing.vertex, border);
        else
            blocked_edges_.push_back(crossing.edge);
    }
}

void RegionPatcher::mark_curve(Index h) {
    const GraphEdge& e = layout_.graph.edges[h / 2];
    const FeatureCurve& curve = mesh_.curves[e.curve];
    const bool forward = h % 2 == 0;
    for (double k = std::floor(e.from); k < e.to; k += 1.0) {
        const auto i = static_cast<std::size_t>(k);
        const Index edge = curve.edges[i % curve.edges.size()];
        blocked_edges_.push_back(edge);
        const Index first = mesh_.edge_halfedges[edge];
        const bool along = mesh_.start_of(first) == curve.vertices[i % curve.vertices.size()];
        const double from = std::max(e.from - k, 0.0), to = std::min(e.to - k, 1.0);
        for (const Index side : {first, mesh_.opposites[first]}) {
            if (side == no_index) continue;
            const Index face = side / 3;
            const Complex a = mesh_.local(face, side % 3), b = mesh_.local(face, (side % 3 + 1) % 3);
            const auto at = [&](double t) { return a + (along == (side == first) ? t : 1.0 - t) * (b - a); };
            pieces_.push_back({face, false, at(from), at(to)});
            if (side != (along == forward ? first : mesh_.opposites[first])) continue;
            const Complex middle = (mesh_.local(face, 1) + mesh_.local(face, 2)) / 3.0, place = at(0.5 * (from + to));
            seeds_.push_back({face, place + 1e-3 * (middle - place), true});
        }
    }
    for (double k = std::ceil(e.from); k <= e.to; k += 1.0)
        set(curve.vertices[static_cast<std::size_t>(k) % curve.vertices.size()], border);
}

void RegionPatcher::mark_border() {
    for (const Index f : region_)
        for (const Index h : layout_.faces[f]) {
            const Index other = owners_[h ^ 1U];
            if (other != no_index && in_region_[other] != 0) continue;
            if (layout_.graph.edges[h / 2].line != no_index)
                mark_line(h);
            else
                mark_curve(h);
        }
    sort_unique(blocked_edges_);
    for (const Index e : blocked_edges_) {
        const Index first = mesh_.edge_halfedges[e];
        cut_faces_.push_back(first / 3);
        if (mesh_.opposites[first] != no_index) cut_faces_.push_back(mesh_.opposites[first] / 3);
    }
    std::sort(marks_.begin(), marks_.end(),
              [](const Mark& a, const Mark& b) { return a.edge != b.edge ? a.edge < b.edge : a.t < b.t; });
}

void RegionPatcher::seed() {
    const auto decide = [&](Index v, bool in) {
        if (states_[v] == border) return;
        const State state = in ? inside : outside;
        set(v, states_[v] == unknown || states_[v] == state ? state : outside);
    };
    for (std::size_t i = 0; i < marks_.size();) {
        std::size_t end = i + 1;
        while (end < marks_.size() && marks_[end].edge == marks_[i].edge) ++end;
        const Index h = mesh_.edge_halfedges[marks_[i].edge];
        decide(mesh_.start_of(h), !marks_[i].inside_high);
        decide(mesh_.end_of(h), marks_[end - 1].inside_high);
        blocked_edges_.push_back(marks_[i].edge);
        i = end;
    }
    // Beside creases: what no line of the border cuts off.
    std::vector<Index> cut;
    for (const BorderPiece& piece : pieces_)
        if (piece.is_line) cut.push_back(piece.face);
    sort_unique(cut);
    for (const Reference& reference : seeds_) {
        if (holds(cut, reference.face)) continue;
        for (const Index v : mesh_.faces[reference.face]) decide(v, true);
    }
    sort_unique(blocked_edges_);
    sort_unique(cut_faces_);
}

void RegionPatcher::flood() {
    std::vector<Index> queue;
    for (const Index v : touched_)
        if (states_[v] == inside) queue.push_back(v);
    for (std::size_t at = 0; at < queue.size(); ++at) {
        const Index v = queue[at];
        for (Index i = corner_offsets_[v]; i < corner_offsets_[v + 1]; ++i) {
            const Index c = corners_[i], p = previous_of(c);
            for (const auto& [edge, other] :
                 {std::pair{mesh_.edges[c], mesh_.end_of(c)}, std::pair{mesh_.edges[p], mesh_.start_of(p)}}) {
                if (states_[other] != unknown || holds(blocked_edges_, edge)) continue;
                set(other, inside);
                queue.push_back(other);
            }
        }
    }
}

RegionMesh RegionPatcher::take_whole_components() const {
    std::vector<Index> all, faces;
    for (const Index f : region_) all.push_back(face_components_[f]);
    sort_unique(all);
    for (Index f = 0; f < mesh_.face_count(); ++f)
        if (holds(all, mesh_.components[f])) faces.push_back(f);
    return cut_region(mesh_, faces, {}, {}, 1);
}

/// What lies well inside, in pieces that are small beside the polygons' sides.
RegionMesh RegionPatcher::take_inside(double side) const {
    std::vector<Index> faces = cut_faces_;
    for (const Index v : touched_)
        if (states_[v] == inside)
            for (Index i = corner_offsets_[v]; i < corner_offsets_[v + 1]; ++i) faces.push_back(corners_[i] / 3);
    for (const Reference& reference : seeds_) faces.push_back(reference.face);
    sort_unique(faces);
    std::vector<Reference> references = seeds_;
    double length = 0.0;
    for (const Index f : faces)
        for (Index i = 0; i < 3; ++i) {
            length += mesh_.lengths[mesh_.edges[3 * f + i]];
            const std::uint8_t state = states_[mesh_.faces[f][i]];
            if (state == inside || state == outside) references.push_back({f, mesh_.local(f, i), state == inside});
        }
    std::stable_sort(references.begin(), references.end(),
                     [](const Reference& a, const Reference& b) { return a.face < b.face; });
    std::vector<BorderPiece> pieces = pieces_;
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const BorderPiece& a, const BorderPiece& b) { return a.face < b.face; });
    length /= 3.0 * static_cast<double>(std::max<std::size_t>(faces.size(), 1));
    constexpr double fineness = 5.0, most = 60000.0;
    const double room = std::sqrt(most / static_cast<double>(std::max<std::size_t>(faces.size(), 1)));
    const double count = std::clamp(std::ceil(fineness * length / side), 1.0, std::clamp(room, 1.0, 16.0));
    return cut_region(mesh_, faces, pieces, references, static_cast<Index>(count));
}

/// The polygons' sides are straight where lines bend: what lies beyond them, or close to them, is in the way.
void RegionPatcher::keep_clear(const Ground& ground, const std::vector<Loop>& outer, double margin,
                               RegionMesh& region) const {
    std::vector<Triangle> sides;
    for (const Loop& loop : outer)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const VertexId a{loop[i]}, b{loop[(i + 1) % loop.size()]};
            sides.push_back({a, b, b});
        }
    const core::TriangleTree rim(ground.polygons.points, sides);
    std::vector<std::uint8_t> is_clear(region.vertices.size(), 0);
    for (std::size_t v = 0; v < is_clear.size(); ++v) {
        const Point3& p = region.vertices[v].point;
        const Index face = ground.faces[ground.tree.find_nearest(p).triangle];
        is_clear[v] =
            face != no_index && in_region_[face] != 0 && rim.find_nearest(p).squared_distance > margin * margin;
    }
    std::erase_if(region.triangles, [&](const std::array<Index, 3>& t) {
        return is_clear[t[0]] == 0 || is_clear[t[1]] == 0 || is_clear[t[2]] == 0;
    });
}

std::optional<std::vector<RegionPatcher::Loop>> RegionPatcher::find_outer_loops(const CoarseMesh& polygons,
                                                                                std::int64_t& characteristic) const {
    std::vector<std::array<Index, 2>> sides, open;
    std::vector<Index> vertices;
    std::int64_t count = 0;
    for (Index q = 0; q < polygons.polygon_count(); ++q) {
        if (polygons.parent(q) == no_index || in_region_[polygons.parent(q)] == 0) continue;
        const auto ring = polygons.polygon(q);
        ++count;
        for (std::size_t i = 0; i < ring.size(); ++i) sides.push_back({ring[i], ring[(i + 1) % ring.size()]});
        vertices.insert(vertices.end(), ring.begin(), ring.end());
    }
    std::sort(sides.begin(), sides.end());
    for (const auto& [a, b] : sides)
        if (!std::binary_search(sides.begin(), sides.end(), std::array{b, a})) open.push_back({a, b});
    sort_unique(vertices);
    characteristic = count + static_cast<std::int64_t>(vertices.size()) -
                     static_cast<std::int64_t>((sides.size() + open.size()) / 2);
    return chain_up(open);
}

namespace {

/// Brings the inner loops into the order of the outer ones, nearest to nearest; false: that is no pairing.
bool pair_loops(const CoarseMesh& polygons, const std::vector<std::vector<Index>>& outer, const RegionMesh& region,
                std::vector<std::vector<Index>>& inner) {
    std::vector<std::vector<Index>> ordered;
    std::vector<bool> is_taken(inner.size(), false);
    for (const auto& loop : outer) {
        double best = std::numeric_limits<double>::infinity();
        std::size_t best_loop = 0;
        for (std::size_t k = 0; k < inner.size(); ++k) {
            double sum = 0.0;
            for (const Index o : loop) {
                double nearest = std::numeric_limits<double>::infinity();
                for (const Index v : inner[k])
                    nearest = std::min(nearest, distance(polygons.points[o], region.vertices[v].point));
                sum += nearest;
            }
            if (sum < best) best = sum, best_loop = k;
        }
        if (is_taken[best_loop]) return false;
        is_taken[best_loop] = true;
        ordered.push_back(inner[best_loop]);
    }
    inner = std::move(ordered);
    return true;
}

}  // namespace

// The strip ------------------------------------------------------------------------------------------------------

/// Creases that enter the region at a vertex of the outer loop: that vertex, the nearest of the inner loop that the
/// crease goes on from, and the crease. `fits` is false where there is none.
std::vector<std::array<std::size_t, 3>> RegionPatcher::find_crease_pairs(const Loop& outer, const Loop& inner,
                                                                         const RegionMesh& region, bool& fits) const {
    std::vector<std::array<std::size_t, 3>> pairs;
    std::vector<std::array<Index, 2>> on_curves;
    for (const FeatureEdge& e : region.feature_edges)
        for (const Index v : {e.a, e.b}) on_curves.push_back({e.curve, v});
    std::sort(on_curves.begin(), on_curves.end());
    for (std::size_t i = 0; i < outer.size(); ++i) {
        if (outer[i] >= layout_.nodes.size()) continue;
        const GraphNode& node = layout_.graph.nodes[layout_.nodes[outer[i]]];
        for (const Index arm : node.arms) {
            const Index curve = layout_.graph.edges[arm / 2].curve;
            if (curve == no_index) continue;
            const Index left = owners_[arm], right = owners_[arm ^ 1U];
            if (left == no_index || right == no_index || in_region_[left] == 0 || in_region_[right] == 0) continue;
            double best = std::numeric_limits<double>::infinity();
            std::size_t at = 0;
            for (std::size_t j = 0; j < inner.size(); ++j) {
                if (!std::binary_search(on_curves.begin(), on_curves.end(), std::array{curve, inner[j]})) continue;
                const double d = distance(node.point, region.vertices[inner[j]].point);
                if (d < best) best = d, at = j;
            }
            fits = fits && best < std::numeric_limits<double>::infinity();
            pairs.push_back({i, at, curve});
        }
    }
    return pairs;
}

bool RegionPatcher::add_strip(const CoarseMesh& polygons, const Loop& outer, const Loop& inner,
                              const RegionMesh& region, const std::vector<Point3>& normals, RegionPatch& patch) const {
    const std::size_t m = outer.size(), n = inner.size();
    if (m * n > 4000000) return false;
    bool fits = true;
    std::vector<std::array<std::size_t, 3>> pairs = find_crease_pairs(outer, inner, region, fits);
    if (!fits) return false;
    std::size_t start_outer = 0, start_inner = 0;
    if (!pairs.empty()) {
        start_outer = pairs[0][0], start_inner = pairs[0][1];
    } else {
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < m; ++i)
            for (std::size_t j = 0; j < n; ++j) {
                const double d = distance(polygons.points[outer[i]], region.vertices[inner[j]].point);
                if (d < best) best = d, start_outer = i, start_inner = j;
            }
    }
    const auto o = [&](std::size_t i) { return outer[(start_outer + i) % m]; };
    const auto v = [&](std::size_t j) { return inner[(start_inner + j) % n]; };
    // Normals at the outer vertices: of the nearest inner ones.
    std::vector<Point3> outer_normals(m);
    for (std::size_t i = 0; i < m; ++i) {
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < n; ++j) {
            const double d = distance(polygons.points[o(i)], region.vertices[v(j)].point);
            if (d < best) best = d, outer_normals[i] = normals[v(j)];
        }
    }
    const auto cost_of = [&](const Point3& a, const Point3& b, const Point3& c, const Point3& below) {
        const Point3 area = cross(b - a, c - a);
        const double size = norm(area);
        const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
        double cost = std::sqrt(longest) + 0.02 * longest / std::sqrt(size + 1e-12 * longest);
        const double agreement = size > 0.0 ? dot(unit(area), below) : 0.0;
        if (agreement < 0.5) cost += (agreement < 0.0 ? 300.0 : 10.0) * std::sqrt(longest) * (1.0 - agreement);
        return cost;
    };
    std::vector<std::array<std::size_t, 2>> forced;
    for (const auto& pair : pairs) forced.push_back({(pair[0] + m - start_outer) % m, (pair[1] + n - start_inner) % n});
    const auto is_barred = [&](std::size_t i, std::size_t j) {
        return std::any_of(forced.begin(), forced.end(), [&](const auto& f) {
            return (f[0] != 0 || f[1] != 0) && ((i < f[0] && j > f[1]) || (i > f[0] && j < f[1]));
        });
    };
    const double infinite = std::numeric_limits<double>::infinity();
    std::vector<double> cost((m + 1) * (n + 1), infinite);
    std::vector<std::uint8_t> from_outer(cost.size(), 0);
    cost[0] = 0.0;
    for (std::size_t i = 0; i <= m; ++i)
        for (std::size_t j = 0; j <= n; ++j) {
            if ((i == 0 && j == 0) || is_barred(i, j)) continue;
            const std::size_t at = i * (n + 1) + j;
            if (i > 0 && cost[at - n - 1] < infinite) {
                const double c = cost[at - n - 1] + cost_of(polygons.points[o(i - 1)], polygons.points[o(i)],
                                                            region.vertices[v(j)].point, unit(normals[v(j)]));
                if (c < cost[at]) cost[at] = c, from_outer[at] = 1;
            }
            if (j > 0 && cost[at - 1] < infinite) {
                const double c = cost[at - 1] + cost_of(region.vertices[v(j)].point, region.vertices[v(j - 1)].point,
                                                        polygons.points[o(i)], unit(normals[v(j)] + normals[v(j - 1)]));
                if (c < cost[at]) cost[at] = c, from_outer[at] = 0;
            }
        }
    if (!(cost.back() < infinite)) return false;
    const auto outer_base = static_cast<Index>(patch.outer.size());
    for (std::size_t i = 0; i < m; ++i) patch.outer.push_back(o(i));
    const auto outer_id = [&](std::size_t i) { return outer_base + static_cast<Index>(i % m); };
    const auto inner_id = [&](std::size_t j) { return v(j) | inner_bit; };
    for (std::size_t i = m, j = n; i + j > 0;) {
        if (from_outer[i * (n + 1) + j] != 0) {
            patch.triangles.push_back({outer_id(i - 1), outer_id(i), inner_id(j)});
            --i;
        } else {
            patch.triangles.push_back({inner_id(j), inner_id(j - 1), outer_id(i)});
            --j;
        }
    }
    for (std::size_t k = 0; k < pairs.size(); ++k)
        patch.feature_edges.push_back(
            {outer_id(forced[k][0]), inner_id(forced[k][1]), static_cast<Index>(pairs[k][2])});
    return true;
}

// ----------------------------------------------------------------------------------------------------------------

std::optional<RegionPatch> RegionPatcher::make(const Ground& ground, const std::vector<Index>& faces,
                                               double clearance) {
    const CoarseMesh& polygons = ground.polygons;
    reset();
    region_ = faces;
    for (const Index f : region_) in_region_[f] = 1;
    RegionPatch patch;
    RegionMesh region;
    if (is_whole(region_)) {
        region = take_whole_components();
    } else {
        std::int64_t characteristic = 0;
        const auto outer = find_outer_loops(polygons, characteristic);
        if (!outer) return std::nullopt;
        mark_border();
        seed();
        flood();
        std::vector<double> sides;
        for (const Loop& loop : *outer)
            for (std::size_t i = 0; i < loop.size(); ++i)
                sides.push_back(distance(polygons.points[loop[i]], polygons.points[loop[(i + 1) % loop.size()]]));
        std::nth_element(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2), sides.end());
        const double side = std::max(sides[sides.size() / 2], 1e-3 * mesh_.mean_edge);
        region = take_inside(side);
        keep_clear(ground, *outer, clearance * side, region);
        if (!region.keep_largest_part() || region.characteristic() != characteristic) return std::nullopt;
        auto inner = chain_up(region.open_sides());
        if (!inner || inner->size() != outer->size() || !pair_loops(polygons, *outer, region, *inner))
            return std::nullopt;
        std::vector<Point3> normals(region.vertices.size());
        for (const auto& t : region.triangles) {
            const Point3& a = region.vertices[t[0]].point;
            const Point3 area = cross(region.vertices[t[1]].point - a, region.vertices[t[2]].point - a);
            for (const Index v : t) normals[v] = normals[v] + area;
        }
        for (Point3& n : normals) n = unit(n);
        for (std::size_t k = 0; k < outer->size(); ++k)
            if (!add_strip(polygons, (*outer)[k], (*inner)[k], region, normals, patch)) return std::nullopt;
    }
    const auto outer_count = static_cast<Index>(patch.outer.size());
    const auto resolve = [&](Index& v) { v = (v & inner_bit) != 0 ? outer_count + (v ^ inner_bit) : v; };
    for (auto& t : patch.triangles)
        for (Index& v : t) resolve(v);
    for (FeatureEdge& e : patch.feature_edges) resolve(e.a), resolve(e.b);
    for (const auto& t : region.triangles)
        patch.triangles.push_back({outer_count + t[0], outer_count + t[1], outer_count + t[2]});
    for (const FeatureEdge& e : region.feature_edges)
        patch.feature_edges.push_back({outer_count + e.a, outer_count + e.b, e.curve});
    patch.inner = std::move(region.vertices);
    return patch;
}

}  // namespace certa::remeshing
