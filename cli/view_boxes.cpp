// What stands in the way of a proof, or decides it, are boxes: the critical leaves of an octree, which a certificate
// lists with all others, and those where a run got stuck, which a report lists.
// Certificate: decode the octree, keep leaves with a sign and no slope (docs/formats.md), join those that share a point
// into clusters, draw the faces around each. Report: draw its obstacles.
#include "view_boxes.h"

#include <certa/error.h>
#include <certa/implicit.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

namespace certa::cli {
namespace {

using Json = nlohmann::json;
using GridBox = std::array<std::array<std::int64_t, 3>, 2>;  ///< low and high corner

/// Points, polygons and labels that grow box by box.
class BoxDocument {
public:
    explicit BoxDocument(const Point3& low, const Point3& high) {
        std::array<VertexId, 8> corners;
        for (unsigned c = 0; c < 8; ++c) corners[c] = add_point(corner_of(low, high, c), 0, 0);
        for (unsigned a = 0; a < 8; ++a)
            for (unsigned axis = 1; axis < 8; axis *= 2)
                if ((a & axis) == 0) document_.complex.segments.push_back({corners[a], corners[a | axis]});
    }
    /// The sides 2 axis + (1 if high) of a box that are not in `hidden`.
    void add_box(const Point3& low, const Point3& high, const std::set<int>& hidden, std::int64_t label,
                 std::int64_t sign) {
        ++boxes_;
        std::array<VertexId, 8> corners;
        corners.fill(VertexId{no_index});
        const auto corner = [&](unsigned c) {
            if (index_of(corners[c]) == no_index) corners[c] = add_point(corner_of(low, high, c), 0, 0);
            return corners[c];
        };
        for (int side = 0; side < 6; ++side) {
            if (hidden.contains(side)) continue;
            const auto axis = static_cast<unsigned>(side / 2), u = 1U << (axis + 1) % 3, v = 1U << (axis + 2) % 3;
            const unsigned base = side % 2 != 0 ? 1U << axis : 0U;
            std::vector<VertexId> ring{corner(base), corner(base | u), corner(base | u | v), corner(base | v)};
            if (side % 2 == 0) std::reverse(ring.begin(), ring.end());
            add_facet(document_.complex, {ring});
            boxes_of_.push_back(boxes_);
            labels_.push_back(label);
            signs_.push_back(sign);
        }
        // Boxes may be too small to be seen: their places are not.
        if (marked_.insert(label).second || sign == 0)
            add_point({(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2}, label, sign);
    }
    MeshDocument finish(const char* label_name, bool with_signs) {
        if (boxes_ > 0) {
            add_field("box", Location::polygons, boxes_of_);
            add_field(label_name, Location::polygons, labels_);
            if (with_signs) add_field("sign", Location::polygons, signs_);
            add_field(label_name, Location::vertices, point_labels_);
            if (with_signs) add_field("sign", Location::vertices, point_signs_);
        }
        return std::move(document_);
    }

private:
    MeshDocument document_;
    std::vector<std::int64_t> boxes_of_, labels_, signs_, point_labels_, point_signs_;
    std::set<std::int64_t> marked_;
    std::int64_t boxes_ = 0;

    void add_field(const char* name, Location location, std::vector<std::int64_t>& values) {
        document_.fields.push_back({name, location, 1, std::move(values)});
    }
    static Point3 corner_of(const Point3& low, const Point3& high, unsigned c) {
        return {(c & 1U) != 0 ? high.x : low.x, (c & 2U) != 0 ? high.y : low.y, (c & 4U) != 0 ? high.z : low.z};
    }
    VertexId add_point(const Point3& place, std::int64_t label, std::int64_t sign) {
        document_.complex.positions.push_back(place);
        point_labels_.push_back(label);
        point_signs_.push_back(sign);
        return VertexId{static_cast<std::uint32_t>(point_labels_.size() - 1)};
    }
};

/// Critical leaves of one octree in grid coordinates, with the sign of the function on each.
struct Leaves {
    std::vector<GridBox> boxes;
    std::vector<int> signs;
};

/// One cell of the preorder text and all below it.
void decode_cell(const std::string& tree, std::size_t& at, const GridBox& cell, Leaves& leaves) {
    if (at >= tree.size()) throw std::runtime_error("its octree ends early");
    const char c = tree[at++];
    if (c != '(') {
        if (c < 'a' || c > 'u') throw std::runtime_error("its octree has a leaf that is not known");
        const int sign = (c - 'a') / 7 - 1, slope = (c - 'a') % 7;
        if (sign == 0 || slope != 0) return;
        leaves.boxes.push_back(cell);
        leaves.signs.push_back(sign);
        return;
    }
    const std::int64_t half = (cell[1][0] - cell[0][0]) / 2;
    if (half == 0) throw std::runtime_error("its octree is deeper than its grid");
    for (unsigned child = 0; child < 8; ++child) {
        GridBox box;
        for (unsigned a = 0; a < 3; ++a) {
            box[0][a] = cell[0][a] + ((child >> a & 1U) != 0 ? half : 0);
            box[1][a] = box[0][a] + half;
        }
        decode_cell(tree, at, box, leaves);
    }
}

bool share_a_point(const GridBox& a, const GridBox& b) {
    for (unsigned k = 0; k < 3; ++k)
        if (a[1][k] < b[0][k] || b[1][k] < a[0][k]) return false;
    return true;
}

/// The cluster of each leaf, numbered from 1 by first leaf. Leaves are sorted along x: only those are compared whose
/// ranges there meet.
std::vector<std::int64_t> clusters_of(const Leaves& leaves) {
    const std::size_t count = leaves.boxes.size();
    std::vector<std::size_t> parent(count), order(count);
    std::iota(parent.begin(), parent.end(), 0);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return leaves.boxes[a][0][0] < leaves.boxes[b][0][0]; });
    const auto root = [&](std::size_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    std::vector<std::size_t> open;
    for (const std::size_t i : order) {
        std::erase_if(open, [&](std::size_t j) { return leaves.boxes[j][1][0] < leaves.boxes[i][0][0]; });
        for (const std::size_t j : open) {
            if (!share_a_point(leaves.boxes[i], leaves.boxes[j])) continue;
            const std::size_t a = root(i), b = root(j);
            parent[std::max(a, b)] = std::min(a, b);
        }
        open.push_back(i);
    }
    std::vector<std::int64_t> clusters(count, 0);
    std::int64_t next = 0;
    for (std::size_t i = 0; i < count; ++i) clusters[i] = root(i) == i ? ++next : clusters[root(i)];
    return clusters;
}

/// The grid of a certificate: integer coordinates to places.
struct Grid {
    std::array<std::int64_t, 3> first, count, exponent;
    std::int64_t resolution;

