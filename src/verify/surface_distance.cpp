// The mesh moved to both sides along the gradient, by a hair less than the bound; what is to be proved of it is listed
// in docs/implicit-theorem.md, "distance".
//
// Plan: moved vertices (any choice would do; near the normal it succeeds); lengths; signs of f on moved triangles, by
// the mean value form on pieces of them; orientation of the prisms between a triangle and the moved one; one vertex per
// component whose moves miss the frontier of W.
#include "verify/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/parallel.h"
#include "verify/report.h"

namespace certa::verify {
namespace {

Point3 operator-(const Point3& a, const Point3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point3 cross(const Point3& a, const Point3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double norm(const Point3& a) { return std::hypot(a.x, a.y, a.z); }

/// A corner of a piece of a triangle: a box of doubles around the exact point.
BoxOfDoubles corner_of(const Point3& p) { return {{p.x, p.y, p.z}, {p.x, p.y, p.z}}; }
BoxOfDoubles middle_of(const BoxOfDoubles& a, const BoxOfDoubles& b) {
    BoxOfDoubles m{};
    for (std::size_t i = 0; i < 3; ++i) {
        m.low[i] = std::nextafter(a.low[i] / 2 + b.low[i] / 2, -HUGE_VAL);
        m.high[i] = std::nextafter(a.high[i] / 2 + b.high[i] / 2, HUGE_VAL);
    }
    return m;
}

class Distance {
public:
    Distance(const DistanceQuestion& question, const RunControl& control) : q_(question), control_(control) {}

    std::vector<std::string> run() {
        if (!(q_.bound > 0) || !std::isfinite(q_.bound)) return {"the bound on the distance is no length"};
        move_vertices();
        if (problems_.empty()) check_triangles();
        if (problems_.empty()) find_witnesses();
        return std::move(problems_);
    }

private:
    void fail(const std::string& text) {
        if (problems_.size() < 100) problems_.push_back("distance: " + text);
    }
    const Point3& at(VertexId v) const { return q_.mesh.positions[index_of(v)]; }

    bool in_box(const Point3& p) const {
        const double c[3] = {p.x, p.y, p.z};
        for (std::size_t a = 0; a < 3; ++a) {
            if (!(c[a] > q_.complex.place(a, 0)) || !(c[a] < q_.complex.place(a, q_.complex.side()))) return false;
        }
        return true;
    }

    void move_vertices() {
        const std::size_t count = q_.mesh.positions.size();
        outer_.resize(count);
        inner_.resize(count);
        std::vector<char> good(count, 0);
        core::parallel_for(count, 64, control_, [&](std::size_t begin, std::size_t end) {
            Enclosures enclosures(q_.function);
            for (std::size_t v = begin; v < end; ++v) {
                const Point3& p = q_.mesh.positions[v];
                const std::array<double, 4> guess = enclosures.guess({p.x, p.y, p.z});
                const double length = std::hypot(guess[1], guess[2], guess[3]);
                if (!(length > 0) || !std::isfinite(length)) continue;
                const double s = q_.bound * (1 - 0x1p-30) / length;
                outer_[v] = {p.x + s * guess[1], p.y + s * guess[2], p.z + s * guess[3]};
                inner_[v] = {p.x - s * guess[1], p.y - s * guess[2], p.z - s * guess[3]};
                // Differences of doubles and a norm: fewer than ten roundings.
                const double longest = q_.bound * (1 - 0x1p-45);
                good[v] = norm(outer_[v] - p) <= longest && norm(inner_[v] - p) <= longest && in_box(outer_[v]) &&
                          in_box(inner_[v]);
            }
        });
        for (std::size_t v = 0; v < count; ++v) {
            if (!good[v]) fail("vertex " + std::to_string(v + 1) + " cannot be moved by the bound to both sides");
        }
    }

    void check_triangles() {
        const std::size_t count = q_.mesh.triangles.size();
        std::vector<const char*> problem(count, nullptr);
        core::parallel_for(count, 16, control_, [&](std::size_t begin, std::size_t end) {
            Enclosures enclosures(q_.function);
            for (std::size_t i = begin; i < end && !control_.cancelled(); ++i) {
                const Triangle& t = q_.mesh.triangles[i];
                if (!keeps_turning(t, outer_, 1) || !keeps_turning(t, inner_, -1))
                    problem[i] = " turns over between its place and the moved one";
                else if (!has_sign(enclosures, t, outer_, 1) || !has_sign(enclosures, t, inner_, -1))
                    problem[i] = " is not proved to be within the bound of the zero set";
            }
        });
        for (std::size_t i = 0; i < count; ++i) {
            if (problem[i] != nullptr) fail("triangle " + std::to_string(i + 1) + problem[i]);
        }
        if (control_.cancelled()) fail("the check was cancelled");
    }

    /// The map (p, s) -> p + s d(p), d linear on the triangle, has a Jacobian of one sign for 0 <= s <= 1: at a corner
    /// k it is the quadratic polynomial (e1 + s g1) x (e2 + s g2) . d_k, positive if its Bernstein coefficients are.
    /// In doubles: differences of coordinates are off by half a unit in the last place, so e and g by less than 2^-52
    /// of `reach`, and products of three such vectors, with some thirty more roundings, by far less than 2^-44 of the
    /// product of their bounds; what might underflow is refused.
    bool keeps_turning(const Triangle& t, const std::vector<Point3>& moved, int side) const {
        const std::array<Point3, 3> d{moved[index_of(t[0])] - at(t[0]), moved[index_of(t[1])] - at(t[1]),
                                      moved[index_of(t[2])] - at(t[2])};
        const Point3 e1 = at(t[1]) - at(t[0]), e2 = at(t[2]) - at(t[0]);
        const Point3 g1 = d[1] - d[0], g2 = d[2] - d[0];
        const Point3 a = cross(e1, e2), c = cross(g1, g2);
        const Point3 b0 = cross(e1, g2), b1 = cross(g1, e2);
        const double reach1 = norm(e1) + norm(d[0]) + norm(d[1]), reach2 = norm(e2) + norm(d[0]) + norm(d[2]);
        for (const Point3& way : d) {
            const double least = 0x1p-44 * reach1 * reach2 * norm(way);
            if (!(least > 0x1p-900)) return false;
            const double first = side * dot(a, way), linear = side * (dot(b0, way) + dot(b1, way)),
                         square = side * dot(c, way);
            if (!(first > least) || !(first + linear / 2 > least) || !(first + linear + square > least)) return false;
        }
        return true;
    }

    static bool has_sign(Enclosures& enclosures, const Triangle& t, const std::vector<Point3>& moved, int sign) {
        return enclosures.proves_sign_on_triangle(
            {corner_of(moved[index_of(t[0])]), corner_of(moved[index_of(t[1])]), corner_of(moved[index_of(t[2])])},
            sign, middle_of);
    }

    /// A vertex of each component whose ways to both sides miss the frontier of W.
    void find_witnesses() {
        std::vector<BoundingBox> boxes;
        for (const Corners& face : q_.frontier) boxes.push_back(BoundingBox::of(face));
        const BoxTree tree(std::move(boxes));
        const auto misses = [&](const Point3& p, const Point3& q) {
            bool clear = true;
            tree.visit(BoundingBox::of(p, q), [&](std::uint32_t face) {
                clear = !segment_meets(p, q, q_.frontier[face]);
                return clear;
            });
            return clear;
        };
        std::map<std::uint32_t, bool> has_one;
        for (std::size_t i = 0; i < q_.mesh.triangles.size(); ++i) {
            bool& done = has_one[q_.component_of_triangle[i]];
            if (done) continue;
            const VertexId v = q_.mesh.triangles[i][0];
            done = misses(at(v), outer_[index_of(v)]) && misses(at(v), inner_[index_of(v)]);
        }
        for (const auto& [component, done] : has_one) {
            if (!done) fail("W is nowhere as thick as the bound around a component: a smaller one may be proved");
        }
    }

    const DistanceQuestion& q_;
    const RunControl& control_;
    std::vector<Point3> outer_, inner_;
    std::vector<std::string> problems_;
};

}  // namespace

std::vector<std::string> check_distance(const DistanceQuestion& question, const RunControl& control) {
    return Distance(question, control).run();
}

}  // namespace certa::verify
