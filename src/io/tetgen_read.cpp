// TetGen's text files: .poly and .smesh (piecewise linear complexes), .node, .ele, .face and .edge (meshes).
// The first index of the points, 0 or 1, is the base of every index in the set. A facet that is one polygon of two
// corners is TetGen's way to say "segment in space" and becomes a segment; a row may run over several lines up to its
// last corner. Plan: points, facets, holes, regions; then the tables of a mesh.
#include <algorithm>
#include <cmath>

#include "io/document_parts.h"
#include "io/formats.h"
#include "io/text_cursor.h"

namespace certa::io {
namespace {

/// Reads the 0 or 1 that says whether rows end with a marker; absent means 0.
bool read_marker_flag(TextCursor& cursor) {
    if (cursor.at_line_end()) return false;
    const std::int64_t flag = cursor.integer("the number of boundary markers (0 or 1)");
    if (flag != 0 && flag != 1)
        cursor.fail("the number of boundary markers is " + std::to_string(flag) + ", not 0 or 1");
    return flag == 1;
}

/// Rows count up from the base; anything else is a lost or repeated line.
void check_row_number(TextCursor& cursor, std::uint64_t expected, const char* what) {
    const std::int64_t number = cursor.integer(what);
    if (number != static_cast<std::int64_t>(expected))
        cursor.fail(std::string(what) + " is " + std::to_string(number) + " where " + std::to_string(expected) +
                    " was expected");
}

struct PointTable {
    std::uint32_t base = 0;
    std::uint32_t count = 0;
};

std::uint32_t read_attribute_count(TextCursor& cursor) {
    return cursor.at_line_end() ? 0 : cursor.count("the number of attributes", 0);
}

/// The rows of a point list whose header says `count` points.
PointTable read_points(TextCursor& cursor, std::uint32_t count, MeshDocument& document) {
    PiecewiseLinearComplex& complex = document.complex;
    if (!cursor.at_line_end()) {
        const std::int64_t dimension = cursor.integer("the dimension");
        if (dimension != 3) cursor.fail("the dimension is " + std::to_string(dimension) + "; only 3 is read");
    }
    const std::uint32_t attributes = read_attribute_count(cursor);
    const bool has_markers = read_marker_flag(cursor);
    cursor.end_line("the header of the points");
    if ((std::uint64_t{attributes} + 4) * 2 * count > cursor.left() + 1)
        cursor.fail("the header promises " + std::to_string(count) + " points with " + std::to_string(attributes) +
                    " attributes, but only " + std::to_string(cursor.left()) + " bytes follow");
    PointTable table{0, count};
    std::vector<double> values;
    values.reserve(std::size_t{count} * attributes);
    complex.positions.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::int64_t number = cursor.integer("the number of a point");
        if (i == 0 && (number == 0 || number == 1)) table.base = static_cast<std::uint32_t>(number);
        if (number != std::int64_t{table.base} + i)
            cursor.fail("the number of a point is " + std::to_string(number) + " where " +
                        (i == 0 ? "0 or 1" : std::to_string(table.base + std::uint64_t{i})) + " was expected");
        Point3 p;
        p.x = cursor.number("a coordinate");
        p.y = cursor.number("a coordinate");
        p.z = cursor.number("a coordinate");
        complex.positions.push_back(p);
        for (std::uint32_t k = 0; k < attributes; ++k) values.push_back(cursor.number("an attribute"));
        if (has_markers) complex.point_markers.push_back(cursor.marker("the marker of a point"));
        cursor.end_line("the point");
    }
    complex.point_markers = meaningful(std::move(complex.point_markers));
    if (attributes > 0) add_field(document, "attribute", Location::vertices, attributes, std::move(values));
    return table;
}

class ComplexReader {
public:
    explicit ComplexReader(const NamedText& file, bool simple) : cursor_(file.text, file.name, '#'), simple_(simple) {}

