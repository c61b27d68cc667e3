// Principal curvatures and directions from the anisotropic measures of a region (thesis, 2.5).
//
// The swapped tensor H~ has the eigenvectors of the second fundamental form with swapped eigenvalues: what it carries
// along dir_min is k_max, and 0 along the normal. Where one curvature vanishes its direction and the normal share an
// eigenspace. The remedy that the thesis suggests: H-bar^2 + H~^2 has k_min^2 + k_max^2 in both tangent directions and
// 0 along the normal.
#include "curvature/principal.h"

#include <algorithm>
#include <cmath>

namespace certa::curvature {
namespace {

/// u^T t v
double value_at(const SymmetricTensor3& t, const Point3& u, const Point3& v) {
    return t.xx * u.x * v.x + t.yy * u.y * v.y + t.zz * u.z * v.z + t.xy * (u.x * v.y + u.y * v.x) +
           t.xz * (u.x * v.z + u.z * v.x) + t.yz * (u.y * v.z + u.z * v.y);
}

SymmetricTensor3 square(const SymmetricTensor3& t) {
    return {t.xx * t.xx + t.xy * t.xy + t.xz * t.xz, t.xx * t.xy + t.xy * t.yy + t.xz * t.yz,
            t.xx * t.xz + t.xy * t.yz + t.xz * t.zz, t.xy * t.xy + t.yy * t.yy + t.yz * t.yz,
            t.xy * t.xz + t.yy * t.yz + t.yz * t.zz, t.xz * t.xz + t.yz * t.yz + t.zz * t.zz};
}

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix matrix_of(const SymmetricTensor3& t) { return {{{t.xx, t.xy, t.xz}, {t.xy, t.yy, t.yz}, {t.xz, t.yz, t.zz}}}; }

/// Annihilates a[p][q] and carries the rotation along.
void rotate(Matrix& a, Matrix& vectors, std::size_t p, std::size_t q) {
    if (a[p][q] == 0.0) return;
    const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
    const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
    const std::size_t r = 3 - p - q;
    const double apq = a[p][q], apr = a[p][r], aqr = a[q][r];
    a[p][p] -= t * apq, a[q][q] += t * apq;
    a[p][q] = a[q][p] = 0.0;
    a[p][r] = a[r][p] = c * apr - s * aqr;
    a[q][r] = a[r][q] = s * apr + c * aqr;
    for (auto& row : vectors) {
        const double vp = row[p], vq = row[q];
        row[p] = c * vp - s * vq;
        row[q] = s * vp + c * vq;
    }
}

}  // namespace

EigenSystem compute_eigensystem(const SymmetricTensor3& tensor) {
    Matrix a = matrix_of(tensor), vectors{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int sweep = 0; sweep < 50; ++sweep) {
        const double off = std::abs(a[0][1]) + std::abs(a[0][2]) + std::abs(a[1][2]);
        const double on = std::abs(a[0][0]) + std::abs(a[1][1]) + std::abs(a[2][2]);
        if (off <= 1e-17 * on || off == 0.0) break;
        rotate(a, vectors, 0, 1);
        rotate(a, vectors, 0, 2);
        rotate(a, vectors, 1, 2);
    }
    std::array<std::size_t, 3> order{0, 1, 2};
    const auto sort_two = [&](std::size_t i, std::size_t j) {
        if (a[order[j]][order[j]] < a[order[i]][order[i]]) std::swap(order[i], order[j]);
    };
    sort_two(0, 1), sort_two(1, 2), sort_two(0, 1);
    EigenSystem system;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t c = order[k];
        system.values[k] = a[c][c];
        system.vectors[k] = unit_or_zero({vectors[0][c], vectors[1][c], vectors[2][c]});
    }
    return system;
}

