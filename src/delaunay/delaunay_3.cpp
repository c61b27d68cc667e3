// Delaunay3 on top of CGAL's Delaunay_triangulation_3 with exact predicates.
// Cells carry the marks of their four faces on both sides; after an insertion the new cells fetch theirs from the
// neighbours across the boundary of the hole, so marks follow faces for as long as these exist.
// Star walks stamp cells instead of collecting them in sets: queries allocate nothing, and are for one thread.
#include "delaunay/delaunay_3.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "core/assert.h"

namespace certa::delaunay {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

struct CellInfo {
    std::array<std::uint32_t, 4> marks{no_index, no_index, no_index, no_index};
    mutable std::uint32_t stamp = 0;
    std::uint32_t component = no_index;
};

using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<CellInfo, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_3<VertexBase, CellBase>;
using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Structure>;
using CellHandle = Triangulation::Cell_handle;
using VertexHandle = Triangulation::Vertex_handle;
using Facet = Triangulation::Facet;

Kernel::Point_3 to_cgal(const Point3& p) { return {p.x, p.y, p.z}; }

// The edges of one conflict zone: small, filled and read out all the time. Emptied by a new stamp.
class EdgeSet {
public:
    struct Slot {
        std::uint32_t a = 0, b = 0, stamp = 0;
    };

    void clear() {
        ++stamp_;
        size_ = 0;
    }
    /// True when ab (a < b) was not there yet.
    bool insert(std::uint32_t a, std::uint32_t b) {
        if (2 * (size_ + 1) > slots_.size()) grow();
        for (std::size_t i = slot_of(a, b);; i = (i + 1) & (slots_.size() - 1)) {
            Slot& slot = slots_[i];
            if (slot.stamp != stamp_) {
                slot = {a, b, stamp_};
                ++size_;
                return true;
            }
            if (slot.a == a && slot.b == b) return false;
        }
    }

private:
    std::size_t slot_of(std::uint32_t a, std::uint32_t b) const {
        return ((a * 0x9e3779b1u) ^ (b * 0x85ebca77u)) >> 7 & (slots_.size() - 1);
    }
    void grow() {
        std::vector<Slot> old(std::max<std::size_t>(256, 2 * slots_.size()));
        old.swap(slots_);
        size_ = 0;
        for (const Slot& slot : old) {
            if (slot.stamp == stamp_) insert(slot.a, slot.b);
        }
    }

    std::vector<Slot> slots_;
    std::size_t size_ = 0;
    std::uint32_t stamp_ = 1;
};

}  // namespace

struct Delaunay3::Impl {
    Triangulation triangulation;
    std::vector<VertexHandle> handles;
    mutable std::uint32_t stamp = 0;
    mutable std::vector<CellHandle> stack;

    ConflictZone zone;
    Point3 place;
    EdgeSet edges;
    std::vector<std::uint32_t> vertex_stamps;
    std::uint32_t vertex_stamp = 0;
    std::vector<Facet> hole;
    std::vector<CellHandle> conflict;
    std::vector<Facet> inner;

    // The first cell around a for which `is_wanted` holds, or none.
    template <class Predicate>
    CellHandle find_in_star(VertexHandle a, const Predicate& is_wanted) const {
        ++stamp;
        stack.clear();
        stack.push_back(a->cell());
        a->cell()->info().stamp = stamp;
        while (!stack.empty()) {
            const CellHandle cell = stack.back();
            stack.pop_back();
            if (is_wanted(cell)) return cell;
            for (int i = 0; i < 4; ++i) {
                if (cell->vertex(i) == a) continue;
                const CellHandle next = cell->neighbor(i);
                if (next->info().stamp == stamp) continue;
                next->info().stamp = stamp;
                stack.push_back(next);
            }
        }
        return {};
    }

    CellHandle find_cell(VertexHandle a, VertexHandle b) const {
        return find_in_star(a, [&](CellHandle cell) { return cell->has_vertex(b); });
    }

