#include "particles/double_particles.h"

#include "fppg/error.h"

#include "core/most_particles.h"
#include "particles/run_positions.h"

#include <fmt/format.h>

#include <algorithm>

namespace fppg
{
namespace
{

class Doubler
{
public:
    explicit Doubler(CaseParticles& particles) : all_(particles), shift_(Vec3{1, 1, 1})
    {
        shift_ = shift_ * (all_.grid.dp / 4);
        if (all_.grid.is_2d) shift_.y = 0;
    }

    /// Takes over the particles of a block, two for one where `doubles`.
    void take(ParticleBlock& block, bool doubles)
    {
        ParticleRuns runs;
        std::uint64_t id = block.begin;
        const std::uint64_t off_lattice_begin = off_lattice_.size();
        for (const ParticleRun& r : block.runs)
        {
            for (std::uint32_t i = 0; i < r.count; ++i, ++id)
            {
                const float density = density_in_run(all_, block, r, i, id, rhop0);
                if (block.type == ParticleType::Fluid && !all_.rhop.empty())
                    rhop_.insert(rhop_.end(), doubles ? 2 : 1, density);
                if (r.is_off_lattice)
                    add(r.off_lattice_begin() + i, doubles, density);
                else if (doubles)
                    add_pair(place_in_run(all_, block, r, i), density);
            }
            if (doubles) continue;
            runs.push_back(r);
            if (r.is_off_lattice) runs.back().set_off_lattice_begin(off_lattice_.size() - r.count);
        }
        if (doubles) add_runs(runs, off_lattice_begin);
        block.runs = std::move(runs);
        block.begin = np_;
        if (doubles) block.count *= 2;
        np_ += block.count;
    }

    void finish()
    {
        all_.off_lattice = std::move(off_lattice_);
        if (!all_.rhop.empty()) all_.rhop = std::move(rhop_);
        all_.np = np_;
        all_.n_fixed = all_.n_moving = all_.n_floating = all_.n_fluid = 0;
        for (const ParticleBlock& block : all_.blocks)
        {
            if (block.type == ParticleType::Fixed) all_.n_fixed += block.count;
            if (block.type == ParticleType::Moving) all_.n_moving += block.count;
            if (block.type == ParticleType::Floating) all_.n_floating += block.count;
            if (block.type == ParticleType::Fluid) all_.n_fluid += block.count;
        }
    }

private:
    void add(const Vec3& position, float density)
    {
        off_lattice_.positions.push_back(position);
        off_lattice_.kinds.push_back(FitKind::Volume);
        off_lattice_.normals.push_back({});
        off_lattice_.distances.push_back(distance_of_nodes);
        off_lattice_.layers.push_back(0);
        off_lattice_.rhop.push_back(density);
    }

    void add_pair(const Vec3& position, float density)
    {
        const Vec3 first = position - shift_;
        add(first, density);
        add(first + 2 * shift_, density);
    }

    void add(std::uint64_t from, bool doubles, float density)
    {
        const OffLatticeParticles& old = all_.off_lattice;
        if (doubles)
            add_pair(old.positions[from], density);
        else
            add(old.positions[from], density);
        for (std::size_t i = off_lattice_.size() - (doubles ? 2 : 1); i < off_lattice_.size(); ++i)
        {
            off_lattice_.kinds[i] = old.kinds[from];
            off_lattice_.normals[i] = old.normals[from];
            off_lattice_.distances[i] = old.distances[from];
            off_lattice_.layers[i] = old.layers[from];
        }
    }

    void add_runs(ParticleRuns& runs, std::uint64_t begin) const
    {
        while (begin < off_lattice_.size())
        {
            const auto count = static_cast<std::uint32_t>(
                std::min<std::uint64_t>(off_lattice_.size() - begin, 1U << 30U));
            runs.push_back(ParticleRun::of_off_lattice(begin, count));
            begin += count;
        }
    }

public:
    float rhop0 = 0; ///< of particles that are no fluid

private:
    CaseParticles& all_;
    Vec3 shift_;
    std::uint64_t np_ = 0;
    OffLatticeParticles off_lattice_;
    std::vector<float> rhop_;
};

} // namespace

bool double_particles(const CaseDef& def, CaseParticles& particles)
{
    const ConstantsDef& constants = def.constants;
    const auto doubles = [&](const ParticleBlock& block)
    {
        return (block.type == ParticleType::Fluid ? constants.lattice_fluid
                                                  : constants.lattice_bound) != 1;
    };
    if (std::none_of(particles.blocks.begin(), particles.blocks.end(), doubles)) return false;
    if (particles.np * 2 > most_particles)
        throw CaseError(
            def.file, 0,
            fmt::format(
                "<lattice> makes two particles of one, which are more than the file format "
                "holds ({}); dp={:g} and larger ones fit",
                most_particles_text,
                dp_that_fits(def.grid.dp, 2 * static_cast<double>(particles.np), def.grid.is_2d)));
    Doubler doubler(particles);
    doubler.rhop0 = static_cast<float>(constants.rhop0);
    for (ParticleBlock& block : particles.blocks) doubler.take(block, doubles(block));
    doubler.finish();
    return true;
}

} // namespace fppg
