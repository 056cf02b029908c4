#include "batch/estimated_work.h"

#include "batch/rates.h"

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

/// Of particles of surfaces: many are relaxed in pieces.
double bytes_to_relax(double particles)
{
    const double pieces = std::max(1.0, std::ceil(particles / rates.relaxed_together));
    return rates.bytes_a_relaxed_particle * particles / pieces +
           (pieces > 1 ? rates.bytes_a_piece_particle * particles : 0);
}

} // namespace

double memory_of(const EstimatedWork& work, int threads)
{
    const double laid = work.on_surfaces + work.laid_layers;
    const double kept = rates.base_bytes + rates.bytes_per_thread * threads +
                        rates.bytes_a_fitted_facet * work.facets +
                        rates.bytes_per_triangle * work.triangles +
                        rates.bytes_a_wall_particle * laid + (laid > 0 ? rates.bytes_to_fit : 0) +
                        rates.normal_bytes * work.wall_particles_with_normals;
    return kept + std::max({rates.bytes_per_run * work.runs, rates.bytes_a_laid_particle * laid,
                            rates.bytes_a_cut_place * work.most_cut +
                                rates.bytes_a_cut_particle * work.cut_particles,
                            bytes_to_relax(std::max(work.relaxed, work.laid_layers)) +
                                rates.bytes_a_band_particle * work.in_band,
                            rates.bytes_a_layered_facet * work.layered_facets,
                            rates.bytes_a_balanced_particle * work.balanced_fluid +
                                rates.bytes_a_wet_particle * work.balanced_walls});
}

StageSeconds seconds_of(const EstimatedWork& work, int threads, double speed)
{
    const double on_threads = speed / threads;
    StageSeconds out;
    out.drawing = rates.seconds_to_start + work.draw_seconds + work.search_seconds / threads +
                  on_threads * (rates.seconds_a_facet * work.facets +
                                rates.seconds_a_wall_particle * work.on_surfaces +
                                rates.seconds_a_cut_place * work.cut_area +
                                rates.seconds_a_cut_particle * work.cut_particles +
                                rates.seconds_a_layer_particle * work.laid_layers +
                                rates.seconds_a_layered_line * work.layered_lines);
    out.relaxing = on_threads * (rates.seconds_a_relaxed_particle * work.relaxed +
                                 rates.seconds_a_band_particle * work.in_band +
                                 rates.seconds_a_fluid_particle * work.relaxed_fluid);
    out.balancing = on_threads * (rates.seconds_a_balanced_particle * work.balanced_fluid +
                                  rates.seconds_a_balanced_step * work.balanced_steps);
    out.writing = work.output_bytes / rates.written_bytes_a_second;
    return out;
}

} // namespace fppg
