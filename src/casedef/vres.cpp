#include "casedef/vres.h"

#include "casedef/execution.h"
#include "core/transforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

namespace fppg
{

Box3 limits_of(const ZoneBox& box)
{
    Box3 out;
    for (unsigned i = 0; i < 8; ++i)
    {
        Vec3 p = box.corner;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if ((i >> axis & 1U) != 0) p = p + box.edges[axis];
        out.add(p);
    }
    return out;
}

ZoneBox resized(ZoneBox box, double by, bool is_2d)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (is_2d && axis == 1) continue;
        Vec3& edge = box.edges[axis];
        const double length = norm(edge);
        Vec3 step = edge * (by / length);
        if (box.is_plain)
        {
            step = {};
            step[static_cast<int>(axis)] = by;
            edge[static_cast<int>(axis)] += by + by;
        }
        else
            edge = edge * ((length + by + by) / length);
        box.corner = box.corner - step;
    }
    return box;
}

namespace
{

/// Rounding of a place on a lattice, in dp.
constexpr double fit_tolerance = 0.001;

/// A width as a whole number of dp, rounded up.
double whole_steps(double width, double dp)
{
    return dp * std::trunc((width + dp * (1 - fit_tolerance)) / dp);
}

class VresReader
{
public:
    VresReader(const Element& definition, const AttributeReader& read, Variables& variables,
               CaseDef& def)
        : definition_(definition), read_(read), variables_(variables), def_(def)
    {
        const ConstantsDef& c = def.constants;
        h_per_dp_ = c.hdp ? *c.hdp : c.coef_h.value_or(1) * std::sqrt(def.grid.is_2d ? 2.0 : 3.0);
        out_.is_2d = def.grid.is_2d;
        out_.y_2d = def.grid.is_2d ? def.grid.origin.y : 0;
    }

    VresDef run(const Element& e, const Vec3& ref)
    {
        check_children(e, {"bufferbox", "buffsizeh", "simulationdomain", "extra"});
        VresZone whole;
        whole.line = e.line;
        whole.dp = def_.grid.dp;
        whole.pointref = ref;
        if (out_.is_2d) whole.pointref.y = 0;
        whole.inner = plain_box(def_.case_pos_min, def_.case_pos_max);
        read_common(e, whole);
        if (whole.uses_parent_domain)
            read_.fail(*e.find_child("simulationdomain"),
                       "useparent=\"true\" is invalid for the whole domain, which has no parent");
        out_.zones.push_back(std::move(whole));
        read_boxes(e, 0);
        if (out_.zones.size() < 2)
            read_.fail(e, "no region is defined, expected a <bufferbox> that is active");
        // GenCase names the files with two digits.
        if (out_.zones.size() > 100)
            read_.fail(e, fmt::format("{} regions, expected at most 99", out_.zones.size() - 1));
        return std::move(out_);
    }

private:
    void check_children(const Element& e, const std::set<std::string>& known) const
    {
        for (const Element& c : e.children)
            if (c.kind == Element::Kind::Tag && !c.name.starts_with('_') && !known.contains(c.name))
                read_.fail_unknown_element(c, e.name, {known.begin(), known.end()});
    }

    void check_attributes(const Element& e, const std::set<std::string>& known) const
    {
        for (const Element::Attribute& a : e.attributes)
            if (!known.contains(a.name) && a.name != "comment" && !a.name.starts_with('_'))
                read_.fail_unknown_attribute(e, a, {known.begin(), known.end()});
    }

    double value_of(const Element& e, const char* name, double otherwise) const
    {
        const Element* c = e.find_child(name);
        return c != nullptr ? read_.number(*c, "v") : otherwise;
    }

    void read_common(const Element& e, VresZone& zone) const
    {
        zone.buffer_h = value_of(e, "buffsizeh", 2);
        if (!std::isfinite(zone.buffer_h))
            read_.fail(*e.find_child("buffsizeh"), "expected a finite width in h");
        if (const Element* domain = e.find_child("simulationdomain"))
            read_simulation_domain(*domain, zone);
        if (const Element* extra = e.find_child("extra")) zone.extra = copied(*extra);
    }

