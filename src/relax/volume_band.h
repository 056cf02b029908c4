#pragma once

#include "fppg/relax_volume.h"
#include "relax/neighbour_list.h"
#include "relax/wall_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace fppg
{

// All lengths below are in dp, unless they are of Vec3.

inline constexpr std::uint32_t no_meeting = 0xFFFFFFFF;

/// Lists hold the neighbours within 2 h + 0.1 and are made anew when a particle has moved by 0.3,
/// half of the skin. A pair that comes from beyond that to below 2 h - 0.3 in between, which takes
/// two of the fastest on course for one another, is missed; at h = dp its force is a fiftieth of
/// that at the distance h.
inline constexpr double list_skin = 0.6;
inline double list_radius(double h)
{
    return 2 * h;
}

/// A wall as a plane.
struct BandPlane
{
    float x, y, z;  ///< normal, towards the wall
    float distance; ///< from the particle, as of when walls were last looked for
};

/// The walls that meet the nearest one near a particle.
struct MeetingWalls
{
    std::array<BandPlane, 2> planes;
    std::uint32_t count = 0;
};

/// Particles as the loops need them: those that may move along a Morton curve, then the held ones,
/// then the walls.
struct Band
{
    Vec3 origin;
    double dp = 0;
    std::size_t moving = 0;
    std::size_t volume_end = 0;         ///< where the walls begin
    std::vector<std::uint32_t> sources; ///< of the moving ones, the caller's index
    std::vector<char> is_inserted;
    PointArrays points;
    PointArrays velocities;
    std::vector<char> is_held;
    std::vector<VolumeMotion> slides; ///< VolumeSurroundings::slides; of those that move

    // Walls as of the last look, per particle that may move:
    std::vector<float> wall_distances;   ///< to the nearest
    PointArrays wall_normals;            ///< towards it; zero where it is out of reach
    PointArrays moved;                   ///< since the last look
    std::vector<char> light_looks;       ///< at the nearest wall only, since all were looked for
    std::vector<std::uint32_t> meetings; ///< index of `meeting_walls`, or none
    std::vector<MeetingWalls> meeting_walls;

    Vec3 place(std::size_t i) const
    {
        return origin + dp * Vec3{points.x[i], points.y[i], points.z[i]};
    }
    /// Where a step leads, rounded as the positions are.
    Vec3 place_after(std::size_t i, const Vec3& step) const
    {
        return origin + dp * Vec3{points.x[i] + static_cast<float>(step.x),
                                  points.y[i] + static_cast<float>(step.y),
                                  points.z[i] + static_cast<float>(step.z)};
    }
    /// A wall is no farther than this; of an inserted particle nothing is known at first.
    double wall_within(std::size_t i) const
    {
        constexpr double rounding_room = 1e-3;
        if (!(wall_distances[i] > 0)) return std::numeric_limits<double>::infinity();
        return double{wall_distances[i]} + double{moved_by(i)} + rounding_room;
    }
    float moved_by(std::size_t i) const
    {
        return std::sqrt(moved.x[i] * moved.x[i] + moved.y[i] * moved.y[i] +
                         moved.z[i] * moved.z[i]);
    }
};

/// The points come relative to an origin amid the moving ones. In 2D all are at one y.
Band make_band(std::span<const Vec3> positions, const VolumeSurroundings& surroundings,
               const RelaxVolumeOptions& options, int threads);

/// Makes the lists of all particles that move.
void build_list(NeighbourList& list, const Band& band, double h, int threads);

inline float approach_to(const Band& band, std::size_t i, const BandPlane& plane)
{
    return band.moved.x[i] * plane.x + band.moved.y[i] * plane.y + band.moved.z[i] * plane.z;
}

/// Calls visit(plane, distance) for the walls near a particle, with the distance from where it is.
template <typename Visit>
void for_each_wall(const Band& band, std::size_t i, const Visit& visit)
{
    const auto visit_plane = [&](const BandPlane& plane)
    { visit(plane, std::max(0.0f, plane.distance - approach_to(band, i, plane))); };
    visit_plane({band.wall_normals.x[i], band.wall_normals.y[i], band.wall_normals.z[i],
                 band.wall_distances[i]});
    if (band.meetings[i] == no_meeting) return;
    const MeetingWalls& meeting = band.meeting_walls[band.meetings[i]];
    for (std::uint32_t w = 0; w < meeting.count; ++w) visit_plane(meeting.planes[w]);
}

/// Takes over the nearest wall where it is the one that was nearest; the others remain planes,
/// which the particle has come nearer to or farther from. False where walls must be looked for
/// again.
bool renew_nearest_wall(Band& band, std::size_t i, const WallPlanes& found);

/// Looks for the walls within reach of all particles (is_first), or of those that have moved so far
/// that what is known of walls is too old.
void renew_walls(Band& band, const NeighbourList& list, double reach, bool is_first,
                 const ClosestWallPoint& closest, int threads);

} // namespace fppg
