// Commands that change the state: mk, modes, constants, transforms, clips.
#include "fppg/error.h"

#include "casedef/program.h"
#include "casedef/transforms.h"
#include "shapes/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

/// Only the turning part of the matrix meets the normal, as in GenCase v5.0 (8164 of 8168 nodes on
/// 200 moved, scaled and turned planes).
ClipPlane placed(const ClipPlane& plane, const Transform& matrix)
{
    const Vec3& n = plane.normal;
    return {matrix(plane.point),
            {dot(matrix.linear[0], n), dot(matrix.linear[1], n), dot(matrix.linear[2], n)}};
}

} // namespace

MkValue ProgramRunner::mk_value(const Element& e, MkKind kind, int mk_type) const
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
    return value;
}

void ProgramRunner::set_mk(const Element& e, MkKind kind, int mk_type)
{
    state_.mk = mk_value(e, kind, mk_type);
    shared_state_.reset();
    const int count = kind == MkKind::Bound ? def_.mkbound_count : def_.mkfluid_count;
    if (kind == MkKind::Void || mk_type < count % 256 || count < 256 || is_large_mk_known_) return;
    is_large_mk_known_ = true;
    def_.warnings.push_back(
        fmt::format("{}:{}: <{}>: GenCase v5.4 refuses mk {}, as its mks have 8 bits and {}={} "
                    "leaves {} of them there; the solver takes mks up to 2047",
                    def_.file, e.line, e.name, mk_type,
                    kind == MkKind::Bound ? "boundcount" : "fluidcount", count, count % 256));
}

