#pragma once

#include "fppg/surface_mesh.h"

#include <vector>

namespace fppg
{

/// The layers behind a surface, each counted by its area: it shrinks as that of a ball with
/// the same volume for its surface.
double layers_of(const std::vector<double>& depths_dp, const MeshReport& report, double dp);

/// The layers of a sheet, each counted by its area: they stand outside of the vessel that it
/// bounds, and grow with the distance by its bends, sharp or smooth.
double layers_outside(const std::vector<double>& depths_dp, const SurfaceMesh& mesh, double dp);

} // namespace fppg
