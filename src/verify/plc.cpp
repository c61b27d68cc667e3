// Reads the input complex: checks indices, numbers segments, finds the sides of facets, merges coplanar facets.
// A facet of one ring without repeated corners and without hole points lies to the left of its sides (Newell's normal
// of a simple polygon sees it counter-clockwise); every other facet goes through arrange_rings.
#include "verify/plc.h"

#include <certa/error.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

namespace certa::verify {
namespace {

bool is_finite(const Point3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Collects what makes the complex unreadable.
class ComplexReader {
public:
    explicit ComplexReader(const PiecewiseLinearComplex& complex) : complex_(complex) {}

    void read() {
        check_offsets(complex_.polygon_offsets, complex_.corners.size(), "polygon_offsets");
        check_offsets(complex_.facet_offsets, complex_.polygon_offsets.size() - 1, "facet_offsets");
        std::vector<std::uint32_t> holes = complex_.hole_offsets;
        if (holes.size() != complex_.facet_offsets.size()) {
            fail(DefectKind::index_out_of_range, {}, {}, "hole_offsets must have one entry more than there are facets");
        } else {
            check_offsets(holes, complex_.facet_holes.size(), "hole_offsets");
        }
        for (const auto* markers : {&complex_.facet_markers}) {
            if (!markers->empty() && markers->size() + 1 != complex_.facet_offsets.size()) {
                fail(DefectKind::index_out_of_range, {}, {}, "facet_markers must be empty or have one entry per facet");
            }
        }
        check_points();
        check_segments();
        if (defects_.empty()) check_polygons();
        if (!defects_.empty()) throw InputError(std::move(defects_));
    }

private:
    void fail(DefectKind kind, std::vector<ElementRef> elements, const Point3& place, std::string message) {
        if (defects_.size() < 1000) defects_.push_back({kind, std::move(elements), place, std::move(message)});
    }
    void check_offsets(const std::vector<std::uint32_t>& offsets, std::size_t end, const std::string& name) {
        if (offsets.empty() || offsets.front() != 0 || offsets.back() != end ||
            !std::is_sorted(offsets.begin(), offsets.end())) {
            fail(DefectKind::index_out_of_range, {}, {},
                 name + " must rise from 0 to " + std::to_string(end) + ", the length of what it divides");
            throw InputError(std::move(defects_));
        }
    }
    void check_points() {
        const auto check = [&](const std::vector<Point3>& points, const std::string& what) {
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (is_finite(points[i])) continue;
                fail(DefectKind::non_finite_coordinate, {}, points[i],
                     what + ' ' + std::to_string(i + 1) +
                         " of the complex has a coordinate that is not a finite number");
            }
        };
        check(complex_.positions, "point");
        check(complex_.facet_holes, "facet hole");
        check(complex_.region_holes, "region hole");
    }
    bool check_index(VertexId v, const std::string& what) {
        if (index_of(v) < complex_.positions.size()) return true;
        fail(DefectKind::index_out_of_range, {}, {},
             what + " names point " + std::to_string(std::uint64_t{index_of(v)} + 1) + ", but there are " +
                 std::to_string(complex_.positions.size()));
        return false;
    }
    void check_segments() {
        for (std::uint32_t s = 0; s < complex_.segments.size(); ++s) {
            const Edge& e = complex_.segments[s];
            const std::string what = "segment " + std::to_string(s + 1);
            if (!check_index(e[0], what) || !check_index(e[1], what) || e[0] != e[1]) continue;
            fail(DefectKind::degenerate_segment, {{ElementKind::segment, s}}, complex_.positions[index_of(e[0])],
                 what + " joins a point to itself");
        }
    }
    void check_polygons() {
        for (std::uint32_t p = 0; p < complex_.polygon_count(); ++p) {
            const std::uint32_t begin = complex_.polygon_offsets[p], end = complex_.polygon_offsets[p + 1];
            const std::string what = "polygon " + std::to_string(p + 1);
            bool valid = true;
            for (std::uint32_t i = begin; i < end; ++i) valid = check_index(complex_.corners[i], what) && valid;
            if (!valid || end - begin < 2) continue;
            for (std::uint32_t i = begin; i < end; ++i) {
                const VertexId a = complex_.corners[i], b = complex_.corners[i + 1 < end ? i + 1 : begin];
                if (a != b) continue;
                fail(DefectKind::repeated_vertex_in_polygon, {{ElementKind::polygon, p}},
                     complex_.positions[index_of(a)], what + " has a side that joins a point to itself");
            }
        }
    }

    const PiecewiseLinearComplex& complex_;
    std::vector<Defect> defects_;
};

/// One facet that is a single ring without repeated corners, without hole points.
bool is_plain(const PiecewiseLinearComplex& complex, std::uint32_t facet) {
    if (complex.hole_offsets[facet + 1] > complex.hole_offsets[facet]) return false;
    std::size_t rings = 0;
    for (std::uint32_t p = complex.facet_offsets[facet]; p < complex.facet_offsets[facet + 1]; ++p) {
        const auto begin = complex.corners.begin() + complex.polygon_offsets[p];
        const auto end = complex.corners.begin() + complex.polygon_offsets[p + 1];
        if (end - begin < 3) continue;
        if (++rings > 1) return false;
        if (end - begin == 3) {
            if (begin[0] == begin[1] || begin[1] == begin[2] || begin[2] == begin[0]) return false;
            continue;
        }
        std::vector<VertexId> sorted(begin, end);
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return false;
    }
    return true;
}

/// Sides of single facets, before merging; numbers the segments on the way.
struct FacetSides {
    std::vector<std::uint64_t> offsets{0};
    std::vector<PlcSide> sides;
};

class SideReader {
public:
    SideReader(const PiecewiseLinearComplex& complex, Plc& plc) : complex_(complex), plc_(plc) {}

