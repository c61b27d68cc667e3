// PLY, binary little-endian unless text is asked for. Coordinates and fields are doubles, integers `int` or `uint`;
// a field of three components becomes name_x name_y name_z ("normal": nx ny nz), of others name_0 name_1 ...
#include <algorithm>
#include <limits>
#include <set>

#include "io/byte_cursor.h"
#include "io/document_parts.h"
#include "io/formats.h"
#include "io/text_output.h"

namespace certa::io {
namespace {

/// One property of an element: a component of a field, or a marker.
struct Column {
    std::string name;
    const char* type = "double";
    const double* numbers = nullptr;         // either these
    const std::int64_t* integers = nullptr;  // or these
    const std::int32_t* markers = nullptr;   // or these
    std::size_t stride = 1;
};

std::string component_name(const Field& field, std::uint32_t k) {
    if (field.components == 1) return field.name;
    if (field.components != 3) return field.name + "_" + std::to_string(k);
    const std::string letter(1, static_cast<char>('x' + k));
    return field.name == "normal" ? "n" + letter : field.name + "_" + letter;
}

class PlyWriter {
public:
    PlyWriter(const MeshDocument& document, bool binary)
        : document_(document), complex_(document.complex), binary_(binary) {}

    std::string write() {
        const auto vertex_columns = columns_at(Location::vertices);
        const auto face_columns = columns_at(Location::polygons);
        const auto edge_columns = columns_at(Location::segments);
        index_type_ = complex_.positions.size() > std::numeric_limits<std::int32_t>::max() ? "uint" : "int";
        for (std::size_t i = 0; i < complex_.polygon_count(); ++i)
            wide_lists_ |= polygon_corners(complex_, i).size() > 255;
        out_ << "ply\nformat " << (binary_ ? "binary_little_endian" : "ascii") << " 1.0\n";
        if (!document_.remark.empty()) out_ << "comment " << remark_line(document_) << '\n';
        out_ << "element vertex " << complex_.positions.size()
             << "\nproperty double x\nproperty double y\nproperty double z\n";
        declare(vertex_columns);
        out_ << "element face " << complex_.polygon_count() << "\nproperty list " << (wide_lists_ ? "uint " : "uchar ")
             << index_type_ << " vertex_indices\n";
        declare(face_columns);
        if (!complex_.segments.empty()) {
            out_ << "element edge " << complex_.segments.size() << "\nproperty " << index_type_ << " vertex1\nproperty "
                 << index_type_ << " vertex2\n";
            declare(edge_columns);
        }
        out_ << "end_header\n";
        write_rows(vertex_columns, face_columns, edge_columns);
        return out_.take();
    }

private:
    std::vector<Column> columns_at(Location location) const {
        std::vector<Column> columns;
        const std::vector<std::int32_t>* markers = find_markers(complex_, location);
        if (markers != nullptr && !markers->empty())
            columns.push_back({"marker", "int", nullptr, nullptr, markers->data(), 1});
        for (const Field& field : document_.fields) {
            if (field.location != location) continue;
            for (std::uint32_t k = 0; k < field.components; ++k) {
                Column column{component_name(field, k), "double", nullptr, nullptr, nullptr, field.components};
                if (const auto* numbers = std::get_if<std::vector<double>>(&field.values)) {
                    column.numbers = numbers->data() + k;
                } else {
                    const auto& integers = std::get<std::vector<std::int64_t>>(field.values);
                    const bool wide = std::any_of(integers.begin(), integers.end(), [](std::int64_t v) {
                        return v > std::numeric_limits<std::int32_t>::max();
                    });
                    column.integers = integers.data() + k;
                    column.type = wide ? "uint" : "int";
                }
                columns.push_back(std::move(column));
            }
        }
        check_names(columns);
        return columns;
    }

    static void check_names(const std::vector<Column>& columns) {
        std::set<std::string> names{"x", "y", "z", "vertex_indices", "vertex_index", "vertex1", "vertex2"};
        for (const Column& column : columns)
            if (!names.insert(column.name).second)
                throw IoError("document", 0, "two properties of a PLY file would be named '" + column.name + "'");
    }

    void declare(const std::vector<Column>& columns) {
        for (const Column& column : columns) out_ << "property " << column.type << ' ' << column.name << '\n';
    }

    template <class T>
    void put(T value) {
        if (!binary_) {
            out_ << value << ' ';
            return;
        }
        if constexpr (std::endian::native != std::endian::little) value = byte_swapped(value);
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        out_ << std::string_view(bytes, sizeof(T));
    }

    void end_row() {
        if (!binary_) out_.text().back() = '\n';
    }

    void put_columns(const std::vector<Column>& columns, std::size_t row) {
        for (const Column& column : columns) {
            if (column.numbers != nullptr)
                put(column.numbers[row * column.stride]);
            else if (column.integers != nullptr)
                put(static_cast<std::uint32_t>(column.integers[row * column.stride]), column.type);
            else
                put(column.markers[row]);
        }
    }

    /// Binary encoding is that of the low 32 bits for int and uint alike; text needs the sign.
    void put(std::uint32_t bits, const char* type) {
        if (std::string_view(type) == "int")
            put(static_cast<std::int32_t>(bits));
        else
            put(bits);
    }

    void write_rows(const std::vector<Column>& vertex_columns, const std::vector<Column>& face_columns,
                    const std::vector<Column>& edge_columns) {
        for (std::size_t i = 0; i < complex_.positions.size(); ++i) {
            put(complex_.positions[i].x);
            put(complex_.positions[i].y);
            put(complex_.positions[i].z);
            put_columns(vertex_columns, i);
            end_row();
        }
        for (std::size_t i = 0; i < complex_.polygon_count(); ++i) {
            const auto corners = polygon_corners(complex_, i);
            if (wide_lists_ || !binary_)
                put(static_cast<std::uint32_t>(corners.size()));
            else
                put(static_cast<std::uint8_t>(corners.size()));
            for (const VertexId corner : corners) put(index_of(corner));
            put_columns(face_columns, i);
            end_row();
        }
        for (std::size_t i = 0; i < complex_.segments.size(); ++i) {
            put(index_of(complex_.segments[i][0]));
            put(index_of(complex_.segments[i][1]));
            put_columns(edge_columns, i);
            end_row();
        }
    }

    const MeshDocument& document_;
    const PiecewiseLinearComplex& complex_;
    bool binary_;
    bool wide_lists_ = false;
    const char* index_type_ = "int";
    TextOutput out_;
};

}  // namespace

std::string write_ply(const MeshDocument& document, Encoding encoding) {
    return PlyWriter(document, encoding != Encoding::ascii).write();
}

}  // namespace certa::io
