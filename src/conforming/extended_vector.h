#pragma once
// Vectors in extended precision, for positions that are computed once and then rounded to doubles.
#include <certa/types.h>

#include <cmath>

namespace certa::conforming {

struct Vector {
    long double x = 0.0L, y = 0.0L, z = 0.0L;

    Vector() = default;
    Vector(long double vx, long double vy, long double vz) : x(vx), y(vy), z(vz) {}
    explicit Vector(const Point3& p) : x(p.x), y(p.y), z(p.z) {}

    Point3 rounded() const { return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}; }
};

inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator-(const Vector& a) { return {-a.x, -a.y, -a.z}; }
inline Vector operator*(long double s, const Vector& a) { return {s * a.x, s * a.y, s * a.z}; }
inline long double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline long double length(const Vector& a) { return std::sqrt(dot(a, a)); }
inline Vector normalized(const Vector& a) { return (1.0L / length(a)) * a; }
inline Vector difference(const Point3& a, const Point3& b) { return Vector(a) - Vector(b); }

}  // namespace certa::conforming
