#pragma once

#include "offset/offset_surface.h"

namespace fppg
{

/// Finds the creases of an offset surface, puts their vertices onto them and closes small gaps
/// between them. Facets change; their edges
/// and neighbours are right again, all else of the mesh is for finish_mesh() to do.
void sharpen_creases(const WallDepth& wall, const OffsetOptions& options, int threads,
                     OffsetSurface& offset);

} // namespace fppg
