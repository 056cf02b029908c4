#include "casedef/wall_boundary.h"

#include "fppg/error.h"
#include "fppg/moving_parts.h"

#include "casedef/execution.h"
#include "casedef/inout_zones.h"
#include "shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace fppg
{
namespace
{

/// A parameter of the solver, as it reads whole numbers; empty where the case does not give it.
std::optional<int> whole_parameter(const CaseDef& def, std::string_view key)
{
    const std::optional<std::string> text = parameter_value(def.execution, key);
    if (!text) return std::nullopt;
    return static_cast<int>(std::strtol(text->c_str(), nullptr, 10));
}

/// As many layers as fluid at the surface sees: layer k is needed while k < 2h/dp - 1.
int layers_seen(double kernel_dp)
{
    return std::max(1, static_cast<int>(std::ceil(kernel_dp - 1 - 1e-9)));
}

/// Of the kernel's reach, within which DBC needs particles. With one layer less in a tank of faces
/// (3D, coefh 1, the third at 0.87 of it) 0.0027 g is left of fluid at rest instead of 0.0002, with
/// one more (coefh 1.2, at 0.96) as much.
constexpr double felt = 0.92;

/// Settles the depths of the layers of solids and of sheets.
void settle_depths(double kernel_dp, FitSettings& settings)
{
    const bool is_mdbc = settings.boundary == WallBoundary::Mdbc;
    const int seen = layers_seen(kernel_dp);
    const int count =
        settings.layers.value_or(is_mdbc ? seen : std::max(2, layers_seen(felt * kernel_dp)));
    std::vector<double> depths;
    for (int k = 0; k < count; ++k) depths.push_back(k + (is_mdbc ? 0.5 : 0.0));
    settings.depths_dp.clear();
    settings.sheet_depths_dp.clear();
    const bool is_inside = settings.place == Placement::Inside;
    if (is_inside) settings.depths_dp = {0.5};
    if (!is_mdbc && !settings.layers && (!is_inside || settings.may_be_open))
        settings.sheet_depths_dp = std::move(depths);
    else if (!is_inside)
        settings.depths_dp = std::move(depths);
}

/// Says of layers for mDBC that are fewer than fluid sees what that means.
void judge_layers(const FitSettings& settings, double kernel_dp, CaseDef& def)
{
    const int needed = layers_seen(kernel_dp);
    if (settings.boundary != WallBoundary::Mdbc || !settings.layers || *settings.layers >= needed)
        return;
    const std::string at = fmt::format("{}:{}: <bodyfitted layers=\"{}\">: ", def.file,
                                       settings.line, *settings.layers);
    if (*settings.layers == 1)
        def.warnings.push_back(
            at + fmt::format("fluid goes through walls of one layer under mDBC; at 2h = {:.3g} dp "
                             "they need {} (layers=\"auto\").",
                             kernel_dp, needed));
    else
        def.hints.push_back(at + fmt::format("at 2h = {:.3g} dp fluid at the wall sees {} layers "
                                             "(layers=\"auto\").",
                                             kernel_dp, needed));
}

/// Of walls in layers: the parameters with which the solver keeps fluid out of them.
void hint_at_parameters(CaseDef& def)
{
    const auto is_mdbc = [](const FitSettings& s) { return s.boundary == WallBoundary::Mdbc; };
    if (!(def.fit.all && is_mdbc(*def.fit.all)) &&
        std::none_of(def.fit.of_mk.begin(), def.fit.of_mk.end(),
                     [&](const auto& of_mk) { return is_mdbc(of_mk.second); }))
        return;
    if (def.solver.no_penetration) return;
    const std::string wrong = def.solver.slip_mode < 2 ? "SlipMode is 1" : "NoPenetration is not 1";
    def.hints.push_back(fmt::format(
        "{}: the parameter {}, with which fluid creeps into walls of mDBC; SlipMode=2 (or 3: free "
        "slip) with NoPenetration=1 holds it in the solver.",
        def.file, wrong));
}

/// Absolute mks of the flexible bodies of `<special><flexstrucs>`, as v5.4 reads them
/// (JSphFlexStruc.cpp).
std::set<std::uint16_t> flexible_mks(const AttributeReader& read, const CaseDef& def)
{
    std::set<std::uint16_t> out;
    for_each_special(
        def.execution, "flexstrucs",
        [&](const Element& body)
        {
            if (body.name != "flexstrucbody" || body.find_attribute("mkbound") == nullptr) return;
            for (const int mkbound : read.number_list(body, "mkbound"))
                out.insert(static_cast<std::uint16_t>(mkbound + def.mk_bound_first));
        });
    return out;
}

/// Puts the particles of solids that float inside them, where boundaries are dynamic and the case
/// does not say otherwise. These hold water half a step off their surface then, and a whole one off
/// particles on it (half as heavy as water, a ball floats 4.9 mm too high instead of 11.8, and a
/// box draws 47 mm instead of 39, of 50).
void put_floating_inside(bool is_mdbc, CaseDef& def)
{
    std::set<std::uint16_t> bodies = floating_mks(def);
    for (const DrawOp& op : def.ops)
    {
        const auto* shape = std::get_if<Shape>(&op.what);
        const DrawState& state = *op.state;
        // Shells of its own, and sheets, have no inside.
        if (state.mk.kind == MkKind::Bound && shape != nullptr &&
            (op.surface != nullptr || state.mode == DrawMode::Face || !is_body(*shape, state.mode)))
            bodies.erase(state.mk.mk);
    }
    for (const std::uint16_t mk : bodies)
    {
        const FitSettings* given = fit_settings(def.fit, mk);
        if (given == nullptr || given->place ||
            (given->boundary ? given->boundary == WallBoundary::Mdbc : is_mdbc))
            continue;
        FitSettings inside = *given;
        inside.place = Placement::Inside;
        inside.may_be_open = true;
        def.fit.of_mk.insert_or_assign(mk, std::move(inside));
    }
}

std::size_t shells_of(const DrawOp& op)
{
    if (const auto* sphere = shape_as<SphereOp>(op)) return sphere->layers_dp.size();
    if (const auto* cylinder = shape_as<CylinderOp>(op)) return cylinder->layers.size();
    return 1;
}

/// Shells of `layers vdp` that thicken a wall on the lattice: where walls stand in layers of their
/// own, the shape itself is drawn once in their place.
void draw_shells_once(CaseDef& def)
{
    std::vector<int> lines;
    DrawOp* drawn = nullptr;
    for (DrawOp& op : def.ops)
    {
        const FitSettings* settings = op.state->mk.kind == MkKind::Bound && op.surface != nullptr
                                          ? fit_settings(def.fit, op.state->mk.mk)
                                          : nullptr;
        if (settings == nullptr || settings->depths_dp.empty() ||
            settings->place == Placement::Inside || !op.state->draw_points)
            continue;
        const std::size_t shells = shells_of(op);
        if (drawn != nullptr && op.surface == drawn->surface)
        {
            drawn->shells += shells;
            DrawState state = *op.state;
            state.draw_points = false;
            op.state = std::make_shared<const DrawState>(std::move(state));
            continue;
        }
        drawn = &op;
        op.shells = shells;
        op.what = *op.surface;
        if (lines.empty() || lines.back() != op.source.line) lines.push_back(op.source.line);
    }
    if (lines.empty()) return;
    def.warnings.push_back(
        fmt::format("{}: <layers vdp> of the shapes of line{} {} is left out: body-fitted walls "
                    "stand in layers "
                    "of their own, behind the shapes themselves.",
                    def.file, lines.size() == 1 ? "" : "s", fmt::join(lines, ", ")));
}

} // namespace

void settle_boundaries(const AttributeReader& read, CaseDef& def)
{
    def.solver.boundary = whole_parameter(def, "Boundary").value_or(1);
    std::vector<std::string> unknown;
    def.solver.inout = read_inout_zones(def, unknown);
    if (def.fit.is_empty()) return;
    def.warnings.insert(def.warnings.end(), unknown.begin(), unknown.end());
    def.solver.slip_mode = whole_parameter(def, "SlipMode").value_or(1);
    def.solver.no_penetration = def.solver.boundary == 2 && def.solver.slip_mode >= 2 &&
                                whole_parameter(def, "NoPenetration").value_or(0) == 1;
    def.solver.kernel = whole_parameter(def, "Kernel").value_or(2);
    def.solver.flexible = flexible_mks(read, def);
    const std::optional<int> parameter = whole_parameter(def, "Boundary");
    const bool is_mdbc = parameter == 2;
    const double kernel_dp = 2 * def.h / def.grid.dp;
    if (!(kernel_dp > 0 && kernel_dp <= most_layers + 1))
        throw CaseError(def.file,
                        def.fit.all ? def.fit.all->line : def.fit.of_mk.begin()->second.line,
                        fmt::format("<bodyfitted>: 2h is {:.3g} dp by the constants of the case, "
                                    "expected more than 0 and at most {} dp; coefh or hdp sets it",
                                    kernel_dp, most_layers + 1));
    // The elements with an mk list give one entry an mk; each element is judged once.
    std::set<int> judged;
    const auto settle = [&](FitSettings& s)
    {
        const bool is_first = judged.insert(s.line).second;
        if (!s.boundary)
            s.boundary = is_mdbc ? WallBoundary::Mdbc : WallBoundary::Dbc;
        else if (is_first && parameter && (s.boundary == WallBoundary::Mdbc) != is_mdbc)
            def.warnings.push_back(fmt::format(
                "{}:{}: <bodyfitted boundary=\"{}\">: the parameter Boundary of the case is {}, "
                "with which the solver expects walls for {}.",
                def.file, s.line, is_mdbc ? "dbc" : "mdbc", *parameter, is_mdbc ? "mDBC" : "DBC"));
        settle_depths(kernel_dp, s);
        // The places themselves give the normals.
        if (s.boundary == WallBoundary::Mdbc) def.normals.is_active = true;
        if (is_first) judge_layers(s, kernel_dp, def);
    };
    put_floating_inside(is_mdbc, def);
    if (def.fit.all) settle(*def.fit.all);
    for (auto& of_mk : def.fit.of_mk) settle(of_mk.second);
    if (is_mdbc) hint_at_parameters(def);
    draw_shells_once(def);
}

} // namespace fppg
