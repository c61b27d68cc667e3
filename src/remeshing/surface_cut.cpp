// Cutting triangles along a rim.
//
// Points on an edge are ordered by the numbers that their crossings own. In a triangle the rim is a set of paths from
// perimeter to perimeter that do not cross; so walking along the perimeter, and into each path that is met, traces
// cells, and a path says which of its sides is wanted. What the rim does not pass follows from its neighbours. Then the
// cells, flat polygons each, become triangles.
#include "remeshing/surface_cut.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "core/triangle_tree.h"
#include "remeshing/triangulate.h"

namespace certa::remeshing {
namespace {

enum class Side : std::uint8_t { unknown, inside, outside };

/// A part of a half-edge between points of the rim on it: the half-edge, and its number from the edge's own start.
using Part = std::pair<Index, Index>;

struct Cell {
    Index face = no_index;
    std::vector<Index> ring;
    std::vector<Part> parts;    ///< on the perimeter ...
    std::vector<Index> starts;  ///< ... and where each starts in the ring
    Side side = Side::unknown;
};

class SurfaceCutter {
public:
    SurfaceCutter(const Network& network, const Graph& graph, const CutNames& names)
        : network_(network), mesh_(network.mesh()), graph_(graph), names_(names) {}

    bool add_rim(std::span<const Index> rim) {
        for (const Index h : rim) place_nodes(h);
        for (auto& [edge, points] : on_edges_) {
            std::sort(points.begin(), points.end());
            points.erase(std::unique(points.begin(), points.end()), points.end());
            for (std::size_t i = 1; i < points.size(); ++i)
                if (points[i].first == points[i - 1].first) return false;
        }
        for (const Index h : rim) {
            if (graph_.edges[h / 2].line != no_index)
                add_line(h);
            else
                add_curve(h);
        }
        std::vector<Index> touched;
        for (const auto& [face, list] : segments_) touched.push_back(face);
        for (const auto& [edge, points] : on_edges_)
            for (const Index h : both_sides(edge)) touched.push_back(h / 3);
        for (const Part& part : rim_parts_) touched.push_back(part.first / 3);
        std::sort(touched.begin(), touched.end());
        touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
        return std::all_of(touched.begin(), touched.end(), [&](Index f) { return trace_cells(f); }) && flood();
    }
    /// From now on a rim fails that something else of the graph lies behind.
    void refuse(const std::unordered_map<Index, std::vector<double>>& crossings) { crossings_ = &crossings; }
    void add_whole(std::span<const Index> faces) { whole_.assign(faces.begin(), faces.end()); }

    RegionPatch finish() {
        for (const Cell& cell : cells_)
            if (cell.side == Side::inside) fill(cell);
        for (const Index f : whole_) triangles_.push_back({corner(f, 0), corner(f, 1), corner(f, 2)});
        add_features();
        return number_corners();
    }

private:
    std::vector<Index> both_sides(Index edge) const {
        const Index h = mesh_.edge_halfedges[edge];
        return mesh_.opposites[h] == no_index ? std::vector{h} : std::vector{h, mesh_.opposites[h]};
    }

