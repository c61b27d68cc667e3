// The public checker of implicit surfaces: reads function and certificate, decides every condition of
// docs/implicit-theorem.md anew, then the mesh.
//
// Plan: claims of leaves (parallel); signs; replay of the marks; tetrahedra with both signs; frontier faces (parallel);
// degrees of clusters; components of W and of its complement, and the balance between them; the mesh
// (implicit_mesh.cpp).
#include <certa/implicit_mesh.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <set>

#include "core/digest.h"
#include "core/parallel.h"
#include "verify/implicit_clip.h"
#include "verify/implicit_complex.h"
#include "verify/implicit_function.h"
#include "verify/implicit_mesh.h"
#include "verify/implicit_product.h"
#include "verify/report.h"
#include "verify/surface_distance.h"
#include "verify/surface_in_w.h"

namespace certa::verify {
namespace {

using Tet = ImplicitComplex::Tet;

/// Disjoint sets.
class Parts {
public:
    explicit Parts(std::size_t count) : up_(count) { std::iota(up_.begin(), up_.end(), 0u); }
    std::uint32_t of(std::uint32_t i) {
        while (up_[i] != i) i = up_[i] = up_[up_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) { up_[of(a)] = of(b); }

private:
    std::vector<std::uint32_t> up_;
};

class Check {
public:
    Check(const ImplicitFunction& function, const ImplicitComplex& complex, const RunControl& control,
          ImplicitCheck& result)
        : function_(function), c_(complex), control_(control), result_(result), marked_(complex.points().size(), 0) {}

    void run() {
        if (!c_.contradiction.empty()) add(c_.contradiction);
        check_leaves();
        index_stars();
        replay_marks();
        check_mixed();
        check_frontier();
        if (result_.violation_count == 0) check_balance();
    }
    /// W and its components, for judging meshes; to be called once, after a run without violations.
    VerifiedW verified() {
        VerifiedW w;
        w.marked = std::move(marked_);
        w.part_of_point = std::move(part_);
        w.components = std::move(verified_);
        return w;
    }

private:
    void add(const std::string& text) {
        ++result_.violation_count;
        if (result_.violations.size() < 100) result_.violations.push_back(text);
    }
    std::string show_leaf(const ClaimedLeaf& leaf) const {
        const BoxOfDoubles box =
            c_.box(leaf.low, {leaf.low[0] + leaf.size, leaf.low[1] + leaf.size, leaf.low[2] + leaf.size});
        return "the leaf from " + show(Point3{box.low[0], box.low[1], box.low[2]}) + " to " +
               show(Point3{box.high[0], box.high[1], box.high[2]});
    }
    std::string show_point(std::uint32_t p) const {
        const auto at = c_.place(p);
        return show(Point3{at[0], at[1], at[2]});
    }

    void check_leaves() {
        std::vector<std::string> problems(c_.leaves().size());
        core::parallel_for(c_.leaves().size(), 64, control_, [&](std::size_t begin, std::size_t end) {
            Enclosures enclosures(function_);
            for (std::size_t i = begin; i < end && !control_.cancelled(); ++i)
                problems[i] = problem_of(c_.leaves()[i], enclosures);
        });
        for (const std::string& problem : problems) {
            if (!problem.empty()) add(problem);
        }
        if (control_.cancelled()) add("the check was cancelled");
        result_.leaves_checked = c_.leaves().size();
    }

    std::string problem_of(const ClaimedLeaf& leaf, Enclosures& enclosures) const {
        const Lattice high{leaf.low[0] + leaf.size, leaf.low[1] + leaf.size, leaf.low[2] + leaf.size};
        const BoxOfDoubles box = c_.box(leaf.low, high);
        if (leaf.sign == 0 && leaf.slope == 0) return show_leaf(leaf) + " claims nothing";
        const unsigned touched = c_.box_faces(leaf.low) | c_.box_faces(high);
        if (leaf.sign == 0 && touched != 0 && !c_.is_clipped())
            return show_leaf(leaf) + " touches the box and claims no sign";
        if (c_.is_clipped() && leaf.slope != 0 && ((touched >> (2 * leaf.axis)) & 3u) != 0)
            return show_leaf(leaf) + " claims a slope across a face of the box that it touches";
        if (leaf.sign != 0 && !enclosures.proves_sign(box, leaf.sign))
            return "the sign of f is not proved on " + show_leaf(leaf);
        if (leaf.slope != 0 && !enclosures.proves_slope(box, leaf.axis, leaf.slope))
            return "the slope of f is not proved on " + show_leaf(leaf);
        return {};
    }

