#include "app/case_stages.h"

#include "fppg/balance.h"
#include "fppg/error.h"
#include "fppg/normals.h"
#include "fppg/periodic.h"
#include "fppg/read_shapes.h"
#include "fppg/relax_walls.h"

#include "app/block_check.h"
#include "app/body_table.h"
#include "app/buffer_check.h"
#include "app/fit_check.h"
#include "app/inlet_check.h"
#include "app/lattice_fluid.h"
#include "app/layer_gaps.h"
#include "app/motion_check.h"
#include "app/particle_log.h"
#include "app/relax_stage.h"
#include "app/settle_floatings.h"
#include "app/thousands.h"
#include "casedef/execution.h"
#include "core/text.h"
#include "lattice/mesh_units.h"
#include "particles/exact_volumes.h"
#include "particles/off_lattice_particles.h"
#include "particles/simulation_domain.h"
#include "platform/memory.h"
#include "relax/gap_rows.h"
#include "relax/inlet_nodes.h"
#include "relax/wall_planes.h"
#include "scene/part_colours.h"
#include "walls/fluid_boxes.h"
#include "walls/fluid_ends.h"
#include "walls/lattice_margin.h"
#include "walls/lattice_shift.h"
#include "walls/periodic_ends.h"
#include "walls/true_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;

void enter_zone(MadeCase& made)
{
    if (!made.def.vres.is_active()) return;
    const bool are_plain = std::all_of(made.def.vres.zones.begin(), made.def.vres.zones.end(),
                                       [](const VresZone& zone) { return zone.inner.is_plain; });
    if (made.field.walls.volume.size() > 0 && (!are_plain || !made.def.point_files.empty()))
        throw CaseError(made.def.file, made.def.vres.zones[0].line,
                        "<vres>: turned regions of other resolution together with particles "
                        "off the lattice (<setfrdrawmode>), and any with point files, are not "
                        "supported yet");
    std::array<bool, 3> is_periodic{};
    std::array<Vec3, 3> shift;
    read_periodic_axes(made.def.execution, made.def.file, is_periodic, shift);
    const bool is_on_lattice =
        made.field.walls.volume.size() == 0 && made.field.walls.bodies.empty();
    if (!is_on_lattice && is_periodic != std::array<bool, 3>{})
        throw CaseError(made.def.file, made.def.vres.zones[0].line,
                        "<vres>: regions of other resolution in a periodic case with particles off "
                        "the lattice (body-fitted walls, <setfrdrawmode>) are not supported yet: "
                        "they would not meet across the period; expected none of the parameters "
                        "XPeriodicIncY and the like, or particles on the lattice only");
    clip_to_zone(made.def.vres, made.def.zone, made.field);
}

std::uint64_t count_particles(const RunField& field)
{
    std::uint64_t count = 0;
    for (const std::uint64_t n : count_off_lattice_particles(field.walls)) count += n;
    for (const std::vector<Run>& slab : field.slabs)
        for (const Run& r : slab) count += r.is_covered ? 0 : r.z_end - r.z_begin;
    return count;
}

LatticeProgress draw_progress(CaseRunState& run)
{
    return [&run](std::size_t done, std::size_t all)
    {
        run.progress(static_cast<double>(done) / static_cast<double>(all),
                     fmt::format("{} of {}", done, all));
    };
}

void log_lattice_move(const LatticeMove& move, RunLog& log)
{
    const Vec3& by = move.shift;
    const Vec3& s = move.to.stretch;
    if (by != Vec3{})
        log.line(fmt::format("Lattice moved by ({:g}, {:g}, {:g}) m: fluid in step with flat walls",
                             by.x, by.y, by.z));
    if (s != Vec3{1, 1, 1})
        log.line(
            fmt::format("Lattice stretched by ({:+.2f}, {:+.2f}, {:+.2f}) %: walls on both "
                        "sides of the fluid are no whole number of dp apart",
                        100 * (s.x - 1), 100 * (s.y - 1), 100 * (s.z - 1)));
    log.fact("lattice", {{"shift", coordinates(by)}, {"stretch", coordinates(s)}});
}

/// Checks for what GenCase accepts in silence. What no zone of a case with `<vres>` has is told
/// with the last one.
void check_blocks(CaseRunState& run, const MadeCase& made)
{
    const CaseDef& def = made.def;
    for (const ParticleBlock& block : made.particles.blocks)
        if (block.count > 0) run.mks.insert(block.mk);
    const auto tell = [&](std::vector<std::string> found)
    {
        for (std::string& w : found) run.diagnose(std::move(w));
    };
    tell(check_motion(def, made.particles));
    tell(check_layer_gaps(def, made.particles, made.field.walls.gaps));
    tell(check_floor(def, made.particles));
    tell(check_inlets(def, made.particles));
    if (def.vres.is_active() && def.zone + 1 < def.vres.zones.size()) return;
    tell(check_mks(def, run.mks));
    tell(check_unions(def));
}