    MeshDocument read(const NamedText& nodes) {
        read_point_part(nodes);
        read_facets();
        if (!cursor_.at_end()) read_holes();
        if (!cursor_.at_end()) read_regions();
        if (!cursor_.at_end()) {
            const std::string_view extra = cursor_.word("the end");
            cursor_.fail("unexpected " + quoted(extra) + " after the last part of the file");
        }
        complex().facet_markers = meaningful(std::move(complex().facet_markers));
        complex().segment_markers = meaningful(std::move(complex().segment_markers));
        return std::move(document_);
    }

private:
    PiecewiseLinearComplex& complex() { return document_.complex; }

    void read_point_part(const NamedText& nodes) {
        if (cursor_.at_end()) cursor_.fail("the file is empty");
        const std::uint32_t count = cursor_.count("the number of points", 8);
        if (count > 0) {
            points_ = read_points(cursor_, count, document_);
            return;
        }
        if (!nodes.present())
            cursor_.fail("the list of points is empty, and the .node file that should hold them is missing");
        cursor_.skip_line();
        TextCursor node_cursor(nodes.text, nodes.name, '#');
        if (node_cursor.at_end()) node_cursor.fail("the file is empty");
        points_ = read_points(node_cursor, node_cursor.count("the number of points", 8), document_);
        if (!node_cursor.at_end()) {
            const std::string_view extra = node_cursor.word("the end");
            node_cursor.fail("unexpected " + quoted(extra) + " after the last point");
        }
    }

    void read_facets() {
        const std::uint32_t count = cursor_.count("the number of facets", 4);
        const bool has_markers = read_marker_flag(cursor_);
        cursor_.end_line("the header of the facets");
        for (std::uint32_t i = 0; i < count; ++i)
            if (simple_)
                read_simple_facet(has_markers);
            else
                read_facet(has_markers);
    }

    void read_polygon() {
        const std::uint32_t degree = cursor_.count("the number of corners of a polygon", 2);
        if (degree == 0) cursor_.fail("a polygon without corners");
        for (std::uint32_t k = 0; k < degree; ++k)
            complex().corners.push_back(VertexId{cursor_.index("corner", points_.count, points_.base)});
        close_polygon(complex());
    }

    void read_simple_facet(bool has_markers) {
        read_polygon();
        std::int32_t marker = 0;
        if (!cursor_.at_line_end() && has_markers) marker = cursor_.marker("the marker of a facet");
        cursor_.end_line("the facet");
        close_facet(marker);
    }

    void read_facet(bool has_markers) {
        const std::uint32_t polygons = cursor_.count("the number of polygons of a facet", 4);
        if (polygons == 0) cursor_.fail("a facet without polygons");
        std::uint32_t holes = 0;
        std::int32_t marker = 0;
        if (!cursor_.at_line_end()) holes = cursor_.count("the number of holes of a facet", 8);
        if (!cursor_.at_line_end() && has_markers) marker = cursor_.marker("the marker of a facet");
        cursor_.end_line("the header of a facet");
        for (std::uint32_t i = 0; i < polygons; ++i) {
            read_polygon();
            cursor_.end_line("the corners of a polygon");
        }
        for (std::uint32_t i = 0; i < holes; ++i) {
            check_row(i, "the number of a hole");
            complex().facet_holes.push_back(read_point());
            cursor_.end_line("the hole point");
        }
        close_facet(marker);
    }

    void close_facet(std::int32_t marker) {
        PiecewiseLinearComplex& plc = complex();
        const bool one_polygon = plc.polygon_count() == plc.facet_offsets.back() + std::size_t{1};
        const bool has_holes = plc.facet_holes.size() != plc.hole_offsets.back();
        if (one_polygon && !has_holes && plc.corners.size() == plc.polygon_offsets.end()[-2] + std::size_t{2}) {
            plc.segments.push_back({plc.corners.end()[-2], plc.corners.end()[-1]});
            plc.segment_markers.push_back(marker);
            plc.corners.resize(plc.corners.size() - 2);
            plc.polygon_offsets.pop_back();
            return;
        }
        plc.facet_offsets.push_back(static_cast<std::uint32_t>(plc.polygon_count()));
        plc.hole_offsets.push_back(static_cast<std::uint32_t>(plc.facet_holes.size()));
        plc.facet_markers.push_back(marker);
    }

