#pragma once

namespace fppg
{

/// What particles cost, for estimates: measured with the release build on an AMD EPYC, one thread,
/// with a ball (surface, filled, in layers, inside; -fit:raw and -fit), an open tank with fluid and
/// the gearbox and the wet road of cases/new; balancing and fluid beside walls with those of
/// cases/. A factor of two off on another machine is usual without a calibration.
struct Rates
{
    double base_bytes = 8e6;                 ///< of the program itself
    double bytes_per_thread = 2e6;           ///< pieces of files being filled
    double bytes_per_run = 100;              ///< of nodes in a column: while drawn, as particles
    double bytes_per_triangle = 660;         ///< of mesh files, with the trees to search them
    double bytes_a_fitted_facet = 220;       ///< of body-fitted draws, besides
    double bytes_a_wall_particle = 44;       ///< off the lattice, with the nodes that it covers
    double bytes_a_laid_particle = 34;       ///< besides, while they are laid
    double bytes_a_relaxed_particle = 330;   ///< besides, of those relaxed together
    double relaxed_together = 2e6;           ///< RelaxSurfaceOptions::together
    double bytes_a_piece_particle = 16;      ///< of all that are relaxed in pieces
    double bytes_a_band_particle = 340;      ///< of a volume that is relaxed
    double bytes_to_fit = 6e6;               ///< where any wall is fitted
    double bytes_a_cut_place = 4900;         ///< of a surface with layers, dp^2: its distance field
    double bytes_a_cut_particle = 2450;      ///< the surface that those of layers are laid on
    double bytes_a_layered_facet = 520;      ///< of the wet surface, for normals
    double bytes_a_balanced_particle = 870;  ///< of fluid
    double bytes_a_wet_particle = 1100;      ///< of walls, where such fluid is near
    double picture_bytes_per_particle = 200; ///< with its sphere and the tree over them

    double seconds_to_start = 0.01;
    double seconds_a_wall_particle = 2.6e-6; ///< placed, with its zone of the lattice; one thread
    double seconds_a_facet = 6e-6;           ///< of a body-fitted mesh: mended, searched
    double seconds_a_relaxed_particle = 6.7e-6;
    double seconds_a_band_particle = 22e-6;
    double seconds_a_fluid_particle = 24e-6;   ///< relaxed beside walls
    double seconds_a_cut_place = 20e-6;        ///< of a surface with layers, dp^2
    double seconds_a_cut_particle = 5e-6;      ///< the surface that it is laid on
    double seconds_a_layer_particle = 11e-6;   ///< laid
    double depths_a_layer_particle = 30;       ///< asked for while it is laid
    double depths_where_rough = 80;            ///< besides, a particle where walls are rough
    double seconds_a_layered_line = 50e-6;     ///< of creases of layers, dp of the edge
    double seconds_a_balanced_particle = 5e-6; ///< of fluid: gathered, its pressure found
    double seconds_a_balanced_step = 0.045e-6; ///< steps_to_balance()
    double band_particles = 2.3;               ///< of a solid, a particle on its surface
    double written_bytes_a_second = 1e9;

    double bi4_bytes = 44;      ///< a particle: id, position, velocity, density
    double normal_bytes = 12;   ///< a boundary particle of a case with normals
    double vtk_bytes = 36;      ///< a particle, in _All.vtk, and again in _Bound.vtk or _Fluid.vtk
    double wall_vtk_bytes = 20; ///< besides, where walls are fitted: kind, normal, distance
};

inline constexpr Rates rates;

} // namespace fppg
