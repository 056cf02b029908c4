#pragma once

#include "fppg/fitted_walls.h"

#include "offset/wall_depth.h"

#include <vector>

namespace fppg
{

struct MergedSheetOptions
{
    double dp = 0;
    /// Where the middle is nearer to the surface than this, the layers of both sides are one, dp.
    double least_depth_dp = 0.8;
    bool is_2d = false;
};

/// The particles that both sides of a thin part share: on its middle (the medial axis), one per dp^2
/// and evenly spaced.
///
/// Points of the surface, 0.3 dp apart, are sunk to the centre of the largest ball that touches the
/// surface there and holds no other point of it (Ma, Bae and Choi, 2012, "shrinking ball"). Those less
/// deep than least_depth whose other side faces away by more than 120 degrees are candidates, half a
/// dp off sharp edges. From them the sheet is filled at 0.9 dp, relaxed on the middle, and filled where
/// it is 0.8 dp from all.
///
/// taken    particles of layers already there, which keep their place
/// returns  positions; the facet under each; nothing for a body that is thick everywhere
/// cost     about 15 distances per dp^2 of surface
SurfaceParticles merged_sheet(const WallDepth& wall, const Features& features,
                              const std::vector<Vec3>& taken, const MergedSheetOptions& options,
                              int threads);

} // namespace fppg
