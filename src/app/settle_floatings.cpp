#include "app/settle_floatings.h"

#include "fppg/error.h"

#include "app/body_table.h"
#include "app/fit_check.h"
#include "particles/initials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

/// A shape that may make up a floating body.
struct TrueShape
{
    std::string name;  ///< the command and its line
    double volume = 0; ///< metres cubed, in 2D metres squared; 0: there is none
};

/// Of the mass of a body on the lattice, whose particles stand for whole cells.
constexpr double largest_on_lattice = 0.05;

/// Of the inertia of a body with fitted walls.
constexpr double largest_of_inertia = 0.05;

/// Compares the masses and inertias of floating bodies with those of their shapes.
class FloatingCheck
{
public:
    FloatingCheck(const CaseDef& def, const CaseParticles& particles, const FittedWalls& walls)
        : def_(def), particles_(particles), walls_(walls)
    {
    }

    /// In 2D, the section that a single fitted body makes.
    TrueShape section_of(const ParticleBlock& block) const
    {
        TrueShape shape;
        if (!def_.grid.is_2d) return shape;
        for (const FittedBody& body : walls_.bodies)
        {
            if (body.mk != block.mk) continue;
            if (!shape.name.empty()) return {};
            shape = {fmt::format("<{}> of line {}", body.name, body.line),
                     body.measures.volume / def_.grid.dp};
        }
        return shape;
    }

    void note(const FloatingBody& body, const FloatingDef& f, const TrueShape& shape)
    {
        const ParticleBlock& block = particles_.blocks[body.block];
        if (!f.rhop_body || f.mass_body || !(shape.volume > 0)) return;
        const bool on_lattice = !is_fitted(block);
        const double expected = *f.rhop_body * shape.volume;
        const double share = body.mass_body / expected - 1;
        if (on_lattice ? std::abs(share) <= largest_on_lattice : !is_off(share)) return;
        (on_lattice            ? on_lattice_
         : is_hollow(block.mk) ? hollow_
                               : cut_)
            .add(block.mk_type, share,
                 fmt::format("particles have {:.4g} kg at {:g} kg/m^3, while its {} has {:.4g} {} "
                             "and {:.4g} kg",
                             body.mass_body, *f.rhop_body, shape.name, shape.volume,
                             def_.grid.is_2d ? "m^2" : "m^3", expected));
    }

    /// exact  of its shape
    void note_inertia(const FloatingBody& body, const FloatingDef& f, const FloatingBody& exact)
    {
        const ParticleBlock& block = particles_.blocks[body.block];
        if (f.inertia || !is_fitted(block)) return;
        double most = 0;
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto i = static_cast<std::size_t>(axis);
            const double share = body.inertia[i][axis] * exact.mass_body /
                                     (exact.inertia[i][axis] * body.mass_body) -
                                 1;
            if (std::abs(share) > std::abs(most)) most = share;
        }
        if (std::abs(most) <= largest_of_inertia) return;
        turning_.add(block.mk_type, most,
                     fmt::format("{} particles turn {} easily than its shape", block.count,
                                 most > 0 ? "less" : "more"));
    }

    std::vector<std::string> warnings() const
    {
        std::vector<std::string> out;
        const auto tell = [&](const DeviationGroup& group, const char* why)
        {
            if (group.is_empty()) return;
            out.push_back(
                fmt::format("{}: floating bodies have another mass than their shapes, {}, "
                            "{}.",
                            def_.file, why, group.text("mkbound")));
            if (!def_.grid.is_2d)
                out.back() += " <fppg><floatings exact=\"true\"> takes the mass of the shape.";
        };
        tell(hollow_, "as no draw fills them");
        tell(cut_, "as the domain, later draws or touching bodies cut them");
        if (!turning_.is_empty())
            out.push_back(
                fmt::format("{}: the particles of floating bodies have another inertia "
                            "than their shapes of the same mass, {}. <fppg><floatings "
                            "exact=\"true\"> takes that of the shape.",
                            def_.file, turning_.text("mkbound")));
        return out;
    }

    /// Of bodies on the lattice.
    std::vector<std::string> light_or_heavy() const
    {
        if (on_lattice_.is_empty()) return {};
        return {
            fmt::format("{}: floating bodies have another mass than their shapes, as they are "
                        "hollow or only a few dp thick, {}; expected at most {:g} % off: "
                        "<fppg><floatings exact=\"true\"> takes the mass of the shape.",
                        def_.file, on_lattice_.text("mkbound"), 100 * largest_on_lattice)};
    }

