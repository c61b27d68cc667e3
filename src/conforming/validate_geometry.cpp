// Geometric validation: facets one by one, pairs of pieces, region seeds; findings become defects with words.
//
// Of two findings that say the same about the same pair of elements only the stronger is reported: coplanar overlap
// over crossing, a segment in a facet over one that passes through or runs close, a point on a facet over one near it.
#include <algorithm>
#include <set>

#include "conforming/build_complex.h"
#include "conforming/repair.h"
#include "conforming/validate_findings.h"
#include "conforming/validate_messages.h"

namespace certa::conforming {
namespace {

class FindingReporter {
public:
    FindingReporter(const Complex& complex, const Pieces& pieces, ValidationReport& report)
        : complex_(complex), pieces_(pieces), report_(report) {}

    void report(const std::vector<Finding>& findings) {
        for (const Finding& finding : findings) {
            if (finding.kind == FindingKind::segment_in_facet && is_whole_in_facet(finding)) {
                adopt_segment(finding);
                continue;
            }
            if (is_said(finding)) continue;
            if (finding.kind == FindingKind::point_on_facet) {
                adopt_point(finding);
            } else if (report_.defects.size() < report_.max_kept) {
                report_.add(defect_of(finding));
            } else {
                ++report_.defect_count;
            }
        }
    }

private:
    /// Findings come in order of precedence, so what says the same has been seen.
    bool is_said(const Finding& f) {
        std::uint32_t topic = 0;
        switch (f.kind) {
            case FindingKind::overlapping_facets:
            case FindingKind::crossing_facets:
                topic = 1;
                break;
            case FindingKind::segment_in_facet:
            case FindingKind::segment_crosses_facet:
            case FindingKind::segment_near_facet:
                topic = 2;
                break;
            case FindingKind::point_on_facet:
            case FindingKind::point_near_facet:
                topic = 3;
                break;
            default:
                return false;
        }
        return !said_.insert({topic, f.first, f.second}).second;
    }

    std::string segment_text(std::uint32_t s) const {
        return segment_name(s) + " (from " + vertex_name(complex_.segments[s][0]) + " to " +
               vertex_name(complex_.segments[s][1]) + ')';
    }

    /// Both ends are points of the facet. Where it leaves the facet in between, another finding says so: it crosses a
    /// side, runs over a vertex, or, in a facet that is flat only up to rounding, passes through it or along it.
    bool is_whole_in_facet(const Finding& f) const {
        const auto& ends = complex_.segments[f.first];
        return std::all_of(ends.begin(), ends.end(), [&](std::uint32_t v) {
            const auto own = complex_.point_facets[v];
            return std::binary_search(own.begin(), own.end(), f.second) || said_.contains({3, v, f.second});
        });
    }

    void adopt_segment(const Finding& f) {
        report_.adopted_segments.push_back({f.first, f.second});
        report_.notes.push_back({DefectKind::segment_in_facet,
                                 {{ElementKind::segment, f.first}, {ElementKind::facet, f.second}},
                                 place_of(complex_, pieces_, f),
                                 segment_text(f.first) + " lies exactly in " + facet_name(f.second) +
                                     "; it is taken as an isolated segment of the facet"});
    }

    void adopt_point(const Finding& f) {
        report_.adopted_points.push_back({f.first, f.second});
        const Point3& p = complex_.points[f.first];
        report_.notes.push_back({DefectKind::point_on_facet,
                                 {{ElementKind::vertex, f.first}, {ElementKind::facet, f.second}},
                                 p,
                                 vertex_name(f.first) + ' ' + name_place(p) + " lies exactly on " +
                                     facet_name(f.second) + "; it is taken as an isolated point of the facet"});
    }

    Defect defect_of(const Finding& f) const {
        const Point3 place = place_of(complex_, pieces_, f);
        const std::string where = " at " + name_place(place);
        const ElementRef vertex{ElementKind::vertex, f.first}, first_segment{ElementKind::segment, f.first};
        const ElementRef second_segment{ElementKind::segment, f.second}, facet{ElementKind::facet, f.second};
        const ElementRef first_facet{ElementKind::facet, f.first};
        switch (f.kind) {
            case FindingKind::point_on_segment:
                return {DefectKind::point_on_segment,
                        {vertex, second_segment},
                        place,
                        vertex_name(f.first) + where + " lies on " + segment_text(f.second) +
                            " without being one of its ends; split the segment there, or use --repair"};
            case FindingKind::point_near_segment:
                return {DefectKind::point_near_segment,
                        {vertex, second_segment},
                        place,
                        vertex_name(f.first) + where + " is within rounding of " + segment_text(f.second) +
                            " but no facet has both; split the segment there, or use --repair"};
            case FindingKind::overlapping_segments:
                return {DefectKind::overlapping_segments,
                        {first_segment, second_segment},
                        place,
                        segment_text(f.first) + " and " + segment_text(f.second) + " overlap" + where +
                            "; split them at each other's ends, or use --repair"};
            case FindingKind::crossing_segments:
                return {DefectKind::crossing_segments,
                        {first_segment, second_segment},
                        place,
                        segment_text(f.first) + " and " + segment_text(f.second) + " cross" + where +
                            "; split both there, or use --repair"};
            case FindingKind::overlapping_facets:
                return {DefectKind::overlapping_facets,
                        {first_facet, facet},
                        place,
                        facet_name(f.first) + " and " + facet_name(f.second) + " overlap in one plane" + where +
                            "; facets may meet only in common vertices and sides"};
            case FindingKind::crossing_facets:
                return {DefectKind::crossing_facets,
                        {first_facet, facet},
                        place,
                        facet_name(f.first) + " and " + facet_name(f.second) + " cross" + where +
                            "; split them along their intersection, or use --repair"};
            case FindingKind::segment_in_facet:
                return {DefectKind::segment_in_facet,
                        {first_segment, facet},
                        place,
                        segment_text(f.first) + " lies partly in " + facet_name(f.second) + where +
                            "; split it at the facet's sides, or use --repair"};
            case FindingKind::segment_crosses_facet:
                return {DefectKind::segment_crosses_facet,
                        {first_segment, facet},
                        place,
                        segment_text(f.first) + " passes through " + facet_name(f.second) + where +
                            "; split it there and list the point in the facet, or use --repair"};
            case FindingKind::segment_near_facet:
                return {DefectKind::segment_crosses_facet,
                        {first_segment, facet},
                        place,
                        segment_text(f.first) + " runs within rounding of " + facet_name(f.second) + where +
                            "; list it as a segment of the facet, or move it away"};
            default:
                return {DefectKind::point_near_facet,
                        {vertex, facet},
                        place,
                        vertex_name(f.first) + where + " is within rounding of " + facet_name(f.second) +
                            " but not on it; list it in the facet, move it away, or use --repair"};
        }
    }

