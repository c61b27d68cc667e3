// The combinatorial arrangement of both families and the features (thesis 4.3.1, 4.3.2; remesh, stages 8 and 9).
//
// Plan: two chords of a face cross exactly when their ends interleave on its perimeter, and along a chord the crossings
// come in the order of the others' ends, because those do not cross each other. No coordinate decides anything. Each
// line becomes a sequence of nodes, ends without a node are trimmed; features get nodes where lines end on them, at
// corners, and where they bend. Nodes know the cyclic order of their arms, so faces follow by walking.
#include "remeshing/arrangement.h"

#include <algorithm>
#include <cmath>

#include "core/assert.h"

namespace certa::remeshing {
namespace {

/// One chord of a line: its number there.
struct Piece {
    Index line = no_index, number = no_index;
};
struct Stop {
    double at = 0.0;  ///< along the line
    Index node = no_index;
};

class GraphBuilder {
public:
    GraphBuilder(const Network& network, const ArrangementRule& rule)
        : network_(network),
          mesh_(network.mesh()),
          rule_(rule),
          stops_(network.lines().size()),
          crossing_nodes_(network.crossing_count(), no_index) {}

    Graph build() {
        cross_lines();
        end_lines_on_features();
        trim();
        add_line_edges();
        add_curves();
        attach_arms();
        return std::move(graph_);
    }

private:
    void cross_lines();
    void cross_in_face(Index face, std::span<const Piece> pieces);
    Index add_crossing_node(Index face, const Piece& a, const Piece& b);
    void end_lines_on_features();
    void start_at_vertex(Index line);
    Index wedge_of(Index face, Index vertex) const {
        Index h = 3 * face;
        while (mesh_.start_of(h) != vertex) ++h;
        return mesh_.wedges[h];
    }
    void trim();
    void add_line_edges();
    void add_curves();
    void add_curve(Index curve);
    void refine(Index curve, std::vector<Stop>& stops) const;
    void attach_arms();
    void attach_at_vertex(Index vertex, Index node);

    Index from_of(const Piece& p) const { return network_.lines()[p.line].crossings[p.number]; }
    Index to_of(const Piece& p) const {
        const Line& line = network_.lines()[p.line];
        return line.crossings[(p.number + 1) % line.crossings.size()];
    }

