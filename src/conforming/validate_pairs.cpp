// All pairs of pieces whose boxes overlap: what they share beyond common vertices and common sides.
//
// Four steps, each for the pairs that the one before could not settle: distances from planes in doubles; exact signs
// and a separating line; all corners of the intersection (validate_contacts.h), from which the finding is read off;
// and, for pairs that are close without touching, the tests for points and segments within rounding. Two faces of a
// known simplicial complex are never compared. Findings are sorted: threads leave no trace.
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "conforming/validate_boxes.h"
#include "conforming/validate_findings.h"
#include "conforming/validate_near.h"
#include "core/parallel.h"
#include "core/vector3.h"
#include "exact/orientation.h"

namespace certa::conforming {
namespace {

using exact::drop_axis;
using exact::orient2d;
using exact::orient3d;

std::uint32_t find_segment(const Complex& complex, std::uint32_t a, std::uint32_t b) {
    if (complex.point_segments[a].size() > complex.point_segments[b].size()) std::swap(a, b);
    for (const std::uint32_t s : complex.point_segments[a]) {
        if (complex.segments[s][0] == b || complex.segments[s][1] == b) return s;
    }
    return no_index;
}

bool has_side(const Complex& complex, std::uint32_t segment, std::uint32_t facet) {
    const auto facets = complex.segment_facets[segment];
    return std::binary_search(facets.begin(), facets.end(), facet);
}

/// Compares pieces and collects findings; one per thread.
class PairTester {
public:
    PairTester(const Complex& complex, const Pieces& pieces) : complex_(complex), pieces_(pieces) {}

    std::vector<Finding> findings;

    void test(std::uint32_t i, std::uint32_t j) {
        if (i > j) std::swap(i, j);
        a_ = i;
        b_ = j;
        const Simplex &a = pieces_.simplices[i], &b = pieces_.simplices[j];
        if (a.size == 3 && b.size == 3) {
            if (pieces_.owners[i] != pieces_.owners[j]) test_triangles(a, b);
        } else {
            classify(find_contacts(complex_.points, a, b));
            find_near(complex_, pieces_, a_, b_, findings);
        }
    }

private:
    const Point3& at(std::uint32_t v) const { return complex_.points[v]; }
    const Simplex& simplex(std::uint32_t piece) const { return pieces_.simplices[piece]; }
    std::uint32_t owner(std::uint32_t piece) const { return pieces_.owners[piece]; }
    std::uint32_t side(std::uint32_t piece, Feature edge) const { return side_along(complex_, pieces_, piece, edge); }

    void found(FindingKind kind, std::uint32_t first, std::uint32_t second) {
        findings.push_back({kind, first, second, a_, b_});
    }

    // Triangles -----------------------------------------------------------------------------------------------------

    /// The corners of `s` that `t` does not have.
    static int other_corners(const Simplex& t, const Simplex& s, std::array<std::uint32_t, 3>& others) {
        int count = 0;
        for (const std::uint32_t v : s.vertices) {
            if (v != t.vertices[0] && v != t.vertices[1] && v != t.vertices[2]) others[count++] = v;
        }
        return count;
    }

