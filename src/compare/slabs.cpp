#include "compare/slabs.h"

#include "core/parallel.h"
#include "core/parallel_sort.h"
#include "fppg/compare.h"

#include <fmt/format.h>
#include <algorithm>
#include <mutex>

namespace fppg
{

namespace
{

constexpr std::uint64_t most_layers = std::uint64_t{1} << 20;

/// After this many blocks the pages of the file are given back, so that memory does not grow with
/// it.
constexpr std::size_t blocks_held = 32;

/// Calls body(begin, end, block) for all blocks of a file.
template <typename Body>
void for_each_block(const ParticleSource& source, int threads, const Body& body)
{
    constexpr std::size_t size = FileIndex::particles_per_block;
    const std::size_t n = source.size();
    parallel_for((n + size - 1) / size, threads,
                 [&](std::size_t block)
                 {
                     body(block * size, std::min(n, (block + 1) * size), block);
                     if (block % blocks_held == blocks_held - 1) source.release();
                 });
}

} // namespace

CompareFrame frame_around(const Box3& bounds, double dp)
{
    CompareFrame frame;
    frame.dp = dp;
    frame.cell = CompareFrame::cell_dp * dp;
    if (bounds.is_empty()) return frame;
    frame.origin = bounds.min;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double extent = bounds.max[axis] - bounds.min[axis];
        if (!(extent / frame.cell < 4e9))
            throw CompareError(
                fmt::format("they reach over {:g} m, more than 4e9 cells of 1.3 dp", extent));
        // Files are in the order of x, so slabs across it are read fastest.
        const double longest = bounds.max[frame.axis] - bounds.min[frame.axis];
        if (extent > (frame.axis == 0 ? 2 : 1) * longest) frame.axis = axis;
    }
    return frame;
}

FileIndex::FileIndex(const ParticleSource& source, int threads)
    : source_(&source),
      boxes_((source.size() + particles_per_block - 1) / particles_per_block),
      counts_(65536),
      types_(65536, -1)
{
    std::mutex guard;
    for_each_block(
        source, threads,
        [&](std::size_t begin, std::size_t end, std::size_t block)
        {
            struct OfMk
            {
                std::uint16_t mk;
                std::uint64_t count;
                int type;
            };
            std::vector<OfMk> found;
            std::size_t last = 0;
            for (std::size_t i = begin; i < end; ++i)
            {
                const Vec3 p = source.position(i);
                if (!is_finite(p))
                    throw CompareError(
                        fmt::format("cannot compare '{}': particle {} is at ({}, {}, {})",
                                    source.path(), source.id(i), p.x, p.y, p.z));
                boxes_[block].add(p);
                const std::uint16_t mk = source.mk(i);
                const int type = source.has_types() ? source.type(i) : -1;
                if (last >= found.size() || found[last].mk != mk || found[last].type != type)
                {
                    last = 0;
                    while (last < found.size() &&
                           (found[last].mk != mk || found[last].type != type))
                        ++last;
                    if (last == found.size()) found.push_back({mk, 0, type});
                }
                ++found[last].count;
            }
            const std::lock_guard lock(guard);
            for (const OfMk& of : found)
            {
                counts_[of.mk] += of.count;
                types_[of.mk] = std::max(types_[of.mk], of.type);
            }
        });
    for (const Box3& box : boxes_)
        if (!box.is_empty())
        {
            bounds_.add(box.min);
            bounds_.add(box.max);
        }
}

std::vector<Slab> plan_slabs(const CompareFrame& frame, const FileIndex& a, const FileIndex& b,
                             std::uint64_t most, int threads)
{
    std::uint64_t cells = 0;
    for (const FileIndex* file : {&a, &b})
        if (!file->bounds().is_empty())
            cells = std::max(cells, frame.cell_of(file->bounds().max, frame.axis) + 1);
    const std::uint64_t total = a.source().size() + b.source().size();
    if (total == 0) return {};
    if (total <= most) return {{0, cells}};

    std::uint64_t thickness = 1; // of a layer, in cells
    while ((cells + thickness - 1) / thickness > most_layers) thickness *= 2;
    const std::size_t layers = (cells + thickness - 1) / thickness;
    std::vector<std::uint64_t> sums(layers + 1); // first counts, then those of all before
    std::mutex guard;
    for (const FileIndex* file : {&a, &b})
        for_each_block(
            file->source(), threads,
            [&](std::size_t begin, std::size_t end, std::size_t block)
            {
                const Box3& box = file->boxes()[block];
                const std::uint64_t first = frame.cell_of(box.min, frame.axis) / thickness;
                const std::uint64_t last = frame.cell_of(box.max, frame.axis) / thickness;
                std::vector<std::uint64_t> counts(last - first + 1);
                for (std::size_t i = begin; i < end; ++i)
                    ++counts[frame.cell_of(file->source().position(i), frame.axis) / thickness -
                             first];
                const std::lock_guard lock(guard);
                for (std::size_t l = 0; l < counts.size(); ++l) sums[first + l + 1] += counts[l];
            });
    for (std::size_t l = 0; l < layers; ++l) sums[l + 1] += sums[l];

    const auto halo_cells =
        static_cast<std::uint64_t>(CompareFrame::halo_dp / CompareFrame::cell_dp) + 1;
    const std::size_t halo = (halo_cells + thickness - 1) / thickness;
    const auto held = [&](std::size_t begin, std::size_t end)
    { return sums[std::min(end + halo, layers)] - sums[begin - std::min(begin, halo)]; };
    std::vector<Slab> slabs;
    for (std::size_t begin = 0; begin < layers;)
    {
        std::size_t end = begin + 1;
        while (end < layers && held(begin, end + 1) <= most) ++end;
        if (sums[end] > sums[begin])
            slabs.push_back({begin * thickness, std::min(end * thickness, cells)});
        begin = end;
    }
    return slabs;
}