    /// Elements and attributes without those of an underscore, comments and texts.
    static std::vector<Element> copied(const Element& e)
    {
        std::vector<Element> out;
        for (const Element& c : e.children)
        {
            if (c.kind != Element::Kind::Tag || c.name.starts_with('_')) continue;
            Element copy = c;
            copy.text.clear();
            copy.tail.clear();
            std::erase_if(copy.attributes,
                          [](const Element::Attribute& a) { return a.name.starts_with('_'); });
            copy.children = copied(c);
            out.push_back(std::move(copy));
        }
        return out;
    }

    void read_simulation_domain(const Element& e, VresZone& zone) const
    {
        check_children(e, {"posmin", "posmax"});
        check_attributes(e, {"useparent"});
        zone.uses_parent_domain = read_.flag_or(e, "useparent", false);
        for (const char* limit : {"posmin", "posmax"})
            for (const char* axis : {"x", "y", "z"})
            {
                const Element* c = e.find_child(limit);
                const std::string text =
                    c != nullptr ? read_.text_or(*c, axis, "default") : "default";
                zone.simulation_domain.push_back(domain_limit(read_, c != nullptr ? *c : e, text,
                                                              limit == std::string_view("posmin")));
            }
    }

    void read_boxes(const Element& e, std::size_t parent)
    {
        for (const Element& c : e.children)
            if (c.kind == Element::Kind::Tag && c.name == "bufferbox" &&
                read_.flag_or(c, "active", true))
                read_box(c, parent);
    }

    void read_box(const Element& e, std::size_t parent)
    {
        check_children(e, {"bufferbox", "dpratio", "buffsizeh", "overlappingh", "point", "size",
                           "endpoint", "tracking", "simulationdomain", "extra", "transform"});
        for (const Element::Attribute& attribute : e.attributes)
            if (attribute.name != "active" && attribute.name != "comment" &&
                !attribute.name.starts_with('_'))
                def_.warnings.push_back(
                    fmt::format("{}:{}: <bufferbox>: attribute '{}' has no effect, as in GenCase; "
                                "active=\"#...\" takes an expression.",
                                def_.file, e.line, attribute.name));
        VresZone zone;
        zone.line = e.line;
        zone.parent = static_cast<int>(parent);
        const double ratio = read_.number(read_.child(e, "dpratio"), "v");
        if (!(ratio > 0) || !std::isfinite(ratio))
            read_.fail(
                *e.find_child("dpratio"),
                fmt::format("{:g} is invalid, expected dp outside over dp inside, above 0", ratio));
        zone.dp = out_.zones[parent].dp / ratio;
        read_common(e, zone);
        if (const Element* tracking = e.find_child("tracking"))
        {
            check_attributes(*tracking, {"mkbound"});
            zone.tracked_mkbound = read_.integer(*tracking, "mkbound", 0, 60000, true);
        }
        zone.pointref = pointref(zone.dp);
        const double overlap = value_of(e, "overlappingh", 0) * (zone.dp * h_per_dp_);
        if (!std::isfinite(overlap))
            read_.fail(*e.find_child("overlappingh"), "expected a finite width in h");
        zone.inner = fitted(read_limits(e), zone);
        make_boxes(e, zone, overlap);
        out_.zones.push_back(std::move(zone));
        read_boxes(e, out_.zones.size() - 1);
    }

    /// As the definition gives it for a dp.
    Vec3 pointref(double dp) const
    {
        const Element* ref = definition_.find_child("pointref");
        if (ref == nullptr) return {};
        variables_.save();
        variables_.erase("Dp");
        variables_.predefine("Dp", dp);
        const Vec3 out = read_.vec3_or(*ref, {});
        variables_.load();
        return out;
    }

    ZoneBox plain_box(const Vec3& low, const Vec3& high) const
    {
        ZoneBox box;
        box.corner = low;
        for (int axis = 0; axis < 3; ++axis)
            box.edges[static_cast<std::size_t>(axis)][axis] = high[axis] - low[axis];
        if (out_.is_2d)
        {
            box.corner.y = out_.y_2d;
            box.edges[1] = {};
        }
        return box;
    }