    // Points -----------------------------------------------------------------------------------------------------
    Index add_point(std::uint64_t key, const RegionVertex& v, Index node) {
        const auto [at, is_new] = numbers_.emplace(key, static_cast<Index>(points_.size()));
        if (is_new) {
            points_.push_back(v);
            nodes_.push_back(node);
        }
        return at->second;
    }
    Index of_node(Index n) {
        const GraphNode& node = graph_.nodes[n];
        return add_point((std::uint64_t{2} << 62) | n, {node.point, node.place, node.kind, node.curve, no_index, false},
                         n);
    }
    Index of_vertex(Index v, Index face) {
        if (const auto at = node_at_vertex_.find(v); at != node_at_vertex_.end()) return of_node(at->second);
        RegionVertex vertex;
        vertex.point = mesh_.points[v];
        vertex.place.face = face;
        for (Index i = 0; i < 3; ++i) vertex.place.weights[i] = mesh_.faces[face][i] == v ? 1.0 : 0.0;
        vertex.kind = mesh_.is_corner[v] ? VertexKind::corner : VertexKind::smooth;
        vertex.source = v;
        return add_point(v, vertex, no_index);
    }
    Index corner(Index face, Index i) { return of_vertex(mesh_.faces[face][i], face); }
    Index of_crossing(Index c, Index face) {
        if (const auto at = node_at_crossing_.find(c); at != node_at_crossing_.end()) return of_node(at->second);
        const Crossing& crossing = network_.crossing(c);
        if (crossing.vertex != no_index) return of_vertex(crossing.vertex, face);
        RegionVertex vertex;
        vertex.point = network_.point(c);
        Index h = 3 * face;
        while (mesh_.edges[h] != crossing.edge) ++h;
        vertex.place.face = face;
        const double t = mesh_.along(h) ? crossing.t : 1.0 - crossing.t;
        vertex.place.weights = {0.0, 0.0, 0.0};
        vertex.place.weights[h % 3] = 1.0 - t, vertex.place.weights[next_of(h) % 3] = t;
        vertex.on_minor_edge = names_.is_minor[crossing.edge] != 0;
        return add_point((std::uint64_t{1} << 62) | c, vertex, no_index);
    }

    // The rim ----------------------------------------------------------------------------------------------------
    /// Nodes that lie on edges or at vertices of the work mesh.
    void place_nodes(Index h) {
        const GraphEdge& e = graph_.edges[h / 2];
        for (const auto& [node, at] : {std::pair{e.a, e.from}, std::pair{e.b, e.to}}) {
            const auto k = static_cast<std::size_t>(at);
            const double part = at - static_cast<double>(k);
            if (e.line != no_index) {
                const Line& line = network_.lines()[e.line];
                if (part != 0.0) continue;
                const Index c = line.crossings[k % line.crossings.size()];
                const Crossing& crossing = network_.crossing(c);
                if (crossing.vertex != no_index) {
                    node_at_vertex_[crossing.vertex] = node;
                } else {
                    node_at_crossing_[c] = node;
                    put_on_edge(crossing.edge, crossing.t, of_node(node));
                }
            } else {
                const FeatureCurve& curve = mesh_.curves[e.curve];
                if (part == 0.0) {
                    node_at_vertex_[curve.vertices[k % curve.vertices.size()]] = node;
                } else {
                    const Index edge = curve.edges[k % curve.edges.size()];
                    const bool along =
                        mesh_.start_of(mesh_.edge_halfedges[edge]) == curve.vertices[k % curve.vertices.size()];
                    put_on_edge(edge, along ? part : 1.0 - part, of_node(node));
                }
            }
        }
        if (e.line == no_index) return;
        const Line& line = network_.lines()[e.line];
        for (double k = std::floor(e.from) + 1.0; k < e.to; k += 1.0) {
            const Index c = line.crossings[static_cast<std::size_t>(k) % line.crossings.size()];
            const Crossing& crossing = network_.crossing(c);
            put_on_edge(crossing.edge, crossing.t, of_crossing(c, mesh_.edge_halfedges[crossing.edge] / 3));
        }
    }
    void put_on_edge(Index edge, double t, Index point) {
        auto& list = on_edges_[edge];
        if (std::none_of(list.begin(), list.end(), [&](const auto& entry) { return entry.second == point; }))
            list.push_back({t, point});
    }

