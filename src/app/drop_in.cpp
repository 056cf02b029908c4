#include "app/drop_in.h"

#include "fppg/case_def.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "fppg/lattice.h"
#include "fppg/normals.h"
#include "fppg/particles.h"
#include "fppg/read_shapes.h"
#include "fppg/relax_walls.h"
#include "fppg/scene.h"
#include "fppg/version.h"

#include "app/debug_pictures.h"
#include "app/fit_check.h"
#include "app/floating_log.h"
#include "app/motion_check.h"
#include "app/particle_log.h"
#include "app/relax_stage.h"
#include "app/result_files.h"
#include "app/run_log.h"
#include "app/stage_bar.h"
#include "app/stopwatch.h"
#include "app/templates_command.h"
#include "app/threads.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iterator>
#include <set>
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

std::string full_name()
{
    return fmt::format("fppg v{} (compatible with GenCase v5.4)", version);
}

class DropInRun
{
public:
    explicit DropInRun(const DropInOptions& options)
        : options_(options),
          threads_(options.threads > 0 ? options.threads : default_threads()),
          log_(options.log_json   ? LogStyle::Json
               : options.is_quiet ? LogStyle::Quiet
                                  : LogStyle::Text)
    {
    }

    int run()
    {
        const Stopwatch total;
        log_.line(full_name());
        log_.line(std::string(full_name().size(), '='));
        log_.line(fmt::format("OmpThreads: {}", threads_));
        try
        {
            prepare_folder();
            read();
            make_case();
            make_other_zones();
        }
        catch (const std::exception& error)
        {
            write_failed_log(error);
            throw;
        }
        print_warnings();
        log_.line(
            fmt::format("Time of execution: {:.3f} sec. ({} threads)", total.seconds(), threads_));
        log_.line();
        log_.line("Finished execution (code=0).");
        files_.add(options_.output + ".out").append(log_.text());
        files_.commit(options_.save_three_vtk);
        log_.finished(total.seconds(), {{"particles", particles_.np},
                                        {"fixed", particles_.n_fixed},
                                        {"moving", particles_.n_moving},
                                        {"floating", particles_.n_floating},
                                        {"fluid", particles_.n_fluid}});
        return 0;
    }

private:
    void make_case()
    {
        draw();
        relax();
        add_points();
        prepare();
        save();
    }

    /// Zone 0 of a case with `<vres>` is made; the others follow, each a case of its own.
    void make_other_zones()
    {
        if (!def_.vres.is_active()) return;
        const VresDef vres = def_.vres;
        std::vector<ZoneSummary> zones{summary_of_zone(def_, particles_, constants_)};
        while (zones.size() < vres.zones.size())
        {
            const std::size_t id = zones.size();
            log_.line();
            log_.line(std::string(72, '#'));
            read(id, &vres);
            def_.main_hswl = zones[0].constants.hswl;
            if (def_.constants.rhop_gradient == 3 && zones[0].counts[0] > 0)
                def_.main_surface = zones[0].constants.surface;
            def_.particles_around = zones[static_cast<std::size_t>(vres.zones[id].parent)].limits;
            make_case();
            zones.push_back(summary_of_zone(def_, particles_, constants_));
        }
        output_ = options_.output;
        save_zones(vres);
        log_zones(zones, log_);
    }

    void save_zones(const VresDef& vres)
    {
        for (std::size_t id = 0; id < vres.zones.size(); ++id)
            write(fmt::format("_vresDomain{:02}.vtk", id), "",
                  [&](OutputFile& f) { write_zone_vtk(f, vres, id); });
        write("_vresDomains.vtk", "", [&](OutputFile& f) { write_zones_vtk(f, vres); });
    }

    template <typename Body>
    void stage(const char* name, const Body& body)
    {
        const Stopwatch time;
        log_.begin_stage(name);
        {
            const StageBar bar(name, log_.style() == LogStyle::Text);
            body();
        }
        log_.end_stage(name, time.seconds());
    }

    void prepare_folder() const
    {
        const fs::path folder = fs::path(options_.output).parent_path();
        if (folder.empty() || fs::is_directory(folder)) return;
        if (!options_.create_folders)
            throw IoError(fmt::format("{}: the folder does not exist (and -createdirs:0 is given)",
                                      folder.string()));
        std::error_code error;
        fs::create_directories(folder, error);
        if (error)
            throw IoError(
                fmt::format("{}: cannot create the folder: {}", folder.string(), error.message()));
    }

