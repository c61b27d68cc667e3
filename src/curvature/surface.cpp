// Builds the surface of the curvature code from an indexed mesh.
//
// Vertices are sorted along a Z-shaped curve over the bounding box, faces by their lowest vertex: regions around
// vertices that are near in the order share cache lines, which is worth several times the sort. Sides of faces are
// bucketed by their lower vertex; a group of sides on one edge becomes a hinge, a border, the wedges of a solid, or is
// excluded. Nothing depends on the number of threads: every loop writes its own elements only, sums run in input order.
// Plan: check, sort, connect, measure faces and hinges, measure vertices (angle defects, normals), count.
#include "curvature/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "core/assert.h"
#include "core/morton.h"
#include "core/parallel.h"
#include "core/union_find.h"
#include "curvature/link.h"

namespace certa::curvature {
namespace {

constexpr std::array<std::size_t, 3> next{1, 2, 0}, previous{2, 0, 1};
constexpr std::size_t grain = 4096;

void require_valid(const TriangleMesh& mesh) {
    std::vector<Defect> defects;
    constexpr std::size_t shown = 1000;
    for (std::size_t i = 0; i < mesh.positions.size() && defects.size() < shown; ++i) {
        const Point3& p = mesh.positions[i];
        if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
        defects.push_back(
            {DefectKind::non_finite_coordinate,
             {{ElementKind::vertex, static_cast<Index>(i)}},
             {},
             "vertex " + std::to_string(i + 1) + " has a coordinate that is not a finite number; remove it"});
    }
    for (std::size_t t = 0; t < mesh.triangles.size() && defects.size() < shown; ++t)
        for (const VertexId v : mesh.triangles[t]) {
            if (index_of(v) < mesh.positions.size()) continue;
            defects.push_back({DefectKind::index_out_of_range,
                               {{ElementKind::triangle, static_cast<Index>(t)}},
                               {},
                               "triangle " + std::to_string(t + 1) + " names vertex " +
                                   std::to_string(index_of(v) + std::uint64_t{1}) + " of " +
                                   std::to_string(mesh.positions.size())});
            break;
        }
    if (mesh.triangles.empty())
        defects.push_back({DefectKind::empty_input, {}, {}, "there are no triangles, so there is no curvature"});
    if (!defects.empty()) throw InputError(std::move(defects));
}

bool names_vertex_twice(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Sorts pairs (key, index) by key, then index: by digits, least significant first.
void sort_by_key(std::vector<std::pair<std::uint64_t, Index>>& entries, std::uint64_t largest) {
    std::vector<std::pair<std::uint64_t, Index>> other(entries.size());
    constexpr int digit = 11;
    for (int shift = 0; shift < 64 && (largest >> shift) != 0; shift += digit) {
        std::vector<std::size_t> starts((std::size_t{1} << digit) + 1);
        const auto place = [&](std::uint64_t key) {
            return static_cast<std::size_t>(key >> shift) & ((std::size_t{1} << digit) - 1);
        };
        for (const auto& entry : entries) ++starts[place(entry.first) + 1];
        std::partial_sum(starts.begin(), starts.end(), starts.begin());
        for (const auto& entry : entries) other[starts[place(entry.first)]++] = entry;
        entries.swap(other);
    }
}

Point3 scaled(const Point3& p, int exponent) {
    return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

/// Sorted positions, and input -> sorted.
void sort_vertices(const TriangleMesh& mesh, Surface& surface) {
    const std::size_t n = mesh.positions.size();
    std::vector<bool> used(n);
    for (const Triangle& t : mesh.triangles)
        if (!names_vertex_twice(t))
            for (const VertexId v : t) used[index_of(v)] = true;
    Point3 low{}, high{};
    bool first = true;
    for (std::size_t i = 0; i < n; ++i) {
        if (!used[i]) continue;
        const Point3& p = mesh.positions[i];
        if (first) low = high = p, first = false;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (!std::isfinite(extent))
        throw InputError(
            {{DefectKind::coordinate_out_of_range, {}, {}, "the box of the mesh overflows; scale it down"}});
    surface.exponent = extent > 0.0 ? std::ilogb(extent) + 1 : 0;
    std::vector<std::pair<std::uint64_t, Index>> order(n);
    const auto cell = [&](double x, double origin) {
        return extent > 0.0 ? static_cast<std::uint64_t>((x - origin) / extent * 1048575.0) : std::uint64_t{0};
    };
    constexpr std::uint64_t last = std::uint64_t{1} << 60;  // unused vertices
    for (std::size_t i = 0; i < n; ++i) {
        const Point3& p = mesh.positions[i];
        const std::uint64_t key =
            !used[i] ? last : core::morton_code_of_bits(cell(p.x, low.x), cell(p.y, low.y), cell(p.z, low.z));
        order[i] = {key, static_cast<Index>(i)};
    }
    sort_by_key(order, last);
    surface.sorted_vertices.resize(n);
    surface.positions.resize(n);
    surface.vertex_sources.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
        const Index source = order[k].second;
        surface.sorted_vertices[source] = static_cast<Index>(k);
        surface.vertex_sources[k] = source;
        surface.positions[k] = scaled(mesh.positions[source], -surface.exponent);
    }
    surface.diagonal = distance(scaled(low, -surface.exponent), scaled(high, -surface.exponent));
    surface.used_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
    surface.statistics.unused_vertices = n - surface.used_vertices;
}

void sort_faces(const TriangleMesh& mesh, Surface& surface) {
    const std::vector<Index>& sorted_of = surface.sorted_vertices;
    std::vector<std::pair<std::uint64_t, Index>> order;
    order.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& v = mesh.triangles[t];
        if (names_vertex_twice(v)) {
            ++surface.statistics.repeated_vertices;
            continue;
        }
        order.emplace_back(std::min({sorted_of[index_of(v[0])], sorted_of[index_of(v[1])], sorted_of[index_of(v[2])]}),
                           static_cast<Index>(t));
    }
    sort_by_key(order, mesh.positions.size());
    surface.faces.reserve(order.size());
    surface.face_sources.reserve(order.size());
    for (const auto& [key, t] : order) {
        const Triangle& v = mesh.triangles[t];
        std::array<Index, 3> face{sorted_of[index_of(v[0])], sorted_of[index_of(v[1])], sorted_of[index_of(v[2])]};
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        surface.faces.push_back(face);
        surface.face_sources.push_back(t);
    }
}

/// Lists of what `keys_of` says for each of `count` items, keyed by vertex, in increasing order of items.
template <class KeysOf>
Lists bucket(std::size_t vertices, std::size_t count, const KeysOf& keys_of) {
    Lists lists;
    lists.offsets.assign(vertices + 1, 0);
    for (std::size_t i = 0; i < count; ++i)
        for (const Index v : keys_of(i)) ++lists.offsets[v + 1];
    std::partial_sum(lists.offsets.begin(), lists.offsets.end(), lists.offsets.begin());
    lists.items.resize(lists.offsets.back());
    std::vector<std::uint64_t> cursor(lists.offsets.begin(), lists.offsets.end() - 1);
    for (std::size_t i = 0; i < count; ++i)
        for (const Index v : keys_of(i)) lists.items[cursor[v]++] = static_cast<Index>(i);
    return lists;
}

/// A face's side on an edge whose lower vertex is known: the other vertex, the corner opposite, and which way it runs.
struct Side {
    Index other = 0;
    Index face = 0;
    std::uint8_t corner = 0;
    bool forward = false;  ///< the face walks from the lower to the other vertex
};

class HingeBuilder {
public:
    explicit HingeBuilder(Surface& surface) : surface_(surface) {
        surface_.hinges.reserve(surface_.faces.size() * 3 / 2 + 1);
        surface_.face_hinges.resize(surface_.faces.size());
    }

    void add_edges_of(Index vertex) {
        sides_.clear();
        for (const Index f : surface_.vertex_faces[vertex]) {
            const auto& face = surface_.faces[f];
            for (std::uint8_t i = 0; i < 3; ++i) {
                const Index from = face[next[i]], to = face[previous[i]];
                if (std::min(from, to) == vertex) sides_.push_back({std::max(from, to), f, i, from == vertex});
            }
        }
        std::stable_sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) { return a.other < b.other; });
        for (std::size_t i = 0, j = 0; i < sides_.size(); i = j) {
            while (j < sides_.size() && sides_[j].other == sides_[i].other) ++j;
            add_edge(vertex, {sides_.data() + i, j - i});
        }
    }

private:
    void add_edge(Index vertex, std::span<Side> sides) {
        ++surface_.statistics.edges;
        if (sides.size() == 1) {
            ++surface_.statistics.border_edges;
            mark(vertex, sides[0].other, vertex_flags::border);
            add_hinge(vertex, &sides[0], nullptr, 0.0);
        } else if (sides.size() == 2 && sides[0].forward != sides[1].forward) {
            if (!sides[0].forward) std::swap(sides[0], sides[1]);
            add_hinge(vertex, &sides[0], &sides[1], 0.0);
        } else {
            if (sides.size() > 2) {
                ++surface_.statistics.non_manifold_edges;
                mark(vertex, sides[0].other, vertex_flags::non_manifold);
            }
            if (sides.size() % 2 == 0 && order_into_wedges(vertex, sides)) {
                // Inclusion-exclusion over the wedges, whose pairwise intersections are the edge: a full turn each.
                const double turns = 2.0 * std::numbers::pi * (static_cast<double>(sides.size()) / 2.0 - 1.0);
                for (std::size_t i = 0; i < sides.size(); i += 2)
                    add_hinge(vertex, &sides[i + 1], &sides[i], i == 0 ? turns : 0.0);
            } else {
                ++surface_.statistics.excluded_edges;
                mark(vertex, sides[0].other, vertex_flags::excluded);
                for (Side& side : sides) add_hinge(vertex, &side, nullptr, 0.0);
            }
        }
    }

