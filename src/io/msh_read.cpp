// Gmsh's .msh, versions 2.0 to 2.2 and 4.1, text and binary. Lines become segments, triangles and quadrilaterals
// polygons, tetrahedra tetrahedra; other elements are refused. Arrays ($NodeData, $ElementData) become fields, one per
// kind of element. Where no array "marker" or label says more, physical tags are the markers, else the elementary tags
// if they differ at all. Plan: sections in file order; nodes and elements by tag; data; tags to markers.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>

#include "io/byte_cursor.h"
#include "io/document_parts.h"
#include "io/formats.h"
#include "io/msh.h"
#include "io/text_cursor.h"

namespace certa::io {
namespace {

/// Numbers in the encoding of the file, text or binary.
class MshSource {
public:
    MshSource(std::string_view text, const std::string& name)
        : words_(text, name, TextCursor::no_comments), bytes_(text, name, std::endian::little) {}

    void set_binary(std::endian order) {
        binary_ = true;
        bytes_ = ByteCursor(words_.text(), words_.name(), order);
    }
    bool is_binary() const { return binary_; }
    TextCursor& words() { return words_; }

    /// Called after the text that precedes binary numbers, and before the text that follows them.
    void enter() {
        if (binary_) words_.skip_line(), bytes_.move_to(words_.position());
    }
    void leave() {
        if (binary_) words_.move_to(bytes_.position());
    }

    std::int64_t integer(const char* what) { return binary_ ? bytes_.read<std::int32_t>(what) : words_.integer(what); }
    std::uint64_t size(const char* what) {
        if (binary_) return bytes_.read<std::uint64_t>(what);
        const std::int64_t value = words_.integer(what);
        if (value < 0) fail(std::string(what) + " is negative");
        return static_cast<std::uint64_t>(value);
    }
    double number(const char* what) {
        if (!binary_) return words_.number(what);
        const double value = bytes_.read<double>(what);
        if (!std::isfinite(value)) fail(std::string(what) + " is not finite");
        return value;
    }
    /// Checks a count against the rest of the file.
    std::uint32_t checked(std::uint64_t count, std::size_t binary_bytes, std::size_t text_bytes,
                          const char* what) const {
        const std::size_t left = binary_ ? bytes_.left() : words_.left() + 1;
        const std::size_t each = binary_ ? binary_bytes : text_bytes;
        if (count >= no_index || (each > 0 && count > left / each))
            fail(std::to_string(count) + " " + what +
                 " do not fit into the rest of the file: it is truncated or the count is wrong");
        return static_cast<std::uint32_t>(count);
    }
    [[noreturn]] void fail(const std::string& reason) const {
        if (binary_) bytes_.fail(reason);
        words_.fail(reason);
    }

private:
    TextCursor words_;
    ByteCursor bytes_;
    bool binary_ = false;
};

/// Positions of things by their tags; tags are mostly dense.
class TagMap {
public:
    /// False if the tag is there already.
    bool add(std::uint64_t tag) {
        const std::uint32_t index = size_++;
        if (tag == dense_.size() + first_ || dense_.empty()) {
            if (dense_.empty()) first_ = tag;
            dense_.push_back(index);
            return sparse_.find(tag) == sparse_.end();
        }
        if (find(tag) != no_index) return false;
        return sparse_.emplace(tag, index).second;
    }
    std::uint32_t find(std::uint64_t tag) const {
        if (tag >= first_ && tag - first_ < dense_.size()) return dense_[static_cast<std::size_t>(tag - first_)];
        const auto found = sparse_.find(tag);
        return found == sparse_.end() ? no_index : found->second;
    }

private:
    std::uint64_t first_ = 0;
    std::uint32_t size_ = 0;
    std::vector<std::uint32_t> dense_;
    std::unordered_map<std::uint64_t, std::uint32_t> sparse_;
};

/// An element in the document: which kind (index into cell_locations; 3: left out) and which of them.
struct ElementPlace {
    std::uint8_t kind;
    std::uint32_t index;
};

class MshReader {
public:
    MshReader(std::string_view text, const std::string& name) : source_(text, name) {}

