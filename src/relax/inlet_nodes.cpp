#include "relax/inlet_nodes.h"

#include "meshes/point_grid.h"
#include "nodes/spans.h"

#include <map>

namespace fppg
{

std::vector<InletNode> inlet_nodes(const InOutZones& inout, const RunField& field)
{
    std::vector<InletNode> out;
    for (std::uint32_t x = 0; x < field.slabs.size() && !inout.fluids.empty(); ++x)
        for (const Run& run : field.slabs[x])
        {
            const auto inlet = inout.fluids.find(run.mk);
            if (run.is_covered || inlet == inout.fluids.end()) continue;
            for (std::uint32_t z = run.z_begin; z < run.z_end; ++z)
                out.push_back(
                    {{{x, run.y, z}, run.mk}, place_of({x, run.y, z}, field.grid), inlet->second});
        }
    return out;
}

std::vector<InletRim> leave_out_inlet_rims(const CaseDef& def, RunField& field)
{
    const std::vector<InletNode> nodes = inlet_nodes(def.solver.inout, field);
    const std::vector<Vec3>& walls = field.walls.particles.positions;
    if (nodes.empty() || walls.empty()) return {};
    const double dp = field.grid.dp;
    PointGrid rows(dp, nodes.size());
    std::vector<std::size_t> owners;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (int row = 0; row < nodes[i].zone.layers; ++row)
        {
            rows.add(nodes[i].place - (row * dp) * nodes[i].zone.way);
            owners.push_back(i);
        }
    std::vector<char> is_out(nodes.size());
    for (const Vec3& p : walls)
        rows.for_each_near(p, off_inlets_dp * dp,
                           [&](std::uint32_t at, double) { is_out[owners[at]] = 1; });
    std::map<std::uint16_t, InletRim> rims;
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
        const Mover& at = nodes[i].at;
        InletRim& rim = rims[at.mk];
        rim.mk = at.mk;
        ++rim.of;
        if (is_out[i] == 0) continue;
        if (rim.left_out++ == 0) rim.first = nodes[i].place;
        paint(field.slabs[at.node.x], {{at.node.y, at.node.z, at.node.z + 1}}, 0);
    }
    std::vector<InletRim> out;
    for (const auto& [mk, rim] : rims)
        if (rim.left_out > 0) out.push_back(rim);
    return out;
}

} // namespace fppg