    void mark(Index a, Index b, std::uint8_t flag) {
        surface_.flags[a] |= flag;
        surface_.flags[b] |= flag;
    }

    /// The hinge runs the way its left face walks. `turns` is subtracted from its angle later.
    void add_hinge(Index vertex, const Side* left, const Side* right, double turns) {
        const auto id = static_cast<Index>(surface_.hinges.size());
        Hinge hinge{vertex, left->other, left->face, right != nullptr ? right->face : no_index, turns, 0.0};
        if (!left->forward) std::swap(hinge.a, hinge.b);
        surface_.face_hinges[left->face][left->corner] = id;
        if (right != nullptr) surface_.face_hinges[right->face][right->corner] = id;
        surface_.hinges.push_back(hinge);
    }

    /// Sorts sides around the edge so that pairs (backward, forward) bound the wedges of the solid; false if they do
    /// not alternate. Going round the edge counter-clockwise one enters the solid through a backward face.
    bool order_into_wedges(Index vertex, std::span<Side> sides) {
        const Point3& origin = surface_.positions[vertex];
        const Point3 axis = unit_or_zero(surface_.positions[sides[0].other] - origin);
        std::vector<std::pair<double, Side>> around;
        Point3 x{};
        for (const Side& side : sides) {
            const Point3 to_apex = surface_.positions[surface_.faces[side.face][side.corner]] - origin;
            const Point3 across = unit_or_zero(to_apex - dot(to_apex, axis) * axis);
            if (around.empty()) x = across;
            if (across == Point3{}) return false;
            const double angle = std::atan2(dot(cross(axis, x), across), dot(x, across));
            around.emplace_back(angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle, side);
        }
        std::stable_sort(around.begin(), around.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
        // Faces at the same angle may come in either order.
        for (std::size_t i = 1; i + 1 < around.size(); ++i)
            if (around[i].second.forward == around[i - 1].second.forward && around[i + 1].first == around[i].first)
                std::swap(around[i], around[i + 1]);
        const std::size_t n = around.size(), start = around[0].second.forward ? n - 1 : 0;
        for (std::size_t i = 0; i < n; ++i)
            if (around[(start + i) % n].second.forward != (i % 2 == 1)) return false;
        for (std::size_t i = 0; i < n; ++i) sides[i] = around[(start + i) % n].second;
        return true;
    }

    Surface& surface_;
    std::vector<Side> sides_;
};

double angle_between(const Point3& u, const Point3& v) { return std::atan2(norm(cross(u, v)), dot(u, v)); }

/// Angles of a triangle from unit vectors along its sides, opposite first; they sum to pi also where sides vanish.
std::array<double, 3> corner_angles(const Point3& a, const Point3& b, const Point3& c) {
    const Point3 bc = unit_or_zero(c - b), ca = unit_or_zero(a - c), ab = unit_or_zero(b - a);
    const bool no_bc = bc == Point3{}, no_ca = ca == Point3{}, no_ab = ab == Point3{};
    constexpr double pi = std::numbers::pi;
    if (no_bc && no_ca) return {pi / 3, pi / 3, pi / 3};
    if (no_bc) return {0.0, pi / 2, pi / 2};
    if (no_ca) return {pi / 2, 0.0, pi / 2};
    if (no_ab) return {pi / 2, pi / 2, 0.0};
    return {angle_between(ab, -1.0 * ca), angle_between(bc, -1.0 * ab), angle_between(ca, -1.0 * bc)};
}

void measure_faces(Surface& surface, const RunControl& control) {
    const std::size_t count = surface.faces.size();
    surface.face_geometry.resize(count);
    surface.face_angles.resize(count);
    core::parallel_for(count, grain, control, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            const auto& v = surface.faces[f];
            const Point3 &a = surface.positions[v[0]], &b = surface.positions[v[1]], &c = surface.positions[v[2]];
            surface.face_angles[f] = corner_angles(a, b, c);
            // From the corner opposite the longest side, where the cross product loses least.
            const double bc = dot(c - b, c - b), ca = dot(a - c, a - c), ab = dot(b - a, b - a);
            const Point3 twice = bc >= ca && bc >= ab ? cross(b - a, c - a)
                                 : ca >= ab           ? cross(c - b, a - b)
                                                      : cross(a - c, b - c);
            const double length = norm(twice);
            if (length > 0.0) surface.face_geometry[f] = {(1.0 / length) * twice, 0.5 * length};
        }
    });
}

