#include "fppg/fit.h"

#include "core/parallel.h"
#include "fit/chart_filler.h"
#include "fit/crossed_cells.h"
#include "fit/first_rows.h"
#include "fit/for_each_chart.h"
#include "fppg/error.h"
#include "meshes/mesh_query.h"
#include "meshes/point_grid.h"
#include "platform/memory.h"

#include <algorithm>

namespace fppg
{

namespace
{

/// Cells whose closest points are the same point give one particle; in dp.
constexpr double same_point = 1e-3;

std::uint32_t facet_of(const FeatureParticle& particle, const SurfaceMesh& mesh,
                       const std::vector<std::uint32_t>& facet_of_vertex)
{
    if (particle.vertex != no_index) return facet_of_vertex[particle.vertex];
    return mesh.edge_facets[particle.edge][0];
}

std::vector<std::uint32_t> find_a_facet_per_vertex(const SurfaceMesh& mesh)
{
    std::vector<std::uint32_t> facet(mesh.vertices.size(), no_index);
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        for (const std::uint32_t v : mesh.facets[f])
            if (facet[v] == no_index) facet[v] = f;
    return facet;
}

/// Begins a result with the particles of corners, then those of lines.
SurfaceParticles take_feature_particles(const SurfaceMesh& mesh,
                                        const std::vector<FeatureParticle>& particles)
{
    const auto facet_of_vertex = find_a_facet_per_vertex(mesh);
    SurfaceParticles result;
    for (const bool is_corner : {true, false})
        for (const FeatureParticle& particle : particles)
        {
            if (particle.is_corner != is_corner) continue;
            result.positions.push_back(particle.position);
            result.kinds.push_back(is_corner ? FitKind::Corner : FitKind::Edge);
            result.facets.push_back(facet_of(particle, mesh, facet_of_vertex));
        }
    return result;
}

/// Moves the particles of all charts to the end of a result. What charts held goes back to the
/// system on the way, so that not all of them are there twice.
void gather(FillState& state, int threads, SurfaceParticles& result)
{
    constexpr std::size_t particles_at_once = 2'000'000;
    const std::size_t charts = state.particles.size();
    std::vector<std::size_t> first(charts + 1, result.positions.size());
    for (std::size_t c = 0; c < charts; ++c)
        first[c + 1] = first[c] + state.particles[c].sites.size();
    result.positions.reserve(first.back());
    result.facets.reserve(first.back());
    for (std::size_t begin = 0, end = 0; begin < charts; begin = end)
    {
        while (end < charts && first[end] - first[begin] < particles_at_once) ++end;
        result.positions.resize(first[end]);
        result.facets.resize(first[end]);
        parallel_for(end - begin, threads,
                     [&](std::size_t k)
                     {
                         const std::size_t c = begin + k;
                         std::size_t at = first[c];
                         for (const SurfaceSite& site : state.particles[c].sites)
                         {
                             result.positions[at] = site.position;
                             result.facets[at++] = state.mesh.facets[site.facet].parent;
                         }
                         state.particles[c] = {};
                     });
        if (first[end] - first[begin] >= particles_at_once) return_free_memory();
    }
}

void add_area_particles(const SurfaceMesh& mesh, const Features& features,
                        const std::vector<FeatureParticle>& feature_particles, double dp,
                        int threads, SurfaceParticles& result)
{
    const WorkMesh work = make_work_mesh(mesh, features, longest_chart_side * dp, threads);
    const Charts charts(work, dp);
    const std::vector<FeatureSite> sites =
        make_feature_sites(mesh, work, feature_particles, threads);
    FillState state{work, charts, sites, dp, std::vector<ChartParticles>(charts.size())};
    state.share_out_features();
    for (const SurfaceRay& row :
         lay_first_rows(mesh, work, features, feature_particles, dp, threads))
        state.particles[charts.of_facet(row.facet)].rows.push_back(row);

    for_each_chart(state, threads,
                   [](ChartFiller& filler, std::uint32_t c) { filler.advance_front(c); });
    for (ChartParticles& of_chart : state.particles) of_chart.leaving = {};
    for_each_chart(state, threads,
                   [](ChartFiller& filler, std::uint32_t c) { filler.fill_holes(c); });

    gather(state, threads, result);
}

void add_cell_particles(const SurfaceMesh& mesh, const FitOptions& options, int threads,
                        SurfaceParticles& result)
{
    const MeshQuery query(soup_of(mesh), threads);
    query.prepare_nearest();
    const auto cells = find_crossed_cells(mesh, options.lattice_origin, options.dp, threads);
    std::vector<ClosestPoint> closest(cells.size());
    parallel_for(
        cells.size(), threads,
        [&](std::size_t i)
        {
            const Vec3 node{static_cast<double>(cells[i][0]), static_cast<double>(cells[i][1]),
                            static_cast<double>(cells[i][2])};
            closest[i] = query.closest_point(options.lattice_origin + node * options.dp);
        },
        1024);
    const double near = same_point * options.dp;
    PointGrid grid(near, result.positions.size() + closest.size());
    for (const Vec3& p : result.positions) grid.add(p);
    for (const ClosestPoint& c : closest)
    {
        if (grid.has_nearer(c.point, near)) continue;
        grid.add(c.point);
        result.positions.push_back(c.point);
        result.facets.push_back(c.facet);
    }
}

} // namespace

SurfaceParticles fit_surface(const SurfaceMesh& mesh, const Features& features,
                             const std::vector<FeatureParticle>& feature_particles,
                             const FitOptions& options, int threads)
{
    SurfaceParticles result = take_feature_particles(mesh, feature_particles);
    if (options.density == FitDensity::Cell)
        add_cell_particles(mesh, options, threads, result);
    else
        add_area_particles(mesh, features, feature_particles, options.dp, threads, result);
    result.kinds.resize(result.positions.size(), FitKind::Surface);
    return result;
}

} // namespace fppg
