// Exact positions by GMP rationals: p = a + t (b - a) with one t in (0, 1) for all coordinates. Orientation: the
// positive points of the tetrahedron lie on the side that a triangle faces; its vertices being on edges between the
// signs, that is decided by one positive point with an exact determinant.
#include "verify/implicit_mesh.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

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

    void check_vertex(std::uint32_t v, std::uint32_t a, std::uint32_t b) {
        const std::string name = "vertex " + std::to_string(v + 1) + " of the mesh ";
        if (c_.sign[a] == c_.sign[b]) return fail(name + "is said to be between points of one sign");
        if (!vertex_of_.emplace(std::minmax(a, b), v).second) return fail(name + "shares its edge with another");
        const Point3& p = mesh_.positions[v];
        const double at[3] = {p.x, p.y, p.z};
        const auto low = c_.place(a), high = c_.place(b);
        mpq_class t(-1);
        for (std::size_t i = 0; i < 3; ++i) {
            if (!std::isfinite(at[i])) return fail(name + "is not finite");
            const mpq_class from(low[i]), step = mpq_class(high[i]) - from, moved = mpq_class(at[i]) - from;
            if (step == 0) {
                if (moved != 0) return fail(name + "is off its edge");
                continue;
            }
            const mpq_class here = moved / step;
            if (t != -1 && here != t) return fail(name + "is off its edge");
            t = here;
        }
        if (!(t > 0) || !(t < 1)) fail(name + "is not inside its edge");
    }

    void check_triangles() {
        std::map<std::array<std::uint32_t, 3>, std::vector<std::uint32_t>> by_vertices;
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            std::array<std::uint32_t, 3> key{index_of(mesh_.triangles[i][0]), index_of(mesh_.triangles[i][1]),
                                             index_of(mesh_.triangles[i][2])};
            std::sort(key.begin(), key.end());
            by_vertices[key].push_back(i);
        }
        std::size_t used = 0, edges = 0;
        std::set<std::pair<std::uint32_t, std::uint32_t>> mixed;
        for (const ImplicitComplex::Tet& t : c_.tets()) {
            std::vector<std::uint32_t> positive, negative;
            for (const std::uint32_t p : t) (c_.sign[p] > 0 ? positive : negative).push_back(p);
            if (positive.empty() || negative.empty()) continue;
            for (const std::uint32_t p : positive) {
                for (const std::uint32_t q : negative) mixed.insert(std::minmax(p, q));
            }
            used += check_tet(positive, negative, by_vertices);
        }
        edges = mixed.size();
        if (edges != vertex_of_.size())
            fail("the mesh has " + std::to_string(vertex_of_.size()) + " vertices for " + std::to_string(edges) +
                 " edges with both signs");
        if (used != mesh_.triangles.size()) fail("the mesh has triangles that lie in no tetrahedron with both signs");
    }

    using ByVertices = std::map<std::array<std::uint32_t, 3>, std::vector<std::uint32_t>>;

    std::uint32_t vertex(std::uint32_t a, std::uint32_t b) const {
        const auto found = vertex_of_.find(std::minmax(a, b));
        return found == vertex_of_.end() ? ImplicitComplex::no_point : found->second;
    }

    /// The triangle with these vertices, if there is exactly one and it faces `positive`.
    bool has(std::array<std::uint32_t, 3> key, std::uint32_t positive, const ByVertices& by_vertices) {
        std::sort(key.begin(), key.end());
        const auto found = by_vertices.find(key);
        if (found == by_vertices.end() || found->second.size() != 1) return false;
        const std::uint32_t t = found->second[0];
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

    bool faces(const Triangle& triangle, std::uint32_t positive) const {
        mpq_class d[3][3];
        const auto target = c_.place(positive);
        const Point3& origin = mesh_.positions[index_of(triangle[0])];
        const auto difference = [&](mpq_class(&row)[3], double x, double y, double z) {
            row[0] = mpq_class(x) - mpq_class(origin.x);
            row[1] = mpq_class(y) - mpq_class(origin.y);
            row[2] = mpq_class(z) - mpq_class(origin.z);
        };
        const Point3 &b = mesh_.positions[index_of(triangle[1])], &c = mesh_.positions[index_of(triangle[2])];
        difference(d[0], b.x, b.y, b.z);
        difference(d[1], c.x, c.y, c.z);
        difference(d[2], target[0], target[1], target[2]);
        const mpq_class determinant = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                                      d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                                      d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
        return determinant > 0;
    }

    /// How many triangles of the mesh make the disk of one tetrahedron; 0 and a problem where they make none.
    std::size_t check_tet(const std::vector<std::uint32_t>& positive, const std::vector<std::uint32_t>& negative,
                          const ByVertices& by_vertices) {
        std::vector<std::uint32_t> ring;  // around the disk
        if (positive.size() == 2) {
            ring = {vertex(positive[0], negative[0]), vertex(positive[1], negative[0]),
                    vertex(positive[1], negative[1]), vertex(positive[0], negative[1])};
        } else {
            for (const std::uint32_t p : positive) {
                for (const std::uint32_t q : negative) ring.push_back(vertex(p, q));
            }
        }
        if (std::find(ring.begin(), ring.end(), ImplicitComplex::no_point) != ring.end()) {
            fail("an edge with both signs carries no vertex of the mesh");
            return 0;
        }
        const std::uint32_t p = positive[0];
        if (ring.size() == 3) {
            if (has({ring[0], ring[1], ring[2]}, p, by_vertices)) return 1;
        } else {
            if (has({ring[0], ring[1], ring[2]}, p, by_vertices) && has({ring[0], ring[2], ring[3]}, p, by_vertices))
                return 2;
            if (has({ring[1], ring[2], ring[3]}, p, by_vertices) && has({ring[1], ring[3], ring[0]}, p, by_vertices))
                return 2;
        }
        fail("the triangles of the mesh in a tetrahedron are not the disk between its signs, near vertex " +
             std::to_string(ring[0] + 1));
        return 0;
    }

    const TriangleMesh& mesh_;
    const ImplicitComplex& c_;
    bool either_way_;
    std::vector<char> turned_;  ///< per triangle: faces the negative side
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> vertex_of_;
    std::vector<std::string> problems_;
};

std::vector<std::string> check_mesh_on_complex(const TriangleMesh& mesh, const ImplicitComplex& complex,
                                               const ImplicitCertificate& certificate, bool either_way) {
    return MeshOnComplex(mesh, complex, either_way).run(certificate.vertex_edges);
}

}  // namespace certa::verify
