#pragma once

namespace fppg
{

/// Seconds of a run, by what it does.
struct StageSeconds
{
    double drawing = 0; ///< the lattice, surfaces and their layers, and what is read for them
    double relaxing = 0;
    double balancing = 0;
    double writing = 0;
};

/// What a run does, in numbers that cost time or memory (rates.h); of body-fitted walls but for the
/// first four.
struct EstimatedWork
{
    double draw_seconds = 0; ///< measured: reading, and drawing all on the lattice
    double runs = 0;         ///< of nodes in columns of the lattice
    double triangles = 0;    ///< drawn
    double output_bytes = 0;

    double wall_particles_with_normals = 0; ///< of the whole case
    double facets = 0;
    double layered_facets = 0; ///< of them, of walls with layers
    double on_surfaces = 0;    ///< particles
    double laid_layers = 0;    ///< particles behind the surface
    double layered_lines = 0;  ///< dp of creases of walls with layers
    double cut_area = 0;       ///< surfaces with layers, dp^2
    double most_cut = 0;       ///< the largest of one draw, dp^2
    double cut_particles = 0;  ///< the surfaces that layers are laid on, dp^2
    double search_seconds = 0; ///< to lay layers, tried on this machine, one thread
    double relaxed = 0;        ///< particles on surfaces and in layers
    double in_band = 0;        ///< particles inside solids that are relaxed too
    double relaxed_fluid = 0;
    double balanced_fluid = 0;
    double balanced_walls = 0; ///< particles that its forces reach
    double balanced_steps = 0; ///< steps_to_balance()
};

/// The memory of a run at its peak, bytes.
double memory_of(const EstimatedWork& work, int threads);

/// The time of a run.
///
/// speed  machine_speed.h: times the seconds of rates.h
StageSeconds seconds_of(const EstimatedWork& work, int threads, double speed);

} // namespace fppg
