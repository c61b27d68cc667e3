// Conforming, second half, and faithful: the triangles of every facet tile it.
//
// Project along the facet's normal. If every triangle is positively oriented, the number of triangles over a point x is
// the winding number around x of the triangles' boundary chain. The chain is compared, edge by edge and with
// orientation, with the chains of the segments that the facet lies on one side of (Plc derives the side from the rings
// and hole points). The chains are graphs over their segments within `deviation` (check_segments), so for every x
// farther than that from the sides the number is the winding number of the facet's own boundary: 1 in the facet, 0
// outside. So the triangles cover the facet exactly once, without gap. Sides that the facet lies on both sides of,
// isolated segments included, have to be edges of two triangles, and its isolated points vertices. Triangles are faces
// of tetrahedra, and distinct, so they do not cross each other either.
#include <algorithm>
#include <atomic>

#include "verify/distance.h"
#include "verify/parallel.h"
#include "verify/subject.h"

namespace certa::verify {
namespace {

constexpr std::size_t told_per_facet = 5;

/// Triangles by facet label.
struct TrianglesByFacet {
    std::vector<std::uint64_t> offsets;
    std::vector<std::uint32_t> triangles;

    TrianglesByFacet(const Subject& subject) : offsets(subject.plc.facet_count() + 1, 0) {
        if (!subject.triangle_labels) return;
        const auto& labels = subject.mesh.triangle_facets;
        for (const FacetId f : labels) {
            if (index_of(f) < subject.plc.facet_count()) ++offsets[index_of(f) + 1];
        }
        for (std::size_t f = 1; f < offsets.size(); ++f) offsets[f] += offsets[f - 1];
        triangles.resize(offsets.back());
        std::vector<std::uint64_t> next(offsets.begin(), offsets.end() - 1);
        for (std::uint32_t i = 0; i < labels.size(); ++i) {
            if (index_of(labels[i]) < subject.plc.facet_count()) triangles[next[index_of(labels[i])]++] = i;
        }
    }
};

/// What is found and expected at one undirected edge a < b of a facet.
struct EdgeCount {
    std::uint32_t a = 0, b = 0;
    std::uint32_t segment = no_index;  // whose chain it is part of
    int forward = 0, backward = 0;     // triangles that run from a to b, from b to a
    int expected = 0;                  // forward - backward
    bool inner = false;                // one each expected
};

class FacetCheck {
public:
    FacetCheck(const Subject& subject, const Chains& chains, const TrianglesByFacet& by_facet, std::uint32_t facet,
               Findings& findings)
        : subject_(subject), chains_(chains), facet_(facet), findings_(findings) {
        begin_ = by_facet.triangles.data() + by_facet.offsets[facet];
        end_ = by_facet.triangles.data() + by_facet.offsets[facet + 1];
    }

    /// Returns the largest distance of a Steiner vertex inside the facet from its plane.
    double run() {
        if (subject_.plc.leaders[facet_] != facet_) {
            if (begin_ != end_) {
                add(Promise::labelled, triangle_ref(*begin_), subject_.mesh.triangles[*begin_][0],
                    show("triangle", *begin_) + " is labelled with " + name() + ", which is merged into " +
                        show("facet", subject_.plc.leaders[facet_]));
            }
            return 0.0;
        }
        collect_vertices();
        check_boundary();
        check_points();
        if (is_itself()) return 0.0;
        const NewellNormal normal = facet_normal(subject_.complex, facet_);
        check_orientation(normal);
        return check_distances(normal);
    }

private:
    std::string name() const { return show("facet", facet_); }
    void add(Promise promise, ElementRef element, VertexId place, std::string message) {
        add(promise, element, index_of(place), std::move(message));
    }
    void add(Promise promise, ElementRef element, std::uint32_t place, std::string message) {
        if (++told_ > told_per_facet) return;
        findings_.add(promise, {facet_ref(facet_), element}, subject_.at(place), std::move(message));
    }
    const Triangle& triangle(const std::uint32_t* i) const { return subject_.mesh.triangles[*i]; }

