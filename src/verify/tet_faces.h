#pragma once
// Which tetrahedra meet in which faces and edges. Geometry-free; indices must be valid.
#include <certa/mesh.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace certa::verify {

/// A half-face is 4 * tetrahedron + corner: the face opposite to that corner, seen from outside its tetrahedron.
using HalfFace = std::uint32_t;

/// Corners of the face opposite to corner i, counter-clockwise from outside a positive tetrahedron.
inline constexpr std::array<std::array<int, 3>, 4> outward_corners{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

inline std::array<std::uint32_t, 3> outward_face(const TetMesh& mesh, HalfFace half) {
    const Tetrahedron& t = mesh.tetrahedra[half / 4];
    const auto& c = outward_corners[half % 4];
    return {index_of(t[static_cast<std::size_t>(c[0])]), index_of(t[static_cast<std::size_t>(c[1])]),
            index_of(t[static_cast<std::size_t>(c[2])])};
}
inline std::uint32_t apex_of(const TetMesh& mesh, HalfFace half) {
    return index_of(mesh.tetrahedra[half / 4][half % 4]);
}

class TetFaces {
public:
    explicit TetFaces(const TetMesh& mesh);

    /// The half-face on the other side, or no_index: a boundary face, or one of a face that is in `crowded`.
    HalfFace mate(HalfFace half) const { return mates_[half]; }
    std::size_t half_face_count() const { return mates_.size(); }
    /// All half-faces on three vertices, in any order of them.
    std::vector<HalfFace> find(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    bool has_edge(std::uint32_t a, std::uint32_t b) const;
    /// Neighbours of a with a larger index.
    std::pair<const std::uint32_t*, const std::uint32_t*> upper_neighbors(std::uint32_t a) const {
        return {edge_ends_.data() + edge_offsets_[a], edge_ends_.data() + edge_offsets_[a + 1]};
    }
    /// One half-face of every face that more than two tetrahedra share, or that two share from the same side.
    const std::vector<HalfFace>& crowded() const { return crowded_; }
    bool is_crowded(HalfFace half) const;

private:
    struct Entry {
        std::uint32_t middle, high;
        HalfFace half;
    };
    void collect_faces(const TetMesh& mesh);
    void match_faces(const TetMesh& mesh);
    void collect_edges(const TetMesh& mesh);

    std::vector<std::uint64_t> face_offsets_;  // by lowest vertex
    std::vector<Entry> entries_;
    std::vector<HalfFace> mates_;
    std::vector<HalfFace> crowded_;            // ascending
    std::vector<HalfFace> crowded_halves_;     // all of theirs, ascending
    std::vector<std::uint64_t> edge_offsets_;  // by lower vertex
    std::vector<std::uint32_t> edge_ends_;
};

}  // namespace certa::verify