    const Network& network_;
    const WorkMesh& mesh_;
    const ArrangementRule& rule_;
    Graph graph_;
    std::vector<std::vector<Stop>> stops_;  ///< per line
    std::vector<Index> crossing_nodes_;     ///< per crossing that ends a line on a feature
    std::vector<Index> vertex_nodes_;       ///< per vertex of the work mesh
    /// Per node of two lines: the line along_max first; whether the second line runs to the left of the first.
    struct Lines {
        std::array<Index, 2> line{no_index, no_index};
        bool second_to_left = false;
        bool into_first_half = false;  ///< on features: the line lies in the face of the edge's first half-edge
        bool starts = false;           ///< on features: the line begins here
        Index edge = no_index;         ///< on features
        Index vertex = no_index;       ///< at a vertex of the work mesh
    };
    std::vector<Lines> node_lines_;
    std::vector<std::array<Index, 4>> line_arms_;  ///< per node: forward and backward arm of line 0, of line 1
    std::vector<std::vector<std::pair<Index, Index>>> curve_arms_;  ///< per node: edge of the work mesh, half-edge
};

Complex local_point(const WorkMesh& mesh, const Network& network, Index face, Index crossing) {
    const PerimeterPlace p = network.place(crossing, face, 0);
    const Complex a = mesh.local(face, p.side), b = mesh.local(face, (p.side + 1) % 3);
    const double t = p.key < 0.0 ? 1.0 + p.key : p.key;
    return a + t * (b - a);
}

SurfacePlace place_in(const WorkMesh& mesh, Index face, const Complex& p) {
    const Complex b = mesh.local(face, 1), c = mesh.local(face, 2);
    const double w2 = std::clamp(p.imag() / c.imag(), 0.0, 1.0);
    const double w1 = std::clamp((p.real() - w2 * c.real()) / b.real(), 0.0, 1.0 - w2);
    return {face, {1.0 - w1 - w2, w1, w2}};
}

Point3 point_at(const WorkMesh& mesh, const SurfacePlace& place) {
    const auto& f = mesh.faces[place.face];
    return place.weights[0] * mesh.points[f[0]] + place.weights[1] * mesh.points[f[1]] +
           place.weights[2] * mesh.points[f[2]];
}

void GraphBuilder::cross_lines() {
    std::vector<Index> offsets(mesh_.faces.size() + 1, 0);
    for (const Line& line : network_.lines())
        for (const Index f : line.faces) ++offsets[f + 1];
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) offsets[f + 1] += offsets[f];
    std::vector<Piece> pieces(offsets.back());
    std::vector<Index> at(offsets.begin(), offsets.end() - 1);
    for (Index l = 0; l < network_.lines().size(); ++l)
        for (Index k = 0; k < network_.lines()[l].faces.size(); ++k)
            pieces[at[network_.lines()[l].faces[k]]++] = {l, k};
    for (Index f = 0; f < mesh_.face_count(); ++f)
        if (offsets[f + 1] - offsets[f] > 1)
            cross_in_face(f, std::span(pieces).subspan(offsets[f], offsets[f + 1] - offsets[f]));
    for (auto& stops : stops_)
        std::sort(stops.begin(), stops.end(), [](const Stop& a, const Stop& b) { return a.at < b.at; });
}

Index GraphBuilder::add_crossing_node(Index face, const Piece& a, const Piece& b) {
    const Complex a0 = local_point(mesh_, network_, face, from_of(a)),
                  a1 = local_point(mesh_, network_, face, to_of(a));
    const Complex b0 = local_point(mesh_, network_, face, from_of(b)),
                  b1 = local_point(mesh_, network_, face, to_of(b));
    const auto wedge = [](const Complex& x, const Complex& y) { return x.real() * y.imag() - x.imag() * y.real(); };
    const double den = wedge(a1 - a0, b1 - b0);
    double s = den != 0.0 ? wedge(b0 - a0, b1 - b0) / den : 0.5;
    if (!(s >= 0.0 && s <= 1.0)) s = s > 1.0 ? 1.0 : s < 0.0 ? 0.0 : 0.5;
    GraphNode node;
    node.place = place_in(mesh_, face, a0 + s * (a1 - a0));
    node.point = point_at(mesh_, node.place);
    graph_.nodes.push_back(std::move(node));
    return static_cast<Index>(graph_.nodes.size() - 1);
}

void GraphBuilder::cross_in_face(Index face, std::span<const Piece> pieces) {
    struct Met {
        PerimeterPlace key;
        Index node;
    };
    std::vector<std::vector<Met>> met(pieces.size());
    const auto ends = [&](const Piece& p) {
        return std::array{network_.place(from_of(p), face, 0), network_.place(to_of(p), face, 0)};
    };
    // Whether p lies on the way from a to b, counter-clockwise.
    const auto between = [](const PerimeterPlace& a, const PerimeterPlace& p, const PerimeterPlace& b) {
        return a < b ? a < p && p < b : a < p || p < b;
    };
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (network_.lines()[pieces[i].line].family != along_max) continue;
        const auto a = ends(pieces[i]);
        for (std::size_t j = 0; j < pieces.size(); ++j) {
            if (network_.lines()[pieces[j].line].family != along_min) continue;
            const auto b = ends(pieces[j]);
            const bool from_right = between(a[0], b[0], a[1]), to_right = between(a[0], b[1], a[1]);
            if (from_right == to_right) continue;
            const Index node = add_crossing_node(face, pieces[i], pieces[j]);
            node_lines_.push_back({{pieces[i].line, pieces[j].line}, from_right, false, false, no_index, no_index});
            met[i].push_back({from_right ? b[0] : b[1], node});
            const bool reversed = between(b[0], a[0], b[1]);
            met[j].push_back({reversed ? a[0] : a[1], node});
        }
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const PerimeterPlace start = ends(pieces[i])[0];
        std::sort(met[i].begin(), met[i].end(), [&](const Met& x, const Met& y) {
            const bool x_late = x.key < start, y_late = y.key < start;
            return x_late != y_late ? y_late : x.key < y.key;
        });
        const double count = static_cast<double>(met[i].size() + 1);
        for (std::size_t k = 0; k < met[i].size(); ++k)
            stops_[pieces[i].line].push_back({pieces[i].number + static_cast<double>(k + 1) / count, met[i][k].node});
    }
}

