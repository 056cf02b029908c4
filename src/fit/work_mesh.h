#pragma once

#include "fppg/features.h"
#include "fppg/surface_mesh.h"

#include "core/raw_array.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fppg
{

/// A facet, or a piece of a facet, with all that a walk over it needs in one place.
struct WorkFacet
{
    std::array<Vec3, 3> corners;
    Vec3 normal;
    /// Across side s (corner s to s + 1); no_index where a walk ends: at feature edges, open edges,
    /// edges of more than two facets, and where the neighbour looks the other way.
    std::array<std::uint32_t, 3> neighbours;
    std::array<std::uint32_t, 3> vertices; ///< below the mesh's own count: its vertices
    std::uint32_t parent;                  ///< facet of the mesh
    /// Its normal is about that of its own plane. A sliver with that of the facet beside it may
    /// have no width in there, so that no side ends a walk; it has no neighbours then.
    bool has_plane = true;
};

/// The facets of a mesh with long sides halved until none is longer than a given length, so that
/// any surface can be cut into pieces of about one size. Pieces meet side to side.
struct WorkMesh
{
    RawArray<WorkFacet> facets;             ///< sorted by parent
    std::vector<std::uint32_t> first_piece; ///< per mesh facet, and one past the end
    /// Around 16 facets in their order, around 16 such boxes, and so on; none where no facet is
    /// cut.
    std::vector<std::vector<Box3>> boxes;

    /// The piece of a mesh facet that holds a point of that facet.
    std::uint32_t locate(std::uint32_t parent, const Vec3& point) const;
    double area(std::uint32_t facet) const;
};

/// longest  metres, above 0: the longest side that is left whole
WorkMesh make_work_mesh(const SurfaceMesh& mesh, const Features& features, double longest,
                        int threads);

} // namespace fppg