    /// True when all of `others` are strictly on one side of the plane of triangle `piece` and further than `near`.
    /// The frame's normal is good to 1e-11 even for needles, so the sign of the product is certain beyond 1e-9 of the
    /// distance along the plane.
    bool is_clear_of_plane(std::uint32_t piece, const std::array<std::uint32_t, 3>& others, int count,
                           double near) const {
        const Frame& frame = complex_.frames[owner(piece)];
        const Point3& base = at(simplex(piece).vertices[0]);
        int side = 0;
        for (int i = 0; i < count; ++i) {
            const Point3 d = at(others[i]) - base;
            const double height = dot(d, frame.normal);
            const double doubt = near + 1e-9 * (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
            const int s = height > doubt ? 1 : height < -doubt ? -1 : 0;
            if (s == 0 || s * side < 0) return false;
            side = s;
        }
        return true;
    }

    void test_triangles(const Simplex& a, const Simplex& b) {
        std::array<std::uint32_t, 3> a_others{}, b_others{};
        const int b_count = other_corners(a, b, b_others);
        const int a_count = other_corners(b, a, a_others);
        const double near = std::max(pieces_.near[owner(a_)], pieces_.near[owner(b_)]);
        // A common edge inside a facet must be looked at even when nothing else touches.
        const bool common_edge = b_count == 1;
        if (b_count > 0 && !(common_edge && !is_common_side(a, b))) {
            if (is_clear_of_plane(a_, b_others, b_count, near)) return;
            if (is_clear_of_plane(b_, a_others, a_count, near)) return;
        }
        if (!are_surely_apart(a, b, a_others, b_others, b_count)) classify(find_contacts(complex_.points, a, b));
        find_near(complex_, pieces_, a_, b_, findings);
    }

    /// For triangles with two common vertices: the edge between them is a side of both facets.
    bool is_common_side(const Simplex& a, const Simplex& b) const {
        for (int i = 0; i < 3; ++i) {
            const auto edge = static_cast<Feature>(first_edge + i);
            const auto ends = ends_of(a, edge);
            const auto has = [&](std::uint32_t v) {
                return v == b.vertices[0] || v == b.vertices[1] || v == b.vertices[2];
            };
            if (!has(ends[0]) || !has(ends[1])) continue;
            const std::uint32_t s = side(a_, edge);
            return s != no_index && has_side(complex_, s, owner(b_));
        }
        return false;
    }

    /// Exact and quick; false means "look closer". Covers neighbours of a surface, whose planes nearly always meet.
    bool are_surely_apart(const Simplex& a, const Simplex& b, const std::array<std::uint32_t, 3>& a_others,
                          const std::array<std::uint32_t, 3>& b_others, int count) const {
        if (count == 0) return false;
        if (are_separated(a, b)) return true;
        if (count == 3) return false;
        const auto sign = [&](const Simplex& t, std::uint32_t v) {
            return orient3d(at(t.vertices[0]), at(t.vertices[1]), at(t.vertices[2]), at(v));
        };
        std::array<int, 3> b_signs{};
        bool strict = true;
        for (int i = 0; i < count; ++i) {
            b_signs[i] = sign(a, b_others[i]);
            strict = strict && b_signs[i] != 0 && b_signs[i] == b_signs[0];
        }
        if (strict) return count > 1 || is_common_side(a, b);
        if (count == 2) return are_wedges_apart(a, b, a_others, b_others, b_signs);
        return false;
    }

    /// Seen along an axis, a side of one triangle has the other on its far side, with common vertices only on it: then
    /// a plane through that side and along the axis parts them. All there is to say about coplanar triangles, and
    /// cheaper than the signs of volumes for nearly coplanar ones.
    bool are_separated(const Simplex& a, const Simplex& b) const {
        const int axis = faithful_axis(at(a.vertices[0]), at(a.vertices[1]), at(a.vertices[2]));
        if (axis < 0) return false;
        return has_separating_side(a_, a, b, axis) || has_separating_side(b_, b, a, axis);
    }

    bool has_separating_side(std::uint32_t piece, const Simplex& a, const Simplex& b, int axis) const {
        std::array<exact::Point2, 3> p, q;
        for (int i = 0; i < 3; ++i) {
            p[i] = drop_axis(at(a.vertices[i]), axis);
            q[i] = drop_axis(at(b.vertices[i]), axis);
        }
        const int turn = orient2d(p[0], p[1], p[2]);
        for (int i = 0; i < 3; ++i) {
            const int k = (i + 1) % 3;
            bool separates = true;
            int common = 0;
            for (int j = 0; j < 3 && separates; ++j) {
                const bool shared = b.vertices[j] == a.vertices[i] || b.vertices[j] == a.vertices[k];
                common += shared;
                separates = shared || turn * orient2d(p[i], p[k], q[j]) < 0;
            }
            if (!separates) continue;
            if (common < 2) return true;
            const std::uint32_t s = side(piece, static_cast<Feature>(first_edge + i));
            return s != no_index && has_side(complex_, s, owner(piece == a_ ? b_ : a_));
        }
        return false;
    }

    /// One common vertex o and planes that meet in a line through o inside both angles: apart when the line runs into
    /// opposite directions of o. Seen from the line through a1 and a2, which crosses the plane of b on the side of b or
    /// on the opposite one.
    bool are_wedges_apart(const Simplex& a, const Simplex& b, const std::array<std::uint32_t, 3>& a_others,
                          const std::array<std::uint32_t, 3>& b_others, const std::array<int, 3>& b_signs) const {
        if (b_signs[0] * b_signs[1] >= 0) return false;
        std::uint32_t o = 0;
        for (const std::uint32_t v : a.vertices) {
            if (v != a_others[0] && v != a_others[1]) o = v;
        }
        const std::uint32_t a1 = a_others[0], a2 = a_others[1], b1 = b_others[0], b2 = b_others[1];
        const int below = orient3d(at(o), at(b1), at(b2), at(a1)), above = orient3d(at(o), at(b1), at(b2), at(a2));
        if (below * above > 0) return true;
        if (below == 0 || above == 0) return false;
        // The line from a1 to a2 passes the rays o->b1 and o->b2 on these sides; inside the angle both agree with the
        // direction in which it crosses the plane.
        const int first = orient3d(at(a1), at(a2), at(o), at(b1)), second = orient3d(at(a1), at(a2), at(b2), at(o));
        (void)b;
        return first * above < 0 || second * above < 0;
    }

    // Reading findings off the corners ------------------------------------------------------------------------------

    void classify(const Contacts& contacts) {
        bool pierced = false;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> crossings;
        for (const Contact& c : contacts) {
            if (is_vertex(c.first) && is_vertex(c.second)) continue;
            if (is_vertex(c.first)) {
                found_vertex(simplex(a_).vertices[c.first], b_, c.second);
            } else if (is_vertex(c.second)) {
                found_vertex(simplex(b_).vertices[c.second], a_, c.first);
            } else {
                const std::uint32_t s = is_edge(c.first) ? side(a_, c.first) : no_index;
                const std::uint32_t t = is_edge(c.second) ? side(b_, c.second) : no_index;
                pierced = pierced || s == no_index || t == no_index;
                if (s != no_index && t != no_index) crossings.emplace_back(std::min(s, t), std::max(s, t));
            }
        }
        if (contacts.count > 2) {
            found_pair(FindingKind::overlapping_facets);
            return;
        }
        for (const auto& [s, t] : crossings) found(FindingKind::crossing_segments, s, t);
        if (contacts.count == 1 && pierced) found_crossing();
        if (contacts.count == 2) classify_line(contacts.list[0], contacts.list[1]);
    }

    void found_vertex(std::uint32_t v, std::uint32_t piece, Feature place) {
        const std::uint32_t s = is_edge(place) ? side(piece, place) : no_index;
        if (s != no_index) {
            found(FindingKind::point_on_segment, v, s);
        } else {
            found(FindingKind::point_on_facet, v, owner(piece));
        }
    }

    void found_pair(FindingKind kind) { found(kind, std::min(owner(a_), owner(b_)), std::max(owner(a_), owner(b_))); }

    void found_crossing() {
        if (simplex(a_).size == 3 && simplex(b_).size == 3) {
            found_pair(FindingKind::crossing_facets);
        } else if (simplex(a_).size == 3) {
            found(FindingKind::segment_crosses_facet, owner(b_), owner(a_));
        } else {
            found(FindingKind::segment_crosses_facet, owner(a_), owner(b_));
        }
    }

    /// The pieces have a segment in common.
    void classify_line(const Contact& c, const Contact& d) {
        const Feature e = edge_with(simplex(a_), c.first, d.first), f = edge_with(simplex(b_), c.second, d.second);
        const std::uint32_t s = is_edge(e) ? side(a_, e) : no_index, t = is_edge(f) ? side(b_, f) : no_index;
        if (s != no_index && t != no_index) {
            // The same side, or a T-junction that found_vertex has reported.
            const bool mutual = is_vertex(c.first) != is_vertex(c.second) &&
                                is_vertex(d.first) != is_vertex(d.second) && is_vertex(c.first) != is_vertex(d.first);
            if (s != t && mutual) found(FindingKind::overlapping_segments, std::min(s, t), std::max(s, t));
        } else if (t != no_index) {
            found(FindingKind::segment_in_facet, t, owner(a_));
        } else if (s != no_index) {
            found(FindingKind::segment_in_facet, s, owner(b_));
        } else {
            found_pair(FindingKind::crossing_facets);
        }
    }

    const Complex& complex_;
    const Pieces& pieces_;
    std::uint32_t a_ = 0, b_ = 0;
};

Box box_of(const Complex& complex, const Pieces& pieces, std::uint32_t piece) {
    const Simplex& s = pieces.simplices[piece];
    Box box{complex.points[s.vertices[0]], complex.points[s.vertices[0]]};
    for (int i = 1; i < s.size; ++i) box.extend({complex.points[s.vertices[i]], complex.points[s.vertices[i]]});
    const double near =
        s.size == 3 ? pieces.near[pieces.owners[piece]] : near_of(complex.points, {s.vertices.data(), s.size});
    box.low = box.low - Point3{near, near, near};
    box.high = box.high + Point3{near, near, near};
    return box;
}

std::vector<Box> boxes_of(const Complex& complex, const Pieces& pieces) {
    std::vector<Box> boxes(pieces.simplices.size());
    core::parallel_for(boxes.size(), 4096, {}, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            boxes[i] = box_of(complex, pieces, static_cast<std::uint32_t>(i));
        }
    });
    return boxes;
}

/// 1 for pieces that may touch what they should not. Points are vertices of the known complex, if there is one.
std::vector<std::uint8_t> find_active(const Pieces& pieces, const KnownClean& known) {
    std::vector<std::uint8_t> active(pieces.simplices.size(), 1);
    for (std::size_t i = 0; i < active.size(); ++i) {
        const std::uint32_t owner = pieces.owners[i];
        switch (pieces.simplices[i].size) {
            case 3:
                active[i] = owner >= known.facets.size() || known.facets[owner] == 0;
                break;
            case 2:
                active[i] = owner >= known.segments.size() || known.segments[owner] == 0;
                break;
            default:
                active[i] = known.facets.empty() && known.segments.empty();
        }
    }
    return active;
}

}  // namespace