/// A line from the tip of a crease: the tip is its first node.
void GraphBuilder::start_at_vertex(Index l) {
    const Line& line = network_.lines()[l];
    const Index vertex = network_.crossing(line.crossings.front()).vertex;
    GraphNode node;
    node.kind = VertexKind::corner;
    node.point = mesh_.points[vertex];
    node.place.face = line.faces.front();
    for (Index i = 0; i < 3; ++i) {
        const Index h = 3 * node.place.face + i;
        node.place.weights[i] = mesh_.start_of(h) == vertex ? 1.0 : 0.0;
    }
    for (Index c = mesh_.wedge_first[wedge_of(node.place.face, vertex)]; c != no_index; c = mesh_.next_corner(c))
        for (const Index h : {c, previous_of(c)})
            if (mesh_.is_feature(h)) node.curve = mesh_.edge_curves[mesh_.edges[h]];
    const Index number = static_cast<Index>(graph_.nodes.size());
    graph_.nodes.push_back(std::move(node));
    vertex_nodes_[vertex] = number;
    node_lines_.push_back({});
    node_lines_.back().line[0] = l;
    node_lines_.back().vertex = vertex;
    stops_[l].insert(stops_[l].begin(), {0.0, number});
}

void GraphBuilder::end_lines_on_features() {
    vertex_nodes_.assign(mesh_.points.size(), no_index);
    for (Index l = 0; l < network_.lines().size(); ++l) {
        const Line& line = network_.lines()[l];
        if (line.faces.empty() || line.closed) continue;
        if (network_.crossing(line.crossings.front()).vertex != no_index) start_at_vertex(l);
        for (const bool start : {true, false}) {
            const Index c = start ? line.crossings.front() : line.crossings.back();
            const Index e = network_.crossing(c).edge;
            const Index curve = e == no_index ? no_index : mesh_.edge_curves[e];
            if (curve == no_index) continue;
            const Index face = start ? line.faces.front() : line.faces.back();
            GraphNode node;
            node.kind = mesh_.curves[curve].boundary ? VertexKind::boundary : VertexKind::crease;
            node.curve = curve;
            node.place = place_in(mesh_, face, local_point(mesh_, network_, face, c));
            node.point = network_.point(c);
            const Index number = static_cast<Index>(graph_.nodes.size());
            graph_.nodes.push_back(std::move(node));
            crossing_nodes_[c] = number;
            node_lines_.push_back({{l, no_index}, false, mesh_.edge_halfedges[e] / 3 == face, start, e, no_index});
            if (start)
                stops_[l].insert(stops_[l].begin(), {0.0, number});
            else
                stops_[l].push_back({static_cast<double>(line.faces.size()), number});
        }
    }
}

