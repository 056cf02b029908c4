#include "newcase/xml_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fppg
{

namespace
{

/// Layers of particles behind the plane of a zone.
constexpr int zone_layers = 4;
/// How far the plane stands before the face: its layers, and what walls take there; dp.
constexpr double before_face = zone_layers + 1;

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

} // namespace

void write_inlet_zones(const CasePlan& plan, XmlLines& xml)
{
    if (plan.inlets.empty()) return;
    xml.open("special");
    xml.open("inout");
    for (const FluidInlet& inlet : plan.inlets)
    {
        const Vec3 place = inlet.face.middle + inlet.direction * (before_face * plan.dp);
        xml.comment(fmt::format("{}: {} dp before its face.", inlet.name, before_face));
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
