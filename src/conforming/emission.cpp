// Constraint triangles become walls between the cells of the triangulation; what they separate are the regions.
// What is outside is left out, with what hole points name; but never so much that a constraint loses its last
// tetrahedron: a check must not pass on nothing.
#include "conforming/emission.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "conforming/validate_messages.h"
#include "core/assert.h"
#include "core/vector3.h"

namespace certa::conforming {
namespace {

using Corners = std::array<std::uint32_t, 3>;

Triangle to_triangle(const Corners& t) { return {VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}}; }

class Emitter {
public:
    Emitter(MeshState& mesh, const PiecewiseLinearComplex& input, ConformResult& result)
        : mesh_(mesh), input_(input), result_(result) {}

    void emit(const Recovery& recovery, bool keep_outside) {
        emit_vertices();
        emit_constraints(recovery);
        cells_ = mesh_.triangulation.collect_cells();
        kept_.assign(cells_.component_count, 1);
        choose_regions(keep_outside);
        label_seeds();
        emit_cells();
    }

    void emit_vertices() {
        TetMesh& out = result_.mesh;
        out.positions = mesh_.triangulation.positions();
        const auto inputs = static_cast<std::uint32_t>(mesh_.complex.points.size());
        for (std::uint32_t v = 0; v < inputs; ++v) out.vertex_sources.push_back({VertexOrigin::input, v});
        for (std::size_t i = 0; i < mesh_.owners.size(); ++i) {
            const Owner& owner = mesh_.owners[i];
            out.vertex_sources.push_back({owner.on_segment ? VertexOrigin::segment : VertexOrigin::facet, owner.index});
            (owner.on_segment ? result_.statistics.steiner_on_segments : result_.statistics.steiner_in_facets) += 1;
            const double d = displacement(owner, out.positions[inputs + i]);
            result_.statistics.max_displacement = std::max(result_.statistics.max_displacement, d);
        }
        for (const auto& [a, b] : mesh_.complex.segments) result_.segments.push_back({VertexId{a}, VertexId{b}});
    }

    void emit_pieces(bool present_only) {
        for (std::uint32_t s = 0; s < mesh_.complex.segments.size(); ++s) {
            for (std::uint32_t id = mesh_.first_pieces[s]; id != no_index; id = mesh_.pieces[id].next) {
                const Piece& piece = mesh_.pieces[id];
                // Sides of facets are sides of constraint triangles.
                const bool implied = !present_only && !mesh_.complex.segment_facets[s].empty();
                const bool present = implied || mesh_.triangulation.has_edge(piece.a, piece.b);
                CERTA_ASSERT(present || present_only);
                if (!present) continue;
                result_.mesh.edges.push_back({VertexId{piece.a}, VertexId{piece.b}});
                result_.mesh.edge_segments.push_back(SegmentId{s});
            }
        }
    }

    void emit_all_cells() {
        cells_ = mesh_.triangulation.collect_cells();
        kept_.assign(cells_.component_count, 1);
        emit_cells();
    }

private:
    MeshState& mesh_;
    const PiecewiseLinearComplex& input_;
    ConformResult& result_;
    delaunay::Delaunay3::Cells cells_;
    std::vector<std::uint8_t> kept_;  // per component

    double displacement(const Owner& owner, const Point3& p) const {
        const Complex& c = mesh_.complex;
        if (!owner.on_segment) {
            const Frame& frame = c.frames[owner.index];
            return std::abs(dot(p - frame.origin, frame.normal));
        }
        const auto& [a, b] = c.segments[owner.index];
        const Point3 direction = c.points[b] - c.points[a];
        return norm(cross(p - c.points[a], direction)) / norm(direction);
    }

    void emit_constraints(const Recovery& recovery) {
        std::vector<std::uint32_t> counts = mesh_.triangulation.count_marks(mesh_.complex.frames.size());
        std::vector<Corners> triangles;
        for (std::uint32_t f = 0; f < mesh_.complex.frames.size(); ++f) {
            if (mesh_.complex.facet_sides[f].empty()) continue;
            recovery.collect_triangles(f, triangles);
            CERTA_ASSERT(!triangles.empty());
            for (const Corners& t : triangles) {
                result_.mesh.triangles.push_back(to_triangle(t));
                result_.mesh.triangle_facets.push_back(FacetId{f});
            }
            counts[f] -= static_cast<std::uint32_t>(triangles.size());
        }
        // Marks are those of the triangles, unless facets share some: a face has one mark.
        if (std::any_of(counts.begin(), counts.end(), [](std::uint32_t n) { return n != 0; })) mark_anew();
        emit_pieces(false);
    }

    void mark_anew() {
        mesh_.triangulation.clear_marks();
        for (std::size_t i = 0; i < result_.mesh.triangles.size(); ++i) {
            const Triangle& t = result_.mesh.triangles[i];
            CERTA_ASSERT(mesh_.mark(index_of(result_.mesh.triangle_facets[i]),
                                    {index_of(t[0]), index_of(t[1]), index_of(t[2])}));
        }
    }

    bool is_kept(std::uint32_t component) const { return component != no_index && kept_[component] != 0; }