    const Complex& complex_;
    const Pieces& pieces_;
    ValidationReport& report_;
    std::set<std::array<std::uint32_t, 3>> said_;
};

void check_seeds(const PiecewiseLinearComplex& input, const Complex& complex, const Pieces& pieces,
                 ValidationReport& report) {
    std::vector<Point3> places = input.region_holes;
    for (const RegionSeed& seed : input.region_seeds) places.push_back(seed.place);
    for (const auto& [i, facet] : find_places_on_facets(complex, pieces, places)) {
        const bool hole = i < input.region_holes.size();
        const std::size_t number = 1 + (hole ? i : i - input.region_holes.size());
        report.add({DefectKind::region_seed_on_facet,
                    {{ElementKind::facet, facet}},
                    places[i],
                    (hole ? "region hole " : "region seed ") + std::to_string(number) + ' ' + name_place(places[i]) +
                        " lies on " + facet_name(facet) + "; move it to the inside of the region that it means"});
    }
}

}  // namespace

ValidationReport validate_geometry(const PiecewiseLinearComplex& input, const Complex& complex,
                                   const ValidationReport& structure, const ConformOptions& options,
                                   const KnownClean& known, const RunControl& control) {
    ValidationReport report;
    control.report("validate", 0.0);
    const Pieces pieces = check_facets(input, complex, options, structure, report);
    if (control.cancelled()) return report;
    FindingReporter(complex, pieces, report).report(find_findings(complex, pieces, known));
    check_seeds(input, complex, pieces, report);
    control.report("validate", 1.0);
    return report;
}

ValidationReport validate(const PiecewiseLinearComplex& input, const ConformOptions& options,
                          const RunControl& control) {
    ValidationReport report = validate_structure(input);
    if (!report.buildable) return report;
    const bool clean = report.ok();
    const PiecewiseLinearComplex cleaned = clean ? PiecewiseLinearComplex{} : clean_structure(input).complex;
    const PiecewiseLinearComplex& sound = clean ? input : cleaned;
    const ValidationReport structure = clean ? report : validate_structure(cleaned);
    const Complex complex = build_complex(sound);
    ValidationReport geometry = validate_geometry(sound, complex, structure, options, {}, control);
    report.append(std::move(geometry));
    return report;
}

void adopt_elements(Complex& complex, const ValidationReport& report) {
    if (report.adopted_points.empty() && report.adopted_segments.empty()) return;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> points, segments;  // facet, element
    for (const AdoptedPoint& a : report.adopted_points) points.emplace_back(a.facet, a.point);
    for (const AdoptedSegment& a : report.adopted_segments) segments.emplace_back(a.facet, a.segment);
    std::sort(points.begin(), points.end());
    std::sort(segments.begin(), segments.end());
    Rows<std::uint32_t> point_rows;
    Rows<Side> side_rows;
    std::vector<std::uint32_t> points_of_facet;
    std::vector<Side> sides;
    auto point = points.begin();
    auto segment = segments.begin();
    for (std::uint32_t f = 0; f < complex.facet_sides.size(); ++f) {
        sides.assign(complex.facet_sides[f].begin(), complex.facet_sides[f].end());
        for (; segment != segments.end() && segment->first == f; ++segment) sides.push_back({segment->second, false});
        points_of_facet.assign(complex.facet_points[f].begin(), complex.facet_points[f].end());
        for (; point != points.end() && point->first == f; ++point) points_of_facet.push_back(point->second);
        // Isolated points are on no side: the ends of adopted segments are none.
        const bool gained = sides.size() > complex.facet_sides[f].size();
        if (gained)
            std::erase_if(points_of_facet, [&](std::uint32_t v) {
                return std::any_of(sides.begin(), sides.end(), [&](const Side& side) {
                    return complex.segments[side.segment][0] == v || complex.segments[side.segment][1] == v;
                });
            });
        side_rows.push_row(sides);
        point_rows.push_row(points_of_facet);
    }
    complex.facet_sides = std::move(side_rows);
    complex.facet_points = std::move(point_rows);
    build_incidences(complex);
}

}  // namespace certa::conforming
