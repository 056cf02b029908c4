#pragma once

#include "fppg/surface_mesh.h"

#include "meshes/cad_surface.h"
#include "meshes/inside_test.h"
#include "meshes/pseudo_normals.h"
#include "offset/round_wall.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace fppg
{

/// Which side of a surface counts as behind it.
enum class WallSide : std::uint8_t
{
    Behind, ///< against the normals of the facets; of closed solids the inside
    Front,
};

/// A mitre is cut off where it is so much farther from its edge than deep: that of a corner of a
/// box is not, 1.73.
inline constexpr double longest_mitre = 1.8;

/// A point seen from a wall.
struct DepthPlace
{
    Vec3 nearest;            ///< point of the surface
    Vec3 foot;               ///< the point from which the depth is measured, along the direction
    Vec3 direction;          ///< unit, the way in which the depth grows fastest
    double depth = 0;        ///< metres behind the surface; negative before it
    std::uint32_t facet = 0; ///< of the mesh, at the foot
    bool is_beyond_rim =
        false; ///< the foot is on an open edge, and the point not over a facet there
};

/// How deep points are behind a surface: the distance to it, with the sign of the side. Behind a
/// sharp edge that runs into the wall, where the nearest place is the edge itself, it is the
/// largest distance to the planes of the faces that meet there, so that surfaces of one depth keep
/// the edge (a mitre); but no less than the distance over 1.8. Behind smooth surfaces it is the
/// distance.
///
/// The side is that of the angle-weighted pseudonormal at the foot (Baerentzen and Aanaes, 2005),
/// which is exact for surfaces without clashing edges; for closed bodies with faults, and at facets
/// that are folded onto others, the inside test (meshes/inside_test.h) is asked.
class WallDepth
{
public:
    /// mesh              connected; it is copied
    /// sharp_angle_deg   edges whose facets' normals differ by more are sharp
    WallDepth(const SurfaceMesh& mesh, const MeshReport& report, bool is_solid, WallSide side,
              double sharp_angle_deg, int threads);

    /// Of a round body: takes places from its exact surface. In 2D the mesh is that of the lines in
    /// the plane of the case.
    ///
    /// body  the mesh that the round surface belongs to
    void take_round_surface(const SurfaceMesh& body, std::shared_ptr<const RoundSurface> round,
                            bool is_2d);
    /// The same of a body that was made from CAD models; in 3D its mesh is the wall's.
    void take_cad_surface(const SurfaceMesh& body, std::shared_ptr<const CadSurface> cad,
                          bool is_2d, int threads);
    /// Whether places are those of an exact surface, not of the facets.
    bool is_exact() const { return round_ != nullptr || cad_ != nullptr; }
    /// How far facets are from the exact surface, metres.
    double chord() const;

    /// within  metres; a point of the surface is known to be so near
    DepthPlace at(const Vec3& p, double within = std::numeric_limits<double>::infinity()) const;
    /// Whether a point is before the wall beyond doubt: beside facets that lie on one another, as
    /// folded slivers do, the nearest facet alone does not say so.
    ///
    /// place  at(p)
    bool is_surely_before(const Vec3& p, const DepthPlace& place) const
    {
        return place.depth < 0 && (!is_solid_ || test_.is_inside(p) != (sign_ > 0));
    }
    const SurfaceMesh& mesh() const { return mesh_; }
    /// Whether depths may be those of a mitre around some point: an edge that has one is so near.
    bool has_mitre_near(const Vec3& p, double within) const
    {
        return mitres_ != nullptr && mitres_->closest_point(p).distance <= within;
    }
    /// 1 where the layers are behind the facets, -1 where they are in front.
    double sign() const { return sign_; }

private:
    const MeshQuery& query() const { return test_.query(); }
    bool is_behind(const Vec3& p, const ClosestPoint& foot, FacetPlace& place) const;
    DepthPlace seen_from(const ExactPlace& place, const Vec3& p, std::uint32_t facet) const;
    std::optional<ExactPlace> exact_place(const Vec3& p, const ClosestPoint& foot) const;
    void mitre(const Vec3& p, std::uint32_t facet, const FacetPlace& place, DepthPlace& out) const;

    SurfaceMesh mesh_;
    PseudoNormals normals_;
    InsideTest test_;
    double size_ = 0; ///< metres, the largest coordinate: by it rounding is measured
    bool is_solid_ = false;
    bool asks_inside_ = false;
    double sign_ = 1;
    std::vector<char> is_sharp_;        ///< per edge
    std::vector<char> is_folded_;       ///< per facet of a solid: another may lie on it
    double turn_ = 0;                   ///< cosine of the angle from which edges are sharp
    std::unique_ptr<MeshQuery> mitres_; ///< the sharp edges that run into the wall; or null
    std::unique_ptr<RoundWall> round_;
    std::shared_ptr<const CadSurface> cad_;
    /// Of CAD models in 2D: the body whose section the mesh is.
    struct CadBody
    {
        SurfaceMesh mesh;
        MeshQuery query;
    };
    std::unique_ptr<CadBody> cad_body_;
};

} // namespace fppg
