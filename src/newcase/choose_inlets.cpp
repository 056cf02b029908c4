#include "newcase/flat_faces.h"

#include "fppg/error.h"
#include "newcase/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fppg
{

namespace
{

/// A direction names the faces that look along it, to about two degrees.
constexpr double named_way = 0.9994;
/// Smaller faces beside the largest of one direction are no openings.
constexpr double least_face_share = 0.02;
constexpr std::size_t most_listed = 6;

std::string way_text(const Vec3& way)
{
    return fmt::format("{},{},{}", short_number(way.x, 5), short_number(way.y, 5),
                       short_number(way.z, 5));
}

std::string face_text(const FlatFace& face)
{
    return fmt::format("{} ({} mm2 at {})", way_text(face.normal), short_number(1e6 * face.area, 3),
                       place_text(face.middle));
}

/// The faces of a part that can be chosen, for messages.
std::string faces_text(const std::vector<FlatFace>& faces)
{
    std::string out;
    for (std::size_t k = 0; k < std::min(faces.size(), most_listed); ++k)
        out += (k > 0 ? "; " : "") + face_text(faces[k]);
    return out;
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

bool is_sheet(const NewPart& part, const std::vector<FlatFace>& faces)
{
    return !faces.empty() && faces.front().area > 0.999 * part.report.area;
}

/// The face of a part that looks along a direction, the farthest one; with a place behind @ the
/// nearest to it.
///
/// text  "-x" or "0.7,0,0.7@0.1,0,0.2"
FlatFace face_named(const NewPart& part, const std::vector<FlatFace>& faces,
                    const std::string& text)
{
    const std::size_t at = text.find('@');
    const Vec3 direction = direction_of(text.substr(0, at));
    std::vector<FlatFace> found;
    for (const FlatFace& face : faces)
        if (dot(face.normal, direction) > named_way &&
            (found.empty() || face.area > least_face_share * found.front().area))
            found.push_back(face);
    if (found.empty())
        throw GeometryError(
            fmt::format("{}: no flat face of the part looks along {}; expected one of its faces, "
                        "the largest look along {}",
                        part.path, text.substr(0, at), faces_text(faces)));
    if (at != std::string::npos)
    {
        const Vec3 place = vector_of(text.substr(at + 1), "--inlet");
        return *std::min_element(found.begin(), found.end(),
                                 [&](const FlatFace& a, const FlatFace& b)
                                 { return norm(a.middle - place) < norm(b.middle - place); });
    }
    const auto along = [&](const FlatFace& face) { return dot(face.middle, direction); };
    std::stable_sort(found.begin(), found.end(),
                     [&](const FlatFace& a, const FlatFace& b) { return along(a) > along(b); });
    const double size = norm(part.box().max - part.box().min);
    if (found.size() > 1 && along(found[0]) - along(found[1]) < 1e-3 * size)
        throw UsageError(fmt::format(
            "--inlet: faces of {} look along {} side by side: {}; a place names one: {}:{}@{}",
            part.name, text, faces_text(found), part.name, text, way_text(found[0].middle)));
    return found.front();
}

/// The face of a part that is one flat sheet. It looks into the case: to the middle of what holds
/// the fluid, or of all other parts.
FlatFace face_of_sheet(const CasePlan& plan, const NewPart& part,
                       const std::vector<FlatFace>& faces)
{
    if (!is_sheet(part, faces))
        throw UsageError(fmt::format(
            "--inlet: {0} is no flat sheet; name its face by where it looks: {0}:-x=2m/s (x, y, z "
            "or a direction such as 0,0,1). Its largest flat faces look along {1}",
            part.name, faces_text(faces)));
    FlatFace face = faces.front();
    Box3 room;
    for (const NewPart& other : plan.parts)
        if (&other != &part && other.role == PartRole::Housing) room = other.box();
    for (const NewPart& other : plan.parts)
        if (&other != &part && room.is_empty())
        {
            room.add(other.box().min);
            room.add(other.box().max);
        }
    if (room.is_empty()) return face;
    const Vec3 inwards = (room.min + room.max) * 0.5 - face.middle;
    if (dot(inwards, face.normal) < -1e-3 * norm(inwards)) face.normal = face.normal * -1.0;
    return face;
}

/// "2m/s", or a flow through the area: "3l/min", "0.05l/s".
void read_speed(const std::string& text, FluidInlet& inlet)
{
    const char* expected = "2m/s, 3l/min or 0.05l/s";
    const Quantity q = split_quantity(text, "--inlet", expected);
    if (q.unit == "l/s" || q.unit == "l/min")
        inlet.litres_per_s = q.unit == "l/s" ? q.value : q.value / 60;
    inlet.speed = q.unit == "m/s" ? q.value : inlet.litres_per_s / 1000 / inlet.area;
    if (!(inlet.speed > 0))
        throw UsageError(fmt::format("--inlet: \"{}\" is invalid, expected {}", text, expected));
}

std::string outline_text(const FaceOutline& o)
{
    return o.is_disc ? fmt::format("a disc of radius {} mm", short_number(1000 * o.radius))
                     : fmt::format("a rectangle of {} x {} mm", short_number(1000 * o.length),
                                   short_number(1000 * o.width));
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
    NewPart& part = plan.parts[part_named(plan, left.substr(0, colon), "--inlet")];
    const std::vector<FlatFace> faces = flat_faces(part);
    const FlatFace face = colon == std::string::npos
                              ? face_of_sheet(plan, part, faces)
                              : face_named(part, faces, left.substr(colon + 1));
    FluidInlet inlet;
    inlet.name = left;
    inlet.face = outline_of(part, face);
    inlet.direction = face.normal;
    inlet.area = face.area;
    if (!inlet.face.is_near_enough)
        throw GeometryError(fmt::format(
            "{}: the face at {} is no disc and no rectangle: it fills {:.0f} % of {} round it. The "
            "solver lets fluid in through discs and rectangles; expected a face of such a shape, "
            "or "
            "a sheet of one that is drawn into the opening",
            part.path, place_text(face.middle), 100 * inlet.face.filled, outline_text(inlet.face)));
    inlet.is_sheet = colon == std::string::npos;
    if (inlet.is_sheet) part.role = PartRole::Inlet;
    read_speed(entry.substr(equal + 1), inlet);
    plan.propose(
        "inlet " + left,
        fmt::format("{} m/s along ({})", short_number(inlet.speed), way_text(inlet.direction)),
        fmt::format("through {} at {}, {} l/min", outline_text(inlet.face),
                    place_text(inlet.face.middle), short_number(60000 * inlet.speed * face.area)),
        "The zone stands 5 dp before the face or more, as its 4 layers of particles reach back "
        "from it.");
    plan.inlets.push_back(inlet);
}

/// Flat sheets that are called inlets, and that no --inlet names.
void add_called_inlets(CasePlan& plan)
{
    for (std::size_t p = 0; p < plan.parts.size(); ++p)
    {
        const NewPart& part = plan.parts[p];
        if (part.role != PartRole::Fixed || !has_word(part.name, {"inlet", "inflow"}) ||
            !is_sheet(part, flat_faces(part)))
            continue;
        const std::string missing = fmt::format(
            "--inlet {}=2m/s is missing: {} is a flat sheet whose name says that fluid "
            "comes in there; how fast (2m/s, 3l/min or 0.05l/s)?",
            part.name, part.path);
        if (!plan.options->ask) throw UsageError(missing);
        const std::string answer = plan.options->ask(
            fmt::format("How fast does fluid come in through {} (2m/s, 3l/min or 0.05l/s)?",
                        part.name),
            "1m/s");
        add_inlet(plan, part.name + "=" + answer);
    }
}

} // namespace

void choose_inlets(CasePlan& plan)
{
    for (const std::string& entry : plan.options->inlets) add_inlet(plan, entry);
    add_called_inlets(plan);
    int mkbound = 0;
    for (NewPart& part : plan.parts) part.mkbound = part.role == PartRole::Inlet ? 0 : ++mkbound;
    if (mkbound == 0) throw UsageError("--inlet: no part is left that is a wall");
}

} // namespace fppg
