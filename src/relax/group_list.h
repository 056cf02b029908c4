#pragma once

#include "core/parallel.h"
#include "relax/cell_rows.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fppg
{

/// As many as go into a register (core/lanes.h).
inline constexpr std::size_t points_per_group = 8;

/// Up to eight points that lie together, and all that are within reach of one of them.
struct PointGroup
{
    std::array<std::uint32_t, points_per_group> points{}; ///< filled up with the first
    std::size_t count = 0;
    std::span<const std::uint32_t> near; ///< the points themselves too
};

/// Active points by eights, each eight with one list. A pair then costs no gathering: eight points
/// stay in registers, and one neighbour after the other is compared with all of them. Of the pairs
/// half are too far apart, but each takes half of the time that it takes out of NeighbourList;
/// lists have a fifth of the entries. Fastest, and groups are compact, when the points are stored
/// along a Morton curve over cells of about two spacings.
class GroupList
{
public:
    /// radius, skin  in the unit of the points; their sum above 0
    GroupList(float radius, float skin) : reach_(radius + skin), skin_(skin) {}

    /// Makes the groups and their lists anew.
    ///
    /// is_active(i)  whether point i is in a group; called from several threads, as counts is
    /// counts(j)     whether j may be in lists
    template <typename IsActive, typename Counts>
    void build(const PointArrays& points, int threads, const IsActive& is_active,
               const Counts& counts)
    {
        rows_.sort(points, reach_, threads);
        chunks_.resize((rows_.cells() + cells_per_chunk - 1) / cells_per_chunk);
        parallel_for(chunks_.size(), threads,
                     [&](std::size_t c) { fill_chunk(c, is_active, counts); });
        rows_.forget_cells();
    }

    /// Whether a point has moved by half the skin since build(), or their number has changed.
    bool is_outdated(const PointArrays& points, int threads) const
    {
        return rows_.has_moved(points, 0.5f * skin_, threads);
    }

    /// Calls visit(group) for all groups, spread over threads.
    template <typename Visit>
    void for_each_group(int threads, const Visit& visit) const
    {
        parallel_for(chunks_.size(), threads,
                     [&](std::size_t c)
                     {
                         std::size_t begin = 0;
                         for (const Entry& entry : chunks_[c].groups)
                         {
                             visit(PointGroup{entry.points,
                                              entry.count,
                                              {chunks_[c].near.data() + begin, entry.end - begin}});
                             begin = entry.end;
                         }
                     });
    }

private:
    static constexpr std::size_t cells_per_chunk = 16;

    struct Entry
    {
        std::array<std::uint32_t, points_per_group> points{};
        std::uint32_t count = 0;
        std::uint32_t end = 0; ///< of its list
    };
    struct Chunk
    {
        std::vector<Entry> groups;
        std::vector<std::uint32_t> near;
    };

    template <typename IsActive, typename Counts>
    void fill_chunk(std::size_t c, const IsActive& is_active, const Counts& counts)
    {
        CellRows::Scratch& scratch = CellRows::scratch_of_thread();
        Chunk& chunk = chunks_[c];
        chunk.groups.clear();
        scratch.list.clear();
        const std::size_t end = std::min((c + 1) * cells_per_chunk, rows_.cells());
        for (std::size_t cell = c * cells_per_chunk; cell < end; ++cell)
        {
            std::vector<std::uint32_t>& active = active_of_thread();
            active.clear();
            for (std::size_t row = rows_.cell_begin(cell); row < rows_.cell_begin(cell + 1); ++row)
                if (is_active(rows_.point(row))) active.push_back(static_cast<std::uint32_t>(row));
            if (active.empty()) continue;
            rows_.gather(cell, scratch);
            for (std::size_t begin = 0; begin < active.size(); begin += points_per_group)
                add_group(
                    {active.data() + begin, std::min(points_per_group, active.size() - begin)},
                    counts, chunk, scratch);
        }
        chunk.near.assign(scratch.list.begin(), scratch.list.end());
    }

    template <typename Counts>
    void add_group(std::span<const std::uint32_t> rows, const Counts& counts, Chunk& chunk,
                   CellRows::Scratch& scratch) const
    {
        rows_.find_near_any(rows, reach_, scratch);
        for (const std::uint32_t place : scratch.found)
            if (counts(scratch.indices[place])) scratch.list.push_back(scratch.indices[place]);
        Entry entry;
        for (std::size_t l = 0; l < points_per_group; ++l)
            entry.points[l] = rows_.point(rows[l < rows.size() ? l : 0]);
        entry.count = static_cast<std::uint32_t>(rows.size());
        entry.end = static_cast<std::uint32_t>(scratch.list.size());
        chunk.groups.push_back(entry);
    }

    static std::vector<std::uint32_t>& active_of_thread()
    {
        thread_local std::vector<std::uint32_t> active;
        return active;
    }

    float reach_;
    float skin_;
    CellRows rows_;
    std::vector<Chunk> chunks_;
};

} // namespace fppg