    /// The tetrahedra around each point that is to be marked.
    void index_stars() {
        std::vector<char> wanted(c_.points().size(), 0);
        for (const std::uint32_t p : c_.marks) wanted[p] = 1;
        star_first_.assign(c_.points().size() + 1, 0);
        for (const Tet& t : c_.tets()) {
            for (const std::uint32_t p : t) star_first_[p + 1] += wanted[p] ? 1 : 0;
        }
        std::partial_sum(star_first_.begin(), star_first_.end(), star_first_.begin());
        star_.resize(star_first_.back());
        std::vector<std::uint32_t> next(star_first_.begin(), star_first_.end() - 1);
        for (std::uint32_t i = 0; i < c_.tets().size(); ++i) {
            for (const std::uint32_t p : c_.tets()[i]) {
                if (wanted[p]) star_[next[p]++] = i;
            }
        }
    }

    void replay_marks() {
        place_in_link_.assign(c_.points().size() + 1, nowhere);
        for (const std::uint32_t p : c_.marks) {
            if (marked_[p]) add("a point is marked twice: " + show_point(p));
            if (!may_join(p)) add("a mark adds no cone over a contractible set, at " + show_point(p));
            marked_[p] = 1;
        }
        result_.marks_checked = c_.marks.size();
    }

    /// The link of p falls into points of the other sign or marked, and the rest: each must be non-empty and connected.
    bool may_join(std::uint32_t p) {
        const unsigned faces = c_.box_faces(c_.points()[p]);
        if (faces != 0 && !c_.is_clipped()) return false;
        link_edges_.clear();
        for (std::uint32_t k = star_first_[p]; k < star_first_[p + 1]; ++k) {
            if (c_.leaves()[c_.leaf_of_tet()[star_[k]]].is_critical()) return false;
            const Tet& t = c_.tets()[star_[k]];
            for (std::size_t i = 0; i < 4; ++i) {
                for (std::size_t j = i + 1; j < 4; ++j) {
                    if (t[i] != p && t[j] != p) link_edges_.emplace_back(t[i], t[j]);
                }
            }
        }
        // On the boundary of a box that clips, the link is a disk; a point that is not inside is joined to its rim.
        const auto inside = [&](std::uint32_t a) {
            return a != ImplicitComplex::no_point && (c_.sign[a] != c_.sign[p] || marked_[a] != 0);
        };
        if (faces != 0 &&
            !close_rim(c_, p, {star_.data() + star_first_[p], star_.data() + star_first_[p + 1]}, inside, link_edges_))
            return false;
        return has_two_parts(inside);
    }

    /// Whether the points of the link's edges that are inside are one part, and those that are not another.
    template <class Inside>
    bool has_two_parts(const Inside& inside) {
        const auto slot_of = [&](std::uint32_t a) -> std::uint32_t& {
            return place_in_link_[a == ImplicitComplex::no_point ? c_.points().size() : a];
        };
        link_.clear();
        for (const auto& [a, b] : link_edges_) {
            for (const std::uint32_t end : {a, b}) {
                if (slot_of(end) != nowhere) continue;
                slot_of(end) = static_cast<std::uint32_t>(link_.size());
                link_.push_back({end, slot_of(end), inside(end)});
            }
        }
        const auto root = [&](std::uint32_t i) {
            while (link_[i].up != i) i = link_[i].up = link_[link_[i].up].up;
            return i;
        };
        int parts[2] = {0, 0};
        for (const LinkPoint& point : link_) ++parts[point.inside ? 1 : 0];
        for (const auto& [a, b] : link_edges_) {
            const std::uint32_t i = root(slot_of(a)), j = root(slot_of(b));
            if (i == j || link_[i].inside != link_[j].inside) continue;
            link_[i].up = j;
            --parts[link_[j].inside ? 1 : 0];
        }
        for (const LinkPoint& point : link_) slot_of(point.id) = nowhere;
        return parts[0] == 1 && parts[1] == 1;
    }