/// Forgets stops at the ends of lines where nothing else of the graph is left, until nothing changes.
void GraphBuilder::trim() {
    std::vector<Index> degree(graph_.nodes.size(), 0);
    struct Range {
        std::size_t first = 0, end = 0;
    };
    std::vector<Range> ranges(stops_.size());
    for (std::size_t l = 0; l < stops_.size(); ++l) {
        const auto& stops = stops_[l];
        ranges[l] = {0, stops.size()};
        const bool closed = network_.lines()[l].closed;
        if (!closed && stops.size() < 2) ranges[l].end = 0;
        for (std::size_t i = 0; i < ranges[l].end; ++i)
            degree[stops[i].node] += closed || (i > 0 && i + 1 < stops.size()) ? 2 : 1;
    }
    const auto loose = [&](Index node) { return graph_.nodes[node].curve == no_index && degree[node] < 2; };
    for (bool again = true; again;) {
        again = false;
        for (std::size_t l = 0; l < stops_.size(); ++l) {
            if (network_.lines()[l].closed) continue;
            auto& [first, end] = ranges[l];
            const auto& stops = stops_[l];
            while (end - first >= 2 && loose(stops[first].node)) {
                --degree[stops[first].node];
                --degree[stops[++first].node];
                again = true;
                if (end - first == 1) end = first;
            }
            while (end - first >= 2 && loose(stops[end - 1].node)) {
                --degree[stops[end - 1].node];
                --degree[stops[--end - 1].node];
                again = true;
                if (end - first == 1) end = first;
            }
        }
    }
    for (std::size_t l = 0; l < stops_.size(); ++l)
        stops_[l] = std::vector<Stop>(stops_[l].begin() + static_cast<std::ptrdiff_t>(ranges[l].first),
                                      stops_[l].begin() + static_cast<std::ptrdiff_t>(ranges[l].end));
}

void GraphBuilder::add_line_edges() {
    line_arms_.assign(graph_.nodes.size(), {no_index, no_index, no_index, no_index});
    for (Index l = 0; l < stops_.size(); ++l) {
        const auto& stops = stops_[l];
        const bool closed = network_.lines()[l].closed;
        if (stops.empty()) continue;
        const std::size_t count = closed ? stops.size() : stops.size() - 1;
        for (std::size_t i = 0; i < count; ++i) {
            const Stop &a = stops[i], &b = stops[(i + 1) % stops.size()];
            const Index e = static_cast<Index>(graph_.edges.size());
            const double wrap = i + 1 == stops.size() ? static_cast<double>(network_.lines()[l].faces.size()) : 0.0;
            graph_.edges.push_back({a.node, b.node, l, no_index, a.at, b.at + wrap});
            const Index slot_a = node_lines_[a.node].line[0] == l ? 0 : 2,
                        slot_b = node_lines_[b.node].line[0] == l ? 0 : 2;
            line_arms_[a.node][slot_a] = 2 * e;
            line_arms_[b.node][slot_b + 1] = 2 * e + 1;
        }
    }
}

/// Adds stops at vertices until straight sides stay close to the curve.
void GraphBuilder::refine(Index number, std::vector<Stop>& stops) const {
    const FeatureCurve& curve = mesh_.curves[number];
    const std::size_t count = curve.vertices.size();
    const auto vertex = [&](std::size_t i) { return mesh_.points[curve.vertices[i % count]]; };
    const auto place = [&](double at) {
        SurfacePlace unused;
        return point_along_curve(mesh_, number, at, unused);
    };
    std::vector<std::pair<double, double>> stack;
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) stack.push_back({stops[i].at, stops[i + 1].at});
    while (!stack.empty()) {
        const auto [from, to] = stack.back();
        stack.pop_back();
        const Point3 a = place(from), d = place(to) - a;
        const double length = dot(d, d);
        double worst = curve.boundary ? rule_.boundary_error : rule_.crease_error, where = -1.0;
        for (double i = std::floor(from) + 1.0; i < to; i += 1.0) {
            const Point3 e = vertex(static_cast<std::size_t>(i)) - a;
            const double t = length > 0.0 ? std::clamp(dot(e, d) / length, 0.0, 1.0) : 0.0;
            const double off = norm(e - t * d);
            if (off > worst) worst = off, where = i;
        }
        if (where < 0.0) continue;
        stops.push_back({where, no_index});
        stack.push_back({from, where});
        stack.push_back({where, to});
    }
    std::sort(stops.begin(), stops.end(), [](const Stop& a, const Stop& b) { return a.at < b.at; });
}