void measure_hinges(Surface& surface, const RunControl& control) {
    core::parallel_for(surface.hinges.size(), grain, control, [&](std::size_t begin, std::size_t end) {
        for (std::size_t h = begin; h < end; ++h) {
            Hinge& hinge = surface.hinges[h];
            const Point3 along = surface.positions[hinge.b] - surface.positions[hinge.a];
            hinge.length = norm(along);
            const double turns = hinge.angle;
            hinge.angle = 0.0;
            if (hinge.right == no_index || !(hinge.length > 0.0)) continue;
            const Point3& n = surface.face_geometry[hinge.left].normal;
            const Point3& m = surface.face_geometry[hinge.right].normal;
            if (n == Point3{} || m == Point3{}) continue;
            hinge.angle = std::atan2(dot(cross(n, m), (1.0 / hinge.length) * along), dot(n, m)) - turns;
        }
    });
}

/// Number of fans of faces around a vertex, closed and open.
std::array<std::size_t, 2> count_fans(const Surface& surface, Index vertex, std::vector<Index>& seen) {
    const std::span<const Index> faces = surface.vertex_faces[vertex];
    std::array<std::size_t, 2> fans{};
    seen.clear();
    // Walks over the hinges at the vertex from f, leaving through the side before or after the vertex.
    const auto walk = [&](Index f, const std::array<std::size_t, 3>& turn) {
        for (const Index start = f;;) {
            const auto& face = surface.faces[f];
            const std::size_t i = face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
            f = surface.across(f, surface.face_hinges[f][turn[i]]);
            if (f == no_index) return false;
            if (f == start) return true;
            CERTA_ASSERT(seen.size() <= faces.size());
            seen.push_back(f);
        }
    };
    for (const Index f : faces) {
        if (std::find(seen.begin(), seen.end(), f) != seen.end()) continue;
        seen.push_back(f);
        if (walk(f, next)) {
            ++fans[0];
        } else {
            walk(f, previous);
            ++fans[1];
        }
    }
    return fans;
}

