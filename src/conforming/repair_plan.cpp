// From findings to a plan. Points within rounding of each other, and rings that walk straight back, are put right
// before anything else. T-junctions come next: where a point is on a segment or within rounding of it, the segment is
// split there, so that the exact intersections computed afterwards meet what is already there instead of coming to lie
// beside it. Then every pair of elements that cross gets its points of intersection, each made once and shared by all
// that meet there (a point is known by the segment and the facet, or the two segments, that it comes from), and the
// segments between them.
//
// Facets are compared piece by piece; the points where an intersection passes from one piece of a facet to the next are
// no points of the complex, and the parts that meet there are joined again.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "conforming/repair.h"
#include "conforming/validate_findings.h"
#include "conforming/validate_messages.h"
#include "core/vector3.h"

namespace certa::conforming {
namespace {

using Ids = std::vector<std::uint32_t>;

/// Makes the points of a plan, and finds again what is already there: where three facets meet, the point is computed
/// from each pair of their intersections, and comes out a few units in the last place apart.
class PointMaker {
public:
    PointMaker(const Complex& complex, RepairPlan& plan) : complex_(complex), plan_(plan) {
        double largest = 0.0;
        for (const Point3& p : complex.points) {
            largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        }
        reach_ = 64.0 * std::numeric_limits<double>::epsilon() * largest;
        for (std::uint32_t v = 0; v < complex.points.size(); ++v) {
            const bool used = !complex.point_segments[v].empty() || !complex.point_facets[v].empty();
            if (used) cells_.emplace(cell_of(complex.points[v]), v);
        }
    }

    /// The nearest point within rounding of `place`, or a new one.
    std::uint32_t make(const Point3& place) {
        std::pair<double, std::uint32_t> best{reach_, no_index};
        visit_around(place, [&](std::uint32_t v) { best = std::min(best, {distance(at(v), place), v}); });
        if (best.second != no_index) return best.second;
        const auto fresh = static_cast<std::uint32_t>(complex_.points.size() + plan_.new_points.size());
        plan_.new_points.push_back(place);
        cells_.emplace(cell_of(place), fresh);
        return fresh;
    }

    /// Points within rounding of a lower one that is kept: the lower one, the other.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> find_close_points() const {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
        std::vector<std::uint8_t> gone(complex_.points.size(), 0);
        std::set<std::uint32_t> used;
        for (const auto& [cell, v] : cells_) used.insert(v);
        for (const std::uint32_t v : used) {
            if (gone[v]) continue;
            visit_around(at(v), [&](std::uint32_t w) {
                const double near = near_of(complex_.points, {&w, 1});
                if (w <= v || gone[w] || distance(at(v), at(w)) > near) return;
                gone[w] = 1;
                pairs.emplace_back(v, w);
            });
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

private:
    using Cell = std::array<double, 3>;

    template <class Visit>
    void visit_around(const Point3& place, Visit visit) const {
        std::set<Cell> around;
        for (const double x : {place.x - reach_, place.x + reach_}) {
            for (const double y : {place.y - reach_, place.y + reach_}) {
                for (const double z : {place.z - reach_, place.z + reach_}) around.insert(cell_of({x, y, z}));
            }
        }
        for (const Cell& cell : around) {
            const auto [begin, end] = cells_.equal_range(cell);
            for (auto it = begin; it != end; ++it) visit(it->second);
        }
    }

    const Point3& at(std::uint32_t v) const {
        const std::size_t count = complex_.points.size();
        return v < count ? complex_.points[v] : plan_.new_points[v - count];
    }

    /// Cells are wider than twice the reach, so that the corners of the box around a place name all cells it touches.
    Cell cell_of(const Point3& p) const {
        const double width = std::max(4.0 * reach_, std::numeric_limits<double>::min());
        return {std::floor(p.x / width), std::floor(p.y / width), std::floor(p.z / width)};
    }

    const Complex& complex_;
    RepairPlan& plan_;
    double reach_ = 0.0;
    std::multimap<Cell, std::uint32_t> cells_;
};

class Planner {
public:
    Planner(const PiecewiseLinearComplex& input, const Complex& complex, const ConformOptions& options)
        : input_(input), complex_(complex), maker_(complex, plan_) {
        ValidationReport structure = validate_structure(input), report;
        report.max_kept = std::numeric_limits<std::size_t>::max();
        pieces_ = check_facets(input, complex, options, structure, report);
        facet_defects_ = std::move(report.defects);
        findings_ = find_findings(complex, pieces_, {}, true);
    }