    void read(std::size_t zone = 0, const VresDef* vres = nullptr)
    {
        stage("LoadXMLInit",
              [&]
              {
                  CaseOptions of_zone = case_options(options_);
                  of_zone.vres = vres;
                  of_zone.zone = zone;
                  of_zone.meshes = scene_.meshes;
                  def_ = read_case(options_.input + ".xml", of_zone);
                  scene_ = make_scene(def_);
                  output_ =
                      def_.vres.is_active() ? zone_name(options_.output, zone) : options_.output;
                  if (def_.vres.is_active())
                      log_.line(
                          fmt::format("VResolution: zone {} of {}", zone, def_.vres.zones.size()));
                  log_.line(fmt::format("Total operations: {}", def_.ops.size()));
              });
    }

    void draw()
    {
        stage("Draw",
              [this]
              {
                  const LatticeGrid& grid = def_.grid;
                  log_.line("List of available variables: " + def_.variables_log);
                  log_.line();
                  log_.line(fmt::format("Case limits: ({:g},{:g},{:g}) - ({:g},{:g},{:g})",
                                        def_.case_pos_min.x, def_.case_pos_min.y,
                                        def_.case_pos_min.z, def_.case_pos_max.x,
                                        def_.case_pos_max.y, def_.case_pos_max.z));
                  log_.line(fmt::format("Distance between points (Dp): {:g}", grid.dp));
                  log_.line(fmt::format("Case domain: (0,0,0)-({},{},{})", grid.n[0] - 1,
                                        grid.n[1] - 1, grid.n[2] - 1));
                  for (const std::string& line : def_.list_log) log_.line(line);
                  LatticeReport report;
                  mesh_files_.clear();
                  field_ = draw_scene(scene_, threads_, draw_progress(), report);
                  enter_zone();
                  mesh_files_ = std::move(report.mesh_files);
                  for (const std::string& line : report.log) log_.line(line);
                  node_files_ = std::move(report.node_files);
                  for (std::string& w : def_.warnings) warn_of_slip(std::move(w));
                  for (std::string& w : report.warnings) warn_of_slip(std::move(w));
                  log_.line(fmt::format("Triangles: {} ({} ignored)", report.triangles,
                                        report.triangles_ignored));
              });
    }

    void enter_zone()
    {
        if (!def_.vres.is_active()) return;
        const bool are_plain =
            std::all_of(def_.vres.zones.begin(), def_.vres.zones.end(),
                        [](const VresZone& zone) { return zone.inner.is_plain; });
        if (field_.walls.volume.size() > 0 && (!are_plain || !def_.point_files.empty()))
            throw CaseError(def_.file, def_.vres.zones[0].line,
                            "<vres>: turned regions of other resolution together with particles "
                            "off the lattice (<setfrdrawmode>), and any with point files, are not "
                            "supported yet");
        clip_to_zone(def_.vres, def_.zone, field_);
    }

    static LatticeProgress draw_progress()
    {
        return [](std::size_t done, std::size_t all)
        {
            StageBar::show(static_cast<double>(done) / static_cast<double>(all),
                           fmt::format("{} of {}", done, all));
        };
    }

    /// Spreads the particles of fitted walls.
    void relax()
    {
        if (field_.walls.bodies.empty()) return;
        log_fitted_walls(field_, log_);
        if (relaxes(def_, field_))
            stage("Relax",
                  [this]
                  {
                      RelaxOutcome done = run_relaxation(def_, field_, output_, threads_, log_);
                      relax_history_ = std::move(done.history);
                      for (std::string& w : done.warnings) warn(std::move(w));
                  });
        for (const std::string& w : check_fit(def_.fit, field_.walls, field_.grid, log_))
            warn(fmt::format("{}: {}", def_.file, w));
    }

    /// After the relaxation, which would move them.
    void add_points()
    {
        if (def_.point_files.empty()) return;
        LatticeReport report;
        add_point_files(scene_, field_, report);
        std::move(report.mesh_files.begin(), report.mesh_files.end(),
                  std::back_inserter(mesh_files_));
        for (const std::string& line : report.log) log_.line(line);
        for (std::string& w : report.warnings) warn(std::move(w));
    }

