#include "casedef/inout_zones.h"

#include "casedef/execution.h"
#include "core/finite_number.h"
#include "core/text.h"
#include "core/transforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

namespace fppg
{
namespace
{

double number(const Element* e, std::string_view name)
{
    const std::string* text = e == nullptr ? nullptr : e->find_attribute(name);
    return text == nullptr ? 0 : finite_signed_number(trimmed(*text)).value_or(0);
}

Vec3 vector(const Element* e)
{
    return {number(e, "x"), number(e, "y"), number(e, "z")};
}

double angle_of(const Element& e)
{
    const std::string* unit = e.find_attribute("anglesunits");
    const double angle = number(&e, "angle");
    return unit != nullptr && lower_case(*unit) == "radians" ? angle : radians(angle);
}

/// What turns a zone; the identity where nothing does. A turn by Euler angles is not followed:
/// `by_euler` is its centre.
Transform turn_of(const Element& shape, const Vec3& first, std::optional<Vec3>& by_euler)
{
    Vec3 centre = first;
    Vec3 axis;
    double angle = 0;
    if (const Element* e = shape.find_child("rotate"))
    {
        // Of lines in x and z.
        if (e->find_attribute("centerx") != nullptr)
            centre = {number(e, "centerx"), first.y, number(e, "centerz")};
        axis = {0, 1, 0};
        angle = angle_of(*e);
    }
    else if (const Element* about = shape.find_child("rotateaxis"))
    {
        centre = vector(about->find_child("point1"));
        axis = vector(about->find_child("point2")) - centre;
        angle = angle_of(*about);
    }
    else if (const Element* euler = shape.find_child("rotateadv"))
        by_euler = vector(euler->find_child("center"));
    if (!(norm(axis) > 0)) return {};
    // The solver turns clockwise seen from the second point, x towards z about y
    // (JMatrix4::MatrixRot).
    return translation(centre) * rotation(axis, -angle) * translation(-1.0 * centre);
}

/// The corners of a line, box or circle; empty for other shapes.
std::vector<Vec3> corners_of(const Element& shape)
{
    const Vec3 a = vector(shape.find_child("point"));
    Vec3 size;
    if (shape.name == "line")
        size = vector(shape.find_child("point2")) - a;
    else if (shape.name == "box")
        size = vector(shape.find_child("size"));
    else if (shape.name != "circle")
        return {};
    const double radius = number(shape.find_child("radius"), "v");
    const Vec3 way = vector(shape.find_child("direction"));
    const auto half = [&](double along)
    {
        if (!(norm(way) > 0)) return radius;
        return radius * std::sqrt(std::max(0.0, 1 - std::pow(along / norm(way), 2)));
    };
    const Vec3 off{half(way.x), half(way.y), half(way.z)};
    const Vec3 low = a - off;
    const Vec3 across = size + 2 * off;
    std::vector<Vec3> out;
    for (unsigned corner = 0; corner < 8; ++corner)
        out.push_back(low + Vec3{(corner & 1U) != 0 ? across.x : 0,
                                 (corner & 2U) != 0 ? across.y : 0,
                                 (corner & 4U) != 0 ? across.z : 0});
    return out;
}

/// Where points begin on a side, and how far apart they are: whole dp, or a little less where the
/// side is nearly one dp longer.
struct Side
{
    int count = 1;
    double step = 0;

