#include "meshes/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace fppg
{
namespace
{

/// Facets are looked at in parts, as many along each side, where there are few of them.
constexpr std::size_t few_facets = 1000;
constexpr int parts_of_few = 4;
/// Of more than these every second, third, ... is looked at.
constexpr std::size_t enough_facets = 20000;

/// What is left of widths, so that facets keep their share of the area.
constexpr double pressed = 1e-6;
/// Facets whose normal is so near to the y axis are across the plane.
constexpr double across = 1 - 1e-8;

/// A facet in parts * parts triangles of one size.
std::vector<Vec3> middles_of_parts(const Vec3* corners, int parts)
{
    const Vec3 u = (corners[1] - corners[0]) / parts;
    const Vec3 v = (corners[2] - corners[0]) / parts;
    std::vector<Vec3> out;
    for (int i = 0; i < parts; ++i)
        for (int j = 0; j < parts - i; ++j)
        {
            out.push_back(corners[0] + (i + 1.0 / 3) * u + (j + 1.0 / 3) * v);
            if (i + j < parts - 1)
                out.push_back(corners[0] + (i + 2.0 / 3) * u + (j + 2.0 / 3) * v);
        }
    return out;
}

} // namespace

double distance_of_share(const TriangleSoup& facets, const MeshQuery& surface, double share)
{
    const std::size_t count = facets.vertices.size() / 3;
    const int parts = count < few_facets ? parts_of_few : 1;
    const std::size_t stride = 1 + count / enough_facets;
    std::vector<std::pair<double, double>> by_distance; // with the area
    double all = 0;
    for (std::size_t f = 0; f < count; f += stride)
    {
        const Vec3* corners = &facets.vertices[3 * f];
        const double area = 0.5 * norm(cross(corners[1] - corners[0], corners[2] - corners[0]));
        if (!(area > 0)) continue;
        for (const Vec3& middle : middles_of_parts(corners, parts))
            by_distance.emplace_back(surface.closest_point(middle).distance,
                                     area / (parts * parts));
        all += area;
    }
    std::sort(by_distance.begin(), by_distance.end());
    double within = 0;
    for (const auto& [distance, area] : by_distance)
    {
        within += area;
        if (within >= share * all) return distance;
    }
    return by_distance.empty() ? 0 : by_distance.back().first;
}

TriangleSoup pressed_to_plane(const TriangleSoup& facets, double y)
{
    TriangleSoup out;
    for (std::size_t f = 0; f + 2 < facets.vertices.size(); f += 3)
    {
        const Vec3* v = &facets.vertices[f];
        const Vec3 normal = cross(v[1] - v[0], v[2] - v[0]);
        if (std::abs(normal.y) > across * norm(normal)) continue;
        for (int k = 0; k < 3; ++k)
            out.vertices.push_back({v[k].x, y + pressed * (v[k].y - y), v[k].z});
    }
    return out;
}

} // namespace fppg
