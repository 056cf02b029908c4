#pragma once

#include "fppg/features.h"
#include "fppg/fit.h"
#include "fppg/surface_mesh.h"

namespace fppg
{

struct OneSheetOptions
{
    double dp = 0;        ///< metres, above 0
    double thickness = 1; ///< plates thinner than this lose a sheet, dp, at most 1
};

/// Thins a plate to one sheet of particles: of two smooth parts of the surface (bounded by feature
/// edges) that face away from each other less than the thickness apart, the one with the smaller
/// area loses its particles there, and so do the edges and narrow sides between them that do not
/// belong to the larger one. Of equal areas the part with the first facet stays. Of a surface that
/// faces itself, such as a blade with round edges, the side that looks more along (9, 12, 20) / 25
/// stays.
///
/// particles  as fit_surface() or section_particles() made them; those of the second sheet are
///            taken out, the order stays
/// returns    those taken out
/// cost       O(n)
SurfaceParticles keep_one_sheet(const SurfaceMesh& mesh, const Features& features,
                                const OneSheetOptions& options, SurfaceParticles& particles,
                                int threads);

} // namespace fppg
