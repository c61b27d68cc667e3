// Point-segment and point-plane distances. Differences of doubles carry 64 bits here, so the results are good to about
// 1e-19 of the coordinates' differences, far below any tolerance that doubles can meet.
#include "verify/distance.h"

#include <cmath>
#include <limits>

namespace certa::verify {
namespace {

static_assert(std::numeric_limits<long double>::digits >= 64, "distances rest on extended precision");

Vec<long double> difference(const Point3& from, const Point3& to) {
    return {static_cast<long double>(to.x) - from.x, static_cast<long double>(to.y) - from.y,
            static_cast<long double>(to.z) - from.z};
}
long double norm(const Vec<long double>& v) { return std::sqrt(dot_of(v, v)); }

}  // namespace

double distance_to_segment(const Point3& p, const Point3& a, const Point3& b) {
    const Vec<long double> u = difference(a, b), v = difference(a, p);
    const long double along = dot_of(u, v), length = dot_of(u, u);
    if (along <= 0.0L || length == 0.0L) return static_cast<double>(norm(v));
    if (along >= length) return static_cast<double>(norm(difference(b, p)));
    return static_cast<double>(norm(cross_of(u, v)) / std::sqrt(length));
}

FacetPlane::FacetPlane(const std::vector<Point3>& corners, const NewellNormal& normal) {
    // About the first corner: far from the origin the sum of the coordinates would lose bits.
    for (const Point3& p : corners) origin_ = origin_ + difference(corners[0], p);
    if (!corners.empty()) {
        const Vec<long double> first{corners[0].x, corners[0].y, corners[0].z};
        origin_ = first + (1.0L / static_cast<long double>(corners.size())) * origin_;
    }
    normal_ = normal.direction();
}

double FacetPlane::distance(const Point3& p) const {
    if (normal_.x == 0.0L && normal_.y == 0.0L && normal_.z == 0.0L) return std::numeric_limits<double>::infinity();
    return static_cast<double>(
        std::fabs(dot_of(normal_, Vec<long double>{p.x - origin_.x, p.y - origin_.y, p.z - origin_.z})));
}

}  // namespace certa::verify