    bool is_mixed(const Tet& t) const {
        return std::any_of(t.begin(), t.end(), [&](std::uint32_t p) { return c_.sign[p] != c_.sign[t[0]]; });
    }

    void check_mixed() {
        for (const Tet& t : c_.tets()) {
            if (!is_mixed(t)) continue;
            for (const std::uint32_t p : t) {
                if (!marked_[p]) {
                    add("a tetrahedron with both signs is not in W, at " + show_point(p));
                    break;
                }
            }
        }
    }

    void check_frontier() {
        // The largest marked face of each tetrahedron outside W; of fewer than three points, the last one repeats.
        std::vector<std::array<std::uint32_t, 3>> list;
        for (std::size_t i = 0; i < c_.tets().size(); ++i) {
            if (c_.leaves()[c_.leaf_of_tet()[i]].sign != 0) continue;  // proved with the leaf
            std::array<std::uint32_t, 3> face{};
            std::size_t count = 0;
            for (const std::uint32_t p : c_.tets()[i]) {
                if (!marked_[p]) continue;
                if (count < 3) face[count] = p;
                ++count;
            }
            if (count == 0 || count == 4 || is_mixed(c_.tets()[i])) continue;
            for (; count < 3; ++count) face[count] = face[count - 1];
            std::sort(face.begin(), face.end());
            list.push_back(face);
        }
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        std::vector<char> holds(list.size(), 0);
        core::parallel_for(list.size(), 64, control_, [&](std::size_t begin, std::size_t end) {
            Enclosures enclosures(function_);
            for (std::size_t i = begin; i < end && !control_.cancelled(); ++i) {
                Lattice low = c_.points()[list[i][0]], high = low;
                for (const std::uint32_t p : list[i]) {
                    for (std::size_t a = 0; a < 3; ++a) {
                        low[a] = std::min(low[a], c_.points()[p][a]);
                        high[a] = std::max(high[a], c_.points()[p][a]);
                    }
                }
                holds[i] = enclosures.proves_sign(c_.box(low, high), c_.sign[list[i][0]]) ? 1 : 0;
            }
        });
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (!holds[i]) add("the sign of f is not proved on a face of W, at " + show_point(list[i][0]));
        }
    }

    // ---- Degrees ----------------------------------------------------------------------------------------------------

    /// Critical leaves that share a point of T; each cluster with its squares.
    void check_balance() {
        Parts clusters(c_.points().size());
        std::vector<char> of_critical(c_.points().size(), 0);
        for (std::size_t i = 0; i < c_.tets().size(); ++i) {
            if (!c_.leaves()[c_.leaf_of_tet()[i]].is_critical()) continue;
            for (const std::uint32_t p : c_.tets()[i]) {
                clusters.join(p, c_.tets()[i][0]);
                of_critical[p] = 1;
            }
        }
        std::map<std::uint32_t, std::vector<SlopeTriangle>> boundaries;  // per cluster
        collect_boundaries(clusters, of_critical, boundaries);
        find_regions();
        std::map<std::uint32_t, long> degree_of_region;
        for (const auto& [cluster, triangles] : boundaries) {
            const std::uint32_t region = part_[cluster];
            if (c_.is_clipped())
                degree_of_region[region] += degree_of(unfolded(c_, triangles));
            else if (region != outside_)
                degree_of_region[region] += 8 * degree_of(triangles);
        }
        balance(degree_of_region);
    }

