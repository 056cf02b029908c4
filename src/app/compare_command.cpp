#include "app/compare_command.h"

#include "compare/report_words.h"

#include <fmt/format.h>
#include <algorithm>

#include "app/cloud_scene.h"
#include "app/drawn_geometry.h"
#include "app/stage_bar.h"
#include "app/subcommand_line.h"
#include "app/threads.h"
#include "fppg/compare.h"
#include "fppg/files.h"
#include "fppg/render.h"
#include "meshes/mesh_formats.h"
#include "report/scene.h"

#include <optional>

namespace fppg
{

namespace
{

/// Ways to change that pictures show, in the order of their colours.
constexpr const char* changes[] = {"missing", "extra", "moved", "another mk"};

constexpr std::size_t most_changed = 200000;
/// In grids, and mapped of the files.
constexpr std::uint64_t bytes_per_particle = 160;

struct CompareCall
{
    std::string a;
    std::string b;
    std::string json;
    std::string html;
    std::string definition;
    std::vector<std::string> of_run; ///< options that it is read with
    bool is_quiet = false;
    double memory_mib = 1536;
    CompareOptions options;
};

/// Reads the arguments; false when only the help was asked for.
bool read_arguments(std::vector<std::string> arguments, CompareCall& call)
{
    SubcommandLine app(
        "Says what differs between two results of one case, the largest differences first. A "
        "result is named without extension (Case.bi4 and Case.xml, or Case_All.vtk), or as one "
        "file .bi4 or .vtk. Exit code: 0 equal, 1 different, 2 not comparable.",
        "fppg compare");
    CompareOptions& options = call.options;
    app.add_option("A", call.a, "a result").required();
    app.add_option("B", call.b, "another one").required();
    app.add_option("--json", call.json, "all numbers, as JSON");
    app.add_option("--html", call.html, "a page with pictures and histograms, in one file");
    app.add_option("--stl", options.geometry,
                   "mesh in the place of the particles: how far they are from it; may be repeated. "
                   "Formats: " +
                       mesh_format_list())
        .may_be_repeated();
    app.add_option("--definition", call.definition,
                   "Case_Def whose boundaries are that mesh, where the case draws them; read with "
                   "the options behind --, such as -- -dp:0.01");
    app.add_option("--tolerance", options.same_place_dp, "two places are one within this, dp")
        .range(0.0, 0.5)
        .shows_default();
    app.add_option("--tolerance-density", options.density, "relative")
        .not_negative()
        .shows_default();
    app.add_option("--tolerance-velocity", options.velocity, "m/s").not_negative().shows_default();
    app.add_option("--tolerance-normal", options.normal_dp, "dp").not_negative().shows_default();
    app.add_option("--tolerance-constants", options.constants, "relative, of numbers in Case.xml")
        .not_negative()
        .shows_default();
    app.add_option("--examples", options.examples, "particles named of each kind of difference")
        .range(0, 100000)
        .shows_default();
    app.add_option("--memory", call.memory_mib, "MiB for particles; files of any size are compared")
        .range(1.0, 1e9)
        .shows_default();
    app.add_flag("--quiet", call.is_quiet,
                 "print nothing; the exit code says whether they are equal");
    app.add_option("--threads", options.threads,
                   "default 0: what the machine or its scheduler allows")
        .range(0, 4096);
    options.threads = 0;
    call.of_run = take_run_options(arguments);
    if (!app.read(arguments)) return false;
    if (options.threads == 0) options.threads = default_threads();
    options.particles_at_once = std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(call.memory_mib * (1 << 20)) / bytes_per_particle);
    if (!call.html.empty()) options.changed_at_most = most_changed;
    return true;
}

RenderOptions picture_options(const Comparison& comparison)
{
    RenderOptions options;
    options.width = 1600;
    options.height = 700;
    if (comparison.is_2d) options.view = parse_view("front");
    options.has_scale_bar = true;
    return options;
}

/// Colours of kinds stand for the ways to change.
std::uint8_t colour_of(ChangeKind kind)
{
    switch (kind)
    {
        case ChangeKind::Missing:
            return 0;
        case ChangeKind::Extra:
            return 1;
        case ChangeKind::Moved:
            return 2;
        default:
            return 3;
    }
}

void draw_changed(const Comparison& comparison, std::vector<ComparePicture>& pictures)
{
    if (comparison.changed.empty()) return;
    std::vector<ParticleCloud> clouds(2);
    for (const std::size_t f : {0U, 1U})
    {
        clouds[f].file = comparison.files[f].path;
        clouds[f].dp = comparison.dp;
        for (const ChangedParticle& p : comparison.changed)
        {
            if (p.kind == (f == 0 ? ChangeKind::Extra : ChangeKind::Missing)) continue;
            clouds[f].positions.push_back(p.position[f]);
            clouds[f].mk.push_back(p.mk[f]);
            clouds[f].kind.push_back(colour_of(p.kind));
        }
    }
    RenderOptions options = picture_options(comparison);
    options.colour = RenderColour::Kind;
    std::vector<std::pair<std::string, std::string>> legend;
    for (std::size_t c = 0; c < std::size(changes); ++c)
        legend.emplace_back(hex_of(colour_of_kind(static_cast<std::uint8_t>(c))), changes[c]);
    pictures.push_back(
        {fmt::format("Only what differs{}, A on the left, B on the right:",
                     comparison.changed.size() < most_changed ? "" : " (the first 200,000)"),
         legend, png_bytes(render_particles(clouds, options, comparison.options.threads), true)});
}

/// What differs in one file, a part a way to change.
SceneSet scene_of_changed(const Comparison& comparison, std::size_t f)
{
    SceneSet set;
    set.name = f == 0 ? "A, only what differs" : "B, only what differs";
    set.dp = comparison.dp;
    for (std::size_t c = 0; c < std::size(changes); ++c)
        set.parts.push_back({changes[c], hex_of(colour_of_kind(static_cast<std::uint8_t>(c))), {}});
    for (const ChangedParticle& p : comparison.changed)
        if (p.kind != (f == 0 ? ChangeKind::Extra : ChangeKind::Missing))
            set.parts[colour_of(p.kind)].positions.push_back(p.position[f]);
    std::erase_if(set.parts, [](const ScenePart& part) { return part.positions.empty(); });
    return set;
}

/// Both results side by side, to be turned.
std::string view_of(const Comparison& comparison)
{
    const auto clouds = clouds_for_picture(comparison, most_in_scene);
    std::vector<std::string> sets;
    std::vector<SceneView> views;
    std::string title = "all particles";
    if (clouds[0].dp > comparison.dp)
        title = fmt::format("one of every mk in cubes of {:g} dp", clouds[0].dp / comparison.dp);
    if (clouds[0].positions.size() + clouds[1].positions.size() > 0)
    {
        sets = {to_json(scene_by_mk(clouds[0], "A")), to_json(scene_by_mk(clouds[1], "B"))};
        views = {{title, {0, 1}}};
    }
    if (!comparison.changed.empty())
    {
        views.push_back({"only what differs", {sets.size(), sets.size() + 1}});
        for (const std::size_t f : {0U, 1U})
            sets.push_back(to_json(scene_of_changed(comparison, f)));
    }
    return scene_html(sets, views);
}

/// The mks of both files with their colours.
std::vector<std::pair<std::string, std::string>> mk_legend(const Comparison& comparison,
                                                           const std::vector<ParticleCloud>& clouds)
{
    std::vector<std::pair<std::string, std::string>> legend;
    for (const MkComparison& of : comparison.mks)
    {
        // What it is in A, or where A has none in B.
        const int type = of.type[0] >= 0 ? of.type[0] : of.type[1];
        Rgb colour = colour_of_mk(of.mk, type < 0 ? unknown_type : static_cast<std::uint8_t>(type));
        for (const std::size_t f : {1U, 0U})
            if (const auto own = clouds[f].colours.find(of.mk); own != clouds[f].colours.end())
                colour = own->second;
        legend.emplace_back(
            hex_of(colour),
            fmt::format("mk {}{}", of.mk,
                        type < 0 ? "" : fmt::format(" {}", particle_type_name(type))));
    }
    if (legend.size() > 30) legend.resize(30);
    return legend;
}

std::vector<ComparePicture> draw_pictures(const Comparison& comparison)
{
    std::vector<ComparePicture> pictures;
    const int threads = comparison.options.threads;
    {
        const auto both = clouds_for_picture(comparison, most_in_picture);
        const std::vector<ParticleCloud> clouds(both.begin(), both.end());
        RenderOptions options = picture_options(comparison);
        std::string thinned;
        if (clouds[0].dp > comparison.dp)
            thinned = fmt::format("; one particle of every mk in cubes of {:g} dp",
                                  clouds[0].dp / comparison.dp);
        if (clouds[0].positions.empty() && clouds[1].positions.empty()) return pictures;
        pictures.push_back({"A on the left, B on the right, by mk" + thinned + ":",
                            mk_legend(comparison, clouds),
                            png_bytes(render_particles(clouds, options, threads), true)});
        Box3 bounds;
        for (const ComparedFile& file : comparison.files)
            if (!file.bounds.is_empty())
            {
                bounds.add(file.bounds.min);
                bounds.add(file.bounds.max);
            }
        if (!comparison.is_2d)
        {
            // From a plane between layers, so that rounding does not decide what is cut.
            const double middle = 0.5 * (bounds.min.y + bounds.max.y) - 0.25 * comparison.dp;
            options.cuts = {{1, true, middle}};
            options.view = parse_view("front");
            pictures.push_back({fmt::format("Cut at y = {:.4g} m", middle) + thinned + ":",
                                mk_legend(comparison, clouds),
                                png_bytes(render_particles(clouds, options, threads), true)});
        }
    }
    draw_changed(comparison, pictures);
    return pictures;
}

} // namespace

