#pragma once

#include "files/particle_source.h"
#include "fppg/vec.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// Cells and slabs that both files share.
struct CompareFrame
{
    static constexpr double cell_dp = 1.3;
    /// Of a slab on both sides, dp: four rounds of pairs, each of which looks 2 dp far, and the
    /// partner of a particle at the border.
    static constexpr double halo_dp = 9.05;

    Vec3 origin; ///< least coordinates of both files
    double dp = 0;
    double cell = 0; ///< metres
    int axis = 0;    ///< slabs lie across it

    std::uint64_t cell_of(const Vec3& p, int along) const
    {
        return static_cast<std::uint64_t>((p[along] - origin[along]) / cell);
    }
};

/// throws CompareError if the particles reach over more cells than can be counted
CompareFrame frame_around(const Box3& bounds, double dp);

/// Whether particles are those of a two-dimensional case.
inline bool is_in_plane(const Box3& bounds, double dp)
{
    return !bounds.is_empty() && bounds.max.y - bounds.min.y <= 1e-6 * dp;
}

/// A file cut into stretches, with the box of each: what a slab needs is read without the rest.
class FileIndex
{
public:
    static constexpr std::size_t particles_per_block = 32768;

    /// throws  CompareError for a particle that is not at a finite place; as ParticleSource::mk()
    FileIndex(const ParticleSource& source, int threads);

    const ParticleSource& source() const { return *source_; }
    const std::vector<Box3>& boxes() const { return boxes_; }
    const Box3& bounds() const { return bounds_; }
    /// Size 65536: particles of each mk, and the type of one of them (-1: none is known).
    const std::vector<std::uint64_t>& counts() const { return counts_; }
    const std::vector<int>& types() const { return types_; }

private:
    const ParticleSource* source_;
    std::vector<Box3> boxes_;
    Box3 bounds_;
    std::vector<std::uint64_t> counts_;
    std::vector<int> types_;
};

/// Cells [begin, end) along the frame's axis.
struct Slab
{
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
};

/// Cuts space into slabs that hold at most `most` particles of both files with their halo, where
/// slabs of one layer can.
std::vector<Slab> plan_slabs(const CompareFrame& frame, const FileIndex& a, const FileIndex& b,
                             std::uint64_t most, int threads);

struct SlabParticle
{
    Vec3 position;
    std::uint32_t index = 0;  ///< in the file
    std::uint32_t cell_z = 0; ///< of the frame
    std::uint16_t mk = 0;
    bool is_core = false; ///< of the slab, not of its halo
};

/// Particles sorted by column (cells over one another), then by cell, then as in the file.
class CellGrid
{
public:
    struct Column
    {
        std::uint32_t x = 0;
        std::uint32_t y = 0;
        std::uint32_t begin = 0; ///< into particles()
    };

    /// The particles of a slab and of its halo.
    CellGrid(const CompareFrame& frame, const FileIndex& file, const Slab& slab, int threads);

    const std::vector<SlabParticle>& particles() const { return particles_; }
    std::size_t columns() const { return columns_.size() - 1; }
    const Column& column(std::size_t c) const { return columns_[c]; }
    std::uint32_t end_of(std::size_t c) const { return columns_[c + 1].begin; }

    struct Stretch
    {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };
    static constexpr std::size_t most_stretches = 25;

    /// For every particle i of a column calls visit(i, stretches, n): the particles of `other` in
    /// the cells up to `reach` (1 or 2) cells from its own, in an order that depends on nothing
    /// but the cells.
    template <typename Visit>
    void for_each_in_column(std::size_t c, const CellGrid& other, std::uint32_t reach,
                            const Visit& visit) const
    {
        Stretch windows[most_stretches]; // what is above the lowest cell in reach
        Stretch found[most_stretches];
        std::size_t n = 0;
        const Column& home = columns_[c];
        const std::uint32_t y_begin = home.y - std::min(home.y, reach);
        for (std::uint32_t x = home.x - std::min(home.x, reach); x <= home.x + reach; ++x)
            for (std::size_t o = other.first_column(x, y_begin); o < other.columns(); ++o)
            {
                const Column& column = other.column(o);
                if (column.x != x || column.y > home.y + reach) break;
                windows[n++] = {column.begin, other.end_of(o)};
            }
        std::uint32_t last_z = UINT32_MAX;
        for (std::uint32_t i = home.begin; i < end_of(c); ++i)
        {
            const std::uint32_t z = particles_[i].cell_z;
            for (std::size_t w = 0; w < n && z != last_z; ++w)
            {
                Stretch& window = windows[w];
                while (window.begin < window.end &&
                       other.particles_[window.begin].cell_z + reach < z)
                    ++window.begin;
                std::uint32_t end = std::max(found[w].end, window.begin);
                if (last_z == UINT32_MAX) end = window.begin;
                while (end < window.end && other.particles_[end].cell_z <= z + reach) ++end;
                found[w] = {window.begin, end};
            }
            last_z = z;
            visit(i, found, n);
        }
    }

private:
    std::vector<SlabParticle> particles_;
    std::vector<Column> columns_; ///< by x, y; one more as the end

    std::size_t first_column(std::uint32_t x, std::uint32_t y) const
    {
        const auto less =
            [](const Column& column, const std::pair<std::uint32_t, std::uint32_t>& at)
        { return column.x != at.first ? column.x < at.first : column.y < at.second; };
        return static_cast<std::size_t>(
            std::lower_bound(columns_.begin(), columns_.end() - 1, std::pair(x, y), less) -
            columns_.begin());
    }
};

} // namespace fppg
