#pragma once
// Lines as sequences of crossings with edges, and the chords that they cut through triangles.
//
// A crossing owns a number on its edge, different from those of all other crossings of that edge: their order is exact,
// and whether two chords of a triangle cross is a comparison of such numbers. Chords of one family never cross.
#include <array>

#include "remeshing/field.h"

namespace certa::remeshing {

struct Crossing {
    Index edge = no_index;  ///< no_index: taken back
    double t = 0.0;         ///< in (0, 1) along the edge's first half-edge
    Index line = no_index;
    Index vertex = no_index;  ///< instead of an edge: a line that starts at the tip of a crease
};

/// How a line ends.
enum class LineEnd : std::uint8_t { none, feature, near_line, umbilic, stuck };

struct Line {
    Family family = along_max;
    bool closed = false;
    std::vector<Index> crossings;
    std::vector<Index> faces;  ///< between consecutive crossings; closed: one more, back to the first
    std::array<LineEnd, 2> ends{LineEnd::none, LineEnd::none};
};

struct Chord {
    Index face = no_index, line = no_index;
    Index from = no_index, to = no_index;  ///< crossings, in either order
    Index next = no_index;                 ///< in the face
};

/// A place on the perimeter of a face, counter-clockwise from the start of a half-edge `side` steps after a given one.
struct PerimeterPlace {
    Index side = 0;
    double key = 0.0;  ///< grows along the half-edge
    friend bool operator<(const PerimeterPlace& a, const PerimeterPlace& b) {
        return a.side != b.side ? a.side < b.side : a.key < b.key;
    }
    friend bool operator==(const PerimeterPlace&, const PerimeterPlace&) = default;
};

/// How near lines of a family, or creases along it, are to the wedges where they are wanted.
struct Coverage {
    double farthest = 0.0;      ///< in spacings, of those with a line near them
    std::size_t uncovered = 0;  ///< wedges without
};

class Network {
public:
    explicit Network(const WorkMesh& mesh)
        : mesh_(mesh), edge_lists_(mesh.edge_halfedges.size()), face_heads_(mesh.faces.size(), no_index) {}

    const WorkMesh& mesh() const { return mesh_; }
    const std::vector<Line>& lines() const { return lines_; }
    std::vector<Line>& lines() { return lines_; }
    const Coverage& coverage(Family family) const { return coverage_[family]; }
    Coverage& coverage(Family family) { return coverage_[family]; }
    const Crossing& crossing(Index c) const { return crossings_[c]; }
    const std::vector<Index>& on_edge(Index edge) const { return edge_lists_[edge]; }
    const Chord& chord(Index c) const { return chords_[c]; }
    Index first_chord(Index face) const { return face_heads_[face]; }
    Point3 point(Index crossing) const {
        const Crossing& c = crossings_[crossing];
        return c.vertex != no_index ? mesh_.points[c.vertex] : mesh_.point_on(c.edge, c.t);
    }

    Index add_line(Family family) {
        lines_.push_back({family, false, {}, {}, {}});
        return static_cast<Index>(lines_.size() - 1);
    }
    /// A crossing near `t`, strictly between `low` and `high` and different from all others; no_index if there is no
    /// room for one more number. Close to an end of the edge, later crossings lie farther inside.
    Index add_crossing(Index line, Index edge, double t, double low, double high);
    /// The start of a line at a vertex.
    Index add_vertex_crossing(Index line, Index vertex);
    void add_chord(Index line, Index face, Index from, Index to);
    /// Where a chord that enters face h / 3 at `from`, on half-edge h, may leave: nearest to place `t` of half-edge
    /// `exit` without crossing its family. Changes exit and t (of the exit's edge) and sets the bounds; false: nowhere.
    bool find_exit(Family family, Index h, Index from, Index& exit, double& t, double& low, double& high) const;
    /// Takes the whole line back.
    void remove_line(Index line);
    /// Takes back the last chord and the crossing at its end.
    void remove_last(Index line);

    PerimeterPlace place(Index crossing, Index face, Index first_side) const;
    Family family_of(const Chord& chord) const { return lines_[chord.line].family; }
    /// Whether the ends of two chords of one face interleave.
    bool cross(const Chord& a, const Chord& b) const;
    std::size_t crossing_count() const { return crossings_.size(); }

private:
    void erase_crossing(Index c);
    void erase_chord(Index face, Index from, Index to);

    const WorkMesh& mesh_;
    std::vector<Crossing> crossings_;
    std::vector<std::vector<Index>> edge_lists_;
    std::vector<Chord> chords_;
    std::vector<Index> face_heads_;
    std::vector<Line> lines_;
    std::array<Coverage, 2> coverage_;
};

}  // namespace certa::remeshing
