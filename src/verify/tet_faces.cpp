// Adjacency by bucket sort: faces go to the bucket of their lowest vertex, edges to that of their lower one; buckets
// are small, are sorted on their own, and equal entries become neighbours.
#include "verify/tet_faces.h"

#include <algorithm>
#include <stdexcept>

#include "core/parallel.h"

namespace certa::verify {
namespace {

std::array<std::uint32_t, 3> sorted_face(const TetMesh& mesh, HalfFace half) {
    std::array<std::uint32_t, 3> f = outward_face(mesh, half);
    std::sort(f.begin(), f.end());
    return f;
}

/// Whether the outward order of a half-face is an even permutation of the ascending one.
bool is_even(const std::array<std::uint32_t, 3>& f) {
    return (f[0] < f[1] && f[1] < f[2]) || (f[1] < f[2] && f[2] < f[0]) || (f[2] < f[0] && f[0] < f[1]);
}

}  // namespace

TetFaces::TetFaces(const TetMesh& mesh) {
    if (mesh.tetrahedra.size() >= no_index / 4) throw std::length_error("more than 2^30 - 1 tetrahedra");
    collect_faces(mesh);
    match_faces(mesh);
    collect_edges(mesh);
}

void TetFaces::collect_faces(const TetMesh& mesh) {
    const std::size_t vertices = mesh.positions.size(), halves = 4 * mesh.tetrahedra.size();
    face_offsets_.assign(vertices + 1, 0);
    for (HalfFace h = 0; h < halves; ++h) ++face_offsets_[sorted_face(mesh, h)[0] + 1];
    for (std::size_t v = 0; v < vertices; ++v) face_offsets_[v + 1] += face_offsets_[v];
    entries_.resize(halves);
    std::vector<std::uint64_t> next(face_offsets_.begin(), face_offsets_.end() - 1);
    for (HalfFace h = 0; h < halves; ++h) {
        const auto f = sorted_face(mesh, h);
        entries_[next[f[0]]++] = {f[1], f[2], h};
    }
    core::parallel_for(vertices, 4096, {}, [&](std::size_t first, std::size_t last) {
        for (std::size_t v = first; v < last; ++v) {
            std::sort(entries_.begin() + static_cast<std::ptrdiff_t>(face_offsets_[v]),
                      entries_.begin() + static_cast<std::ptrdiff_t>(face_offsets_[v + 1]),
                      [](const Entry& a, const Entry& b) {
                          return a.middle != b.middle ? a.middle < b.middle
                                 : a.high != b.high   ? a.high < b.high
                                                      : a.half < b.half;
                      });
        }
    });
}

void TetFaces::match_faces(const TetMesh& mesh) {
    mates_.assign(entries_.size(), no_index);
    for (std::size_t v = 0; v + 1 < face_offsets_.size(); ++v) {
        for (std::size_t i = face_offsets_[v]; i < face_offsets_[v + 1];) {
            std::size_t end = i + 1;
            while (end < face_offsets_[v + 1] && entries_[end].middle == entries_[i].middle &&
                   entries_[end].high == entries_[i].high) {
                ++end;
            }
            const HalfFace first = entries_[i].half;
            if (end == i + 2 &&
                is_even(outward_face(mesh, first)) != is_even(outward_face(mesh, entries_[i + 1].half))) {
                mates_[first] = entries_[i + 1].half;
                mates_[entries_[i + 1].half] = first;
            } else if (end > i + 1) {
                crowded_.push_back(first);
                for (std::size_t k = i; k < end; ++k) crowded_halves_.push_back(entries_[k].half);
            }
            i = end;
        }
    }
    std::sort(crowded_.begin(), crowded_.end());
    std::sort(crowded_halves_.begin(), crowded_halves_.end());
}

void TetFaces::collect_edges(const TetMesh& mesh) {
    const std::size_t vertices = mesh.positions.size();
    std::vector<std::uint64_t> offsets(vertices + 1, 0);
    const auto for_each_edge = [&](auto&& visit) {
        for (const Tetrahedron& t : mesh.tetrahedra) {
            for (std::size_t i = 0; i < 4; ++i) {
                for (std::size_t j = i + 1; j < 4; ++j) {
                    const std::uint32_t a = index_of(t[i]), b = index_of(t[j]);
                    visit(std::min(a, b), std::max(a, b));
                }
            }
        }
    };
    for_each_edge([&](std::uint32_t a, std::uint32_t) { ++offsets[a + 1]; });
    for (std::size_t v = 0; v < vertices; ++v) offsets[v + 1] += offsets[v];
    std::vector<std::uint32_t> ends(offsets.back());
    std::vector<std::uint64_t> next(offsets.begin(), offsets.end() - 1);
    for_each_edge([&](std::uint32_t a, std::uint32_t b) { ends[next[a]++] = b; });
    edge_offsets_.assign(vertices + 1, 0);
    edge_ends_.reserve(ends.size() / 4);
    for (std::size_t v = 0; v < vertices; ++v) {
        const auto begin = ends.begin() + static_cast<std::ptrdiff_t>(offsets[v]);
        const auto end = ends.begin() + static_cast<std::ptrdiff_t>(offsets[v + 1]);
        std::sort(begin, end);
        edge_ends_.insert(edge_ends_.end(), begin, std::unique(begin, end));
        edge_offsets_[v + 1] = edge_ends_.size();
    }
}

std::vector<HalfFace> TetFaces::find(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    std::array<std::uint32_t, 3> f{a, b, c};
    std::sort(f.begin(), f.end());
    const auto begin = entries_.begin() + static_cast<std::ptrdiff_t>(face_offsets_[f[0]]);
    const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(face_offsets_[f[0] + 1]);
    auto i = std::lower_bound(begin, end, f, [](const Entry& e, const std::array<std::uint32_t, 3>& key) {
        return e.middle != key[1] ? e.middle < key[1] : e.high < key[2];
    });
    std::vector<HalfFace> result;
    for (; i != end && i->middle == f[1] && i->high == f[2]; ++i) result.push_back(i->half);
    return result;
}

bool TetFaces::has_edge(std::uint32_t a, std::uint32_t b) const {
    const auto [begin, end] = upper_neighbors(std::min(a, b));
    return std::binary_search(begin, end, std::max(a, b));
}

bool TetFaces::is_crowded(HalfFace half) const {
    return std::binary_search(crowded_halves_.begin(), crowded_halves_.end(), half);
}

}  // namespace certa::verify
