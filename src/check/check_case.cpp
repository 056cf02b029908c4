#include "check/judge_motion.h"
#include "check/judge_places.h"
#include "check/judge_walls.h"
#include "check/read_setup.h"
#include "core/parallel.h"
#include "files/particle_source.h"
#include "fppg/case_def.h"
#include "fppg/check.h"
#include "fppg/error.h"
#include "meshes/point_grid.h"

#include <fmt/format.h>

#include <map>

namespace fppg
{

namespace
{

constexpr std::size_t walls_per_chunk = 256;

bool is_placed(const CheckParticles& particles, std::size_t i)
{
    return is_finite(particles.positions[i]);
}

bool has_normal(const CheckParticles& particles, std::size_t i)
{
    return normal_of(particles, i) != Vec3{};
}

/// Boundary particles, in masks and sums of their mk.
struct WallSums
{
    CheckReport& report;
    std::map<std::uint16_t, CheckedMk>& mks;
    std::vector<std::uint16_t>& masks;
    std::map<std::uint16_t, std::vector<float>> thicknesses;

    void add(const CheckParticles& particles, std::uint32_t i, const FluidNearWall& around,
             const WallJudgement& of)
    {
        CheckedMk& mk = mks.at(particles.mk[i]);
        masks[i] |= of.faults;
        ++mk.near_fluid;
        if (around.nearest < 1.9 * report.setup.dp)
        {
            ++mk.front;
            const double length = norm(normal_of(particles, i)) / report.setup.dp;
            if (length > 0 && length < 0.875)
            {
                ++mk.front_no_penetration;
                mk.mean_window += 1.5 * length;
            }
        }
        if ((of.faults & bit_of(Fault::BothSides)) != 0)
            thicknesses[particles.mk[i]].push_back(of.thickness);
    }

