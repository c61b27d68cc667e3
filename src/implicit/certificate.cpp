// Writing certificates. Integers only, besides the function: nothing in a certificate is rounded.
// The octree is a string in preorder: '(' a cell that is split, followed by its eight children, x fastest; a letter per
// leaf: 'a' + 7 (sign + 1) + slope, slope being 0 for none, 1 + 2 axis + (1 if positive) else.
#include "implicit/certificate.h"

#include <algorithm>
#include <cmath>

#include "core/digest.h"

namespace certa::implicit {
namespace {

void append_tree(const Octree& tree, std::uint32_t id, std::string& text) {
    const Cell& cell = tree.cell(id);
    if (!cell.is_leaf()) {
        text += '(';
        for (std::uint32_t c = 0; c < 8; ++c) append_tree(tree, cell.children + c, text);
        return;
    }
    const int slope = cell.known.slope == 0 ? 0 : 1 + 2 * cell.known.axis + (cell.known.slope > 0 ? 1 : 0);
    text += static_cast<char>('a' + 7 * (cell.known.sign + 1) + slope);
}

void append_number(std::int64_t number, std::string& text) {
    if (text.back() != '[') text += ',';
    text += std::to_string(number);
}

void append_point(const GridPoint& point, std::string& text) {
    for (const Coordinate c : point) append_number(c, text);
}

template <class Numbers>
void append_numbers(const char* key, const Numbers& numbers, std::string& text) {
    text += std::string("\"") + key + "\":[";
    for (const auto number : numbers) append_number(number, text);
    text += "]";
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '\n') {
            result += "\\n";
        } else {
            if (c == '"' || c == '\\') result += '\\';
            result += c;
        }
    }
    return result + "\"";
}

/// Negative points of T that no leaf with a sign holds.
std::vector<std::uint32_t> negative_points(const Octree& tree, const Triangulation& triangulation) {
    std::vector<char> given(triangulation.point_count(), 0), negative(triangulation.point_count(), 0);
    for (std::size_t i = 0; i < triangulation.active_leaves().size(); ++i) {
        const bool open = tree.cell(triangulation.active_leaves()[i]).known.sign == 0;
        for (const auto& t : triangulation.tetrahedra_of(i)) {
            for (const std::uint32_t point : t) {
                if (!open) given[point] = 1;
                if (triangulation.sign(point) < 0) negative[point] = 1;
            }
        }
    }
    std::vector<std::uint32_t> result;
    for (std::uint32_t point = 0; point < given.size(); ++point) {
        if (negative[point] && !given[point]) result.push_back(point);
    }
    return result;
}

}  // namespace

std::string write_certificate(const Expression& function, const Octree& tree, const Triangulation& triangulation,
                              const Growth& growth, const Surface& surface, const TriangleMesh& mesh,
                              const std::vector<ImplicitComponent>& components, std::optional<double> hausdorff) {
    std::string text = "{\"format\":\"certa implicit certificate\",\"version\":1,\n\"function\":";
    text += quoted(format_expression(function)) + ",\n\"mesh\":\"" + core::digest_of(mesh) + "\",\n\"grid\":{";
    append_numbers("first", tree.grid().first(), text);
    text += ",";
    append_numbers("count", tree.grid().count(), text);
    text += ",";
    append_numbers("exponent", tree.grid().exponent(), text);
    text += ",\"resolution\":" + std::to_string(tree.grid().resolution()) + "},\n\"octree\":\"";
    append_tree(tree, 0, text);
    text += "\",\n\"negative_points\":[";
    for (const std::uint32_t point : negative_points(tree, triangulation)) append_point(tree.points()[point], text);
    text += "],\n\"marks\":[";
    for (const std::uint32_t point : growth.order) append_point(tree.points()[point], text);
    text += "],\n\"vertex_edges\":[";
    for (const auto& [a, b] : surface.vertex_edges) {
        append_point(tree.points()[a], text);
        append_point(tree.points()[b], text);
    }
    text += "],\n";
    std::vector<std::pair<int, int>> forms;
    for (const ImplicitComponent& component : components) forms.emplace_back(component.genus, component.loops);
    std::sort(forms.begin(), forms.end());
    text += "\"genera\":[";
    for (const auto& [genus, loops] : forms) append_number(genus, text);
    if (tree.is_clipped()) {
        text += "],\n\"loops\":[";
        for (const auto& [genus, loops] : forms) append_number(loops, text);
    }
    if (hausdorff) {
        // mantissa 2^exponent
        int exponent = 0;
        const double mantissa = std::frexp(*hausdorff, &exponent);
        text += "],\n\"hausdorff\":[";
        append_number(static_cast<std::int64_t>(std::ldexp(mantissa, 53)), text);
        append_number(exponent - 53, text);
    }
    return text + "]}\n";
}

std::string write_product_certificate(const std::vector<const ImplicitResult*>& factors) {
    std::string text = "{\"format\":\"certa implicit product\",\"version\":1,\n";
    std::vector<std::size_t> vertices, triangles;
    for (const ImplicitResult* factor : factors) {
        vertices.push_back(factor->mesh.positions.size());
        triangles.push_back(factor->mesh.triangles.size());
    }
    append_numbers("vertices", vertices, text);
    text += ",";
    append_numbers("triangles", triangles, text);
    text += ",\n\"factors\":[";
    for (const ImplicitResult* factor : factors) {
        if (text.back() != '[') text += ",";
        text += "\n" + factor->certificate;
    }
    return text + "]}\n";
}

}  // namespace certa::implicit
