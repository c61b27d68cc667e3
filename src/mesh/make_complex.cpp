// A surface mesh as a piecewise linear complex: every polygon becomes a facet of one ring, in order.
// Nothing is judged here: `conform` validates, so that one place reports every defect.
#include <certa/conforming.h>

#include <numeric>

namespace certa {
namespace {

/// Facet i is polygon i; no facet has hole points.
void make_single_ring_facets(PiecewiseLinearComplex& complex) {
    complex.facet_offsets.resize(complex.polygon_offsets.size());
    std::iota(complex.facet_offsets.begin(), complex.facet_offsets.end(), 0u);
    complex.hole_offsets.assign(complex.polygon_offsets.size(), 0u);
}

}  // namespace

PiecewiseLinearComplex make_complex(const PolygonMesh& mesh) {
    PiecewiseLinearComplex complex;
    complex.positions = mesh.positions;
    complex.corners = mesh.corners;
    complex.polygon_offsets = mesh.offsets;
    if (complex.polygon_offsets.empty()) complex.polygon_offsets.push_back(0);
    make_single_ring_facets(complex);
    return complex;
}

PiecewiseLinearComplex make_complex(const TriangleMesh& mesh) {
    PiecewiseLinearComplex complex;
    complex.positions = mesh.positions;
    complex.corners.reserve(3 * mesh.triangles.size());
    complex.polygon_offsets.reserve(mesh.triangles.size() + 1);
    for (const Triangle& t : mesh.triangles) {
        complex.corners.insert(complex.corners.end(), t.begin(), t.end());
        complex.polygon_offsets.push_back(static_cast<std::uint32_t>(complex.corners.size()));
    }
    make_single_ring_facets(complex);
    return complex;
}

}  // namespace certa
