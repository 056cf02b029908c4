#pragma once

#include "fppg/fitted_walls.h"

#include "offset/wall_depth.h"

#include <optional>
#include <vector>

namespace fppg
{

/// Where the innermost layers of both sides have room for one more sheet between them, but not for
/// two.
struct SheetGap
{
    double from_dp = 0, to_dp = 0; ///< depth of the middle
    int layers = 0;                ///< of both sides; its particles stand for what these do not
};

struct MergedSheetOptions
{
    double dp = 0;
    /// Where the middle is nearer to the surface than this, the layers of both sides are one, dp.
    double least_depth_dp = 0.8;
    std::vector<SheetGap> gaps{}; ///< where there is one too
    double off_edges_dp = 0.45;   ///< no point of the middle is nearer to a sharp edge
    /// Of so many sheets through the thickness it is one, and each of its particles stands for
    /// dp^3: where the body is thin they are farther apart. 0: they are dp apart everywhere.
    int parts = 0;
    /// So many particles are wanted; empty: as many as there is room for.
    std::optional<std::size_t> wanted{};
    bool evens_out = true;         ///< false: particles stay where they were taken
    std::optional<double> plane_y; ///< of 2D cases: the wall is drawn out along y
};

/// A point on the middle of a thin part.
struct MiddlePoint
{
    Vec3 position;
    std::uint32_t facet = 0; ///< of the wall, at its foot
    double spacing = 1;      ///< to the next of the sheet there, of what the sheet asks for
    double number = 0; ///< of particles that the layers around a gap lack, a dp^2; 0: not in one

    bool is_in_gap() const { return number > 0; }
};

/// The thin parts of a body.
struct ThinParts
{
    std::vector<MiddlePoint> middle; ///< points on their middle (the medial axis), from both sides
    /// Of the parts with their rims, metres cubed. In 3D only.
    double volume = 0;
};

/// Finds the middle of the thin parts of a body, and their volume.
///
/// Points of the surface, 0.3 dp apart, are sunk to the centre of their inner_ball(). Those
/// less deep than least_depth or in a gap, whose other side faces away by more than 120 degrees,
/// are taken, half a dp off sharp edges; none of a body that is thick everywhere. The volume
/// nearest to a piece of the surface is its area times the radius there, beside right-angled rims
/// too.
///
/// cost  about 15 distances per dp^2 of surface
ThinParts find_thin_parts(const WallDepth& wall, const Features& features,
                          const MergedSheetOptions& options, int threads);

/// How many points of a surface find_thin_parts() sinks in 3D.
double samples_of_thin_parts(const SurfaceMesh& mesh, double dp, int threads);

/// How thick a body is under points spread evenly over its surface: twice the radius of the ball of
/// find_thin_parts(), metres; 0 where that is more than `most` or the other side does not face
/// away.
///
/// plane_y  of a 2D case, in whose plane the points are
std::vector<double> sample_thickness(const WallDepth& wall, double most, std::size_t count,
                                     std::optional<double> plane_y, int threads);

/// The particles that both sides of a thin part share: on its middle (the medial axis), one per
/// dp^2 and evenly spaced.
///
/// From points on the middle the sheet is filled at 0.92 dp, relaxed on the middle, and filled
/// where it is 0.83 dp from all; or, with a number wanted, with so many as far apart as may be, and
/// relaxed. None comes nearer to `taken` than least_pair_dp.
///
/// taken    particles of layers already there, which keep their place
/// returns  positions, and the facet under each
SurfaceParticles merged_sheet(const WallDepth& wall, const Features& features,
                              const std::vector<MiddlePoint>& points,
                              const std::vector<Vec3>& taken, const MergedSheetOptions& options,
                              int threads);

} // namespace fppg
