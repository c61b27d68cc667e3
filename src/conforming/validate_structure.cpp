// Defects that show without looking at where facets lie: arrays that do not fit together, indices out of range,
// coordinates that are no numbers, points that coincide, sides without length, facets without area, facets given twice.
//
// Each check is one pass; a later check runs only when the ones that it relies on found nothing.

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "conforming/validate.h"
#include "conforming/validate_messages.h"
#include "core/parallel.h"
#include "exact/orientation.h"

namespace certa::conforming {
namespace {

/// Predicates and constructions work with products of up to five differences: this range keeps them from over- and
/// underflowing with room to spare.
constexpr double largest_coordinate = 1e50;

using Ids = std::vector<std::uint32_t>;

class StructureCheck {
public:
    StructureCheck(const PiecewiseLinearComplex& input, ValidationReport& report) : input_(input), report_(report) {}

    void run() {
        if (!check_arrays() || !check_indices() || !check_coordinates()) {
            report_.buildable = false;
            return;
        }
        if (input_.positions.empty()) {
            report_.add({DefectKind::empty_input, {}, {}, "the input has no points; give at least four"});
            report_.buildable = false;
            return;
        }
        find_used_points();
        check_duplicates();
        check_segments();
        check_polygons();
        check_areas();
        check_repeated_facets();
    }

private:
    const Point3& at(std::uint32_t corner) const { return input_.positions[index_of(input_.corners[corner])]; }
    std::uint32_t id(std::uint32_t corner) const { return first_[index_of(input_.corners[corner])]; }

    bool refuse_arrays(const std::string& what) {
        report_.add({DefectKind::index_out_of_range, {}, {}, what});
        return false;
    }

    bool check_offsets(const std::vector<std::uint32_t>& offsets, std::size_t size, const char* name,
                       const char* target) {
        const bool sound = !offsets.empty() && offsets.front() == 0 && std::is_sorted(offsets.begin(), offsets.end()) &&
                           offsets.back() == size;
        return sound || refuse_arrays(std::string(name) + " must start at 0, never fall, and end at the number of " +
                                      target + " (" + std::to_string(size) + ")");
    }

    bool check_markers(std::size_t have, std::size_t want, const char* name) {
        return have == 0 || have == want ||
               refuse_arrays(std::string(name) + " has " + std::to_string(have) + " entries for " +
                             std::to_string(want) + " elements; give one each or none at all");
    }

    bool check_arrays() {
        if (input_.positions.size() >= no_index || input_.corners.size() >= no_index) {
            return refuse_arrays("more than 4294967294 points or corners cannot be numbered");
        }
        const bool polygons =
            check_offsets(input_.polygon_offsets, input_.corners.size(), "polygon_offsets", "corners") &&
            check_offsets(input_.facet_offsets, input_.polygon_offsets.size() - 1, "facet_offsets", "polygons") &&
            check_offsets(input_.hole_offsets, input_.facet_holes.size(), "hole_offsets", "hole points");
        if (!polygons) return false;
        if (input_.hole_offsets.size() != input_.facet_offsets.size()) {
            return refuse_arrays("hole_offsets has " + std::to_string(input_.hole_offsets.size()) +
                                 " entries; it needs one more than there are facets, as facet_offsets has");
        }
        return check_markers(input_.point_markers.size(), input_.positions.size(), "point_markers") &&
               check_markers(input_.segment_markers.size(), input_.segments.size(), "segment_markers") &&
               check_markers(input_.facet_markers.size(), input_.facet_count(), "facet_markers");
    }

    bool check_index(VertexId v, ElementKind kind, std::size_t element) {
        if (index_of(v) < input_.positions.size()) return true;
        const auto index = static_cast<std::uint32_t>(element);
        report_.add({DefectKind::index_out_of_range,
                     {{kind, index}},
                     {},
                     name_element(kind, index) + " names " + vertex_name(index_of(v)) + ", but there are " +
                         std::to_string(input_.positions.size()) + " points"});
        return false;
    }

