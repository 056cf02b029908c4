#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fppg
{

/// What GenCase v5.4.354 makes of a <mkorient> where it sorts by cells: z falls where y is in
/// capitals, whatever z is (all 48 orders, 64 points each, and random ones).
inline MkOrient orient_of_cells(MkOrient orient)
{
    const auto place = [&](int axis)
    {
        return static_cast<std::size_t>(std::find(orient.axes.begin(), orient.axes.end(), axis) -
                                        orient.axes.begin());
    };
    orient.descending[place(2)] = orient.descending[place(1)];
    return orient;
}

/// The order of the particles of an mk: by coordinates, slowest axis first.
///
/// Where the mk has particles of `setfrdrawmode`, GenCase v5.4.354 sorts all its particles by cells
/// instead, 1024 along each axis of their bounding box; a cell is floor(float(x - min) / float(max
/// - min) * 1024), the last one for the maximum, in single precision (found by experiment: 2880 of
/// 2880 places beside limits of cells). Particles of one cell keep the order of drawing. Nodes of
/// one cell, which a box of more than 1024 dp has, keep their own order here.
class PositionOrder
{
public:
    using Key = std::array<double, 3>;

    /// By x, y, z, or as `orient` says.
    explicit PositionOrder(const MkOrient& orient = {}) : orient_(orient) {}

    /// Sorts by cells of this box from now on.
    void use_cells(const Box3& box)
    {
        cells_ = box;
        orient_ = orient_of_cells(orient_);
    }

    Key key(const Vec3& p) const
    {
        Key key{};
        for (std::size_t i = 0; i < 3; ++i)
        {
            const int axis = orient_.axes[i];
            const double value = cells_.is_empty() ? p[axis] : cell(p[axis], axis);
            key[i] = orient_.descending[i] ? -value : value;
        }
        return key;
    }

private:
    double cell(double x, int axis) const
    {
        const auto size = static_cast<float>(cells_.max[axis] - cells_.min[axis]);
        const float share = static_cast<float>(x - cells_.min[axis]) / size;
        return size > 0 ? std::min(std::floor(share * 1024.0F), 1023.0F) : 0.0;
    }

    MkOrient orient_;
    Box3 cells_;
};

/// How many particles off the lattice carry each mk; size 65536.
std::vector<std::uint64_t> count_off_lattice_particles(const FittedWalls& walls);

/// Puts the particles of `walls` into the order of the blocks, with normals and distances;
/// densities are left to the caller (zero). Those of `walls.particles` are moved there.
///
/// blocks   every mk of the walls has one
/// orders   of every block
/// returns  in `begin` where each block's particles begin, and their number as last entry
/// cost     O(n log n) time, about 22 bytes per particle beside those of `walls`
OffLatticeParticles sort_off_lattice_particles(FittedWalls& walls,
                                               const std::vector<ParticleBlock>& blocks,
                                               const std::vector<PositionOrder>& orders,
                                               int threads, std::vector<std::uint64_t>& begin);

/// Sorts the particles [begin, end) of particles.off_lattice in among the nodes of a block: its
/// runs are split where needed, and its part of particles.rhop, when there is one, is spread out.
/// The runs must be in the given order.
void merge_off_lattice_particles(CaseParticles& particles, ParticleBlock& block,
                                 const PositionOrder& order, std::uint64_t begin,
                                 std::uint64_t end);

} // namespace fppg
