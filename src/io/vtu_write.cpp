// VTK unstructured grids: cells are the tetrahedra, then the polygons, then the segments; arrays of the three kinds
// that share a name become one cell array, with 0 where a kind has none. Markers are the array "marker".
// Numbers are Float64 and Int64, as base64 within the file (plain XML, so that every XML tool reads it) or as text.
#include <bit>
#include <cstring>

#include "io/base64.h"
#include "io/document_parts.h"
#include "io/formats.h"
#include "io/text_output.h"
#include "io/vtk.h"

namespace certa::io {
namespace {

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

class VtuWriter {
public:
    VtuWriter(const MeshDocument& document, bool binary) : document_(document), binary_(binary) {}

    std::string write() {
        const PiecewiseLinearComplex& complex = document_.complex;
        out_ << "<?xml version=\"1.0\"?>\n";
        if (!document_.remark.empty()) out_ << "<!-- " << remark_line(document_) << " -->\n";
        out_ << "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
             << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian")
             << "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" << complex.positions.size()
             << "\" NumberOfCells=\"" << cell_count() << "\">\n<Points>\n";
        // Point3 is three doubles without padding.
        const double* coordinates = complex.positions.empty() ? nullptr : &complex.positions.front().x;
        write_array<double>("Points", 3, {coordinates, complex.positions.size() * 3});
        out_ << "</Points>\n<Cells>\n";
        write_cells();
        out_ << "</Cells>\n<PointData>\n";
        write_point_fields();
        out_ << "</PointData>\n<CellData>\n";
        write_cell_fields();
        out_ << "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
        return out_.take();
    }

private:
    std::size_t cell_count() const {
        std::size_t count = 0;
        for (const Location location : cell_locations) count += size_at(document_, location);
        return count;
    }

    template <class T>
    void write_array(std::string_view name, std::uint32_t components, std::span<const T> values) {
        const char* type = std::is_same_v<T, double> ? "Float64" : std::is_same_v<T, std::uint8_t> ? "UInt8" : "Int64";
        out_ << "<DataArray type=\"" << type << "\" Name=\"" << escaped(name) << "\" NumberOfComponents=\""
             << components << "\" format=\"" << (binary_ ? "binary" : "ascii") << "\">\n";
        if (binary_) {
            const std::uint64_t bytes = values.size_bytes();
            std::string block(sizeof bytes + bytes, '\0');
            std::memcpy(block.data(), &bytes, sizeof bytes);
            if (bytes > 0) std::memcpy(block.data() + sizeof bytes, values.data(), bytes);
            encode_base64(block, out_.text());
            out_ << '\n';
        } else {
            for (std::size_t i = 0; i < values.size(); ++i)
                out_ << values[i] << ((i + 1) % components == 0 || i + 1 == values.size() ? '\n' : ' ');
        }
        out_ << "</DataArray>\n";
    }

    void write_cells() {
        const PiecewiseLinearComplex& complex = document_.complex;
        std::vector<std::int64_t> connectivity, offsets;
        std::vector<std::uint8_t> types;
        const auto add = [&](std::span<const VertexId> corners, VtkCell type) {
            for (const VertexId corner : corners) connectivity.push_back(index_of(corner));
            offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
            types.push_back(static_cast<std::uint8_t>(type));
        };
        for (const Tetrahedron& tetrahedron : document_.tetrahedra) add(tetrahedron, VtkCell::tetra);
        for (std::size_t i = 0; i < complex.polygon_count(); ++i) {
            const auto corners = polygon_corners(complex, i);
            add(corners, corners.size() == 3   ? VtkCell::triangle
                         : corners.size() == 4 ? VtkCell::quad
                                               : VtkCell::polygon);
        }
        for (const Edge& segment : complex.segments) add(segment, VtkCell::line);
        write_array<std::int64_t>("connectivity", 1, connectivity);
        write_array<std::int64_t>("offsets", 1, offsets);
        write_array<std::uint8_t>("types", 1, types);
    }

    void write_point_fields() {
        const std::vector<std::int32_t>& markers = document_.complex.point_markers;
        if (!markers.empty())
            write_array<std::int64_t>("marker", 1, std::vector<std::int64_t>(markers.begin(), markers.end()));
        for (const Field& field : document_.fields)
            if (field.location == Location::vertices)
                std::visit(
                    [&](const auto& values) {
                        using T = typename std::decay_t<decltype(values)>::value_type;
                        write_array<T>(field.name, field.components, values);
                    },
                    field.values);
    }

    void write_cell_fields() {
        for (const std::string& name : cell_array_names(document_)) {
            const std::uint32_t components = cell_array_components(document_, name);
            std::visit(
                [&](const auto& values) {
                    using T = typename std::decay_t<decltype(values)>::value_type;
                    write_array<T>(name, components, values);
                },
                merged_cell_array(document_, name));
        }
    }

    const MeshDocument& document_;
    bool binary_;
    TextOutput out_;
};

}  // namespace

std::string write_vtu(const MeshDocument& document, Encoding encoding) {
    return VtuWriter(document, encoding != Encoding::ascii).write();
}

}  // namespace certa::io
