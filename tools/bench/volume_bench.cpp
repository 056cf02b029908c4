// Relaxes the volume particles along the surface of an STL file and says how even they are before
// and after, and how long that takes.
//
//   volume_bench mesh.stl DP [clearance_dp] [band_dp] [h_dp] [iterations] [threads]
//                [inside|outside] [fit|keep] [quadrature]
//
// With the last word what lies beyond the wall is summed over a lattice of dp / 4 as
// well, which knows corners and curvature.

#include "fppg/features.h"
#include "fppg/fit.h"
#include "fppg/lattice.h"
#include "fppg/relax_volume.h"
#include "fppg/shapes.h"
#include "meshes/mesh_query.h"
#include "relax/kernel.h"
#include "relax/neighbour_list.h"

#include <malloc.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <new>

namespace
{

using fppg::Vec3;

std::atomic<std::size_t> allocated{0};
std::atomic<std::size_t> allocated_at_peak{0};

struct Statistics
{
    double mean = 0;
    double std = 0;
    double min = 0;
    double max = 0;
};

Statistics statistics_of(const std::vector<double>& values)
{
    Statistics s;
    if (values.empty()) return s;
    for (const double v : values) s.mean += v / static_cast<double>(values.size());
    for (const double v : values)
        s.std += (v - s.mean) * (v - s.mean) / static_cast<double>(values.size());
    s.std = std::sqrt(s.std) / s.mean;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    s.min = *low;
    s.max = *high;
    return s;
}

/// Nodes of a lattice around a mesh that are inside it (or outside), with their distances.
struct Nodes
{
    std::vector<Vec3> positions;
    std::vector<double> distances;
};

Nodes nodes_of(const fppg::MeshQuery& query, const fppg::Box3& bounds, double dp, bool is_inside,
               double farthest, int threads)
{
    fppg::LatticeGrid grid;
    grid.dp = dp;
    const double margin = is_inside ? 2 * dp : farthest + 2 * dp;
    grid.origin = bounds.min - Vec3{margin, margin, margin};
    // Off the corners of the mesh by a number that no drawing has.
    grid.origin = grid.origin + dp * Vec3{0.137, 0.293, 0.411};
    for (int axis = 0; axis < 3; ++axis)
        grid.n[static_cast<std::size_t>(axis)] =
            static_cast<std::uint32_t>((bounds.max[axis] + margin - grid.origin[axis]) / dp + 1);
    const auto spans = fppg::inside_spans(query.soup(), grid, threads);
    std::vector<char> inside(std::size_t{grid.n[0]} * grid.n[1] * grid.n[2], 0);
    const auto at = [&](std::size_t i, std::size_t j, std::size_t k)
    { return (i * grid.n[1] + j) * grid.n[2] + k; };
    for (std::size_t s = 0; s < spans.slabs.size(); ++s)
        for (const auto& span : spans.slabs[s])
            for (std::size_t k = span.z_begin; k < span.z_end; ++k)
                inside[at(spans.x_begin + s, span.y, k)] = 1;
    Nodes nodes;
    for (std::size_t i = 0; i < grid.n[0]; ++i)
        for (std::size_t j = 0; j < grid.n[1]; ++j)
            for (std::size_t k = 0; k < grid.n[2]; ++k)
            {
                if ((inside[at(i, j, k)] != 0) != is_inside) continue;
                const Vec3 p =
                    grid.origin + dp * Vec3{static_cast<double>(i), static_cast<double>(j),
                                            static_cast<double>(k)};
                const double distance = query.closest_point(p).distance;
                if (distance > farthest) continue;
                nodes.positions.push_back(p);
                nodes.distances.push_back(distance);
            }
    return nodes;
}

/// Shepard sums of particles `at` from points that weigh `weight` each.
std::vector<double> sums_from(const std::vector<Vec3>& at, const std::vector<Vec3>& from,
                              double weight, double dp, double h, int threads)
{
    fppg::PointArrays points;
    for (const auto* some : {&at, &from})
        for (const Vec3& p : *some)
        {
            points.x.push_back(static_cast<float>((p.x - at[0].x) / dp));
            points.y.push_back(static_cast<float>((p.y - at[0].y) / dp));
            points.z.push_back(static_cast<float>((p.z - at[0].z) / dp));
        }
    fppg::NeighbourList list(static_cast<float>(2 * h), 0);
    std::vector<double> sums(at.size(), 0);
    list.build(
        points, threads, [&](std::uint32_t i) { return i < at.size(); },
        [&](std::uint32_t i, std::uint32_t j)
        {
            if (j >= at.size())
                sums[i] += weight * fppg::wendland_alpha_3d(h) *
                           fppg::wendland(std::hypot(double{points.x[i]} - double{points.x[j]},
                                                     double{points.y[i]} - double{points.y[j]},
                                                     double{points.z[i]} - double{points.z[j]}) /
                                          h);
            return false;
        });
    return sums;
}

} // namespace

