#include "app/save_result.h"

#include "fppg/convert.h"
#include "fppg/error.h"
#include "fppg/version.h"

#include "app/debug_vtk.h"
#include "app/particle_log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string_view>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;

/// The date that goes into the files: now, in local time, or SOURCE_DATE_EPOCH (seconds since 1970,
/// UTC; reproducible-builds.org), so that two runs of a case give the same bytes.
std::string date_of_run()
{
    constexpr const char* form = "{:%d-%m-%Y %H:%M:%S}";
    const char* fixed = std::getenv("SOURCE_DATE_EPOCH");
    if (fixed == nullptr) return fmt::format(form, fmt::localtime(std::time(nullptr)));
    const std::string_view text(fixed);
    std::int64_t seconds = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    // The year 9999 is the last that has four digits.
    if (error != std::errc() || end != text.data() + text.size() || seconds < 0 ||
        seconds > 253402300799)
        throw UsageError(
            fmt::format("the environment's SOURCE_DATE_EPOCH=\"{}\" is invalid, expected seconds "
                        "since 1970",
                        text));
    return fmt::format(form, fmt::gmtime(static_cast<std::time_t>(seconds)));
}

/// A file of the case, or of the zone, that is made.
template <typename Body>
void write(CaseRunState& run, const MadeCase& made, const std::string& ending, const char* note,
           const Body& body)
{
    run.files.write(made.output + ending, note, run.log, body);
}

/// Meshes go beside the result, as with GenCase; those outside the folder of the case stay
/// where they are.
void copy_meshes(CaseRunState& run, const MadeCase& made)
{
    for (const MeshFileUse& mesh : made.mesh_files)
    {
        const fs::path name(mesh.name);
        if (name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end()) continue;
        const fs::path target = fs::path(run.options.output).parent_path() / name;
        std::error_code error;
        if (fs::exists(target, error) && fs::equivalent(target, mesh.path, error)) continue;
        if (run.files.has(target.string())) continue; // of another zone
        if (!target.parent_path().empty()) fs::create_directories(target.parent_path(), error);
        run.files.copy(mesh.path, target.string());
        run.log.line(fmt::format("Geometry file copied: {} (xml row:{})", mesh.name, mesh.line));
    }
}

/// Files that the solver reads go beside the result too, as with GenCase.
void list_data_files(CaseRunState& run, MadeCase& made)
{
    for (const DataFileUse& use : made.def.data_files)
    {
        std::error_code ignored;
        const fs::path beside = fs::path(run.options.input).parent_path() / use.name;
        const fs::path source = fs::exists(use.name, ignored) ? fs::path(use.name) : beside;
        const bool is_known = std::any_of(made.mesh_files.begin(), made.mesh_files.end(),
                                          [&](const MeshFileUse& m) { return m.name == use.name; });
        if (fs::is_regular_file(source, ignored))
        {
            if (!is_known) made.mesh_files.push_back({use.name, source.string(), use.line});
        }
        else
            run.warn(fmt::format("{}:{}: file '{}' was not found to be copied beside the result.",
                                 made.def.file, use.line, use.name));
    }
}

void write_shape_file(OutputFile& f, const ShapeFile& shape_file)
{
    switch (shape_file.format)
    {
        case ShapeFormat::Vtk:
            write_shapes_vtk(f, shape_file.shapes);
            break;
        case ShapeFormat::Vtp:
            write_shapes_vtp(f, shape_file.shapes);
            break;
        case ShapeFormat::Vtu:
            write_shapes_vtu(f, shape_file.shapes);
            break;
        case ShapeFormat::Stl:
            write_shapes_stl(f, shape_file.shapes);
            break;
    }
}

/// What cellsout and pointsmkout ask for; cells of an mk without any give no file.
void save_node_files(CaseRunState& run, const MadeCase& made)
{
    for (const NodeFile& node_file : made.node_files)
    {
        std::uint64_t faces = 1;
        write(run, made, node_file.name, "",
              [&](OutputFile& f)
              {
                  if (node_file.is_cells)
                      faces = write_shown_cells_vtk(f, node_file.cells, node_file.mk, run.threads);
                  else
                      write_points_vtk(f, node_file.points);
              });
        if (faces > 0) continue;
        run.files.drop_last();
        run.log.line(fmt::format("{}{} is empty and not saved", made.output, node_file.name));
    }
}