    RepairPlan run() {
        plan_merges();
        if (plan_.empty()) plan_trims();
        if (plan_.empty()) plan_touching();
        if (plan_.empty()) {
            plan_own_crossings();
            plan_crossings();
        }
        return std::move(plan_);
    }

private:
    const Point3& at(std::uint32_t v) const {
        const std::size_t count = complex_.points.size();
        return v < count ? complex_.points[v] : plan_.new_points[v - count];
    }

    void say(DefectKind kind, std::vector<ElementRef> elements, const Point3& place, std::string message) {
        plan_.repairs.push_back({kind, std::move(elements), place, std::move(message)});
    }

    void split(DefectKind kind, std::uint32_t segment, std::uint32_t v) {
        const auto& ends = complex_.segments[segment];
        if (v == ends[0] || v == ends[1] || !splits_.insert({segment, v}).second) return;
        plan_.splits.emplace_back(segment, v);
        say(kind, {{ElementKind::segment, segment}, {ElementKind::vertex, v}}, at(v),
            segment_name(segment) + " (from " + vertex_name(ends[0]) + " to " + vertex_name(ends[1]) +
                ") was split at " + vertex_name(v) + ' ' + name_place(at(v)));
    }

    void add_polygon(DefectKind kind, std::uint32_t facet, Ids polygon) {
        Ids key = polygon;
        std::sort(key.begin(), key.end());
        if (!polygons_.insert({facet, key}).second) return;
        const std::string what = polygon.size() == 1
                                     ? vertex_name(polygon[0]) + ' ' + name_place(at(polygon[0]))
                                     : "the segment from " + vertex_name(polygon[0]) + " to " + vertex_name(polygon[1]);
        std::vector<ElementRef> elements{{ElementKind::facet, facet}};
        for (const std::uint32_t v : polygon) elements.push_back({ElementKind::vertex, v});
        say(kind, std::move(elements), at(polygon[0]), facet_name(facet) + " was given " + what);
        plan_.polygons.emplace_back(facet, std::move(polygon));
    }

    bool has_point(std::uint32_t facet, std::uint32_t v) const {
        const auto facets = complex_.point_facets[v];
        return std::binary_search(facets.begin(), facets.end(), facet);
    }

    // Points within rounding of each other, rings that walk back
    // -------------------------------------------------------

    /// Legal as such, but they make most of what is wrong around them.
    void plan_merges() {
        for (const auto& [v, w] : maker_.find_close_points()) {
            plan_.merges.emplace_back(w, v);
            say(DefectKind::duplicate_point, {{ElementKind::vertex, v}, {ElementKind::vertex, w}}, at(w),
                vertex_name(w) + " at " + name_place(at(w)) + " is within rounding of " + vertex_name(v) +
                    " and was merged into it");
        }
    }

    void plan_trims() {
        for (const Defect& defect : facet_defects_) {
            const std::uint32_t f = defect.elements[0].index;
            if (defect.kind != DefectKind::open_facet || (!plan_.trims.empty() && plan_.trims.back() == f)) continue;
            bool changes = false;
            for (std::uint32_t p = input_.facet_offsets[f]; p < input_.facet_offsets[f + 1]; ++p) {
                Ids ring;
                for (std::uint32_t c = input_.polygon_offsets[p]; c < input_.polygon_offsets[p + 1]; ++c) {
                    ring.push_back(index_of(input_.corners[c]));
                }
                changes = (ring.size() > 2 && trim_spikes(ring)) || changes;
            }
            if (!changes) continue;
            plan_.trims.push_back(f);
            say(DefectKind::open_facet, {{ElementKind::facet, f}}, defect.place,
                facet_name(f) + " lost spikes, where its ring walks straight back");
        }
    }

