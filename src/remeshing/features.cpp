// Creases, boundary and corners (remesh, stage 1; thesis 4.1.5).
//
// Plan: mark boundary edges, tagged edges, and edges with a dihedral angle above the limit, also between the faces that
// slivers lie between; forget groups of creases by angle that are shorter than a few edges and touch nothing else
// (noise, not design): all that on the input as it is, before edges are halved, as whoever checks the result will see
// it. Corners are where not exactly two marked edges meet, or two meet at a sharp turn; chains between corners are
// curves, closed chains too.
#include <algorithm>
#include <numbers>

#include "core/union_find.h"
#include "remeshing/work_mesh.h"

namespace certa::remeshing {
namespace {

enum class Mark : std::uint8_t { none, angle, tagged, boundary };

Point3 normal_of(const WorkMesh& mesh, Index f) {
    const auto& [a, b, c] = mesh.faces[f];
    return cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
}

/// The face that a half-edge belongs to or, as the normals of slivers say nothing, the first one beyond: out of a
/// sliver by the longer of its other two sides. A side of slivers is sharp where what they lie between is.
Index face_beyond_slivers(const WorkMesh& mesh, Index h) {
    constexpr double least_height = 5e-4;  // of the diagonal
    const auto length = [&](Index side) {
        return distance(mesh.points[mesh.start_of(side)], mesh.points[mesh.end_of(side)]);
    };
    for (int step = 0; step < 8; ++step) {
        const Index next = next_of(h), last = next_of(next);
        const double longest = std::max({length(h), length(next), length(last)});
        if (norm(normal_of(mesh, h / 3)) >= least_height * mesh.diagonal * longest) break;
        const Index beyond = mesh.opposites[length(next) >= length(last) ? next : last];
        if (beyond == no_index) break;
        h = beyond;
    }
    return h / 3;
}

double length_of(const WorkMesh& mesh, Index edge) {
    const Index h = mesh.edge_halfedges[edge];
    return distance(mesh.points[mesh.start_of(h)], mesh.points[mesh.end_of(h)]);
}

/// By the ends' point_sources, as pieces of edges are found.
std::uint64_t source_of(const WorkMesh& mesh, Index edge) {
    const Index h = mesh.edge_halfedges[edge];
    return pair_key(mesh.point_sources[mesh.start_of(h)], mesh.point_sources[mesh.end_of(h)]);
}

/// `is_sharp(edge)`: the angle at an edge of two faces makes it a crease.
template <class IsSharp>
std::vector<Mark> mark_edges(const WorkMesh& mesh, IsSharp&& is_sharp) {
    std::vector<Mark> marks(mesh.edge_halfedges.size(), Mark::none);
    for (Index e = 0; e < marks.size(); ++e) {
        if (mesh.opposites[mesh.edge_halfedges[e]] == no_index)
            marks[e] = Mark::boundary;
        else if (mesh.tagged.contains(source_of(mesh, e)))
            marks[e] = Mark::tagged;
        else if (is_sharp(e))
            marks[e] = Mark::angle;
    }
    return marks;
}

std::vector<Index> count_at_vertices(const WorkMesh& mesh, const std::vector<Mark>& marks) {
    std::vector<Index> degree(mesh.points.size(), 0);
    for (std::size_t e = 0; e < marks.size(); ++e) {
        if (marks[e] == Mark::none) continue;
        const Index h = mesh.edge_halfedges[e];
        ++degree[mesh.start_of(h)];
        ++degree[mesh.end_of(h)];
    }
    return degree;
}

/// Groups of creases by angle that nothing else holds up and that are short.
void forget_noise(const WorkMesh& mesh, std::vector<Mark>& marks, double least) {
    core::UnionFind sets(mesh.points.size());
    for (std::size_t e = 0; e < marks.size(); ++e) {
        const Index h = mesh.edge_halfedges[e];
        if (marks[e] != Mark::none) sets.unite(mesh.start_of(h), mesh.end_of(h));
    }
    std::vector<double> length(mesh.points.size(), 0.0);
    std::vector<bool> held(mesh.points.size(), false);
    for (std::size_t e = 0; e < marks.size(); ++e) {
        if (marks[e] == Mark::none) continue;
        const Index group = sets.find(mesh.start_of(mesh.edge_halfedges[e]));
        length[group] += length_of(mesh, static_cast<Index>(e));
        if (marks[e] != Mark::angle) held[group] = true;
    }
    for (std::size_t e = 0; e < marks.size(); ++e) {
        if (marks[e] != Mark::angle) continue;
        const Index group = sets.find(mesh.start_of(mesh.edge_halfedges[e]));
        if (!held[group] && length[group] < least) marks[e] = Mark::none;
    }
}

/// Short chains by angle that end in nothing.
void forget_whiskers(const WorkMesh& mesh, std::vector<Mark>& marks, double least) {
    std::vector<std::vector<Index>> incident(mesh.points.size());
    for (Index e = 0; e < marks.size(); ++e) {
        if (marks[e] == Mark::none) continue;
        incident[mesh.start_of(mesh.edge_halfedges[e])].push_back(e);
        incident[mesh.end_of(mesh.edge_halfedges[e])].push_back(e);
    }
    for (Index tip = 0; tip < mesh.points.size(); ++tip) {
        if (incident[tip].size() != 1) continue;
        std::vector<Index> chain;
        double length = 0.0;
        Index v = tip, edge = incident[tip].front();
        while (marks[edge] == Mark::angle) {
            chain.push_back(edge);
            length += mesh.lengths[edge];
            const Index h = mesh.edge_halfedges[edge];
            v = mesh.start_of(h) == v ? mesh.end_of(h) : mesh.start_of(h);
            if (incident[v].size() != 2) break;
            edge = incident[v][0] == edge ? incident[v][1] : incident[v][0];
        }
        if (length >= least || chain.empty() || marks[edge] != Mark::angle) continue;
        for (const Index e : chain) {
            marks[e] = Mark::none;
            const Index h = mesh.edge_halfedges[e];
            std::erase(incident[mesh.start_of(h)], e);
            std::erase(incident[mesh.end_of(h)], e);
        }
    }
}

class CurveBuilder {
public:
    CurveBuilder(WorkMesh& mesh, const std::vector<Mark>& marks) : mesh_(mesh), marks_(marks) {
        const std::vector<Index> degree = count_at_vertices(mesh, marks);
        offsets_.assign(mesh.points.size() + 1, 0);
        for (std::size_t v = 0; v < degree.size(); ++v) offsets_[v + 1] = offsets_[v] + degree[v];
        incident_.resize(offsets_.back());
        std::vector<Index> at(offsets_.begin(), offsets_.end() - 1);
        for (std::size_t e = 0; e < marks.size(); ++e) {
            if (marks[e] == Mark::none) continue;
            const Index h = mesh.edge_halfedges[e];
            incident_[at[mesh.start_of(h)]++] = static_cast<Index>(e);
            incident_[at[mesh.end_of(h)]++] = static_cast<Index>(e);
        }
        mesh_.is_corner.assign(mesh.points.size(), false);
        for (Index v = 0; v < degree.size(); ++v) mesh_.is_corner[v] = is_corner(v, degree[v]);
    }

