#include "casedef/known_commands.h"

#include <algorithm>
#include <array>

namespace fppg
{
namespace
{

constexpr auto built = std::to_array<std::string_view>(
    {"abort",           "cellsout",      "clipbox",        "clipplane",        "clipreset",
     "debugout",        "delvar",        "dpctesload",     "dpctesreset",      "dpctessave",
     "drawbathymetry",  "drawbox",       "drawcylinder",   "drawellipsoid",    "drawextrude",
     "drawfigure",      "drawfilecsv",   "drawfileply",    "drawfilestl",      "drawfilevtk",
     "drawfilevtm",     "drawline",      "drawlines",      "drawlineto",       "drawpoint",
     "drawpoints",      "drawpolygon",   "drawprism",      "drawpyramid",      "drawquadri",
     "drawsphere",      "drawtriangle",  "drawtriangles",  "drawtrianglesfan", "drawtrianglesstrip",
     "exportvar",       "fillbox",       "fillfigure",     "fillpoint",        "fillprism",
     "fillvoidpoint",   "matrixload",    "matrixreset",    "matrixsave",       "mkload",
     "mksave",          "move",          "newvar",         "newvarcte",        "newvarstr",
     "newvarstrcte",    "pointsmkout",   "printf",         "redraw",           "redrawbox",
     "redrawnear",      "redrawnearbox", "resetdraw",      "rotate",           "rotateadv",
     "rotateline",      "runlist",       "scale",          "setactive",        "setboxlimitmode",
     "setdpctes",       "setdrawmode",   "setfrdrawmode",  "setlinebegin",     "setmkbound",
     "setmkfluid",      "setmknextauto", "setmknextbound", "setmknextfluid",   "setmkvoid",
     "setnormalinvert", "setshapemode",  "setvar",         "setvarstr",        "shapeout",
     "stateload",       "statesave",     "varsload",       "varssave"});

constexpr auto planned = std::to_array<std::string_view>(
    {"clipdomain", "drawbeach", "drawwave", "setmkbackbound", "setmkbackclear", "setmkbackfluid",
     "setmkbackvoid", "setpattern"});

} // namespace

CommandSupport command_support(std::string_view name)
{
    if (std::find(built.begin(), built.end(), name) != built.end()) return CommandSupport::Built;
    if (std::find(planned.begin(), planned.end(), name) != planned.end())
        return CommandSupport::Planned;
    return CommandSupport::Unknown;
}

} // namespace fppg