    void add_line(Index h) {
        const GraphEdge& e = graph_.edges[h / 2];
        const Line& line = network_.lines()[e.line];
        std::vector<Index> corners{of_node(e.a)}, faces;
        for (double k = std::floor(e.from); k < e.to; k += 1.0)
            faces.push_back(line.faces[static_cast<std::size_t>(k) % line.faces.size()]);
        std::size_t at = 0;
        for (double k = std::floor(e.from) + 1.0; k < e.to; k += 1.0)
            corners.push_back(
                of_crossing(line.crossings[static_cast<std::size_t>(k) % line.crossings.size()], faces[at++]));
        corners.push_back(of_node(e.b));
        const bool forward = h % 2 == 0;
        for (std::size_t i = 0; i < faces.size(); ++i)
            segments_[faces[i]].push_back(forward ? std::array{corners[i], corners[i + 1]}
                                                  : std::array{corners[i + 1], corners[i]});
        if (!forward) std::reverse(corners.begin(), corners.end());
        sides_.push_back({std::move(corners), no_index});
    }
    void add_curve(Index h) {
        const GraphEdge& e = graph_.edges[h / 2];
        const FeatureCurve& curve = mesh_.curves[e.curve];
        const bool forward = h % 2 == 0;
        std::vector<Index> corners{of_node(e.a)};
        for (double k = std::floor(e.from) + 1.0; k < e.to; k += 1.0) {
            const Index edge = curve.edges[static_cast<std::size_t>(k) % curve.edges.size()];
            corners.push_back(of_vertex(curve.vertices[static_cast<std::size_t>(k) % curve.vertices.size()],
                                        mesh_.edge_halfedges[edge] / 3));
        }
        corners.push_back(of_node(e.b));
        for (double k = std::floor(e.from); k < e.to; k += 1.0) {
            const auto i = static_cast<std::size_t>(k) % curve.edges.size();
            const Index edge = curve.edges[i], first = mesh_.edge_halfedges[edge];
            const bool along = mesh_.start_of(first) == curve.vertices[i];
            // The part that starts at or before the piece.
            const double t = 0.5 * (std::max(e.from - k, 0.0) + std::min(e.to - k, 1.0));
            Index number = 0;
            if (const auto points = on_edges_.find(edge); points != on_edges_.end())
                for (const auto& [place, point] : points->second) number += place < (along ? t : 1.0 - t) ? 1 : 0;
            const Index inner = along == forward ? first : mesh_.opposites[first];
            for (const Index side : both_sides(edge)) {
                rim_parts_.insert({side, number});
                if (side == inner) inner_parts_.insert({side, number});
            }
        }
        if (!forward) std::reverse(corners.begin(), corners.end());
        sides_.push_back({std::move(corners), e.curve});
    }

    // Cells ------------------------------------------------------------------------------------------------------
    struct Perimeter {
        std::vector<Index> points;
        std::vector<Part> parts;  ///< behind each point
    };
    Perimeter walk_perimeter(Index face) {
        Perimeter out;
        for (Index i = 0; i < 3; ++i) {
            const Index h = 3 * face + i;
            const auto found = on_edges_.find(mesh_.edges[h]);
            const std::size_t count = found == on_edges_.end() ? 0 : found->second.size();
            out.points.push_back(corner(face, i));
            for (std::size_t k = 0; k < count; ++k)
                out.points.push_back(found->second[mesh_.along(h) ? k : count - 1 - k].second);
            for (std::size_t k = 0; k <= count; ++k)
                out.parts.push_back({h, static_cast<Index>(mesh_.along(h) ? k : count - k)});
        }
        return out;
    }

    bool trace_cells(Index face) {
        const Perimeter rim = walk_perimeter(face);
        std::unordered_map<Index, std::size_t> place;
        for (std::size_t i = 0; i < rim.points.size(); ++i)
            if (!place.emplace(rim.points[i], i).second) return false;
        std::unordered_map<Index, Index> next, previous;
        if (const auto found = segments_.find(face); found != segments_.end())
            for (const auto& [a, b] : found->second)
                if (!next.emplace(a, b).second || !previous.emplace(b, a).second) return false;
        std::unordered_set<Index> used;
        const std::size_t first_cell = cells_.size();
        std::vector<bool> seen(rim.points.size(), false);
        for (std::size_t start = 0; start < seen.size(); ++start) {
            if (seen[start]) continue;
            Cell cell;
            cell.face = face;
            bool is_in = false, is_out = false;
            std::size_t at = start;
            do {
                if (seen[at]) return false;
                seen[at] = true;
                cell.starts.push_back(static_cast<Index>(cell.ring.size()));
                cell.ring.push_back(rim.points[at]);
                cell.parts.push_back(rim.parts[at]);
                at = (at + 1) % rim.points.size();
                const Index w = rim.points[at];
                const bool out = next.contains(w), in = previous.contains(w);
                if (out && in) return false;
                if (!out && !in) continue;
                (out ? is_in : is_out) = true;
                const auto& step = out ? next : previous;
                Index p = w;
                for (bool first = true; first || !place.contains(p); first = false) {
                    cell.ring.push_back(p);
                    const auto to = step.find(p);
                    if (to == step.end()) return false;
                    if (out) used.insert(p);
                    p = to->second;
                    if (cell.ring.size() > rim.points.size() + 2 * next.size() + 2) return false;
                }
                at = place[p];
            } while (at != start);
            for (const Part& part : cell.parts)
                if (rim_parts_.contains(part)) (inner_parts_.contains(part) ? is_in : is_out) = true;
            if (is_in && is_out) return false;
            cell.side = is_in ? Side::inside : is_out ? Side::outside : Side::unknown;
            cells_.push_back(std::move(cell));
        }
        if (used.size() < next.size() && !add_islands(face, next, used, first_cell)) return false;
        for (std::size_t c = first_cell; c < cells_.size(); ++c)
            for (const Part& part : cells_[c].parts) cell_at_[part] = static_cast<Index>(c);
        cut_faces_.insert(face);
        return true;
    }

