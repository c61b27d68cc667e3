// Do the tetrahedra fill the convex hull, or the kept regions, exactly once?
//
// Let K be positive tetrahedra whose faces are matched: shared by two from opposite sides, or by one (the boundary of
// K). Let n(x) be the number of tetrahedra around a point x on no face. As all are positive, n(x) is the winding number
// around x of the boundary chain of K: it changes at boundary faces only, by one, rising inwards.
//
// Full hull. If no vertex (used or not) lies beyond the plane of any boundary face, then every boundary face lies in
// the boundary of H, the convex hull of all vertices: a face plane supports H. So n is one constant c in the interior
// of H and 0 outside, and c >= 1. The lexicographically lowest vertex v is extreme in H, so only tetrahedra with corner
// v contain points near v; a direction from v into the middle of one of them must lie in no other: then c = 1. The
// tetrahedra fill H exactly once and meet face to face, for a vertex w in another tetrahedron or inside a face or edge
// would put that element's neighbourhood and the star of w (which is closed up to the boundary of H) on top of each
// other, n >= 2. Planes are tested once per cluster of exactly coplanar neighbours, and not at all next to a reflex
// edge.
//
// Otherwise overlaps are excluded by the boundary (check_embedding) or, where that is not embedded, by the search for
// circumballs (check_delaunay), n is 0 or 1, and what is left to show
// is that K ends where it may: each boundary face is a constraint triangle or has no vertex beyond its plane (here),
// and the bounded components of the rest of space are regions that a hole point lies in (check_regions).
#include <algorithm>

#include "core/union_find.h"
#include "verify/parallel.h"
#include "verify/shells.h"

