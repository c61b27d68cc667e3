// Sides that would be walked twice in one direction, and a way out: a vertex in the middle of the polygon.
#include "remeshing/crowded.h"

#include <algorithm>

#include "core/vector3.h"

namespace certa::remeshing {

std::vector<Index> crowded_vertices(const CoarseMesh& mesh) {
    std::vector<std::array<Index, 2>> sides;
    for (std::size_t i = 0; i < mesh.polygon_count(); ++i) {
        const auto ring = mesh.polygon(i);
        for (std::size_t k = 0; k < ring.size(); ++k) sides.push_back({ring[k], ring[(k + 1) % ring.size()]});
    }
    std::sort(sides.begin(), sides.end());
    std::vector<Index> crowded;
    for (std::size_t i = 1; i < sides.size(); ++i)
        if (sides[i] == sides[i - 1]) crowded.insert(crowded.end(), sides[i].begin(), sides[i].end());
    return crowded;
}

CoarseMesh fan_out(const CoarseMesh& mesh, const std::vector<Index>& crowded) {
    CoarseMesh out = mesh.without_polygons();
    for (std::size_t i = 0; i < mesh.polygon_count(); ++i) {
        const auto ring = mesh.polygon(i);
        const std::size_t n = ring.size();
        bool fan = false;
        for (std::size_t k = 0; k + 1 < crowded.size() && !fan; k += 2) {
            const auto a = std::find(ring.begin(), ring.end(), crowded[k]);
            const auto b = std::find(ring.begin(), ring.end(), crowded[k + 1]);
            if (a == ring.end() || b == ring.end()) continue;
            const std::size_t gap = static_cast<std::size_t>(std::abs(a - b));
            fan = gap != 1 && gap + 1 != n;
        }
        if (!fan) {
            out.add_polygon(ring, mesh.parent(i));
            continue;
        }
        Point3 middle;
        for (const Index v : ring) middle = middle + (1.0 / static_cast<double>(n)) * mesh.points[v];
        const Index center = out.add_vertex(middle, mesh.places[ring[0]]);
        for (std::size_t k = 0; k < n; ++k)
            out.add_polygon(std::array{ring[k], ring[(k + 1) % n], center}, mesh.parent(i));
    }
    return out;
}

}  // namespace certa::remeshing
