#include "batch/estimate.h"

#include "fppg/balance.h"
#include "fppg/error.h"
#include "fppg/features.h"
#include "fppg/lattice.h"
#include "fppg/scene.h"

#include "batch/estimated_work.h"
#include "batch/fluid_near_walls.h"
#include "batch/layer_counts.h"
#include "batch/machine_speed.h"
#include "batch/particle_limit.h"
#include "batch/rates.h"
#include "core/even_places.h"
#include "core/json.h"
#include "lattice/mesh_units.h"
#include "meshes/outline.h"
#include "scene/near_domain.h"
#include "walls/fast_walls.h"
#include "walls/fluid_boxes.h"
#include "walls/layer_builder.h"
#include "walls/part_in_domain.h"
#include "walls/step_surfaces.h"
#include "walls/thickened.h"
#include "walls/true_surfaces.h"
#include "walls/wall_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <set>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;

/// The area of shapes that reach out of the domain is found with this many points.
constexpr double area_samples = 20000;
/// Particles on a surface, as a multiple of area / dp^2 with density="cell": between 1.0 and 1.7
/// by the tilt of the surface.
constexpr double cell_density = 1.5;

/// What a body-fitted mk counts.
struct WallCount
{
    double on_surface = 0;
    double on_lines = 0;
    double in_layers = 0;      ///< behind them
    double laid_layers = 0;    ///< of all that is laid, beyond the domain too
    double layered_lines = 0;  ///< likewise: those on lines, on surfaces with layers
    double cut_area = 0;       ///< a dp^2 of surfaces with layers, less where cells are coarse
    double cut_particles = 0;  ///< of laid_layers, likewise
    double search_seconds = 0; ///< to lay layers, on one thread
    double inside = 0;
    double relaxed = 0; ///< of those on surfaces and in layers
    double in_band = 0; ///< of those inside, that are relaxed too
};

class Estimator
{
public:
    Estimator(const std::string& path, const EstimateOptions& options) : options_(options)
    {
        const auto start = std::chrono::steady_clock::now();
        def_ = read_case(path, options.case_options);
        scene_ = make_scene(def_);
        if (!def_.fit.is_empty())
            fast_ = mks_of_fast_walls(scene_, boxes_of_fluid(scene_, options_.threads),
                                      options_.threads);
        CaseOptions coarse = options_.case_options;
        coarse.meshes = scene_.meshes;
        expect_particles_fit(path, coarse, def_, options_.threads);
        expect_metres(scene_, options_.threads);
        for (std::string& w : draw_shells_around_fluid(scene_, options_.threads, def_))
            def_.hints.push_back(std::move(w));
        draw_true_surfaces(scene_, options_.threads, def_);
        out_.definition = path;
        out_.dp = def_.grid.dp;
        out_.nodes = def_.grid.n;
        draw();
        work_.draw_seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (!def_.grid.is_2d)
            for (const SceneStep& step : scene_.remaining()) count_wall(step);
        count_blocks();
        add_up();
    }

    Estimate take() { return std::move(out_); }

private:
    /// Draws all on the lattice, body-fitted walls too.
    void draw()
    {
        CaseDef on_lattice = def_;
        on_lattice.fit = {};
        on_lattice.fluid_bands.clear();
        LatticeReport report;
        RunField field = draw_on_lattice(scene_, options_.threads, {}, report);
        work_.runs = static_cast<double>(runs_of_nodes(field));
        fluid_ = sample_fluid(field, def_.mk_bound_first);
        add_point_files(scene_, field, report);
        CaseConstants constants;
        std::vector<std::string> warnings;
        const CaseParticles particles =
            make_particles(on_lattice, field, options_.threads, constants, warnings);
        for (const ParticleBlock& block : particles.blocks)
            out_.blocks.push_back({block.type, block.mk, block.count, true});
        out_.triangles = report.triangles;
        work_.triangles = static_cast<double>(report.triangles);
        for (const auto* list : {&def_.warnings, &def_.hints, &report.warnings, &warnings})
            out_.warnings.insert(out_.warnings.end(), list->begin(), list->end());
        note_files(report);
    }

