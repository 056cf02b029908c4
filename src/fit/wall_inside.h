#pragma once

#include "fppg/features.h"
#include "fppg/fit.h"
#include "fppg/surface_mesh.h"

namespace fppg
{

/// A particle on a smooth surface lies in the body with one half, one on the edge of a box with a
/// quarter, one on its corner with an eighth.
///
/// is_2d    corners are those of the section, edges of the mesh
/// returns  how much less than one half each all particles on edges and corners together have in
///          the body, in particles; below 0 where most edges are hollows. Edges by their angle,
///          corners by the mean of their edges, exact for boxes.
double less_than_half(const SurfaceMesh& mesh, const Features& features,
                      const SurfaceParticles& particles, bool is_2d);

} // namespace fppg
