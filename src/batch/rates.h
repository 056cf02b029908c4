#pragma once

namespace fppg
{

/// What particles cost, for estimates: measured with the release build on an AMD EPYC, one thread,
/// with the cases of cases/ (gear, tyre, ford; lattice, -fit:raw and -fit). A factor of two off on
/// another machine is usual.
struct Rates
{
    double base_bytes = 8e6;                 ///< of the program itself
    double bytes_per_thread = 2e6;           ///< pieces of files being filled
    double bytes_per_run = 100;              ///< of nodes in a column: while drawn, as particles
    double bytes_per_triangle = 600;         ///< of mesh files, with the trees to search them
    double bytes_a_wall_particle = 600;      ///< off the lattice, placed
    double bytes_a_relaxed_particle = 500;   ///< besides, with the band around it
    double picture_bytes_per_particle = 200; ///< with its sphere and the tree over them

    double seconds_to_start = 0.01;
    double seconds_a_wall_particle = 6e-6;     ///< placed, with its zone of the lattice; one thread
    double seconds_a_relaxed_particle = 50e-6; ///< with the band around it; one thread
    double written_bytes_a_second = 1e9;

    double bi4_bytes = 44;      ///< a particle: id, position, velocity, density
    double normal_bytes = 12;   ///< a boundary particle of a case with normals
    double vtk_bytes = 36;      ///< a particle, in _All.vtk, and again in _Bound.vtk or _Fluid.vtk
    double wall_vtk_bytes = 20; ///< besides, where walls are fitted: kind, normal, distance
};

inline constexpr Rates rates;

} // namespace fppg