namespace certa::verify {
namespace {

/// An edge of a boundary face: the face runs from a to b if `forward`, else from b to a; a < b.
struct BoundaryEdge {
    std::uint32_t a, b;
    std::uint32_t face;  // position in Domain::boundary
    std::uint32_t apex;  // third vertex of the face
    bool forward;
};

std::vector<BoundaryEdge> collect_edges(const Subject& subject, const Domain& domain) {
    std::vector<BoundaryEdge> edges;
    edges.reserve(3 * domain.boundary.size());
    for (std::uint32_t i = 0; i < domain.boundary.size(); ++i) {
        const auto f = outward_face(subject.mesh, domain.boundary[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = f[k], b = f[(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), i, f[(k + 2) % 3], a < b});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const BoundaryEdge& l, const BoundaryEdge& r) {
        return l.a != r.a ? l.a < r.a : l.b != r.b ? l.b < r.b : l.face < r.face;
    });
    return edges;
}

/// Sorts the faces around an edge counter-clockwise about the direction from a to b, starting with the first.
void sort_around(const Subject& subject, std::vector<BoundaryEdge>& fan) {
    const Point3 &a = subject.at(fan[0].a), &b = subject.at(fan[0].b), &reference = subject.at(fan[0].apex);
    // Half-planes of distinct faces are distinct unless tetrahedra overlap, so "same plane" means half a turn.
    const auto half = [&](const BoundaryEdge& e) {
        if (e.face == fan[0].face) return 0;
        const int side = orientation(a, b, reference, subject.at(e.apex));
        return side > 0 ? 1 : side == 0 ? 2 : 3;
    };
    std::vector<std::pair<int, BoundaryEdge>> sorted;
    for (const BoundaryEdge& e : fan) sorted.emplace_back(half(e), e);
    std::stable_sort(sorted.begin(), sorted.end(), [&](const auto& l, const auto& r) {
        if (l.first != r.first) return l.first < r.first;
        return orientation(a, b, subject.at(l.second.apex), subject.at(r.second.apex)) > 0;
    });
    for (std::size_t i = 0; i < fan.size(); ++i) fan[i] = sorted[i].second;
}

/// A boundary face running from a to b has the unmeshed side counter-clockwise of it; it ends at the next face, which
/// must run from b to a.
void join_fan(const Subject& subject, std::vector<BoundaryEdge>& fan, Domain& domain, Findings& findings) {
    if (fan.size() > 2) sort_around(subject, fan);
    bool alternates = fan.size() % 2 == 0;
    for (std::size_t i = 0; i < fan.size() && alternates; ++i) {
        const BoundaryEdge &e = fan[i], &next = fan[(i + 1) % fan.size()];
        alternates = e.forward != next.forward;
        if (e.forward && alternates) domain.joints.push_back({e.face, next.face});
    }
    if (alternates) return;
    findings.add(Promise::well_formed, {vertex_ref(fan[0].a), vertex_ref(fan[0].b)}, subject.at(fan[0].a),
                 "the tetrahedra around the edge of " + show_vertices({fan[0].a, fan[0].b}) + " overlap");
}

void join_boundary(const Subject& subject, Domain& domain, Findings& findings) {
    const std::vector<BoundaryEdge> edges = collect_edges(subject, domain);
    std::vector<BoundaryEdge> fan;
    for (std::size_t begin = 0; begin < edges.size();) {
        std::size_t end = begin;
        while (end < edges.size() && edges[end].a == edges[begin].a && edges[end].b == edges[begin].b) ++end;
        fan.assign(edges.begin() + static_cast<std::ptrdiff_t>(begin),
                   edges.begin() + static_cast<std::ptrdiff_t>(end));
        join_fan(subject, fan, domain, findings);
        begin = end;
    }
}

/// The vertex of `face` that is not one of `other`'s; they share an edge.
std::uint32_t far_corner(const std::array<std::uint32_t, 3>& face, const std::array<std::uint32_t, 3>& other) {
    for (const std::uint32_t v : face) {
        if (std::find(other.begin(), other.end(), v) == other.end()) return v;
    }
    return face[0];
}

/// Fills on_hull.
void find_hull(const Subject& subject, Domain& domain) {
    const std::size_t count = domain.boundary.size();
    core::UnionFind clusters(count);
    domain.on_hull.assign(count, 1);
    for (const auto& [i, k] : domain.joints) {
        const auto f = outward_face(subject.mesh, domain.boundary[i]),
                   g = outward_face(subject.mesh, domain.boundary[k]);
        const int side =
            orientation(subject.at(f[0]), subject.at(f[1]), subject.at(f[2]), subject.at(far_corner(g, f)));
        if (side > 0) domain.on_hull[i] = domain.on_hull[k] = 0;
        if (side == 0) clusters.unite(i, k);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        if (!domain.on_hull[i]) domain.on_hull[clusters.find(i)] = 0;
    }
    Findings none;
    for_each_item(count, subject.control, none, [&](std::size_t i, Findings&) {
        if (!clusters.is_leader(static_cast<std::uint32_t>(i)) || !domain.on_hull[i]) return;
        const auto f = outward_face(subject.mesh, domain.boundary[i]);
        subject.tree.visit(QuadricRegion::beyond(subject.at(f[0]), subject.at(f[1]), subject.at(f[2])), f, false,
                           [&](std::uint32_t, int) { return (domain.on_hull[i] = 0) != 0; });
    });
    for (std::uint32_t i = 0; i < count; ++i) domain.on_hull[i] = domain.on_hull[clusters.find(i)];
}

/// Whether the direction from v to the middle of the face of t opposite to v lies in the cone of `other` at v, or on
/// it.
bool cone_contains(const Subject& subject, std::uint32_t v, const Tetrahedron& t, const Tetrahedron& other) {
    const auto opposite = [&](const Tetrahedron& s) {
        const auto i = static_cast<std::size_t>(std::find(s.begin(), s.end(), VertexId{v}) - s.begin());
        const auto& c = outward_corners[i];
        return std::array<const Point3*, 3>{&subject.at(s[static_cast<std::size_t>(c[0])]),
                                            &subject.at(s[static_cast<std::size_t>(c[1])]),
                                            &subject.at(s[static_cast<std::size_t>(c[2])])};
    };
    const auto middle = opposite(t), cone = opposite(other);
    // (p, q, r) is counter-clockwise seen from outside, that is from the far side of v, so det(p - v, q - v, r - v) >
    // 0.
    for (std::size_t k = 0; k < 3; ++k) {
        if (middle_side(subject.at(v), *cone[k], *cone[(k + 1) % 3], *middle[0], *middle[1], *middle[2]) < 0)
            return false;
    }
    return true;
}

/// c = 1? See the head of this file.
bool covers_once(const Subject& subject, Findings& findings) {
    const auto& positions = subject.mesh.positions;
    const auto is_lower = [](const Point3& a, const Point3& b) {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    };
    std::uint32_t lowest = no_index;
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        if (subject.used[v] && (lowest == no_index || is_lower(positions[v], positions[lowest]))) lowest = v;
    }
    std::uint32_t first = no_index;
    bool once = true;
    for (std::uint32_t i = 0; i < subject.mesh.tetrahedra.size(); ++i) {
        const Tetrahedron& t = subject.mesh.tetrahedra[i];
        if (std::find(t.begin(), t.end(), VertexId{lowest}) == t.end()) continue;
        if (first == no_index) {
            first = i;
        } else if (cone_contains(subject, lowest, subject.mesh.tetrahedra[first], t)) {
            findings.add(Promise::well_formed, {tetrahedron_ref(first), tetrahedron_ref(i)}, positions[lowest],
                         "tetrahedra " + std::to_string(first + 1) + " and " + std::to_string(i + 1) + " overlap at " +
                             show("vertex", lowest) + ": the convex hull is filled more than once");
            once = false;
        }
    }
    return once && first != no_index;
}

void check_ends(const Subject& subject, Domain& domain, Findings& findings) {
    for (std::size_t i = 0; i < domain.boundary.size(); ++i) {
        const HalfFace h = domain.boundary[i];
        if (subject.walls[h]) continue;
        domain.keeps_outside = true;
        if (domain.on_hull[i] || subject.faces.is_crowded(h)) continue;
        const auto f = outward_face(subject.mesh, h);
        findings.add(Promise::well_formed, {tetrahedron_ref(h / 4)}, subject.at(f[0]),
                     "the mesh ends at the face of " + show_vertices({f[0], f[1], f[2]}) + " of " +
                         show("tetrahedron", h / 4) +
                         ", which is neither a constraint triangle nor on the convex hull: a tetrahedron is missing");
    }
}

}  // namespace

Domain check_domain(const Subject& subject, Findings& findings) {
    Domain domain;
    for (HalfFace h = 0; h < subject.faces.half_face_count(); ++h) {
        if (subject.faces.mate(h) == no_index) domain.boundary.push_back(h);
    }
    domain.matched = findings.count(Promise::well_formed) == 0;
    join_boundary(subject, domain, findings);
    find_hull(subject, domain);
    check_ends(subject, domain, findings);
    bool all_used = true;
    for (std::size_t v = 0; v < subject.used.size(); ++v) all_used = all_used && (subject.used[v] || subject.spare[v]);
    const bool all_on_hull = std::find(domain.on_hull.begin(), domain.on_hull.end(), 0) == domain.on_hull.end();
    const bool usable = domain.matched && findings.count(Promise::well_formed) == 0 && all_used;
    domain.full_hull = usable && all_on_hull && covers_once(subject, findings);
    if (!domain.full_hull) domain.shells = collect_shells(subject, domain);
    domain.embedded = domain.full_hull || (usable && !all_on_hull && is_embedded(subject, domain));
    return domain;
}

}  // namespace certa::verify
