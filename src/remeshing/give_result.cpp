// Copies into the public structures.
#include "remeshing/give_result.h"

#include <cmath>
#include <cstdlib>
#include <locale>
#include <sstream>

#include "core/vector3.h"

namespace certa::remeshing {

void give_polygons(const CoarseMesh& mesh, RemeshResult& result) {
    result.mesh = {};
    result.feature_edges.clear();
    result.feature_curves.clear();
    result.mesh.positions = mesh.points;
    for (const Index c : mesh.corners) result.mesh.corners.push_back(VertexId{c});
    result.mesh.offsets = mesh.offsets;
    for (const FeatureEdge& e : mesh.feature_edges) {
        result.feature_edges.push_back({VertexId{e.a}, VertexId{e.b}});
        result.feature_curves.push_back(e.curve);
    }
    RemeshStatistics& s = result.statistics;
    s.vertices = mesh.points.size();
    s.faces = mesh.polygon_count();
    s.quads = s.triangles = 0;
    for (std::size_t i = 0; i < s.faces; ++i) {
        s.quads += mesh.polygon(i).size() == 4 ? 1 : 0;
        s.triangles += mesh.polygon(i).size() == 3 ? 1 : 0;
    }
}

namespace {

Point3 place_of(const FieldUmbilic& u, const WorkMesh& mesh) {
    const auto& f = mesh.faces[u.face];
    return u.weights[0] * mesh.points[f[0]] + u.weights[1] * mesh.points[f[1]] + u.weights[2] * mesh.points[f[2]];
}

}  // namespace

void count_umbilics(const DirectionField& field, const WorkMesh& mesh, RemeshStatistics& s) {
    const FieldUmbilic* first = nullptr;
    for (const FieldUmbilic& u : field.umbilics) {
        s.wedges += u.half_turns == 1 ? 1 : 0;
        s.trisectors += u.half_turns == -1 ? 1 : 0;
        s.umbilic_half_turns += u.half_turns;
        s.umbilics_typed_otherwise += u.typed_half_turns != u.half_turns ? 1 : 0;
        if (std::abs(u.half_turns) < 2) continue;
        ++s.multiple_umbilics;
        if (first == nullptr) first = &u;
    }
    if (first == nullptr) return;
    const Point3 p = place_of(*first, mesh);
    std::ostringstream note;
    note.imbue(std::locale::classic());
    note << "directions turn more than once around " << s.multiple_umbilics
         << (s.multiple_umbilics == 1 ? " triangle" : " triangles") << " of the input, first near (" << p.x << ", "
         << p.y << ", " << p.z << "): lines there follow one of the turns only";
    s.notes.push_back(note.str());
}

void give_lines(const Network& network, const DirectionField& field, const WorkMesh& mesh, bool with_lines,
                RemeshResult& result) {
    for (const Line& line : network.lines()) {
        if (line.faces.empty()) continue;
        result.statistics.closed_lines += line.closed ? 1 : 0;
        ++(line.family == along_max ? result.statistics.lines_max : result.statistics.lines_min);
        if (!with_lines) continue;
        CurvatureLine out{line.family == along_max, line.closed, {}};
        for (const Index c : line.crossings) out.points.push_back(network.point(c));
        result.lines.push_back(std::move(out));
    }
    for (const Family family : {along_max, along_min}) {
        const Coverage& coverage = network.coverage(family);
        result.statistics.widest_gap = std::max(result.statistics.widest_gap, coverage.farthest);
        result.statistics.uncovered += coverage.uncovered;
    }
    for (const FieldUmbilic& u : field.umbilics)
        result.umbilics.push_back({place_of(u, mesh), mesh.face_sources[u.face], u.half_turns});
}

void note_count(double count, double wanted, double network, RemeshStatistics& statistics) {
    if (std::abs(std::log(count / wanted)) <= 0.05) return;
    const auto text_of = [](double n) { return std::to_string(static_cast<std::size_t>(n)); };
    std::string note = "the nearest count that was found is " + text_of(count) + ", not " + text_of(wanted);
    if (count > 1.05 * network) note += "; mending has added " + text_of(count - network) + " of them";
    statistics.notes.push_back(std::move(note));
}

}  // namespace certa::remeshing
