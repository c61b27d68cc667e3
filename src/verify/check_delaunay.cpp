// Delaunay and Gabriel, exactly.
// Where the tetrahedra are proved to fill the convex hull face to face with every vertex used (check_domain), the
// Delaunay lemma needs one test per inner face: a triangulation of a convex domain in which no vertex lies strictly
// inside the circumsphere of the tetrahedron across a face of its own is Delaunay, because the lifting to the
// paraboloid is then convex across every face, hence convex.
//
// Where they are proved to overlap nowhere (check_embedding), with every vertex used, one test more is needed per
// boundary face: no vertex may lie in the circumball of its tetrahedron beyond the face. For suppose that a vertex v
// lies inside the circumball of t. Walk from a point inside t straight to v. From tetrahedron to tetrahedron v stays
// inside the circumballs, as the next ball contains all of the last one beyond the face between them. The walk cannot
// end in a tetrahedron: v is no corner of it, being inside its ball, and lies in no other. So it leaves through a
// boundary face, with v beyond it and inside the ball.
//
// Elsewhere local tests prove nothing: every circumball is searched among all vertices.
//
// That search also proves that the tetrahedra do not overlap. Two tetrahedra with empty open circumballs and different
// circumspheres lie on different sides of the spheres' radical plane: at a vertex of the first its own power is 0 and
// that of the second at least 0, and vice versa. Only tetrahedra on one common sphere can still overlap. Where
// tetrahedra overlap, the set of points covered twice ends at the boundary of the chain of all tetrahedra (inner faces
// change nothing: as many tetrahedra begin as end there), so some tetrahedron with a boundary face overlaps another one
// on its own sphere. Hence it is enough to test those with boundary faces and more than four vertices on their sphere
// against all tetrahedra on that sphere.
#include <algorithm>

#include "verify/parallel.h"
#include "verify/subject.h"

namespace certa::verify {
namespace {

void add_encroachment(const Subject& subject, std::uint32_t tetrahedron, std::uint32_t vertex, Findings& findings) {
    const Tetrahedron& t = subject.mesh.tetrahedra[tetrahedron];
    findings.add(Promise::delaunay, {tetrahedron_ref(tetrahedron), vertex_ref(vertex)}, subject.at(vertex),
                 show("vertex", vertex) + " at " + show(subject.at(vertex)) +
                     " is strictly inside the circumsphere of " + show("tetrahedron", tetrahedron) + " of " +
                     show_vertices({index_of(t[0]), index_of(t[1]), index_of(t[2]), index_of(t[3])}));
}

/// The part of a ball beyond a plane.
struct Cap {
    QuadricRegion ball, beyond;