    FacetSides read() {
        for (const Edge& e : complex_.segments) number(index_of(e[0]), index_of(e[1]));
        FacetSides result;
        for (std::uint32_t f = 0; f < complex_.facet_count(); ++f) {
            row_.clear();
            read_polygons(f);
            if (row_.size() > searched) unite_row();
            if (!is_plain(complex_, f)) cover_rings(f);
            result.sides.insert(result.sides.end(), row_.begin(), row_.end());
            result.offsets.push_back(result.sides.size());
        }
        return result;
    }

private:
    static constexpr std::size_t searched = 16;

    std::uint32_t number(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t known = plc_.segment_of_ends.find(a, b);
        if (known != no_index) return known;
        const auto fresh = static_cast<std::uint32_t>(plc_.segments.size());
        plc_.segment_of_ends.set(a, b, fresh);
        plc_.segments.push_back({a, b});
        return fresh;
    }
    /// Every side once; rings counted as if the facet lay to their left.
    void read_polygons(std::uint32_t facet) {
        for (std::uint32_t p = complex_.facet_offsets[facet]; p < complex_.facet_offsets[facet + 1]; ++p) {
            const std::uint32_t begin = complex_.polygon_offsets[p], end = complex_.polygon_offsets[p + 1];
            if (end - begin < 2) continue;
            const std::uint32_t sides = end - begin == 2 ? 1 : end - begin;
            for (std::uint32_t i = 0; i < sides; ++i) {
                const std::uint32_t a = index_of(complex_.corners[begin + i]);
                const std::uint32_t b = index_of(complex_.corners[i + 1 < end - begin ? begin + i + 1 : begin]);
                const std::uint32_t s = number(a, b);
                const bool ring = sides > 1;
                add({s, static_cast<std::int8_t>(!ring ? 0 : plc_.segments[s][0] == a ? 1 : -1), ring, !ring});
            }
        }
    }
    void add(const PlcSide& side) {
        // Rows are short but for a few facets, and those are sorted instead.
        if (row_.size() <= searched) {
            for (PlcSide& known : row_) {
                if (known.segment != side.segment) continue;
                if (side.ring && !known.ring) known = side;
                return;
            }
        }
        row_.push_back(side);
    }
    void unite_row() {
        std::stable_sort(row_.begin(), row_.end(), [](const PlcSide& a, const PlcSide& b) {
            return a.segment != b.segment ? a.segment < b.segment : a.ring && !b.ring;
        });
        row_.erase(std::unique(row_.begin(), row_.end(),
                               [](const PlcSide& a, const PlcSide& b) { return a.segment == b.segment; }),
                   row_.end());
    }
    void cover_rings(std::uint32_t facet) {
        unite_row();
        const NewellNormal normal = facet_normal(complex_, facet);
        for (const RingEdge& edge : arrange_rings(complex_, facet, normal)) {
            const std::uint32_t s = plc_.segment_of_ends.find(edge.a, edge.b);
            const auto side = std::lower_bound(row_.begin(), row_.end(), s,
                                               [](const PlcSide& r, std::uint32_t key) { return r.segment < key; });
            const bool forward = plc_.segments[s][0] == edge.a;
            side->cover = static_cast<std::int8_t>((edge.left ? 1 : 0) - (edge.right ? 1 : 0));
            if (!forward) side->cover = static_cast<std::int8_t>(-side->cover);
            side->inner = edge.left && edge.right;
        }
    }

