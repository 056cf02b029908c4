#pragma once

#include "fppg/mesh.h"
#include "fppg/surface_mesh.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// The facets of a mesh that bound a volume.
///
/// A shell is closed where its holes, each taken as a fan of triangles around the middle of its
/// rim, have less than a tenth of its area, and where it holds a volume. The shells that are not
/// closed by themselves are then taken together and judged by the same rule: pieces that meet at
/// edges of more than two facets may close one another. What is left are sheets and fins.
struct ClosedPart
{
    std::vector<char> is_bounding;  ///< per facet
    std::uint64_t sheet_facets = 0; ///< the others
    bool is_exact = true;           ///< it has no holes and no edge that clashes
    double hole_area = 0;           ///< metres squared
    double volume = 0; ///< signed, with the holes closed by their fans; parts that overlap count
                       ///< twice; 0 where nothing is bounded
};

ClosedPart find_closed_part(const SurfaceMesh& mesh);

/// The facets that bound a volume.
TriangleSoup soup_of_closed_part(const SurfaceMesh& mesh, const ClosedPart& part);

} // namespace fppg
