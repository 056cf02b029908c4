#include "casedef/wall_boundary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace fppg
{
namespace
{

/// The value of a parameter of the solver; empty without.
std::optional<std::string> parameter_of(const CaseDef& def, std::string_view name)
{
    std::optional<std::string> out;
    for (const Element& e : def.execution)
    {
        if (e.name != "parameters") continue;
        for (const Element& p : e.children)
        {
            const std::string* key = p.find_attribute("key");
            const std::string* value = p.find_attribute("value");
            if (key != nullptr && value != nullptr && *key == name) out = *value;
        }
    }
    return out;
}

/// Fluid at the surface sees 2 h of wall, so that layer k is needed while k < 2h/dp - 1.
std::vector<double> layer_depths(const FitSettings& settings, double kernel_dp)
{
    std::vector<double> out;
    const bool is_mdbc = settings.boundary == WallBoundary::Mdbc;
    int count = settings.layers.value_or(0);
    if (is_mdbc && !settings.layers)
        count = std::max(1, static_cast<int>(std::ceil(kernel_dp - 1 - 1e-9)));
    for (int k = 0; k < count; ++k) out.push_back(k + (is_mdbc ? 0.5 : 0.0));
    return out;
}

} // namespace

void settle_boundaries(CaseDef& def)
{
    const std::optional<std::string> parameter = parameter_of(def, "Boundary");
    const bool is_mdbc = parameter == "2";
    const auto settle = [&](FitSettings& s)
    {
        if (!s.boundary)
            s.boundary = is_mdbc ? WallBoundary::Mdbc : WallBoundary::Dbc;
        else if (parameter && (s.boundary == WallBoundary::Mdbc) != is_mdbc)
            def.warnings.push_back(fmt::format(
                "{}:{}: <bodyfitted boundary=\"{}\">: the parameter Boundary of the case is {}, "
                "with which the solver expects walls for {}.",
                def.file, s.line, is_mdbc ? "dbc" : "mdbc", *parameter, is_mdbc ? "mDBC" : "DBC"));
        s.depths_dp = layer_depths(s, 2 * def.h / def.grid.dp);
        // The places themselves give the normals.
        if (s.boundary == WallBoundary::Mdbc) def.normals.is_active = true;
    };
    if (def.fit.all) settle(*def.fit.all);
    for (auto& of_mk : def.fit.of_mk) settle(of_mk.second);
}

} // namespace fppg