    // Face abc as (cell, index), or a null cell.
    Facet find_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        if (a < b) std::swap(a, b);
        if (a < c) std::swap(a, c);
        const VertexHandle va = handles[a], vb = handles[b], vc = handles[c];
        const CellHandle start = find_cell(va, vb);
        if (start == CellHandle()) return {};
        auto around = triangulation.incident_cells(start, start->index(va), start->index(vb));
        const auto begin = around;
        do {
            const CellHandle cell = around;
            int k = 0;
            if (cell->has_vertex(vc, k)) {
                return {cell, 6 - cell->index(va) - cell->index(vb) - k};
            }
        } while (++around != begin);
        return {};
    }

    std::uint32_t id_of(VertexHandle v) const { return triangulation.is_infinite(v) ? no_index : v->info(); }

    void fill_zone() {
        zone.vertices.clear();
        zone.edges.clear();
        zone.border_edges.clear();
        zone.removed_marks.clear();
        zone.border_marks.clear();
        vertex_stamps.resize(handles.size(), 0);
        ++vertex_stamp;
        edges.clear();
        // Edges around the zone first: what the cells add after that is inside.
        for (const Facet& face : hole) {
            std::array<std::uint32_t, 3> ids;
            for (int i = 0; i < 3; ++i) ids[i] = id_of(face.first->vertex((face.second + i + 1) & 3));
            std::sort(ids.begin(), ids.end());
            add_edge(ids[0], ids[1], zone.border_edges);
            add_edge(ids[1], ids[2], zone.border_edges);
            add_edge(ids[0], ids[2], zone.border_edges);
            const std::uint32_t mark = face.first->info().marks[face.second];
            if (mark != no_index) zone.border_marks.push_back(mark);
        }
        for (const CellHandle cell : conflict) {
            std::array<std::uint32_t, 4> ids;
            for (int i = 0; i < 4; ++i) ids[i] = id_of(cell->vertex(i));
            std::sort(ids.begin(), ids.end());
            for (int i = 0; i < 4; ++i) {
                if (ids[i] == no_index) continue;
                if (vertex_stamps[ids[i]] != vertex_stamp) {
                    vertex_stamps[ids[i]] = vertex_stamp;
                    zone.vertices.push_back(ids[i]);
                }
                for (int j = i + 1; j < 4; ++j) add_edge(ids[i], ids[j], zone.edges);
            }
        }
        for (const Facet& face : inner) {
            const std::uint32_t mark = face.first->info().marks[face.second];
            if (mark != no_index) zone.removed_marks.push_back(mark);
        }
        // The triangulation lists faces in the order of its cells' addresses.
        std::sort(zone.removed_marks.begin(), zone.removed_marks.end());
        std::sort(zone.border_marks.begin(), zone.border_marks.end());
    }

    void add_edge(std::uint32_t a, std::uint32_t b, std::vector<std::array<std::uint32_t, 2>>& list) {
        if (b != no_index && edges.insert(a, b)) list.push_back({a, b});
    }

    void release_conflicts() {
        for (const CellHandle cell : conflict) cell->tds_data().clear();
        conflict.clear();
        hole.clear();
        inner.clear();
    }
};

Delaunay3::Delaunay3() : impl_(std::make_unique<Impl>()) {}
Delaunay3::~Delaunay3() = default;
Delaunay3::Delaunay3(Delaunay3&&) noexcept = default;
Delaunay3& Delaunay3::operator=(Delaunay3&&) noexcept = default;

void Delaunay3::build(std::span<const Point3> points, std::span<const std::uint32_t> left_out) {
    std::vector<std::pair<Kernel::Point_3, std::uint32_t>> input;
    input.reserve(points.size());
    auto skip = left_out.begin();
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        if (skip != left_out.end() && *skip == i) {
            ++skip;
        } else {
            input.emplace_back(to_cgal(points[i]), i);
        }
    }
    impl_->release_conflicts();
    impl_->triangulation.clear();
    impl_->triangulation.insert(input.begin(), input.end());
    CERTA_ASSERT(impl_->triangulation.number_of_vertices() == input.size());
    positions_.assign(points.begin(), points.end());
    impl_->handles.assign(points.size(), VertexHandle());
    for (const VertexHandle v : impl_->triangulation.finite_vertex_handles()) impl_->handles[v->info()] = v;
}

bool Delaunay3::is_solid() const { return impl_->triangulation.dimension() == 3; }

const ConflictZone& Delaunay3::find_conflicts(const Point3& place, std::uint32_t near) {
    Impl& s = *impl_;
    s.release_conflicts();
    s.place = place;
    const Kernel::Point_3 p = to_cgal(place);
    Triangulation::Locate_type type{};
    int li = 0, lj = 0;
    const CellHandle cell = s.triangulation.locate(p, type, li, lj, s.handles[near]->cell());
    s.zone.occupied = type == Triangulation::VERTEX;
    if (s.zone.occupied) {
        s.zone.vertices.assign(1, cell->vertex(li)->info());
        s.zone.edges.clear();
        s.zone.border_edges.clear();
        s.zone.removed_marks.clear();
        s.zone.border_marks.clear();
        return s.zone;
    }
    s.triangulation.find_conflicts(p, cell, std::back_inserter(s.hole), std::back_inserter(s.conflict),
                                   std::back_inserter(s.inner));
    s.fill_zone();
    return s.zone;
}

