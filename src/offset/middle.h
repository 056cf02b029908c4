#pragma once

#include "offset/wall_depth.h"

#include <optional>

namespace fppg
{

/// A ball inside a body that touches its surface in two places.
struct InnerBall
{
    Vec3 centre; ///< on the middle of the part, its medial axis
    double radius = 0;
    bool is_across = false; ///< the two places face away from each other by more than 120 degrees
};

/// The largest ball that touches the surface at a point and holds no other point of it (Ma, Bae and
/// Choi, 2012, "shrinking ball").
///
/// foot, normal  a point of a facet and the facet's normal
/// most          metres
/// returns       nothing where its radius would be more than `most`
std::optional<InnerBall> touching_ball(const WallDepth& wall, const Vec3& foot, const Vec3& normal,
                                       double most);

/// The same where the other side faces away by more than 120 degrees: in thin parts.
std::optional<InnerBall> inner_ball(const WallDepth& wall, const Vec3& foot, const Vec3& normal,
                                    double most);

/// The ball that touches the surface at the place nearest to a point inside, and has its centre on
/// the line from there to the point: over an edge too, where the normals of its facets lead away.
///
/// place  of p
std::optional<InnerBall> ball_through(const WallDepth& wall, const DepthPlace& place, const Vec3& p,
                                      double most);

/// The point of the middle over the surface that is nearest to p; p itself where there is no middle
/// less deep than `most`, metres.
Vec3 on_middle(const WallDepth& wall, const Vec3& p, double most);

} // namespace fppg
