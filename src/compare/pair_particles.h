#pragma once

#include "compare/slabs.h"

#include <cstdint>
#include <vector>

namespace fppg
{

inline constexpr std::uint32_t no_partner = UINT32_MAX;

/// Particles of a file, of one slab, sorted into cells.
struct GridOfFile
{
    const CellGrid& grid;
    const FileIndex& file;
};

/// Places in the grid of the other file, or no_partner.
struct Partners
{
    std::vector<std::uint32_t> of_a;
    std::vector<std::uint32_t> of_b;
};

/// Pairs as compare_results() describes them. Right for the particles of the slab; those of its
/// halo lack neighbours.
///
/// same_place  metres
/// reach       metres, how far a particle may have moved; at most a cell
Partners pair_particles(const GridOfFile& a, const GridOfFile& b, double same_place, double reach,
                        int threads);

} // namespace fppg
