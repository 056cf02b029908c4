#include "fuzz/targets.h"

#include "app/command_line.h"
#include "app/subcommand_line.h"
#include "app/subcommands.h"
#include "casedef/expression.h"
#include "casedef/mesh_data.h"
#include "casedef/variables.h"
#include "core/text.h"
#include "fppg/case_def.h"
#include "fppg/error.h"
#include "fppg/read_particles.h"
#include "fppg/read_shapes.h"
#include "fppg/shapes.h"
#include "fppg/surface_mesh.h"
#include "fuzz/working_folder.h"
#include "meshes/readers.h"
#include "report/run_facts.h"
#include "upgrade/upgrade.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace fppg::fuzz
{
namespace
{

/// Facets of a mesh that is repaired after it was read; more would make the fuzzer slow.
constexpr std::size_t most_facets = 500;

/// Reads a mesh file, and mends it as a case does.
void read_and_repair(const std::string& name, std::string_view bytes, const MeshReading& reading)
{
    write_input(name, bytes);
    const MeshFile mesh = read_mesh_file(name, reading, 1);
    if (mesh.soup.size() == 0 || mesh.soup.size() > most_facets) return;
    MeshReport report;
    MeshIntakeOptions options;
    options.dp = 0.1;
    options.is_solid = true;
    options.count_self_intersections = true;
    (void)repair_mesh(mesh.soup, options, 1, report);
}

template <MeshFormat Format>
void read_mesh(std::string_view bytes)
{
    read_and_repair("input.mesh", bytes, {.format = Format});
}

/// `<drawbathymetry>`: points by rows or scattered, with all that may follow.
void read_ground(std::string_view bytes)
{
    BathymetryGrid grid;
    grid.spacing = 0.1;
    grid.expands[0] = {.size = 0.4, .z = 0.9, .size2 = 0.3, .z2 = -0.2};
    grid.expands[3].size = -0.2;
    grid.periods[1] = BathymetryPeriod{.ramp_width = 0.2, .flat_width = 0.1};
    read_and_repair("input.mesh", bytes, {.format = MeshFormat::Bathymetry, .bathymetry = grid});
}

void read_point_list(std::string_view bytes)
{
    (void)read_points(bytes, "points");
}

CaseOptions options_of_case()
{
    CaseOptions options;
    options.case_name = "Case";
    return options;
}

/// A definition, and the program that brings old ones up to date.
void read_definition_text(std::string_view bytes)
{
    try
    {
        (void)upgrade_definition(std::string(bytes), "Case_Def.xml");
    }
    catch (const Error&)
    {
    }
    write_input("Case_Def.xml", bytes);
    (void)read_case("Case_Def.xml", options_of_case());
}

/// The parts that `<drawfilevtm>` draws; Vtm_Def.xml draws those of input.vtm.
void read_parts(std::string_view bytes)
{
    write_input("input.vtm", bytes);
    (void)read_case("Vtm_Def.xml", options_of_case());
}

void evaluate(std::string_view bytes)
{
    Variables vars;
    vars.predefine("Dp", 0.1);
    vars.predefine("PosMin_x", -0.5);
    vars.predefine("x1", 2.0);
    vars.predefine("T", "text");
    try
    {
        (void)evaluate_expression(bytes, vars);
    }
    catch (const ExpressionError&)
    {
    }
    try
    {
        (void)vars.interpolate(bytes);
    }
    catch (const ExpressionError&)
    {
    }
}

/// Particles of a result whose Case.xml is that of the working folder.
void read_bi4_file(std::string_view bytes)
{
    write_input("Result.bi4", bytes);
    (void)read_particles("Result", false, 1);
}

/// The Case.xml of a result, beside the particles of the working folder.
void read_result_xml(std::string_view bytes)
{
    write_input("Given.xml", bytes);
    (void)read_particles("Given", false, 1);
}

/// What `<initials>` reads: tables and binary files.
void read_values_on_a_mesh(std::string_view bytes)
{
    const std::string name = bytes.starts_with("#FileJBD") ? "values.mbi4" : "values.csv";
    write_input(name, bytes);
    (void)values_at_time(read_mesh_data(name, "Vel"), 0.5);
}

void read_shape_file(std::string_view bytes)
{
    write_input("Case__Dp.vtk", bytes);
    (void)read_shapes_vtk("Case__Dp.vtk");
}

/// Case.out, as reports read it.
void read_log(std::string_view bytes)
{
    (void)run_facts_html(read_run_facts(bytes));
}

void read_vtk_file(std::string_view bytes)
{
    write_input("Result_All.vtk", bytes);
    (void)read_particles("Result_All.vtk", false, 1);
}

/// One argument a line. Names with slashes could reach files outside the working folder, and a
/// batch starts programs.
void take_arguments(std::string_view bytes)
{
    std::vector<std::string> arguments;
    for (const std::string_view line : split(bytes, '\n'))
    {
        if (line.find('/') != std::string_view::npos || line.find('\0') != std::string_view::npos ||
            line.find("..") != std::string_view::npos)
            return;
        arguments.emplace_back(line);
    }
    if (arguments.empty() || arguments.front() == "batch") return;
    (void)read_evars(arguments.back());
    if (const Subcommand command = find_subcommand(arguments.front()))
        (void)command({arguments.begin() + 1, arguments.end()});
    else
        (void)parse_command_line(arguments);
}

constexpr auto table = std::to_array<Target>({
    {"arguments", take_arguments, false},
    {"bathymetry", read_ground, false},
    {"bi4", read_bi4_file, false},
    {"case", read_definition_text, true},
    {"csv", read_mesh<MeshFormat::CsvBathymetry>, false},
    {"expression", evaluate, false},
    {"generate", generate_particles, true},
    {"log", read_log, false},
    {"meshdata", read_values_on_a_mesh, false},
    {"obj", read_mesh<MeshFormat::Obj>, false},
    {"off", read_mesh<MeshFormat::Off>, false},
    {"particles", read_vtk_file, false},
    {"ply", read_mesh<MeshFormat::Ply>, false},
    {"points", read_point_list, false},
    {"result", read_result_xml, true},
    {"shapes", read_shape_file, false},
    {"stl", read_mesh<MeshFormat::Stl>, false},
    {"vtk", read_mesh<MeshFormat::Vtk>, false},
    {"vtm", read_parts, false},
});

} // namespace

std::span<const Target> targets()
{
    return table;
}

const Target* find_target(std::string_view name)
{
    const auto found = std::find_if(table.begin(), table.end(),
                                    [name](const Target& t) { return t.name == name; });
    return found == table.end() ? nullptr : &*found;
}

void run_target(const Target& target, std::string_view bytes)
{
    try
    {
        target.run(bytes);
    }
    catch (const Error&)
    {
    }
    catch (const std::filesystem::filesystem_error&)
    {
        // The program ends with exit code 4 for these, too.
    }
    tidy_working_folder();
}

} // namespace fppg::fuzz
