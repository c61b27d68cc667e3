#pragma once
// Valid meshes made by hand: boxes of unit cubes, each cut into six tetrahedra around its main diagonal (Kuhn), which
// is Delaunay (all eight corners on one sphere) and face to face; complexes are drawn on the lattice.
#include <certa/conforming.h>

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <vector>

namespace certa::test {

struct Case {
    TetMesh mesh;
    PiecewiseLinearComplex complex;
};

using Place = std::array<int, 3>;
using Loop = std::vector<Place>;

class GridMesh {
public:
    GridMesh(int x, int y, int z) : size_{x, y, z} {}

    /// Input points in the order of their first mention; corners of the other calls count as mentioned.
    std::uint32_t point(const Place& p);
    void segment(const Place& a, const Place& b);
    /// A facet in the plane normal to `axis`: its polygons, its hole points, and the lower corners of the unit squares
    /// that it covers.
    void facet(int axis, const std::vector<Loop>& polygons, const std::vector<Point3>& holes,
               const std::vector<Place>& squares);
    /// A rectangle from `low` to `high` (equal in `axis`), counter-clockwise about +axis, or about -axis if `down`.
    void rectangle(int axis, const Place& low, const Place& high, bool down = false);
    /// The six sides of a box, normals outwards.
    void box(const Place& low, const Place& high);
    void region_hole(const Point3& p) {
        complex_.region_holes.push_back({shift.x + scale * p.x, shift.y + scale * p.y, shift.z + scale * p.z});
    }
    /// Region of each unit cube; negative: left out. Default: 1 everywhere.
    std::function<int(const Place&)> region_of = [](const Place&) { return 1; };

    /// Lattice points that no segment or facet carries become isolated input points.
    Case make();
    /// As make(), over scaled and translated coordinates.
    double scale = 1.0;
    Point3 shift{};

private:
    struct Square {
        std::uint32_t facet;
        int axis;
        bool down;
        Place corner;
    };
    Point3 position(const Place& p) const;
    std::vector<Place> line(const Place& a, const Place& b) const;
    static std::array<Place, 4> corners(const Square& s);
    void number_segments();
    void place_vertices(TetMesh& mesh, const std::vector<Place>& cubes);
    void fill(TetMesh& mesh, const Place& cube) const;

    Place size_;
    PiecewiseLinearComplex complex_;
    std::map<Place, std::uint32_t> points_;
    std::vector<Place> places_;
    std::vector<Square> squares_;
    std::vector<std::array<Place, 2>> chains_;  // one per segment number
    std::map<Place, VertexId> ids_;
};

/// Labels for a mesh whose facets are polygons of its vertices and that has no added vertices: segments by number, one
/// region.
Case make_case(std::vector<Point3> positions, std::vector<Tetrahedron> tetrahedra,
               const std::vector<std::vector<std::uint32_t>>& facets, const std::vector<Triangle>& triangles,
               const std::vector<std::uint32_t>& triangle_facets);

/// The Delaunay triangulation of random integer points, found by testing all quadruples, and a complex drawn on it:
/// regions are unions of tetrahedra, facets are the triangles between them, each its own, some more are left dangling
/// inside regions. Bounded regions may be left out as holes, and the outside may be dropped.
Case random_case(std::uint64_t seed);

/// Every violation on a line of its own.
std::string text(const ConformingCheck& check);
bool has(const ConformingCheck& check, const std::string& promise);

/// One tetrahedron with its four faces as facets.
Case one_tetrahedron();
/// The unit cube in five or six tetrahedra, its sides as squares or triangles.
Case cube(bool squares);
Case cube_of_five();

}  // namespace certa::test
