#include "lattice/mesh_units.h"

#include "fppg/error.h"
#include "fppg/mesh.h"

#include "core/most_particles.h"
#include "meshes/outline.h"
#include "platform/memory.h"
#include "scene/near_domain.h"
#include "scene/surfaces.h"
#include "shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace fppg
{

namespace
{

double largest_extent(const LatticeGrid& grid, const Box3& box)
{
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (!(grid.is_2d && axis == 1) && grid.n[static_cast<std::size_t>(axis)] != 1)
            largest = std::max(largest, box.max[axis] - box.min[axis]);
    return largest;
}

Box3 bounds_of(const MeshFile& mesh, const Transform& transform)
{
    Box3 bounds;
    for (const Vec3& v : mesh.soup.vertices) bounds.add(transform(v));
    return bounds;
}

/// Of all facets, and of what of them is in a box, m^2.
struct Area
{
    double whole = 0;
    double in_box = 0;

    void add(const TriangleSoup& soup, const Transform& transform, const Box3& box)
    {
        const std::vector<Vec3>& v = soup.vertices;
        for (std::size_t f = 0; f + 2 < v.size(); f += 3)
        {
            const Vec3 corners[3] = {transform(v[f]), transform(v[f + 1]), transform(v[f + 2])};
            whole += norm(cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
            in_box += area_in_box(box, corners);
        }
    }
};

/// What spheres, cylinders and ellipsoids have at least, m^2, without making their facets; 0 of
/// other shapes.
double least_round_area(const DrawOp& draw, double dp)
{
    constexpr double pi = std::numbers::pi;
    double area = 0;
    if (const auto* sphere = shape_as<SphereOp>(draw))
    {
        const auto add = [&](double radius) { area += 4 * pi * radius * radius; };
        for (const double layer : sphere->layers_dp) add(sphere->radius + layer * dp);
        if (sphere->layers_dp.empty()) add(sphere->radius);
    }
    if (const auto* cylinder = shape_as<CylinderOp>(draw))
    {
        const auto add = [&](const CylinderLayer& layer)
        {
            const auto& [first, second, tube] = cylinder->is_visible;
            const double cover = pi * layer.radius * layer.radius;
            area += (first ? cover : 0) + (second ? cover : 0) +
                    (tube ? 2 * pi * layer.radius * norm(layer.p1 - layer.p0) : 0);
        };
        for (const CylinderLayer& layer : cylinder->layers) add(layer);
        if (cylinder->layers.empty()) add({cylinder->p0, cylinder->p1, cylinder->radius});
    }
    if (const auto* ellipsoid = shape_as<EllipsoidOp>(draw))
    {
        const double apart = norm(ellipsoid->focus1 - ellipsoid->focus0);
        const double sum = ellipsoid->radius;
        // Of a needle; of a sphere it is 4 / pi times as much.
        area = pi * pi * 0.25 * sum * std::sqrt(std::max(0.0, (sum - apart) * (sum + apart)));
    }
    return area;
}

/// Of the true surface that is laid of a draw, m^2. Of a shape in a small box not more than that
/// box's, of a round one that is far too large not less than it has: its surface is only made where
/// it matters. Of a body with plane facets of which most is beyond the domain what is near it: the
/// rest is cut off (walls/part_in_domain.h).
///
/// small  m^2; as much fits
double laid_area(const Scene& scene, const DrawOp& draw, double small, int threads)
{
    const double dp = scene.def->grid.dp;
    const Box3 near = box_near_domain(scene.def->grid);
    Area area;
    bool is_round = false;
    if (const auto* op = shape_as<MeshFileOp>(draw))
        area.add(mesh_of(scene, draw, threads)->soup, op->transform, near);
    else
    {
        const Box3 box = bounds_of(std::get<Shape>(draw.what), dp);
        if (box.is_empty()) return 0;
        const Vec3 size = box.max - box.min;
        const double of_box = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
        if (of_box < small) return of_box;
        const double of_round = least_round_area(draw, dp);
        if (of_round > small) return of_round;
        for (const ShapeMesh& shape : surfaces_of(scene, draw, PartsAs::One, threads))
        {
            is_round = is_round || shape.round != nullptr;
            area.add(shape.soup, {}, near);
        }
    }
    const double beyond = area.whole - area.in_box;
    const bool is_cut = !is_round && !is_laid_whole(*scene.def, draw.state->mk.mk) &&
                        beyond > std::max(area.in_box, least_beyond_dp2 * dp * dp);
    return is_cut ? area.in_box : area.whole;
}

bool has_fills(const Scene& scene)
{
    return std::any_of(scene.steps.begin(), scene.steps.end(),
                       [](const SceneStep& step)
                       {
                           const Edit* edit = step.edit();
                           return edit != nullptr && std::holds_alternative<CavityFillOp>(*edit);
                       });
}

bool is_fitted(const CaseDef& def, const DrawState& state)
{
    return !def.grid.is_2d && state.mk.kind == MkKind::Bound &&
           fit_settings(def.fit, state.mk.mk) != nullptr && state.mode != DrawMode::Wire;
}

/// Body-fitted walls are laid before what is outside the domain goes, but for what is far beyond.
void expect_few_on_surface(const Scene& scene, const DrawOp& draw, int threads)
{
    constexpr double bytes_per_particle = 85; // bunny of 260 million: 83 to lay, 76 to relax
    const double dp = scene.def->grid.dp;
    const auto memory = static_cast<double>(available_memory());
    const double most = std::min(static_cast<double>(most_particles), memory / bytes_per_particle);
    const std::optional<DrawOp> shorter = made_near_domain(draw, *scene.def);
    // All but what is near the domain is cut off.
    if (shorter && shape_as<SphereOp>(*shorter) != nullptr) return;
    const double area = laid_area(scene, shorter ? *shorter : draw, most * dp * dp, threads);
    const double count = area / (dp * dp);
    if (count <= most) return;
    const auto* op = shape_as<MeshFileOp>(draw);
    throw GeometryError(fmt::format(
        "{}: {} has a surface of {:.4g} m^2, for which body-fitted walls need {:.2g} particles "
        "with dp={:g}; {}{}",
        place_of(*scene.def, draw.source), op != nullptr ? op->file : "it", area, count, dp,
        count > static_cast<double>(most_particles)
            ? fmt::format("the file format holds at most {}", most_particles_text)
            : fmt::format("this machine has {:.3g} GB of memory free", memory * 1e-9),
        std::isfinite(count) ? fmt::format("; dp={:g} and larger ones fit",
                                           dp_rounded_up(dp * std::sqrt(count / most)))
                             : std::string()));
}

/// A mesh file whose size does not go with that of the domain.
void expect_size(const Scene& scene, const DrawOp& draw, bool may_be_small, int threads)
{
    const auto* op = shape_as<MeshFileOp>(draw);
    if (op == nullptr) return;
    const CaseDef& def = *scene.def;
    const Box3 bounds = bounds_of(*mesh_of(scene, draw, threads), op->transform);
    if (bounds.is_empty()) return;
    const std::optional<std::string> wrong = wrong_units(def, op->file, bounds);
    if (wrong && (!may_be_small || largest_extent(def.grid, bounds) > 4 * def.grid.dp))
        throw GeometryError(fmt::format("{}: {}", place_of(def, draw.source), *wrong));
}

} // namespace

std::optional<std::string> wrong_units(const CaseDef& def, const std::string& file,
                                       const Box3& bounds, double factor)
{
    const double size = largest_extent(def.grid, bounds);
    const double domain = largest_extent(def.grid, {def.case_pos_min, def.case_pos_max});
    const bool is_large = size > factor * domain;
    if (!is_large && (factor * size >= domain || size >= 4 * def.grid.dp)) return {};
    const char* scale = is_large ? "0.001" : "1000";
    return fmt::format(
        "{} is {:g} m wide in a domain of {:g} m with dp = {:g} m; if the file "
        "is in other units (mm), <drawscale x=\"{}\" y=\"{}\" z=\"{}\" /> turns "
        "them into metres",
        file, size, domain, def.grid.dp, scale, scale, scale);
}

void expect_metres(const Scene& scene, int threads)
{
    const bool fills = has_fills(scene);
    for (const SceneStep& step : scene.steps)
    {
        if (step.combination || !std::holds_alternative<Shape>(step.draw->what)) continue;
        const DrawState& state = *step.draw->state;
        const bool fitted = is_fitted(*scene.def, state);
        if (!(fitted || fills) || !state.draw_points || state.mk.kind == MkKind::Void ||
            !state.clips.empty())
            continue;
        expect_size(scene, *step.draw, !fills, threads);
        // Parts of a combination are cut before they are laid.
        if (fitted && !step.is_part) expect_few_on_surface(scene, *step.draw, threads);
    }
}

std::string suspected_units(const Scene& scene, int threads)
{
    constexpr double suspicious = 10;
    for (const SceneStep& step : scene.steps)
    {
        const auto* op = step.combination ? nullptr : shape_as<MeshFileOp>(*step.draw);
        if (op == nullptr) continue;
        const Box3 bounds = bounds_of(*mesh_of(scene, *step.draw, threads), op->transform);
        if (bounds.is_empty()) continue;
        if (const auto wrong = wrong_units(*scene.def, op->file, bounds, suspicious))
            return "; " + *wrong;
    }
    return {};
}

} // namespace fppg
