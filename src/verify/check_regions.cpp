// Labelled: regions are exactly the connected components of the tetrahedra when constraint triangles are walls.
// A component that reaches the convex hull through no wall is connected to the outside and has region 0; every other
// one has a number of its own, in the order of their lowest vertices. Regions that a hole point lies in are left out.
//
// Left out means: a bounded component of the space that no tetrahedron fills. Each of these has exactly one outer
// boundary, which is a connected piece (a shell) of the boundary of the mesh, faces being joined across the unmeshed
// side of their common edges; its normals point out of the mesh, into the component, so its signed volume is negative,
// while the outer boundaries of pieces of the mesh have positive volume. So the shells of negative volume count the
// holes, and each must be the innermost one around some hole point.
//
// If the outside is kept, the boundary faces on the convex hull must form a closed chain: a closed chain in the
// boundary of the hull is a multiple of it, so that the hull is lined with tetrahedra everywhere.
#include <algorithm>
#include <map>
#include <numeric>

#include "verify/shells.h"
#include "verify/subject.h"

namespace certa::verify {
namespace {

/// Every hole point marks the innermost negative shell around it, if it lies in no tetrahedron: a point with as many
/// positive as negative windings.
std::vector<std::uint8_t> find_hollow(const Subject& subject, const Domain& domain, const std::vector<Shell>& shells) {
    std::vector<std::uint8_t> hollow(shells.size(), 0);
    for (const Point3& hole : subject.complex.region_holes) {
        int winding = 0;
        std::size_t innermost = shells.size();
        for (std::size_t i = 0; i < shells.size(); ++i) {
            const int w = winding_of(subject, domain, shells[i], hole);
            winding += w;
            if (w >= 0 || shells[i].sign >= 0) continue;
            if (innermost == shells.size() || is_smaller(subject, domain, shells[i], shells[innermost])) innermost = i;
        }
        if (winding == 0 && innermost < shells.size()) hollow[innermost] = 1;
    }
    return hollow;
}

/// Returns the number of regions that are left out.
std::size_t check_shells(const Subject& subject, const Domain& domain, Findings& findings) {
    const std::vector<Shell>& shells = domain.shells;
    const std::vector<std::uint8_t> hollow = find_hollow(subject, domain, shells);
    for (std::size_t s = 0; s < shells.size(); ++s) {
        const Point3 place = face_points(subject, domain.boundary[shells[s].faces[0]])[0];
        if (shells[s].sign < 0 && !hollow[s]) {
            findings.add(Promise::labelled, {tetrahedron_ref(domain.boundary[shells[s].faces[0]] / 4)}, place,
                         "a bounded region next to " + show("tetrahedron", domain.boundary[shells[s].faces[0]] / 4) +
                             " at " + show(place) + " is left out, but no hole point lies in it");
        }
    }
    return static_cast<std::size_t>(std::count(hollow.begin(), hollow.end(), 1));
}

/// The outside is kept as a whole or not at all.
void check_lining(const Subject& subject, const Domain& domain, Findings& findings) {
    struct Use {
        std::uint32_t a, b;
        int direction;
        HalfFace half;
    };
    std::vector<Use> uses;
    for (std::size_t i = 0; i < domain.boundary.size(); ++i) {
        if (!domain.on_hull[i]) continue;
        const auto f = outward_face(subject.mesh, domain.boundary[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = f[k], b = f[(k + 1) % 3];
            uses.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1, domain.boundary[i]});
        }
    }
    std::sort(uses.begin(), uses.end(), [](const Use& l, const Use& r) {
        return l.a != r.a ? l.a < r.a : l.b != r.b ? l.b < r.b : l.half < r.half;
    });
    for (std::size_t i = 0; i < uses.size();) {
        int sum = 0;
        const Use& first = uses[i];
        for (; i < uses.size() && uses[i].a == first.a && uses[i].b == first.b; ++i) sum += uses[i].direction;
        if (sum == 0) continue;
        findings.add(Promise::labelled, {tetrahedron_ref(first.half / 4)}, subject.at(first.a),
                     "the outside is kept elsewhere, but left out next to the edge of " +
                         show_vertices({first.a, first.b}) + " of " + show("tetrahedron", first.half / 4));
    }
}

/// Components of the tetrahedra with constraint triangles as walls.
struct Components {
    std::vector<std::uint32_t> of;  // per tetrahedron
    struct Component {
        std::uint32_t first = 0;          // tetrahedron
        std::uint32_t lowest = no_index;  // vertex
        bool outside = false;             // reaches the hull through no wall
        std::uint32_t region = 0;         // the label of the first tetrahedron
    };
    std::vector<Component> all;
};

Components collect_components(const Subject& subject) {
    const TetMesh& mesh = subject.mesh;
    Components result;
    result.of.assign(mesh.tetrahedra.size(), no_index);
    std::vector<std::uint32_t> stack;
    for (std::uint32_t start = 0; start < mesh.tetrahedra.size(); ++start) {
        if (result.of[start] != no_index) continue;
        const auto index = static_cast<std::uint32_t>(result.all.size());
        Components::Component c;
        c.first = start;
        c.region = index_of(mesh.tetrahedron_regions[start]);
        result.of[start] = index;
        stack.assign(1, start);
        while (!stack.empty()) {
            const std::uint32_t t = stack.back();
            stack.pop_back();
            for (const VertexId v : mesh.tetrahedra[t]) c.lowest = std::min(c.lowest, index_of(v));
            for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
                if (subject.walls[h]) continue;
                const HalfFace mate = subject.faces.mate(h);
                if (mate == no_index) {
                    c.outside = true;
                } else if (result.of[mate / 4] == no_index) {
                    result.of[mate / 4] = index;
                    stack.push_back(mate / 4);
                }
            }
        }
        result.all.push_back(c);
    }
    return result;
}

