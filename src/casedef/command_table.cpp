#include "casedef/command_table.h"

#include "core/text.h"
#include "meshes/mesh_formats.h"
#include "shapes/solid_shape.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace fppg
{
namespace commands
{

// state_commands.cpp
void clear_mk_back(Program& p, const Element& e);
void load_dp_ctes(Program& p, const Element& e);
void load_mk(Program& p, const Element& e);
void load_state(Program& p, const Element& e);
void reset_dp_ctes(Program& p, const Element& e);
void reset_draw(Program& p, const Element& e);
void save_dp_ctes(Program& p, const Element& e);
void save_mk(Program& p, const Element& e);
void save_state(Program& p, const Element& e);
void set_active(Program& p, const Element& e);
void set_box_limit_mode(Program& p, const Element& e);
void set_dp_ctes(Program& p, const Element& e);
void set_draw_mode(Program& p, const Element& e);
void set_fr_draw_mode(Program& p, const Element& e);
void set_mk_back_bound(Program& p, const Element& e);
void set_mk_back_fluid(Program& p, const Element& e);
void set_mk_back_void(Program& p, const Element& e);
void set_mk_bound(Program& p, const Element& e);
void set_mk_fluid(Program& p, const Element& e);
void set_mk_next_auto(Program& p, const Element& e);
void set_mk_next_bound(Program& p, const Element& e);
void set_mk_next_fluid(Program& p, const Element& e);
void set_mk_void(Program& p, const Element& e);
void set_normal_invert(Program& p, const Element& e);
void set_pattern(Program& p, const Element& e);
void set_shape_mode(Program& p, const Element& e);

// transform_commands.cpp
void load_matrix(Program& p, const Element& e);
void move(Program& p, const Element& e);
void reset_matrix(Program& p, const Element& e);
void rotate(Program& p, const Element& e);
void rotate_adv(Program& p, const Element& e);
void rotate_line(Program& p, const Element& e);
void save_matrix(Program& p, const Element& e);
void scale(Program& p, const Element& e);

// clip_commands.cpp
void clip_box(Program& p, const Element& e);
void clip_domain(Program& p, const Element& e);
void clip_plane(Program& p, const Element& e);
void reset_clips(Program& p, const Element& e);

// draw_commands.cpp
void draw_beach(Program& p, const Element& e);
void draw_box(Program& p, const Element& e);
void draw_extrude(Program& p, const Element& e);
void draw_figure(Program& p, const Element& e);
void draw_line(Program& p, const Element& e);
void draw_line_to(Program& p, const Element& e);
void draw_lines(Program& p, const Element& e);
void draw_point(Program& p, const Element& e);
void draw_points(Program& p, const Element& e);
void draw_polygon(Program& p, const Element& e);
void draw_prism(Program& p, const Element& e);
void draw_pyramid(Program& p, const Element& e);
void draw_quadri(Program& p, const Element& e);
void draw_triangle(Program& p, const Element& e);
void draw_triangles(Program& p, const Element& e);
void draw_triangles_fan(Program& p, const Element& e);
void draw_triangles_strip(Program& p, const Element& e);
void set_line_begin(Program& p, const Element& e);

// round_commands.cpp
void draw_cylinder(Program& p, const Element& e);
void draw_ellipsoid(Program& p, const Element& e);
void draw_read(Program& p, const Element& e, std::optional<Shape> (*read)(const DrawReader&));
void draw_sphere(Program& p, const Element& e);
void draw_wave(Program& p, const Element& e);

// mesh_commands.cpp
void draw_bathymetry(Program& p, const Element& e);
void draw_mesh_file(Program& p, const Element& e);

// fill_commands.cpp
void fill_box(Program& p, const Element& e);
void fill_figure(Program& p, const Element& e);
void fill_point(Program& p, const Element& e);
void fill_prism(Program& p, const Element& e);
void fill_void_point(Program& p, const Element& e);
void redraw(Program& p, const Element& e);
void redraw_box(Program& p, const Element& e);
void redraw_near(Program& p, const Element& e);
void redraw_near_box(Program& p, const Element& e);

// flow_commands.cpp
void abort_case(Program& p, const Element& e);
void pass_over(Program& p, const Element& e);
void print_text(Program& p, const Element& e);
void run_named_list(Program& p, const Element& e);
void run_variable_command(Program& p, const Element& e);

// output_commands.cpp
void cells_out(Program& p, const Element& e);
void points_mk_out(Program& p, const Element& e);
void shape_out(Program& p, const Element& e);

} // namespace commands

namespace
{

using namespace commands;

constexpr std::string_view any_child = "*";

/// A command whose shape reads it.
template <std::optional<Shape> (*Read)(const DrawReader&)>
void draw(Program& p, const Element& e)
{
    draw_read(p, e, Read);
}

/// All commands by name. Which elements they may have was found by giving each command 17 other
/// elements in GenCase v5.0 and some in v5.4, and each of its own elements twice in 18 of them.
constexpr auto table = std::to_array<CommandRow>({
    {"abort", any_child, abort_case},
    {"cellsout", "", cells_out},
    {"clipbox", "angles boxfaces endpoint point size", clip_box},
    {"clipdomain", any_child, clip_domain},
    {"clipplane", "point point1 point2 point3 vector", clip_plane},
    {"clipreset", any_child, reset_clips},
    {"debugout", any_child, pass_over},
    {"delvar", any_child, run_variable_command},
    {"dpctesload", any_child, load_dp_ctes},
    {"dpctesreset", any_child, reset_dp_ctes},
    {"dpctessave", any_child, save_dp_ctes},
    {"drawbathymetry", any_child, draw_bathymetry},
    {"drawbeach", "point+", draw_beach},
    {"drawbox", "boxfill endpoint layers point size", draw_box},
    {"drawcylinder", "layers point+", draw_cylinder},
    {"drawellipsoid", "point+", draw_ellipsoid},
    {"drawextrude", "extrude layers point+", draw_extrude},
    {"drawfigure", "points triangles", draw_figure},
    {"drawfile", "clipdomain depth drawcenter drawmove drawrotate drawscale layers", draw_mesh_file,
     true},
    {"drawfilecsv", "clipdomain drawcenter drawmove drawrotate drawscale", draw_mesh_file},
    {"drawfilevtk", "clipdomain depth drawcenter drawmove drawrotate drawscale layers polyselec",
     draw_mesh_file},
    {"drawfilevtm",
     "clipdomain depth drawcenter drawmove drawrotate drawscale onlysurfaces+ polyselec",
     draw_mesh_file},
    {"drawline", "point+", draw_line},
    {"drawlines", "point+", draw_lines},
    {"drawlineto", any_child, draw_line_to},
    {"drawpoint", any_child, draw_point},
    {"drawpoints", "point+", draw_points},
    {"drawpolygon", "point+", draw_polygon},
    {"drawprism", "point+", draw_prism},
    {"drawpyramid", "point+", draw_pyramid},
    {"drawquadri", "point+", draw_quadri},
    {"drawsphere", "layers point+", draw_sphere},
    {"drawtorus", "point+ vector", draw<read_torus>, true},
    {"drawtriangle", "point+", draw_triangle},
    {"drawtriangles", "points triangles", draw_triangles},
    {"drawtrianglesfan", "point+", draw_triangles_fan},
    {"drawtrianglesstrip", "point+", draw_triangles_strip},
    {"drawwave", "point size", draw_wave},
    {"exportvar", any_child, run_variable_command},
    {"fillbox", "endpoint modefill point size", fill_box},
    {"fillfigure", "modefill points triangles", fill_figure},
    {"fillpoint", "modefill", fill_point},
    {"fillprism", "modefill point+", fill_prism},
    {"fillvoidpoint", any_child, fill_void_point},
    {"matrixload", any_child, load_matrix},
    {"matrixreset", any_child, reset_matrix},
    {"matrixsave", any_child, save_matrix},
    {"mkload", any_child, load_mk},
    {"mksave", any_child, save_mk},
    {"move", any_child, move},
    {"newvar", any_child, run_variable_command},
    {"newvarcte", any_child, run_variable_command},
    {"newvarstr", any_child, run_variable_command},
    {"newvarstrcte", any_child, run_variable_command},
    {"pointsmkout", any_child, points_mk_out},
    {"printf", any_child, print_text},
    {"redraw", "", redraw},
    {"redrawbox", "endpoint point size", redraw_box},
    {"redrawnear", "dirfilter", redraw_near},
    {"redrawnearbox", "dirfilter endpoint point size", redraw_near_box},
    {"resetdraw", any_child, reset_draw},
    {"rotate", any_child, rotate},
    {"rotateadv", "center", rotate_adv},
    {"rotateline", any_child, rotate_line},
    {"runlist", any_child, run_named_list},
    {"scale", any_child, scale},
    {"setactive", any_child, set_active},
    {"setboxlimitmode", any_child, set_box_limit_mode},
    {"setdpctes", any_child, set_dp_ctes},
    {"setdrawmode", any_child, set_draw_mode},
    {"setfrdrawmode", any_child, set_fr_draw_mode},
    {"setlinebegin", any_child, set_line_begin},
    {"setmkbackbound", any_child, set_mk_back_bound},
    {"setmkbackclear", any_child, clear_mk_back},
    {"setmkbackfluid", any_child, set_mk_back_fluid},
    {"setmkbackvoid", any_child, set_mk_back_void},
    {"setmkbound", any_child, set_mk_bound},
    {"setmkfluid", any_child, set_mk_fluid},
    {"setmknextauto", any_child, set_mk_next_auto},
    {"setmknextbound", any_child, set_mk_next_bound},
    {"setmknextfluid", any_child, set_mk_next_fluid},
    {"setmkvoid", any_child, set_mk_void},
    {"setnormalinvert", any_child, set_normal_invert},
    {"setpattern", any_child, set_pattern},
    {"setshapemode", any_child, set_shape_mode},
    {"setvar", any_child, run_variable_command},
    {"setvarstr", any_child, run_variable_command},
    {"shapeout", "", shape_out},
    {"stateload", any_child, load_state},
    {"statesave", any_child, save_state},
    {"varsload", any_child, run_variable_command},
    {"varssave", any_child, run_variable_command},
});

/// Of mesh formats that have no row of their own, GenCase's and fppg's.
constexpr CommandRow mesh_file{
    "drawfile", "clipdomain depth drawcenter drawmove drawrotate drawscale layers", draw_mesh_file};
constexpr CommandRow own_mesh_file{mesh_file.name, mesh_file.children, mesh_file.run, true};

} // namespace

const CommandRow* find_command(std::string_view name)
{
    const auto* row = std::lower_bound(table.begin(), table.end(), name,
                                       [](const CommandRow& r, std::string_view wanted)
                                       { return r.name < wanted; });
    if (row != table.end() && row->name == name) return &*row;
    if (!name.starts_with(mesh_file.name)) return nullptr;
    const auto format = mesh_format_named(name.substr(mesh_file.name.size()));
    if (!format) return nullptr;
    return is_own_format(*format) ? &own_mesh_file : &mesh_file;
}

std::vector<std::string_view> command_names()
{
    std::vector<std::string_view> names{"drawfilestl", "drawfileply", "drawfileobj", "drawfileoff",
                                        "drawfilestep"};
    for (const CommandRow& row : table) names.push_back(row.name);
    return names;
}

std::size_t allowed_children(const CommandRow& row, std::string_view child)
{
    if (row.children == any_child) return SIZE_MAX;
    for (std::string_view name : split(row.children, ' '))
    {
        const bool is_repeated = name.ends_with('+');
        if (is_repeated) name.remove_suffix(1);
        if (name == child) return is_repeated ? SIZE_MAX : 1;
    }
    return 0;
}

} // namespace fppg
