#include "fppg/relax_walls.h"

#include "core/parallel.h"
#include "meshes/point_grid.h"
#include "relax/all_surfaces.h"
#include "relax/all_walls.h"
#include "relax/cut_nodes.h"
#include "relax/fit_moments.h"
#include "relax/fluid_space.h"
#include "relax/lattice_strips.h"
#include "relax/near_blocks.h"
#include "relax/own_lattice.h"
#include "relax/region_volume.h"
#include "relax/regions.h"
#include "relax/sliding_walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

namespace fppg
{
namespace
{

/// A sheet with nodes of a region this near on both sides stays as it is, dp.
constexpr double reach_of_sides_dp = 1.5;
constexpr int volume_iterations = 30;
/// Of bodies that are wholly inside, whose outermost particles move as well.
constexpr int inside_iterations = 80;
constexpr std::size_t runs_per_chunk = 256;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A run of the field and its slab.
struct SlabRun
{
    std::uint32_t x = 0;
    Run run;
};

/// What look_at(run, found) adds for the runs, chunk by chunk in their order.
template <typename Found, typename LookAt>
std::vector<std::vector<Found>> find_in_chunks(const std::vector<SlabRun>& runs,
                                               const LookAt& look_at, int threads)
{
    std::vector<std::vector<Found>> chunks((runs.size() + runs_per_chunk - 1) / runs_per_chunk);
    parallel_for(chunks.size(), threads,
                 [&](std::size_t c)
                 {
                     const std::size_t end = std::min(runs.size(), (c + 1) * runs_per_chunk);
                     for (std::size_t i = c * runs_per_chunk; i < end; ++i)
                         look_at(runs[i], chunks[c]);
                 });
    return chunks;
}

class Relaxation
{
public:
    Relaxation(const CaseDef& def, RunField& field, int threads, const RelaxObserver& observe,
               RelaxReport& report, const RelaxSnapshot& snapshot)
        : def_(def),
          field_(field),
          threads_(threads),
          observe_(observe),
          report_(report),
          snapshot_(snapshot)
    {
    }

    void run()
    {
        if (!field_.grid.is_2d)
            relax_all_surfaces(def_, field_, threads_, observe_, report_, snapshot_);
        cover_crowded_nodes();
        relax_volumes();
    }

private:
    const FitSettings* settings_of(std::uint16_t mk) const { return fit_settings(def_.fit, mk); }

    bool observe(const RelaxStep& step)
    {
        if (observe_ && !observe_(step)) report_.is_stopped = true;
        return !report_.is_stopped;
    }

    /// Nodes between layers, that particles of the layers came too near to, go.
    void cover_crowded_nodes()
    {
        std::vector<char> is_layered(65536, 0);
        std::vector<Vec3> layers;
        for (std::size_t i = 0; i < field_.walls.particles.size(); ++i)
        {
            const FittedBody& body = field_.walls.bodies[field_.walls.particles.bodies[i]];
            if (!body.is_layer()) continue;
            is_layered[body.mk] = 1;
            layers.push_back(field_.walls.particles.positions[i]);
        }
        if (layers.empty()) return;
        const double distance = (1 - 1e-9) * least_pair_dp * field_.grid.dp;
        PointGrid grid(distance, layers.size());
        for (const Vec3& p : layers) grid.add(p);
        std::vector<SlabRun> runs;
        for_each_run(
            [&](const SlabRun& r)
            {
                if (is_layered[r.run.mk] != 0) runs.push_back(r);
            });
        const NearBlocks& blocks = near_blocks(3, 1);
        const auto look_at = [&](const SlabRun& r, std::vector<Mover>& out)
        {
            const auto test = [&](std::uint32_t begin, std::uint32_t end)
            {
                for (std::uint32_t z = begin; z < end; ++z)
                {
                    const NodeIndex node{r.x, r.run.y, z};
                    if (grid.has_nearer(place_of(node, field_.grid), distance))
                        out.push_back({node, r.run.mk});
                }
            };
            blocks.for_each_stretch(r.x, r.run, test);
        };
        std::vector<std::vector<Mover>> left(field_.slabs.size());
        std::map<std::uint16_t, double> counts;
        for (const auto& chunk : find_in_chunks<Mover>(runs, look_at, threads_))
            for (const Mover& m : chunk)
            {
                left[m.node.x].push_back(m);
                ++counts[m.mk];
            }
        for (std::size_t x = 0; x < left.size(); ++x) cover(field_.slabs[x], left[x]);
        for (const auto& [mk, count] : counts)
        {
            Region region;
            region.band.assign(65536, 0);
            region.band[mk] = 1;
            take_new_nodes(field_.walls, region, -count, field_.grid.dp);
            if (!report_.parts.empty())
                report_.parts.front().removed += static_cast<std::size_t>(count);
        }
    }

