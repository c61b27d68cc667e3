// Regions of the graph's faces, and which part of the input each of them is.
//
// The rim of a region are half-edges of the graph with the region on their left: pieces of lines, which pass edges of
// the work mesh at places whose order is exact, and pieces of creases. surface_cut.cpp cuts the triangles along them.
#include "remeshing/region_patch.h"

#include <algorithm>

#include "remeshing/surface_cut.h"

namespace certa::remeshing {
void sort_unique(std::vector<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

namespace {

std::vector<std::uint8_t> mark_minor(const WorkMesh& mesh) {
    std::vector<std::uint8_t> is_minor(mesh.edge_halfedges.size(), 0);
    for (const Index e : mesh.minor_edges) is_minor[e] = 1;
    return is_minor;
}

}  // namespace

std::int64_t characteristic_of(const RegionPatch& patch) {
    std::vector<std::array<Index, 2>> edges;
    for (const auto& t : patch.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            edges.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return static_cast<std::int64_t>(patch.outer.size() + patch.inner.size() + patch.triangles.size()) -
           static_cast<std::int64_t>(edges.size());
}

RegionPatcher::RegionPatcher(const Layout& layout) : layout_(layout), mesh_(layout.network.mesh()) {
    owners_.assign(2 * layout_.graph.edges.size(), no_index);
    node_faces_.resize(layout_.graph.nodes.size());
    names_.vertices.assign(layout_.graph.nodes.size(), no_index);
    names_.is_merged.assign(layout_.graph.nodes.size(), 0);
    names_.is_minor = mark_minor(mesh_);
    for (Index v = 0; v < layout_.nodes.size(); ++v) names_.vertices[layout_.nodes[v]] = v;
    for (const MergedVertex& m : layout_.merged) {
        names_.vertices[layout_.nodes[m.vertex]] = m.into;
        names_.is_merged[layout_.nodes[m.vertex]] = 1;
    }
    component_faces_.resize(mesh_.component_count);
    for (Index f = 0; f < layout_.faces.size(); ++f) {
        for (const Index h : layout_.faces[f]) {
            owners_[h] = f;
            node_faces_[layout_.graph.tail(h)].push_back(f);
        }
        const Index triangle = triangle_beside(layout_.graph, layout_.network, layout_.faces[f].front());
        face_components_.push_back(mesh_.components[triangle]);
        component_faces_[face_components_.back()].push_back(f);
    }
}

std::vector<Index> RegionPatcher::grow(const std::vector<Index>& faces) const {
    std::vector<Index> grown = faces;
    for (const Index f : faces)
        for (const Index h : layout_.faces[f]) {
            const auto& around = node_faces_[layout_.graph.tail(h)];
            grown.insert(grown.end(), around.begin(), around.end());
        }
    sort_unique(grown);
    return grown;
}

std::vector<Index> RegionPatcher::rim_of(const std::vector<Index>& faces) const {
    std::vector<Index> rim;
    for (const Index f : faces)
        for (const Index h : layout_.faces[f]) {
            const Index other = owners_[h ^ 1U];
            if (other == no_index || !std::binary_search(faces.begin(), faces.end(), other)) rim.push_back(h);
        }
    return rim;
}

std::vector<Index> RegionPatcher::pinches(const std::vector<Index>& rim) const {
    std::vector<Index> starts, twice;
    for (const Index h : rim) starts.push_back(layout_.graph.tail(h));
    std::sort(starts.begin(), starts.end());
    for (std::size_t i = 1; i < starts.size(); ++i)
        if (starts[i] == starts[i - 1]) twice.push_back(starts[i]);
    return twice;
}

std::vector<Index> RegionPatcher::grow_for_patch(const std::vector<Index>& faces) const {
    std::vector<Index> grown = faces;
    for (const Index n : pinches(rim_of(faces)))
        grown.insert(grown.end(), node_faces_[n].begin(), node_faces_[n].end());
    sort_unique(grown);
    return grown.size() > faces.size() ? grown : grow(faces);
}

bool RegionPatcher::is_whole(const std::vector<Index>& faces) const {
    std::vector<Index> all;
    for (const Index f : faces) all.push_back(face_components_[f]);
    sort_unique(all);
    std::size_t count = 0;
    for (const Index c : all) count += component_faces_[c].size();
    return count == faces.size();
}

std::int64_t RegionPatcher::characteristic(const std::vector<Index>& faces) const {
    std::vector<Index> nodes, edges;
    for (const Index f : faces)
        for (const Index h : layout_.faces[f]) {
            nodes.push_back(layout_.graph.tail(h));
            edges.push_back(h / 2);
        }
    sort_unique(nodes);
    sort_unique(edges);
    return static_cast<std::int64_t>(nodes.size() + faces.size()) - static_cast<std::int64_t>(edges.size());
}

std::optional<RegionPatch> RegionPatcher::make(const std::vector<Index>& faces) const {
    if (is_whole(faces)) {
        std::vector<Index> components;
        for (const Index f : faces) components.push_back(face_components_[f]);
        sort_unique(components);
        std::vector<Index> triangles;
        for (Index f = 0; f < mesh_.face_count(); ++f)
            if (std::binary_search(components.begin(), components.end(), mesh_.components[f])) triangles.push_back(f);
        return cut_surface(layout_.network, layout_.graph, {}, triangles, names_);
    }
    const std::vector<Index> rim = rim_of(faces);
    if (!pinches(rim).empty()) return std::nullopt;
    std::optional<RegionPatch> patch = cut_surface(layout_.network, layout_.graph, rim, {}, names_);
    // Cycles around what is no disk do not tell its topology; the cut itself keeps it.
    const bool is_told = std::none_of(faces.begin(), faces.end(), [&](Index f) {
        return std::binary_search(layout_.open.begin(), layout_.open.end(), f);
    });
    if (patch && is_told && characteristic_of(*patch) != characteristic(faces)) return std::nullopt;
    return patch;
}

RegionPatch take_part(const WorkMesh& mesh, std::span<const Index> triangles) {
    const Network network(mesh);
    return *cut_surface(network, {}, {}, triangles, {{}, {}, mark_minor(mesh)});
}

RegionPatch take_all(const WorkMesh& mesh) {
    std::vector<Index> triangles(mesh.face_count());
    for (Index f = 0; f < triangles.size(); ++f) triangles[f] = f;
    return take_part(mesh, triangles);
}

}  // namespace certa::remeshing
