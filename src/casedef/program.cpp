#include "casedef/program.h"

#include "fppg/error.h"

#include "casedef/figures.h"
#include "casedef/known_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

namespace fppg
{
namespace
{

constexpr int max_list_depth = 100;
constexpr std::size_t max_commands = 50'000'000;

double radians(double degrees)
{
    return degrees * std::numbers::pi / 180;
}

Transform translation(const Vec3& by)
{
    Transform t;
    t.offset = by;
    return t;
}

Transform scaling(const Vec3& s)
{
    Transform t;
    t.linear = {Vec3{s.x, 0, 0}, Vec3{0, s.y, 0}, Vec3{0, 0, s.z}};
    return t;
}

/// Right-handed rotation about an axis through the origin.
Transform rotation(const Vec3& axis, double angle)
{
    const Vec3 u = axis / norm(axis);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double k = 1 - c;
    Transform t;
    t.linear = {Vec3{c + u.x * u.x * k, u.x * u.y * k - u.z * s, u.x * u.z * k + u.y * s},
                Vec3{u.y * u.x * k + u.z * s, c + u.y * u.y * k, u.y * u.z * k - u.x * s},
                Vec3{u.z * u.x * k - u.y * s, u.z * u.y * k + u.x * s, c + u.z * u.z * k}};
    return t;
}

Transform rotation_about_axis(int axis, double angle)
{
    Vec3 u;
    u[axis] = 1;
    return rotation(u, angle);
}

Transform around(const Vec3& center, const Transform& t)
{
    return translation(center) * t * translation(-center);
}

} // namespace

ProgramRunner::ProgramRunner(CaseDef& def, VariableCommands& variables, const AttributeReader& read)
    : def_(def), variables_(variables), read_(read)
{
}

void ProgramRunner::run(const Element& commands)
{
    const Element* main = nullptr;
    for (const Element& e : commands.children)
    {
        if (e.kind != Element::Kind::Tag || e.name.starts_with('_')) continue;
        if (e.name == "list")
            lists_[read_.text(e, "name")] = &e;
        else if (e.name == "mainlist")
            main = &e;
        else
            read_.fail(e, "is not known in <commands>, expected list or mainlist");
    }
    if (main == nullptr) read_.fail(commands, "the element <mainlist> is missing in it");
    def_.list_log.push_back("> MAIN");
    run_list(*main, "MAIN");
    def_.list_log.push_back("<MAIN");
}

void ProgramRunner::run_list(const Element& list, const std::string& name)
{
    if (++depth_ > max_list_depth)
        read_.fail(list, fmt::format("lists call one another more than {} deep (list '{}')",
                                     max_list_depth, name));
    for (const Element& e : list.children)
        if (e.kind == Element::Kind::Tag && !e.name.starts_with('_')) run_command(e);
    --depth_;
}

void ProgramRunner::run_command(const Element& e)
{
    const CommandSupport support = command_support(e.name);
    if (support == CommandSupport::Unknown)
        read_.fail(e, "is not a command, see the templates for what can stand in a list");
    if (!read_.is_active(e)) return;
    if (++commands_run_ > max_commands)
        read_.fail(e, fmt::format("more than {} commands were run, the lists seem to be endless",
                                  max_commands));
    if (support == CommandSupport::Planned) read_.fail_unsupported(e);
    if (!run_state_command(e) && !run_transform(e) && !run_clip(e) &&
        !variables_.run(e, def_.list_log) && !run_flow_command(e) && !run_draw(e) &&
        !run_fill_or_redraw(e))
        read_.fail_unsupported(e);
}

void ProgramRunner::set_mk(const Element& e, MkKind kind, int mk_type)
{
    const int count = kind == MkKind::Bound ? def_.mkbound_count : def_.mkfluid_count;
    if (kind != MkKind::Void && (mk_type < 0 || mk_type >= count))
        read_.fail(
            e, fmt::format("mk {} is invalid, <mkconfig> leaves 0 to {} for {} (raise {} there)",
                           mk_type, count - 1, kind == MkKind::Bound ? "boundary" : "fluid",
                           kind == MkKind::Bound ? "boundcount" : "fluidcount"));
    MkValue value;
    value.kind = kind;
    value.mk_type = static_cast<std::uint16_t>(mk_type);
    if (kind == MkKind::Bound) value.mk = static_cast<std::uint16_t>(mk_type + def_.mk_bound_first);
    if (kind == MkKind::Fluid) value.mk = static_cast<std::uint16_t>(mk_type + def_.mk_fluid_first);
    state_.mk = value;
    shared_state_.reset();
}

bool ProgramRunner::run_state_command(const Element& e)
{
    const std::string& name = e.name;
    const auto next_mk = [&](MkKind kind)
    {
        const int step = read_.flag_or(e, "next", true) ? 1 : -1;
        set_mk(e, kind, state_.mk.kind == kind ? std::max(0, state_.mk.mk_type + step) : 0);
    };
    const auto pop = [](auto& stack, auto& target)
    {
        if (stack.empty()) return;
        target = stack.back();
        stack.pop_back();
    };
    if (name == "setmkvoid")
        set_mk(e, MkKind::Void, 0);
    else if (name == "setmkfluid" || name == "setmkbound")
        set_mk(e, name == "setmkfluid" ? MkKind::Fluid : MkKind::Bound,
               read_.integer(e, "mk", 0, 65000, false));
    else if (name == "setmknextfluid")
        next_mk(MkKind::Fluid);
    else if (name == "setmknextbound")
        next_mk(MkKind::Bound);
    else if (name == "setmknextauto")
    {
        if (read_.flag_or(e, "auto", false)) read_.fail_unsupported(e, "auto=\"true\"");
    }
    else if (name == "setdrawmode")
    {
        const std::string& mode = read_.text(e, "mode");
        if (mode == "wire")
            state_.mode = DrawMode::Wire;
        else if (mode == "face")
            state_.mode = DrawMode::Face;
        else if (mode == "solid")
            state_.mode = DrawMode::Solid;
        else if (mode == "full")
            state_.mode = DrawMode::Full;
        else
            read_.fail(
                e, fmt::format("mode \"{}\" is invalid, expected wire, face, solid or full", mode));
    }
    else if (name == "setboxlimitmode")
    {
        const std::string& mode = read_.text(e, "mode");
        if (mode != "inner" && mode != "full")
            read_.fail(e, fmt::format("mode \"{}\" is invalid, expected inner or full", mode));
        state_.box_limit_full = mode == "full";
    }
    else if (name == "setfrdrawmode")
    {
        if (read_.flag_or(e, "auto", false))
            read_.fail_unsupported(e, "auto=\"true\" (free particles)");
    }
    else if (name == "setnormalinvert")
        state_.normal_invert = read_.flag_or(e, "invert", true);
    else if (name == "setactive")
    {
        state_.draw_points = read_.flag_or(e, "drawpoints", state_.draw_points);
        state_.draw_shapes = read_.flag_or(e, "drawshapes", state_.draw_shapes);
    }
    else if (name == "setdpctes")
    {
        DrawConstants& c = state_.constants;
        c.line = read_.number_or(e, "cteline", c.line);
        c.triangle_weight = read_.number_or(e, "ctetriangleweight", c.triangle_weight);
        c.triangle_limits = read_.number_or(e, "ctetrianglelimits", c.triangle_limits);
        c.sphere = read_.number_or(e, "ctesphere", c.sphere);
        c.ellipsoid = read_.number_or(e, "cteellipsoid", c.ellipsoid);
        c.cylinder_tube = read_.number_or(e, "ctecylindertube", c.cylinder_tube);
        c.cylinder_cover = read_.number_or(e, "ctecylindercover", c.cylinder_cover);
        if (e.find_attribute("ctespherenumsides") != nullptr)
            c.sphere_sides = read_.integer(e, "ctespherenumsides", 3, 100000, true);
        if (e.find_attribute("ctecylindernumsides") != nullptr)
            c.cylinder_sides = read_.integer(e, "ctecylindernumsides", 3, 100000, true);
    }
    else if (name == "dpctessave")
        saved_constants_.push_back(state_.constants);
    else if (name == "dpctesload")
        pop(saved_constants_, state_.constants);
    else if (name == "dpctesreset")
        state_.constants = {};
    else if (name == "mksave")
        saved_mks_.push_back(state_.mk);
    else if (name == "mkload")
        pop(saved_mks_, state_.mk);
    else if (name == "statesave")
        saved_states_.push_back({state_, matrix_});
    else if (name == "stateload")
    {
        if (!saved_states_.empty())
        {
            std::vector<ClipPlane> clips = std::move(state_.clips);
            state_ = saved_states_.back().state;
            state_.clips = std::move(clips);
            matrix_ = saved_states_.back().matrix;
            saved_states_.pop_back();
        }
    }
    else if (name == "resetdraw")
    {
        add(e, ResetOp{});
        state_ = {};
        matrix_ = {};
    }
    else if (name == "setshapemode")
    {
        const auto words = read_.words(e, e.text, "shape mode",
                                       {"null", "actual", "dp", "all", "bound", "fluid", "void"});
        std::array<bool, 2> forms{};
        std::array<bool, 3> kinds{};
        for (const std::string& w : words)
        {
            if (w == "actual") forms[0] = true;
            if (w == "dp") forms[1] = true;
            if (w == "void") kinds[0] = true;
            if (w == "bound") kinds[1] = true;
            if (w == "fluid") kinds[2] = true;
            if (w == "all") kinds = {true, true, true};
        }
        shape_forms_ = forms;
        shape_kinds_ = kinds;
    }
    else
        return false;
    shared_state_.reset();
    return true;
}

bool ProgramRunner::run_transform(const Element& e)
{
    const std::string& name = e.name;
    if (name == "matrixreset")
        matrix_ = {};
    else if (name == "matrixsave")
        saved_matrices_.push_back(matrix_);
    else if (name == "matrixload")
    {
        if (!saved_matrices_.empty())
        {
            matrix_ = saved_matrices_.back();
            saved_matrices_.pop_back();
        }
    }
    else if (name == "move")
        matrix_ = matrix_ * translation(read_.vec3(e));
    else if (name == "scale")
        matrix_ = matrix_ * scaling(read_.vec3(e));
    else if (name == "rotate")
    {
        const Vec3 axis = read_.vec3(e);
        if (norm(axis) == 0) read_.fail(e, "the axis (x, y, z) is zero, expected a direction");
        // Clockwise seen from the tip of the axis (rule T2).
        matrix_ = matrix_ * rotation(axis, -radians(read_.number(e, "ang")));
    }
    else if (name == "rotateline")
    {
        const std::vector<Vec3> points = read_.points(e);
        if (points.size() != 2)
            read_.fail(e, fmt::format("has {} points, expected 2", points.size()));
        const Vec3 axis = points[1] - points[0];
        if (norm(axis) == 0) read_.fail(e, "its two points are the same, expected an axis");
        matrix_ = matrix_ * around(points[0], rotation(axis, -radians(read_.number(e, "ang"))));
    }
    else if (name == "rotateadv")
    {
        const std::string axes = read_.text_or(e, "axes", "XYZ");
        const auto is_axis = [](char c) { return c >= 'X' && c <= 'Z'; };
        if (axes.size() != 3 || !std::all_of(axes.begin(), axes.end(), is_axis))
            read_.fail(e, fmt::format("axes \"{}\" is invalid, expected three of X, Y, Z", axes));
        std::array<Transform, 3> turns;
        const std::array<const char*, 3> names{"ang1", "ang2", "ang3"};
        for (std::size_t i = 0; i < 3; ++i)
            turns[i] = rotation_about_axis(axes[i] - 'X', radians(read_.number_or(e, names[i], 0)));
        const Transform t = read_.flag_or(e, "intrinsic", true) ? turns[0] * turns[1] * turns[2]
                                                                : turns[2] * turns[1] * turns[0];
        const Element* center = e.find_child("center");
        matrix_ = matrix_ * (center != nullptr ? around(read_.vec3(*center), t) : t);
    }
    else
        return false;
    return true;
}

bool ProgramRunner::run_clip(const Element& e)
{
    const std::string& name = e.name;
    if (name == "clipreset")
        state_.clips.clear();
    else if (name == "clipplane")
    {
        ClipPlane plane;
        if (e.find_child("point1") != nullptr)
        {
            const Vec3 p1 = matrix_(read_.child_vec3(e, "point1"));
            const Vec3 p2 = matrix_(read_.child_vec3(e, "point2"));
            const Vec3 p3 = matrix_(read_.child_vec3(e, "point3"));
            plane = {p1, cross(p2 - p1, p3 - p1)};
        }
        else
        {
            const Vec3 point = read_.child_vec3(e, "point");
            plane.point = matrix_(point);
            plane.normal = matrix_(point + read_.child_vec3(e, "vector")) - plane.point;
            if (matrix_.is_identity()) plane.normal = read_.child_vec3(e, "vector");
        }
        if (norm(plane.normal) == 0)
            read_.fail(e, "the plane has no direction, expected a vector that is not zero");
        state_.clips.push_back(plane);
    }
    else if (name == "clipbox")
    {
        if (e.find_child("angles") != nullptr) read_.fail_unsupported(e, "<angles>");
        std::array<bool, 6> faces{true, true, true, true, true, true};
        if (const Element* which = e.find_child("boxfaces"))
        {
            faces = {};
            for (const std::string& w :
                 read_.words(e, which->text, "box face",
                             {"all", "bottom", "top", "left", "right", "front", "back"}))
            {
                if (w == "all") faces = {true, true, true, true, true, true};
                if (w == "bottom") faces[BoxBottom] = true;
                if (w == "top") faces[BoxTop] = true;
                if (w == "left") faces[BoxLeft] = true;
                if (w == "right") faces[BoxRight] = true;
                if (w == "front") faces[BoxFront] = true;
                if (w == "back") faces[BoxBack] = true;
            }
        }
        const Transform matrix = matrix_;
        matrix_ = {};
        const BoxRegion box = box_of(e);
        matrix_ = matrix;
        Vec3 low;
        Vec3 high;
        for (int axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(box.corner0[axis], box.corner1[axis]);
            high[axis] = std::max(box.corner0[axis], box.corner1[axis]);
        }
        const auto side = [&](BoxSide which, const Vec3& at, const Vec3& outward)
        {
            if (!faces[which]) return;
            if (matrix_.is_identity())
                state_.clips.push_back({at, outward});
            else
                state_.clips.push_back({matrix_(at), matrix_(at + outward) - matrix_(at)});
        };
        side(BoxBottom, low, {0, 0, -1});
        side(BoxTop, high, {0, 0, 1});
        side(BoxLeft, low, {-1, 0, 0});
        side(BoxRight, high, {1, 0, 0});
        side(BoxFront, low, {0, -1, 0});
        side(BoxBack, high, {0, 1, 0});
    }
    else
        return false;
    shared_state_.reset();
    return true;
}

bool ProgramRunner::run_flow_command(const Element& e)
{
    const std::string& name = e.name;
    if (name == "runlist")
    {
        const std::string& list = read_.text(e, "name");
        const auto found = lists_.find(list);
        if (found == lists_.end()) read_.fail(e, fmt::format("there is no list named '{}'", list));
        const int times = e.find_attribute("times") != nullptr
                              ? read_.integer(e, "times", 0, 1'000'000'000, true)
                              : 1;
        const bool is_printed = read_.flag_or(*found->second, "printcall", true);
        for (int i = 0; i < times; ++i)
        {
            if (is_printed) def_.list_log.push_back("> " + list);
            run_list(*found->second, list);
        }
    }
    else if (name == "printf")
        def_.list_log.push_back(read_.interpolated(e, read_.text(e, "text")));
    else if (name == "abort")
        throw CaseError(def_.file, e.line,
                        fmt::format("<abort>: the case stops itself: {}",
                                    read_.interpolated(e, read_.text_or(e, "text", "(no text)"))));
    else if (name == "shapeout")
        shape_out(e);
    else if (name == "debugout")
        return true; // a picture for GenCase's own debugging, written at a debug level only
    else
        return false;
    return true;
}

void ProgramRunner::add(const Element& e, DrawVariant what)
{
    if (!shared_state_) shared_state_ = std::make_shared<const DrawState>(state_);
    def_.ops.push_back({{e.line, e.name}, shared_state_, std::move(what)});
}

void ProgramRunner::add_figure(const Element& e, FigureOp figure)
{
    transform_figure(figure, matrix_);
    add(e, std::move(figure));
}

std::vector<Vec3> ProgramRunner::transformed_points(const Element& e, std::size_t at_least,
                                                    std::size_t at_most) const
{
    std::vector<Vec3> points = read_.points(e);
    if (points.size() < at_least || points.size() > at_most)
        read_.fail(
            e, at_least == at_most
                   ? fmt::format("has {} points, expected {}", points.size(), at_least)
                   : fmt::format("has {} points, expected at least {}", points.size(), at_least));
    for (Vec3& p : points) p = matrix_(p);
    return points;
}

FigureOp ProgramRunner::figure_of(const Element& e) const
{
    FigureOp figure;
    figure.vertices = read_.points(read_.child(e, "points"));
    for (const Element& t : read_.child(e, "triangles").children)
    {
        if (t.kind != Element::Kind::Tag || t.name != "triangle") continue;
        FigureFace face;
        for (const char* axis : {"x", "y", "z"})
            face.vertices.push_back(static_cast<std::uint32_t>(
                read_.integer(t, axis, 0, static_cast<int>(figure.vertices.size()) - 1, true)));
        figure.faces.push_back(std::move(face));
    }
    return figure;
}

BoxRegion ProgramRunner::box_of(const Element& e) const
{
    BoxRegion box;
    box.corner0 = read_.child_vec3(e, "point");
    if (const Element* end = e.find_child("endpoint"))
        box.corner1 = read_.vec3(*end);
    else
        box.corner1 = box.corner0 + read_.child_vec3(e, "size");
    box.corner0 = matrix_(box.corner0);
    box.corner1 = matrix_(box.corner1);
    return box;
}

std::vector<double> ProgramRunner::layers_of(const Element& e) const
{
    std::vector<double> out;
    const Element* layers = e.find_child("layers");
    if (layers == nullptr) return out;
    std::string list = read_.text(*layers, "vdp");
    std::size_t begin = 0;
    while (begin <= list.size())
    {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        std::string part = list.substr(begin, end - begin);
        // A star behind the number changes no node (semantics-2, section 23).
        std::erase_if(part, [](char c) { return c == ' ' || c == '\t' || c == '*'; });
        double value = 0;
        const char* first = part.data() + (!part.empty() && part[0] == '+' ? 1 : 0);
        const auto [stop, error] = std::from_chars(first, part.data() + part.size(), value);
        if (error != std::errc() || stop != part.data() + part.size() || !std::isfinite(value))
            read_.fail(
                *layers,
                fmt::format("vdp=\"{}\" is invalid, expected numbers like \"0,-1,2.5\"", list));
        out.push_back(value);
        begin = end + 1;
    }
    return out;
}

std::vector<int> ProgramRunner::mask_of(const Element& e) const
{
    std::vector<int> out;
    const std::string* mask = e.find_attribute("mask");
    if (mask == nullptr) return out;
    std::vector<int> numbers;
    std::size_t begin = 0;
    while (begin <= mask->size())
    {
        const std::size_t end = std::min(mask->find('|', begin), mask->size());
        std::string part = mask->substr(begin, end - begin);
        std::erase_if(part, [](char c) { return c == ' ' || c == '\t'; });
        int value = 0;
        const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (error != std::errc() || stop != part.data() + part.size() || value < 0)
            read_.fail(
                e, fmt::format(
                       "mask=\"{}\" is invalid, expected face numbers like \"1 | 3\" or a bit mask",
                       *mask));
        numbers.push_back(value);
        begin = end + 1;
    }
    // One number alone is a bit mask (rule S10).
    if (numbers.size() > 1) return numbers;
    for (int bit = 0; bit < 31; ++bit)
        if ((numbers[0] >> bit & 1) != 0) out.push_back(bit + 1);
    return out;
}

void ProgramRunner::draw_box(const Element& e)
{
    const Element& fill = read_.child(e, "boxfill");
    std::array<bool, 6> sides{};
    bool is_solid = false;
    for (const std::string& w :
         read_.words(e, fill.text, "boxfill",
                     {"solid", "all", "bottom", "top", "left", "right", "front", "back"}))
    {
        if (w == "solid") is_solid = true;
        if (w == "solid" || w == "all") sides = {true, true, true, true, true, true};
        if (w == "bottom") sides[BoxBottom] = true;
        if (w == "top") sides[BoxTop] = true;
        if (w == "left") sides[BoxLeft] = true;
        if (w == "right") sides[BoxRight] = true;
        if (w == "front") sides[BoxFront] = true;
        if (w == "back") sides[BoxBack] = true;
    }
    const Transform matrix = matrix_;
    matrix_ = {};
    const BoxRegion box = box_of(e);
    matrix_ = matrix;
    for (FigureOp& figure :
         make_box(box.corner0, box.corner1, sides, is_solid, layers_of(e), def_.grid.dp))
        add_figure(e, std::move(figure));
}

void ProgramRunner::draw_mesh_file(const Element& e)
{
    MeshFileOp op;
    op.file = read_.interpolated(e, read_.text(e, "file"));
    op.autofill = read_.flag_or(e, "autofill", false);
    op.advanced = read_.flag_or(e, "advanced", false);
    if (const std::string* fill = e.find_attribute("fppg:fill"))
    {
        if (*fill != "inside")
            read_.fail(e, fmt::format("fppg:fill=\"{}\" is invalid, expected inside", *fill));
        op.fill_inside = true;
    }
    if (e.find_child("clipdomain") != nullptr) read_.fail_unsupported(e, "<clipdomain>");
    Vec3 center;
    Vec3 scale{1, 1, 1};
    Vec3 angles;
    Vec3 move;
    if (const Element* c = e.find_child("drawcenter")) center = read_.vec3(*c);
    if (const Element* c = e.find_child("drawscale")) scale = read_.vec3(*c);
    if (const Element* c = e.find_child("drawrotate"))
        angles = {read_.number(*c, "angx"), read_.number(*c, "angy"), read_.number(*c, "angz")};
    if (const Element* c = e.find_child("drawmove")) move = read_.vec3(*c);
    if (op.advanced)
    {
        op.depth_min = 0;
        op.depth_max = 2 * def_.grid.dp;
        if (read_.flag_or(e, "reverse", false)) read_.fail_unsupported(e, "reverse=\"true\"");
        if (op.autofill) read_.fail_unsupported(e, "advanced with autofill");
        if (const Element* depth = e.find_child("depth"))
        {
            const auto low = read_.number_if(*depth, "depthmin");
            const auto high = read_.number_if(*depth, "depthmax");
            if (low) op.depth_min = *low;
            if (low && !high) op.depth_max = std::numeric_limits<double>::infinity();
            if (high) op.depth_max = *high;
        }
    }
    // Scale, then rotate right-handed about y, x, z in this order, about the centre; then move
    // (rule T5; the order was found with four random triples of angles: only this one puts all
    // corners right).
    Transform t = scaling(scale);
    for (const int axis : {1, 0, 2})
        if (angles[axis] != 0) t = rotation_about_axis(axis, radians(angles[axis])) * t;
    if (!(center == Vec3{})) t = around(center, t);
    op.transform = matrix_ * translation(move) * t;
    add(e, std::move(op));
}

bool ProgramRunner::run_draw(const Element& e)
{
    const std::string& name = e.name;
    constexpr std::size_t many = 100'000'000;
    if (name == "drawpoint")
        add(e, PointsOp{{matrix_(read_.vec3(e))}});
    else if (name == "drawpoints")
        add(e, PointsOp{transformed_points(e, 1, many)});
    else if (name == "setlinebegin")
        line_begin_ = matrix_(read_.vec3(e));
    else if (name == "drawlineto")
    {
        const Vec3 end = matrix_(read_.vec3(e));
        add(e, LinesOp{{{line_begin_, end}}});
        line_begin_ = end;
    }
    else if (name == "drawline" || name == "drawlines")
    {
        const std::vector<Vec3> points = transformed_points(e, 2, name == "drawline" ? 2 : many);
        LinesOp op;
        for (std::size_t i = 1; i < points.size(); ++i)
            op.segments.emplace_back(points[i - 1], points[i]);
        add(e, std::move(op));
    }
    else if (name == "drawtriangle" || name == "drawquadri")
    {
        const std::size_t n = name == "drawtriangle" ? 3 : 4;
        FigureOp op;
        op.vertices = transformed_points(e, n, n);
        op.faces.push_back(
            {n == 3 ? std::vector<std::uint32_t>{0, 1, 2} : std::vector<std::uint32_t>{0, 1, 2, 3},
             true,
             {},
             0,
             {}});
        add(e, std::move(op));
    }
    else if (name == "drawtrianglesstrip")
        add(e, make_strip(transformed_points(e, 3, many)));
    else if (name == "drawtrianglesfan")
        add(e, make_fan(transformed_points(e, 3, many)));
    else if (name == "drawpolygon")
        add(e, make_polygon(transformed_points(e, 3, many)));
    else if (name == "drawtriangles" || name == "drawfigure")
    {
        FigureOp op = figure_of(e);
        if (name == "drawfigure") op.solid = SolidKind::Faces;
        add_figure(e, std::move(op));
    }
    else if (name == "drawbox")
        draw_box(e);
    else if (name == "drawprism")
    {
        const std::vector<Vec3> points = transformed_points(e, 6, many);
        if (points.size() % 2 != 0)
            read_.fail(e,
                       fmt::format("has {} points, expected as many for the bottom as for the top",
                                   points.size()));
        FigureOp op = make_prism(points);
        hide_faces(op, mask_of(e));
        add(e, std::move(op));
    }
    else if (name == "drawpyramid")
    {
        FigureOp op = make_pyramid(transformed_points(e, 4, many));
        hide_faces(op, mask_of(e));
        add(e, std::move(op));
    }
    else if (name == "drawextrude")
    {
        if (e.find_child("layers") != nullptr) read_.fail_unsupported(e, "<layers>");
        add_figure(e, make_extrusion(read_.points(e), read_.child_vec3(e, "extrude"),
                                     read_.flag_or(e, "closed", false)));
    }
    else if (name == "drawsphere")
    {
        if (state_.mode == DrawMode::Wire) read_.fail_unsupported(e, "draw mode wire");
        add(e, SphereOp{transformed_points(e, 1, 1)[0], read_.number(e, "radius"), layers_of(e)});
    }
    else if (name == "drawcylinder")
    {
        if (state_.mode == DrawMode::Wire)
            read_.fail(
                e, "draw mode wire is not possible for a cylinder, expected face, solid or full");
        const std::vector<Vec3> points = transformed_points(e, 2, 2);
        CylinderOp op{
            points[0], points[1], read_.number(e, "radius"), {true, true, true}, layers_of(e)};
        for (const int face : mask_of(e))
            if (face >= 1 && face <= 3) op.is_visible[static_cast<std::size_t>(face - 1)] = false;
        add(e, std::move(op));
    }
    else if (name == "drawellipsoid")
    {
        const std::vector<Vec3> points = transformed_points(e, 2, 2);
        if (state_.mode != DrawMode::Wire) // draws nothing in wire mode
            add(e, EllipsoidOp{points[0], points[1], read_.number(e, "radius")});
    }
    else if (name == "drawfilestl")
        draw_mesh_file(e);
    else
        return false;
    return true;
}

FillFilter ProgramRunner::fill_filter(const Element& e, const std::string& words) const
{
    FillFilter filter;
    for (const std::string& w :
         read_.words(e, words, "modefill", {"void", "fluid", "bound", "border"}))
    {
        if (w == "void") filter.names[static_cast<std::size_t>(MkKind::Void)] = true;
        if (w == "bound") filter.names[static_cast<std::size_t>(MkKind::Bound)] = true;
        if (w == "fluid") filter.names[static_cast<std::size_t>(MkKind::Fluid)] = true;
        if (w == "border") filter.border = true;
    }
    filter.mkbound = absolute_mk(e, "mkbound", MkKind::Bound);
    filter.mkfluid = absolute_mk(e, "mkfluid", MkKind::Fluid);
    return filter;
}

std::optional<std::uint16_t> ProgramRunner::absolute_mk(const Element& e, const char* attribute,
                                                        MkKind kind) const
{
    if (e.find_attribute(attribute) == nullptr) return std::nullopt;
    const int first = kind == MkKind::Bound ? def_.mk_bound_first : def_.mk_fluid_first;
    return static_cast<std::uint16_t>(read_.integer(e, attribute, 0, 65000 - first, false) + first);
}

MkFilter ProgramRunner::near_filter(const Element& e, const char* type, const char* mk) const
{
    std::string word = read_.text(e, type);
    for (char& c : word) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    MkFilter filter;
    if (word == "void")
        filter.kind = MkKind::Void;
    else if (word == "bound")
        filter.kind = MkKind::Bound;
    else if (word == "fluid")
        filter.kind = MkKind::Fluid;
    else
        read_.fail(e, fmt::format("attribute {}=\"{}\" is invalid, expected void, fluid or bound",
                                  type, word));
    if (filter.kind != MkKind::Void) filter.mk = absolute_mk(e, mk, filter.kind);
    return filter;
}

bool ProgramRunner::run_fill_or_redraw(const Element& e)
{
    const std::string& name = e.name;
    if (name == "fillpoint" || name == "fillvoidpoint" || name == "fillbox" ||
        name == "fillfigure" || name == "fillprism")
    {
        FillOp op;
        op.seed = matrix_(read_.vec3(e));
        op.filter =
            fill_filter(e, name == "fillvoidpoint" ? "void" : read_.child(e, "modefill").text);
        if (name == "fillbox") op.region = box_of(e);
        if (name == "fillfigure")
        {
            FigureOp figure = figure_of(e);
            figure.solid = SolidKind::Faces;
            transform_figure(figure, matrix_);
            op.region = std::move(figure);
        }
        if (name == "fillprism") op.region = make_prism(transformed_points(e, 6, 100'000'000));
        add(e, std::move(op));
    }
    else if (name == "redraw" || name == "redrawbox")
    {
        RedrawOp op;
        if (const auto mk = absolute_mk(e, "mkfluid", MkKind::Fluid))
            op.filters.push_back({MkKind::Fluid, mk});
        if (const auto mk = absolute_mk(e, "mkbound", MkKind::Bound))
            op.filters.push_back({MkKind::Bound, mk});
        if (name == "redrawbox") op.region = box_of(e);
        add(e, std::move(op));
    }
    else if (name == "redrawnear" || name == "redrawnearbox")
    {
        RedrawNearOp op;
        op.target = near_filter(e, "targettp", "targetmk");
        op.border = near_filter(e, "bordertp", "bordermk");
        if (e.find_attribute("times") != nullptr)
            op.times = read_.integer(e, "times", 0, 1'000'000, true);
        if (const Element* filter = e.find_child("dirfilter"))
            for (const std::string& w :
                 read_.words(e, filter->text, "direction",
                             {"all", "top", "bottom", "right", "left", "back", "front"}))
            {
                constexpr std::array<std::string_view, 6> names{"top",  "bottom", "right",
                                                                "left", "back",   "front"};
                for (std::size_t d = 0; d < 6; ++d)
                    if (w == "all" || w == names[d]) op.directions[d] = true;
            }
        if (name == "redrawnearbox") op.region = box_of(e);
        add(e, op);
    }
    else
        return false;
    return true;
}

void ProgramRunner::shape_out(const Element& e)
{
    std::string format = read_.text_or(e, "format", "vtk");
    for (char& c : format) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    if (format != "vtk") read_.fail_unsupported(e, fmt::format("format=\"{}\"", format));
    if (e.find_attribute("savenormal") != nullptr) read_.fail_unsupported(e, "savenormal");
    ShapeOutOp op;
    op.file = read_.interpolated(e, read_.text(e, "file"));
    op.reset = read_.flag_or(e, "reset", true);
    op.actual = shape_forms_[0];
    op.snapped = shape_forms_[1];
    op.kinds = shape_kinds_;
    add(e, std::move(op));
}

} // namespace fppg
