// Positions by exact signs of determinants: a vertex is on the line of its edge, strictly between its ends.
// Orientation: the positive points of the tetrahedron lie on the side that a triangle faces; its vertices being on
// edges between the signs, that is decided by one positive point.
#include "verify/implicit_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "verify/predicates.h"

namespace certa::verify {

class MeshOnComplex {
public:
    MeshOnComplex(const TriangleMesh& mesh, const ImplicitComplex& complex, bool either_way)
        : mesh_(mesh), c_(complex), either_way_(either_way), turned_(mesh.triangles.size(), 0) {}

    std::vector<std::string> run(const std::vector<std::int64_t>& vertex_edges) {
        if (vertex_edges.size() != 6 * mesh_.positions.size()) {
            problems_.push_back("the certificate is for a mesh with another number of vertices");
            return problems_;
        }
        const std::vector<std::uint32_t> ends = c_.points_from(vertex_edges, "vertex_edges");
        for (std::uint32_t v = 0; v < mesh_.positions.size(); ++v) check_vertex(v, ends[2 * v], ends[2 * v + 1]);
        for (const Triangle& t : mesh_.triangles) {
            for (const VertexId v : t) {
                if (index_of(v) >= mesh_.positions.size()) {
                    problems_.push_back("a triangle of the mesh names a vertex that does not exist");
                    return problems_;
                }
            }
        }
        if (problems_.empty()) check_triangles();
        if (problems_.empty() && either_way_) check_turns();
        return problems_;
    }

private:
    void fail(const std::string& text) {
        if (problems_.size() < 100) problems_.push_back(text);
    }

    /// An edge with both signs, and a vertex of the mesh on it.
    struct Carrier {
        std::uint32_t low, high, vertex;
        bool operator<(const Carrier& o) const {
            return low != o.low ? low < o.low : high != o.high ? high < o.high : vertex < o.vertex;
        }
    };
    /// The three vertices of a triangle, sorted.
    struct Corner {
        std::array<std::uint32_t, 3> key;
        std::uint32_t triangle;
        bool operator<(const Corner& o) const { return key != o.key ? key < o.key : triangle < o.triangle; }
    };

    static std::string name(std::uint32_t v) { return "vertex " + std::to_string(v + 1) + " of the mesh "; }

    void check_vertex(std::uint32_t v, std::uint32_t a, std::uint32_t b) {
        if (c_.sign[a] == c_.sign[b]) return fail(name(v) + "is said to be between points of one sign");
        carriers_.push_back({std::min(a, b), std::max(a, b), v});
        const Point3& p = mesh_.positions[v];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return fail(name(v) + "is not finite");
        const Point3 low = place(a), high = place(b);
        // On the line of the edge if and only if it is in three projections.
        if (orientation_xy(low, high, p) != 0 || orientation_xy(turned(low), turned(high), turned(p)) != 0 ||
            orientation_xy(turned(turned(low)), turned(turned(high)), turned(turned(p))) != 0)
            return fail(name(v) + "is off its edge");
        if (!is_between(low.x, high.x, p.x) || !is_between(low.y, high.y, p.y) || !is_between(low.z, high.z, p.z))
            fail(name(v) + "is not inside its edge");
    }
    static Point3 turned(const Point3& p) { return {p.y, p.z, p.x}; }
    static bool is_between(double a, double b, double x) {
        return a == b ? x == a : std::min(a, b) < x && x < std::max(a, b);
    }
    Point3 place(std::uint32_t point) const {
        const auto at = c_.place(point);
        return {at[0], at[1], at[2]};
    }

    void check_triangles() {
        std::sort(carriers_.begin(), carriers_.end());
        for (std::size_t i = 0; i + 1 < carriers_.size(); ++i) {
            if (carriers_[i].low == carriers_[i + 1].low && carriers_[i].high == carriers_[i + 1].high)
                fail(name(carriers_[i + 1].vertex) + "shares its edge with another");
        }
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            corners_.push_back(
                {{index_of(mesh_.triangles[i][0]), index_of(mesh_.triangles[i][1]), index_of(mesh_.triangles[i][2])},
                 i});
            std::sort(corners_.back().key.begin(), corners_.back().key.end());
        }
        std::sort(corners_.begin(), corners_.end());
        std::size_t used = 0;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> mixed;
        for (const ImplicitComplex::Tet& t : c_.tets()) {
            std::array<std::uint32_t, 4> positive{}, negative{};
            std::size_t positives = 0, negatives = 0;
            for (const std::uint32_t p : t) (c_.sign[p] > 0 ? positive[positives++] : negative[negatives++]) = p;
            if (positives == 0 || negatives == 0) continue;
            for (std::size_t i = 0; i < positives; ++i) {
                for (std::size_t j = 0; j < negatives; ++j) mixed.push_back(std::minmax(positive[i], negative[j]));
            }
            used += check_tet({positive.data(), positives}, {negative.data(), negatives});
        }
        std::sort(mixed.begin(), mixed.end());
        const auto edges = std::unique(mixed.begin(), mixed.end()) - mixed.begin();
        if (static_cast<std::size_t>(edges) != carriers_.size())
            fail("the mesh has " + std::to_string(carriers_.size()) + " vertices for " + std::to_string(edges) +
                 " edges with both signs");
        if (used != mesh_.triangles.size()) fail("the mesh has triangles that lie in no tetrahedron with both signs");
    }