    /// Holes and regions count from 0 or 1, whatever the points do.
    void check_row(std::uint32_t i, const char* what) {
        const std::int64_t number = cursor_.integer(what);
        if (i == 0 && number == 0) row_base_ = 0;
        if (i == 0 && number != 0) row_base_ = 1;
        if (number != std::int64_t{row_base_} + i)
            cursor_.fail(std::string(what) + " is " + std::to_string(number) + " where " +
                         std::to_string(row_base_ + std::uint64_t{i}) + " was expected");
    }

    Point3 read_point() {
        Point3 p;
        p.x = cursor_.number("a coordinate");
        p.y = cursor_.number("a coordinate");
        p.z = cursor_.number("a coordinate");
        return p;
    }

    void read_holes() {
        const std::uint32_t count = cursor_.count("the number of holes", 8);
        cursor_.end_line("the number of holes");
        for (std::uint32_t i = 0; i < count; ++i) {
            check_row(i, "the number of a hole");
            complex().region_holes.push_back(read_point());
            cursor_.end_line("the hole point");
        }
    }

    void read_regions() {
        const std::uint32_t count = cursor_.count("the number of regions", 8);
        cursor_.end_line("the number of regions");
        for (std::uint32_t i = 0; i < count; ++i) {
            check_row(i, "the number of a region");
            RegionSeed seed;
            seed.place = read_point();
            if (!cursor_.at_line_end()) seed.attribute = cursor_.number("the attribute of a region");
            if (!cursor_.at_line_end()) seed.max_volume = cursor_.number("the volume bound of a region");
            cursor_.end_line("the region");
            complex().region_seeds.push_back(seed);
        }
    }

