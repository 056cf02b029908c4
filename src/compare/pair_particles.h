#pragma once

#include "compare/slabs.h"

#include <cstdint>
#include <vector>

namespace fppg
{

inline constexpr std::uint32_t no_partner = UINT32_MAX;

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
Partners pair_particles(const CellGrid& a, const FileIndex& file_a, const CellGrid& b,
                        const FileIndex& file_b, double same_place, double reach, int threads);

} // namespace fppg
