#include "walls/plate_thickness.h"

#include "core/parallel.h"
#include "meshes/facing_distance.h"
#include "meshes/measure_facets.h"
#include "meshes/mesh_query.h"
#include "walls/step_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace fppg
{
namespace
{

/// Bodies of more volume for their surface are no plates, dp: that of a plate is its thickness.
constexpr double no_plate_dp = 4;
/// Where the thickness is looked for: from the middle of a facet towards its corners.
constexpr double off_middle = 0.6;
constexpr double least_plate_share = 0.5; ///< of the surface of a plate

std::vector<double> thicknesses(const SurfaceMesh& mesh, const LatticeGrid& grid, double thin_dp,
                                int threads)
{
    const MeshQuery query(soup_of(mesh), threads);
    query.prepare_nearest();
    const double reach = (1 - 1e-9) * thin_dp * grid.dp;
    std::vector<double> out(mesh.facets.size(), std::numeric_limits<double>::infinity());
    parallel_for(
        out.size(), threads,
        [&](std::size_t f)
        {
            if (grid.is_2d && lies_across(mesh.normals[f], 1)) return;
            const auto& corners = mesh.facets[f];
            Vec3 middle;
            for (const std::uint32_t v : corners) middle = middle + mesh.vertices[v] / 3;
            std::array<double, 4> found{};
            for (std::size_t c = 0; c < found.size(); ++c)
            {
                const Vec3 at =
                    c == 3 ? middle
                           : off_middle * mesh.vertices[corners[c]] + (1 - off_middle) * middle;
                const double through =
                    facing_distance(mesh.normals, query, {static_cast<std::uint32_t>(f), at},
                                    FacetSide::Behind, reach);
                if (!std::isfinite(through))
                {
                    found[c] = through;
                    continue;
                }
                // Through round shells the way along an axis is longer.
                const Vec3& n = mesh.normals[f];
                const ClosestPoint other = query.closest_point(at - through * n, reach);
                found[c] = std::max(least_thickness_dp * grid.dp, dot(at - other.point, n));
            }
            std::sort(found.begin(), found.end());
            out[f] = found[1];
        },
        256);
    return out;
}

} // namespace

bool may_be_plate(const TriangleSoup& soup, double dp)
{
    double volume = 0;
    double area = 0;
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        const Vec3* c = &soup.vertices[3 * f];
        const Vec3 across = cross(c[1] - c[0], c[2] - c[0]);
        volume += dot(c[0] - soup.vertices[0], across) / 6;
        area += norm(across) / 2;
    }
    return 2 * std::abs(volume) < no_plate_dp * dp * area;
}

PlateThickness plate_thickness(const SurfaceMesh& mesh, const LatticeGrid& grid, int threads,
                               double thin_dp)
{
    PlateThickness out{thicknesses(mesh, grid, thin_dp, threads),
                       std::numeric_limits<double>::infinity()};
    double thin = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        if (grid.is_2d && lies_across(mesh.normals[f], 1)) continue;
        out.area += mesh.areas[f];
        if (std::isfinite(out.of_facets[f])) thin += mesh.areas[f];
        out.least = std::min(out.least, out.of_facets[f]);
    }
    out.is_plate = thin > 0 && thin >= least_plate_share * out.area;
    return out;
}

} // namespace fppg
