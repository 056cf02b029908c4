#include "walls/thickened.h"

#include "fppg/moving_parts.h"

#include "core/parallel.h"
#include "meshes/measure_facets.h"
#include "meshes/mesh_query.h"
#include "meshes/wall_ball.h"
#include "offset/quadric.h"
#include "scene/surfaces.h"
#include "walls/fluid_boxes.h"
#include "walls/layer_builder.h"
#include "walls/plate_thickness.h"
#include "walls/wet_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace fppg
{
namespace
{

constexpr double two_layers_dp = 2;
/// So much of a gap between two thin parts, as teeth or fins, is left for fluid.
constexpr double open_gap_dp = 1.25;
/// Corners of a thin facet go at most so much farther than its plane.
constexpr double most_mitre = 2;

/// How far the corners of facets go, so that each facet goes as far as it should.
std::vector<Vec3> moves_of_vertices(const SurfaceMesh& mesh, const std::vector<double>& outwards)
{
    std::vector<Quadric> planes(mesh.vertices.size());
    std::vector<double> farthest(mesh.vertices.size(), 0);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        for (const std::uint32_t v : mesh.facets[f])
        {
            planes[v].add_plane(mesh.normals[f], outwards[f]);
            farthest[v] = std::max(farthest[v], outwards[f]);
        }
    std::vector<Vec3> out(mesh.vertices.size());
    for (std::size_t v = 0; v < out.size(); ++v)
    {
        if (!(farthest[v] > 0)) continue;
        out[v] = planes[v].least_point();
        const double length = norm(out[v]);
        if (length > most_mitre * farthest[v])
            out[v] = (most_mitre * farthest[v] / length) * out[v];
    }
    return out;
}

/// How far facets go outwards: a thin part is two_layers_dp thick then, but closes no gap before
/// it.
std::vector<double> moves_of_facets(const SurfaceMesh& mesh, const std::vector<double>& thickness,
                                    double dp, int threads)
{
    const MeshQuery query(soup_of(mesh), threads);
    query.prepare_nearest();
    const ClosestWallPoint closest = [&](const Vec3& p, double within)
    { return query.closest_point(p, within).point; };
    std::vector<double> out(mesh.facets.size(), 0);
    parallel_for(
        out.size(), threads,
        [&](std::size_t f)
        {
            if (!std::isfinite(thickness[f])) return;
            Vec3 middle;
            for (const std::uint32_t v : mesh.facets[f]) middle = middle + mesh.vertices[v] / 3;
            const double wanted = (two_layers_dp * dp - thickness[f]) / 2;
            const WallBall ball =
                largest_ball(middle, mesh.normals[f], wanted + open_gap_dp * dp / 2, closest);
            out[f] = ball.is_opposite ? std::clamp(ball.radius - open_gap_dp * dp / 2, 0.0, wanted)
                                      : wanted;
        },
        256);
    return out;
}

/// A slab 2 dp thick about a solid without thickness, as a box of size 0 along one axis; empty for
/// every other surface.
TriangleSoup slab_about(const TriangleSoup& soup, double dp)
{
    constexpr double flat = 1e-9;
    const auto area_normal = [&](std::size_t f)
    {
        const Vec3* c = &soup.vertices[3 * f];
        return cross(c[1] - c[0], c[2] - c[0]);
    };
    Vec3 normal;
    for (std::size_t f = 0; f < soup.size(); ++f)
        if (const Vec3 n = area_normal(f); norm(n) > norm(normal)) normal = n;
    if (!(norm(normal) > flat * dp * dp)) return {};
    normal = normal / norm(normal);
    TriangleSoup out;
    std::set<std::array<double, 6>> edges; // of the facets of one side, as they run
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        const Vec3* c = &soup.vertices[3 * f];
        if (std::abs(dot(c[0] - soup.vertices[0], normal)) > flat * dp) return {};
        if (!(dot(area_normal(f), normal) > flat * dp * dp)) continue;
        for (const std::size_t k : {0, 1, 2}) out.vertices.push_back(c[k] + dp * normal);
        for (const std::size_t k : {0, 2, 1}) out.vertices.push_back(c[k] - dp * normal);
        for (std::size_t k = 0; k < 3; ++k)
        {
            const Vec3& a = c[k];
            const Vec3& b = c[(k + 1) % 3];
            edges.insert({a.x, a.y, a.z, b.x, b.y, b.z});
        }
    }
    for (const std::array<double, 6>& e : edges)
    {
        const Vec3 a{e[0], e[1], e[2]};
        const Vec3 b{e[3], e[4], e[5]};
        if (edges.contains({b.x, b.y, b.z, a.x, a.y, a.z})) continue;
        const std::array<Vec3, 4> rim{a - dp * normal, b - dp * normal, b + dp * normal,
                                      a + dp * normal};
        for (const std::size_t k : {0, 1, 2, 0, 2, 3}) out.vertices.push_back(rim[k]);
    }
    return out;
}

/// Whether a shape that may be thickened is fitted to its wet_side() instead.
bool has_wet_side(const Scene& scene, const SceneStep& step, int threads)
{
    const Combination* combination = step.combination.get();
    if (combination == nullptr && step.shape() == nullptr) return false;
    FitSettings settings = *fit_settings(scene.def->fit, step.draw->state->mk.mk);
    settings.thickens = true;
    const std::vector<Box3> fluid = boxes_of_fluid(scene, threads);
    settings.fluid_places = combination != nullptr
                                ? places_in_fluid(fluid, scene, *combination, threads)
                                : places_in_fluid(fluid, scene, *step.draw, threads);
    if (settings.fluid_places.empty()) return false;
    std::vector<StepSurface> surfaces;
    if (combination != nullptr)
        surfaces = step_surfaces(scene, step, threads);
    else
        for (ShapeMesh& shape : surfaces_of(scene, *step.draw, PartsAs::Drawn, threads))
            surfaces.push_back({std::move(shape), {}});
    return std::any_of(
        surfaces.begin(), surfaces.end(),
        [&](const StepSurface& surface)
        {
            return may_have_sides(surface.facet_mk) &&
                   wet_side(surface.shape, scene.def->grid, settings, threads).has_value();
        });
}

} // namespace

