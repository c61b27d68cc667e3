// Whole components of the input in place of those that came out wrong.
//
// Each component has a level: 0 as it came, 1 thinned out by the tolerance, 2 by a tenth of it, 3 as the input has it.
// Whatever is broken rises by one, both sides of a contact too; so this ends.
#include "remeshing/rescue.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/union_find.h"

namespace certa::remeshing {
namespace {

/// Of one component.
struct Shape {
    std::int64_t euler = 0;
    std::size_t pieces = 0, loops = 0;
    bool is_manifold = true;
    friend bool operator==(const Shape&, const Shape&) = default;
};

/// Per component, which polygons tell. Vertices belong to one component each.
std::vector<Shape> find_shapes(const CoarseMesh& mesh, const std::vector<Index>& components, std::size_t count) {
    std::vector<Shape> shapes(count);
    struct Side {
        Index low = 0, high = 0, polygon = 0;
        auto key() const { return std::array{low, high}; }
    };
    std::vector<Side> sides;
    std::vector<Index> owner(mesh.points.size(), no_index);
    for (Index q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        ++shapes[components[q]].euler;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i], b = ring[(i + 1) % ring.size()];
            if (owner[a] == no_index) ++shapes[components[q]].euler;
            owner[a] = components[q];
            sides.push_back({std::min(a, b), std::max(a, b), q});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key() < b.key(); });
    core::UnionFind pieces(mesh.polygon_count()), rims(mesh.points.size());
    std::vector<std::uint8_t> is_on_rim(mesh.points.size(), 0);
    for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
        for (end = i + 1; end < sides.size() && sides[end].key() == sides[i].key(); ++end)
            pieces.unite(sides[i].polygon, sides[end].polygon);
        Shape& shape = shapes[components[sides[i].polygon]];
        --shape.euler;
        shape.is_manifold = shape.is_manifold && end - i <= 2;
        if (end - i > 1) continue;
        rims.unite(sides[i].low, sides[i].high);
        is_on_rim[sides[i].low] = is_on_rim[sides[i].high] = 1;
    }
    for (Index q = 0; q < mesh.polygon_count(); ++q) shapes[components[q]].pieces += pieces.find(q) == q ? 1 : 0;
    for (Index v = 0; v < mesh.points.size(); ++v)
        if (is_on_rim[v] != 0 && rims.find(v) == v) ++shapes[owner[v]].loops;
    return shapes;
}

class Rescuer {
public:
    Rescuer(const Layout& layout, const Judge& judge, const RescueRule& rule, CoarseMesh& mesh,
            const RunControl& control)
        : layout_(layout),
          work_(layout.network.mesh()),
          judge_(judge),
          rule_(rule),
          mesh_(mesh),
          base_(mesh),
          control_(control),
          levels_(work_.component_count, 0) {
        for (std::size_t q = 0; q < mesh.polygon_count(); ++q) base_components_.push_back(component_of(q));
        components_ = base_components_;
        CoarseMesh input;
        input.points = work_.points;
        for (const auto& f : work_.faces) input.add_polygon(f);
        wanted_ = find_shapes(input, work_.components, work_.component_count);
    }

    std::size_t run() {
        bool is_doubtful = !rule_.left.empty();
        for (const Point3& p : rule_.left) levels_[work_.components[judge_.tree.find_nearest(p).triangle]] = 1;
        if (is_doubtful) assemble();
        while (!control_.cancelled() && raise(is_doubtful)) {
            assemble();
            is_doubtful = true;
        }
        return static_cast<std::size_t>(levels_.size()) -
               static_cast<std::size_t>(std::count(levels_.begin(), levels_.end(), 0));
    }

private:
    static constexpr std::array<double, 4> shares{0.0, 1.0, 0.1, 0.0};  ///< of the tolerance, per level