private:
    /// Whether no draw or fill gave a mk the inside of its fitted walls.
    bool is_hollow(std::uint16_t mk) const
    {
        return std::none_of(walls_.bodies.begin(), walls_.bodies.end(),
                            [&](const FittedBody& body)
                            { return body.mk == mk && body.measures.filled > 0.98; });
    }

    /// Whether a block has particles of a fitted wall.
    bool is_fitted(const ParticleBlock& block) const
    {
        const auto is_of_wall = [](FitKind kind) { return kind != FitKind::Volume; };
        return std::any_of(block.runs.begin(), block.runs.end(),
                           [&](const ParticleRun& run)
                           {
                               if (!run.is_off_lattice) return false;
                               const auto first =
                                   particles_.off_lattice.kinds.begin() +
                                   static_cast<std::ptrdiff_t>(run.off_lattice_begin());
                               return std::any_of(first, first + run.count, is_of_wall);
                           });
    }

    const CaseDef& def_;
    const CaseParticles& particles_;
    const FittedWalls& walls_;
    DeviationGroup hollow_;
    DeviationGroup cut_;
    DeviationGroup on_lattice_;
    DeviationGroup turning_;
};

std::string text_of(const FloatingBody& body)
{
    // Rounding off the diagonal is not shown.
    std::array<Vec3, 3> i = body.inertia;
    const double least = 1e-12 * (std::fabs(i[0].x) + std::fabs(i[1].y) + std::fabs(i[2].z));
    for (Vec3& row : i)
        for (int axis = 0; axis < 3; ++axis)
            if (std::fabs(row[axis]) < least) row[axis] = 0;
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

/// A body with the mass and inertia of its shape, but for what its definition gives.
FloatingBody exact_floating(const FloatingBody& body, const FloatingDef& f, const ExactBody& shape,
                            const Transform& map)
{
    FloatingBody out = body;
    out.mass_body = f.mass_body ? *f.mass_body : f.rhop_body.value_or(0) * shape.volume;
    const double density = out.mass_body / shape.volume;
    std::array<Vec3, 3> inertia = turned(shape.inertia, map);
    for (Vec3& row : inertia)
        for (int j = 0; j < 3; ++j) row[j] = row[j] == 0 ? 0 : row[j] * density;
    const Vec3 center = map(shape.center);
    out.center = f.center ? *f.center : center;
    out.inertia =
        f.inertia ? *f.inertia : inertia_about(inertia, out.mass_body, center - out.center);
    if (f.distribute_mass) out.mass_part *= out.mass_body / body.mass_body;
    return out;
}

} // namespace

SettledFloatings settle_floatings(const Scene& scene, const FittedWalls& walls,
                                  CaseParticles& particles)
{
    const CaseDef& def = *scene.def;
    const ExactFloatings& exact = def.exact_floatings;
    SettledFloatings out;
    FloatingCheck check(def, particles, walls);
    for (FloatingBody& body : particles.floatings)
    {
        const ParticleBlock& block = particles.blocks[body.block];
        const FloatingDef* f = definition_of(def, block.mk_type);
        SettledFloating& settled = out.bodies.emplace_back();
        settled.mkbound = block.mk_type;
        settled.of_particles = body;
        const bool is_wanted =
            exact.all || std::find(exact.mk.begin(), exact.mk.end(), block.mk) != exact.mk.end();
        const std::optional<ExactBody> shape = shape_of_block(scene, walls, block, settled.why_not);
        if (!shape || f == nullptr)
        {
            if (is_wanted)
                throw CaseError(def.file, exact.line,
                                fmt::format("<floatings exact=\"true\">: mkbound {} has no exact "
                                            "mass and inertia: {}; expected one closed shape",
                                            block.mk_type, settled.why_not));
            if (f != nullptr) check.note(body, *f, check.section_of(block));
            continue;
        }
        settled.shape = shape;
        settled.exact = exact_floating(body, *f, *shape, motion_of(block));
        settled.is_exact_taken = is_wanted;
        if (is_wanted)
            body = settled.exact;
        else
        {
            check.note(body, *f, {shape->shape, shape->volume});
            check.note_inertia(body, *f, settled.exact);
        }
    }
    out.warnings = check.warnings();
    out.light_or_heavy = check.light_or_heavy();
    return out;
}

void log_floatings(const SettledFloatings& floatings, RunLog& log)
{
    if (floatings.bodies.empty()) return;
    log.line("Floating bodies:");
    for (const SettledFloating& body : floatings.bodies)
    {
        log.line(
            fmt::format("  mkbound {}: {} (particles)", body.mkbound, text_of(body.of_particles)));
        if (body.shape)
            log.line(fmt::format("    exact, {}: volume {:.9g} m^3, {}{}", body.shape->shape,
                                 body.shape->volume, text_of(body.exact),
                                 body.is_exact_taken ? " (taken)" : ""));
        else
            log.line(fmt::format("    there is no single closed shape of it: {}", body.why_not));
    }
    log.line();
}

} // namespace fppg
