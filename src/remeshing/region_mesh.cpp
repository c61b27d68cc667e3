// Pieces of triangles on the right side of a border.
//
// A point of a face is inside if the way to a point that is known to be inside meets the border an even number of
// times, as seen from every point that is known in that face. Points near the border count as on it: what is kept has
// some room around it, so that rounding decides nothing.
#include "remeshing/region_mesh.h"

#include <algorithm>
#include <cmath>

namespace certa::remeshing {
namespace {

double wedge(const Complex& x, const Complex& y) { return x.real() * y.imag() - x.imag() * y.real(); }

bool do_cross(const Complex& a, const Complex& b, const Complex& c, const Complex& d) {
    const double sc = wedge(b - a, c - a), sd = wedge(b - a, d - a), sa = wedge(d - c, a - c), sb = wedge(d - c, b - c);
    return (sc > 0.0) != (sd > 0.0) && (sa > 0.0) != (sb > 0.0);
}

double distance_to(const Complex& p, const Complex& a, const Complex& b) {
    const Complex d = b - a, e = p - a;
    const double length = std::norm(d);
    const double t = length > 0.0 ? std::clamp((e * std::conj(d)).real() / length, 0.0, 1.0) : 0.0;
    return std::abs(e - t * d);
}

enum State : std::uint8_t { unknown, inside, outside, border };

class Cutter {
public:
    Cutter(const WorkMesh& mesh, const std::vector<BorderPiece>& pieces, const std::vector<Reference>& references,
           Index count)
        : mesh_(mesh), pieces_(pieces), references_(references), count_(count) {}

    RegionMesh cut(const std::vector<Index>& faces) {
        for (const Index f : faces) add_face(f);
        for (const auto& [face, corners] : candidates_) {
            const auto& [a, b, c] = corners;
            if (states_[a] == inside && states_[b] == inside && states_[c] == inside && !is_crossed(face, corners))
                out_.triangles.push_back(corners);
        }
        add_features();
        drop_unused();
        return std::move(out_);
    }

private:
    template <class Entry>
    std::pair<std::size_t, std::size_t> range(const std::vector<Entry>& list, Index face) const {
        const auto begin =
            std::lower_bound(list.begin(), list.end(), face, [](const Entry& e, Index f) { return e.face < f; });
        auto end = begin;
        while (end != list.end() && end->face == face) ++end;
        return {static_cast<std::size_t>(begin - list.begin()), static_cast<std::size_t>(end - list.begin())};
    }
    Complex plane(Index f, Index i, Index j) const {
        const double s = static_cast<double>(count_);
        return (i / s) * mesh_.local(f, 1) + (j / s) * mesh_.local(f, 2);
    }

    /// The vertex at step i towards corner 1 and j towards corner 2 of a face.
    Index vertex(Index f, Index i, Index j) {
        const Index s = count_, k = s - i - j;
        std::uint64_t key = 0;
        Index source = no_index, edge = no_index;
        double t = 0.0;
        if (i == s || j == s || k == s) {
            source = mesh_.faces[f][i == s ? 1 : j == s ? 2 : 0];
            key = source;
        } else if (i == 0 || j == 0 || k == 0) {
            const Index h = 3 * f + (j == 0 ? 0 : k == 0 ? 1 : 2);
            const Index step = j == 0 ? i : k == 0 ? j : k;  // from the start of h
            const Index along = mesh_.along(h) ? step : s - step;
            edge = mesh_.edges[h];
            t = static_cast<double>(along) / s;
            key = (std::uint64_t{1} << 62) | (std::uint64_t{edge} << 8) | along;
        } else {
            key = (std::uint64_t{2} << 62) | (std::uint64_t{f} << 16) | (i << 8) | j;
        }
        const auto [at, is_new] = numbers_.emplace(key, static_cast<Index>(out_.vertices.size()));
        if (!is_new) return at->second;
        RegionVertex v;
        v.source = source;
        v.place = {f, {static_cast<double>(k) / s, static_cast<double>(i) / s, static_cast<double>(j) / s}};
        const auto& c = mesh_.faces[f];
        v.point = source != no_index ? mesh_.points[source]
                  : edge != no_index
                      ? mesh_.point_on(edge, t)
                      : v.place.weights[0] * mesh_.points[c[0]] + v.place.weights[1] * mesh_.points[c[1]] +
                            v.place.weights[2] * mesh_.points[c[2]];
        if (edge != no_index && mesh_.edge_curves[edge] != no_index) v.curve = mesh_.edge_curves[edge];
        if (v.curve != no_index) v.kind = mesh_.curves[v.curve].boundary ? VertexKind::boundary : VertexKind::crease;
        if (source != no_index && mesh_.is_corner[source]) v.kind = VertexKind::corner;
        out_.vertices.push_back(v);
        states_.push_back(unknown);
        return at->second;
    }

