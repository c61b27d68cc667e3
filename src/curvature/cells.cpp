// Dual cells and rings (thesis, 2.5: the averaging region is a number of rings; docs/curvature.md: why dual cells).
//
// With rim `dual` a region is a union of barycentric dual cells, so its measures are a sum of one record per vertex.
// The other rims are unions of triangles whose border edges and vertices count by the rim's rule. Breadth-first over
// vertices that lie near each other in memory; marks are epochs, so nothing is cleared or allocated per vertex.
#include "curvature/cells.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace certa::curvature {
namespace {

constexpr std::array<std::size_t, 3> next{1, 2, 0};

void add_record(Sums& sums, const CellRecord& record) {
    add(sums.swapped, 1.0, record.swapped);
    sums.area += record.area;
    sums.gaussian += record.gaussian;
}

void add_remainder(Sums& sums, const CellRemainder& remainder) {
    add(sums.plain, 1.0, remainder.plain);
    sums.edge_mass += remainder.edge_mass;
    sums.vertex_mass += remainder.vertex_mass;
}

}  // namespace

Cells build_cells(const Surface& surface, const RunControl& control) {
    Cells cells;
    const std::size_t n = surface.positions.size();
    cells.records.resize(n);
    cells.remainders.resize(n);
    core::parallel_for(surface.used_vertices, 4096, control, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            CellRecord& record = cells.records[v];
            CellRemainder& remainder = cells.remainders[v];
            for (const Index f : surface.vertex_faces[v]) {
                record.area += surface.face_geometry[f].area / 3.0;
                const auto& face = surface.faces[f];
                const std::size_t i = face[0] == v ? 0 : face[1] == v ? 1 : 2;
                // The edge to the previous corner: each hinge at the vertex is that of one face only.
                const Hinge& hinge = surface.hinges[surface.face_hinges[f][next[i]]];
                if (hinge.angle == 0.0) continue;
                const EdgeTensors tensors = hinge_tensors(surface, hinge);
                add(record.swapped, 0.5 * hinge.length, tensors.swapped);
                add(remainder.plain, 0.5 * hinge.length, tensors.plain);
                remainder.edge_mass += 0.5 * hinge.length * std::abs(hinge.angle);
            }
            record.gaussian = surface.defects[v];
            remainder.vertex_mass = vertex_mass(surface, static_cast<Index>(v));
        }
    });
    return cells;
}

Sums sum_all(const Cells& cells) {
    // In blocks, so that rounding grows with the square root of the number of vertices at worst.
    Sums total;
    constexpr std::size_t block = 1024;
    for (std::size_t begin = 0; begin < cells.records.size(); begin += block) {
        Sums part;
        for (std::size_t v = begin; v < std::min(begin + block, cells.records.size()); ++v) {
            add_record(part, cells.records[v]);
            add_remainder(part, cells.remainders[v]);
        }
        add(total.swapped, 1.0, part.swapped);
        add(total.plain, 1.0, part.plain);
        total.area += part.area, total.gaussian += part.gaussian;
        total.edge_mass += part.edge_mass, total.vertex_mass += part.vertex_mass;
    }
    return total;
}

SymmetricTensor3 scaled_tensor(const SymmetricTensor3& t, int exponent) {
    const auto scale = [&](double x) { return std::ldexp(x, exponent); };
    return {scale(t.xx), scale(t.xy), scale(t.xz), scale(t.yy), scale(t.yz), scale(t.zz)};
}

CurvatureMeasures measures_of(const Sums& sums, int exponent) {
    CurvatureMeasures measures;
    measures.area = std::ldexp(sums.area, 2 * exponent);
    measures.gaussian = sums.gaussian;
    measures.mean = std::ldexp(sums.swapped.trace(), exponent);
    measures.tensor = scaled_tensor(sums.plain, exponent);
    measures.swapped_tensor = scaled_tensor(sums.swapped, exponent);
    measures.edge_mass = std::ldexp(sums.edge_mass, exponent);
    measures.vertex_mass = sums.vertex_mass;
    return measures;
}

void RingWalker::start(Index vertex) {
    vertices_.clear();
    found_ = 0;
    reserve(1);
    list_[found_++] = vertex;
    vertices_.mark(vertex);
}

std::span<const Index> RingWalker::collect(Index vertex, std::uint64_t rings) {
    start(vertex);
    std::size_t begin = 0, found = found_;
    ends_.clear();
    for (std::uint64_t ring = 0; ring < rings && begin < found; ++ring) {
        ends_.push_back(found);
        for (const std::size_t end = found; begin < end; ++begin) {
            const std::span<const Index> neighbors = surface_.vertex_neighbors[list_[begin]];
            found_ = found;
            reserve(neighbors.size());
            Index* const list = list_.data();
            for (const Index w : neighbors) {
                list[found] = w;
                found += vertices_.mark_and_count(w);
            }
        }
    }
    found_ = found;
    return {list_.data(), found_};
}

