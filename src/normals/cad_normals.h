#pragma once

#include "fppg/case_def.h"

#include "meshes/cad_surface.h"

#include <memory>

namespace fppg
{

/// The CAD models that a case draws as walls, by which vectors to their facets are made exact.
class CadNormals
{
public:
    CadNormals(const CaseDef& def, int threads);

    /// The vector from a particle to the exact face, in the place of one that leads straight to one
    /// of its facets; any other stays.
    Vec3 exact(const Vec3& particle, const Vec3& to_facet) const;

private:
    double room_ = 0; ///< metres, that facets are off their surface at most
    std::unique_ptr<CadModels> models_;
};

} // namespace fppg