namespace {

/// The eigenvector of the smallest eigenvalue of a positive matrix whose other two are nearly equal, by powers of the
/// adjugate: with two tensors summed, what is not normal is damped by a factor in the hundreds each time. 0 where that
/// does not lead to a direction near `start`.
Point3 find_smallest(const SymmetricTensor3& m, const Point3& start) {
    const SymmetricTensor3 adjugate{m.yy * m.zz - m.yz * m.yz, m.xz * m.yz - m.xy * m.zz, m.xy * m.yz - m.xz * m.yy,
                                    m.xx * m.zz - m.xz * m.xz, m.xy * m.xz - m.xx * m.yz, m.xx * m.yy - m.xy * m.xy};
    Point3 x = start;
    for (int step = 0; step < 12; ++step) {
        const Point3 image{adjugate.xx * x.x + adjugate.xy * x.y + adjugate.xz * x.z,
                           adjugate.xy * x.x + adjugate.yy * x.y + adjugate.yz * x.z,
                           adjugate.xz * x.x + adjugate.yz * x.y + adjugate.zz * x.z};
        const double length = norm(image);
        if (!(length > 0.0)) return {};
        const Point3 next = (1.0 / length) * image;
        const Point3 moved = next - x;
        x = next;
        // Any other eigenvector is at a right angle to this one: none is closer to the start than 0.66.
        if (dot(moved, moved) < 1e-24) return dot(x, start) > 0.75 ? x : Point3{};
    }
    return {};
}

}  // namespace

Point3 choose_normal(const Sums& sums, const Point3& vertex_normal) {
    SymmetricTensor3 both = square(sums.swapped);
    add(both, 1.0, square(sums.plain));
    const Point3 smallest = find_smallest(both, vertex_normal);
    if (smallest != Point3{}) return smallest;
    // The smallest eigenvalue, unless the faces' normal says clearly that it is another one: where both curvatures
    // nearly vanish, or where the sampling is coarse.
    const EigenSystem system = compute_eigensystem(both);
    std::size_t best = 0;
    double alignment = -1.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double along = std::abs(dot(system.vectors[k], vertex_normal));
        if (along > alignment) alignment = along, best = k;
    }
    const Point3& n = system.vectors[best];
    // Flat regions have no eigenvectors to speak of, and 1/sqrt(3) is the least alignment of the best of three.
    if (!(system.values[2] > 0.0) || alignment < 0.7) return vertex_normal;
    return dot(n, vertex_normal) < 0.0 ? -1.0 * n : n;
}

Principal make_principal(double k_first, double k_second, const Point3& first, const Point3& normal) {
    Principal result;
    const Point3 second = cross(normal, first);
    result.normal = normal;
    if (k_first <= k_second) {
        result.k_min = k_first, result.k_max = k_second, result.dir_min = first, result.dir_max = second;
    } else {
        result.k_min = k_second, result.k_max = k_first, result.dir_min = second, result.dir_max = first;
    }
    const double size = std::abs(k_first) + std::abs(k_second);
    result.confidence = size > 0.0 ? std::min(1.0, (result.k_max - result.k_min) / size) : 0.0;
    return result;
}

Point3 perpendicular_to(const Point3& n) {
    const Point3 axis = std::abs(n.x) <= std::abs(n.y) && std::abs(n.x) <= std::abs(n.z) ? Point3{1, 0, 0}
                        : std::abs(n.y) <= std::abs(n.z)                                 ? Point3{0, 1, 0}
                                                                                         : Point3{0, 0, 1};
    return unit_or_zero(cross(n, axis));
}

Principal compute_principal(const Sums& sums, const Point3& vertex_normal) {
    Principal result;
    if (!(sums.area > 0.0)) return result;
    const Point3 normal = choose_normal(sums, vertex_normal);
    if (normal == Point3{}) return result;
    // The swap: H~ of the region is the tensor of curvatures turned by a right angle in the tangent plane.
    const Principal turned = compute_principal_along(sums.swapped, sums.area, normal);
    return make_principal(turned.k_max, turned.k_min, turned.dir_min, normal);
}

Principal compute_principal_along(const SymmetricTensor3& tensor, double area, const Point3& normal) {
    const Point3 u = perpendicular_to(normal), v = cross(normal, u);
    const double uu = value_at(tensor, u, u), vv = value_at(tensor, v, v), uv = value_at(tensor, u, v);
    const double middle = 0.5 * (uu + vv), half = 0.5 * (uu - vv), spread = std::sqrt(half * half + uv * uv);
    // The eigenvector of the larger eigenvalue, by the form that does not cancel.
    Point3 first = half >= 0.0 ? (spread + half) * u + uv * v : uv * u + (spread - half) * v;
    first = spread > 0.0 ? unit_or_zero(first) : u;
    return make_principal((middle + spread) / area, (middle - spread) / area, first, normal);
}

}  // namespace certa::curvature