    TextCursor cursor_;
    bool simple_;
    MeshDocument document_;
    PointTable points_;
    std::uint32_t row_base_ = 1;
};

/// A table of an .ele, .face or .edge file: header "count ...", rows "number corners ... rest".
struct Table {
    TextCursor cursor;
    std::uint32_t count;
};

Table open_table(const NamedText& file) {
    TextCursor cursor(file.text, file.name, '#');
    if (cursor.at_end()) cursor.fail("the file is empty");
    const std::uint32_t count = cursor.count("the number of elements", 4);
    return {cursor, count};
}

void close_table(Table& table) {
    if (table.cursor.at_end()) return;
    const std::string_view extra = table.cursor.word("the end");
    table.cursor.fail("unexpected " + quoted(extra) + " after the last element");
}

template <std::size_t N>
std::array<VertexId, N> read_corners(TextCursor& cursor, const PointTable& points) {
    std::array<VertexId, N> corners;
    for (VertexId& corner : corners) corner = VertexId{cursor.index("corner", points.count, points.base)};
    return corners;
}

/// A column of whole numbers is the region; everything else are attributes.
void add_element_attributes(MeshDocument& document, std::uint32_t attributes, const std::vector<double>& values) {
    constexpr double largest = 9007199254740992.0;  // 2^53: every whole number up to here is a double
    const std::size_t count = document.tetrahedra.size();
    bool whole = attributes > 0;
    for (std::size_t i = 0; i < count && whole; ++i) {
        const double v = values[i * attributes];
        whole = v == std::floor(v) && std::abs(v) <= largest && !(v == 0.0 && std::signbit(v));
    }
    const std::uint32_t first = whole ? 1 : 0;
    if (whole) {
        std::vector<std::int64_t> regions(count);
        for (std::size_t i = 0; i < count; ++i) regions[i] = static_cast<std::int64_t>(values[i * attributes]);
        add_field(document, "region", Location::tetrahedra, std::move(regions));
    }
    if (attributes == first) return;
    std::vector<double> rest;
    rest.reserve(count * (attributes - first));
    for (std::size_t i = 0; i < values.size(); ++i)
        if (i % attributes >= first) rest.push_back(values[i]);
    add_field(document, "attribute", Location::tetrahedra, attributes - first, std::move(rest));
}

void read_tetrahedra(const NamedText& file, const PointTable& points, MeshDocument& document) {
    Table table = open_table(file);
    TextCursor& cursor = table.cursor;
    if (!cursor.at_line_end()) {
        const std::int64_t corners = cursor.integer("the number of corners of a tetrahedron");
        if (corners != 4)
            cursor.fail("tetrahedra of " + std::to_string(corners) + " nodes are not read, only linear ones of 4");
    }
    const std::uint32_t attributes = read_attribute_count(cursor);
    cursor.end_line("the header of the tetrahedra");
    if ((std::uint64_t{attributes} + 5) * 2 * table.count > cursor.left() + 1)
        cursor.fail("the header promises " + std::to_string(table.count) + " tetrahedra with " +
                    std::to_string(attributes) + " attributes, but only " + std::to_string(cursor.left()) +
                    " bytes follow");
    std::vector<double> values;
    values.reserve(std::size_t{table.count} * attributes);
    document.tetrahedra.reserve(table.count);
    for (std::uint32_t i = 0; i < table.count; ++i) {
        check_row_number(cursor, std::uint64_t{points.base} + i, "the number of a tetrahedron");
        document.tetrahedra.push_back(read_corners<4>(cursor, points));
        for (std::uint32_t k = 0; k < attributes; ++k) values.push_back(cursor.number("an attribute"));
        cursor.end_line("the tetrahedron");
    }
    close_table(table);
    if (table.count > 0) add_element_attributes(document, attributes, values);
}

void read_triangles(const NamedText& file, const PointTable& points, PiecewiseLinearComplex& complex) {
    Table table = open_table(file);
    const bool has_markers = read_marker_flag(table.cursor);
    table.cursor.end_line("the header of the triangles");
    for (std::uint32_t i = 0; i < table.count; ++i) {
        check_row_number(table.cursor, std::uint64_t{points.base} + i, "the number of a triangle");
        for (const VertexId corner : read_corners<3>(table.cursor, points)) complex.corners.push_back(corner);
        close_polygon(complex);
        if (has_markers) complex.facet_markers.push_back(table.cursor.marker("the marker of a triangle"));
        table.cursor.end_line("the triangle");
    }
    close_table(table);
    complex.facet_markers = meaningful(std::move(complex.facet_markers));
}

void read_edges(const NamedText& file, const PointTable& points, PiecewiseLinearComplex& complex) {
    Table table = open_table(file);
    const bool has_markers = read_marker_flag(table.cursor);
    table.cursor.end_line("the header of the edges");
    for (std::uint32_t i = 0; i < table.count; ++i) {
        check_row_number(table.cursor, std::uint64_t{points.base} + i, "the number of an edge");
        complex.segments.push_back(read_corners<2>(table.cursor, points));
        if (has_markers) complex.segment_markers.push_back(table.cursor.marker("the marker of an edge"));
        table.cursor.end_line("the edge");
    }
    close_table(table);
    complex.segment_markers = meaningful(std::move(complex.segment_markers));
}

}  // namespace

MeshDocument read_poly(const NamedText& poly, const NamedText& nodes) { return ComplexReader(poly, false).read(nodes); }

MeshDocument read_smesh(const NamedText& smesh, const NamedText& nodes) {
    return ComplexReader(smesh, true).read(nodes);
}

bool has_points_elsewhere(const NamedText& poly) {
    TextCursor cursor(poly.text, poly.name, '#');
    return !cursor.at_end() && cursor.word("the number of points") == "0";
}

MeshDocument read_node_set(const NodeSetText& set) {
    MeshDocument document;
    TextCursor cursor(set.node.text, set.node.name, '#');
    if (cursor.at_end()) cursor.fail("the file is empty");
    const PointTable points = read_points(cursor, cursor.count("the number of points", 8), document);
    if (!cursor.at_end()) {
        const std::string_view extra = cursor.word("the end");
        cursor.fail("unexpected " + quoted(extra) + " after the last point");
    }
    if (set.ele.present()) read_tetrahedra(set.ele, points, document);
    if (set.face.present()) read_triangles(set.face, points, document.complex);
    if (set.edge.present()) read_edges(set.edge, points, document.complex);
    make_facets_of_polygons(document.complex);
    return document;
}

}  // namespace certa::io
