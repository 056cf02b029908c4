// Fits particles to the surface of an STL file, relaxes them on request, says how long that takes,
// and writes them as a legacy VTK file with their kind as mk and the normal of their facet.
//
//   fit_bench mesh.stl DP [out.vtk] [threads] [area|cell] [--relax N] [--h H] [--together N]
//   [--quality]
//
// N of --relax is the number of iterations, 0 for as many as improve the spacing; of --together how
// many particles are relaxed at once.

#include "fppg/features.h"
#include "fppg/fit.h"
#include "fppg/relax.h"
#include "fppg/shapes.h"
#include "meshes/point_grid.h"

#include <sys/resource.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

namespace
{

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The most memory that the process had so far.
double peak_mb()
{
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<double>(used.ru_maxrss) / 1000;
}

void write_double(std::ofstream& out, double value)
{
    auto bits = std::bit_cast<std::uint64_t>(value);
    if constexpr (std::endian::native == std::endian::little) bits = __builtin_bswap64(bits);
    out.write(reinterpret_cast<const char*>(&bits), 8);
}

void write_vtk(const std::string& path, const fppg::SurfaceMesh& mesh,
               const fppg::SurfaceParticles& particles)
{
    std::ofstream out(path, std::ios::binary);
    const std::size_t n = particles.positions.size();
    out << "# vtk DataFile Version 3.0\nfitted\nBINARY\nDATASET POLYDATA\nPOINTS " << n
        << " double\n";
    for (const fppg::Vec3& p : particles.positions)
        for (int axis = 0; axis < 3; ++axis) write_double(out, p[axis]);
    out << "\nPOINT_DATA " << n << "\nSCALARS Mk unsigned_char 1\nLOOKUP_TABLE default\n";
    for (const fppg::FitKind kind : particles.kinds) out.put(static_cast<char>(kind));
    out << "\nNORMALS Normal double\n";
    for (const std::uint32_t facet : particles.facets)
        for (int axis = 0; axis < 3; ++axis) write_double(out, mesh.normals[facet][axis]);
    out << "\n";
}

/// Takes an option with a value out of the arguments.
const char* take_option(std::vector<char*>& arguments, const char* name)
{
    for (std::size_t i = 1; i + 1 < arguments.size(); ++i)
        if (std::strcmp(arguments[i], name) == 0)
        {
            const char* value = arguments[i + 1];
            const auto at = arguments.begin() + static_cast<std::ptrdiff_t>(i);
            arguments.erase(at, at + 2);
            return value;
        }
    return nullptr;
}

void relax(fppg::SurfaceMesh& mesh, const fppg::Features& features,
           fppg::SurfaceParticles& particles, const fppg::RelaxSurfaceOptions& options, int threads)
{
    std::vector<fppg::FittedBody> bodies(1);
    bodies[0].mesh = std::move(mesh);
    bodies[0].features = features;
    fppg::WallParticles walls;
    walls.bodies.assign(particles.positions.size(), 0);
    walls.mk.assign(particles.positions.size(), 0);
    walls.positions = std::move(particles.positions);
    walls.kinds = std::move(particles.kinds);
    walls.facets = std::move(particles.facets);
    std::vector<char> held;
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu_start = std::clock();
    const auto report = fppg::relax_surface(bodies, walls, held, options, threads);
    const double seconds = seconds_since(start);
    const double cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    const double updates = static_cast<double>(walls.size()) * report.after.iteration;
    std::printf(
        "   relaxed: %d iterations, %zu particles (+%zu -%zu), spacing %.4f +- %.4f to "
        "%.4f +- %.4f, %zu projected, %zu returned\n   %.3f s (%.3f s of processor, "
        "%.3f us a particle, %.3f an iteration), peak %.0f MB\n",
        report.after.iteration, walls.size(), report.inserted, report.removed,
        report.before.spacing_mean, report.before.spacing_variation, report.after.spacing_mean,
        report.after.spacing_variation, report.projected, report.returned, seconds, cpu_seconds,
        1e6 * cpu_seconds / static_cast<double>(walls.size()), 1e6 * cpu_seconds / updates,
        peak_mb());
    particles.positions = std::move(walls.positions);
    particles.kinds = std::move(walls.kinds);
    particles.facets = std::move(walls.facets);
    mesh = std::move(bodies[0].mesh);
}

/// From a place to the nearest particle but one, in dp; at most 2.
double distance_to_nearest(const fppg::PointGrid& grid, const fppg::Vec3& place, double dp,
                           std::size_t but)
{
    double best = 4 * dp * dp;
    grid.for_each_near(place, 2 * dp,
                       [&](std::uint32_t i, double squared)
                       {
                           if (i != but) best = std::min(best, squared);
                       });
    return std::sqrt(best) / dp;
}

/// The farthest of 30 surface points a dp squared from its nearest particle, in dp.
double farthest_surface_point(const fppg::SurfaceMesh& mesh, const fppg::PointGrid& grid, double dp)
{
    double farthest = 0;
    double due = 0;
    double count = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        for (due += 30 * mesh.areas[f] / (dp * dp); due >= 1; due -= 1)
        {
            // The plastic number's sequence spreads points evenly for any count.
            ++count;
            double u = std::fmod(0.5 + 0.7548776662466927 * count, 1.0);
            double v = std::fmod(0.5 + 0.5698402909980532 * count, 1.0);
            if (u + v > 1)
            {
                u = 1 - u;
                v = 1 - v;
            }
            const fppg::Vec3& a = mesh.vertices[mesh.facets[f][0]];
            const fppg::Vec3 place = a + (mesh.vertices[mesh.facets[f][1]] - a) * u +
                                     (mesh.vertices[mesh.facets[f][2]] - a) * v;
            farthest = std::max(farthest, distance_to_nearest(grid, place, dp, SIZE_MAX));
        }
    return farthest;
}

/// Prints how evenly particles stand, and how far the surface is from them.
void print_quality(const fppg::SurfaceMesh& mesh, const fppg::SurfaceParticles& particles,
                   double dp)
{
    const std::size_t n = particles.positions.size();
    fppg::PointGrid grid(dp, n);
    for (const fppg::Vec3& p : particles.positions) grid.add(p);
    double sum = 0, squares = 0, least = 2, count = 0;
    for (std::size_t i = 0; i < n; ++i)
    {
        const double distance = distance_to_nearest(grid, particles.positions[i], dp, i);
        least = std::min(least, distance);
        if (particles.kinds[i] != fppg::FitKind::Surface) continue;
        sum += distance;
        squares += distance * distance;
        ++count;
    }
    const double mean = sum / count;
    std::printf(
        "   nearest particle of those on the surface: mean %.4f, c.v. %.4f; least of all "
        "%.3f; farthest surface point %.3f dp\n",
        mean, std::sqrt(std::max(0.0, squares / count - mean * mean)) / mean, least,
        farthest_surface_point(mesh, grid, dp));
}

/// Counts pairs closer than 0.3 dp, and those of them whose facets look apart: through a plate.
void count_close_pairs(const fppg::SurfaceMesh& mesh, const fppg::SurfaceParticles& particles,
                       double dp)
{
    fppg::PointGrid grid(dp, particles.positions.size());
    for (const fppg::Vec3& p : particles.positions) grid.add(p);
    std::size_t on_features = 0;
    std::size_t through_plates = 0;
    std::size_t others = 0;
    for (std::uint32_t i = 0; i < particles.positions.size(); ++i)
        grid.for_each_near(particles.positions[i], 0.3 * dp,
                           [&](std::uint32_t j, double)
                           {
                               if (j >= i) return;
                               if (particles.kinds[i] != fppg::FitKind::Surface)
                                   ++on_features;
                               else if (dot(mesh.normals[particles.facets[i]],
                                            mesh.normals[particles.facets[j]]) < -0.5)
                                   ++through_plates;
                               else
                                   ++others;
                           });
    std::printf("   closer than 0.3 dp: %zu pairs of features, %zu through plates, %zu others\n",
                on_features, through_plates, others);
}

} // namespace

