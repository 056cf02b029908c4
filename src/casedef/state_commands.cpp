// Commands that change the state of the draws: mk, modes, constants.
#include "casedef/command_table.h"
#include "casedef/patterns.h"
#include "core/text.h"

#include <fmt/format.h>

#include <tuple>
#include <utility>

namespace fppg::commands
{
namespace
{

/// Takes the top of a stack; nothing of an empty one.
template <typename Value>
void pop(std::vector<Value>& stack, Value& target)
{
    if (stack.empty()) return;
    target = std::move(stack.back());
    stack.pop_back();
}

void set_next_mk(Program& p, const Element& e, MkKind kind)
{
    const int step = p.read.plain_flag_or(e, "next", true) ? 1 : -1;
    const int next = p.state.mk.kind == kind ? p.state.mk.mk_type + step : 0;
    if (next < 0)
        p.read.fail(e, "there is no mk below 0, expected next=\"true\" or a higher mk before it");
    p.set_mk(e, kind, next);
}

void set_mk_of(Program& p, const Element& e, MkKind kind)
{
    p.set_mk(e, kind, p.read.integer(e, "mk", 0, 65000, false));
}

void set_mk_back(Program& p, const Element& e, MkKind kind)
{
    p.state.mk_back = p.mk_value(e, kind, p.read.integer(e, "mk", 0, 65000, false));
}

} // namespace

void set_mk_void(Program& p, const Element& e)
{
    p.set_mk(e, MkKind::Void, 0);
}

void set_mk_fluid(Program& p, const Element& e)
{
    set_mk_of(p, e, MkKind::Fluid);
}

void set_mk_bound(Program& p, const Element& e)
{
    set_mk_of(p, e, MkKind::Bound);
}

void set_mk_next_fluid(Program& p, const Element& e)
{
    set_next_mk(p, e, MkKind::Fluid);
}

void set_mk_next_bound(Program& p, const Element& e)
{
    set_next_mk(p, e, MkKind::Bound);
}

void set_mk_next_auto(Program& p, const Element& e)
{
    p.read.text(e, "auto");
    p.state.mk_next_auto = p.read.plain_flag_or(e, "auto", false);
}

void set_draw_mode(Program& p, const Element& e)
{
    const std::string& mode = p.read.text(e, "mode");
    if (mode == "wire")
        p.state.mode = DrawMode::Wire;
    else if (mode == "face")
        p.state.mode = DrawMode::Face;
    else if (mode == "solid")
        p.state.mode = DrawMode::Solid;
    else if (mode == "full")
        p.state.mode = DrawMode::Full;
    else
        p.read.fail(
            e, fmt::format("mode \"{}\" is invalid, expected wire, face, solid or full", mode));
}

void set_box_limit_mode(Program& p, const Element& e)
{
    const std::string& mode = p.read.text(e, "mode");
    if (mode != "inner" && mode != "full")
        p.read.fail(e, fmt::format("mode \"{}\" is invalid, expected inner or full", mode));
    p.state.box_limit_full = mode == "full";
}

void set_fr_draw_mode(Program& p, const Element& e)
{
    p.state.off_lattice = p.flag_of(e, "auto");
}

void set_normal_invert(Program& p, const Element& e)
{
    p.read.text(e, "invert");
    p.state.normal_invert = p.read.plain_flag_or(e, "invert", false);
}

void set_active(Program& p, const Element& e)
{
    for (const Element::Attribute& a : e.attributes)
        if (a.name != "drawpoints" && a.name != "drawshapes" && a.name != "vtkout" &&
            a.name != "if" && !a.name.starts_with('_') && !a.name.starts_with("fppg:"))
            p.read.fail(e, fmt::format("attribute '{}' is not known, expected drawpoints or "
                                       "drawshapes",
                                       a.name));
    p.state.draw_points = p.read.flag_or(e, "drawpoints", p.state.draw_points);
    p.state.draw_shapes = p.read.flag_or(e, "drawshapes", p.state.draw_shapes);
}

void set_dp_ctes(Program& p, const Element& e)
{
    DrawConstants& c = p.state.constants;
    c.line = p.read.number_or(e, "cteline", c.line);
    c.triangle_weight = p.read.number_or(e, "ctetriangleweight", c.triangle_weight);
    c.triangle_limits = p.read.number_or(e, "ctetrianglelimits", c.triangle_limits);
    c.sphere = p.read.number_or(e, "ctesphere", c.sphere);
    c.ellipsoid = p.read.number_or(e, "cteellipsoid", c.ellipsoid);
    c.cylinder_tube = p.read.number_or(e, "ctecylindertube", c.cylinder_tube);
    c.cylinder_cover = p.read.number_or(e, "ctecylindercover", c.cylinder_cover);
    if (e.find_attribute("ctespherenumsides") != nullptr)
        c.sphere_sides = p.read.integer(e, "ctespherenumsides", 3, 100000, true);
    if (e.find_attribute("ctecylindernumsides") != nullptr)
        c.cylinder_sides = p.read.integer(e, "ctecylindernumsides", 3, 100000, true);
}

void save_dp_ctes(Program& p, const Element&)
{
    p.saved_constants.push_back(p.state.constants);
}

void load_dp_ctes(Program& p, const Element&)
{
    pop(p.saved_constants, p.state.constants);
}

void reset_dp_ctes(Program& p, const Element&)
{
    p.state.constants = {};
}

void save_mk(Program& p, const Element&)
{
    p.saved_mks.emplace_back(p.state.mk, p.state.mk_back, p.state.pattern);
}

void load_mk(Program& p, const Element&)
{
    std::tuple all{p.state.mk, p.state.mk_back, p.state.pattern};
    pop(p.saved_mks, all);
    std::tie(p.state.mk, p.state.mk_back, p.state.pattern) = std::move(all);
}

void set_mk_back_void(Program& p, const Element&)
{
    p.state.mk_back = MkValue{};
}

void set_mk_back_fluid(Program& p, const Element& e)
{
    set_mk_back(p, e, MkKind::Fluid);
}

void set_mk_back_bound(Program& p, const Element& e)
{
    set_mk_back(p, e, MkKind::Bound);
}

void clear_mk_back(Program& p, const Element&)
{
    p.state.mk_back.reset();
}

void set_pattern(Program& p, const Element& e)
{
    const auto found = p.patterns.find(lower_case(p.read.text(e, "name")));
    if (found == p.patterns.end())
        p.read.fail(
            e, fmt::format("there is no pattern named '{}' in <patterns>", p.read.text(e, "name")));
    p.state.pattern = found->second;
}

void save_state(Program& p, const Element&)
{
    p.saved_states.push_back(p.state);
    p.saved_matrices.push_back(p.matrix);
    p.saved_mks.emplace_back(p.state.mk, p.state.mk_back, p.state.pattern);
    p.saved_constants.push_back(p.state.constants);
}

void load_state(Program& p, const Element& e)
{
    DrawState loaded = p.state;
    pop(p.saved_states, loaded);
    loaded.clips = std::move(p.state.clips);
    loaded.mk = p.state.mk;
    loaded.mk_back = p.state.mk_back;
    loaded.pattern = p.state.pattern;
    loaded.constants = p.state.constants;
    p.state = std::move(loaded);
    load_mk(p, e);
    pop(p.saved_constants, p.state.constants);
    pop(p.saved_matrices, p.matrix);
    p.place_clips();
}

void reset_draw(Program& p, const Element& e)
{
    p.add(e, ResetOp{});
    p.pictures_forgotten = p.def.debug_boxes.size();
    p.line_begin = p.def.case_pos_min;
    auto pattern = std::move(p.state.pattern);
    p.state = {};
    p.state.pattern = std::move(pattern);
    p.matrix = {};
    p.defined_clips.clear();
    p.clip_matrix = {};
    p.saved_states.clear();
    p.saved_matrices.clear();
    p.saved_mks.clear();
    p.saved_constants.clear();
}

void set_shape_mode(Program& p, const Element& e)
{
    const unsigned bits = p.read.word_bits(e, e.text, "shape mode",
                                           {{"null", 0},
                                            {"actual", 1},
                                            {"real", 1}, // its name in GenCase v4.0 and v5.0
                                            {"dp", 2},
                                            {"all", 4 | 8 | 16},
                                            {"void", 4},
                                            {"bound", 8},
                                            {"fluid", 16}});
    p.state.shape_mode = {
        (bits & 1) != 0, (bits & 2) != 0, {(bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0}};
}

} // namespace fppg::commands
