#include "fppg/relax_volume.h"

#include "core/parallel.h"
#include "relax/continuum.h"
#include "relax/kernel.h"
#include "relax/neighbour_list.h"
#include "relax/wall_planes.h"

#include <cmath>

namespace fppg
{

std::vector<double> shepard_sums(std::span<const Vec3> particles,
                                 const VolumeSurroundings& surroundings,
                                 const ShepardOptions& options, int threads)
{
    std::vector<double> sums(particles.size());
    if (particles.empty()) return sums;
    const double h = options.h_dp;
    const Vec3 origin = particles[particles.size() / 2];
    PointArrays points;
    for (const auto& some : {particles, surroundings.held, surroundings.walls})
        for (const Vec3& p : some)
        {
            points.x.push_back(static_cast<float>((p.x - origin.x) / options.dp));
            points.y.push_back(options.is_2d ? 0.0f
                                             : static_cast<float>((p.y - origin.y) / options.dp));
            points.z.push_back(static_cast<float>((p.z - origin.z) / options.dp));
        }
    NeighbourList list(static_cast<float>(2 * h), 0);
    list.build(
        points, threads, [&](std::uint32_t i) { return i < particles.size(); },
        [](std::uint32_t, std::uint32_t) { return true; });
    const HalfSpace beyond(h, options.is_2d);
    const double alpha = options.is_2d ? wendland_alpha_2d(h) : wendland_alpha_3d(h);
    parallel_for(
        list.rows(), threads,
        [&](std::size_t row)
        {
            const std::uint32_t i = list.point(row);
            if (i >= particles.size()) return;
            double sum = 1;
            for (const std::uint32_t j : list.neighbours(row))
                sum += wendland(std::hypot(double{points.x[i]} - double{points.x[j]},
                                           double{points.y[i]} - double{points.y[j]},
                                           double{points.z[i]} - double{points.z[j]}) /
                                h);
            sum *= alpha;
            const double reach = (2 * h - options.behind_wall_dp) * options.dp;
            for (const WallPlane& plane :
                 find_wall_planes(particles[i], reach, surroundings.closest))
                sum += beyond.share(plane.distance / options.dp + options.behind_wall_dp);
            sums[i] = sum;
        },
        NeighbourList::rows_per_chunk);
    return sums;
}

} // namespace fppg
