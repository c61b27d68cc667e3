// Wavefront OBJ: vertices, faces and lines (`l`: chains of segments). Texture coordinates, normals, colours, groups and
// materials are read over; free-form geometry is refused. A backslash at the end of a line continues it.
// Plan: one statement per logical line; indices are checked at the end of the file, because a face may come before its
// vertices; negative ones count back from the vertices read so far.
#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <string>
#include <string_view>

#include "io/document_parts.h"
#include "io/formats.h"
#include "io/text_cursor.h"
#include "io/text_output.h"

namespace certa::io {
namespace {

/// A statement that is stepped over, and what it holds, as the note of the document says it.
struct IgnoredWord {
    std::string_view word, kind;
};
constexpr std::array ignored_words{IgnoredWord{"vt", "texture coordinates"},
                                   IgnoredWord{"vn", "normals"},
                                   IgnoredWord{"g", "groups"},
                                   IgnoredWord{"o", "object names"},
                                   IgnoredWord{"s", "groups"},
                                   IgnoredWord{"mg", "groups"},
                                   IgnoredWord{"usemtl", "materials"},
                                   IgnoredWord{"mtllib", "materials"},
                                   IgnoredWord{"usemap", "materials"},
                                   IgnoredWord{"maplib", "materials"},
                                   IgnoredWord{"lod", "display attributes"},
                                   IgnoredWord{"bevel", "display attributes"},
                                   IgnoredWord{"c_interp", "display attributes"},
                                   IgnoredWord{"d_interp", "display attributes"},
                                   IgnoredWord{"shadow_obj", "display attributes"},
                                   IgnoredWord{"trace_obj", "display attributes"},
                                   IgnoredWord{"p", "point elements"}};
constexpr std::array free_form_words{"vp",   "cstype", "deg", "bmat", "step", "curv",  "curv2", "surf", "parm", "trim",
                                     "hole", "scrv",   "sp",  "end",  "con",  "ctech", "stech", "call", "csh"};

template <std::size_t N>
bool contains(const std::array<const char*, N>& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

const IgnoredWord* ignored_word(std::string_view word) {
    const auto* found = std::find_if(ignored_words.begin(), ignored_words.end(),
                                     [&](const IgnoredWord& ignored) { return ignored.word == word; });
    return found == ignored_words.end() ? nullptr : found;
}

/// "a", "a and b", "a, b and c".
std::string list_of(const std::set<std::string_view>& words) {
    std::string text;
    std::size_t left = words.size();
    for (const std::string_view word : words) {
        text += word;
        if (--left > 0) text += left == 1 ? " and " : ", ";
    }
    return text;
}

class ObjReader {
public:
    ObjReader(std::string_view text, const std::string& name) : cursor_(text, name, '#') {}

    MeshDocument read() {
        if (cursor_.at_end() && cursor_.text().empty()) cursor_.fail("the file is empty");
        while (!cursor_.at_end()) read_statement();
        check_forward_references();
        make_facets_of_polygons(complex());
        if (!left_out_.empty()) document_.notes.push_back(list_of(left_out_) + " are left out");
        return std::move(document_);
    }

private:
    PiecewiseLinearComplex& complex() { return document_.complex; }

    /// Is the logical line over? Steps over continuations.
    bool at_statement_end() {
        while (!cursor_.at_line_end()) {
            const std::string_view text = cursor_.text();
            const std::size_t here = cursor_.position();
            if (text[here] != '\\') return false;
            cursor_.move_to(here + 1);
            if (!cursor_.at_line_end()) cursor_.fail("text after the backslash that continues a line");
            cursor_.skip_line();
        }
        return true;
    }

    void skip_statement() {
        std::string_view line = cursor_.rest_of_line();
        while (line.ends_with('\\') && cursor_.left() > 0) {
            cursor_.skip_line();
            line = cursor_.rest_of_line();
        }
    }

    void read_statement() {
        const std::string_view keyword = cursor_.word("a statement");
        if (keyword == "v") {
            read_vertex();
        } else if (keyword == "f" || keyword == "fo") {
            read_face();
        } else if (keyword == "l") {
            read_line();
        } else if (const auto* ignored = ignored_word(keyword)) {
            left_out_.insert(ignored->kind);
            skip_statement();
        } else if (contains(free_form_words, keyword)) {
            cursor_.fail("free-form geometry (" + quoted(keyword) + ") is not read; save it as polygons");
        } else {
            cursor_.fail(quoted(keyword) + " is not a statement of an OBJ file");
        }
        cursor_.skip_line();
    }

    double read_coordinate() {
        if (at_statement_end()) cursor_.fail("a vertex has fewer than three coordinates");
        return cursor_.number("a coordinate");
    }

    void read_vertex() {
        Point3 p;
        p.x = read_coordinate();
        p.y = read_coordinate();
        p.z = read_coordinate();
        complex().positions.push_back(p);
        int extras = 0;
        for (; !at_statement_end(); ++extras) {
            double value = 0.0;
            const std::string_view word = cursor_.word("a colour");
            if (extras == 4 || !parse_number(word, value))
                cursor_.fail("unexpected " + quoted(word) + " after the coordinates of a vertex");
        }
        if (extras > 0) left_out_.insert("colours of vertices");
    }

    /// A corner `v`, `v/vt`, `v//vn` or `v/vt/vn`; only v is used. 0-based, possibly beyond the vertices read so far.
    VertexId read_corner() {
        const std::size_t start = cursor_.position();
        std::string_view word = cursor_.word("a corner");
        if (word.ends_with('\\')) {
            word.remove_suffix(1);
            cursor_.move_to(start + word.size());
        }
        std::int64_t vertex = 0;
        const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), vertex);
        const std::string_view tail = word.substr(static_cast<std::size_t>(last - word.data()));
        const bool tail_ok = tail.empty() || (tail.front() == '/' && std::count(tail.begin(), tail.end(), '/') <= 2 &&
                                              tail.find_first_not_of("-0123456789/") == std::string_view::npos);
        if (error != std::errc() || !tail_ok) cursor_.fail(quoted(word) + " where a corner was expected");
        const auto size = static_cast<std::int64_t>(complex().positions.size());
        const std::int64_t index = vertex < 0 ? size + vertex : vertex - 1;
        if (vertex == 0 || index < 0 || index >= std::int64_t{no_index})
            cursor_.fail("vertex " + std::to_string(vertex) + " is out of range: " + std::to_string(size) +
                         " vertices so far, counted from 1");
        if (index >= size && index > farthest_) farthest_ = index, farthest_at_ = start;
        return VertexId{static_cast<std::uint32_t>(index)};
    }

