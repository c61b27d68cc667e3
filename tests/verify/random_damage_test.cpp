// Random damage to random valid meshes: what breaks a promise is reported, what does not is not.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "verify/grid_mesh.h"

namespace certa::test {
namespace {

enum class Effect { breaks, keeps, either };

/// Changes one thing; nothing to change counts as kept.
class Damage {
public:
    Damage(Case& c, std::uint64_t seed) : case_(c), mesh_(c.mesh), random_(seed) {}

    static constexpr int kinds = 20;
    Effect apply(int kind) {
        switch (kind) {
            case 0:
                return move_point();
            case 1:
                return replace_corner(mesh_.tetrahedra);
            case 2:
                return permute(mesh_.tetrahedra, true);
            case 3:
                return permute(mesh_.tetrahedra, false);
            case 4:
                return relabel_region();
            case 5:
                return replace_corner(mesh_.triangles);
            case 6:
                return permute(mesh_.triangles, true);
            case 7:
                return permute(mesh_.triangles, false);
            case 8:
                return relabel(mesh_.triangle_facets, mesh_.triangles.size());
            case 9:
                return replace_corner(mesh_.edges);
            case 10:
                return permute(mesh_.edges, false);
            case 11:
                return relabel(mesh_.edge_segments, mesh_.edges.size());
            case 12:
                return remove(mesh_.tetrahedra, mesh_.tetrahedron_regions);
            case 13:
                return remove(mesh_.triangles, mesh_.triangle_facets);
            case 14:
                return remove(mesh_.edges, mesh_.edge_segments);
            case 15:
                return repeat();
            case 16:
                return forget_hole();
            case 17:
                return remove_region();
            case 18:
                return add_vertex();
            default:
                return shuffle();
        }
    }

private:
    std::size_t pick(std::size_t count) { return static_cast<std::size_t>(random_.below(count)); }

