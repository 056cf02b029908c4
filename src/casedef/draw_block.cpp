#include "casedef/draw_block.h"

#include "casedef/block_reader.h"
#include "core/text.h"
#include "core/transforms.h"

#include <cmath>
#include <string>
#include <vector>

namespace fppg
{
namespace
{

/// Wider gaps than this are no gaps.
constexpr int most_gap_nodes = 100;

class DrawBlockReader : BlockReader
{
public:
    DrawBlockReader(const AttributeReader& read, CaseDef& def) : BlockReader(read), def_(def) {}

    void read_block(const Element& block) const
    {
        for (const Element& e : block.children)
        {
            if (is_remark(e)) continue;
            if (e.name == "fill") read_fill(e);
            if (e.name == "points") read_points(e);
            if (e.name == "offlattice")
            {
                require_known(e, {"hydrostatic"}, {});
                def_.hydrostatic_off_lattice = read_.flag_or(e, "hydrostatic", true);
            }
        }
    }

private:
    /// The parts of a list between commas; those in brackets of an expression separate nothing.
    static std::vector<std::string> parts_of(const std::string& list)
    {
        std::vector<std::string> parts(1);
        int depth = 0;
        for (const char c : list)
        {
            depth += c == '(' ? 1 : c == ')' ? -1 : 0;
            if (c == ',' && depth == 0)
                parts.emplace_back();
            else
                parts.back() += c;
        }
        for (std::string& part : parts) part = std::string(trimmed(part));
        return parts;
    }

    /// "x,y,z", each a number or an #expression; where `may_be_one`, one number for all.
    Vec3 triple(const Element& e, const char* name, bool may_be_one = false) const
    {
        const std::string& list = read_.text(e, name);
        std::vector<std::string> parts = parts_of(list);
        if (may_be_one && parts.size() == 1) parts.resize(3, parts[0]);
        bool is_whole = parts.size() == 3;
        for (const std::string& part : parts) is_whole = is_whole && !part.empty();
        if (!is_whole)
            read_.fail(e, fmt::format("attribute {}=\"{}\" is invalid, expected {}x,y,z", name,
                                      list, may_be_one ? "one number or " : ""));
        Vec3 out;
        for (int axis = 0; axis < 3; ++axis)
        {
            Element part;
            part.name = e.name;
            part.line = e.line;
            part.attributes.push_back({name, parts[static_cast<std::size_t>(axis)]});
            out[axis] = read_.number(part, name);
        }
        return out;
    }

    /// A place given as attribute "x,y,z" or as child with x, y, z.
    std::optional<Vec3> place(const Element& e, const char* name) const
    {
        const Element* found = nullptr;
        for (const Element& c : e.children)
        {
            if (is_remark(c) || c.name != name) continue;
            if (found != nullptr || e.find_attribute(name) != nullptr)
                read_.fail(c, fmt::format("is given twice in <{}>, expected once", e.name));
            require_known(c, {"x", "y", "z"}, {});
            found = &c;
        }
        if (found != nullptr) return read_.vec3(*found);
        if (e.find_attribute(name) == nullptr) return std::nullopt;
        return triple(e, name);
    }

    MkValue mk_of(const Element& e, const char* name) const
    {
        const bool is_bound = std::string_view(name) == "mkbound";
        const int count = is_bound ? def_.mkbound_count : def_.mkfluid_count;
        if (count == 0) read_.fail(e, fmt::format("<mkconfig> leaves no {}", name));
        const int number = read_.integer(e, name, 0, count - 1, true);
        const int first = is_bound ? def_.mk_bound_first : def_.mk_fluid_first;
        return {is_bound ? MkKind::Bound : MkKind::Fluid,
                static_cast<std::uint16_t>(number + first), static_cast<std::uint16_t>(number)};
    }

    Vec3 up_of(const Element& e) const
    {
        const std::optional<Vec3> given = place(e, "up");
        const Vec3 up = given ? *given : -def_.constants.gravity;
        Vec3 in_plane = up;
        if (def_.grid.is_2d) in_plane.y = 0;
        if (norm(in_plane) == 0)
        {
            if (given)
                read_.fail(e, fmt::format("attribute up is ({:g}, {:g}, {:g}), expected a "
                                          "direction{}",
                                          up.x, up.y, up.z,
                                          def_.grid.is_2d ? " with a part along x or z" : ""));
            read_.fail(e, "the attribute up is missing: gravity gives no direction");
        }
        return up / norm(up);
    }

    void read_fill(const Element& e) const
    {
        require_known(e, {"mkfluid", "seed", "level", "litres", "percent", "gapclose", "up"},
                      {"seed", "up"});
        CavityFillOp op;
        const std::optional<Vec3> seed = place(e, "seed");
        if (!seed) read_.fail(e, "the seed is missing, expected seed=\"x,y,z\" or <seed x y z />");
        op.seed = *seed;
        op.up = up_of(e);
        int measures = 0;
        for (const char* name : {"level", "litres", "percent"})
            measures += e.find_attribute(name) != nullptr ? 1 : 0;
        if (measures != 1)
            read_.fail(e,
                       fmt::format("has {} of the attributes level, litres and percent, expected "
                                   "one",
                                   measures));
        if (e.find_attribute("level") != nullptr)
        {
            op.measure = FillMeasure::Level;
            op.amount = number_or(
                e, "level", 0, [](double) { return true; }, "a height in metres");
        }
        else if (e.find_attribute("litres") != nullptr)
        {
            op.measure = FillMeasure::Litres;
            op.amount = number_or(
                e, "litres", 0, [](double v) { return v > 0; }, "litres above 0");
        }
        else
            op.amount = number_or(
                e, "percent", 0, [](double v) { return v > 0 && v <= 100; }, "above 0 to 100");
        op.gap_nodes = static_cast<int>(number_or(
            e, "gapclose", op.gap_nodes,
            [](double v) { return v >= 0 && v <= most_gap_nodes && v == std::floor(v); },
            "a whole number of nodes from 0 to 100"));
        DrawState state;
        state.mk = mk_of(e, "mkfluid");
        def_.ops.push_back({{e.line, e.name}, std::make_shared<const DrawState>(state), op});
    }

    void read_points(const Element& e) const
    {
        require_known(e, {"file", "mkbound", "mkfluid", "scale", "rotate", "move"}, {});
        PointFile points;
        points.source = {e.line, e.name};
        points.file = read_.text(e, "file");
        if (points.file.empty()) read_.fail(e, "attribute file=\"\" is empty, expected a name");
        const bool is_bound = e.find_attribute("mkbound") != nullptr;
        if (is_bound == (e.find_attribute("mkfluid") != nullptr))
            read_.fail(e, "expected one of the attributes mkbound and mkfluid");
        points.mk = mk_of(e, is_bound ? "mkbound" : "mkfluid");
        Vec3 scale{1, 1, 1};
        Vec3 angles;
        Vec3 move;
        if (e.find_attribute("scale") != nullptr) scale = triple(e, "scale", true);
        if (e.find_attribute("rotate") != nullptr) angles = triple(e, "rotate");
        if (e.find_attribute("move") != nullptr) move = triple(e, "move");
        points.transform = placement({}, scale, angles, move);
        def_.point_files.push_back(std::move(points));
    }

    CaseDef& def_;
};

} // namespace

void read_draw_block(const AttributeReader& read, CaseDef& def)
{
    const DrawBlockReader reader(read, def);
    for (const Element& block : def.casedef.children)
        if (block.kind == Element::Kind::Tag && block.name == "fppg") reader.read_block(block);
}

} // namespace fppg
