#pragma once

#include "fit/charts.h"
#include "fit/walk.h"

#include <cmath>
#include <functional>
#include <memory>

namespace fppg
{

/// The two sides of a thin plate do not count as neighbours, however thin it is and wherever on the
/// other side a particle is: each side is covered by its own.
inline bool is_other_sheet(const Vec3& normal, const Vec3& other_normal)
{
    return dot(normal, other_normal) < -0.5;
}

/// Whether a particle of another sheet counts as a neighbour all the same, or particles of both
/// would be nearer than least_pair_dp: one on an edge or a corner, or on the other side of a narrow
/// gap. (Of a plate so thin one sheet stays, see one_sheet.h.)
///
/// normal  of the place, unit
/// offset  from there to the other particle, dp
inline bool is_close_across(const Vec3& normal, const Vec3& offset, bool is_on_feature)
{
    const double across = dot(offset, normal);
    return (is_on_feature || across > 0) && std::fabs(across) < least_pair_dp;
}

/// A particle on a corner or a feature line, as the filling of charts sees it.
struct FeatureSite
{
    Vec3 position;
    Vec3 normal;                       ///< mean of its facets' normals, not of unit length
    std::vector<std::uint32_t> facets; ///< of the work mesh, that it lies on
};

/// The sites of feature particles, in their order.
std::vector<FeatureSite> make_feature_sites(const SurfaceMesh& mesh, const WorkMesh& work,
                                            const std::vector<FeatureParticle>& particles,
                                            int threads);

/// What is known of a surface particle while its surroundings are still being filled.
struct SurfaceSite
{
    Vec3 position;
    std::uint32_t facet = no_index; ///< of the work mesh
    bool is_irregular = false;      ///< not amid six others in a hexagon: a hole may be near
    bool is_at_seam = false;        ///< another chart is near
};

/// The particles of one chart, and the rays of its front that ended in others.
struct ChartParticles
{
    std::vector<SurfaceSite> sites;
    std::vector<SurfaceRay> leaving;
    std::vector<SurfaceRay> rows;        ///< first rows along features, to begin with
    std::vector<std::uint32_t> features; ///< sites of features that are near
};

/// What all charts share while they are filled.
struct FillState
{
    const WorkMesh& mesh;
    const Charts& charts;
    const std::vector<FeatureSite>& features;
    double dp;
    std::vector<ChartParticles> particles; ///< per chart
    double hole_radius = 0.90;             ///< dp; no point is left farther from a particle
    /// Where particles may be put, by place and normal of the surface; empty: everywhere. Called
    /// from several threads.
    std::function<bool(const Vec3&, const Vec3&)> may_fill = {};

    /// Gives every chart the feature particles that are near it.
    void share_out_features();
};

/// Fills one chart after another; each thread has its own, for the memory that it keeps.
class ChartFiller
{
public:
    explicit ChartFiller(FillState& state);
    ~ChartFiller();
    ChartFiller(ChartFiller&&) noexcept;
    ChartFiller& operator=(ChartFiller&&) noexcept;

    /// Lays first rows, then walks a hexagonal front over the chart: particles 1.075 dp apart, none
    /// nearer than 0.86 dp to another of its sheet.
    void advance_front(std::uint32_t chart);

    /// Puts particles into the holes, the farthest first, until no point of the chart is farther
    /// than the state's hole radius from a particle. All charts must have had their front.
    void fill_holes(std::uint32_t chart);

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

} // namespace fppg
