// VTK unstructured grids (.vtu): tetrahedra, polygons (triangles, quadrilaterals, pixels, strips) and lines; every
// other type of cell is refused, lone vertices are left out. A cell array is split into one field per kind of element:
// a kind on which it is zero everywhere does not get it, unless it is zero on all ("0 where a kind has none").
// Plan: tags into declarations, then points, cells, and fields.
#include <algorithm>
#include <array>
#include <map>

#include "io/document_parts.h"
#include "io/formats.h"
#include "io/vtk.h"
#include "io/vtk_array.h"
#include "io/xml.h"

namespace certa::io {
namespace {

using Integers = std::vector<std::int64_t>;
using Numbers = std::vector<double>;

/// The declarations of a file, before any array is decoded.
struct Declarations {
    VtkEncoding encoding;
    std::uint64_t points = 0, cells = 0;
    std::map<std::string, std::vector<VtkArray>, std::less<>> sections;
    int pieces = 0;
    bool has_grid = false;
};

class VtuReader {
public:
    VtuReader(std::string_view text, const std::string& name) : text_(text), name_(name), xml_(text, name) {}

    MeshDocument read() {
        read_tags();
        read_points();
        read_cells();
        for (const VtkArray& array : declared_.sections["PointData"]) take_point_array(array);
        for (const VtkArray& array : declared_.sections["CellData"]) take_cell_array(array);
        if (!declared_.sections["FieldData"].empty()) document_.notes.push_back("FieldData is left out");
        if (lone_vertices_) document_.notes.push_back("vertex cells are left out");
        make_facets_of_polygons(complex());
        return std::move(document_);
    }

private:
    PiecewiseLinearComplex& complex() { return document_.complex; }

    std::uint64_t number_in(const XmlTag& tag, const char* attribute, std::optional<std::uint64_t> otherwise) const {
        const std::string* value = tag.find(attribute);
        if (value == nullptr && otherwise) return *otherwise;
        std::int64_t number = 0;
        if (value == nullptr || !parse_integer(*value, number) || number < 0)
            xml_.fail_at(tag.start, "the tag '" + tag.name + "' needs a whole number '" + attribute + "'");
        return static_cast<std::uint64_t>(number);
    }

    void read_root(const XmlTag& tag) {
        const std::string* type = tag.find("type");
        if (type == nullptr || *type != "UnstructuredGrid")
            xml_.fail_at(tag.start, "only VTK files of type UnstructuredGrid are read");
        const std::string* order = tag.find("byte_order");
        if (order != nullptr && *order != "LittleEndian" && *order != "BigEndian")
            xml_.fail_at(tag.start, "byte_order is neither LittleEndian nor BigEndian");
        if (order != nullptr && *order == "BigEndian") declared_.encoding.order = std::endian::big;
        const std::string* header = tag.find("header_type");
        if (header != nullptr && *header != "UInt32" && *header != "UInt64")
            xml_.fail_at(tag.start, "header_type is neither UInt32 nor UInt64");
        declared_.encoding.wide_headers = header != nullptr && *header == "UInt64";
        const std::string* compressor = tag.find("compressor");
        if (compressor == nullptr || compressor->empty()) return;
        if (*compressor != "vtkZLibDataCompressor")
            xml_.fail_at(tag.start,
                         "data compressed by " + quoted(*compressor) + " is not read, only by vtkZLibDataCompressor");
        declared_.encoding.compressed = true;
    }

    void read_appended(const XmlTag& tag) {
        const std::string* encoding = tag.find("encoding");
        declared_.encoding.appended_base64 = encoding == nullptr || *encoding == "base64";
        if (encoding != nullptr && *encoding != "base64" && *encoding != "raw")
            xml_.fail_at(tag.start, "the encoding of appended data is neither base64 nor raw");
        const std::size_t underscore = text_.find_first_not_of(" \t\r\n", tag.end);
        if (underscore == std::string_view::npos || text_[underscore] != '_')
            xml_.fail_at(tag.start, "appended data starts with an underscore");
        declared_.encoding.appended_start = underscore + 1;
    }

