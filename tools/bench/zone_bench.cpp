// Finds the lattice nodes around the fitted wall of an STL file, and says how well the volume came
// out and how long that took.
//
//   zone_bench mesh.stl DP [threads] [shift] [2d]
//
// The lattice stands on whole multiples of dp, moved by `shift` dp.

#include "fit/inside_angles.h"
#include "fit/near_nodes.h"
#include "fppg/exclusion_band.h"
#include "fppg/features.h"
#include "fppg/fit.h"
#include "fppg/shapes.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace
{

std::size_t count_nodes(const fppg::SpanSet& set)
{
    std::size_t count = 0;
    for (const auto& slab : set.slabs)
        for (const fppg::Span& span : slab) count += span.z_end - span.z_begin;
    return count;
}

/// Of processor time, all threads together.
double seconds_since(std::clock_t start)
{
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 3)
    {
        std::fprintf(stderr, "usage: zone_bench mesh.stl DP [threads] [shift] [2d]\n");
        return 2;
    }
    const double dp = std::atof(argv[2]);
    const int threads = argc > 3 ? std::atoi(argv[3]) : 1;
    const double shift = argc > 4 ? std::atof(argv[4]) : 0;
    const bool is_2d = argc > 5;
    fppg::MeshReport report;
    const auto mesh = fppg::repair_mesh(fppg::read_stl(argv[1]).soup, {}, threads, report);
    fppg::FeatureOptions feature_options;
    feature_options.dp = dp;
    const auto features = fppg::find_features(mesh, feature_options);
    const auto on_features = fppg::place_feature_particles(mesh, features, feature_options);
    fppg::FitOptions fit_options;
    fit_options.dp = dp;
    const auto fit_start = std::clock();
    const auto particles = fppg::fit_surface(mesh, features, on_features, fit_options, threads);
    const double fit_seconds = seconds_since(fit_start);

    fppg::LatticeGrid grid;
    grid.dp = dp;
    grid.is_2d = is_2d;
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto k = static_cast<std::size_t>(axis);
        grid.origin[axis] = (std::floor(report.bounds.min[axis] / dp) - 3 + shift) * dp;
        grid.n[k] = static_cast<std::uint32_t>(
            std::ceil((report.bounds.max[axis] - grid.origin[axis]) / dp) + 4);
    }
    if (is_2d)
    {
        grid.origin.y = 0.5 * (report.bounds.min.y + report.bounds.max.y);
        grid.n[1] = 1;
    }
    fppg::ExclusionBandOptions options;
    options.wall_particles = particles.positions.size();
    options.share_inside = fppg::mean_share_inside(
        mesh, {particles.positions, particles.kinds, particles.facets}, is_2d);
    fppg::TriangleSoup soup;
    for (const auto& facet : mesh.facets)
        for (const std::uint32_t v : facet) soup.vertices.push_back(mesh.vertices[v]);
    const auto near_start = std::clock();
    std::size_t near = 0;
    for (const auto& slab : fppg::find_near_nodes(soup, grid, threads)) near += slab.size();
    const double near_seconds = seconds_since(near_start);
    const auto start = std::clock();
    const auto zone = fppg::exclusion_band(mesh, report, grid, options, threads);
    const double seconds = seconds_since(start);
    std::printf(
        "%zu facets, %zu wall particles (%.3f s); %zu nodes within 1 dp, %.2f us a node to "
        "find, %.2f us in all (%.3f s)\n",
        mesh.facets.size(), particles.positions.size(), fit_seconds, near,
        1e6 * near_seconds / static_cast<double>(near), 1e6 * seconds / static_cast<double>(near),
        seconds);
    std::printf(
        "  volume nodes %zu, zone %zu, clearance %.4f inside %.4f outside, share %.4f, "
        "body %.6g (signed %.6g), error %+.4f %%, disputed %llu, sheets %llu\n",
        count_nodes(zone.volume), count_nodes(zone.zone), zone.clearance_inside_dp,
        zone.clearance_outside_dp, zone.wall_share_inside, zone.body_volume, report.volume,
        100 * zone.volume_error, static_cast<unsigned long long>(zone.disputed_nodes),
        static_cast<unsigned long long>(zone.sheet_facets));
    for (const auto& warning : zone.warnings) std::printf("  %s\n", warning.c_str());
    return 0;
}
