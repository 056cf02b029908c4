#include "casedef/known_commands.h"

#include <algorithm>
#include <array>

namespace fppg
{
namespace
{

constexpr auto built =
    std::to_array<std::string_view>({"abort",          "clipbox",          "clipdomain",
                                     "clipplane",      "clipreset",        "debugout",
                                     "delvar",         "dpctesload",       "dpctesreset",
                                     "dpctessave",     "drawbathymetry",   "drawbeach",
                                     "drawbox",        "drawcylinder",     "drawellipsoid",
                                     "drawextrude",    "drawfigure",       "drawfilecsv",
                                     "drawfileply",    "drawfilestl",      "drawfilevtk",
                                     "drawfilevtm",    "drawline",         "drawlines",
                                     "drawlineto",     "drawpoint",        "drawpoints",
                                     "drawpolygon",    "drawprism",        "drawpyramid",
                                     "drawquadri",     "drawsphere",       "drawtriangle",
                                     "drawtriangles",  "drawtrianglesfan", "drawtrianglesstrip",
                                     "drawwave",       "exportvar",        "fillbox",
                                     "fillfigure",     "fillpoint",        "fillprism",
                                     "fillvoidpoint",  "matrixload",       "matrixreset",
                                     "matrixsave",     "mkload",           "mksave",
                                     "move",           "newvar",           "newvarcte",
                                     "newvarstr",      "newvarstrcte",     "printf",
                                     "redraw",         "redrawbox",        "redrawnear",
                                     "redrawnearbox",  "resetdraw",        "rotate",
                                     "rotateadv",      "rotateline",       "runlist",
                                     "scale",          "setactive",        "setboxlimitmode",
                                     "setdpctes",      "setdrawmode",      "setfrdrawmode",
                                     "setlinebegin",   "setmkbackbound",   "setmkbackclear",
                                     "setmkbackfluid", "setmkbackvoid",    "setmkbound",
                                     "setmkfluid",     "setmknextauto",    "setmknextbound",
                                     "setmknextfluid", "setmkvoid",        "setnormalinvert",
                                     "setpattern",     "setshapemode",     "setvar",
                                     "setvarstr",      "shapeout",         "stateload",
                                     "statesave",      "varsload",         "varssave"});

constexpr auto planned = std::to_array<std::string_view>({"cellsout", "pointsmkout"});

} // namespace

CommandSupport command_support(std::string_view name)
{
    if (std::find(built.begin(), built.end(), name) != built.end()) return CommandSupport::Built;
    if (std::find(planned.begin(), planned.end(), name) != planned.end())
        return CommandSupport::Planned;
    return CommandSupport::Unknown;
}

} // namespace fppg
