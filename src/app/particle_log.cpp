#include "app/particle_log.h"

#include "fppg/files.h"

#include "app/thousands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fppg
{

namespace
{

/// What log_particles() prints, as fields.
void log_facts(const CaseDef& def, const CaseParticles& particles, const CaseConstants& constants,
               const RunLog& log)
{
    constexpr std::array names{"fixed", "moving", "floating", "fluid"};
    Json blocks = Json::array();
    for (const ParticleBlock& block : particles.blocks)
        blocks.push_back(
            {{"type", names[static_cast<std::size_t>(block.type)]},
             {"mk", block.mk},
             {block.type == ParticleType::Fluid ? "mkfluid" : "mkbound", block.mk_type},
             {"first_id", block.begin},
             {"count", block.count}});
    log.fact("particles", {{"particles", particles.np},
                           {"fixed", particles.n_fixed},
                           {"moving", particles.n_moving},
                           {"floating", particles.n_floating},
                           {"fluid", particles.n_fluid},
                           {"blocks", blocks},
                           {"depth", constants.hswl},
                           {"speed_system", constants.speed_system},
                           {"speed_sound", constants.speed_sound},
                           {"h", def.h}});
}

} // namespace

std::array<double, 3> coordinates(const Vec3& p)
{
    return {p.x, p.y, p.z};
}

void log_domain(const CaseDef& def, RunLog& log)
{
    const LatticeGrid& grid = def.grid;
    const Vec3& low = def.case_pos_min;
    const Vec3& high = def.case_pos_max;
    log.text_line(fmt::format("Case limits: ({:g},{:g},{:g}) - ({:g},{:g},{:g})", low.x, low.y,
                              low.z, high.x, high.y, high.z));
    log.text_line(fmt::format("Distance between points (Dp): {:g}", grid.dp));
    log.text_line(fmt::format("Case domain: (0,0,0)-({},{},{})", grid.n[0] - 1, grid.n[1] - 1,
                              grid.n[2] - 1));
    log.fact("domain", {{"min", coordinates(low)},
                        {"max", coordinates(high)},
                        {"dp", grid.dp},
                        {"nodes", grid.n}});
}

void log_fill(const CavityFilled& fill, RunLog& log)
{
    for (const std::string& line : fill.log) log.text_line(line);
    const auto litres = [&](std::uint64_t nodes)
    { return static_cast<double>(nodes) * fill.litres_per_node; };
    log.fact("fill", {{"line", fill.line},
                      {"cavity_nodes", fill.cavity_nodes},
                      {"cavity_litres", litres(fill.cavity_nodes)},
                      {"open_at", fill.open_at ? Json(*fill.open_at) : Json()},
                      {"nodes", fill.nodes},
                      {"litres", litres(fill.nodes)},
                      {"level", fill.level}});
}

void log_particles(const CaseDef& def, const CaseParticles& particles,
                   const CaseConstants& constants, RunLog& log)
{
    struct Group
    {
        const char* title;
        const char* label;
        ParticleType type;
        std::uint64_t count;
    };
    const std::array<Group, 4> groups{
        Group{"Fixed-Boundary", "Fixed....", ParticleType::Fixed, particles.n_fixed},
        Group{"Moving-Boundary", "Moving...", ParticleType::Moving, particles.n_moving},
        Group{"Floating-Boundary", "Floating.", ParticleType::Floating, particles.n_floating},
        Group{"Fluid", "Fluid....", ParticleType::Fluid, particles.n_fluid}};
    log.text_line("List of Points:");
    std::array<std::size_t, 4> blocks{};
    std::vector<std::string> summary;
    for (const Group& group : groups)
    {
        std::vector<int> mks;
        std::uint64_t begin = 0;
        for (std::size_t b = 0; b < particles.blocks.size(); ++b)
        {
            const ParticleBlock& block = particles.blocks[b];
            if (block.type != group.type) continue;
            if (mks.empty())
            {
                log.text_line(fmt::format("Points -> {} particles:", group.title));
                begin = block.begin;
            }
            log.text_line(fmt::format("  block[{:3}] (mk:{:3}): {:6}", b, block.mk, block.count));
            mks.push_back(block.mk);
            ++blocks[static_cast<std::size_t>(group.type)];
        }
        summary.push_back(mks.empty()
                              ? fmt::format("  {}: 0", group.label)
                              : fmt::format("  {}: {}  id:({}-{})   MKs:{} ({})", group.label,
                                            thousands(group.count), begin, begin + group.count - 1,
                                            mks.size(), format_ranges(mks)));
    }
    log.text_line();
    log.text_line("Particle summary:");
    for (const std::string& line : summary) log.text_line(line);
    log.text_line();
    log.text_line(fmt::format("Total particles: {} (bound={} (fx={} mv={} ft={}) fluid={})",
                              thousands(particles.np), thousands(particles.np - particles.n_fluid),
                              thousands(particles.n_fixed), thousands(particles.n_moving),
                              thousands(particles.n_floating), thousands(particles.n_fluid)));
    log.text_line(fmt::format("Total MK blocks: {} (bound={} (fx={} mv={} ft={}) fluid={})",
                              particles.blocks.size(), blocks[0] + blocks[1] + blocks[2], blocks[0],
                              blocks[1], blocks[2], blocks[3]));
    log.text_line();
    const ConstantsDef& c = def.constants;
    const char* depth_source = c.rhop_gradient != 3 && particles.n_floating > 0
                                   ? "automatic from the height of water+floating bodies"
                                   : "automatic";
    log.text_line(
        fmt::format("Maximum depth: {:g} ({})", constants.hswl, c.hswl ? "fixed" : depth_source));
    log.text_line(fmt::format("Speed of system: {:g} ({})", constants.speed_system,
                              c.speed_system ? "fixed" : "automatic"));
    log.text_line(fmt::format("Speed of sound: {:g} ({})", constants.speed_sound,
                              c.speed_sound ? "fixed" : "automatic"));
    log_facts(def, particles, constants, log);
    const std::vector<ParticleType>& types = particles.off_lattice_points.types;
    if (std::find(types.begin(), types.end(), ParticleType::Fluid) != types.end())
        log.line(def.hydrostatic_off_lattice
                     ? "Density of fluid of <setfrdrawmode>: hydrostatic (<offlattice>)"
                     : "Density of fluid of <setfrdrawmode>: rhop0, as GenCase gives it");
    log.text_line();
    const double hdp = def.h / def.grid.dp;
    log.text_line(
        fmt::format("Coefh:{:.6f} (hdp:{:.6f})", hdp / std::sqrt(def.grid.is_2d ? 2.0 : 3.0), hdp));
}

ZoneSummary summary_of_zone(const CaseDef& def, const CaseParticles& particles,
                            const CaseConstants& constants)
{
    ZoneSummary out;
    out.dp = def.grid.dp;
    out.parent = def.vres.zones[def.zone].parent;
    out.counts = {particles.n_fluid, particles.n_fixed, particles.n_moving, particles.n_floating};
    out.limits.add(particles.pos_min);
    out.limits.add(particles.pos_max);
    out.constants = constants;
    return out;
}

void log_zones(const std::vector<ZoneSummary>& zones, RunLog& log)
{
    log.line();
    log.line("VResolution summary:");
    log.line(fmt::format("{:>6} {:>7} {:>10} {:>14} {:>14} {:>14} {:>14} {:>14}", "Zone", "Parent",
                         "Dp", "Particles", "Fluid", "Fixed", "Moving", "Floating"));
    const auto row = [&](const std::string& id, const std::string& parent, const std::string& dp,
                         const std::array<std::uint64_t, 4>& n)
    {
        log.line(fmt::format("{:>6} {:>7} {:>10} {:>14} {:>14} {:>14} {:>14} {:>14}", id, parent,
                             dp, thousands(n[0] + n[1] + n[2] + n[3]), thousands(n[0]),
                             thousands(n[1]), thousands(n[2]), thousands(n[3])));
    };
    std::array<std::uint64_t, 4> all{};
    for (std::size_t id = 0; id < zones.size(); ++id)
    {
        const ZoneSummary& zone = zones[id];
        row(fmt::format("{}", id), id > 0 ? fmt::format("{}", zone.parent) : "",
            fmt::format("{:g}", zone.dp), zone.counts);
        for (std::size_t k = 0; k < 4; ++k) all[k] += zone.counts[k];
    }
    row("all", "", "", all);
    log.line();
}

void log_balance(const BalanceReport& report, RunLog& log)
{
    if (!report.why_not.empty()) log.line(fmt::format("Balance: left out, as {}", report.why_not));
    if (report.particles == 0) return;
    const auto text = [](const Accelerations& a)
    {
        return fmt::format("mean {:.4f} g, 99 % below {:.3f} g, {:.2f} % above 0.05 g", a.mean,
                           a.of_99, 100 * a.above_5);
    };
    const std::string held = report.held > 0
                                 ? fmt::format(
                                       " ({} held, as they are at free faces, or where one depth "
                                       "meets another)",
                                       thousands(report.held))
                                 : std::string{};
    if (!report.is_balanced)
    {
        log.line(
            fmt::format("Balance: {} particles near walls{} stay as they are, as more than 0.1 g "
                        "would be left; accelerations: {}",
                        thousands(report.particles), held, text(report.before)));
        return;
    }
    log.line(
        fmt::format("Balanced fluid: {} particles near walls{}, {} iterations, moved by "
                    "{:.3f} dp, {:.2f} dp at most",
                    thousands(report.particles), held, report.iterations, report.mean_move_dp,
                    report.largest_move_dp));
    const char* what = report.is_packed
                           ? "all fluid stands on the lattice that is most stable under pressure "
                             "(<fluidband packing=\"cubic\"> keeps its own); accelerations"
                           : "accelerations beside those of a lattice at rest";
    log.line(fmt::format("  {}: {}; before: {}", what, text(report.after), text(report.before)));
}

} // namespace fppg