    /// Rims within one triangle: around something wanted, or nothing can be done.
    bool add_islands(Index face, const std::unordered_map<Index, Index>& next, std::unordered_set<Index>& used,
                     std::size_t first_cell) {
        for (std::size_t c = first_cell; c < cells_.size(); ++c)
            if (cells_[c].side == Side::inside) return false;
        std::vector<Index> starts;
        for (const auto& [a, b] : next)
            if (!used.contains(a)) starts.push_back(a);
        std::sort(starts.begin(), starts.end());
        for (const Index start : starts) {
            if (used.contains(start)) continue;
            Cell cell;
            cell.face = face;
            cell.side = Side::inside;
            for (Index p = start; used.insert(p).second;) {
                cell.ring.push_back(p);
                const auto to = next.find(p);
                if (to == next.end()) return false;
                p = to->second;
            }
            Complex before = in_plane(face, cell.ring.back());
            double area = 0.0;
            for (const Index p : cell.ring) {
                const Complex z = in_plane(face, p);
                area += before.real() * z.imag() - before.imag() * z.real();
                before = z;
            }
            if (!(area > 0.0)) return false;
            cells_.push_back(std::move(cell));
        }
        return true;
    }
    Complex in_plane(Index face, Index point) const {
        const SurfacePlace& place = points_[point].place;
        if (place.face != face) return 0.0;
        return place.weights[1] * mesh_.local(face, 1) + place.weights[2] * mesh_.local(face, 2);
    }

    /// Whether a crease or a line of the graph is there.
    bool is_passed(const Part& part) const {
        if (mesh_.is_feature(part.first)) return true;
        const auto passing = crossings_->find(mesh_.edges[part.first]);
        if (passing == crossings_->end()) return false;
        double low = -1.0, high = 2.0;
        if (const auto found = on_edges_.find(passing->first); found != on_edges_.end()) {
            const auto& points = found->second;
            if (part.second > 0) low = points[part.second - 1].first;
            if (part.second < points.size()) high = points[part.second].first;
        }
        return std::any_of(passing->second.begin(), passing->second.end(),
                           [&](double t) { return t > low && t < high; });
    }
    bool flood() {
        std::vector<Index> cells;
        std::unordered_set<Index> seen;
        for (Index c = 0; c < cells_.size(); ++c)
            if (cells_[c].side == Side::inside) cells.push_back(c);
        const auto enter = [&](const Part& part) {
            if (rim_parts_.contains(part)) return true;
            if (crossings_ != nullptr && is_passed(part)) return false;
            const Index h = mesh_.opposites[part.first];
            if (h == no_index) return true;
            if (!cut_faces_.contains(h / 3)) {
                if (seen.insert(h / 3).second) whole_.push_back(h / 3);
                return true;
            }
            const auto found = cell_at_.find({h, part.second});
            if (found == cell_at_.end()) return false;
            Cell& cell = cells_[found->second];
            if (cell.side == Side::outside) return false;
            if (cell.side == Side::unknown) {
                cell.side = Side::inside;
                cells.push_back(found->second);
            }
            return true;
        };
        for (std::size_t c = 0, f = 0; c < cells.size() || f < whole_.size();) {
            if (c < cells.size()) {
                const std::vector<Part> parts = cells_[cells[c++]].parts;
                if (!std::all_of(parts.begin(), parts.end(), enter)) return false;
            } else {
                const Index face = whole_[f++];
                for (Index h = 3 * face; h < 3 * face + 3; ++h)
                    if (!enter({h, 0})) return false;
            }
        }
        return true;
    }