    void read_array_tag(const XmlTag& tag, const std::string& section) {
        VtkArray array;
        if (const std::string* name = tag.find("Name")) array.name = *name;
        if (const std::string* type = tag.find("type")) array.type = *type;
        const std::uint64_t components = number_in(tag, "NumberOfComponents", 1);
        if (components == 0 || components > 1'000'000)
            xml_.fail_at(tag.start, "NumberOfComponents is out of range: " + std::to_string(components));
        array.components = static_cast<std::uint32_t>(components);
        array.tag = array.start = array.end = tag.start;
        const std::string* format = tag.find("format");
        if (format == nullptr || *format == "ascii") {
            array.format = VtkFormat::text;
        } else if (*format == "binary") {
            array.format = VtkFormat::binary;
        } else if (*format == "appended") {
            array.format = VtkFormat::appended;
            array.offset = number_in(tag, "offset", std::nullopt);
        } else {
            xml_.fail_at(tag.start, "the format " + quoted(*format) + " is none of ascii, binary and appended");
        }
        if (!tag.is_empty) find_content(tag, array);
        declared_.sections[section].push_back(std::move(array));
    }

    /// Finds the numbers of an inline array: the one text that stands beside its <InformationKey> elements, if any.
    void find_content(const XmlTag& opening, VtkArray& array) {
        int depth = 0;
        std::size_t text_start = opening.end;
        for (;;) {
            const std::optional<XmlTag> tag = xml_.next();
            if (!tag) xml_.fail_at(opening.start, "the tag 'DataArray' is never closed");
            const std::string_view content = text_.substr(text_start, tag->start - text_start);
            if (depth == 0 && content.find_first_not_of(" \t\r\n") != std::string_view::npos) {
                if (array.end > array.start)
                    xml_.fail_at(opening.start, "the array '" + array.name + "' has two contents");
                array.start = text_start;
                array.end = tag->start;
            }
            if (tag->is_closing && depth == 0) {
                if (tag->name != opening.name)
                    xml_.fail_at(tag->start, "the tag '" + tag->name + "' closes 'DataArray'");
                return;
            }
            if (!tag->is_empty) depth += tag->is_closing ? -1 : 1;
            text_start = tag->end;
        }
    }

    void open_tag(const XmlTag& tag) {
        if (tag.name == "UnstructuredGrid") {
            declared_.has_grid = true;
        } else if (tag.name == "Piece") {
            if (++declared_.pieces > 1)
                xml_.fail_at(tag.start, "files of several pieces are not read; merge them first");
            declared_.points = number_in(tag, "NumberOfPoints", std::nullopt);
            declared_.cells = number_in(tag, "NumberOfCells", std::nullopt);
            if (std::max(declared_.points, declared_.cells) >= no_index)
                xml_.fail_at(tag.start, "more than 4294967294 points or cells");
        }
    }

    void read_tags() {
        std::vector<std::string> open;
        for (std::optional<XmlTag> tag = xml_.next(); tag; tag = xml_.next()) {
            if (open.empty()) {
                if (tag->name != "VTKFile" || tag->is_closing)
                    xml_.fail_at(tag->start, "a VTK file starts with the tag VTKFile");
                read_root(*tag);
            } else if (tag->name == "AppendedData") {
                read_appended(*tag);
                open.clear();
                break;
            } else if (tag->name == "DataArray" && !tag->is_closing) {
                read_array_tag(*tag, open.back());
                continue;
            } else if (!tag->is_closing) {
                open_tag(*tag);
            }
            if (tag->is_closing) {
                if (tag->name != open.back())
                    xml_.fail_at(tag->start, "the tag '" + tag->name + "' closes '" + open.back() + "'");
                open.pop_back();
                if (open.empty()) break;
            } else if (!tag->is_empty) {
                open.push_back(tag->name);
            }
        }
        if (!open.empty()) xml_.fail_at(text_.size(), "the file ends within the tag '" + open.back() + "'");
        if (!declared_.has_grid) xml_.fail_at(text_.size(), "the file holds no UnstructuredGrid");
    }