    const std::vector<bool>& corners() const { return mesh_.is_corner; }
    void build() {
        mesh_.edge_curves.assign(marks_.size(), no_index);
        for (Index v = 0; v < mesh_.points.size(); ++v)
            if (mesh_.is_corner[v])
                for (Index i = offsets_[v]; i < offsets_[v + 1]; ++i) follow(v, incident_[i]);
        for (Index e = 0; e < marks_.size(); ++e)
            if (marks_[e] != Mark::none) follow(mesh_.start_of(mesh_.edge_halfedges[e]), e);
    }

private:
    Index other_end(Index edge, Index v) const {
        const Index h = mesh_.edge_halfedges[edge];
        return mesh_.start_of(h) == v ? mesh_.end_of(h) : mesh_.start_of(h);
    }
    bool is_corner(Index v, Index degree) const {
        if (degree != 2) return degree > 0;
        const Index a = incident_[offsets_[v]], b = incident_[offsets_[v] + 1];
        if ((marks_[a] == Mark::boundary) != (marks_[b] == Mark::boundary)) return true;
        const Point3 p = mesh_.points[v] - mesh_.points[other_end(a, v)];
        const Point3 q = mesh_.points[other_end(b, v)] - mesh_.points[v];
        return dot(p, q) < std::cos(turn) * norm(p) * norm(q);
    }
    void follow(Index v, Index edge) {
        if (mesh_.edge_curves[edge] != no_index) return;
        const Index number = static_cast<Index>(mesh_.curves.size());
        FeatureCurve curve;
        curve.boundary = marks_[edge] == Mark::boundary;
        const Index start = v;
        curve.vertices.push_back(v);
        while (true) {
            mesh_.edge_curves[edge] = number;
            curve.edges.push_back(edge);
            v = other_end(edge, v);
            if (v == start && !mesh_.is_corner[v]) {
                curve.closed = true;
                break;
            }
            curve.vertices.push_back(v);
            if (mesh_.is_corner[v]) break;
            const Index a = incident_[offsets_[v]], b = incident_[offsets_[v] + 1];
            edge = a == edge ? b : a;
        }
        mesh_.curves.push_back(std::move(curve));
    }

