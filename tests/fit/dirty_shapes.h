#pragma once

#include "meshes/test_shapes.h"

namespace fppg::test
{

/// Spheres of radius 1 and cubes of edge 2 with one fault each.

inline TriangleSoup part_of(const TriangleSoup& soup, const auto& is_kept)
{
    TriangleSoup result;
    for (std::size_t f = 0; f < soup.size(); ++f)
        if (is_kept(f))
            add_facet(result, soup.vertices[3 * f], soup.vertices[3 * f + 1],
                      soup.vertices[3 * f + 2]);
    return result;
}

inline TriangleSoup unit_cube()
{
    return box({-1, -1, -1}, {1, 1, 1});
}

/// Every tenth facet twice, every tenth as well turned over.
inline TriangleSoup sphere_with_copies()
{
    const TriangleSoup good = sphere(3);
    const TriangleSoup copies = part_of(good, [](std::size_t f) { return f % 10 == 3; });
    const TriangleSoup others = part_of(good, [](std::size_t f) { return f % 10 == 7; });
    return joined(joined(good, copies), inverted(others));
}

inline TriangleSoup sphere_with_turned_facets()
{
    const TriangleSoup good = sphere(3);
    const auto is_turned = [](std::size_t f) { return f % 3 == 1; };
    return joined(part_of(good, [&](std::size_t f) { return !is_turned(f); }),
                  inverted(part_of(good, is_turned)));
}

inline TriangleSoup sphere_with_holes()
{
    return part_of(sphere(3), [](std::size_t f) { return f % 100 != 5; });
}

/// A quarter of the surface is missing: a bowl.
inline TriangleSoup open_bowl()
{
    const TriangleSoup good = sphere(3);
    return part_of(good, [&](std::size_t f) { return good.vertices[3 * f].z < 0.5; });
}

/// The lid of a cube in finer facets than its sides.
inline TriangleSoup cube_with_t_junctions()
{
    const TriangleSoup good = unit_cube();
    TriangleSoup soup = part_of(good,
                                [&](std::size_t f)
                                {
                                    const Vec3* p = &good.vertices[3 * f];
                                    return !(p[0].z == 1 && p[1].z == 1 && p[2].z == 1);
                                });
    for (int i = -2; i < 2; ++i)
        for (int j = -2; j < 2; ++j)
            add_quad(soup, {0.5 * i, 0.5 * j, 1}, {0.5 * (i + 1), 0.5 * j, 1},
                     {0.5 * (i + 1), 0.5 * (j + 1), 1}, {0.5 * i, 0.5 * (j + 1), 1});
    return soup;
}

inline TriangleSoup sphere_with_degenerate_facets()
{
    TriangleSoup soup = sphere(3);
    for (std::size_t f = 0; f < 40; ++f)
    {
        const Vec3 a = soup.vertices[3 * f], b = soup.vertices[3 * f + 1];
        add_facet(soup, a, a, b);
        add_facet(soup, a, b, 0.5 * (a + b));
    }
    return soup;
}

inline TriangleSoup cube_with_a_fin()
{
    TriangleSoup soup = unit_cube();
    add_quad(soup, {1, -0.5, 0}, {2, -0.5, 0}, {2, 0.5, 0}, {1, 0.5, 0});
    return soup;
}

inline TriangleSoup overlapping_spheres()
{
    return joined(sphere(3), moved(sphere(3), {.offset = {1, 0, 0}}));
}

inline TriangleSoup scaled(const TriangleSoup& soup, double factor)
{
    return moved(soup,
                 {.linear = {Vec3{factor, 0, 0}, {0, factor, 0}, {0, 0, factor}}, .offset = {}});
}

inline TriangleSoup sphere_with_cavity()
{
    return joined(sphere(3), inverted(scaled(sphere(3), 0.5)));
}

/// Every corner moved on its own by up to 1e-5, so that no two facets meet.
inline TriangleSoup sphere_of_loose_facets()
{
    TriangleSoup soup = sphere(3);
    std::uint32_t state = 1;
    const auto next = [&state]
    { return 2e-5 * ((state = state * 1664525u + 1013904223u) / 4294967296.0 - 0.5); };
    for (Vec3& p : soup.vertices)
    {
        p.x += next();
        p.y += next();
        p.z += next();
    }
    return soup;
}

} // namespace fppg::test
