#pragma once

#include "balance/fluid_at_rest.h"
#include "balance/pressure_sums.h"

namespace fppg
{

/// How the solver treats the boundary.
enum class RestBoundary : std::uint8_t
{
    Dbc,
    Mdbc,  ///< SlipMode 1: density and its gradient at the ghost node
    Mdbc2, ///< SlipMode 2 and 3: pressure cloned along the normal
};

/// Gives boundary particles, and fluid without pressure, the level of the nearest fluid that has
/// pressure, and the pressure of their depth below it; 0 where no fluid is within 2h + dp.
void set_depth_pressures(FluidAtRest& rest, int threads);

/// The pressures that mDBC gives to boundary particles with a ghost node, from the fluid around it.
class GhostPressures
{
public:
    GhostPressures(const FluidAtRest& rest, RestBoundary boundary);
    /// Sets pressures, densities and masses of boundary particles with ghost nodes. Those without
    /// fluid at their ghost node have no mass (SlipMode 2 and 3).
    void set(FluidAtRest& rest, int threads);

private:
    struct Sums;
    /// Takes over where the fluid is, and makes the lists around ghost nodes anew where it has
    /// moved too far since.
    void set_field(const FluidAtRest& rest, int threads);
    Sums sums_of(const FluidAtRest& rest, const DensitySums& dimless) const;
    /// point  that of a ghost node in the field
    void set_one(FluidAtRest& rest, std::uint32_t point, const DensitySums& dimless) const;

    RestBoundary boundary_;
    GroupList list_;
    PressureField field_;               ///< of all particles, then the ghost nodes
    std::vector<std::uint32_t> owners_; ///< of every ghost node
    std::vector<double> masses_;        ///< of their particles
    std::size_t first_ghost_ = 0;
};

} // namespace fppg