/// The polygons that norgeometry asks for: those of a shape file of this run, or of a file that
/// stands in the folder of the output, where GenCase looks for it, or beside the definition.
std::vector<ShapePolygons> normal_geometry(const CaseRunState& run, const MadeCase& made)
{
    if (!made.def.normals.geometry) return {};
    const GeometryNormals& geometry = *made.def.normals.geometry;
    for (const ShapeFile& shape_file : made.shape_files)
        if (made.def.case_name + shape_file.name == geometry.file) return shape_file.shapes;
    const fs::path beside = fs::path(run.options.input).parent_path() / geometry.file;
    const fs::path in_output = fs::path(run.options.output).parent_path() / geometry.file;
    std::error_code ignored;
    for (const fs::path& path : {in_output, beside})
        if (fs::exists(path, ignored)) return read_shapes_vtk(path.string());
    std::vector<std::string> names;
    for (const ShapeFile& shape_file : made.shape_files)
        names.push_back(made.def.case_name + shape_file.name);
    throw IoError(fmt::format(
        "{}:{}: <geometryfile file=\"{}\">: no such shape file; this case writes {}, and "
        "neither {} nor {} exists",
        made.def.file, geometry.line, geometry.file,
        names.empty() ? "none (<shapeout> does)" : fmt::format("{}", fmt::join(names, ", ")),
        in_output.string(), beside.string()));
}

/// The volumes of particles where `<bodyfitted volume="exact">` asks for them.
std::vector<double> volumes_of_bodies(const CaseRunState& run, const MadeCase& made)
{
    try
    {
        return exact_volumes(made.def, made.field.walls, made.particles, run.threads);
    }
    catch (const GeometryError& error)
    {
        throw GeometryError(fmt::format("{}: {}", made.def.file, error.what()));
    }
}

/// A place that is no number would spoil the result without a word.
///
/// throws  Error, as it is a fault of ours
void expect_numbers(const MadeCase& made)
{
    const auto lost = static_cast<std::size_t>(std::count_if(
        made.particles.off_lattice.positions.begin(), made.particles.off_lattice.positions.end(),
        [](const Vec3& p) { return !std::isfinite(p.x + p.y + p.z); }));
    const auto bare = static_cast<std::size_t>(std::count_if(
        made.particles.bound_normals.begin(), made.particles.bound_normals.end(),
        [](const std::array<float, 3>& n) { return !std::isfinite(n[0] + n[1] + n[2]); }));
    if (lost + bare > 0)
        throw Error(fmt::format(
            "{}: {} and {} are no numbers; this is a fault of fppg, nothing is "
            "written. -fit:raw may avoid it.",
            made.def.file, counted(lost, "place", "places"), counted(bare, "normal", "normals")));
}

} // namespace

void read_definition(CaseRunState& run, std::size_t zone, const VresDef* vres, MadeCase& made)
{
    run.stage("LoadXMLInit",
              [&]
              {
                  CaseOptions of_zone = case_options(run.options);
                  of_zone.vres = vres;
                  of_zone.zone = zone;
                  of_zone.meshes = std::move(made.scene.meshes);
                  made = {};
                  made.def = read_case(run.options.input + ".xml", of_zone);
                  made.scene = make_scene(made.def);
                  made.output = made.def.vres.is_active() ? zone_name(run.options.output, zone)
                                                          : run.options.output;
                  if (made.def.vres.is_active())
                      run.log.line(fmt::format("VResolution: zone {} of {}", zone,
                                               made.def.vres.zones.size()));
                  run.log.line(fmt::format("Total operations: {}", made.def.ops.size()));
              });
}

/// Where walls stand and fluid ends, before they are drawn.
void settle_walls(CaseRunState& run, MadeCase& made)
{
    if (const auto period = lattice_of_period(made.scene, run.threads))
    {
        made.def.grid = *period;
        const Vec3& from = period->origin;
        run.log.line(
            fmt::format("Period: as far as the case is drawn, from ({:g}, {:g}, {:g}) m, "
                        "{} x {} x {} nodes",
                        from.x, from.y, from.z, period->n[0], period->n[1], period->n[2]));
    }
    for (std::string& w : draw_shells_around_fluid(made.scene, run.threads, made.def))
        made.def.hints.push_back(std::move(w));
    for (const std::string& line : draw_true_surfaces(made.scene, run.threads, made.def))
        run.log.line(line);
    if (const LatticeMargin margin = margin_for_layers(made.scene, run.threads);
        margin != LatticeMargin{})
    {
        widen_lattice(margin, made.def.grid);
        run.log.line(fmt::format(
            "Lattice wider than the domain, by {}, {}, {} nodes before and {}, {}, {} behind it: "
            "room for all layers of its walls",
            margin.low[0], margin.low[1], margin.low[2], margin.high[0], margin.high[1],
            margin.high[2]));
    }
    if (const LatticeMove move = lattice_move(made.scene, run.threads); !move.is_none())
    {
        move_lattice(move, run.threads, made.def, made.scene);
        log_lattice_move(move, run.log);
    }
    end_fluid_at_walls(made.scene, run.threads, made.def);
}