void measure_vertices(Surface& surface, const RunControl& control) {
    const std::size_t n = surface.positions.size();
    surface.normals.resize(n);
    surface.defects.resize(n);
    surface.angle_sums.resize(n);
    core::parallel_for(surface.used_vertices, grain, control, [&](std::size_t begin, std::size_t end) {
        std::vector<Index> seen;
        for (std::size_t v = begin; v < end; ++v) {
            Point3 sum{};
            double angles = 0.0;
            for (const Index f : surface.vertex_faces[v]) {
                const FaceGeometry& geometry = surface.face_geometry[f];
                sum = sum + geometry.area * geometry.normal;
                const auto& face = surface.faces[f];
                angles += surface.face_angles[f][face[0] == v ? 0 : face[1] == v ? 1 : 2];
                if (geometry.area == 0.0) surface.flags[v] |= vertex_flags::flat_face;
            }
            surface.normals[v] = unit_or_zero(sum);
            surface.angle_sums[v] = angles;
            const auto [closed, open] = count_fans(surface, static_cast<Index>(v), seen);
            constexpr double pi = std::numbers::pi;
            double full = pi * (2.0 * static_cast<double>(closed) + static_cast<double>(open));
            if (closed + open > 1) surface.flags[v] |= vertex_flags::non_manifold;
            // Where several sheets meet the solid decides: 4 pi - 2 pi chi(L), see link.h.
            if (closed + open > 1 && open == 0)
                full = 4.0 * pi - 2.0 * pi * link_characteristic(surface, static_cast<Index>(v));
            surface.defects[v] = full - angles;
        }
    });
}