void GraphBuilder::add_curve(Index number) {
    const FeatureCurve& curve = mesh_.curves[number];
    std::vector<Stop> stops;
    const std::size_t count = curve.vertices.size();
    if (!curve.closed) stops.push_back({0.0, no_index});
    for (std::size_t k = 0; k < curve.edges.size(); ++k) {
        const Index e = curve.edges[k];
        const bool along = mesh_.start_of(mesh_.edge_halfedges[e]) == curve.vertices[k];
        std::vector<Stop> here;
        for (const Index c : network_.on_edge(e)) {
            const Index node = crossing_nodes_[c];
            if (node == no_index || line_arms_[node] == std::array{no_index, no_index, no_index, no_index}) continue;
            const double t = network_.crossing(c).t;
            here.push_back({static_cast<double>(k) + (along ? t : 1.0 - t), node});
        }
        if (!along) std::reverse(here.begin(), here.end());
        stops.insert(stops.end(), here.begin(), here.end());
    }
    const double total = static_cast<double>(curve.edges.size());
    if (curve.closed) {
        if (stops.empty()) stops.push_back({0.0, no_index});
        stops.push_back({stops.front().at + total, stops.front().node});
    } else {
        stops.push_back({total, no_index});
    }
    refine(number, stops);
    while (curve.closed && stops.size() < 4) {  // three sides at least: halve the widest gap
        std::size_t widest = 0;
        for (std::size_t i = 0; i + 1 < stops.size(); ++i)
            if (stops[i + 1].at - stops[i].at > stops[widest + 1].at - stops[widest].at) widest = i;
        const double middle = 0.5 * (stops[widest].at + stops[widest + 1].at);
        stops.insert(stops.begin() + static_cast<std::ptrdiff_t>(widest) + 1, {middle, no_index});
    }
    const VertexKind kind = curve.boundary ? VertexKind::boundary : VertexKind::crease;
    for (std::size_t i = 0; i < stops.size(); ++i) {
        Stop& stop = stops[i];
        if (curve.closed && i + 1 == stops.size()) {
            stop.node = stops.front().node;
            break;
        }
        if (stop.node != no_index) continue;
        const bool at_vertex = stop.at == std::floor(stop.at);
        const Index v = at_vertex ? curve.vertices[static_cast<std::size_t>(stop.at) % count] : no_index;
        if (v != no_index && vertex_nodes_[v] != no_index) {
            stop.node = vertex_nodes_[v];
            continue;
        }
        GraphNode node;
        node.kind = v != no_index && mesh_.is_corner[v] ? VertexKind::corner : kind;
        node.curve = number;
        node.point = point_along_curve(mesh_, number, stop.at, node.place);
        stop.node = static_cast<Index>(graph_.nodes.size());
        graph_.nodes.push_back(std::move(node));
        node_lines_.push_back({});
        node_lines_.back().vertex = v;
        node_lines_.back().edge =
            v == no_index ? curve.edges[static_cast<std::size_t>(stop.at) % curve.edges.size()] : no_index;
        line_arms_.push_back({no_index, no_index, no_index, no_index});
        if (v != no_index) vertex_nodes_[v] = stop.node;
    }
    curve_arms_.resize(graph_.nodes.size());
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
        const Stop &a = stops[i], &b = stops[i + 1];
        const Index e = static_cast<Index>(graph_.edges.size());
        graph_.edges.push_back({a.node, b.node, no_index, number, a.at, b.at});
        const std::size_t first = static_cast<std::size_t>(std::floor(a.at)) % curve.edges.size();
        const std::size_t last = static_cast<std::size_t>(std::ceil(b.at) - 1.0) % curve.edges.size();
        curve_arms_[a.node].push_back({curve.edges[first], 2 * e});
        curve_arms_[b.node].push_back({curve.edges[last], 2 * e + 1});
    }
}