    /// Without those that particles of fitted walls cover, which stand at their surfaces.
    std::uint64_t runs_of_nodes(const RunField& field) const
    {
        constexpr std::uint32_t longest_covered = 2;
        std::vector<char> is_fitted(65536, 0);
        for (std::uint32_t mk = 0; mk < is_fitted.size(); ++mk)
            is_fitted[mk] = fit_settings(def_.fit, static_cast<std::uint16_t>(mk)) != nullptr;
        std::uint64_t count = 0;
        for (const auto& slab : field.slabs)
            for (const Run& run : slab)
                count += is_fitted[run.mk] == 0 || run.z_end - run.z_begin > longest_covered;
        return count;
    }

    void note_files(const LatticeReport& report)
    {
        const auto note = [this](const fs::path& path)
        {
            std::error_code ignored;
            if (!fs::is_regular_file(path, ignored)) return false;
            out_.files.push_back(fs::absolute(path).lexically_normal().string());
            return true;
        };
        const fs::path folder = fs::path(out_.definition).parent_path();
        for (const MeshFileUse& use : report.mesh_files) note(use.path);
        for (const DataFileUse& use : def_.data_files)
            if (!note(use.name)) note(folder / use.name);
        note_attributes(read_definition_tree(out_.definition), note, folder);
        std::sort(out_.files.begin(), out_.files.end());
        out_.files.erase(std::unique(out_.files.begin(), out_.files.end()), out_.files.end());
    }

    /// Whatever the definition names that is a file counts as one that it reads: tables of
    /// properties, geometry for normals.
    template <typename Note>
    static void note_attributes(const Element& e, const Note& note, const fs::path& folder)
    {
        for (const Element::Attribute& a : e.attributes)
            if (a.value.find('.') != std::string::npos && a.value.size() < 1024 && !note(a.value))
                note(folder / a.value);
        for (const Element& child : e.children) note_attributes(child, note, folder);
    }

    void count_wall(const SceneStep& step)
    {
        const DrawState& state = *step.draw->state;
        if (state.mk.kind != MkKind::Bound || !state.draw_points ||
            (!step.combination && state.mode == DrawMode::Wire))
            return;
        const FitSettings* given = fit_settings(def_.fit, state.mk.mk);
        if (given == nullptr) return;
        FitSettings settings = *given;
        if (fluid_.empty() || !may_layer_sheets(step, fast_)) settings.sheet_depths_dp.clear();
        const std::optional<DrawOp> shorter = made_near_domain(*step.draw, def_);
        SceneStep near = step;
        if (shorter) near.draw = &*shorter;
        for (const StepSurface& surface : fitted_surfaces(scene_, near, options_.threads))
        {
            const WallCount count = count_shape(surface.shape, state.clips, settings);
            work_.most_cut = std::max(work_.most_cut, count.cut_area);
            for (const auto& [mk, share] : mk_shares(surface, state.mk.mk))
            {
                WallCount& wall = walls_[mk];
                wall.on_surface += share * count.on_surface;
                wall.on_lines += share * count.on_lines;
                wall.in_layers += share * count.in_layers;
                wall.laid_layers += share * count.laid_layers;
                wall.layered_lines += share * count.layered_lines;
                wall.cut_area += share * count.cut_area;
                wall.cut_particles += share * count.cut_particles;
                wall.search_seconds += share * count.search_seconds;
                wall.inside += share * count.inside;
                wall.relaxed += share * count.relaxed;
                wall.in_band += share * count.in_band;
            }
            const auto facets = static_cast<double>(surface.shape.soup.size());
            work_.facets += facets;
            if (count.in_layers > 0) work_.layered_facets += facets;
            const std::vector<Vec3>& corners = surface.shape.soup.vertices;
            surfaces_.vertices.insert(surfaces_.vertices.end(), corners.begin(), corners.end());
        }
    }