    void collect_vertices() {
        for (const std::uint32_t* i = begin_; i != end_; ++i) {
            for (const VertexId v : triangle(i)) vertices_.push_back(index_of(v));
        }
        std::sort(vertices_.begin(), vertices_.end());
        vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    }
    bool has_vertex(std::uint32_t v) const { return std::binary_search(vertices_.begin(), vertices_.end(), v); }

    /// A triangle that is its own only triangle: oriented and in the plane, being a face of positive tetrahedra.
    bool is_itself() const {
        const PiecewiseLinearComplex& c = subject_.complex;
        const std::uint32_t ring = first_ring(c, facet_);
        if (end_ - begin_ != 1 || ring == no_index ||
            subject_.plc.point_offsets[facet_ + 1] - subject_.plc.point_offsets[facet_] != 3) {
            return false;
        }
        const std::uint32_t first = c.polygon_offsets[ring];
        if (c.polygon_offsets[ring + 1] - first != 3) return false;
        const Triangle &t = triangle(begin_), r{c.corners[first], c.corners[first + 1], c.corners[first + 2]};
        return t == r || t == Triangle{r[1], r[2], r[0]} || t == Triangle{r[2], r[0], r[1]};
    }

    void collect_edges() {
        for (const std::uint32_t* i = begin_; i != end_; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = index_of(triangle(i)[k]), b = index_of(triangle(i)[(k + 1) % 3]);
                edges_.push_back({std::min(a, b), std::max(a, b), no_index, a < b ? 1 : 0, a < b ? 0 : 1});
            }
        }
        for (std::uint64_t i = subject_.plc.side_offsets[facet_]; i < subject_.plc.side_offsets[facet_ + 1]; ++i) {
            const PlcSide& side = subject_.plc.sides[i];
            if (chains_.size(side.segment) == 0) broken_ = true;
            const std::uint32_t* chain = chains_.begin(side.segment);
            for (std::size_t k = 0; k + 1 < chains_.size(side.segment); ++k) {
                const std::uint32_t a = chain[k], b = chain[k + 1];
                edges_.push_back(
                    {std::min(a, b), std::max(a, b), side.segment, 0, 0, a < b ? side.cover : -side.cover, side.inner});
            }
        }
        std::sort(edges_.begin(), edges_.end(),
                  [](const EdgeCount& l, const EdgeCount& r) { return l.a != r.a ? l.a < r.a : l.b < r.b; });
        std::size_t kept = 0;
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            if (kept > 0 && edges_[kept - 1].a == edges_[i].a && edges_[kept - 1].b == edges_[i].b) {
                EdgeCount& e = edges_[kept - 1];
                e.forward += edges_[i].forward;
                e.backward += edges_[i].backward;
                e.expected += edges_[i].expected;
                e.inner = e.inner || edges_[i].inner;
                if (e.segment == no_index) e.segment = edges_[i].segment;
            } else {
                edges_[kept++] = edges_[i];
            }
        }
        edges_.resize(kept);
    }

    void check_boundary() {
        if (begin_ == end_) {
            const std::uint64_t first = subject_.plc.point_offsets[facet_];
            if (first == subject_.plc.point_offsets[facet_ + 1]) return;  // a facet without corners
            add(Promise::conforming, facet_ref(facet_), subject_.plc.points[first],
                "no triangle is labelled with " + name());
            return;
        }
        collect_edges();
        if (broken_) {
            add(Promise::conforming, facet_ref(facet_), vertices_[0],
                name() + " cannot be compared with its boundary: a side of it is no chain of mesh edges");
            return;
        }
        for (const EdgeCount& e : edges_) {
            const std::string edge = "the edge of " + show_vertices({e.a, e.b});
            const ElementRef element = e.segment == no_index ? vertex_ref(e.a) : segment_ref(e.segment);
            const std::string of = e.segment == no_index ? "" : " in " + show("segment", e.segment);
            if (e.forward > 1 || e.backward > 1) {
                add(Promise::faithful, element, e.a,
                    name() + " is covered more than once: " + std::to_string(e.forward + e.backward) +
                        " of its triangles meet at " + edge + of);
            } else if (e.forward - e.backward != e.expected) {
                const char* what = e.expected == 0               ? ", where it does not end"
                                   : e.forward + e.backward == 0 ? ", a side of it"
                                   : e.forward + e.backward == 2 ? ", a side with the facet on one side only"
                                                                 : ", but lie on the wrong side of it";
                add(Promise::conforming, element, e.a,
                    (e.forward + e.backward == 0   ? "no triangle of " + name() + " is at "
                     : e.forward + e.backward == 2 ? "two triangles of " + name() + " meet at "
                                                   : "the triangles of " + name() + " end at ") +
                        edge + of + what);
            } else if (e.inner && (e.forward != 1 || e.backward != 1)) {
                add(Promise::conforming, element, e.a,
                    edge + of + ", which lies inside " + name() + ", is not between two triangles of it");
            }
        }
    }

