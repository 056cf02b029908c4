#pragma once

#include "check/fill_nodes.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// Of a case, on the lattice.
struct FluidAtStart
{
    std::vector<std::uint8_t> is_beside; ///< per run
    std::uint32_t top = 0;               ///< the highest node that fluid is beside
};

/// Of runs that the fluid can come to, takes away what lies beyond a rim: nodes that it comes to
/// only by rising above where it is at the start, and from which it runs down and out of the box,
/// as the outside of a round vessel that stands in its box. Nodes over the vessel stay a little
/// above its rim. Gravity is along -z.
///
/// above  nodes that stay above the level of the rim
/// wet    per run; a run of which nothing is left becomes dry
void leave_out_spilled(FillNodes& nodes, const FluidAtStart& fluid, std::uint32_t above,
                       std::vector<std::uint8_t>& wet);

} // namespace fppg