    /// How much of a surface each mk has, by area.
    static std::map<std::uint16_t, double> mk_shares(const StepSurface& surface, std::uint16_t mk)
    {
        if (surface.facet_mk.empty()) return {{mk, 1.0}};
        std::map<std::uint16_t, double> out;
        double all = 0;
        const std::vector<Vec3>& v = surface.shape.soup.vertices;
        for (std::size_t f = 0; f < surface.facet_mk.size(); ++f)
        {
            const double area = norm(cross(v[3 * f + 1] - v[3 * f], v[3 * f + 2] - v[3 * f]));
            out[surface.facet_mk[f]] += area;
            all += area;
        }
        for (auto& share : out) share.second /= all;
        return out;
    }

    WallCount count_shape(const ShapeMesh& shape, const std::vector<ClipPlane>& clips,
                          const FitSettings& settings)
    {
        WallCount count;
        if (shape.soup.size() == 0) return count;
        const double dp = def_.grid.dp;
        MeshReport report;
        const SurfaceMesh mesh = repair_mesh(shape.soup, {.dp = dp, .is_solid = shape.is_solid},
                                             options_.threads, report);
        const Features features =
            find_features(mesh, {.angle_deg = settings.feature_angle_deg, .dp = dp});
        double length = 0;
        for (const FeatureLine& line : features.lines) length += line.length;
        const double share = share_inside(mesh, clips);
        const double laid =
            share_laid(mesh, shape.round != nullptr, settings, def_.grid, options_.threads);
        const double beyond = share > 0 ? laid / share : 0; // of what the domain has
        const double density = settings.density == FitDensity::Cell ? cell_density : 1;
        const double on_area = share * density * report.area / (dp * dp);
        count.on_lines = share * (length / dp + static_cast<double>(features.singular.size()));
        const bool is_on_surface = settings.depths_dp.empty() || settings.depths_dp[0] == 0;
        if (is_on_surface) count.on_surface = std::max(count.on_lines, on_area);
        const double volume = share * std::abs(report.volume) / (dp * dp * dp);
        if (shape.is_solid)
            count.in_layers = on_area * layers_of(settings.depths_dp, report, dp);
        else
            count.in_layers =
                on_area * layers_outside(settings.depths_dp.empty() ? settings.sheet_depths_dp
                                                                    : settings.depths_dp,
                                         mesh, dp);
        if (shape.is_solid && report.is_watertight)
            count.in_layers = std::min(count.in_layers, volume);
        if (count.in_layers > 0)
        {
            const double finer =
                offset_cell_dp /
                (settings.place == Placement::Inside ? offset_cell_dp : layer_cell_dp(mesh, dp));
            count.laid_layers = beyond * count.in_layers;
            count.layered_lines = beyond * count.on_lines;
            count.search_seconds =
                search_seconds(mesh, report, settings, shape.is_solid, count.laid_layers, laid);
            count.cut_area = finer * finer * beyond * on_area;
            count.cut_particles = finer * finer * count.laid_layers;
        }
        if (settings.relax.is_active) count.relaxed = beyond * (count.on_surface + count.in_layers);
        if (shape.is_solid)
            count.inside = std::max(0.0, volume - count.on_surface / 2 - count.in_layers);
        if (settings.relax.is_active)
            count.in_band = settings.place == Placement::Inside
                                ? count.inside
                                : std::min(count.inside, rates.band_particles * on_area);
        out_.wall_area += share * report.area;
        out_.line_length += share * length;
        return count;
    }

