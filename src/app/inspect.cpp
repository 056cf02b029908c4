#include "app/inspect.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "app/inspect_particles.h"
#include "core/json.h"
#include "core/length_units.h"
#include "core/parallel.h"
#include "core/text_table.h"
#include "fppg/error.h"
#include "fppg/features.h"
#include "fppg/fit.h"
#include "fppg/shapes.h"
#include "meshes/cad_surface.h"
#include "meshes/facing_distance.h"
#include "meshes/mesh_formats.h"
#include "meshes/mesh_query.h"
#include "walls/thickened.h"

namespace fppg
{

namespace
{

constexpr std::size_t open_edges_shown = 5;
/// Beyond this, particles on lines are not placed but estimated.
constexpr double most_line_particles = 1e7;
/// Beyond this, particles on the surface are not placed: it would take longer than a few seconds.
constexpr double most_fitted_particles = 2e6;
/// Beyond this, the particles of the body are not made for its table.
constexpr double most_for_bodies = 2e5;
constexpr std::size_t thickness_samples = 20000;
/// From here on a dp is more likely a mistake than meant.
constexpr double questionable_particles = 1e10;

struct UnitGuess
{
    std::string unit;
    std::string reason;
};

/// Files have no unit; what a designer draws in millimetres is hundreds of units long.
UnitGuess guess_unit(const Box3& bounds, double dp)
{
    const Vec3 extent = bounds.max - bounds.min;
    const double largest = std::max({extent.x, extent.y, extent.z});
    if (largest > 200)
        return {"mm", fmt::format("In metres it would be {:.4g} m long, in millimetres {:.4g} m.",
                                  largest, largest / 1000)};
    if (dp > 0 && largest > 5000 * dp)
        return {"mm", fmt::format("It is {:.3g} dp long; with a dp in metres that is more than a "
                                  "case can hold.",
                                  largest / dp)};
    if (largest < 5)
        return {"m", fmt::format("In millimetres it would be only {:.4g} mm long.", largest)};
    return {largest > 20 ? "mm" : "m",
            fmt::format("Not sure: it is {:.4g} m or {:.4g} mm long, and both are sizes of parts.",
                        largest, largest)};
}

void describe_features(const SurfaceMesh& mesh, const std::shared_ptr<const CadFacets>& facets,
                       Inspection& found)
{
    const FeatureOptions options{.angle_deg = found.options.angle_deg,
                                 .dp = found.options.dp,
                                 .cad_angle_deg = found.options.cad_angle_deg};
    std::shared_ptr<const CadSurface> cad;
    if (facets != nullptr)
        cad = std::make_shared<const CadSurface>(mesh, std::vector{CadSource{facets, Transform{}}},
                                                 found.options.threads);
    const Features features = find_features(mesh, options, {}, bends_of(cad));
    found.lines = features.lines.size();
    found.singular_points = features.singular.size();
    for (const FeatureLine& line : features.lines)
    {
        found.closed_lines += static_cast<std::size_t>(line.is_closed);
        found.line_length += line.length;
        found.longest_line = std::max(found.longest_line, line.length);
        found.shortest_line =
            found.shortest_line > 0 ? std::min(found.shortest_line, line.length) : line.length;
        found.short_lines += static_cast<std::size_t>(line.length < options.dp);
    }
    if (!(options.dp > 0) || !found.question.empty() || !found.options.places_particles) return;
    if (found.line_length > most_line_particles * options.dp)
    {
        found.corner_particles = static_cast<double>(found.singular_points);
        found.line_particles = found.line_length / options.dp;
        return;
    }
    const std::vector<FeatureParticle> particles = place_feature_particles(mesh, features, options);
    for (const FeatureParticle& particle : particles)
        ++(particle.is_corner ? found.corner_particles : found.line_particles);
    if (found.report.area > most_fitted_particles * options.dp * options.dp) return;
    FitOptions fit;
    fit.dp = options.dp;
    const SurfaceParticles fitted =
        fit_surface(mesh, features, particles, fit, found.options.threads);
    found.fitted_particles = fitted.kinds.size() - particles.size();
}

struct Thickness
{
    Vec3 at;
    double value = std::numeric_limits<double>::infinity();
};

/// Layers of both sides that are nearer than this are one, dp.
constexpr double merged_layers_dp = 0.6;

/// How many layers of mDBC walls there is room for through a wall, at depths of (k + 1/2) dp from
/// both of its sides.
std::size_t layers_through(double thickness_dp)
{
    const double of_a_side = std::floor(thickness_dp / 2 + 0.5 + 1e-6);
    if (of_a_side < 1) return 0;
    const bool are_merged = thickness_dp - 2 * (of_a_side - 0.5) < merged_layers_dp;
    const double layers = 2 * of_a_side - (are_merged ? 1 : 0);
    return static_cast<std::size_t>(std::min<double>(layers, Inspection::most_layers));
}

/// Looks for thin places at points spread evenly over the area.
void find_thin_places(const SurfaceMesh& mesh, Inspection& found)
{
    const MeshQuery query(soup_of(mesh), found.options.threads);

    const std::vector<FacetSpot> places = even_places(mesh, thickness_samples);
    std::vector<Thickness> samples(places.size());
    const double reach = (Inspection::most_layers + 0.5) * found.options.dp;
    parallel_for(
        samples.size(), found.options.threads,
        [&](std::size_t i)
        {
            samples[i] = {places[i].place, facing_distance(mesh.normals, query, places[i],
                                                           FacetSide::Behind, reach)};
        },
        64);
    std::size_t thin = 0;
    Thickness least;
    for (const Thickness& sample : samples)
    {
        found.layer_shares[layers_through(std::min(sample.value, reach) / found.options.dp)] +=
            1.0 / thickness_samples;
        if (!(sample.value < found.options.dp)) continue;
        ++thin;
        if (sample.value < least.value) least = sample;
    }
    if (found.report.is_watertight && found.layer_shares[0] + found.layer_shares[1] > 0)
    {
        SurfaceMesh walls = mesh;
        LatticeGrid grid;
        grid.dp = found.options.dp;
        found.is_thickened = thicken(grid, found.options.threads, walls) > 0;
    }
    found.thin_share = static_cast<double>(thin) / thickness_samples;
    if (thin == 0) return;
    found.thinnest = least.value;
    found.thinnest_at = least.at;
}

/// A number of particles, whole as long as a reader can take it in.
std::string whole(double count)
{
    return count < 1e15 ? fmt::format("{:.0f}", count) : fmt::format("{:.3g}", count);
}

/// Formats lengths of a file, areas and volumes, each with its unit; what is rounding beside the
/// size of the mesh is 0.
class Lengths
{
public:
    explicit Lengths(const Inspection& found)
        : unit_(found.unit),
          size_(norm(found.report.bounds.max - found.report.bounds.min) +
                norm(found.report.bounds.min))
    {
    }

