#include "casedef/normals.h"

#include "casedef/initials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace fppg
{
namespace
{

class NormalsReader
{
public:
    NormalsReader(const CaseDef& def, const AttributeReader& read,
                  std::vector<std::string>& warnings)
        : def_(def), read_(read), warnings_(warnings)
    {
    }

    NormalsDef run(const Element& list) const
    {
        NormalsDef normals;
        normals.is_active = read_.flag_or(list, "active", true);
        if (!normals.is_active) return normals;
        if (list.find_child("geometryfile") != nullptr)
        {
            normals.geometry = read_old_form(list);
            return normals;
        }
        for (const Element* e : active_children(list, read_))
        {
            if (e->name != "norgeometry")
            {
                normals.ops.push_back(read_op(*e));
                continue;
            }
            if (normals.geometry)
                read_.fail(*e, "is there twice, only one norgeometry is possible");
            normals.geometry = read_geometry(*e);
        }
        return normals;
    }

private:
    GeometryNormals read_geometry(const Element& e) const
    {
        require_known_children(e, {"geometryfile", "distanceh", "maxsizeh", "svshapes"}, read_);
        if (e.find_attribute("mkbound") != nullptr)
            read_.fail(e,
                       "attribute 'mkbound' is not possible here: norgeometry is for every "
                       "boundary particle");
        require_known_attributes(e, {});
        return read_geometry(e, "v");
    }

    /// `<normals>` of GenCase v5.0: the children of norgeometry, with their values in `value`
    /// instead of `v`. A `<geometryfile>` in `<normals>` tells it; nothing else may stand beside.
    /// svnormals has no effect (GenCase v5.4.354: the same normals as in the new form for 11 of
    /// these). The others that GenCase v5.0 knows there, v5.4 refuses: with v5.0 they write files
    /// for debugging or change nothing, but for ftsupport, without which it gives floating bodies
    /// no normals (v5.0.229, a box that floats in a tank, with each of them on and off).
    GeometryNormals read_old_form(const Element& e) const
    {
        require_known_children(
            e,
            {"geometryfile", "distanceh", "maxsizeh", "svshapes", "svnormals", "svnormaldata",
             "computenormals", "ftsupport", "dg_svopenshapes", "dg_svpartsnormal"},
            read_);
        if (e.find_child("ftsupport") != nullptr && !flag(e, "ftsupport", true, "value"))
            warnings_.push_back(
                fmt::format("{}:{}: <ftsupport>: has no effect, floating bodies have "
                            "normals, as with GenCase v5.4.",
                            read_.file(), e.find_child("ftsupport")->line));
        GeometryNormals geometry = read_geometry(e, "value");
        std::string form = fmt::format("<norgeometry><geometryfile file=\"{}\" />",
                                       *read_.child(e, "geometryfile").find_attribute("file"));
        for (const char* name : {"distanceh", "maxsizeh", "svshapes"})
            if (const Element* c = e.find_child(name); c && c->find_attribute("value"))
                form += fmt::format("<{} v=\"{}\" />", name, *c->find_attribute("value"));
        warnings_.push_back(
            fmt::format("{}:{}: <normals>: this is the form of GenCase v5.0; in that of v5.4 write "
                        "<normals>{}</norgeometry></normals>.",
                        read_.file(), e.line, form));
        return geometry;
    }

    GeometryNormals read_geometry(const Element& e, const char* attribute) const
    {
        GeometryNormals geometry;
        geometry.line = e.line;
        const Element& file = read_.child(e, "geometryfile");
        // Without a '$' the name of the case alone is replaced.
        geometry.file = read_.text(file, "file");
        constexpr std::string_view name = "[CaseName]";
        for (std::size_t at = 0; (at = geometry.file.find(name, at)) != std::string::npos;
             at += def_.case_name.size())
            geometry.file.replace(at, name.size(), def_.case_name);
        geometry.distance_h = value(e, "distanceh", 2, attribute);
        if (geometry.distance_h == 0)
            read_.fail(*e.find_child("distanceh"), "is 0, expected a distance above 0");
        geometry.max_size_h = value(e, "maxsizeh", 0, attribute);
        geometry.save_shapes = flag(e, "svshapes", false, attribute);
        return geometry;
    }

    NormalOp read_op(const Element& e) const
    {
        NormalOp op;
        op.line = e.line;
        const std::vector<std::string_view> common{"onlypos", "maxdisth", "clear"};
        const auto know = [&](std::vector<std::string_view> own)
        {
            own.insert(own.end(), common.begin(), common.end());
            require_known_children(e, own, read_);
        };
        if (e.name == "norset")
        {
            require_known_children(e, {"onlypos", "normal"}, read_);
            op.what = SetNormals{read_.child_vec3(e, "normal")};
        }
        else if (e.name == "norplane")
        {
            know({"point", "limitdist", "normal"});
            op.what = read_plane(e);
        }
        else if (e.name == "norsphere")
        {
            know({"center", "radius", "inside"});
            op.what = SphereNormals{read_.child_vec3(e, "center"), radius(e),
                                    flag(read_.child(e, "inside"))};
        }
        else if (e.name == "norcylinder")
        {
            know({"center1", "center2", "radius", "inside", "limit1", "limit2"});
            op.what = read_cylinder(e);
        }
        else if (e.name == "norparts")
        {
            require_known_children(e, {"maxdisth"}, read_);
            if (!def_.grid.is_2d) read_.fail(e, "is possible in 2-D cases only");
            op.what = PartNormals{};
        }
        else
            read_.fail(e,
                       "is not known in <normals>, expected norgeometry, norset, norplane, "
                       "norsphere, norcylinder or norparts");
        require_known_attributes(e, {"mkbound"});
        op.only = read_only_pos(e, read_);
        op.max_distance_h = value(e, "maxdisth", 2);
        op.clear = flag(e, "clear", op.clear);
        read_selection(e, op);
        return op;
    }

    void read_selection(const Element& e, NormalOp& op) const
    {
        op.has_mk = e.find_attribute("mkbound") != nullptr;
        if (op.has_mk)
            for (const std::uint16_t mk : read_.number_list(e, "mkbound"))
                if (mk < def_.mkbound_count)
                    op.mk.push_back(static_cast<std::uint16_t>(mk + def_.mk_bound_first));
        if (op.has_mk || e.name != "norplane") return;
        op.has_mk = true;
        warnings_.push_back(fmt::format(
            "{}:{}: <norplane>: without mkbound it selects no particle, as with GenCase v5.4; name "
            "those that are meant, such as mkbound=\"0-9\".",
            read_.file(), e.line));
    }

    PlaneNormals read_plane(const Element& e) const
    {
        PlaneNormals plane;
        const Element& point = read_.child(e, "point");
        if (!read_.flag_or(point, "auto", false)) plane.point = read_.vec3(point);
        if (has_value(e, "limitdist", "vdp", fmt::format("{:g}", plane.limit_dp)))
            plane.limit_dp = read_.number(*e.find_child("limitdist"), "vdp");
        plane.normal = read_.child_vec3(e, "normal");
        return plane;
    }

    CylinderNormals read_cylinder(const Element& e) const
    {
        CylinderNormals cylinder;
        cylinder.center1 = read_.child_vec3(e, "center1");
        cylinder.center2 = read_.child_vec3(e, "center2");
        cylinder.radius = radius(e);
        cylinder.is_inside = flag(read_.child(e, "inside"));
        cylinder.limits[0] = flag(e, "limit1", cylinder.limits[0]);
        cylinder.limits[1] = flag(e, "limit2", cylinder.limits[1]);
        return cylinder;
    }

    void require_known_attributes(const Element& e, std::vector<std::string_view> own) const
    {
        own.insert(own.end(), {"active", "if", "comment"});
        for (const Element::Attribute& a : e.attributes)
            if (!a.name.starts_with('_') && std::find(own.begin(), own.end(), a.name) == own.end())
                read_.fail_unknown_attribute(e, a, own);
    }

    /// Whether a child is there with its attribute; one without it has no effect, and a warning
    /// says so.
    bool has_value(const Element& e, const char* name, const char* attribute,
                   const std::string& otherwise) const
    {
        const Element* c = e.find_child(name);
        if (c == nullptr) return false;
        if (c->find_attribute(attribute) != nullptr) return true;
        warnings_.push_back(
            fmt::format("{}:{}: <{}>: has no attribute {}, so {} is taken, as with "
                        "GenCase v5.4.",
                        read_.file(), c->line, name, attribute, otherwise));
        return false;
    }

    /// The value of a child, at least 0.
    double value(const Element& e, const char* name, double otherwise,
                 const char* attribute = "v") const
    {
        return has_value(e, name, attribute, fmt::format("{:g}", otherwise))
                   ? positive(*e.find_child(name), attribute)
                   : otherwise;
    }
    double radius(const Element& e) const { return positive(read_.child(e, "radius"), "v"); }
    double positive(const Element& e, const char* attribute) const
    {
        const double v = read_.number(e, attribute);
        if (!(v >= 0))
            read_.fail(e, fmt::format("{}=\"{:g}\" is invalid, expected 0 or more", attribute, v));
        return v;
    }
    bool flag(const Element& e, const char* name, bool otherwise, const char* attribute = "v") const
    {
        return has_value(e, name, attribute, otherwise ? "true" : "false")
                   ? read_.flag_or(*e.find_child(name), attribute, otherwise)
                   : otherwise;
    }
    bool flag(const Element& e) const
    {
        read_.text(e, "v");
        return read_.flag_or(e, "v", true);
    }

    const CaseDef& def_;
    const AttributeReader& read_;
    std::vector<std::string>& warnings_;
};

} // namespace

NormalsDef read_normals(const Element& list, const CaseDef& def, const AttributeReader& read,
                        std::vector<std::string>& warnings)
{
    return NormalsReader(def, read, warnings).run(list);
}

void warn_of_refused_normals(const CaseDef& def, const AttributeReader& read,
                             std::vector<std::string>& warnings)
{
    constexpr std::array<std::string_view, 4> refused{"boundnormal_plane", "boundnormal_sphere",
                                                      "boundnormal_cylinder", "boundnormal_parts"};
    for (const Element& special : def.execution)
    {
        if (special.kind != Element::Kind::Tag || special.name != "special") continue;
        const Element* initialize = special.find_child("initialize");
        if (initialize == nullptr) continue;
        for (const Element* e : active_children(*initialize, read))
            if (std::find(refused.begin(), refused.end(), e->name) != refused.end())
                warnings.push_back(fmt::format(
                    "{}:{}: <{}>: the solver of v5.4 stops at it; \"fppg upgrade\" turns it into "
                    "its form in <casedef><normals>.",
                    def.file, e->line, e->name));
    }
}

} // namespace fppg
