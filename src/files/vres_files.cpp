#include "files/vres_xml.h"
#include "files/vtk.h"
#include "files/xml_tags.h"
#include "fppg/files.h"

#include <fmt/format.h>

namespace fppg
{
namespace
{

void add_box(Element& out, const ZoneBox& box, bool is_2d)
{
    out.children.push_back(vector_tag("pointmin", box.corner));
    if (box.is_plain)
    {
        out.children.push_back(vector_tag("pointmax", box.far_corner()));
        return;
    }
    out.children.push_back(vector_tag("vectorx", box.edges[0]));
    if (!is_2d) out.children.push_back(vector_tag("vectory", box.edges[1]));
    out.children.push_back(vector_tag("vectorz", box.edges[2]));
}

Element zone_tag(const CaseDef& def, std::size_t id)
{
    const VresDef& vres = def.vres;
    const VresZone& zone = vres.zones[id];
    Element out = tag("bufferbox");
    out.set_attribute("id", fmt::format("{}", id));
    if (id > 0)
    {
        out.set_attribute("parentid", fmt::format("{}", zone.parent));
    }
    out.set_attribute("dp", number(zone.dp));
    const auto add = [&](const char* name, const ZoneBox& box, double grow)
    {
        Element e = tag(name);
        add_box(e, resized(box, grow, vres.is_2d), vres.is_2d);
        out.children.push_back(std::move(e));
    };
    Element full = tag("fulldomain");
    full.children.push_back(vector_tag("pointref", zone.pointref));
    if (id == 0)
    {
        add_box(full, zone.inner, vres.is_2d);
        out.children.push_back(std::move(full));
    }
    else
    {
        const double outer_dp = vres.zones[static_cast<std::size_t>(zone.parent)].dp;
        out.set_attribute("dpratio", number(outer_dp / zone.dp));
        if (zone.tracked_mkbound)
        {
            Element tracking = tag("tracking");
            tracking.set_attribute("mkbound", fmt::format("{}", *zone.tracked_mkbound));
            tracking.set_attribute("mk",
                                   fmt::format("{}", *zone.tracked_mkbound + def.mk_bound_first));
            out.children.push_back(std::move(tracking));
        }
        add_box(full, resized(zone.full, zone.dp / 2, vres.is_2d), vres.is_2d);
        out.children.push_back(std::move(full));
        add("bufferdomain", zone.buffer, zone.dp / 2);
        add("innerdomain", zone.inner, zone.dp / 2);
        add("parentbufferinilimits", zone.outer_begin, -outer_dp / 2);
        add("parentbufferendlimits", zone.outer_end, -outer_dp / 2);
        add("parentfixedlimits", zone.outer_fixed, -outer_dp / 2);
    }
    if (!zone.extra.empty())
    {
        Element extra = tag("extra");
        extra.children = zone.extra;
        out.children.push_back(std::move(extra));
    }
    for (std::size_t i = id + 1; i < vres.zones.size(); ++i)
        if (vres.zones[i].parent == static_cast<int>(id)) out.children.push_back(zone_tag(def, i));
    return out;
}

/// A limit of a zone's domain from that of the particles around it: a number as it is, default,
/// default and this many metres or percent of the size beyond.
double limit_from(const std::string& text, double limit, double size, double outwards)
{
    if (text == "default") return limit;
    if (!text.starts_with("default")) return std::stod(text);
    // "default - 10%" and "default + 0.1"
    const double value = std::stod(text.substr(10));
    return limit + outwards * (text.ends_with('%') ? size * value / 100 : value);
}

} // namespace

Element vres_tag(const CaseDef& def)
{
    Element out = tag("vres");
    out.set_attribute("selid", fmt::format("{}", def.zone));
    if (def.vres.is_2d) out.set_attribute("posy2d", number(def.vres.y_2d));
    out.children.push_back(zone_tag(def, 0));
    return out;
}

std::optional<Element> zone_domain_tag(const CaseDef& def)
{
    const VresZone& zone = def.vres.zones[def.zone];
    bool is_default = true;
    for (const std::string& text : zone.simulation_domain)
        is_default = is_default && text == "default";
    if (is_default && !zone.uses_parent_domain) return std::nullopt;
    Element out = tag("simulationdomain");
    out.set_attribute("comment", "Defines simulation domain for subdomain");
    for (std::size_t side = 0; side < 2; ++side)
    {
        Element limit = tag(side == 0 ? "posmin" : "posmax");
        for (int axis = 0; axis < 3; ++axis)
        {
            std::string text = zone.simulation_domain[side * 3 + static_cast<std::size_t>(axis)];
            if (zone.uses_parent_domain)
            {
                const Box3& around = def.particles_around;
                text =
                    number(limit_from(text, side == 0 ? around.min[axis] : around.max[axis],
                                      around.max[axis] - around.min[axis], side == 0 ? -1.0 : 1.0));
            }
            limit.set_attribute(std::string(1, "xyz"[axis]), text);
        }
        out.children.push_back(std::move(limit));
    }
    return out;
}

namespace
{

/// Cells of equal size for a picture of boxes.
struct ZoneCells
{
    std::string points;
    std::string zones;
    std::uint32_t corners = 0; ///< a cell
    std::uint32_t count = 0;