std::size_t count_components(const Surface& surface) {
    core::UnionFind vertices(surface.used_vertices);
    std::size_t components = surface.used_vertices;
    for (const auto& face : surface.faces)
        for (const std::size_t i : next) {
            if (vertices.unite(face[i], face[next[i]])) --components;
        }
    return components;
}

Lists neighbors_of(const Surface& surface) {
    // One entry per edge and end: the wedges of one edge follow each other in the list of hinges.
    std::vector<std::uint64_t> offsets(surface.positions.size() + 1);
    const auto for_edges = [&](const auto& visit) {
        for (std::size_t h = 0; h < surface.hinges.size(); ++h) {
            const Hinge& hinge = surface.hinges[h];
            const auto [low, high] = std::minmax(hinge.a, hinge.b);
            if (h > 0 && std::minmax(surface.hinges[h - 1].a, surface.hinges[h - 1].b) == std::minmax(hinge.a, hinge.b))
                continue;
            visit(low, high);
        }
    };
    for_edges([&](Index a, Index b) { ++offsets[a + 1], ++offsets[b + 1]; });
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    Lists lists;
    lists.items.resize(offsets.back());
    std::vector<std::uint64_t> cursor(offsets.begin(), offsets.end() - 1);
    for_edges([&](Index a, Index b) {
        lists.items[cursor[a]++] = b;
        lists.items[cursor[b]++] = a;
    });
    lists.offsets = std::move(offsets);
    return lists;
}

