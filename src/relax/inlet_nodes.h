#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"

#include "relax/regions.h"

#include <vector>

namespace fppg
{

/// A node whose particle is a point of a zone where fluid goes in or out.
struct InletNode
{
    Mover at;
    Vec3 place;
    InletParticles zone;
};

/// In the order of the runs.
std::vector<InletNode> inlet_nodes(const InOutZones& inout, const RunField& field);

/// Nodes of one fluid that were taken out beside walls.
struct InletRim
{
    std::uint16_t mk = 0;
    std::size_t left_out = 0;
    std::size_t of = 0;
    Vec3 first; ///< of those left out
};

/// Takes the points of zones out that the solver refuses beside body-fitted walls: where a particle
/// of these is nearer than 0.7 dp to the point, or to one of the rows that the solver sets behind
/// it, dp apart (v5.4, JSphInOut::InitCheckProximity). On the lattice walls are a whole dp off.
///
/// returns  what was taken out, by mk
std::vector<InletRim> leave_out_inlet_rims(const CaseDef& def, RunField& field);

} // namespace fppg
