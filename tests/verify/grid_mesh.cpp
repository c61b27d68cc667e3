// Draws complexes on the lattice and fills the boxes with Kuhn's tetrahedra. Segments are numbered here independently,
// by the letter of docs/conventions.md: given ones, then sides by first appearance.
#include "verify/grid_mesh.h"

#include <algorithm>
#include <numeric>

namespace certa::test {
namespace {

std::array<Place, 2> ordered(const Place& a, const Place& b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

std::uint32_t GridMesh::point(const Place& p) {
    const auto [i, fresh] = points_.try_emplace(p, static_cast<std::uint32_t>(places_.size()));
    if (fresh) {
        places_.push_back(p);
        complex_.positions.push_back(position(p));
    }
    return i->second;
}

Point3 GridMesh::position(const Place& p) const {
    return {shift.x + scale * p[0], shift.y + scale * p[1], shift.z + scale * p[2]};
}

void GridMesh::segment(const Place& a, const Place& b) {
    complex_.segments.push_back({VertexId{point(a)}, VertexId{point(b)}});
}

void GridMesh::facet(int axis, const std::vector<Loop>& polygons, const std::vector<Point3>& holes,
                     const std::vector<Place>& squares) {
    std::vector<std::vector<VertexId>> rings;
    int turn = 0;
    for (const Loop& loop : polygons) {
        std::vector<VertexId> ring;
        for (const Place& p : loop) ring.push_back(VertexId{point(p)});
        rings.push_back(ring);
        if (turn != 0 || loop.size() < 3) continue;
        const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Place &a = loop[i], &b = loop[(i + 1) % loop.size()];
            turn += a[u] * b[v] - a[v] * b[u];
        }
    }
    std::vector<Point3> moved;
    for (const Point3& h : holes) {
        moved.push_back({shift.x + scale * h.x, shift.y + scale * h.y, shift.z + scale * h.z});
    }
    const auto index = static_cast<std::uint32_t>(complex_.facet_count());
    for (const auto& ring : rings) {
        for (const VertexId v : ring) complex_.corners.push_back(v);
        complex_.polygon_offsets.push_back(static_cast<std::uint32_t>(complex_.corners.size()));
    }
    complex_.facet_offsets.push_back(static_cast<std::uint32_t>(complex_.polygon_count()));
    complex_.facet_holes.insert(complex_.facet_holes.end(), moved.begin(), moved.end());
    complex_.hole_offsets.push_back(static_cast<std::uint32_t>(complex_.facet_holes.size()));
    for (const Place& s : squares) squares_.push_back({index, axis, turn < 0, s});
}

void GridMesh::rectangle(int axis, const Place& low, const Place& high, bool down) {
    const auto a = static_cast<std::size_t>(axis), u = (a + 1) % 3, v = (a + 2) % 3;
    Loop loop(4, low);
    loop[1][u] = loop[2][u] = high[u];
    loop[2][v] = loop[3][v] = high[v];
    if (down) std::reverse(loop.begin(), loop.end());
    std::vector<Place> squares;
    for (int i = low[u]; i < high[u]; ++i) {
        for (int j = low[v]; j < high[v]; ++j) {
            Place p = low;
            p[u] = i;
            p[v] = j;
            squares.push_back(p);
        }
    }
    facet(axis, {loop}, {}, squares);
}

void GridMesh::box(const Place& low, const Place& high) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        Place top = high, bottom = low;
        top[a] = low[a];
        bottom[a] = high[a];
        rectangle(axis, low, top, true);
        rectangle(axis, bottom, high);
    }
}

std::vector<Place> GridMesh::line(const Place& a, const Place& b) const {
    const int steps = std::gcd(std::gcd(b[0] - a[0], b[1] - a[1]), b[2] - a[2]);
    std::vector<Place> result;
    for (int i = 0; i <= steps; ++i) {
        result.push_back(
            {a[0] + (b[0] - a[0]) / steps * i, a[1] + (b[1] - a[1]) / steps * i, a[2] + (b[2] - a[2]) / steps * i});
    }
    return result;
}

