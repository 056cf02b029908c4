#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "fppg/surface_mesh.h"

namespace fppg
{

/// The corners of a facet.
using Facet = std::array<std::uint32_t, 3>;

/// What float32 may have rounded away of a coordinate, with room for two roundings.
inline constexpr double float_step = 1.0 / (1 << 22);

/// Metres: no repair moves a corner further. 0.15 dp; without bound where dp is 0, unknown.
inline double widest_crack(double dp)
{
    return dp > 0 ? 0.15 * dp : std::numeric_limits<double>::infinity();
}

inline double largest_coordinate(const Vec3& p)
{
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

/// The shape of one facet.
struct Measures
{
    Vec3 normal;       ///< of unit length
    double area = 0;   ///< metres squared
    double height = 0; ///< over the longest side, metres
    int longest = 0;   ///< the longest side
};

Measures measure(const SurfaceMesh& mesh, const Facet& f);

/// Six times the volume between a facet and a point.
inline double volume_times_six(const SurfaceMesh& mesh, std::size_t f, const Vec3& from)
{
    const Facet& corners = mesh.facets[f];
    return dot(mesh.vertices[corners[0]] - from,
               cross(mesh.vertices[corners[1]] - from, mesh.vertices[corners[2]] - from));
}

/// Turns a facet around, as it stands in the edge map.
inline void flip(SurfaceMesh& mesh, std::size_t f)
{
    std::swap(mesh.facets[f][1], mesh.facets[f][2]);
    std::swap(mesh.facet_edges[f][0], mesh.facet_edges[f][2]);
    std::swap(mesh.neighbours[f][0], mesh.neighbours[f][2]);
}

/// Drops the marked facets; the edge map is to be built anew.
///
/// is_dropped  one entry per facet, not 0 for those that go
void erase_facets(const std::vector<char>& is_dropped, SurfaceMesh& mesh);

} // namespace fppg
