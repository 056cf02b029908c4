#include "app/render_command.h"

#include "app/cloud_scene.h"
#include "app/stage_bar.h"
#include "app/subcommand_line.h"
#include "app/threads.h"
#include "compare/report_words.h"
#include "core/text.h"
#include "fppg/error.h"
#include "fppg/render.h"

#include <fmt/format.h>
#include <array>
#include <charconv>
#include <chrono>
#include <filesystem>

#include <map>
#include <optional>
#include <utility>

namespace fppg
{

namespace
{

struct RenderCall
{
    std::vector<std::string> cases;
    std::string output;
    RenderOptions options;
    bool has_view = false;
    bool has_palette = false;
    int threads = 0;
};

[[noreturn]] void refuse(const std::string& option, const std::string& value, const char* expected)
{
    throw UsageError(fmt::format("{}: \"{}\" is invalid, expected {}", option, value, expected));
}

template <typename Number>
Number number_of(const std::string& option, const std::string& text, std::string_view part,
                 const char* expected)
{
    Number n{};
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), n);
    if (error != std::errc() || end != part.data() + part.size()) refuse(option, text, expected);
    return n;
}

void read_size(const std::string& text, RenderOptions& options)
{
    const char* expected = "WIDTHxHEIGHT in pixels, such as 1600x1200";
    const std::vector<std::string_view> parts = split(text, 'x');
    if (parts.size() != 2) refuse("--size", text, expected);
    options.width = number_of<int>("--size", text, parts[0], expected);
    options.height = number_of<int>("--size", text, parts[1], expected);
}

void read_center(const std::string& text, RenderOptions& options)
{
    const char* expected = "three coordinates, such as 0.5,0,1.2";
    const std::vector<std::string_view> parts = split(text, ',');
    if (parts.size() != 3) refuse("--center", text, expected);
    Vec3 center;
    for (int axis = 0; axis < 3; ++axis)
        center[axis] =
            number_of<double>("--center", text, parts[static_cast<std::size_t>(axis)], expected);
    if (!is_finite(center)) refuse("--center", text, expected);
    options.center = center;
}

void read_mks(const std::string& text, RenderOptions& options)
{
    const char* expected = "numbers and ranges, such as 1,11-13";
    for (const std::string_view part : split(text, ','))
    {
        const std::vector<std::string_view> ends = split(part, '-');
        if (ends.size() > 2) refuse("--mk", text, expected);
        const auto first = number_of<std::uint16_t>("--mk", text, ends.front(), expected);
        const auto last = number_of<std::uint16_t>("--mk", text, ends.back(), expected);
        for (unsigned mk = first; mk <= last; ++mk)
            options.mks.push_back(static_cast<std::uint16_t>(mk));
    }
}

/// A picture whose name says another format would be a PNG that nobody opens as such.
void refuse_other_formats(const std::string& output)
{
    const std::string ending = lower_case(std::filesystem::path(output).extension().string());
    if (!ending.empty() && ending != ".png")
        refuse("--output", output, "a name that ends in .png, the format that is written");
}

