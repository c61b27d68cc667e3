// Clipped surfaces: docs/implicit-theorem.md, "clipping by the box".
#include "verify/implicit_clip.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace certa::verify {
namespace {

constexpr std::uint32_t no_point = ImplicitComplex::no_point;

unsigned faces_of(const ImplicitComplex& complex, std::uint32_t p) { return complex.box_faces(complex.points()[p]); }

}  // namespace

bool close_rim(const ImplicitComplex& complex, std::uint32_t p, std::span<const std::uint32_t> star,
               const std::function<bool(std::uint32_t)>& inside,
               std::vector<std::pair<std::uint32_t, std::uint32_t>>& link_edges) {
    const unsigned own = faces_of(complex, p);
    std::array<int, 6> changes{};
    for (const std::uint32_t tet : star) {
        for (const std::uint32_t a : complex.tets()[tet]) {
            for (const std::uint32_t b : complex.tets()[tet]) {
                if (a >= b || a == p || b == p) continue;
                const unsigned shared = own & faces_of(complex, a) & faces_of(complex, b);
                if (shared == 0) continue;  // the edge (a, b) is not in the rim
                link_edges.emplace_back(a, no_point);
                link_edges.emplace_back(b, no_point);
                for (unsigned face = 0; face < 6; ++face) {
                    if (((shared >> face) & 1u) != 0 && inside(a) != inside(b)) ++changes[face];
                }
            }
        }
    }
    std::vector<int> of_own_faces;
    for (unsigned face = 0; face < 6; ++face) {
        if (((own >> face) & 1u) != 0) of_own_faces.push_back(changes[face]);
    }
    return of_own_faces == std::vector<int>{2} || of_own_faces == std::vector<int>{1, 1};
}

std::vector<std::uint32_t> loops_in_box_faces(const ImplicitComplex& complex) {
    // Each triangle with both signs in a face of the box has two edges with both signs: walk from edge to edge.
    using Edge = std::pair<std::uint32_t, std::uint32_t>;
    std::map<Edge, std::vector<Edge>> next;
    for (const ImplicitComplex::Tet& t : complex.tets()) {
        for (std::size_t skip = 0; skip < 4; ++skip) {
            std::vector<std::uint32_t> face;
            for (std::size_t i = 0; i < 4; ++i) {
                if (i != skip) face.push_back(t[i]);
            }
            if ((faces_of(complex, face[0]) & faces_of(complex, face[1]) & faces_of(complex, face[2])) == 0) continue;
            std::vector<Edge> mixed;
            for (const auto& [a, b] : {Edge{face[0], face[1]}, Edge{face[0], face[2]}, Edge{face[1], face[2]}}) {
                if (complex.sign[a] != complex.sign[b]) mixed.push_back(std::minmax(a, b));
            }
            if (mixed.size() != 2) continue;
            next[mixed[0]].push_back(mixed[1]);
            next[mixed[1]].push_back(mixed[0]);
        }
    }
    std::vector<std::uint32_t> loops;
    std::set<Edge> seen;
    for (const auto& [start, around] : next) {
        if (!seen.insert(start).second) continue;
        loops.push_back(start.first);
        std::vector<Edge> work{start};
        while (!work.empty()) {
            const Edge edge = work.back();
            work.pop_back();
            for (const Edge& other : next.at(edge)) {
                if (seen.insert(other).second) work.push_back(other);
            }
        }
    }
    return loops;
}

std::vector<SlopeTriangle> unfolded(const ImplicitComplex& complex, const std::vector<SlopeTriangle>& triangles) {
    if (complex.points().size() >= (std::size_t{1} << 29)) throw UnreadableCertificate("too many points to unfold");
    std::vector<SlopeTriangle> result;
    for (std::uint32_t x = 0; x < 2; ++x) {
        for (std::uint32_t y = 0; y < 2; ++y) {
            for (std::uint32_t z = 0; z < 2; ++z) {
                const std::uint32_t mirrored[3] = {x, y, z};
                for (SlopeTriangle t : triangles) {
                    for (std::uint32_t& p : t.corners) {
                        const Lattice& at = complex.points()[p];
                        std::uint32_t copy = 0;
                        for (std::size_t a = 0; a < 3; ++a) {
                            if (at[a] != 0 && at[a] != complex.side()) copy += mirrored[a] << a;
                        }
                        p = 8 * p + copy;
                    }
                    if (mirrored[t.axis] == 1) t.slope = -t.slope;
                    if ((x + y + z) % 2 == 1) std::swap(t.corners[0], t.corners[1]);
                    result.push_back(t);
                }
            }
        }
    }
    return result;
}

}  // namespace certa::verify