int main(int count, char** values)
{
    std::vector<char*> argv(values, values + count);
    const char* iterations = take_option(argv, "--relax");
    const char* h = take_option(argv, "--h");
    const char* together = take_option(argv, "--together");
    const auto quality = std::find_if(
        argv.begin(), argv.end(), [](const char* a) { return std::strcmp(a, "--quality") == 0; });
    const bool wants_quality = quality != argv.end();
    if (wants_quality) argv.erase(quality);
    const std::size_t argc = argv.size();
    if (argc < 3)
    {
        std::fprintf(stderr,
                     "usage: fit_bench mesh.stl DP [out.vtk] [threads] [area|cell] "
                     "[--relax N] [--h H] [--together N] [--quality]\n");
        return 2;
    }
    using Clock = std::chrono::steady_clock;
    const double dp = std::atof(argv[2]);
    const int threads = argc > 4 ? std::atoi(argv[4]) : 1;
    fppg::MeshReport report;
    auto mesh = fppg::repair_mesh(fppg::read_stl(argv[1]).soup, {}, threads, report);
    const auto start_lines = Clock::now();
    fppg::FeatureOptions feature_options;
    feature_options.dp = dp;
    const auto features = fppg::find_features(mesh, feature_options);
    const auto on_features = fppg::place_feature_particles(mesh, features, feature_options);
    const double line_seconds = seconds_since(start_lines);
    fppg::FitOptions options;
    options.dp = dp;
    if (argc > 5 && std::strcmp(argv[5], "cell") == 0) options.density = fppg::FitDensity::Cell;
    const auto start = Clock::now();
    const std::clock_t cpu_start = std::clock();
    auto particles = fppg::fit_surface(mesh, features, on_features, options, threads);
    const double seconds = seconds_since(start);
    const double cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    const double peak = peak_mb();
    double area = 0;
    for (const double a : mesh.areas) area += a;
    const auto n = static_cast<double>(particles.positions.size());
    std::printf(
        "%zu facets, %zu on features (%.2f s), %.0f particles, %.3f a dp2, %.3f s "
        "(%.3f s of processor, %.2f us a particle), peak %.0f MB\n",
        mesh.facets.size(), on_features.size(), line_seconds, n, n / area * dp * dp, seconds,
        cpu_seconds, 1e6 * cpu_seconds / n, peak);
    if (iterations != nullptr)
    {
        fppg::RelaxSurfaceOptions relax_options;
        relax_options.dp = dp;
        relax_options.iterations = std::atoi(iterations);
        if (h != nullptr) relax_options.h = std::atof(h);
        if (together != nullptr)
            relax_options.together = static_cast<std::size_t>(std::atof(together));
        relax(mesh, features, particles, relax_options, threads);
    }
    if (wants_quality)
    {
        print_quality(mesh, particles, dp);
        count_close_pairs(mesh, particles, dp);
    }
    if (argc > 3 && std::strcmp(argv[3], "-") != 0) write_vtk(argv[3], mesh, particles);
    return 0;
}