    int side(const Point3& p) const {
        const int past = beyond.side(p);
        return past > 0 ? std::min(past, ball.side(p)) : past;
    }
    bool misses_box(const Point3& low, const Point3& high, bool closed) const {
        return beyond.misses_box(low, high, closed) || ball.misses_box(low, high, closed);
    }
};

void check_caps(const Subject& subject, const Domain& domain, Findings& findings) {
    for_each_item(domain.boundary.size(), subject.control, findings, [&](std::size_t i, Findings& found) {
        if (domain.on_hull[i]) return;
        const HalfFace h = domain.boundary[i];
        const auto f = outward_face(subject.mesh, h);
        const Point3 &a = subject.at(f[0]), &b = subject.at(f[1]), &c = subject.at(f[2]);
        const Point3& apex = subject.at(apex_of(subject.mesh, h));
        const std::array<std::uint32_t, 4> corners{f[0], f[1], f[2], apex_of(subject.mesh, h)};
        subject.tree.visit(Cap{QuadricRegion::circumball(a, c, b, apex), QuadricRegion::beyond(a, b, c)}, corners,
                           false, [&](std::uint32_t vertex, int) {
                               add_encroachment(subject, h / 4, vertex, found);
                               return false;
                           });
    });
}

void check_locally(const Subject& subject, Findings& findings) {
    const TetMesh& mesh = subject.mesh;
    for_each_item(mesh.tetrahedra.size(), subject.control, findings, [&](std::size_t i, Findings& found) {
        const auto index = static_cast<std::uint32_t>(i);
        const Tetrahedron& t = mesh.tetrahedra[i];
        const QuadricRegion ball =
            QuadricRegion::circumball(subject.at(t[0]), subject.at(t[1]), subject.at(t[2]), subject.at(t[3]));
        for (HalfFace h = 4 * index; h < 4 * index + 4; ++h) {
            const HalfFace mate = subject.faces.mate(h);
            if (mate == no_index || mate < h) continue;
            const std::uint32_t apex = apex_of(mesh, mate);
            if (ball.side(subject.at(apex)) > 0) add_encroachment(subject, index, apex, found);
        }
    });
}

/// Whether the plane through p spanned by two arrows has all of `first` on one side and all of `second` on the other.
bool plane_separates(const Subject& subject, const Point3& p, const Arrow& u, const Arrow& v, const Tetrahedron& first,
                     const Tetrahedron& second) {
    bool first_below = true, first_above = true, second_below = true, second_above = true, flat = true;
    const auto side = [&](VertexId w) { return determinant_sign(u, v, {&p, &subject.at(w)}); };
    for (const VertexId w : first) {
        const int s = side(w);
        first_below = first_below && s <= 0;
        first_above = first_above && s >= 0;
        flat = flat && s == 0;
    }
    // A plane that holds all of a tetrahedron is none: the arrows are parallel.
    if (flat || (!first_below && !first_above)) return false;
    for (const VertexId w : second) {
        const int s = side(w);
        second_below = second_below && s <= 0;
        second_above = second_above && s >= 0;
    }
    return (first_below && second_above) || (first_above && second_below);
}

/// Separating axis test: faces of one, faces of the other, pairs of edges.
bool are_disjoint(const Subject& subject, const Tetrahedron& a, const Tetrahedron& b) {
    const auto face_separates = [&](const Tetrahedron& first, const Tetrahedron& second) {
        for (const auto& c : outward_corners) {
            const Point3& p = subject.at(first[static_cast<std::size_t>(c[0])]);
            const Point3& q = subject.at(first[static_cast<std::size_t>(c[1])]);
            const Point3& r = subject.at(first[static_cast<std::size_t>(c[2])]);
            if (plane_separates(subject, p, {&p, &q}, {&p, &r}, first, second)) return true;
        }
        return false;
    };
    if (face_separates(a, b) || face_separates(b, a)) return true;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) {
            for (std::size_t k = 0; k < 4; ++k) {
                for (std::size_t l = k + 1; l < 4; ++l) {
                    const Arrow u{&subject.at(a[i]), &subject.at(a[j])}, v{&subject.at(b[k]), &subject.at(b[l])};
                    if (plane_separates(subject, *u.from, u, v, a, b)) return true;
                }
            }
        }
    }
    return false;
}

/// Tetrahedra by their lowest corner.
struct TetrahedraByCorner {
    std::vector<std::uint32_t> offsets, tetrahedra;

    explicit TetrahedraByCorner(const TetMesh& mesh) : offsets(mesh.positions.size() + 1, 0) {
        const auto lowest = [](const Tetrahedron& t) { return index_of(*std::min_element(t.begin(), t.end())); };
        for (const Tetrahedron& t : mesh.tetrahedra) ++offsets[lowest(t) + 1];
        for (std::size_t v = 1; v < offsets.size(); ++v) offsets[v] += offsets[v - 1];
        tetrahedra.resize(mesh.tetrahedra.size());
        std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
        for (std::uint32_t i = 0; i < mesh.tetrahedra.size(); ++i) tetrahedra[next[lowest(mesh.tetrahedra[i])]++] = i;
    }
};