    void finish()
    {
        for (auto& [number, mk] : mks)
            if (mk.front_no_penetration > 0)
                mk.mean_window /= static_cast<double>(mk.front_no_penetration);
        const CheckSetup& setup = report.setup;
        for (auto& [number, all] : thicknesses)
        {
            std::sort(all.begin(), all.end());
            CheckedMk& mk = mks.at(number);
            mk.thinnest = all.front();
            mk.median_thickness = all[all.size() / 2];
            // A wall has room for both sides from (2 h/dp - 1/2) dp on, with h/dp as it is.
            mk.dp_needed = mk.median_thickness / (2 * setup.h / setup.dp - 0.5);
        }
    }
};

/// Particles of one kind that have a place.
std::vector<std::uint32_t> chosen_particles(const CheckParticles& particles, bool is_fluid)
{
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
        if ((particles.type[i] == ParticleType::Fluid) == is_fluid && is_placed(particles, i))
            out.push_back(static_cast<std::uint32_t>(i));
    return out;
}

void judge_outside(const CheckParticles& particles, const CheckSetup& setup,
                   std::vector<std::uint16_t>& masks)
{
    for (std::size_t i = 0; i < masks.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
        {
            const double at = particles.positions[i][axis];
            if (!(at >= setup.domain.min[axis] && at <= setup.domain.max[axis]))
                masks[i] |= bit_of(Fault::OutsideDomain);
        }
}

/// As the solver does (v5.4, JSphInOut::InitCheckProximity).
void judge_near_inlets(const CheckParticles& particles, const CheckSetup& setup,
                       const std::vector<std::uint32_t>& walls, std::vector<std::uint16_t>& masks)
{
    PointGrid rows(setup.dp, 64);
    const auto add = [&](const CheckInlet& inlet, const Vec3& p)
    {
        for (int row = 0; row < inlet.layers; ++row) rows.add(p - (row * setup.dp) * inlet.way);
    };
    for (const CheckInlet& inlet : setup.inlets)
    {
        for (const Vec3& p : inlet.points) add(inlet, p);
        for (std::size_t i = 0; i < masks.size() && inlet.mk; ++i)
            if (particles.mk[i] == *inlet.mk) add(inlet, particles.positions[i]);
    }
    if (rows.points().empty()) return;
    for (const std::uint32_t i : walls)
        if (rows.has_nearer(particles.positions[i], off_inlets_dp * setup.dp))
            masks[i] |= bit_of(Fault::NearInlet);
}

/// Floating bodies whose particles have no normals are plain DBC whatever the case says.
bool is_judged(const CheckedMk& mk)
{
    return mk.type != ParticleType::Floating || mk.has_normals;
}

void judge_walls(const CheckParticles& particles, WallScene& scene,
                 const std::vector<std::uint32_t>& walls, WallSums& sums, int threads)
{
    std::vector<std::uint32_t> judged;
    for (const std::uint32_t i : walls)
        if (is_judged(sums.mks.at(particles.mk[i]))) judged.push_back(i);
    std::vector<FluidNearWall> around(judged.size());
    scene.looks_away.assign(particles.positions.size(), 0);
    parallel_for(
        judged.size(), threads,
        [&](std::size_t k)
        {
            around[k] = look_around(scene, judged[k]);
            scene.looks_away[judged[k]] = around[k].looks_away ? 1 : 0;
        },
        walls_per_chunk);
    std::vector<WallJudgement> judgements(judged.size());
    parallel_for(
        judged.size(), threads,
        [&](std::size_t k)
        {
            if (around[k].is_near) judgements[k] = judge_wall(scene, judged[k], around[k]);
        },
        walls_per_chunk);
    for (std::size_t k = 0; k < judged.size(); ++k)
        if (around[k].is_near) sums.add(particles, judged[k], around[k], judgements[k]);
}

/// Of every mk its type, count and whether it has normals.
std::map<std::uint16_t, CheckedMk> count_mks(const CheckParticles& particles)
{
    std::map<std::uint16_t, CheckedMk> mks;
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
    {
        CheckedMk& mk = mks[particles.mk[i]];
        mk.mk = particles.mk[i];
        mk.type = particles.type[i];
        ++mk.count;
        mk.has_normals = mk.has_normals || has_normal(particles, i);
    }
    return mks;
}

void collect_faults(const CheckParticles& particles, const std::vector<std::uint16_t>& masks,
                    std::map<std::uint16_t, CheckedMk>& mks, CheckReport& report)
{
    for (std::size_t i = 0; i < masks.size(); ++i)
    {
        if (masks[i] == 0) continue;
        CheckedMk& mk = mks.at(particles.mk[i]);
        for (std::size_t f = 0; f < fault_count; ++f)
            if ((masks[i] >> f & 1U) != 0) ++mk.faults[f];
        FaultyParticle& faulty = report.faulty.emplace_back();
        faulty = {particles.ids[i], particles.mk[i], masks[i], particles.positions[i], {}};
        if (i < particles.normals.size()) faulty.normal = particles.normals[i];
    }
}

void note_what_is_odd(const std::map<std::uint16_t, CheckedMk>& mks, CheckReport& report)
{
    std::vector<std::string>& notes = report.setup.notes;
    const bool is_mdbc = report.setup.boundary == 2;
    bool has_any = false;
    for (const auto& [number, mk] : mks)
    {
        has_any = has_any || mk.has_normals;
        if (is_mdbc && !is_judged(mk))
            notes.push_back(fmt::format(
                "The floating mk {} has no normals: the solver keeps it plain DBC.", number));
    }
    if (is_mdbc && !has_any && !mks.empty())
        notes.push_back(
            "The case asks for mDBC and no particle has a normal: the solver stops with "
            "\"No valid normal vectors for using mDBC\".");
    if (!is_mdbc && has_any)
        notes.push_back(
            "The case has normals, but its parameter Boundary asks for DBC: the solver "
            "does not use them.");
    if (is_mdbc && report.setup.slip_mode == 1)
        notes.push_back("SlipMode is 1: the solver knows no NoPenetration with it.");
    else if (is_mdbc && !report.setup.no_penetration)
        notes.push_back("NoPenetration is off: set it to 1 to keep fluid out of the walls.");
}

Box3 box_of(const std::vector<Vec3>& positions)
{
    Box3 box;
    for (const Vec3& p : positions)
        if (is_finite(p)) box.add(p);
    return box;
}

Box3 box_of(const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& chosen)
{
    Box3 box;
    for (const std::uint32_t i : chosen) box.add(positions[i]);
    return box;
}

} // namespace

CheckReport check_particles(const CheckParticles& particles, CheckSetup setup, int threads)
{
    CheckReport report;
    report.setup = std::move(setup);
    report.np = particles.positions.size();
    std::map<std::uint16_t, CheckedMk> mks = count_mks(particles);
    report.judges_normals = report.setup.boundary == 2;
    for (const auto& [number, mk] : mks)
        report.judges_normals = report.judges_normals || mk.has_normals;

    std::vector<std::uint16_t> masks(report.np, 0);
    judge_outside(particles, report.setup, masks);
    const std::vector<std::uint32_t> walls = chosen_particles(particles, false);
    const std::vector<std::uint32_t> fluid = chosen_particles(particles, true);
    report.fluid = fluid.size();
    const double dp = report.setup.dp;
    const ParticleColumns wall_columns(particles.positions, walls, dp, threads);
    const ParticleColumns fluid_columns(particles.positions, fluid, dp, threads);
    report.close_pairs =
        judge_places(particles, report.setup, wall_columns, fluid_columns, masks, threads);
    for (const std::uint32_t i : walls)
        if (stops_in_buffer(report.setup, particles.positions[i], normal_of(particles, i)))
            masks[i] |= bit_of(Fault::InBufferZone);
    judge_near_inlets(particles, report.setup, walls, masks);
    if (report.judges_normals)
    {
        const FillNodes nodes = fill_cavity(particles, report.setup, walls, fluid, threads);
        report.fill = nodes.size();
        if (nodes.n[2] == 0 && !walls.empty())
            report.setup.notes.push_back(
                "The box of all walls, with 4h around it, is too large to be filled: walls were "
                "judged with the fluid of the case alone.");
        else if (report.fluid + report.fill == 0)
            report.setup.notes.push_back(
                "There is no fluid, and walls leave no room for it: no normal "
                "was judged.");
        WallScene scene{
            particles,
            report.setup,
            wall_columns,
            {fluid_columns, nodes, periodic_ways(report.setup), box_of(particles.positions, walls)},
            {}};
        WallSums sums{report, mks, masks, {}};
        judge_walls(particles, scene, walls, sums, threads);
        sums.finish();
    }
    note_what_is_odd(mks, report);
    for (std::string& note : judge_motion(particles, report.setup, wall_columns))
        report.setup.notes.push_back(std::move(note));
    collect_faults(particles, masks, mks, report);
    for (const auto& [number, mk] : mks) report.mks.push_back(mk);
    return report;
}

CheckReport check_case(const std::string& case_name, int threads)
{
    const ParticleSource source(case_name);
    if (!source.is_bi4())
        throw IoError(fmt::format("cannot check '{}': expected Case.bi4 with Case.xml", case_name));
    CheckParticles particles;
    const std::size_t n = source.size();
    particles.positions.resize(n);
    particles.ids.resize(n);
    particles.mk.resize(n);
    particles.type.resize(n);
    particles.normals.resize(
        std::min<std::size_t>(n, source.bi4().bound_normals.size() / (3 * sizeof(float))));
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            particles.positions[i] = source.position(i);
            particles.ids[i] = source.id(i);
            particles.mk[i] = source.mk(i);
            particles.type[i] = static_cast<ParticleType>(source.type(i));
            if (i < particles.normals.size()) particles.normals[i] = source.normal(i);
        },
        65536);
    source.release();
    CheckSetup setup = read_setup(*source.xml(), source.xml_path(), box_of(particles.positions));
    setup.case_name = case_name;
    return check_particles(particles, std::move(setup), threads);
}

} // namespace fppg
