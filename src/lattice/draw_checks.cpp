#include "lattice/draw_checks.h"

#include "core/text.h"
#include "lattice/mesh_units.h"
#include "meshes/open_edges.h"
#include "meshes/warning_words.h"
#include "nodes/snap.h"
#include "shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fppg
{
namespace
{

/// Over the axes that count.
template <typename IsFlat>
double smallest_extent(const Box3& box, const IsFlat& is_flat)
{
    double smallest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis)
        if (!is_flat(axis)) smallest = std::min(smallest, box.max[axis] - box.min[axis]);
    return smallest;
}

} // namespace

void DrawChecks::warn(const SourceRef& source, Kind kind, const std::string& text)
{
    if (!said_.insert({source.line, kind}).second) return;
    warnings_.push_back(
        fmt::format("{}:{}: <{}>: {}", def_.file, source.line, source.command, text));
}

void DrawChecks::check_shape(const DrawOp& op, const Box3& bounds)
{
    const DrawState& state = *op.state;
    if (bounds.is_empty() || !state.draw_points || state.mk.kind == MkKind::Void ||
        !state.clips.empty())
        return;
    const LatticeGrid& grid = def_.grid;
    const double thickness = smallest_extent(bounds, [this](int axis) { return is_flat(axis); });
    if (const auto* mesh = shape_as<MeshFileOp>(op))
    {
        if (const std::optional<std::string> wrong = wrong_units(def_, mesh->file, bounds))
        {
            warn(op.source, Kind::Size, *wrong);
            return;
        }
    }
    if (const auto* shape = std::get_if<Shape>(&op.what);
        shape != nullptr && is_body(*shape, state.mode) && thickness > 0 &&
        thickness < grid.dp * (1 - 1e-9))
        warn(
            op.source, Kind::Thin,
            fmt::format("the body is {:g} m thick, less than dp = {:g} m, so its particles are as "
                        "thick as one or two of them; a dp of {:g} or less resolves it, and size 0 "
                        "draws a single layer on purpose",
                        thickness, grid.dp, thickness / 2));
    for (int axis = 0; axis < 3; ++axis)
    {
        // What goes on beyond a period is in the next copy of the case.
        if (is_flat(axis) || grid.is_periodic[static_cast<std::size_t>(axis)]) continue;
        const std::int64_t last =
            static_cast<std::int64_t>(grid.n[static_cast<std::size_t>(axis)]) - 1;
        const std::int64_t low = snap(bounds.min[axis], grid.origin[axis], grid.step(axis));
        const std::int64_t high = snap(bounds.max[axis], grid.origin[axis], grid.step(axis));
        if (low >= 0 && high <= last) continue;
        warn(op.source, Kind::Lost,
             fmt::format("it reaches from {} = {:g} to {:g}, the nodes of the domain from {:g} to "
                         "{:g}: what lies beyond gives no particles; expected a <pointmin> and "
                         "<pointmax> around it (a node at pointmax is outside)",
                         "xyz"[axis], bounds.min[axis], bounds.max[axis], grid.origin[axis],
                         grid.origin[axis] + static_cast<double>(last) * grid.step(axis)));
        return;
    }
}

void DrawChecks::check_closed(const SourceRef& source, const MeshFileOp& op,
                              const TriangleSoup& soup, const MeshReport& repairs)
{
    if (!op.autofill && !op.fill_inside && !op.advanced) return;
    const std::uint64_t open = open_edge_count(soup);
    if (open > 0)
        warn(source, Kind::Open,
             fmt::format("{} has {} open edges or edges between facets that face opposite ways, so "
                         "its inside is not certain; close the mesh (fppg inspect shows "
                         "where) or draw it without autofill, advanced or fppg:fill",
                         op.file, open));
    if (repairs.folds > 0)
        warn(source, Kind::Folded,
             fmt::format("{} crosses itself ({} of its facets, the first {}), so its inside is not "
                         "certain there",
                         op.file, counted(repairs.folds, "pair", "pairs"),
                         near(repairs.first_fold)));
    if (open > 0 || (!op.fill_inside && !op.advanced)) return;
    const bool is_mixed =
        repairs.flipped_facets > 0 && repairs.flipped_facets < repairs.facets_read;
    const std::uint64_t twice = repairs.duplicate_facets + repairs.inner_shell_facets;
    if (is_mixed || twice > 0)
        warn(source, Kind::Open,
             fmt::format(
                 "{} has closed parts that face inwards or lie in one another ({}); {}", op.file,
                 is_mixed
                     ? counted(repairs.flipped_facets, "facet faces inwards", "facets face inwards")
                     : counted(twice, "facet has the inside on both of its faces",
                               "facets have the inside on both of their faces"),
                 op.fill_inside ? "all are filled as one solid"
                                : "GenCase's advanced mode may leave them hollow"));
}

void DrawChecks::check_fill(const SourceRef& source, const DrawState& state,
                            const std::vector<std::vector<Span>>& nodes)
{
    // The limits of other zones of <vres> are meant to cut what they have of a fill.
    if (!state.draw_points || state.mk.kind == MkKind::Void || def_.zone > 0) return;
    const LatticeGrid& grid = def_.grid;
    std::string sides;
    const auto add = [&](bool is_there, const char* side)
    {
        if (is_there) sides += (sides.empty() ? "" : ", ") + std::string(side);
    };
    std::array<bool, 6> touches{};
    for (std::size_t x = 0; x < nodes.size(); ++x)
    {
        if (nodes[x].empty()) continue;
        touches[0] = touches[0] || x == 0;
        touches[1] = touches[1] || x + 1 == grid.n[0];
        for (const Span& s : nodes[x])
        {
            touches[2] = touches[2] || s.y == 0;
            touches[3] = touches[3] || s.y + 1 == grid.n[1];
            touches[4] = touches[4] || s.z_begin == 0;
            touches[5] = touches[5] || s.z_end == grid.n[2];
        }
    }
    constexpr std::array<const char*, 6> names{"lowest x",  "highest x", "lowest y",
                                               "highest y", "lowest z",  "highest z"};
    for (std::size_t i = 0; i < 6; ++i)
        // Over a periodic border the fill goes on at the other end.
        add(touches[i] && !is_flat(static_cast<int>(i / 2)) && !grid.is_periodic[i / 2], names[i]);
    if (!sides.empty())
        warn(source, Kind::Leak,
             fmt::format("the fill reached the border of the domain ({}): expected walls around "
                         "its seed; close them, or limit the fill by <fillbox>",
                         sides));
}

} // namespace fppg
