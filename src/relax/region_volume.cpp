#include "relax/region_volume.h"

#include <algorithm>

namespace fppg
{
namespace
{

/// Of the nodes in a body that fills gave particles.
constexpr double nearly_all = 0.98;

/// Whether the particles of a region fill a body.
bool is_filled(const Region& region, const FittedBody& body)
{
    return region.band[body.mk] > 0 && body.is_solid && body.measures.filled > 0;
}

} // namespace

bool is_inside(const FittedWalls& walls, const Region& region)
{
    return std::all_of(walls.bodies.begin(), walls.bodies.end(),
                       [&](const FittedBody& body)
                       { return body.is_inside || region.band[body.mk] <= 0; });
}

std::optional<double> wanted_number(const FittedWalls& walls, const Region& region,
                                    std::size_t moving, double nodes, double dp)
{
    const double dp3 = dp * dp * dp;
    double wanted = 0, all = 0;
    bool has_bodies = false;
    for (const FittedBody& body : walls.bodies)
    {
        if (!is_filled(region, body) || body.is_layer()) continue;
        const FitMeasures& measures = body.measures;
        // Of what a draw left empty in part it is not known how much.
        if (!(measures.volume > 0) || measures.filled < nearly_all) return std::nullopt;
        has_bodies = true;
        wanted += measures.volume - measures.wall_volume;
        all += measures.node_volume;
    }
    if (!has_bodies) return std::nullopt;
    if (!(all > 0)) return static_cast<double>(moving); // there is no room for any
    const double part = std::min(1.0, nodes * dp3 / all);
    // A few nodes gave way to particles of the walls.
    const double more =
        part > nearly_all && part < 1 ? wanted / dp3 - nodes : part * (wanted - all) / dp3;
    return std::max(0.0, static_cast<double>(moving) + more);
}

void take_new_nodes(FittedWalls& walls, const Region& region, double more, double dp)
{
    double volume = 0;
    for (const FittedBody& body : walls.bodies)
        if (is_filled(region, body)) volume += body.measures.node_volume;
    for (FittedBody& body : walls.bodies)
    {
        if (!is_filled(region, body) || volume <= 0) continue;
        body.measures.node_volume += more * dp * dp * dp * body.measures.node_volume / volume;
        body.settle_share(dp);
    }
}

} // namespace fppg