    /// What the searches among the facets take while layers are laid, on one thread.
    ///
    /// particles  of the layers
    /// laid       share of the mesh that has them
    double search_seconds(const SurfaceMesh& mesh, const MeshReport& report,
                          const FitSettings& settings, bool is_solid, double particles,
                          double laid) const
    {
        WallProbeOptions options;
        options.depths_dp =
            settings.depths_dp.empty() ? settings.sheet_depths_dp : settings.depths_dp;
        options.dp = def_.grid.dp;
        options.feature_angle_deg = settings.feature_angle_deg;
        options.is_closed = is_solid && report.is_watertight;
        const WallProbe probe = probe_wall(mesh, report, options, options_.threads);
        return probe.seconds_a_depth * particles *
                   (rates.depths_a_layer_particle + rates.depths_where_rough * probe.rough) +
               probe.seconds_a_ball * probe.balls * laid;
    }

    /// Fluid that is relaxed beside fitted walls, and what is balanced (balance.h).
    ///
    /// bound  particles of walls
    void count_fluid(double bound)
    {
        const auto fluid = static_cast<double>(out_.n_fluid);
        if (fluid == 0) return;
        const double dp = def_.grid.dp;
        const double h_dp = def_.h / dp;
        double width = 2 * h_dp + 1.5;
        for (const FluidBand& band : def_.fluid_bands) width = std::max(width, band.width_dp);
        const std::vector<double> distances =
            distances_to(surfaces_, fluid_, width * dp, options_.threads);
        for (const FluidBand& band : def_.fluid_bands)
            if (band.is_active)
                work_.relaxed_fluid = std::max(work_.relaxed_fluid,
                                               fluid * share_within(distances, band.width_dp * dp));
        if (!def_.balances()) return;
        const double share = share_within(distances, width * dp);
        const double near = fluid * share;
        work_.balanced_fluid = out_.n_fluid <= most_balanced_whole ? fluid : near;
        work_.balanced_walls = std::min(bound, std::ceil(2 * h_dp) * near / width);
        const double at_slanted = share_within(
            distances_to(slanted_facets(surfaces_), fluid_, width * dp, options_.threads),
            width * dp);
        work_.balanced_steps = steps_to_balance(
            def_, work_.balanced_fluid, {holds_fluid(), share > 0 ? at_slanted / share : 0});
    }

    /// Single sheets do not hold fluid at rest; lines of 2D cases are not counted.
    bool holds_fluid() const
    {
        return def_.grid.is_2d ||
               std::any_of(walls_.begin(), walls_.end(),
                           [](const auto& wall)
                           { return wall.second.inside > 0 || wall.second.in_layers > 0; });
    }

    bool is_inside(const Vec3& p, const std::vector<ClipPlane>& clips) const
    {
        const LatticeGrid& grid = def_.grid;
        for (int axis = 0; axis < 3; ++axis)
        {
            const double at = (p[axis] - grid.origin[axis]) / grid.step(axis);
            if (at < -0.5 || at > grid.n[static_cast<std::size_t>(axis)] - 0.5) return false;
        }
        return std::all_of(clips.begin(), clips.end(),
                           [&](const ClipPlane& clip)
                           { return dot(p - clip.point, clip.normal) <= 0; });
    }

    /// How much of the area of a mesh lies in the domain and inside the clips; beside clips by
    /// points spread evenly over it.
    double share_inside(const SurfaceMesh& mesh, const std::vector<ClipPlane>& clips) const
    {
        if (clips.empty() && std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                                         [&](const Vec3& v) { return is_inside(v, clips); }))
            return 1;
        const double area = std::accumulate(mesh.areas.begin(), mesh.areas.end(), 0.0);
        const Box3 domain = box_around(def_.grid, 0.5);
        double inside = 0;
        for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        {
            const auto& [a, b, c] = mesh.facets[f];
            const std::array<Vec3, 3> corners{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
            if (clips.empty())
            {
                inside += area_in_box(domain, corners.data());
                continue;
            }
            const int samples = std::max(1, static_cast<int>(area_samples * mesh.areas[f] / area));
            int found = 0;
            for (int i = 0; i < samples; ++i) // from the middle of the facet
                found += static_cast<int>(is_inside(even_on_facet(corners, i, 1.0 / 3), clips));
            inside += mesh.areas[f] * found / samples;
        }
        return area > 0 ? inside / area : 1;
    }

