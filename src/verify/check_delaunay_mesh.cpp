// What can be said about a tetrahedral mesh when nobody knows what it was made from. Its own constraint triangles and
// edges stand in for the complex, whatever its labels say: the stages that decide form and Delaunay property then have
// all that they ask for, and what the others find (they compare the mesh with itself) is left out.
#include <certa/conforming.h>

#include <algorithm>

namespace certa {
namespace {

/// Every triangle a facet, every edge a segment.
PiecewiseLinearComplex make_own_complex(const TetMesh& mesh) {
    PiecewiseLinearComplex complex;
    complex.positions = mesh.positions;
    complex.segments = mesh.edges;
    for (const Triangle& triangle : mesh.triangles) {
        complex.corners.insert(complex.corners.end(), triangle.begin(), triangle.end());
        complex.polygon_offsets.push_back(static_cast<std::uint32_t>(complex.corners.size()));
        complex.facet_offsets.push_back(static_cast<std::uint32_t>(complex.polygon_count()));
    }
    complex.hole_offsets.assign(mesh.triangles.size() + 1, 0);
    return complex;
}

TetMesh relabel(const TetMesh& mesh) {
    TetMesh own = mesh;
    own.vertex_sources.clear();
    own.triangle_facets.resize(own.triangles.size());
    own.edge_segments.resize(own.edges.size());
    for (std::uint32_t i = 0; i < own.triangles.size(); ++i) own.triangle_facets[i] = FacetId{i};
    for (std::uint32_t i = 0; i < own.edges.size(); ++i) own.edge_segments[i] = SegmentId{i};
    return own;
}

bool is_decided_alone(const Violation& violation) {
    return violation.promise == "delaunay" || violation.promise == "well-formed" || violation.promise == "gabriel";
}

}  // namespace

ConformingCheck check_delaunay_mesh(const TetMesh& mesh, const ConformingCheckOptions& options,
                                    const RunControl& control) {
    ConformingCheck check = check_conforming(relabel(mesh), make_own_complex(mesh), options, control);
    std::erase_if(check.violations, [](const Violation& v) { return !is_decided_alone(v); });
    check.violation_count = check.violations.size();
    return check;
}

}  // namespace certa
