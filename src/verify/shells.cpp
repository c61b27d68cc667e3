// Collecting shells, the exact sign of what they enclose, and winding numbers around points.
//
// Signs of volumes are decided in doubles with an error bound, or on integers; winding numbers by the faces above a
// point, which is moved by an infinitely small step so that it is below no edge.
#include "verify/shells.h"

#include <algorithm>
#include <map>

#include "core/union_find.h"

namespace certa::verify {
namespace {

/// Six times the signed volume of a shell over 2^(3 exponent), exactly.
mpz_class exact_volume(const Subject& subject, const Domain& domain, const Shell& shell, int& exponent) {
    std::vector<std::array<Point3, 3>> points;
    for (const std::uint32_t i : shell.faces) points.push_back(face_points(subject, domain.boundary[i]));
    const Point3 origin = points[0][0];
    std::vector<Arrow> arrows;
    for (const auto& t : points) {
        for (const Point3& p : t) arrows.push_back({&origin, &p});
    }
    std::vector<Vec<mpz_class>> v(arrows.size());
    exponent = to_integers(arrows.data(), arrows.size(), v.data());
    mpz_class sum;
    for (std::size_t i = 0; i < v.size(); i += 3) sum += dot_of(cross_of(v[i], v[i + 1]), v[i + 2]);
    return sum;
}

int volume_sign(const Subject& subject, const Domain& domain, const Shell& shell) {
    Bounded sum;
    bool filtered = true;
    const Point3 origin = face_points(subject, domain.boundary[shell.faces[0]])[0];
    for (const std::uint32_t i : shell.faces) {
        const auto t = face_points(subject, domain.boundary[i]);
        const Vec<Bounded> a = bounded_difference(origin, t[0]), b = bounded_difference(origin, t[1]),
                           c = bounded_difference(origin, t[2]);
        filtered = filtered && is_filtered(a) && is_filtered(b) && is_filtered(c);
        sum = sum + dot_of(cross_of(a, b), c);
    }
    constexpr int determinant = census_of<DeterminantForm>().roundings;
    if (filtered && shell.faces.size() < (std::size_t{1} << 19)) {
        const int sign = filtered_sign(sum, determinant + static_cast<int>(shell.faces.size()));
        if (sign != 2) return sign;
    }
    int exponent = 0;
    return sgn(exact_volume(subject, domain, shell, exponent));
}

/// orientation_xy(a, b, p + (e, e^2)) for an infinitely small e > 0; 0 only where a and b coincide in the plane.
int perturbed_side(const Point3& a, const Point3& b, const Point3& p) {
    const int sign = orientation_xy(a, b, p);
    if (sign != 0) return sign;
    // The derivative along x is -(b.y - a.y), that along y is b.x - a.x.
    if (a.y != b.y) return a.y > b.y ? 1 : -1;
    return b.x > a.x ? 1 : b.x < a.x ? -1 : 0;
}

}  // namespace

std::array<Point3, 3> face_points(const Subject& subject, HalfFace h) {
    const auto f = outward_face(subject.mesh, h);
    return {subject.at(f[0]), subject.at(f[1]), subject.at(f[2])};
}

std::vector<Shell> collect_shells(const Subject& subject, const Domain& domain) {
    core::UnionFind leaders(domain.boundary.size());
    for (const auto& [i, k] : domain.joints) leaders.unite(i, k);
    std::map<std::uint32_t, Shell> shells;
    for (std::uint32_t i = 0; i < domain.boundary.size(); ++i) shells[leaders.find(i)].faces.push_back(i);
    std::vector<Shell> result;
    for (auto& [leader, shell] : shells) {
        shell.low = shell.high = face_points(subject, domain.boundary[shell.faces[0]])[0];
        for (const std::uint32_t i : shell.faces) {
            for (const Point3& p : face_points(subject, domain.boundary[i])) {
                shell.low = {std::min(shell.low.x, p.x), std::min(shell.low.y, p.y), std::min(shell.low.z, p.z)};
                shell.high = {std::max(shell.high.x, p.x), std::max(shell.high.y, p.y), std::max(shell.high.z, p.z)};
            }
        }
        shell.sign = volume_sign(subject, domain, shell);
        result.push_back(std::move(shell));
    }
    return result;
}

/// Winding number of a shell around p, from the faces above p.
int winding_of(const Subject& subject, const Domain& domain, const Shell& shell, const Point3& p) {
    if (!is_in_box(p, shell.low, shell.high)) return 0;
    int winding = 0;
    for (const std::uint32_t i : shell.faces) {
        const auto [a, b, c] = face_points(subject, domain.boundary[i]);
        if (std::max({a.z, b.z, c.z}) < p.z || std::max({a.x, b.x, c.x}) < p.x || std::min({a.x, b.x, c.x}) > p.x)
            continue;
        const int ab = perturbed_side(a, b, p), bc = perturbed_side(b, c, p), ca = perturbed_side(c, a, p);
        if (ab == 0 || ab != bc || bc != ca) continue;
        // The normal points up (ab > 0): p is below the face when it is on the face's negative side.
        if (orientation(a, b, c, p) * ab < 0) winding += ab;
    }
    return winding;
}

/// Whether `a` encloses less than `b`, both of one sign.
bool is_smaller(const Subject& subject, const Domain& domain, const Shell& a, const Shell& b) {
    int ea = 0, eb = 0;
    mpz_class va = abs(exact_volume(subject, domain, a, ea)), vb = abs(exact_volume(subject, domain, b, eb));
    if (ea > eb) va <<= static_cast<unsigned long>(3 * (ea - eb));
    if (eb > ea) vb <<= static_cast<unsigned long>(3 * (eb - ea));
    return va < vb;
}

}  // namespace certa::verify
