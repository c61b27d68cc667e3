#pragma once
// What a mesh file holds, in numbers: counts, box, topology of its surface, its tetrahedra.
#include <certa/mesh.h>

#include <cstdint>
#include <optional>

namespace certa {

/// The polygons of three or more corners, as a surface. An edge is a pair of vertices that are neighbours in a polygon.
struct SurfaceInfo {
    std::size_t polygons = 0;
    std::size_t smallest_degree = 0, largest_degree = 0;  ///< corners of a polygon
    std::size_t vertices = 0;                             ///< points that some polygon uses
    std::size_t edges = 0;
    std::size_t boundary_edges = 0;         ///< of one polygon only
    std::size_t boundary_loops = 0;         ///< connected components of the boundary edges
    std::size_t non_manifold_edges = 0;     ///< of three or more polygons
    std::size_t non_manifold_vertices = 0;  ///< whose polygons are not one fan across common edges
    std::size_t components = 0;             ///< connected by edges
    std::size_t repeated_polygons = 0;      ///< polygons on the same vertices as an earlier one
    std::size_t inconsistent_edges = 0;     ///< manifold edges that both polygons walk in the same direction
    bool closed = false;                    ///< no boundary edges (and some polygon)
    bool manifold = false;                  ///< no non-manifold edges or vertices (and some polygon)
    bool orientable = false;                ///< manifold, and some choice of orientations agrees on every edge
    std::optional<std::int64_t> euler_characteristic;  ///< V - E + F; none where a facet has several polygons
    std::optional<std::int64_t> genus;  ///< all components together; manifold and orientable surfaces only
    double area = 0.0;                  ///< of the polygons, each fanned from its first corner
    std::optional<double> volume;  ///< enclosed, positive for normals that point outwards; closed, consistent surfaces
};

/// The tetrahedra of a document, in numbers.
struct TetrahedraInfo {
    std::size_t tetrahedra = 0;
    std::size_t vertices = 0;                ///< points that some tetrahedron uses
    std::size_t regions = 0;                 ///< different values of the field "region"; 0 without it
    std::size_t components = 0;              ///< connected by triangles
    std::size_t boundary_triangles = 0;      ///< of one tetrahedron only
    std::size_t non_manifold_triangles = 0;  ///< of three or more tetrahedra
    std::size_t flat = 0, inverted = 0;      ///< volume exactly zero, negative
    double volume = 0.0;
    double smallest_dihedral_radians = 0.0, largest_dihedral_radians = 0.0;  ///< over those that are positive
};

/// A document, in numbers.
struct DocumentInfo {
    std::size_t points = 0, duplicate_points = 0, unused_points = 0;  ///< duplicates: equal to an earlier point
    std::size_t segments = 0;                                         ///< given on their own
    std::size_t facets = 0, isolated_segments = 0, isolated_points = 0, facet_holes = 0;
    std::size_t region_holes = 0, region_seeds = 0;
    Point3 lower, upper;    ///< corners of the bounding box
    double diagonal = 0.0;  ///< of the bounding box
    SurfaceInfo surface;
    TetrahedraInfo tetrahedra;
};

/// Counts and measures what a document holds.
///
/// Input:     any document that a reader returned.
/// Guarantee: counts and signs are exact; area, volume and angles are rounded sums in the input's unit.
/// Cost:      O(n log n); deterministic.
DocumentInfo compute_info(const MeshDocument& document);

}  // namespace certa