Feature edge_with(const Simplex& s, Feature f, Feature g) {
    for (int i = 0; i < (s.size == 3 ? 3 : s.size - 1); ++i) {
        const int j = i + 1 < s.size ? i + 1 : 0;
        const auto edge = static_cast<Feature>(first_edge + i);
        const auto has = [&](Feature x) { return x == edge || x == i || x == j; };
        if (has(f) && has(g)) return edge;
    }
    return inside;
}

std::uint32_t side_along(const Complex& complex, const Pieces& pieces, std::uint32_t piece, Feature edge) {
    const Simplex& s = pieces.simplices[piece];
    const std::uint32_t owner = pieces.owners[piece];
    if (s.size == 2) return owner;
    const auto ends = ends_of(s, edge);
    const auto sides = complex.facet_sides[owner];
    if (sides.size() == 3) {  // nearly always a triangle with its sides in order
        const std::uint32_t guess = sides[edge - first_edge].segment;
        const auto& found = complex.segments[guess];
        if ((found[0] == ends[0] && found[1] == ends[1]) || (found[0] == ends[1] && found[1] == ends[0])) return guess;
    }
    const std::uint32_t segment = find_segment(complex, ends[0], ends[1]);
    return segment != no_index && has_side(complex, segment, owner) ? segment : no_index;
}

