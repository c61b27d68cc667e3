// PLY, text and binary of either byte order. Elements: vertex, face (also as tristrips), edge (segments); their scalar
// properties become fields by name, name_x name_y name_z one field of three components, "marker" the markers.
// Other elements and other lists are stepped over and named in the document's notes.
// Plan: header; rows into columns, the same code for both encodings; columns into the document.
#include <cmath>
#include <limits>
#include <optional>

#include "io/byte_cursor.h"
#include "io/document_parts.h"
#include "io/formats.h"
#include "io/ply_header.h"

namespace certa::io {
namespace {

/// The values of one property over all rows; a list property has offsets.
struct Column {
    PlyProperty property;
    std::vector<double> numbers;         // of floating types
    std::vector<std::int64_t> integers;  // of integer types
    std::vector<std::size_t> offsets{0};
};

/// An element that became part of the document, and where its rows start.
struct Table {
    PlyElement element;
    std::vector<Column> columns;
    std::size_t start = 0;

    Column* find(std::string_view name) {
        for (Column& column : columns)
            if (column.property.name == name) return &column;
        return nullptr;
    }
};

struct IntegerRange {
    std::int64_t least, most;
};
IntegerRange range_of(PlyType type) {
    switch (type) {
        case PlyType::int8:
            return {-128, 127};
        case PlyType::uint8:
            return {0, 255};
        case PlyType::int16:
            return {-32768, 32767};
        case PlyType::uint16:
            return {0, 65535};
        case PlyType::int32:
            return {std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()};
        default:
            return {0, std::numeric_limits<std::uint32_t>::max()};
    }
}

/// Rows as lines of words.
class TextRows {
public:
    explicit TextRows(TextCursor& cursor) : cursor_(cursor) {}

    void start_element(const PlyElement& element) {
        least_ = 2 * element.properties.size();
        if (least_ > 0 && element.count > (cursor_.left() + 1) / least_)
            fail("the header promises " + std::to_string(element.count) + " rows of '" + element.name + "', but only " +
                 std::to_string(cursor_.left()) + " bytes follow");
    }
    void start_row() { cursor_.at_end(); }
    void end_row() {
        if (least_ > 0) cursor_.end_line("the row");
    }
    double number(const PlyProperty& property) {
        check_line(property);
        return cursor_.number("a number");
    }
    std::int64_t integer(PlyType type, const PlyProperty& property) {
        check_line(property);
        const std::int64_t value = cursor_.integer("a whole number");
        const IntegerRange range = range_of(type);
        if (value < range.least || value > range.most)
            fail(std::to_string(value) + " is beyond the type of '" + property.name + "'");
        return value;
    }
    void check_list(std::int64_t length, const PlyProperty&) {
        if (static_cast<std::uint64_t>(length) > (cursor_.left() + 1) / 2)
            fail("a list of " + std::to_string(length) + " entries does not fit into the rest of the file");
    }
    [[noreturn]] void fail(const std::string& reason) const { cursor_.fail(reason); }
    std::size_t position() const { return cursor_.position(); }
    /// Fails at the line of a row; every row is a line.
    [[noreturn]] void fail_at_row(std::size_t start, std::size_t row, const std::string& reason) const {
        TextCursor cursor = cursor_;
        cursor.move_to(start);
        for (std::size_t i = 0; i < row && !cursor.at_end(); ++i) cursor.skip_line();
        cursor.at_end();
        cursor.fail_at(cursor.position(), reason);
    }
    void finish() {
        if (cursor_.at_end()) return;
        const std::string_view extra = cursor_.word("the end");
        fail("unexpected " + quoted(extra) + " after the last element");
    }

private:
    void check_line(const PlyProperty& property) {
        if (cursor_.at_line_end()) fail("the line ends where '" + property.name + "' was expected");
    }
    TextCursor& cursor_;
    std::size_t least_ = 0;
};

/// Rows as packed numbers.
class BinaryRows {
public:
    explicit BinaryRows(ByteCursor cursor) : cursor_(std::move(cursor)) {}

