#include "app/relax_stage.h"

#include "fppg/files.h"
#include "fppg/relax_walls.h"

#include "app/fluid_space_log.h"
#include "app/run_state.h"
#include "app/stage_bar.h"
#include "app/stopwatch.h"
#include "app/thousands.h"
#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fppg
{
namespace
{

/// How long the part of a relaxation that runs may last, from the mean time of its iterations.
class TimeLeft
{
public:
    /// To be called after every iteration, with the seconds since some start.
    void note(const RelaxStep& step, double now)
    {
        // The first iteration of a part has its preparation with it and does not count.
        if (step.iteration > 1) return;
        first_end_ = now;
        if (step.piece == 1) begin_ = now;
        of_piece_ = step.piece > 1 ? (now - begin_) / static_cast<double>(step.piece - 1) : 0;
    }
    double seconds(const RelaxStep& step, double now) const
    {
        const double mean = (now - first_end_) / std::max(1, step.iteration - 1);
        const double of_this = mean * (step.last_iteration - step.iteration);
        // Until a piece is done, all are taken for as long as this one.
        const double of_others = of_piece_ > 0 ? of_piece_ : now - first_end_ + of_this;
        return of_this + of_others * static_cast<double>(step.pieces - step.piece);
    }

private:
    double first_end_ = 0;
    double begin_ = 0;
    double of_piece_ = 0; ///< mean of those that are done
};

/// Without commas, as it stands in a table.
std::string name_of(const RelaxStep& step)
{
    return step.pieces > 1 ? fmt::format("{} ({} of {})", step.what, step.piece, step.pieces)
                           : step.what;
}

void log_relaxed(const RelaxedPart& part, RunLog& log)
{
    if (part.mean == 0)
    {
        log.line(fmt::format("Relaxed {}: no particle that may move", part.what));
        return;
    }
    const bool is_surface = part.what == "surface";
    std::string text = fmt::format(
        "Relaxed {}: {} particles, {} iterations, {} {:.4f}, coefficient of variation {:.4f}",
        part.what, thousands(part.particles), part.iterations, is_surface ? "spacing" : "density",
        part.mean, part.variation);
    if (part.variation_before > 0) text += fmt::format(" (before: {:.4f})", part.variation_before);
    if (is_surface)
        text += fmt::format(", {:.4f} of smooth places, nearest pair {:.2f} dp",
                            part.smooth_variation, part.nearest_pair_dp);
    if (part.inserted + part.removed > 0)
        text += fmt::format(", {} inserted, {} removed", part.inserted, part.removed);
    log.text_line(text);
    Json fields{
        {"what", part.what},      {"particles", part.particles}, {"iterations", part.iterations},
        {"mean", part.mean},      {"variation", part.variation}, {"inserted", part.inserted},
        {"removed", part.removed}};
    if (is_surface)
    {
        fields["smooth_variation"] = part.smooth_variation;
        fields["nearest_pair_dp"] = part.nearest_pair_dp;
    }
    log.fact("relaxed", fields);
}

/// Fluid that is more or less than the case drew or filled.
void warn_of_fluid_count(const RelaxedPart& part, const RelaxReport& report, CaseRunState& run,
                         const std::string& file)
{
    double more = static_cast<double>(part.inserted) - static_cast<double>(part.removed);
    for (const auto& [mk, count] : report.space.left_out) more -= static_cast<double>(count);
    const double share = more / (static_cast<double>(part.particles) - more);
    if (std::abs(share) < 0.001) return;
    run.warn(fmt::format(
        "{}: {:+g} particles of fluid near walls ({:+.2f} % of them): as many as fit between the "
        "walls, none in pockets. <fluidband active=\"false\"> leaves fluid as it is drawn; litres "
        "of fills keep their number.",
        file, more, 100 * share));
}

} // namespace

std::string layers_text(const FittedWalls& walls, std::size_t body,
                        const std::function<std::string(std::size_t)>& text_of)
{
    std::vector<std::string> layers;
    for (std::size_t l = body + 1; l < walls.bodies.size(); ++l)
    {
        if (walls.bodies[l].owner != body) continue;
        const auto number = static_cast<std::size_t>(walls.bodies[l].layer);
        layers.resize(std::max(layers.size(), number + 1));
        layers[number] += (layers[number].empty() ? "" : " and ") + text_of(l);
    }
    // The first of DBC stands on the surface.
    if (!layers.empty() && layers[0].empty()) layers[0] = text_of(body);
    return fmt::format("{}", fmt::join(layers, ", "));
}

/// Of the particles in the sheets of a plate, dp.
static double spacing_along(const FittedBody& body, double dp, bool is_2d)
{
    const double area = dp * body.sheets / body.thickness;
    return is_2d ? area : std::sqrt(area);
}

void log_fitted_walls(const RunField& field, RunLog& log)
{
    const FittedWalls& walls = field.walls;
    const double dp = field.grid.dp;
    std::vector<std::array<std::uint64_t, 3>> counts(walls.bodies.size());
    for (std::size_t i = 0; i < walls.particles.size(); ++i)
        ++counts[walls.particles.bodies[i]][static_cast<std::size_t>(walls.particles.kinds[i])];
    log.line("Body-fitted walls:");
    for (std::size_t b = 0; b < walls.bodies.size(); ++b)
    {
        const FittedBody& body = walls.bodies[b];
        if (body.is_layer()) continue;
        // In lines of layers all kinds are of all layers.
        std::array<std::uint64_t, 3> all{};
        for (std::size_t l = b; l < walls.bodies.size(); ++l)
            for (std::size_t kind = 0; kind < 3 && (l == b || walls.bodies[l].owner == b); ++kind)
                all[kind] += counts[l][kind];
        const std::string layers =
            layers_text(walls, b,
                        [&](std::size_t l)
                        { return fmt::format("{}", counts[l][0] + counts[l][1] + counts[l][2]); });
        log.line(fmt::format("  {} (xml row:{}, mk:{}): {} corner, {} edge, {} surface particles{}",
                             body.name, body.line, body.mk, all[0], all[1], all[2],
                             layers.empty() ? "" : ", in layers of " + layers));
        if (!body.continued_along.empty())
            log.line(fmt::format("    goes on over the period along {}",
                                 fmt::join(body.continued_along, " and ")));
        if (body.sheets > 0)
            log.line(fmt::format(
                "    {} through its thickness of {:.4g} dp: {:.4g} dp apart across ({:+.3g} %), "
                "{:.4g} dp along",
                counted(static_cast<std::size_t>(body.sheets), "sheet", "sheets"),
                body.thickness / dp, body.thickness / body.sheets / dp,
                100 * (body.thickness / body.sheets / dp - 1),
                spacing_along(body, dp, field.grid.is_2d)));
        if (body.measures.filled > 0)
            log.line(fmt::format(
                "    volume {:g}, area {:g}, clearance {:.3f} dp inside, {:.3f} dp outside",
                body.measures.volume, body.measures.area + body.measures.second_sheet,
                body.clearance_inside / dp, body.clearance_outside / dp));
    }
    log.line();
}

void log_left_out(const FittedWalls& walls, RunLog& log)
{
    bool is_first = true;
    for (const FittedBody& body : walls.bodies)
    {
        const auto& [corners, edges, surface] = body.left_out;
        if (corners + edges + surface == 0) continue;
        if (is_first)
            log.text_line(
                fmt::format("Left out, as others are nearer than {:g} dp:", least_pair_dp));
        is_first = false;
        log.text_line(
            fmt::format("  {} (xml row:{}, mk:{}): {} corner, {} edge, {} surface particles",
                        body.name, body.line, body.mk, corners, edges, surface));
        log.fact("left_out", {{"line", body.line},
                              {"mk", body.mk},
                              {"corners", corners},
                              {"edges", edges},
                              {"surface", surface}});
    }
    if (!is_first) log.text_line();
}

void run_relaxation(CaseRunState& run, MadeCase& made)
{
    RelaxReport report;
    const Stopwatch time;
    int snapshots = 0;
    TimeLeft left;
    made.relax_history = "what,iteration,particles,mean,deviation,largest_step_dp\n";
    const auto observe = [&](const RelaxStep& step)
    {
        const double now = time.seconds();
        left.note(step, now);
        made.relax_history +=
            fmt::format("{},{},{},{:.6f},{:.6f},{:.6f}\n", name_of(step), step.iteration,
                        step.particles, step.mean, step.variation, step.largest_step_dp);
        const double rest = left.seconds(step, now);
        run.progress(now + rest > 0 ? now / (now + rest) : 0,
                     fmt::format("{}: {} of at most {}, variation {:.3f}, largest step {:.3f} dp",
                                 name_of(step), step.iteration, step.last_iteration, step.variation,
                                 step.largest_step_dp));
        return true;
    };
    const auto snapshot = [&](int iteration, const WallParticles& particles)
    {
        OutputFile& file = run.files.add(fmt::format("{}_Relax_{:04}.vtk", made.output, iteration));
        write_wall_particles_vtk(file, particles);
        file.finish();
        ++snapshots;
    };
    relax_walls(made.def, made.field, run.threads, observe, report, snapshot);
    for (const RelaxedPart& part : report.parts)
    {
        log_relaxed(part, run.log);
        if (part.what == "fluid") warn_of_fluid_count(part, report, run, made.def.file);
    }
    log_fluid_space(report, made, run);
    settle_fluid_mass(report, made, run.log);
    if (snapshots > 0 && run.files.are_written())
        run.log.line(
            fmt::format("{}_Relax_*.vtk: {} VTK files of the relaxation", made.output, snapshots));
    for (const std::string& w : report.warnings) run.warn(fmt::format("{}:{}", made.def.file, w));
}

} // namespace fppg