    VtkValues decode(const VtkArray& array, std::uint64_t count) const {
        if (!is_number_type(array.type))
            xml_.fail_at(array.tag,
                         "the array '" + array.name + "' is of type " + quoted(array.type) + ", not of numbers");
        return decode_array(array, declared_.encoding, text_, name_, count);
    }

    void read_points() {
        const std::vector<VtkArray>& arrays = declared_.sections["Points"];
        if (arrays.empty()) {
            if (declared_.points > 0) xml_.fail_at(text_.size(), "the file has no array of points");
            return;
        }
        if (arrays.size() > 1 || arrays[0].components != 3)
            xml_.fail_at(arrays[0].tag, "points are one array of three components");
        const VtkValues values = decode(arrays[0], declared_.points);
        complex().positions.resize(static_cast<std::size_t>(declared_.points));
        std::visit(
            [&](const auto& v) {
                for (std::size_t i = 0; i < complex().positions.size(); ++i)
                    complex().positions[i] = {static_cast<double>(v[3 * i]), static_cast<double>(v[3 * i + 1]),
                                              static_cast<double>(v[3 * i + 2])};
            },
            values);
    }

    Integers cell_integers(const char* name, std::optional<std::uint64_t> count, std::size_t* tag = nullptr) const {
        const auto section = declared_.sections.find("Cells");
        if (section != declared_.sections.end())
            for (const VtkArray& array : section->second) {
                if (array.name != name) continue;
                if (tag != nullptr) *tag = array.tag;
                if (array.components != 1) xml_.fail_at(array.tag, "the array '" + array.name + "' has one component");
                VtkValues values = decode(array, *count);
                if (const Integers* integers = std::get_if<Integers>(&values)) return *integers;
                xml_.fail_at(array.tag, "the array '" + array.name + "' must hold whole numbers");
            }
        if (declared_.cells > 0) xml_.fail_at(text_.size(), std::string("the cells have no array '") + name + "'");
        return {};
    }

    void read_cells() {
        std::size_t offsets_tag = 0, types_tag = 0, connectivity_tag = 0;
        const Integers types = cell_integers("types", declared_.cells, &types_tag);
        const Integers offsets = cell_integers("offsets", declared_.cells, &offsets_tag);
        std::int64_t previous = 0;
        for (const std::int64_t offset : offsets) {
            if (offset < previous) xml_.fail_at(offsets_tag, "the offsets of cells decrease");
            previous = offset;
        }
        const Integers connectivity =
            cell_integers("connectivity", static_cast<std::uint64_t>(previous), &connectivity_tag);
        std::vector<VertexId> corners;
        corners.reserve(connectivity.size());
        for (const std::int64_t vertex : connectivity) {
            if (vertex < 0 || vertex >= static_cast<std::int64_t>(declared_.points))
                xml_.fail_at(connectivity_tag, "point " + std::to_string(vertex) + " is out of range: the file has " +
                                                   std::to_string(declared_.points) + ", counted from 0");
            corners.push_back(VertexId{static_cast<std::uint32_t>(vertex)});
        }
        for (std::size_t cell = 0; cell < types.size(); ++cell) {
            const auto first = static_cast<std::size_t>(cell == 0 ? 0 : offsets[cell - 1]);
            add_cell(cell, types[cell], {corners.data() + first, static_cast<std::size_t>(offsets[cell]) - first},
                     types_tag);
        }
    }

