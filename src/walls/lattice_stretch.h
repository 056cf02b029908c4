#pragma once

#include "fppg/lattice.h"
#include "fppg/vec.h"

#include <array>
#include <vector>

namespace fppg
{

/// A flat part of a wall across an axis, beside fluid.
struct WetPlane
{
    double at = 0;    ///< metres
    double depth = 0; ///< of the first particles behind it, seen from the fluid, metres
    double area = 0;  ///< beside fluid
    int side = 0;     ///< fluid is beyond it: 1, before it: -1, on both sides: 0
};

/// Steps of a lattice along the axes, over dp, and a plane of its nodes across each, metres.
struct LatticeStretch
{
    Vec3 stretch{1, 1, 1};
    Vec3 anchor;
};

/// The steps with which a lattice has nodes on the walls of both sides of its fluid, where these
/// are no whole number of dp apart: along each axis by at most a twentieth of dp, and along another
/// axis, first that of gravity, so much shorter or longer that a particle has dp^3 all the same. In
/// the solver, mean speed in tanks of DBC 40.3 dp wide in 2D, 20 and 50 dp deep, after 0.1 s: with
/// steps of dp 0.0043 and 0.0070, so stretched 0.0020 and 0.0028 m/s (GenCase's particles: 0.0225
/// and 0.0097). A crystal stretched by 5 % by hand had 0.0025, one not stretched 0.0019.
///
/// planes   per axis
/// grid     with steps of dp, moved to the walls of one side (lattice_move())
/// gravity  of the case
/// returns  steps of dp where others would have less area of walls on nodes
LatticeStretch stretch_between_walls(const std::array<std::vector<WetPlane>, 3>& planes,
                                     const LatticeGrid& grid, const Vec3& gravity);

} // namespace fppg
