// Gmsh's .msh, version 4.1 or 2.2, text or binary. Elements are the segments, the polygons, then the tetrahedra, tagged
// from 1 in this order. Every field, label and marker is an array over all elements ($ElementData), 0 where a kind has
// none; markers alone need no array, because the tags say them. So that Gmsh's own tools see them, the number of each
// element (reference, see MeshDocument) is also its physical tag and its entity; elements without a positive one share
// an entity without a physical tag. Version 4.1 keeps elements by entity: one block per run of equal entities keeps
// their order.
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <map>

#include "io/document_parts.h"
#include "io/formats.h"
#include "io/msh.h"
#include "io/text_output.h"

namespace certa::io {
namespace {

/// One kind of element: dimension 1, 2 or 3.
struct Group {
    int dimension;
    Location location;
    std::vector<std::int32_t> entities;  // one per element
    std::int32_t plain_entity;           // that of elements without a number
};

struct Box {
    Point3 low, high;
};

class MshWriter {
public:
    MshWriter(const MeshDocument& document, bool binary, bool version_2)
        : document_(document), complex_(document.complex), binary_(binary), version_2_(version_2) {
        const ElementNumbers numbers = choose_element_numbers(document);
        groups_.push_back(make_group(1, Location::segments, numbers.segments));
        groups_.push_back(make_group(2, Location::polygons, numbers.polygons));
        groups_.push_back(make_group(3, Location::tetrahedra, numbers.tetrahedra));
        for (const Group& group : groups_) element_count_ += group.entities.size();
        if (std::max(element_count_, complex_.positions.size()) > std::numeric_limits<std::int32_t>::max())
            throw IoError("document", 0, "msh numbers elements by 32-bit integers; write vtu");
    }

    std::string write() {
        out_ << "$MeshFormat\n" << (version_2_ ? "2.2 " : "4.1 ") << (binary_ ? "1 8\n" : "0 8\n");
        if (binary_) {
            put_integer(1);
            end_line();
        }
        out_ << "$EndMeshFormat\n";
        if (!document_.remark.empty()) out_ << "$Comments\n" << remark_line(document_) << "\n$EndComments\n";
        if (version_2_) {
            write_nodes_2();
            write_elements_2();
        } else {
            write_entities();
            write_nodes_4();
            write_elements_4();
        }
        write_node_data();
        write_element_data();
        return out_.take();
    }

private:
    Group make_group(int dimension, Location location, const std::vector<std::int64_t>& numbers) const {
        constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max() - 1;
        Group group{dimension, location, {}, 1};
        for (const std::int64_t number : numbers)
            if (number > 0 && number <= most)
                group.plain_entity = std::max(group.plain_entity, static_cast<std::int32_t>(number) + 1);
        group.entities.assign(size_at(document_, location), group.plain_entity);
        for (std::size_t i = 0; i < numbers.size(); ++i)
            if (numbers[i] > 0 && numbers[i] <= most) group.entities[i] = static_cast<std::int32_t>(numbers[i]);
        return group;
    }

    std::span<const VertexId> corners_of(const Group& group, std::size_t i) const {
        if (group.dimension == 1) return complex_.segments[i];
        if (group.dimension == 2) return polygon_corners(complex_, i);
        return document_.tetrahedra[i];
    }

    std::int32_t type_of(const Group& group, std::size_t i) const {
        if (group.dimension == 1) return static_cast<std::int32_t>(MshElement::line);
        if (group.dimension == 3) return static_cast<std::int32_t>(MshElement::tetrahedron);
        return static_cast<std::int32_t>(polygon_corners(complex_, i).size() == 3 ? MshElement::triangle
                                                                                  : MshElement::quad);
    }

    static std::int32_t physical_of(const Group& group, std::int32_t entity) {
        return entity == group.plain_entity ? 0 : entity;
    }

    // --- numbers ---

    template <class T>
    void put(T value) {
        if (!binary_) {
            out_ << value << ' ';
            return;
        }
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        out_ << std::string_view(bytes, sizeof(T));
    }
    void put_integer(std::int32_t value) { put(value); }
    void put_size(std::uint64_t value) { put(value); }
    void put_number(double value) { put(value); }
    void put_point(const Point3& p) {
        put_number(p.x);
        put_number(p.y);
        put_number(p.z);
    }
    /// Ends a line of text; binary numbers have no lines.
    void end_row() {
        if (!binary_) out_.text().back() = '\n';
    }
    /// Ends a line in both encodings.
    void end_line() { binary_ ? void(out_ << '\n') : end_row(); }
    void end_binary() {
        if (binary_) out_ << '\n';
    }

