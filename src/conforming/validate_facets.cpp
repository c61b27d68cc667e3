// Each facet by itself: planarity, its sides against each other in its plane, what it encloses, its hole points. Sound
// facets become triangles for the tests against other facets.
//
// A facet that is one triangle has nothing to check here. The others are laid flat (see flat_facet.h); only when that
// fails are their sides compared with each other to name what crosses.

#include <algorithm>
#include <cmath>
#include <limits>

#include "conforming/validate_boxes.h"
#include "conforming/validate_findings.h"
#include "conforming/validate_messages.h"
#include "core/parallel.h"
#include "core/vector3.h"
#include "delaunay/flat_facet.h"
#include "exact/orientation.h"

namespace certa::conforming {

using delaunay::FlatFacet;
using delaunay::FlatSide;
using delaunay::FlatState;
using delaunay::Projection;
using exact::Point2;
namespace {

/// What is found out about one facet that is more than a triangle.
struct FacetResult {
    std::vector<Defect> defects;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    double deviation = 0.0;
};

class FacetCheck {
public:
    FacetCheck(const PiecewiseLinearComplex& input, const Complex& complex, const ConformOptions& options,
               std::uint32_t facet)
        : input_(input),
          complex_(complex),
          planarity_(options.planarity.resolve(complex.diagonal)),
          triangulate_(options.triangulate),
          facet_(facet),
          frame_(complex.frames[facet]) {}

    FacetResult run() {
        if (complex_.facet_sides[facet_].empty() && complex_.facet_points[facet_].empty()) return {};
        if (!is_planar()) return std::move(result_);
        const Projection projection(frame_.normal);
        const FlatFacet flat = delaunay::flatten_facet(input_, facet_, projection);
        if (std::none_of(flat.sides.begin(), flat.sides.end(), [](const FlatSide& side) { return side.on_ring; })) {
            refuse_empty();
        } else if (flat.state == FlatState::crossing) {
            find_crossings(flat, projection);
        } else {
            check_inside(flat);
            if (result_.defects.empty()) result_.triangles = flat.triangles;
        }
        return std::move(result_);
    }

private:
    ElementRef self() const { return {ElementKind::facet, facet_}; }
    const Point3& at(std::uint32_t v) const { return complex_.points[v]; }
    std::uint32_t segment_of(std::size_t side) const { return complex_.facet_sides[facet_][side].segment; }
    Point3 middle_of(std::uint32_t s) const {
        return 0.5 * at(complex_.segments[s][0]) + 0.5 * at(complex_.segments[s][1]);
    }
    void refuse(DefectKind kind, std::vector<ElementRef> elements, const Point3& place, std::string message) {
        result_.defects.push_back({kind, std::move(elements), place, std::move(message)});
    }

    bool is_planar() {
        std::uint32_t worst = no_index;
        const auto look_at = [&](std::uint32_t v) {
            const double d = std::abs(dot(at(v) - frame_.origin, frame_.normal));
            if (worst == no_index || d > result_.deviation) worst = v;
            result_.deviation = std::max(result_.deviation, d);
        };
        for (const Side& side : complex_.facet_sides[facet_]) {
            look_at(complex_.segments[side.segment][0]);
            look_at(complex_.segments[side.segment][1]);
        }
        for (const std::uint32_t v : complex_.facet_points[facet_]) look_at(v);
        if (result_.deviation <= planarity_) return true;
        const std::string way_out = triangulate_
                                        ? "it cannot be cut into triangles either, as its sides cross when it is "
                                          "laid flat: divide it into simpler facets"
                                        : "cut it with --triangulate, or raise --planarity";
        refuse(DefectKind::non_planar_facet, {self(), {ElementKind::vertex, worst}}, at(worst),
               vertex_name(worst) + ' ' + name_place(at(worst)) + " is " + name_number(result_.deviation) +
                   " away from the plane of " + facet_name(facet_) + ", more than the planarity of " +
                   name_number(planarity_) + "; " + way_out);
        return false;
    }

    // Sides that cross --------------------------------------------------------------------------------------------

    void find_crossings(const FlatFacet& flat, const Projection& projection) {
        std::vector<Simplex> parts;  // sides in order, then isolated points
        std::vector<std::uint32_t> ids;
        for (const FlatSide& side : flat.sides) ids.insert(ids.end(), side.ends.begin(), side.ends.end());
        ids.insert(ids.end(), flat.points.begin(), flat.points.end());
        std::sort(ids.begin(), ids.end());
        ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
        std::vector<Point3> flat_points;
        for (const std::uint32_t v : ids) {
            const Point2 p = projection(at(v));
            flat_points.push_back({p.x, p.y, 0.0});
        }
        const auto local = [&](std::uint32_t v) {
            return static_cast<std::uint32_t>(std::lower_bound(ids.begin(), ids.end(), v) - ids.begin());
        };
        for (const FlatSide& side : flat.sides) parts.push_back({{local(side.ends[0]), local(side.ends[1])}, 2});
        for (const std::uint32_t v : flat.points) parts.push_back({{local(v)}, 1});
        find_coinciding(ids, flat_points);
        std::vector<std::array<std::uint32_t, 2>> pairs = overlapping_boxes(parts, flat_points);
        for (const auto& [i, j] : pairs) report_pair(parts, flat_points, ids, i, j);
        if (!result_.defects.empty()) return;
        refuse(DefectKind::self_crossing_facet, {self()}, frame_.origin,
               facet_name(facet_) + " cannot be laid flat near " + name_place(frame_.origin) +
                   ": its sides cross within rounding; simplify it, or cut it with --triangulate");
    }

