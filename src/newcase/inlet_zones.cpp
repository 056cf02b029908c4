#include "newcase/xml_lines.h"

#include "fppg/error.h"

#include "meshes/mesh_query.h"
#include "shapes/round_facets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace fppg
{

namespace
{

/// Layers of particles behind the plane of a zone.
constexpr int zone_layers = 4;
/// How far the plane stands before the face: its layers, and what walls take there; dp. Farther
/// where something else is in the way, as the rest of a wall that a sheet stands in.
constexpr double before_face = zone_layers + 1;
constexpr double farthest_before_face = 12;
constexpr double farther = 0.5;
/// Points of a zone keep off walls, dp: particles of modified boundaries stand half a dp behind
/// these, and the solver refuses them nearer than 0.7 dp (v5.4, JSphInOut).
constexpr double off_walls = 0.25;

/// A right-handed turn.
struct Turn
{
    Vec3 axis; ///< of length 1
    double radians = 0;
};

/// The turn that takes x, y and z to three directions at right angles.
///
/// source  Shepperd, Quaternion from rotation matrix, 1978
Turn turn_onto(const Vec3& x, const Vec3& y, const Vec3& z)
{
    const std::array<std::array<double, 3>, 3> m{
        {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
    const double trace = m[0][0] + m[1][1] + m[2][2];
    const std::array<double, 4> squares{trace, m[0][0], m[1][1], m[2][2]};
    const auto largest = static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) -
                                                  squares.begin());
    double w = 0;
    std::array<double, 3> v{};
    if (largest == 0)
    {
        w = std::sqrt(1 + trace) / 2;
        v = {(m[2][1] - m[1][2]) / (4 * w), (m[0][2] - m[2][0]) / (4 * w),
             (m[1][0] - m[0][1]) / (4 * w)};
    }
    else
    {
        const std::size_t i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
        v[i] = std::sqrt(1 + 2 * m[i][i] - trace) / 2;
        v[j] = (m[j][i] + m[i][j]) / (4 * v[i]);
        v[k] = (m[k][i] + m[i][k]) / (4 * v[i]);
        w = (m[k][j] - m[j][k]) / (4 * v[i]);
    }
    const Vec3 way{v[0], v[1], v[2]};
    const double length = norm(way);
    if (!(length > 0)) return {{0, 0, 1}, 0};
    return {way / length, 2 * std::atan2(length, w)};
}

bool is_along_an_axis(const Vec3& v)
{
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) > 1 - 1e-9;
}

/// How many points a dp apart stand on a side, half a dp and a little within its ends.
int points_on(double side, double dp)
{
    return std::max(1, static_cast<int>(std::lround(side / dp)));
}

void write_disc(const FluidInlet& inlet, const Vec3& place, double dp, XmlLines& xml)
{
    xml.open("circle");
    xml.line("<point {} />", xml_place(place));
    // The outermost stand half a dp within its rim, so that their number times dp^2 is the area.
    xml.line("<radius v=\"{}\" />", xml_number(std::max(inlet.face.radius - dp / 2, dp / 2)));
    xml.line("<direction {} />", xml_place(inlet.direction));
    xml.close("circle");
}

/// The solver's boxes stand along the axes; a turn takes them to where the face is.
void write_rectangle(const FluidInlet& inlet, const Vec3& place, double dp, XmlLines& xml)
{
    const FaceOutline& face = inlet.face;
    const Vec3 across = cross(inlet.direction, face.along);
    // A thousandth of dp more: the solver counts whole dp in a side.
    const double length = (points_on(face.length, dp) - 1 + 1e-3) * dp;
    const double width = (points_on(face.width, dp) - 1 + 1e-3) * dp;
    const bool is_straight = is_along_an_axis(inlet.direction) && is_along_an_axis(face.along);
    Vec3 size{length, width, 0};
    if (is_straight)
        for (int axis = 0; axis < 3; ++axis)
            size[axis] = std::abs(face.along[axis]) > 0.5 ? length
                         : std::abs(across[axis]) > 0.5   ? width
                                                          : 0;
    xml.open("box");
    xml.line("<point {} />", xml_place(place - 0.5 * size));
    xml.line("<size {} />", xml_place(size));
    xml.line("<direction {} />", xml_place(is_straight ? inlet.direction : Vec3{0, 0, 1}));
    if (!is_straight)
    {
        const Turn turn = turn_onto(face.along, across, inlet.direction);
        // The solver turns clockwise seen from point2, so this is counter-clockwise from point1.
        xml.open("rotateaxis angle=\"{}\" anglesunits=\"degrees\"",
                 xml_number(turn.radians * 180 / std::numbers::pi));
        xml.line("<point1 {} />", xml_place(place));
        xml.line("<point2 {} />", xml_place(place - turn.axis));
        xml.close("rotateaxis");
    }
    xml.close("box");
}

void write_speed(const FluidInlet& inlet, XmlLines& xml)
{
    xml.open("imposevelocity mode=\"0\" comment=\"0: fixed\"");
    if (inlet.litres_per_s > 0)
    {
        xml.line("<velocity v=\"{}\" units_comment=\"l/s\" />", xml_number(inlet.litres_per_s));
        xml.line(
            "<flowvelocity active=\"true\" ratio=\"1\" units=\"l/s\" comment=\"The solver finds "
            "the speed for its points\" />");
    }
    else
        xml.line("<velocity v=\"{}\" units_comment=\"m/s\" />",
                 xml_number(round_nearest(inlet.speed, 4)));
    xml.close("imposevelocity");
}

/// Where the outermost points of a zone, and one in its middle, stand on the face itself.
std::vector<Vec3> outline_points(const FluidInlet& inlet, double dp)
{
    constexpr int around = 24;
    const FaceOutline& face = inlet.face;
    std::vector<Vec3> out{face.middle};
    const auto add = [&](double u, double v)
    { out.push_back(face.middle + u * face.along + v * cross(inlet.direction, face.along)); };
    if (!face.is_disc)
    {
        const double u = (points_on(face.length, dp) - 1) * dp / 2;
        const double v = (points_on(face.width, dp) - 1) * dp / 2;
        for (const double a : {-1.0, -0.5, 0.0, 0.5, 1.0})
            for (const double side : {-1.0, 1.0})
            {
                add(a * u, side * v);
                add(side * u, a * v);
            }
        return out;
    }
    const double radius = std::max(face.radius - dp / 2, dp / 2);
    const auto [along, beside] = across(inlet.direction);
    for (int i = 0; i < around; ++i)
    {
        const double angle = 2 * std::numbers::pi * i / around;
        out.push_back(face.middle + radius * (std::cos(angle) * along + std::sin(angle) * beside));
    }
    return out;
}

/// The part that is in the way of a zone's rows, or between these and the face of a part; null
/// where none is. A sheet may stand in a wall.
const NewPart* in_the_way(const FluidInlet& inlet, double before, double dp,
                          const std::vector<std::pair<const NewPart*, MeshQuery>>& walls)
{
    for (const Vec3& point : outline_points(inlet, dp))
        for (double at_dp = inlet.is_sheet ? before - zone_layers + farther : 1; at_dp <= before;
             at_dp += farther)
        {
            const Vec3 at = point + inlet.direction * (at_dp * dp);
            for (const auto& [part, query] : walls)
                if (query.closest_point(at, off_walls * dp).distance < off_walls * dp) return part;
        }
    return nullptr;
}

} // namespace