bool ProgramRunner::run_state_command(const Element& e)
{
    const std::string& name = e.name;
    const auto next_mk = [&](MkKind kind)
    {
        const int step = read_.plain_flag_or(e, "next", true) ? 1 : -1;
        const int next = state_.mk.kind == kind ? state_.mk.mk_type + step : 0;
        if (next < 0)
            read_.fail(e,
                       "there is no mk below 0, expected next=\"true\" or a higher mk before it");
        set_mk(e, kind, next);
    };
    const auto pop = [](auto& stack, auto& target)
    {
        if (stack.empty()) return;
        target = stack.back();
        stack.pop_back();
    };
    const auto pop_mk = [&]
    {
        std::tuple all{state_.mk, state_.mk_back, state_.pattern};
        pop(saved_mks_, all);
        std::tie(state_.mk, state_.mk_back, state_.pattern) = std::move(all);
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
        read_.text(e, "auto");
        state_.mk_next_auto = read_.plain_flag_or(e, "auto", false);
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
        state_.off_lattice = flag_of(e, "auto");
    else if (name == "setnormalinvert")
    {
        read_.text(e, "invert");
        state_.normal_invert = read_.plain_flag_or(e, "invert", false);
    }
    else if (name == "setactive")
    {
        for (const Element::Attribute& a : e.attributes)
            if (a.name != "drawpoints" && a.name != "drawshapes" && a.name != "vtkout" &&
                a.name != "if" && !a.name.starts_with('_') && !a.name.starts_with("fppg:"))
                read_.fail(e, fmt::format("attribute '{}' is not known, expected drawpoints or "
                                          "drawshapes",
                                          a.name));
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
        saved_mks_.emplace_back(state_.mk, state_.mk_back, state_.pattern);
    else if (name == "mkload")
        pop_mk();
    else if (name == "setmkbackvoid")
        state_.mk_back = MkValue{};
    else if (name == "setmkbackfluid" || name == "setmkbackbound")
        state_.mk_back = mk_value(e, name == "setmkbackfluid" ? MkKind::Fluid : MkKind::Bound,
                                  read_.integer(e, "mk", 0, 65000, false));
    else if (name == "setmkbackclear")
        state_.mk_back.reset();
    else if (name == "setpattern")
    {
        const auto found = patterns_.find(small_letters(read_.text(e, "name")));
        if (found == patterns_.end())
            read_.fail(e, fmt::format("there is no pattern named '{}' in <patterns>",
                                      read_.text(e, "name")));
        state_.pattern = found->second;
    }
    else if (name == "statesave")
    {
        saved_states_.push_back(state_);
        saved_matrices_.push_back(matrix_);
        saved_mks_.emplace_back(state_.mk, state_.mk_back, state_.pattern);
        saved_constants_.push_back(state_.constants);
    }
    else if (name == "stateload")
    {
        DrawState loaded = state_;
        pop(saved_states_, loaded);
        loaded.clips = std::move(state_.clips);
        loaded.mk = state_.mk;
        loaded.mk_back = state_.mk_back;
        loaded.pattern = state_.pattern;
        loaded.constants = state_.constants;
        state_ = std::move(loaded);
        pop_mk();
        pop(saved_constants_, state_.constants);
        pop(saved_matrices_, matrix_);
        place_clips();
    }
    else if (name == "resetdraw")
    {
        add(e, ResetOp{});
        pictures_forgotten_ = def_.box_pictures.size();
        line_begin_ = def_.case_pos_min;
        auto pattern = std::move(state_.pattern);
        state_ = {};
        state_.pattern = std::move(pattern);
        matrix_ = {};
        defined_clips_.clear();
        clip_matrix_ = {};
        saved_states_.clear();
        saved_matrices_.clear();
        saved_mks_.clear();
        saved_constants_.clear();
    }
    else if (name == "setshapemode")
    {
        const unsigned bits = read_.word_bits(e, e.text, "shape mode",
                                              {{"null", 0},
                                               {"actual", 1},
                                               {"real", 1}, // its name in GenCase v4.0 and v5.0
                                               {"dp", 2},
                                               {"all", 4 | 8 | 16},
                                               {"void", 4},
                                               {"bound", 8},
                                               {"fluid", 16}});
        state_.shape_mode = {
            (bits & 1) != 0, (bits & 2) != 0, {(bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0}};
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
    {
        saved_matrices_.push_back(matrix_);
        return true;
    }
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
        const std::string axes = read_.text(e, "axes");
        const auto is_axis = [](char c) { return c >= 'X' && c <= 'Z'; };
        if (axes.size() != 3 || !std::all_of(axes.begin(), axes.end(), is_axis))
            read_.fail(e, fmt::format("axes \"{}\" is invalid, expected three of X, Y, Z", axes));
        std::array<Transform, 3> turns;
        const std::array<const char*, 3> names{"ang1", "ang2", "ang3"};
        for (std::size_t i = 0; i < 3; ++i)
            turns[i] = rotation_about_axis(axes[i] - 'X', radians(read_.number(e, names[i])));
        const Transform t = flag_of(e, "intrinsic") ? turns[0] * turns[1] * turns[2]
                                                    : turns[2] * turns[1] * turns[0];
        const Element* center = e.find_child("center");
        matrix_ = matrix_ * (center != nullptr ? around(read_.vec3(*center), t) : t);
    }
    else
        return false;
    place_clips();
    return true;
}

void ProgramRunner::add_clip(const ClipPlane& plane)
{
    defined_clips_.push_back({plane.point, plane.normal / norm(plane.normal)});
    state_.clips.push_back(placed(defined_clips_.back(), clip_matrix_));
}

void ProgramRunner::place_clips()
{
    if (defined_clips_.empty()) return;
    clip_matrix_ = matrix_;
    put_clips(matrix_);
}

void ProgramRunner::put_clips(const Transform& matrix)
{
    for (std::size_t i = 0; i < defined_clips_.size(); ++i)
        state_.clips[i] = placed(defined_clips_[i], matrix);
    shared_state_.reset();
}

/// The angles of a clipbox turn it about its lowest corner, about y, x and z in this order,
/// right-handed (found by experiment with GenCase v5.4.354: of the orders, signs and centres tried
/// only this one fits). clipdomain clips at <pointmin> and <pointmax>, farther out by resize; a
/// resize below 0 counts as 0 (a ball on the border of the domain, resize 0, 0.1, -0.1, -0.3). Its
/// lower planes go through the lowest corner, the upper ones through that corner moved along their
/// axis, which matters where a matrix shears (planes fitted to a shapeout).
bool ProgramRunner::run_clip(const Element& e)
{
    const std::string& name = e.name;
    if (name == "clipreset")
    {
        state_.clips.clear();
        defined_clips_.clear();
        clip_matrix_ = {};
    }
    else if (name == "clipdomain")
    {
        const double resize = std::max(0.0, read_.number_or(e, "resize", 0));
        const Vec3 low = def_.case_pos_min - Vec3{resize, resize, resize};
        for (int axis = 0; axis < 3; ++axis)
        {
            Vec3 high = low;
            high[axis] = def_.case_pos_max[axis] + resize;
            Vec3 upwards;
            upwards[axis] = 1;
            add_clip({low, upwards * -1.0});
            add_clip({high, upwards});
        }
    }
    else if (name == "clipplane")
    {
        ClipPlane plane;
        if (e.find_child("point1") != nullptr)
        {
            plane.point = read_.child_vec3(e, "point1");
            plane.normal = cross(read_.child_vec3(e, "point2") - plane.point,
                                 read_.child_vec3(e, "point3") - plane.point);
        }
        else
            plane = {read_.child_vec3(e, "point"), read_.child_vec3(e, "vector")};
        if (norm(plane.normal) == 0)
            read_.fail(e, "the plane has no direction, expected a vector that is not zero");
        add_clip(plane);
    }
    else if (name == "clipbox")
    {
        std::array<bool, 6> faces{true, true, true, true, true, true};
        if (const Element* which = e.find_child("boxfaces")) faces = box_sides(e, *which).sides;
        const BoxRegion box = box_of(e);
        Vec3 low;
        Vec3 high;
        for (int axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(box.corner0[axis], box.corner1[axis]);
            high[axis] = std::max(box.corner0[axis], box.corner1[axis]);
        }
        Transform turned;
        if (const Element* c = e.find_child("angles"))
        {
            Transform rotation;
            const Vec3 angles = read_.vec3(*c);
            for (const int axis : {2, 0, 1})
                rotation = rotation * rotation_about_axis(axis, radians(angles[axis]));
            turned = around(low, rotation);
        }
        const bool is_turned = !turned.is_identity();
        const auto side = [&](BoxSide which, const Vec3& at, const Vec3& outward)
        {
            if (!faces[which]) return;
            ClipPlane plane{at, outward};
            if (is_turned) plane = placed(plane, turned);
            add_clip(plane);
        };
        side(BoxBottom, low, {0, 0, -1});
        side(BoxTop, is_turned ? high : Vec3{low.x, low.y, high.z}, {0, 0, 1});
        side(BoxLeft, low, {-1, 0, 0});
        side(BoxRight, is_turned ? high : Vec3{high.x, low.y, low.z}, {1, 0, 0});
        side(BoxFront, low, {0, -1, 0});
        side(BoxBack, is_turned ? high : Vec3{high.x, high.y, low.z}, {0, 1, 0});
    }
    else
        return false;
    shared_state_.reset();
    return true;
}

} // namespace fppg