    // Triangles --------------------------------------------------------------------------------------------------
    void fill(const Cell& cell) {
        flat_.clear();
        ring_.clear();
        for (const Index p : cell.ring) {
            ring_.push_back(static_cast<Index>(flat_.size()));
            flat_.push_back(points_[p].point);
        }
        filled_.clear();
        const core::TriangleTree none({}, {});
        triangulate_polygon(flat_, ring_, none, filled_);
        for (const auto& t : filled_) triangles_.push_back({cell.ring[t[0]], cell.ring[t[1]], cell.ring[t[2]]});
    }

    /// Parts of creases between pieces that are kept.
    void add_features() {
        const auto add = [&](Index a, Index b, Index h) {
            const Index edge = mesh_.edges[h], curve = mesh_.edge_curves[edge];
            if (curve != no_index) features_.push_back({std::min(a, b), std::max(a, b), curve});
            if (names_.is_minor[edge] != 0) minors_.push_back({std::min(a, b), std::max(a, b)});
        };
        for (const Cell& cell : cells_) {
            if (cell.side != Side::inside) continue;
            for (std::size_t k = 0; k < cell.parts.size(); ++k) {
                const std::size_t i = cell.starts[k];
                if (!rim_parts_.contains(cell.parts[k]))
                    add(cell.ring[i], cell.ring[(i + 1) % cell.ring.size()], cell.parts[k].first);
            }
        }
        for (const Index f : whole_)
            for (Index i = 0; i < 3; ++i) add(corner(f, i), corner(f, (i + 1) % 3), 3 * f + i);
        std::sort(features_.begin(), features_.end());
        features_.erase(std::unique(features_.begin(), features_.end()), features_.end());
        std::sort(minors_.begin(), minors_.end());
        minors_.erase(std::unique(minors_.begin(), minors_.end()), minors_.end());
        for (const auto& [a, b, curve] : features_) {
            const VertexKind kind = mesh_.curves[curve].boundary ? VertexKind::boundary : VertexKind::crease;
            for (const Index v : {a, b}) {
                points_[v].curve = curve;
                if (points_[v].kind == VertexKind::smooth) points_[v].kind = kind;
            }
        }
    }
    /// Sides between nodes with one vertex go on to the next: the node that was merged is a corner of its own no more.
    void join_contracted_sides() {
        for (std::size_t i = 0; i < sides_.size();) {
            const Index front = sides_[i].corners.front(), back = sides_[i].corners.back();
            const bool joins_next = names_.is_merged[nodes_[back]] != 0;
            const Index shared = joins_next ? back : front;
            const auto other = std::find_if(sides_.begin(), sides_.end(), [&](const RegionSide& side) {
                return (joins_next ? side.corners.front() : side.corners.back()) == shared;
            });
            const bool is_contracted = names_.vertices[nodes_[front]] == names_.vertices[nodes_[back]];
            if (!is_contracted || sides_.size() < 3 || other == sides_.end() || names_.is_merged[nodes_[shared]] == 0) {
                ++i;
                continue;
            }
            RegionSide &first = joins_next ? sides_[i] : *other, &second = joins_next ? *other : sides_[i];
            if (first.curve != second.curve) first.curve = no_index;
            first.corners.insert(first.corners.end(), second.corners.begin() + 1, second.corners.end());
            sides_.erase(sides_.begin() + (&second - sides_.data()));
            i = 0;
        }
    }
    RegionPatch number_corners() {
        join_contracted_sides();
        RegionPatch patch;
        std::vector<std::uint8_t> is_used(points_.size(), 0);
        for (const auto& t : triangles_)
            for (const Index v : t) is_used[v] = 1;
        std::vector<Index> numbers(points_.size(), no_index);
        for (const RegionSide& side : sides_) {
            const Index v = side.corners.front();
            numbers[v] = static_cast<Index>(patch.outer.size());
            patch.outer.push_back(names_.vertices[nodes_[v]]);
        }
        for (Index v = 0; v < points_.size(); ++v)
            if (is_used[v] != 0 && numbers[v] == no_index) {
                numbers[v] = static_cast<Index>(patch.outer.size() + patch.inner.size());
                patch.inner.push_back(points_[v]);
            }
        for (const auto& t : triangles_) patch.triangles.push_back({numbers[t[0]], numbers[t[1]], numbers[t[2]]});
        for (const auto& [a, b, curve] : features_) patch.feature_edges.push_back({numbers[a], numbers[b], curve});
        for (const auto& [a, b] : minors_) patch.minor_edges.push_back({numbers[a], numbers[b]});
        for (RegionSide& side : sides_) {
            for (Index& v : side.corners) {
                if (side.curve != no_index && numbers[v] >= patch.outer.size()) {
                    RegionVertex& vertex = patch.inner[numbers[v] - patch.outer.size()];
                    vertex.curve = side.curve;
                    if (vertex.kind == VertexKind::smooth)
                        vertex.kind = mesh_.curves[side.curve].boundary ? VertexKind::boundary : VertexKind::crease;
                }
                v = numbers[v];
            }
            patch.sides.push_back(std::move(side));
        }
        return patch;
    }