CellGrid::CellGrid(const CompareFrame& frame, const FileIndex& file, const Slab& slab, int threads)
{
    const ParticleSource& source = file.source();
    const int axis = frame.axis;
    const double halo = CompareFrame::halo_dp * frame.dp;
    const double low = frame.origin[axis] + static_cast<double>(slab.begin) * frame.cell - halo;
    const double high = frame.origin[axis] + static_cast<double>(slab.end) * frame.cell + halo;
    const auto is_in = [&](const Vec3& p) { return p[axis] >= low && p[axis] <= high; };
    std::vector<std::uint32_t> blocks;
    for (std::size_t block = 0; block < file.boxes().size(); ++block)
        if (file.boxes()[block].max[axis] >= low && file.boxes()[block].min[axis] <= high)
            blocks.push_back(static_cast<std::uint32_t>(block));
    const auto for_each_particle = [&](std::size_t which, const auto& body)
    {
        const std::size_t begin = blocks[which] * FileIndex::particles_per_block;
        const std::size_t end = std::min(source.size(), begin + FileIndex::particles_per_block);
        for (std::size_t i = begin; i < end; ++i)
        {
            const Vec3 p = source.position(i);
            if (is_in(p)) body(i, p);
        }
        if (which % blocks_held == blocks_held - 1) source.release();
    };
    source.release();
    std::vector<std::size_t> starts(blocks.size() + 1);
    parallel_for(
        blocks.size(), threads,
        [&](std::size_t which)
        { for_each_particle(which, [&](std::size_t, const Vec3&) { ++starts[which + 1]; }); });
    for (std::size_t which = 0; which < blocks.size(); ++which) starts[which + 1] += starts[which];

    struct Entry
    {
        std::uint32_t x, y, z;
        std::uint32_t index;
    };
    std::vector<Entry> entries(starts.back());
    parallel_for(blocks.size(), threads,
                 [&](std::size_t which)
                 {
                     std::size_t to = starts[which];
                     for_each_particle(which,
                                       [&](std::size_t i, const Vec3& p)
                                       {
                                           entries[to++] = {
                                               static_cast<std::uint32_t>(frame.cell_of(p, 0)),
                                               static_cast<std::uint32_t>(frame.cell_of(p, 1)),
                                               static_cast<std::uint32_t>(frame.cell_of(p, 2)),
                                               static_cast<std::uint32_t>(i)};
                                       });
                 });
    parallel_sort(entries, threads,
                  [](const Entry& a, const Entry& b)
                  {
                      if (a.x != b.x) return a.x < b.x;
                      if (a.y != b.y) return a.y < b.y;
                      return a.z != b.z ? a.z < b.z : a.index < b.index;
                  });
    particles_.resize(entries.size());
    parallel_for(
        entries.size(), threads,
        [&](std::size_t e)
        {
            SlabParticle& to = particles_[e];
            to.index = entries[e].index;
            to.position = source.position(to.index);
            to.cell_z = entries[e].z;
            to.mk = source.mk(to.index);
            const std::uint64_t layer = frame.cell_of(to.position, axis);
            to.is_core = layer >= slab.begin && layer < slab.end;
        },
        4096);
    for (std::size_t e = 0; e < entries.size(); ++e)
        if (e == 0 || entries[e].x != entries[e - 1].x || entries[e].y != entries[e - 1].y)
            columns_.push_back({entries[e].x, entries[e].y, static_cast<std::uint32_t>(e)});
    columns_.push_back({UINT32_MAX, UINT32_MAX, static_cast<std::uint32_t>(entries.size())});
}

} // namespace fppg
