// Tensors, smoothing and umbilics (thesis 4.1.1 to 4.1.5; remesh, stages 2 to 4).
//
// Plan: the surface is cut open along features, so that the curvature room measures one-sided by itself. The deviator's
// direction becomes a complex square per wedge. Smoothing solves (L + lambda M W) u = lambda M W q with the connection
// Laplacian of order two, q the unit direction and W a saturating confidence: strong regions do not leak into weak
// ones. Solved by iteration: the screen makes the system well conditioned wherever there is something to follow.
// Umbilics are the triangles around which the directions turn; the linear zero only says where in the triangle.
#include "remeshing/field.h"

#include <certa/curvature.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "core/assert.h"
#include "remeshing/connection.h"

namespace certa::remeshing {
namespace {

constexpr double pi = std::numbers::pi;

/// The surface with one vertex per wedge.
TriangleMesh cut_open(const WorkMesh& mesh) {
    TriangleMesh cut;
    cut.positions.resize(mesh.wedge_count());
    for (Index w = 0; w < mesh.wedge_count(); ++w) cut.positions[w] = mesh.points[mesh.wedge_vertices[w]];
    cut.triangles.resize(mesh.faces.size());
    for (Index f = 0; f < mesh.face_count(); ++f)
        for (Index i = 0; i < 3; ++i) cut.triangles[f][i] = VertexId{mesh.wedges[3 * f + i]};
    return cut;
}

/// Intrinsic angle of a tangent direction at a wedge, modulo pi: between which half-edges it points, and how far.
double intrinsic_angle(const WorkMesh& mesh, Index wedge, const Point3& normal, const Point3& direction) {
    const Point3& o = mesh.points[mesh.wedge_vertices[wedge]];
    const Point3 side = cross(normal, direction);
    const auto angle_to = [&](const Point3& p) {  // of p against the direction
        const Point3 d = p - o;
        return std::atan2(dot(d, side), dot(d, direction));
    };
    Index corner = mesh.wedge_first[wedge];
    const Index first = corner;
    double best = 0.0, best_excess = 1e300;
    do {
        const double from = angle_to(mesh.points[mesh.end_of(corner)]);
        const double to = angle_to(mesh.points[mesh.start_of(previous_of(corner))]);
        double opening = to - from;
        if (opening <= 0.0) opening += 2.0 * pi;
        for (const double turn : {0.0, pi}) {
            double ahead = turn - from;  // from the first side to the direction, or to its opposite
            while (ahead < -pi) ahead += 2.0 * pi;
            while (ahead > pi) ahead -= 2.0 * pi;
            const double excess = std::max({0.0, -ahead, ahead - opening});
            if (excess < best_excess) {
                best_excess = excess;
                best = mesh.corner_start[corner] + mesh.corner_angle[corner] * ahead / opening;
            }
        }
        corner = mesh.next_corner(corner);
    } while (corner != no_index && corner != first && best_excess > 0.0);
    return best;
}

/// Wedges that no confidence reaches: a direction along a feature, so that everything has one.
void direct_flat_parts(const WorkMesh& mesh, DirectionField& field) {
    for (Index w = 0; w < mesh.wedge_count(); ++w)
        if (std::norm(field.squares[w]) < 1e-24) field.squares[w] = 1e-12;
}

std::array<double, 3> linear_zero(const std::array<Complex, 3>& z, bool& inside) {
    // Weights proportional to the signed areas that 0 spans with two values.
    std::array<double, 3> weights{};
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Complex a = z[(i + 1) % 3], b = z[(i + 2) % 3];
        weights[i] = a.real() * b.imag() - a.imag() * b.real();
        sum += weights[i];
    }
    inside = sum != 0.0;
    for (double& w : weights) {
        w /= sum;
        inside = inside && w >= 0.0;
    }
    if (!inside) weights.fill(1.0 / 3.0);
    return weights;
}

/// Flat parts of patches have no direction of their own: they take that of the patch's longest feature edge, with next
/// to no weight.
void suggest_in_flat_parts(const WorkMesh& mesh, const std::vector<Point3>& normals, DirectionField& field) {
    std::vector<double> longest(mesh.patch_count, 0.0);
    std::vector<Point3> along(mesh.patch_count);
    for (Index h = 0; h < mesh.edges.size(); ++h) {
        double& length = longest[mesh.patches[h / 3]];
        if (!mesh.is_feature(h) || !(mesh.lengths[mesh.edges[h]] > length)) continue;
        length = mesh.lengths[mesh.edges[h]];
        along[mesh.patches[h / 3]] = mesh.points[mesh.end_of(h)] - mesh.points[mesh.start_of(h)];
    }
    for (Index w = 0; w < mesh.wedge_count(); ++w) {
        const Index patch = mesh.patches[mesh.wedge_first[w] / 3];
        if (field.confidence[w] > 0.0 || longest[patch] == 0.0) continue;
        const Point3& n = normals[w];
        const Point3 d = along[patch] - dot(along[patch], n) * n;
        if (!(norm(d) > 1e-3 * longest[patch])) continue;
        field.confidence[w] = 1e-6;
        field.measured[w] = std::polar(1.0, 2.0 * intrinsic_angle(mesh, w, n, (1.0 / norm(d)) * d));
    }
}

}  // namespace