    const Network& network_;
    const WorkMesh& mesh_;
    const Graph& graph_;
    const CutNames& names_;
    const std::unordered_map<Index, std::vector<double>>* crossings_ = nullptr;  ///< of lines, where none may be inside

    std::unordered_map<std::uint64_t, Index> numbers_;
    std::vector<RegionVertex> points_;
    std::vector<Index> nodes_;  ///< per point: of the graph
    std::unordered_map<Index, Index> node_at_vertex_, node_at_crossing_;
    std::map<Index, std::vector<std::pair<double, Index>>> on_edges_;  ///< by place
    std::map<Index, std::vector<std::array<Index, 2>>> segments_;      ///< per face, with the region on the left
    std::set<Part> rim_parts_;                                         ///< on creases
    std::set<Part> inner_parts_;                                       ///< those with the region on the left
    std::vector<RegionSide> sides_;
    std::vector<Cell> cells_;
    std::map<Part, Index> cell_at_;
    std::unordered_set<Index> cut_faces_;
    std::vector<Index> whole_;  ///< faces inside that the rim does not touch
    std::vector<std::array<Index, 3>> triangles_;
    std::vector<std::array<Index, 3>> features_;
    std::vector<std::array<Index, 2>> minors_;
    std::vector<Point3> flat_;
    std::vector<Index> ring_;
    std::vector<std::array<Index, 3>> filled_;
};

}  // namespace

std::optional<RegionPatch> cut_surface(const Network& network, const Graph& graph, std::span<const Index> rim,
                                       std::span<const Index> whole, const CutNames& names) {
    SurfaceCutter cutter(network, graph, names);
    cutter.add_whole(whole);
    if (!rim.empty() && !cutter.add_rim(rim)) return std::nullopt;
    return cutter.finish();
}

DiskTest::DiskTest(const Network& network, const Graph& graph) : network_(network), graph_(graph) {
    names_.vertices.resize(graph.nodes.size());
    std::iota(names_.vertices.begin(), names_.vertices.end(), Index{0});
    names_.is_merged.assign(graph.nodes.size(), 0);
    names_.is_minor.assign(network.mesh().edge_halfedges.size(), 0);
    for (const GraphEdge& e : graph.edges) {
        if (!e.alive() || e.line == no_index) continue;
        const Line& line = network.lines()[e.line];
        for (double k = std::floor(e.from) + 1.0; k < e.to; k += 1.0) {
            const Crossing& c = network.crossing(line.crossings[static_cast<std::size_t>(k) % line.crossings.size()]);
            if (c.vertex == no_index) crossings_[c.edge].push_back(c.t);
        }
    }
}

bool DiskTest::operator()(std::span<const Index> rim) const {
    SurfaceCutter cutter(network_, graph_, names_);
    cutter.refuse(crossings_);
    return cutter.add_rim(rim) && characteristic_of(cutter.finish()) == 1;
}

}  // namespace certa::remeshing
