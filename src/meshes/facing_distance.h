#pragma once

#include "fppg/surface_mesh.h"

#include "meshes/mesh_query.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Which side of a facet is looked at.
enum class FacetSide
{
    Behind, ///< through the body
    Before, ///< through the room in front of it
};

/// A place on a facet.
struct FacetSpot
{
    std::uint32_t facet = 0;
    Vec3 place;
};

/// Places spread evenly over the area of a mesh, by the additive sequence of the plastic number;
/// always the same.
std::vector<FacetSpot> even_places(const SurfaceMesh& mesh, std::size_t count);

/// How far it is from a place of a facet to the next facet that looks the other way: along the axis
/// nearest to the normal, times the cosine between both, which is exact for plates and gaps between
/// parallel faces.
///
/// normals  of length 1, one a facet of the query's soup
/// reach    metres; infinite where nothing is found within
double facing_distance(const std::vector<Vec3>& normals, const MeshQuery& query,
                       const FacetSpot& from, FacetSide side, double reach);

} // namespace fppg
