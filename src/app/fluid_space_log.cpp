#include "app/fluid_space_log.h"

#include "fppg/error.h"

#include "app/particle_log.h"
#include "app/thousands.h"
#include "core/text.h"
#include "relax/wall_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace fppg
{
namespace
{

constexpr std::size_t pockets_logged = 20;

/// Volumes as fills name them.
class Litres
{
public:
    explicit Litres(const LatticeGrid& grid)
        : per_m3_(grid.is_2d ? 1000 / grid.dp : 1000),
          dp3_(grid.dp * grid.dp * grid.dp),
          name_(grid.is_2d ? "litres a metre of width" : "litres")
    {
    }
    double of(double m3) const { return m3 * per_m3_; }
    double of_particles(std::size_t n) const { return of(static_cast<double>(n) * dp3_); }
    double m3(double litres) const { return litres / per_m3_; }
    double dp3() const { return dp3_; }
    const char* name() const { return name_; }

private:
    double per_m3_;
    double dp3_;
    const char* name_;
};

/// The particles of each fluid after relaxation, by mk.
std::map<std::uint16_t, std::size_t> count_fluid(const MadeCase& made)
{
    std::map<std::uint16_t, std::size_t> out;
    for (const std::vector<Run>& slab : made.field.slabs)
        for (const Run& run : slab)
            if (!run.is_covered && run.mk < made.def.mk_bound_first)
                out[run.mk] += run.z_end - run.z_begin;
    for (const std::uint16_t mk : made.field.walls.volume.mk)
        if (mk < made.def.mk_bound_first) ++out[mk];
    return out;
}

/// Fluid that is this much more than the space between walls is warned of.
constexpr double too_much = 0.02;

double missing_of(const FluidSpace& space, std::uint16_t mk)
{
    const auto found = space.missing.find(mk);
    return found == space.missing.end() ? 0 : found->second;
}

/// The litres that fills give a fluid; 0 where anything else is drawn with it.
double litres_asked(const CaseDef& def, std::uint16_t mk)
{
    double litres = 0;
    for (const DrawOp& op : def.ops)
    {
        const auto* edit = std::get_if<Edit>(&op.what);
        if (op.state->mk.mk != mk || op.state->mk.kind != MkKind::Fluid) continue;
        if (edit == nullptr && std::get_if<Shape>(&op.what) == nullptr) continue;
        const auto* fill = edit != nullptr ? std::get_if<CavityFillOp>(edit) : nullptr;
        if (fill == nullptr || fill->measure != FillMeasure::Litres) return 0;
        litres += fill->amount;
    }
    return litres;
}

void log_pockets(const FluidSpace& space, const Litres& litres, RunLog& log)
{
    if (space.pockets.empty()) return;
    double volume = 0;
    std::size_t nodes = 0;
    for (const FluidPocket& pocket : space.pockets)
    {
        volume += pocket.volume;
        nodes += pocket.nodes;
        log.fact("pocket", {{"center", coordinates(pocket.center)},
                            {"litres", litres.of(pocket.volume)},
                            {"narrowest_dp", pocket.narrowest_dp},
                            {"particles", pocket.nodes}});
    }
    log.text_line(fmt::format(
        "Left empty: {} between walls less than {:g} dp apart (2 dp where one moves{}), {:.4g} {}, "
        "{} of fluid taken out there",
        counted(space.pockets.size(), "pocket", "pockets"), space.pocket_dp,
        space.pocket_dp == pocket_of_layers_dp
            ? fmt::format(", {:g} dp where it slides", sliding_pocket_of_layers_dp)
            : "",
        litres.of(volume), litres.name(), counted(nodes, "particle", "particles")));
    for (std::size_t i = 0; i < std::min(pockets_logged, space.pockets.size()); ++i)
    {
        const FluidPocket& pocket = space.pockets[i];
        log.text_line(fmt::format(
            "  ({:.4g}, {:.4g}, {:.4g}): {:.3g} {}, {:.2f} dp at its "
            "narrowest, {}",
            pocket.center.x, pocket.center.y, pocket.center.z, litres.of(pocket.volume),
            litres.name(), pocket.narrowest_dp, counted(pocket.nodes, "particle", "particles")));
    }
    if (space.pockets.size() > pockets_logged)
        log.text_line(fmt::format("  and {} more (-log-json lists all)",
                                  space.pockets.size() - pockets_logged));
}

/// What must not be in a case whose fluid particles are heavier than rhop0 dp^3.
void expect_one_mass(const CaseDef& def, const FluidBand& band)
{
    const auto fail = [&](const char* what)
    { throw CaseError(def.file, band.line, fmt::format("<fluidband>: mass=\"exact\" {}", what)); };
    if (def.constants.mass_fluid)
        fail("and <massfluid> both give the mass of fluid particles, expected one of them");
    if (def.vres.is_active())
        fail("is not possible with <vres>, whose zones exchange particles of rhop0 dp^3");
    if (!def.solver.inout.is_empty())
        fail("is not possible with <inout>, whose zones let in particles dp apart");
}

} // namespace

void log_fluid_space(const RelaxReport& report, const MadeCase& made, CaseRunState& run)
{
    RunLog& log = run.log;
    const FluidSpace& space = report.space;
    const Litres litres(made.field.grid);
    log_pockets(space, litres, log);
    const auto counts = count_fluid(made);
    for (const auto& [mk, nodes] : space.nodes)
    {
        const std::size_t count = counts.contains(mk) ? counts.at(mk) : 0;
        const double cavity = static_cast<double>(nodes) * litres.dp3() + missing_of(space, mk);
        const double missing = litres.of(cavity) - litres.of_particles(count);
        const double asked = litres_asked(made.def, mk);
        log.text_line(fmt::format(
            "Fluid mk {}: {} particles of dp^3 are {:.6g} {}; between the walls are {:.6g}: {:.2f} "
            "% {}{}",
            mk, thousands(count), litres.of_particles(count), litres.name(), litres.of(cavity),
            100 * std::abs(missing) / litres.of(cavity), missing < 0 ? "too many" : "missing",
            asked > 0 ? fmt::format("; asked for are {:g}", asked) : std::string{}));
        log.fact("fluid_space", {{"mk", mk},
                                 {"mkfluid", mk - made.def.mk_fluid_first},
                                 {"particles", count},
                                 {"litres", litres.of_particles(count)},
                                 {"cavity_litres", litres.of(cavity)},
                                 {"asked_litres", asked > 0 ? Json(asked) : Json()},
                                 {"in_pockets", space.left_out.contains(mk) ? space.left_out.at(mk)
                                                                            : std::size_t{0}}});
        // The particles of an inlet lie in the wall on purpose.
        if (missing < -too_much * litres.of(cavity) && !made.def.solver.inout.fluids.contains(mk))
            run.warn(fmt::format(
                "{}: fluid mk {} has {:.1f} % more particles than fit between the walls; where it "
                "is drawn beyond their surface it takes the places of their particles.",
                made.def.file, mk, -100 * missing / litres.of(cavity)));
    }
}

void settle_fluid_mass(const RelaxReport& report, MadeCase& made, RunLog& log)
{
    CaseDef& def = made.def;
    const auto asks = std::find_if(def.fluid_bands.begin(), def.fluid_bands.end(),
                                   [](const FluidBand& band) { return band.has_exact_mass; });
    if (asks == def.fluid_bands.end()) return;
    expect_one_mass(def, *asks);
    const Litres litres(made.field.grid);
    double volume = 0;
    std::size_t particles = 0;
    for (const auto& [mk, count] : count_fluid(made))
    {
        const FluidBand* band = fluid_band(def, mk);
        if (band == nullptr || !band->has_exact_mass)
            throw CaseError(
                def.file, asks->line,
                fmt::format("<fluidband>: mass=\"exact\" is not for mkfluid {}, and the "
                            "solver has one mass for all fluid particles; expected it "
                            "for all fluids, as without mkfluid",
                            mk - def.mk_fluid_first));
        const double asked = litres_asked(def, mk);
        const auto nodes = report.space.nodes.find(mk);
        particles += count;
        volume +=
            asked > 0 ? litres.m3(asked)
            : nodes == report.space.nodes.end()
                ? static_cast<double>(count) * litres.dp3()
                : static_cast<double>(nodes->second) * litres.dp3() + missing_of(report.space, mk);
    }
    if (particles == 0 || !(volume > 0)) return;
    def.fluid_fullness = volume / (static_cast<double>(particles) * litres.dp3());
    def.mass_fluid *= def.fluid_fullness;
    log.line(
        fmt::format("Mass of a fluid particle: {:.6g} kg, {:.4f} times rhop0 dp^3, so that all "
                    "are {:.6g} {}",
                    def.mass_fluid, def.fluid_fullness, litres.of(volume), litres.name()));
    log.fact("fluid_mass", {{"massfluid", def.mass_fluid}, {"fullness", def.fluid_fullness}});
}

} // namespace fppg
