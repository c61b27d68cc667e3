// STL: a soup of triangles, as text or as binary single-precision numbers; vertices are merged when their coordinates
// are equal, numbered by first appearance. A binary file may start with "solid": its size tells (84 + 50 n bytes).
// Written as binary only when every coordinate is a single-precision number, because that would lose digits otherwise.
#include <bit>
#include <cmath>

#include "io/byte_cursor.h"
#include "io/document_parts.h"
#include "io/formats.h"
#include "io/text_cursor.h"
#include "io/text_output.h"

namespace certa::io {
namespace {

constexpr std::size_t header_bytes = 84, triangle_bytes = 50;

/// Numbers points by their coordinates: a hash table with linear probing, at most half full.
class PointNumbering {
public:
    explicit PointNumbering(std::vector<Point3>& points) : points_(points), slots_(1024, no_index) {}

    VertexId number_of(const Point3& p) {
        if (points_.size() * 2 >= slots_.size()) grow();
        std::size_t slot = slot_of(p);
        for (; slots_[slot] != no_index; slot = (slot + 1) & (slots_.size() - 1))
            if (points_[slots_[slot]] == p) return VertexId{slots_[slot]};
        slots_[slot] = static_cast<std::uint32_t>(points_.size());
        points_.push_back(p);
        return VertexId{slots_[slot]};
    }

private:
    std::size_t slot_of(const Point3& p) const {
        std::uint64_t hash = 0;
        for (const double c : {p.x, p.y, p.z}) {
            const std::uint64_t bits = std::bit_cast<std::uint64_t>(c + 0.0);  // -0.0 equals 0.0
            hash = (hash ^ bits) * 0x9e3779b97f4a7c15ULL;
            hash ^= hash >> 32;
        }
        return hash & (slots_.size() - 1);
    }
    void grow() {
        slots_.assign(slots_.size() * 2, no_index);
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            std::size_t slot = slot_of(points_[i]);
            while (slots_[slot] != no_index) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = i;
        }
    }
    std::vector<Point3>& points_;
    std::vector<std::uint32_t> slots_;
};

bool is_binary(std::string_view text) {
    if (text.size() < header_bytes) return false;
    ByteCursor cursor(text.substr(80), "", std::endian::little);
    return text.size() == header_bytes + std::size_t{cursor.read<std::uint32_t>("")} * triangle_bytes;
}

MeshDocument read_binary(std::string_view text, const std::string& name) {
    MeshDocument document;
    PiecewiseLinearComplex& complex = document.complex;
    PointNumbering numbering(complex.positions);
    ByteCursor cursor(text, name, std::endian::little);
    cursor.skip(80, "the header");
    const auto count = cursor.read<std::uint32_t>("the number of triangles");
    complex.corners.reserve(std::size_t{count} * 3);
    bool has_attributes = false;
    for (std::uint32_t i = 0; i < count; ++i) {
        cursor.skip(12, "a normal");
        for (int k = 0; k < 3; ++k) {
            Point3 p;
            p.x = cursor.read<float>("a coordinate");
            p.y = cursor.read<float>("a coordinate");
            p.z = cursor.read<float>("a coordinate");
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                cursor.fail("a coordinate of triangle " + std::to_string(i + std::uint64_t{1}) + " is not finite");
            complex.corners.push_back(numbering.number_of(p));
        }
        close_polygon(complex);
        has_attributes |= cursor.read<std::uint16_t>("an attribute") != 0;
    }
    make_facets_of_polygons(complex);
    if (has_attributes) document.notes.push_back("attribute bytes of triangles (colours) are left out");
    return document;
}

void expect(TextCursor& cursor, const char* keyword) {
    const std::string_view word = cursor.word(keyword);
    if (!equal_ignoring_case(word, keyword)) cursor.fail(quoted(word) + " where '" + keyword + "' was expected");
}

void read_facet(TextCursor& cursor, PiecewiseLinearComplex& complex, PointNumbering& numbering) {
    // Normals are often rubbish (nan, zero), and say nothing that the corners do not say.
    expect(cursor, "normal");
    for (int k = 0; k < 3; ++k) cursor.word("a component of a normal");
    expect(cursor, "outer");
    expect(cursor, "loop");
    for (int k = 0; k < 3; ++k) {
        expect(cursor, "vertex");
        Point3 p;
        p.x = cursor.number("a coordinate");
        p.y = cursor.number("a coordinate");
        p.z = cursor.number("a coordinate");
        complex.corners.push_back(numbering.number_of(p));
    }
    expect(cursor, "endloop");
    expect(cursor, "endfacet");
    close_polygon(complex);
}

MeshDocument read_text(std::string_view text, const std::string& name) {
    TextCursor cursor(text, name, TextCursor::no_comments);
    if (cursor.at_end()) cursor.fail("the file is empty");
    MeshDocument document;
    PointNumbering numbering(document.complex.positions);
    int solids = 0;
    for (; !cursor.at_end(); ++solids) {
        const std::string_view keyword = cursor.word("solid");
        if (!equal_ignoring_case(keyword, "solid"))
            cursor.fail(solids == 0 ? "neither the text 'solid' nor a binary file of the size that its count tells"
                                    : quoted(keyword) + " where 'solid' was expected");
        cursor.skip_line();
        for (;;) {
            const std::string_view word = cursor.word("facet or endsolid");
            if (equal_ignoring_case(word, "endsolid")) break;
            if (!equal_ignoring_case(word, "facet"))
                cursor.fail(quoted(word) + " where 'facet' or 'endsolid' was expected");
            read_facet(cursor, document.complex, numbering);
        }
        cursor.skip_line();
    }
    make_facets_of_polygons(document.complex);
    if (solids > 1) document.notes.push_back("the division into " + std::to_string(solids) + " solids is left out");
    return document;
}

bool is_single(double value) {
    return std::abs(value) <= std::numeric_limits<float>::max() &&
           static_cast<double>(static_cast<float>(value)) == value;
}

/// Unit normal; zero for a degenerate triangle.
Point3 normal_of(const Point3& a, const Point3& b, const Point3& c) {
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const Point3 n{uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
    const double length = std::hypot(n.x, n.y, n.z);
    if (!std::isfinite(length) || length == 0.0) return {};
    return {n.x / length, n.y / length, n.z / length};
}

std::string write_text(const PiecewiseLinearComplex& complex) {
    TextOutput out;
    out << "solid certa\n";
    for (std::size_t i = 0; i < complex.polygon_count(); ++i) {
        const auto corners = polygon_corners(complex, i);
        const auto at = [&](int k) { return complex.positions[index_of(corners[k])]; };
        out << "facet normal " << normal_of(at(0), at(1), at(2)) << "\nouter loop\n";
        for (int k = 0; k < 3; ++k) out << "vertex " << at(k) << '\n';
        out << "endloop\nendfacet\n";
    }
    out << "endsolid certa\n";
    return out.take();
}

void put_single(std::string& out, double value) {
    auto single = static_cast<float>(value);
    if constexpr (std::endian::native != std::endian::little) single = byte_swapped(single);
    char bytes[sizeof single];
    std::memcpy(bytes, &single, sizeof single);
    out.append(bytes, sizeof bytes);
}

std::string write_binary(const PiecewiseLinearComplex& complex) {
    std::string out = "binary STL";
    out.resize(80, ' ');
    const std::size_t count = complex.polygon_count();
    for (int k = 0; k < 4; ++k) out += static_cast<char>(count >> (8 * k) & 255);
    for (std::size_t i = 0; i < count; ++i) {
        const auto corners = polygon_corners(complex, i);
        const auto at = [&](int k) { return complex.positions[index_of(corners[k])]; };
        for (const Point3& p : {normal_of(at(0), at(1), at(2)), at(0), at(1), at(2)})
            for (const double c : {p.x, p.y, p.z}) put_single(out, c);
        out.append(2, '\0');
    }
    return out;
}

}  // namespace

MeshDocument read_stl(std::string_view text, const std::string& name) {
    return is_binary(text) ? read_binary(text, name) : read_text(text, name);
}

std::string write_stl(const MeshDocument& document, Encoding encoding) {
    const PiecewiseLinearComplex& complex = document.complex;
    std::size_t first_wide = 0;
    while (first_wide < complex.positions.size() && is_single(complex.positions[first_wide].x) &&
           is_single(complex.positions[first_wide].y) && is_single(complex.positions[first_wide].z))
        ++first_wide;
    const bool all_single = first_wide == complex.positions.size();
    if (encoding == Encoding::binary && !all_single)
        throw IoError("document", 0,
                      "binary STL holds single-precision numbers and would round vertex " +
                          std::to_string(first_wide + 1) + "; write text, or binary ply");
    return all_single && encoding != Encoding::ascii ? write_binary(complex) : write_text(complex);
}

}  // namespace certa::io
