// Critical clusters and the degree of grad f around them: Franek and Ratschan's combinatorial degree, with the sign
// covering supplied by the octree. The thesis left this open ("in a forthcoming version", Part III, 1.8).
//
// Plan: connect critical leaves that share a point. The boundary of a cluster is a chain of oriented squares, each
// subdivided to its finest neighbour and labelled (i, s) by the regular leaf on its far side: there the i-th derivative
// has sign s. With axes (i, j, k) in cyclic order: P = squares labelled (i, +), oriented outwards; Z = boundary of P, a
// 1-cycle; each edge of Z lies in a square of another label, (j, +-) or (k, +-), since (i, -) cannot touch (i, +); A =
// part of Z on edges labelled (j, +); at every point of its boundary an edge labelled (k, s) arrives; deg = sum of
// coefficients of boundary(A) at points with s = +. Chains have integer coefficients, so nothing has to be a manifold.
// The sign makes x^2 + y^2 + z^2 have degree +1.
#include "implicit/clusters.h"

#include <algorithm>
#include <bit>
#include <map>
#include <unordered_map>

#include "core/assert.h"
#include "core/union_find.h"

namespace certa::implicit {
namespace {

/// An oriented square: corners counter-clockwise seen from outside the cluster.
struct Square {
    std::array<std::uint32_t, 4> corners;
    std::int8_t axis, slope;
};

/// Leaves that share a point share a corner of the smaller one, which is a point on the larger one's surface: so each
/// critical leaf is united with the leaves around each of its corners.
void unite_around(const Octree& tree, const GridPoint& corner, std::uint32_t place,
                  const std::vector<std::uint32_t>& places, core::UnionFind& groups) {
    for (unsigned octant = 0; octant < 8; ++octant) {
        GridPoint p = corner;
        bool inside = true;
        for (unsigned a = 0; a < 3; ++a) {
            const bool below = ((octant >> a) & 1u) != 0;
            if (below ? p[a] == 0 : p[a] == tree.grid().side()) inside = false;
            if (below) --p[a];
        }
        if (!inside) continue;
        const std::uint32_t other = places[tree.leaf_at(p)];
        if (other != none) groups.unite(place, other);
    }
}

/// The four corners of a square with low corner p, counter-clockwise around +axis.
std::array<GridPoint, 4> corners_of(const GridPoint& p, int axis, Coordinate size) {
    const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
    std::array<GridPoint, 4> corners{p, p, p, p};
    corners[1][u] += size;
    corners[2][u] += size;
    corners[2][v] += size;
    corners[3][v] += size;
    return corners;
}

class Boundary {
public:
    explicit Boundary(const Octree& tree) : tree_(tree) {}

    /// The outer squares of one face of a critical leaf.
    void add_face(const Cell& cell, int axis, int side) {
        GridPoint low = cell.low;
        if (side == 1) low[static_cast<std::size_t>(axis)] += tree_.size_of(cell);
        add_square(low, axis, side, tree_.size_of(cell), tree_.across(cell, axis, side));
    }
    const std::vector<Square>& squares() const { return squares_; }

    /// Edges of the square as pairs of points, split wherever a leaf has a corner.
    template <class Visit>
    void for_each_edge(const Square& square, const Visit& visit) const {
        for (std::size_t i = 0; i < 4; ++i) split_edge(square.corners[i], square.corners[(i + 1) % 4], visit);
    }

private:
    void add_square(const GridPoint& low, int axis, int side, Coordinate size, std::uint32_t beyond) {
        if (beyond == none) return;  // a mirror: the other side is the same cluster again
        const Cell& neighbour = tree_.cell(beyond);
        if (!neighbour.is_leaf()) {
            const auto a = static_cast<unsigned>(axis), u = (a + 1) % 3, v = (a + 2) % 3;
            for (unsigned q = 0; q < 4; ++q) {
                GridPoint corner = low;
                corner[u] += (q & 1u) * (size / 2);
                corner[v] += (q >> 1) * (size / 2);
                const unsigned child = ((q & 1u) << u) | ((q >> 1) << v) | ((side == 0 ? 1u : 0u) << a);
                add_square(corner, axis, side, size / 2, neighbour.children + child);
            }
            return;
        }
        if (neighbour.is_critical()) return;
        CERTA_ASSERT(neighbour.known.slope != 0);
        Square square{{}, neighbour.known.axis, neighbour.known.slope};
        std::array<GridPoint, 4> corners = corners_of(low, axis, size);
        if (side == 0) std::reverse(corners.begin(), corners.end());
        for (std::size_t i = 0; i < 4; ++i) square.corners[i] = tree_.points().find(corners[i]);
        squares_.push_back(square);
    }

    template <class Visit>
    void split_edge(std::uint32_t a, std::uint32_t b, const Visit& visit) const {
        CERTA_ASSERT(a != none && b != none);
        const GridPoint &p = tree_.points()[a], &q = tree_.points()[b];
        GridPoint middle;
        bool unit = true;
        for (std::size_t i = 0; i < 3; ++i) {
            middle[i] = p[i] + (q[i] - p[i]) / 2;
            if (q[i] > p[i] ? q[i] - p[i] > 1 : p[i] - q[i] > 1) unit = false;
            if (q[i] < p[i]) middle[i] = q[i] + (p[i] - q[i]) / 2;
        }
        const std::uint32_t m = unit ? none : tree_.points().find(middle);
        if (m == none || !tree_.is_corner(m)) {
            visit(a, b);
            return;
        }
        split_edge(a, m, visit);
        split_edge(m, b, visit);
    }

