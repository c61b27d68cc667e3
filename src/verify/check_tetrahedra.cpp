// Well-formed: arrays that fit together, valid indices, finite and distinct positions, positive tetrahedra that are
// matched face to face from both sides, no vertex that belongs to nothing.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "verify/parallel.h"
#include "verify/subject.h"

namespace certa::verify {
namespace {

void check_sizes(const TetMesh& mesh, Findings& findings) {
    const auto check = [&](std::size_t labels, std::size_t elements, const char* what) {
        if (labels == 0 || labels == elements) return;
        findings.add(Promise::well_formed, {}, {},
                     std::string(what) + " has " + std::to_string(labels) + " entries for " + std::to_string(elements) +
                         " elements; expected none or one each");
    };
    check(mesh.vertex_sources.size(), mesh.positions.size(), "vertex_sources");
    check(mesh.tetrahedron_regions.size(), mesh.tetrahedra.size(), "tetrahedron_regions");
    check(mesh.triangle_facets.size(), mesh.triangles.size(), "triangle_facets");
    check(mesh.edge_segments.size(), mesh.edges.size(), "edge_segments");
    if (mesh.positions.size() >= no_index) {
        findings.add(Promise::well_formed, {}, {}, "more than 2^32 - 2 vertices");
    }
}

template <class Element>
void check_elements(const TetMesh& mesh, const std::vector<Element>& elements, ElementKind kind, Findings& findings) {
    for (std::uint32_t i = 0; i < elements.size(); ++i) {
        const Element& e = elements[i];
        for (std::size_t k = 0; k < e.size(); ++k) {
            if (index_of(e[k]) >= mesh.positions.size()) {
                findings.add(Promise::well_formed, {{kind, i}}, {},
                             show(name_of(kind), i) + " names " + show("vertex", index_of(e[k])) + ", but there are " +
                                 std::to_string(mesh.positions.size()));
            }
            for (std::size_t l = 0; l < k; ++l) {
                if (e[k] != e[l]) continue;
                findings.add(Promise::well_formed, {{kind, i}}, {},
                             show(name_of(kind), i) + " names " + show("vertex", index_of(e[k])) + " twice");
            }
        }
    }
}

/// Input points that coincide may stay, as long as one of them alone is used: repair leaves the others so.
void check_positions_distinct(Subject& subject, Findings& findings) {
    const auto& positions = subject.mesh.positions;
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
        const Point3 &a = positions[i], &b = positions[j];
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z != b.z ? a.z < b.z : i < j;
    });
    const auto is_idle = [&](std::uint32_t v) {
        return v < subject.input_count() && !subject.used[v] && subject.plc.is_isolated[v];
    };
    subject.spare.assign(positions.size(), 0);
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && positions[order[end]] == positions[order[begin]]) ++end;
        if (end == begin + 1) continue;
        std::uint32_t kept = no_index;
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t v = order[k];
            if (is_idle(v)) continue;
            if (kept != no_index) {
                findings.add(Promise::well_formed, {vertex_ref(kept), vertex_ref(v)}, positions[v],
                             show_vertices({kept, v}) + " are both at " + show(positions[v]));
            }
            kept = v;
        }
        for (std::size_t k = begin; k < end; ++k) {
            subject.spare[order[k]] = kept != no_index && subject.used[kept] && is_idle(order[k]);
        }
    }
}

void check_faces(const Subject& subject, Findings& findings) {
    const TetMesh& mesh = subject.mesh;
    for (const HalfFace h : subject.faces.crowded()) {
        const auto f = outward_face(mesh, h);
        std::vector<ElementRef> elements;
        for (const HalfFace k : subject.faces.find(f[0], f[1], f[2])) elements.push_back(tetrahedron_ref(k / 4));
        std::string message = "the face of " + show_vertices({f[0], f[1], f[2]}) + " belongs to tetrahedra";
        for (std::size_t i = 0; i < elements.size() && i < 8; ++i)
            message += ' ' + std::to_string(elements[i].index + 1);
        message += elements.size() > 2 ? "; expected at most two" : ", which lie on the same side of it";
        findings.add(Promise::well_formed, std::move(elements), mesh.positions[f[0]], std::move(message));
    }
}

void check_unused(const Subject& subject, Findings& findings) {
    for (std::uint32_t v = 0; v < subject.mesh.positions.size(); ++v) {
        // Whether an isolated input point is rightly left out depends on what is filled: see check_domain.
        if (subject.used[v] || (v < subject.input_count() && subject.plc.is_isolated[v])) continue;
        findings.add(Promise::well_formed, {vertex_ref(v)}, subject.at(v),
                     show("vertex", v) + " at " + show(subject.at(v)) + " belongs to no tetrahedron");
    }
}

}  // namespace

bool check_arrays(const TetMesh& mesh, Findings& findings) {
    check_sizes(mesh, findings);
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const Point3& p = mesh.positions[v];
        if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
        findings.add(Promise::well_formed, {vertex_ref(v)}, p,
                     show("vertex", v) + " has a coordinate that is not a finite number");
    }
    check_elements(mesh, mesh.tetrahedra, ElementKind::tetrahedron, findings);
    check_elements(mesh, mesh.triangles, ElementKind::triangle, findings);
    check_elements(mesh, mesh.edges, ElementKind::edge, findings);
    if (mesh.tetrahedra.empty()) findings.add(Promise::well_formed, {}, {}, "the mesh has no tetrahedra");
    return findings.count() == 0;
}

void check_tetrahedra(Subject& subject, Findings& findings) {
    const TetMesh& mesh = subject.mesh;
    subject.positive.assign(mesh.tetrahedra.size(), 1);
    for_each_item(mesh.tetrahedra.size(), subject.control, findings, [&](std::size_t i, Findings& found) {
        const Tetrahedron& t = mesh.tetrahedra[i];
        const int sign = orientation(subject.at(t[0]), subject.at(t[1]), subject.at(t[2]), subject.at(t[3]));
        if (sign > 0) return;
        subject.positive[i] = 0;
        const auto index = static_cast<std::uint32_t>(i);
        found.add(Promise::well_formed, {tetrahedron_ref(index)}, subject.at(t[0]),
                  show("tetrahedron", index) + " of " +
                      show_vertices({index_of(t[0]), index_of(t[1]), index_of(t[2]), index_of(t[3])}) +
                      (sign < 0 ? " is negatively oriented" : " is flat") + "; expected a positive determinant");
    });
    check_positions_distinct(subject, findings);
    check_faces(subject, findings);
    check_unused(subject, findings);
}

}  // namespace certa::verify
