#pragma once

#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "fppg/mesh.h"

namespace fppg::test
{

inline void add_facet(TriangleSoup& soup, const Vec3& a, const Vec3& b, const Vec3& c)
{
    soup.vertices.insert(soup.vertices.end(), {a, b, c});
}

/// A convex or concave quadrilateral, counter-clockwise from outside.
inline void add_quad(TriangleSoup& soup, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    add_facet(soup, a, b, c);
    add_facet(soup, a, c, d);
}

/// A box of eight corners, first the four of the bottom counter-clockwise from above.
inline TriangleSoup hexahedron(const std::array<Vec3, 8>& p)
{
    TriangleSoup soup;
    add_quad(soup, p[3], p[2], p[1], p[0]);
    add_quad(soup, p[4], p[5], p[6], p[7]);
    for (std::size_t i = 0; i < 4; ++i)
        add_quad(soup, p[i], p[(i + 1) % 4], p[4 + (i + 1) % 4], p[4 + i]);
    return soup;
}

inline TriangleSoup box(const Vec3& low, const Vec3& high)
{
    return hexahedron({Vec3{low.x, low.y, low.z}, Vec3{high.x, low.y, low.z},
                       Vec3{high.x, high.y, low.z}, Vec3{low.x, high.y, low.z},
                       Vec3{low.x, low.y, high.z}, Vec3{high.x, low.y, high.z},
                       Vec3{high.x, high.y, high.z}, Vec3{low.x, high.y, high.z}});
}

/// |x| + |y| + |z| <= radius.
inline TriangleSoup octahedron(double radius)
{
    TriangleSoup soup;
    for (const double z : {-radius, radius})
        for (const double y : {-radius, radius})
            for (const double x : {-radius, radius})
            {
                if (x * y * z > 0)
                    add_facet(soup, {x, 0, 0}, {0, y, 0}, {0, 0, z});
                else
                    add_facet(soup, {0, y, 0}, {x, 0, 0}, {0, 0, z});
            }
    return soup;
}

/// A sphere of radius 1 from an octahedron, every facet cut into four `levels` times.
inline TriangleSoup sphere(int levels)
{
    TriangleSoup soup = octahedron(1);
    for (int level = 0; level < levels; ++level)
    {
        TriangleSoup finer;
        for (std::size_t i = 0; i < soup.size(); ++i)
        {
            const Vec3* const p = &soup.vertices[3 * i];
            const auto middle = [](const Vec3& a, const Vec3& b) { return (a + b) / norm(a + b); };
            const Vec3 ab = middle(p[0], p[1]);
            const Vec3 bc = middle(p[1], p[2]);
            const Vec3 ca = middle(p[2], p[0]);
            add_facet(finer, p[0], ab, ca);
            add_facet(finer, ab, p[1], bc);
            add_facet(finer, ca, bc, p[2]);
            add_facet(finer, ab, bc, ca);
        }
        soup = finer;
    }
    return soup;
}

inline TriangleSoup joined(TriangleSoup a, const TriangleSoup& b)
{
    a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
    return a;
}

inline TriangleSoup inverted(TriangleSoup soup)
{
    for (std::size_t i = 0; i < soup.size(); ++i)
        std::swap(soup.vertices[3 * i + 1], soup.vertices[3 * i + 2]);
    return soup;
}

inline TriangleSoup moved(TriangleSoup soup, const Transform& transform)
{
    for (Vec3& vertex : soup.vertices) vertex = transform(vertex);
    return soup;
}

/// How often the facets wind around a point that is not on them, by the sum of solid angles.
/// Source: A. Van Oosterom and J. Strackee, The Solid Angle of a Plane Triangle, 1983.
inline double winding_number(const TriangleSoup& soup, const Vec3& point)
{
    double sum = 0;
    for (std::size_t i = 0; i < soup.size(); ++i)
    {
        const Vec3 a = soup.vertices[3 * i] - point;
        const Vec3 b = soup.vertices[3 * i + 1] - point;
        const Vec3 c = soup.vertices[3 * i + 2] - point;
        sum +=
            2 * std::atan2(dot(a, cross(b, c)), norm(a) * norm(b) * norm(c) + dot(a, b) * norm(c) +
                                                    dot(b, c) * norm(a) + dot(c, a) * norm(b));
    }
    return sum / (4 * 3.14159265358979323846);
}

} // namespace fppg::test
