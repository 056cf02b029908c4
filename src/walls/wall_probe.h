#pragma once

#include "fppg/surface_mesh.h"

#include <vector>

namespace fppg
{

/// What laying layers behind a wall costs beside the number of particles, found by trying it at a
/// few hundred places: searches among its facets take 0.2 to 10 us, and rough walls give creases.
struct WallProbe
{
    double seconds_a_depth = 0; ///< on one thread
    double seconds_a_ball = 0;  ///< of an inner ball, by which thin parts are found
    double balls = 0;           ///< that are asked for; 0 where no thin parts are looked for
    double rough = 0;           ///< share of the layers that turns within half a dp, 0 to 1
};

struct WallProbeOptions
{
    std::vector<double> depths_dp; ///< of layers, ascending
    double dp = 0;                 ///< metres
    double feature_angle_deg = 30;
    bool is_closed = false;
};

/// cost  a tree over the facets, and up to a thousand searches
WallProbe probe_wall(const SurfaceMesh& mesh, const MeshReport& report,
                     const WallProbeOptions& options, int threads);

} // namespace fppg
