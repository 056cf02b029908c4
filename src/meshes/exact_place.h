#pragma once

#include "fppg/vec.h"

#include <array>

namespace fppg
{

/// A point seen from the exact surface behind the facets of a body.
struct ExactPlace
{
    Vec3 nearest;
    /// Unit normals, as the facets look, of the faces that meet there: one, on an edge two.
    std::array<Vec3, 2> faces;
    int face_count = 1;
    bool is_beyond_rim = false; ///< the surface ends there, and the point is not over it
};

} // namespace fppg