    /// Each tetrahedron has one triangle on the surface of its leaf: the one without the leaf's centre.
    void collect_boundaries(Parts& clusters, const std::vector<char>& of_critical,
                            std::map<std::uint32_t, std::vector<SlopeTriangle>>& boundaries) {
        struct OnSurface {
            std::array<std::uint32_t, 3> key;
            std::uint32_t tet;
            bool operator<(const OnSurface& o) const { return key != o.key ? key < o.key : tet < o.tet; }
        };
        std::vector<OnSurface> all;
        for (std::uint32_t i = 0; i < c_.tets().size(); ++i) {
            const Tet& t = c_.tets()[i];
            if (!of_critical[t[1]] || !of_critical[t[2]] || !of_critical[t[3]]) continue;
            all.push_back({{t[1], t[2], t[3]}, i});
            std::sort(all.back().key.begin(), all.back().key.end());
        }
        std::sort(all.begin(), all.end());
        const auto leaf_of = [&](const OnSurface& s) -> const ClaimedLeaf& {
            return c_.leaves()[c_.leaf_of_tet()[s.tet]];
        };
        for (std::size_t i = 0; i + 1 < all.size(); ++i) {
            if (all[i].key != all[i + 1].key) continue;
            const bool first = leaf_of(all[i]).is_critical(), second = leaf_of(all[i + 1]).is_critical();
            if (first == second) continue;
            const Tet& t = c_.tets()[all[first ? i : i + 1].tet];
            const ClaimedLeaf& regular = leaf_of(all[first ? i + 1 : i]);
            // (t1, t2, t3) is counter-clockwise seen from outside the critical leaf, its centre t0 being behind.
            boundaries[clusters.of(t[0])].push_back({{t[1], t[2], t[3]}, regular.axis, regular.slope});
        }
    }

    /// What the triangles around an edge say of it: how often the boundary of P runs along it, from the lower to the
    /// higher point, and the signs of the first two derivatives.
    struct SlopeEdge {
        std::uint32_t low, high;
        long times;
        int x, y;
    };

    /// The degree by the preimages of -z: triangles with slope (z, -) make P; on its boundary, crossings of x > 0 make
    /// A; ends of A with y > 0 count. The orientation around -z is the opposite of that around +z, hence the sign.
    long degree_of(const std::vector<SlopeTriangle>& triangles) {
        std::vector<SlopeEdge> edges;
        for (const SlopeTriangle& t : triangles) {
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t a = t.corners[i], b = t.corners[(i + 1) % 3];
                const long times = t.axis == 2 && t.slope < 0 ? (a < b ? 1 : -1) : 0;
                edges.push_back(
                    {std::min(a, b), std::max(a, b), times, t.axis == 0 ? t.slope : 0, t.axis == 1 ? t.slope : 0});
            }
        }
        std::sort(edges.begin(), edges.end(), [](const SlopeEdge& a, const SlopeEdge& b) {
            return a.low != b.low ? a.low < b.low : a.high < b.high;
        });
        std::map<std::uint32_t, long> ends;
        std::map<std::uint32_t, int> y_at;
        for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
            SlopeEdge edge = edges[i];
            for (next = i + 1; next < edges.size() && edges[next].low == edge.low && edges[next].high == edge.high;
                 ++next) {
                edge.times += edges[next].times;
                if (edges[next].x != 0) edge.x = edges[next].x;
                if (edges[next].y != 0) edge.y = edges[next].y;
            }
            if (edge.times == 0) continue;
            if (edge.x == 0 && edge.y == 0) add("the boundary of a cluster is not covered by slopes");
            if (edge.x > 0) {
                ends[edge.high] += edge.times;
                ends[edge.low] -= edge.times;
            }
            if (edge.x == 0) y_at[edge.low] = y_at[edge.high] = edge.y;
        }
        long degree = 0;
        for (const auto& [point, times] : ends) {
            if (times == 0) continue;
            const auto found = y_at.find(point);
            if (found == y_at.end())
                add("the boundary of a cluster is not covered by slopes");
            else if (found->second > 0)
                degree -= times;
        }
        return degree;
    }

    // ---- Regions and components -------------------------------------------------------------------------------------

    /// Components of W beside those of its complement.
    void find_regions() {
        Parts parts(c_.points().size());
        for (const Tet& t : c_.tets()) {
            std::uint32_t last[2] = {ImplicitComplex::no_point, ImplicitComplex::no_point};
            for (const std::uint32_t p : t) {
                std::uint32_t& before = last[marked_[p] ? 1 : 0];
                if (before != ImplicitComplex::no_point) parts.join(p, before);
                before = p;
            }
        }
        part_.resize(c_.points().size());
        for (std::uint32_t p = 0; p < part_.size(); ++p) part_[p] = parts.of(p);
        outside_ = part_[c_.find({0, 0, 0})];
    }