    void find_coinciding(const std::vector<std::uint32_t>& ids, const std::vector<Point3>& flat_points) {
        std::vector<std::uint32_t> order(ids.size());
        for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        const auto key = [&](std::uint32_t i) { return std::make_pair(flat_points[i].x, flat_points[i].y); };
        std::sort(order.begin(), order.end(), [&](auto i, auto j) { return key(i) < key(j); });
        for (std::size_t i = 1; i < order.size(); ++i) {
            if (key(order[i - 1]) != key(order[i])) continue;
            const std::uint32_t v = std::min(ids[order[i - 1]], ids[order[i]]);
            const std::uint32_t w = std::max(ids[order[i - 1]], ids[order[i]]);
            refuse(DefectKind::self_crossing_facet, {self(), {ElementKind::vertex, v}, {ElementKind::vertex, w}}, at(v),
                   vertex_name(v) + " and " + vertex_name(w) + " of " + facet_name(facet_) +
                       " are one above the other at " + name_place(at(v)) + "; a facet is flat: remove one of them");
        }
    }

    static std::vector<std::array<std::uint32_t, 2>> overlapping_boxes(const std::vector<Simplex>& parts,
                                                                       const std::vector<Point3>& flat_points) {
        std::vector<Box> boxes;
        for (const Simplex& part : parts) {
            Box box{flat_points[part.vertices[0]], flat_points[part.vertices[0]]};
            for (int i = 1; i < part.size; ++i) {
                box.extend({flat_points[part.vertices[i]], flat_points[part.vertices[i]]});
            }
            boxes.push_back(box);
        }
        const BoxTree tree(boxes, {});
        std::vector<std::array<std::uint32_t, 2>> pairs;
        for (std::size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
            tree.visit_pairs(leaf, [&](std::uint32_t i, std::uint32_t j) {
                pairs.push_back({std::min(i, j), std::max(i, j)});
            });
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

    void report_pair(const std::vector<Simplex>& parts, const std::vector<Point3>& flat_points,
                     const std::vector<std::uint32_t>& ids, std::uint32_t i, std::uint32_t j) {
        for (const Contact& contact : find_contacts(flat_points, parts[i], parts[j])) {
            if (is_edge(contact.first) && is_edge(contact.second)) {
                const Point3 flat = place_of(flat_points, parts[i], parts[j], contact);
                report_crossing(i, j, lifted(flat, flat_points, parts[i], ids));
            } else if (is_edge(contact.first)) {
                report_touching(ids[parts[j].vertices[contact.second]], i);
            } else if (is_edge(contact.second)) {
                report_touching(ids[parts[i].vertices[contact.first]], j);
            }
        }
    }

    /// The point of a side above a point of its projection.
    Point3 lifted(const Point3& flat, const std::vector<Point3>& flat_points, const Simplex& side,
                  const std::vector<std::uint32_t>& ids) const {
        const Point3 a = flat_points[side.vertices[0]], b = flat_points[side.vertices[1]];
        const bool along_x = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
        const double t = along_x ? (flat.x - a.x) / (b.x - a.x) : (flat.y - a.y) / (b.y - a.y);
        const Point3 p = at(ids[side.vertices[0]]);
        return p + t * (at(ids[side.vertices[1]]) - p);
    }

    void report_crossing(std::uint32_t i, std::uint32_t j, const Point3& place) {
        const std::uint32_t s = std::min(segment_of(i), segment_of(j)), t = std::max(segment_of(i), segment_of(j));
        refuse(DefectKind::self_crossing_facet, {self(), {ElementKind::segment, s}, {ElementKind::segment, t}}, place,
               "sides of " + facet_name(facet_) + " cross at " + name_place(place) + " (" + segment_name(s) + " and " +
                   segment_name(t) + "); split them there, or correct the order of its vertices");
    }

    void report_touching(std::uint32_t v, std::uint32_t side) {
        const std::uint32_t s = segment_of(side);
        const auto& ends = complex_.segments[s];
        const bool exact = exact::is_between(at(ends[0]), at(ends[1]), at(v));
        refuse(exact ? DefectKind::point_on_segment : DefectKind::self_crossing_facet,
               exact ? std::vector<ElementRef>{{ElementKind::vertex, v}, {ElementKind::segment, s}}
                     : std::vector<ElementRef>{self(), {ElementKind::vertex, v}, {ElementKind::segment, s}},
               at(v),
               vertex_name(v) + ' ' + name_place(at(v)) + " lies on " + segment_name(s) + ", a side of " +
                   facet_name(facet_) + "; split the side there" + (exact ? ", or use --repair" : ""));
    }

    // What the rings enclose --------------------------------------------------------------------------------------

    void refuse_empty() {
        refuse(DefectKind::open_facet, {self()}, frame_.origin,
               facet_name(facet_) + " near " + name_place(frame_.origin) +
                   " encloses nothing; give it a closed ring of at least three vertices, or remove hole points that "
                   "empty it");
    }

    void check_inside(const FlatFacet& flat) {
        for (const std::uint32_t h : flat.holes_outside) {
            const Point3& p = input_.facet_holes[h];
            refuse(DefectKind::hole_outside_facet, {self()}, p,
                   "the hole point " + name_place(p) + " of " + facet_name(facet_) +
                       " lies on a side or outside of the facet; move it inside the hole");
        }
        if (flat.triangles.empty()) {
            refuse_empty();
            return;
        }
        for (std::size_t i = 0; i < flat.sides.size(); ++i) {
            if (flat.sides[i].inside > 0) continue;
            const std::uint32_t s = segment_of(i);
            const bool ring = flat.sides[i].on_ring;
            refuse(ring ? DefectKind::open_facet : DefectKind::element_outside_facet,
                   {self(), {ElementKind::segment, s}}, middle_of(s),
                   segment_name(s) + " of " + facet_name(facet_) + " has the facet on neither side, at " +
                       name_place(middle_of(s)) + "; take it out of the facet" +
                       (ring ? "" : " and list it as a segment on its own"));
        }
        for (std::size_t i = 0; i < flat.points.size(); ++i) {
            if (flat.points_inside[i]) continue;
            const std::uint32_t v = flat.points[i];
            refuse(DefectKind::element_outside_facet, {self(), {ElementKind::vertex, v}}, at(v),
                   vertex_name(v) + ' ' + name_place(at(v)) + " is listed in " + facet_name(facet_) +
                       " but lies outside of it; take it out of the facet");
        }
    }

    const PiecewiseLinearComplex& input_;
    const Complex& complex_;
    const double planarity_;
    const bool triangulate_;
    const std::uint32_t facet_;
    const Frame& frame_;
    FacetResult result_;
};

/// One ring of three vertices and nothing else.
bool is_plain_triangle(const PiecewiseLinearComplex& input, std::uint32_t f) {
    const std::uint32_t p = input.facet_offsets[f];
    return input.facet_offsets[f + 1] == p + 1 && input.polygon_offsets[p + 1] - input.polygon_offsets[p] == 3 &&
           input.hole_offsets[f] == input.hole_offsets[f + 1];
}

}  // namespace

double near_of(std::span<const Point3> points, std::span<const std::uint32_t> vertices) {
    double largest = 0.0;
    for (const std::uint32_t v : vertices) {
        const Point3& p = points[v];
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    return 16.0 * std::numeric_limits<double>::epsilon() * largest;
}

Pieces check_facets(const PiecewiseLinearComplex& input, const Complex& complex, const ConformOptions& options,
                    const ValidationReport& structure, ValidationReport& report) {
    const auto facets = static_cast<std::uint32_t>(input.facet_count());
    std::vector<std::uint32_t> involved;
    for (std::uint32_t f = 0; f < facets; ++f) {
        if (!is_plain_triangle(input, f)) involved.push_back(f);
    }
    std::vector<FacetResult> results(involved.size());
    core::parallel_for(involved.size(), 16, {}, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) results[i] = FacetCheck(input, complex, options, involved[i]).run();
    });
    Pieces pieces;
    pieces.near.resize(facets, 0.0);
    pieces.simplices.reserve(facets);
    pieces.owners.reserve(facets);
    std::size_t next = 0;
    for (std::uint32_t f = 0; f < facets; ++f) {
        if (next == involved.size() || involved[next] != f) {
            const VertexId* v = input.corners.data() + input.polygon_offsets[input.facet_offsets[f]];
            const Simplex t{{index_of(v[0]), index_of(v[1]), index_of(v[2])}, 3};
            pieces.add(t, f);
            pieces.near[f] = near_of(complex.points, t.vertices);
            continue;
        }
        FacetResult& result = results[next++];
        for (Defect& defect : result.defects) report.add(std::move(defect));
        for (const auto& t : result.triangles) {
            pieces.add({t, 3}, f);
            pieces.near[f] = std::max(pieces.near[f], near_of(complex.points, t));
        }
        pieces.near[f] += result.deviation;
    }
    for (std::uint32_t s = 0; s < complex.segments.size(); ++s) {
        if (complex.segment_facets[s].empty()) pieces.add({{complex.segments[s][0], complex.segments[s][1]}, 2}, s);
    }
    std::vector<std::uint8_t> ignored(complex.points.size(), 0);
    for (const std::uint32_t v : structure.ignored_points) ignored[v] = 1;
    for (std::uint32_t v = 0; v < complex.points.size(); ++v) {
        const bool unused = complex.point_segments[v].empty() && complex.point_facets[v].empty();
        if (unused && !ignored[v]) pieces.add({{v}, 1}, v);
    }
    return pieces;
}

}  // namespace certa::conforming