std::uint32_t Delaunay3::find_nearest(const Point3& place, std::uint32_t near) const {
    const Impl& s = *impl_;
    const auto measure = [&](std::uint32_t v) {
        const Point3& q = positions_[v];
        const double dx = q.x - place.x, dy = q.y - place.y, dz = q.z - place.z;
        return dx * dx + dy * dy + dz * dz;
    };
    // Of a vertex and its neighbours in a Delaunay triangulation, the vertex is the nearest only if it is so of all.
    std::uint32_t nearest = near;
    double best = measure(near);
    for (std::uint32_t from = no_index; from != nearest;) {
        from = nearest;
        s.find_in_star(s.handles[from], [&](CellHandle cell) {
            for (int i = 0; i < 4; ++i) {
                const std::uint32_t v = s.id_of(cell->vertex(i));
                if (v == no_index || v == nearest) continue;
                const double d = measure(v);
                if (d < best || (d == best && v < nearest)) {
                    best = d;
                    nearest = v;
                }
            }
            return false;
        });
    }
    return nearest;
}

std::uint32_t Delaunay3::insert_in_conflicts() {
    Impl& s = *impl_;
    CERTA_ASSERT(!s.conflict.empty());
    const Facet begin = s.hole.front();
    const VertexHandle v = s.triangulation.insert_in_hole(to_cgal(s.place), s.conflict.begin(), s.conflict.end(),
                                                          begin.first, begin.second);
    s.conflict.clear();  // these cells are gone
    s.hole.clear();
    s.inner.clear();
    const auto id = static_cast<std::uint32_t>(positions_.size());
    v->info() = id;
    s.handles.push_back(v);
    positions_.push_back(s.place);
    std::vector<CellHandle>& cells = s.stack;
    cells.clear();
    s.triangulation.incident_cells(v, std::back_inserter(cells));
    for (const CellHandle cell : cells) {
        const int i = cell->index(v);
        const CellHandle outside = cell->neighbor(i);
        cell->info().marks = {no_index, no_index, no_index, no_index};
        cell->info().marks[i] = outside->info().marks[outside->index(cell)];
    }
    return id;
}

bool Delaunay3::has_edge(std::uint32_t a, std::uint32_t b) const {
    // Late vertices have small stars.
    return impl_->find_cell(impl_->handles[std::max(a, b)], impl_->handles[std::min(a, b)]) != CellHandle();
}

bool Delaunay3::has_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return impl_->find_face(a, b, c).first != CellHandle();
}

void Delaunay3::find_link(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& link) const {
    link.clear();
    const VertexHandle va = impl_->handles[a], vb = impl_->handles[b];
    const CellHandle start = impl_->find_cell(va, vb);
    if (start == CellHandle()) return;
    auto around = impl_->triangulation.incident_facets(start, start->index(va), start->index(vb));
    const auto begin = around;
    do {
        const Facet face = *around;
        for (int i = 0; i < 4; ++i) {
            const VertexHandle v = face.first->vertex(i);
            if (i != face.second && v != va && v != vb && !impl_->triangulation.is_infinite(v))
                link.push_back(v->info());
        }
    } while (++around != begin);
}

bool Delaunay3::find_apexes(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                            std::array<std::uint32_t, 2>& apexes) const {
    const Facet face = impl_->find_face(a, b, c);
    if (face.first == CellHandle()) return false;
    const Facet mirror = impl_->triangulation.mirror_facet(face);
    apexes = {impl_->id_of(face.first->vertex(face.second)), impl_->id_of(mirror.first->vertex(mirror.second))};
    return true;
}

bool Delaunay3::mark_face(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t mark) {
    const Facet face = impl_->find_face(a, b, c);
    if (face.first == CellHandle()) return false;
    const Facet mirror = impl_->triangulation.mirror_facet(face);
    face.first->info().marks[face.second] = mark;
    mirror.first->info().marks[mirror.second] = mark;
    return true;
}

