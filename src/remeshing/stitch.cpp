// Copies of a vertex are where the input had one: equal coordinates find them.
#include "remeshing/stitch.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace certa::remeshing {

std::vector<Index> stitched_vertices(const CoarseMesh& mesh) {
    const auto in_order = [](const Point3& a, const Point3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    std::map<Point3, Index, decltype(in_order)> first(in_order);
    std::vector<Index> place(mesh.points.size());  // per vertex: the first in its place
    for (Index v = 0; v < mesh.points.size(); ++v) place[v] = first.emplace(mesh.points[v], v).first->second;
    std::vector<std::uint8_t> is_apart(mesh.points.size(), 0);  // per place
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        std::vector<Index> places;
        for (const Index v : mesh.polygon(q)) places.push_back(place[v]);
        std::sort(places.begin(), places.end());
        for (std::size_t i = 1; i < places.size(); ++i)
            if (places[i] == places[i - 1]) is_apart[places[i]] = 1;
    }
    for (Index v = 0; v < place.size(); ++v)
        if (is_apart[place[v]] != 0) is_apart[v] = 1;
    for (Index v = 0; v < place.size(); ++v)
        if (is_apart[v] != 0) place[v] = v;
    return place;
}

std::size_t count_vertices(const CoarseMesh& mesh, bool stitched) {
    std::vector<Index> used = mesh.corners;
    if (stitched) {
        const std::vector<Index> keys = stitched_vertices(mesh);
        for (Index& v : used) v = keys[v];
    }
    std::sort(used.begin(), used.end());
    return static_cast<std::size_t>(std::unique(used.begin(), used.end()) - used.begin());
}

CoarseMesh stitch(const CoarseMesh& mesh) {
    const std::vector<Index> keys = stitched_vertices(mesh);
    std::vector<Index> numbers(mesh.points.size(), no_index);
    CoarseMesh out;
    const auto number_of = [&](Index v) {
        const Index key = keys[v];
        if (numbers[key] == no_index)
            numbers[key] = out.add_vertex(mesh.points[v], mesh.places[v], mesh.kinds[v], mesh.curves[v]);
        return numbers[key];
    };
    std::vector<Index> ring;
    for (std::size_t q = 0; q < mesh.polygon_count(); ++q) {
        ring.clear();
        for (const Index v : mesh.polygon(q)) ring.push_back(number_of(v));
        out.add_polygon(ring, mesh.parent(q));
    }
    for (const FeatureEdge& e : mesh.feature_edges)
        out.feature_edges.push_back({number_of(e.a), number_of(e.b), e.curve});
    return out;
}

}  // namespace certa::remeshing
