#pragma once
// The four channels of failure (ARCHITECTURE.md): bad data, file trouble, honest inability, our bug.
#include <certa/types.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace certa {

/// What is wrong with the caller's data. The names are stable and appear in reports with `_` as written here.
enum class DefectKind : std::uint8_t {
    non_finite_coordinate,
    index_out_of_range,
    duplicate_point,
    degenerate_segment,
    repeated_vertex_in_polygon,
    degenerate_facet,  // zero area
    repeated_facet,
    non_planar_facet,
    open_facet,           // its polygons enclose nothing
    self_crossing_facet,  // its own sides cross or overlap
    hole_outside_facet,
    crossing_segments,
    overlapping_segments,
    point_on_segment,  // a T-junction
    point_near_segment,
    point_near_facet,  // within rounding of a facet, not exactly on it
    segment_crosses_facet,
    crossing_facets,
    overlapping_facets,
    region_seed_on_facet,
    conflicting_region_seeds,
    empty_input,
    option_out_of_range,
    coordinate_out_of_range,  // finite, but too large or too close together for exact work in doubles
    element_outside_facet,    // an isolated segment or point of a facet lies outside it
    point_on_facet,           // exactly on a facet that does not list it: adopted, a note
    segment_in_facet,         // a segment has a part in a facet that does not list it; adopted when wholly in it
};
/// The name as it is written here; valid for ever.
const char* name_of(DefectKind kind);

/// What an ElementRef counts.
enum class ElementKind : std::uint8_t { vertex, segment, facet, polygon, tetrahedron, triangle, edge, option };
/// The name as it is written here; valid for ever.
const char* name_of(ElementKind kind);

/// One element of the caller's data or of a mesh.
struct ElementRef {
    ElementKind kind = ElementKind::vertex;
    std::uint32_t index = 0;  ///< 0-based; messages show it 1-based, the file's count being theirs
    friend bool operator==(const ElementRef&, const ElementRef&) = default;
};

/// One violation: what, which elements, where, and in `message` a sentence with the way out.
struct Defect {
    DefectKind kind{};
    std::vector<ElementRef> elements;
    Point3 place;
    std::string message;
};

/// The caller's data is wrong; nothing was computed. Carries every violation that was found.
class InputError : public std::runtime_error {
public:
    explicit InputError(std::vector<Defect> defects);                ///< at least one; what() lists the first of them
    const std::vector<Defect>& defects() const { return defects_; }  ///< all that was found, in a fixed order

private:
    std::vector<Defect> defects_;
};

/// A file cannot be read or written. `line` is 1-based, 0 where there is none (binary data, missing file).
class IoError : public std::runtime_error {
public:
    IoError(std::string path, std::uint64_t line, std::string reason);  ///< what() joins the three
    const std::string& path() const { return path_; }                   ///< as the caller wrote it
    std::uint64_t line() const { return line_; }                        ///< 1-based; 0: none
    const std::string& reason() const { return reason_; }               ///< a sentence without path and line

private:
    std::string path_;
    std::uint64_t line_;
    std::string reason_;
};

/// A broken promise inside the library: please report it.
class InternalError : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

}  // namespace certa