    void prepare()
    {
        stage("PreparePoints",
              [this]
              {
                  std::vector<std::string> warnings;
                  particles_ = make_particles(def_, field_, threads_, constants_, warnings);
                  log_particles(def_, particles_, constants_, log_);
                  for (std::string& w : settle_floatings(scene_, field_.walls, particles_, log_))
                      warn(std::move(w));
                  for (std::string& w : warnings) warn(std::move(w));
                  for (std::string& w : check_motion(def_, particles_)) warn_of_slip(std::move(w));
              });
        if (options_.strict && !slips_.empty())
            throw CaseError(fmt::format(
                "-strict: {} warning{} count as errors, nothing is "
                "written:\n  {}",
                slips_.size(), slips_.size() == 1 ? "" : "s", fmt::join(slips_, "\n  ")));
    }

    void save()
    {
        stage("SaveCase3D",
              [this]
              {
                  const FileOrigin origin{full_name(), date_of_run(), def_.case_name};
                  std::vector<VtkOutEntry> vtk_out;
                  copy_data_files();
                  copy_meshes();
                  save_shapes(vtk_out);
                  save_node_files();
                  for (const DebugPicture& picture : debug_pictures(def_, threads_))
                      write(picture.name, "", picture.write);
                  make_normals();
                  if (options_.save_cells)
                      write("_MkCells.vtk", "",
                            [&](OutputFile& f) { write_cells_vtk(f, field_, types(), threads_); });
                  save_free_points();
                  if (options_.save_relaxation && !relax_history_.empty())
                      write("_Relax.csv", "", [&](OutputFile& f) { f.append(relax_history_); });
                  if (options_.save_features && !field_.walls.bodies.empty())
                      write("_Features.vtk", "",
                            [&](OutputFile& f) { write_features_vtk(f, field_.walls); });
                  field_ = {};
                  if (options_.save_bi4)
                      write(".bi4", "<double>",
                            [&](OutputFile& f)
                            { write_bi4(f, particles_, constants_, origin, threads_); });
                  const auto picture = [&](bool wanted, const char* ending, VtkSelection selection,
                                           std::uint64_t count)
                  {
                      if (wanted && count > 0)
                          write(ending, "",
                                [&](OutputFile& f) {
                                    write_particles_vtk(f, particles_, constants_, selection,
                                                        threads_);
                                });
                  };
                  picture(options_.save_all, "_All.vtk", VtkSelection::All, particles_.np);
                  picture(options_.save_bound, "_Bound.vtk", VtkSelection::Bound,
                          particles_.np - particles_.n_fluid);
                  picture(options_.save_fluid, "_Fluid.vtk", VtkSelection::Fluid,
                          particles_.n_fluid);
                  keep_overwritten_definition();
                  write(".xml", "",
                        [&](OutputFile& f)
                        { write_case_xml(f, def_, particles_, constants_, vtk_out, origin); });
                  log_.line();
                  log_.line("Particle limits:");
                  for (int axis = 0; axis < 3; ++axis)
                      log_.line(fmt::format("  {} range: {:g} to {:g} [m]", "XYZ"[axis],
                                            particles_.pos_min[axis], particles_.pos_max[axis]));
                  log_.line();
              });
        log_.line();
    }

    void save_free_points()
    {
        if (options_.save_free_points && !particles_.free_points.mk.empty())
            write("_FreePt.vtk", "",
                  [&](OutputFile& f) { write_free_points_vtk(f, particles_.free_points); });
        particles_.free_points = {};
    }

    /// Meshes go beside the result, as with GenCase; those outside the folder of the case stay
    /// where they are.
    void copy_meshes()
    {
        for (const MeshFileUse& mesh : mesh_files_)
        {
            const fs::path name(mesh.name);
            if (name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end())
                continue;
            const fs::path target = fs::path(options_.output).parent_path() / name;
            std::error_code error;
            if (fs::exists(target, error) && fs::equivalent(target, mesh.path, error)) continue;
            if (files_.has(target.string())) continue; // of another zone
            if (!target.parent_path().empty()) fs::create_directories(target.parent_path(), error);
            files_.copy(mesh.path, target.string());
            log_.line(fmt::format("Geometry file copied: {} (xml row:{})", mesh.name, mesh.line));
        }
    }

