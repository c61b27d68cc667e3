// Each triangle is moved along the gradients at its corners; f is enclosed on it by the mean value form, whose linear
// part is extreme at corners; where that is not enough, on four pieces of it. Triangles that turn over on the way count
// as far, too.
#include "implicit/offset.h"

#include <cmath>

#include "core/parallel.h"
#include "core/vector3.h"
#include "implicit/field.h"

namespace certa::implicit {
namespace {

constexpr int deepest = 5;  // the checker goes one further

class TriangleSigns {
public:
    explicit TriangleSigns(const expression::Tape& tape) : workspace_(tape) { interval::require_sound_environment(); }

    bool proves(const std::array<Region, 3>& t, int sign, int depth = 0) {
        Region hull = t[0], center;
        for (std::size_t a = 0; a < 3; ++a) {
            for (const Region& corner : t) hull[a] = interval::hull(hull[a], corner[a]);
            center[a] = Interval(interval::middle(hull[a]));
        }
        const auto& jet = workspace_.evaluate<1>(hull);
        if (interval::sign_of(jet.value) == sign) return true;
        if (interval::is_defined(jet.value)) {
            const std::array<Interval, 3> slope = jet.gradient;
            const Interval middle = workspace_.evaluate<0>(center).value;
            bool all = true;
            for (const Region& corner : t) {
                Interval value = middle;
                for (std::size_t a = 0; a < 3; ++a) value = value + slope[a] * (corner[a] - center[a]);
                all = all && interval::sign_of(value) == sign;
            }
            if (all) return true;
        }
        if (depth == deepest) return false;
        const auto between = [](const Region& p, const Region& q) {
            Region m;
            for (std::size_t a = 0; a < 3; ++a) m[a] = Interval(0.5) * (p[a] + q[a]);
            return m;
        };
        const Region a = between(t[1], t[2]), b = between(t[2], t[0]), c = between(t[0], t[1]);
        return proves({t[0], c, b}, sign, depth + 1) && proves({c, t[1], a}, sign, depth + 1) &&
               proves({b, a, t[2]}, sign, depth + 1) && proves({a, b, c}, sign, depth + 1);
    }

private:
    expression::Workspace<Interval> workspace_;
};

/// Whether no prism between a triangle with sides e1, e2 and the one whose corners are moved by d turns over: the
/// checker's test of the Bernstein coefficients of the Jacobian at the corners, with more margin.
bool keeps_turning(const Point3& e1, const Point3& e2, const std::array<Point3, 3>& d, int side) {
    const Point3 g1 = d[1] - d[0], g2 = d[2] - d[0];
    const Point3 a = cross(e1, e2), b = cross(e1, g2) + cross(g1, e2), c = cross(g1, g2);
    const double reach = (norm(e1) + norm(d[0]) + norm(d[1])) * (norm(e2) + norm(d[0]) + norm(d[2]));
    for (const Point3& way : d) {
        const double least = 0x1p-42 * reach * norm(way);
        const double first = side * dot(a, way), linear = side * dot(b, way), square = side * dot(c, way);
        if (!(first > least) || !(first + linear / 2 > least) || !(first + linear + square > least)) return false;
    }
    return true;
}

}  // namespace

std::vector<std::uint32_t> find_far_triangles(const TriangleMesh& mesh, double length, const expression::Tape& tape,
                                              const RunControl& control) {
    std::vector<Point3> ways(mesh.positions.size());
    Field field(tape);
    for (std::size_t v = 0; v < ways.size(); ++v) {
        const auto& g = field.slope(mesh.positions[v]).gradient;
        const double scale = length * (1 - 0x1p-20) / std::hypot(g[0], g[1], g[2]);
        ways[v] = {scale * g[0], scale * g[1], scale * g[2]};
    }
    std::vector<char> far(mesh.triangles.size(), 0);
    core::parallel_for(mesh.triangles.size(), 32, control, [&](std::size_t begin, std::size_t end) {
        TriangleSigns signs(tape);
        for (std::size_t i = begin; i < end && !control.cancelled(); ++i) {
            for (const int side : {1, -1}) {
                std::array<Region, 3> t;
                std::array<Point3, 3> at, moves;
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::uint32_t v = index_of(mesh.triangles[i][k]);
                    const Point3 &p = mesh.positions[v], &w = ways[v];
                    at[k] = p;
                    moves[k] = static_cast<double>(side) * w;
                    t[k] = {Interval(p.x + side * w.x), Interval(p.y + side * w.y), Interval(p.z + side * w.z)};
                }
                if (!keeps_turning(at[1] - at[0], at[2] - at[0], moves, side) || !signs.proves(t, side)) far[i] = 1;
            }
        }
    });
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < far.size(); ++i) {
        if (far[i]) result.push_back(i);
    }
    return result;
}

}  // namespace certa::implicit
