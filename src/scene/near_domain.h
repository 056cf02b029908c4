#pragma once

#include "fppg/case_def.h"
#include "fppg/draw_ops.h"
#include "fppg/lattice.h"
#include "fppg/mesh.h"

#include <cstdint>
#include <optional>

namespace fppg
{

/// Of bodies only those are cut of which at least so much is beyond the domain.
inline constexpr double least_beyond_dp2 = 20000;

/// From the first to the last node of the domain, with a margin on all sides.
Box3 box_around(const LatticeGrid& grid, double margin_dp);

/// The domain with a margin of 12 dp on all sides. Layers, relaxation and features reach less far.
Box3 box_near_domain(const LatticeGrid& grid);

/// What goes on in the domain shall be as if all were laid: a round shape is left whole unless so
/// many times as much of it is beyond the domain as within.
inline constexpr double times_beyond_of_round = 8;

/// Whether a body-fitted shape is laid whole, however much of it is beyond the domain: the mass of
/// what floats is that of all of it, and with `place="inside"` the wall fills its solid.
bool is_laid_whole(const CaseDef& def, std::uint16_t mk);

/// A body-fitted draw with the facets that what is in the domain needs. Of a cylinder of which far
/// more is beyond the domain than within (times_beyond_of_round), and at least 20,000 dp^2, most of
/// that is left out; a sphere that is twenty times as large as the domain, and at least 1,500 dp in
/// radius, has coarse facets beyond. Empty for all else, and for what is laid whole.
std::optional<DrawOp> made_near_domain(const DrawOp& draw, const CaseDef& def);

} // namespace fppg