    bool check_indices() {
        bool fine = true;
        for (std::size_t s = 0; s < input_.segments.size(); ++s) {
            for (const VertexId v : input_.segments[s]) fine = check_index(v, ElementKind::segment, s) && fine;
        }
        for (std::size_t f = 0; f < input_.facet_count(); ++f) {
            const std::uint32_t begin = input_.polygon_offsets[input_.facet_offsets[f]];
            const std::uint32_t end = input_.polygon_offsets[input_.facet_offsets[f + 1]];
            for (std::uint32_t c = begin; c < end; ++c) {
                fine = check_index(input_.corners[c], ElementKind::facet, f) && fine;
            }
        }
        return fine;
    }

    bool check_point(const Point3& p, const std::string& name, std::vector<ElementRef> elements) {
        const double largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
        if (finite && largest <= largest_coordinate) return true;
        report_.add({finite ? DefectKind::coordinate_out_of_range : DefectKind::non_finite_coordinate,
                     std::move(elements), p,
                     name + " is at " + name_place(p) +
                         (finite ? "; coordinates beyond 1e50 cannot be meshed reliably: choose another unit"
                                 : "; coordinates must be finite numbers")});
        return false;
    }

    bool check_coordinates() {
        bool fine = true;
        for (std::uint32_t v = 0; v < input_.positions.size(); ++v) {
            const Point3& p = input_.positions[v];
            const double largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
            if (largest <= largest_coordinate && p.x == p.x && p.y == p.y && p.z == p.z) continue;
            fine = check_point(p, vertex_name(v), {{ElementKind::vertex, v}}) && fine;
        }
        for (std::uint32_t f = 0; f + 1 < input_.hole_offsets.size(); ++f) {
            for (std::uint32_t h = input_.hole_offsets[f]; h < input_.hole_offsets[f + 1]; ++h) {
                fine =
                    check_point(input_.facet_holes[h], "a hole point of " + facet_name(f), {{ElementKind::facet, f}}) &&
                    fine;
            }
        }
        for (std::size_t i = 0; i < input_.region_holes.size(); ++i) {
            fine = check_point(input_.region_holes[i], "region hole " + std::to_string(i + 1), {}) && fine;
        }
        for (std::size_t i = 0; i < input_.region_seeds.size(); ++i) {
            fine = check_point(input_.region_seeds[i].place, "region seed " + std::to_string(i + 1), {}) && fine;
        }
        return fine && check_extent();
    }

    /// A complex smaller than 1e-50 underflows; one point (extent zero) is left to the mesher.
    bool check_extent() {
        if (input_.positions.empty()) return true;
        Point3 low = input_.positions[0], high = low;
        for (const Point3& p : input_.positions) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
        if (extent == 0.0 || extent >= 1.0 / largest_coordinate) return true;
        report_.add(
            {DefectKind::coordinate_out_of_range,
             {},
             low,
             "the points lie within " + name_number(extent) +
                 " of each other; a complex smaller than 1e-50 cannot be meshed reliably: choose another unit"});
        return false;
    }

    void find_used_points() {
        used_.assign(input_.positions.size(), 0);
        for (const Edge& e : input_.segments) used_[index_of(e[0])] = used_[index_of(e[1])] = 1;
        for (const VertexId v : input_.corners) used_[index_of(v)] = 1;
    }