    static std::uint64_t all_of(const WallCount& wall)
    {
        return static_cast<std::uint64_t>(wall.on_surface + wall.in_layers + wall.inside);
    }

    void count_blocks()
    {
        for (EstimatedBlock& block : out_.blocks)
        {
            if (block.type == ParticleType::Fluid) continue;
            if (fit_settings(def_.fit, block.mk) == nullptr) continue;
            const auto wall = walls_.find(block.mk);
            block.is_exact = wall == walls_.end() && !def_.grid.is_2d;
            if (wall != walls_.end()) block.count = all_of(wall->second);
        }
        for (const auto& [mk, wall] : walls_)
        {
            out_.n_wall += static_cast<std::uint64_t>(wall.on_surface + wall.in_layers);
            out_.n_line += static_cast<std::uint64_t>(wall.on_lines);
            work_.on_surfaces += wall.on_surface;
            work_.laid_layers += wall.laid_layers;
            work_.search_seconds += wall.search_seconds;
            work_.layered_lines += wall.layered_lines;
            work_.cut_area += wall.cut_area;
            work_.cut_particles += wall.cut_particles;
            work_.relaxed += wall.relaxed;
            work_.in_band += wall.in_band;
            const auto is_it = [mk = mk](const EstimatedBlock& b) { return b.mk == mk; };
            // A shape so thin that no node is near it.
            if (std::none_of(out_.blocks.begin(), out_.blocks.end(), is_it))
                out_.blocks.push_back({ParticleType::Fixed, mk, all_of(wall), false});
        }
        out_.is_exact = std::all_of(out_.blocks.begin(), out_.blocks.end(),
                                    [](const EstimatedBlock& b) { return b.is_exact; });
    }

    void add_up()
    {
        for (const EstimatedBlock& block : out_.blocks)
        {
            out_.np += block.count;
            switch (block.type)
            {
                case ParticleType::Fixed:
                    out_.n_fixed += block.count;
                    break;
                case ParticleType::Moving:
                    out_.n_moving += block.count;
                    break;
                case ParticleType::Floating:
                    out_.n_floating += block.count;
                    break;
                case ParticleType::Fluid:
                    out_.n_fluid += block.count;
                    break;
            }
        }
        const auto np = static_cast<double>(out_.np);
        const auto bound = static_cast<double>(out_.np - out_.n_fluid);
        const auto walls = static_cast<double>(out_.n_wall);
        const double vtk = rates.vtk_bytes + (walls > 0 ? rates.wall_vtk_bytes : 0);
        if (options_.saves_bi4)
            out_.output_bytes +=
                np * rates.bi4_bytes + (def_.normals.is_active ? bound * rates.normal_bytes : 0);
        if (options_.saves_all) out_.output_bytes += np * vtk;
        if (options_.saves_parts) out_.output_bytes += np * vtk;

        if (def_.normals.is_active) work_.wall_particles_with_normals = bound;
        work_.output_bytes = out_.output_bytes;
        count_fluid(bound);
        out_.memory_bytes = memory_of(work_, options_.threads);
        out_.stages = seconds_of(work_, options_.threads, read_machine_speed().factor);
        out_.seconds = out_.stages.drawing + out_.stages.relaxing + out_.stages.balancing +
                       out_.stages.writing;
    }

    EstimateOptions options_;
    CaseDef def_;
    Scene scene_;                  ///< of def_
    std::set<std::uint16_t> fast_; ///< mks
    Estimate out_;
    std::map<std::uint16_t, WallCount> walls_; ///< by mk
    EstimatedWork work_;
    std::vector<Vec3> fluid_; ///< some of its nodes
    TriangleSoup surfaces_;   ///< of all fitted walls
};