    void relax_volumes()
    {
        if (field_.walls.particles.size() == 0) return;
        const std::vector<std::vector<std::uint16_t>> solids = solid_mks(field_.walls.bodies);
        const bool has_solids = std::any_of(solids.begin(), solids.end(),
                                            [&](const auto& mks) { return band_of(mks) > 0; });
        if (!has_solids && def_.fluid_bands.empty()) return;
        const AllWalls all(field_.walls.bodies, field_.grid, threads_);
        if (all.is_empty()) return;
        const std::vector<std::vector<SlabRun>> runs = runs_of_solids(solids);
        own_lattices_ = own_lattices(field_.walls, field_.grid);
        for (std::size_t s = 0; s < solids.size() && !report_.is_stopped; ++s)
        {
            const std::vector<std::uint16_t>& mks = solids[s];
            const FitSettings* settings = settings_of(mks.front());
            if (band_of(mks) <= 0) continue;
            Region region;
            region.what = fmt::format("volume mk {}", fmt::join(mks, ","));
            region.band.assign(65536, 0);
            // Under layers the inside begins that much deeper.
            const double layers =
                settings->depths_dp.empty() ? 0 : settings->depths_dp.back() + 0.5;
            for (const std::uint16_t mk : mks)
                region.band[mk] = has_own_lattice(field_.walls, own_lattices_, mk)
                                      ? infinity
                                      : settings->relax.band_dp + layers;
            region.beside.assign(65536, 0);
            region.is_solid = true;
            if (settings->relax.iterations)
                region.iterations = std::min(*settings->relax.iterations, volume_iterations);
            relax_region(region, all, runs[s]);
        }
        for (std::size_t b = 0; b < field_.walls.bodies.size() && !report_.is_stopped; ++b)
        {
            const FitSettings* settings = settings_of(field_.walls.bodies[b].mk);
            if (settings != nullptr && settings->relax.is_active)
                fit_moments(field_, b, all, threads_);
        }
        if (!def_.fluid_bands.empty() && !report_.is_stopped)
        {
            report_.space = measure_fluid_space(def_, field_, all, are_layered(), threads_);
            const Region region = fluid_region(def_, report_.space);
            std::vector<SlabRun> of_fluid;
            for_each_run(
                [&](const SlabRun& r)
                {
                    if (region.band[r.run.mk] > 0 || region.beside[r.run.mk]) of_fluid.push_back(r);
                });
            relax_region(region, all, of_fluid);
        }
    }

    /// How far from the wall the inside of a solid moves, in dp; 0: not at all.
    double band_of(const std::vector<std::uint16_t>& mks) const
    {
        const FitSettings* settings = settings_of(mks.front());
        return settings != nullptr && settings->relax.is_active ? settings->relax.band_dp : 0;
    }

    template <typename Visit>
    void for_each_run(const Visit& visit) const
    {
        for (std::size_t x = 0; x < field_.slabs.size(); ++x)
            for (const Run& run : field_.slabs[x])
                if (!run.is_covered) visit(SlabRun{static_cast<std::uint32_t>(x), run});
    }