    MeshDocument read() {
        TextCursor& words = source_.words();
        if (words.at_end()) words.fail("the file is empty");
        if (words.word("$MeshFormat") != "$MeshFormat") words.fail("a .msh file starts with $MeshFormat");
        read_format();
        while (!words.at_end()) read_section();
        if (!has_nodes_) words.fail("the file has no $Nodes");
        take_tags();
        make_facets_of_polygons(complex());
        if (lone_points_) document_.notes.push_back("point elements are left out");
        return std::move(document_);
    }

private:
    PiecewiseLinearComplex& complex() { return document_.complex; }

    void read_format() {
        TextCursor& words = source_.words();
        const std::string_view version = words.word("the version");
        if (version != "2" && version != "2.0" && version != "2.1" && version != "2.2" && version != "4.1")
            words.fail("version " + quoted(version) + " is not read; save it as 2.2 or 4.1");
        is_version_4_ = version == "4.1";
        const std::int64_t kind = words.integer("the kind of file");
        const std::int64_t size = words.integer("the size of numbers");
        if (kind < 0 || kind > 1) words.fail("the kind of file is neither 0 (text) nor 1 (binary)");
        if (size != 8) words.fail("numbers of " + std::to_string(size) + " bytes are not read, only of 8");
        if (kind == 1) {
            words.skip_line();
            ByteCursor bytes(words.text(), words.name(), std::endian::little);
            bytes.move_to(words.position());
            const auto one = bytes.read<std::int32_t>("the number one");
            if (one != 1 && byte_swapped(one) != 1) bytes.fail("the byte order of the file cannot be told");
            words.move_to(bytes.position());
            source_.set_binary(one == 1 ? std::endian::little : std::endian::big);
        }
        end_section("MeshFormat");
    }

    void end_section(const std::string& name) {
        TextCursor& words = source_.words();
        const std::string_view word = words.word(("$End" + name).c_str());
        if (word != "$End" + name) words.fail(quoted(word) + " where $End" + name + " was expected");
    }

    void read_section() {
        TextCursor& words = source_.words();
        const std::string_view word = words.word("a section");
        if (!word.starts_with('$') || word.starts_with("$End"))
            words.fail(quoted(word) + " where a section was expected");
        const std::string name(word.substr(1));
        if (name == "Nodes") {
            has_nodes_ ? words.fail("a second section $Nodes") : read_nodes();
        } else if (name == "Elements") {
            has_elements_ ? words.fail("a second section $Elements") : read_elements();
        } else if (name == "Entities" && is_version_4_) {
            read_entities();
        } else if (name == "NodeData" || name == "ElementData") {
            read_data(name == "NodeData");
        } else {
            skip_section(name);
            return;
        }
        end_section(name);
    }

    void skip_section(const std::string& name) {
        TextCursor& words = source_.words();
        const std::size_t end = words.text().find("$End" + name, words.position());
        if (end == std::string_view::npos) words.fail("the section $" + name + " has no end");
        if (name != "Comments") document_.notes.push_back("the section $" + name + " is left out");
        words.move_to(end);
        end_section(name);
    }

    // --- nodes ---

    void read_nodes() {
        has_nodes_ = true;
        is_version_4_ ? read_nodes_4() : read_nodes_2();
    }

    void add_node(std::uint64_t tag) {
        if (!nodes_.add(tag)) source_.fail("node " + std::to_string(tag) + " is there twice");
    }

    Point3 read_point() {
        Point3 p;
        p.x = source_.number("a coordinate");
        p.y = source_.number("a coordinate");
        p.z = source_.number("a coordinate");
        return p;
    }

    void read_nodes_2() {
        const std::uint32_t count = source_.words().count("the number of nodes", 0);
        source_.enter();
        source_.checked(count, 28, 8, "nodes");
        for (std::uint32_t i = 0; i < count; ++i) {
            add_node(positive_tag(source_.integer("the tag of a node")));
            complex().positions.push_back(read_point());
        }
        source_.leave();
    }

