// Types of umbilics by a polynomial of third order (thesis 4.1.4, after Tricoche and Delmarcelle).
//
// Around the zero of a linear deviator the directions that point at the zero are the roots of a cubic form. Between two
// of them the direction turns against the radius by half a turn, one way or the other, as the form's sign says: three
// roots, all passed the same way, make a trisector; all else is a wedge, with one separatrix or three. The
// combinatorial index stays the authority; this is what the thesis does, and the test of the other.
#include <algorithm>
#include <numbers>

#include "remeshing/field.h"

namespace certa::remeshing {
namespace {

constexpr double pi = std::numbers::pi;

/// Angles in [0, pi) at which c x^3 + (d - 2 a) x^2 y - (c + 2 b) x y^2 - d y^3 vanishes.
std::vector<double> radial_angles(const std::array<double, 4>& form) {
    const auto value = [&](double angle) {
        const double x = std::cos(angle), y = std::sin(angle);
        return form[0] * x * x * x + form[1] * x * x * y + form[2] * x * y * y + form[3] * y * y * y;
    };
    // In a frame where the coefficient of y^3 is large, with t = y / x: p t^3 + q t^2 + r t + s.
    double frame = 0.0;
    for (int k = 1; k < 12; ++k)
        if (std::abs(value(pi * k / 12.0 + 0.5 * pi)) > std::abs(value(frame + 0.5 * pi))) frame = pi * k / 12.0;
    const double e = std::cos(frame), f = std::sin(frame);
    const auto& [c0, c1, c2, c3] = form;  // x -> e x - f y, y -> f x + e y
    const double s = c0 * e * e * e + c1 * e * e * f + c2 * e * f * f + c3 * f * f * f;
    const double r =
        -3 * c0 * e * e * f + c1 * (e * e * e - 2 * e * f * f) + c2 * (2 * e * e * f - f * f * f) + 3 * c3 * e * f * f;
    const double q =
        3 * c0 * e * f * f + c1 * (f * f * f - 2 * e * e * f) + c2 * (e * e * e - 2 * e * f * f) + 3 * c3 * e * e * f;
    const double p = -c0 * f * f * f + c1 * e * f * f - c2 * e * e * f + c3 * e * e * e;
    if (p == 0.0) return {};
    // t = z - q / 3 p: z^3 + m z + n.
    const double shift = q / (3.0 * p), m = r / p - 3.0 * shift * shift;
    const double n = 2.0 * shift * shift * shift - shift * r / p + s / p;
    const double discriminant = 0.25 * n * n + m * m * m / 27.0;
    std::vector<double> roots;
    if (discriminant > 0.0) {
        const double root = std::sqrt(discriminant);
        roots.push_back(std::cbrt(-0.5 * n + root) + std::cbrt(-0.5 * n - root) - shift);
    } else {
        const double radius = 2.0 * std::sqrt(-m / 3.0);
        const double cosine = radius > 0.0 ? std::clamp(-4.0 * n / (radius * radius * radius), -1.0, 1.0) : 1.0;
        for (int k = 0; k < 3; ++k)
            roots.push_back(radius * std::cos((std::acos(cosine) + 2.0 * pi * k) / 3.0) - shift);
    }
    for (double& t : roots) t = std::atan(t) + frame;
    return roots;
}

}  // namespace

UmbilicType type_of_linear_field(double a, double b, double c, double d) {
    UmbilicType type;
    const std::array<double, 4> form{c, d - 2.0 * a, -c - 2.0 * b, -d};
    type.half_turns = 2;
    for (double angle : radial_angles(form)) {
        const auto along = [&](double at) {  // the deviator in the frame of the radius
            const double x = std::cos(at), y = std::sin(at);
            return Complex(a * x + b * y, c * x + d * y) * std::polar(1.0, -2.0 * at);
        };
        if (along(angle).real() < 0.0) angle += pi;  // k_max points outwards on the other side
        constexpr double step = 1e-5;
        type.half_turns += along(angle + step).imag() > along(angle - step).imag() ? 1 : -1;
        ++type.separatrices;
    }
    return type;
}

UmbilicType type_of_face(const WorkMesh& mesh, const DirectionField& field, Index face) {
    const std::array<Complex, 3> u = corner_values(mesh, field, face);
    const Complex p = mesh.local(face, 1), q = mesh.local(face, 2);
    const Complex along_x = (u[1] - u[0]) / p.real();
    const Complex along_y = (u[2] - u[0] - q.real() * along_x) / q.imag();
    return type_of_linear_field(along_x.real(), along_y.real(), along_x.imag(), along_y.imag());
}

}  // namespace certa::remeshing
