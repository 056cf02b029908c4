#include "app/floating_log.h"

#include "fppg/error.h"

#include "lattice/exact_body.h"
#include "particles/initials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

/// Of the mass of a body to that of its shape, beyond which it is told.
constexpr double largest_deviation = 0.02;

/// Whether a block has particles of a fitted wall.
bool is_fitted(const CaseParticles& particles, const ParticleBlock& block)
{
    return std::any_of(block.runs.begin(), block.runs.end(),
                       [&](const ParticleRun& run)
                       {
                           if (!run.is_free()) return false;
                           const auto first = particles.free.kinds.begin() +
                                              static_cast<std::ptrdiff_t>(run.free_begin());
                           return std::any_of(first, first + run.count,
                                              [](FitKind kind) { return kind != FitKind::Volume; });
                       });
}

std::string text_of(const FloatingBody& body)
{
    const auto& i = body.inertia;
    return fmt::format(
        "mass {:.9g} kg, centre ({:.9g}, {:.9g}, {:.9g}) m, inertia xx yy zz "
        "({:.9g}, {:.9g}, {:.9g}) xy xz yz ({:.9g}, {:.9g}, {:.9g}) kg*m^2",
        body.mass_body, body.center.x, body.center.y, body.center.z, i[0].x, i[1].y, i[2].z, i[0].y,
        i[0].z, i[1].z);
}

/// R I R^T
std::array<Vec3, 3> turned(const std::array<Vec3, 3>& inertia, const Transform& map)
{
    std::array<Vec3, 3> out;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Vec3& row = map.linear[i];
        const Vec3 left = row.x * inertia[0] + row.y * inertia[1] + row.z * inertia[2];
        for (std::size_t j = 0; j < 3; ++j) out[i][static_cast<int>(j)] = dot(left, map.linear[j]);
    }
    return out;
}

const FloatingDef* definition_of(const CaseDef& def, std::uint16_t mkbound)
{
    const auto found = std::find_if(
        def.floatings.rbegin(), def.floatings.rend(),
        [&](const FloatingDef& f)
        { return std::find(f.mkbound.begin(), f.mkbound.end(), mkbound) != f.mkbound.end(); });
    return found == def.floatings.rend() ? nullptr : &*found;
}

} // namespace

std::vector<std::string> settle_floatings(const CaseDef& def, CaseParticles& particles, RunLog& log)
{
    std::vector<std::string> warnings;
    if (particles.floatings.empty()) return warnings;
    const ExactFloatings& exact = def.exact_floatings;
    log.line("Floating bodies:");
    for (FloatingBody& body : particles.floatings)
    {
        const ParticleBlock& block = particles.blocks[body.block];
        const FloatingDef* f = definition_of(def, block.mk_type);
        log.line(fmt::format("  mkbound {}: {} (particles)", block.mk_type, text_of(body)));
        const bool is_wanted =
            exact.all || std::find(exact.mk.begin(), exact.mk.end(), block.mk) != exact.mk.end();
        std::string why_not;
        const std::optional<ExactBody> shape = exact_body(def, block.mk, why_not);
        if (!shape || f == nullptr)
        {
            log.line(fmt::format("    there is no single closed shape of it: {}", why_not));
            if (is_wanted)
                throw CaseError(def.file, exact.line,
                                fmt::format("<floatings exact=\"true\">: mkbound {} has no exact "
                                            "mass and inertia: {}; expected one closed shape",
                                            block.mk_type, why_not));
            continue;
        }
        FloatingBody true_body = body;
        true_body.mass_body =
            f->mass_body ? *f->mass_body : f->rhop_body.value_or(0) * shape->volume;
        const double density = true_body.mass_body / shape->volume;
        const Transform map = motion_of(block);
        std::array<Vec3, 3> inertia = turned(shape->inertia, map);
        for (Vec3& row : inertia)
            for (int j = 0; j < 3; ++j) row[j] = row[j] == 0 ? 0 : row[j] * density;
        const Vec3 center = map(shape->center);
        true_body.center = f->center ? *f->center : center;
        true_body.inertia =
            f->inertia ? *f->inertia
                       : inertia_about(inertia, true_body.mass_body, center - true_body.center);
        if (f->distribute_mass)
            true_body.mass_part = true_body.mass_body / static_cast<double>(block.count);
        log.line(fmt::format("    exact, {}: volume {:.9g} m^3, {}{}", shape->shape, shape->volume,
                             text_of(true_body), is_wanted ? " (taken)" : ""));
        if (is_wanted)
            body = true_body;
        else if (f->rhop_body && is_fitted(particles, block) &&
                 std::abs(body.mass_body / true_body.mass_body - 1) > largest_deviation)
            warnings.push_back(fmt::format(
                "{}: floating mkbound {}: at {:g} kg/m^3 its particles have {:.4g} kg, its {} of "
                "{:.4g} m^3 would have {:.4g} kg ({:+.3g} %): it is drawn hollow, or cut by the "
                "domain or later draws; <fppg><floatings exact=\"true\"> takes the shape's mass, "
                "centre and inertia.",
                def.file, block.mk_type, *f->rhop_body, body.mass_body, shape->shape, shape->volume,
                true_body.mass_body, 100 * (body.mass_body / true_body.mass_body - 1)));
    }
    log.line();
    return warnings;
}

} // namespace fppg
