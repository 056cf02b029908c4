#include "particles/off_lattice_particles.h"

#include "core/parallel.h"
#include "core/row_lists.h"
#include "particles/wall_surfaces.h"

#include <algorithm>
#include <limits>

namespace fppg
{
namespace
{

/// The particles of walls, then those of the volume, sorted by blocks and in each by its order;
/// equal ones as they come. They go into buckets by the slowest coordinate first, so that what is
/// sorted at once is small.
class SortedSources
{
public:
    SortedSources(const FittedWalls& walls, const std::vector<ParticleBlock>& blocks,
                  const std::vector<PositionOrder>& orders, int threads)
        : walls_(walls),
          orders_(orders),
          threads_(threads),
          of_walls_(walls.particles.size()),
          block_of_mk_(65536, 0),
          ranges_(blocks.size())
    {
        for (std::size_t b = 0; b < blocks.size(); ++b) block_of_mk_[blocks[b].mk] = b;
        measure();
    }

    /// Indices of the particles.
    std::vector<std::uint32_t> take() const
    {
        const std::size_t n = size();
        RowLists<std::uint32_t> buckets =
            make_row_lists<std::uint32_t>(ranges_.empty() ? 0 : ranges_.back().end, n, threads_,
                                          [&](std::size_t i, const auto& add)
                                          { add(bucket_of(i), static_cast<std::uint32_t>(i)); });
        parallel_for(buckets.first.size() - 1, threads_,
                     [&](std::size_t bucket)
                     {
                         std::uint32_t* const begin = buckets.values.data() + buckets.first[bucket];
                         const std::size_t count = buckets.row(bucket).size();
                         std::vector<Entry> entries(count);
                         for (std::size_t k = 0; k < count; ++k)
                             entries[k] = {key(begin[k]), begin[k]};
                         std::sort(entries.begin(), entries.end());
                         for (std::size_t k = 0; k < count; ++k) begin[k] = entries[k].source;
                     });
        return std::move(buckets.values);
    }

private:
    struct Entry
    {
        PositionOrder::Key key;
        std::uint32_t source = 0;

        bool operator<(const Entry& other) const
        {
            return key < other.key || (!(other.key < key) && source < other.source);
        }
    };
    /// The slowest coordinates of a block's particles, and its buckets.
    struct Range
    {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        std::size_t count = 0;
        std::size_t begin = 0, end = 0;
    };
    static constexpr std::size_t in_bucket = 1024;
    static constexpr std::size_t most_buckets = std::size_t{1} << 18;

    std::size_t size() const { return of_walls_ + walls_.volume.size(); }
    std::size_t block_of(std::size_t i) const
    {
        return block_of_mk_[i < of_walls_ ? walls_.particles.mk[i]
                                          : walls_.volume.mk[i - of_walls_]];
    }
    PositionOrder::Key key(std::size_t i) const
    {
        return orders_[block_of(i)].key(i < of_walls_ ? walls_.particles.positions[i]
                                                      : walls_.volume.positions[i - of_walls_]);
    }

    void measure()
    {
        constexpr std::size_t chunk = 65536;
        std::vector<std::vector<Range>> of_chunk((size() + chunk - 1) / chunk);
        parallel_for(of_chunk.size(), threads_,
                     [&](std::size_t c)
                     {
                         of_chunk[c].resize(ranges_.size());
                         for (std::size_t i = c * chunk; i < std::min(size(), (c + 1) * chunk); ++i)
                         {
                             Range& range = of_chunk[c][block_of(i)];
                             const double first = key(i)[0];
                             range.low = std::min(range.low, first);
                             range.high = std::max(range.high, first);
                             ++range.count;
                         }
                     });
        std::size_t buckets = 0;
        for (std::size_t b = 0; b < ranges_.size(); ++b)
        {
            Range& range = ranges_[b];
            for (const std::vector<Range>& part : of_chunk)
            {
                range.low = std::min(range.low, part[b].low);
                range.high = std::max(range.high, part[b].high);
                range.count += part[b].count;
            }
            range.begin = buckets;
            buckets += std::clamp<std::size_t>(range.count / in_bucket, 1, most_buckets);
            range.end = buckets;
        }
    }

