#include "lattice/exact_body.h"

#include "lattice/draw_checks.h"
#include "scene/surfaces.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

/// Sums over a body: second moments as a symmetric matrix.
using Moments = std::array<Vec3, 3>;

std::array<Vec3, 3> inertia_of(const Moments& m)
{
    const double trace = m[0].x + m[1].y + m[2].z;
    std::array<Vec3, 3> out;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
            const double v = m[static_cast<std::size_t>(i)][j];
            out[static_cast<std::size_t>(i)][j] = i == j ? trace - v : v == 0 ? 0 : -v;
        }
    return out;
}

/// A body of revolution about the unit vector u.
std::array<Vec3, 3> inertia_around(const Vec3& u, double axial, double across)
{
    std::array<Vec3, 3> out;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            out[static_cast<std::size_t>(i)][j] =
                (i == j ? across : 0) + (axial - across) * u[i] * u[j];
    return out;
}

std::optional<ExactBody> body_of(const DrawOp& op, const Scene& scene, std::string& why_not)
{
    ExactBody body;
    const auto* sphere = shape_as<SphereOp>(op);
    const auto* cylinder = shape_as<CylinderOp>(op);
    if ((sphere != nullptr && !sphere->layers_dp.empty()) ||
        (cylinder != nullptr && (!cylinder->layers.empty() || cylinder->is_masked)))
    {
        why_not = "it is drawn by layers or a part of a closed shape only";
        return std::nullopt;
    }
    if (sphere != nullptr)
    {
        const double r = sphere->radius;
        body.volume = 4.0 / 3 * std::numbers::pi * r * r * r;
        body.center = sphere->center;
        const double i = body.volume * 0.4 * r * r;
        body.inertia = inertia_around({1, 0, 0}, i, i);
        return body;
    }
    if (cylinder != nullptr)
    {
        const Vec3 along = cylinder->p1 - cylinder->p0;
        const double length = norm(along);
        const double r = cylinder->radius;
        if (!(length > 0))
        {
            why_not = "its cylinder has no length";
            return std::nullopt;
        }
        body.volume = std::numbers::pi * r * r * length;
        body.center = (cylinder->p0 + cylinder->p1) * 0.5;
        body.inertia = inertia_around(along / length, body.volume * r * r / 2,
                                      body.volume * (3 * r * r + length * length) / 12);
        return body;
    }
    if (const auto* ellipsoid = shape_as<EllipsoidOp>(op))
    {
        const Vec3 along = ellipsoid->focus1 - ellipsoid->focus0;
        const double a = ellipsoid->radius / 2;
        const double c = norm(along) / 2;
        const double b2 = a * a - c * c;
        if (!(b2 > 0))
        {
            why_not = "its ellipsoid has no volume";
            return std::nullopt;
        }
        body.volume = 4.0 / 3 * std::numbers::pi * a * b2;
        body.center = (ellipsoid->focus0 + ellipsoid->focus1) * 0.5;
        body.inertia = inertia_around(c > 0 ? along / (2 * c) : Vec3{1, 0, 0},
                                      body.volume * 0.4 * b2, body.volume * 0.2 * (a * a + b2));
        return body;
    }
    TriangleSoup soup;
    if (const auto* mesh = shape_as<MeshFileOp>(op))
    {
        for (const Vec3& v : mesh_of(scene, op, 1)->soup.vertices)
            soup.vertices.push_back(mesh->transform(v));
    }
    else if (const auto* figure = shape_as<FigureOp>(op))
    {
        if (figure->part > 0) return std::nullopt; // the first part stands for the whole
        DrawOp whole = op;
        auto state = std::make_shared<DrawState>(*op.state);
        state->mode = DrawMode::Full;
        whole.state = state;
        for (const ShapeMesh& shape : surfaces_of(scene, whole, PartsAs::One, 1)) soup = shape.soup;
    }
    const std::uint64_t open = open_edge_count(soup);
    if (soup.size() == 0 || open > 0)
    {
        why_not = soup.size() == 0 ? "it is drawn by points or lines"
                                   : fmt::format("its surface has {} open edges", open);
        return std::nullopt;
    }
    body = body_of_facets(soup);
    if (!(body.volume > 0))
    {
        why_not = "its surface encloses nothing";
        return std::nullopt;
    }
    return body;
}

} // namespace

ExactBody body_of_facets(const TriangleSoup& soup)
{
    // Tetrahedra from the middle of the box, so that sums stay small.
    Box3 box;
    for (const Vec3& v : soup.vertices) box.add(v);
    const Vec3 from = box.is_empty() ? Vec3{} : (box.min + box.max) * 0.5;
    double volume = 0;
    Vec3 first;
    Moments second;
    for (std::size_t t = 0; t < soup.size(); ++t)
    {
        const std::array<Vec3, 3> p{soup.vertices[3 * t] - from, soup.vertices[3 * t + 1] - from,
                                    soup.vertices[3 * t + 2] - from};
        const double six = dot(p[0], cross(p[1], p[2]));
        const Vec3 sum = p[0] + p[1] + p[2];
        volume += six / 6;
        first = first + sum * (six / 24);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                second[static_cast<std::size_t>(i)][j] +=
                    six / 120 *
                    (sum[i] * sum[j] + p[0][i] * p[0][j] + p[1][i] * p[1][j] + p[2][i] * p[2][j]);
    }
    ExactBody body;
    const double sign = volume < 0 ? -1 : 1;
    body.volume = sign * volume;
    if (!(body.volume > 0)) return body;
    const Vec3 mean = first / volume;
    body.center = from + mean;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
            double& m = second[static_cast<std::size_t>(i)][j];
            m = sign * m - body.volume * mean[i] * mean[j];
        }
    body.inertia = inertia_of(second);
    return body;
}

std::array<Vec3, 3> inertia_about(const std::array<Vec3, 3>& inertia, double mass,
                                  const Vec3& offset)
{
    std::array<Vec3, 3> out = inertia;
    const double square = dot(offset, offset);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            out[static_cast<std::size_t>(i)][j] +=
                mass * ((i == j ? square : 0) - offset[i] * offset[j]);
    return out;
}

std::optional<ExactBody> exact_body(const Scene& scene, std::uint16_t mk, std::string& why_not)
{
    if (scene.def->grid.is_2d)
    {
        why_not = "a case in two dimensions has no closed shapes";
        return std::nullopt;
    }
    std::vector<const DrawOp*> draws;
    bool is_recoloured = false;
    for (const SceneStep& step : scene.remaining())
    {
        const DrawState& state = *step.draw->state;
        if (step.combination || state.mk.kind != MkKind::Bound || state.mk.mk != mk ||
            !state.draw_points)
            continue;
        const auto* shape = std::get_if<Shape>(&step.draw->what);
        const Edit* edit = step.edit();
        is_recoloured =
            is_recoloured || !state.clips.empty() || (edit != nullptr && is_redraw(*edit));
        if (shape != nullptr && !std::holds_alternative<WaveOp>(*shape)) draws.push_back(step.draw);
    }
    if (draws.size() != 1 || is_recoloured)
    {
        why_not = is_recoloured ? "redraws or clips take part in it"
                                : fmt::format("{} draws make it", draws.size());
        return std::nullopt;
    }
    std::optional<ExactBody> body = body_of(*draws.front(), scene, why_not);
    if (body)
        body->shape = fmt::format("<{}> of line {}", draws.front()->source.command,
                                  draws.front()->source.line);
    return body;
}

} // namespace fppg
