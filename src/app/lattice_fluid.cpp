#include "app/lattice_fluid.h"

#include "fppg/error.h"

#include "app/thousands.h"
#include "particles/off_lattice_particles.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>

namespace fppg
{
namespace
{

/// Smaller differences come of walls that stand half a step beside nodes, in tanks of 14 dp.
constexpr double least_share = 0.25;
constexpr std::int64_t least_particles = 20;

/// Particles by mk as on the lattice; none where only fitted walls can be drawn.
std::map<std::uint16_t, std::int64_t> count_on_lattice(const CaseRunState& run,
                                                       const MadeCase& made)
{
    std::map<std::uint16_t, std::int64_t> out;
    CaseOptions options = case_options(run.options);
    options.fit = FitChoice::Off;
    options.meshes = made.scene.meshes;
    try
    {
        const CaseDef def = read_case(run.options.input + ".xml", options);
        LatticeReport report;
        const RunField field = draw_on_lattice(make_scene(def), run.threads, {}, report);
        for (const std::vector<Run>& slab : field.slabs)
            for (const Run& r : slab)
                if (!r.is_covered) out[r.mk] += r.z_end - r.z_begin;
        const std::vector<std::uint64_t> others = count_off_lattice_particles(field.walls);
        for (std::size_t mk = 0; mk < others.size(); ++mk)
            if (others[mk] > 0)
                out[static_cast<std::uint16_t>(mk)] += static_cast<std::int64_t>(others[mk]);
    }
    catch (const Error&)
    {
        out.clear();
    }
    return out;
}

} // namespace

std::vector<std::string> check_lattice_fluid(const CaseRunState& run, const MadeCase& made)
{
    const CaseDef& def = made.def;
    if (made.field.walls.bodies.empty() || def.vres.is_active() || !def.point_files.empty())
        return {};
    std::map<std::uint16_t, std::int64_t> fitted;
    for (const ParticleBlock& block : made.particles.blocks)
        if (block.mk < def.mk_bound_first && !def.solver.inout.fluids.contains(block.mk))
            fitted[block.mk] += static_cast<std::int64_t>(block.count);
    if (fitted.empty()) return {};
    const auto on_lattice = count_on_lattice(run, made);
    std::vector<std::string> out;
    for (const auto& [mk, count] : fitted)
    {
        const auto found = on_lattice.find(mk);
        if (found == on_lattice.end()) continue;
        const std::int64_t more = count - found->second;
        const double share = static_cast<double>(more) / static_cast<double>(found->second);
        if (std::abs(more) < least_particles || std::abs(share) < least_share) continue;
        out.push_back(fmt::format(
            "{}: mkfluid {} has {} particles beside body-fitted walls; on the lattice, as GenCase "
            "draws the case, it has {} ({:+.3g} %). -fit:off draws it so.",
            def.file, mk - def.mk_fluid_first, thousands(static_cast<std::uint64_t>(count)),
            thousands(static_cast<std::uint64_t>(found->second)), 100 * share));
    }
    return out;
}

} // namespace fppg