    /// The runs of each set of mks, which no set changes for another.
    std::vector<std::vector<SlabRun>> runs_of_solids(
        const std::vector<std::vector<std::uint16_t>>& solids) const
    {
        std::vector<std::size_t> of_mk(65536, solids.size());
        for (std::size_t s = 0; s < solids.size(); ++s)
            for (const std::uint16_t mk : solids[s]) of_mk[mk] = s;
        std::vector<std::vector<SlabRun>> runs(solids.size());
        for_each_run(
            [&](const SlabRun& r)
            {
                if (of_mk[r.run.mk] < solids.size()) runs[of_mk[r.run.mk]].push_back(r);
            });
        return runs;
    }

    /// Blocks near all walls; kept, as many solids ask for the same.
    const NearBlocks& near_blocks(std::uint32_t side, int reach)
    {
        const auto [place, is_new] = near_blocks_.try_emplace({side, reach});
        if (is_new)
            place->second = std::make_unique<NearBlocks>(field_.walls.particles.positions,
                                                         field_.grid, side, reach, threads_);
        return *place->second;
    }

    /// The nodes of a region that move, in the order of its runs.
    std::vector<Mover> find_movers(const Region& region, const std::vector<SlabRun>& runs,
                                   const AllWalls& all, const NearBlocks& blocks,
                                   const std::function<bool(const Vec3&)>& stays)
    {
        const LatticeGrid& grid = field_.grid;
        const FittedWalls& walls = field_.walls;
        struct Candidate
        {
            Mover mover;
            std::size_t body = 0;
            bool is_outside = false;
            bool is_at_sides = false;
        };
        const auto look_at = [&](const SlabRun& r, std::vector<Candidate>& out)
        {
            const double band = region.band[r.run.mk];
            if (band <= 0) return;
            const auto test = [&](std::uint32_t begin, std::uint32_t end)
            {
                for (std::uint32_t z = begin; z < end; ++z)
                {
                    Candidate c;
                    c.mover = {{r.x, r.run.y, z}, r.run.mk};
                    const Vec3 p = place_of(c.mover.node, grid);
                    const AllWalls::Closest near = all.closest(p, band * grid.dp);
                    if (near.distance > band * grid.dp || stays(p)) continue;
                    c.body = near.body;
                    c.is_outside = near.is_outside;
                    c.is_at_sides = near.distance < reach_of_sides_dp * grid.dp;
                    out.push_back(c);
                }
            };
            if (std::isinf(band))
                test(r.run.z_begin, r.run.z_end);
            else
                blocks.for_each_stretch(r.x, r.run, test);
        };
        const auto chunks = find_in_chunks<Candidate>(runs, look_at, threads_);
        // Per body: whether it has nodes of the region on its inner and its outer side.
        std::vector<std::array<char, 2>> sides(walls.bodies.size());
        for (const auto& chunk : chunks)
            for (const Candidate& c : chunk)
                if (c.is_at_sides) sides[c.body][c.is_outside ? 1 : 0] = 1;
        std::vector<Mover> movers;
        std::vector<char> is_warned(walls.bodies.size(), 0);
        for (const auto& chunk : chunks)
            for (const Candidate& c : chunk)
            {
                if (walls.bodies[c.body].is_solid || !sides[c.body][0] || !sides[c.body][1])
                {
                    movers.push_back(c.mover);
                    continue;
                }
                if (is_warned[c.body]) continue;
                is_warned[c.body] = 1;
                report_.warnings.push_back(fmt::format(
                    "{}: <{}> has particles of {} on both sides of its sheet: they are left as "
                    "they are next to it.",
                    walls.bodies[c.body].line, walls.bodies[c.body].name, region.what));
            }
        return movers;
    }

