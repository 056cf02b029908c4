#include "relax/regions.h"

#include "core/disjoint_set.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace fppg
{

std::vector<std::vector<std::uint16_t>> solid_mks(const std::vector<FittedBody>& bodies)
{
    std::vector<char> is_solid(65536, 0);
    DisjointSet sets(65536);
    for (const FittedBody& body : bodies)
    {
        if (!body.is_solid) continue;
        is_solid[body.mk] = 1;
        for (const std::uint16_t mk : body.facet_mk)
        {
            is_solid[mk] = 1;
            sets.join(body.mk, mk);
        }
    }
    std::vector<std::vector<std::uint16_t>> out;
    std::vector<std::size_t> group(65536, 0);
    for (std::uint32_t mk = 1; mk < 65536; ++mk)
    {
        if (!is_solid[mk]) continue;
        const std::uint32_t first = sets.find(mk);
        if (first == mk)
        {
            group[mk] = out.size();
            out.emplace_back();
        }
        out[group[first]].push_back(static_cast<std::uint16_t>(mk));
    }
    return out;
}

Region fluid_region(const CaseDef& def, const FluidSpace& space)
{
    Region region;
    region.what = "fluid";
    region.band.assign(65536, 0);
    region.beside.assign(65536, 0);
    region.left_empty = space.pocket_places;
    for (std::uint32_t number = 1; number < 65536; ++number)
    {
        const auto mk = static_cast<std::uint16_t>(number);
        region.beside[mk] = mk < def.mk_bound_first || fit_settings(def.fit, mk) == nullptr;
        const FluidBand* band = fluid_band(def, mk);
        if (band != nullptr && band->is_active) region.band[mk] = band->width_dp;
    }
    // Several fluids would have to share what comes and goes, so each keeps what it has.
    const bool has_litres = def.fills_litres();
    if (has_litres && space.nodes.size() == 1) region.missing = region.left_empty.size();
    region.fits_count = !has_litres || region.missing;
    return region;
}

std::optional<double> number_between_layers(const FluidSpace& space, std::size_t moving,
                                            const LatticeGrid& grid)
{
    // Tanks 5 to 20 dp wide lack 0.25 to 0.4; with these the solver is about as calm or calmer.
    constexpr double most = 0.6;
    constexpr double most_of_stretched = 0.005;
    double missing = 0;
    double nodes = 0;
    for (const auto& [mk, volume] : space.missing) missing += volume;
    missing = (missing - space.missing_at_zones) / (grid.dp * grid.dp * grid.dp);
    for (const auto& [mk, count] : space.nodes) nodes += static_cast<double>(count);
    const auto now = static_cast<double>(moving);
    if (grid.stretch != Vec3{1, 1, 1} && std::abs(missing) <= most_of_stretched * nodes) return now;
    if (space.missing.empty() || std::abs(missing) > most * now) return std::nullopt;
    return now + missing;
}

void cover(std::vector<Run>& runs, const std::vector<Mover>& nodes)
{
    if (nodes.empty()) return;
    std::vector<Run> out;
    const auto append_run = [&](const Run& run)
    {
        if (run.z_begin >= run.z_end) return;
        if (!out.empty() && out.back().y == run.y && out.back().mk == run.mk &&
            out.back().is_covered == run.is_covered && out.back().z_end == run.z_begin)
            out.back().z_end = run.z_end;
        else
            out.push_back(run);
    };
    auto node = nodes.begin();
    for (const Run& run : runs)
    {
        std::uint32_t from = run.z_begin;
        for (; node != nodes.end() && node->node.y == run.y && node->node.z < run.z_end; ++node)
        {
            const std::uint32_t z = node->node.z;
            append_run({run.y, from, z, run.mk, run.is_covered});
            append_run({run.y, z, z + 1, run.mk, true});
            from = z + 1;
        }
        append_run({run.y, from, run.z_end, run.mk, run.is_covered});
    }
    runs = std::move(out);
}

WallParticles join(const WallParticles& a, const WallParticles& b)
{
    WallParticles out;
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() || j < b.size())
        if (j == b.size() || (i < a.size() && a.bodies[i] < b.bodies[j]))
            out.append(a, i++);
        else
            out.append(b, j++);
    return out;
}

} // namespace fppg