    State state_at(Index f, const Complex& p, double margin) const {
        if (pieces_.empty() && references_.empty()) return inside;
        const auto [first, last] = range(pieces_, f);
        for (std::size_t k = first; k < last; ++k)
            if (distance_to(p, pieces_[k].a, pieces_[k].b) < margin) return border;
        const auto [begin, end] = range(references_, f);
        const Complex middle = (mesh_.local(f, 1) + mesh_.local(f, 2)) / 3.0;
        constexpr double inwards = 1e-4;
        State state = unknown;
        for (std::size_t r = begin; r < end; ++r) {
            const Complex a = p + inwards * (middle - p),
                          b = references_[r].place + inwards * (middle - references_[r].place);
            bool is_inside = references_[r].is_inside;
            for (std::size_t k = first; k < last; ++k)
                if (do_cross(a, b, pieces_[k].a, pieces_[k].b)) is_inside = !is_inside;
            const State here = is_inside ? inside : outside;
            if (state != unknown && state != here) return border;
            state = here;
        }
        return state == unknown ? border : state;
    }

    void add_face(Index f) {
        const Index s = count_;
        const double longest = std::max({mesh_.lengths[mesh_.edges[3 * f]], mesh_.lengths[mesh_.edges[3 * f + 1]],
                                         mesh_.lengths[mesh_.edges[3 * f + 2]]});
        const double height = mesh_.local(f, 1).real() * mesh_.local(f, 2).imag() / longest;
        const double margin = 0.2 * height / s;
        for (Index i = 0; i <= s; ++i)
            for (Index j = 0; i + j <= s; ++j) {
                const Index v = vertex(f, i, j);
                const State here = state_at(f, plane(f, i, j), margin);
                states_[v] = states_[v] == unknown || states_[v] == here ? here : border;
            }
        for (Index i = 0; i < s; ++i)
            for (Index j = 0; i + j < s; ++j) {
                candidates_.push_back({f, {vertex(f, i, j), vertex(f, i + 1, j), vertex(f, i, j + 1)}});
                if (i + j + 1 < s)
                    candidates_.push_back({f, {vertex(f, i + 1, j), vertex(f, i + 1, j + 1), vertex(f, i, j + 1)}});
            }
    }

    /// Whether the border passes between corners that are all inside.
    bool is_crossed(Index f, const std::array<Index, 3>& corners) const {
        const auto [first, last] = range(pieces_, f);
        std::array<Complex, 3> p{};
        for (std::size_t i = 0; i < 3; ++i) {
            const RegionVertex& v = out_.vertices[corners[i]];
            p[i] = place_in(f, v);
        }
        for (std::size_t k = first; k < last; ++k) {
            for (std::size_t i = 0; i < 3; ++i)
                if (do_cross(p[i], p[(i + 1) % 3], pieces_[k].a, pieces_[k].b)) return true;
            const Complex& a = pieces_[k].a;
            if (wedge(p[1] - p[0], a - p[0]) > 0.0 && wedge(p[2] - p[1], a - p[1]) > 0.0 &&
                wedge(p[0] - p[2], a - p[2]) > 0.0)
                return true;
        }
        return false;
    }
    /// In the plane of f, which may not be the face that the vertex was first met in.
    Complex place_in(Index f, const RegionVertex& v) const {
        Complex sum = 0.0;
        for (Index i = 0; i < 3; ++i) {
            const double w = v.place.weights[i];
            if (w == 0.0) continue;
            const Index corner = mesh_.faces[v.place.face][i];
            for (Index k = 0; k < 3; ++k)
                if (mesh_.faces[f][k] == corner) sum += w * mesh_.local(f, k);
        }
        return sum;
    }

