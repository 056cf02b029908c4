#pragma once

#include "lattice/painting.h"

namespace fppg
{

/// Draws a shape of a body-fitted mk by its true surface.
///
/// returns  false for what stays on the lattice: other mks, points, lines, wires, fills, and in
///          2D what lies in the plane of the particles
bool paint_fitted(Painting& painting, const Brush& brush, const DrawOp& draw);

/// Draws a combination of body-fitted parts by its true surface.
///
/// whole  the source and the state of the combination
void paint_fitted(Painting& painting, const BooleanDef& boolean, const DrawOp& whole,
                  const FitSettings& settings);

/// The mk of a part of a combination.
MkValue mk_of_part(const CaseDef& def, const BooleanDef& boolean, std::size_t part);

} // namespace fppg
