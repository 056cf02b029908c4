#include "particles/density.h"

#include "core/parallel.h"
#include "particles/depths.h"
#include "particles/roofs.h"
#include "particles/upward_depths.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fppg
{
namespace
{

void set_speeds(const CaseDef& def, double g, CaseConstants& constants)
{
    const ConstantsDef& c = def.constants;
    const double wave = std::sqrt(g * constants.hswl);
    constants.speed_system = c.speed_system.value_or(wave);
    constants.speed_sound =
        c.speed_sound.value_or(std::max(c.coef_sound * constants.speed_system, 10 * wave));
    constants.b = c.b.value_or(constants.speed_sound * constants.speed_sound * c.rhop0 / c.gamma);
}

/// Computes what compute_densities() says: depths, then hswl and what follows from it, then
/// densities.
class Densities
{
public:
    Densities(const WaterNodes& water, const Vec3& gravity, CaseParticles& particles,
              CaseConstants& constants, int threads)
        : def_(water.def),
          field_(water.field),
          type_of_mk_(water.type_of_mk),
          particles_(particles),
          constants_(constants),
          threads_(threads),
          gravity_(gravity),
          meter_(field_, type_of_mk_, !raises_roofs()),
          g_(norm(gravity_)),
          is_vertical_(gravity_.x == 0 && gravity_.y == 0),
          by_height_(def_.constants.rhop_gradient == 3),
          top_(field_.slabs.size()),
          off_lattice_(field_, meter_, water.off_lattice_begin, particles, threads)
    {
    }

    void measure()
    {
        parallel_for(
            top_.size(), threads_, [&](std::size_t x) { top_[x] = meter_.depths_along_z(x); }, 16);
        measure_nodes();
        if (raises_roofs())
            raise_roofed_depths(
                field_, particles_.off_lattice, [](const Vec3& p) { return p; }, meter_, top_);
        measure_off_lattice();
    }

    void set_constants()
    {
        if (by_height_ && std::isfinite(water_.s_max)) constants_.surface = water_.s_max;
        constants_.hswl = hswl();
        set_speeds(def_, g_, constants_);
    }

    /// returns  whether fluid has another depth than rhopgradient 3 asks for
    bool set_densities()
    {
        const ConstantsDef& c = def_.constants;
        is_uniform_ = c.rhop_gradient == 1 || g_ == 0 || constants_.b == 0;
        const auto rhop0 = static_cast<float>(c.rhop0);
        particles_.off_lattice.rhop.assign(particles_.off_lattice.size(), rhop0);
        if (particles_.n_fluid == 0) return false;
        const std::optional<UpAxis> up = up_axis(gravity_);
        row_ = up ? def_.grid.step(up->axis) : def_.grid.dp;
        if (!is_uniform_ && def_.balances() && up && (by_height_ || !up->is_z()) &&
            !def_.vres.is_active())
        {
            return set_upward(*up) && by_height_;
        }
        if (is_uniform_ || (is_vertical_ && (!by_height_ || gravity_.z < 0)))
            set_by_steps();
        else
            set_one_by_one();
        if (!is_uniform_) set_off_lattice();
        return false;
    }

private:
    /// Height over the origin against gravity.
    double height(const Vec3& p) const
    {
        return -(p.x * gravity_.x + p.y * gravity_.y + p.z * gravity_.z) / g_;
    }
    double height(std::size_t x, std::uint32_t y, std::uint32_t z) const
    {
        return height(def_.grid.place(
            {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
    }

    /// The density at a depth.
    float rhop(double depth) const
    {
        const ConstantsDef& c = def_.constants;
        if (is_uniform_) return static_cast<float>(c.rhop0);
        // GenCase's surface goes through the highest particles, that of the fluid lies above them.
        if (def_.balances()) depth += row_ / 2;
        const double pressure = c.rhop0 * g_ * depth / def_.fluid_fullness;
        return static_cast<float>(c.rhop0 * std::pow(1 + pressure / constants_.b, 1 / c.gamma));
    }

    bool raises_roofs() const
    {
        return def_.balances() && def_.constants.rhop_gradient != 3 && gravity_.x == 0 &&
               gravity_.y == 0 && gravity_.z < 0;
    }

    /// GenCase gives all fluid of an mk that setfrdrawmode draws rhop0, on nodes too.
    bool is_plain(const ParticleBlock& block) const
    {
        const std::vector<std::uint16_t>& mks = field_.walls.off_lattice_mks;
        return !def_.hydrostatic_off_lattice &&
               std::binary_search(mks.begin(), mks.end(), block.mk);
    }

    void measure_slab(std::size_t x, WaterLimits& w) const
    {
        for (std::size_t i = 0; i < field_.slabs[x].size(); ++i)
        {
            const Run& r = field_.slabs[x][i];
            if (meter_.medium(r.mk) != Medium::Water) continue;
            if (counts_for_hswl(field_, r))
                w.deepest = std::max(w.deepest, top_[x][i] + (r.z_end - r.z_begin - 1));
            if (r.is_covered || type_of_mk_[r.mk] != ParticleType::Fluid) continue;
            w.z_max = std::max(w.z_max, r.z_end - 1);
            if (g_ > 0 && by_height_)
                for (const std::uint32_t z : {r.z_begin, r.z_end - 1}) w.add(height(x, r.y, z));
        }
    }

    void measure_nodes()
    {
        std::vector<WaterLimits> of_slab(field_.slabs.size());
        parallel_for(
            of_slab.size(), threads_, [&](std::size_t x) { measure_slab(x, of_slab[x]); }, 16);
        for (const WaterLimits& w : of_slab) water_.add(w);
    }

    void measure_off_lattice()
    {
        if (!(g_ > 0)) return;
        if (!by_height_)
        {
            if (is_vertical_)
                off_lattice_.measure_along_z(top_, def_.grid.step(2));
            else
                off_lattice_.sort_by_slab(field_.slabs.size());
            return;
        }
        const double of_nodes = water_.s_max;
        off_lattice_.for_each_of_fluid(
            [&](std::uint64_t i, const ParticleBlock&)
            { water_.add(height(particles_.off_lattice.positions[i])); });
        // Where GenCase v5.4.354 has several zones, the surface of the first is that of all.
        if (def_.main_surface && particles_.n_fluid > 0) water_.s_max = *def_.main_surface;
        if (std::isfinite(of_nodes)) excess_ = water_.s_max - of_nodes;
    }

    double hswl()
    {
        if (def_.constants.hswl) return *def_.constants.hswl;
        if (def_.main_hswl) return *def_.main_hswl;
        if (particles_.n_fluid == 0 || g_ == 0) return 0;
        if (by_height_) return water_.s_max - water_.s_min;
        if (is_vertical_)
            return std::max(water_.deepest * def_.grid.step(2), off_lattice_.deepest());
        double most = 0;
        TiltedDepths tilted(gravity_, field_, meter_);
        tilted.for_each(
            [&](std::size_t x, std::size_t i, std::uint32_t, double d)
            {
                if (counts_for_hswl(field_, field_.slabs[x][i])) most = std::max(most, d);
            },
            [&](const TiltedDepths::Slab& slab) { off_lattice_.measure(tilted, slab); });
        return std::max(most, off_lattice_.deepest());
    }

    /// The largest depth in steps of a run of fluid, after the depths of runs are set.
    std::uint32_t count_steps()
    {
        std::uint32_t most = 0;
        if (is_uniform_)
        {
            for (const ParticleBlock& block : particles_.blocks)
                if (block.type == ParticleType::Fluid)
                    for (const ParticleRun& run : block.runs) most = std::max(most, run.count - 1);
            return most;
        }
        BlockCursor cursor(particles_);
        for (std::size_t x = 0; x < field_.slabs.size(); ++x)
            cursor.visit(field_.slabs[x],
                         [&](std::size_t i, ParticleBlock& block, std::size_t at)
                         {
                             if (block.type != ParticleType::Fluid) return;
                             ParticleRun& run = block.runs[at];
                             run.depth =
                                 by_height_ ? water_.z_max - (run.z + run.count - 1) : top_[x][i];
                             most = std::max(most, run.depth + run.count - 1);
                         });
        return most;
    }

    /// Runs of plain fluid stand behind all depths, where the density is rhop0.
    void add_plain_runs()
    {
        const auto behind = static_cast<std::uint32_t>(particles_.rhop_of_depth.size());
        std::uint32_t longest = 0;
        for (ParticleBlock& block : particles_.blocks)
            if (block.type == ParticleType::Fluid && is_plain(block))
                for (ParticleRun& run : block.runs)
                {
                    run.depth = behind;
                    longest = std::max(longest, run.count);
                }
        particles_.rhop_of_depth.resize(std::size_t{behind} + longest,
                                        static_cast<float>(def_.constants.rhop0));
    }

    /// One value per step of depth.
    void set_by_steps()
    {
        const std::uint32_t most = count_steps();
        particles_.rhop_of_depth.resize(static_cast<std::size_t>(most) + 1);
        for (std::uint32_t s = 0; s <= most; ++s)
        {
            const double step = s * def_.grid.step(2) * gravity_.z;
            particles_.rhop_of_depth[s] =
                rhop(is_uniform_ ? 0 : std::sqrt(step * step) / g_ + excess_);
        }
        if (!is_uniform_) add_plain_runs();
    }

    /// Of every node run of particles, where its first one stands in the fluid's order of ids; none
    /// for other particles and for plain fluid.
    std::vector<std::vector<std::uint64_t>> first_of_runs()
    {
        const std::uint64_t first_fluid = particles_.np - particles_.n_fluid;
        std::vector<std::vector<std::uint64_t>> of_block(particles_.blocks.size());
        for (std::size_t b = 0; b < particles_.blocks.size(); ++b)
        {
            const ParticleBlock& block = particles_.blocks[b];
            std::uint64_t at = block.begin - first_fluid;
            if (block.type != ParticleType::Fluid || is_plain(block)) continue;
            for (const ParticleRun& run : block.runs)
            {
                of_block[b].push_back(at);
                at += run.count;
            }
        }
        std::vector<std::vector<std::uint64_t>> out(field_.slabs.size());
        BlockCursor cursor(particles_);
        for (std::size_t x = 0; x < out.size(); ++x)
        {
            out[x].assign(field_.slabs[x].size(), no_particle);
            cursor.visit(field_.slabs[x],
                         [&](std::size_t i, const ParticleBlock& block, std::size_t at)
                         {
                             const auto b =
                                 static_cast<std::size_t>(&block - particles_.blocks.data());
                             if (!of_block[b].empty()) out[x][i] = of_block[b][at];
                         });
        }
        return out;
    }

    /// One value per particle.
    void set_one_by_one()
    {
        const std::vector<std::vector<std::uint64_t>> first = first_of_runs();
        particles_.rhop.assign(particles_.n_fluid, static_cast<float>(def_.constants.rhop0));
        if (!by_height_)
        {
            TiltedDepths tilted(gravity_, field_, meter_);
            tilted.for_each(
                [&](std::size_t x, std::size_t i, std::uint32_t k, double d)
                {
                    if (first[x][i] != no_particle) particles_.rhop[first[x][i] + k] = rhop(d);
                },
                [&](const TiltedDepths::Slab& slab) { off_lattice_.measure(tilted, slab); });
            return;
        }
        parallel_for(first.size(), threads_,
                     [&](std::size_t x)
                     {
                         for (std::size_t i = 0; i < first[x].size(); ++i)
                         {
                             if (first[x][i] == no_particle) continue;
                             const Run& r = field_.slabs[x][i];
                             for (std::uint32_t z = r.z_begin; z < r.z_end; ++z)
                                 particles_.rhop[first[x][i] + (z - r.z_begin)] =
                                     rhop(water_.s_max - height(x, r.y, z));
                         }
                     });
    }

    /// Under gravity along any axis, where fluid is balanced.
    ///
    /// returns  whether some has less depth than under the highest fluid
    bool set_upward(const UpAxis& up)
    {
        constexpr double lower_rows = 2;
        const UpwardDepths depths(field_, type_of_mk_, particles_.off_lattice, up, threads_);
        const std::vector<std::vector<std::uint64_t>> first = first_of_runs();
        particles_.rhop.assign(particles_.n_fluid, static_cast<float>(def_.constants.rhop0));
        std::vector<char> is_lower(first.size(), 0);
        parallel_for(
            first.size(), threads_,
            [&](std::size_t x)
            {
                for (std::size_t i = 0; i < first[x].size(); ++i)
                {
                    if (first[x][i] == no_particle) continue;
                    const Run& r = field_.slabs[x][i];
                    for (std::uint32_t z = r.z_begin; z < r.z_end; ++z)
                    {
                        const double depth = depths.of_node({static_cast<std::int64_t>(x), r.y, z});
                        particles_.rhop[first[x][i] + (z - r.z_begin)] = rhop(depth);
                        if (by_height_ &&
                            water_.s_max - height(x, r.y, z) > depth + lower_rows * row_)
                            is_lower[x] = 1;
                    }
                }
            });
        off_lattice_.for_each_of_fluid(
            [&](std::uint64_t i, const ParticleBlock& block)
            {
                if (is_plain(block)) return;
                particles_.off_lattice.rhop[i] =
                    rhop(depths.of_place(particles_.off_lattice.positions[i]));
            });
        return std::find(is_lower.begin(), is_lower.end(), 1) != is_lower.end();
    }

    /// Of the particles off the lattice.
    void set_off_lattice()
    {
        off_lattice_.for_each_of_fluid(
            [&](std::uint64_t i, const ParticleBlock& block)
            {
                if (is_plain(block)) return;
                const Vec3& p = particles_.off_lattice.positions[i];
                particles_.off_lattice.rhop[i] =
                    rhop(by_height_ ? water_.s_max - height(p) : off_lattice_.depth(i));
            });
    }

    static constexpr std::uint64_t no_particle = UINT64_MAX;
    const CaseDef& def_;
    const RunField& field_;
    const std::vector<ParticleType>& type_of_mk_;
    CaseParticles& particles_;
    CaseConstants& constants_;
    int threads_;
    Vec3 gravity_;
    DepthMeter meter_;
    double g_;
    bool is_vertical_; ///< gravity is along z, or there is none
    bool by_height_;   ///< rhopgradient 3
    bool is_uniform_ = false;
    double row_ = 0;                              ///< metres, between rows of fluid
    std::vector<std::vector<std::uint32_t>> top_; ///< per run, steps from its highest node
    WaterLimits water_;
    double excess_ = 0; ///< height of the highest particle off the lattice over the highest node
    OffLatticeDepths off_lattice_;
};

} // namespace

bool compute_densities(const WaterNodes& water, CaseParticles& particles, CaseConstants& constants,
                       int threads)
{
    const ConstantsDef& c = water.def.constants;
    Densities by_gravity(water, c.gravity, particles, constants, threads);
    by_gravity.measure();
    by_gravity.set_constants();
    if (c.driving == Vec3{}) return by_gravity.set_densities();
    Densities at_rest(water, c.rest_gravity(), particles, constants, threads);
    at_rest.measure();
    return at_rest.set_densities();
}

} // namespace fppg