void GraphBuilder::add_curves() {
    curve_arms_.resize(graph_.nodes.size());
    for (Index c = 0; c < mesh_.curves.size(); ++c) add_curve(c);
}

/// Around a corner: arms in the order of their edges.
void GraphBuilder::attach_at_vertex(Index vertex, Index node) {
    auto& arms = graph_.nodes[node].arms;
    // Any half-edge of the first arm that leaves the vertex, then clockwise to the boundary, if there is one.
    const Index e = curve_arms_[node].front().first;
    Index c = mesh_.edge_halfedges[e];
    if (mesh_.start_of(c) != vertex) c = mesh_.opposites[c] != no_index ? mesh_.opposites[c] : next_of(c);
    const Index begin = c;
    while (mesh_.opposites[c] != no_index) {
        c = next_of(mesh_.opposites[c]);
        if (c == begin) break;
    }
    const auto add = [&](Index edge) {
        for (const auto& [own, h] : curve_arms_[node])
            if (own == edge && std::find(arms.begin(), arms.end(), h) == arms.end()) {
                arms.push_back(h);
                return;
            }
    };
    const Index first = c;
    const Index line = line_arms_[node][0];
    const Index line_face = line == no_index ? no_index : network_.lines()[graph_.edges[line / 2].line].faces.front();
    do {
        add(mesh_.edges[c]);
        if (c / 3 == line_face) arms.push_back(line);
        const Index left = previous_of(c);
        if (mesh_.opposites[left] == no_index) {
            add(mesh_.edges[left]);
            break;
        }
        c = mesh_.opposites[left];
    } while (c != first);
    CERTA_ASSERT(arms.size() == curve_arms_[node].size() + (line == no_index ? 0 : 1));
}

void GraphBuilder::attach_arms() {
    for (Index n = 0; n < graph_.nodes.size(); ++n) {
        auto& arms = graph_.nodes[n].arms;
        const Lines& lines = node_lines_[n];
        const auto push = [&](Index h) {
            if (h != no_index) arms.push_back(h);
        };
        if (lines.vertex != no_index) {
            attach_at_vertex(lines.vertex, n);
        } else if (lines.edge != no_index) {
            // Along the edge's first half-edge, the face to the left, back, the face to the right.
            std::array<Index, 2> along{no_index, no_index};
            for (const auto& [edge, h] : curve_arms_[n]) {
                const GraphEdge& e = graph_.edges[h / 2];
                const FeatureCurve& curve = mesh_.curves[e.curve];
                const double at = h % 2 == 0 ? e.from : e.to;
                const std::size_t k = static_cast<std::size_t>(std::floor(at)) % curve.edges.size();
                const bool curve_along = mesh_.start_of(mesh_.edge_halfedges[lines.edge]) == curve.vertices[k];
                along[(h % 2 == 0) == curve_along ? 0 : 1] = h;
            }
            const Index line = line_arms_[n][lines.starts ? 0 : 1];
            push(along[0]);
            if (lines.into_first_half) push(line);
            push(along[1]);
            if (!lines.into_first_half) push(line);
        } else {
            const auto& a = line_arms_[n];
            push(a[0]);
            push(lines.second_to_left ? a[2] : a[3]);
            push(a[1]);
            push(lines.second_to_left ? a[3] : a[2]);
        }
    }
    for (Index n = 0; n < graph_.nodes.size(); ++n) graph_.join_at(n);
}

}  // namespace

Graph build_graph(const Network& network, const ArrangementRule& rule) { return GraphBuilder(network, rule).build(); }