    ZoneBox read_limits(const Element& e) const
    {
        const Vec3 low = read_.child_vec3(e, "point");
        if (e.find_child("size") != nullptr && e.find_child("endpoint") != nullptr)
            read_.fail(e, "has both <size> and <endpoint>, expected one of them");
        const Vec3 high = e.find_child("endpoint") != nullptr ? read_.child_vec3(e, "endpoint")
                                                              : low + read_.child_vec3(e, "size");
        for (int axis = 0; axis < 3; ++axis)
            if (!(low[axis] <= high[axis]) && !(out_.is_2d && axis == 1))
                read_.fail(e, fmt::format("its upper limit {:g} of {} is below the lower one {:g}",
                                          high[axis], "xyz"[axis], low[axis]));
        ZoneBox box = plain_box(low, high);
        if (const Element* transform = e.find_child("transform")) place(*transform, box);
        return box;
    }

    void place(const Element& e, ZoneBox& box) const
    {
        check_children(e, {"move", "rotate", "center"});
        Vec3 move;
        Vec3 angles;
        Vec3 center;
        if (const Element* m = e.find_child("move")) move = read_.vec3(*m);
        if (const Element* rotate = e.find_child("rotate"))
        {
            check_attributes(*rotate, {"angx", "angy", "angz", "anglesunits"});
            angles = {read_.number_or(*rotate, "angx", 0), read_.number_or(*rotate, "angy", 0),
                      read_.number_or(*rotate, "angz", 0)};
            const std::string& units = read_.text(*rotate, "anglesunits");
            if (units == "radians")
                angles = angles / radians(1);
            else if (units != "degrees")
                read_.fail(*rotate,
                           fmt::format("anglesunits=\"{}\" is invalid, expected degrees or radians",
                                       units));
            if (const Element* c = e.find_child("center")) center = read_.vec3(*c);
        }
        if (out_.is_2d && (move.y != 0 || angles.x != 0 || angles.z != 0))
            read_.fail(e,
                       "leads out of the plane of a 2D case, expected a turn about y and a move "
                       "in x and z only");
        if (move == Vec3{} && angles == Vec3{}) return;
        const Transform t = placement(center, {1, 1, 1}, angles, move);
        box.is_plain = false;
        box.corner = t(box.corner);
        Transform turn = t;
        turn.offset = {};
        for (Vec3& edge : box.edges) edge = turn(edge);
        if (out_.is_2d)
        {
            box.corner.y = out_.y_2d;
            for (Vec3& edge : box.edges) edge.y = 0;
        }
    }

    static double on_lattice(double x, double ref, double dp)
    {
        return ref + dp * std::round((x - ref) / dp);
    }

    /// Limits on the lattice of a zone, the box growing or, with `inwards`, shrinking to them.
    ZoneBox rounded(const ZoneBox& box, const Vec3& ref, double dp, bool inwards) const
    {
        const Vec3 far = box.far_corner();
        Vec3 low = box.corner;
        Vec3 high = far;
        const double slack = dp * fit_tolerance;
        for (int axis = 0; axis < 3; ++axis)
        {
            double& a = low[axis];
            double& b = high[axis];
            a = on_lattice(a, ref[axis], dp);
            b = on_lattice(b, ref[axis], dp);
            if (inwards)
            {
                if (a < box.corner[axis] - slack) a += dp;
                if (b > far[axis] + slack) b -= dp;
            }
            else
            {
                if (a > box.corner[axis] + slack) a -= dp;
                if (b < far[axis] - slack) b += dp;
            }
        }
        return plain_box(low, high);
    }

    /// A plain box reaches to nodes of its lattice, others keep their place and have edges of whole
    /// dp.
    ZoneBox fitted(ZoneBox box, const VresZone& zone) const
    {
        if (box.is_plain) return rounded(box, zone.pointref, zone.dp, false);
        for (Vec3& edge : box.edges)
        {
            const double length = norm(edge);
            if (length > 0)
                edge = edge * (zone.dp * std::trunc(std::round(length / zone.dp)) / length);
        }
        return box;
    }

    bool contains(const ZoneBox& outside, const ZoneBox& inside) const
    {
        if (outside.is_plain)
        {
            const Box3 limits = limits_of(inside);
            const Vec3 far = outside.far_corner();
            for (int axis = 0; axis < 3; ++axis)
            {
                // Rounding: the far corner is kept as a corner and an edge.
                const double slack = 1e-12 * (1 + std::abs(far[axis]));
                if (limits.min[axis] < outside.corner[axis] - slack ||
                    limits.max[axis] > far[axis] + slack)
                    return false;
            }
            return true;
        }
        for (unsigned i = 0; i < 8; ++i)
        {
            Vec3 p = inside.corner;
            for (std::size_t axis = 0; axis < 3; ++axis)
                if ((i >> axis & 1U) != 0) p = p + inside.edges[axis];
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                if (out_.is_2d && axis == 1) continue;
                const double length = norm(outside.edges[axis]);
                const double d = dot(p - outside.corner, outside.edges[axis]) / length;
                if (d < 0 || d > length) return false;
            }
        }
        return true;
    }