    Effect move_point() {
        Point3& p = mesh_.positions[pick(mesh_.positions.size())];
        double& x = random_.coin() ? p.x : random_.coin() ? p.y : p.z;
        x = std::nextafter(x, random_.coin() ? 1e9 : -1e9);
        return Effect::breaks;
    }
    template <class Element>
    Effect replace_corner(std::vector<Element>& elements) {
        if (elements.empty()) return Effect::keeps;
        Element& e = elements[pick(elements.size())];
        VertexId& v = e[pick(e.size())];
        const VertexId other{static_cast<std::uint32_t>(pick(mesh_.positions.size()))};
        if (v == other) return Effect::keeps;
        v = other;
        return Effect::breaks;
    }
    template <class Element>
    Effect permute(std::vector<Element>& elements, bool even) {
        if (elements.empty()) return Effect::keeps;
        Element& e = elements[pick(elements.size())];
        if (even) {
            std::rotate(e.begin(), e.begin() + 1, e.begin() + 3);
            return Effect::keeps;
        }
        std::swap(e[0], e[1]);
        return Effect::breaks;
    }
    Effect relabel_region() {
        RegionId& r = mesh_.tetrahedron_regions[pick(mesh_.tetrahedra.size())];
        const RegionId other{static_cast<std::uint32_t>(random_.below(4))};
        if (r == other) return Effect::keeps;
        r = other;
        // Regions that are left out may have taken numbers: a region of one tetrahedron can then have another one.
        return case_.complex.region_holes.empty() ? Effect::breaks : Effect::either;
    }
    template <class Label>
    Effect relabel(std::vector<Label>& labels, std::size_t count) {
        if (labels.empty()) return Effect::keeps;
        Label& l = labels[pick(labels.size())];
        const Label other{static_cast<std::uint32_t>(random_.below(count + 1))};
        if (l == other) return Effect::keeps;
        l = other;
        return Effect::breaks;
    }
    template <class Element, class Label>
    Effect remove(std::vector<Element>& elements, std::vector<Label>& labels) {
        if (elements.empty()) return Effect::keeps;
        const auto i = static_cast<std::ptrdiff_t>(pick(elements.size()));
        // One tetrahedron between facets and the hull may have been all that was kept of the outside.
        Effect effect = Effect::breaks;
        if constexpr (std::is_same_v<Element, Tetrahedron>) {
            if (labels[static_cast<std::size_t>(i)] == Label{0}) effect = Effect::either;
        }
        elements.erase(elements.begin() + i);
        labels.erase(labels.begin() + i);
        // Without any edge they are looked up.
        if constexpr (std::is_same_v<Element, Edge>) return elements.empty() ? Effect::keeps : Effect::breaks;
        return effect;
    }
    Effect repeat() {
        const auto copy = [&](auto& elements, auto& labels) {
            if (elements.empty()) return Effect::keeps;
            const std::size_t i = pick(elements.size());
            elements.push_back(elements[i]);
            labels.push_back(labels[i]);
            return Effect::breaks;
        };
        switch (random_.below(3)) {
            case 0:
                return copy(mesh_.tetrahedra, mesh_.tetrahedron_regions);
            case 1:
                return copy(mesh_.triangles, mesh_.triangle_facets);
            default:
                return copy(mesh_.edges, mesh_.edge_segments);
        }
    }
    Effect forget_hole() {
        auto& holes = case_.complex.region_holes;
        if (holes.empty()) return Effect::keeps;
        holes.erase(holes.begin() + static_cast<std::ptrdiff_t>(pick(holes.size())));
        return Effect::breaks;
    }
    /// All tetrahedra of one bounded region.
    Effect remove_region() {
        const RegionId region = mesh_.tetrahedron_regions[pick(mesh_.tetrahedra.size())];
        if (region == RegionId{0}) return Effect::keeps;
        for (std::size_t i = mesh_.tetrahedra.size(); i-- > 0;) {
            if (mesh_.tetrahedron_regions[i] != region) continue;
            mesh_.tetrahedra.erase(mesh_.tetrahedra.begin() + static_cast<std::ptrdiff_t>(i));
            mesh_.tetrahedron_regions.erase(mesh_.tetrahedron_regions.begin() + static_cast<std::ptrdiff_t>(i));
        }
        return Effect::breaks;
    }
    Effect add_vertex() {
        mesh_.positions.push_back({random_.uniform(0, 4000), random_.uniform(0, 4000), random_.uniform(0, 4000)});
        mesh_.vertex_sources.push_back({random_.coin() ? VertexOrigin::segment : VertexOrigin::facet, 0});
        return Effect::breaks;
    }
    Effect shuffle() {
        const auto mix = [&](auto& elements, auto& labels) {
            for (std::size_t i = elements.size(); i > 1; --i) {
                const std::size_t k = pick(i);
                std::swap(elements[i - 1], elements[k]);
                std::swap(labels[i - 1], labels[k]);
            }
        };
        mix(mesh_.tetrahedra, mesh_.tetrahedron_regions);
        mix(mesh_.triangles, mesh_.triangle_facets);
        mix(mesh_.edges, mesh_.edge_segments);
        return Effect::keeps;
    }

    Case& case_;
    TetMesh& mesh_;
    core::Random random_;
};

TEST(CheckDamaged, random_damage_is_reported) {
    ASSERT_TRUE(rc::check([](std::uint64_t seed) {
        const Case valid = random_case(seed);
        for (int kind = 0; kind < Damage::kinds; ++kind) {
            Case c = valid;
            const Effect effect = Damage(c, seed + static_cast<std::uint64_t>(kind)).apply(kind);
            const ConformingCheck check = check_conforming(c.mesh, c.complex);
            if (effect == Effect::breaks && check.ok()) RC_FAIL("damage " + std::to_string(kind) + " was not reported");
            if (effect == Effect::keeps && !check.ok()) {
                RC_FAIL("harmless change " + std::to_string(kind) + " was reported:\n" + text(check));
            }
        }
    }));
}

TEST(CheckDamaged, same_report_for_any_number_of_threads) {
    Case c = random_case(3);
    for (RegionId& r : c.mesh.tetrahedron_regions) r = RegionId{index_of(r) + 5};
    std::swap(c.mesh.tetrahedra[0][0], c.mesh.tetrahedra[0][1]);
    RunControl one, two;
    one.threads = 1;
    two.threads = 2;
    EXPECT_EQ(text(check_conforming(c.mesh, c.complex, {}, one)), text(check_conforming(c.mesh, c.complex, {}, two)));
}

}  // namespace
}  // namespace certa::test
