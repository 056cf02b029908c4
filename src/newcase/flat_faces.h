#pragma once

#include "newcase/plan.h"

#include <vector>

namespace fppg
{

/// Facets that join and look the same way, to about a degree.
struct FlatFace
{
    Vec3 middle; ///< of its area
    Vec3 normal;
    double area = 0;                   ///< m2
    std::vector<std::uint32_t> facets; ///< ascending
};

/// The flat faces of a part, the largest first; each facet is in one of them.
std::vector<FlatFace> flat_faces(const NewPart& part);

/// The smallest disc round the middle of a face, or the smallest rectangle round it, whichever it
/// fills better.
FaceOutline outline_of(const NewPart& part, const FlatFace& face);

} // namespace fppg
