// Medit .mesh (text): vertices, edges, triangles, quadrilaterals and tetrahedra, each with one reference number, which
// becomes the marker (of tetrahedra: the field "marker"). Written with MeshVersionFormatted 2, without which readers
// take the coordinates for floats. Plan: keyword by keyword; sections that say nothing about the mesh (corners, ridges,
// normals) are stepped over by their known width, unknown ones are refused.
#include <algorithm>
#include <optional>

#include "io/document_parts.h"
#include "io/formats.h"
#include "io/text_cursor.h"
#include "io/text_output.h"

namespace certa::io {
namespace {

/// Sections that are stepped over: words per row.
struct SkippedSection {
    std::string_view keyword;
    int words;
};
constexpr SkippedSection skipped_sections[] = {
    {"Corners", 1},
    {"RequiredVertices", 1},
    {"Ridges", 1},
    {"RequiredEdges", 1},
    {"RequiredTriangles", 1},
    {"RequiredQuadrilaterals", 1},
    {"Normals", 3},
    {"NormalAtVertices", 2},
    {"NormalAtTriangleVertices", 3},
    {"Tangents", 3},
    {"TangentAtVertices", 2},
    {"TangentAtEdges", 3},
    {"SubDomainFromMesh", 4},
    {"SubDomainFromGeom", 4},
    {"VertexOnGeometricVertex", 2},
    {"EdgeOnGeometricEdge", 2},
    {"RequiredTetrahedra", 1},
    {"ParallelVertexCommunicators", 2},
};
constexpr std::string_view refused_sections[] = {"Hexahedra", "Hexaedra", "Prisms",      "Pentahedra",
                                                 "Pyramids",  "EdgesP2",  "TrianglesP2", "TetrahedraP2"};

class MeditReader {
public:
    MeditReader(std::string_view text, const std::string& name) : cursor_(text, name, '#') {}

    MeshDocument read() {
        if (cursor_.at_end()) cursor_.fail("the file is empty");
        if (!equal_ignoring_case(cursor_.word("MeshVersionFormatted"), "MeshVersionFormatted"))
            cursor_.fail("a Medit file starts with MeshVersionFormatted");
        const std::int64_t version = cursor_.integer("the version");
        if (version < 1 || version > 4) cursor_.fail("version " + std::to_string(version) + " is not known");
        while (!cursor_.at_end() && read_section()) {
        }
        check_corners();
        PiecewiseLinearComplex& complex = document_.complex;
        make_facets_of_polygons(complex);
        complex.point_markers = meaningful(std::move(complex.point_markers));
        complex.segment_markers = meaningful(std::move(complex.segment_markers));
        complex.facet_markers = meaningful(std::move(complex.facet_markers));
        if (std::any_of(references_.begin(), references_.end(), [](std::int64_t r) { return r != 0; }))
            add_field(document_, "marker", Location::tetrahedra, std::move(references_));
        return std::move(document_);
    }

private:
    bool read_section() {
        const std::string_view keyword = cursor_.word("a keyword");
        const auto is = [&](std::string_view name) { return equal_ignoring_case(keyword, name); };
        if (is("End")) {
            if (!cursor_.at_end()) {
                const std::string_view extra = cursor_.word("the end");
                cursor_.fail("unexpected " + quoted(extra) + " after End");
            }
            return false;
        }
        if (is("Dimension")) {
            const std::int64_t dimension = cursor_.integer("the dimension");
            if (dimension != 3) cursor_.fail("the dimension is " + std::to_string(dimension) + "; only 3 is read");
        } else if (is("Vertices")) {
            read_vertices();
        } else if (is("Edges")) {
            read_edges();
        } else if (is("Triangles")) {
            read_polygons("the number of triangles", 3);
        } else if (is("Quadrilaterals")) {
            read_polygons("the number of quadrilaterals", 4);
        } else if (is("Tetrahedra")) {
            read_tetrahedra();
        } else {
            read_other_section(keyword);
        }
        return true;
    }

    void read_vertices() {
        if (has_vertices_) cursor_.fail("a second list of vertices");
        has_vertices_ = true;
        PiecewiseLinearComplex& complex = document_.complex;
        const std::uint32_t count = cursor_.count("the number of vertices", 8);
        complex.positions.reserve(count);
        complex.point_markers.reserve(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            Point3 p;
            p.x = cursor_.number("a coordinate");
            p.y = cursor_.number("a coordinate");
            p.z = cursor_.number("a coordinate");
            complex.positions.push_back(p);
            complex.point_markers.push_back(cursor_.marker("the reference of a vertex"));
        }
    }

    /// Corners may come before the vertices; then their range is checked at the end.
    VertexId read_corner() {
        const std::uint32_t size =
            has_vertices_ ? static_cast<std::uint32_t>(document_.complex.positions.size()) : no_index;
        const std::size_t before = cursor_.position();
        const std::uint32_t corner = cursor_.index("vertex", size, 1);
        if (!has_vertices_ && corner >= farthest_.value_or(0)) farthest_ = corner, farthest_at_ = before;
        return VertexId{corner};
    }