    void read_face() {
        const std::size_t before = complex().corners.size();
        while (!at_statement_end()) complex().corners.push_back(read_corner());
        if (complex().corners.size() == before) cursor_.fail("a face without corners");
        close_polygon(complex());
    }

    void read_line() {
        std::size_t count = 0;
        VertexId previous{};
        for (; !at_statement_end(); ++count) {
            const VertexId corner = read_corner();
            if (count > 0) complex().segments.push_back({previous, corner});
            previous = corner;
        }
        if (count < 2) cursor_.fail("a line of fewer than two vertices");
    }

    void check_forward_references() {
        const auto size = static_cast<std::int64_t>(complex().positions.size());
        if (farthest_ >= size)
            cursor_.fail_at(farthest_at_, "vertex " + std::to_string(farthest_ + 1) +
                                              " is out of range: the file has " + std::to_string(size) + " vertices");
    }

    TextCursor cursor_;
    MeshDocument document_;
    std::int64_t farthest_ = -1;
    std::size_t farthest_at_ = 0;
    std::set<std::string_view> left_out_;
};

}  // namespace

MeshDocument read_obj(std::string_view text, const std::string& name) { return ObjReader(text, name).read(); }

std::string write_obj(const MeshDocument& document) {
    const PiecewiseLinearComplex& complex = document.complex;
    TextOutput out;
    out.reserve(complex.positions.size() * 64 + complex.corners.size() * 10);
    if (!document.remark.empty()) out << "# " << remark_line(document) << '\n';
    if (complex.positions.empty()) out << "# no vertices\n";
    for (const Point3& p : complex.positions) out << "v " << p << '\n';
    for (std::size_t i = 0; i < complex.polygon_count(); ++i) {
        out << 'f';
        for (const VertexId corner : polygon_corners(complex, i)) out << ' ' << index_of(corner) + 1ULL;
        out << '\n';
    }
    for (const Edge& edge : complex.segments)
        out << "l " << index_of(edge[0]) + 1ULL << ' ' << index_of(edge[1]) + 1ULL << '\n';
    return out.take();
}

}  // namespace certa::io