/// Segments by number, with their ends' places.
void GridMesh::number_segments() {
    std::set<std::array<Place, 2>> known;
    const auto add = [&](const Place& a, const Place& b) {
        if (known.insert(ordered(a, b)).second) chains_.push_back({a, b});
    };
    for (const Edge& e : complex_.segments) add(places_[index_of(e[0])], places_[index_of(e[1])]);
    for (std::size_t p = 0; p < complex_.polygon_count(); ++p) {
        const std::uint32_t begin = complex_.polygon_offsets[p], count = complex_.polygon_offsets[p + 1] - begin;
        for (std::uint32_t i = 0; count > 1 && i < (count == 2 ? 1 : count); ++i) {
            add(places_[index_of(complex_.corners[begin + i])],
                places_[index_of(complex_.corners[begin + (i + 1) % count])]);
        }
    }
}

/// The corners of a unit square in the plane normal to its axis, counter-clockwise about the axis.
std::array<Place, 4> GridMesh::corners(const Square& s) {
    const auto u = static_cast<std::size_t>((s.axis + 1) % 3), v = static_cast<std::size_t>((s.axis + 2) % 3);
    std::array<Place, 4> result{s.corner, s.corner, s.corner, s.corner};
    ++result[1][u];
    ++result[2][u];
    ++result[2][v];
    ++result[3][v];
    return result;
}

void GridMesh::place_vertices(TetMesh& mesh, const std::vector<Place>& cubes) {
    std::set<Place> used;
    for (const auto& [x, y, z] : cubes) {
        for (int c = 0; c < 8; ++c) used.insert({x + (c & 1), y + ((c >> 1) & 1), z + (c >> 2)});
    }
    std::map<Place, VertexSource> carried;
    for (const Square& s : squares_) {
        for (const Place& p : corners(s)) carried.try_emplace(p, VertexSource{VertexOrigin::facet, s.facet});
    }
    for (std::uint32_t s = 0; s < chains_.size(); ++s) {
        for (const Place& p : line(chains_[s][0], chains_[s][1])) carried[p] = {VertexOrigin::segment, s};
    }
    for (const Place& p : used) {
        if (!carried.contains(p)) point(p);
    }
    const auto add = [&](const Place& p, const VertexSource& source) {
        ids_[p] = VertexId{static_cast<std::uint32_t>(mesh.positions.size())};
        mesh.positions.push_back(position(p));
        mesh.vertex_sources.push_back(source);
    };
    ids_.clear();
    for (std::uint32_t i = 0; i < places_.size(); ++i) add(places_[i], {VertexOrigin::input, i});
    for (const Place& p : used) {
        if (!ids_.contains(p)) add(p, carried.at(p));
    }
}

void GridMesh::fill(TetMesh& mesh, const Place& cube) const {
    std::array<std::size_t, 3> axes{0, 1, 2};
    do {
        Place p = cube;
        Tetrahedron t{ids_.at(p)};
        for (std::size_t k = 0; k < 3; ++k) {
            ++p[axes[k]];
            t[k + 1] = ids_.at(p);
        }
        const bool even = (axes[0] + 1) % 3 == axes[1];
        if (!even) std::swap(t[2], t[3]);
        mesh.tetrahedra.push_back(t);
        mesh.tetrahedron_regions.push_back(RegionId{static_cast<std::uint32_t>(region_of(cube))});
    } while (std::next_permutation(axes.begin(), axes.end()));
}

Case GridMesh::make() {
    chains_.clear();
    number_segments();
    std::vector<Place> cubes;
    for (int x = 0; x < size_[0]; ++x) {
        for (int y = 0; y < size_[1]; ++y) {
            for (int z = 0; z < size_[2]; ++z) {
                if (region_of({x, y, z}) >= 0) cubes.push_back({x, y, z});
            }
        }
    }
    Case result;
    TetMesh& mesh = result.mesh;
    place_vertices(mesh, cubes);
    for (const Place& cube : cubes) fill(mesh, cube);
    for (const Square& s : squares_) {
        const auto [p, q, r, t] = corners(s);
        for (Triangle triangle : {Triangle{ids_.at(p), ids_.at(q), ids_.at(r)}, {ids_.at(p), ids_.at(r), ids_.at(t)}}) {
            if (s.down) std::swap(triangle[1], triangle[2]);
            mesh.triangles.push_back(triangle);
            mesh.triangle_facets.push_back(FacetId{s.facet});
        }
    }
    for (std::uint32_t s = 0; s < chains_.size(); ++s) {
        const std::vector<Place> places = line(chains_[s][0], chains_[s][1]);
        for (std::size_t i = 0; i + 1 < places.size(); ++i) {
            mesh.edges.push_back({ids_.at(places[i]), ids_.at(places[i + 1])});
            mesh.edge_segments.push_back(SegmentId{s});
        }
    }
    result.complex = complex_;
    return result;
}