    /// Files that the solver reads go beside the result too, as with GenCase.
    void copy_data_files()
    {
        for (const DataFileUse& use : def_.data_files)
        {
            std::error_code ignored;
            const fs::path beside = fs::path(options_.input).parent_path() / use.name;
            const fs::path source = fs::exists(use.name, ignored) ? fs::path(use.name) : beside;
            const bool is_known =
                std::any_of(mesh_files_.begin(), mesh_files_.end(),
                            [&](const MeshFileUse& m) { return m.name == use.name; });
            if (fs::is_regular_file(source, ignored))
            {
                if (!is_known) mesh_files_.push_back({use.name, source.string(), use.line});
            }
            else
                warn(fmt::format("{}:{}: file '{}' was not found to be copied beside the result.",
                                 def_.file, use.line, use.name));
        }
    }

    /// A file of the zone that is made.
    template <typename Body>
    void write(const std::string& ending, const char* note, const Body& body)
    {
        files_.write(output_ + ending, note, log_, body);
    }

    static void write_shape_file(OutputFile& f, const ShapeFile& shape_file)
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
    void save_node_files()
    {
        for (const NodeFile& node_file : node_files_)
        {
            std::uint64_t faces = 1;
            write(node_file.name, "",
                  [&](OutputFile& f)
                  {
                      if (node_file.is_cells)
                          faces = write_shown_cells_vtk(f, node_file.cells, node_file.mk, threads_);
                      else
                          write_points_vtk(f, node_file.points);
                  });
            if (faces > 0) continue;
            files_.drop_last();
            log_.line(fmt::format("{}{} is empty and not saved", output_, node_file.name));
        }
        node_files_.clear();
    }