bool may_thicken(const CaseDef& def, std::uint16_t mk)
{
    const FitSettings* settings = fit_settings(def.fit, mk);
    return settings != nullptr && settings->boundary == WallBoundary::Mdbc && !settings->layers &&
           settings->place != Placement::Inside && !settings->depths_dp.empty() && !floats(def, mk);
}

double thicken(const LatticeGrid& grid, int threads, SurfaceMesh& mesh)
{
    if (mesh.facets.empty() || !may_be_plate(soup_of(mesh), grid.dp)) return 0;
    const PlateThickness thickness = plate_thickness(mesh, grid, threads);
    if (!thickness.is_plate) return 0;
    const std::vector<double> outwards =
        moves_of_facets(mesh, thickness.of_facets, grid.dp, threads);
    if (*std::max_element(outwards.begin(), outwards.end()) <= 0) return 0;
    const std::vector<Vec3> moves = moves_of_vertices(mesh, outwards);
    for (std::size_t v = 0; v < moves.size(); ++v) mesh.vertices[v] = mesh.vertices[v] + moves[v];
    measure_facets(mesh, threads, high_for_particles * grid.dp);
    return thickness.least;
}

double thicken(const LatticeGrid& grid, int threads, ShapeMesh& shape)
{
    if (shape.soup.size() == 0 || !may_be_plate(shape.soup, grid.dp)) return 0;
    if (TriangleSoup slab; shape.is_solid && (slab = slab_about(shape.soup, grid.dp)).size() > 0)
    {
        shape = {};
        shape.soup = std::move(slab);
        shape.is_solid = true;
        return least_thickness_dp * grid.dp;
    }
    MeshReport report;
    SurfaceMesh mesh = repair_mesh(shape.soup,
                                   {.dp = grid.dp,
                                    .is_exact = shape.round != nullptr || shape.cad != nullptr,
                                    .is_solid = shape.is_solid},
                                   threads, report);
    if (!shape.is_solid && !report.is_watertight) return 0;
    const double thickness = thicken(grid, threads, mesh);
    if (thickness > 0)
    {
        shape.soup = soup_of(mesh);
        shape.round = nullptr;
        shape.cad = nullptr;
    }
    return thickness;
}

std::string thickened_from(double thickness, double dp)
{
    if (thickness <= least_thickness_dp * dp)
        return fmt::format(
            "it has no thickness and so room for one layer of mDBC, through which fluid goes: it "
            "is "
            "thickened to 2 dp, {:.3g} m, evenly to both sides.",
            two_layers_dp * dp);
    return fmt::format(
        "it is {:.3g} m thick, room for one layer of mDBC, through which fluid goes: it is "
        "thickened to 2 dp, {:.3g} m, evenly to both sides. A dp of {:.3g} m has room for two "
        "layers in it.",
        thickness, two_layers_dp * dp, thickness / two_layers_dp);
}

std::vector<StepSurface> fitted_surfaces(const Scene& scene, const SceneStep& step, int threads)
{
    const MkValue& mk = step.draw->state->mk;
    const bool thickens = mk.kind == MkKind::Bound && may_thicken(*scene.def, mk.mk);
    return step_surfaces(scene, step, threads, thickens && !has_wet_side(scene, step, threads));
}

} // namespace fppg
