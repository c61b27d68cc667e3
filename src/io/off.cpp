// OFF: polygons over shared vertices, with its prefixes ST, C and N (texture, colours, normals), which are read over.
// Dialect (docs/formats.md): the keyword may be missing or share its line with the counts; every vertex and every face
// starts a new line and may go on over several; what follows on its last line is a colour. Plan: header, vertices,
// faces, nothing more.
#include "io/document_parts.h"
#include "io/formats.h"
#include "io/text_cursor.h"
#include "io/text_output.h"

namespace certa::io {
namespace {

struct Header {
    bool texture = false, colors = false, normals = false;
    std::uint32_t vertices = 0, faces = 0;
};

Header read_header(TextCursor& cursor) {
    Header header;
    if (cursor.at_end()) cursor.fail("the file is empty");
    const std::size_t start = cursor.position();
    std::string_view keyword = cursor.word("OFF");
    const std::string_view full = keyword;
    if (keyword.find_first_not_of("0123456789") == std::string_view::npos) {
        cursor.move_to(start);
    } else {
        if (keyword.starts_with("ST")) header.texture = true, keyword.remove_prefix(2);
        for (; !keyword.empty() && (keyword.front() == 'C' || keyword.front() == 'N'); keyword.remove_prefix(1))
            (keyword.front() == 'C' ? header.colors : header.normals) = true;
        if (keyword != "OFF") {
            if (keyword.ends_with("OFF"))
                cursor.fail("points with other than three coordinates (" + quoted(full) + ")");
            cursor.fail(quoted(full) + " where the keyword OFF was expected");
        }
        if (cursor.rest_of_line().find("BINARY") != std::string_view::npos)
            cursor.fail("binary OFF is not read; save it as text, or as PLY");
        cursor.move_to(start + full.size());
    }
    if (cursor.at_end()) cursor.fail("the file ends where the number of vertices was expected");
    header.vertices = cursor.count("the number of vertices", 6);
    header.faces = cursor.count("the number of faces", 3);
    if (!cursor.at_line_end()) cursor.count("the number of edges", 0);
    cursor.end_line("the counts");
    return header;
}

/// The rest of the line after a vertex or face: numbers of a colour. Returns whether there were any.
bool skip_colors(TextCursor& cursor, int most) {
    int numbers = 0;
    while (!cursor.at_line_end()) {
        double value = 0.0;
        const std::string_view word = cursor.word("a colour");
        if (++numbers > most || !parse_number(word, value))
            cursor.fail("unexpected " + quoted(word) + " at the end of the line");
    }
    cursor.skip_line();
    return numbers > 0;
}

bool read_vertices(TextCursor& cursor, const Header& header, std::vector<Point3>& positions) {
    bool extras = false;
    positions.reserve(header.vertices);
    for (std::uint32_t i = 0; i < header.vertices; ++i) {
        Point3 p;
        p.x = cursor.number("a coordinate");
        p.y = cursor.number("a coordinate");
        p.z = cursor.number("a coordinate");
        positions.push_back(p);
        for (int k = 0; header.normals && k < 3; ++k) cursor.word("a component of a normal");
        // At most normal, colour and texture coordinates: with more, several vertices share the line.
        extras |= skip_colors(cursor, 9);
    }
    return extras || header.normals;
}

bool read_faces(TextCursor& cursor, const Header& header, PiecewiseLinearComplex& complex) {
    bool extras = false;
    complex.polygon_offsets.reserve(header.faces + std::size_t{1});
    for (std::uint32_t i = 0; i < header.faces; ++i) {
        const std::uint32_t degree = cursor.count("the number of corners of a face", 2);
        if (degree == 0) cursor.fail("face " + std::to_string(i + 1) + " has no corners");
        for (std::uint32_t k = 0; k < degree; ++k)
            complex.corners.push_back(VertexId{cursor.index("corner", header.vertices, 0)});
        close_polygon(complex);
        extras |= skip_colors(cursor, 4);
    }
    return extras;
}

}  // namespace

MeshDocument read_off(std::string_view text, const std::string& name) {
    TextCursor cursor(text, name, '#');
    const Header header = read_header(cursor);
    MeshDocument document;
    const bool vertex_extras = read_vertices(cursor, header, document.complex.positions);
    const bool face_extras = read_faces(cursor, header, document.complex);
    if (!cursor.at_end()) {
        const std::string_view extra = cursor.word("the end");
        cursor.fail("unexpected " + quoted(extra) + " after the last of " + std::to_string(header.faces) + " faces");
    }
    make_facets_of_polygons(document.complex);
    if (vertex_extras) document.notes.push_back("colours, normals and texture coordinates of vertices are left out");
    if (face_extras) document.notes.push_back("colours of faces are left out");
    return document;
}

std::string write_off(const MeshDocument& document) {
    const PiecewiseLinearComplex& complex = document.complex;
    TextOutput out;
    out.reserve(complex.positions.size() * 64 + complex.corners.size() * 10);
    out << "OFF\n";
    if (!document.remark.empty()) out << "# " << remark_line(document) << '\n';
    out << complex.positions.size() << ' ' << complex.polygon_count() << " 0\n";
    for (const Point3& p : complex.positions) out << p << '\n';
    for (std::size_t i = 0; i < complex.polygon_count(); ++i) {
        const auto corners = polygon_corners(complex, i);
        out << corners.size();
        for (const VertexId corner : corners) out << ' ' << index_of(corner);
        out << '\n';
    }
    return out.take();
}

}  // namespace certa::io
