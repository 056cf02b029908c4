#pragma once

#include "fppg/draw_ops.h"
#include "fppg/lattice.h"
#include "fppg/mesh.h"

#include <optional>

namespace fppg
{

/// Of bodies only those are cut of which at least so much is beyond the domain.
inline constexpr double least_beyond_dp2 = 20000;

/// The domain with a margin of 12 dp on all sides. Layers, relaxation and features reach less far.
Box3 box_near_domain(const LatticeGrid& grid);

/// A cylinder of which eight times as much as what comes into the domain is beyond it, and at least
/// 20,000 dp^2, without most of that: its facets would be made first. Empty for all else.
std::optional<DrawOp> ended_beside_domain(const DrawOp& draw, const LatticeGrid& grid);

} // namespace fppg