void draw(CaseRunState& run, MadeCase& made)
{
    run.stage("Draw",
              [&]
              {
                  run.log.line("List of available variables: " + made.def.variables_log);
                  run.log.line();
                  log_domain(made.def, run.log);
                  for (const std::string& line : made.def.list_log) run.log.line(line);
                  CaseOptions options = case_options(run.options);
                  options.meshes = made.scene.meshes;
                  expect_particles_fit(run.options.input + ".xml", options, made.def, run.threads,
                                       run.limit);
                  expect_metres(made.scene, run.threads);
                  settle_walls(run, made);
                  LatticeReport report;
                  made.mesh_files.clear();
                  made.field = draw_scene(made.scene, run.threads, draw_progress(run), report);
                  return_free_memory(); // shapes were cut row by row
                  enter_zone(made);
                  expect_room(made.def, count_particles(made.field), run.limit);
                  made.mesh_files = std::move(report.mesh_files);
                  for (const CavityFilled& fill : report.fills) log_fill(fill, run.log);
                  for (const std::string& line : report.log) run.log.line(line);
                  made.node_files = std::move(report.node_files);
                  for (std::string& w : made.def.warnings) run.diagnose(std::move(w));
                  for (std::string& w : made.def.hints) run.warn(std::move(w));
                  for (std::string& w : report.warnings) run.diagnose(std::move(w));
                  run.log.line(fmt::format("Triangles: {} ({} ignored)", report.triangles,
                                           report.triangles_ignored));
              });
}

void log_gap(CaseRunState& run, const CaseDef& def, const ClosedGap& gap)
{
    const auto name = [&](std::uint16_t mk)
    { return fmt::format("mkbound {}", mk - def.mk_bound_first); };
    const std::string least = fmt::format("{:.2g}", gap.least_dp);
    const std::string most = fmt::format("{:.2g}", gap.most_dp);
    const std::string rows = fmt::format(
        "{} between {} and {} of {} dp, near ({:g}, {:g}, {:g})",
        counted(gap.count, "particle closes the gap", "particles close the gap"), name(gap.mk),
        name(gap.other), least == most ? least : fmt::format("{} to {}", least, most), gap.place.x,
        gap.place.y, gap.place.z);
    if (gap.moves)
        run.warn(
            fmt::format("{}: {}, and go along with {}. On the lattice there is no node in such "
                        "a gap; between layers fluid would run through. Draw it wider than "
                        "{:g} dp if fluid is to pass.",
                        def.file, rows, name(gap.mk), sliding_pocket_of_layers_dp));
    else
        run.log.line(rows);
}

void relax(CaseRunState& run, MadeCase& made)
{
    if (made.field.walls.bodies.empty()) return;
    log_fitted_walls(made.field, run.log);
    if (relaxes(made.def, made.field)) run.stage("Relax", [&] { run_relaxation(run, made); });
    for (const ClosedGap& gap : close_gaps(made.def, made.field, run.threads))
        log_gap(run, made.def, gap);
    for (const InletRim& rim : leave_out_inlet_rims(made.def, made.field))
        run.warn(fmt::format(
            "{}: {} of {} particles of mkfluid {} are left out, the first at ({:g}, {:g}, {:g}): "
            "the solver refuses points of an inlet that are nearer than 0.7 dp to a wall. As much "
            "less fluid comes in; walls a whole number of dp apart leave no such points.",
            made.def.file, thousands(rim.left_out), thousands(rim.of),
            rim.mk - made.def.mk_fluid_first, rim.first.x, rim.first.y, rim.first.z));
    return_free_memory(); // surfaces were laid and relaxed piece by piece
    log_left_out(made.field.walls, run.log);
    for (const std::string& w : check_fit(made.def.fit, made.field.walls, made.field.grid, run.log))
        run.warn(fmt::format("{}: {}", made.def.file, w));
}