    // Points on or near segments and facets ---------------------------------------------------------------------------

    void plan_touching() {
        for (const Defect& defect : facet_defects_) {
            const auto& e = defect.elements;
            const std::size_t n = e.size();
            const bool touching =
                n >= 2 && e[n - 1].kind == ElementKind::segment && e[n - 2].kind == ElementKind::vertex;
            if (touching) split(DefectKind::point_on_segment, e[n - 1].index, e[n - 2].index);
        }
        for (const Finding& f : findings_) {
            switch (f.kind) {
                case FindingKind::point_on_segment:
                    split(DefectKind::point_on_segment, f.second, f.first);
                    break;
                case FindingKind::point_near_segment:
                    split(DefectKind::point_near_segment, f.second, f.first);
                    break;
                case FindingKind::point_near_facet:
                    add_polygon(DefectKind::point_near_facet, f.second, {f.first});
                    break;
                case FindingKind::segment_near_facet: {
                    const auto& ends = complex_.segments[f.first];
                    if (has_point(f.second, ends[0]) && has_point(f.second, ends[1])) {
                        add_polygon(DefectKind::segment_in_facet, f.second, {ends[0], ends[1]});
                    }
                    break;
                }
                default:
                    break;
            }
        }
    }

    /// Isolated segments of a facet that cross each other or its rings. Rings that cross have no obvious meaning.
    void plan_own_crossings() {
        for (const Defect& defect : facet_defects_) {
            const auto& e = defect.elements;
            if (e.size() != 3 || e[1].kind != ElementKind::segment || e[2].kind != ElementKind::segment) continue;
            const auto is_ring = [&](std::uint32_t s) {
                const auto sides = complex_.facet_sides[e[0].index];
                return std::any_of(sides.begin(), sides.end(), [&](auto& x) { return x.segment == s && x.boundary; });
            };
            if (is_ring(e[1].index) && is_ring(e[2].index)) continue;
            cross(e[1].index, e[2].index, defect.place);
        }
    }

    /// One point for two segments that cross.
    std::uint32_t cross(std::uint32_t s, std::uint32_t t, const Point3& place) {
        if (s > t) std::swap(s, t);
        const auto [it, fresh] = segment_points_.emplace(std::make_pair(s, t), 0);
        if (fresh) it->second = maker_.make(place);
        split(DefectKind::crossing_segments, s, it->second);
        split(DefectKind::crossing_segments, t, it->second);
        return it->second;
    }

    // Facets that cross -----------------------------------------------------------------------------------------------

    /// A corner of the intersection of two facets: the open simplices that carry it, as ascending points.
    struct Node {
        std::array<Ids, 2> carriers;
        friend auto operator<=>(const Node&, const Node&) = default;  // NOLINT(modernize-use-nullptr)
    };
    enum class Along : std::uint8_t { no_side, side_of_first, side_of_second };
    struct Link {
        Node to;
        Along along = Along::no_side;
    };
    /// The corners of one pair of owners, with the intersections between them.
    struct Graph {
        std::map<Node, std::uint32_t> points;  ///< those that become points of the complex
        std::map<Node, std::vector<Link>> links;
    };

    static Ids carrier(const Simplex& s, Feature f) {
        Ids ids;
        if (is_vertex(f)) {
            ids = {s.vertices[f]};
        } else if (is_edge(f)) {
            const auto ends = ends_of(s, f);
            ids = {ends[0], ends[1]};
        } else {
            ids.assign(s.vertices.begin(), s.vertices.end());
        }
        std::sort(ids.begin(), ids.end());
        return ids;
    }

