#pragma once

#include "fppg/features.h"
#include "fppg/fit.h"
#include "fppg/surface_mesh.h"

#include <vector>

namespace fppg
{

/// Thins a plate that is thinner than dp to one sheet of particles: of two smooth parts of the
/// surface (bounded by feature edges) that face away from each other less than dp apart, the one
/// with the smaller area loses its particles there, and so do the edges and narrow sides between
/// them that do not belong to the larger one. Of equal areas the part with the first facet stays.
/// A surface that faces itself, such as a thin lens without a sharp rim, keeps both sides.
///
/// particles  as fit_surface() made them; those of the second sheet are taken out, the order stays
/// dp         metres, above 0
/// returns    the places of those taken out
/// cost       O(n)
std::vector<Vec3> keep_one_sheet(const SurfaceMesh& mesh, const Features& features, double dp,
                                 SurfaceParticles& particles, int threads);

} // namespace fppg