int run_compare(const std::vector<std::string>& arguments)
{
    CompareCall call;
    if (!read_arguments(arguments, call)) return 0;
    try
    {
        // The files are made first: a folder that cannot be written is found before the work.
        std::optional<OutputFile> json;
        std::optional<OutputFile> html;
        if (!call.json.empty()) json.emplace(call.json);
        if (!call.html.empty()) html.emplace(call.html);
        std::optional<StageBar> bar(std::in_place, "compare", !call.is_quiet);
        if (!call.definition.empty())
            call.options.surface =
                drawn_geometry(call.definition, call.of_run, call.options.threads);
        const Comparison comparison = compare_results(call.a, call.b, call.options);
        if (json)
        {
            json->append(to_json(comparison));
            json->commit();
        }
        if (html)
        {
            bar.reset();
            bar.emplace("pictures", !call.is_quiet);
            html->append(to_html(comparison, draw_pictures(comparison), view_of(comparison)));
            html->commit();
        }
        bar.reset();
        if (!call.is_quiet) fmt::print("{}", to_text(comparison));
        return comparison.is_equal() ? 0 : 1;
    }
    catch (const Interrupted&)
    {
        throw;
    }
    catch (const Error& error)
    {
        throw CompareError(error.what());
    }
}

} // namespace fppg
