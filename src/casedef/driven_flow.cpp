#include "casedef/driven_flow.h"

#include <fmt/format.h>

#include <cmath>

namespace fppg
{

void drop_driven_depth(CaseDef& def)
{
    constexpr double driving = 0.5; // of gravity
    ConstantsDef& c = def.constants;
    if (def.fit.is_empty() || c.rhop_gradient == 1) return;
    for (int axis = 0; axis < 3; ++axis)
        if (def.grid.is_periodic[static_cast<std::size_t>(axis)] &&
            std::abs(c.gravity[axis]) > driving * norm(c.gravity))
        {
            c.rhop_gradient = 1;
            def.warnings.push_back(fmt::format(
                "{}: gravity drives the fluid along {}, which is periodic: its density is rhop0 "
                "everywhere. By depths, which GenCase takes, it would jump at the end of the "
                "period. <rhopgradient value=\"1\" /> says the same.",
                def.file, "xyz"[axis]));
            return;
        }
}

} // namespace fppg
