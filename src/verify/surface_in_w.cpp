// Theorem A (docs/implicit-theorem.md, "any mesh"): what a mesh has to be, and to miss, to be isotopic to the surface
// in W.
//
// Plan: form of a closed surface; contacts with itself; components, genera, nesting (rays); triangles with exactly one
// tetrahedron of W, which no triangle of the mesh may touch; the component of W around one vertex of each component of
// the mesh; winding numbers of a point on either side.
#include "verify/surface_in_w.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/parallel.h"
#include "verify/predicates.h"
#include "verify/report.h"
#include "verify/surface_contacts.h"

namespace certa::verify {
namespace {

constexpr std::uint32_t no_point = ImplicitComplex::no_point;

Point3 point_of(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

class Judge {
public:
    Judge(const TriangleMesh& mesh, const ImplicitComplex& complex, const VerifiedW& w, const RunControl& control)
        : mesh_(mesh), c_(complex), w_(w), control_(control) {}

    MeshFindings run() {
        if (has_form()) {
            findings_.genera = surface_.genera;
            std::sort(findings_.genera.begin(), findings_.genera.end());
            index_triangles();
            if (misses_itself() && agrees_with_w() && misses_frontier()) locate();
        }
        if (control_.cancelled()) findings_.hindering.push_back("the check was cancelled");
        findings_.component_of_triangle = std::move(surface_.component_of_triangle);
        std::sort(findings_.triangles.begin(), findings_.triangles.end());
        findings_.triangles.erase(std::unique(findings_.triangles.begin(), findings_.triangles.end()),
                                  findings_.triangles.end());
        return std::move(findings_);
    }

private:
    void note(std::vector<std::string>& reasons, const std::string& text, std::initializer_list<std::uint32_t> where) {
        if (reasons.size() < 100) reasons.push_back(text);
        findings_.triangles.insert(findings_.triangles.end(), where.begin(), where.end());
    }
    void refute(const std::string& text, std::initializer_list<std::uint32_t> where = {}) {
        note(findings_.refuting, text, where);
    }
    void hinder(const std::string& text, std::initializer_list<std::uint32_t> where = {}) {
        note(findings_.hindering, text, where);
    }
    static std::string name(std::uint32_t triangle) { return "triangle " + std::to_string(triangle + 1); }
    const Point3& at(VertexId v) const { return mesh_.positions[index_of(v)]; }
    Corners corners(std::uint32_t t) const {
        const Triangle& v = surface_.triangles[t];
        return {at(v[0]), at(v[1]), at(v[2])};
    }

    // ---- Form -------------------------------------------------------------------------------------------------------

    bool has_form() {
        surface_.triangles = mesh_.triangles;
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
            for (const VertexId v : mesh_.triangles[t]) {
                if (index_of(v) >= mesh_.positions.size()) {
                    refute(name(t) + " names a vertex that does not exist", {t});
                    return false;
                }
                const Point3& p = at(v);
                if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
                    refute(name(t) + " has a vertex that is not finite", {t});
                    return false;
                }
            }
            if (is_degenerate(corners(t))) refute(name(t) + " has no area", {t});
        }
        return findings_.refuting.empty() && has_closed_edges() && has_round_links() && orient();
    }

