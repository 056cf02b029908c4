#pragma once

#include "balance/fluid_at_rest.h"

#include <optional>
#include <span>
#include <vector>

namespace fppg
{

/// What the solver's sums leave of gravity in the midst of a lattice at each of some depths, whose
/// nodes have the pressures of their depths. Metres a second squared.
///
/// offsets  from a node to those within 2h, metres; the node itself first
/// mass     of a particle, kg (2D: a metre of width)
/// depths   of the node below the level, metres
std::vector<Vec3> lattice_falls(const FluidAtRest& rest, const std::vector<Vec3>& offsets,
                                double mass, std::span<const double> depths);

/// What the solver's sums leave of gravity in the midst of a lattice whose nodes have the pressure
/// of their depth: 0.004 to 0.03 g downwards.
///
/// In the solver such fluid sinks as a whole until its pressure has risen by as much. Fluid beside
/// walls is at rest against it when it has the same acceleration: where its own was brought to
/// zero, columns of it slid along those of the lattice, at 0.02 to 0.03 g in a tank 50 dp deep.
class LatticeFall
{
public:
    /// None: of fluid all of which is brought to rest.
    LatticeFall() = default;
    /// A table over the depth: of the rows below a level surface, of which the two highest draw
    /// together (-0.16 and 0.12 g at h = 2 dp); where gravity is along no axis of the lattice, from
    /// the depth on at which no kernel reaches the surface.
    ///
    /// grid     its steps are those of the lattice
    /// mass     of a particle, kg (2D: a metre of width)
    /// deepest  metres below the level
    LatticeFall(const FluidAtRest& rest, const LatticeGrid& grid, double mass, double deepest);

    /// Metres a second squared, at a depth below the level in metres.
    Vec3 at(double depth) const;
    /// Whether a place is on a row of the lattice; any is where gravity is along none of its axes,
    /// and none where there is no fall.
    bool is_on_row(const Vec3& place) const;

private:
    double first_ = 0; ///< depth of the first entry, metres
    double step_ = 0;
    std::optional<int> axis_; ///< that gravity is along
    double first_row_ = 0;    ///< along the axis, metres

    std::vector<Vec3> table_;
};

} // namespace fppg
