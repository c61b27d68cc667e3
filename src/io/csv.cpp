// CSV of the fields of vertices: a header row, then one row per vertex in order. Write only: the mesh is elsewhere.
// A field of three components has the columns name_x, name_y, name_z, of others name_0, name_1 ...
#include "io/document_parts.h"
#include "io/formats.h"
#include "io/text_output.h"

namespace certa::io {
namespace {

/// A column's name as CSV wants it (RFC 4180).
std::string cell(const std::string& name) {
    if (name.find_first_of(",\"\r\n") == std::string::npos) return name;
    std::string out = "\"";
    for (const char c : name) {
        if (c == '"') out += '"';
        out += c;
    }
    return out + '"';
}

std::string component_name(const Field& field, std::uint32_t k) {
    if (field.components == 1) return field.name;
    if (field.components == 3) return field.name + "_" + static_cast<char>('x' + k);
    return field.name + "_" + std::to_string(k);
}

}  // namespace

std::string write_csv(const MeshDocument& document) {
    const std::vector<std::int32_t>& markers = document.complex.point_markers;
    TextOutput out;
    const char* separator = "";
    if (!markers.empty()) out << "marker", separator = ",";
    for (const Field& field : document.fields)
        for (std::uint32_t k = 0; k < field.components; ++k, separator = ",")
            out << separator << cell(component_name(field, k));
    out << '\n';
    for (std::size_t i = 0; i < document.complex.positions.size(); ++i) {
        separator = "";
        if (!markers.empty()) out << markers[i], separator = ",";
        for (const Field& field : document.fields)
            for (std::uint32_t k = 0; k < field.components; ++k, separator = ",") {
                out << separator;
                std::visit([&](const auto& values) { out << values[i * field.components + k]; }, field.values);
            }
        out << '\n';
    }
    return out.take();
}

}  // namespace certa::io