void count(Surface& surface) {
    CurvatureStatistics& s = surface.statistics;
    s.vertices = surface.positions.size();
    s.triangles = surface.faces.size();
    for (const FaceGeometry& geometry : surface.face_geometry) s.flat_triangles += geometry.area == 0.0;
    for (const std::uint8_t flags : surface.flags) s.non_manifold_vertices += (flags & vertex_flags::non_manifold) != 0;
    s.components = count_components(surface);
    double lengths = 0.0;
    for (const Hinge& hinge : surface.hinges) lengths += hinge.length;
    s.mean_edge_length = surface.hinges.empty() ? 0.0 : lengths / static_cast<double>(surface.hinges.size());
    surface.euler_characteristic = static_cast<std::int64_t>(surface.used_vertices) -
                                   static_cast<std::int64_t>(s.edges) + static_cast<std::int64_t>(s.triangles);
}

}  // namespace

Surface build_surface(const TriangleMesh& mesh, const RunControl& control) {
    require_valid(mesh);
    Surface surface;
    sort_vertices(mesh, surface);
    sort_faces(mesh, surface);
    const std::size_t n = surface.positions.size();
    surface.flags.assign(n, 0);
    for (std::size_t v = surface.used_vertices; v < n; ++v) surface.flags[v] = vertex_flags::unused;
    surface.vertex_faces = bucket(n, surface.faces.size(), [&](std::size_t f) { return surface.faces[f]; });
    HingeBuilder hinges(surface);
    for (std::size_t v = 0; v < surface.used_vertices; ++v) hinges.add_edges_of(static_cast<Index>(v));
    surface.vertex_neighbors = neighbors_of(surface);
    measure_faces(surface, control);
    measure_hinges(surface, control);
    measure_vertices(surface, control);
    count(surface);
    return surface;
}

SymmetricTensor3 swapped_tensor(const Surface& surface, const Hinge& hinge) {
    SymmetricTensor3 swapped;
    if (!(hinge.length > 0.0)) return swapped;
    const Point3 e = (1.0 / hinge.length) * (surface.positions[hinge.b] - surface.positions[hinge.a]);
    add_outer(swapped, hinge.angle, e);
    return swapped;
}

EdgeTensors hinge_tensors(const Surface& surface, const Hinge& hinge) {
    EdgeTensors result;
    if (hinge.angle == 0.0 || !(hinge.length > 0.0)) return result;
    const Point3 e = (1.0 / hinge.length) * (surface.positions[hinge.b] - surface.positions[hinge.a]);
    add_outer(result.swapped, hinge.angle, e);
    const Point3& n = surface.face_geometry[hinge.left].normal;
    const Point3& m = surface.face_geometry[hinge.right].normal;
    // e+ along n + m, e- = e x e+, also where n - m vanishes; a fold by pi has no e+, but then both weights are equal.
    const Point3 sum = n + m;
    Point3 plus = unit_or_zero(sum - dot(sum, e) * e);
    Point3 minus = cross(e, plus);
    if (norm(sum) < 1e-7) minus = unit_or_zero(n - dot(n, e) * e), plus = cross(minus, e);
    const double b = hinge.angle, square = b * b;
    const double less =
        std::abs(b) < 1e-2 ? b * square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)) : b - std::sin(b);
    add_outer(result.plain, 0.5 * less, plus);
    add_outer(result.plain, 0.5 * (2.0 * b - less), minus);
    return result;
}

double vertex_mass(const Surface& surface, Index vertex) {
    const Point3& pole = surface.normals[vertex];
    double mass = 0.0;
    for (const Index f : surface.vertex_faces[vertex]) {
        const auto& face = surface.faces[f];
        const std::size_t i = face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
        const Index g = surface.across(f, surface.face_hinges[f][next[i]]);
        if (g == no_index) continue;
        const Point3 &n = surface.face_geometry[f].normal, &m = surface.face_geometry[g].normal;
        // Area of a spherical triangle (Van Oosterom, Strackee 1983).
        mass += 2.0 * std::abs(std::atan2(dot(pole, cross(n, m)), 1.0 + dot(pole, n) + dot(n, m) + dot(m, pole)));
    }
    return mass;
}

}  // namespace certa::curvature