    static constexpr double turn = 45.0 * std::numbers::pi / 180.0;
    WorkMesh& mesh_;
    const std::vector<Mark>& marks_;
    std::vector<Index> offsets_, incident_;
};

}  // namespace

std::unordered_set<std::uint64_t> find_sharp_edges(const WorkMesh& mesh, const RemeshOptions& options) {
    const double limit = std::cos(options.feature_angle_radians);
    const auto is_sharp = [&](Index first, Index second) {
        const Point3 n = normal_of(mesh, first), m = normal_of(mesh, second);
        const double lengths = norm(n) * norm(m);
        return lengths > 0.0 && dot(n, m) < limit * lengths;
    };
    std::vector<Mark> marks = mark_edges(mesh, [&](Index e) {
        const Index h = mesh.edge_halfedges[e], o = mesh.opposites[h];
        return is_sharp(h / 3, o / 3) && is_sharp(face_beyond_slivers(mesh, h), face_beyond_slivers(mesh, o));
    });
    double total = 0.0;
    for (Index e = 0; e < marks.size(); ++e) total += length_of(mesh, e);
    const double mean = total / static_cast<double>(marks.size());
    forget_noise(mesh, marks, std::min(0.03 * mesh.diagonal, 12.0 * mean));
    std::unordered_set<std::uint64_t> sharp;
    for (Index e = 0; e < marks.size(); ++e)
        if (marks[e] == Mark::angle) sharp.insert(source_of(mesh, e));
    return sharp;
}

void find_features(WorkMesh& mesh, const RemeshOptions& options, RemeshStatistics& statistics) {
    const std::vector<Mark> all = mark_edges(mesh, [&](Index e) { return mesh.sharp.contains(source_of(mesh, e)); });
    std::vector<Mark> marks;  // without what no curve should follow
    const std::vector<bool> all_corners = CurveBuilder(mesh, all).corners();
    const auto forget_short = [&](double longest) {
        marks = all;
        forget_whiskers(mesh, marks, longest);
        forget_noise(mesh, marks, 3.0 * longest);
    };
    forget_short(0.04 * mesh.diagonal);
    // An error is promised for all of them: sides had better follow what is longer. Where there are many, it is noise.
    const double error = options.error.value_or(default_remesh_error).resolve(mesh.diagonal);
    constexpr double many = 0.01;  // of all edges
    std::size_t minor = 0;
    for (std::size_t e = 0; e < marks.size(); ++e) minor += all[e] != marks[e] ? 1 : 0;
    if (!options.vertices && !options.faces && double(minor) < many * double(marks.size()))
        forget_short(std::min(0.04 * mesh.diagonal, 3.0 * error));
    CurveBuilder(mesh, marks).build();
    for (Index e = 0; e < marks.size(); ++e)
        if (all[e] != marks[e]) mesh.minor_edges.push_back(e);
    for (Index v = 0; v < mesh.points.size(); ++v)
        if (all_corners[v] && !mesh.is_corner[v]) mesh.minor_corners.push_back(v);
    statistics.feature_curves = mesh.curves.size();
    statistics.feature_edges =
        static_cast<std::size_t>(std::count_if(marks.begin(), marks.end(), [](Mark m) { return m != Mark::none; }));
    statistics.corners = static_cast<std::size_t>(std::count(mesh.is_corner.begin(), mesh.is_corner.end(), true));
    core::UnionFind loops(mesh.points.size());
    std::vector<bool> on_boundary(mesh.points.size(), false);
    for (std::size_t e = 0; e < marks.size(); ++e) {
        if (marks[e] != Mark::boundary) continue;
        const Index a = mesh.start_of(mesh.edge_halfedges[e]), b = mesh.end_of(mesh.edge_halfedges[e]);
        on_boundary[a] = on_boundary[b] = true;
        loops.unite(a, b);
    }
    for (Index v = 0; v < mesh.points.size(); ++v)
        statistics.boundary_loops += on_boundary[v] && loops.find(v) == v ? 1 : 0;
}

}  // namespace certa::remeshing