    void plan_crossings() {
        std::map<std::array<std::uint32_t, 4>, std::set<std::pair<std::uint32_t, std::uint32_t>>> pairs;
        std::set<std::pair<std::uint32_t, std::uint32_t>> overlapping;
        for (const Finding& f : findings_) {
            if (f.kind == FindingKind::overlapping_facets) overlapping.insert({f.first, f.second});
        }
        for (const Finding& f : findings_) {
            const bool crossing = f.kind == FindingKind::crossing_facets || f.kind == FindingKind::segment_in_facet ||
                                  f.kind == FindingKind::segment_crosses_facet ||
                                  f.kind == FindingKind::crossing_segments;
            if (!crossing) continue;
            // The larger simplex first, then the lower owner: the same order for every pair of pieces of two owners.
            std::uint32_t a = f.piece_a, b = f.piece_b;
            const auto rank = [&](std::uint32_t p) { return std::make_pair(-int(size_of(p)), pieces_.owners[p]); };
            if (rank(b) < rank(a)) std::swap(a, b);
            if (size_of(a) == 3 && size_of(b) == 3 && overlapping.contains({pieces_.owners[a], pieces_.owners[b]}))
                continue;
            pairs[{size_of(a), size_of(b), pieces_.owners[a], pieces_.owners[b]}].insert({a, b});
        }
        for (const auto& [key, list] : pairs) plan_pair(list);
    }

    std::uint32_t size_of(std::uint32_t piece) const { return pieces_.simplices[piece].size; }

    void plan_pair(const std::set<std::pair<std::uint32_t, std::uint32_t>>& list) {
        Graph graph;
        const auto [first_a, first_b] = *list.begin();
        for (const auto& [a, b] : list) {
            const Contacts contacts = find_contacts(complex_.points, pieces_.simplices[a], pieces_.simplices[b]);
            if (contacts.count > 2) continue;
            for (const Contact& contact : contacts) make_point(a, b, contact, graph);
            if (contacts.count == 2) link(a, b, contacts.list[0], contacts.list[1], graph);
        }
        const std::uint32_t f = pieces_.owners[first_a], g = pieces_.owners[first_b];
        std::set<std::uint32_t> on_segments;
        for (const auto& [node, point] : graph.points) {
            for (const Link& link : graph.links[node]) {
                follow(node, link, point, graph, {first_a, first_b}, on_segments);
            }
        }
        // Points where something passes through a facet without leaving a segment in it.
        for (const auto& [node, point] : graph.points) {
            if (on_segments.contains(point)) continue;
            if (size_of(first_a) == 3 && node.carriers[0].size() > 1 && !is_on_side(first_a, node.carriers[0])) {
                add_polygon(DefectKind::segment_crosses_facet, f, {point});
            }
            if (size_of(first_b) == 3 && node.carriers[1].size() > 1 && !is_on_side(first_b, node.carriers[1])) {
                add_polygon(DefectKind::segment_crosses_facet, g, {point});
            }
        }
    }

    /// The side that a carrier is the inside of; no_index for anything else.
    std::uint32_t side_of(std::uint32_t piece, const Ids& carrier) const {
        if (carrier.size() != 2) return no_index;
        if (size_of(piece) == 2) return pieces_.owners[piece];
        for (const Side& side : complex_.facet_sides[pieces_.owners[piece]]) {
            const auto& ends = complex_.segments[side.segment];
            if (std::min(ends[0], ends[1]) == carrier[0] && std::max(ends[0], ends[1]) == carrier[1])
                return side.segment;
        }
        return no_index;
    }
    bool is_on_side(std::uint32_t piece, const Ids& carrier) const { return side_of(piece, carrier) != no_index; }

    Node node_of(std::uint32_t a, std::uint32_t b, const Contact& contact) const {
        return {{carrier(pieces_.simplices[a], contact.first), carrier(pieces_.simplices[b], contact.second)}};
    }

