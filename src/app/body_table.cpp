#include "app/body_table.h"

#include "core/text_table.h"
#include "particles/run_positions.h"
#include "scene/exact_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{
namespace
{

/// Of the nodes in a body that fills gave particles.
constexpr double filled_body = 0.98;
/// Of the volume of a mesh, that its parts have in common.
constexpr double overlapping = 1e-3;
/// Of the volume of a flexible body, which is warned of.
constexpr double flexible_off = 0.01;

/// The one fitted solid of a block; null where there are several, or it is hollow.
const FittedBody* solid_of(const FittedWalls& walls, const ParticleBlock& block)
{
    const FittedBody* found = nullptr;
    for (const FittedBody& body : walls.bodies)
    {
        if (body.is_layer() || body.mk != block.mk) continue;
        if (found != nullptr) return nullptr;
        found = &body;
    }
    if (found == nullptr || found->measures.filled < filled_body ||
        std::any_of(found->facet_mk.begin(), found->facet_mk.end(),
                    [&](std::uint16_t mk) { return mk != block.mk; }) ||
        !(found->measures.volume > 0))
        return nullptr;
    return found;
}

/// Whether a body of facets has another volume than its fitted solid, which counts what parts of
/// its mesh have in common once.
bool differs_from(const ExactBody& shape, const FittedBody& solid)
{
    return solid.round == nullptr && solid.cad == nullptr && solid.measures.kept >= 1 &&
           std::abs(shape.volume / solid.measures.volume - 1) > overlapping;
}

/// The body that the facets of a solid bound, if no parts of them overlap.
std::optional<ExactBody> facets_of(const FittedBody& solid)
{
    ExactBody out = body_of_facets(soup_of(solid.mesh));
    return differs_from(out, solid) ? std::nullopt : std::optional(std::move(out));
}

std::vector<std::string> row_of(const std::string& mk, const char* of, const ExactBody& body,
                                double density)
{
    const auto inertia = [&](int i)
    { return fmt::format("{:.6g}", density * body.inertia[static_cast<std::size_t>(i)][i]); };
    std::vector<std::string> row{mk, of, fmt::format("{:.6g}", body.volume),
                                 fmt::format("{:.6g}", density * body.volume)};
    for (int axis = 0; axis < 3; ++axis) row.push_back(fmt::format("{:.6g}", body.center[axis]));
    for (int axis = 0; axis < 3; ++axis) row.push_back(inertia(axis));
    return row;
}

std::vector<std::string> difference(const ExactBody& particles, const ExactBody& shape, double dp)
{
    const std::string volume =
        fmt::format("{:+.3f} %", 100 * (particles.volume / shape.volume - 1));
    std::vector<std::string> row{"", "difference", volume, volume};
    for (int axis = 0; axis < 3; ++axis)
        row.push_back(
            fmt::format("{:+.4f} dp", (particles.center[axis] - shape.center[axis]) / dp));
    for (int i = 0; i < 3; ++i)
    {
        const auto k = static_cast<std::size_t>(i);
        row.push_back(
            fmt::format("{:+.3f} %", 100 * (particles.inertia[k][i] / shape.inertia[k][i] - 1)));
    }
    return row;
}

double density_of(const CaseDef& def, const ParticleBlock& block, double rhop0)
{
    for (const FloatingDef& f : def.floatings)
        if (f.rhop_body &&
            std::find(f.mkbound.begin(), f.mkbound.end(), block.mk_type) != f.mkbound.end())
            return *f.rhop_body;
    return rhop0;
}

} // namespace

std::optional<ExactBody> shape_of_block(const Scene& scene, const FittedWalls& walls,
                                        const ParticleBlock& block, std::string& why_not)
{
    const FittedBody* body = solid_of(walls, block);
    // The facets of fitted solids are turned.
    std::optional<ExactBody> shape = exact_body(scene, block.mk, body == nullptr, why_not);
    if (scene.def->grid.is_2d || body == nullptr || (shape && !differs_from(*shape, *body)))
        return shape;
    if (!shape && body->facet_mk.empty()) return std::nullopt;
    const std::string name =
        shape ? shape->shape
              : fmt::format("<{}> of line {} and what is combined with it", body->name, body->line);
    shape = facets_of(*body);
    if (shape)
        shape->shape = name;
    else
        why_not = "parts of its mesh overlap, or it is open";
    return shape;
}