    void add_features() {
        std::vector<std::array<Index, 2>> kept;
        for (const auto& t : out_.triangles)
            for (std::size_t i = 0; i < 3; ++i)
                kept.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
        std::sort(kept.begin(), kept.end());
        std::vector<Index> edges;
        for (const auto& [f, corners] : candidates_)
            for (Index h = 3 * f; h < 3 * f + 3; ++h)
                if (mesh_.is_feature(h)) edges.push_back(mesh_.edges[h]);
        std::sort(edges.begin(), edges.end());
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
        for (const Index e : edges) {
            const Index h = mesh_.edge_halfedges[e], f = h / 3, i = h % 3;
            const auto at = [&](Index step) -> Index {  // along the edge
                const std::uint64_t key = step == 0        ? mesh_.faces[f][i]
                                          : step == count_ ? mesh_.end_of(h)
                                                           : (std::uint64_t{1} << 62) | (std::uint64_t{e} << 8) | step;
                const auto found = numbers_.find(key);
                return found == numbers_.end() ? no_index : found->second;
            };
            for (Index step = 0; step < count_; ++step) {
                const Index a = at(step), b = at(step + 1);
                if (a == no_index || b == no_index) continue;
                if (std::binary_search(kept.begin(), kept.end(), std::array{std::min(a, b), std::max(a, b)}))
                    out_.feature_edges.push_back({a, b, mesh_.edge_curves[e]});
            }
        }
        for (const FeatureEdge& e : out_.feature_edges)
            for (const Index v : {e.a, e.b}) {
                RegionVertex& vertex = out_.vertices[v];
                vertex.curve = e.curve;
                if (vertex.kind == VertexKind::smooth)
                    vertex.kind = mesh_.curves[e.curve].boundary ? VertexKind::boundary : VertexKind::crease;
            }
    }

    void drop_unused() {
        std::vector<Index> renamed(out_.vertices.size(), no_index);
        std::vector<RegionVertex> used;
        for (auto& t : out_.triangles)
            for (Index& v : t) {
                if (renamed[v] == no_index) {
                    renamed[v] = static_cast<Index>(used.size());
                    used.push_back(out_.vertices[v]);
                }
                v = renamed[v];
            }
        for (FeatureEdge& e : out_.feature_edges) e.a = renamed[e.a], e.b = renamed[e.b];
        out_.vertices = std::move(used);
    }

