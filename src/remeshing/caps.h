#pragma once
// Upper bounds of the distance between lines, from what is wrong with networks that have been tried.
#include <algorithm>

#include "remeshing/arrangement.h"
#include "remeshing/polygons.h"
#include "remeshing/spacing.h"

namespace certa::remeshing {

class Caps {
public:
    explicit Caps(const WorkMesh& mesh) : mesh_(mesh) {}

    /// For a search for `wanted` vertices. On curved surfaces the error is about diagonal / vertices; where it would
    /// have to be so much less, curvature is at the edges of the input's facets only, and lines along these crowd.
    void expect(double wanted);
    /// The error that lines are given where `error` was asked: not less than makes sense.
    double given(double error) const { return std::max(error, least_error_); }
    /// Per wedge, for compute_spacing. Below the least error, lines do not get closer where curvature says so, but
    /// everywhere: it has nothing more to say.
    std::vector<double> at(double error) const;
    /// A new network: what flaws of others needed is forgotten; what was close enough for polygons to be sound at a
    /// smaller error may be too close now.
    void forget_flaws() { caps_.clear(), patch_caps_.clear(); }
    void loosen(double error);

    void lower(Index wedge, double cap);
    /// Lines of each family are to be this close at a wedge: for SpacingRule::most.
    void lower_families(Index wedge, double factor, const Spacing& spacing);
    const std::array<std::vector<double>, 2>& of_families() const { return family_caps_; }
    /// Where faces are no polygons: near the places where one more line might do; where there are none, or if that
    /// has not helped before (`all`), all over a patch and around all nodes of a face.
    void refine(const Flaws& flaws, const Graph& graph, const std::vector<std::vector<Index>>& faces,
                const Spacing& spacing, bool all);
    /// Around faces whose polygons are broken; can be taken back once.
    void refine_broken(const std::vector<Index>& broken, const Graph& graph,
                       const std::vector<std::vector<Index>>& faces, const Spacing& spacing);
    void take_back() { broken_caps_ = before_; }

private:
    void lower_near(const FlawPlace& place, const Graph& graph, const Spacing& spacing);
    void lower_around(const std::vector<Index>& list, const Graph& graph, const std::vector<std::vector<Index>>& faces,
                      const Spacing& spacing, double least, std::vector<double>& caps) const;

    const WorkMesh& mesh_;
    std::vector<double> caps_;                        ///< per wedge, 0 where free
    std::vector<double> patch_caps_;                  ///< per patch, of the last refinement
    std::vector<double> broken_caps_, before_;        ///< per wedge, because of polygons that were broken
    std::array<std::vector<double>, 2> family_caps_;  ///< per wedge, because the error was not kept
    double last_error_ = 0.0;                         ///< that `loosen` was told
    double least_error_ = 0.0;
    double widest_ = 0.0;  ///< below the least error no two lines are farther apart
};

}  // namespace certa::remeshing