    // --- version 2.2 ---

    void write_nodes_2() {
        out_ << "$Nodes\n" << complex_.positions.size() << '\n';
        for (std::size_t i = 0; i < complex_.positions.size(); ++i) {
            put_integer(static_cast<std::int32_t>(i + 1));
            put_point(complex_.positions[i]);
            end_row();
        }
        end_binary();
        out_ << "$EndNodes\n";
    }

    void write_elements_2() {
        out_ << "$Elements\n" << element_count_ << '\n';
        std::int32_t tag = 0;
        for (const Group& group : groups_) {
            for (std::size_t i = 0; i < group.entities.size(); ++i) {
                if (binary_) {
                    // One block per run of elements of one type.
                    if (i == 0 || type_of(group, i) != type_of(group, i - 1)) {
                        std::size_t end = i;
                        while (end < group.entities.size() && type_of(group, end) == type_of(group, i)) ++end;
                        put_integer(type_of(group, i));
                        put_integer(static_cast<std::int32_t>(end - i));
                        put_integer(2);
                    }
                    put_integer(++tag);
                } else {
                    put_integer(++tag);
                    put_integer(type_of(group, i));
                    put_integer(2);
                }
                put_integer(physical_of(group, group.entities[i]));
                put_integer(group.entities[i]);
                for (const VertexId corner : corners_of(group, i))
                    put_integer(static_cast<std::int32_t>(index_of(corner) + 1));
                end_row();
            }
        }
        end_binary();
        out_ << "$EndElements\n";
    }

    // --- version 4.1 ---

    std::map<std::int32_t, Box> boxes_of(const Group& group) const {
        std::map<std::int32_t, Box> boxes;
        for (std::size_t i = 0; i < group.entities.size(); ++i) {
            const auto corners = corners_of(group, i);
            const Point3& first = complex_.positions[index_of(corners[0])];
            Box& box = boxes.try_emplace(group.entities[i], Box{first, first}).first->second;
            for (const VertexId corner : corners) {
                const Point3& p = complex_.positions[index_of(corner)];
                box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
                box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
            }
        }
        return boxes;
    }

    void write_entities() {
        out_ << "$Entities\n";
        // Nodes belong to an entity; a cloud of points needs one of its own.
        const bool lone = element_count_ == 0 && !complex_.positions.empty();
        put_size(lone ? 1 : 0);
        std::vector<std::map<std::int32_t, Box>> boxes;
        for (const Group& group : groups_) {
            boxes.push_back(boxes_of(group));
            put_size(boxes.back().size());
        }
        end_row();
        if (lone) {
            put_integer(1);
            put_point(complex_.positions.front());
            put_size(0);
            end_row();
        }
        for (std::size_t g = 0; g < groups_.size(); ++g)
            for (const auto& [entity, box] : boxes[g]) {
                put_integer(entity);
                put_point(box.low);
                put_point(box.high);
                const std::int32_t physical = physical_of(groups_[g], entity);
                put_size(physical != 0 ? 1 : 0);
                if (physical != 0) put_integer(physical);
                put_size(0);
                end_row();
            }
        end_binary();
        out_ << "$EndEntities\n";
    }

    void write_nodes_4() {
        const std::size_t count = complex_.positions.size();
        out_ << "$Nodes\n";
        put_size(count > 0 ? 1 : 0);
        put_size(count);
        put_size(count > 0 ? 1 : 0);
        put_size(count);
        end_row();
        if (count > 0) {
            std::int32_t dimension = 0, entity = 1;
            for (const Group& group : groups_)
                if (!group.entities.empty()) dimension = group.dimension, entity = group.entities.front();
            put_integer(dimension);
            put_integer(entity);
            put_integer(0);
            put_size(count);
            end_row();
        }
        for (std::size_t i = 0; i < count; ++i) {
            put_size(i + 1);
            end_row();
        }
        for (const Point3& p : complex_.positions) {
            put_point(p);
            end_row();
        }
        end_binary();
        out_ << "$EndNodes\n";
    }

    bool starts_block(const Group& group, std::size_t i) const {
        return i == 0 || group.entities[i] != group.entities[i - 1] || type_of(group, i) != type_of(group, i - 1);
    }