    const PiecewiseLinearComplex& complex_;
    Plc& plc_;
    std::vector<PlcSide> row_;
};

/// Calls visit(point) for every corner of a facet.
template <class Visit>
void for_each_corner(const PiecewiseLinearComplex& complex, std::uint32_t facet, const Visit& visit) {
    const std::uint32_t begin = complex.polygon_offsets[complex.facet_offsets[facet]];
    const std::uint32_t end = complex.polygon_offsets[complex.facet_offsets[facet + 1]];
    for (std::uint32_t i = begin; i < end; ++i) visit(index_of(complex.corners[i]));
}

/// Three corners of a facet that are not on one line, or nothing.
std::vector<Point3> find_plane(const PiecewiseLinearComplex& complex, std::uint32_t facet) {
    std::vector<Point3> plane;
    const std::uint32_t ring = first_ring(complex, facet);
    if (ring == no_index) return plane;
    const std::vector<Point3> points = ring_points(complex, ring);
    std::size_t second = 1;
    while (second < points.size() && points[second] == points[0]) ++second;
    for (std::size_t third = second + 1; third < points.size(); ++third) {
        const Point3 &a = points[0], &b = points[second], &c = points[third];
        // On a line exactly when all three coordinate projections are degenerate.
        const auto turn = [](const Point3& p, const Point3& q, const Point3& r) { return orientation_xy(p, q, r); };
        const auto cycle = [](const Point3& p) { return Point3{p.y, p.z, p.x}; };
        if (turn(a, b, c) == 0 && turn(cycle(a), cycle(b), cycle(c)) == 0 &&
            turn(cycle(cycle(a)), cycle(cycle(b)), cycle(cycle(c))) == 0) {
            continue;
        }
        return {a, b, c};
    }
    return plane;
}

bool are_coplanar(const PiecewiseLinearComplex& complex, std::uint32_t first, std::uint32_t second) {
    const std::vector<Point3> plane = find_plane(complex, first);
    if (plane.empty() || find_plane(complex, second).empty()) return false;
    bool coplanar = true;
    const auto test = [&](std::uint32_t v) {
        coplanar = coplanar && orientation(plane[0], plane[1], plane[2], complex.positions[v]) == 0;
    };
    for_each_corner(complex, first, test);
    for_each_corner(complex, second, test);
    return coplanar;
}

/// Merges coplanar neighbours: leaders, dropped segments.
void merge_facets(const PiecewiseLinearComplex& complex, const FacetSides& facets, Plc& plc, std::size_t given) {
    std::vector<std::array<std::uint32_t, 2>> users(plc.segments.size(), {no_index, no_index});
    std::vector<std::uint32_t> counts(plc.segments.size(), 0);
    for (std::uint32_t f = 0; f < plc.facet_count(); ++f) {
        for (std::uint64_t i = facets.offsets[f]; i < facets.offsets[f + 1]; ++i) {
            const PlcSide& side = facets.sides[i];
            if (counts[side.segment] < 2) users[side.segment][counts[side.segment]] = f;
            // A side that its facet does not end at cannot be what two facets have in common.
            counts[side.segment] += side.cover != 0 ? 1 : 3;
        }
    }
    const auto find = [&](std::uint32_t f) {
        while (plc.leaders[f] != f) f = plc.leaders[f] = plc.leaders[plc.leaders[f]];
        return f;
    };
    const auto marker = [&](std::uint32_t f) { return complex.facet_markers.empty() ? 0 : complex.facet_markers[f]; };
    for (auto s = static_cast<std::uint32_t>(given); s < plc.segments.size(); ++s) {
        if (counts[s] != 2 || users[s][0] == users[s][1] || marker(users[s][0]) != marker(users[s][1])) continue;
        if (!are_coplanar(complex, users[s][0], users[s][1])) continue;
        plc.dropped[s] = 1;
        const std::uint32_t a = find(users[s][0]), b = find(users[s][1]);
        plc.leaders[std::max(a, b)] = std::min(a, b);
    }
    for (std::uint32_t f = 0; f < plc.facet_count(); ++f) plc.leaders[f] = find(f);
}

/// Sides and points of groups, in the leader's orientation.
void collect_groups(const PiecewiseLinearComplex& complex, const FacetSides& facets, Plc& plc) {
    std::vector<std::vector<std::uint32_t>> members(plc.facet_count());
    bool merged = false;
    for (std::uint32_t f = 0; f < plc.facet_count(); ++f) {
        if (plc.leaders[f] == f) continue;
        members[plc.leaders[f]].push_back(f);
        merged = true;
    }
    std::map<std::uint32_t, PlcSide> united;
    std::vector<std::uint32_t> corners;
    for (std::uint32_t f = 0; f < plc.facet_count(); ++f) {
        if (plc.leaders[f] == f) {
            corners.clear();
            united.clear();
            const auto add_member = [&](std::uint32_t m, int sign) {
                for_each_corner(complex, m, [&](std::uint32_t v) { corners.push_back(v); });
                for (std::uint64_t i = facets.offsets[m]; i < facets.offsets[m + 1]; ++i) {
                    PlcSide side = facets.sides[i];
                    if (plc.dropped[side.segment]) continue;
                    side.cover = static_cast<std::int8_t>(sign * side.cover);
                    if (!merged || members[f].empty()) {
                        plc.sides.push_back(side);
                        continue;
                    }
                    auto [known, fresh] = united.try_emplace(side.segment, side);
                    if (fresh) continue;
                    PlcSide& k = known->second;
                    k.inner = k.inner || side.inner || (k.cover != 0 && k.cover == -side.cover);
                    k.cover = static_cast<std::int8_t>(k.cover + side.cover);
                    k.ring = k.ring || side.ring;
                }
            };
            add_member(f, 1);
            if (!members[f].empty()) {
                const NewellNormal normal = facet_normal(complex, f);
                for (const std::uint32_t m : members[f]) {
                    const std::uint32_t ring = first_ring(complex, m);
                    add_member(m, ring == no_index ? 1 : normal.turn(ring_points(complex, ring)));
                }
                for (const auto& [segment, side] : united) plc.sides.push_back(side);
            }
            std::sort(corners.begin(), corners.end());
            corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
            plc.points.insert(plc.points.end(), corners.begin(), corners.end());
        }
        plc.side_offsets.push_back(plc.sides.size());
        plc.point_offsets.push_back(plc.points.size());
    }
}

}  // namespace

Plc::Plc(const PiecewiseLinearComplex& complex, bool merge_coplanar) {
    ComplexReader(complex).read();
    const FacetSides facets = SideReader(complex, *this).read();
    dropped.assign(segments.size(), 0);
    leaders.resize(complex.facet_count());
    std::iota(leaders.begin(), leaders.end(), 0u);
    if (merge_coplanar) {
        std::size_t given = 0;
        for (const Edge& e : complex.segments) {
            given = std::max<std::size_t>(given, segment_of_ends.find(index_of(e[0]), index_of(e[1])) + std::size_t{1});
        }
        merge_facets(complex, facets, *this, given);
    }
    side_offsets.assign(1, 0);
    point_offsets.assign(1, 0);
    collect_groups(complex, facets, *this);
    is_isolated.assign(complex.positions.size(), 1);
    for (const auto& ends : segments) is_isolated[ends[0]] = is_isolated[ends[1]] = 0;
    for (const VertexId v : complex.corners) is_isolated[index_of(v)] = 0;
}

std::vector<Point3> ring_points(const PiecewiseLinearComplex& complex, std::uint32_t polygon) {
    std::vector<Point3> points;
    for (std::uint32_t i = complex.polygon_offsets[polygon]; i < complex.polygon_offsets[polygon + 1]; ++i) {
        points.push_back(complex.positions[index_of(complex.corners[i])]);
    }
    return points;
}

std::vector<Point3> facet_corners(const PiecewiseLinearComplex& complex, std::uint32_t facet) {
    std::vector<Point3> points;
    for_each_corner(complex, facet, [&](std::uint32_t v) { points.push_back(complex.positions[v]); });
    return points;
}

std::uint32_t first_ring(const PiecewiseLinearComplex& complex, std::uint32_t facet) {
    for (std::uint32_t p = complex.facet_offsets[facet]; p < complex.facet_offsets[facet + 1]; ++p) {
        if (complex.polygon_offsets[p + 1] - complex.polygon_offsets[p] >= 3) return p;
    }
    return no_index;
}

NewellNormal facet_normal(const PiecewiseLinearComplex& complex, std::uint32_t facet) {
    const std::uint32_t ring = first_ring(complex, facet);
    return NewellNormal(ring == no_index ? std::vector<Point3>{} : ring_points(complex, ring));
}

}  // namespace certa::verify