    const Octree& tree_;
    std::vector<Square> squares_;
};

/// One edge of the boundary: how often Z runs along it (from the lower to the higher id), and whose derivatives are
/// proved on it.
struct EdgeInZ {
    int coefficient = 0;
    std::array<std::int8_t, 3> slopes{};
};

/// The point of a copy of the box that is reflected along some axes, a bit each: points on the mirrors are the same in
/// both halves.
std::uint32_t copied(const Octree& tree, std::uint32_t point, unsigned copy) {
    const unsigned faces = tree.box_faces(tree.points()[point]);
    for (unsigned a = 0; a < 3; ++a) {
        if (((faces >> (2 * a)) & 3u) != 0) copy &= ~(1u << a);
    }
    return 8 * point + copy;
}

/// Sum over the first `copies` copies; reflection turns squares over and the slopes along its axes.
int degree_with_roles(const Octree& tree, const Boundary& boundary, unsigned copies, int first) {
    const auto i = first, j = (first + 1) % 3, k = (first + 2) % 3;
    std::map<std::pair<std::uint32_t, std::uint32_t>, EdgeInZ> edges;
    for (unsigned copy = 0; copy < copies; ++copy) {
        const int turn = std::popcount(copy) % 2 == 0 ? 1 : -1;
        for (const Square& square : boundary.squares()) {
            const auto own = static_cast<std::int8_t>(((copy >> square.axis) & 1u) == 0 ? square.slope : -square.slope);
            const bool in_p = square.axis == i && own > 0;
            boundary.for_each_edge(square, [&](std::uint32_t p, std::uint32_t q) {
                const std::uint32_t a = copied(tree, p, copy), b = copied(tree, q, copy);
                EdgeInZ& edge = edges[{std::min(a, b), std::max(a, b)}];
                if (in_p) edge.coefficient += a < b ? turn : -turn;
                std::int8_t& slope = edge.slopes[static_cast<std::size_t>(square.axis)];
                CERTA_ASSERT(slope == 0 || slope == own);
                slope = own;
            });
        }
    }
    std::unordered_map<std::uint32_t, int> ends;           // boundary of A
    std::unordered_map<std::uint32_t, std::int8_t> third;  // sign of the k-th derivative at points of Z
    for (const auto& [ids, edge] : edges) {
        if (edge.coefficient == 0) continue;
        const std::int8_t second_slope = edge.slopes[static_cast<std::size_t>(j)];
        const std::int8_t third_slope = edge.slopes[static_cast<std::size_t>(k)];
        CERTA_ASSERT(second_slope != 0 || third_slope != 0);
        if (second_slope > 0) {
            ends[ids.second] += edge.coefficient;
            ends[ids.first] -= edge.coefficient;
        }
        if (second_slope == 0) third[ids.first] = third[ids.second] = third_slope;
    }
    int degree = 0;
    for (const auto& [point, coefficient] : ends) {
        if (coefficient == 0) continue;
        const auto found = third.find(point);
        CERTA_ASSERT(found != third.end());
        if (found->second > 0) degree += coefficient;
    }
    return degree;
}

int degree8_of(const Octree& tree, const Cluster& cluster) {
    Boundary boundary(tree);
    for (const std::uint32_t leaf : cluster.leaves) {
        for (int face = 0; face < 6; ++face) boundary.add_face(tree.cell(leaf), face / 2, face % 2);
    }
    const unsigned copies = cluster.touches_box ? 8 : 1;
    const int degree = degree_with_roles(tree, boundary, copies, 0);
    CERTA_ASSERT(degree == degree_with_roles(tree, boundary, copies, 1));
    CERTA_ASSERT(degree == degree_with_roles(tree, boundary, copies, 2));
    return degree * static_cast<int>(8 / copies);
}

}  // namespace

std::vector<Cluster> find_clusters(const Octree& tree) {
    std::vector<std::uint32_t> critical, places(tree.cells().size(), none);
    for (const std::uint32_t leaf : tree.leaves()) {
        if (!tree.cell(leaf).is_critical()) continue;
        places[leaf] = static_cast<std::uint32_t>(critical.size());
        critical.push_back(leaf);
    }
    core::UnionFind groups(critical.size());
    for (std::uint32_t place = 0; place < critical.size(); ++place) {
        const Cell& cell = tree.cell(critical[place]);
        const GridPoint high = tree.high_of(cell);
        for (unsigned c = 0; c < 8; ++c) {
            const GridPoint corner{(c & 1u) ? high[0] : cell.low[0], (c & 2u) ? high[1] : cell.low[1],
                                   (c & 4u) ? high[2] : cell.low[2]};
            unite_around(tree, corner, place, places, groups);
        }
    }
    std::vector<Cluster> clusters;
    std::vector<std::uint32_t> cluster_of(critical.size(), none);
    for (std::uint32_t place = 0; place < critical.size(); ++place) {
        std::uint32_t& id = cluster_of[groups.find(place)];
        if (id == none) {
            id = static_cast<std::uint32_t>(clusters.size());
            clusters.emplace_back();
            clusters.back().sign = tree.cell(critical[place]).known.sign;
        }
        Cluster& cluster = clusters[id];
        const Cell& cell = tree.cell(critical[place]);
        CERTA_ASSERT(cluster.sign == cell.known.sign);
        cluster.leaves.push_back(critical[place]);
        cluster.touches_box = cluster.touches_box || tree.touches_boundary(cell);
    }
    for (Cluster& cluster : clusters) {
        if (tree.is_clipped() || !cluster.touches_box) cluster.degree8 = degree8_of(tree, cluster);
    }
    return clusters;
}

}  // namespace certa::implicit
