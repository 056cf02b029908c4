#pragma once

#include "fit/chart_filler.h"
#include "fppg/relax.h"
#include "relax/slide.h"
#include "relax/surface_forces.h"

#include <functional>
#include <memory>

namespace fppg
{

class MeshQuery;

/// What a body's particles are like in one moment, to be summed over bodies.
struct LayerState
{
    std::size_t moving = 0;
    double spacing_sum = 0; ///< dp, over the moving particles
    double spacing_square_sum = 0;
    double power = 0; ///< sum of force times velocity: below 0 the layer runs uphill
};

/// A particle of a body while it is relaxed.
struct LayerParticle
{
    SlidePlace place;
    std::uint32_t source = no_index; ///< the given particle that it is or was put next to
    std::uint32_t site = no_index;   ///< of a feature particle, among the layer's
    FitKind kind = FitKind::Surface;
    bool is_moving = false;
    bool is_new = false; ///< put into a hole
};

/// The particles of one body, sorted along a curve, and what moves them.
class SurfaceLayer
{
public:
    /// particles  those of the body; facets of places are still those of the mesh
    /// h          smoothing length, dp
    SurfaceLayer(const FittedBody& body, std::vector<LayerParticle> particles, double dp, double h,
                 int threads);
    ~SurfaceLayer();
    SurfaceLayer(SurfaceLayer&&) noexcept;

    /// Computes forces and spacings.
    LayerState look_around();
    /// Makes a step along forces and, unless it starts anew, the last step. Returns the largest
    /// displacement in dp.
    double step(bool is_restart);
    /// Takes out moving particles nearer than `least` dp to another of their sheet. Returns how
    /// many.
    std::size_t thin(double least);
    /// Puts particles where the surface is farther than `radius` dp from all. Returns how many.
    std::size_t fill(double radius, const std::function<bool(const Vec3&, const Vec3&)>& may_fill);

    /// Places with facets of the work mesh, in the order of the curve.
    const std::vector<LayerParticle>& particles() const { return particles_; }
    std::uint32_t mesh_facet(std::uint32_t facet) const { return work_.facets[facet].parent; }
    std::size_t size() const { return particles_.size(); }
    std::size_t projected() const { return projected_; }
    std::size_t returned() const { return returned_; }

private:
    void sort();
    void build_list();
    bool move(std::size_t i, bool is_restart);
    void prefetch_facet(std::size_t i) const;
    Vec3 intended_step(std::size_t i, bool is_restart) const;
    void project(std::size_t i, bool is_restart);
    void find_patches();
    Vec3 normal_of(const LayerParticle& particle) const;
    void accept(std::size_t i, const SlidePlace& place);
    std::vector<char> find_near_holes(float radius);
    void name_sources();
    Vec3 local(const Vec3& position) const { return (position - origin_) / dp_; }

    const FittedBody* body_;
    double dp_;
    int threads_;
    WorkMesh work_;
    Charts charts_;
    std::vector<FeatureSite> sites_;
    SurfaceForces forces_of_;
    float step_over_force_;
    Vec3 origin_;

    std::vector<LayerParticle> particles_;
    PointArrays points_;     ///< dp, from the origin
    PointArrays velocities_; ///< dp an iteration
    PointArrays forces_;
    std::vector<float> nearest_squared_;
    NeighbourList list_;
    bool is_listed_ = false;

    std::unique_ptr<MeshQuery> query_; ///< made when it is first needed
    std::vector<std::uint32_t> patches_;
    std::size_t projected_ = 0;
    std::size_t returned_ = 0;
};

} // namespace fppg
