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

// Pairs among the few vertices of one conflict zone, as a matrix of bits: filled and read out with every insertion.
class PairMatrix {
public:
    void clear(std::size_t size) {
        words_ = (size + 63) / 64;
        bits_.assign(size * words_, 0);
    }
    /// True when ij was not there yet. Callers give the two always in the same order.
    bool insert(std::uint32_t i, std::uint32_t j) {
        std::uint64_t& word = bits_[i * words_ + j / 64];
        const std::uint64_t bit = std::uint64_t{1} << (j % 64);
        const bool is_new = (word & bit) == 0;
        word |= bit;
        return is_new;
    }

private:
    std::vector<std::uint64_t> bits_;
    std::size_t words_ = 0;
};

}  // namespace

struct Delaunay3::Impl {
    Triangulation triangulation;
    std::vector<VertexHandle> handles;
    mutable std::uint32_t stamp = 0;
    mutable std::vector<CellHandle> stack;

    ConflictZone zone;
    Point3 place;
    PairMatrix pairs;
    struct Place {
        std::uint32_t stamp = 0, index = 0;
    };
    std::vector<Place> places_in_zone;  // per vertex: where zone.vertices holds it, if the stamp is the last one
    std::uint32_t zone_stamp = 0;
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

    // A cell with edge ab, or none. The cells around a tile the directions from a, and a cell that has b in its closed
    // cone has it as a vertex, or nothing has: so a walk decides, unless it comes to the hull.
    CellHandle find_cell(VertexHandle a, VertexHandle b) const {
        CellHandle cell = a->cell(), last;
        for (int steps = 0; steps < 50; ++steps) {
            if (cell->has_vertex(b)) return cell;
            if (triangulation.is_infinite(cell)) break;
            const CellHandle next = step_to(cell, last, a, b);
            if (next == CellHandle()) return {};
            last = std::exchange(cell, next);
        }
        return find_in_star(a, [&](CellHandle c) { return c->has_vertex(b); });
    }

