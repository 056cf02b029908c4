#include "particles/off_lattice_particles.h"

#include "core/parallel.h"
#include "core/parallel_sort.h"
#include "particles/wall_surfaces.h"

#include <algorithm>

namespace fppg
{
namespace
{

/// `source` counts the particles of walls, then those of the volume.
struct Entry
{
    PositionOrder::Key key;
    std::uint32_t source = 0;

    bool operator<(const Entry& other) const
    {
        return key < other.key || (!(other.key < key) && source < other.source);
    }
};

/// Takes runs and single particles off the lattice in id order.
class RunList
{
public:
    explicit RunList(const ParticleBlock& block)
        : is_fluid_(block.type == ParticleType::Fluid), is_descending_(block.run_descending)
    {
    }

    /// The nodes [from, to) of a run.
    void add_nodes(const ParticleRun& run, std::uint32_t from, std::uint32_t to)
    {
        ParticleRun part = run;
        part.z = is_descending_ ? run.z - from : run.z + from;
        part.count = to - from;
        if (is_fluid_) part.depth += is_descending_ ? from : run.count - to;
        runs_.push_back(part);
    }
    void add_off_lattice(std::uint64_t index)
    {
        if (!runs_.empty() && runs_.back().is_off_lattice)
            ++runs_.back().count;
        else
            runs_.push_back(ParticleRun::of_off_lattice(index, 1));
    }
    ParticleRuns take() { return std::move(runs_); }

private:
    bool is_fluid_;
    bool is_descending_;
    ParticleRuns runs_;
};

/// Puts the densities of a fluid block's nodes, which stand together at its begin, to their places
/// among those off the lattice.
void spread_densities(CaseParticles& particles, const ParticleBlock& block)
{
    const std::uint64_t first = block.begin - (particles.np - particles.n_fluid);
    const auto begin = particles.rhop.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<float> old(begin, begin + static_cast<std::ptrdiff_t>(block.count));
    auto from = old.begin();
    auto to = begin;
    for (const ParticleRun& run : block.runs)
    {
        if (run.is_off_lattice)
            to = std::copy_n(particles.off_lattice.rhop.begin() +
                                 static_cast<std::ptrdiff_t>(run.off_lattice_begin()),
                             run.count, to);
        else
        {
            to = std::copy_n(from, run.count, to);
            from += run.count;
        }
    }
}

} // namespace

std::vector<std::uint64_t> count_off_lattice_particles(const FittedWalls& walls)
{
    std::vector<std::uint64_t> count(65536, 0);
    for (const std::uint16_t mk : walls.particles.mk) ++count[mk];
    for (const std::uint16_t mk : walls.volume.mk) ++count[mk];
    return count;
}

OffLatticeParticles sort_off_lattice_particles(const FittedWalls& walls,
                                               const std::vector<ParticleBlock>& blocks,
                                               const std::vector<PositionOrder>& orders,
                                               int threads, std::vector<std::uint64_t>& begin)
{
    const std::size_t of_walls = walls.particles.size();
    const std::size_t n = of_walls + walls.volume.size();
    const auto position = [&](std::size_t i) -> const Vec3&
    { return i < of_walls ? walls.particles.positions[i] : walls.volume.positions[i - of_walls]; };

    const std::vector<std::uint64_t> count = count_off_lattice_particles(walls);
    std::vector<std::vector<Entry>> entries(blocks.size());
    std::vector<std::size_t> block_of_mk(65536, 0);
    begin.assign(blocks.size() + 1, 0);
    for (std::size_t b = 0; b < blocks.size(); ++b)
    {
        block_of_mk[blocks[b].mk] = b;
        entries[b].reserve(count[blocks[b].mk]);
        begin[b + 1] = begin[b] + count[blocks[b].mk];
    }
    for (std::size_t i = 0; i < n; ++i)
    {
        const std::uint16_t mk =
            i < of_walls ? walls.particles.mk[i] : walls.volume.mk[i - of_walls];
        const std::size_t b = block_of_mk[mk];
        entries[b].push_back({orders[b].key(position(i)), static_cast<std::uint32_t>(i)});
    }

    OffLatticeParticles out;
    out.positions.resize(n);
    out.kinds.resize(n);
    out.normals.resize(n);
    out.distances.resize(n);
    out.layers.assign(n, 0);
    out.rhop.resize(n);
    out.shares.assign(n, 1);
    const WallSurfaces surfaces(walls);
    for (std::size_t b = 0; b < blocks.size(); ++b)
    {
        parallel_sort(entries[b], threads, std::less<Entry>());
        parallel_for(
            entries[b].size(), threads,
            [&](std::size_t i)
            {
                const std::size_t source = entries[b][i].source;
                const std::size_t at = begin[b] + i;
                out.positions[at] = position(source);
                if (source < of_walls)
                {
                    const SurfacePlace place = surfaces.at(source);
                    out.kinds[at] = walls.particles.kinds[source];
                    out.normals[at] = place.normal;
                    out.distances[at] = place.distance;
                    const std::uint32_t of = walls.particles.bodies[source];
                    const FittedBody& body = walls.bodies[of];
                    out.layers[at] = static_cast<std::uint8_t>(body.layer + 1);
                    out.shares[at] = static_cast<float>(
                        body.is_layer() ? walls.owner_of(of).layer_share : body.share);
                }
                else
                {
                    out.kinds[at] = FitKind::Volume;
                    out.distances[at] = walls.volume.distances[source - of_walls];
                }
            },
            4096);
        entries[b] = {};
    }
    return out;
}

namespace
{

/// The first of nodes [low, high) that comes behind a particle; `high` if none does.
template <typename KeyOfNode>
std::uint32_t first_behind(const PositionOrder::Key& particle, const KeyOfNode& node,
                           std::uint32_t low, std::uint32_t high)
{
    if (!(particle < node(high - 1))) return high;
    while (low < high)
    {
        const std::uint32_t middle = low + (high - low) / 2;
        if (particle < node(middle))
            high = middle;
        else
            low = middle + 1;
    }
    return high;
}

} // namespace

void merge_off_lattice_particles(CaseParticles& particles, ParticleBlock& block,
                                 const PositionOrder& order, std::uint64_t begin, std::uint64_t end)
{
    if (begin == end) return;
    const LatticeGrid& grid = particles.grid;
    const std::vector<Vec3>& positions = particles.off_lattice.positions;
    RunList merged(block);
    std::uint64_t next = begin;
    for (const ParticleRun& run : block.runs)
    {
        const double x = grid.origin.x + run.x * grid.step(0);
        const double y = grid.origin.y + run.y * grid.step(1);
        const auto node = [&](std::uint32_t i)
        {
            const std::uint32_t z = block.run_descending ? run.z - i : run.z + i;
            return order.key({x, y, grid.origin.z + z * grid.step(2)});
        };
        for (std::uint32_t done = 0; done < run.count;)
        {
            const PositionOrder::Key first = node(done);
            while (next < end && order.key(positions[next]) < first) merged.add_off_lattice(next++);
            const std::uint32_t before =
                next < end ? first_behind(order.key(positions[next]), node, done + 1, run.count)
                           : run.count;
            merged.add_nodes(run, done, before);
            done = before;
        }
    }
    while (next < end) merged.add_off_lattice(next++);
    block.runs = merged.take();
    if (block.type == ParticleType::Fluid && !particles.rhop.empty())
        spread_densities(particles, block);
}

} // namespace fppg
