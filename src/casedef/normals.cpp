#include "casedef/normals.h"

#include "casedef/initials.h"

#include <fmt/format.h>

#include <algorithm>

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
        GeometryNormals geometry;
        geometry.line = e.line;
        const Element& file = read_.child(e, "geometryfile");
        geometry.file = read_.interpolated(file, read_.text(file, "file"));
        geometry.distance_h = value(e, "distanceh", 2);
        geometry.max_size_h = value(e, "maxsizeh", 0);
        if (const Element* c = e.find_child("svshapes")) geometry.save_shapes = flag(*c);
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
        op.only = read_only_pos(e, read_);
        op.max_distance_h = value(e, "maxdisth", 2);
        if (const Element* c = e.find_child("clear")) op.clear = flag(*c);
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
        if (const Element* c = e.find_child("limitdist")) plane.limit_dp = read_.number(*c, "vdp");
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
        if (const Element* c = e.find_child("limit1")) cylinder.limits[0] = flag(*c);
        if (const Element* c = e.find_child("limit2")) cylinder.limits[1] = flag(*c);
        return cylinder;
    }

    /// Attribute v of a child, at least 0.
    double value(const Element& e, const char* name, double otherwise) const
    {
        const Element* c = e.find_child(name);
        return c == nullptr ? otherwise : positive(*c);
    }
    double radius(const Element& e) const { return positive(read_.child(e, "radius")); }
    double positive(const Element& e) const
    {
        const double v = read_.number(e, "v");
        if (!(v >= 0)) read_.fail(e, fmt::format("v=\"{:g}\" is invalid, expected 0 or more", v));
        return v;
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

} // namespace fppg
