#pragma once
// The names of what results hold, once, for the command's reports and for Python: visit_fields(result, put) calls
// put("name", member) for every plain member, in the order in which reports show them. Members that the two write in
// their own ways (arrays, places in files, lists of defects) are left to them.
#include <certa/conforming.h>
#include <certa/curvature.h>
#include <certa/distance.h>
#include <certa/implicit.h>
#include <certa/remeshing.h>
#include <certa/surface_check.h>

namespace certa::frontend {

template <class Put>
void visit_fields(const ConformStatistics& s, Put&& put) {
    put("input_points", s.input_points);
    put("segments", s.segments);
    put("facets", s.facets);
    put("missing_segments", s.missing_segments);
    put("missing_facets", s.missing_facets);
    put("steiner_on_segments", s.steiner_on_segments);
    put("steiner_in_facets", s.steiner_in_facets);
    put("protecting_balls", s.protecting_balls);
    put("restarts", s.restarts);
    put("max_displacement", s.max_displacement);
}

template <class Put>
void visit_fields(const ConformingCheck& c, Put&& put) {
    put("full_hull", c.full_hull);
    put("max_deviation", c.max_deviation);
    put("tetrahedra_checked", c.tetrahedra_checked);
    put("segments_checked", c.segments_checked);
    put("facets_checked", c.facets_checked);
}

template <class Put>
void visit_fields(const CurvatureStatistics& s, Put&& put) {
    put("vertices", s.vertices);
    put("triangles", s.triangles);
    put("edges", s.edges);
    put("components", s.components);
    put("border_edges", s.border_edges);
    put("non_manifold_edges", s.non_manifold_edges);
    put("non_manifold_vertices", s.non_manifold_vertices);
    put("excluded_edges", s.excluded_edges);
    put("unused_vertices", s.unused_vertices);
    put("flat_triangles", s.flat_triangles);
    put("repeated_vertices", s.repeated_vertices);
    put("mean_edge_length", s.mean_edge_length);
}

template <class Put>
void visit_fields(const RemeshStatistics& s, Put&& put) {
    put("input_vertices", s.input_vertices);
    put("input_triangles", s.input_triangles);
    put("components", s.components);
    put("euler_characteristic", s.euler_characteristic);
    put("boundary_loops", s.boundary_loops);
    put("feature_edges", s.feature_edges);
    put("feature_curves", s.feature_curves);
    put("corners", s.corners);
    put("unused_vertices", s.unused_vertices);
    put("degenerate_triangles", s.degenerate_triangles);
    put("repeated_triangles", s.repeated_triangles);
    put("flipped_triangles", s.flipped_triangles);
    put("non_manifold_edges", s.non_manifold_edges);
    put("split_vertices", s.split_vertices);
    put("wedges", s.wedges);
    put("trisectors", s.trisectors);
    put("multiple_umbilics", s.multiple_umbilics);
    put("umbilic_half_turns", s.umbilic_half_turns);
    put("lines_min", s.lines_min);
    put("lines_max", s.lines_max);
    put("closed_lines", s.closed_lines);
    put("widest_gap", s.widest_gap);
    put("uncovered", s.uncovered);
    put("spacing_error", s.spacing_error);
    put("smoothing", s.smoothing);
    put("rounds", s.rounds);
    put("mended_regions", s.mended_regions);
    put("mended_triangles", s.mended_triangles);
    put("cut_faces", s.cut_faces);
    put("held_vertices", s.held_vertices);
    put("subdivision_rounds", s.subdivision_rounds);
    put("coarse_faces", s.coarse_faces);
    put("distance_bound", s.distance_bound);
    put("vertices", s.vertices);
    put("faces", s.faces);
    put("triangles", s.triangles);
    put("quads", s.quads);
    put("t_nodes", s.t_nodes);
    put("quad_share_with_t", s.quad_share_with_t);
    put("quad_share_without_t", s.quad_share_without_t);
    put("merged_points", s.merged_points);
    put("cancelled_pairs", s.cancelled_pairs);
    put("umbilics_typed_otherwise", s.umbilics_typed_otherwise);
    put("isotropic_samples", s.isotropic_samples);
    put("notes", s.notes);
}

template <class Put>
void visit_fields(const ImplicitStatistics& s, Put&& put) {
    put("evaluations", s.evaluations);
    put("cells", s.cells);
    put("leaves", s.leaves);
    put("open_leaves", s.open_leaves);
    put("clusters", s.clusters);
    put("rounds", s.rounds);
    put("tetrahedra", s.tetrahedra);
}

template <class Put>
void visit_fields(const OneSidedDistance& d, Put&& put) {
    put("mean", d.mean);
    put("rms", d.rms);
    put("largest", d.largest);
    put("largest_place", d.largest_place);
    put("bound", d.bound);
}

/// Without the two sides.
template <class Put>
void visit_fields(const SurfaceDistance& d, Put&& put) {
    put("rms", d.rms);
    put("hausdorff", d.hausdorff);
    put("hausdorff_bound", d.hausdorff_bound);
    put("diagonal", d.diagonal);
    put("is_tight", d.is_tight);
}

template <class Put>
void visit_fields(const ComponentShape& c, Put&& put) {
    put("genus", c.genus);
    put("boundary_loops", c.boundary_loops);
    put("euler_characteristic", c.euler_characteristic);
}

/// Without the components.
template <class Put>
void visit_fields(const SurfaceShape& s, Put&& put) {
    put("vertices", s.vertices);
    put("edges", s.edges);
    put("polygons", s.polygons);
    put("triangles", s.triangles);
    put("quads", s.quads);
    put("boundary_edges", s.boundary_edges);
    put("boundary_loops", s.boundary_loops);
    put("non_manifold_edges", s.non_manifold_edges);
    put("non_manifold_vertices", s.non_manifold_vertices);
    put("inconsistent_edges", s.inconsistent_edges);
}

template <class Put>
void visit_fields(const CreaseCover& c, Put&& put) {
    put("edges", c.edges);
    put("corners", c.corners);
    put("length", c.length);
    put("mean_distance", c.mean_distance);
    put("largest_distance", c.largest_distance);
    put("largest_place", c.largest_place);
    put("corner_distance", c.corner_distance);
}

/// Without violations, distances, shapes and creases.
template <class Put>
void visit_fields(const SurfaceCheck& c, Put&& put) {
    put("folded_polygons", c.folded_polygons);
    put("contacts", c.contacts);
    put("possible_contacts", c.possible_contacts);
    put("input_contacts", c.input_contacts);
}

}  // namespace certa::frontend
