#pragma once

#include "fppg/fitted_walls.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace fppg
{

/// How evenly particles stand after an iteration; lengths in dp. Spacing is the distance of a
/// surface particle to the nearest particle of its own sheet, of any kind.
struct RelaxProgress
{
    int iteration = 0; ///< from 1; 0: before the first
    std::size_t particles = 0;
    double spacing_mean = 0;
    double spacing_variation = 0;    ///< coefficient of variation
    double largest_displacement = 0; ///< of this iteration
    /// Where the particles are relaxed in pieces, the one that this is of, from 1, and their
    /// number; particles, spacing and iteration are then of this piece.
    std::size_t piece = 1, pieces = 1;
};

struct RelaxSurfaceOptions
{
    double dp = 0; ///< metres, above 0
    /// Smoothing length in dp, 0.5 to 2. A layer of one particle per dp^2 is unstable from 0.95 to
    /// 1.05 and at 1.5.
    double h = 0.8;
    int iterations = 0;       ///< exactly this many; 0: until the spacing no longer improves
    int max_iterations = 100; ///< where the number is not fixed
    /// It no longer improves when its coefficient of variation falls by less than this in 3
    /// iterations, not judged before 18; for less than 10,000 particles in 12, not before 58.
    double tolerance = 1e-3;
    /// More particles than this are relaxed in pieces one after the other, so that memory for
    /// relaxing is that of a piece: whole bodies, and slabs of those with more particles. A slab
    /// takes in the last 10 dp of the one before, so that they meet without a seam.
    std::size_t together = 2'000'000;
    /// Called after every iteration. False ends the relaxation, and the state reached is kept;
    /// what it throws is passed on, and the particles stay as they were given (in pieces: those of
    /// the piece and of later ones).
    std::function<bool(const RelaxProgress&)> on_progress = {};
    /// Iterations between two calls with the particles as they stand, on their facets; 0: no call.
    /// What it throws is passed on. With calls, all particles are relaxed together.
    int snapshot_interval = 0;
    std::function<void(int iteration, const WallParticles&)> on_snapshot = {};
    /// Where particles may be put into holes, by index of the body, position and normal of the
    /// surface; empty: everywhere. Called from several threads.
    std::function<bool(std::size_t, const Vec3&, const Vec3&)> may_insert = {};
};

struct RelaxSurfaceReport
{
    RelaxProgress before; ///< iteration 0
    RelaxProgress after;
    std::size_t inserted = 0; ///< in holes
    std::size_t removed = 0;  ///< too near another
    std::size_t projected =
        0;                    ///< steps that crossed too many facets and ended at the nearest point
    std::size_t returned = 0; ///< steps that were given up
};

/// Spreads the surface particles of fitted walls evenly. They push one another along the surface;
/// corner and edge particles stand still and push.
///
/// A particle moves in the plane of its facet and is taken back to the surface every few steps by
/// sliding over the facets; it never crosses a feature edge or an open edge, so it stays on its
/// sheet. Positions end on the facets to rounding of double: those on a round shape's true surface
/// are taken to the facets first, and the caller takes them back.
/// Where points of the surface are farther than 0.735 dp from all particles, particles are put in;
/// those nearer than 0.7 dp to another are taken out. After the last of these changes only the
/// particles near one move, for five iterations.
///
/// As in fit_surface(), normals more than 120 degrees apart are of two sheets (the sides of a thin
/// plate), which do not push each other unless edges, corners or a gap bring them nearer than 0.6
/// dp; an edge or corner particle has the mean normal of its facets.
///
/// bodies     with mesh and features; the particles name them
/// particles  by body; those of a body keep their order, and new ones follow at its end with the mk
///            of the particle nearest to them, or that of their facet where the nearest one is of
///            another part of a combination
/// held       empty, or one value per particle: one that is not 0 holds it still. Kept in step with
///            the particles; a new one next to a held surface particle is held
/// threads    number of threads; the result does not depend on it
/// throws     GeometryError for a dp or h out of range; what on_progress throws
/// source     FPPG paper, "Interparticle force": equation 15 with equal target pressures and
///            Wendland's kernel, and pushes below 1.05 and 0.8 dp. Steps follow a heavy-ball scheme
///            with restart instead of the paper's damped time integration
/// cost       about 4 microseconds per particle in all on one core (25 to 45 iterations); 300 bytes
///            per particle of a piece, and 16 for each of all particles where there are pieces
RelaxSurfaceReport relax_surface(const std::vector<FittedBody>& bodies, WallParticles& particles,
                                 std::vector<char>& held, const RelaxSurfaceOptions& options,
                                 int threads);

} // namespace fppg