    std::size_t bucket_of(std::size_t i) const
    {
        const Range& range = ranges_[block_of(i)];
        const double length = range.high - range.low;
        if (!(length > 0)) return range.begin;
        const auto count = static_cast<double>(range.end - range.begin);
        const double share = (key(i)[0] - range.low) / length;
        return range.begin + static_cast<std::size_t>(std::min(share * count, count - 1));
    }

    const FittedWalls& walls_;
    const std::vector<PositionOrder>& orders_;
    int threads_;
    std::size_t of_walls_;
    std::vector<std::size_t> block_of_mk_;
    std::vector<Range> ranges_; ///< per block
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

namespace
{

/// One coordinate after the other: with a second copy of all places this would take more memory
/// than laying and relaxing the walls did.
///
/// order  for each place the index of what comes there
void put_in_order(const std::vector<std::uint32_t>& order, int threads, std::vector<Vec3>& places)
{
    std::vector<double> moved(places.size());
    for (int axis = 0; axis < 3; ++axis)
    {
        parallel_for(
            places.size(), threads, [&](std::size_t at) { moved[at] = places[order[at]][axis]; },
            4096);
        parallel_for(
            places.size(), threads, [&](std::size_t at) { places[at][axis] = moved[at]; }, 4096);
    }
}

} // namespace

OffLatticeParticles sort_off_lattice_particles(FittedWalls& walls,
                                               const std::vector<ParticleBlock>& blocks,
                                               const std::vector<PositionOrder>& orders,
                                               int threads, std::vector<std::uint64_t>& begin)
{
    const std::vector<std::uint64_t> count = count_off_lattice_particles(walls);
    begin.assign(blocks.size() + 1, 0);
    for (std::size_t b = 0; b < blocks.size(); ++b) begin[b + 1] = begin[b] + count[blocks[b].mk];
    const std::size_t of_walls = walls.particles.size();
    const std::size_t n = of_walls + walls.volume.size();
    const std::vector<std::uint32_t> order = SortedSources(walls, blocks, orders, threads).take();
    OffLatticeParticles out;
    out.kinds.resize(n);
    out.normals.resize(n);
    out.distances.resize(n);
    out.layers.assign(n, 0);
    const auto share_of = [&](std::size_t body)
    {
        const FittedBody& of = walls.bodies[body];
        return of.is_layer() ? walls.owner_of(body).layer_share : of.share;
    };
    bool has_shares = false;
    for (std::size_t b = 0; b < walls.bodies.size(); ++b)
        has_shares = has_shares || share_of(b) != 1;
    if (has_shares) out.shares.assign(n, 1);
    const WallSurfaces surfaces(walls);
    parallel_for(
        n, threads,
        [&](std::size_t at)
        {
            const std::size_t source = order[at];
            if (source >= of_walls)
            {
                out.kinds[at] = FitKind::Volume;
                out.distances[at] = walls.volume.distances[source - of_walls];
                return;
            }
            const SurfacePlace place = surfaces.at(source);
            const std::uint32_t body = walls.particles.bodies[source];
            out.kinds[at] = walls.particles.kinds[source];
            out.normals[at] = place.normal;
            out.distances[at] = place.distance;
            out.layers[at] = static_cast<std::uint8_t>(walls.bodies[body].layer + 1);
            if (has_shares) out.shares[at] = static_cast<float>(share_of(body));
        },
        4096);
    out.positions = std::move(walls.particles.positions);
    walls.particles = {};
    out.positions.insert(out.positions.end(), walls.volume.positions.begin(),
                         walls.volume.positions.end());
    put_in_order(order, threads, out.positions);
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