const char* name_of(ParticleType type)
{
    static constexpr const char* names[] = {"fixed", "moving", "floating", "fluid"};
    return names[static_cast<std::size_t>(type)];
}

std::string size_text(double bytes)
{
    if (bytes >= 1e9) return fmt::format("{:.1f} GB", bytes / 1e9);
    return fmt::format("{:.0f} MB", std::max(1.0, bytes / 1e6));
}

std::string grouped(std::uint64_t n)
{
    std::string text = std::to_string(n);
    for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3)
        text.insert(static_cast<std::size_t>(at), 1, ',');
    return text;
}

} // namespace

Estimate estimate_case(const std::string& path, const EstimateOptions& options)
{
    return Estimator(path, options).take();
}

std::string to_text(const Estimate& e)
{
    const char* about = e.is_exact ? "" : "about ";
    std::string text;
    const auto line = [&text](const char* name, const std::string& value)
    { text += fmt::format("{:<12}{}\n", name, value); };
    line("Case", e.definition);
    line("Dp", fmt::format("{:g}, a domain of {} x {} x {} nodes", e.dp, e.nodes[0], e.nodes[1],
                           e.nodes[2]));
    line("Particles", fmt::format("{}{} (fixed {}, moving {}, floating {}, fluid {})", about,
                                  grouped(e.np), grouped(e.n_fixed), grouped(e.n_moving),
                                  grouped(e.n_floating), grouped(e.n_fluid)));
    for (const EstimatedBlock& block : e.blocks)
        line("", fmt::format("mk {:<4} {:<9}{}{}", block.mk, name_of(block.type),
                             block.is_exact ? "" : "about ", grouped(block.count)));
    if (e.n_wall > 0)
        line("Walls",
             fmt::format("body-fitted: {:.4g} m^2, about {} particles on them, of these "
                         "{} on {:.4g} m of edges",
                         e.wall_area, grouped(e.n_wall), grouped(e.n_line), e.line_length));
    line("Memory", "about " + size_text(e.memory_bytes));
    line("Files", "about " + size_text(e.output_bytes));
    const auto rounded = [](double seconds)
    { return fmt::format("{:.{}f} s", seconds, seconds < 10 ? 1 : 0); };
    line("Time",
         fmt::format("about {}: drawing {}, relaxing {}, balancing {}, writing {}",
                     rounded(e.seconds), rounded(e.stages.drawing), rounded(e.stages.relaxing),
                     rounded(e.stages.balancing), rounded(e.stages.writing)));
    for (const std::string& warning : e.warnings) line("Warning", warning);
    return text;
}

std::string to_json(const Estimate& e)
{
    Json blocks = Json::array();
    for (const EstimatedBlock& block : e.blocks)
        blocks.push_back({{"mk", block.mk},
                          {"type", name_of(block.type)},
                          {"count", block.count},
                          {"exact", block.is_exact}});
    const Json json = {{"definition", e.definition},
                       {"dp", e.dp},
                       {"nodes", e.nodes},
                       {"exact", e.is_exact},
                       {"particles", e.np},
                       {"fixed", e.n_fixed},
                       {"moving", e.n_moving},
                       {"floating", e.n_floating},
                       {"fluid", e.n_fluid},
                       {"blocks", blocks},
                       {"wall_area", e.wall_area},
                       {"line_length", e.line_length},
                       {"wall_particles", e.n_wall},
                       {"line_particles", e.n_line},
                       {"triangles", e.triangles},
                       {"memory_bytes", e.memory_bytes},
                       {"output_bytes", e.output_bytes},
                       {"seconds", e.seconds},
                       {"drawing_seconds", e.stages.drawing},
                       {"relaxing_seconds", e.stages.relaxing},
                       {"balancing_seconds", e.stages.balancing},
                       {"writing_seconds", e.stages.writing},
                       {"files", e.files},
                       {"warnings", e.warnings}};
    return json.text(2) + "\n";
}

} // namespace fppg