    /// Gives a corner its point, when it is one of the complex.
    void make_point(std::uint32_t a, std::uint32_t b, const Contact& contact, Graph& graph) {
        const Node node = node_of(a, b, contact);
        if (graph.points.contains(node)) return;
        for (const Ids& ids : node.carriers) {
            if (ids.size() == 1) {
                graph.points[node] = ids[0];
                return;
            }
        }
        const std::uint32_t s = side_of(a, node.carriers[0]), t = side_of(b, node.carriers[1]);
        if (s == no_index && t == no_index) return;  // between pieces of one facet: no point of the complex
        const Point3 place = place_of(complex_.points, pieces_.simplices[a], pieces_.simplices[b], contact);
        if (s != no_index && t != no_index) {
            graph.points[node] = cross(s, t, place);
            return;
        }
        const std::uint32_t segment = s != no_index ? s : t, facet = pieces_.owners[s != no_index ? b : a];
        const auto [it, fresh] = facet_points_.emplace(std::make_pair(segment, facet), 0);
        if (fresh) it->second = maker_.make(place);
        split(DefectKind::crossing_facets, segment, it->second);
        graph.points[node] = it->second;
    }

    void link(std::uint32_t a, std::uint32_t b, const Contact& c, const Contact& d, Graph& graph) const {
        const Feature e = edge_with(pieces_.simplices[a], c.first, d.first);
        const Feature f = edge_with(pieces_.simplices[b], c.second, d.second);
        const bool along_a = is_edge(e) && side_along(complex_, pieces_, a, e) != no_index;
        const bool along_b = is_edge(f) && side_along(complex_, pieces_, b, f) != no_index;
        if (along_a && along_b) return;  // sides that overlap: their T-junctions are split
        const Along along = along_a ? Along::side_of_first : along_b ? Along::side_of_second : Along::no_side;
        const Node from = node_of(a, b, c), to = node_of(a, b, d);
        add_link(graph.links[from], {to, along});
        add_link(graph.links[to], {from, along});
    }

    static void add_link(std::vector<Link>& links, Link link) {
        const auto same = [&](const Link& other) { return other.to == link.to; };
        if (std::none_of(links.begin(), links.end(), same)) links.push_back(std::move(link));
    }

    /// Walks over corners between pieces to the next point and adds the segment between the two.
    void follow(const Node& start, const Link& first, std::uint32_t from, const Graph& graph,
                const std::pair<std::uint32_t, std::uint32_t>& pieces, std::set<std::uint32_t>& on_segments) {
        Node before = start, node = first.to;
        while (!graph.points.contains(node)) {
            const auto& links = graph.links.at(node);
            if (links.size() != 2) return;
            const Node next = links[0].to == before ? links[1].to : links[0].to;
            before = node;
            node = next;
        }
        const std::uint32_t to = graph.points.at(node);
        on_segments.insert(from);
        on_segments.insert(to);
        if (from >= to) return;  // each once, from its lower end
        const auto add = [&](std::uint32_t piece, Along side) {
            const bool has_it = first.along == side;
            if (size_of(piece) == 3 && !has_it) {
                add_polygon(DefectKind::crossing_facets, pieces_.owners[piece], {from, to});
            }
        };
        add(pieces.first, Along::side_of_first);
        add(pieces.second, Along::side_of_second);
    }

    const PiecewiseLinearComplex& input_;
    const Complex& complex_;
    RepairPlan plan_;
    PointMaker maker_;
    Pieces pieces_;
    std::vector<Defect> facet_defects_;
    std::vector<Finding> findings_;
    std::set<std::pair<std::uint32_t, std::uint32_t>> splits_;
    std::set<std::pair<std::uint32_t, Ids>> polygons_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> segment_points_;  // two segments
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> facet_points_;    // segment, facet
};

}  // namespace

RepairPlan plan_repairs(const PiecewiseLinearComplex& input, const Complex& complex, const ConformOptions& options) {
    return Planner(input, complex, options).run();
}

}  // namespace certa::conforming