void add_points(CaseRunState& run, MadeCase& made)
{
    if (made.def.point_files.empty()) return;
    LatticeReport report;
    add_point_files(made.scene, made.field, report);
    std::move(report.mesh_files.begin(), report.mesh_files.end(),
              std::back_inserter(made.mesh_files));
    for (const std::string& line : report.log) run.log.line(line);
    for (std::string& w : report.warnings) run.warn(std::move(w));
}

void warn_of_flexible(CaseRunState& run, const MadeCase& made)
{
    for (std::string& w : weigh_flexible(made.scene, made.field.walls, made.particles))
        run.warn(std::move(w));
}

void prepare_particles(CaseRunState& run, MadeCase& made)
{
    run.stage("PreparePoints",
              [&]
              {
                  const SeamsClosed seams = close_seams(made.def, made.field);
                  if (seams.left_out + seams.moved > 0)
                      run.log.line(fmt::format(
                          "Periodic seam: {} particles left out, as others are nearer than half "
                          "a dp across it, {} moved by a period",
                          seams.left_out, seams.moved));
                  std::vector<std::string> warnings;
                  made.particles =
                      make_particles(made.def, made.field, run.threads, made.constants, warnings);
                  const auto colours = colours_of_parts(made.scene);
                  for (ParticleBlock& block : made.particles.blocks)
                      if (const auto own = colours.find(block.mk); own != colours.end())
                          block.colour = own->second;
                  made.particles.volumes = volumes_of_bodies(run, made);
                  std::vector<std::string> periods;
                  set_period(made.def, made.particles, periods);
                  for (std::string& w : periods) run.diagnose(std::move(w));
                  for (std::string& w : widen_simulation_domain(made.particles, made.def))
                      run.warn(std::move(w));
                  log_particles(made.def, made.particles, made.constants, run.log);
                  const SettledFloatings floatings =
                      settle_floatings(made.scene, made.field.walls, made.particles);
                  log_floatings(floatings, run.log);
                  log_bodies(made.scene, made.field.walls, made.particles, made.constants, run.log);
                  warn_of_flexible(run, made);
                  for (const std::string& w : floatings.warnings) run.warn(w);
                  for (std::string& w : warnings) run.warn(std::move(w));
                  for (const std::string& w : floatings.light_or_heavy) run.diagnose(w);
                  for (std::string& w : check_lattice_fluid(run, made)) run.warn(std::move(w));
                  check_blocks(run, made);
              });
    if (run.options.strict && !run.diagnostics.empty())
        throw CaseError(
            fmt::format("-strict: {} as errors, nothing is written:\n  {}",
                        counted(run.diagnostics.size(), "warning counts", "warnings count"),
                        fmt::join(run.diagnostics, "\n  ")));
}

void make_normals(CaseRunState& run, MadeCase& made)
{
    made.shape_files = collect_shape_files(made.scene);
    if (made.def.normals.is_active)
        run.stage("Normals",
                  [&]
                  {
                      NormalsReport report;
                      made.particles.bound_normals =
                          compute_normals(made.def, made.particles, made.field,
                                          normal_geometry(run, made), run.threads, report);
                      made.normal_shapes = std::move(report.shapes);
                      for (const std::string& line : report.log) run.log.line(line);
                      for (std::string& w : report.warnings) run.warn(std::move(w));
                  });
    if (std::optional<std::string> stops = check_buffers(made.def, made.particles))
        run.warn(std::move(*stops));
}

void balance(CaseRunState& run, MadeCase& made)
{
    if (!made.def.balances() || !made.particles.off_lattice.has_walls()) return;
    run.stage("Balance",
              [&]
              {
                  const BalanceReport report = balance_fluid(
                      made.def, made.field, made.constants, made.particles, run.threads,
                      [&run](const BalanceProgress& p)
                      {
                          run.progress(
                              static_cast<double>(p.iteration) / p.last_iteration,
                              fmt::format("{} of at most {}, mean acceleration {:.4f} g",
                                          p.iteration, p.last_iteration, p.mean_acceleration));
                          return true;
                      });
                  log_balance(report, run.log);
                  if (report.is_balanced && report.falling > 0)
                      run.warn(fmt::format(
                          "{}: {} particles of fluid near body-fitted walls stay as they are, the "
                          "fastest at ({:.4g}, {:.4g}, {:.4g}): the walls there do not "
                          "hold them (one sheet of particles holds no water at rest, layers and "
                          "filled bodies do)",
                          made.def.file, thousands(report.falling), report.fastest.x,
                          report.fastest.y, report.fastest.z));
              });
}

void make_particles_of_case(CaseRunState& run, MadeCase& made)
{
    draw(run, made);
    relax(run, made);
    add_points(run, made);
    prepare_particles(run, made);
    make_normals(run, made);
    balance(run, made);
    expect_numbers(made);
}

} // namespace fppg