    Side(double length, double dp) : step(dp)
    {
        count = static_cast<int>(length / dp);
        if (length - dp * count > 0.95 * dp) step = length / ++count;
        ++count;
    }
};

/// Rings about the middle; where on them points begin is as in the solver (VecOrthogonal2).
void add_ring_points(const Vec3& middle, double radius, const Vec3& way, double dp,
                     std::vector<Vec3>& out)
{
    const Vec3 along = way.x != 0   ? Vec3{-way.z, 0, way.x}
                       : way.y != 0 ? Vec3{0, -way.z, way.y}
                                    : Vec3{way.z, 0, -way.x};
    const Vec3 first = (1 / norm(along)) * along;
    const Vec3 second = cross(way, first);
    const int rings = std::max(1, static_cast<int>((radius + dp / 4) / dp));
    for (int ring = 0; ring <= rings; ++ring)
    {
        const double at = radius * ring / rings;
        const double around = 2 * std::numbers::pi;
        const int count = std::max(1, static_cast<int>((around * at + dp / 2) / dp));
        for (int i = 0; i < count; ++i)
        {
            const double angle = around * i / count;
            out.push_back(middle + at * std::cos(angle) * first + at * std::sin(angle) * second);
        }
    }
}

/// The points that the solver sets in a line, box or circle, before any turn (v5.4,
/// JSphInOutPoints::Create2d_Line, Create3d_Box, Create3d_Circle).
///
/// way  unit, before any turn
std::vector<Vec3> points_in(const Element& shape, const Vec3& way, const LatticeGrid& grid)
{
    constexpr double most = 1e7; // a wrong size is for the solver to refuse
    std::vector<Vec3> out;
    const double dp = grid.dp;
    const Vec3 a = vector(shape.find_child("point"));
    if (shape.name == "line")
    {
        const Vec3 begin{a.x, grid.origin.y, a.z};
        const Vec3 b = vector(shape.find_child("point2"));
        const Vec3 along = Vec3{b.x, grid.origin.y, b.z} - begin;
        if (!(norm(along) > 0) || norm(along) > most * dp) return out;
        const Side side(norm(along), dp);
        for (int i = 0; i < side.count; ++i)
            out.push_back(begin + (i * side.step / norm(along)) * along);
    }
    else if (shape.name == "box")
    {
        const Vec3 size = vector(shape.find_child("size"));
        if (size.x < 0 || size.y < 0 || size.z < 0 ||
            (size.x / dp + 1) * (size.y / dp + 1) * (size.z / dp + 1) > most)
            return out;
        const Side x(size.x, dp), y(size.y, dp), z(size.z, dp);
        for (int k = 0; k < z.count; ++k)
            for (int j = 0; j < y.count; ++j)
                for (int i = 0; i < x.count; ++i)
                    out.push_back(a + Vec3{i * x.step, j * y.step, k * z.step});
    }
    else if (const double radius = number(shape.find_child("radius"), "v");
             radius >= 0 && radius / dp < std::sqrt(most) && norm(way) > 0)
        add_ring_points(a, radius, way, dp, out);
    return out;
}

/// The way in which fluid comes in through a shape, unit; zero where it is not known.
Vec3 way_through(const Element& shape)
{
    const Element* direction = shape.find_child("direction");
    Vec3 way = vector(direction);
    if (direction == nullptr && shape.name == "line")
    {
        const Vec3 along = vector(shape.find_child("point2")) - vector(shape.find_child("point"));
        way = {-along.z, 0, along.x};
    }
    return norm(way) > 0 ? (1 / norm(way)) * way : Vec3{};
}

/// The way in which fluid comes in, of `<particles direction="right">`.
Vec3 way_of(const Element& particles)
{
    constexpr std::array<std::pair<std::string_view, Vec3>, 6> ways{{{"left", {-1, 0, 0}},
                                                                     {"right", {1, 0, 0}},
                                                                     {"front", {0, -1, 0}},
                                                                     {"back", {0, 1, 0}},
                                                                     {"bottom", {0, 0, -1}},
                                                                     {"top", {0, 0, 1}}}};
    const std::string* text = particles.find_attribute("direction");
    if (text == nullptr) return {};
    const std::string name = lower_case(trimmed(*text));
    for (const auto& [word, way] : ways)
        if (name == word) return way;
    return way_through(particles); // "custom"
}

/// Adds the zone that a shape gives. False: it is not known.
///
/// layers  of the zone
bool add_shape(const Element& shape, int layers, const CaseDef& def, InOutZones& zones)
{
    if (shape.name == "particles")
    {
        const double mkfluid = number(&shape, "mkfluid");
        if (mkfluid >= 0 && mkfluid + def.mk_fluid_first < def.mk_bound_first)
            zones.fluids[static_cast<std::uint16_t>(mkfluid + def.mk_fluid_first)] = {
                way_of(shape), layers, shape.line};
        return true;
    }
    std::vector<Vec3> corners = corners_of(shape);
    if (corners.empty()) return false;
    if (def.grid.is_2d && shape.name == "line")
        for (Vec3& c : corners) c.y = def.grid.origin.y;
    std::optional<Vec3> by_euler;
    const Transform turn = turn_of(shape, corners.front(), by_euler);
    Box3 box;
    for (const Vec3& c : corners)
    {
        box.add(turn(c));
        if (!by_euler) continue;
        const double reach = norm(c - *by_euler);
        box.add(*by_euler + Vec3{reach, reach, reach});
        box.add(*by_euler - Vec3{reach, reach, reach});
    }
    const Vec3 way = way_through(shape);
    InletShape zone{box, {}, layers, shape.line, {}};
    if (!by_euler)
    {
        zone.way = turn(way) - turn(Vec3{});
        zone.points = points_in(shape, way, def.grid);
        for (Vec3& p : zone.points) p = turn(p);
    }
    zones.shapes.push_back(std::move(zone));
    return true;
}

} // namespace

InOutZones read_inout_zones(const CaseDef& def, std::vector<std::string>& warnings)
{
    InOutZones zones;
    const auto read_zone = [&](const Element& zone)
    {
        bool is_known = false;
        constexpr double most_rows = 250; // as the solver
        const int layers = static_cast<int>(
            std::clamp(number(zone.find_child("layers"), "value"), 1.0, most_rows));
        for_each_read(zone,
                      [&](const Element& of)
                      {
                          if (of.name != "zone2d" && of.name != "zone3d") return;
                          for_each_read(
                              of, [&](const Element& shape)
                              { is_known = add_shape(shape, layers, def, zones) || is_known; });
                      });
        if (!is_known)
            warnings.push_back(fmt::format(
                "{}:{}: <{}>: where it lets fluid in or out is not known, expected <zone2d> or "
                "<zone3d> with <particles>, <line>, <box> or <circle>; fluid beside it that is "
                "near "
                "body-fitted walls is moved off the lattice.",
                def.file, zone.line, zone.name));
    };
    for_each_special(def.execution, "inout",
                     [&](const Element& zone)
                     {
                         if (zone.name == "inoutzone") read_zone(zone);
                     });
    return zones;
}

} // namespace fppg
