#pragma once

#include "fppg/case_def.h"

namespace fppg
{

/// Whether a shape has a surface that particles can stand on and Booleans can cut: all but points,
/// lines and waves.
bool has_surface(const Shape& shape);

/// Whether GenCase writes a shape into shape files and numbers it there: all but points,
/// ellipsoids and waves.
bool has_polygons(const Shape& shape);

} // namespace fppg