    static std::uint64_t hash_of(const Point3& p) {
        std::uint64_t h = 0;
        for (const double x : {p.x, p.y, p.z}) {
            h = (h ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15ull;  // -0.0 + 0.0 is 0.0
            h ^= h >> 32;
        }
        return h;
    }

    /// first_[v]: the lowest point at the same place.
    void find_first_points() {
        const auto count = static_cast<std::uint32_t>(input_.positions.size());
        std::vector<std::uint32_t> slots(std::bit_ceil(std::size_t{2} * count + 16), no_index);
        first_.resize(count);
        for (std::uint32_t v = 0; v < count; ++v) {
            std::size_t i = hash_of(input_.positions[v]) & (slots.size() - 1);
            while (slots[i] != no_index && !(input_.positions[slots[i]] == input_.positions[v])) {
                i = (i + 1) & (slots.size() - 1);
            }
            if (slots[i] == no_index) slots[i] = v;
            first_[v] = slots[i];
        }
    }

    void check_duplicates() {
        find_first_points();
        std::vector<std::pair<std::uint32_t, std::uint32_t>> repeats;  // first point at the place, another one
        for (std::uint32_t v = 0; v < first_.size(); ++v) {
            if (first_[v] != v) repeats.emplace_back(first_[v], v);
        }
        std::sort(repeats.begin(), repeats.end());
        for (std::size_t begin = 0, end = 0; begin < repeats.size(); begin = end) {
            Ids group{repeats[begin].first};
            for (end = begin; end < repeats.size() && repeats[end].first == group[0]; ++end) {
                group.push_back(repeats[end].second);
            }
            report_group(group);
        }
    }

    /// The kept point of a group is the lowest used one; other used ones are defects, unused ones are ignored.
    void report_group(const Ids& group) {
        const auto used = std::find_if(group.begin(), group.end(), [&](std::uint32_t v) { return used_[v] != 0; });
        const std::uint32_t kept = used == group.end() ? group[0] : *used;
        for (const std::uint32_t v : group) {
            if (v == kept) continue;
            const std::string text =
                vertex_name(v) + " repeats " + vertex_name(kept) + " at " + name_place(input_.positions[v]);
            const std::vector<ElementRef> elements{{ElementKind::vertex, kept}, {ElementKind::vertex, v}};
            if (used_[v]) {
                report_.add({DefectKind::duplicate_point, elements, input_.positions[v],
                             text + "; merge them, or use --repair"});
            } else {
                report_.ignored_points.push_back(v);
                report_.notes.push_back({DefectKind::duplicate_point, elements, input_.positions[v],
                                         text + " and nothing uses it; it is kept, in no tetrahedron"});
            }
        }
    }

    void check_segments() {
        std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
        for (std::uint32_t s = 0; s < input_.segments.size(); ++s) {
            const auto [a, b] = input_.segments[s];
            const std::uint32_t i = first_[index_of(a)], j = first_[index_of(b)];
            if (i == j) {
                report_.add({DefectKind::degenerate_segment,
                             {{ElementKind::segment, s}, {ElementKind::vertex, index_of(a)}},
                             input_.positions[i],
                             segment_name(s) + " has no length: both ends are at " + vertex_name(index_of(a)) +
                                 "; remove it, or use --repair"});
            } else {
                keys.emplace_back(std::uint64_t{std::min(i, j)} << 32 | std::max(i, j), s);
            }
        }
        std::sort(keys.begin(), keys.end());
        for (std::size_t begin = 0, i = 1; i < keys.size(); ++i) {
            if (keys[i].first != keys[begin].first) {
                begin = i;
                continue;
            }
            const std::uint32_t s = keys[begin].second, t = keys[i].second;
            const Edge& e = input_.segments[t];
            const Point3 &p = input_.positions[index_of(e[0])], &q = input_.positions[index_of(e[1])];
            report_.add({DefectKind::overlapping_segments,
                         {{ElementKind::segment, s}, {ElementKind::segment, t}},
                         {0.5 * (p.x + q.x), 0.5 * (p.y + q.y), 0.5 * (p.z + q.z)},
                         segment_name(t) + " repeats " + segment_name(s) + "; remove it, or use --repair"});
        }
    }

    void check_polygons() {
        for (std::uint32_t f = 0; f < input_.facet_count(); ++f) {
            for (std::uint32_t p = input_.facet_offsets[f]; p < input_.facet_offsets[f + 1]; ++p) {
                check_polygon(f, p);
            }
        }
    }

    void check_polygon(std::uint32_t f, std::uint32_t p) {
        const std::uint32_t begin = input_.polygon_offsets[p], n = input_.polygon_offsets[p + 1] - begin;
        if (n == 0) {
            report_.add({DefectKind::degenerate_facet,
                         {{ElementKind::facet, f}, {ElementKind::polygon, p}},
                         {},
                         name_element(ElementKind::polygon, p) + " of " + facet_name(f) +
                             " has no vertices; remove it, or use --repair"});
            return;
        }
        for (std::uint32_t i = 0; n > 1 && i < (n == 2 ? 1 : n); ++i) {
            const std::uint32_t a = begin + i, b = begin + (i + 1) % n;
            if (id(a) != id(b)) continue;
            const std::uint32_t v = index_of(input_.corners[a]);
            report_.add({n == 2 ? DefectKind::degenerate_segment : DefectKind::repeated_vertex_in_polygon,
                         {{ElementKind::facet, f}, {ElementKind::vertex, v}},
                         at(a),
                         facet_name(f) + " has a side without length at " + vertex_name(v) + ' ' + name_place(at(a)) +
                             "; list the vertex once, or use --repair"});
        }
    }

    bool has_area(std::uint32_t f) const {
        for (std::uint32_t p = input_.facet_offsets[f]; p < input_.facet_offsets[f + 1]; ++p) {
            const std::uint32_t begin = input_.polygon_offsets[p], end = input_.polygon_offsets[p + 1];
            if (end - begin < 3) continue;
            std::uint32_t second = begin + 1;
            while (second < end && at(second) == at(begin)) ++second;
            for (std::uint32_t i = second + 1; i < end; ++i) {
                if (!exact::are_collinear(at(begin), at(second), at(i))) return true;
            }
        }
        return false;
    }

    bool has_ring(std::uint32_t f) const {
        for (std::uint32_t p = input_.facet_offsets[f]; p < input_.facet_offsets[f + 1]; ++p) {
            if (input_.polygon_offsets[p + 1] - input_.polygon_offsets[p] >= 3) return true;
        }
        return false;
    }

    void check_areas() {
        const std::size_t facets = input_.facet_count();
        flat_.assign(facets, 0);
        core::parallel_for(facets, 1024, {}, [&](std::size_t first, std::size_t last) {
            for (auto f = static_cast<std::uint32_t>(first); f < last; ++f) flat_[f] = has_ring(f) && !has_area(f);
        });
        for (std::uint32_t f = 0; f < facets; ++f) {
            if (!flat_[f]) continue;
            const std::uint32_t corner = input_.polygon_offsets[input_.facet_offsets[f]];
            report_.add({DefectKind::degenerate_facet,
                         {{ElementKind::facet, f}},
                         at(corner),
                         facet_name(f) + " has no area: its vertices lie on one line through " +
                             name_place(at(corner)) + "; remove it, or use --repair"});
        }
    }

    static std::uint64_t mix(std::uint64_t k) {
        k = (k ^ (k >> 33)) * 0xff51afd7ed558ccdull;
        k = (k ^ (k >> 33)) * 0xc4ceb9fe1a85ec53ull;
        return k ^ (k >> 33);
    }

    template <class Visit>
    void visit_sides(std::uint32_t f, Visit visit) const {
        for (std::uint32_t p = input_.facet_offsets[f]; p < input_.facet_offsets[f + 1]; ++p) {
            const std::uint32_t begin = input_.polygon_offsets[p], n = input_.polygon_offsets[p + 1] - begin;
            for (std::uint32_t i = 0; i < n; ++i) {
                const std::uint32_t a = id(begin + i), b = id(begin + (i + 1) % n);
                visit(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b));
            }
        }
    }