    std::string length(double v) const { return fmt::format("{:.6g} {}", clean(v, 1), unit_); }
    std::string area(double v) const { return fmt::format("{:.6g} {}^2", clean(v, 2), unit_); }
    std::string volume(double v) const { return fmt::format("{:.6g} {}^3", clean(v, 3), unit_); }
    std::string place(const Vec3& p) const { return triple(p, ", ", "(", ")"); }
    std::string size(const Vec3& p) const { return triple(p, " x ", "", ""); }

private:
    double clean(double v, int power) const
    {
        return std::abs(v) <= 1e-12 * std::pow(size_, power) ? 0 : v;
    }
    std::string triple(const Vec3& p, const char* between, const char* before,
                       const char* behind) const
    {
        return fmt::format("{}{:.6g}{}{:.6g}{}{:.6g}{} {}", before, clean(p.x, 1), between,
                           clean(p.y, 1), between, clean(p.z, 1), behind, unit_);
    }

    std::string unit_;
    double size_;
};

/// " (0.0012 m^3)" of what is measured in another unit; power 1 to 3.
std::string in_metres(const Inspection& found, double value, int power)
{
    if (found.unit == "m") return "";
    return fmt::format(" ({:.6g} m{})", value * std::pow(metres_of_unit(found.unit), power),
                       power == 1 ? "" : fmt::format("^{}", power));
}

/// What to ask of a dp that makes more particles than a computer holds.
std::string question_of(const Inspection& found)
{
    const double dp = found.options.dp;
    const double most = std::max(found.surface_particles, found.volume_particles);
    if (most < questionable_particles) return "";
    const bool is_volume = found.volume_particles >= found.surface_particles;
    const double least = dp * std::pow(most / 1e8, is_volume ? 1.0 / 3 : 0.5);
    return fmt::format(
        "dp {:g} {} makes {} particles in {}, so none was placed: is dp in the unit "
        "of the file ({})? From dp = {:.2g} {} on it is less than a hundred million",
        dp, found.unit, whole(most), is_volume ? "the volume" : "the surface", found.unit, least,
        found.unit);
}

Json as_json(const Vec3& p)
{
    return {p.x, p.y, p.z};
}

MeshFile read_file(const InspectOptions& options, Inspection& found)
{
    if (options.path.ends_with(".vtm") || options.path.ends_with(".VTM"))
        throw GeometryError(
            fmt::format("{}: names other files that hold the meshes, expected one "
                        "of those",
                        options.path));
    const MeshReading reading = reading_of(options);
    if (reading.format == MeshFormat::Step && !options.unit.empty() && options.unit != "m")
        throw UsageError(
            fmt::format("{}: --unit {}: STEP files name their unit, and are read as "
                        "metres, as dp",
                        options.path, options.unit));
    found.format = mesh_format_name(reading.format);
    return read_mesh_file(options.path, reading, options.threads);
}

} // namespace

Inspection inspect_mesh(const InspectOptions& options)
{
    Inspection found;
    found.options = options;
    const MeshFile file = read_file(options, found);
    found.file_warnings = file.warnings;
    found.points = file.points.size();
    found.polylines = file.lines.size();
    try
    {
        if (file.soup.size() == 0)
            throw GeometryError(
                fmt::format("has no surface, only {} points and {} lines, which a case draws on "
                            "the lattice",
                            found.points, found.polylines));
        const SurfaceMesh mesh = repair_mesh(file.soup,
                                             {.weld_distance = options.weld_distance,
                                              .dp = options.dp,
                                              .count_self_intersections = true},
                                             options.threads, found.report);
        found.facets = mesh.facets.size();
        found.vertices = mesh.vertices.size();
        for (std::size_t e = 0; e < mesh.edges.size(); ++e)
            if (mesh.edge_facets[e][1] == no_index && found.open_edges.size() < open_edges_shown)
                found.open_edges.push_back(
                    {mesh.vertices[mesh.edges[e][0]], mesh.vertices[mesh.edges[e][1]]});
        const UnitGuess guess = guess_unit(found.report.bounds, options.dp);
        const bool is_known = !options.unit.empty() || file.cad != nullptr;
        found.unit = file.cad != nullptr ? "m" : is_known ? options.unit : guess.unit;
        found.unit_reason = is_known ? "" : guess.reason;
        if (file.cad != nullptr) found.cad_parts = file.cad->parts;
        if (options.dp > 0)
        {
            found.surface_particles = found.report.area / (options.dp * options.dp);
            found.volume_particles =
                std::abs(found.report.volume) / (options.dp * options.dp * options.dp);
            found.question = question_of(found);
        }
        describe_features(mesh, file.cad, found);
        if (options.dp > 0 && found.question.empty())
        {
            find_thin_places(mesh, found);
            if (options.places_particles && found.report.is_watertight && found.report.volume > 0 &&
                found.surface_particles + found.volume_particles < most_for_bodies)
                found.bodies = inspect_bodies(options, mesh);
        }
    }
    catch (const GeometryError& error)
    {
        throw GeometryError(fmt::format("{}: {}", options.path, error.what()));
    }
    return found;
}

namespace
{

using Line = std::function<void(const char*, const std::string&)>;

void write_table(const std::vector<std::vector<std::string>>& rows, const Line& line)
{
    std::string table = text_table(rows, 1, "");
    while (!table.empty() && table.back() == '\n') table.pop_back();
    for (std::size_t at = 0; at <= table.size();)
    {
        const std::size_t end = std::min(table.find('\n', at), table.size());
        line("", table.substr(at, end - at));
        at = end + 1;
    }
}

/// Volume, mass, centre and inertia of the shape and of the particles.
void write_bodies(const Inspection& found, const Line& line)
{
    if (found.bodies.empty()) return;
    const double metre = metres_of_unit(found.unit);
    constexpr double density = 1000;
    std::vector<std::vector<std::string>> rows{{"", "particles", "volume m3", "mass kg",
                                                "centre x m", "y", "z", "inertia xx kg m2", "yy",
                                                "zz"}};
    for (const InspectedBody& b : found.bodies)
    {
        std::vector<std::string> row{
            b.of, b.particles > 0 ? fmt::format("{}", b.particles) : std::string(),
            fmt::format("{:.6g}", b.body.volume * std::pow(metre, 3)),
            fmt::format("{:.6g}", density * b.body.volume * std::pow(metre, 3))};
        for (int axis = 0; axis < 3; ++axis)
            row.push_back(fmt::format("{:.6g}", b.body.center[axis] * metre));
        for (int axis = 0; axis < 3; ++axis)
            row.push_back(fmt::format(
                "{:.6g}", density * b.body.inertia[static_cast<std::size_t>(axis)][axis] *
                              std::pow(metre, 5)));
        rows.push_back(std::move(row));
    }
    line("Bodies", "at 1000 kg/m3, with -fit (on the surface) and place=\"inside\":");
    write_table(rows, line);
}

/// "#rrggbb"; empty: it has none.
std::string color_text(const CadPart& part)
{
    return part.color ? hex_of(*part.color) : "";
}

/// By the exact faces, not by facets.
void write_cad_parts(const Inspection& found, const Line& line)
{
    if (found.cad_parts.empty()) return;
    std::vector<std::vector<std::string>> rows{
        {"part", "colour", "volume m3", "area m2", "edges that bend", "long m", "tangent edges"}};
    for (const CadPart& part : found.cad_parts)
        rows.push_back({fmt::format("{}", fmt::join(part.path, "/")), color_text(part),
                        fmt::format("{:.9g}", part.volume), fmt::format("{:.9g}", part.area),
                        std::to_string(part.sharp_edges), fmt::format("{:.9g}", part.sharp_length),
                        std::to_string(part.smooth_edges)});
    line("CAD parts", "by their exact faces:");
    write_table(rows, line);
}

void write_particles(const Inspection& found, const Lengths& in, const Line& line)
{
    const MeshReport& report = found.report;
    line("With dp", in.length(found.options.dp) + in_metres(found, found.options.dp, 1));
    line("  on the surface",
         fmt::format("{} particles (area / dp^2)", whole(found.surface_particles)));
    if (found.question.empty())
        line("  on lines", fmt::format("{} particles, and {} on corners",
                                       whole(found.line_particles), whole(found.corner_particles)));
    if (found.fitted_particles)
        line("  with -fit",
             fmt::format("{} particles on the surface besides those on lines and corners",
                         *found.fitted_particles));
    if (!report.is_watertight)
        line("",
             "not watertight: what -fit takes for its inside is a guess, an open sheet has "
             "none");
    line("  in the volume",
         fmt::format("{} particles (volume / dp^3)", whole(found.volume_particles)));
    if (!found.question.empty()) return;
    line("  short lines", fmt::format("{} shorter than dp", found.short_lines));
    line("  thin places",
         found.thinnest > 0 || found.thin_share > 0
             ? fmt::format("{:.2g} % of the area is thinner than dp, the least {} near {}",
                           100 * found.thin_share, in.length(found.thinnest),
                           in.place(found.thinnest_at))
             : "none found");
    write_bodies(found, line);
    if (!report.is_watertight) return;
    std::size_t least = 0;
    while (least < Inspection::most_layers && !(found.layer_shares[least] > 0)) ++least;
    const auto share = [&](std::size_t layers) { return 100 * found.share_with_layers(layers); };
    line("  layers (mDBC)",
         fmt::format(
             "room for {} {}{}; 3 (coefh 1) behind {:.3g} % of the area, 4 (coefh 1.2) "
             "behind {:.3g} %",
             least,
             least == Inspection::most_layers ? "or more everywhere" : "at the thinnest place",
             found.is_thickened ? ", so walls are thickened to 2 dp, for 2" : "", share(3),
             share(4)));
}

} // namespace

std::string to_text(const Inspection& found)
{
    const MeshReport& report = found.report;
    const Lengths in(found);
    std::string text;
    const Line line = [&text](const char* name, const std::string& value)
    { text += fmt::format("{:<18}{}\n", name, value); };
    if (!found.question.empty()) line("Question", found.question);
    line("File", fmt::format("{} ({})", found.options.path, found.format));
    line("Unit", found.unit_reason.empty() ? found.unit
                                           : fmt::format("probably {} (--unit says which). {}",
                                                         found.unit, found.unit_reason));
    line("Facets", found.facets == report.facets_read
                       ? fmt::format("{}", found.facets)
                       : fmt::format("{} of {} read", found.facets, report.facets_read));
    line("Vertices", fmt::format("{}", found.vertices));
    if (found.points + found.polylines > 0)
        line("Besides", fmt::format("{} single points, {} lines", found.points, found.polylines));
    line("Shells", fmt::format("{}", report.shells));
    line("Watertight", report.is_watertight ? "yes" : "no");
    for (const auto& [a, b] : found.open_edges)
        line("  open edge", fmt::format("{} to {}", in.place(a), in.place(b)));
    if (report.open_edges > found.open_edges.size())
        line("", fmt::format("and {} more", report.open_edges - found.open_edges.size()));
    line("Bounding box",
         fmt::format("{} to {}", in.place(report.bounds.min), in.place(report.bounds.max)));
    line("Size", in.size(report.bounds.max - report.bounds.min));
    line("Volume", in.volume(report.volume) + in_metres(found, report.volume, 3) +
                       (report.is_watertight ? "" : " (not watertight: a guess)"));
    line("Area", in.area(report.area) + in_metres(found, report.area, 2));
    line("Crossing facets", fmt::format("{} pairs", report.self_intersections));
    line("Feature lines", fmt::format("{} ({} closed), {} long, at {:g} degrees", found.lines,
                                      found.closed_lines, in.length(found.line_length),
                                      found.cad_parts.empty() ? found.options.angle_deg
                                                              : found.options.cad_angle_deg));
    if (found.lines > 0)
        line("", fmt::format("shortest {}, longest {}", in.length(found.shortest_line),
                             in.length(found.longest_line)));
    line("Singular points", fmt::format("{}", found.singular_points));
    write_cad_parts(found, line);
    if (found.options.dp > 0) write_particles(found, in, line);
    for (const std::string& warning : found.file_warnings) line("Warning", warning);
    for (const std::string& warning : report.warnings) line("Warning", warning);
    return text;
}

namespace
{

/// Lengths in the unit of the file, density 1.
Json bodies_json(const Inspection& found)
{
    Json out = Json::array();
    for (const InspectedBody& b : found.bodies)
    {
        Json body{{"of", b.of}, {"particles", b.particles}, {"volume", b.body.volume}};
        body["centre"] = as_json(b.body.center);
        body["inertia"] = {b.body.inertia[0].x, b.body.inertia[1].y, b.body.inertia[2].z};
        out.push_back(body);
    }
    return out;
}

Json cad_parts_json(const Inspection& found)
{
    Json out = Json::array();
    for (const CadPart& part : found.cad_parts)
        out.push_back({{"name", part.name},
                       {"path", part.path},
                       {"color", color_text(part)},
                       {"volume", part.volume},
                       {"area", part.area},
                       {"centre", as_json(part.center)},
                       {"inertia", part.inertia},
                       {"sharp_edges", part.sharp_edges},
                       {"sharp_length", part.sharp_length},
                       {"smooth_edges", part.smooth_edges}});
    return out;
}

} // namespace

std::string to_json(const Inspection& found)
{
    const MeshReport& report = found.report;
    Json json;
    json["file"] = found.options.path;
    json["format"] = found.format;
    json["points"] = found.points;
    json["polylines"] = found.polylines;
    json["facets_read"] = report.facets_read;
    json["facets"] = found.facets;
    json["vertices"] = found.vertices;
    json["shells"] = report.shells;
    json["is_watertight"] = report.is_watertight;
    json["open_edges"] = report.open_edges;
    json["first_open_edges"] = Json::array();
    for (const auto& [a, b] : found.open_edges)
        json["first_open_edges"].push_back({as_json(a), as_json(b)});
    json["non_manifold_edges"] = report.non_manifold_edges;
    json["clashing_edges"] = report.clashing_edges;
    json["t_junctions"] = report.t_junctions;
    json["duplicate_facets"] = report.duplicate_facets;
    json["inner_wall_facets"] = report.inner_wall_facets;
    json["degenerate_facets"] = report.degenerate_facets;
    json["flipped_facets"] = report.flipped_facets;
    json["self_intersections"] = report.self_intersections;
    json["bounds"] = {{"min", as_json(report.bounds.min)}, {"max", as_json(report.bounds.max)}};
    json[found.options.unit.empty() ? "unit_guess" : "unit"] = found.unit;
    if (found.options.unit.empty()) json["unit_reason"] = found.unit_reason;
    if (!found.question.empty()) json["question"] = found.question;
    if (!found.cad_parts.empty()) json["cad_parts"] = cad_parts_json(found);
    json["volume"] = report.volume;
    json["area"] = report.area;
    json["features"] = {{"angle_deg", found.cad_parts.empty() ? found.options.angle_deg
                                                              : found.options.cad_angle_deg},
                        {"lines", found.lines},
                        {"closed_lines", found.closed_lines},
                        {"length", found.line_length},
                        {"shortest", found.shortest_line},
                        {"longest", found.longest_line},
                        {"singular_points", found.singular_points}};
    if (found.options.dp > 0)
    {
        json["dp"] = found.options.dp;
        json["expected_particles"] = {{"surface", found.surface_particles},
                                      {"lines", found.line_particles},
                                      {"corners", found.corner_particles},
                                      {"volume", found.volume_particles}};
        if (found.fitted_particles) json["fitted_particles"] = *found.fitted_particles;
        json["lines_shorter_than_dp"] = found.short_lines;
        json["thin"] = {{"share_of_area", found.thin_share}, {"least", found.thinnest}};
        if (found.thin_share > 0) json["thin"]["at"] = as_json(found.thinnest_at);
        if (!found.bodies.empty()) json["bodies"] = bodies_json(found);
        if (report.is_watertight && found.question.empty())
        {
            json["layers"]["share_of_area"] = Json::array();
            for (const double share : found.layer_shares)
                json["layers"]["share_of_area"].push_back(share);
            json["layers"]["is_thickened"] = found.is_thickened;
        }
    }
    json["warnings"] = found.file_warnings;
    for (const std::string& warning : report.warnings) json["warnings"].push_back(warning);
    return json.text(2) + "\n";
}

} // namespace fppg