DirectionField measure_directions(const WorkMesh& mesh, const RunControl& control) {
    DirectionField field;
    CurvatureOptions options;
    options.rings = 2;
    const CurvatureResult curvature = compute_curvature(cut_open(mesh), options, control);
    if (curvature.outcome != Outcome::done) return field;
    const Index wedges = mesh.wedge_count();
    field.k_min = curvature.k_min;
    field.k_max = curvature.k_max;
    field.measured.assign(wedges, Complex(0.0));
    field.confidence.assign(wedges, 0.0);
    double square = 0.0, area = 0.0;
    for (Index w = 0; w < wedges; ++w) {
        const double difference = field.k_max[w] - field.k_min[w];
        square += curvature.area[w] * difference * difference;
        area += curvature.area[w];
    }
    field.noise = area > 0.0 ? 0.1 * std::sqrt(square / area) : 0.0;
    // Rounding of coordinates bends a plane by this much.
    const double floor = 1e-9 / mesh.diagonal;
    for (Index w = 0; w < wedges; ++w) {
        const double difference = field.k_max[w] - field.k_min[w];
        if (!(difference > floor) || curvature.normal[w] == Point3{}) continue;
        const double g = difference * difference, side = mesh.wedge_closed[w] ? 1.0 : 0.3;
        field.confidence[w] = side * g / (g + field.noise * field.noise);
        field.measured[w] = std::polar(1.0, 2.0 * intrinsic_angle(mesh, w, curvature.normal[w], curvature.dir_max[w]));
    }
    suggest_in_flat_parts(mesh, curvature.normal, field);
    return field;
}

void spread_to_halfedges(const WorkMesh& mesh, std::span<const Index> faces, DirectionField& field) {
    for (const Index f : faces)
        for (Index h = 3 * f; h < 3 * f + 3; ++h) {
            const Index n = next_of(h);
            field.starts[h] = field.squares[mesh.wedges[h]] * std::polar(1.0, -2.0 * mesh.corner_start[h]);
            field.ends[h] =
                field.squares[mesh.wedges[n]] * std::polar(1.0, -2.0 * (mesh.corner_start[n] + mesh.corner_angle[n]));
        }
}

void spread_to_halfedges(const WorkMesh& mesh, DirectionField& field) {
    field.starts.resize(mesh.edges.size());
    field.ends.resize(mesh.edges.size());
    std::vector<Index> all(mesh.faces.size());
    std::iota(all.begin(), all.end(), 0U);
    spread_to_halfedges(mesh, all, field);
}

int half_turns_of(const WorkMesh& mesh, const DirectionField& field, Index face) {
    double sum = -2.0 * pi;
    for (Index i = 0; i < 3; ++i) {
        const Index h = 3 * face + i, o = mesh.opposites[h];
        // One half-edge decides for both sides: a rotation by pi has no sign of its own.
        const bool own = mesh.is_feature(h) || o == no_index || mesh.along(h);
        const Index used = own ? h : o;
        const double turn = std::arg(field.ends[used] * std::conj(field.starts[used]));
        sum += (own ? turn : -turn) + 2.0 * mesh.corner_angle[h];
    }
    return static_cast<int>(std::lround(sum / (2.0 * pi)));
}

std::array<Complex, 3> corner_values(const WorkMesh& mesh, const DirectionField& field, Index face) {
    std::array<Complex, 3> z{};
    for (Index i = 0; i < 3; ++i) {
        const Index c = 3 * face + i;
        const Complex o = mesh.local(face, i), p = mesh.local(face, (i + 1) % 3), q = mesh.local(face, (i + 2) % 3);
        const double bisector = std::arg(p - o) + 0.5 * std::arg((q - o) * std::conj(p - o));
        z[i] = field.squares[mesh.wedges[c]] *
               std::polar(1.0, 2.0 * (bisector - mesh.corner_start[c] - 0.5 * mesh.corner_angle[c]));
    }
    return z;
}

std::optional<FieldUmbilic> find_umbilic(const WorkMesh& mesh, const DirectionField& field, Index face) {
    const int turns = half_turns_of(mesh, field, face);
    if (turns == 0) return std::nullopt;
    FieldUmbilic umbilic{face, turns, {}, false, 0};
    umbilic.weights = linear_zero(corner_values(mesh, field, face), umbilic.linear_zero);
    if (umbilic.linear_zero) umbilic.typed_half_turns = type_of_face(mesh, field, face).half_turns;
    return umbilic;
}

void finish_directions(const WorkMesh& mesh, DirectionField& field) {
    direct_flat_parts(mesh, field);
    spread_to_halfedges(mesh, field);
    field.umbilics.clear();
    for (Index f = 0; f < mesh.face_count(); ++f)
        if (const auto umbilic = find_umbilic(mesh, field, f)) field.umbilics.push_back(*umbilic);
}

void smooth_directions(const WorkMesh& mesh, DirectionField& field, double length, const RunControl& control) {
    field.smoothing = length;
    const Laplacian laplacian = build_laplacian(mesh);
    const std::size_t n = field.measured.size();
    std::vector<double> screen(n);
    std::vector<Complex> right(n);
    const double lambda = 1.0 / (length * length);
    field.squares.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        screen[i] = lambda * laplacian.mass[i] * field.confidence[i];
        right[i] = screen[i] * field.measured[i];
        field.squares[i] = field.confidence[i] * field.measured[i];
    }
    if (length > 0.0) {
        solve(laplacian, screen, right, field.squares, control);
    } else {
        field.squares = field.measured;
    }
    finish_directions(mesh, field);
}

}  // namespace certa::remeshing