    std::vector<std::uint64_t> sorted_sides(std::uint32_t f) const {
        std::vector<std::uint64_t> sides;
        visit_sides(f, [&](std::uint64_t key) { sides.push_back(key); });
        std::sort(sides.begin(), sides.end());
        return sides;
    }

    bool has_same_holes(std::uint32_t f, std::uint32_t g) const {
        const auto begin = input_.facet_holes.begin();
        return std::equal(begin + input_.hole_offsets[f], begin + input_.hole_offsets[f + 1],
                          begin + input_.hole_offsets[g], begin + input_.hole_offsets[g + 1]);
    }

    /// Facets with the same sides and holes, by a hash that does not depend on the order of the sides.
    void check_repeated_facets() {
        const auto facets = static_cast<std::uint32_t>(input_.facet_count());
        std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(facets);
        core::parallel_for(facets, 1024, {}, [&](std::size_t first, std::size_t last) {
            for (auto f = static_cast<std::uint32_t>(first); f < last; ++f) {
                std::uint64_t sum = 0;
                visit_sides(f, [&](std::uint64_t key) { sum += mix(key); });
                keys[f] = {sum, f};
            }
        });
        std::sort(keys.begin(), keys.end());
        std::vector<std::pair<std::uint32_t, std::uint32_t>> repeats;
        for (std::size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
            while (end < keys.size() && keys[end].first == keys[begin].first) ++end;
            if (end - begin > 1) find_repeats(keys, begin, end, repeats);
        }
        std::sort(repeats.begin(), repeats.end());
        for (const auto& [f, g] : repeats) {
            const Point3 place = at(input_.polygon_offsets[input_.facet_offsets[g]]);
            report_.add({DefectKind::repeated_facet,
                         {{ElementKind::facet, f}, {ElementKind::facet, g}},
                         place,
                         facet_name(g) + " has the same sides as " + facet_name(f) + ", near " + name_place(place) +
                             "; remove one of them, or use --repair"});
        }
    }