    explicit Grid(const Json& json)
        : first(json.at("first")),
          count(json.at("count")),
          exponent(json.at("exponent")),
          resolution(json.at("resolution")) {
        if (resolution < 1 || resolution > 40) throw std::runtime_error("the resolution of its grid is not known");
    }
    std::int64_t side() const { return std::int64_t{1} << resolution; }
    double place(unsigned a, std::int64_t i) const {
        const double whole = std::ldexp(static_cast<double>(first[a]), static_cast<int>(resolution));
        return std::ldexp(whole + static_cast<double>(count[a]) * static_cast<double>(i),
                          static_cast<int>(exponent[a] - resolution));
    }
    Point3 place(const std::array<std::int64_t, 3>& p) const {
        return {place(0, p[0]), place(1, p[1]), place(2, p[2])};
    }
};

/// Sides of a leaf that are sides of a leaf of the same cluster too.
std::set<int> inner_sides(const GridBox& box, std::int64_t cluster, const std::map<GridBox, std::int64_t>& known) {
    std::set<int> sides;
    for (int side = 0; side < 6; ++side) {
        const auto axis = static_cast<unsigned>(side / 2);
        const std::int64_t size = box[1][axis] - box[0][axis], step = side % 2 != 0 ? size : -size;
        GridBox other = box;
        other[0][axis] += step;
        other[1][axis] += step;
        const auto found = known.find(other);
        if (found != known.end() && found->second == cluster) sides.insert(side);
    }
    return sides;
}

MeshDocument clusters_document(const std::vector<const Json*>& certificates) {
    const Grid outer(certificates.front()->at("grid"));
    const std::int64_t end = outer.side();
    BoxDocument document(outer.place({0, 0, 0}), outer.place({end, end, end}));
    std::int64_t before = 0;
    for (const Json* certificate : certificates) {
        const Grid grid(certificate->at("grid"));
        const auto& tree = certificate->at("octree").get_ref<const std::string&>();
        Leaves leaves;
        std::size_t at = 0;
        const std::int64_t side = grid.side();
        decode_cell(tree, at, {{{0, 0, 0}, {side, side, side}}}, leaves);
        const std::vector<std::int64_t> clusters = clusters_of(leaves);
        std::map<GridBox, std::int64_t> known;
        for (std::size_t i = 0; i < clusters.size(); ++i) known[leaves.boxes[i]] = clusters[i];
        for (std::size_t i = 0; i < clusters.size(); ++i)
            document.add_box(grid.place(leaves.boxes[i][0]), grid.place(leaves.boxes[i][1]),
                             inner_sides(leaves.boxes[i], clusters[i], known), before + clusters[i], leaves.signs[i]);
        if (!clusters.empty()) before += *std::max_element(clusters.begin(), clusters.end());
    }
    return document.finish("cluster", true);
}

Point3 point_of(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }

MeshDocument obstacles_document(const Json& report) {
    using Reason = ImplicitObstacle::Reason;
    BoxDocument document(point_of(report.at("box").at("low")), point_of(report.at("box").at("high")));
    for (const Json& obstacle : report.at("obstacles")) {
        const auto name = obstacle.at("reason").get<std::string>();
        std::int64_t reason = 0;
        for (int r = 0; r <= static_cast<int>(Reason::cancelled); ++r)
            if (name == name_of(static_cast<Reason>(r))) reason = r + 1;
        if (reason == 0) throw std::runtime_error("it names a reason that is not known: " + name);
        document.add_box(point_of(obstacle.at("low")), point_of(obstacle.at("high")), {}, reason, 0);
    }
    return document.finish("reason", false);
}

}  // namespace

bool holds_boxes(const std::string& path) { return path.size() > 5 && path.substr(path.size() - 5) == ".json"; }

MeshDocument read_boxes(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw IoError(path, 0, "cannot be read");
    try {
        const Json json = Json::parse(file);
        const std::string format = json.value("format", "");
        if (format == "certa implicit certificate") return clusters_document({&json});
        if (format == "certa implicit product") {
            std::vector<const Json*> factors;
            for (const Json& factor : json.at("factors")) factors.push_back(&factor);
            if (!factors.empty()) return clusters_document(factors);
        }
        if (json.value("command", "") == "implicit" && json.contains("obstacles")) return obstacles_document(json);
    } catch (const std::exception& error) {
        throw IoError(path, 0, std::string("is no certificate or report of `certa implicit`: ") + error.what());
    }
    throw IoError(
        path, 0,
        "is no certificate or report of `certa implicit`: of JSON, --certificate FILE and --json FILE of that "
        "command can be shown");
}

}  // namespace certa::cli
