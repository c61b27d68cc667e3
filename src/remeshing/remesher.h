#pragma once
// One job of remeshing: what its stages share. Inside of the room; `remesh` of the public face makes one of these.
#include <certa/remeshing.h>

#include <optional>

#include "core/triangle_tree.h"
#include "remeshing/caps.h"
#include "remeshing/damage.h"
#include "remeshing/give_result.h"
#include "remeshing/join_triangles.h"
#include "remeshing/mend.h"
#include "remeshing/missed_creases.h"
#include "remeshing/nearer_origin.h"
#include "remeshing/placement.h"
#include "remeshing/stitch.h"
#include "remeshing/stopwatch.h"
#include "remeshing/text.h"
#include "remeshing/trace_lines.h"

namespace certa::remeshing {

/// One network and what came of it.
struct Draft {
    double knob = 0.0, error = 0.0;  ///< the error asked of lines, and the one that they were given
    Network network;
    Spacing spacing{};  ///< of its lines
    Graph graph{};
    std::vector<std::vector<Index>> faces{};
    std::vector<Index> nodes{};  ///< of the graph, per vertex of the polygons
    std::vector<MergedVertex> merged{};
    std::vector<Index> open{};    ///< faces that are no polygons, but have the input's triangles ...
    std::vector<Index> filled{};  ///< ... or, where they are flat, triangles between their rims
    CoarseMesh polygons{};
    PolygonCounts counts{};
    std::size_t samples = 0;      ///< that polygons are triangulated around
    std::vector<Point3> flaws{};  ///< places that no refinement has mended
    std::size_t broken = 0;       ///< faces whose polygons will be mended
    double reach = 0.0;           ///< of its polygons, see reach_of: creases are missed that are farther away
    bool gives_up = false;        ///< what no line has mended is open, where lines should be, too

    Layout layout() const { return {network, graph, faces, nodes, merged, open, filled}; }
};

class Remesher {
public:
    /// `edge_count`: see build_work_mesh.
    Remesher(const TriangleMesh& mesh, const RemeshOptions& options, const RunControl& control, double edge_count = 0.0)
        : options_(options),
          control_(control),
          watch_(result_.statistics),
          mesh_(build_work_mesh(mesh, options, result_.statistics, edge_count)) {
        input_.positions = mesh_.points;
        for (const auto& f : mesh_.faces) input_.triangles.push_back({VertexId{f[0]}, VertexId{f[1]}, VertexId{f[2]}});
        tree_.emplace(input_.positions, input_.triangles);
        watch_.stage("input");
    }

    RemeshResult run();

private:
    bool prepare();
    SpacingRule rule_of(double error) const;
    ArrangementRule arrangement_rule(double error) const;
    double start_error(double count = 0.0);
    Draft draft(double error);
    std::vector<Index> open_faces(Flaws& flaws, const Draft& draft, bool all) const;
    std::vector<Index> broken_faces(const Draft& draft, CoarseMesh polygons, double& reach);
    void even_cells(CoarseMesh& polygons);
    void undo_evening();
    void add_rims(const Draft& draft, Flaws& flaws) const;
    void merge_ends(Draft& draft) const;
    void add_samples(Draft& draft) const;
    void relieve_crowded(Draft& draft);
    double count_of(const Draft& draft);
    double wanted_count() const {
        return static_cast<double>(options_.vertices ? *options_.vertices : options_.faces.value_or(0));
    }
    double final_count(const CoarseMesh& mesh) const {
        if (!options_.vertices) return static_cast<double>(mesh.polygon_count());
        return static_cast<double>(count_vertices(mesh, mesh_.is_cut_open));
    }
    void search(double wanted);
    void find_network(double wanted);
    void trim(Draft& draft, double wanted);
    struct Attempt {
        Draft draft;
        CoarseMesh mesh;
        RemeshStatistics statistics;
    };
    void meet_error();
    std::optional<Attempt> attempt_error();
    void give_input_within_error(const std::string& why);
    bool is_finer_than_input(double error) const;
    void keep(Attempt&& attempt);
    double prove_distance();
    void refine_where_far(double error, double limit);
    double far_share(double limit) const;
    double far_quantile(double share) const;
    std::vector<Index> far_polygons(double limit) const;
    void come_near(double limit);
    void drop_harmful_recuts();
    void lower_peaks();
    std::vector<MissedCrease> missed_creases(const CoarseMesh& mesh, const Judge& judge) const;
    void cover_creases();
    std::vector<Index> find_peaks() const;
    bool cut_last_peaks(Judge& judge, CoarseMesh& mesh);
    bool cut_far(const std::vector<Index>& far, bool may_add, CoarseMesh& mesh);
    void take_places(const CoarseMesh& mesh);
    double wanted_error() const { return options_.error.value_or(default_remesh_error).resolve(mesh_.diagonal); }
    bool finish();
    MendingRule mending_rule(double error) const;
    CoarseMesh mended(CoarseMesh mesh, double error);
    Damage judge_input(CoarseMesh& mesh, Judge& judge);
    void give_input(double tolerance, const std::string& why);
    void finish_count();
    void emit(const CoarseMesh& mesh) {
        given_ = mesh;
        give_polygons(mesh_.is_cut_open ? stitch(mesh) : mesh, result_);
    }
    void subdivide_result();
    PlacementReport place(CoarseMesh& mesh, PlacementOptions options = {});
    CoarseMesh cut(const CoarseMesh& polygons);
    void describe_polygons();

    const RemeshOptions& options_;
    const RunControl& control_;
    RemeshResult result_;
    Stopwatch watch_;
    WorkMesh mesh_;
    TriangleMesh input_;  ///< the work mesh
    std::optional<core::TriangleTree> tree_;
    std::optional<bool> is_embedded_;  ///< the input, once it has been asked
    DirectionField field_;
    Caps caps_{mesh_};
    TraceRule trace_rule_;
    double balance_ = 1.0;          ///< see SpacingRule
    CoarseMesh placed_;             ///< what `finish` has made, but for open faces ...
    CoarseMesh filled_;             ///< ... and with them
    CoarseMesh given_;              ///< the result, with copies of vertices
    CoarseMesh judged_;             ///< as it was placed last, and cut ...
    std::vector<double> farthest_;  ///< ... and how far its polygons are
    double rms_ = 0.0;              ///< of that
    std::vector<Recut> recuts_;
    std::optional<Draft> best_, untrimmed_;
};

}  // namespace certa::remeshing