    struct Component {
        long euler8 = 0;  ///< of eight copies of the surface, reflected at the faces of the box
        long tets = 0, edge_points = 0, loops = 0;
        std::set<std::uint32_t> regions;
        /// Points in faces of the box are in half as many copies, those on edges in a quarter; loops have as many
        /// points on edges as open arcs between them.
        long euler() const { return (euler8 + 2 * edge_points) / 8; }
        long genus() const { return (2 - loops - euler()) / 2; }
        bool is_integral() const { return (euler8 + 2 * edge_points) % 8 == 0 && (loops + euler()) % 2 == 0; }
    };

    using MixedEdges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

    void balance(const std::map<std::uint32_t, long>& degree_of_region) {
        std::map<std::uint32_t, Component> components;
        std::map<std::uint32_t, int> sign_of_region;
        for (std::uint32_t p = 0; p < part_.size(); ++p) {
            if (part_[p] != p) continue;  // one point of each part
            if (marked_[p])
                components[p];
            else
                sign_of_region[p] = c_.sign[p];
        }
        MixedEdges mixed_edges;
        for (const Tet& t : c_.tets()) note(t, components, mixed_edges);
        std::sort(mixed_edges.begin(), mixed_edges.end());
        mixed_edges.erase(std::unique(mixed_edges.begin(), mixed_edges.end()), mixed_edges.end());
        for (const auto& [a, b] : mixed_edges) {
            const auto faces =
                c_.is_clipped() ? std::popcount(c_.box_faces(c_.points()[a]) & c_.box_faces(c_.points()[b])) : 0;
            components.at(part_[a]).euler8 += 8 >> faces;
            components.at(part_[a]).edge_points += faces == 2 ? 1 : 0;
        }
        if (c_.is_clipped()) {
            for (const std::uint32_t p : loops_in_box_faces(c_)) ++components.at(part_[p]).loops;
        }
        std::set<std::uint32_t> done;
        for (auto& [id, component] : components) {
            if (component.regions.size() != 2 || component.tets == 0) {
                add("a component of W does not have two sides, at " + show_point(id));
                return;
            }
        }
        inwards(outside_, ImplicitComplex::no_point, components, degree_of_region, sign_of_region, done);
        if (done.size() != components.size()) add("a component of W is not reached from the outside");
        std::sort(forms_.begin(), forms_.end());
        for (const auto& [genus, loops] : forms_) {
            result_.genera.push_back(genus);
            if (c_.is_clipped()) result_.loops.push_back(loops);
        }
    }