std::vector<Finding> find_findings(const Complex& complex, const Pieces& pieces, const KnownClean& known,
                                   bool every_piece) {
    const std::vector<std::uint8_t> active = find_active(pieces, known);
    if (std::find(active.begin(), active.end(), 1) == active.end()) return {};
    const BoxTree tree(boxes_of(complex, pieces), active);
    tbb::enumerable_thread_specific<PairTester> testers([&] { return PairTester(complex, pieces); });
    core::parallel_for(tree.leaf_count(), 16, {}, [&](std::size_t first, std::size_t last) {
        PairTester& tester = testers.local();
        for (std::size_t leaf = first; leaf < last; ++leaf) {
            tree.visit_pairs(leaf, [&](std::uint32_t i, std::uint32_t j) { tester.test(i, j); });
        }
    });
    std::vector<Finding> findings;
    for (const PairTester& tester : testers) {
        findings.insert(findings.end(), tester.findings.begin(), tester.findings.end());
    }
    std::sort(findings.begin(), findings.end());
    if (every_piece) return findings;
    const auto same = [](const Finding& f, const Finding& g) {
        return f.kind == g.kind && f.first == g.first && f.second == g.second;
    };
    findings.erase(std::unique(findings.begin(), findings.end(), same), findings.end());
    return findings;
}

Point3 place_of(const Complex& complex, const Pieces& pieces, const Finding& finding) {
    switch (finding.kind) {
        case FindingKind::point_on_segment:
        case FindingKind::point_on_facet:
        case FindingKind::point_near_segment:
        case FindingKind::point_near_facet:
            return complex.points[finding.first];
        case FindingKind::segment_near_facet: {
            const bool first =
                pieces.simplices[finding.piece_a].size == 3 && pieces.owners[finding.piece_a] == finding.second;
            const auto& ends = complex.segments[finding.first];
            return clip_to_piece(complex, pieces, first ? finding.piece_a : finding.piece_b, ends,
                                 pieces.near[finding.second])
                .value_or(complex.points[ends[0]]);
        }
        default:
            break;
    }
    const Simplex &a = pieces.simplices[finding.piece_a], &b = pieces.simplices[finding.piece_b];
    Point3 sum;
    int count = 0;
    for (const Contact& contact : find_contacts(complex.points, a, b)) {
        // Of two segments that cross, the point itself; of everything else, the middle.
        const bool crossing = is_edge(contact.first) && is_edge(contact.second);
        if (finding.kind == FindingKind::crossing_segments && !crossing) continue;
        const Point3 p = place_of(complex.points, a, b, contact);
        sum = sum + p;
        ++count;
        if (finding.kind == FindingKind::crossing_segments) break;
    }
    return count == 0 ? complex.points[a.vertices[0]] : (1.0 / count) * sum;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> find_places_on_facets(const Complex& complex, const Pieces& pieces,
                                                                           std::span<const Point3> places) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> result;
    if (places.empty()) return result;
    const BoxTree tree(boxes_of(complex, pieces), {});
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        tree.visit_overlapping({places[i], places[i]}, [&](std::uint32_t piece) {
            if (pieces.simplices[piece].size == 3 &&
                is_on_triangle(complex.points, pieces.simplices[piece], places[i])) {
                result.emplace_back(i, pieces.owners[piece]);
            }
        });
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

}  // namespace certa::conforming
