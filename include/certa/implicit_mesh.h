#pragma once
// Triangle meshes of any origin against the zero set of a function.
#include <certa/implicit.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace certa {

/// What is proved about a mesh and a zero set.
enum class ImplicitMeshVerdict : std::uint8_t {
    certified,  ///< the mesh is isotopic to the zero set in the box
    refuted,    ///< it is not: it is no embedded closed surface, or its components, genera or their nesting differ
    undecided,  ///< nothing is claimed
};
/// The name as it is written here.
const char* name_of(ImplicitMeshVerdict verdict);

/// What is proved about a mesh that any program may have made.
struct ImplicitMeshCheck {
    ImplicitMeshVerdict verdict = ImplicitMeshVerdict::undecided;
    std::vector<std::string> reasons;      ///< why it is refuted, or what hinders: at most 100
    std::vector<std::uint32_t> triangles;  ///< named by the reasons, 0-based: the first 1000
    std::size_t triangle_count = 0;
    bool surface_known = false;       ///< the topology of the zero set is proved
    std::vector<int> mesh_genera;     ///< per component, sorted; empty where the mesh is no closed surface
    std::vector<int> surface_genera;  ///< of the zero set, sorted; meaningful if surface_known
    bool faces_positive = false;      ///< certified, and every triangle faces f > 0
    Outcome outcome = Outcome::done;
    std::vector<ImplicitObstacle> obstacles;  ///< where the topology of the zero set could not be proved
    Point3 low, high;                         ///< the box of the proof
    std::size_t leaves_checked = 0, marks_checked = 0;
};

/// Decides by the W of a certificate, which is verified first, what a mesh is to the zero set of a function.
///
/// Input:      any triangle mesh, vertices shared; the function's text; a certificate of mesh_implicit for any mesh.
/// Result:     undecided where the certificate does not prove what it claims, or the mesh leaves W.
/// Guarantee:  exact on the doubles of the mesh (docs/implicit-theorem.md, "any mesh"); shares no code with
///             mesh_implicit.
ImplicitMeshCheck judge_implicit_mesh(const TriangleMesh& mesh, std::string_view function, std::string_view certificate,
                                      const RunControl& control = {});

/// Low and high corner of a box in which a mesh can be compared with a zero set: its own, enlarged by about a sixth.
///
/// Definition: the margins differ from side to side and are no simple fractions of the size, so that grids of marching
///             cubes are not aligned with the cells of the proof.
/// Errors:     InputError empty_input for a mesh without points.
std::array<Point3, 2> find_box_around(const TriangleMesh& mesh);

/// Decides what a mesh made by any program is to the zero set of a function in a box.
///
/// Input:      any triangle mesh, vertices shared, not within reach of the box's boundary; the function's text.
/// Definition: the topology of the zero set is proved as mesh_implicit does. Where that W does not hold the mesh, W is
///             grown along the mesh, leaves being split where the mesh leaves it, up to eight times. What is said is
///             what judge_implicit_mesh says: the growth only proposes.
/// Result:     `reasons` and `obstacles` say what hinders; outcome over_budget or undecided where the zero set's
///             topology could not be proved.
/// Errors:     ExpressionError; InputError for a box that makes no sense.
/// Cost:       that of mesh_implicit and its check, some times.
ImplicitMeshCheck check_mesh_against(const TriangleMesh& mesh, std::string_view function, const Point3& low,
                                     const Point3& high, const ImplicitOptions& options = {},
                                     const RunControl& control = {});

}  // namespace certa
