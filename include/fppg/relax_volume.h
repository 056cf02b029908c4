#pragma once

#include "fppg/closest_wall_point.h"
#include "fppg/vec.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace fppg
{

/// How a particle moves in relax_volume().
enum class VolumeMotion : std::uint8_t
{
    Free,      ///< it may be removed where the count is fitted
    Lasting,   ///< freely, but it stays whatever the count is
    AlongWall, ///< along the wall that is nearest to it, and it stays
    AlongEdge, ///< along the line where the walls nearest to it meet, and it stays
};

/// What surrounds the volume particles that move. Particles of other regions, beyond a wall, do not
/// belong here: a continuum stands for them.
struct VolumeSurroundings
{
    std::span<const Vec3> held;  ///< volume particles that stay; those within 2.5 h suffice
    std::span<const Vec3> walls; ///< wall particles, each of the weight of a volume particle
    ClosestWallPoint closest;    ///< empty: there is no wall
    /// Per moving particle how it moves; empty: all freely.
    std::span<const VolumeMotion> slides{};
    /// The place on its surface of a sliding one, by its index and where it is; called from several
    /// threads at once.
    std::function<Vec3(std::size_t, const Vec3&)> put_back{};
    /// Whether a particle may come to a place, by the index of the moving particle that it is or
    /// beside which it was inserted; called from several threads at once. Empty: anywhere.
    std::function<bool(std::size_t, const Vec3&)> may_come{};
};

/// What an iteration has reached.
struct RelaxVolumeProgress
{
    int iteration = 0;            ///< from 1
    double shepard_mean = 0;      ///< over the particles that move, before the step
    double shepard_variation = 0; ///< coefficient of variation
    double largest_step_dp = 0;
};

struct RelaxVolumeOptions
{
    double dp = 0;       ///< metres, above 0
    double h_dp = 1.0;   ///< smoothing length in dp, 0.6 to 2
    int iterations = 30; ///< 0: until the coefficient of variation settles, at most 100
    bool is_2d = false;  ///< particles keep their y, the kernel is the plane one
    double min_wall_distance_dp = 0.4; ///< no particle comes nearer to a wall
    /// So far behind the walls the continuum begins: half a dp behind particles on their surface, 0
    /// where it stands for all of the wall and surroundings.walls is empty. At least 0.
    double behind_wall_dp = 0.5;
    bool has_free_surface = true; ///< a lattice may end in the open, where it is held
    bool is_solid = false;        ///< the inside of a body: it ends where its walls leave no room
    double clearance_dp = 1.0;    ///< nodes nearer to a wall than this may be missing because of it
    /// Particles are removed where they are too many for the space that the walls leave, and
    /// inserted where they are too few.
    bool fit_count = false;
    /// With `fit_count`: so many particles are wanted in all; empty: as many as fill the space
    /// evenly.
    std::optional<double> wanted{};
    /// With `fit_count`: of two particles that end nearer than this to one another, or to one that
    /// does not move, one is taken out, dp; 0: none is. Above 0, no more than a quarter of those
    /// that may move come or go for the number wanted, as others stay around them.
    double least_pair_dp = 0;
    /// Called after every iteration; relaxation ends when it returns false. May be empty.
    std::function<bool(const RelaxVolumeProgress&)> on_iteration;
};

struct RelaxVolumeReport
{
    int iterations = 0;
    std::size_t held_at_surface = 0; ///< of the moving ones, held because a free surface is near
    std::size_t pushed_back = 0;     ///< steps that a wall shortened
    double shepard_mean = 0;         ///< of the last iteration
    double shepard_variation = 0;
    std::size_t removed = 0;
    std::size_t inserted = 0;
    std::size_t kept = 0; ///< of the result, those that were there
    /// With `fit_count`, for every particle of the result the index that it had, or that of the
    /// particle beside which it was inserted. First those that were there, in their order.
    std::vector<std::uint32_t> sources;
};

/// Moves volume particles until they lie evenly between the walls and the particles that are held.
///
/// Forces are those of equation 15 of the FPPG paper with one target density for all particles:
///   f_i = -sum_j grad W(x_i - x_j),
/// W of Wendland (C2) with the factor for which its integral is 1, so that sums are in units of one
/// particle per dp^3 (dp^2 in 2D). The paper prints p for the target density rho in equations 6 and
/// 15; with one density it is a constant, which belongs to the step. The division by the Shepard
/// sum of equation 8 is left out: the support is full everywhere, see below, so the sum is 1 to a
/// few per cent and only scales the step.
///
/// A wall is one layer of particles. What lies behind it must push as well, or the layer next to it
/// is pressed onto the wall: a continuum that begins half a dp behind the wall fills the rest of
/// the support. Behind a plane at the distance d its force is the integral of W over the plane at
/// d + dp / 2 (Gauss), along the inward normal; src/relax/continuum.h derives it. Where walls meet,
/// up to three planes push. Particles nearer than 0.8 dp to one another are pushed apart besides,
/// because the kernel's force vanishes at distance zero.
///
/// Steps have momentum (heavy ball, factor 0.9), which ends whenever the sum of force times
/// velocity is negative; the paper sets the velocity to zero at every step. No step is longer than
/// 0.1 dp. A step that would end nearer to a wall than `min_wall_distance_dp` is taken back to that
/// distance or not made; every such step is checked with the exact closest point, and is shorter
/// than the distance to the wall that it starts from. So none ends on the other side of a wall,
/// open, closed or turned as that may be; a particle that starts nearer than the limit comes no
/// nearer.
///
/// The free surface stays: a particle at the node of a lattice that lacks a neighbour along an
/// axis, farther than `clearance_dp` from the walls, is at the surface; it is held, and all within
/// 2 h of it.
///
/// A lattice whose walls lie along it has too many particles at one side and too few at another,
/// which moving them cannot mend. With `fit_count`, at iterations 5, 10 and 15, the deviations of
/// the Shepard sum from the lattice's are added up along a Morton curve; wherever half a particle
/// has come together, the particle with the largest deviation of that stretch goes, or one is put
/// into the widest gap beside it. So every region has its number to within about one particle.
///
/// positions  of the moving particles, metres, at nodes of one lattice of spacing dp; changed in
///            place. Those that are held keep their bits. Number and order stay without `fit_count`
/// threads    number of threads; the result does not depend on it
/// throws     GeometryError if a position is not finite or dp, h, a distance or the number of
///            iterations is out of its range (names the value)
/// source     section 3.3 of the FPPG paper, equations 15 to 17; continuum, momentum, push, limits
///            and constants by trial on spheres, boxes and gears: after 30 iterations, the Shepard
///            sums at h = 1.3 dp deviate by 0.9 to 1.3 per cent with fit_count (before: 4 to 11)
/// cost       about 0.4 microseconds a moving particle and iteration on one core, walls of a mesh
///            with sharp edges up to 0.1 more; 300 bytes a moving particle, with held and wall
///            particles in their usual number
RelaxVolumeReport relax_volume(std::vector<Vec3>& positions, const VolumeSurroundings& surroundings,
                               const RelaxVolumeOptions& options, int threads);

struct ShepardOptions
{
    double dp = 0;     ///< metres, above 0
    double h_dp = 1.3; ///< smoothing length in dp
    bool is_2d = false;
    double behind_wall_dp = 0.5; ///< as in RelaxVolumeOptions
};

/// The Shepard sum at every particle: that of W dp^3 (W dp^2 in 2D) over the particles themselves,
/// the held ones and the walls, and of the continuum beyond the walls. 1 where particles fill
/// space evenly.
///
/// threads  number of threads; the result does not depend on it
/// source   equation 7 of the FPPG paper, completed beyond the walls as in relax_volume()
std::vector<double> shepard_sums(std::span<const Vec3> particles,
                                 const VolumeSurroundings& surroundings,
                                 const ShepardOptions& options, int threads);

} // namespace fppg
