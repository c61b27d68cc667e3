// Surface meshes as piecewise linear complexes, and the surfaces of documents as meshes. A polygon becomes a facet of
// one ring, in order; a document's segments and points within facets are no faces. Nothing is judged here: `conform`
// and the checkers validate, so that one place reports every defect.
#include <certa/conforming.h>
#include <certa/io.h>

#include <numeric>
#include <utility>

namespace certa {
namespace {

/// Facet i is polygon i; no facet has hole points.
PiecewiseLinearComplex make_single_ring_facets(PolygonMesh mesh) {
    PiecewiseLinearComplex complex;
    complex.positions = std::move(mesh.positions);
    complex.corners = std::move(mesh.corners);
    complex.polygon_offsets = std::move(mesh.offsets);
    if (complex.polygon_offsets.empty()) complex.polygon_offsets.push_back(0);
    complex.facet_offsets.resize(complex.polygon_offsets.size());
    std::iota(complex.facet_offsets.begin(), complex.facet_offsets.end(), 0u);
    complex.hole_offsets.assign(complex.polygon_offsets.size(), 0u);
    return complex;
}

}  // namespace

PiecewiseLinearComplex make_complex(const PolygonMesh& mesh) { return make_single_ring_facets(mesh); }

PiecewiseLinearComplex make_complex(const TriangleMesh& mesh) {
    return make_single_ring_facets(make_polygon_mesh(mesh));
}

PolygonMesh make_polygon_mesh(const TriangleMesh& mesh) {
    PolygonMesh polygons;
    polygons.positions = mesh.positions;
    polygons.corners.reserve(3 * mesh.triangles.size());
    polygons.offsets.reserve(mesh.triangles.size() + 1);
    for (const Triangle& t : mesh.triangles) {
        polygons.corners.insert(polygons.corners.end(), t.begin(), t.end());
        polygons.offsets.push_back(static_cast<std::uint32_t>(polygons.corners.size()));
    }
    return polygons;
}

PolygonMesh make_polygon_mesh(const MeshDocument& document) {
    const PiecewiseLinearComplex& complex = document.complex;
    PolygonMesh mesh;
    mesh.positions = complex.positions;
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const auto begin = complex.corners.begin() + complex.polygon_offsets[p],
                   end = complex.corners.begin() + complex.polygon_offsets[p + 1];
        if (end - begin < 3) continue;
        mesh.corners.insert(mesh.corners.end(), begin, end);
        mesh.offsets.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
    return mesh;
}

TriangleMesh make_triangle_mesh(const MeshDocument& document) {
    const PiecewiseLinearComplex& complex = document.complex;
    TriangleMesh mesh;
    mesh.positions = complex.positions;
    mesh.triangles.reserve(complex.polygon_count());
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const std::uint32_t first = complex.polygon_offsets[p], degree = complex.polygon_offsets[p + 1] - first;
        if (degree != 3)
            throw IoError("document", 0,
                          "polygon " + std::to_string(p + 1) + " has " + std::to_string(degree) +
                              " corners; here every face must be a triangle");
        mesh.triangles.push_back({complex.corners[first], complex.corners[first + 1], complex.corners[first + 2]});
    }
    return mesh;
}

}  // namespace certa
