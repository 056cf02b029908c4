#pragma once

#include "fppg/relax_volume.h"
#include "fppg/vec.h"

#include <array>
#include <limits>

namespace fppg
{

/// Places between walls that are nearer to one another than this are pockets, which stay empty, dp:
/// particles on both surfaces keep fluid a step off.
inline constexpr double pocket_dp = 1.5;
/// The same between layers, whose first particles are half a dp behind the surface; nearer walls
/// are joined (gap_rows.h). Water 20 dp deep rushes into wider gaps that are left empty (2D, solver
/// v5.4, 0.6 to 1.4 dp under a block, after 0.15 s: mean 0.03 to 0.16 m/s, with fluid in them
/// 0.0002 to 0.0005).
inline constexpr double pocket_of_layers_dp = 0.6;
/// The same where one of the walls slides along the other, as a gate does.
inline constexpr double sliding_pocket_of_layers_dp = 1.25;

/// A wall near a point, as a plane.
struct WallPlane
{
    Vec3 normal;         ///< unit, from the point towards the wall
    double distance = 0; ///< from the point, metres
};

/// The walls within reach of a point.
struct WallPlanes
{
    std::array<WallPlane, 3> planes;
    int count = 0;
    Vec3 nearest;        ///< the nearest wall point, whether within reach or not
    double distance = 0; ///< to it

    const WallPlane* begin() const { return planes.data(); }
    const WallPlane* end() const { return planes.data() + count; }
};

/// Finds the nearest wall, if it is within reach.
///
/// reach   metres
/// within  the caller knows of a wall so near, metres
WallPlanes find_nearest_wall(const Vec3& point, double reach, const ClosestWallPoint& closest,
                             double within = std::numeric_limits<double>::infinity());

/// Adds the walls that meet the nearest one, up to three in all: those that are nearest to places
/// farther off the walls found before. In the corner of a box these are its other sides.
void add_further_walls(WallPlanes& found, const Vec3& point, double reach,
                       const ClosestWallPoint& closest);

/// Both of these.
WallPlanes find_wall_planes(const Vec3& point, double reach, const ClosestWallPoint& closest);

/// Whether the straight way between two places meets no wall.
///
/// limit  metres, above 0: a wall is met where it is nearer
bool is_way_free(const Vec3& from, const Vec3& to, double limit, const ClosestWallPoint& closest);

} // namespace fppg