void check_labels(const Subject& subject, const Components& components, Findings& findings) {
    const TetMesh& mesh = subject.mesh;
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        const auto& c = components.all[components.of[t]];
        const std::uint32_t region = index_of(mesh.tetrahedron_regions[t]);
        if (region == c.region) continue;
        findings.add(
            Promise::labelled, {tetrahedron_ref(t), tetrahedron_ref(c.first)}, subject.at(mesh.tetrahedra[t][0]),
            show("tetrahedron", t) + " has region " + std::to_string(region) + ", but " + show("tetrahedron", c.first) +
                ", connected to it without crossing a facet, has region " + std::to_string(c.region));
    }
}

/// Region numbers of components; `removed` regions may have kept their numbers.
void check_numbers(const Subject& subject, const Components& components, std::size_t removed, Findings& findings) {
    std::map<std::uint32_t, const Components::Component*> by_region;
    for (const auto& c : components.all) {
        const Point3& place = subject.at(subject.mesh.tetrahedra[c.first][0]);
        const auto tell = [&](const std::string& message) {
            findings.add(Promise::labelled, {tetrahedron_ref(c.first)}, place,
                         "the region of " + show("tetrahedron", c.first) + message);
        };
        if (c.outside != (c.region == 0)) {
            tell(c.outside ? " is connected to the outside, but has number " + std::to_string(c.region)
                           : " is bounded by facets, but has number 0, the outside's");
        } else if (!c.outside) {
            const auto [known, fresh] = by_region.try_emplace(c.region, &c);
            if (!fresh) {
                tell(" has number " + std::to_string(c.region) + ", as has that of " +
                     show("tetrahedron", known->second->first) + ", but a facet separates them");
            }
        }
    }
    const Components::Component* previous = nullptr;
    for (const auto& [region, c] : by_region) {
        const auto tell = [&, number = region, c = c](const std::string& message) {  // clang 14 captures no bindings
            findings.add(Promise::labelled, {tetrahedron_ref(c->first)}, subject.at(c->lowest),
                         "region " + std::to_string(number) + message);
        };
        if (region > by_region.size() + removed) {
            tell(" has a number too high: there are " + std::to_string(by_region.size() + removed));
        }
        if (previous != nullptr && c->lowest < previous->lowest) {
            tell(" has " + show("vertex", c->lowest) + ", lower than all of region " +
                 std::to_string(previous->region) + ": regions are numbered by their lowest vertex");
        }
        previous = c;
    }
}

