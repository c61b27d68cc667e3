#pragma once
// The data that crosses the public face: aggregates of arrays, one per kind of mesh.
// Orientation, units and index conventions are stated once in docs/conventions.md.
#include <certa/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace certa {

using Triangle = std::array<VertexId, 3>;     ///< corners
using Edge = std::array<VertexId, 2>;         ///< ends
using Tetrahedron = std::array<VertexId, 4>;  ///< corners

/// Triangles over shared vertices; counter-clockwise seen from outside.
struct TriangleMesh {
    std::vector<Point3> positions;
    std::vector<Triangle> triangles;
};

/// Polygons over shared vertices. Polygon i owns corners[offsets[i]] ... corners[offsets[i + 1] - 1];
/// offsets has one entry more than there are polygons (two triangles: {0, 3, 6}).
struct PolygonMesh {
    std::vector<Point3> positions;
    std::vector<VertexId> corners;
    std::vector<std::uint32_t> offsets{0};
};

/// A point inside a region of space and what the user wants to call that region.
struct RegionSeed {
    Point3 place;
    double attribute = 0.0;
    double max_volume = 0.0;  ///< 0: no bound. Carried, not used by `conform`.
};

/// Piecewise linear complex: points, segments and planar facets (thesis, Part I, introduction).
///
/// A facet is a set of polygons in one plane. A polygon of three or more vertices is a closed ring, of two an
/// isolated segment, of one an isolated point. The facet is what the rings enclose: everything that cannot be
/// reached in the plane from infinity, nor from one of its hole points, without crossing a ring. A ring inside
/// a ring is therefore a hole only when a hole point says so.
/// Layout: facet f owns polygons facet_offsets[f] ... facet_offsets[f + 1] - 1, polygon p owns
/// corners[polygon_offsets[p]] ..., and facet f owns hole points hole_offsets[f] ... of facet_holes.
struct PiecewiseLinearComplex {
    std::vector<Point3> positions;
    std::vector<Edge> segments;  ///< segments given on their own, in space or in a facet; sides of facets need no entry
    std::vector<VertexId> corners;
    std::vector<std::uint32_t> polygon_offsets{0};
    std::vector<std::uint32_t> facet_offsets{0};
    std::vector<Point3> facet_holes;
    std::vector<std::uint32_t> hole_offsets{0};

    std::vector<std::int32_t> point_markers;    ///< empty, or one per point
    std::vector<std::int32_t> segment_markers;  ///< empty, or one per entry of `segments`
    std::vector<std::int32_t> facet_markers;    ///< empty, or one per facet

    std::vector<Point3> region_holes;  ///< the region around each of these is left out
    std::vector<RegionSeed> region_seeds;

    std::size_t facet_count() const { return facet_offsets.size() - 1; }      ///< number of facets
    std::size_t polygon_count() const { return polygon_offsets.size() - 1; }  ///< number of polygons of all facets
};

/// Appends one facet made of `polygons` (see PiecewiseLinearComplex) and its hole points.
void add_facet(PiecewiseLinearComplex& complex, const std::vector<std::vector<VertexId>>& polygons,
               const std::vector<Point3>& holes = {});

/// Where a vertex of a result comes from.
enum class VertexOrigin : std::uint8_t {
    input,    ///< an input point, at the same index
    segment,  ///< Steiner point on input segment `index`
    facet,    ///< Steiner point inside input facet `index`
};
/// The element of the input that a vertex lies on.
struct VertexSource {
    VertexOrigin origin = VertexOrigin::input;
    std::uint32_t index = 0;
    friend bool operator==(const VertexSource&, const VertexSource&) = default;
};

/// Tetrahedra with labelled constraint triangles and edges. Every labelling array is empty or has one entry per
/// element.
struct TetMesh {
    std::vector<Point3> positions;
    std::vector<VertexSource> vertex_sources;
    std::vector<Tetrahedron> tetrahedra;  ///< positively oriented: det(b - a, c - a, d - a) > 0
    std::vector<RegionId> tetrahedron_regions;
    std::vector<Triangle> triangles;  ///< constraint triangles, oriented like their facet
    std::vector<FacetId> triangle_facets;
    std::vector<Edge> edges;  ///< constraint edges, directed like their segment
    std::vector<SegmentId> edge_segments;
};

/// Elements that a field has numbers for.
enum class Location : std::uint8_t { vertices, polygons, segments, tetrahedra };
/// A named array beside the elements of a document, `components` numbers per element.
struct Field {
    std::string name;
    Location location = Location::vertices;
    std::uint32_t components = 1;
    std::variant<std::vector<double>, std::vector<std::int64_t>> values;
};

/// Which numbers a format that has room for one number per element carries: ids or the user's markers.
enum class Reference : std::uint8_t { id, marker };

/// Everything that a mesh file can say, as it says it: what readers return and writers take (see io.h).
/// `complex` carries points, polygons, segments, their markers, holes and region seeds; `facet_offsets` groups polygons
/// into facets (one polygon per facet in all formats but TetGen's .poly); `tetrahedra` are those of volume formats.
/// Numbers that a volume format attaches to points, segments and polygons ("references") are markers of the complex,
/// those of tetrahedra the integer field "marker". An array of zero markers says nothing: readers leave it empty.
/// Labels are integer fields that count from 1, 0 meaning none: "region" of tetrahedra, "facet" of polygons, "segment"
/// of segments.
struct MeshDocument {
    PiecewiseLinearComplex complex;
    std::vector<Tetrahedron> tetrahedra;
    std::vector<Field> fields;
    /// Set: a format with one number per element writes the labels (id) or the markers, and leaves the other labels
    /// out. Empty: a document with both is refused by such a format.
    std::optional<Reference> reference;
    /// One line that volume formats carry as a comment, such as that a mesh is a partial result. Not read back.
    std::string remark;
    /// What the reader left out of the document, a sentence each ("normals are left out").
    std::vector<std::string> notes;
};

}  // namespace certa
