// Commands that fill and redraw.
#include "casedef/command_table.h"
#include "core/text.h"
#include "shapes/polyhedra.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

namespace fppg::commands
{
namespace
{

FillFilter fill_filter(const Program& p, const Element& e, const std::string& words)
{
    FillFilter filter;
    const unsigned bits = p.read.word_bits(
        e, words, "modefill", {{"void", 1}, {"fluid", 2}, {"bound", 4}, {"border", 8}});
    filter.names[static_cast<std::size_t>(MkKind::Void)] = (bits & 1) != 0;
    filter.names[static_cast<std::size_t>(MkKind::Fluid)] = (bits & 2) != 0;
    filter.names[static_cast<std::size_t>(MkKind::Bound)] = (bits & 4) != 0;
    filter.border = (bits & 8) != 0;
    filter.mkbound = p.absolute_mk(e, "mkbound", MkKind::Bound);
    filter.mkfluid = p.absolute_mk(e, "mkfluid", MkKind::Fluid);
    if (filter.names[static_cast<std::size_t>(MkKind::Bound)])
        p.check_mk(e, "mkbound", MkKind::Bound);
    if (filter.names[static_cast<std::size_t>(MkKind::Fluid)])
        p.check_mk(e, "mkfluid", MkKind::Fluid);
    return filter;
}

MkFilter near_filter(const Program& p, const Element& e, const char* type, const char* mk)
{
    const std::string word = lower_case(p.read.text(e, type));
    MkFilter filter;
    if (word == "void")
        filter.kind = MkKind::Void;
    else if (word == "bound")
        filter.kind = MkKind::Bound;
    else if (word == "fluid")
        filter.kind = MkKind::Fluid;
    else
        p.read.fail(e, fmt::format("attribute {}=\"{}\" is invalid, expected void, fluid or bound",
                                   type, word));
    if (filter.kind == MkKind::Void) return filter;
    p.check_mk(e, mk, filter.kind);
    filter.mk = p.absolute_mk(e, mk, filter.kind);
    return filter;
}

void fill(Program& p, const Element& e, const std::string& words, std::optional<BoxLimits> region)
{
    FillOp op;
    op.seed = p.matrix(p.read.vec3(e));
    op.filter = fill_filter(p, e, words);
    op.region = std::move(region);
    p.add(e, std::move(op));
}

const std::string& modes_of(const Program& p, const Element& e)
{
    return p.read.child(e, "modefill").text;
}

RedrawOp redraw_of(const Program& p, const Element& e)
{
    RedrawOp op;
    // With both attributes mkbound alone counts. A mkfluid beyond those of <mkconfig> is the
    // number of a boundary: with six of them mkfluid="6" recolours mkbound 0 (GenCase
    // v5.4.354, which refuses such a number in fills and redrawnear).
    const auto mkbound = p.absolute_mk(e, "mkbound", MkKind::Bound);
    const auto mk = mkbound ? mkbound : p.absolute_mk(e, "mkfluid", MkKind::Fluid);
    if (mk) op.filters.push_back({*mk >= p.def.mk_bound_first ? MkKind::Bound : MkKind::Fluid, mk});
    return op;
}

RedrawNearOp redraw_near_of(const Program& p, const Element& e)
{
    RedrawNearOp op;
    op.target = near_filter(p, e, "targettp", "targetmk");
    op.border = near_filter(p, e, "bordertp", "bordermk");
    if (e.find_attribute("times") != nullptr)
        op.times = p.read.integer(e, "times", 0, 1'000'000, true);
    if (const Element* filter = e.find_child("dirfilter"))
    {
        const unsigned bits = p.read.word_bits(e, filter->text, "direction",
                                               {{"all", 63},
                                                {"top", 1},
                                                {"bottom", 2},
                                                {"right", 4},
                                                {"left", 8},
                                                {"back", 16},
                                                {"front", 32}});
        for (std::size_t d = 0; d < 6; ++d) op.directions[d] = (bits >> d & 1) != 0;
    }
    return op;
}

} // namespace

void fill_point(Program& p, const Element& e)
{
    fill(p, e, modes_of(p, e), {});
}

void fill_void_point(Program& p, const Element& e)
{
    fill(p, e, "void", {});
}

void fill_box(Program& p, const Element& e)
{
    p.keep_debug_box(e, p.state.box_limit_full, p.matrix(p.read.vec3(e)));
    fill(p, e, modes_of(p, e), p.limits_of(e, p.state.box_limit_full));
}

void fill_figure(Program& p, const Element& e)
{
    PolyhedronOp polyhedron = p.polyhedron_of(e);
    polyhedron.solid = SolidKind::Faces;
    transform_polyhedron(polyhedron, p.matrix);
    fill(p, e, modes_of(p, e), std::move(polyhedron));
}

void fill_prism(Program& p, const Element& e)
{
    fill(p, e, modes_of(p, e), prism_limits(p.transformed_points(e, 6, many_points)));
}

void redraw(Program& p, const Element& e)
{
    p.add(e, redraw_of(p, e));
}

void redraw_box(Program& p, const Element& e)
{
    RedrawOp op = redraw_of(p, e);
    // Without an mk it is for void nodes alone (seen with GenCase v5.4).
    if (op.filters.empty()) op.filters.push_back({MkKind::Void, std::nullopt});
    op.region = p.limits_of(e, false);
    p.keep_debug_box(e, false, std::nullopt);
    p.add(e, std::move(op));
}

void redraw_near(Program& p, const Element& e)
{
    p.add(e, redraw_near_of(p, e));
}

void redraw_near_box(Program& p, const Element& e)
{
    RedrawNearOp op = redraw_near_of(p, e);
    op.region = p.limits_of(e, p.state.box_limit_full);
    p.keep_debug_box(e, p.state.box_limit_full, std::nullopt);
    p.add(e, std::move(op));
}

} // namespace fppg::commands
