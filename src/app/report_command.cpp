#include "app/report_command.h"

#include "app/cloud_scene.h"
#include "app/drawn_geometry.h"
#include "app/stage_bar.h"
#include "app/subcommand_line.h"
#include "app/threads.h"
#include "check/read_setup.h"
#include "compare/measure.h"
#include "compare/measure_result.h"
#include "compare/report_words.h"
#include "files/particle_source.h"
#include "files/thinned_cloud.h"
#include "fppg/check.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "fppg/motion_gaps.h"
#include "fppg/render.h"
#include "fppg/version.h"
#include "meshes/mesh_formats.h"
#include "report/html.h"
#include "report/result_look.h"
#include "report/run_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

namespace fppg
{

namespace
{

constexpr std::uint64_t particles_at_once = 4000000;
/// They are checked in memory, about 100 bytes each.
constexpr std::uint64_t most_checked = 50000000;
/// Fluid needs as much to flow between parts.
constexpr double marked_gap_dp = 3;

struct ReportCall
{
    std::vector<std::string> results;
    std::vector<std::string> geometry;
    std::vector<std::string> of_run; ///< options that the definition is read with
    std::string output = "report.html";
    std::string definition;
    std::string data;
    std::string picture;
    bool is_quiet = false;
    std::size_t particles = most_in_scene;
    int threads = 0;
};

/// The arguments behind "--" are those of the run; false when only the help was asked for.
bool read_arguments(std::vector<std::string> arguments, ReportCall& call)
{
    SubcommandLine app(
        "Makes a page of results in one file: pictures side by side, counts, histograms of "
        "spacing and of the distance to the surface, what fppg check finds, times, warnings, and "
        "particles in space that can be turned. A result is named without extension (Case.bi4 and "
        "Case.xml, or "
        "Case_All.vtk), or as one file .bi4 or .vtk.",
        "fppg report");
    app.add_option("RESULT", call.results, "one or more").required().expected(1, 1000);
    app.add_option("-o,--output", call.output, "the page").shows_default();
    app.add_option("--stl", call.geometry,
                   "mesh in the place of the particles: how far they are from it; may be repeated. "
                   "Formats: " +
                       mesh_format_list())
        .may_be_repeated();
    app.add_option("--definition", call.definition,
                   "Case_Def whose boundaries are that mesh, read with the options behind --, such "
                   "as -- -dp:0.01");
    app.add_option("--particles", call.particles, "in space, of each result, at most")
        .range(1000, 5000000)
        .shows_default();
    app.add_option("--picture", call.picture, "of one result: its picture as a file too, .png");
    app.add_option("--data", call.data, "of one result: what the page would hold, instead of it");
    app.add_flag("--quiet", call.is_quiet, "print nothing but errors");
    app.add_option("--threads", call.threads, "default 0: what the machine or its scheduler allows")
        .range(0, 4096);
    call.of_run = take_run_options(arguments);
    if (!app.read(arguments)) return false;
    if (call.results.size() > 1 && !(call.data.empty() && call.picture.empty()))
        throw UsageError("--data and --picture are of one result");
    if (call.threads == 0) call.threads = default_threads();
    return true;
}

TriangleSoup geometry_of(const ReportCall& call)
{
    TriangleSoup soup = read_geometry(call.geometry, call.threads);
    if (call.definition.empty()) return soup;
    const TriangleSoup walls = drawn_geometry(call.definition, call.of_run, call.threads);
    soup.vertices.insert(soup.vertices.end(), walls.vertices.begin(), walls.vertices.end());
    return soup;
}

std::string statistics_cells(const Statistics& statistics)
{
    if (statistics.count == 0) return "<td>-</td><td>-</td>";
    return fmt::format("<td>{:.4f} &plusmn; {:.4f}</td><td>{:.4f} to {:.4f}</td>", statistics.mean,
                       statistics.deviation, statistics.least, statistics.largest);
}

std::string table_of(const MeasuredResult& result)
{
    std::string html =
        "<div class=\"scroll\"><table><tr><th>mk</th><th>type</th><th>particles</th><th>spacing, "
        "dp</th><th></th><th>Shepard sum</th><th></th><th>to the surface, dp</th><th></th></tr>\n";
    for (const MeasuredMk& of : result.mks)
        html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td>{}{}{}</tr>\n", of.mk,
                            particle_type_name(of.type), grouped_digits(of.count),
                            statistics_cells(of.spacing_dp), statistics_cells(of.shepard),
                            statistics_cells(of.distance_dp));
    return html + "</table></div>\n";
}

/// Boundaries and fluid side by side.
std::string histograms_of(const MeasuredResult& result)
{
    using Histogram = std::array<std::uint64_t, Statistics::bins>;
    const auto draw =
        [&](const char* title, Statistics MeasuredMk::*statistics, const HistogramRange& range)
    {
        std::array<Histogram, 2> sums{};
        std::uint64_t count = 0;
        for (const MeasuredMk& of : result.mks)
        {
            const Statistics& one = of.*statistics;
            count += one.count;
            const bool is_fluid = of.type == static_cast<int>(ParticleType::Fluid);
            for (std::size_t b = 0; b < Statistics::bins; ++b)
                sums[is_fluid ? 1 : 0][b] += one.histogram[b];
        }
        return count == 0
                   ? ""
                   : histogram_svg(title, {{"a", sums[0]}, {"b", sums[1]}}, range.begin, range.end);
    };
    return "<p><svg width=\"12\" height=\"12\"><rect class=\"a\" width=\"12\" "
           "height=\"12\"/></svg> "
           "boundaries <svg width=\"12\" height=\"12\"><rect class=\"b\" width=\"12\" "
           "height=\"12\"/></svg> fluid</p>\n<div class=\"histograms\">\n" +
           draw("nearest particle, dp", &MeasuredMk::spacing_dp, spacing_range) +
           draw("Shepard sum", &MeasuredMk::shepard, shepard_range) +
           draw("distance to the surface, dp", &MeasuredMk::distance_dp, distance_range) +
           "</div>\n";
}

/// What fppg check finds; nothing of a picture file.
std::string checked_html(const std::string& name, const ParticleSource& source, int threads)
{
    if (!source.is_bi4()) return "";
    if (source.size() > most_checked)
        return fmt::format("<p>Not checked, with more than {} particles: fppg check does.</p>\n",
                           grouped_digits(most_checked));
    try
    {
        return to_html(check_case(name, threads));
    }
    catch (const CaseError& error)
    {
        return fmt::format("<p>Not checked: {}</p>\n", escaped_html(error.what()));
    }
}

/// Whether it is a case, not an output of the solver, whose parts have moved already.
bool is_case(const ParticleSource& source)
{
    namespace fs = std::filesystem;
    return source.xml() && fs::path(source.path()).stem() == fs::path(source.xml_path()).stem();
}

/// The motion of a case; of an output of the solver, whose parts have moved already, none.
std::vector<MovingBlock> motion_of_case(const ParticleSource& source, const Box3& bounds)
{
    if (!is_case(source)) return {};
    try
    {
        return read_setup(*source.xml(), source.xml_path(), bounds).moving;
    }
    catch (const CaseError&)
    {
        return {}; // the section of the check says what is wrong with the case
    }
}

/// Marks where parts of a case are near each other, by the definition or Case.xml. What to say
/// where that is not possible, or not known, as HTML.
std::string mark_gaps(SceneSet& set, const ParticleSource& source, const ReportCall& call)
{
    if (!is_case(source)) return "";
    MotionGapOptions options;
    options.dp = source.dp();
    options.threads = call.threads;
    std::string definition = source.xml_path();
    try
    {
        if (!call.definition.empty())
        {
            const DropInOptions run = parse_definition(call.definition, call.of_run);
            definition = run.input + ".xml";
            options.evars = run.evars;
        }
        const NearPlaces places =
            find_near_places(definition, options, frame_times(set), marked_gap_dp);
        add_marks(set, places, marked_gap_dp);
        std::string html;
        for (const std::string& note : places.notes)
            html += fmt::format("<p>Gaps: {}</p>\n", escaped_html(note));
        return html;
    }
    catch (const Error& error)
    {
        return fmt::format(
            "<p>Gaps between parts are not marked: {}. --definition names the definition beside "
            "its meshes.</p>\n",
            escaped_html(error.what()));
    }
}

ResultLook look_at(const std::string& name, const TriangleSoup& geometry, const ReportCall& call)
{
    const MeasuredResult result = measure_result(name, geometry, particles_at_once, call.threads);
    const ParticleSource source(name);
    ResultLook look;
    look.name = name;
    look.note = fmt::format(": {} particles, dp {:g} m", grouped_digits(result.np), result.dp);
    if (result.np > 0)
    {
        const ParticleCloud picture =
            thinned_cloud(source, result.bounds.min, result.dp, most_in_picture);
        RenderOptions options;
        options.width = 800;
        options.height = 600;
        options.opens_walls = options.has_scale_bar = options.has_legend = true;
        if (result.is_2d) options.view = parse_view("front");
        look.picture = png_bytes(render_particles({picture}, options, call.threads), true);
        SceneSet set =
            scene_by_mk(picture.positions.size() <= call.particles
                            ? picture
                            : thinned_cloud(source, result.bounds.min, result.dp, call.particles),
                        look.name);
        add_motion(set, motion_of_case(source, result.bounds));
        look.details = mark_gaps(set, source, call);
        look.set = to_json(set);
    }
    look.details += table_of(result) + histograms_of(result);
    look.details += checked_html(name, source, call.threads);
    if (const auto facts = facts_of_result(result.path)) look.details += run_facts_html(*facts);
    return look;
}

void write_file(const std::string& path, const std::string& bytes)
{
    OutputFile file(path);
    file.append(bytes);
    file.commit();
}

std::string page_of(const std::vector<ResultLook>& looks)
{
    return page_head("fppg report") + "<h1>" + (looks.size() == 1 ? "Result" : "Results") +
           "</h1>\n" + pictures_html(looks) + "<h2>In space</h2>\n" + views_html(looks) +
           "<h2>Particles</h2>\n" + details_html(looks) +
           fmt::format("<p>fppg {}</p>\n</body></html>\n", version);
}

} // namespace

int run_report(const std::vector<std::string>& arguments)
{
    ReportCall call;
    if (!read_arguments(arguments, call)) return 0;
    // Made first: a folder that cannot be written is found before the work.
    OutputFile file(call.data.empty() ? call.output : call.data);
    std::optional<StageBar> bar(std::in_place, "report", !call.is_quiet);
    const TriangleSoup geometry = geometry_of(call);
    std::vector<ResultLook> looks;
    for (const std::string& name : call.results)
    {
        StageBar::show(static_cast<double>(looks.size()) / static_cast<double>(call.results.size()),
                       name);
        looks.push_back(look_at(name, geometry, call));
    }
    bar.reset();
    if (!call.picture.empty()) write_file(call.picture, looks.front().picture);
    file.append(call.data.empty() ? page_of(looks) : to_json(looks.front()));
    file.commit();
    if (call.data.empty() && !call.is_quiet) fmt::print("{}\n", call.output);
    return 0;
}

} // namespace fppg