    void add(const std::vector<Vec3>& cell, std::size_t zone)
    {
        for (const Vec3& p : cell)
            for (int axis = 0; axis < 3; ++axis)
                append_big_endian(points, static_cast<float>(p[axis]));
        append_big_endian(zones, static_cast<std::uint32_t>(zone));
        corners = static_cast<std::uint32_t>(cell.size());
        ++count;
    }

    void write(OutputFile& file) const
    {
        file.append(fmt::format("{}POINTS {} float\n", vtk_head, count * corners));
        file.append(points);
        std::string connectivity;
        for (std::uint32_t i = 0; i < count; ++i)
        {
            append_big_endian(connectivity, corners);
            for (std::uint32_t k = 0; k < corners; ++k)
                append_big_endian(connectivity, i * corners + k);
        }
        file.append(fmt::format("\n{} {} {}\n", corners == 2 ? "LINES" : "POLYGONS", count,
                                count * (corners + 1)));
        file.append(connectivity);
        file.append(fmt::format("\nCELL_DATA {}\nSCALARS Zone int\nLOOKUP_TABLE default\n", count));
        file.append(zones);
        file.append("\n");
    }
};

/// Corners of the rectangle of a 2D box, around it.
std::array<Vec3, 4> rectangle(const ZoneBox& box)
{
    const Vec3& c = box.corner;
    return {c, c + box.edges[0], c + box.edges[0] + box.edges[2], c + box.edges[2]};
}

void add_rectangle(ZoneCells& cells, const ZoneBox& box, std::size_t zone)
{
    const std::array<Vec3, 4> p = rectangle(box);
    for (std::size_t i = 0; i < 4; ++i) cells.add({p[i], p[(i + 1) % 4]}, zone);
}

/// The six faces: below, above, front, back, right, left.
std::array<std::array<Vec3, 4>, 6> faces(const ZoneBox& box)
{
    const Vec3& a = box.corner;
    const auto& [x, y, z] = box.edges;
    return {{{a, a + y, a + x + y, a + x},
             {a + z, a + x + z, a + x + y + z, a + y + z},
             {a, a + x, a + x + z, a + z},
             {a + x + y, a + y, a + y + z, a + x + y + z},
             {a + x, a + x + y, a + x + y + z, a + x + z},
             {a, a + z, a + y + z, a + y}}};
}

void add_faces(ZoneCells& cells, const ZoneBox& box, std::size_t zone, bool as_lines)
{
    for (const std::array<Vec3, 4>& face : faces(box))
    {
        if (!as_lines) cells.add({face.begin(), face.end()}, zone);
        for (std::size_t i = 0; as_lines && i < 4; ++i)
            cells.add({face[i], face[(i + 1) % 4]}, zone);
    }
}

} // namespace

void write_zone_vtk(OutputFile& file, const VresDef& vres, std::size_t id)
{
    const VresZone& zone = vres.zones[id];
    ZoneCells cells;
    const auto add = [&](const ZoneBox& box, double grow)
    {
        const ZoneBox shown = grow != 0 ? resized(box, grow, vres.is_2d) : box;
        if (vres.is_2d)
            add_rectangle(cells, shown, id);
        else
            add_faces(cells, shown, id, false);
    };
    add(zone.inner, id > 0 ? zone.dp / 2 : 0);
    if (id > 0) add(zone.buffer, zone.dp / 2);
    for (const VresZone& inner : vres.zones)
    {
        if (inner.parent != static_cast<int>(id)) continue;
        add(inner.outer_begin, -zone.dp / 2);
        add(inner.outer_end, -zone.dp / 2);
        if (!vres.is_2d) continue;
        const std::array<Vec3, 4> begin = rectangle(resized(inner.outer_begin, -zone.dp / 2, true));
        const std::array<Vec3, 4> end = rectangle(resized(inner.outer_end, -zone.dp / 2, true));
        for (std::size_t i = 0; i < 4; ++i) cells.add({begin[i], end[i]}, id);
    }
    cells.write(file);
}

void write_zones_vtk(OutputFile& file, const VresDef& vres)
{
    ZoneCells cells;
    for (std::size_t id = 0; id < vres.zones.size(); ++id)
    {
        const VresZone& zone = vres.zones[id];
        const ZoneBox box = id > 0 ? resized(zone.inner, zone.dp / 2, vres.is_2d) : zone.inner;
        if (vres.is_2d)
            add_rectangle(cells, box, id);
        else
            add_faces(cells, box, id, true);
    }
    cells.write(file);
}

} // namespace fppg