    void add_polygon(std::size_t cell, std::span<const VertexId> corners) {
        complex().corners.insert(complex().corners.end(), corners.begin(), corners.end());
        close_polygon(complex());
        sources_[1].push_back(cell);
    }

    void add_cell(std::size_t cell, std::int64_t type, std::span<const VertexId> c, std::size_t tag) {
        const auto need = [&](bool ok) {
            if (!ok)
                xml_.fail_at(tag, "cell " + std::to_string(cell + 1) + " of type " + std::to_string(type) + " has " +
                                      std::to_string(c.size()) + " corners");
        };
        switch (type) {
            case static_cast<int>(VtkCell::vertex):
            case static_cast<int>(VtkCell::poly_vertex):
                lone_vertices_ = true;
                break;
            case static_cast<int>(VtkCell::line):
            case static_cast<int>(VtkCell::poly_line):
                need(type == static_cast<int>(VtkCell::line) ? c.size() == 2 : c.size() >= 2);
                for (std::size_t k = 1; k < c.size(); ++k) {
                    complex().segments.push_back({c[k - 1], c[k]});
                    sources_[2].push_back(cell);
                }
                break;
            case static_cast<int>(VtkCell::triangle):
                need(c.size() == 3), add_polygon(cell, c);
                break;
            case static_cast<int>(VtkCell::quad):
                need(c.size() == 4), add_polygon(cell, c);
                break;
            case static_cast<int>(VtkCell::polygon):
                need(c.size() >= 3), add_polygon(cell, c);
                break;
            case static_cast<int>(VtkCell::pixel):
                need(c.size() == 4);
                add_polygon(cell, std::array{c[0], c[1], c[3], c[2]});
                break;
            case static_cast<int>(VtkCell::triangle_strip):
                need(c.size() >= 3);
                for (std::size_t k = 2; k < c.size(); ++k)
                    add_polygon(
                        cell, k % 2 == 0 ? std::array{c[k - 2], c[k - 1], c[k]} : std::array{c[k - 1], c[k - 2], c[k]});
                break;
            case static_cast<int>(VtkCell::tetra):
                need(c.size() == 4);
                document_.tetrahedra.push_back({c[0], c[1], c[2], c[3]});
                sources_[0].push_back(cell);
                break;
            default:
                xml_.fail_at(tag, "cell " + std::to_string(cell + 1) + " is of VTK's type " + std::to_string(type) +
                                      ", which is not read; only tetrahedra, polygons and lines are");
        }
    }

    bool left_out(const VtkArray& array) {
        if (is_number_type(array.type)) return false;
        document_.notes.push_back("the array '" + array.name + "' is left out: it does not hold numbers");
        return true;
    }

    void take_point_array(const VtkArray& array) {
        if (left_out(array)) return;
        add_vertex_array(document_, array.name, array.components, decode(array, declared_.points));
    }

    void take_cell_array(const VtkArray& array) {
        if (left_out(array)) return;
        const VtkValues values = decode(array, declared_.cells);
        std::visit(
            [&](const auto& all) {
                std::array<NumberArray, 3> parts;
                for (std::size_t k = 0; k < parts.size(); ++k) {
                    std::decay_t<decltype(all)> part;
                    for (const std::size_t cell : sources_[k]) {
                        const auto first = all.begin() + static_cast<std::ptrdiff_t>(cell * array.components);
                        part.insert(part.end(), first, first + array.components);
                    }
                    parts[k] = std::move(part);
                }
                add_cell_array(document_, array.name, array.components, std::move(parts));
            },
            values);
    }

    std::string_view text_;
    const std::string& name_;
    XmlCursor xml_;
    Declarations declared_;
    MeshDocument document_;
    std::array<std::vector<std::size_t>, 3> sources_;  // cells of the tetrahedra, polygons and segments
    bool lone_vertices_ = false;
};

}  // namespace

MeshDocument read_vtu(std::string_view text, const std::string& name) { return VtuReader(text, name).read(); }

}  // namespace certa::io
