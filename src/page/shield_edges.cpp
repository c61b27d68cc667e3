// A mesh file carries the radii of protecting balls at their centres, which are vertices, but not the shield edges:
// these follow. An isosceles triangle of the protected area (thesis, Part I, 1.1.3) is a constraint triangle with one
// corner at the centre of a ball and the others on its boundary; the side between those is a shield edge. In
// right-angled triangles the corner on the segment is inside the ball.
#include "page/shield_edges.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/vector3.h"

namespace certa::page {
namespace {

/// Points are put on a ball's boundary up to rounding, which far from the origin is more than a share of the radius.
bool is_on_ball(const Point3& centre, double radius, const Point3& p) {
    const double largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return std::abs(norm(p - centre) - radius) <= 1e-9 * radius + 64 * 0x1p-52 * largest;
}

}  // namespace

std::vector<std::uint32_t> find_shield_edges(const MeshDocument& document) {
    const std::vector<double>* radii = nullptr;
    for (const Field& field : document.fields)
        if (field.name == "ball_radius" && field.location == Location::vertices && field.components == 1)
            radii = std::get_if<std::vector<double>>(&field.values);
    std::vector<std::uint32_t> shields;
    if (radii == nullptr) return shields;
    const PiecewiseLinearComplex& complex = document.complex;
    std::set<std::pair<std::uint32_t, std::uint32_t>> known;
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const std::uint32_t first = complex.polygon_offsets[p];
        if (complex.polygon_offsets[p + 1] - first != 3) continue;
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t centre = index_of(complex.corners[first + i]);
            const double radius = (*radii)[centre];
            if (!(radius > 0.0)) continue;
            const std::uint32_t a = index_of(complex.corners[first + (i + 1) % 3]);
            const std::uint32_t b = index_of(complex.corners[first + (i + 2) % 3]);
            const Point3& o = complex.positions[centre];
            if (!is_on_ball(o, radius, complex.positions[a]) || !is_on_ball(o, radius, complex.positions[b])) continue;
            if (known.emplace(std::min(a, b), std::max(a, b)).second) shields.insert(shields.end(), {a, b});
        }
    }
    return shields;
}

}  // namespace certa::page