Point3 point_along(const Network& network, Index number, double at, SurfacePlace& place) {
    const Line& line = network.lines()[number];
    const WorkMesh& mesh = network.mesh();
    const double count = static_cast<double>(line.faces.size());
    while (at >= count && line.closed) at -= count;
    const std::size_t k = std::min(static_cast<std::size_t>(at), line.faces.size() - 1);
    const Index face = line.faces[k];
    const Complex a = local_point(mesh, network, face, line.crossings[k]);
    const Complex b = local_point(mesh, network, face, line.crossings[(k + 1) % line.crossings.size()]);
    place = place_in(mesh, face, a + (at - static_cast<double>(k)) * (b - a));
    return point_at(mesh, place);
}

Point3 point_along_curve(const WorkMesh& mesh, Index number, double at, SurfacePlace& place) {
    const FeatureCurve& curve = mesh.curves[number];
    const std::size_t count = curve.edges.size();
    const std::size_t k = std::min(static_cast<std::size_t>(at), curve.closed ? ~std::size_t{0} : count - 1) % count;
    double t = at - std::floor(at);
    if (!curve.closed && at >= static_cast<double>(count)) t = 1.0;
    const Index e = curve.edges[k], h = mesh.edge_halfedges[e];
    if (mesh.start_of(h) != curve.vertices[k]) t = 1.0 - t;
    place.face = h / 3;
    place.weights = {0.0, 0.0, 0.0};
    place.weights[h % 3] = 1.0 - t;
    place.weights[next_of(h) % 3] = t;
    return mesh.point_on(e, t);
}

Index Graph::next(Index h) const {
    const auto& arms = nodes[head(h)].arms;
    const auto at = std::find(arms.begin(), arms.end(), h ^ 1U);
    CERTA_ASSERT(at != arms.end());
    return at == arms.begin() ? arms.back() : *(at - 1);
}

void Graph::delete_edge(Index e) {
    std::erase(nodes[edges[e].a].arms, 2 * e);
    std::erase(nodes[edges[e].b].arms, 2 * e + 1);
    edges[e].a = edges[e].b = no_index;
}

void Graph::join_at(Index n) {
    auto& arms = nodes[n].arms;
    if (arms.size() != 2 || nodes[n].curve != no_index || arms[0] / 2 == arms[1] / 2) return;
    const Index out = arms[0] % 2 == 0 ? arms[0] : arms[1], in = out == arms[0] ? arms[1] : arms[0];
    const Index f = out / 2, e = in / 2;  // e arrives, f leaves
    if (edges[e].line != edges[f].line || out % 2 != 0 || in % 2 != 1) return;
    const double length = edges[f].to - edges[f].from;
    edges[e].b = edges[f].b;
    edges[e].to += length;
    auto& far = nodes[edges[f].b].arms;
    *std::find(far.begin(), far.end(), 2 * f + 1) = 2 * e + 1;
    edges[f].a = edges[f].b = no_index;
    arms.clear();
}

Index Graph::split(Index e, const Point3& point, const SurfacePlace& place, double at) {
    const Index n = static_cast<Index>(nodes.size()), f = static_cast<Index>(edges.size());
    GraphNode node;
    node.point = point;
    node.place = place;
    node.arms = {2 * f, 2 * e + 1};
    nodes.push_back(std::move(node));
    edges.push_back({n, edges[e].b, edges[e].line, edges[e].curve, at, edges[e].to});
    auto& far = nodes[edges[e].b].arms;
    *std::find(far.begin(), far.end(), 2 * e + 1) = 2 * f + 1;
    edges[e].b = n;
    edges[e].to = at;
    return n;
}

std::vector<std::vector<Index>> Graph::trace_faces(const WorkMesh& mesh) const {
    std::vector<std::vector<Index>> faces;
    std::vector<bool> seen(2 * edges.size(), false);
    const auto outside = [&](Index h) {
        const GraphEdge& e = edges[h / 2];
        if (e.curve == no_index || !mesh.curves[e.curve].boundary) return false;
        const FeatureCurve& curve = mesh.curves[e.curve];
        const bool inside_left = mesh.start_of(mesh.edge_halfedges[curve.edges[0]]) == curve.vertices[0];
        return (h % 2 == 0) != inside_left;
    };
    for (Index h = 0; h < seen.size(); ++h) {
        if (seen[h] || !edges[h / 2].alive()) continue;
        std::vector<Index> face;
        bool out = false;
        for (Index at = h; !seen[at]; at = next(at)) {
            seen[at] = true;
            face.push_back(at);
            out = out || outside(at);
        }
        if (!out) faces.push_back(std::move(face));
    }
    return faces;
}

