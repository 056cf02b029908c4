#include "app/new_command.h"

#include "app/inspect.h"
#include "app/stage_bar.h"
#include "app/subcommand_line.h"
#include "app/threads.h"
#include "core/finite_number.h"
#include "core/length_units.h"
#include "core/text.h"
#include "core/text_table.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "fppg/generate.h"
#include "fppg/new_case.h"
#include "fppg/render.h"
#include "meshes/mesh_formats.h"
#include "platform/files.h"
#include "platform/terminal.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>

namespace fppg
{

namespace
{

namespace fs = std::filesystem;

/// Particles of the picture at most.
constexpr double picture_particles = 2.5e5;

struct NewCall
{
    NewCaseOptions options;
    std::string particles; ///< 500000, 500k or 2M
    double water = 0;
    double speed = 0;
    double duration = 0;
    std::vector<std::string> units;
    std::string picture;
    bool has_no_picture = false;
    bool explains = false;
    bool as_json = false;
    bool asks_nothing = false;
};

/// "2M", "500k" or a number.
double particle_count_of(const std::string& text)
{
    if (text.empty()) return 0;
    std::string digits = text;
    double factor = 1;
    const char last = lower_case(text.back());
    if (last == 'k' || last == 'm')
    {
        factor = last == 'k' ? 1e3 : 1e6;
        digits.pop_back();
    }
    const std::optional<double> number = finite_number(digits);
    if (!number || !(*number * factor >= 100))
        throw UsageError(fmt::format(
            "--particles: \"{}\" is invalid, expected a number from 100 on, such as 500k or 2M",
            text));
    return *number * factor;
}

std::string ask_at_terminal(const std::string& question, const std::string& otherwise)
{
    fmt::print("{}{}: ", question, otherwise.empty() ? "" : fmt::format(" [{}]", otherwise));
    std::fflush(stdout);
    std::string answer;
    if (!std::getline(std::cin, answer)) throw UsageError("no answer was given");
    answer = std::string(trimmed(answer));
    return answer.empty() ? otherwise : answer;
}

void add_options(SubcommandLine& app, NewCall& call)
{
    NewCaseOptions& o = call.options;
    app.add_option("PARTS", o.inputs,
                   "STEP and mesh files, and folders of them: " + mesh_format_list())
        .required()
        .expected(1, -1);
    app.add_option("-o,--output", o.output, "the definition, Case_Def.xml").required();
    app.add_option("--kind", o.kind,
                   "tank, wading, gearbox, obstacle or floating; found by the options otherwise");
    app.add_option("--unit", call.units,
                   "of the files: m, cm, mm or in, or PART=mm of one; found by sizes otherwise")
        .may_be_repeated();
    app.add_option("--up", o.up, "the axis of the files that points upwards")
        .one_of({"x", "y", "z"})
        .shows_default();
    app.add_option("--dp", o.dp, "particle distance, metres").positive();
    app.add_option("--particles", call.particles, "about as many, such as 500k or 2M");
    app.add_option("--across", o.across, "so many dp across the thinnest passage between parts")
        .positive();
    app.add_option("--housing", o.housing, "the part that holds the fluid");
    app.add_option("--rotate", o.rotations,
                   "PART=3000deg/s (rad/s, rpm), or with @AXIS: y, 0,1,0, POINT:DIRECTION or a "
                   "part; the axis is found otherwise. Several parts: A,B=...")
        .may_be_repeated();
    app.add_option("--fix", o.fixed, "a part that stands, whatever it touches").may_be_repeated();
    app.add_option("--float", o.floatings, "PART=400 (kg/m3) or PART=12kg").may_be_repeated();
    app.add_option("--fill", o.fill, "oil=2.5l, water=60% or oil=0.12m, with @PART in that part");
    app.add_option("--inlet", o.inlets,
                   "fluid comes in: PART=2m/s through a flat sheet, PART:-x=3l/min through the "
                   "flat face of a part that looks along -x or 0.8,0,0.6, of any tilt, a disc or a "
                   "rectangle; of several with @PLACE the nearest")
        .may_be_repeated();
    app.add_option("--water", call.water, "height of the water along z, metres");
    app.add_option("--speed", call.speed, "m/s, of the vehicle or of the stream");
    app.add_option("--time", call.duration, "duration of the run, seconds").positive();
    app.add_option("--picture", call.picture, "default: the name of the case, .png");
    app.add_flag("--no-picture", call.has_no_picture,
                 "no picture, and no trial of the case at a coarse dp");
    app.add_flag("--allow-far", o.allows_far, "parts may be far from each other");
    app.add_flag("--allow-overlap", o.allows_overlap, "parts may move through each other");
    app.add_flag("--explain", call.explains, "more about each proposal");
    app.add_flag("--json", call.as_json, "prints JSON");
    app.add_flag("--no-questions", call.asks_nothing, "asks nothing at a terminal either");
    app.add_option("--threads", o.threads, "default 0: what the machine or its scheduler allows")
        .range(0, 4096);
}

/// Reads the arguments; false when only the help was asked for.
bool read_arguments(const std::vector<std::string>& arguments, NewCall& call)
{
    SubcommandLine app(
        "Writes a case from parts: finds units, what holds the fluid, axes, domain, dp and "
        "constants, and says why. Ends with a trial of the case, a picture and a look at each "
        "part.",
        "fppg new");
    call.water = call.speed = call.duration = std::nan("");
    NewCaseOptions& o = call.options;
    add_options(app, call);
    if (!app.read(arguments)) return false;
    if (!std::isnan(call.water)) o.water = call.water;
    if (!std::isnan(call.speed)) o.speed = call.speed;
    if (!std::isnan(call.duration)) o.duration = call.duration;
    for (const std::string& unit : call.units)
    {
        if (unit.find('=') != std::string::npos)
            o.units.push_back(unit);
        else if (metres_of_unit(unit) > 0)
            o.unit = unit;
        else
            throw UsageError(
                fmt::format("--unit: \"{}\" is invalid, expected m, cm, mm, in or PART=mm", unit));
    }
    o.particles = particle_count_of(call.particles);
    if ((o.dp > 0) + (o.particles > 0) + (o.across > 0) > 1)
        throw UsageError("--dp, --particles and --across: expected one of them");
    if (!o.output.ends_with(".xml")) o.output += ".xml";
    if (o.threads == 0) o.threads = default_threads();
    const bool can_ask = is_terminal(Stream::In) && is_terminal(Stream::Out);
    if (can_ask && !call.asks_nothing && !call.as_json) o.ask = ask_at_terminal;
    return true;
}

/// A folder that goes when it is left.
class ScratchFolder
{
public:
    ScratchFolder() : path_(make_scratch_folder()) {}
    ~ScratchFolder()
    {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    std::string file(const char* name) const { return (path_ / name).string(); }

private:
    fs::path path_;
};

/// Makes the particles of the case, walls one sheet on their surface and without relaxation: layers
/// take most of the time of a run.
GeneratedCase try_case(const NewCall& call, const NewCase& made, double dp)
{
    GenerateOptions options;
    if (dp != made.dp) options.dp = dp;
    options.fit = FitChoice::Raw;
    options.vars = {{"Boundary", "1"}};
    options.threads = call.options.threads;
    return generate_case(call.options.output, options);
}

/// The case at a dp that is quick; where walls come too near at that dp, at its own.
GeneratedCase trial_of(const NewCall& call, const NewCase& made, double& dp)
{
    dp = made.dp;
    if (made.expected_particles > picture_particles)
        dp = made.dp * std::pow(made.expected_particles / picture_particles, 1.0 / 3);
    if (dp == made.dp) return try_case(call, made, dp);
    try
    {
        return try_case(call, made, dp);
    }
    catch (const GeometryError&)
    {
        dp = made.dp;
        return try_case(call, made, dp);
    }
}

void draw_picture(GeneratedCase& made, const std::string& path, int threads)
{
    const ScratchFolder scratch;
    made.save(scratch.file("Case"), {});
    const ParticleCloud cloud = read_particles(scratch.file("Case"), false, threads);
    RenderOptions options;
    options.opens_walls = options.has_scale_bar = options.has_legend = true;
    OutputFile file(path);
    write_png(file, render_particles({cloud}, options, threads), true);
    file.commit();
}

std::string picture_name(const NewCall& call)
{
    if (!call.picture.empty()) return call.picture;
    std::string name = call.options.output.substr(0, call.options.output.size() - 4);
    if (name.ends_with("_Def")) name.resize(name.size() - 4);
    return name + ".png";
}

/// What inspect says of each part, a line each.
std::string parts_table(const NewCase& made, int threads)
{
    std::vector<std::vector<std::string>> rows{{"part", "mkbound", "role", "facets", "closed",
                                                "size m", "on the surface", "thinner than dp",
                                                "room for 3 layers"}};
    for (const NewCasePart& part : made.parts)
    {
        const double metre = metres_of_unit(part.unit);
        InspectOptions options;
        options.path = part.path;
        options.parts = part.step_part;
        options.dp = made.dp / metre;
        options.unit = part.unit;
        options.threads = threads;
        options.places_particles = false;
        const Inspection found = inspect_mesh(options);
        const Vec3 size = (found.report.bounds.max - found.report.bounds.min) * metre;
        rows.push_back({part.name, std::to_string(part.mkbound), part.role,
                        std::to_string(found.facets),
                        found.report.is_watertight
                            ? "yes"
                            : counted(found.report.open_edges, "open edge", "open edges"),
                        fmt::format("{:.4g} x {:.4g} x {:.4g}", size.x, size.y, size.z),
                        fmt::format("{:.0f}", found.surface_particles),
                        fmt::format("{:.2g} %", 100 * found.thin_share),
                        fmt::format("{:.3g} %", 100 * found.share_with_layers(3))});
    }
    return text_table(rows, 3, "");
}

} // namespace

int run_new(const std::vector<std::string>& arguments)
{
    NewCall call;
    if (!read_arguments(arguments, call)) return 0;
    const fs::path folder = fs::path(call.options.output).parent_path();
    std::error_code error;
    if (!folder.empty()) fs::create_directories(folder, error);
    if (error) throw IoError(folder.string() + ": cannot create the folder: " + error.message());
    OutputFile file(call.options.output);
    std::optional<StageBar> bar(std::in_place, "new");
    if (call.options.ask) bar.reset();
    const NewCase made = propose_case(call.options);
    bar.reset();
    file.append(made.xml);
    file.commit();
    fmt::print("{}", call.as_json ? to_json(made) : to_text(made, call.explains));
    if (!call.as_json) fmt::print("{}: the definition is written\n", call.options.output);
    if (call.has_no_picture && !call.as_json)
        for (const std::string& warning : made.file_warnings) fmt::print("Warning: {}\n", warning);
    if (call.has_no_picture) return 0;
    bar.emplace("try the case");
    double dp = 0;
    GeneratedCase trial = trial_of(call, made, dp);
    const std::string picture = picture_name(call);
    draw_picture(trial, picture, call.options.threads);
    const std::string table = parts_table(made, call.options.threads);
    bar.reset();
    if (call.as_json) return 0;
    for (const std::string& warning : trial.warnings()) fmt::print("Warning: {}\n", warning);
    fmt::print("{}: {} particles at dp {:.4g} m, walls as one sheet, without relaxation\n{}",
               picture, trial.particles().np, dp, table);
    return 0;
}

} // namespace fppg
