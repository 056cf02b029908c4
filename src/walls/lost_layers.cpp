#include "walls/lost_layers.h"

#include "nodes/domain.h"
#include "offset/wall_depth.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace fppg
{
namespace
{

/// How far particles lie beyond the first and the last nodes, metres.
struct Beyond
{
    std::array<double, 3> low{};
    std::array<double, 3> high{};
    std::size_t count = 0;

    void add(const Vec3& p, const LatticeGrid& grid)
    {
        ++count;
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto a = static_cast<std::size_t>(axis);
            const double last = grid.origin[axis] + (grid.n[a] - 1) * grid.step(axis);
            low[a] = std::max(low[a], grid.origin[axis] - p[axis]);
            high[a] = std::max(high[a], p[axis] - last);
        }
    }

    std::vector<std::string> ways() const
    {
        std::vector<std::string> out;
        for (std::size_t a = 0; a < 3; ++a)
        {
            if (low[a] > 0) out.push_back(fmt::format("-{} ({:.3g} m)", "xyz"[a], low[a]));
            if (high[a] > 0) out.push_back(fmt::format("+{} ({:.3g} m)", "xyz"[a], high[a]));
        }
        return out;
    }
};

} // namespace

void warn_of_lost_layers(const std::string& place, const LatticeGrid& grid, FittedStep& step)
{
    // Sheets of dynamic boundaries hold fluid with one row too, but not at rest.
    constexpr double told_share = 0.02;
    Beyond lost;
    Beyond of_sheets;
    double rows = 0;
    for (const FittedDraw& draw : step.draws)
    {
        const bool is_sheet = draw.body.layered_step != no_index;
        if (is_sheet) rows += static_cast<double>(draw.particles.size());
        for (std::size_t i = 0; i < draw.cut.size(); ++i)
        {
            const std::uint32_t body = draw.cut_bodies[i];
            if (body == 0 || is_in_domain(draw.cut[i], grid, beyond_period_dp)) continue;
            const WallDepth* wall = draw.layers[body - 1].wall.get();
            if (wall != nullptr && is_in_domain(wall->at(draw.cut[i]).nearest, grid))
                (is_sheet ? of_sheets : lost).add(draw.cut[i], grid);
        }
    }
    if (static_cast<double>(of_sheets.count) > told_share * rows)
        step.warnings.push_back(fmt::format(
            "{}: {} particles of the rows behind this sheet lie beyond the domain and are left "
            "out: fluid beside it does not stay at rest. Let <definition> reach further to {}.",
            place, of_sheets.count, fmt::join(of_sheets.ways(), ", ")));
    if (lost.count == 0) return;
    step.warnings.push_back(fmt::format(
        "{}: {} particles of layers lie beyond the domain and are left out, though their wall is "
        "in it: fluid can get through. Let <definition> reach further to {}.",
        place, lost.count, fmt::join(lost.ways(), ", ")));
}

} // namespace fppg