    std::uint64_t positive_tag(std::int64_t tag) const {
        if (tag < 0) source_.fail("a negative tag: " + std::to_string(tag));
        return static_cast<std::uint64_t>(tag);
    }

    void read_nodes_4() {
        source_.enter();
        const std::uint32_t blocks = source_.checked(source_.size("the number of blocks"), 20, 8, "blocks of nodes");
        const std::uint32_t total = source_.checked(source_.size("the number of nodes"), 32, 8, "nodes");
        source_.size("the least tag");
        source_.size("the largest tag");
        for (std::uint32_t b = 0; b < blocks; ++b) {
            const std::int64_t dimension = source_.integer("the dimension of an entity");
            source_.integer("the tag of an entity");
            const std::int64_t parametric = source_.integer("the mark of parametric nodes");
            if (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1)
                source_.fail("the header of a block of nodes is damaged");
            const std::uint32_t count = source_.checked(source_.size("the number of nodes"), 32, 8, "nodes");
            for (std::uint32_t i = 0; i < count; ++i) add_node(source_.size("the tag of a node"));
            for (std::uint32_t i = 0; i < count; ++i) {
                complex().positions.push_back(read_point());
                for (std::int64_t k = 0; k < dimension * parametric; ++k) source_.number("a parameter");
            }
        }
        if (complex().positions.size() != total)
            source_.fail("the blocks hold " + std::to_string(complex().positions.size()) + " nodes where " +
                         std::to_string(total) + " were promised");
        source_.leave();
    }

    // --- entities ---

    void read_entities() {
        source_.enter();
        std::array<std::uint32_t, 4> counts{};
        for (std::uint32_t& count : counts)
            count = source_.checked(source_.size("the number of entities"), 36, 10, "entities");
        for (int dimension = 0; dimension < 4; ++dimension)
            for (std::uint32_t i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i) read_entity(dimension);
        source_.leave();
    }

    void read_entity(int dimension) {
        const std::int64_t tag = source_.integer("the tag of an entity");
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) source_.number("a bound of an entity");
        const std::uint32_t physicals =
            source_.checked(source_.size("the number of physical tags"), 4, 2, "physical tags");
        for (std::uint32_t k = 0; k < physicals; ++k) {
            const std::int64_t physical = source_.integer("a physical tag");
            if (k == 0) physicals_[{dimension, tag}] = physical;
        }
        if (physicals > 1) several_physicals_ = true;
        if (dimension == 0) return;
        const std::uint32_t bounds =
            source_.checked(source_.size("the number of bounding entities"), 4, 2, "bounding entities");
        for (std::uint32_t k = 0; k < bounds; ++k) source_.integer("the tag of a bounding entity");
    }

    // --- elements ---

    void read_elements() {
        if (!has_nodes_) source_.words().fail("$Elements before $Nodes");
        has_elements_ = true;
        is_version_4_ ? read_elements_4() : read_elements_2();
    }

    static std::uint32_t corner_count(MshElement type) {
        switch (type) {
            case MshElement::line:
                return 2;
            case MshElement::triangle:
                return 3;
            case MshElement::quad:
            case MshElement::tetrahedron:
                return 4;
            case MshElement::point:
                return 1;
        }
        return 0;
    }

    MshElement checked_type(std::int64_t number) const {
        const auto type = static_cast<MshElement>(number);
        if (number < 0 || number > 1000 || corner_count(type) == 0)
            source_.fail("elements of Gmsh's type " + std::to_string(number) +
                         " are not read; only lines, triangles, quadrilaterals and tetrahedra of first order are");
        return type;
    }

    VertexId vertex_of(std::uint64_t tag) const {
        const std::uint32_t vertex = nodes_.find(tag);
        if (vertex == no_index) source_.fail("node " + std::to_string(tag) + " does not exist");
        return VertexId{vertex};
    }

