#include "balance/take_places.h"

namespace fppg
{
namespace
{

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

void take_places(CaseParticles& particles, const std::vector<NewPlace>& places)
{
    PlaceTaker(particles, places).run();
}

} // namespace fppg
