#pragma once

#include "fppg/error.h"
#include "fppg/surface_mesh.h"

#include <optional>

namespace fppg
{

/// repair_mesh() for a solid at a particle distance dp (metres); nothing where no facet has area.
inline std::optional<SurfaceMesh> repaired_solid(const TriangleSoup& soup, double dp, int threads,
                                                 MeshReport& report)
{
    try
    {
        return repair_mesh(soup, {.dp = dp, .is_solid = true, .warns_of_folds = true}, threads,
                           report);
    }
    catch (const GeometryError&)
    {
        return {};
    }
}

} // namespace fppg
