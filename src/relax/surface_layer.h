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

/// So few are relaxed with more care: they cost little.
inline constexpr std::size_t few_particles = 10'000;

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
    SlidePlace place;                ///< where it last stood on the surface
    std::uint32_t source = no_index; ///< the given particle that it is or was put next to
    std::uint32_t site = no_index;   ///< of a feature particle, among the layer's
    FitKind kind = FitKind::Surface;
    bool is_moving = false;
    bool is_new = false;  ///< put into a hole
    bool is_awake = true; ///< one that sleeps stands still as long as nothing changes near it
};

/// How many particles came and went.
struct LayerChange
{
    std::size_t inserted = 0;
    std::size_t removed = 0;
};

/// The particles of one body, sorted along a curve, and what moves them.
///
/// Steps lead along the plane of the facet that a particle last stood on; every few steps all are
/// taken back to the surface by sliding over it from there.
class SurfaceLayer
{
public:
    /// work       of the body's mesh, cut to longest_chart_side
    /// particles  those of the body; facets of places are still those of the mesh
    /// h          smoothing length, dp
    SurfaceLayer(const FittedBody& body, std::shared_ptr<const WorkMesh> work,
                 std::vector<LayerParticle> particles, double dp, double h, int threads);
    ~SurfaceLayer();
    SurfaceLayer(SurfaceLayer&&) noexcept;

    /// Computes forces and spacings.
    LayerState look_around();
    /// Makes a step along forces and, unless it starts anew, the last step. Returns the largest
    /// displacement in dp.
    double step(bool is_restart);
    /// Takes all particles to the surface.
    void settle() { settle(0); }

    /// What renew() takes out and fills, dp.
    struct Limits
    {
        double least;       ///< moving particles nearer to another of their sheet are taken out
        double hole_radius; ///< particles are put where the surface is farther from all
        bool is_sampled;    ///< also where only edge particles of others are near
    };
    /// Takes particles out and puts others in, and wakes those around; all others sleep then if
    /// `is_local`.
    LayerChange renew(const Limits& limits, bool is_local,
                      const std::function<bool(const Vec3&, const Vec3&)>& may_fill);

    /// Places with facets of the work mesh.
    const std::vector<LayerParticle>& particles() const { return particles_; }
    std::uint32_t mesh_facet(std::uint32_t facet) const { return work_.facets[facet].parent; }
    std::size_t size() const { return particles_.size(); }
    std::size_t projected() const { return projected_; }
    std::size_t returned() const { return returned_; }

private:
    friend class HoleFinder;

    enum class Role : std::uint8_t
    {
        Still,
        Asleep,
        Awake
    };

    void place_on_work_mesh();
    void sort();
    void build_list();
    void pack_points(const std::vector<char>& is_out);
    LayerState state_of_rows(std::size_t begin, std::size_t end) const;
    float push_on(std::size_t i, bool is_restart);
    void settle(double least);
    bool slide_back(std::size_t i, double least);
    Vec3 strayed(std::size_t i) const;
    void project(std::size_t i);
    void find_patches();
    Vec3 normal_of(const LayerParticle& particle) const;
    void accept(std::size_t i, const SlidePlace& place);

    std::vector<char> find_crowded(double least);
    void wake_around(std::size_t row, std::vector<char>& is_awake) const;
    Vec3 local(const Vec3& position) const { return (position - origin_) / dp_; }

    const FittedBody* body_;
    double dp_;
    int threads_;
    std::shared_ptr<const WorkMesh> shared_work_;
    const WorkMesh& work_;
    std::vector<FeatureSite> sites_;
    SurfaceForces forces_of_;
    float step_over_force_;
    Vec3 origin_;

    std::vector<LayerParticle> particles_;
    PointArrays points_;     ///< dp, from the origin
    PointArrays velocities_; ///< dp an iteration
    PointArrays normals_;    ///< of the surface where the particles last stood on it
    PointArrays forces_;
    std::vector<PackedPoint> packed_; ///< the same points
    std::vector<float> nearest_squared_;
    std::vector<Role> roles_;
    NeighbourList list_;
    bool is_listed_ = false;
    int steps_off_ = 0; ///< since all were on the surface

    std::unique_ptr<MeshQuery> query_; ///< made when it is first needed
    std::vector<std::uint32_t> patches_;
    std::size_t projected_ = 0;
    std::size_t returned_ = 0;
};

} // namespace fppg