    void save_shapes(std::vector<VtkOutEntry>& vtk_out)
    {
        shape_files_ = collect_shape_files(scene_);
        for (const ShapeFile& shape_file : shape_files_)
        {
            write(shape_file.name, "", [&](OutputFile& f) { write_shape_file(f, shape_file); });
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
                (s.mk >= def_.mk_bound_first ? mk_bound : mk_fluid)
                    .push_back(s.mk - (s.mk >= def_.mk_bound_first ? def_.mk_bound_first
                                                                   : def_.mk_fluid_first));
            }
            vtk_out.push_back({fs::path(output_ + shape_file.name).filename().string(),
                               format_ranges(mk), format_ranges(mk_bound),
                               format_ranges(mk_fluid)});
        }
    }

    void make_normals()
    {
        if (!def_.normals.is_active) return;
        NormalsReport report;
        particles_.bound_normals =
            compute_normals(def_, particles_, normal_geometry(), threads_, report);
        shape_files_.clear();
        for (const std::string& line : report.log) log_.line(line);
        for (std::string& w : report.warnings) warn(std::move(w));
        if (!report.shapes.empty())
            write("_GeometryShapes.vtk", "",
                  [&](OutputFile& f) { write_shapes_vtk(f, report.shapes); });
    }

    /// The polygons that norgeometry asks for: those of a shape file of this run, or of a file that
    /// stands in the folder of the output, where GenCase looks for it, or beside the definition.
    std::vector<ShapePolygons> normal_geometry() const
    {
        if (!def_.normals.geometry) return {};
        const GeometryNormals& geometry = *def_.normals.geometry;
        for (const ShapeFile& shape_file : shape_files_)
            if (def_.case_name + shape_file.name == geometry.file) return shape_file.shapes;
        const fs::path beside = fs::path(options_.input).parent_path() / geometry.file;
        const fs::path in_output = fs::path(options_.output).parent_path() / geometry.file;
        std::error_code ignored;
        for (const fs::path& path : {in_output, beside})
            if (fs::exists(path, ignored)) return read_shapes_vtk(path.string());
        std::vector<std::string> names;
        for (const ShapeFile& shape_file : shape_files_)
            names.push_back(def_.case_name + shape_file.name);
        throw IoError(fmt::format(
            "{}:{}: <geometryfile file=\"{}\">: no such shape file; this case writes {}, and "
            "neither {} nor {} exists",
            def_.file, geometry.line, geometry.file,
            names.empty() ? "none (<shapeout> does)" : fmt::format("{}", fmt::join(names, ", ")),
            in_output.string(), beside.string()));
    }

    std::vector<ParticleType> types() const
    {
        std::vector<ParticleType> out(65536, ParticleType::Fixed);
        for (const ParticleBlock& b : particles_.blocks) out[b.mk] = b.type;
        return out;
    }

    /// With one name for both, Case.xml takes the place of the definition, as with GenCase; the
    /// definition is kept beside it.
    void keep_overwritten_definition()
    {
        const std::string source = options_.input + ".xml";
        const std::string target = output_ + ".xml";
        std::error_code error;
        if (!fs::exists(target, error) || !fs::equivalent(source, target, error)) return;
        const std::string kept = target + ".orig";
        if (!fs::exists(kept)) fs::copy_file(source, kept, error);
        if (error)
            throw IoError(
                fmt::format("{}: cannot keep a copy of the definition: {}", kept, error.message()));
        warn(
            fmt::format("{} is the definition and the output: it now holds the generated case, the "
                        "definition was "
                        "kept as {}.",
                        target, kept));
    }

    void warn(std::string text)
    {
        log_.warning(text);
        warnings_.push_back(std::move(text));
    }

    /// A warning where GenCase says nothing; with -strict an error.
    void warn_of_slip(std::string text)
    {
        slips_.push_back(text);
        warn(std::move(text));
    }

    void print_warnings()
    {
        if (warnings_.empty()) return;
        log_.line("[WARNINGS]");
        for (std::size_t i = 0; i < warnings_.size(); ++i)
            log_.line(fmt::format("{}. {}", i + 1, warnings_[i]));
        log_.line();
    }

    /// What went wrong goes into Case.out, unless one of an older run stands beside older results.
    void write_failed_log(const std::exception& error)
    {
        const std::string path = options_.output + ".out";
        std::error_code ignored;
        if (fs::exists(path, ignored)) return;
        files_.clear();
        try
        {
            const auto* known = dynamic_cast<const Error*>(&error);
            files_.add(path).append(
                fmt::format("{}\n*** Error: {}\n\nFinished execution (code={}).\n", log_.text(),
                            error.what(), known != nullptr ? known->exit_code() : 5));
            files_.commit(false);
        }
        catch (const std::exception&)
        {
            // The folder cannot be written: the error itself is what the user has to see.
        }
        files_.clear();
    }

    DropInOptions options_;
    int threads_;
    RunLog log_;
    std::string output_; ///< as options_.output, of the zone that is made
    CaseDef def_;
    Scene scene_; ///< of def_
    RunField field_;
    std::string relax_history_;
    CaseParticles particles_;
    CaseConstants constants_;
    ResultFiles files_;
    std::vector<MeshFileUse> mesh_files_;
    std::vector<ShapeFile> shape_files_; ///< until the normals are made
    std::vector<NodeFile> node_files_;
    std::vector<std::string> slips_; ///< those of the warnings that -strict takes for errors
    std::vector<std::string> warnings_;
};

void print_info()
{
    fmt::print(
        "{{ \"ShortName\" : \"GenCase\", \"FullName\" : \"{}\", \"Version\" : \"v{}\", \"Date\" : "
        "\"21-11-2026\", "
        "\"Features\" : {{ \"MaximumMkValues\" : 65000 }} }}\n",
        full_name(), version);
}

int write_clean_copy(const DropInOptions& options)
{
    const Element document = read_definition_tree(options.input + ".xml");
    OutputFile file(options.output + ".xml");
    file.append(print_document(document));
    file.commit();
    fmt::print("{}\n{}.xml\nFinished execution (code=0).\n", full_name(), options.output);
    return 0;
}

} // namespace

int run_drop_in(const DropInOptions& options)
{
    switch (options.action)
    {
        case DropInOptions::Action::Help:
            fmt::print("{}", help_text());
            return 0;
        case DropInOptions::Action::Version:
            fmt::print("{}\n", full_name());
            return 0;
        case DropInOptions::Action::Info:
            print_info();
            return 0;
        case DropInOptions::Action::Templates:
            fmt::print("{}\n", full_name());
            write_templates(options.output, options.overwrite);
            return 0;
        case DropInOptions::Action::Clean:
            return write_clean_copy(options);
        case DropInOptions::Action::Run:
            break;
    }
    return DropInRun(options).run();
}

} // namespace fppg