    void check_points() {
        if (begin_ == end_) return;
        std::vector<std::uint32_t> excused;  // ends of ring sides along which there is no facet
        for (std::uint64_t i = subject_.plc.side_offsets[facet_]; i < subject_.plc.side_offsets[facet_ + 1]; ++i) {
            const PlcSide& side = subject_.plc.sides[i];
            if (!side.ring || side.cover != 0 || side.inner) continue;
            excused.insert(excused.end(), subject_.plc.segments[side.segment].begin(),
                           subject_.plc.segments[side.segment].end());
        }
        for (std::uint64_t i = subject_.plc.point_offsets[facet_]; i < subject_.plc.point_offsets[facet_ + 1]; ++i) {
            const std::uint32_t v = subject_.plc.points[i];
            if (has_vertex(v) || std::find(excused.begin(), excused.end(), v) != excused.end()) continue;
            add(Promise::conforming, vertex_ref(v), v,
                show("input point", v) + " of " + name() + " is no vertex of its triangles");
        }
    }

    void check_orientation(const NewellNormal& normal) {
        for (const std::uint32_t* i = begin_; i != end_; ++i) {
            const Triangle& t = triangle(i);
            const int sign = normal.side(subject_.at(t[0]), subject_.at(t[1]), subject_.at(t[2]));
            if (sign > 0) continue;
            add(Promise::faithful, triangle_ref(*i), t[0],
                show("triangle", *i) + " of " + show_vertices({index_of(t[0]), index_of(t[1]), index_of(t[2])}) +
                    ", seen along the normal of " + name() + ", is " +
                    (sign < 0 ? "negatively oriented" : "degenerate"));
        }
    }

    double check_distances(const NewellNormal& normal) {
        const FacetPlane plane(facet_corners(subject_.complex, facet_), normal);
        double largest = 0.0;
        for (const std::uint32_t v : vertices_) {
            const double distance = plane.distance(subject_.at(v));
            const bool added_inside = v >= subject_.input_count() && chains_.segment_of[v] == no_index;
            const double allowed = added_inside ? subject_.deviation : subject_.planarity + subject_.deviation;
            if (added_inside) largest = std::max(largest, distance);
            if (distance <= allowed) continue;
            add(Promise::faithful, vertex_ref(v), v,
                show("vertex", v) + " at " + show(subject_.at(v)) + " is " + show(distance) +
                    " away from the plane of " + name() + "; expected at most " + show(allowed));
        }
        return largest;
    }

    const Subject& subject_;
    const Chains& chains_;
    std::uint32_t facet_;
    Findings& findings_;
    const std::uint32_t *begin_ = nullptr, *end_ = nullptr;
    std::vector<std::uint32_t> vertices_;  // of the triangles, ascending
    std::vector<EdgeCount> edges_;
    bool broken_ = false;
    std::size_t told_ = 0;
};

