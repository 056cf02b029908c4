#pragma once

#include "fppg/surface_mesh.h"

#include "meshes/exact_place.h"
#include "meshes/round_surface.h"

#include <array>
#include <memory>
#include <optional>

namespace fppg
{

/// The exact surface of a round body with its plane covers, where these meet in circles.
class RoundWall
{
public:
    /// mesh   the facets that stand for the surface, or for a part of it
    /// is_2d  the nearest place is looked for in the plane y = constant of the point
    RoundWall(const SurfaceMesh& mesh, std::shared_ptr<const RoundSurface> round, bool is_2d);

    /// start     the place of the facets nearest to p
    /// returns   nothing where the facets are not as far from p as the exact surface, as where they
    ///           are a part of it only
    std::optional<ExactPlace> at(const Vec3& p, const Vec3& start) const;
    /// How far facets are from the exact surface, metres.
    double chord() const { return chord_; }

private:
    /// A place on one face: on the tube, or on a cover.
    struct Candidate
    {
        Vec3 point;
        bool is_found = false;
        int rim = -1; ///< 0, 1: on that rim, with p beyond it
    };

    Level level_in_plane(const Vec3& p) const;
    bool put_on_surface(Vec3& p) const;
    bool put_on_rim(Vec3& p, int end) const;
    Candidate on_tube(const Vec3& p, const Vec3& start) const;
    Candidate on_cover(const Vec3& p, int end) const;
    double along(const Vec3& p) const;
    Vec3 tube_normal(const Vec3& p) const;

    std::shared_ptr<const RoundSurface> round_;
    bool is_2d_;
    double chord_ = 0;
    bool has_ends_ = false; ///< the tube ends at covers or open rims
    bool has_tube_ = false;
    std::array<bool, 2> has_cover_{false, false};
    std::array<double, 2> end_{0, 0};  ///< of the tube along its axis, metres
    std::array<Vec3, 2> cover_normal_; ///< unit, as the facets look
    Vec3 axis_;                        ///< in 2D its part in the plane
    double sense_ = 1;                 ///< -1: the facets look to lower levels
};

} // namespace fppg