    void check_corners() {
        if (!has_vertices_) cursor_.fail("the file has no vertices");
        const std::size_t size = document_.complex.positions.size();
        if (!farthest_ || *farthest_ < size) return;
        // The position is that of the blank before the word; step over it to the right line.
        cursor_.move_to(farthest_at_);
        cursor_.at_end();
        cursor_.fail_at(cursor_.position(), "vertex " + std::to_string(*farthest_ + 1ULL) +
                                                " is out of range: the file has " + std::to_string(size) + " vertices");
    }

    void read_edges() {
        PiecewiseLinearComplex& complex = document_.complex;
        const std::uint32_t count = cursor_.count("the number of edges", 6);
        for (std::uint32_t i = 0; i < count; ++i) {
            const VertexId first = read_corner();
            const VertexId second = read_corner();
            complex.segments.push_back({first, second});
            complex.segment_markers.push_back(cursor_.marker("the reference of an edge"));
        }
    }

    void read_polygons(const char* what, int degree) {
        PiecewiseLinearComplex& complex = document_.complex;
        const std::uint32_t count = cursor_.count(what, 2 * static_cast<std::size_t>(degree) + 2);
        for (std::uint32_t i = 0; i < count; ++i) {
            for (int k = 0; k < degree; ++k) complex.corners.push_back(read_corner());
            close_polygon(complex);
            complex.facet_markers.push_back(cursor_.marker("the reference of a polygon"));
        }
    }

    void read_tetrahedra() {
        const std::uint32_t count = cursor_.count("the number of tetrahedra", 10);
        for (std::uint32_t i = 0; i < count; ++i) {
            Tetrahedron corners;
            for (VertexId& corner : corners) corner = read_corner();
            document_.tetrahedra.push_back(corners);
            references_.push_back(cursor_.integer("the reference of a tetrahedron"));
        }
    }

    void read_other_section(std::string_view keyword) {
        for (const std::string_view refused : refused_sections)
            if (equal_ignoring_case(keyword, refused)) {
                if (cursor_.count("the number of elements", 2) > 0)
                    cursor_.fail("elements of type " + std::string(refused) + " are not read");
                return;
            }
        for (const SkippedSection& section : skipped_sections)
            if (equal_ignoring_case(keyword, section.keyword)) {
                const std::uint32_t count =
                    cursor_.count("the number of rows", 2 * static_cast<std::size_t>(section.words));
                for (std::uint64_t i = 0; i < std::uint64_t{count} * section.words; ++i) cursor_.number("a number");
                if (count > 0)
                    document_.notes.push_back("the section " + std::string(section.keyword) + " is left out");
                return;
            }
        cursor_.fail(quoted(keyword) + " is not a known section of a Medit file");
    }

    TextCursor cursor_;
    MeshDocument document_;
    std::vector<std::int64_t> references_;
    bool has_vertices_ = false;
    std::optional<std::uint32_t> farthest_;
    std::size_t farthest_at_ = 0;
};

void write_cell(TextOutput& out, std::span<const VertexId> corners, const std::vector<std::int64_t>& numbers,
                std::size_t i) {
    for (const VertexId corner : corners) out << index_of(corner) + 1ULL << ' ';
    out << (numbers.empty() ? 0 : numbers[i]) << '\n';
}

}  // namespace

MeshDocument read_medit(std::string_view text, const std::string& name) { return MeditReader(text, name).read(); }

std::string write_medit(const MeshDocument& document) {
    const PiecewiseLinearComplex& complex = document.complex;
    const ElementNumbers numbers = choose_element_numbers(document);
    TextOutput out;
    out.reserve(complex.positions.size() * 64 + complex.corners.size() * 10 + document.tetrahedra.size() * 36);
    out << "MeshVersionFormatted 2\n";
    if (!document.remark.empty()) out << "# " << remark_line(document) << '\n';
    out << "Dimension 3\n\nVertices\n" << complex.positions.size() << '\n';
    for (std::size_t i = 0; i < complex.positions.size(); ++i)
        out << complex.positions[i] << ' ' << (numbers.vertices.empty() ? 0 : numbers.vertices[i]) << '\n';
    if (!complex.segments.empty()) {
        out << "\nEdges\n" << complex.segments.size() << '\n';
        for (std::size_t i = 0; i < complex.segments.size(); ++i)
            write_cell(out, complex.segments[i], numbers.segments, i);
    }
    // check_writable has made sure that all triangles come before all quadrilaterals.
    std::size_t triangles = 0;
    while (triangles < complex.polygon_count() && polygon_corners(complex, triangles).size() == 3) ++triangles;
    if (triangles > 0) out << "\nTriangles\n" << triangles << '\n';
    for (std::size_t i = 0; i < triangles; ++i) write_cell(out, polygon_corners(complex, i), numbers.polygons, i);
    if (triangles < complex.polygon_count()) out << "\nQuadrilaterals\n" << complex.polygon_count() - triangles << '\n';
    for (std::size_t i = triangles; i < complex.polygon_count(); ++i)
        write_cell(out, polygon_corners(complex, i), numbers.polygons, i);
    if (!document.tetrahedra.empty()) {
        out << "\nTetrahedra\n" << document.tetrahedra.size() << '\n';
        for (std::size_t i = 0; i < document.tetrahedra.size(); ++i)
            write_cell(out, document.tetrahedra[i], numbers.tetrahedra, i);
    }
    out << "\nEnd\n";
    return out.take();
}

}  // namespace certa::io