    void start_element(const PlyElement& element) {
        cursor_.need_all(element.count, element.least_bytes(), ("rows of '" + element.name + "'").c_str());
    }
    void start_row() {}
    void end_row() {}
    double number(const PlyProperty& property) {
        const double value = property.type == PlyType::float32 ? static_cast<double>(cursor_.read<float>("a number"))
                                                               : cursor_.read<double>("a number");
        if (!std::isfinite(value)) fail("a value of '" + property.name + "' is not finite");
        return value;
    }
    std::int64_t integer(PlyType type, const PlyProperty&) {
        switch (type) {
            case PlyType::int8:
                return cursor_.read<std::int8_t>("a number");
            case PlyType::uint8:
                return cursor_.read<std::uint8_t>("a number");
            case PlyType::int16:
                return cursor_.read<std::int16_t>("a number");
            case PlyType::uint16:
                return cursor_.read<std::uint16_t>("a number");
            case PlyType::int32:
                return cursor_.read<std::int32_t>("a number");
            default:
                return cursor_.read<std::uint32_t>("a number");
        }
    }
    void check_list(std::int64_t length, const PlyProperty& property) {
        cursor_.need_all(static_cast<std::uint64_t>(length), size_of(property.type), "entries of a list");
    }
    [[noreturn]] void fail(const std::string& reason) const { cursor_.fail(reason); }
    std::size_t position() const { return cursor_.position(); }
    [[noreturn]] void fail_at_row(std::size_t, std::size_t row, const std::string& reason) const {
        fail(reason + " (row " + std::to_string(row + 1) + ")");
    }
    void finish() {
        while (cursor_.left() > 0) {
            const char c = cursor_.read<char>("the end");
            if (c != '\n' && c != '\r' && c != ' ') fail("more data after the last element: the counts are wrong");
        }
    }

private:
    ByteCursor cursor_;
};

template <class Rows>
class PlyReader {
public:
    PlyReader(Rows rows, PlyHeader header) : rows_(std::move(rows)), header_(std::move(header)) {}

    MeshDocument read() {
        for (const PlyElement& element : header_.elements) read_element(element);
        rows_.finish();
        take_vertices();
        take_faces();
        take_strips();
        take_edges();
        make_facets_of_polygons(complex());
        return std::move(document_);
    }

private:
    PiecewiseLinearComplex& complex() { return document_.complex; }

    static bool keeps(const PlyElement& element, const PlyProperty& property) {
        if (!property.is_list) return true;
        const bool is_face = element.name == "face" || element.name == "tristrips";
        return is_face && (property.name == "vertex_indices" || property.name == "vertex_index") &&
               !is_float(property.type);
    }

    void note(const std::string& what) { document_.notes.push_back(what + " is left out"); }

    void read_element(const PlyElement& element) {
        const bool known =
            element.name == "vertex" || element.name == "face" || element.name == "tristrips" || element.name == "edge";
        if (!known && element.count > 0) note("the element '" + element.name + "'");
        rows_.start_element(element);
        Table table{element, {}, rows_.position()};
        for (const PlyProperty& property : element.properties) {
            table.columns.push_back({property, {}, {}, {0}});
            if (known && element.count > 0 && !keeps(element, property))
                note("the list '" + property.name + "' of the element '" + element.name + "'");
        }
        // Rows of nothing take no bytes: there is nothing to read, however many the header promises.
        for (std::uint32_t i = 0; i < element.count && !element.properties.empty(); ++i) {
            rows_.start_row();
            for (Column& column : table.columns) read_value(column, known && keeps(element, column.property));
            rows_.end_row();
        }
        if (known) tables_.push_back(std::move(table));
    }

    void read_value(Column& column, bool keep) {
        const PlyProperty& property = column.property;
        std::int64_t length = 1;
        if (property.is_list) {
            length = rows_.integer(property.count_type, property);
            if (length < 0) rows_.fail("a list of negative length");
            rows_.check_list(length, property);
        }
        for (std::int64_t k = 0; k < length; ++k) {
            if (is_float(property.type)) {
                const double value = rows_.number(property);
                if (keep) column.numbers.push_back(value);
            } else {
                const std::int64_t value = rows_.integer(property.type, property);
                if (keep) column.integers.push_back(value);
            }
        }
        if (property.is_list && keep) column.offsets.push_back(column.integers.size());
    }

    Table* find_table(std::string_view name) {
        for (Table& table : tables_)
            if (table.element.name == name) return &table;
        return nullptr;
    }

