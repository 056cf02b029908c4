#include "casedef/known_commands.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace fppg
{

namespace
{

constexpr auto commands = std::to_array<std::string_view>({"abort",
                                                           "cellsout",
                                                           "clipbox",
                                                           "clipdomain",
                                                           "clipplane",
                                                           "clipreset",
                                                           "debugout",
                                                           "delvar",
                                                           "dpctesload",
                                                           "dpctesreset",
                                                           "dpctessave",
                                                           "drawbathymetry",
                                                           "drawbeach",
                                                           "drawbox",
                                                           "drawcylinder",
                                                           "drawellipsoid",
                                                           "drawextrude",
                                                           "drawfigure",
                                                           "drawfilecsv",
                                                           "drawfileply",
                                                           "drawfilestl",
                                                           "drawfilevtk",
                                                           "drawfilevtm",
                                                           "drawline",
                                                           "drawlines",
                                                           "drawlineto",
                                                           "drawpoint",
                                                           "drawpoints",
                                                           "drawpolygon",
                                                           "drawprism",
                                                           "drawpyramid",
                                                           "drawquadri",
                                                           "drawsphere",
                                                           "drawtriangle",
                                                           "drawtriangles",
                                                           "drawtrianglesfan",
                                                           "drawtrianglesstrip",
                                                           "drawwave",
                                                           "exportvar",
                                                           "fillbox",
                                                           "fillfigure",
                                                           "fillpoint",
                                                           "fillprism",
                                                           "fillvoidpoint",
                                                           "matrixload",
                                                           "matrixreset",
                                                           "matrixsave",
                                                           "mkload",
                                                           "mksave",
                                                           "move",
                                                           "newvar",
                                                           "newvarcte",
                                                           "newvarstr",
                                                           "newvarstrcte",
                                                           "pointsmkout",
                                                           "printf",
                                                           "redraw",
                                                           "redrawbox",
                                                           "redrawnear",
                                                           "redrawnearbox",
                                                           "resetdraw",
                                                           "rotate",
                                                           "rotateadv",
                                                           "rotateline",
                                                           "runlist",
                                                           "scale",
                                                           "setactive",
                                                           "setboxlimitmode",
                                                           "setdpctes",
                                                           "setdrawmode",
                                                           "setfrdrawmode",
                                                           "setlinebegin",
                                                           "setmkbackbound",
                                                           "setmkbackclear",
                                                           "setmkbackfluid",
                                                           "setmkbackvoid",
                                                           "setmkbound",
                                                           "setmkfluid",
                                                           "setmknextauto",
                                                           "setmknextbound",
                                                           "setmknextfluid",
                                                           "setmkvoid",
                                                           "setnormalinvert",
                                                           "setpattern",
                                                           "setshapemode",
                                                           "setvar",
                                                           "setvarstr",
                                                           "shapeout",
                                                           "stateload",
                                                           "statesave",
                                                           "varsload",
                                                           "varssave"});

struct ChildrenOf
{
    std::string_view command;
    std::string_view children; ///< separated by blanks; with '+' those that may be repeated
};

/// Found by giving each command 17 other elements in GenCase v5.0 and some in v5.4, and each of its
/// own elements twice in 18 of them.
constexpr auto children = std::to_array<ChildrenOf>({
    {"cellsout", ""},
    {"clipbox", "angles boxfaces endpoint point size"},
    {"clipplane", "point point1 point2 point3 vector"},
    {"drawbeach", "point+"},
    {"drawbox", "boxfill endpoint layers point size"},
    {"drawcylinder", "layers point+"},
    {"drawellipsoid", "point+"},
    {"drawextrude", "extrude layers point+"},
    {"drawfigure", "points triangles"},
    {"drawfilecsv", "clipdomain drawcenter drawmove drawrotate drawscale"},
    {"drawfileply", "clipdomain depth drawcenter drawmove drawrotate drawscale layers"},
    {"drawfilestl", "clipdomain depth drawcenter drawmove drawrotate drawscale layers"},
    {"drawfilevtk", "clipdomain depth drawcenter drawmove drawrotate drawscale layers polyselec"},
    {"drawfilevtm",
     "clipdomain depth drawcenter drawmove drawrotate drawscale onlysurfaces+ polyselec"},
    {"drawline", "point+"},
    {"drawlines", "point+"},
    {"drawpoints", "point+"},
    {"drawpolygon", "point+"},
    {"drawprism", "point+"},
    {"drawpyramid", "point+"},
    {"drawquadri", "point+"},
    {"drawsphere", "layers point+"},
    {"drawtriangle", "point+"},
    {"drawtriangles", "points triangles"},
    {"drawtrianglesfan", "point+"},
    {"drawtrianglesstrip", "point+"},
    {"drawwave", "point size"},
    {"fillbox", "endpoint modefill point size"},
    {"fillfigure", "modefill points triangles"},
    {"fillpoint", "modefill"},
    {"fillprism", "modefill point+"},
    {"redraw", ""},
    {"redrawbox", "endpoint point size"},
    {"redrawnear", "dirfilter"},
    {"redrawnearbox", "dirfilter endpoint point size"},
    {"rotateadv", "center"},
    {"shapeout", ""},
});

} // namespace

bool is_known_command(std::string_view name)
{
    return std::binary_search(commands.begin(), commands.end(), name);
}

std::size_t allowed_children(std::string_view command, std::string_view child)
{
    const auto* own = std::lower_bound(children.begin(), children.end(), command,
                                       [](const ChildrenOf& c, std::string_view name)
                                       { return c.command < name; });
    if (own == children.end() || own->command != command) return SIZE_MAX;
    std::string_view rest = own->children;
    while (!rest.empty())
    {
        const std::size_t end = std::min(rest.find(' '), rest.size());
        const bool is_repeated = rest[end - 1] == '+';
        if (rest.substr(0, is_repeated ? end - 1 : end) == child) return is_repeated ? SIZE_MAX : 1;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return 0;
}

} // namespace fppg
