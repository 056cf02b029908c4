#include "batch/fluid_near_walls.h"

#include "balance/iterations.h"
#include "meshes/mesh_query.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace fppg
{
namespace
{

constexpr std::uint64_t most_samples = 5000;

} // namespace

std::vector<Vec3> sample_fluid(const RunField& field, std::uint16_t first_bound)
{
    const auto for_each_run = [&](const auto& visit)
    {
        for (std::size_t x = 0; x < field.slabs.size(); ++x)
            for (const Run& run : field.slabs[x])
                if (run.mk < first_bound) visit(x, run);
    };
    std::uint64_t all = 0;
    for_each_run([&](std::size_t, const Run& run) { all += run.z_end - run.z_begin; });
    const std::uint64_t stride = std::max<std::uint64_t>(1, all / most_samples);
    std::vector<Vec3> out;
    std::uint64_t until_next = 0;
    for_each_run(
        [&](std::size_t x, const Run& run)
        {
            std::uint64_t z = run.z_begin + until_next;
            for (; z < run.z_end; z += stride)
                out.push_back(field.grid.place(
                    {static_cast<double>(x), static_cast<double>(run.y), static_cast<double>(z)}));
            until_next = z - run.z_end;
        });
    return out;
}

std::vector<double> distances_to(TriangleSoup surface, const std::vector<Vec3>& places, double most,
                                 int threads)
{
    std::vector<double> out(places.size(), std::numeric_limits<double>::infinity());
    if (places.empty() || surface.size() == 0) return out;
    const MeshQuery query(std::move(surface), threads);
    std::transform(places.begin(), places.end(), out.begin(),
                   [&](const Vec3& p) { return query.closest_point(p, most).distance; });
    return out;
}

double share_within(const std::vector<double>& distances, double most)
{
    if (distances.empty()) return 0;
    const auto near =
        std::count_if(distances.begin(), distances.end(), [&](double d) { return d <= most; });
    return static_cast<double>(near) / static_cast<double>(distances.size());
}

TriangleSoup slanted_facets(const TriangleSoup& surface)
{
    constexpr double along_axis = 0.9999;
    TriangleSoup out;
    const std::vector<Vec3>& v = surface.vertices;
    for (std::size_t f = 0; f < surface.size(); ++f)
    {
        const Vec3 n = cross(v[3 * f + 1] - v[3 * f], v[3 * f + 2] - v[3 * f]);
        const double most = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
        if (most < along_axis * norm(n))
            out.vertices.insert(out.vertices.end(), v.begin() + static_cast<std::ptrdiff_t>(3 * f),
                                v.begin() + static_cast<std::ptrdiff_t>(3 * f + 3));
    }
    return out;
}

double steps_to_balance(const CaseDef& def, double particles, const FluidHold& walls)
{
    constexpr int iterations_to_find_out = 40;
    constexpr double skin_dp = 0.5;
    constexpr double slanted_of_hard = 1.5;
    if (particles == 0) return 0;
    const bool is_2d = def.grid.is_2d;
    const double h_dp = def.h / def.grid.dp, reach = 2 * h_dp + skin_dp;
    const double neighbours = std::numbers::pi * reach * reach * (is_2d ? 1 : 4.0 / 3 * reach);
    if (!walls.holds) return particles * iterations_to_find_out * std::sqrt(neighbours);
    const int usual = usual_iterations(static_cast<std::size_t>(particles));
    const double hard = std::min(1.0, slanted_of_hard * walls.slanted);
    return particles * (first_settled + hard * (usual - first_settled)) * std::sqrt(neighbours);
}

} // namespace fppg
