#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fppg
{

/// A point or a vector; metres unless said otherwise.
struct Vec3
{
    double x = 0;
    double y = 0;
    double z = 0;

    double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    bool operator==(const Vec3&) const = default;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator-(const Vec3& a)
{
    return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(const Vec3& a, double s)
{
    return {a.x * s, a.y * s, a.z * s};
}
inline Vec3 operator*(double s, const Vec3& a)
{
    return a * s;
}
inline Vec3 operator/(const Vec3& a, double s)
{
    return {a.x / s, a.y / s, a.z / s};
}
inline double dot(const Vec3& a, const Vec3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(const Vec3& a, const Vec3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vec3& a)
{
    return std::sqrt(dot(a, a));
}
/// Radians between two directions, 0 to pi, exact near both ends.
inline double angle_between(const Vec3& a, const Vec3& b)
{
    return std::atan2(norm(cross(a, b)), dot(a, b));
}
inline bool is_finite(const Vec3& a)
{
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Axis-aligned box; empty until a point is added.
struct Box3
{
    Vec3 min{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
             std::numeric_limits<double>::infinity()};
    Vec3 max{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
             -std::numeric_limits<double>::infinity()};

    bool is_empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
    void add(const Vec3& p)
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            min[axis] = std::min(min[axis], p[axis]);
            max[axis] = std::max(max[axis], p[axis]);
        }
    }
    /// Whether a point is in the box, widened by `margin` on all sides.
    bool has(const Vec3& p, double margin) const
    {
        for (int axis = 0; axis < 3; ++axis)
            if (p[axis] < min[axis] - margin || p[axis] > max[axis] + margin) return false;
        return true;
    }
    std::array<Vec3, 8> corners() const
    {
        std::array<Vec3, 8> out;
        for (std::size_t k = 0; k < out.size(); ++k)
            out[k] = {(k & 1U) != 0 ? max.x : min.x, (k & 2U) != 0 ? max.y : min.y,
                      (k & 4U) != 0 ? max.z : min.z};
        return out;
    }
};

/// Affine map p -> linear * p + offset; rows of `linear` first.
struct Transform
{
    std::array<Vec3, 3> linear{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    Vec3 offset;

    Vec3 operator()(const Vec3& p) const
    {
        return {dot(linear[0], p) + offset.x, dot(linear[1], p) + offset.y,
                dot(linear[2], p) + offset.z};
    }
    bool is_identity() const { return *this == Transform{}; }
    bool operator==(const Transform&) const = default;
};

/// The map that applies `b` first, then `a`.
Transform operator*(const Transform& a, const Transform& b);

} // namespace fppg