std::span<const Index> RingWalker::collect_ball(Index vertex, double radius) {
    start(vertex);
    const Point3& center = surface_.positions[vertex];
    for (std::size_t k = 0; k < found_; ++k) {
        const std::span<const Index> neighbors = surface_.vertex_neighbors[list_[k]];
        reserve(neighbors.size());
        for (const Index w : neighbors) {
            const Point3 d = surface_.positions[w] - center;
            if (dot(d, d) <= radius * radius && vertices_.mark(w)) list_[found_++] = w;
        }
    }
    return {list_.data(), found_};
}

const std::vector<Index>& RingWalker::collect_faces(Index vertex, std::uint64_t rings) {
    if (face_list_.empty()) faces_ = Marks(surface_.faces.size());
    faces_.clear();
    face_list_.clear();
    for (const Index v : collect(vertex, rings - 1))
        for (const Index f : surface_.vertex_faces[v])
            if (faces_.mark(f)) face_list_.push_back(f);
    return face_list_;
}

Sums RingWalker::sum(Index vertex, std::uint64_t rings, Rim rim) {
    if (rim != Rim::dual) return sum_faces(vertex, rings, rim);
    Sums sums;
    for (const Index v : collect(vertex, rings)) {
        add_record(sums, cells_.records[v]);
        add_remainder(sums, cells_.remainders[v]);
    }
    return sums;
}

Sums RingWalker::sum_tapered(Index vertex, std::uint64_t rings) {
    Sums sums;
    const std::span<const Index> cells = collect(vertex, rings);
    ends_.push_back(cells.size());
    std::size_t k = 0;
    for (std::size_t step = 0; step < ends_.size(); ++step) {
        const double t = static_cast<double>(step) / static_cast<double>(rings + 1), s = 1.0 - t * t, weight = s * s;
        for (; k < ends_[step]; ++k) {
            const CellRecord& record = cells_.records[cells[k]];
            const CellRemainder& remainder = cells_.remainders[cells[k]];
            add(sums.swapped, weight, record.swapped);
            add(sums.plain, weight, remainder.plain);
            sums.area += weight * record.area, sums.gaussian += weight * record.gaussian;
            sums.edge_mass += weight * remainder.edge_mass, sums.vertex_mass += weight * remainder.vertex_mass;
        }
    }
    return sums;
}

Sums RingWalker::sum_faces(Index vertex, std::uint64_t rings, Rim rim) {
    Sums sums;
    const double rim_weight = rim == Rim::half ? 0.5 : rim == Rim::closed ? 1.0 : 0.0;
    for (const Index f : collect_faces(vertex, rings)) {
        sums.area += surface_.face_geometry[f].area;
        for (const Index h : surface_.face_hinges[f]) {
            const Hinge& hinge = surface_.hinges[h];
            if (hinge.angle == 0.0) continue;
            const double weight = (faces_.has(surface_.across(f, h)) ? 0.5 : rim_weight) * hinge.length;
            if (weight == 0.0) continue;
            const EdgeTensors tensors = hinge_tensors(surface_, hinge);
            add(sums.swapped, weight, tensors.swapped);
            add(sums.plain, weight, tensors.plain);
            sums.edge_mass += weight * std::abs(hinge.angle);
        }
    }
    add_rim_vertices(sums, rim);
    return sums;
}

void RingWalker::add_rim_vertices(Sums& sums, Rim rim) {
    // Those within rings - 1 steps are inside; the others of the faces are on the rim, unless the ring closes there.
    const std::size_t inner = found_;
    reserve(3 * face_list_.size());
    for (const Index f : face_list_)
        for (const Index v : surface_.faces[f])
            if (vertices_.mark(v)) list_[found_++] = v;
    for (std::size_t k = 0; k < found_; ++k) {
        const Index v = list_[k];
        double weight = 1.0;
        if (k >= inner) {
            double inside = 0.0;
            bool all = true;
            for (const Index f : surface_.vertex_faces[v]) {
                const auto& face = surface_.faces[f];
                if (faces_.has(f))
                    inside += surface_.face_angles[f][face[0] == v ? 0 : face[1] == v ? 1 : 2];
                else
                    all = false;
            }
            if (!all) weight = rim == Rim::closed ? 1.0 : rim == Rim::open ? 0.0 : inside / surface_.angle_sums[v];
        }
        if (weight == 0.0) continue;
        sums.gaussian += weight * surface_.defects[v];
        sums.vertex_mass += weight * cells_.remainders[v].vertex_mass;
    }
}

}  // namespace certa::curvature
