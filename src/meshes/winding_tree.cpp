#include "meshes/winding_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fppg
{

namespace
{

constexpr std::uint32_t leaf_size = 8;
constexpr double far_radii = 3;

/// Half the solid angle of a facet seen from the origin.
/// Source: Van Oosterom and Strackee, The Solid Angle of a Plane Triangle, 1983.
double half_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const double la = norm(a), lb = norm(b), lc = norm(c);
    const double det = dot(a, cross(b, c));
    const double div = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    if (det == 0 && div == 0) return 0;
    return std::atan2(det, div);
}

} // namespace

WindingTree::WindingTree(const TriangleSoup& soup) : soup_(soup), order_(soup.size())
{
    if (soup.size() == 0) return;
    std::vector<Vec3> middles(soup.size());
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        order_[f] = static_cast<std::uint32_t>(f);
        const Vec3* p = &soup.vertices[3 * f];
        middles[f] = (p[0] + p[1] + p[2]) / 3.0;
    }
    build(0, static_cast<std::uint32_t>(soup.size()), middles);
}

std::uint32_t WindingTree::build(std::uint32_t begin, std::uint32_t end,
                                 const std::vector<Vec3>& middles)
{
    const auto at = static_cast<std::uint32_t>(groups_.size());
    groups_.emplace_back();
    Group group;
    group.begin = begin;
    group.end = end;
    Box3 box;
    double area = 0;
    for (std::uint32_t i = begin; i < end; ++i)
    {
        const Vec3* p = &soup_.vertices[3 * std::size_t{order_[i]}];
        const Vec3& middle = middles[order_[i]];
        const Vec3 vector = 0.5 * cross(p[1] - p[0], p[2] - p[0]);
        const double size = norm(vector);
        group.area_vector = group.area_vector + vector;
        group.centre = group.centre + size * middle;
        area += size;
        box.add(middle);
    }
    group.centre = area > 0 ? group.centre / area : 0.5 * (box.min + box.max);
    for (std::uint32_t i = begin; i < end; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            group.radius = std::max(
                group.radius, norm(soup_.vertices[3 * std::size_t{order_[i]} + k] - group.centre));
    if (end - begin > leaf_size)
    {
        const Vec3 size = box.max - box.min;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                         [&](std::uint32_t f, std::uint32_t g)
                         {
                             const double p = middles[f][axis], q = middles[g][axis];
                             return p != q ? p < q : f < g;
                         });
        build(begin, middle, middles);
        group.second = build(middle, end, middles);
    }
    groups_[at] = group;
    return at;
}

double WindingTree::winding_number(const Vec3& point) const
{
    if (groups_.empty()) return 0;
    double dipoles = 0, halves = 0;
    std::uint32_t stack[64];
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0)
    {
        const std::uint32_t at = stack[--depth];
        const Group& group = groups_[at];
        const Vec3 away = group.centre - point;
        const double squared = dot(away, away);
        if (squared > far_radii * far_radii * group.radius * group.radius)
        {
            dipoles += dot(group.area_vector, away) / (squared * std::sqrt(squared));
            continue;
        }
        if (group.second != 0)
        {
            stack[depth++] = group.second;
            stack[depth++] = at + 1;
            continue;
        }
        for (std::uint32_t i = group.begin; i < group.end; ++i)
        {
            const Vec3* p = &soup_.vertices[3 * std::size_t{order_[i]}];
            halves += half_solid_angle(p[0] - point, p[1] - point, p[2] - point);
        }
    }
    return (dipoles + 2 * halves) / (4 * std::numbers::pi);
}

} // namespace fppg