    // The cell around a behind a face that b lies strictly behind; none where b is in the cell's closed cone.
    CellHandle step_to(CellHandle cell, CellHandle last, VertexHandle a, VertexHandle b) const {
        for (int k = 0; k < 4; ++k) {
            if (cell->vertex(k) == a || cell->neighbor(k) == last) continue;
            std::array<const Kernel::Point_3*, 4> corners;
            for (int i = 0; i < 4; ++i) corners[i] = &(i == k ? b : cell->vertex(i))->point();
            if (CGAL::orientation(*corners[0], *corners[1], *corners[2], *corners[3]) == CGAL::NEGATIVE)
                return cell->neighbor(k);
        }
        return {};
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

    Facet facet_of(const FaceHandle& face) const {
        using Cell = Structure::Cell;
        return {triangulation.tds().cells().iterator_to(*static_cast<Cell*>(face.cell)), face.index};
    }

    std::uint32_t id_of(VertexHandle v) const { return triangulation.is_infinite(v) ? no_index : v->info(); }

    void fill_zone() {
        zone.vertices.clear();
        zone.edges.clear();
        zone.border_edges.clear();
        zone.removed_marks.clear();
        zone.border_marks.clear();
        places_in_zone.resize(handles.size());
        ++zone_stamp;
        for (const CellHandle cell : conflict) {
            for (int i = 0; i < 4; ++i) {
                const std::uint32_t v = id_of(cell->vertex(i));
                if (v == no_index || places_in_zone[v].stamp == zone_stamp) continue;
                places_in_zone[v] = {zone_stamp, static_cast<std::uint32_t>(zone.vertices.size())};
                zone.vertices.push_back(v);
            }
        }
        pairs.clear(zone.vertices.size());
        // Edges around the zone first: what the cells add after that is inside.
        for (const Facet& face : hole) {
            std::array<std::uint32_t, 3> ids;
            for (int i = 0; i < 3; ++i) ids[i] = id_of(face.first->vertex((face.second + i + 1) & 3));
            add_edges(ids, zone.border_edges);
            const std::uint32_t mark = face.first->info().marks[face.second];
            if (mark != no_index) zone.border_marks.push_back(mark);
        }
        for (const CellHandle cell : conflict) {
            std::array<std::uint32_t, 4> ids;
            for (int i = 0; i < 4; ++i) ids[i] = id_of(cell->vertex(i));
            add_edges(ids, zone.edges);
        }
        for (const Facet& face : inner) {
            const std::uint32_t mark = face.first->info().marks[face.second];
            if (mark != no_index) zone.removed_marks.push_back(mark);
        }
        // The triangulation lists faces in the order of its cells' addresses.
        std::sort(zone.removed_marks.begin(), zone.removed_marks.end());
        std::sort(zone.border_marks.begin(), zone.border_marks.end());
    }

    template <std::size_t N>
    void add_edges(std::array<std::uint32_t, N> ids, std::vector<std::array<std::uint32_t, 2>>& list) {
        std::sort(ids.begin(), ids.end());
        for (std::size_t i = 0; i + 1 < N; ++i) {
            for (std::size_t j = i + 1; j < N && ids[j] != no_index; ++j) {
                if (pairs.insert(places_in_zone[ids[i]].index, places_in_zone[ids[j]].index))
                    list.push_back({ids[i], ids[j]});
            }
        }
    }

    std::uint32_t flood_components();
    std::vector<std::array<std::uint32_t, 2>> collect_walls() const;

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
    bool tie = false;
    const auto find_nearer = [&](std::uint32_t from) {
        tie = false;
        return s.find_in_star(s.handles[from], [&](CellHandle cell) {
            bool found = false;
            for (int i = 0; i < 4; ++i) {
                const std::uint32_t v = s.id_of(cell->vertex(i));
                if (v == no_index || v == nearest) continue;
                const double d = measure(v);
                tie = tie || d == best;
                if (d >= best) continue;
                best = d;
                nearest = v;
                found = true;
            }
            return found;
        });
    };
    while (find_nearer(nearest) != CellHandle()) {
    }
    if (!tie) return nearest;
    // Vertices on one empty sphere hang together by edges.
    std::vector<std::uint32_t> equals{nearest};
    for (std::size_t i = 0; i < equals.size(); ++i) {
        s.find_in_star(s.handles[equals[i]], [&](CellHandle cell) {
            for (int k = 0; k < 4; ++k) {
                const std::uint32_t v = s.id_of(cell->vertex(k));
                if (v == no_index || measure(v) != best) continue;
                if (std::find(equals.begin(), equals.end(), v) == equals.end()) equals.push_back(v);
            }
            return false;
        });
    }
    return *std::min_element(equals.begin(), equals.end());
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

FaceHandle Delaunay3::find_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Facet face = impl_->find_face(a, b, c);
    return face.first == CellHandle() ? FaceHandle{} : FaceHandle{&*face.first, face.second};
}

bool Delaunay3::is_beside_last(std::uint32_t v) const {
    // Its neighbours are the vertices of the zone that it was inserted into.
    const Impl& s = *impl_;
    return v < s.places_in_zone.size() && s.places_in_zone[v].stamp == s.zone_stamp;
}

void Delaunay3::find_link(std::uint32_t a, std::uint32_t b, std::vector<LinkFace>& link) const {
    link.clear();
    const VertexHandle va = impl_->handles[std::max(a, b)], vb = impl_->handles[std::min(a, b)];
    const CellHandle start = impl_->find_cell(va, vb);
    if (start == CellHandle()) return;
    auto around = impl_->triangulation.incident_facets(start, start->index(va), start->index(vb));
    const auto begin = around;
    do {
        const Facet face = *around;
        for (int i = 0; i < 4; ++i) {
            const VertexHandle v = face.first->vertex(i);
            if (i != face.second && v != va && v != vb && !impl_->triangulation.is_infinite(v))
                link.push_back({v->info(), {&*face.first, face.second}});
        }
    } while (++around != begin);
}

std::array<std::uint32_t, 2> Delaunay3::apexes_of(const FaceHandle& handle) const {
    const Facet face = impl_->facet_of(handle);
    const Facet mirror = impl_->triangulation.mirror_facet(face);
    return {impl_->id_of(face.first->vertex(face.second)), impl_->id_of(mirror.first->vertex(mirror.second))};
}

void Delaunay3::mark_face(const FaceHandle& handle, std::uint32_t mark) {
    const Facet face = impl_->facet_of(handle);
    const Facet mirror = impl_->triangulation.mirror_facet(face);
    face.first->info().marks[face.second] = mark;
    mirror.first->info().marks[mirror.second] = mark;
}

std::vector<std::uint32_t> Delaunay3::count_marks(std::size_t size) const {
    std::vector<std::uint32_t> counts(size, 0);
    for (const CellHandle cell : impl_->triangulation.all_cell_handles()) {
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t mark = cell->info().marks[i];
            if (mark != no_index && cell < cell->neighbor(i)) ++counts[mark];
        }
    }
    return counts;
}