    std::uint32_t vertex(std::uint32_t a, std::uint32_t b) const {
        const Carrier wanted{std::min(a, b), std::max(a, b), 0};
        const auto found = std::lower_bound(carriers_.begin(), carriers_.end(), wanted);
        return found == carriers_.end() || found->low != wanted.low || found->high != wanted.high
                   ? ImplicitComplex::no_point
                   : found->vertex;
    }

    /// The triangle with these vertices, if there is exactly one and it faces `positive`.
    bool has(std::array<std::uint32_t, 3> key, std::uint32_t positive) {
        std::sort(key.begin(), key.end());
        const auto found = std::lower_bound(corners_.begin(), corners_.end(), Corner{key, 0});
        if (found == corners_.end() || found->key != key) return false;
        if (found + 1 != corners_.end() && (found + 1)->key == key) return false;
        const std::uint32_t t = found->triangle;
        turned_[t] = faces(mesh_.triangles[t], positive) ? 0 : 1;
        return either_way_ || turned_[t] == 0;
    }

    /// Triangles that share a vertex are all turned over, or none is.
    void check_turns() {
        std::vector<int> turn_at(mesh_.positions.size(), -1);
        for (std::size_t t = 0; t < turned_.size(); ++t) {
            for (const VertexId v : mesh_.triangles[t]) {
                int& turn = turn_at[index_of(v)];
                if (turn >= 0 && turn != turned_[t])
                    return fail("triangle " + std::to_string(t + 1) +
                                " of the mesh faces another way than its neighbour");
                turn = turned_[t];
            }
        }
    }

    bool faces(const Triangle& t, std::uint32_t positive) const {
        return orientation(mesh_.positions[index_of(t[0])], mesh_.positions[index_of(t[1])],
                           mesh_.positions[index_of(t[2])], place(positive)) > 0;
    }

    /// How many triangles of the mesh make the disk of one tetrahedron; 0 and a problem where they make none.
    std::size_t check_tet(std::span<const std::uint32_t> positive, std::span<const std::uint32_t> negative) {
        std::array<std::uint32_t, 4> ring{};  // around the disk
        std::size_t size = 0;
        if (positive.size() == 2) {
            ring = {vertex(positive[0], negative[0]), vertex(positive[1], negative[0]),
                    vertex(positive[1], negative[1]), vertex(positive[0], negative[1])};
            size = 4;
        } else {
            for (const std::uint32_t p : positive) {
                for (const std::uint32_t q : negative) ring[size++] = vertex(p, q);
            }
        }
        if (std::find(ring.begin(), ring.begin() + size, ImplicitComplex::no_point) != ring.begin() + size) {
            fail("an edge with both signs carries no vertex of the mesh");
            return 0;
        }
        const std::uint32_t p = positive[0];
        if (size == 3) {
            if (has({ring[0], ring[1], ring[2]}, p)) return 1;
        } else {
            if (has({ring[0], ring[1], ring[2]}, p) && has({ring[0], ring[2], ring[3]}, p)) return 2;
            if (has({ring[1], ring[2], ring[3]}, p) && has({ring[1], ring[3], ring[0]}, p)) return 2;
        }
        fail("the triangles of the mesh in a tetrahedron are not the disk between its signs, near vertex " +
             std::to_string(ring[0] + 1));
        return 0;
    }

    const TriangleMesh& mesh_;
    const ImplicitComplex& c_;
    bool either_way_;
    std::vector<char> turned_;  ///< per triangle: faces the negative side
    std::vector<Carrier> carriers_;
    std::vector<Corner> corners_;
    std::vector<std::string> problems_;
};

std::vector<std::string> check_mesh_on_complex(const TriangleMesh& mesh, const ImplicitComplex& complex,
                                               const ImplicitCertificate& certificate, bool either_way) {
    return MeshOnComplex(mesh, complex, either_way).run(certificate.vertex_edges);
}

}  // namespace certa::verify