std::string text(const ConformingCheck& check) {
    std::string s;
    for (const Violation& v : check.violations) s += v.promise + ": " + v.message + "\n";
    return s;
}

bool has(const ConformingCheck& check, const std::string& promise) {
    for (const Violation& v : check.violations) {
        if (v.promise == promise) return true;
    }
    return false;
}

Case make_case(std::vector<Point3> positions, std::vector<Tetrahedron> tetrahedra,
               const std::vector<std::vector<std::uint32_t>>& facets, const std::vector<Triangle>& triangles,
               const std::vector<std::uint32_t>& labels) {
    Case c;
    c.mesh.positions = c.complex.positions = std::move(positions);
    c.mesh.vertex_sources.assign(c.mesh.positions.size(), {VertexOrigin::input, 0});
    c.mesh.tetrahedra = std::move(tetrahedra);
    c.mesh.tetrahedron_regions.assign(c.mesh.tetrahedra.size(), RegionId{1});
    c.mesh.triangles = triangles;
    for (const std::uint32_t l : labels) c.mesh.triangle_facets.push_back(FacetId{l});
    std::set<std::array<std::uint32_t, 2>> known;
    for (const auto& f : facets) {
        for (std::size_t i = 0; i < f.size(); ++i) {
            const std::uint32_t a = f[i], b = f[(i + 1) % f.size()];
            c.complex.corners.push_back(VertexId{a});
            if (!known.insert({std::min(a, b), std::max(a, b)}).second) continue;
            c.mesh.edges.push_back({VertexId{a}, VertexId{b}});
            c.mesh.edge_segments.push_back(SegmentId{static_cast<std::uint32_t>(c.mesh.edge_segments.size())});
        }
        c.complex.polygon_offsets.push_back(static_cast<std::uint32_t>(c.complex.corners.size()));
        c.complex.facet_offsets.push_back(static_cast<std::uint32_t>(c.complex.polygon_count()));
        c.complex.hole_offsets.push_back(0);
    }
    return c;
}

namespace {

Tetrahedron tetrahedron(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    return {VertexId{a}, VertexId{b}, VertexId{c}, VertexId{d}};
}
Triangle triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { return {VertexId{a}, VertexId{b}, VertexId{c}}; }

}  // namespace

Case one_tetrahedron() {
    return make_case({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {tetrahedron(0, 1, 2, 3)},
                     {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}},
                     {triangle(1, 2, 3), triangle(0, 3, 2), triangle(0, 1, 3), triangle(0, 2, 1)}, {0, 1, 2, 3});
}

Case cube_of_five() {
    const std::vector<Point3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    const std::vector<Triangle> triangles{triangle(0, 2, 3), triangle(0, 3, 1), triangle(4, 5, 6), triangle(5, 7, 6),
                                          triangle(0, 1, 5), triangle(0, 5, 4), triangle(2, 6, 3), triangle(3, 6, 7),
                                          triangle(0, 4, 6), triangle(0, 6, 2), triangle(1, 3, 5), triangle(3, 7, 5)};
    std::vector<std::vector<std::uint32_t>> facets;
    std::vector<std::uint32_t> labels;
    for (const Triangle& t : triangles) {
        labels.push_back(static_cast<std::uint32_t>(facets.size()));
        facets.push_back({index_of(t[0]), index_of(t[1]), index_of(t[2])});
    }
    return make_case(corners,
                     {tetrahedron(0, 3, 6, 5), tetrahedron(0, 1, 3, 5), tetrahedron(0, 3, 2, 6),
                      tetrahedron(0, 6, 4, 5), tetrahedron(3, 7, 6, 5)},
                     facets, triangles, labels);
}

Case cube(bool squares) {
    GridMesh grid(1, 1, 1);
    if (squares) {
        grid.box({0, 0, 0}, {1, 1, 1});
        return grid.make();
    }
    Case c = [&] {
        grid.box({0, 0, 0}, {1, 1, 1});
        return grid.make();
    }();
    std::vector<std::vector<std::uint32_t>> facets;
    std::vector<std::uint32_t> labels;
    for (const Triangle& t : c.mesh.triangles) {
        labels.push_back(static_cast<std::uint32_t>(facets.size()));
        facets.push_back({index_of(t[0]), index_of(t[1]), index_of(t[2])});
    }
    return make_case(c.mesh.positions, c.mesh.tetrahedra, facets, c.mesh.triangles, labels);
}

}  // namespace certa::test
