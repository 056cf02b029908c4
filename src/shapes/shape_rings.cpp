#include "shapes/shape_rings.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace fppg
{
namespace
{

using Float3 = std::array<float, 3>;
/// Rows of a 3 x 4 matrix; the fourth row is (0, 0, 0, 1).
using Matrix = std::array<std::array<float, 4>, 3>;

constexpr Matrix identity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

Float3 as_float(const Vec3& v)
{
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Vec3 as_double(const Float3& v)
{
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

Matrix product(const Matrix& a, const Matrix& b)
{
    Matrix out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] +
                        (j == 3 ? a[i][3] : 0.0F);
    return out;
}

Float3 product(const Matrix& m, const Float3& p)
{
    Float3 out{};
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3];
    return out;
}

/// The turn about the line from `a` along `axis`, clockwise seen from its tip.
Matrix turn_about(const Float3& a, const Float3& axis, double degrees)
{
    const auto [x, y, z] = axis;
    const float length = std::sqrt(x * x + y * y + z * z);
    const float flat = std::sqrt(y * y + z * z);
    const float cos_x = flat == 0 ? 0.0F : z / flat;
    const float sin_x = flat == 0 ? 1.0F : y / flat;
    const float cos_y = flat / length;
    const float sin_y = x / length;
    const auto angle = static_cast<float>(static_cast<double>(static_cast<float>(degrees)) *
                                          (std::numbers::pi / 180));
    const float cos_z = std::cos(angle);
    const float sin_z = std::sin(angle);
    Matrix to = identity;
    Matrix from = identity;
    for (std::size_t i = 0; i < 3; ++i)
    {
        to[i][3] = a[i];
        from[i][3] = -a[i];
    }
    Matrix m = product(to, {{{1, 0, 0, 0}, {0, cos_x, sin_x, 0}, {0, -sin_x, cos_x, 0}}});
    m = product(m, {{{cos_y, 0, sin_y, 0}, {0, 1, 0, 0}, {-sin_y, 0, cos_y, 0}}});
    m = product(m, {{{cos_z, sin_z, 0, 0}, {-sin_z, cos_z, 0, 0}, {0, 0, 1, 0}}});
    m = product(m, {{{cos_y, 0, -sin_y, 0}, {0, 1, 0, 0}, {sin_y, 0, cos_y, 0}}});
    m = product(m, {{{1, 0, 0, 0}, {0, cos_x, -sin_x, 0}, {0, sin_x, cos_x, 0}}});
    return product(m, from);
}

/// From the axis to the first corner.
Float3 first_spoke(const Float3& axis, float radius)
{
    const std::size_t k = axis[0] != 0 ? 0 : axis[1] != 0 ? 1 : 2;
    Float3 across{1, 1, 1};
    across[k] = (-axis[(k + 1) % 3] - axis[(k + 2) % 3]) / axis[k];
    const float length =
        std::sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2]);
    const float scale = radius / length;
    for (float& c : across) c *= scale;
    return across;
}

Float3 sum(const Float3& a, const Float3& b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

} // namespace

std::array<std::vector<Vec3>, 2> cylinder_rings(const Vec3& a, const Vec3& b, double radius,
                                                int sides)
{
    const Float3 begin = as_float(a);
    const Float3 end = as_float(b);
    const Float3 axis{end[0] - begin[0], end[1] - begin[1], end[2] - begin[2]};
    const Matrix turn = turn_about(begin, axis, 360.0 / sides);
    std::array<std::vector<Vec3>, 2> out;
    Float3 corner = sum(begin, first_spoke(axis, static_cast<float>(radius)));
    for (int i = 0; i < sides; ++i)
    {
        out[0].push_back(as_double(corner));
        out[1].push_back(as_double(sum(corner, axis)));
        corner = product(turn, corner);
    }
    return out;
}

std::vector<std::vector<Vec3>> sphere_rings(const Vec3& center, double radius, int sides)
{
    const Float3 middle = as_float(center);
    const auto up = static_cast<float>(radius);
    const Float3 low = sum(middle, {0, 0, -up});
    const Matrix rise = turn_about(middle, {1, 0, 0}, 180.0 / sides);
    const Matrix around = turn_about(middle, {0, 0, 1}, 360.0 / sides);
    std::vector<std::vector<Vec3>> out{{as_double(low)}};
    Float3 first = low;
    for (int ring = 1; ring < sides; ++ring)
    {
        first = product(rise, first);
        std::vector<Vec3>& corners = out.emplace_back();
        Float3 corner = first;
        for (int i = 0; i < sides; ++i)
        {
            corners.push_back(as_double(corner));
            corner = product(around, corner);
        }
    }
    out.push_back({as_double(sum(middle, {0, 0, up}))});
    return out;
}

} // namespace fppg
