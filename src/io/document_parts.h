#pragma once
// Filling documents and looking things up in them: shared by the readers and writers of all formats.
#include <certa/io.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace certa::io {

/// Makes every polygon a facet of its own; called once, after the last polygon.
void make_facets_of_polygons(PiecewiseLinearComplex& complex);

/// Ends the polygon whose corners have just been appended.
inline void close_polygon(PiecewiseLinearComplex& complex) {
    complex.polygon_offsets.push_back(static_cast<std::uint32_t>(complex.corners.size()));
}

/// The document's remark as one line that can stand in a comment of any format; empty if there is none.
std::string remark_line(const MeshDocument& document);

/// Markers as the document keeps them: an array of zeros says nothing and becomes empty.
std::vector<std::int32_t> meaningful(std::vector<std::int32_t> markers);

inline std::span<const VertexId> polygon_corners(const PiecewiseLinearComplex& complex, std::size_t polygon) {
    return {complex.corners.data() + complex.polygon_offsets[polygon],
            complex.corners.data() + complex.polygon_offsets[polygon + 1]};
}

/// Number of elements at a location.
std::size_t size_at(const MeshDocument& document, Location location);
const char* name_of(Location location);

const Field* find_field(const MeshDocument& document, std::string_view name, Location location);

/// Integer values of a scalar field, null if it is absent or holds doubles.
const std::vector<std::int64_t>* find_integers(const MeshDocument& document, std::string_view name, Location location);

void add_field(MeshDocument& document, std::string name, Location location, std::vector<std::int64_t> values);
void add_field(MeshDocument& document, std::string name, Location location, std::uint32_t components,
               std::vector<double> values);

/// Kinds of cells in the order in which VTK and Gmsh files that we write list what one cell array covers.
inline constexpr std::array cell_locations{Location::tetrahedra, Location::polygons, Location::segments};
using NumberArray = std::variant<std::vector<double>, std::vector<std::int64_t>>;

/// Adds the parts of one cell array, in the order of cell_locations. "marker" becomes the markers of the complex where
/// it can. Formats with one array for all cells hold 0 where a kind of cell has none: a part that is zero everywhere is
/// no field, unless all are, or it is the label of its kind.
void add_cell_array(MeshDocument& document, const std::string& name, std::uint32_t components,
                    std::array<NumberArray, 3> parts);

/// Adds an array of vertices; "marker" becomes the markers of the points where it can.
void add_vertex_array(MeshDocument& document, const std::string& name, std::uint32_t components, NumberArray values);

/// The inverse of add_cell_array: the cell array of a name, zero where a kind of cell has none.
NumberArray merged_cell_array(const MeshDocument& document, std::string_view name);
/// Names of all cell arrays, markers included, in order of appearance.
std::vector<std::string> cell_array_names(const MeshDocument& document);
std::uint32_t cell_array_components(const MeshDocument& document, std::string_view name);

/// Marker of a point, segment, or polygon (the marker of its facet; polygons are facets where this is asked); 0: none.
inline std::int32_t marker_of(const std::vector<std::int32_t>& markers, std::size_t i) {
    return markers.empty() ? 0 : markers[i];
}

/// The marker array that a location has in the complex; null for tetrahedra, whose marker is a field.
const std::vector<std::int32_t>* find_markers(const PiecewiseLinearComplex& complex, Location location);

/// The arrays that a format with one number per element writes, chosen by MeshDocument::reference; empty: all zero.
struct ElementNumbers {
    std::vector<std::int64_t> vertices, polygons, segments, tetrahedra;
};
ElementNumbers choose_element_numbers(const MeshDocument& document);

}  // namespace certa::io