    static double value_of(const Column& column, std::size_t row) {
        return is_float(column.property.type) ? column.numbers[row] : static_cast<double>(column.integers[row]);
    }

    void take_vertices() {
        Table* table = find_table("vertex");
        if (table == nullptr) throw_missing("the element vertex");
        Column *x = table->find("x"), *y = table->find("y"), *z = table->find("z");
        if (x == nullptr || y == nullptr || z == nullptr) throw_missing("a coordinate x, y or z of the element vertex");
        for (const Column* column : {x, y, z})
            if (column->property.is_list) throw_missing("a coordinate x, y or z that is no list");
        complex().positions.reserve(table->element.count);
        for (std::size_t i = 0; i < table->element.count; ++i)
            complex().positions.push_back({value_of(*x, i), value_of(*y, i), value_of(*z, i)});
        std::vector<Column> rest;
        for (Column& column : table->columns)
            if (&column != x && &column != y && &column != z) rest.push_back(std::move(column));
        take_fields(std::move(rest), Location::vertices);
    }

    [[noreturn]] void throw_missing(const std::string& what) { rows_.fail("the file lacks " + what); }

    VertexId vertex_of(const Table& table, std::size_t row, std::int64_t vertex) {
        const std::size_t size = complex().positions.size();
        if (vertex < 0 || vertex >= static_cast<std::int64_t>(size))
            rows_.fail_at_row(table.start, row,
                              "vertex " + std::to_string(vertex) + " is out of range: the file has " +
                                  std::to_string(size) + " vertices, counted from 0");
        return VertexId{static_cast<std::uint32_t>(vertex)};
    }

    Column* corner_list(Table& table) {
        Column* list = table.find("vertex_indices");
        if (list == nullptr) list = table.find("vertex_index");
        if (list != nullptr && keeps(table.element, list->property) && list->property.is_list) return list;
        if (table.element.count > 0) throw_missing("the list vertex_indices of the element " + table.element.name);
        return nullptr;
    }

    void take_faces() {
        Table* table = find_table("face");
        if (table == nullptr) return;
        Column* list = corner_list(*table);
        if (list == nullptr) return;
        for (std::size_t i = 0; i < table->element.count; ++i) {
            if (list->offsets[i] == list->offsets[i + 1]) rows_.fail_at_row(table->start, i, "a face without corners");
            for (std::size_t k = list->offsets[i]; k < list->offsets[i + 1]; ++k)
                complex().corners.push_back(vertex_of(*table, i, list->integers[k]));
            close_polygon(complex());
        }
        std::vector<Column> rest;
        for (Column& column : table->columns)
            if (!column.property.is_list) rest.push_back(std::move(column));
        const Table* strips = find_table("tristrips");
        if (strips == nullptr || strips->element.count == 0)
            take_fields(std::move(rest), Location::polygons);
        else if (!rest.empty())
            note("the properties of faces beside strips");
    }

    /// A strip a b c d ...: triangles abc, cbd, ...; -1 starts anew; triangles that repeat a corner are joints.
    void take_strips() {
        Table* table = find_table("tristrips");
        if (table == nullptr) return;
        const Column* list = corner_list(*table);
        if (list == nullptr) return;
        for (std::size_t i = 0; i < table->element.count; ++i) {
            std::vector<VertexId> strip;
            for (std::size_t k = list->offsets[i]; k < list->offsets[i + 1]; ++k) {
                if (list->integers[k] == -1) {
                    strip.clear();
                    continue;
                }
                strip.push_back(vertex_of(*table, i, list->integers[k]));
                if (strip.size() < 3) continue;
                VertexId a = strip.end()[-3], b = strip.end()[-2];
                const VertexId c = strip.end()[-1];
                if (strip.size() % 2 == 0) std::swap(a, b);
                if (a == b || b == c || c == a) continue;
                complex().corners.insert(complex().corners.end(), {a, b, c});
                close_polygon(complex());
            }
        }
        if (table->columns.size() > 1 && table->element.count > 0) note("the properties of strips");
    }