namespace {

/// Deletes one line's edge of a face with one or two sides; false if only features bound it.
bool open_small_face(Graph& graph, const std::vector<Index>& face) {
    for (const Index h : face) {
        const Index e = h / 2;
        if (graph.edges[e].line == no_index) continue;
        const Index a = graph.edges[e].a, b = graph.edges[e].b;
        graph.delete_edge(e);
        for (Index n : {a, b}) {
            // What dangles now goes too.
            while (graph.nodes[n].arms.size() == 1 && graph.nodes[n].curve == no_index) {
                const Index dangling = graph.nodes[n].arms[0];
                n = graph.head(dangling);
                graph.delete_edge(dangling / 2);
            }
            graph.join_at(n);
        }
        return true;
    }
    return false;
}

void split_in_middle(Graph& graph, const Network& network, Index e) {
    const GraphEdge edge = graph.edges[e];
    const double at = 0.5 * (edge.from + edge.to);
    SurfacePlace place;
    Point3 point = edge.line != no_index ? point_along(network, edge.line, at, place)
                                         : point_along_curve(network.mesh(), edge.curve, at, place);
    const SurfacePlace &a = graph.nodes[edge.a].place, &b = graph.nodes[edge.b].place;
    if (edge.line != no_index && std::floor(edge.from) == std::floor(edge.to) && a.face == b.face) {
        // Within a chord, places along the line are ranks only.
        place.face = a.face;
        for (std::size_t i = 0; i < 3; ++i) place.weights[i] = 0.5 * (a.weights[i] + b.weights[i]);
        point = point_at(network.mesh(), place);
    }
    const Index n = graph.split(e, point, place, at);
    if (edge.curve == no_index) return;
    graph.nodes[n].curve = edge.curve;
    graph.nodes[n].kind = network.mesh().curves[edge.curve].boundary ? VertexKind::boundary : VertexKind::crease;
}

}  // namespace

void simplify_graph(Graph& graph, const Network& network) {
    for (bool again = true; again;) {
        again = false;
        for (const auto& face : graph.trace_faces(network.mesh())) {
            if (face.size() > 2) continue;
            bool intact = true;  // an earlier change in this round may have touched it
            for (std::size_t i = 0; i < face.size(); ++i)
                intact =
                    intact && graph.edges[face[i] / 2].alive() && graph.next(face[i]) == face[(i + 1) % face.size()];
            if (intact && open_small_face(graph, face)) again = true;
        }
    }
    // Loops get two more nodes, all but one of several edges between the same nodes one.
    for (Index e = 0; e < graph.edges.size(); ++e)
        if (graph.edges[e].alive() && graph.edges[e].a == graph.edges[e].b) split_in_middle(graph, network, e);
    std::vector<std::array<Index, 3>> pairs;
    for (bool again = true; again;) {
        again = false;
        pairs.clear();
        for (Index e = 0; e < graph.edges.size(); ++e)
            if (graph.edges[e].alive())
                pairs.push_back(
                    {std::min(graph.edges[e].a, graph.edges[e].b), std::max(graph.edges[e].a, graph.edges[e].b), e});
        std::sort(pairs.begin(), pairs.end());
        for (std::size_t i = 1; i < pairs.size(); ++i)
            if (pairs[i][0] == pairs[i - 1][0] && pairs[i][1] == pairs[i - 1][1]) {
                split_in_middle(graph, network, pairs[i][2]);
                again = true;
            }
    }
}

}  // namespace certa::remeshing