/// Tests a tetrahedron against all others on its sphere; `sphere` lists the sphere's vertices, ascending.
void check_overlaps(const Subject& subject, std::uint32_t index, const std::vector<std::uint32_t>& sphere,
                    const TetrahedraByCorner& by_corner, Findings& findings) {
    const TetMesh& mesh = subject.mesh;
    const Tetrahedron& t = mesh.tetrahedra[index];
    for (const std::uint32_t v : sphere) {
        for (std::uint32_t i = by_corner.offsets[v]; i < by_corner.offsets[v + 1]; ++i) {
            const std::uint32_t other = by_corner.tetrahedra[i];
            const Tetrahedron& o = mesh.tetrahedra[other];
            const bool on_sphere = std::all_of(o.begin(), o.end(), [&](VertexId w) {
                return std::binary_search(sphere.begin(), sphere.end(), index_of(w));
            });
            if (other == index || !on_sphere || !subject.positive[other] || are_disjoint(subject, t, o)) continue;
            findings.add(Promise::well_formed, {tetrahedron_ref(index), tetrahedron_ref(other)}, subject.at(t[0]),
                         "tetrahedra " + std::to_string(index + 1) + " and " + std::to_string(other + 1) +
                             ", on one circumsphere, overlap");
        }
    }
}

void check_everywhere(const Subject& subject, Findings& findings) {
    const TetMesh& mesh = subject.mesh;
    const TetrahedraByCorner by_corner(mesh);
    for_each_item(mesh.tetrahedra.size(), subject.control, findings, [&](std::size_t i, Findings& found) {
        if (!subject.positive[i]) return;
        const auto index = static_cast<std::uint32_t>(i);
        const Tetrahedron& t = mesh.tetrahedra[i];
        const std::array<std::uint32_t, 4> corners{index_of(t[0]), index_of(t[1]), index_of(t[2]), index_of(t[3])};
        bool on_boundary = false;
        for (HalfFace h = 4 * index; h < 4 * index + 4; ++h) {
            on_boundary = on_boundary || subject.faces.mate(h) == no_index;
        }
        std::vector<std::uint32_t> sphere;
        bool empty = true;
        subject.tree.visit(
            QuadricRegion::circumball(subject.at(t[0]), subject.at(t[1]), subject.at(t[2]), subject.at(t[3])), corners,
            on_boundary, [&](std::uint32_t vertex, int side) {
                if (side == 0) {
                    sphere.push_back(vertex);
                    return true;
                }
                add_encroachment(subject, index, vertex, found);
                return empty = false;
            });
        if (!empty || sphere.empty()) return;
        sphere.insert(sphere.end(), corners.begin(), corners.end());
        std::sort(sphere.begin(), sphere.end());
        check_overlaps(subject, index, sphere, by_corner, found);
    });
}

}  // namespace

void check_delaunay(const Subject& subject, const Domain& domain, Findings& findings) {
    if (domain.embedded) {
        check_locally(subject, findings);
        if (!domain.full_hull) check_caps(subject, domain, findings);
    } else {
        check_everywhere(subject, findings);
    }
}

void check_gabriel(const Subject& subject, Findings& findings) {
    const TetMesh& mesh = subject.mesh;
    for_each_item(mesh.triangles.size(), subject.control, findings, [&](std::size_t i, Findings& found) {
        const auto index = static_cast<std::uint32_t>(i);
        const Triangle& t = mesh.triangles[i];
        const std::array<std::uint32_t, 3> corners{index_of(t[0]), index_of(t[1]), index_of(t[2])};
        subject.tree.visit(QuadricRegion::diametral_ball(subject.at(t[0]), subject.at(t[1]), subject.at(t[2])), corners,
                           false, [&](std::uint32_t vertex, int) {
                               found.add(Promise::gabriel, {triangle_ref(index), vertex_ref(vertex)},
                                         subject.at(vertex),
                                         show("vertex", vertex) + " at " + show(subject.at(vertex)) +
                                             " is strictly inside the diametral ball of " + show("triangle", index) +
                                             " of " + show_vertices({corners[0], corners[1], corners[2]}));
                               return false;
                           });
    });
}

}  // namespace certa::verify
