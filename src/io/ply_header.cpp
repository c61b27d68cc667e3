// The header of a PLY file, line by line: format, comment, obj_info, element, property, end_header.
#include "io/ply_header.h"

#include <array>
#include <set>

namespace certa::io {
namespace {

struct TypeName {
    std::string_view name;
    PlyType type;
};
constexpr std::array type_names{
    TypeName{"char", PlyType::int8},       TypeName{"uchar", PlyType::uint8},    TypeName{"short", PlyType::int16},
    TypeName{"ushort", PlyType::uint16},   TypeName{"int", PlyType::int32},      TypeName{"uint", PlyType::uint32},
    TypeName{"float", PlyType::float32},   TypeName{"double", PlyType::float64}, TypeName{"int8", PlyType::int8},
    TypeName{"uint8", PlyType::uint8},     TypeName{"int16", PlyType::int16},    TypeName{"uint16", PlyType::uint16},
    TypeName{"int32", PlyType::int32},     TypeName{"uint32", PlyType::uint32},  TypeName{"float32", PlyType::float32},
    TypeName{"float64", PlyType::float64},
};

std::string_view word_of_line(TextCursor& cursor, const char* what) {
    if (cursor.at_line_end()) cursor.fail(std::string("the line ends where ") + what + " was expected");
    return cursor.word(what);
}

PlyType read_type(TextCursor& cursor) {
    const std::string_view word = word_of_line(cursor, "a type");
    for (const TypeName& candidate : type_names)
        if (candidate.name == word) return candidate.type;
    cursor.fail(quoted(word) + " is not a type of PLY");
}

PlyProperty read_property(TextCursor& cursor) {
    PlyProperty property;
    const std::size_t start = cursor.position();
    property.is_list = word_of_line(cursor, "a type") == "list";
    if (property.is_list) {
        property.count_type = read_type(cursor);
        if (is_float(property.count_type)) cursor.fail("the length of a list cannot be of a floating type");
    } else {
        cursor.move_to(start);
    }
    property.type = read_type(cursor);
    property.name = word_of_line(cursor, "the name of a property");
    return property;
}

void read_format(TextCursor& cursor, PlyHeader& header) {
    const std::string_view format = word_of_line(cursor, "the format");
    if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian")
        cursor.fail(quoted(format) + " is not a format of PLY");
    header.is_text = format == "ascii";
    header.order = format == "binary_big_endian" ? std::endian::big : std::endian::little;
    if (const std::string_view version = word_of_line(cursor, "the version"); version != "1.0")
        cursor.fail("version " + quoted(version) + " is not known, only 1.0");
}

void add_property(TextCursor& cursor, PlyHeader& header, std::set<std::string>& names) {
    if (header.elements.empty()) cursor.fail("a property before the first element");
    PlyProperty property = read_property(cursor);
    if (!names.insert(property.name).second) cursor.fail("the property " + quoted(property.name) + " is there twice");
    header.elements.back().properties.push_back(std::move(property));
}

void add_element(TextCursor& cursor, PlyHeader& header, std::set<std::string>& names) {
    PlyElement element;
    element.name = word_of_line(cursor, "the name of an element");
    if (!names.insert(element.name).second) cursor.fail("the element " + quoted(element.name) + " is there twice");
    element.count = cursor.count("the number of elements", 0);
    header.elements.push_back(std::move(element));
}

}  // namespace

std::size_t size_of(PlyType type) {
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::int32:
        case PlyType::uint32:
        case PlyType::float32:
            return 4;
        case PlyType::float64:
            return 8;
    }
    return 0;
}

std::size_t PlyElement::least_bytes() const {
    std::size_t bytes = 0;
    for (const PlyProperty& property : properties)
        bytes += size_of(property.is_list ? property.count_type : property.type);
    return bytes;
}

PlyHeader read_ply_header(TextCursor& cursor) {
    PlyHeader header;
    if (cursor.at_end()) cursor.fail("the file is empty");
    if (cursor.word("ply") != "ply") cursor.fail("a PLY file starts with the word ply");
    cursor.end_line("ply");
    bool has_format = false;
    std::set<std::string> element_names, property_names;
    for (;;) {
        const std::string_view keyword = cursor.word("end_header");
        if (keyword == "comment" || keyword == "obj_info") {
            cursor.skip_line();
            continue;
        }
        if (keyword == "format") {
            read_format(cursor, header);
            has_format = true;
        } else if (keyword == "element") {
            add_element(cursor, header, element_names);
            property_names.clear();
        } else if (keyword == "property") {
            add_property(cursor, header, property_names);
        } else if (keyword == "end_header") {
            break;
        } else {
            cursor.fail(quoted(keyword) + " in the header of a PLY file");
        }
        cursor.end_line("the statement");
    }
    if (!has_format) cursor.fail("the header does not state the format");
    cursor.end_line("end_header");
    return header;
}

}  // namespace certa::io
