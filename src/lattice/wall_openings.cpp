#include "lattice/wall_openings.h"

#include "core/parallel.h"
#include "meshes/inside_test.h"
#include "offset/wall_depth.h"

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

/// A face of an opening takes what is so near to it, dp.
constexpr double face_reach_dp = 0.5 - 1e-6;
/// Rounding of places, dp.
constexpr double same_place_dp = 1e-3;
/// Nearer to the points of an inlet than this is no wall, dp.
constexpr double inlet_rim_dp = 0.75;
/// A place on a surface is looked at from so far before it, dp.
constexpr double before_dp = 0.01;

/// Where a particle belongs on the surface of its body.
struct SurfacePlace
{
    Vec3 foot;
    Vec3 into; ///< unit, from the wet side to the layers
};

/// What is drawn on an opening.
struct Cover
{
    const WallDepth* wall;
    double depth; ///< metres, beyond its last layer by what fluid before it can reach
};

class OpeningCutter
{
public:
    OpeningCutter(const WallOpening& opening, const FittedWalls& walls, double dp, int threads)
        : walls_(walls),
          dp_(dp),
          is_solid_(opening.shape.is_solid),
          rim_((opening.is_inlet ? inlet_rim_dp : same_place_dp) * dp),
          test_(opening.shape.soup, threads)
    {
        test_.query().prepare_nearest();
        for (const Vec3& v : opening.shape.soup.vertices) box_.add(v);
        behind_.resize(walls.bodies.size(), 1);
        for (std::size_t b = 0; b < walls.bodies.size(); ++b)
            if (walls.bodies[b].wall != nullptr)
                behind_[walls.bodies[b].owner] = walls.bodies[b].wall->sign();
        for (std::size_t b = opening.bodies; b < walls.bodies.size(); ++b)
            if (walls.bodies[b].wall != nullptr)
                covers_.push_back({walls.bodies[b].wall.get(), walls.bodies[b].depth + 2 * dp});
    }

    bool cuts(std::size_t particle) const
    {
        const Vec3& p = walls_.particles.positions[particle];
        const FittedBody& body = walls_.bodies[walls_.particles.bodies[particle]];
        if (!box_.has(p, body.depth * longest_mitre + dp_)) return false;
        SurfacePlace place{p, {}};
        if (body.wall != nullptr)
        {
            const DepthPlace at = body.wall->at(p);
            place = {at.foot, at.direction};
        }
        else
            place.into = -behind_[walls_.particles.bodies[particle]] *
                         body.mesh.normals[walls_.particles.facets[particle]];
        return is_open(place) && !is_covered(place.foot - (before_dp * dp_) * place.into);
    }

private:
    bool is_open(const SurfacePlace& place) const
    {
        if (!box_.has(place.foot, dp_)) return false;
        if (is_solid_ && test_.is_inside(place.foot)) return true;
        const Vec3 off = place.foot - test_.query().closest_point(place.foot).point;
        const double across = dot(off, place.into);
        return std::abs(across) <= face_reach_dp * dp_ && norm(off - across * place.into) <= rim_;
    }

    bool is_covered(const Vec3& before) const
    {
        return std::any_of(covers_.begin(), covers_.end(),
                           [&](const Cover& cover)
                           {
                               const DepthPlace at = cover.wall->at(before);
                               return !at.is_beyond_rim && at.depth > -before_dp * dp_ &&
                                      at.depth <= cover.depth;
                           });
    }

    const FittedWalls& walls_;
    double dp_;
    bool is_solid_;
    double rim_; ///< metres around its faces, in the plane of a wall
    InsideTest test_;
    Box3 box_;
    std::vector<Cover> covers_;
    std::vector<double> behind_; ///< per body, -1 where its layers are before its facets
};

} // namespace

std::vector<char> sheets_among(const std::vector<FittedBody>& bodies)
{
    std::vector<char> out(bodies.size(), 0);
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        const FittedBody& drawn = bodies[b].is_layer() ? bodies[bodies[b].owner] : bodies[b];
        out[b] = drawn.is_solid ? 0 : 1;
    }
    return out;
}

void cut_openings(const std::vector<WallOpening>& openings, const FittedWalls& walls, double dp,
                  int threads, std::vector<char>& is_cut)
{
    if (openings.empty()) return;
    const std::vector<char> is_sheet = sheets_among(walls.bodies);
    for (const WallOpening& opening : openings)
    {
        const OpeningCutter cutter(opening, walls, dp, threads);
        std::vector<char> opens = is_sheet;
        for (const std::uint32_t body : opening.shaped) opens[body] = 0;
        parallel_for(
            is_cut.size(), threads,
            [&](std::size_t i)
            {
                const std::uint32_t body = walls.particles.bodies[i];
                if (is_cut[i] == 0 && opens[body] != 0 && body < opening.bodies && cutter.cuts(i))
                    is_cut[i] = 1;
            },
            1024);
    }
}

} // namespace fppg