    void note(const Tet& t, std::map<std::uint32_t, Component>& components, MixedEdges& mixed_edges) {
        std::uint32_t inside = ImplicitComplex::no_point, region = inside;
        int positive = 0;
        for (const std::uint32_t p : t) {
            (marked_[p] ? inside : region) = part_[p];
            positive += c_.sign[p] > 0 ? 1 : 0;
        }
        if (inside == ImplicitComplex::no_point) return;
        Component& component = components.at(inside);
        if (region != ImplicitComplex::no_point) component.regions.insert(region);
        if (positive == 0 || positive == 4) return;
        ++component.tets;
        component.euler8 += 8 - 4 * (positive == 2 ? 4 : 3);
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = i + 1; j < 4; ++j) {
                if (c_.sign[t[i]] != c_.sign[t[j]]) mixed_edges.push_back(std::minmax(t[i], t[j]));
            }
        }
    }

    /// The degree of everything inside the components that bound a region from within it; checks each on the way.
    long inwards(std::uint32_t region, std::uint32_t around, std::map<std::uint32_t, Component>& components,
                 const std::map<std::uint32_t, long>& degree_of_region,
                 const std::map<std::uint32_t, int>& sign_of_region, std::set<std::uint32_t>& done) {
        long degree = degree_of_region.count(region) != 0 ? degree_of_region.at(region) : 0;
        for (auto& [id, component] : components) {
            if (id == around || component.regions.count(region) == 0) continue;
            if (!done.insert(id).second) {
                add("a component of W is reached twice");
                return degree;
            }
            const std::uint32_t inner =
                *component.regions.begin() == region ? *component.regions.rbegin() : *component.regions.begin();
            const long inside = inwards(inner, id, components, degree_of_region, sign_of_region, done);
            if (2 * inside != -sign_of_region.at(inner) * component.euler8 || !component.is_integral())
                add("the degree " + std::to_string(inside) + "/8 does not match the Euler characteristic " +
                    std::to_string(component.euler8) + "/8, at " + show_point(id));
            forms_.emplace_back(component.genus(), component.loops);
            verified_.push_back(
                {id, static_cast<int>(component.genus()), sign_of_region.at(inner), inner, region, around});
            degree += inside;
        }
        return degree;
    }

    const ImplicitFunction& function_;
    const ImplicitComplex& c_;
    const RunControl& control_;
    ImplicitCheck& result_;
    std::vector<char> marked_;
    std::vector<std::uint32_t> star_first_, star_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> link_edges_;
    struct LinkPoint {
        std::uint32_t id, up;
        bool inside;
    };
    std::vector<LinkPoint> link_;
    static constexpr std::uint32_t nowhere = 0xffffffffu;
    std::vector<std::uint32_t> place_in_link_;  ///< per point, and one for the cone over a rim
    std::vector<std::uint32_t> part_;  ///< per point: component of W or of its complement, by one of its points
    std::uint32_t outside_ = 0;
    std::vector<VerifiedComponent> verified_;
    std::vector<std::pair<int, int>> forms_;  ///< genus and loops of each component
};

void add_to(ImplicitCheck& result, std::string problem) {
    ++result.violation_count;
    if (result.violations.size() < 100) result.violations.push_back(std::move(problem));
}

void check_claimed_distance(const TriangleMesh& mesh, const ImplicitFunction& function,
                            const ImplicitCertificate& certificate, const ImplicitComplex& complex,
                            const MeshFindings& found, const RunControl& control, ImplicitCheck& result) {
    if (!found.refuting.empty() || !found.hindering.empty() || !found.faces_positive) return;  // a violation anyway
    const double bound =
        std::ldexp(static_cast<double>(certificate.hausdorff[0]), static_cast<int>(certificate.hausdorff[1]));
    const DistanceQuestion question{mesh, bound, function, complex, found.frontier, found.component_of_triangle};
    for (std::string& problem : check_distance(question, control)) add_to(result, std::move(problem));
    if (result.violation_count == 0) result.hausdorff = bound;
}

/// Verifies W; a mesh whose vertices the certificate does not place on edges of T, or `any` mesh, is judged by what it
/// is.
MeshFindings check(const TriangleMesh& mesh, const ImplicitFunction& function, const ImplicitCertificate& certificate,
                   bool any, bool either_way, const RunControl& control, ImplicitCheck& result) {
    if (!any && !certificate.mesh.empty() && certificate.mesh != core::digest_of(mesh)) {
        add_to(result, "the mesh is not the one that the certificate was made for: its digest is another");
        return {};
    }
    const ImplicitComplex complex(certificate);
    Check check(function, complex, control, result);
    check.run();
    const std::vector<std::int64_t> genera(result.genera.begin(), result.genera.end());
    const std::vector<std::int64_t> loops(result.loops.begin(), result.loops.end());
    if (result.violation_count == 0 && (genera != certificate.genera || loops != certificate.loops))
        add_to(result, "the certificate names other genera");
    result.triangles_checked = mesh.triangles.size();
    result.isotopic = !certificate.clip;
    if (any || (certificate.vertex_edges.empty() && !mesh.triangles.empty())) {
        if (result.violation_count != 0) return {};
        if (certificate.clip) {
            add_to(result, "the certificate of a clipped surface is for the mesh that it names the vertices of");
            return {};
        }
        MeshFindings found = judge_mesh(mesh, complex, check.verified(), control);
        if (!any && !certificate.hausdorff.empty())
            check_claimed_distance(mesh, function, certificate, complex, found, control, result);
        return found;
    }
    if (!certificate.hausdorff.empty()) add_to(result, "a distance is claimed of a mesh that is not judged as a whole");
    for (std::string& problem : check_mesh_on_complex(mesh, complex, certificate, either_way))
        add_to(result, std::move(problem));
    MeshFindings on_edges;
    on_edges.faces_positive = true;
    return on_edges;
}

