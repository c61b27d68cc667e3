// Far from the origin, middles of edges and points on lines would be rounded by more than the surface can bear;
// differences of its own coordinates are exact. So the work is done around one of its points.
#include "remeshing/nearer_origin.h"

#include <algorithm>
#include <cmath>

#include "core/vector3.h"

namespace certa::remeshing {

std::optional<Point3> far_origin(const TriangleMesh& mesh) {
    constexpr double far = 1e3, too_far = 1e9;  // sizes of the surface
    if (mesh.positions.empty()) return std::nullopt;
    Point3 origin = mesh.positions.front();
    double size = 0.0;
    for (const Point3& p : mesh.positions) {
        const Point3 d = p - origin;
        if (!std::isfinite(norm(d))) return std::nullopt;
        size = std::max({size, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    }
    const double away = std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)});
    if (!(size > 0.0 && away > far * size)) return std::nullopt;
    // Less is left then than a bound on the distance can tell.
    if (away > too_far * size)
        throw InputError({{DefectKind::coordinate_out_of_range,
                           {{ElementKind::vertex, 0}},
                           origin,
                           "the surface is more than 1e9 times as far from the origin as it is large: its coordinates "
                           "have too few digits left to be remeshed reliably; move it to the origin before it is "
                           "saved"}});
    for (double* coordinate : {&origin.x, &origin.y, &origin.z})
        if (!(std::abs(*coordinate) > far * size)) *coordinate = 0.0;
    const bool is_exact = std::all_of(mesh.positions.begin(), mesh.positions.end(),
                                      [&](const Point3& p) { return (p - origin) + origin == p; });
    return is_exact ? std::optional(origin) : std::nullopt;
}

RemeshResult remesh_near_origin(const TriangleMesh& mesh, const Point3& origin, const RemeshOptions& options,
                                const RunControl& control) {
    TriangleMesh moved = mesh;
    for (Point3& p : moved.positions) p = p - origin;
    try {
        RemeshResult result = remesh(moved, options, control);
        for (Point3& p : result.mesh.positions) p = p + origin;
        for (CurvatureLine& line : result.lines)
            for (Point3& p : line.points) p = p + origin;
        for (Umbilic& u : result.umbilics) u.place = u.place + origin;
        return result;
    } catch (const InputError& error) {
        std::vector<Defect> defects = error.defects();
        for (Defect& defect : defects)
            if (!defect.elements.empty()) defect.place = defect.place + origin;
        throw InputError(std::move(defects));
    }
}

}  // namespace certa::remeshing