    /// The nodes beside those that move, within the reach of their forces.
    std::vector<Vec3> find_held(const Region& region, const std::vector<SlabRun>& runs,
                                const std::vector<Mover>& movers, const NearBlocks& blocks) const
    {
        const LatticeGrid& grid = field_.grid;
        const double reach = (2 * region.h_dp + 0.6) * grid.dp;
        const bool is_endless = std::any_of(region.band.begin(), region.band.end(),
                                            [](double band) { return std::isinf(band); });
        PointGrid moving(reach, movers.size());
        for (const Mover& m : movers) moving.add(place_of(m.node, grid));
        const auto comes_before = [](const Mover& m, const NodeIndex& node)
        { return std::tuple(m.node.x, m.node.y, m.node.z) < std::tuple(node.x, node.y, node.z); };
        const auto look_at = [&](const SlabRun& r, std::vector<Vec3>& out)
        {
            auto mover = std::lower_bound(movers.begin(), movers.end(),
                                          NodeIndex{r.x, r.run.y, r.run.z_begin}, comes_before);
            const auto test = [&](std::uint32_t begin, std::uint32_t end)
            {
                for (std::uint32_t z = begin; z < end; ++z)
                {
                    const NodeIndex node{r.x, r.run.y, z};
                    while (mover != movers.end() && comes_before(*mover, node)) ++mover;
                    if (mover != movers.end() && mover->node == node) continue;
                    const Vec3 p = place_of(node, grid);
                    if (moving.has_nearer(p, reach)) out.push_back(p);
                }
            };
            if (is_endless)
                test(r.run.z_begin, r.run.z_end);
            else
                blocks.for_each_stretch(r.x, r.run, test);
        };
        const auto chunks = find_in_chunks<Vec3>(runs, look_at, threads_);
        std::vector<Vec3> held;
        for (const auto& chunk : chunks) held.insert(held.end(), chunk.begin(), chunk.end());
        // What would come into pockets is pushed back as if they were full.
        for (const Vec3& p : region.left_empty)
            if (moving.has_nearer(p, reach)) held.push_back(p);
        // What an earlier region took off the lattice pushes as well.
        const VolumeParticles& volume = field_.walls.volume;
        for (std::size_t i = 0; i < volume.size(); ++i)
            if ((region.band[volume.mk[i]] > 0 || region.beside[volume.mk[i]]) &&
                moving.has_nearer(volume.positions[i], reach))
                held.push_back(volume.positions[i]);
        return held;
    }

    /// Whether all fitted walls are layers behind their surfaces.
    bool are_layered() const
    {
        const FittedWalls& walls = field_.walls;
        return std::all_of(walls.particles.bodies.begin(), walls.particles.bodies.end(),
                           [&](std::uint32_t b) { return walls.bodies[b].is_layer(); });
    }

    /// Wall particles that stay, within the reach of forces on those that move.
    std::vector<Vec3> find_walls(const Region& region, const std::vector<Mover>& movers,
                                 const SlidingWalls& sliding) const
    {
        const LatticeGrid& grid = field_.grid;
        const WallParticles& particles = field_.walls.particles;
        const double reach = (2 * region.h_dp + 2) * grid.dp;
        Box3 box;
        for (const Mover& m : movers) box.add(place_of(m.node, grid));
        for (const std::uint32_t i : sliding.particles) box.add(particles.positions[i]);
        std::vector<Vec3> out;
        auto next = sliding.particles.begin();
        for (std::uint32_t i = 0; i < particles.size(); ++i)
        {
            if (next != sliding.particles.end() && *next == i)
                ++next;
            else if (box.has(particles.positions[i], reach))
                out.push_back(particles.positions[i]);
        }
        return out;
    }

    static double count_nodes(const Region& region, const std::vector<SlabRun>& runs)
    {
        double count = 0;
        for (const SlabRun& r : runs)
            if (region.band[r.run.mk] > 0) count += r.run.z_end - r.run.z_begin;
        return count;
    }

    /// How many particles are wanted in the end; nothing: as many as fit.
    std::optional<double> number_wanted(const Region& region, const std::vector<SlabRun>& runs,
                                        std::size_t moving) const
    {
        const double dp = field_.grid.dp;
        if (region.is_solid)
            return wanted_number(field_.walls, region, moving, count_nodes(region, runs), dp);
        if (region.missing) return static_cast<double>(moving + *region.missing);
        if (are_layered()) return number_between_layers(report_.space, moving, field_.grid);
        return std::nullopt;
    }