/// Reads the arguments; false when only the help was asked for.
bool read_arguments(const std::vector<std::string>& arguments, RenderCall& call)
{
    SubcommandLine app(
        "Draws the particles of a case as spheres; two cases side by side with one "
        "camera. A case is named without extension (Case.bi4 and Case.xml, or "
        "Case_All.vtk), or as one file .bi4 or .vtk.",
        "fppg render");
    std::string size;
    std::string view;
    std::string center;
    std::string mks;
    std::string colour = "mk";
    std::vector<std::string> cuts;
    bool is_closed = false;
    bool is_bare = false;
    RenderOptions& options = call.options;
    app.add_option("CASE", call.cases, "one case or two").required().expected(1, 2);
    app.add_option("-o,--output", call.output, "the picture, .png").required();
    app.add_option("--view", view,
                   "iso (default), front, back, left, right, top, bottom, or AZIMUTH,ELEVATION in "
                   "degrees; a case in the plane of x and z is seen from the front by default");
    app.add_option(
        "--color,--colour", colour,
        "mk (default; parts of CAD models that have a colour have it), role (fixed, moving, "
        "floating, fluid), kind (corner, edge, surface, volume) or layer (of walls, 1 next to the "
        "surface)");
    app.add_option("--mk", mks, "only these, such as 1,11-13");
    app.add_option("--cut", cuts, "keeps what is on one side: y>0.3 or z<1; may be repeated")
        .may_be_repeated();
    app.add_option("--zoom", options.zoom, "magnification (default 1)");
    app.add_option("--center", center, "X,Y,Z in the middle of the picture");
    app.add_option("--size", size, "in pixels (default 1600x1200)");
    app.add_option("--radius", options.radius_dp, "of the spheres, in dp (default 0.5)");
    app.add_option("--samples", options.samples, "rays per pixel along each axis (default 2)");
    app.add_flag(
        "--closed", is_closed,
        "fixed walls in front of fluid and moving parts stay; by default they are left out, "
        "unless --cut or --mk is given");
    app.add_flag("--bare", is_bare, "no scale bar and no legend");
    app.add_flag("--palette", call.has_palette, "256 colours, for a smaller file");
    app.add_option("--threads", call.threads,
                   "default 0: what the machine or its scheduler allows");
    if (!app.read(arguments)) return false;
    refuse_other_formats(call.output);
    options.opens_walls = !is_closed && cuts.empty() && mks.empty();
    options.has_scale_bar = options.has_legend = !is_bare;
    if (!size.empty()) read_size(size, options);
    if (!center.empty()) read_center(center, options);
    if (!mks.empty()) read_mks(mks, options);
    if (!view.empty()) options.view = parse_view(view);
    call.has_view = !view.empty();
    for (const std::string& cut : cuts) options.cuts.push_back(parse_cut(cut));
    if (colour == "kind")
        options.colour = RenderColour::Kind;
    else if (colour == "layer")
        options.colour = RenderColour::Layer;
    else if (colour == "role")
        options.colour = RenderColour::Role;
    else if (colour != "mk")
        refuse("--color", colour, "mk, role, kind or layer");
    if (call.threads < 0 || call.threads > 4096)
        throw UsageError(
            fmt::format("--threads: {} is out of range, expected 0 to 4096", call.threads));
    if (call.threads == 0) call.threads = default_threads();
    return true;
}

bool is_in_plane(const ParticleCloud& cloud)
{
    return std::all_of(cloud.positions.begin(), cloud.positions.end(),
                       [&](const Vec3& p) { return p.y == cloud.positions.front().y; });
}

/// Prints what the colours stand for.
void print_colours(const std::vector<ParticleCloud>& clouds, const RenderOptions& options)
{
    std::vector<bool> is_wanted(65536, options.mks.empty());
    for (const std::uint16_t mk : options.mks) is_wanted[mk] = true;
    std::map<unsigned, std::pair<Rgb, std::string>> found;
    for (const ParticleCloud& cloud : clouds)
        for (std::size_t i = 0; i < cloud.mk.size(); ++i)
        {
            const unsigned value = colour_value(cloud, i, options.colour);
            if (!is_wanted[cloud.mk[i]] || found.contains(value)) continue;
            found[value] = {colour_of(cloud, i, options.colour),
                            colour_name(cloud, i, options.colour)};
        }
    for (const auto& [value, entry] : found)
        fmt::print("  {}  {}\n", hex_of(entry.first), entry.second);
}

} // namespace

int run_render(const std::vector<std::string>& arguments)
{
    const auto start = std::chrono::steady_clock::now();
    RenderCall call;
    if (!read_arguments(arguments, call)) return 0;
    OutputFile file(call.output);
    std::optional<StageBar> bar(std::in_place, "render");
    std::vector<ParticleCloud> clouds;
    for (const std::string& name : call.cases)
        clouds.push_back(
            read_particles(name, call.options.colour >= RenderColour::Kind, call.threads));
    if (!call.has_view && std::all_of(clouds.begin(), clouds.end(), is_in_plane))
        call.options.view = parse_view("front");
    const Image image = render_particles(clouds, call.options, call.threads);
    write_png(file, image, call.has_palette);
    file.commit();
    bar.reset();
    print_colours(clouds, call.options);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    fmt::print("{}: {} x {} pixels, {:.2f} s\n", call.output, image.width, image.height,
               seconds.count());
    return 0;
}

} // namespace fppg