void place_inlets(CasePlan& plan)
{
    std::vector<std::pair<const NewPart*, MeshQuery>> walls;
    for (const NewPart& part : plan.parts)
        if (part.role != PartRole::Inlet && !plan.inlets.empty())
            walls.emplace_back(&part, MeshQuery(soup_of(part.mesh), plan.options->threads));
    for (FluidInlet& inlet : plan.inlets)
    {
        const NewPart* obstacle = nullptr;
        const auto fits = [&](double dp)
        {
            for (inlet.before_dp = before_face; inlet.before_dp <= farthest_before_face;
                 inlet.before_dp += farther)
            {
                const NewPart* found = in_the_way(inlet, inlet.before_dp, dp, walls);
                if (found == nullptr) return true;
                if (obstacle == nullptr) obstacle = found;
            }
            return false;
        };
        if (fits(plan.dp)) continue;
        constexpr int most_tries = 20;
        double enough = plan.dp;
        int tries = 0;
        while (tries < most_tries && !fits(enough *= 0.8)) ++tries;
        throw GeometryError(fmt::format(
            "--inlet {}: there is no room for the zone before its face: it begins {} dp or more "
            "before the face, and its {} layers reach back from there; {} is in the way. Expected "
            "{}a face with more room before it",
            inlet.name, before_face, zone_layers, obstacle->path,
            tries == most_tries
                ? ""
                : fmt::format("a dp of {} m or less, or ", short_number(enough, 2))));
    }
}

void write_inlet_zones(const CasePlan& plan, XmlLines& xml)
{
    if (plan.inlets.empty()) return;
    xml.open("special");
    xml.open("inout");
    for (const FluidInlet& inlet : plan.inlets)
    {
        const Vec3 place = inlet.face.middle + inlet.direction * (inlet.before_dp * plan.dp);
        xml.comment(fmt::format("{}: {} dp before its face.", inlet.name, inlet.before_dp));
        xml.open("inoutzone");
        xml.line(
            "<refilling value=\"0\" comment=\"0: full, 1: below the surface, 2: advanced\" />");
        xml.line(
            "<inputtreatment value=\"0\" comment=\"0: particles that come in stay as they are\" "
            "/>");
        xml.line("<layers value=\"{}\" comment=\"Of particles that are pushed in\" />",
                 zone_layers);
        xml.open("zone3d");
        if (inlet.face.is_disc)
            write_disc(inlet, place, plan.dp, xml);
        else
            write_rectangle(inlet, place, plan.dp, xml);
        xml.close("zone3d");
        write_speed(inlet, xml);
        xml.line("<imposerhop mode=\"0\" comment=\"0: rhop0\" />");
        xml.close("inoutzone");
    }
    xml.close("inout");
    xml.close("special");
}

} // namespace fppg