    bool has_closed_edges() {
        struct Side {
            std::uint32_t low, high, triangle;
            bool operator<(const Side& o) const {
                return low != o.low ? low < o.low : high != o.high ? high < o.high : triangle < o.triangle;
            }
        };
        std::vector<Side> sides;
        for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t p = index_of(surface_.triangles[t][i]);
                const std::uint32_t q = index_of(surface_.triangles[t][(i + 1) % 3]);
                sides.push_back({std::min(p, q), std::max(p, q), t});
            }
        }
        std::sort(sides.begin(), sides.end());
        across_.assign(surface_.triangles.size(), {no_point, no_point, no_point});
        for (std::size_t i = 0; i < sides.size();) {
            std::size_t end = i;
            while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
            if (end - i != 2) {
                refute("the edge of vertices " + std::to_string(sides[i].low + 1) + " and " +
                           std::to_string(sides[i].high + 1) + " is in " + std::to_string(end - i) +
                           " triangles, among them " + name(sides[i].triangle),
                       {sides[i].triangle});
            } else {
                across_[sides[i].triangle][slot(sides[i].triangle, sides[i].low, sides[i].high)] =
                    sides[i + 1].triangle;
                across_[sides[i + 1].triangle][slot(sides[i + 1].triangle, sides[i].low, sides[i].high)] =
                    sides[i].triangle;
            }
            i = end;
        }
        return findings_.refuting.empty();
    }
    /// Which edge of a triangle has these ends: edge i is from corner i to the next.
    std::size_t slot(std::uint32_t triangle, std::uint32_t a, std::uint32_t b) const {
        const Triangle& t = surface_.triangles[triangle];
        for (std::size_t i = 0; i < 3; ++i) {
            if (std::minmax(index_of(t[i]), index_of(t[(i + 1) % 3])) == std::minmax(a, b)) return i;
        }
        return 0;
    }

    /// The triangles around every vertex are one cycle: walking across edges meets all of them.
    bool has_round_links() {
        std::vector<std::uint32_t> count(mesh_.positions.size(), 0), first(mesh_.positions.size(), no_point);
        for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
            for (const VertexId v : surface_.triangles[t]) {
                ++count[index_of(v)];
                first[index_of(v)] = t;
            }
        }
        for (std::uint32_t v = 0; v < count.size(); ++v) {
            if (count[v] == 0) continue;
            std::uint32_t steps = 0, from = no_point, t = first[v];
            do {
                const std::uint32_t next = other_around(t, v, from);
                from = t;
                t = next;
                ++steps;
            } while (t != first[v] && steps <= count[v]);
            if (steps != count[v])
                refute("the triangles around vertex " + std::to_string(v + 1) + " are no single cycle", {first[v]});
        }
        return findings_.refuting.empty();
    }
    /// The triangle across an edge at v that is not the one that one came from. (Two triangles that share two edges at
    /// v are found as contacts later: their third edge is common, too.)
    std::uint32_t other_around(std::uint32_t t, std::uint32_t v, std::uint32_t from) const {
        std::uint32_t other = no_point;
        for (std::size_t i = 0; i < 3; ++i) {
            const Triangle& c = surface_.triangles[t];
            if (index_of(c[i]) != v && index_of(c[(i + 1) % 3]) != v) continue;
            if (across_[t][i] != from || other == no_point) other = across_[t][i];
            if (from == no_point) return other;
        }
        return other;
    }

    bool orient() {
        const std::size_t count = surface_.triangles.size();
        surface_.component_of_triangle.assign(count, no_point);
        std::vector<char> turn(count, 0);
        for (std::uint32_t start = 0; start < count; ++start) {
            if (surface_.component_of_triangle[start] != no_point) continue;
            const auto component = static_cast<std::uint32_t>(surface_.first_triangle.size());
            surface_.first_triangle.push_back(start);
            std::vector<std::uint32_t> work{start};
            surface_.component_of_triangle[start] = component;
            std::set<std::uint32_t> vertices;
            std::size_t triangles = 0;
            while (!work.empty()) {
                const std::uint32_t t = work.back();
                work.pop_back();
                ++triangles;
                for (std::size_t i = 0; i < 3; ++i) {
                    vertices.insert(index_of(surface_.triangles[t][i]));
                    const std::uint32_t other = across_[t][i];
                    const VertexId a = surface_.triangles[t][i], b = surface_.triangles[t][(i + 1) % 3];
                    const std::size_t j = slot(other, index_of(a), index_of(b));
                    const bool same_way = surface_.triangles[other][j] == a;
                    const char wanted = same_way ? static_cast<char>(1 - turn[t]) : turn[t];
                    if (surface_.component_of_triangle[other] == no_point) {
                        surface_.component_of_triangle[other] = component;
                        turn[other] = wanted;
                        work.push_back(other);
                    } else if (turn[other] != wanted) {
                        refute("the mesh is not orientable, near " + name(other), {other});
                        return false;
                    }
                }
            }
            // V - E + F with 2 E = 3 F.
            const long euler = static_cast<long>(vertices.size()) - static_cast<long>(triangles / 2);
            surface_.genera.push_back(static_cast<int>(1 - euler / 2));
        }
        for (std::size_t t = 0; t < count; ++t) {
            if (!turn[t]) continue;
            std::swap(surface_.triangles[t][1], surface_.triangles[t][2]);
            surface_.turned = true;
        }
        return true;
    }

    // ---- Contacts ---------------------------------------------------------------------------------------------------

    void index_triangles() {
        std::vector<BoundingBox> boxes;
        for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) boxes.push_back(BoundingBox::of(corners(t)));
        tree_ = std::make_unique<BoxTree>(std::move(boxes));
    }

    bool misses_itself() {
        const std::size_t count = surface_.triangles.size();
        std::vector<std::uint32_t> touched(count, no_point);
        core::parallel_for(count, 256, control_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end && !control_.cancelled(); ++i) {
                const auto t = static_cast<std::uint32_t>(i);
                tree_->visit(BoundingBox::of(corners(t)), [&](std::uint32_t other) {
                    if (other > t && in_contact(t, other)) touched[i] = other;
                    return touched[i] == no_point;
                });
            }
        });
        for (std::uint32_t t = 0; t < count; ++t) {
            if (touched[t] != no_point)
                refute("the mesh touches itself: " + name(t) + " and " + name(touched[t]) + ", near " +
                           show(corners(t)[0]),
                       {t, touched[t]});
        }
        return findings_.refuting.empty() && !control_.cancelled();
    }

    bool in_contact(std::uint32_t s, std::uint32_t t) const {
        std::array<std::size_t, 3> in_s{}, in_t{};
        std::size_t shared = 0;
        const Triangle &a = surface_.triangles[s], &b = surface_.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                if (a[i] != b[j]) continue;
                in_s[shared] = i;
                in_t[shared++] = j;
            }
        }
        const Corners p = corners(s), q = corners(t);
        if (shared == 0) return triangles_meet(p, q);
        const auto first = [](const Corners& c, std::size_t i) {
            return Corners{c[i], c[(i + 1) % 3], c[(i + 2) % 3]};
        };
        if (shared == 1) return meet_beyond_corner(first(p, in_s[0]), first(q, in_t[0]));
        if (shared == 2)
            return meet_beyond_edge({p[in_s[0]], p[in_s[1]], p[3 - in_s[0] - in_s[1]]},
                                    {q[in_t[0]], q[in_t[1]], q[3 - in_t[0] - in_t[1]]});
        return true;
    }

    // ---- Invariants -------------------------------------------------------------------------------------------------

    bool agrees_with_w() {
        std::vector<int> wanted;
        for (const VerifiedComponent& v : w_.components) wanted.push_back(v.genus);
        std::sort(wanted.begin(), wanted.end());
        const auto list = [](const std::vector<int>& genera) {
            std::string text = std::to_string(genera.size()) + (genera.size() == 1 ? " component" : " components");
            for (std::size_t i = 0; i < genera.size() && i < 20; ++i)
                text += (i == 0 ? " of genus " : ", ") + std::to_string(genera[i]);
            return text + (genera.size() > 20 ? ", ..." : "");
        };
        if (findings_.genera != wanted) {
            refute("the mesh has " + list(findings_.genera) + ", the zero set " + list(wanted));
            return false;
        }
        if (surface_.genera.size() > 1 && nesting_of_mesh() != nesting_of_w()) {
            if (findings_.hindering.empty()) refute("the components of mesh and zero set are nested differently");
            return false;
        }
        return true;
    }

    /// A text for a tree of components that does not depend on their order.
    static std::string text_of(const std::vector<int>& genera, const std::vector<std::uint32_t>& parents,
                               std::uint32_t node) {
        std::vector<std::string> children;
        for (std::uint32_t i = 0; i < parents.size(); ++i) {
            if (parents[i] == node) children.push_back(text_of(genera, parents, i));
        }
        std::sort(children.begin(), children.end());
        std::string text = node == no_point ? "" : std::to_string(genera[node]);
        for (const std::string& child : children) text += "(" + child + ")";
        return text;
    }

    std::string nesting_of_w() const {
        std::vector<int> genera;
        std::map<std::uint32_t, std::uint32_t> number;
        for (const VerifiedComponent& v : w_.components) {
            number.emplace(v.id, static_cast<std::uint32_t>(genera.size()));
            genera.push_back(v.genus);
        }
        std::vector<std::uint32_t> parents;
        for (const VerifiedComponent& v : w_.components)
            parents.push_back(v.parent == no_point ? no_point : number.at(v.parent));
        return text_of(genera, parents, no_point);
    }

    std::string nesting_of_mesh() {
        const auto count = static_cast<std::uint32_t>(surface_.genera.size());
        std::vector<std::vector<std::uint32_t>> around(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::map<std::uint32_t, int> windings = windings_at(corners(surface_.first_triangle[i])[0], i);
            for (const auto& [component, winding] : windings) {
                if (component != i && winding != 0) around[i].push_back(component);
            }
        }
        // The next one around is the one that most others are around.
        std::vector<std::uint32_t> parents(count, no_point);
        for (std::uint32_t i = 0; i < count; ++i) {
            for (const std::uint32_t j : around[i]) {
                if (parents[i] == no_point || around[j].size() > around[parents[i]].size()) parents[i] = j;
            }
        }
        return text_of(surface_.genera, parents, no_point);
    }

    /// Winding numbers of the components of the mesh, other than `except`, around a point off them.
    std::map<std::uint32_t, int> windings_at(const Point3& p, std::uint32_t except) {
        BoundingBox all = BoundingBox::of(p, p);
        for (const Point3& q : mesh_.positions) {
            if (std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z)) all.add(BoundingBox::of(q, q));
        }
        const double size = std::max({all.high.x - all.low.x, all.high.y - all.low.y, all.high.z - all.low.z});
        if (!std::isfinite(size) || !std::isfinite(all.high.x + size)) {
            hinder("the mesh is too large for rays to leave it");
            return {};
        }
        for (int attempt = 0; attempt < 50; ++attempt) {
            // Rays in directions near +x, none of which a mesh is likely to be aligned with.
            const double t = (attempt + 1) * 0.0137;
            const Point3 far{all.high.x + size, p.y + size * t * 0.613,
                             p.z + size * t * (attempt % 2 ? -0.471 : 0.289)};
            std::map<std::uint32_t, int> result;
            bool generic = true;
            tree_->visit(BoundingBox::of(p, far), [&](std::uint32_t triangle) {
                const std::uint32_t component = surface_.component_of_triangle[triangle];
                if (component == except) return true;
                const int way = crossing(p, far, corners(triangle));
                if (way == 2) generic = false;
                result[component] += way;
                return generic;
            });
            if (generic) return result;
        }
        hinder("every ray tried from " + show(p) + " meets an edge of the mesh");
        return {};
    }

    // ---- Within W ---------------------------------------------------------------------------------------------------

    bool is_in_w(const ImplicitComplex::Tet& t) const {
        return std::all_of(t.begin(), t.end(), [&](std::uint32_t p) { return w_.marked[p] != 0; });
    }

    /// Triangles of T with exactly one tetrahedron of W.
    std::vector<Corners> frontier() const {
        std::vector<std::array<std::uint32_t, 3>> faces;
        for (const ImplicitComplex::Tet& t : c_.tets()) {
            if (!is_in_w(t)) continue;
            for (std::size_t i = 0; i < 4; ++i) {
                std::array<std::uint32_t, 3> face{t[(i + 1) % 4], t[(i + 2) % 4], t[(i + 3) % 4]};
                std::sort(face.begin(), face.end());
                faces.push_back(face);
            }
        }
        std::sort(faces.begin(), faces.end());
        std::vector<Corners> result;
        for (std::size_t i = 0; i < faces.size();) {
            std::size_t end = i;
            while (end < faces.size() && faces[end] == faces[i]) ++end;
            if (end - i == 1)
                result.push_back({point_of(c_.place(faces[i][0])), point_of(c_.place(faces[i][1])),
                                  point_of(c_.place(faces[i][2]))});
            i = end;
        }
        return result;
    }

    bool misses_frontier() {
        findings_.frontier = frontier();
        const std::vector<Corners>& faces = findings_.frontier;
        std::vector<BoundingBox> boxes;
        for (const Corners& face : faces) boxes.push_back(BoundingBox::of(face));
        const BoxTree tree(std::move(boxes));
        std::vector<char> touches(surface_.triangles.size(), 0);
        core::parallel_for(surface_.triangles.size(), 256, control_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end && !control_.cancelled(); ++i) {
                const Corners mine = corners(static_cast<std::uint32_t>(i));
                tree.visit(BoundingBox::of(mine), [&](std::uint32_t face) {
                    if (triangles_meet(mine, faces[face])) touches[i] = 1;
                    return touches[i] == 0;
                });
            }
        });
        for (std::uint32_t t = 0; t < touches.size(); ++t) {
            if (touches[t]) hinder(name(t) + " leaves W, near " + show(corners(t)[0]), {t});
        }
        return findings_.hindering.empty() && !control_.cancelled();
    }

    /// The component of W in one of whose tetrahedra a point lies, or no_point.
    std::uint32_t component_around(const Point3& p) const {
        Lattice at{};
        const double coordinates[3] = {p.x, p.y, p.z};
        for (std::size_t a = 0; a < 3; ++a) {
            if (coordinates[a] < c_.place(a, 0) || coordinates[a] > c_.place(a, c_.side())) return no_point;
            // The last grid point not above p, at most the last but one of all.
            std::uint32_t low = 0, high = c_.side();
            while (high - low > 1) {
                const std::uint32_t middle = low + (high - low) / 2;
                (c_.place(a, middle) <= coordinates[a] ? low : high) = middle;
            }
            at[a] = low;
        }
        const std::uint32_t leaf = c_.leaf_at(at);
        const auto& leaves = c_.leaf_of_tet();
        const auto [first, last] = std::equal_range(leaves.begin(), leaves.end(), leaf);
        for (auto i = first; i != last; ++i) {
            const ImplicitComplex::Tet& t = c_.tets()[static_cast<std::size_t>(i - leaves.begin())];
            if (is_in_w(t) && holds(t, p)) return w_.part_of_point[t[0]];
        }
        return no_point;
    }
    bool holds(const ImplicitComplex::Tet& t, const Point3& p) const {
        const std::array<Point3, 4> q{point_of(c_.place(t[0])), point_of(c_.place(t[1])), point_of(c_.place(t[2])),
                                      point_of(c_.place(t[3]))};
        const int whole = orientation(q[0], q[1], q[2], q[3]);
        for (std::size_t i = 0; i < 4; ++i) {
            std::array<Point3, 4> r = q;
            r[i] = p;
            if (orientation(r[0], r[1], r[2], r[3]) == -whole) return false;
        }
        return true;
    }

    void locate() {
        std::map<std::uint32_t, std::uint32_t> in_component;  // of W: of the mesh
        for (std::uint32_t i = 0; i < surface_.first_triangle.size(); ++i) {
            const std::uint32_t t = surface_.first_triangle[i];
            const std::uint32_t part = component_around(corners(t)[0]);
            if (part == no_point)
                hinder("the component of " + name(t) + " lies outside W", {t});
            else if (!in_component.emplace(part, i).second)
                hinder("the component of " + name(t) + " lies in the same component of W as another", {t});
        }
        if (!findings_.hindering.empty()) return;
        findings_.faces_positive = !surface_.turned;
        for (const VerifiedComponent& v : w_.components) {
            const std::uint32_t i = in_component.at(v.id);
            const std::uint32_t t = surface_.first_triangle[i];
            if (surface_.genera[i] != v.genus) {
                hinder("the component of " + name(t) + " has another genus than the zero set in its component of W",
                       {t});
                continue;
            }
            const int inside = windings_at(point_of(c_.place(v.inner)), no_point)[i];
            const int outside = windings_at(point_of(c_.place(v.outer)), no_point)[i];
            if (std::abs(inside) != 1 || outside != 0)
                hinder("the component of " + name(t) + " does not separate the sides of its component of W", {t});
            if (inside != -v.inner_sign) findings_.faces_positive = false;
        }
    }

    const TriangleMesh& mesh_;
    const ImplicitComplex& c_;
    const VerifiedW& w_;
    const RunControl& control_;
    ClosedSurface surface_;
    std::vector<std::array<std::uint32_t, 3>> across_;  ///< per triangle and edge
    std::unique_ptr<BoxTree> tree_;
    MeshFindings findings_;
};

}  // namespace

MeshFindings judge_mesh(const TriangleMesh& mesh, const ImplicitComplex& complex, const VerifiedW& w,
                        const RunControl& control) {
    return Judge(mesh, complex, w, control).run();
}

}  // namespace certa::verify
