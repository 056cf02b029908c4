#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// The order of the particles of an mk: by coordinates, slowest axis first.
class PositionOrder
{
public:
    using Key = std::array<double, 3>;

    /// By x, y, z, or as `orient` says.
    explicit PositionOrder(const MkOrient& orient = {}) : orient_(orient) {}

    Key key(const Vec3& p) const
    {
        Key key{};
        for (std::size_t i = 0; i < 3; ++i)
            key[i] = orient_.descending[i] ? -p[orient_.axes[i]] : p[orient_.axes[i]];
        return key;
    }

private:
    MkOrient orient_;
};

/// How many particles off the lattice carry each mk; size 65536.
std::vector<std::uint64_t> count_free_particles(const FittedWalls& walls);

/// Puts the particles of `walls` into the order of the blocks, with normals and distances;
/// densities are left to the caller (zero).
///
/// blocks   every mk of the walls has one
/// orders   of every block
/// returns  in `begin` where each block's particles begin, and their number as last entry
/// cost     O(n log n) time, about 100 bytes a particle at its peak
FreeParticles sort_free_particles(const FittedWalls& walls,
                                  const std::vector<ParticleBlock>& blocks,
                                  const std::vector<PositionOrder>& orders, int threads,
                                  std::vector<std::uint64_t>& begin);

/// Sorts the particles [begin, end) of particles.free in among the nodes of a block: its runs are
/// split where needed, and its part of particles.rhop, when there is one, is spread out. The runs
/// must be in the given order.
void merge_free_particles(CaseParticles& particles, ParticleBlock& block,
                          const PositionOrder& order, std::uint64_t begin, std::uint64_t end);

} // namespace fppg
