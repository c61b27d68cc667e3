#pragma once
// The checker of surface meshes against the surface that they stand for: what `remesh` promises, on any program's mesh.
#include <certa/conforming.h>
#include <certa/distance.h>
#include <certa/mesh.h>
#include <certa/run_control.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace certa {

/// What a surface mesh is held to by check_surface.
struct SurfaceCheckOptions {
    /// Promised bound on the distance, both ways. Empty: distances are measured, nothing is demanded of them.
    std::optional<Length> error = std::nullopt;
    /// An edge of the input is a crease above this angle between the normals of its polygons. Groups of such edges that
    /// touch no other crease and are shorter together than 3 % of the diagonal and 12 mean edges are noise. Normals of
    /// triangles lower than 5e-4 of the diagonal say nothing: the polygons beyond them must form the angle too.
    double feature_angle_radians = 0.69813170079773179;
    std::vector<Edge> features = {};  ///< edges of the input that are creases whatever their angle
    /// How far a crease may be from the nearest edge, a corner from the nearest vertex, of the mesh. Empty: `error`, or
    /// the bound on the distance that was found, and at least 1e-6 of the diagonal.
    std::optional<Length> crease_tolerance = std::nullopt;
    DistanceOptions distance = {};
};

/// A connected part: polygons that share edges.
struct ComponentShape {
    std::int64_t euler_characteristic = 0;
    std::size_t boundary_loops = 0;
    /// (2 - euler_characteristic - boundary_loops) / 2: handles of an orientable surface. Meant where it is manifold.
    std::int64_t genus = 0;
    friend bool operator==(const ComponentShape&, const ComponentShape&) = default;
};
/// Counts of a polygon mesh, exact.
struct SurfaceShape {
    std::size_t vertices = 0;  ///< that polygons use
    std::size_t edges = 0, polygons = 0, triangles = 0, quads = 0;
    std::vector<ComponentShape> components;  ///< sorted by genus, then loops
    std::size_t boundary_edges = 0, boundary_loops = 0;
    std::size_t non_manifold_edges = 0;     ///< of more than two polygons
    std::size_t non_manifold_vertices = 0;  ///< whose polygons do not form one fan
    std::size_t inconsistent_edges = 0;     ///< that both polygons walk the same way
    /// Every edge has one polygon or two, every vertex one fan.
    bool is_manifold() const { return non_manifold_edges == 0 && non_manifold_vertices == 0; }
    /// Manifold, and polygons that share an edge walk it in opposite directions.
    bool is_oriented() const { return is_manifold() && inconsistent_edges == 0; }
};

/// How closely a mesh follows the input's creases. Lengths in the input's unit.
struct CreaseCover {
    std::size_t edges = 0, corners = 0;  ///< of the input; its boundary is part of the creases
    double length = 0.0;
    double mean_distance = 0.0, largest_distance = 0.0;  ///< from points of creases to the nearest edge of the mesh
    Point3 largest_place;
    double corner_distance = 0.0;  ///< largest, from a corner to the nearest vertex of the mesh
};

/// What check_surface found.
struct SurfaceCheck {
    std::vector<Violation> violations;  ///< at most 100 per promise are kept
    std::size_t violation_count = 0;
    SurfaceDistance distance;  ///< to_second: from the mesh to the input
    SurfaceShape mesh, input;
    CreaseCover creases;
    std::size_t folded_polygons = 0;
    std::size_t contacts = 0;           ///< pairs of polygons that meet beyond what they share, as triangulated
    std::size_t possible_contacts = 0;  ///< pairs that do so under some triangulation
    std::size_t input_contacts = 0;     ///< of the input; looked for only where the mesh has any
    std::vector<std::string> promises;  ///< the names of what was checked
    Outcome outcome = Outcome::done;
    bool ok() const { return violation_count == 0; }  ///< every promise holds
};

/// Decides whether `mesh` is a faithful version of `input`.
///
/// Promises:   well-formed  manifold and consistently oriented where the input is
///             topology     as many components, each with the genus and boundary loops of one of the input
///             unfolded     no triangle turns away by 90 degrees or more from every polygon of the input that is
///                          nearest to its middle
///             embedded     no two polygons meet but in what they share, exactly; not asked where the input does so
///             creases      every crease and boundary of the input is covered by edges, every corner by a vertex
///             error        with `error`: the proved bound on the distance is not above it
///             Polygons of more than three corners are taken as triangulated nearest to the input; possible_contacts
///             counts over all triangulations that certa/distance.h lists.
/// Input:      any polygon meshes. Corners are vertices of the input where not exactly two crease edges meet, or two at
///             an angle of more than 45 degrees, or boundary and crease.
/// Errors:     as measure_distance.
/// Guarantee:  topology and contacts are exact; distances have proved bounds; creases are sampled densely.
/// Cost:       O(n log n); deterministic.
SurfaceCheck check_surface(const PolygonMesh& mesh, const PolygonMesh& input, const SurfaceCheckOptions& options = {},
                           const RunControl& control = {});

/// Pairs of polygons that meet beyond the corners and sides that they share; exact.
///
/// Definition: polygons of more than three corners count under each triangulation that certa/distance.h lists.
/// Result:     0-based numbers of polygons, the lower first, sorted.
/// Errors:     as measure_distance.
std::vector<std::array<std::uint32_t, 2>> find_contacts(const PolygonMesh& mesh, const RunControl& control = {});

/// Counts components, boundary and what is not manifold.
///
/// Errors: as measure_distance.
/// Cost:   O(n log n); deterministic.
SurfaceShape compute_surface_shape(const PolygonMesh& mesh);

}  // namespace certa