void Delaunay3::clear_marks() {
    for (const CellHandle cell : impl_->triangulation.all_cell_handles()) {
        cell->info().marks = {no_index, no_index, no_index, no_index};
    }
}

Delaunay3::Cells Delaunay3::collect_cells() const {
    const Triangulation& t = impl_->triangulation;
    for (const CellHandle cell : t.all_cell_handles()) cell->info().component = no_index;
    std::vector<CellHandle>& stack = impl_->stack;
    using Key = std::array<std::uint32_t, 4>;
    const auto key_of = [&](CellHandle cell) {
        Key key;
        for (int i = 0; i < 4; ++i) key[i] = impl_->id_of(cell->vertex(i));
        std::sort(key.begin(), key.end());
        return key;
    };
    // Returns the lowest cell by vertices: it makes the numbering independent of the order of cells in memory.
    const auto flood = [&](CellHandle seed, std::uint32_t number) {
        Key lowest = key_of(seed);
        stack.assign(1, seed);
        seed->info().component = number;
        while (!stack.empty()) {
            const CellHandle cell = stack.back();
            stack.pop_back();
            lowest = std::min(lowest, key_of(cell));
            for (int i = 0; i < 4; ++i) {
                const CellHandle next = cell->neighbor(i);
                if (cell->info().marks[i] != no_index || next->info().component != no_index) continue;
                next->info().component = number;
                stack.push_back(next);
            }
        }
        return lowest;
    };
    // Infinite cells touch each other across infinite faces, which carry no marks: they are one component.
    flood(t.infinite_cell(), 0);
    std::vector<std::pair<Key, std::uint32_t>> bounded;
    for (const CellHandle cell : t.finite_cell_handles()) {
        if (cell->info().component != no_index) continue;
        const auto number = static_cast<std::uint32_t>(bounded.size() + 1);
        bounded.emplace_back(flood(cell, number), number);
    }
    std::sort(bounded.begin(), bounded.end());
    std::vector<std::uint32_t> renumbered(bounded.size() + 1, 0);
    for (std::uint32_t i = 0; i < bounded.size(); ++i) renumbered[bounded[i].second] = i + 1;
    for (const CellHandle cell : t.all_cell_handles()) cell->info().component = renumbered[cell->info().component];

    Cells cells;
    cells.component_count = static_cast<std::uint32_t>(bounded.size() + 1);
    cells.vertices.reserve(t.number_of_finite_cells());
    cells.components.reserve(t.number_of_finite_cells());
    std::array<std::uint32_t, 2> last{no_index, no_index};
    for (const CellHandle cell : t.finite_cell_handles()) {
        Key ids;
        for (int i = 0; i < 4; ++i) {
            ids[i] = cell->vertex(i)->info();
            if (cell->info().marks[i] == no_index) continue;
            const CellHandle next = cell->neighbor(i);
            const std::uint32_t own = cell->info().component;
            const std::uint32_t other = t.is_infinite(next) ? no_index : next->info().component;
            const std::array<std::uint32_t, 2> wall{std::min(own, other), std::max(own, other)};
            if (wall != last) cells.walls.push_back(last = wall);
        }
        cells.vertices.push_back(ids);
        cells.components.push_back(cell->info().component);
    }
    std::sort(cells.walls.begin(), cells.walls.end());
    cells.walls.erase(std::unique(cells.walls.begin(), cells.walls.end()), cells.walls.end());
    return cells;
}

bool is_inside_diametral_ball(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
    return CGAL::side_of_bounded_sphere(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(p)) == CGAL::ON_BOUNDED_SIDE;
}

void Delaunay3::components_around(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& components) const {
    components.clear();
    const VertexHandle va = impl_->handles[a], vb = impl_->handles[b];
    const CellHandle start = impl_->find_cell(va, vb);
    CERTA_ASSERT(start != CellHandle());
    auto around = impl_->triangulation.incident_cells(start, start->index(va), start->index(vb));
    const auto begin = around;
    do {
        if (!impl_->triangulation.is_infinite(around)) components.push_back(around->info().component);
    } while (++around != begin);
}

std::uint32_t Delaunay3::locate_component(const Point3& place) const {
    Triangulation::Locate_type type{};
    int li = 0, lj = 0;
    const CellHandle cell = impl_->triangulation.locate(to_cgal(place), type, li, lj);
    if (type == Triangulation::FACET && cell->info().marks[li] != no_index) return no_index;
    return cell->info().component;
}

}  // namespace certa::delaunay
