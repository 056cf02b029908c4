#pragma once

#include "fppg/case_def.h"

#include "nodes/spans.h"

namespace fppg
{

/// The nodes of a sphere, tested one by one, not faceted (rule R1): with C the real place of the
/// snapped centre, r = floor(R / dp + 0.5) * dp and d = |C - x|: face |d - r| < width, solid d <=
/// R, full either. `layers_dp` draws faces of radius R + layer * dp instead (rule R4). The
/// arithmetic is GenCase's (v5.4.354: 9 sets of 216 spheres, most with nodes exactly at a limit,
/// none different).
SlabRegion sphere_region(const SphereOp& sphere, const DrawState& state, const LatticeGrid& grid);

/// The nodes of a cylinder (rule R2): A, B real places of the snapped ends, V = B - A, va = V . x -
/// V . A, vb = V . x - V . B, d the distance from the axis, r = floor(R / dp + 0.5) * dp: tube |d -
/// r| < width with va >= 0 >= vb; covers |va| / |V| < width or |vb| / |V| < width, and d <= R;
/// interior d <= R with va >= 0 >= vb. The arithmetic is GenCase's (v5.4.354: 27 sets of 216
/// oblique cylinders and ties, none different).
SlabRegion cylinder_region(const CylinderOp& cylinder, const DrawState& state,
                           const LatticeGrid& grid);

/// The nodes of an ellipsoid of revolution by the sum s of the distances to its snapped foci (rule
/// R3): face |s - S0| < width with S0 = floor(R / dp + 0.5), full s < S0 + width, solid s <= R /
/// dp. The width is that of spheres, ctesphere; GenCase reads cteellipsoid and uses it nowhere.
SlabRegion ellipsoid_region(const EllipsoidOp& ellipsoid, const DrawState& state,
                            const LatticeGrid& grid);

} // namespace fppg