    const WorkMesh& mesh_;
    const std::vector<BorderPiece>& pieces_;
    const std::vector<Reference>& references_;
    const Index count_;
    RegionMesh out_;
    std::vector<State> states_;
    std::unordered_map<std::uint64_t, Index> numbers_;
    std::vector<std::pair<Index, std::array<Index, 3>>> candidates_;
};

}  // namespace

RegionMesh cut_region(const WorkMesh& mesh, const std::vector<Index>& faces, const std::vector<BorderPiece>& border,
                      const std::vector<Reference>& references, Index pieces) {
    return Cutter(mesh, border, references, pieces).cut(faces);
}

std::vector<std::array<Index, 2>> RegionMesh::open_sides() const {
    std::vector<std::array<Index, 2>> sides, open;
    for (const auto& t : triangles)
        for (std::size_t i = 0; i < 3; ++i) sides.push_back({t[i], t[(i + 1) % 3]});
    std::sort(sides.begin(), sides.end());
    for (const auto& [a, b] : sides)
        if (!std::binary_search(sides.begin(), sides.end(), std::array{b, a})) open.push_back({a, b});
    return open;
}

std::int64_t RegionMesh::characteristic() const {
    std::size_t open = open_sides().size();
    const std::size_t edges = (3 * triangles.size() + open) / 2;
    return static_cast<std::int64_t>(vertices.size() + triangles.size()) - static_cast<std::int64_t>(edges);
}

bool RegionMesh::keep_largest_part() {
    for (int round = 0; round < 16 && !triangles.empty(); ++round) {
        // Parts that share sides.
        std::vector<std::array<Index, 3>> sides;
        for (Index t = 0; t < triangles.size(); ++t)
            for (std::size_t i = 0; i < 3; ++i) {
                const Index a = triangles[t][i], b = triangles[t][(i + 1) % 3];
                sides.push_back({std::min(a, b), std::max(a, b), t});
            }
        std::sort(sides.begin(), sides.end());
        std::vector<std::vector<Index>> neighbours(triangles.size());
        for (std::size_t k = 1; k < sides.size(); ++k)
            if (sides[k][0] == sides[k - 1][0] && sides[k][1] == sides[k - 1][1]) {
                neighbours[sides[k][2]].push_back(sides[k - 1][2]);
                neighbours[sides[k - 1][2]].push_back(sides[k][2]);
            }
        std::vector<std::uint8_t> seen(triangles.size(), 0);
        std::vector<Index> best, part;
        for (Index seed = 0; seed < triangles.size(); ++seed) {
            if (seen[seed] != 0) continue;
            part.assign(1, seed);
            seen[seed] = 1;
            for (std::size_t at = 0; at < part.size(); ++at)
                for (const Index n : neighbours[part[at]])
                    if (seen[n] == 0) seen[n] = 1, part.push_back(n);
            if (part.size() > best.size()) best.swap(part);
        }
        std::sort(best.begin(), best.end());
        std::vector<std::array<Index, 3>> kept;
        for (const Index t : best) kept.push_back(triangles[t]);
        triangles = std::move(kept);
        std::vector<Index> starts, pinched;
        for (const auto& [a, b] : open_sides()) starts.push_back(a);
        std::sort(starts.begin(), starts.end());
        for (std::size_t k = 1; k < starts.size(); ++k)
            if (starts[k] == starts[k - 1]) pinched.push_back(starts[k]);
        if (pinched.empty()) break;
        std::erase_if(triangles, [&](const std::array<Index, 3>& t) {
            return std::any_of(t.begin(), t.end(),
                               [&](Index v) { return std::binary_search(pinched.begin(), pinched.end(), v); });
        });
    }
    if (triangles.empty()) return false;
    std::vector<Index> renamed(vertices.size(), no_index);
    std::vector<RegionVertex> used;
    std::vector<std::array<Index, 2>> sides;
    for (auto& t : triangles)
        for (Index& v : t) {
            if (renamed[v] == no_index) {
                renamed[v] = static_cast<Index>(used.size());
                used.push_back(vertices[v]);
            }
            v = renamed[v];
        }
    vertices = std::move(used);
    for (const auto& t : triangles)
        for (std::size_t i = 0; i < 3; ++i)
            sides.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
    std::sort(sides.begin(), sides.end());
    for (FeatureEdge& e : feature_edges) e.a = renamed[e.a], e.b = renamed[e.b];
    std::erase_if(feature_edges, [&](const FeatureEdge& e) {
        return e.a == no_index || e.b == no_index ||
               !std::binary_search(sides.begin(), sides.end(), std::array{std::min(e.a, e.b), std::max(e.a, e.b)});
    });
    return true;
}

}  // namespace certa::remeshing