    Index component_of(std::size_t q) const {
        const Index f = base_.parent(q);
        if (f != no_index)
            return work_.components[triangle_beside(layout_.graph, layout_.network, layout_.faces[f].front())];
        return work_.components[base_.places[base_.polygon(q)[0]].face];
    }

    /// Whether there is anything to do.
    bool raise(bool is_doubtful) {
        std::vector<std::uint8_t> is_bad(levels_.size(), 0);
        if (is_doubtful) {
            const std::size_t before = mesh_.polygon_count();
            CoarseMesh cut = mesh_;
            const Damage damage = find_damage(judge_, cut, control_);
            if (cut.polygon_count() == before)
                for (const Index q : damage.polygons) is_bad[components_[q]] = 1;
            else if (!damage.polygons.empty())
                mark_by_corners(cut, damage.polygons, is_bad);
        }
        const std::vector<Shape> shapes = find_shapes(mesh_, components_, levels_.size());
        bool has_risen = false;
        for (Index c = 0; c < levels_.size(); ++c) {
            if ((is_bad[c] == 0 && shapes[c] == wanted_[c]) || levels_[c] == 3) continue;
            ++levels_[c];
            has_risen = true;
        }
        return has_risen;
    }
    /// Quads have been split: their numbers are others, the corners are not.
    void mark_by_corners(const CoarseMesh& cut, const std::vector<Index>& polygons,
                         std::vector<std::uint8_t>& is_bad) const {
        std::vector<Index> owner(mesh_.points.size(), no_index);
        for (std::size_t q = 0; q < mesh_.polygon_count(); ++q)
            for (const Index v : mesh_.polygon(q)) owner[v] = components_[q];
        for (const Index q : polygons) is_bad[owner[cut.polygon(q)[0]]] = 1;
    }

    void assemble() {
        mesh_ = base_.without_polygons();
        components_.clear();
        for (std::size_t q = 0; q < base_.polygon_count(); ++q) {
            if (levels_[base_components_[q]] != 0) continue;
            mesh_.add_polygon(base_.polygon(q), base_.parent(q));
            components_.push_back(base_components_[q]);
        }
        for (std::size_t level = 1; level < shares.size(); ++level) {
            std::vector<Index> triangles;
            for (Index f = 0; f < work_.face_count(); ++f)
                if (levels_[work_.components[f]] == level) triangles.push_back(f);
            if (!triangles.empty()) add(thin_part(work_, triangles, judge_, shares[level] * rule_.tolerance, control_));
        }
    }
    void add(const CoarseMesh& part) {
        const Index first = static_cast<Index>(mesh_.points.size());
        for (Index v = 0; v < part.points.size(); ++v)
            mesh_.add_vertex(part.points[v], part.places[v], part.kinds[v], part.curves[v]);
        std::vector<Index> ring;
        for (std::size_t q = 0; q < part.polygon_count(); ++q) {
            ring.clear();
            for (const Index v : part.polygon(q)) ring.push_back(first + v);
            mesh_.add_polygon(ring);
            components_.push_back(work_.components[part.places[part.polygon(q)[0]].face]);
        }
        for (const FeatureEdge& e : part.feature_edges)
            mesh_.feature_edges.push_back({first + e.a, first + e.b, e.curve});
    }

    const Layout& layout_;
    const WorkMesh& work_;
    const Judge& judge_;
    const RescueRule& rule_;
    CoarseMesh& mesh_;
    const CoarseMesh base_;
    const RunControl& control_;
    std::vector<std::uint8_t> levels_;
    std::vector<Index> base_components_, components_;  ///< per polygon
    std::vector<Shape> wanted_;
};

}  // namespace

std::size_t rescue_components(const Layout& layout, const Judge& judge, const RescueRule& rule, CoarseMesh& mesh,
                              const RunControl& control) {
    const std::size_t count = Rescuer(layout, judge, rule, mesh, control).run();
    if (count > 0) leave_out_unused(mesh);
    return count;
}

}  // namespace certa::remeshing
