#include "walls/lattice_stretch.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fppg
{
namespace
{

/// Planes nearer than this are one, dp.
constexpr double same_place_dp = 0.01;
/// A wall is on nodes when its particles are so near to them, steps.
constexpr double on_nodes = 0.02;
/// Of dp, how much longer or shorter a step may be.
constexpr double most_stretch = 0.05;
/// Between two walls that are nearer to each other steps stay.
constexpr double least_steps = 4;
/// Volume of a particle, of dp^3, that nothing has to make up for.
constexpr double volume_room = 0.002;
constexpr double noise_of_area = 1e-6;

/// Where the first particles of a wall are if its fluid is on a side.
double particles_at(const WetPlane& plane, int side)
{
    return plane.at - side * plane.depth;
}

/// The plane of the most area that has fluid on a side; of two with as much that farther out.
std::optional<WetPlane> end_of(std::vector<WetPlane> planes, int side, double dp)
{
    std::erase_if(planes, [side](const WetPlane& p) { return p.side == -side; });
    const auto at = [side](const WetPlane& p) { return particles_at(p, side); };
    std::sort(planes.begin(), planes.end(),
              [&](const WetPlane& a, const WetPlane& b) { return side * at(a) < side * at(b); });
    std::optional<WetPlane> best;
    for (std::size_t i = 0; i < planes.size();)
    {
        WetPlane plane = planes[i];
        for (++i; i < planes.size() && std::abs(at(planes[i]) - at(plane)) < same_place_dp * dp;
             ++i)
            plane.area += planes[i].area;
        if (!best || plane.area > best->area * (1 + noise_of_area)) best = plane;
    }
    return best;
}

/// How much area has its first particles on nodes.
double area_on_nodes(const std::vector<WetPlane>& planes, double node, double step)
{
    double area = 0;
    for (const WetPlane& plane : planes)
    {
        const auto is_on_nodes = [&](int side)
        {
            const double at = (particles_at(plane, side) - node) / step;
            return plane.side != -side && std::abs(at - std::round(at)) < on_nodes;
        };
        if (is_on_nodes(1) || is_on_nodes(-1)) area += plane.area;
    }
    return area;
}

} // namespace

LatticeStretch stretch_between_walls(const std::array<std::vector<WetPlane>, 3>& planes,
                                     const LatticeGrid& grid, const Vec3& gravity)
{
    const LatticeStretch plain{{1, 1, 1}, grid.origin};
    LatticeStretch out = plain;
    double volume = 1;
    std::optional<int> free; // the axis that makes up for the volume
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto a = static_cast<std::size_t>(axis);
        if (grid.is_periodic[a] || (axis == 1 && grid.is_2d)) continue;
        const auto low = end_of(planes[a], 1, grid.dp);
        const auto high = end_of(planes[a], -1, grid.dp);
        const double apart = low && high ? particles_at(*high, -1) - particles_at(*low, 1) : 0;
        if (apart > least_steps * grid.dp)
        {
            const double steps = std::round(apart / grid.dp);
            const double stretch = apart / (steps * grid.dp);
            if (!(std::abs(stretch - 1) <= most_stretch)) continue;
            out.stretch[axis] = stretch;
            out.anchor[axis] = particles_at(*low, 1);
            // Of the fluid, which is not between the particles but between the surfaces.
            const double behind = low->depth + high->depth;
            volume *= (apart - behind) / (steps * grid.dp - behind);
            continue;
        }
        if (!free || std::abs(gravity[axis]) > std::abs(gravity[*free])) free = axis;
        if (low || high) out.anchor[axis] = low ? particles_at(*low, 1) : particles_at(*high, -1);
    }
    if (free && std::abs(1 / volume - 1) <= most_stretch)
        out.stretch[*free] = 1 / volume;
    else if (!(std::abs(volume - 1) <= volume_room))
        return plain;
    double gain = 0;
    double total = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const std::vector<WetPlane>& across = planes[static_cast<std::size_t>(axis)];
        const double before = area_on_nodes(across, grid.origin[axis], grid.dp);
        gain += area_on_nodes(across, out.anchor[axis], out.stretch[axis] * grid.dp) - before;
        total += before;
    }
    return gain > noise_of_area * total ? out : plain;
}

} // namespace fppg