    RelaxVolumeOptions options_of(const Region& region, const std::vector<SlabRun>& runs,
                                  std::size_t moving, bool is_of_inside) const
    {
        RelaxVolumeOptions options;
        options.dp = field_.grid.dp;
        options.h_dp = region.h_dp;
        options.iterations =
            region.iterations.value_or(is_of_inside ? inside_iterations : volume_iterations);
        options.is_2d = field_.grid.is_2d;
        options.fit_count = region.fits_count;
        options.wanted = number_wanted(region, runs, moving);
        if (is_of_inside || (!region.is_solid && are_layered())) options.behind_wall_dp = 0;
        if (is_of_inside) options.min_wall_distance_dp = 0.5;
        options.has_free_surface = !is_of_inside;
        options.is_solid = region.is_solid;
        if (options.wanted && region.is_solid && !is_of_inside)
            options.least_pair_dp = least_pair_dp;
        return options;
    }

    /// runs  of the region, and of what is beside it, in their order in the field
    void relax_region(const Region& region, const AllWalls& all, const std::vector<SlabRun>& runs)
    {
        const LatticeGrid& grid = field_.grid;
        double widest = 0;
        for (const double band : region.band)
            if (std::isfinite(band)) widest = std::max(widest, band);
        // Twice the side reaches from a wall particle over the band and the reach of forces.
        const auto side = std::max(3u, static_cast<std::uint32_t>(std::ceil(widest)) + 1);
        const bool is_of_inside = region.is_solid && is_inside(field_.walls, region);
        const SlidingWalls sliding =
            is_of_inside ? find_sliding(field_.walls, region) : SlidingWalls{};
        if (runs.empty() && sliding.particles.empty()) return;
        const PointGrid cut = places_of_cuts(field_, region, all, threads_);
        const std::optional<LatticeStrips> strips =
            region.is_solid ? std::nullopt
                            : std::optional<LatticeStrips>(std::in_place, def_, field_);
        const auto stays = [&](const Vec3& p)
        { return cut.has_nearer(p, reach_of_cuts_dp * grid.dp) || (strips && strips->has(p)); };
        const std::vector<Mover> movers =
            find_movers(region, runs, all, near_blocks(side, 1), stays);
        if (movers.empty() && sliding.particles.empty()) return;
        const std::vector<Vec3> held = find_held(region, runs, movers, near_blocks(side, 2));
        // Before walls all of whose particles stand behind their surface, a continuum from there on
        // stands for them: it is as smooth as the boundary condition.
        const bool is_before_layers = !region.is_solid && are_layered();
        const std::vector<Vec3> near_walls =
            is_before_layers ? std::vector<Vec3>{} : find_walls(region, movers, sliding);
        std::vector<Vec3> positions;
        for (const Mover& m : movers) positions.push_back(place_of(m.node, grid));
        if (is_of_inside)
            move_to_own_lattices(field_.walls, own_lattices_, all, movers, positions, threads_);
        std::vector<VolumeMotion> slides(sliding.particles.empty() ? 0 : movers.size(),
                                         VolumeMotion::Free);
        slides.insert(slides.end(), sliding.motions.begin(), sliding.motions.end());
        for (const std::uint32_t i : sliding.particles)
            positions.push_back(field_.walls.particles.positions[i]);
        VolumeSurroundings surroundings;
        surroundings.slides = slides;
        surroundings.put_back = [&](std::size_t i, const Vec3& p)
        {
            return put_back(field_.walls, sliding.particles[i - movers.size()], p, grid.dp,
                            surroundings.closest);
        };
        const bool has_limits = !cut.points().empty() || (strips && strips->are_at_inlets());
        const std::vector<Vec3> starts = has_limits ? positions : std::vector<Vec3>{};
        if (has_limits) // so near to a cut nothing moved, and nothing comes
            surroundings.may_come = [&](std::size_t i, const Vec3& p)
            {
                return norm(p - starts[i]) < grid.dp ||
                       !(cut.has_nearer(p, (reach_of_cuts_dp - 1) * grid.dp) ||
                         (strips && strips->keeps_out(p, is_before_layers)));
            };
        surroundings.held = held;
        surroundings.walls = near_walls;
        surroundings.closest = [&](const Vec3& p, double within)
        { return all.closest_point(p, within); };
        RelaxVolumeOptions options = options_of(region, runs, positions.size(), is_of_inside);
        options.on_iteration = [&](const RelaxVolumeProgress& p)
        {
            return observe({region.what, p.iteration, options.iterations,
                            slides.empty() ? movers.size() : slides.size(), p.shepard_mean,
                            p.shepard_variation, p.largest_step_dp});
        };
        RelaxVolumeReport done = relax_volume(positions, surroundings, options, threads_);
        const double more = static_cast<double>(positions.size()) -
                            static_cast<double>(movers.size() + sliding.particles.size());
        const std::size_t relaxed = positions.size();
        if (!sliding.particles.empty())
            keep_slid(sliding, movers.size(), field_.walls, positions, done);
        keep_moved(region, all, movers, positions, done.sources);
        if (region.is_solid) take_new_nodes(field_.walls, region, more, field_.grid.dp);
        report_.parts.push_back({.what = region.what,
                                 .iterations = done.iterations,
                                 .particles = relaxed,
                                 .inserted = done.inserted,
                                 .removed = done.removed,
                                 .mean = done.shepard_mean,
                                 .variation = done.shepard_variation});
    }

