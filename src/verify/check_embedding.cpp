// Do the tetrahedra overlap nowhere, although they do not fill a convex hull?
//
// Let n(x) be the number of tetrahedra around x, as in check_domain.cpp: it changes at boundary faces only, by one,
// rising inwards. Suppose that the boundary faces meet in common edges and corners only (decided exactly, pair by
// pair). Then a component K of the unmeshed side is bounded by shells whose faces are neighbours across the sectors of
// K at their edges, so n is one constant just outside all of a shell S. The part of S itself in it is 0 where S
// encloses a positive volume and -1 where it encloses a negative one: the winding number of S takes two values only,
// which differ by one, and one of them is 0, far away. The part of another shell S' is its winding number around any
// vertex of S that is not one of S' too: S does not cross S', and across a common edge the sector of K holds no face of
// S'. If n is 0 just outside all shells, it is 0 or 1 everywhere. Then no vertex lies in a tetrahedron that it is no
// corner of: inside it, inside one of its inner faces or edges, the star of the vertex would overlap it; inside one of
// its boundary faces or edges, the vertex would be on the boundary too, and a face at it would meet that face.
#include <algorithm>
#include <atomic>

#include "verify/parallel.h"
#include "verify/shells.h"
#include "verify/surface_contacts.h"

namespace certa::verify {
namespace {

/// Pairs of a shell and a face that winding numbers may cost; beyond, nothing is proved here.
constexpr double most_pairs = 1e9;

bool boundary_meets_itself(const Subject& subject, const Domain& domain) {
    const std::size_t count = domain.boundary.size();
    std::vector<BoundingBox> boxes(count);
    for (std::size_t i = 0; i < count; ++i) boxes[i] = BoundingBox::of(face_points(subject, domain.boundary[i]));
    const BoxTree tree(boxes);
    std::atomic<bool> meets = false;
    Findings none;
    for_each_item(count, subject.control, none, [&](std::size_t i, Findings&) {
        const auto f = outward_face(subject.mesh, domain.boundary[i]);
        tree.visit(boxes[i], [&](std::uint32_t k) {
            if (k > i && meet_beyond_shared(subject.mesh.positions, f, outward_face(subject.mesh, domain.boundary[k])))
                meets = true;
            return !meets;
        });
    });
    return meets;
}

/// Vertices of each shell, ascending.
std::vector<std::vector<std::uint32_t>> collect_vertices(const Subject& subject, const Domain& domain,
                                                         const std::vector<Shell>& shells) {
    std::vector<std::vector<std::uint32_t>> all(shells.size());
    for (std::size_t s = 0; s < shells.size(); ++s) {
        for (const std::uint32_t i : shells[s].faces) {
            const auto f = outward_face(subject.mesh, domain.boundary[i]);
            all[s].insert(all[s].end(), f.begin(), f.end());
        }
        std::sort(all[s].begin(), all[s].end());
        all[s].erase(std::unique(all[s].begin(), all[s].end()), all[s].end());
    }
    return all;
}

/// An element of `of` that is not in `other`, or no_index.
std::uint32_t find_own(const std::vector<std::uint32_t>& of, const std::vector<std::uint32_t>& other) {
    std::size_t k = 0;
    for (const std::uint32_t v : of) {
        while (k < other.size() && other[k] < v) ++k;
        if (k == other.size() || other[k] != v) return v;
    }
    return no_index;
}

/// Whether n is 0 just outside of every shell.
bool is_outside_empty(const Subject& subject, const Domain& domain) {
    const std::vector<Shell>& shells = domain.shells;
    const auto vertices = collect_vertices(subject, domain, shells);
    double pairs = 0.0;
    for (std::size_t s = 0; s < shells.size(); ++s) {
        if (subject.control.cancelled() || shells[s].sign == 0) return false;
        int n = shells[s].sign > 0 ? 0 : -1;
        for (std::size_t k = 0; k < shells.size(); ++k) {
            pairs += 1.0;
            // Where the box of one is not in the box of the other, the winding number around a vertex is 0.
            if (k == s || !is_in_box(shells[s].low, shells[k].low, shells[k].high) ||
                !is_in_box(shells[s].high, shells[k].low, shells[k].high))
                continue;
            pairs += static_cast<double>(shells[k].faces.size());
            const std::uint32_t own = find_own(vertices[s], vertices[k]);
            if (own == no_index || pairs > most_pairs) return false;
            n += winding_of(subject, domain, shells[k], subject.at(own));
        }
        if (n != 0) return false;
    }
    return true;
}

}  // namespace

bool is_embedded(const Subject& subject, const Domain& domain) {
    return !boundary_meets_itself(subject, domain) && !subject.control.cancelled() && is_outside_empty(subject, domain);
}

}  // namespace certa::verify
