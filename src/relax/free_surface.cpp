#include "relax/free_surface.h"

#include "core/parallel.h"
#include "relax/wall_planes.h"

namespace fppg
{

namespace
{

constexpr double least_nearer = 1e-3; ///< to a wall, dp
/// A step that leads so far towards a wall may lead behind it, dp.
constexpr double towards_wall = 0.05;

/// Which of the six neighbours along the axes a particle has, as bits.
unsigned axis_neighbours(const Band& band, std::uint32_t i, std::span<const std::uint32_t> near)
{
    unsigned found = 0;
    for (const std::uint32_t j : near)
    {
        if (j >= band.volume_end) continue;
        const std::array<float, 3> d{band.points.x[j] - band.points.x[i],
                                     band.points.y[j] - band.points.y[i],
                                     band.points.z[j] - band.points.z[i]};
        for (unsigned axis = 0; axis < 3; ++axis)
        {
            const float across = std::abs(d[(axis + 1) % 3]) + std::abs(d[(axis + 2) % 3]);
            const float along = std::abs(d[axis]);
            if (across < 0.2f && std::abs(along - 1) < 0.1f)
                found |= 1u << (2 * axis + (d[axis] > 0 ? 1 : 0));
        }
    }
    return found;
}

/// Whether a particle is next to another one and as high along an axis.
bool is_beside(const Band& band, std::uint32_t i, std::uint32_t j, unsigned axis)
{
    const std::array<float, 3> d{band.points.x[j] - band.points.x[i],
                                 band.points.y[j] - band.points.y[i],
                                 band.points.z[j] - band.points.z[i]};
    const float across =
        d[(axis + 1) % 3] * d[(axis + 1) % 3] + d[(axis + 2) % 3] * d[(axis + 2) % 3];
    return std::abs(d[axis]) < 0.1f && across < 2.2f;
}

/// A free surface goes on up to the wall that it meets: a particle at the height of a free one,
/// next to it, that lacks the same neighbour is free too, though a wall, as one that leans over it,
/// is near enough to be the cause.
void follow_to_walls(const Band& band, const NeighbourList& list,
                     const std::vector<unsigned char>& lacking,
                     std::vector<unsigned char>& free_sides)
{
    const auto sides_of_neighbour = [&](std::uint32_t i, std::uint32_t j)
    {
        unsigned out = 0;
        for (unsigned side = 0; side < 6; ++side)
            if ((free_sides[j] & lacking[i] & 1u << side) != 0 && is_beside(band, i, j, side / 2))
                out |= 1u << side;
        return out;
    };
    for (bool has_changed = true; has_changed;)
    {
        has_changed = false;
        for (std::size_t row = 0; row < list.rows(); ++row)
        {
            const std::uint32_t i = list.point(row);
            if (i >= band.moving || (lacking[i] & ~free_sides[i]) == 0) continue;
            unsigned sides = free_sides[i];
            for (const std::uint32_t j : list.neighbours(row))
                if (j < band.moving) sides |= sides_of_neighbour(i, j);
            has_changed = has_changed || sides != free_sides[i];
            free_sides[i] = static_cast<unsigned char>(sides);
        }
    }
}

} // namespace

std::size_t hold_free_surface(Band& band, const NeighbourList& list,
                              const VolumeSurroundings& around, const RelaxVolumeOptions& options,
                              int threads)
{
    // Per particle the sides, of the six along the axes, on which it lacks a neighbour: because of
    // a wall, perhaps, or at a free surface.
    std::vector<unsigned char> lacking(band.moving, 0);
    std::vector<unsigned char> free_sides(band.moving, 0);
    const auto is_explained = [&](std::size_t i, unsigned side)
    {
        if (!around.closest) return false;
        Vec3 way;
        way[static_cast<int>(side / 2)] = side % 2 == 1 ? band.dp : -band.dp;
        const Vec3 place = band.place(i);
        const double within = (options.clearance_dp + 1e-4) * band.dp;
        const double there = norm(around.closest(place + way, within) - place - way);
        if (!(there <= within)) return false;
        if (options.is_solid) return true;
        // A wall that the node is no nearer to than the particle, as one beside it, is no cause.
        const WallPlanes walls = find_wall_planes(place, within + band.dp, around.closest);
        return there < walls.distance - least_nearer * band.dp ||
               std::any_of(walls.begin(), walls.end(),
                           [&](const WallPlane& wall)
                           {
                               const double nearer = dot(way, wall.normal);
                               return nearer > towards_wall * band.dp &&
                                      wall.distance - nearer <= within;
                           });
    };
    parallel_for(
        list.rows(), threads,
        [&](std::size_t row)
        {
            const std::uint32_t i = list.point(row);
            if (i >= band.moving) return;
            const unsigned found = axis_neighbours(band, i, list.neighbours(row));
            for (unsigned side = 0; side < 6; ++side)
            {
                if ((options.is_2d && side / 2 == 1) || (found >> side & 1) != 0) continue;
                lacking[i] = static_cast<unsigned char>(lacking[i] | 1u << side);
                if (!is_explained(i, side))
                    free_sides[i] = static_cast<unsigned char>(free_sides[i] | 1u << side);
            }
        },
        NeighbourList::rows_per_chunk);
    follow_to_walls(band, list, lacking, free_sides);
    // A little less than 2 h, where the kernel has ended: rows at just that distance are free.
    const auto reach = static_cast<float>(1.999 * options.h_dp);
    parallel_for(
        list.rows(), threads,
        [&](std::size_t row)
        {
            const std::uint32_t i = list.point(row);
            if (i >= band.moving) return;
            band.is_held[i] = free_sides[i] != 0 ? 1 : 0;
            for (const std::uint32_t j : list.neighbours(row))
            {
                if (j >= band.moving || free_sides[j] == 0) continue;
                const float x = band.points.x[j] - band.points.x[i];
                const float y = band.points.y[j] - band.points.y[i];
                const float z = band.points.z[j] - band.points.z[i];
                if (x * x + y * y + z * z < reach * reach) band.is_held[i] = 1;
            }
        },
        NeighbourList::rows_per_chunk);
    return static_cast<std::size_t>(std::count(band.is_held.begin(), band.is_held.end(), 1));
}

} // namespace fppg