void* operator new(std::size_t size)
{
    void* const p = std::malloc(size);
    if (p == nullptr) throw std::bad_alloc();
    const std::size_t now = allocated += malloc_usable_size(p);
    for (std::size_t peak = allocated_at_peak;
         peak < now && !allocated_at_peak.compare_exchange_weak(peak, now);)
        ;
    return p;
}

void operator delete(void* p) noexcept
{
    allocated -= malloc_usable_size(p);
    std::free(p);
}

void operator delete(void* p, std::size_t) noexcept
{
    operator delete(p);
}

int main(int argc, char** argv)
{
    if (argc < 3)
    {
        std::fprintf(stderr,
                     "usage: volume_bench mesh.stl DP [clearance] [band] [h] [iterations] "
                     "[threads] [inside|outside] [fit|keep] [quadrature]\n");
        return 2;
    }
    const auto argument = [&](int i, double otherwise)
    { return argc > i ? std::atof(argv[i]) : otherwise; };
    const double dp = std::atof(argv[2]);
    const double clearance = argument(3, 0.55);
    const double band = argument(4, 3);
    fppg::RelaxVolumeOptions options;
    options.dp = dp;
    options.h_dp = argument(5, 1);
    options.iterations = static_cast<int>(argument(6, 30));
    const int threads = static_cast<int>(argument(7, 1));
    const bool is_inside = argc < 9 || argv[8][0] != 'o';
    options.fit_count = argc > 9 && argv[9][0] == 'f';
    const bool has_quadrature = argc > 10;

    fppg::MeshReport report;
    const auto mesh = fppg::repair_mesh(fppg::read_stl(argv[1]).soup, {}, threads, report);
    fppg::TriangleSoup soup;
    for (const auto& facet : mesh.facets)
        for (const auto v : facet) soup.vertices.push_back(mesh.vertices[v]);
    const fppg::MeshQuery query(std::move(soup), threads);
    fppg::FeatureOptions feature_options;
    feature_options.dp = dp;
    const auto features = fppg::find_features(mesh, feature_options);
    fppg::FitOptions fit_options;
    fit_options.dp = dp;
    const auto walls = fppg::fit_surface(
        mesh, features, fppg::place_feature_particles(mesh, features, feature_options), fit_options,
        threads);

    const Nodes nodes =
        nodes_of(query, report.bounds, dp, is_inside, is_inside ? 1e30 : 8 * dp, threads);
    std::vector<Vec3> moving;
    std::vector<Vec3> held;
    std::size_t volume_particles = 0;
    for (std::size_t i = 0; i < nodes.positions.size(); ++i)
    {
        if (nodes.distances[i] < clearance * dp) continue;
        if (nodes.distances[i] < (band + 2.6) * dp)
            (nodes.distances[i] < band * dp ? moving : held).push_back(nodes.positions[i]);
        ++volume_particles;
    }
    fppg::VolumeSurroundings around;
    around.held = held;
    around.walls = walls.positions;
    std::atomic<std::size_t> queries{0};
    around.closest = [&](const Vec3& p)
    {
        queries.fetch_add(1, std::memory_order_relaxed);
        return query.closest_point(p).point;
    };
    const double counted =
        static_cast<double>(volume_particles) + 0.5 * static_cast<double>(walls.positions.size());
    std::printf("%zu moving, %zu held, %zu walls; count dp3 / volume %.4f\n", moving.size(),
                held.size(), walls.positions.size(), counted * dp * dp * dp / report.volume);

    const std::vector<Vec3> beyond =
        has_quadrature ? [&]
    {
        Nodes fine = nodes_of(query, report.bounds, dp / 4, !is_inside, 3.2 * dp, threads);
        std::vector<Vec3> far;
        for (std::size_t i = 0; i < fine.positions.size(); ++i)
            if (fine.distances[i] > 0.5 * dp) far.push_back(fine.positions[i]);
        return far;
    }()
                       : std::vector<Vec3>{};

    const auto say = [&](const char* when)
    {
        std::vector<double> distances;
        for (const Vec3& p : moving) distances.push_back(query.closest_point(p).distance / dp);
        fppg::ShepardOptions shepard;
        shepard.dp = dp;
        const auto banded = [&](const std::vector<double>& sums)
        {
            std::vector<double> near;
            for (std::size_t i = 0; i < sums.size(); ++i)
                if (distances[i] < 2.6) near.push_back(sums[i]);
            return statistics_of(near);
        };
        const Statistics s = banded(fppg::shepard_sums(moving, around, shepard, threads));
        std::printf("%s: S mean %.4f std %.2f %% min %.3f max %.3f", when, s.mean, 100 * s.std,
                    s.min, s.max);
        if (has_quadrature)
        {
            auto without = around;
            without.closest = {};
            auto sums = fppg::shepard_sums(moving, without, shepard, threads);
            const auto more = sums_from(moving, beyond, 1.0 / 64, dp, shepard.h_dp, threads);
            for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += more[i];
            const Statistics t = banded(sums);
            std::printf("; by quadrature mean %.4f std %.2f %% min %.3f max %.3f", t.mean,
                        100 * t.std, t.min, t.max);
        }
        std::vector<Vec3> all = moving;
        all.insert(all.end(), held.begin(), held.end());
        all.insert(all.end(), walls.positions.begin(), walls.positions.end());
        fppg::PointArrays points;
        for (const Vec3& p : all)
        {
            points.x.push_back(static_cast<float>((p.x - all[0].x) / dp));
            points.y.push_back(static_cast<float>((p.y - all[0].y) / dp));
            points.z.push_back(static_cast<float>((p.z - all[0].z) / dp));
        }
        fppg::NeighbourList list(1.7f, 0);
        std::vector<double> nearest(moving.size(), 1.7);
        list.build(
            points, threads, [&](std::uint32_t i) { return i < moving.size(); },
            [&](std::uint32_t i, std::uint32_t j)
            {
                nearest[i] = std::min(nearest[i], norm(all[i] - all[j]) / dp);
                return false;
            });
        const Statistics nn = statistics_of(nearest);
        const auto side = std::count_if(moving.begin(), moving.end(),
                                        [&](const Vec3& p)
                                        {
                                            int sum = 0;
                                            for (const auto& c : query.crossings(p, 0))
                                                sum -= c.step;
                                            return (sum > 0) != is_inside;
                                        });
        std::printf(
            "\n        nn mean %.3f std/mean %.3f min %.3f; nearest to the wall %.3f; %ld on "
            "the wrong side\n",
            nn.mean, nn.std / 1, nn.min, *std::min_element(distances.begin(), distances.end()),
            side);
    };
    say("before");
    options.on_iteration = [](const fppg::RelaxVolumeProgress& p)
    {
        if (p.iteration <= 5 || p.iteration % 10 == 0)
            std::printf("   %3d: S %.4f %.2f %%, largest step %.4f\n", p.iteration, p.shepard_mean,
                        100 * p.shepard_variation, p.largest_step_dp);
        return true;
    };
    const auto before = moving;
    const std::size_t memory = allocated;
    queries = 0;
    allocated_at_peak = memory;
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu_start = std::clock();
    const auto result = fppg::relax_volume(moving, around, options, threads);
    const double cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto more = static_cast<double>(allocated_at_peak - memory);
    const std::size_t made = queries;
    const auto n = static_cast<double>(moving.size());
    std::printf(
        "%d iterations, %.3f s (%.3f of processor), %.3f us a particle and iteration; %zu "
        "held at a surface, %zu steps shortened; peak %.0f bytes a particle more, %.2f wall "
        "queries a particle\n",
        result.iterations, seconds, cpu_seconds,
        1e6 * cpu_seconds / n / std::max(1, result.iterations), result.held_at_surface,
        result.pushed_back, more / n, static_cast<double>(made) / n);
    double sum = 0;
    for (std::size_t i = 0; i < moving.size(); ++i)
        sum += norm(moving[i] - before[options.fit_count ? result.sources[i] : i]) / dp;
    say("after");
    std::printf("        %zu removed, %zu inserted\n", result.removed, result.inserted);
    std::printf("        moved %.3f dp on average\n", sum / n);
    return 0;
}
