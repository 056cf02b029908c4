#include "newcase/plan.h"

#include "fppg/error.h"
#include "newcase/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fppg
{

namespace
{

/// Facets of a flat face look the same way, to about a degree.
constexpr double same_way = 0.9998;
/// A face that fills less of the circle round it is no disc.
constexpr double least_disc = 0.9;

struct FlatFace
{
    Vec3 middle;
    Vec3 normal;
    double area = 0;   ///< m2
    double radius = 0; ///< m, of its farthest corner from the middle
};

/// The facets that look along a direction and lie farthest along it.
FlatFace face_along(const NewPart& part, const Vec3& direction)
{
    const SurfaceMesh& mesh = part.mesh;
    const double size = norm(part.box().max - part.box().min);
    const auto middle_of = [&](std::size_t f)
    {
        const auto& c = mesh.facets[f];
        return (mesh.vertices[c[0]] + mesh.vertices[c[1]] + mesh.vertices[c[2]]) / 3;
    };
    double farthest = -1e300;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (dot(mesh.normals[f], direction) > same_way)
            farthest = std::max(farthest, dot(middle_of(f), direction));
    FlatFace out;
    out.normal = direction;
    std::vector<std::size_t> facets;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (dot(mesh.normals[f], direction) > same_way &&
            dot(middle_of(f), direction) > farthest - 1e-3 * size)
        {
            facets.push_back(f);
            out.area += mesh.areas[f];
            out.middle = out.middle + mesh.areas[f] * middle_of(f);
        }
    if (!(out.area > 0)) return out;
    out.middle = out.middle / out.area;
    for (const std::size_t f : facets)
        for (const std::uint32_t v : mesh.facets[f])
            out.radius = std::max(out.radius, norm(mesh.vertices[v] - out.middle));
    return out;
}

/// A part that is one flat sheet is the face itself.
FlatFace face_of_sheet(const NewPart& part)
{
    const FlatFace face = face_along(part, part.mesh.normals.front());
    if (face.area < 0.999 * part.report.area)
        throw UsageError(fmt::format(
            "--inlet: {} is no flat sheet; name the face by where it looks: {}:-x=2m/s (x, y, z or "
            "a direction such as 0,0,1)",
            part.name, part.name));
    return face;
}

Vec3 direction_of(const std::string& text)
{
    Vec3 out;
    const bool is_negative = text.starts_with('-');
    const std::string axis = text.substr(is_negative || text.starts_with('+') ? 1 : 0);
    if (axis == "x" || axis == "y" || axis == "z")
        out[axis[0] - 'x'] = is_negative ? -1 : 1;
    else
        out = vector_of(text, "--inlet");
    const double length = norm(out);
    if (!(length > 0)) throw UsageError("--inlet: the face looks in no direction");
    return out / length;
}

/// "2m/s", or a flow through the area: "3l/min", "0.05l/s".
double speed_of(const std::string& text, double area)
{
    const char* expected = "2m/s, 3l/min or 0.05l/s";
    const Quantity q = split_quantity(text, "--inlet", expected);
    const double speed = q.unit == "m/s"     ? q.value
                         : q.unit == "l/s"   ? q.value / 1000 / area
                         : q.unit == "l/min" ? q.value / 60000 / area
                                             : 0;
    if (!(speed > 0))
        throw UsageError(fmt::format("--inlet: \"{}\" is invalid, expected {}", text, expected));
    return speed;
}

void add_inlet(CasePlan& plan, const std::string& entry)
{
    const std::size_t equal = entry.find('=');
    if (equal == std::string::npos)
        throw UsageError(fmt::format(
            "--inlet: \"{}\" is invalid, expected PART=2m/s of a flat sheet, or PART:-x=2m/s",
            entry));
    const std::string left = entry.substr(0, equal);
    const std::size_t colon = left.find(':');
    const std::size_t p = part_named(plan, left.substr(0, colon), "--inlet");
    NewPart& part = plan.parts[p];
    const FlatFace face = colon == std::string::npos
                              ? face_of_sheet(part)
                              : face_along(part, direction_of(left.substr(colon + 1)));
    if (!(face.area > 0))
        throw GeometryError(fmt::format("{}: no flat face of the part looks along {}", part.path,
                                        left.substr(colon + 1)));
    const double disc = face.area / (std::numbers::pi * face.radius * face.radius);
    if (disc < least_disc)
        throw GeometryError(fmt::format(
            "{}: the face at {} is no disc: it fills {:.0f} % of the circle round it. Only round "
            "faces can be inlets; others are written by hand (<inoutzone> with a box)",
            part.path, place_text(face.middle), 100 * disc));
    if (colon == std::string::npos) part.role = PartRole::Inlet;
    FluidInlet inlet;
    inlet.name = left;
    inlet.place = face.middle;
    inlet.direction = face.normal;
    inlet.radius = face.radius;
    inlet.speed = speed_of(entry.substr(equal + 1), face.area);
    plan.propose("inlet " + left,
                 fmt::format("{} m/s along ({}, {}, {})", short_number(inlet.speed),
                             short_number(inlet.direction.x), short_number(inlet.direction.y),
                             short_number(inlet.direction.z)),
                 fmt::format("through a disc of radius {} mm at {}, {} l/min",
                             short_number(1000 * inlet.radius), place_text(inlet.place),
                             short_number(60000 * inlet.speed * face.area)),
                 "The zone stands 5 dp before the face, as its 4 layers of particles reach back "
                 "from it.");
    plan.inlets.push_back(inlet);
}

} // namespace

void choose_inlets(CasePlan& plan)
{
    for (const std::string& entry : plan.options->inlets) add_inlet(plan, entry);
    int mkbound = 0;
    for (NewPart& part : plan.parts) part.mkbound = part.role == PartRole::Inlet ? 0 : ++mkbound;
    if (mkbound == 0) throw UsageError("--inlet: no part is left that is a wall");
}

} // namespace fppg
