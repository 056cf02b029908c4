#pragma once

#include "fppg/case_def.h"

#include "lattice/spans.h"

namespace fppg
{

/// The nodes of a sphere, tested one by one, not faceted (rule R1): with C the snapped centre, r =
/// floor(R / dp + 0.5) and d = |n - C| in indices, face: |d - r| < width, full: d < r + width,
/// solid: d <= R / dp. `layers_dp` draws faces of radius R + layer * dp instead (rule R4).
SlabRegion sphere_region(const SphereOp& sphere, const DrawState& state, const LatticeGrid& grid);

/// The nodes of a cylinder (rule R2): A, B snapped ends, u the axis, t = (n - A) . u, q the
/// distance to the axis, r = floor(R / dp + 0.5): tube |q - r| < width and 0 <= t <= L; covers |t|
/// < width or |t - L| < width, and q <= R / dp; interior q <= R / dp and 0 <= t <= L.
SlabRegion cylinder_region(const CylinderOp& cylinder, const DrawState& state,
                           const LatticeGrid& grid);

/// The nodes of an ellipsoid of revolution by the sum s of the distances to its snapped foci (rule
/// R3): face |s - S0| < width with S0 = floor(R / dp + 0.5), full s < S0 + width, solid s <= R /
/// dp.
SlabRegion ellipsoid_region(const EllipsoidOp& ellipsoid, const DrawState& state,
                            const LatticeGrid& grid);

} // namespace fppg
