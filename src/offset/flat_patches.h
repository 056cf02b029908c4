#pragma once

#include "fppg/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Facets of a mesh in patches, each about as large as a brick of the grid they were cut from.
struct PatchedMesh
{
    std::vector<Vec3> vertices; ///< metres
    std::vector<std::vector<std::array<std::uint32_t, 3>>> patches;
};

/// Gives patches that lie in a plane, as most behind the walls of a flume do, 8 facets or fewer
/// where they have 128: a fan around a vertex in their middle, with the vertices that they have in
/// common with two other patches, or with one that stays as it is. The surface is the same; drops
/// vertices that no facet needs any more.
///
/// cell     metres, side of the cells that facets come from
/// threads  number of threads; the result does not depend on it
/// cost     O(n log n) for the edges between patches
void merge_flat_facets(double cell, int threads, PatchedMesh& mesh);

} // namespace fppg
