// Commands that write files of shapes and nodes.
#include "casedef/command_table.h"

#include "core/text.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace fppg::commands
{
namespace
{

/// The part that a command gives to the name of a file of the result. Parts of a name are folders;
/// ".." among them would lead out of that of the result.
std::string name_beside_result(const Program& p, const Element& e)
{
    std::string name = p.read.text(e, "file");
    for (const std::filesystem::path& folder : std::filesystem::path(name))
        if (folder == "..")
            p.read.fail(e,
                        fmt::format("file=\"{}\" leads out of the folder of the result, expected "
                                    "a name without \"..\"",
                                    name));
    return name;
}

} // namespace

void cells_out(Program& p, const Element& e)
{
    CellsOutOp op;
    op.file = name_beside_result(p, e);
    for (const char* name : {"mkbound", "mkfluid"})
    {
        if (e.find_attribute(name) == nullptr) continue;
        const int number = p.read.integer(e, name, 0, 65000, false);
        const bool is_bound = name == std::string_view("mkbound");
        op.mk = static_cast<std::uint16_t>(
            number + (is_bound ? p.def.mk_bound_first : p.def.mk_fluid_first));
        op.suffix = fmt::format("_{}{}", name, number);
        break; // mkbound comes first, as with GenCase
    }
    p.add_whole(e, std::move(op));
}

void shape_out(Program& p, const Element& e)
{
    const std::string format = lower_case(p.read.text_or(e, "format", "vtk"));
    ShapeOutOp op;
    op.file = name_beside_result(p, e);
    if (format == "vtp")
        op.format = ShapeFormat::Vtp;
    else if (format == "vtu")
        op.format = ShapeFormat::Vtu;
    else if (format == "stl")
        op.format = ShapeFormat::Stl;
    else if (format != "vtk")
        p.read.fail(e, fmt::format("format=\"{}\" is invalid, expected vtk, vtp, vtu or stl",
                                   p.read.text(e, "format")));
    op.normal_dp = p.read.number_or(e, "savenormal", 0);
    op.reset = p.read.plain_flag_or(e, "reset", true);
    p.add(e, std::move(op));
}

void points_mk_out(Program& p, const Element& e)
{
    p.add_whole(e, PointsMkOutOp{name_beside_result(p, e)});
}

} // namespace fppg::commands
