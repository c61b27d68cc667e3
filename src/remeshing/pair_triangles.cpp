// Greedy matching of triangles across their sides.
#include "remeshing/pair_triangles.h"

#include <algorithm>
#include <cmath>

#include "core/vector3.h"
#include "remeshing/work_mesh.h"

namespace certa::remeshing {
namespace {

constexpr double least_sine = 0.2;  ///< of a quad's corners

/// The least sine of the corners, negative where one turns the wrong way; 0 where the diagonals are too far apart.
double shape_of(const std::array<Point3, 4>& p, double height) {
    const Point3 normal = cross(p[2] - p[0], p[3] - p[1]);
    const double size = norm(normal);
    if (!(size > 0.0) || std::abs(dot(p[1] - p[0], normal)) > height * size) return 0.0;
    double least = 1.0;
    for (std::size_t i = 0; i < 4; ++i) {
        const Point3 in = p[i] - p[(i + 3) % 4], out = p[(i + 1) % 4] - p[i];
        const double lengths = norm(in) * norm(out);
        if (!(lengths > 0.0)) return 0.0;
        least = std::min(least, dot(cross(in, out), normal) / (size * lengths));
    }
    return least;
}

struct Side {
    std::uint64_t key = 0;
    Index polygon = no_index, corner = no_index;  ///< the side starts at this corner of its triangle
    friend bool operator<(const Side& l, const Side& r) {
        return l.key != r.key ? l.key < r.key : l.polygon < r.polygon;
    }
};
struct Pair {
    double shape = 0.0;
    Side first, second;
};

}  // namespace

CoarseMesh pair_triangles(const CoarseMesh& mesh, const std::vector<Index>& group, double height) {
    std::vector<std::uint64_t> features;
    for (const FeatureEdge& e : mesh.feature_edges) features.push_back(pair_key(e.a, e.b));
    std::sort(features.begin(), features.end());
    std::vector<Side> sides;
    for (Index q = 0; q < mesh.polygon_count(); ++q) {
        const auto ring = mesh.polygon(q);
        if (group[q] == no_index || ring.size() != 3) continue;
        for (Index i = 0; i < 3; ++i) sides.push_back({pair_key(ring[i], ring[(i + 1) % 3]), q, i});
    }
    std::sort(sides.begin(), sides.end());
    const auto quad_of = [&](const Side& a, const Side& b) {
        const auto s = mesh.polygon(a.polygon), t = mesh.polygon(b.polygon);
        return std::array{s[a.corner], t[(b.corner + 2) % 3], s[(a.corner + 1) % 3], s[(a.corner + 2) % 3]};
    };
    std::vector<Pair> pairs;
    for (std::size_t i = 1; i < sides.size(); ++i) {
        const Side &a = sides[i - 1], &b = sides[i];
        if (a.key != b.key || group[a.polygon] != group[b.polygon]) continue;
        if (std::binary_search(features.begin(), features.end(), a.key)) continue;
        const auto ring = quad_of(a, b);
        const double shape =
            shape_of({mesh.points[ring[0]], mesh.points[ring[1]], mesh.points[ring[2]], mesh.points[ring[3]]}, height);
        if (shape > least_sine) pairs.push_back({shape, a, b});
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& l, const Pair& r) { return l.shape > r.shape; });
    std::vector<Index> partner(mesh.polygon_count(), no_index);  // per polygon: its pair
    for (Index i = 0; i < pairs.size(); ++i) {
        Index &a = partner[pairs[i].first.polygon], &b = partner[pairs[i].second.polygon];
        if (a == no_index && b == no_index) a = b = i;
    }
    CoarseMesh out = mesh.without_polygons();
    for (Index q = 0; q < mesh.polygon_count(); ++q) {
        if (partner[q] == no_index) {
            out.add_polygon(mesh.polygon(q), mesh.parent(q));
        } else if (const Pair& pair = pairs[partner[q]]; pair.first.polygon == q) {
            out.add_polygon(quad_of(pair.first, pair.second), mesh.parent(q));
        }
    }
    return out;
}

}  // namespace certa::remeshing
