#include "app/inlet_check.h"

#include "app/thousands.h"
#include "meshes/point_grid.h"
#include "particles/initials.h"
#include "particles/run_positions.h"
#include "particles/simulation_domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace fppg
{
namespace
{

/// So far points may be from their plane, dp.
constexpr double off_plane_dp = 0.01;

struct Zone
{
    int line = 0;
    Vec3 way;
    int layers = 1;
    std::vector<Vec3> points;
};

/// visit(place) for every particle of a block.
template <typename Visit>
void for_each_place(const CaseParticles& particles, const ParticleBlock& block, const Visit& visit)
{
    const Transform map = motion_of(block);
    for (const ParticleRun& run : block.runs)
        for (std::uint32_t k = 0; k < run.count; ++k)
            visit(map(place_in_run(particles, block, run, k)));
}

std::vector<Zone> zones_of(const InOutZones& inout, const CaseParticles& particles)
{
    std::vector<Zone> out;
    for (const auto& [mk, inlet] : inout.fluids)
    {
        Zone zone{inlet.line, inlet.way, inlet.layers, {}};
        for (const ParticleBlock& block : particles.blocks)
            if (block.mk == mk)
                for_each_place(particles, block, [&](const Vec3& p) { zone.points.push_back(p); });
        out.push_back(std::move(zone));
    }
    for (const InletShape& shape : inout.shapes)
        out.push_back({shape.line, shape.way, shape.layers, shape.points});
    return out;
}

bool is_across_its_way(const Zone& zone, double dp)
{
    return std::all_of(
        zone.points.begin(), zone.points.end(),
        [&](const Vec3& p)
        { return std::abs(dot(p - zone.points.front(), zone.way)) <= off_plane_dp * dp; });
}

/// Points with a row at which something is wrong.
struct Refused
{
    std::size_t near_walls = 0;
    Vec3 first; ///< of them
    std::size_t outside = 0;
};

Refused look_at(const Zone& zone, const PointGrid& walls, const std::optional<Box3>& domain,
                double dp)
{
    Refused out;
    for (const Vec3& p : zone.points)
    {
        bool is_near = false;
        bool is_outside = false;
        // Of one row more the solver asks whether it is in the domain.
        for (int row = 0; row <= zone.layers; ++row)
        {
            const Vec3 at = p - (row * dp) * zone.way;
            is_near = is_near || (row < zone.layers && walls.has_nearer(at, off_inlets_dp * dp));
            is_outside = is_outside || (domain && !domain->has(at, 0));
        }
        if (is_near && out.near_walls++ == 0) out.first = p;
        out.outside += is_outside ? 1 : 0;
    }
    return out;
}

} // namespace

std::vector<std::string> check_inlets(const CaseDef& def, const CaseParticles& particles)
{
    if (def.solver.inout.is_empty() || def.vres.is_active()) return {};
    const double dp = def.grid.dp;
    PointGrid walls(dp, 1024);
    const std::vector<Zone> zones = zones_of(def.solver.inout, particles);
    Box3 beside;
    for (const Zone& zone : zones)
        for (const Vec3& p : zone.points)
            for (const int row : {0, zone.layers}) beside.add(p - (row * dp) * zone.way);
    for (const ParticleBlock& block : particles.blocks)
        if (block.type != ParticleType::Fluid)
            for_each_place(particles, block,
                           [&](const Vec3& p)
                           {
                               if (beside.has(p, dp)) walls.add(p);
                           });
    const std::optional<Box3> domain = solver_domain(def, particles);
    std::vector<std::string> out;
    for (const Zone& zone : zones)
    {
        const auto tell = [&](const std::string& text)
        {
            out.push_back(fmt::format("{}:{}: <inout>: {}, where DualSPHysics v5.4 stops the run.",
                                      def.file, zone.line, text));
        };
        if (zone.points.empty() || zone.way == Vec3{}) continue;
        if (!is_across_its_way(zone, dp))
        {
            tell("the points of this zone are in no plane across its direction");
            continue;
        }
        const Refused refused = look_at(zone, walls, domain, dp);
        const std::string count = thousands(zone.points.size());
        if (refused.near_walls > 0)
            tell(
                fmt::format("{} of {} points of this zone, or rows behind them, are nearer than "
                            "{:g} dp to boundary particles, the first at ({:.4g}, {:.4g}, {:.4g})",
                            thousands(refused.near_walls), count, off_inlets_dp, refused.first.x,
                            refused.first.y, refused.first.z));
        else if (refused.outside > 0)
            tell(
                fmt::format("{} of {} points of this zone, or rows behind them, are outside of "
                            "the solver's domain (<simulationdomain>)",
                            thousands(refused.outside), count));
    }
    return out;
}

} // namespace fppg