    /// Whether all constraints have a tetrahedron; collects the components beside those that have none.
    bool all_covered(std::vector<std::uint32_t>& beside_bare) const {
        beside_bare.clear();
        for (const auto& wall : cells_.walls) {
            if (is_kept(wall[0]) || is_kept(wall[1])) continue;
            std::copy_if(wall.begin(), wall.end(), std::back_inserter(beside_bare),
                         [](std::uint32_t c) { return c != no_index; });
        }
        std::vector<std::uint32_t> around;
        for (std::size_t e = 0; e < result_.mesh.edges.size(); ++e) {
            if (!mesh_.complex.segment_facets[index_of(result_.mesh.edge_segments[e])].empty()) continue;
            const Edge& edge = result_.mesh.edges[e];
            mesh_.triangulation.components_around(index_of(edge[0]), index_of(edge[1]), around);
            if (std::any_of(around.begin(), around.end(), [&](std::uint32_t c) { return kept_[c] != 0; })) continue;
            beside_bare.insert(beside_bare.end(), around.begin(), around.end());
        }
        return beside_bare.empty();
    }

    void warn(const std::string& message) { result_.warnings.push_back({DefectKind::open_facet, {}, {}, message}); }

    /// Where the facets are open: most often a hole that nobody meant. Empty where every side is shared.
    std::string name_rim() const {
        const Complex& complex = mesh_.complex;
        std::size_t count = 0, first = 0;
        for (std::size_t s = 0; s < complex.segments.size(); ++s) {
            if (complex.segment_facets[s].size() != 1) continue;
            if (count++ == 0) first = s;
        }
        if (count == 0) return {};
        const auto [a, b] = complex.segments[first];
        return "; " + std::to_string(count) + (count == 1 ? " segment belongs" : " segments belong") +
               " to one facet only, first that from vertex " + std::to_string(a + 1) + " to vertex " +
               std::to_string(b + 1) + " at " + name_place(complex.points[a]);
    }

    void choose_regions(bool keep_outside) {
        std::vector<std::uint32_t> bare;
        if (!keep_outside) kept_[0] = 0;
        for (const Point3& place : input_.region_holes) {
            const std::uint32_t component = mesh_.triangulation.locate_component(place);
            if (component == 0) {
                warn("hole point " + name_place(place) + " lies outside: it removes nothing");
            } else if (component != no_index) {
                kept_[component] = 0;
            }
        }
        if (std::none_of(kept_.begin(), kept_.end(), [](std::uint8_t k) { return k != 0; })) {
            kept_[0] = 1;
            if (!keep_outside) {
                warn(
                    "the facets enclose no region that may be kept: region 0, the outside, is part of the mesh up to "
                    "the convex hull" +
                    name_rim());
            }
        }
        if (!all_covered(bare) && kept_[0] == 0) {
            kept_[0] = 1;
            warn(
                "some facets or segments touch no enclosed region: region 0, the outside, is part of the mesh up to "
                "the convex hull");
        }
        if (all_covered(bare)) return;
        for (const std::uint32_t component : bare) {
            if (kept_[component] != 0) continue;
            kept_[component] = 1;
            warn(
                "a region with a hole point is kept, because facets or segments touch nothing else: remove these or "
                "the hole point");
        }
    }

    void label_seeds() {
        result_.region_attributes.assign(cells_.component_count, 0.0);
        std::map<std::uint32_t, std::size_t> seed_of;
        std::vector<Defect> conflicts;
        for (std::size_t i = 0; i < input_.region_seeds.size(); ++i) {
            const RegionSeed& seed = input_.region_seeds[i];
            const std::uint32_t component = mesh_.triangulation.locate_component(seed.place);
            if (component == no_index) continue;  // validation reports seeds on facets
            const auto [known, fresh] = seed_of.emplace(component, i);
            if (!fresh && input_.region_seeds[known->second].attribute != seed.attribute) {
                conflicts.push_back(
                    {DefectKind::conflicting_region_seeds,
                     {},
                     seed.place,
                     "region seeds " + std::to_string(known->second + 1) + " and " + std::to_string(i + 1) +
                         " lie in one region, the latter " + name_place(seed.place) +
                         ", and want different attributes: remove one of them, or close the gap between "
                         "their regions"});
            }
            result_.region_attributes[component] = seed.attribute;
        }
        if (!conflicts.empty()) throw InputError(std::move(conflicts));
    }

    void emit_cells() {
        TetMesh& out = result_.mesh;
        for (std::size_t i = 0; i < cells_.vertices.size(); ++i) {
            if (kept_[cells_.components[i]] == 0) continue;
            const auto& v = cells_.vertices[i];
            out.tetrahedra.push_back({VertexId{v[0]}, VertexId{v[1]}, VertexId{v[2]}, VertexId{v[3]}});
            out.tetrahedron_regions.push_back(RegionId{cells_.components[i]});
        }
    }
};

}  // namespace

void emit_mesh(MeshState& mesh, const Recovery& recovery, const PiecewiseLinearComplex& input,
               const ConformOptions& options, ConformResult& result) {
    Emitter(mesh, input, result).emit(recovery, options.keep_outside);
}

void emit_partial(MeshState& mesh, const Recovery& recovery, ConformResult& result) {
    const PiecewiseLinearComplex nothing;
    Emitter emitter(mesh, nothing, result);
    emitter.emit_vertices();
    std::vector<Corners> triangles;
    for (std::uint32_t f = 0; f < mesh.complex.frames.size(); ++f) {
        recovery.collect_triangles(f, triangles);
        for (const Corners& t : triangles) {
            if (!mesh.triangulation.has_face(t[0], t[1], t[2])) continue;
            result.mesh.triangles.push_back(to_triangle(t));
            result.mesh.triangle_facets.push_back(FacetId{f});
        }
    }
    emitter.emit_pieces(true);
    emitter.emit_all_cells();
}

}  // namespace certa::conforming
