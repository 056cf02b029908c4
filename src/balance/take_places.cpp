#include "balance/take_places.h"

#include "core/parallel_sort.h"
#include "particles/initials.h"

namespace fppg
{
namespace
{

struct NewPlace
{
    std::uint64_t id = 0;
    Vec3 position;
    float rhop = 0;
};

/// Rebuilds the particles off the lattice and the runs of all blocks, in the order of ids.
class PlaceTaker
{
public:
    PlaceTaker(CaseParticles& all, const std::vector<NewPlace>& places)
        : all_(all), places_(places), fluid_begin_(all.np - all.n_fluid)
    {
    }

    void run()
    {
        for (ParticleBlock& block : all_.blocks)
        {
            ParticleRuns runs;
            std::uint64_t id = block.begin;
            for (const ParticleRun& run : block.runs)
            {
                if (run.is_off_lattice)
                    copy_off_lattice(run, id, runs);
                else
                    cut_up(block, run, id, runs);
                id += run.count;
            }
            block.runs = std::move(runs);
        }
        all_.off_lattice = std::move(out_);
    }

private:
    bool is_next(std::uint64_t id) const
    {
        return next_ < places_.size() && places_[next_].id == id;
    }
    void set_density(const NewPlace& place)
    {
        out_.rhop.back() = place.rhop;
        if (!all_.rhop.empty()) all_.rhop[place.id - fluid_begin_] = place.rhop;
    }

    void copy_off_lattice(const ParticleRun& run, std::uint64_t id, ParticleRuns& runs)
    {
        const OffLatticeParticles& old = all_.off_lattice;
        runs.push_back(ParticleRun::of_off_lattice(out_.size(), run.count));
        for (std::uint32_t k = 0; k < run.count; ++k)
        {
            const std::size_t from = run.off_lattice_begin() + k;
            out_.positions.push_back(old.positions[from]);
            out_.kinds.push_back(old.kinds[from]);
            out_.normals.push_back(old.normals[from]);
            out_.distances.push_back(old.distances[from]);
            out_.rhop.push_back(old.rhop[from]);
            if (!old.layers.empty()) out_.layers.push_back(old.layers[from]);
            if (!old.shares.empty()) out_.shares.push_back(old.shares[from]);
            if (!is_next(id + k)) continue;
            out_.positions.back() = places_[next_].position;
            set_density(places_[next_++]);
        }
    }

    /// The nodes of a run, and between them the particles that leave it.
    void cut_up(const ParticleBlock& block, const ParticleRun& run, std::uint64_t id,
                ParticleRuns& runs)
    {
        std::uint32_t begin = 0;
        const auto keep_nodes = [&](std::uint32_t end)
        {
            if (end == begin) return;
            ParticleRun nodes = run;
            nodes.count = end - begin;
            nodes.z = block.run_descending ? run.z - begin : run.z + begin;
            nodes.depth = run.depth + (block.run_descending ? begin : run.count - end);
            runs.push_back(nodes);
        };
        while (next_ < places_.size() && places_[next_].id < id + run.count)
        {
            const auto k = static_cast<std::uint32_t>(places_[next_].id - id);
            keep_nodes(k);
            std::uint32_t count = 0;
            const std::size_t first = out_.size();
            while (k + count < run.count && is_next(id + k + count))
            {
                add(places_[next_++]);
                ++count;
            }
            runs.push_back(ParticleRun::of_off_lattice(first, count));
            begin = k + count;
        }
        keep_nodes(run.count);
    }

    void add(const NewPlace& place)
    {
        const OffLatticeParticles& old = all_.off_lattice;
        out_.positions.push_back(place.position);
        out_.kinds.push_back(FitKind::Volume);
        out_.normals.push_back({});
        out_.distances.push_back(distance_of_nodes);
        out_.rhop.push_back(place.rhop);
        if (!old.layers.empty()) out_.layers.push_back(0);
        if (!old.shares.empty()) out_.shares.push_back(1);
        set_density(place);
    }

    CaseParticles& all_;
    const std::vector<NewPlace>& places_;
    std::uint64_t fluid_begin_;
    OffLatticeParticles out_;
    std::size_t next_ = 0;
};

} // namespace

void take_over(const CaseDef& def, const FluidAtRest& rest, int threads, CaseParticles& particles)
{
    std::vector<NewPlace> places;
    particles.bound_rhop.assign(particles.np - particles.n_fluid, static_cast<float>(rest.rhop0));
    bool is_at_limit = false;
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
        if (rest.roles[i] == RestRole::Bound)
            particles.bound_rhop[rest.ids[i]] = static_cast<float>(rest.densities[i]);
        if (!rest.moves(i)) continue;
        places.push_back({rest.ids[i], rest.positions[i], static_cast<float>(rest.densities[i])});
        for (int axis = 0; axis < 3; ++axis)
            is_at_limit = is_at_limit ||
                          rest.positions[i][axis] < particles.pos_min[axis] + 1.5 * rest.dp ||
                          rest.positions[i][axis] > particles.pos_max[axis] - 1.5 * rest.dp;
    }
    parallel_sort(places, threads,
                  [](const NewPlace& a, const NewPlace& b) { return a.id < b.id; });
    PlaceTaker(particles, places).run();
    const bool is_periodic = std::any_of(def.grid.is_periodic.begin(), def.grid.is_periodic.end(),
                                         [](bool is) { return is; });
    if (is_at_limit && !is_periodic) set_limits(def, particles);
}

} // namespace fppg
