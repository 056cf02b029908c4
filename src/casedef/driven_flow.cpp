#include "casedef/driven_flow.h"

#include <fmt/format.h>

#include <cmath>

namespace fppg
{
namespace
{

/// Whether fluid enters, or leaves, through zones that face each other along an axis.
bool has_zones_at_both_ends(const InOutZones& inout, int axis)
{
    constexpr double along = 0.9; // of a unit vector
    bool has_up = false;
    bool has_down = false;
    const auto add = [&](const Vec3& way)
    {
        has_up = has_up || way[axis] > along;
        has_down = has_down || way[axis] < -along;
    };
    for (const auto& [mk, inlet] : inout.fluids) add(inlet.way);
    for (const InletShape& shape : inout.shapes) add(shape.way);
    return has_up && has_down;
}

} // namespace

void find_driving_gravity(CaseDef& def)
{
    constexpr double most_between_zones = 0.5; // of gravity: a shaft holds its fluid back
    ConstantsDef& c = def.constants;
    if (def.fit.is_empty() || c.rhop_gradient == 1) return;
    for (int axis = 0; axis < 3; ++axis)
    {
        const bool is_periodic = def.grid.is_periodic[static_cast<std::size_t>(axis)];
        if (c.gravity[axis] == 0 ||
            (!is_periodic && (std::abs(c.gravity[axis]) > most_between_zones * norm(c.gravity) ||
                              !has_zones_at_both_ends(def.solver.inout, axis))))
            continue;
        c.driving[axis] = c.gravity[axis];
        def.warnings.push_back(fmt::format(
            "{}: gravity drives the fluid along {}, {}: densities are those of depths without that "
            "part of gravity. By GenCase's depths they would {}.",
            def.file, "xyz"[axis], is_periodic ? "which is periodic" : "between zones of <inout>",
            is_periodic ? "jump at the end of the period" : "fall along the channel"));
    }
}

} // namespace fppg