    void take_edges() {
        Table* table = find_table("edge");
        if (table == nullptr) return;
        Column *first = table->find("vertex1"), *second = table->find("vertex2");
        if (first == nullptr || second == nullptr || is_float(first->property.type) ||
            is_float(second->property.type) || first->property.is_list || second->property.is_list) {
            if (table->element.count > 0) throw_missing("the whole numbers vertex1 and vertex2 of the element edge");
            return;
        }
        for (std::size_t i = 0; i < table->element.count; ++i)
            complex().segments.push_back(
                {vertex_of(*table, i, first->integers[i]), vertex_of(*table, i, second->integers[i])});
        std::vector<Column> rest;
        for (Column& column : table->columns)
            if (&column != first && &column != second) rest.push_back(std::move(column));
        take_fields(std::move(rest), Location::segments);
    }

    /// How many columns from `first` on are the components of one vector, and its name.
    static std::pair<std::size_t, std::string> find_vector(const std::vector<Column>& columns, std::size_t first) {
        const std::string& name = columns[first].property.name;
        const auto run = [&](auto&& name_of_component, std::size_t most) {
            std::size_t n = 0;
            while (n < most && first + n < columns.size() && columns[first + n].property.name == name_of_component(n) &&
                   is_float(columns[first + n].property.type) == is_float(columns[first].property.type))
                ++n;
            return n;
        };
        const auto letter = [](std::size_t k) { return std::string(1, static_cast<char>('x' + k)); };
        if (run([&](std::size_t k) { return "n" + letter(k); }, 3) == 3) return {3, "normal"};
        if (name.size() > 2 && name.ends_with("_x")) {
            const std::string stem = name.substr(0, name.size() - 2);
            if (run([&](std::size_t k) { return stem + "_" + letter(k); }, 3) == 3) return {3, stem};
        }
        if (name.size() > 2 && name.ends_with("_0")) {
            const std::string stem = name.substr(0, name.size() - 2);
            const std::size_t n = run([&](std::size_t k) { return stem + "_" + std::to_string(k); }, columns.size());
            if (n > 1 && n != 3) return {n, stem};
        }
        return {1, name};
    }

    void take_fields(std::vector<Column> columns, Location location) {
        std::erase_if(columns, [](const Column& column) { return column.property.is_list; });
        std::size_t width = 1;
        for (std::size_t first = 0; first < columns.size(); first += width) {
            auto [components, name] = find_vector(columns, first);
            width = components;
            if (name == "marker" && take_markers(columns[first], location)) continue;
            Field field{name, location, static_cast<std::uint32_t>(components), {}};
            if (is_float(columns[first].property.type))
                field.values = interleaved(columns, first, components, &Column::numbers);
            else
                field.values = interleaved(columns, first, components, &Column::integers);
            document_.fields.push_back(std::move(field));
        }
    }

    template <class T>
    static std::vector<T> interleaved(std::vector<Column>& columns, std::size_t first, std::size_t components,
                                      std::vector<T> Column::*values) {
        if (components == 1) return std::move(columns[first].*values);
        std::vector<T> all((columns[first].*values).size() * components);
        for (std::size_t k = 0; k < components; ++k)
            for (std::size_t i = 0; i < (columns[first + k].*values).size(); ++i)
                all[i * components + k] = (columns[first + k].*values)[i];
        return all;
    }

    bool take_markers(const Column& column, Location location) {
        if (is_float(column.property.type)) return false;
        std::vector<std::int32_t> markers;
        markers.reserve(column.integers.size());
        for (const std::int64_t value : column.integers) {
            if (value > std::numeric_limits<std::int32_t>::max()) return false;
            markers.push_back(static_cast<std::int32_t>(value));
        }
        auto& target = location == Location::vertices   ? complex().point_markers
                       : location == Location::polygons ? complex().facet_markers
                                                        : complex().segment_markers;
        target = meaningful(std::move(markers));
        return true;
    }

    Rows rows_;
    PlyHeader header_;
    std::vector<Table> tables_;
    MeshDocument document_;
};

}  // namespace

MeshDocument read_ply(std::string_view text, const std::string& name) {
    TextCursor cursor(text, name, TextCursor::no_comments);
    PlyHeader header = read_ply_header(cursor);
    if (header.is_text) return PlyReader<TextRows>(TextRows(cursor), std::move(header)).read();
    ByteCursor bytes(text, name, header.order);
    bytes.move_to(cursor.position());
    return PlyReader<BinaryRows>(BinaryRows(std::move(bytes)), std::move(header)).read();
}

}  // namespace certa::io
