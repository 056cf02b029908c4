#include "casedef/known_names.h"

#include "core/nearest_word.h"
#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace fppg
{
namespace
{

/// The names that may stand in some elements, all separated by blanks. An element is "name", or
/// "parent/name" where the same name has other attributes elsewhere; "*": it may have any.
struct NameRow
{
    std::string_view names;
    std::string_view elements;
};

/// Attributes of all elements of xml-templates/fppg.xsd. tests/templates/check_known_names.py
/// writes this table, and holds it against the schema.
constexpr auto attribute_table = std::to_array<NameRow>({
    // clang-format off
    {"",
"boxfaces boxfill casedef/floatings casedef/motion clipbox clipplane clipreset "
"commands constantsdef debugout dirfilter dpctesload dpctesreset dpctessave "
"drawbathymetry drawbox drawfigure drawfigure/points drawline drawlines drawpoints "
"drawpolygon drawquadri drawtriangle drawtriangles drawtriangles/points "
"drawtrianglesfan drawtrianglesstrip execution expands fillfigure/points fppg "
"geometry inertiafull initdomain initials links mainlist matrixload matrixreset "
"matrixsave mkload mksave modefill obj onlypos parameters "
"parameters/simulationdomain patterns polyselec predefinition properties resetdraw "
"selection setmkbackclear setmkbackvoid setmkvoid setshapemode stateload statesave "
"transform triangles varsload varssave"},
    {"*",
"constants execution/motion extra newvar newvarcte newvarstr newvarstrcte "
"particles setvar setvarstr special uservars vtkout"},
    {"* name",
"property"},
    {"across boundary clearance density featureangle layers mkbound place plates side "
"volume",
"bodyfitted"},
    {"active",
"bufferbox norgeometry normals vres"},
    {"active angle anglesunits mkbound mkfluid",
"rotateaxis"},
    {"active balance mass mkfluid packing width",
"fluidband"},
    {"active band h iterations snapshots tolerance",
"relax"},
    {"active depth hmaxwave mkfluid negative x0",
"velwave"},
    {"active dpx dpxyz dpy dpz mkfluid randomseed",
"moverandom"},
    {"active key value",
"parameter"},
    {"active mkbound",
"norcylinder norparts norplane norset norsphere"},
    {"active mkbound mkfluid x y z",
"initials/move"},
    {"active mkfluid",
"densitydepth densitygradient densitymesh velmesh"},
    {"active mkfluid rhop",
"densityuniform"},
    {"active mkfluid x y z",
"initials/velocity"},
    {"advanced autofill file reverse",
"drawfile drawfileobj drawfileoff drawfileply drawfilestep drawfilestl drawfilevtk "
"drawfilevtm"},
    {"ang",
"mvcir/vel mvcirace/ace mvcirace/velini mvrot/vel mvrotace/ace mvrotace/velini "
"rotateline"},
    {"ang x y z",
"list/rotate mainlist/rotate"},
    {"ang1 ang2 ang3 axes intrinsic",
"rotateadv"},
    {"anglesunits angx angy angz",
"transform/rotate"},
    {"anglesunits duration id next",
"mvcir mvcirace mvcirsinu mvpathfile mvrectsinu mvrot mvrotace mvrotadvfile "
"mvrotfile mvrotsinu"},
    {"angx angy angz",
"drawrotate"},
    {"angx angy angz x y z",
"zpoints/rotate"},
    {"app date",
"case"},
    {"auto",
"setfrdrawmode setmknextauto"},
    {"auto value",
"constantsdef/b h hswl massbound massfluid speedsound speedsystem"},
    {"auto x y z",
"norplane/point"},
    {"bordermk bordertp targetmk targettp times",
"redrawnear redrawnearbox"},
    {"bound fluid",
"lattice"},
    {"boundcount fluidcount",
"mkconfig"},
    {"closed",
"drawextrude"},
    {"ctecylindercover ctecylindernumsides ctecylindertube cteellipsoid cteline "
"cterevolutionnumsides ctesphere ctespherenumsides ctetrianglelimits "
"ctetriangleweight",
"setdpctes"},
    {"depth hmaxwave x0 z0",
"drawwave"},
    {"depthmax depthmin",
"depth"},
    {"dp",
"definition"},
    {"dp file",
"grid"},
    {"draw mkbound name op",
"fppg/boolean"},
    {"drawpoints drawshapes vtkout",
"setactive"},
    {"duration id next",
"mvfile mvpredef mvrect mvrectace mvrectfile wait"},
    {"exact mkbound",
"fppg/floatings"},
    {"fieldang1 fieldang2 fieldang3 fields fieldtime fieldx fieldy fieldz name",
"mvpathfile/file"},
    {"fieldang1 fieldang2 fieldang3 fields fieldtime name",
"mvrotadvfile/file"},
    {"fields fieldtime fieldx fieldy fieldz name",
"mvfile/file mvpredef/file mvrectfile/file"},
    {"file",
"angularforce angularvel geometryfile linearforce linearvel pointsmkout zpoints"},
    {"file format reset savenormal",
"shapeout"},
    {"file initialtime magnitude reverse setx sety setz",
"velmesh/meshdata"},
    {"file initialtime setx sety setz",
"densitymesh/meshdata"},
    {"file mkbound mkfluid",
"cellsout"},
    {"file mkbound mkfluid move rotate scale",
"fppg/points"},
    {"file mode",
"drawfilecsv"},
    {"file path",
"propertyfile"},
    {"finish mov start",
"begin"},
    {"flatwidth rampwidth",
"periodicx periodicy"},
    {"gapclose level litres mkfluid percent seed up",
"fill"},
    {"hydrostatic",
"offlattice"},
    {"id",
"mvnull"},
    {"index mkbound mkfluid name",
"onlysurfaces"},
    {"invert",
"setnormalinvert"},
    {"mask",
"drawbeach drawprism drawpyramid"},
    {"mask radius",
"drawcylinder"},
    {"mk",
"setmkbackbound setmkbackfluid setmkbound setmkfluid"},
    {"mk orient",
"mkorientbound mkorientfluid"},
    {"mkbound",
"tracking"},
    {"mkbound mkfluid",
"redraw redrawbox"},
    {"mkbound mkfluid property",
"link"},
    {"mkbound mkfluid ref sheet",
"part"},
    {"mkbound mkfluid x y z",
"fillbox fillfigure fillpoint fillprism"},
    {"mkbound property relativeweight rhopbody",
"floating"},
    {"mode",
"setboxlimitmode setdrawmode"},
    {"name",
"mvrotfile/file setpattern"},
    {"name pattern",
"pattern"},
    {"name printcall",
"list"},
    {"name times",
"runlist"},
    {"next",
"setmknextbound setmknextfluid"},
    {"op",
"boolean/boolean"},
    {"radius",
"drawellipsoid drawsphere"},
    {"radius tube",
"drawtorus"},
    {"ref",
"objreal"},
    {"requiredversion",
"casedef"},
    {"resize",
"clipdomain"},
    {"rhop x y z",
"pos1 pos2"},
    {"size size2 z z2",
"xmax xmin ymax ymin"},
    {"text",
"abort printf"},
    {"time x y z",
"angularvel/vel force linearvel/vel"},
    {"useparent",
"bufferbox/simulationdomain vres/simulationdomain"},
    {"v",
"buffsizeh clear dpratio inside limit1 limit2 maxdisth mvcirsinu/ampl "
"mvcirsinu/freq mvcirsinu/phase mvrotsinu/ampl mvrotsinu/freq mvrotsinu/phase "
"norgeometry/distanceh norgeometry/maxsizeh norgeometry/svshapes overlappingh "
"radius velocity/velocity"},
    {"v v2 v3 z z2 z3",
"velocity3"},
    {"v v2 z z2",
"velocity2"},
    {"v11 v12 v13 v21 v22 v23 v31 v32 v33",
"values"},
    {"value",
"axes cflnumber coefficient coefh coefsound computenormals densitydepth/b dg_svopenshapes "
"dg_svpartsnormal eps ftsupport gamma hdp intrinsic massbody masspart movecenter "
"normals/distanceh normals/maxsizeh normals/svshapes rhop0 rhopgradient savegrid savepoints "
"svnormaldata svnormals"},
    {"vars",
"delvar exportvar"},
    {"vdp",
"layers limitdist"},
    {"x y",
"initdomain/point initdomain/size selection/point selection/size"},
    {"x y z",
"angles angularvelini axisp1 axisp2 border bufferbox/point bufferbox/size center "
"center1 center2 clipbox/point clipbox/size clipplane/point direction "
"drawbeach/point drawbox/point drawbox/size drawcenter drawcylinder/point "
"drawellipsoid/point drawextrude/point drawline/point drawlines/point drawlineto "
"drawmove drawpoint drawpoints/point drawpolygon/point drawprism/point "
"drawpyramid/point drawquadri/point drawscale drawsphere/point drawtorus/point "
"drawtriangle/point drawtrianglesfan/point drawtrianglesstrip/point drawwave/point "
"drawwave/size endpoint extrude fillbox/point fillbox/size fillprism/point "
"fillvoidpoint finalmove gap gravity inertia linearvelini list/move mainlist/move "
"mvrect/vel mvrectace/ace mvrectace/velini mvrectsinu/ampl mvrectsinu/freq "
"mvrectsinu/phase normal pattern/size point1 point2 point3 pointmax pointmin "
"pointref points/point posmax posmin posswl redrawbox/point redrawbox/size "
"redrawnearbox/point redrawnearbox/size ref rotateline/point rotationDOF scale "
"seed setlinebegin transform/move translationDOF triangle up vector zpoints/move"},
    // clang-format on
});

/// What stands in the sections that every case has. GenCase v5.4.354 passes over all else there.
constexpr auto sections = std::to_array<NameRow>({
    {"constantsdef floatings fppg geometry initials mkconfig motion normals patterns properties "
     "vres",
     "casedef"},
    {"b cflnumber coefficient coefh coefsound eps gamma gravity h hdp hswl lattice massbound "
     "massfluid rhop0 rhopgradient speedsound speedsystem",
     "constantsdef"},
    {"commands definition predefinition", "geometry"},
    {"pointmax pointmin pointref", "definition"},
    {"constants motion parameters particles special uservars vtkout", "execution"},
    {"casedef execution", "case"},
});

using Names = std::vector<std::string_view>;

/// The names that stand in an element, "name" or "parent/name"; null: there is none of them.
const std::string_view* find_names(std::string_view element)
{
    using Entry = std::pair<std::string_view, const NameRow*>;
    static const std::vector<Entry> all = []
    {
        std::vector<Entry> out;
        for (const NameRow& row : attribute_table)
            for (const std::string_view name : split(row.elements, ' '))
                out.emplace_back(name, &row);
        std::sort(out.begin(), out.end());
        return out;
    }();
    const auto found =
        std::lower_bound(all.begin(), all.end(), element,
                         [](const Entry& e, std::string_view wanted) { return e.first < wanted; });
    return found == all.end() || found->first != element ? nullptr : &found->second->names;
}

/// Null: the element is not known, so that it is for others to judge.
const std::string_view* names_of(const std::string& parent, const std::string& name)
{
    const std::string_view* there = find_names(parent + '/' + name);
    return there != nullptr ? there : find_names(name);
}

/// DesignSPHysics and examples of DualSPHysics name draws by objname, and mks by name.
bool is_remark(const std::string& element, std::string_view attribute)
{
    return attribute == "comment" || attribute == "cmt" || attribute == "if" ||
           attribute == "objname" || (attribute == "name" && element.starts_with("setmk")) ||
           attribute.starts_with('_') || attribute.ends_with("_comment") ||
           attribute.starts_with("xmlns") ||
           (attribute.find(':') != std::string_view::npos && !attribute.starts_with("fppg:"));
}

/// Whether a word is one of a list separated by blanks.
bool is_listed(std::string_view list, std::string_view word)
{
    for (std::size_t at = list.find(word); at != std::string_view::npos;
         at = list.find(word, at + 1))
    {
        const std::size_t end = at + word.size();
        if ((at == 0 || list[at - 1] == ' ') && (end == list.size() || list[end] == ' '))
            return true;
    }
    return false;
}

void look_at_attributes(const Element& e, std::string_view names, const std::string& file,
                        std::vector<std::string>& out)
{
    const bool is_draw = e.name.starts_with("draw");
    const bool is_file = e.name.starts_with("drawfile");
    const bool may_be_step = e.name == "drawfile" || e.name == "drawfilestep";
    for (const Element::Attribute& a : e.attributes)
    {
        if (is_listed(names, a.name) || is_remark(e.name, a.name) ||
            (is_draw && a.name == "fppg:name") || (is_file && a.name == "fppg:fill") ||
            (may_be_step && a.name == "fppg:part"))
            continue;
        Names known = names.empty() ? Names{} : split(names, ' ');
        if (is_draw) known.push_back("fppg:name");
        if (is_file) known.push_back("fppg:fill");
        if (may_be_step) known.push_back("fppg:part");
        out.push_back(fmt::format(
            "{}:{}: <{}>: attribute {}=\"{}\" is not known and has no effect{}, expected {}", file,
            e.line, e.name, a.name, a.value, did_you_mean(a.name, known),
            known.empty() ? std::string("none") : fmt::format("{}", fmt::join(known, ", "))));
    }
}

void look_at_section(const Element& e, const std::string& file, std::vector<std::string>& out)
{
    const auto* section = std::find_if(sections.begin(), sections.end(),
                                       [&](const NameRow& row) { return row.elements == e.name; });
    if (section == sections.end()) return;
    const Names known = split(section->names, ' ');
    for (const Element& c : e.children)
        if (c.kind == Element::Kind::Tag && !c.name.starts_with('_') &&
            std::find(known.begin(), known.end(), c.name) == known.end())
            out.push_back(fmt::format(
                "{}:{}: <{}>: is not known in <{}> and has no effect{}, expected {}", file, c.line,
                c.name, e.name, did_you_mean(c.name, known), fmt::join(known, ", ")));
}

void look_at(const Element& e, const std::string& parent, const std::string& file,
             std::vector<std::string>& out)
{
    const std::string_view* known = names_of(parent, e.name);
    const bool may_be_any = known != nullptr && known->starts_with('*');
    if (known != nullptr && !may_be_any) look_at_attributes(e, *known, file, out);
    look_at_section(e, file, out);
    // What stands in them is for the solver or belongs to nobody.
    if (may_be_any || e.name == "property" || e.name == "extra") return;
    for (const Element& c : e.children)
        if (c.kind == Element::Kind::Tag && !c.name.starts_with('_')) look_at(c, e.name, file, out);
}

} // namespace

std::vector<std::string> unknown_names(const Element& root, const std::string& file)
{
    std::vector<std::string> out;
    look_at(root, "", file, out);
    return out;
}

} // namespace fppg
