#pragma once
// The three-dimensional Delaunay triangulation behind indices: exact presence of edges and faces, the conflict zone of
// a point before and after its insertion, and marks on faces that survive insertions elsewhere.
#include <certa/types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace certa::delaunay {

/// What the insertion of a point would remove. Valid until the next call that changes or searches conflicts.
struct ConflictZone {
    bool occupied = false;  ///< a vertex is already exactly there: `vertices` holds it alone, nothing else is set
    std::vector<std::uint32_t> vertices;                     ///< of the zone's cells, each once
    std::vector<std::array<std::uint32_t, 2>> edges;         ///< inside the zone, each once: they disappear
    std::vector<std::array<std::uint32_t, 2>> border_edges;  ///< around the zone, each once: they stay
    std::vector<std::uint32_t> removed_marks;                ///< marks of the faces that disappear
    std::vector<std::uint32_t> border_marks;                 ///< marks of the faces around the zone, which stay
};

/// A face of the triangulation, for as long as nothing is inserted.
struct FaceHandle {
    void* cell = nullptr;  ///< null: there is no such face
    int index = 0;
};

class Delaunay3 {
public:
    Delaunay3();
    ~Delaunay3();
    Delaunay3(Delaunay3&&) noexcept;
    Delaunay3& operator=(Delaunay3&&) noexcept;

    /// Triangulates points; ids are their indices. Points in `left_out` (sorted) get an id but no vertex: nothing may
    /// ask for them. The others are distinct. Cost: O(n log n) on surfaces in practice.
    void build(std::span<const Point3> points, std::span<const std::uint32_t> left_out = {});

    bool is_solid() const;  ///< the points span space
    std::size_t size() const { return positions_.size(); }
    const Point3& position(std::uint32_t vertex) const { return positions_[vertex]; }
    const std::vector<Point3>& positions() const { return positions_; }

    /// The conflict zone of a point; `near` is a vertex to start the search from.
    const ConflictZone& find_conflicts(const Point3& place, std::uint32_t near);
    /// Inserts the point of the last find_conflicts (not occupied) and returns its id.
    std::uint32_t insert_in_conflicts();

    /// The vertex nearest to a place, up to rounding; the lower one of two. `near` is a vertex to start the search
    /// from.
    std::uint32_t find_nearest(const Point3& place, std::uint32_t near) const;

    bool has_edge(std::uint32_t a, std::uint32_t b) const;
    FaceHandle find_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    bool has_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return find_face(a, b, c).cell != nullptr;
    }
    /// Whether the vertex inserted last has an edge to v.
    bool is_beside_last(std::uint32_t v) const;
    /// A face around an edge, and its third vertex.
    struct LinkFace {
        std::uint32_t vertex = 0;
        FaceHandle face;
    };
    /// The faces around edge ab; empty where ab is no edge.
    void find_link(std::uint32_t a, std::uint32_t b, std::vector<LinkFace>& link) const;
    /// The fourth vertices of the two cells on a face; no_index outside the hull.
    std::array<std::uint32_t, 2> apexes_of(const FaceHandle& face) const;

    /// Marks a face with a number below no_index.
    void mark_face(const FaceHandle& face, std::uint32_t mark);
    void clear_marks();
    /// Number of faces with each mark below `size`.
    std::vector<std::uint32_t> count_marks(std::size_t size) const;

    /// All finite cells, positively oriented, and the connected components that marked faces divide space into: 0 is
    /// the one at infinity, the others follow in the order of their lowest vertex.
    struct Cells {
        std::vector<std::array<std::uint32_t, 4>> vertices;
        std::vector<std::uint32_t> components;  ///< per cell
        std::uint32_t component_count = 1;
        /// Pairs of components that have a wall between them, each once, lower number first; no_index beyond the hull.
        std::vector<std::array<std::uint32_t, 2>> walls;
    };
    Cells collect_cells() const;
    /// The components of the finite cells around an edge, which must be present.
    void components_around(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& components) const;
    /// The component (as in `cells`) that holds a place; no_index on a marked face.
    std::uint32_t locate_component(const Point3& place) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    std::vector<Point3> positions_;
};

/// Whether p is strictly inside the ball that has the circumcircle of abc as a great circle; exact.
bool is_inside_diametral_ball(const Point3& p, const Point3& a, const Point3& b, const Point3& c);

}  // namespace certa::delaunay
