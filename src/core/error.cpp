// Names and messages of errors. An InputError's text is the first few defects; all of them travel as data.
#include <certa/error.h>
#include <certa/run_control.h>

#include <array>
#include <utility>

namespace certa {
namespace {

std::string summary_of(const std::vector<Defect>& defects) {
    constexpr std::size_t shown = 5;
    std::string text;
    for (std::size_t i = 0; i < defects.size() && i < shown; ++i) {
        if (i > 0) text.push_back('\n');
        text.append(name_of(defects[i].kind)).append(": ").append(defects[i].message);
    }
    if (defects.size() > shown)
        text.append("\n... and ").append(std::to_string(defects.size() - shown)).append(" more");
    return text;
}

std::string text_of(const std::string& path, std::uint64_t line, const std::string& reason) {
    std::string text = path;
    if (line > 0) text.append(":").append(std::to_string(line));
    return text.append(": ").append(reason);
}

}  // namespace

const char* name_of(DefectKind kind) {
    constexpr std::array names{"non_finite_coordinate",
                               "index_out_of_range",
                               "duplicate_point",
                               "degenerate_segment",
                               "repeated_vertex_in_polygon",
                               "degenerate_facet",
                               "repeated_facet",
                               "non_planar_facet",
                               "open_facet",
                               "self_crossing_facet",
                               "hole_outside_facet",
                               "crossing_segments",
                               "overlapping_segments",
                               "point_on_segment",
                               "point_near_segment",
                               "point_near_facet",
                               "segment_crosses_facet",
                               "crossing_facets",
                               "overlapping_facets",
                               "region_seed_on_facet",
                               "conflicting_region_seeds",
                               "empty_input",
                               "option_out_of_range",
                               "coordinate_out_of_range",
                               "element_outside_facet",
                               "point_on_facet",
                               "segment_in_facet"};
    return names.at(static_cast<std::size_t>(kind));
}

const char* name_of(ElementKind kind) {
    constexpr std::array names{"vertex", "segment", "facet", "polygon", "tetrahedron", "triangle", "edge", "option"};
    return names.at(static_cast<std::size_t>(kind));
}

const char* name_of(Outcome outcome) {
    constexpr std::array names{"done", "over_budget", "below_min_feature", "undecided", "cancelled"};
    return names.at(static_cast<std::size_t>(outcome));
}

InputError::InputError(std::vector<Defect> defects)
    : std::runtime_error(summary_of(defects)), defects_(std::move(defects)) {}

IoError::IoError(std::string path, std::uint64_t line, std::string reason)
    : std::runtime_error(text_of(path, line, reason)),
      path_(std::move(path)),
      line_(line),
      reason_(std::move(reason)) {}

}  // namespace certa