/// Tetrahedra around hole points: their regions had to be left out, unless that would leave a constraint triangle bare.
void check_holes(const Subject& subject, const Components& components, Findings& findings) {
    const TetMesh& mesh = subject.mesh;
    const auto& holes = subject.complex.region_holes;
    std::vector<std::uint32_t> order(holes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return holes[a].x != holes[b].x ? holes[a].x < holes[b].x : a < b;
    });
    struct Filled {
        std::uint32_t hole, tetrahedron;
    };
    std::vector<Filled> filled;
    std::vector<std::uint8_t> asked(components.all.size(), 0);  // to be left out
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        const auto at = [&](std::size_t i) -> const Point3& { return subject.at(mesh.tetrahedra[t][i]); };
        const Point3 low{std::min({at(0).x, at(1).x, at(2).x, at(3).x}), std::min({at(0).y, at(1).y, at(2).y, at(3).y}),
                         std::min({at(0).z, at(1).z, at(2).z, at(3).z})};
        const Point3 high{std::max({at(0).x, at(1).x, at(2).x, at(3).x}),
                          std::max({at(0).y, at(1).y, at(2).y, at(3).y}),
                          std::max({at(0).z, at(1).z, at(2).z, at(3).z})};
        for (auto i = std::lower_bound(order.begin(), order.end(), low.x,
                                       [&](std::uint32_t h, double x) { return holes[h].x < x; });
             i != order.end() && holes[*i].x <= high.x; ++i) {
            const Point3& p = holes[*i];
            bool inside = is_in_box(p, low, high);
            for (HalfFace h = 4 * t; h < 4 * t + 4 && inside; ++h) {
                const auto f = face_points(subject, h);
                const int side = orientation(f[0], f[1], f[2], p);
                // A hole point on a facet belongs to no region.
                inside = side < 0 || (side == 0 && !subject.walls[h]);
            }
            if (!inside || components.all[components.of[t]].outside) continue;
            filled.push_back({*i, t});
            asked[components.of[t]] = 1;
        }
    }
    if (filled.empty()) return;
    const auto stays = [&](HalfFace h) { return h != no_index && !asked[components.of[h / 4]]; };
    for (HalfFace h = 0; h < subject.walls.size(); ++h) {
        if (subject.walls[h] && !stays(h) && !stays(subject.faces.mate(h))) return;
    }
    for (const Filled& f : filled) {
        findings.add(Promise::labelled, {tetrahedron_ref(f.tetrahedron)}, holes[f.hole],
                     "hole point " + std::to_string(f.hole + 1) + " at " + show(holes[f.hole]) + " lies in " +
                         show("tetrahedron", f.tetrahedron) + ": its region had to be left out");
    }
}

}  // namespace

void check_regions(const Subject& subject, const Domain& domain, Findings& findings) {
    const std::size_t removed = domain.full_hull ? 0 : check_shells(subject, domain, findings);
    if (domain.keeps_outside && !domain.full_hull) check_lining(subject, domain, findings);
    if (!subject.tetrahedron_labels) {
        findings.add(Promise::labelled, {}, {}, "the tetrahedra carry no regions");
        return;
    }
    const Components components = collect_components(subject);
    check_labels(subject, components, findings);
    check_numbers(subject, components, removed, findings);
    check_holes(subject, components, findings);
}

}  // namespace certa::verify