std::vector<VtkOutEntry> save_shapes(CaseRunState& run, const MadeCase& made)
{
    std::vector<VtkOutEntry> vtk_out;
    for (const ShapeFile& shape_file : made.shape_files)
    {
        write(run, made, shape_file.name, "",
              [&](OutputFile& f) { write_shape_file(f, shape_file); });
        // GenCase lists neither.
        if (shape_file.format == ShapeFormat::Stl || shape_file.has_normals) continue;
        std::vector<int> mk;
        std::vector<int> mk_bound;
        std::vector<int> mk_fluid;
        for (const ShapePolygons& s : shape_file.shapes)
        {
            if (s.mk <= 0)
            {
                // GenCase lists void as 0 unless it comes before all others.
                if (!mk.empty()) mk.push_back(0);
                continue;
            }
            mk.push_back(s.mk);
            (s.mk >= made.def.mk_bound_first ? mk_bound : mk_fluid)
                .push_back(s.mk - (s.mk >= made.def.mk_bound_first ? made.def.mk_bound_first
                                                                   : made.def.mk_fluid_first));
        }
        vtk_out.push_back({fs::path(made.output + shape_file.name).filename().string(),
                           format_ranges(mk), format_ranges(mk_bound), format_ranges(mk_fluid)});
    }
    return vtk_out;
}

std::vector<ParticleType> types_of(const CaseParticles& particles)
{
    std::vector<ParticleType> out(65536, ParticleType::Fixed);
    for (const ParticleBlock& b : particles.blocks) out[b.mk] = b.type;
    return out;
}

/// With one name for both, Case.xml takes the place of the definition, as with GenCase; the
/// definition is kept beside it.
void keep_overwritten_definition(CaseRunState& run, const MadeCase& made)
{
    const std::string source = run.options.input + ".xml";
    const std::string target = made.output + ".xml";
    std::error_code error;
    if (!fs::exists(target, error) || !fs::equivalent(source, target, error)) return;
    const std::string kept = target + ".orig";
    if (!fs::exists(kept)) fs::copy_file(source, kept, error);
    if (error)
        throw IoError(
            fmt::format("{}: cannot keep a copy of the definition: {}", kept, error.message()));
    run.warn(
        fmt::format("{} is the definition and the output: it now holds the generated case, the "
                    "definition was "
                    "kept as {}.",
                    target, kept));
}

/// Pictures and tables of what stands between the definition and the particles.
void save_field(CaseRunState& run, const MadeCase& made)
{
    const DropInOptions& options = run.options;
    if (!made.normal_shapes.empty())
        write(run, made, "_GeometryShapes.vtk", "",
              [&](OutputFile& f) { write_shapes_vtk(f, made.normal_shapes); });
    if (options.save_cells)
        write(run, made, "_MkCells.vtk", "",
              [&](OutputFile& f)
              { write_cells_vtk(f, made.field, types_of(made.particles), run.threads); });
    if (options.save_off_lattice_points && !made.particles.off_lattice_points.mk.empty())
        write(run, made, "_FreePt.vtk", "",
              [&](OutputFile& f)
              { write_off_lattice_points_vtk(f, made.particles.off_lattice_points); });
    if (options.save_relaxation && !made.relax_history.empty())
        write(run, made, "_Relax.csv", "", [&](OutputFile& f) { f.append(made.relax_history); });
    if (options.save_features && !made.field.walls.bodies.empty())
        write(run, made, "_Features.vtk", "",
              [&](OutputFile& f) { write_features_vtk(f, made.field.walls); });
}

