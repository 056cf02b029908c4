#pragma once

#include "fppg/features.h"
#include "fppg/surface_mesh.h"

#include "offset/wall_depth.h"

#include <cstdint>
#include <optional>

namespace fppg
{

struct OffsetOptions
{
    double depth = 0; ///< metres behind the wall, above 0
    double dp = 0;    ///< metres
    double feature_angle_deg = 30;
    double cell = 0; ///< metres, of the grid that the surface is cut from; about dp / 2
    /// Of 2D cases: only a strip along the plane y = this is made, two cells wide.
    std::optional<double> plane_y;
    /// Flat parts keep facets as small as cells, each of which has one owner.
    bool keeps_facets = false;
};

/// A surface at a given depth behind a wall.
struct OffsetSurface
{
    SurfaceMesh mesh; ///< facets look to the wall; none where nothing is that deep
    MeshReport report;
    std::vector<std::uint32_t> creases; ///< edges of the mesh, ascending
};

/// The surface at a given depth behind a wall.
///
/// Dual contouring (Ju et al., 2002, with a vertex per sheet in a cell as Nielson, 2004) of the
/// exact distance on a grid that is only followed where the surface passes. Vertices in cells where
/// the foot of the depth jumps, as behind sharp edges that stand out of the body, are on the crease
/// of the tangent planes; behind edges that run into it the surface is round and smooth. Flat
/// pieces are exact, curved ones to about cell^2 / (8 R). Creases are the edges across which the
/// direction of the depth turns by more than the feature angle within 0.16 dp; their vertices are
/// put onto them, and gaps of up to three edges are closed.
///
/// cost    about 20 distances per dp^2 of surface at cell = dp / 2
OffsetSurface offset_surface(const WallDepth& wall, const OffsetOptions& options, int threads);

/// The creases of an offset surface and its open edges as features.
Features offset_features(const OffsetSurface& offset, const FeatureOptions& options);

/// The point of the offset surface nearest to p, as far as Newton's steps find it: its depth is
/// exact to 1e-9 dp where the foot does not jump.
Vec3 project_to_depth(const WallDepth& wall, const Vec3& p, double depth);

/// The same on a crease: as deep under all the given directions.
///
/// towards  points near p on the faces that meet in the crease, metres
/// returns  p moved so that its depth is exact under each of these faces; as project_to_depth()
///          where that fails
Vec3 project_to_crease(const WallDepth& wall, const Vec3& p, double depth, double dp,
                       const std::vector<Vec3>& towards);

} // namespace fppg