void Delaunay3::clear_marks() {
    for (const CellHandle cell : impl_->triangulation.all_cell_handles()) {
        cell->info().marks = {no_index, no_index, no_index, no_index};
    }
}

// Numbers components in the order of cells in memory; 0 is the one at infinity.
std::uint32_t Delaunay3::Impl::flood_components() {
    const auto flood = [&](CellHandle seed, std::uint32_t number) {
        stack.assign(1, seed);
        seed->info().component = number;
        while (!stack.empty()) {
            const CellHandle cell = stack.back();
            stack.pop_back();
            for (int i = 0; i < 4; ++i) {
                const CellHandle next = cell->neighbor(i);
                if (cell->info().marks[i] != no_index || next->info().component != no_index) continue;
                next->info().component = number;
                stack.push_back(next);
            }
        }
    };
    for (const CellHandle cell : triangulation.all_cell_handles()) cell->info().component = no_index;
    // Infinite cells touch each other across infinite faces, which carry no marks: they are one component.
    flood(triangulation.infinite_cell(), 0);
    std::uint32_t count = 1;
    for (const CellHandle cell : triangulation.finite_cell_handles()) {
        if (cell->info().component == no_index) flood(cell, count++);
    }
    return count;
}

Delaunay3::Cells Delaunay3::collect_cells() const {
    const Triangulation& t = impl_->triangulation;
    Cells cells;
    cells.component_count = impl_->flood_components();
    cells.vertices.reserve(t.number_of_finite_cells());
    cells.components.reserve(t.number_of_finite_cells());
    // The lowest cell of each component by its vertices makes the numbers independent of the order in memory.
    using Key = std::array<std::uint32_t, 4>;
    constexpr Key none{no_index, no_index, no_index, no_index};
    std::vector<std::pair<Key, std::uint32_t>> lowest(cells.component_count, {none, 0});
    for (const CellHandle cell : t.finite_cell_handles()) {
        Key ids;
        for (int i = 0; i < 4; ++i) ids[i] = cell->vertex(i)->info();
        cells.vertices.push_back(ids);
        const std::uint32_t component = cell->info().component;
        cells.components.push_back(component);
        Key& low = lowest[component].first;
        if (std::none_of(ids.begin(), ids.end(), [&](std::uint32_t v) { return v <= low[0]; })) continue;
        std::sort(ids.begin(), ids.end());
        low = std::min(low, ids);
    }
    for (std::uint32_t i = 0; i < lowest.size(); ++i) lowest[i].second = i;
    std::sort(lowest.begin() + 1, lowest.end());
    std::vector<std::uint32_t> renumbered(cells.component_count);
    for (std::uint32_t i = 0; i < lowest.size(); ++i) renumbered[lowest[i].second] = i;
    for (std::uint32_t& component : cells.components) component = renumbered[component];
    for (const CellHandle cell : t.all_cell_handles()) cell->info().component = renumbered[cell->info().component];
    cells.walls = impl_->collect_walls();
    return cells;
}

std::vector<std::array<std::uint32_t, 2>> Delaunay3::Impl::collect_walls() const {
    std::vector<std::array<std::uint32_t, 2>> walls;
    std::array<std::uint32_t, 2> last{no_index, no_index};
    for (const CellHandle cell : triangulation.finite_cell_handles()) {
        for (int i = 0; i < 4; ++i) {
            if (cell->info().marks[i] == no_index) continue;
            const CellHandle next = cell->neighbor(i);
            const std::uint32_t own = cell->info().component;
            const std::uint32_t other = triangulation.is_infinite(next) ? no_index : next->info().component;
            const std::array<std::uint32_t, 2> wall{std::min(own, other), std::max(own, other)};
            if (wall != last) walls.push_back(last = wall);
        }
    }
    std::sort(walls.begin(), walls.end());
    walls.erase(std::unique(walls.begin(), walls.end()), walls.end());
    return walls;
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