void save_particles(CaseRunState& run, const MadeCase& made, const FileOrigin& origin)
{
    const CaseParticles& particles = made.particles;
    if (run.options.save_bi4)
        write(run, made, ".bi4", "<double>",
              [&](OutputFile& f) { write_bi4(f, particles, made.constants, origin, run.threads); });
    else if (std::error_code ignored; fs::exists(made.output + ".bi4", ignored))
        run.warn(
            fmt::format("{}.bi4 is of an earlier run and stays, as -save leaves bi out; it does "
                        "not belong to the new {}.xml.",
                        made.output, made.output));
    const auto picture =
        [&](bool wanted, const char* ending, VtkSelection selection, std::uint64_t count)
    {
        if (wanted && count > 0)
            write(run, made, ending, "",
                  [&](OutputFile& f)
                  { write_particles_vtk(f, particles, made.constants, selection, run.threads); });
    };
    picture(run.options.save_all, "_All.vtk", VtkSelection::All, particles.np);
    picture(run.options.save_bound, "_Bound.vtk", VtkSelection::Bound,
            particles.np - particles.n_fluid);
    picture(run.options.save_fluid, "_Fluid.vtk", VtkSelection::Fluid, particles.n_fluid);
}

/// The files of other codes that -to asks for; what they do not hold is said.
void save_conversions(CaseRunState& run, const MadeCase& made)
{
    if (run.options.to.empty()) return;
    const ParticleFeed feed = feed_of_case(made.def, made.particles, made.constants);
    for (const std::string& name : run.options.to)
    {
        const Stopwatch time;
        const ParticleFormat& format = find_particle_format(name, "");
        ConvertedFiles written =
            convert_particles(feed, format, made.output + format.suffix, run.threads);
        for (OutputFile& file : written.files)
        {
            // Names of bodies alone would be those of another zone of a case with <vres>.
            if (run.files.has(file.path()))
                throw UsageError(
                    fmt::format("-to:{}: '{}' would be written twice; expected it "
                                "without <vres>",
                                name, file.path()));
            run.log.text_line(
                fmt::format("{}<{}>  (time:{:.3f}s)", file.path(), format.name, time.seconds()));
            run.log.fact("file", {{"path", file.path()}, {"seconds", time.seconds()}});
            run.files.take(std::move(file));
        }
        for (const std::string& loss : written.losses)
            run.log.text_line(fmt::format("  {}: {}", format.name, loss));
    }
}

void log_limits(RunLog& log, const CaseParticles& particles)
{
    log.text_line();
    log.text_line("Particle limits:");
    for (int axis = 0; axis < 3; ++axis)
        log.text_line(fmt::format("  {} range: {:g} to {:g} [m]", "XYZ"[axis],
                                  particles.pos_min[axis], particles.pos_max[axis]));
    log.text_line();
    log.fact("limits",
             {{"min", coordinates(particles.pos_min)}, {"max", coordinates(particles.pos_max)}});
}

} // namespace

std::string full_name()
{
    return fmt::format("fppg v{} (compatible with GenCase v5.4)", version);
}

void save_result(CaseRunState& run, MadeCase& made)
{
    run.stage("SaveCase3D",
              [&]
              {
                  const FileOrigin origin{full_name(), date_of_run(), made.def.case_name};
                  list_data_files(run, made);
                  if (run.files.are_written()) copy_meshes(run, made);
                  const std::vector<VtkOutEntry> vtk_out = save_shapes(run, made);
                  made.shape_files.clear();
                  save_node_files(run, made);
                  made.node_files.clear();
                  for (const DebugVtk& picture : debug_vtk(made.def, run.threads))
                      write(run, made, picture.name, "", picture.write);
                  save_field(run, made);
                  made.field = {};
                  made.particles.off_lattice_points = {};
                  save_particles(run, made, origin);
                  save_conversions(run, made);
                  if (run.files.are_written()) keep_overwritten_definition(run, made);
                  write(run, made, ".xml", "",
                        [&](OutputFile& f) {
                            write_case_xml(f, made.def, made.particles, made.constants, vtk_out,
                                           origin);
                        });
                  log_limits(run.log, made.particles);
              });
    run.log.line();
}

void save_zones(CaseRunState& run, const VresDef& vres)
{
    const std::string& output = run.options.output;
    for (std::size_t id = 0; id < vres.zones.size(); ++id)
        run.files.write(fmt::format("{}_vresDomain{:02}.vtk", output, id), "", run.log,
                        [&](OutputFile& f) { write_zone_vtk(f, vres, id); });
    run.files.write(output + "_vresDomains.vtk", "", run.log,
                    [&](OutputFile& f) { write_zones_vtk(f, vres); });
}

} // namespace fppg