    std::string text_of(const ZoneBox& box) const
    {
        const Box3 b = limits_of(box);
        return fmt::format("({:g},{:g},{:g})-({:g},{:g},{:g})", b.min.x, b.min.y, b.min.z, b.max.x,
                           b.max.y, b.max.z);
    }

    /// Length of the shortest edge, negative for a plain box whose limits have changed places.
    double shortest(const ZoneBox& box) const
    {
        double least = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis)
        {
            if (out_.is_2d && axis == 1) continue;
            const Vec3& edge = box.edges[static_cast<std::size_t>(axis)];
            least = std::min(least, box.is_plain ? edge[axis] : norm(edge));
        }
        return least;
    }

    /// The box `by` further in, which must have an inside.
    ZoneBox shrunk(const Element& e, const ZoneBox& box, double by, const char* what) const
    {
        const double least = shortest(box);
        // A plain box may shrink to nothing, a turned one not.
        const double slack = box.is_plain ? -1e-9 * by : 0;
        if (box.is_plain ? least - 2 * by < slack : least <= 2 * by)
            read_.fail(e, fmt::format("is too small: {} {:g} wide on both sides leaves nothing of "
                                      "{}, whose shortest edge is {:g}; expected a larger box, a "
                                      "smaller dp or a smaller buffsizeh of the zone around it",
                                      what, by, text_of(box), least));
        return by != 0 ? resized(box, -by, out_.is_2d) : box;
    }

    void make_boxes(const Element& e, VresZone& zone, double overlap) const
    {
        const VresZone& outer = out_.zones[static_cast<std::size_t>(zone.parent)];
        const double h = zone.dp * h_per_dp_;
        const double outer_h = outer.dp * h_per_dp_;
        if (!contains(outer.inner, zone.inner))
            read_.fail(e, fmt::format("the box {} is not within that of the zone around it, {}",
                                      text_of(zone.inner), text_of(outer.inner)));
        if (!(shortest(zone.inner) > 0)) read_.fail(e, "the box has no inside");
        zone.buffer = grown(zone.inner, whole_steps(h * zone.buffer_h, zone.dp));
        zone.full = grown(zone.buffer, whole_steps(h * 2, zone.dp));
        if (!contains(outer.inner, zone.full))
            read_.fail(e, fmt::format("with its buffer and 2 h of fixed particles it is {}, which "
                                      "is not within the box of the zone around it, {}; expected "
                                      "to be further from its limits",
                                      text_of(zone.full), text_of(outer.inner)));
        if (zone.inner.is_plain)
        {
            ZoneBox begin = zone.inner;
            if (overlap != 0) begin = resized(begin, -overlap, out_.is_2d);
            zone.outer_begin = rounded(begin, outer.pointref, outer.dp, true);
            if (shortest(zone.outer_begin) < 0)
                read_.fail(e, "is too small: nothing is left of it within overlappingh");
        }
        else
            zone.outer_begin = shrunk(e, zone.inner, whole_steps(overlap, outer.dp), "an overlap");
        zone.outer_end =
            shrunk(e, zone.outer_begin, whole_steps(outer_h * outer.buffer_h, outer.dp),
                   "the buffer of the zone around it,");
        zone.outer_fixed = shrunk(e, zone.outer_end, whole_steps(outer_h * 2, outer.dp),
                                  "the fixed particles of the zone around it,");
    }

    ZoneBox grown(const ZoneBox& box, double by) const
    {
        return by != 0 ? resized(box, by, out_.is_2d) : box;
    }

    const Element& definition_;
    const AttributeReader& read_;
    Variables& variables_;
    CaseDef& def_;
    double h_per_dp_ = 0;
    VresDef out_;
};

} // namespace

VresDef read_vres(const Element& vres, const Element& definition, const AttributeReader& read,
                  Variables& variables, CaseDef& def, const Vec3& ref)
{
    return VresReader(definition, read, variables, def).run(vres, ref);
}

} // namespace fppg
