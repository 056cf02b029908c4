#include "lattice/mesh_units.h"

#include "fppg/error.h"
#include "fppg/mesh.h"

#include "core/most_particles.h"
#include "scene/surfaces.h"
#include "shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
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

double area_of(const MeshFile& mesh, const Transform& transform)
{
    double area = 0;
    const std::vector<Vec3>& v = mesh.soup.vertices;
    for (std::size_t f = 0; f + 2 < v.size(); f += 3)
    {
        const Vec3 a = transform(v[f]);
        area += norm(cross(transform(v[f + 1]) - a, transform(v[f + 2]) - a)) / 2;
    }
    return area;
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

void expect_few_on_surface(const Scene& scene, const DrawOp& draw, const MeshFileOp& op,
                           double area)
{
    const double dp = scene.def->grid.dp;
    const double count = area / (dp * dp);
    if (count <= static_cast<double>(most_particles)) return;
    throw GeometryError(
        fmt::format("{}: {} has a surface of {:.4g} m^2, for which body-fitted walls need {:.2g} "
                    "particles with "
                    "dp={:g}; the file format holds at most {}; dp={:g} and larger ones fit",
                    place_of(*scene.def, draw.source), op.file, area, count, dp,
                    most_particles_text, dp_that_fits(dp, count, false)));
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
    const CaseDef& def = *scene.def;
    const bool fills = has_fills(scene);
    for (const SceneStep& step : scene.steps)
    {
        const auto* op = step.combination ? nullptr : shape_as<MeshFileOp>(*step.draw);
        if (op == nullptr) continue;
        const DrawState& state = *step.draw->state;
        const bool fitted = is_fitted(def, state);
        if (!(fitted || fills) || !state.draw_points || state.mk.kind == MkKind::Void ||
            !state.clips.empty())
            continue;
        const MeshFile& mesh = *mesh_of(scene, *step.draw, threads);
        const Box3 bounds = bounds_of(mesh, op->transform);
        if (bounds.is_empty()) continue;
        const std::optional<std::string> wrong = wrong_units(def, op->file, bounds);
        const bool is_large = largest_extent(def.grid, bounds) > def.grid.dp * 4;
        if (wrong && (fills || is_large))
            throw GeometryError(fmt::format("{}: {}", place_of(def, step.draw->source), *wrong));
        if (fitted) expect_few_on_surface(scene, *step.draw, *op, area_of(mesh, op->transform));
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