    void find_repeats(const std::vector<std::pair<std::uint64_t, std::uint32_t>>& keys, std::size_t begin,
                      std::size_t end, std::vector<std::pair<std::uint32_t, std::uint32_t>>& repeats) const {
        std::vector<std::pair<std::uint32_t, std::vector<std::uint64_t>>> distinct;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t f = keys[i].second;
            if (flat_[f] || !has_ring(f)) continue;
            std::vector<std::uint64_t> sides = sorted_sides(f);
            const auto same = std::find_if(distinct.begin(), distinct.end(), [&](const auto& other) {
                return other.second == sides && has_same_holes(other.first, f);
            });
            if (same != distinct.end()) {
                repeats.emplace_back(same->first, f);
            } else {
                distinct.emplace_back(f, std::move(sides));
            }
        }
    }

    const PiecewiseLinearComplex& input_;
    ValidationReport& report_;
    std::vector<std::uint8_t> used_, flat_;
    Ids first_;
};

}  // namespace

void ValidationReport::append(ValidationReport other) {
    const std::size_t dropped = other.defect_count - other.defects.size();
    for (Defect& defect : other.defects) add(std::move(defect));
    defect_count += dropped;
    for (Defect& note : other.notes) notes.push_back(std::move(note));
    adopted_points.insert(adopted_points.end(), other.adopted_points.begin(), other.adopted_points.end());
    adopted_segments.insert(adopted_segments.end(), other.adopted_segments.begin(), other.adopted_segments.end());
    ignored_points.insert(ignored_points.end(), other.ignored_points.begin(), other.ignored_points.end());
    buildable = buildable && other.buildable;
}

ValidationReport validate_structure(const PiecewiseLinearComplex& input, std::size_t max_kept) {
    ValidationReport report;
    report.max_kept = max_kept;
    StructureCheck(input, report).run();
    return report;
}

}  // namespace certa::conforming