/// Every added vertex lies on the complex, and on what it says it comes from.
double check_added(const Subject& subject, const Chains& chains, Findings& findings) {
    const TetMesh& mesh = subject.mesh;
    std::vector<std::uint8_t> on_facet(mesh.positions.size(), 0), on_source(mesh.positions.size(), 0);
    if (subject.triangle_labels) {
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const std::uint32_t facet = index_of(mesh.triangle_facets[i]);
            for (const VertexId v : mesh.triangles[i]) {
                on_facet[index_of(v)] = 1;
                if (!subject.sources) continue;
                const VertexSource& source = mesh.vertex_sources[index_of(v)];
                if (source.origin == VertexOrigin::facet && source.index < subject.plc.facet_count() &&
                    subject.plc.leaders[source.index] == facet) {
                    on_source[index_of(v)] = 1;
                }
            }
        }
    }
    double largest = 0.0;
    for (auto v = static_cast<std::uint32_t>(subject.input_count()); v < mesh.positions.size(); ++v) {
        const std::uint32_t s = chains.segment_of[v];
        if (s != no_index) {
            const auto& ends = subject.plc.segments[s];
            largest = std::max(largest, distance_to_segment(subject.at(v), subject.at(ends[0]), subject.at(ends[1])));
        } else if (!on_facet[v]) {
            findings.add(Promise::faithful, {vertex_ref(v)}, subject.at(v),
                         show("added vertex", v) + " at " + show(subject.at(v)) +
                             " lies on no segment's chain and on no facet's triangle");
        }
        if (!subject.sources) continue;
        const VertexSource& source = mesh.vertex_sources[v];
        const bool right = source.origin == VertexOrigin::segment ? s != no_index && source.index == s
                           : source.origin == VertexOrigin::facet ? s == no_index && on_source[v] != 0
                                                                  : false;
        if (right) continue;
        findings.add(
            Promise::labelled, {vertex_ref(v)}, subject.at(v),
            show("added vertex", v) +
                (source.origin == VertexOrigin::input
                     ? " is said to be an input point, but there are only " + std::to_string(subject.input_count())
                     : " is said to come from " +
                           show(source.origin == VertexOrigin::segment ? "segment" : "facet", source.index) +
                           ", but is not inside it"));
    }
    return largest;
}

void check_inputs(const Subject& subject, Findings& findings) {
    for (std::uint32_t v = 0; v < subject.input_count(); ++v) {
        const Point3& expected = subject.complex.positions[v];
        if (subject.at(v) != expected) {
            findings.add(
                Promise::faithful, {vertex_ref(v)}, subject.at(v),
                show("vertex", v) + " is at " + show(subject.at(v)) + "; expected the input point " + show(expected));
        }
        if (subject.sources && subject.mesh.vertex_sources[v].origin != VertexOrigin::input) {
            findings.add(Promise::labelled, {vertex_ref(v)}, expected,
                         show("vertex", v) + " is an input point, but is said to be an added one");
        }
    }
}

}  // namespace

void mark_walls(Subject& subject, Findings& findings) {
    const TetMesh& mesh = subject.mesh;
    subject.walls.assign(subject.faces.half_face_count(), 0);
    if (!subject.triangle_labels && !mesh.triangles.empty()) {
        findings.add(Promise::labelled, {}, {}, "the constraint triangles carry no facets");
    }
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const std::array<std::uint32_t, 3> corners{index_of(t[0]), index_of(t[1]), index_of(t[2])};
        const std::vector<HalfFace> halves = subject.faces.find(corners[0], corners[1], corners[2]);
        for (const HalfFace h : halves) subject.walls[h] = 1;
        if (halves.empty()) {
            findings.add(Promise::conforming, {triangle_ref(i)}, subject.at(t[0]),
                         show("triangle", i) + " of " + show_vertices({corners[0], corners[1], corners[2]}) +
                             " is no face of a tetrahedron");
        }
        if (subject.triangle_labels && index_of(mesh.triangle_facets[i]) >= subject.plc.facet_count()) {
            findings.add(Promise::labelled, {triangle_ref(i)}, subject.at(t[0]),
                         show("triangle", i) + " is labelled with " + show("facet", index_of(mesh.triangle_facets[i])) +
                             ", but there are " + std::to_string(subject.plc.facet_count()));
        }
    }
}

double check_facets(const Subject& subject, const Chains& chains, Findings& findings) {
    check_inputs(subject, findings);
    const TrianglesByFacet by_facet(subject);
    std::atomic<double> largest{0.0};
    for_each_item(subject.plc.facet_count(), subject.control, findings, [&](std::size_t f, Findings& found) {
        const double distance = FacetCheck(subject, chains, by_facet, static_cast<std::uint32_t>(f), found).run();
        double known = largest.load();
        while (distance > known && !largest.compare_exchange_weak(known, distance)) {
        }
    });
    return std::max(largest.load(), check_added(subject, chains, findings));
}

}  // namespace certa::verify