    /// Particles that left their nodes go into walls.volume; nodes left get the bit of the zone.
    void keep_moved(const Region& region, const AllWalls& all, const std::vector<Mover>& movers,
                    const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& sources)
    {
        const LatticeGrid& grid = field_.grid;
        VolumeParticles& volume = field_.walls.volume;
        std::vector<char> stays(movers.size(), 0);
        const std::size_t first = volume.distances.size();
        for (std::size_t i = 0; i < positions.size(); ++i)
        {
            const std::uint32_t source =
                sources.empty() ? static_cast<std::uint32_t>(i) : sources[i];
            if (positions[i] == place_of(movers[source].node, grid))
            {
                stays[source] = 1;
                continue;
            }
            volume.positions.push_back(positions[i]);
            volume.mk.push_back(movers[source].mk);
        }
        volume.distances.resize(volume.positions.size());
        parallel_for(
            volume.size() - first, threads_,
            [&](std::size_t i)
            {
                const double distance = all.closest(volume.positions[first + i]).distance;
                volume.distances[first + i] =
                    static_cast<float>(region.is_solid ? -distance : distance);
            },
            256);
        std::vector<std::vector<Mover>> left(field_.slabs.size());
        for (std::size_t i = 0; i < movers.size(); ++i)
            if (!stays[i]) left[movers[i].node.x].push_back(movers[i]);
        parallel_for(field_.slabs.size(), threads_,
                     [&](std::size_t x) { cover(field_.slabs[x], left[x]); });
    }

    const CaseDef& def_;
    RunField& field_;
    int threads_;
    const RelaxObserver& observe_;
    RelaxReport& report_;
    const RelaxSnapshot& snapshot_;
    std::map<std::pair<std::uint32_t, int>, std::unique_ptr<NearBlocks>> near_blocks_;
    std::vector<std::optional<OwnLattice>> own_lattices_; ///< of the bodies
};

} // namespace

bool relaxes(const CaseDef& def, const RunField& field)
{
    const auto is_active = [&](const FittedBody& body)
    {
        const FitSettings* settings = fit_settings(def.fit, body.mk);
        return settings != nullptr && settings->relax.is_active;
    };
    const std::vector<FittedBody>& bodies = field.walls.bodies;
    return !bodies.empty() && (std::any_of(def.fluid_bands.begin(), def.fluid_bands.end(),
                                           [](const FluidBand& band) { return band.is_active; }) ||
                               std::any_of(bodies.begin(), bodies.end(), is_active));
}

void relax_walls(const CaseDef& def, RunField& field, int threads, const RelaxObserver& observe,
                 RelaxReport& report, const RelaxSnapshot& snapshot)
{
    if (!relaxes(def, field)) return;
    Relaxation(def, field, threads, observe, report, snapshot).run();
}

} // namespace fppg