    void add_element(std::uint64_t tag, MshElement type, std::span<const VertexId> c, std::int64_t physical,
                     std::int64_t elementary) {
        if (!elements_.add(tag)) source_.fail("element " + std::to_string(tag) + " is there twice");
        std::uint8_t kind = 3;
        switch (type) {
            case MshElement::point:
                lone_points_ = true;
                break;
            case MshElement::line:
                kind = 2, complex().segments.push_back({c[0], c[1]});
                break;
            case MshElement::tetrahedron:
                kind = 0, document_.tetrahedra.push_back({c[0], c[1], c[2], c[3]});
                break;
            case MshElement::triangle:
            case MshElement::quad:
                kind = 1;
                complex().corners.insert(complex().corners.end(), c.begin(), c.end());
                close_polygon(complex());
                break;
        }
        const std::size_t index = kind < 3 ? size_at(document_, cell_locations[kind]) - 1 : 0;
        places_.push_back({kind, static_cast<std::uint32_t>(index)});
        if (kind == 3) return;
        physical_tags_[kind].push_back(physical);
        elementary_tags_[kind].push_back(elementary);
    }

    void read_element_2(MshElement type, std::uint64_t tag, std::uint32_t tags) {
        std::int64_t physical = 0, elementary = 0;
        for (std::uint32_t k = 0; k < tags; ++k) {
            const std::int64_t value = source_.integer("the tag of an element");
            if (k == 0) physical = value;
            if (k == 1) elementary = value;
        }
        std::array<VertexId, 4> corners;
        const std::uint32_t degree = corner_count(type);
        for (std::uint32_t k = 0; k < degree; ++k) corners[k] = vertex_of(positive_tag(source_.integer("a node")));
        add_element(tag, type, {corners.data(), degree}, physical, elementary);
    }

    void read_elements_2() {
        const std::uint32_t count = source_.words().count("the number of elements", 0);
        source_.enter();
        source_.checked(count, 8, 8, "elements");
        if (!source_.is_binary()) {
            for (std::uint32_t i = 0; i < count; ++i) {
                const std::uint64_t tag = positive_tag(source_.integer("the tag of an element"));
                const MshElement type = checked_type(source_.integer("the type of an element"));
                const std::uint64_t tags = positive_tag(source_.integer("the number of tags"));
                read_element_2(type, tag, source_.checked(tags, 4, 2, "tags"));
            }
            return;
        }
        for (std::uint32_t done = 0; done < count;) {
            const MshElement type = checked_type(source_.integer("the type of an element"));
            const std::uint64_t here = positive_tag(source_.integer("the number of elements"));
            const std::uint32_t tags =
                source_.checked(positive_tag(source_.integer("the number of tags")), 4, 2, "tags");
            if (here == 0 || here > count - done) source_.fail("a block of elements holds more than were promised");
            for (std::uint64_t i = 0; i < here; ++i)
                read_element_2(type, positive_tag(source_.integer("the tag of an element")), tags);
            done += static_cast<std::uint32_t>(here);
        }
        source_.leave();
    }

    void read_elements_4() {
        source_.enter();
        const std::uint32_t blocks = source_.checked(source_.size("the number of blocks"), 20, 8, "blocks of elements");
        const std::uint32_t total = source_.checked(source_.size("the number of elements"), 16, 4, "elements");
        source_.size("the least tag");
        source_.size("the largest tag");
        std::uint64_t seen = 0;
        for (std::uint32_t b = 0; b < blocks; ++b) {
            const std::int64_t dimension = source_.integer("the dimension of an entity");
            const std::int64_t entity = source_.integer("the tag of an entity");
            const MshElement type = checked_type(source_.integer("the type of an element"));
            const std::uint32_t count = source_.checked(source_.size("the number of elements"), 16, 4, "elements");
            const auto found = physicals_.find({static_cast<int>(dimension), entity});
            const std::int64_t physical = found == physicals_.end() ? 0 : found->second;
            const std::uint32_t degree = corner_count(type);
            for (std::uint32_t i = 0; i < count; ++i) {
                const std::uint64_t tag = source_.size("the tag of an element");
                std::array<VertexId, 4> corners;
                for (std::uint32_t k = 0; k < degree; ++k) corners[k] = vertex_of(source_.size("a node"));
                add_element(tag, type, {corners.data(), degree}, physical, entity);
            }
            seen += count;
        }
        if (seen != total)
            source_.fail("the blocks hold " + std::to_string(seen) + " elements where " + std::to_string(total) +
                         " were promised");
        source_.leave();
    }

