#pragma once

#include "fppg/scene.h"

#include <array>
#include <cstdint>

namespace fppg
{

/// Nodes that the lattice gets beyond the domain of a case, at each end of each axis.
struct LatticeMargin
{
    std::array<std::uint32_t, 3> low{};
    std::array<std::uint32_t, 3> high{};

    bool operator==(const LatticeMargin&) const = default;
};

/// How many nodes walls of one sheet need beyond the domain to have all their layers:
/// `<definition>` often reaches just as far as the walls that GenCase draws. A tank of sheets in a
/// domain that ends 1 dp beyond it kept 0.18 g under dynamic boundaries (3 dp: 0.0003 g). An end
/// that something is drawn beyond stays, as the domain cuts it there, and so do those of periodic
/// axes and of cases with `<vres>`.
LatticeMargin margin_for_layers(const Scene& scene, int threads);

/// Widens the lattice of a case.
void widen_lattice(const LatticeMargin& margin, LatticeGrid& grid);

} // namespace fppg