/// The part of a mesh between two vertices and two triangles. Errors: UnreadableCertificate where it is no mesh.
TriangleMesh part_of(const TriangleMesh& mesh, std::size_t vertex, std::size_t vertex_end, std::size_t triangle,
                     std::size_t triangle_end) {
    TriangleMesh part;
    if (vertex_end > mesh.positions.size() || triangle_end > mesh.triangles.size())
        throw UnreadableCertificate("it is for a mesh with more vertices or triangles");
    part.positions.assign(mesh.positions.begin() + static_cast<std::ptrdiff_t>(vertex),
                          mesh.positions.begin() + static_cast<std::ptrdiff_t>(vertex_end));
    for (; triangle < triangle_end; ++triangle) {
        Triangle corners = mesh.triangles[triangle];
        for (VertexId& v : corners) {
            if (index_of(v) < vertex || index_of(v) >= vertex_end)
                throw UnreadableCertificate("the meshes of its factors do not follow each other");
            v = VertexId{static_cast<std::uint32_t>(index_of(v) - vertex)};
        }
        part.triangles.push_back(corners);
    }
    return part;
}

/// Every factor by its certificate on its part of the mesh; constants are not 0; no two factors have a common zero.
void check_product(const TriangleMesh& mesh, const ImplicitFunction& function,
                   const ImplicitProductCertificate& certificate, const RunControl& control, ImplicitCheck& result) {
    const ImplicitFunction::Factors factors = function.factors();
    if (factors.variable.size() != certificate.factors.size())
        return add_to(result, "the function has another number of factors than the certificate");
    const ImplicitCertificate& first = certificate.factors.front();
    const BoxOfDoubles box = box_of(first);
    std::vector<ImplicitFunction> functions;
    for (const std::uint32_t step : factors.variable) functions.push_back(function.ending_at(step));
    for (const std::uint32_t step : factors.constant) {
        const ImplicitFunction constant = function.ending_at(step);
        if (!Enclosures(constant).misses_zero(box)) add_to(result, "a constant factor is not proved to differ from 0");
    }
    std::vector<std::pair<int, int>> forms;
    std::size_t vertex = 0, triangle = 0, surfaces = 0;
    for (std::size_t k = 0; k < functions.size(); ++k) {
        const ImplicitCertificate& own = certificate.factors[k];
        if (own.first != first.first || own.count != first.count || own.exponent != first.exponent ||
            own.clip != first.clip)
            return add_to(result, "the factors are certified in different boxes");
        if (certificate.vertices[k] < 0 || certificate.triangles[k] < 0)
            return add_to(result, "the certificate counts vertices or triangles below 0");
        const std::size_t vertex_end = vertex + static_cast<std::size_t>(certificate.vertices[k]),
                          triangle_end = triangle + static_cast<std::size_t>(certificate.triangles[k]);
        ImplicitCheck factor;
        const MeshFindings found = check(part_of(mesh, vertex, vertex_end, triangle, triangle_end), functions[k], own,
                                         false, true, control, factor);
        const auto note = [&](const std::vector<std::string>& reasons) {
            for (const std::string& reason : reasons) add_to(result, "factor " + std::to_string(k + 1) + ": " + reason);
        };
        note(factor.violations);
        note(found.refuting);
        note(found.hindering);
        for (std::size_t c = 0; c < factor.genera.size(); ++c)
            forms.emplace_back(factor.genera[c], own.clip ? factor.loops[c] : 0);
        surfaces += factor.genera.empty() ? 0 : 1;
        result.leaves_checked += factor.leaves_checked;
        result.marks_checked += factor.marks_checked;
        vertex = vertex_end;
        triangle = triangle_end;
    }
    if (vertex != mesh.positions.size() || triangle != mesh.triangles.size())
        add_to(result, "the mesh has vertices or triangles of no factor");
    for (std::size_t i = 0; i < functions.size(); ++i) {
        for (std::size_t j = i + 1; j < functions.size() && result.violation_count == 0; ++j) {
            if (std::string problem = check_apart(functions[i], functions[j], box, control); !problem.empty())
                add_to(result, std::move(problem));
        }
    }
    std::sort(forms.begin(), forms.end());
    for (const auto& [genus, loops] : forms) {
        result.genera.push_back(genus);
        if (first.clip) result.loops.push_back(loops);
    }
    result.triangles_checked = mesh.triangles.size();
    result.isotopic = surfaces < 2 && !first.clip;
}

