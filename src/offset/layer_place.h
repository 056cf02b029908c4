#pragma once

#include "fppg/fitted_walls.h"

#include "meshes/pseudo_normals.h"

#include <cstdint>

namespace fppg
{

/// The exact places of the particles of a layer.
class LayerPlaces
{
public:
    /// layer  is_layer(); must outlive the object
    LayerPlaces(const FittedBody& layer, double dp) : layer_(layer), around_(layer.mesh), dp_(dp) {}

    /// A particle of the layer's mesh at the depth of the layer; one of an edge or a corner under
    /// all the faces that meet there, where it can be.
    Vec3 place(const Vec3& p, FitKind kind, std::uint32_t facet) const;

private:
    const FittedBody& layer_;
    PseudoNormals around_;
    double dp_;
};

} // namespace fppg
