// The first step of a repair, of which nothing can go wrong: points that coincide, sides without length, facets without
// area, facets given twice. What goes is emptied, not removed, so that points and facets keep their numbers.
#include <algorithm>
#include <limits>
#include <set>

#include "conforming/repair.h"
#include "conforming/repair_edit.h"
#include "conforming/validate.h"
#include "conforming/validate_messages.h"

namespace certa::conforming {
namespace {

class StructureCleaner {
public:
    explicit StructureCleaner(const PiecewiseLinearComplex& input) : input_(input), edited_(take_apart(input)) {}

    CleanedComplex run() {
        const ValidationReport report = validate_structure(input_, std::numeric_limits<std::size_t>::max());
        if (report.ok()) return {input_, {}};
        merge_points(report);
        clean_segments();
        for (std::uint32_t f = 0; f < edited_.facets.size(); ++f) clean_polygons(f);
        for (const Defect& defect : report.defects) {
            if (defect.kind == DefectKind::degenerate_facet && defect.elements.size() == 1) {
                empty_facet(defect.elements[0].index, defect, " has no area and was dropped");
            } else if (defect.kind == DefectKind::repeated_facet) {
                empty_facet(defect.elements[1].index, defect,
                            " repeats " + facet_name(defect.elements[0].index) + " and was dropped");
            }
        }
        return {put_together(edited_, input_), std::move(repairs_)};
    }

private:
    void say(DefectKind kind, std::vector<ElementRef> elements, const Point3& place, std::string message) {
        repairs_.push_back({kind, std::move(elements), place, std::move(message)});
    }

    void merge_points(const ValidationReport& report) {
        std::vector<std::uint32_t> kept(edited_.points.size());
        for (std::uint32_t v = 0; v < kept.size(); ++v) kept[v] = v;
        for (const Defect& defect : report.defects) {
            if (defect.kind != DefectKind::duplicate_point) continue;
            const std::uint32_t first = defect.elements[0].index, v = defect.elements[1].index;
            kept[v] = first;
            say(DefectKind::duplicate_point, defect.elements, defect.place,
                vertex_name(v) + " at " + name_place(defect.place) + " was merged into " + vertex_name(first));
        }
        for (auto& segment : edited_.segments) segment = {kept[segment[0]], kept[segment[1]]};
        for (EditableFacet& facet : edited_.facets) {
            for (auto& polygon : facet.polygons) {
                for (std::uint32_t& v : polygon) v = kept[v];
            }
        }
    }

    void clean_segments() {
        std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
        std::vector<std::array<std::uint32_t, 2>> segments;
        std::vector<std::int32_t> markers;
        for (std::uint32_t s = 0; s < edited_.segments.size(); ++s) {
            const auto [a, b] = edited_.segments[s];
            const bool fresh = a != b && seen.emplace(std::min(a, b), std::max(a, b)).second;
            if (fresh) {
                segments.push_back({a, b});
                markers.push_back(edited_.segment_markers[s]);
                continue;
            }
            say(a == b ? DefectKind::degenerate_segment : DefectKind::overlapping_segments, {{ElementKind::segment, s}},
                edited_.points[a],
                segment_name(s) + (a == b ? " has no length" : " repeats another") + " and was dropped");
        }
        edited_.segments = std::move(segments);
        edited_.segment_markers = std::move(markers);
    }

    void clean_polygons(std::uint32_t f) {
        std::vector<std::vector<std::uint32_t>> polygons;
        for (auto& polygon : edited_.facets[f].polygons) {
            const std::size_t size = polygon.size();
            polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
            while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
            const bool lost_ring = size >= 3 && polygon.size() < 3;
            if (polygon.size() != size || size == 0) {
                say(size == 0 ? DefectKind::degenerate_facet : DefectKind::repeated_vertex_in_polygon,
                    {{ElementKind::facet, f}}, polygon.empty() ? Point3{} : edited_.points[polygon[0]],
                    facet_name(f) + (lost_ring || size == 0 ? " lost a polygon without area"
                                                            : " lost vertices that repeat the one before"));
            }
            if (!lost_ring && !polygon.empty()) polygons.push_back(std::move(polygon));
        }
        edited_.facets[f].polygons = std::move(polygons);
    }

    void empty_facet(std::uint32_t f, const Defect& defect, const std::string& what) {
        if (edited_.facets[f].polygons.empty()) return;
        edited_.facets[f].polygons.clear();
        edited_.facets[f].holes.clear();
        say(defect.kind, defect.elements, defect.place, facet_name(f) + what);
    }

    const PiecewiseLinearComplex& input_;
    EditableComplex edited_;
    std::vector<Defect> repairs_;
};

}  // namespace

CleanedComplex clean_structure(const PiecewiseLinearComplex& input) { return StructureCleaner(input).run(); }

}  // namespace certa::conforming