/// Verifies a mesh by a certificate of either kind.
MeshFindings check(const TriangleMesh& mesh, std::string_view text, std::string_view certificate, bool any,
                   const RunControl& control, ImplicitCheck& result) {
    const ImplicitFunction function(text);
    if (!is_product_certificate(certificate))
        return check(mesh, function, read_certificate(certificate), any, false, control, result);
    if (any) {
        add_to(result, "the certificate of a product is for its own mesh");
    } else {
        check_product(mesh, function, read_product_certificate(certificate), control, result);
    }
    MeshFindings own;
    own.faces_positive = true;
    return own;
}

/// What cannot be read is a violation.
template <class Body>
void reading(ImplicitCheck& result, const Body& body) {
    try {
        body();
    } catch (const UnreadableFunction& error) {
        add_to(result, std::string("the function cannot be read: ") + error.what());
    } catch (const UnreadableCertificate& error) {
        add_to(result, std::string("the certificate cannot be read: ") + error.what());
    }
}

}  // namespace
}  // namespace certa::verify

namespace certa {

ImplicitCheck check_implicit(const TriangleMesh& mesh, std::string_view function, std::string_view certificate,
                             const RunControl& control) {
    ImplicitCheck result;
    verify::reading(result, [&] {
        verify::MeshFindings found = verify::check(mesh, function, certificate, false, control, result);
        for (std::string& reason : found.refuting) verify::add_to(result, std::move(reason));
        for (std::string& reason : found.hindering) verify::add_to(result, std::move(reason));
        if (result.ok() && !found.faces_positive) verify::add_to(result, "the mesh faces the negative side of f");
    });
    if (result.ok()) {
        result.verdict = result.genera.empty() ? ImplicitVerdict::empty : ImplicitVerdict::certified;
        result.isotopic = result.isotopic || result.genera.empty();
    } else {
        result.genera.clear();
        result.loops.clear();
        result.isotopic = false;
        result.hausdorff.reset();
    }
    return result;
}

ImplicitMeshCheck judge_implicit_mesh(const TriangleMesh& mesh, std::string_view function, std::string_view certificate,
                                      const RunControl& control) {
    ImplicitCheck check;
    verify::MeshFindings found;
    verify::reading(check, [&] { found = verify::check(mesh, function, certificate, true, control, check); });
    ImplicitMeshCheck result;
    result.leaves_checked = check.leaves_checked;
    result.marks_checked = check.marks_checked;
    result.mesh_genera = std::move(found.genera);
    for (const std::uint32_t t : found.triangles) {
        if (result.triangles.size() < 1000) result.triangles.push_back(t);
    }
    result.triangle_count = found.triangles.size();
    result.surface_known = check.ok();
    if (!check.ok()) {
        result.reasons = std::move(check.violations);
        return result;
    }
    result.surface_genera = std::move(check.genera);
    result.faces_positive = found.faces_positive;
    result.verdict = !found.refuting.empty()    ? ImplicitMeshVerdict::refuted
                     : !found.hindering.empty() ? ImplicitMeshVerdict::undecided
                                                : ImplicitMeshVerdict::certified;
    result.reasons = !found.refuting.empty() ? std::move(found.refuting) : std::move(found.hindering);
    return result;
}

const char* name_of(ImplicitMeshVerdict verdict) {
    switch (verdict) {
        case ImplicitMeshVerdict::certified:
            return "certified";
        case ImplicitMeshVerdict::refuted:
            return "refuted";
        default:
            return "undecided";
    }
}

}  // namespace certa