    void write_elements_4() {
        std::size_t blocks = 0;
        for (const Group& group : groups_)
            for (std::size_t i = 0; i < group.entities.size(); ++i) blocks += starts_block(group, i) ? 1 : 0;
        out_ << "$Elements\n";
        put_size(blocks);
        put_size(element_count_);
        put_size(element_count_ > 0 ? 1 : 0);
        put_size(element_count_);
        end_row();
        std::uint64_t tag = 0;
        for (const Group& group : groups_)
            for (std::size_t i = 0; i < group.entities.size(); ++i) {
                if (starts_block(group, i)) {
                    std::size_t end = i + 1;
                    while (end < group.entities.size() && !starts_block(group, end)) ++end;
                    put_integer(group.dimension);
                    put_integer(group.entities[i]);
                    put_integer(type_of(group, i));
                    put_size(end - i);
                    end_row();
                }
                put_size(++tag);
                for (const VertexId corner : corners_of(group, i)) put_size(index_of(corner) + 1ULL);
                end_row();
            }
        end_binary();
        out_ << "$EndElements\n";
    }

    // --- data ---

    void write_array(const char* section, std::string_view name, std::uint32_t components, const NumberArray& values) {
        const std::size_t rows = std::visit([](const auto& v) { return v.size(); }, values) / components;
        out_ << '$' << section << "\n1\n\"" << name << "\"\n1\n0\n3\n0\n" << components << '\n' << rows << '\n';
        for (std::size_t i = 0; i < rows; ++i) {
            put_integer(static_cast<std::int32_t>(i + 1));
            for (std::uint32_t k = 0; k < components; ++k)
                std::visit([&](const auto& v) { put_number(static_cast<double>(v[i * components + k])); }, values);
            end_row();
        }
        end_binary();
        out_ << "$End" << section << '\n';
    }

    void write_node_data() {
        const std::vector<std::int32_t>& markers = complex_.point_markers;
        if (!markers.empty())
            write_array("NodeData", "marker", 1, std::vector<std::int64_t>(markers.begin(), markers.end()));
        for (const Field& field : document_.fields)
            if (field.location == Location::vertices)
                write_array("NodeData", field.name, field.components, field.values);
    }

    /// Do the physical tags say all that the markers say? Not beside labels, nor if one is negative.
    bool tags_carry_markers() const {
        for (const Group& group : groups_) {
            for (const char* label : {"region", "facet", "segment"})
                if (find_field(document_, label, group.location) != nullptr) return false;
            const auto* markers = find_markers(complex_, group.location);
            const auto* field = find_integers(document_, "marker", group.location);
            const auto fits = [](std::int64_t m) { return 0 <= m && m < std::numeric_limits<std::int32_t>::max(); };
            if (markers != nullptr && !std::all_of(markers->begin(), markers->end(), fits)) return false;
            if (field != nullptr && !std::all_of(field->begin(), field->end(), fits)) return false;
            // An array of zeros is something that tags cannot say.
            if (field != nullptr && std::all_of(field->begin(), field->end(), [](std::int64_t m) { return m == 0; }))
                return false;
        }
        return true;
    }

    void write_element_data() {
        const bool skips_markers = tags_carry_markers();
        for (const std::string& name : cell_array_names(document_)) {
            if (name == "marker" && skips_markers) continue;
            const std::uint32_t components = cell_array_components(document_, name);
            // merged_cell_array goes from tetrahedra to segments, elements of this file the other way.
            std::visit(
                [&](const auto& merged) {
                    auto values = merged;
                    values.clear();
                    for (const Group& group : groups_) {
                        std::size_t start = 0;
                        for (const Location location : cell_locations) {
                            if (location == group.location) break;
                            start += size_at(document_, location) * components;
                        }
                        const auto first = merged.begin() + static_cast<std::ptrdiff_t>(start);
                        values.insert(values.end(), first,
                                      first + static_cast<std::ptrdiff_t>(group.entities.size() * components));
                    }
                    write_array("ElementData", name, components, values);
                },
                merged_cell_array(document_, name));
        }
    }

    const MeshDocument& document_;
    const PiecewiseLinearComplex& complex_;
    bool binary_, version_2_;
    std::vector<Group> groups_;
    std::size_t element_count_ = 0;
    TextOutput out_;
};

}  // namespace

std::string write_msh(const MeshDocument& document, Encoding encoding, bool version_2) {
    return MshWriter(document, encoding == Encoding::binary, version_2).write();
}

}  // namespace certa::io