ExactBody body_of_particles(const CaseParticles& particles, const ParticleBlock& block,
                            bool are_cubes)
{
    const double dp = particles.grid.dp;
    const double whole = dp * dp * (particles.grid.is_2d ? 1 : dp);
    const std::vector<float>& shares = particles.off_lattice.shares;
    const auto for_each = [&](const auto& visit)
    {
        std::uint64_t id = block.begin;
        for (const ParticleRun& run : block.runs)
            for (std::uint32_t k = 0; k < run.count; ++k, ++id)
            {
                double volume = whole;
                if (!particles.volumes.empty())
                    volume = particles.volumes[id];
                else if (run.is_off_lattice && !shares.empty())
                    volume = double{shares[run.off_lattice_begin() + k]} * whole;
                visit(place_in_run(particles, block, run, k), volume);
            }
    };
    ExactBody out;
    Vec3 sum;
    for_each(
        [&](const Vec3& p, double volume)
        {
            out.volume += volume;
            sum = sum + volume * p;
        });
    out.center = sum / out.volume;
    const double own = are_cubes ? dp * dp / 6 : 0;
    for_each(
        [&](const Vec3& p, double volume)
        {
            const Vec3 d = p - out.center;
            for (int i = 0; i < 3; ++i)
            {
                Vec3& row = out.inertia[static_cast<std::size_t>(i)];
                row = row - (volume * d[i]) * d;
                row[i] += volume * (dot(d, d) + own);
            }
        });
    return out;
}

std::vector<std::string> weigh_flexible(const Scene& scene, const FittedWalls& walls,
                                        const CaseParticles& particles)
{
    const CaseDef& def = *scene.def;
    std::vector<std::string> out;
    for (const ParticleBlock& block : particles.blocks)
    {
        const FittedBody* body =
            def.solver.flexible.contains(block.mk) ? solid_of(walls, block) : nullptr;
        if (body == nullptr || body->is_inside) continue;
        const double dp = def.grid.dp;
        const double share =
            static_cast<double>(block.count) * dp * dp * dp / body->measures.volume - 1;
        if (std::abs(share) <= flexible_off) continue;
        out.push_back(fmt::format(
            "{}: flexible mkbound {}: DualSPHysics counts each of its {} particles for dp^{}, "
            "{:.1f} % {} than its volume. <bodyfitted place=\"inside\"> gives it particles for "
            "its volume, but bodies of few rows bend too easily then.",
            def.file, block.mk_type, block.count, def.grid.is_2d ? 2 : 3, 100 * std::abs(share),
            share > 0 ? "more" : "less"));
    }
    return out;
}

void log_bodies(const Scene& scene, const FittedWalls& walls, const CaseParticles& particles,
                const CaseConstants& constants, RunLog& log)
{
    const CaseDef& def = *scene.def;
    if (def.grid.is_2d) return;
    std::vector<std::vector<std::string>> rows{{"mkbound", "of", "volume m3", "mass kg",
                                                "centre x m", "y", "z", "inertia xx kg m2", "yy",
                                                "zz"}};
    std::vector<std::string> overlap;
    for (const ParticleBlock& block : particles.blocks)
    {
        const FittedBody* body = solid_of(walls, block);
        if (body == nullptr || block.type == ParticleType::Fluid || block.count == 0) continue;
        std::string why_not;
        std::optional<ExactBody> shape = shape_of_block(scene, walls, block, why_not);
        if (!shape) shape = facets_of(*body);
        if (!shape)
        {
            overlap.push_back(fmt::format("{}", block.mk_type));
            continue;
        }
        const ExactBody found = body_of_particles(particles, block, body->is_inside);
        const double density = density_of(def, block, constants.rhop0);
        rows.push_back(row_of(fmt::format("{}", block.mk_type), "shape", *shape, density));
        rows.push_back(row_of("", "particles", found, density));
        rows.push_back(difference(found, *shape, def.grid.dp));
        const auto fact = [&](const ExactBody& of)
        {
            Json fields{{"volume", of.volume}, {"mass", density * of.volume}};
            fields["centre"] = {of.center.x, of.center.y, of.center.z};
            fields["inertia"] = {density * of.inertia[0].x, density * of.inertia[1].y,
                                 density * of.inertia[2].z};
            return fields;
        };
        log.fact("body",
                 {{"mkbound", block.mk_type}, {"shape", fact(*shape)}, {"particles", fact(found)}});
    }
    if (rows.size() > 1)
    {
        log.text_line("Fitted solids and their particles:");
        log.text_line(text_table(rows, 2, "  "));
    }
    if (!overlap.empty())
        log.text_line(
            fmt::format("No exact volume, centre and inertia of the shape of mkbound {}: "
                        "parts of its mesh overlap, or it is open.",
                        fmt::join(overlap, ", ")));
}

} // namespace fppg