    // --- data ---

    std::string read_quoted() {
        TextCursor& words = source_.words();
        if (words.at_end()) words.fail("the file ends where a name was expected");
        const std::size_t start = words.position();
        words.word("a name");
        words.move_to(start);
        const std::string_view line = words.rest_of_line();
        const std::size_t end = line.size() > 1 ? line.find('"', 1) : std::string_view::npos;
        if (line.front() != '"' || end == std::string_view::npos) words.fail("a name in double quotes was expected");
        return std::string(line.substr(1, end - 1));
    }

    void read_data(bool of_nodes) {
        TextCursor& words = source_.words();
        const std::uint32_t strings = words.count("the number of names", 2);
        std::string name;
        for (std::uint32_t k = 0; k < strings; ++k) {
            std::string text = read_quoted();
            if (k == 0) name = std::move(text);
        }
        const std::uint32_t reals = words.count("the number of real tags", 2);
        for (std::uint32_t k = 0; k < reals; ++k) words.number("a real tag");
        const std::uint32_t integers = words.count("the number of integer tags", 2);
        std::array<std::int64_t, 3> tags{0, 1, 0};
        for (std::uint32_t k = 0; k < integers; ++k) {
            const std::int64_t value = words.integer("an integer tag");
            if (k < 3) tags[k] = value;
        }
        if (strings == 0 || name.empty() || integers < 3 || tags[1] < 1 || tags[1] > 1'000'000 || tags[2] < 0)
            words.fail("the tags of an array are incomplete or out of range");
        const auto components = static_cast<std::uint32_t>(tags[1]);
        source_.enter();
        const std::uint32_t rows = source_.checked(static_cast<std::uint64_t>(tags[2]), 4 + 8 * std::size_t{components},
                                                   2 + 2 * std::size_t{components}, "rows of an array");
        of_nodes ? read_node_rows(name, components, rows) : read_element_rows(name, components, rows);
        source_.leave();
    }

    /// An array may state few rows for many elements; what it does not state is zero but costs memory, which must stay
    /// in proportion to the file.
    void check_memory(std::size_t elements, std::uint32_t components) {
        array_numbers_ += std::uint64_t{elements} * components;
        if (array_numbers_ > 16 * std::uint64_t{source_.words().text().size()})
            source_.fail("arrays state too few of their rows");
    }

    void read_node_rows(const std::string& name, std::uint32_t components, std::uint32_t rows) {
        const std::size_t size = complex().positions.size();
        check_memory(size, components);
        std::vector<double> values(size * components, 0.0);
        std::vector<bool> seen(size, false);
        for (std::uint32_t i = 0; i < rows; ++i) {
            const std::uint32_t node = index_of(vertex_of(positive_tag(source_.integer("the tag of a node"))));
            if (seen[node]) source_.fail("an array has two rows for one node");
            seen[node] = true;
            for (std::uint32_t k = 0; k < components; ++k)
                values[std::size_t{node} * components + k] = source_.number("a value");
        }
        add_vertex_array(document_, name, components, typed(name, components, std::move(values)));
    }

