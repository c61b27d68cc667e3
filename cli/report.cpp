// Results as JSON and as words.
#include "report.h"

#include <array>
#include <charconv>
#include <numbers>
#include <string_view>

namespace certa::cli {
namespace {

template <class T>
Json optional_json(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

Json to_json(const SurfaceInfo& s) {
    return {{"polygons", s.polygons},
            {"smallest_degree", s.smallest_degree},
            {"largest_degree", s.largest_degree},
            {"vertices", s.vertices},
            {"edges", s.edges},
            {"boundary_edges", s.boundary_edges},
            {"boundary_loops", s.boundary_loops},
            {"non_manifold_edges", s.non_manifold_edges},
            {"non_manifold_vertices", s.non_manifold_vertices},
            {"components", s.components},
            {"repeated_polygons", s.repeated_polygons},
            {"inconsistent_edges", s.inconsistent_edges},
            {"closed", s.closed},
            {"manifold", s.manifold},
            {"orientable", s.orientable},
            {"euler_characteristic", optional_json(s.euler_characteristic)},
            {"genus", optional_json(s.genus)},
            {"area", s.area},
            {"volume", optional_json(s.volume)}};
}

Json to_json(const TetrahedraInfo& t) {
    return {{"tetrahedra", t.tetrahedra},
            {"vertices", t.vertices},
            {"regions", t.regions},
            {"components", t.components},
            {"boundary_triangles", t.boundary_triangles},
            {"non_manifold_triangles", t.non_manifold_triangles},
            {"flat", t.flat},
            {"inverted", t.inverted},
            {"volume", t.volume},
            {"smallest_dihedral_deg", degrees(t.smallest_dihedral_radians)},
            {"largest_dihedral_deg", degrees(t.largest_dihedral_radians)}};
}

}  // namespace

Json to_json(const Point3& point) { return Json::array({point.x, point.y, point.z}); }

Json to_json(const std::vector<ElementRef>& elements) {
    Json result = Json::array();
    for (const ElementRef& element : elements)
        result.push_back({{"kind", name_of(element.kind)}, {"id", std::uint64_t{element.index} + 1}});
    return result;
}

Json to_json(const Defect& defect) {
    return {{"kind", name_of(defect.kind)},
            {"elements", to_json(defect.elements)},
            {"place", to_json(defect.place)},
            {"message", defect.message}};
}

Json to_json(const std::vector<Defect>& defects) {
    Json result = Json::array();
    for (const Defect& defect : defects) result.push_back(to_json(defect));
    return result;
}

Json to_json(const ConformStatistics& s) {
    Json result = record_of(s);
    result["stage_seconds"] = Json::object();
    for (const auto& [stage, seconds] : s.stage_seconds) result["stage_seconds"][stage] = seconds;
    return result;
}

Json to_json(const std::vector<Violation>& violations) {
    Json result = Json::array();
    for (const Violation& violation : violations)
        result.push_back({{"promise", violation.promise},
                          {"elements", to_json(violation.elements)},
                          {"place", to_json(violation.place)},
                          {"message", violation.message}});
    return result;
}

Json to_json(const ConformingCheck& check) {
    Json result{{"violation_count", check.violation_count}, {"violations", to_json(check.violations)}};
    result.update(record_of(check));
    return result;
}

Json to_json(const DocumentInfo& info) {
    return {{"points", info.points},
            {"duplicate_points", info.duplicate_points},
            {"unused_points", info.unused_points},
            {"segments", info.segments},
            {"facets", info.facets},
            {"isolated_segments", info.isolated_segments},
            {"isolated_points", info.isolated_points},
            {"facet_holes", info.facet_holes},
            {"region_holes", info.region_holes},
            {"region_seeds", info.region_seeds},
            {"lower", to_json(info.lower)},
            {"upper", to_json(info.upper)},
            {"diagonal", info.diagonal},
            {"surface", to_json(info.surface)},
            {"tetrahedra", to_json(info.tetrahedra)}};
}

const char* label_of(const char* key) {
    const std::string_view name = key;
    if (name == "repairs") return "repair";
    if (name == "obstacles") return "stopped";
    return "warning";
}

std::string text_of_seconds(double seconds) {
    std::array<char, 32> buffer;
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), seconds, std::chars_format::fixed, 2).ptr;
    return std::string(buffer.data(), end) + " s";
}

std::string text_of_count(std::size_t count) {
    std::string text = std::to_string(count);
    for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
    return text;
}

std::string counted(std::size_t count, const std::string& singular, const std::string& plural) {
    return text_of_count(count) + " " + (count == 1 ? singular : plural);
}

std::string counted(std::size_t count, const std::string& noun) { return counted(count, noun, noun + "s"); }

std::string joined(const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
    return text;
}

Json spelled_value(const std::string& name, const std::string& text) {
    if (text.empty()) return nullptr;
    const char *begin = text.data(), *end = begin + text.size();
    std::uint64_t count = 0;
    const bool is_angle = name.size() > 8 && name.compare(name.size() - 8, 8, "_radians") == 0;
    if (const auto [stop, error] = std::from_chars(begin, end, count); !is_angle && error == std::errc() && stop == end)
        return count;
    double value = 0.0;
    if (const auto [stop, error] = std::from_chars(begin, end, value); error != std::errc() || stop != end) return text;
    return is_angle ? value * std::numbers::pi / 180.0 : value;
}

}  // namespace certa::cli