    void read_element_rows(const std::string& name, std::uint32_t components, std::uint32_t rows) {
        check_memory(places_.size(), components);
        std::array<std::vector<double>, 3> parts;
        for (std::size_t k = 0; k < 3; ++k) parts[k].resize(size_at(document_, cell_locations[k]) * components, 0.0);
        std::vector<bool> seen(places_.size(), false);
        for (std::uint32_t i = 0; i < rows; ++i) {
            const std::uint64_t tag = positive_tag(source_.integer("the tag of an element"));
            const std::uint32_t element = elements_.find(tag);
            if (element == no_index) source_.fail("element " + std::to_string(tag) + " does not exist");
            if (seen[element]) source_.fail("an array has two rows for one element");
            seen[element] = true;
            const ElementPlace place = places_[element];
            for (std::uint32_t k = 0; k < components; ++k) {
                const double value = source_.number("a value");
                if (place.kind < 3) parts[place.kind][std::size_t{place.index} * components + k] = value;
            }
        }
        std::array<NumberArray, 3> typed_parts;
        bool integers = true;
        for (std::size_t k = 0; k < 3; ++k) {
            typed_parts[k] = typed(name, components, parts[k]);
            integers = integers && std::holds_alternative<std::vector<std::int64_t>>(typed_parts[k]);
        }
        if (!integers)
            for (std::size_t k = 0; k < 3; ++k) typed_parts[k] = std::move(parts[k]);
        const std::array labels{"region", "facet", "segment"};
        for (std::size_t k = 0; k < 3; ++k) has_numbers_[k] = has_numbers_[k] || name == "marker" || name == labels[k];
        add_cell_array(document_, name, components, std::move(typed_parts));
    }

    /// The values of labels and markers as whole numbers, if they are.
    static NumberArray typed(const std::string& name, std::uint32_t components, std::vector<double> values) {
        constexpr double most = 9007199254740992.0;  // 2^53
        const auto* end = std::end(msh_integer_names);
        const bool is_name = std::find(std::begin(msh_integer_names), end, name) != end;
        const bool whole = is_name && components == 1 && std::all_of(values.begin(), values.end(), [](double v) {
                               return v == std::floor(v) && std::abs(v) <= most;
                           });
        if (!whole) return values;
        std::vector<std::int64_t> integers;
        integers.reserve(values.size());
        for (const double v : values) integers.push_back(static_cast<std::int64_t>(v));
        return integers;
    }

    // --- tags ---

    /// Do elementary tags say anything beside the physical ones, where there are any?
    static bool says_more(const std::vector<std::int64_t>& elementary, const std::vector<std::int64_t>& physical) {
        std::set<std::int64_t> others;
        for (std::size_t i = 0; i < physical.size(); ++i) {
            if (physical[i] == 0) others.insert(elementary[i]);
            if (physical[i] != 0 && physical[i] != elementary[i]) return true;
        }
        return others.size() > 1;
    }

    void take_tags() {
        if (several_physicals_)
            document_.notes.push_back("of several physical tags of an entity only the first is read");
        for (std::size_t k = 0; k < 3; ++k) {
            if (has_numbers_[k]) continue;
            std::vector<std::int64_t>& physical = physical_tags_[k];
            std::vector<std::int64_t>& elementary = elementary_tags_[k];
            const bool has_physical =
                std::any_of(physical.begin(), physical.end(), [](std::int64_t t) { return t != 0; });
            const bool differ =
                std::adjacent_find(elementary.begin(), elementary.end(), std::not_equal_to<>()) != elementary.end();
            if (!has_physical && !differ) continue;
            if (has_physical && differ && says_more(elementary, physical))
                document_.notes.push_back(std::string("elementary tags of ") + name_of(cell_locations[k]) +
                                          " are left out");
            std::array<NumberArray, 3> parts;
            for (NumberArray& part : parts) part = std::vector<std::int64_t>();
            parts[k] = std::move(has_physical ? physical : elementary);
            add_cell_array(document_, "marker", 1, std::move(parts));
        }
    }

    MshSource source_;
    MeshDocument document_;
    bool is_version_4_ = false, has_nodes_ = false, has_elements_ = false;
    bool lone_points_ = false, several_physicals_ = false;
    TagMap nodes_, elements_;
    std::vector<ElementPlace> places_;
    std::map<std::pair<int, std::int64_t>, std::int64_t> physicals_;
    std::array<std::vector<std::int64_t>, 3> physical_tags_, elementary_tags_;
    std::array<bool, 3> has_numbers_{};
    std::uint64_t array_numbers_ = 0;
};

}  // namespace

MeshDocument read_msh(std::string_view text, const std::string& name) { return MshReader(text, name).read(); }

}  // namespace certa::io
