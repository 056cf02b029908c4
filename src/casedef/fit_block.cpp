#include "casedef/fit_block.h"

#include "casedef/block_reader.h"
#include "casedef/driven_flow.h"
#include "casedef/wall_boundary.h"
#include "shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace fppg
{
namespace
{

bool has_same_clips(const DrawState& a, const DrawState& b)
{
    return std::equal(a.clips.begin(), a.clips.end(), b.clips.begin(), b.clips.end(),
                      [](const ClipPlane& p, const ClipPlane& q)
                      { return p.point == q.point && p.normal == q.normal; });
}

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Numbers that a warning lists.
constexpr std::size_t mks_shown = 10;

/// Reads what `<fppg>` says of body-fitted walls.
class FitBlockReader : BlockReader
{
public:
    FitBlockReader(const AttributeReader& read, CaseDef& def) : BlockReader(read), def_(def) {}

    void read_block(const Element& block) const
    {
        require_known(
            block, {},
            {"bodyfitted", "boolean", "fluidband", "fill", "floatings", "offlattice", "points"});
        for (const Element& e : block.children)
        {
            if (is_remark(e)) continue;
            if (e.name == "bodyfitted") read_body_fitted(e);
            if (e.name == "fluidband") read_fluid_band(e);
            if (e.name == "boolean") read_boolean(e);
            if (e.name == "floatings") read_exact_floatings(e);
        }
    }

private:
    void read_exact_floatings(const Element& e) const
    {
        require_known(e, {"exact", "mkbound"}, {});
        if (!read_.flag_or(e, "exact", true)) return;
        ExactFloatings& exact = def_.exact_floatings;
        exact.line = e.line;
        const std::vector<std::uint16_t> mks = mks_of(e, MkKind::Bound);
        if (e.find_attribute("mkbound") == nullptr)
            exact.all = true;
        else
            exact.mk.insert(exact.mk.end(), mks.begin(), mks.end());
    }

    /// True for the first word, which is what a missing attribute means too; false for the second.
    bool is_first_of(const Element& e, std::string_view name, std::string_view first,
                     std::string_view second) const
    {
        const std::string* value = e.find_attribute(name);
        if (value == nullptr || *value == first) return true;
        if (*value == second) return false;
        read_.fail(e, fmt::format("attribute {}=\"{}\" is invalid, expected {} or {}", name, *value,
                                  first, second));
    }

    bool is_word(const Element& e, std::string_view name, std::string_view word) const
    {
        const std::string* value = e.find_attribute(name);
        return value != nullptr && *value == word;
    }

    /// The mks of a list, absolute and ascending; none where the attribute is missing.
    std::vector<std::uint16_t> mks_of(const Element& e, MkKind kind) const
    {
        const bool is_bound = kind == MkKind::Bound;
        const char* name = is_bound ? "mkbound" : "mkfluid";
        const std::string* list = e.find_attribute(name);
        if (list == nullptr) return {};
        const int count = is_bound ? def_.mkbound_count : def_.mkfluid_count;
        const int first = is_bound ? def_.mk_bound_first : def_.mk_fluid_first;
        std::set<std::uint16_t> mks;
        const std::vector<std::uint16_t> numbers =
            list->starts_with('#')
                ? std::vector{static_cast<std::uint16_t>(number_or(
                      e, name, 0,
                      [](double v) { return v >= 0 && v <= 65000 && v == std::floor(v); },
                      "a whole number from 0 to 65000"))}
                : read_.number_list(e, name);
        for (const int number : numbers)
        {
            if (number >= count)
                read_.fail(e, fmt::format("{} {} is out of range, <mkconfig> leaves 0 to {} (raise "
                                          "{} there)",
                                          name, number, count - 1,
                                          is_bound ? "boundcount" : "fluidcount"));
            mks.insert(static_cast<std::uint16_t>(number + first));
        }
        return {mks.begin(), mks.end()};
    }

    void read_body_fitted(const Element& e) const
    {
        require_known(e,
                      {"mkbound", "featureangle", "density", "clearance", "plates", "boundary",
                       "layers", "side", "place", "across", "volume"},
                      {"relax"});
        FitSettings s;
        s.line = e.line;
        s.feature_angle_deg = number_or(
            e, "featureangle", s.feature_angle_deg, [](double v) { return v >= 0 && v < 180; },
            "degrees from 0 to less than 180");
        if (e.find_attribute("featureangle") != nullptr) s.cad_angle_deg = s.feature_angle_deg;
        s.density = is_first_of(e, "density", "area", "cell") ? FitDensity::Area : FitDensity::Cell;
        if (e.find_attribute("clearance") != nullptr && !is_word(e, "clearance", "auto"))
            s.clearance_dp = number_or(
                e, "clearance", 0, [](double v) { return v >= 0.5 && v <= 1; },
                "auto or 0.5 to 1 (times dp)");
        const std::string plates = read_.text_or(e, "plates", "auto");
        s.gives_sheets = plates != "auto";
        if (plates == "both" || plates == "one")
            s.one_sheet_dp = plates == "one" ? 1 : 0;
        else if (plates != "auto")
            read_.fail(e,
                       fmt::format("attribute plates=\"{}\" is invalid, expected auto, both or one",
                                   plates));
        read_layers(e, s);
        read_place(e, s);
        bool has_relax = false;
        for (const Element& c : e.children)
        {
            if (is_remark(c)) continue;
            if (has_relax) read_.fail(c, "is given twice in <bodyfitted>, expected once at most");
            has_relax = true;
            s.relax = relax_of(c);
        }
        if (e.find_attribute("mkbound") != nullptr)
        {
            for (const std::uint16_t mk : mks_of(e, MkKind::Bound))
                def_.fit.of_mk.insert_or_assign(mk, s);
            return;
        }
        // What is for every mk comes after those before it, and so wins over them.
        def_.fit.of_mk.clear();
        def_.fit.all = s;
    }

    /// The place of the layers; `boundary` is left empty where the case's parameters decide.
    void read_layers(const Element& e, FitSettings& s) const
    {
        const std::string boundary = read_.text_or(e, "boundary", "auto");
        if (boundary == "mdbc")
            s.boundary = WallBoundary::Mdbc;
        else if (boundary == "dbc")
            s.boundary = WallBoundary::Dbc;
        else if (boundary != "auto")
            read_.fail(
                e, fmt::format("attribute boundary=\"{}\" is invalid, expected auto, mdbc or dbc",
                               boundary));
        if (e.find_attribute("layers") != nullptr && !is_word(e, "layers", "auto"))
            s.layers = static_cast<int>(number_or(
                e, "layers", 0,
                [](double v) { return v >= 1 && v <= most_layers && v == std::floor(v); },
                fmt::format("auto or a whole number from 1 to {}", most_layers).c_str()));
        if (e.find_attribute("side") == nullptr) return;
        const std::string& side = read_.text(e, "side");
        if (side == "behind")
            s.side = LayerSide::Behind;
        else if (side == "front")
            s.side = LayerSide::Front;
        else if (side == "both")
            s.side = LayerSide::Both;
        else
            read_.fail(e, fmt::format("attribute side=\"{}\" is invalid, expected behind, front or "
                                      "both",
                                      side));
    }

    void read_place(const Element& e, FitSettings& s) const
    {
        s.has_exact_volumes = !is_first_of(e, "volume", "equal", "exact");
        if (is_first_of(e, "place", "surface", "inside"))
        {
            if (e.find_attribute("across") != nullptr)
                read_.fail(e, "attribute across is for place=\"inside\" only");
            // What is asked for on the surface keeps bodies there.
            for (const char* surface : {"place", "clearance", "plates", "layers", "side"})
                if (e.find_attribute(surface) != nullptr && !is_word(e, surface, "auto"))
                    s.place = Placement::Surface;
            return;
        }
        s.place = Placement::Inside;
        for (const char* other : {"clearance", "plates", "layers", "side"})
            if (e.find_attribute(other) != nullptr)
                read_.fail(e, fmt::format("attribute {} has no meaning with place=\"inside\", "
                                          "which puts all particles into the body",
                                          other));
        if (e.find_attribute("across") != nullptr && !is_word(e, "across", "auto"))
            s.across = static_cast<int>(number_or(
                e, "across", 0, [](double v) { return v >= 1 && v <= 64 && v == std::floor(v); },
                "auto or a whole number from 1 to 64"));
    }

    RelaxSettings relax_of(const Element& e) const
    {
        require_known(e, {"active", "iterations", "tolerance", "h", "band", "snapshots"}, {});
        RelaxSettings r;
        r.is_active = read_.flag_or(e, "active", true);
        if (e.find_attribute("iterations") != nullptr && !is_word(e, "iterations", "auto"))
            r.iterations = static_cast<int>(number_or(
                e, "iterations", 0,
                [](double v) { return v >= 1 && v <= 1e6 && v == std::floor(v); },
                "auto or a whole number from 1 to 1000000 (active=\"false\" for none)"));
        r.tolerance = number_or(
            e, "tolerance", r.tolerance, [](double v) { return v > 0 && v <= 1; }, "above 0 to 1");
        r.surface_h_dp = number_or(
            e, "h", r.surface_h_dp, [](double v) { return v >= 0.5 && v <= 2; },
            "0.5 to 2 (times dp)");
        r.band_dp = is_word(e, "band", "all")
                        ? infinity
                        : number_or(
                              e, "band", r.band_dp, [](double v) { return v >= 0; },
                              "all or a width from 0 on (times dp)");
        r.snapshots = static_cast<int>(number_or(
            e, "snapshots", 0, [](double v) { return v >= 0 && v <= 1e6 && v == std::floor(v); },
            "a whole number of iterations from 0 to 1000000"));
        return r;
    }

    void read_boolean(const Element& e) const
    {
        require_known(e, {"name", "op", "mkbound", "draw"}, {"part", "boolean"});
        BooleanDef boolean;
        boolean.line = e.line;
        boolean.name = read_.text_or(e, "name", "");
        boolean.is_drawn = read_.flag_or(e, "draw", true);
        if (!boolean.is_drawn && boolean.name.empty())
            read_.fail(e, "is not drawn and has no name, so that it has no effect");
        if (!boolean.name.empty())
        {
            const auto has_name = [&](const auto& other) { return other.name == boolean.name; };
            if (std::any_of(def_.booleans.begin(), def_.booleans.end(), has_name) ||
                std::any_of(def_.ops.begin(), def_.ops.end(),
                            [&](const DrawOp& op) { return has_name(op.source); }))
                read_.fail(e, fmt::format("name=\"{}\" is that of another boolean or of a draw",
                                          boolean.name));
        }
        boolean.tree = boolean_node(e, boolean);
        const std::vector<std::uint16_t> mks = mks_of(e, MkKind::Bound);
        if (mks.size() > 1)
            read_.fail(e, fmt::format("mkbound names {} numbers, expected one", mks.size()));
        if (!mks.empty()) boolean.mk = mks[0];
        if (boolean.is_drawn) check_boolean(e, boolean);
        def_.booleans.push_back(std::move(boolean));
    }

    BooleanNode boolean_node(const Element& e, BooleanDef& boolean) const
    {
        BooleanNode node;
        const std::string& op = read_.text(e, "op");
        if (op == "union")
            node.op = BooleanOp::Union;
        else if (op == "intersection")
            node.op = BooleanOp::Intersection;
        else if (op == "difference")
            node.op = BooleanOp::Difference;
        else
            read_.fail(
                e, fmt::format("op=\"{}\" is not known, expected union, intersection or difference",
                               op));
        for (const Element& c : e.children)
        {
            if (is_remark(c)) continue;
            if (c.name == "part")
                node.operands.push_back(boolean_part(c, boolean));
            else
            {
                require_known(c, {"op"}, {"part", "boolean"});
                node.operands.push_back(boolean_node(c, boolean));
            }
        }
        if (node.operands.size() < 2)
            read_.fail(e, fmt::format("has {} operands, expected two or more <part> or <boolean>",
                                      node.operands.size()));
        return node;
    }

    /// The draws of a name or of an mk, together if there are several; or an earlier boolean.
    BooleanNode boolean_part(const Element& e, BooleanDef& boolean) const
    {
        require_known(e, {"ref", "mkbound", "mkfluid", "sheet"}, {});
        const int ways = (e.find_attribute("ref") != nullptr ? 1 : 0) +
                         (e.find_attribute("mkbound") != nullptr ? 1 : 0) +
                         (e.find_attribute("mkfluid") != nullptr ? 1 : 0);
        if (ways != 1) read_.fail(e, "needs one of the attributes ref, mkbound and mkfluid");
        const bool is_sheet = read_.flag_or(e, "sheet", false);
        BooleanNode node;
        node.op = BooleanOp::Union;
        const auto add = [&](std::size_t op, bool may_be_sheet)
        {
            BooleanNode leaf;
            leaf.part = static_cast<std::uint32_t>(boolean.parts.size());
            for (std::size_t p = 0; p < boolean.parts.size(); ++p)
                if (boolean.parts[p].op == op) leaf.part = static_cast<std::uint32_t>(p);
            if (leaf.part == boolean.parts.size()) boolean.parts.push_back({op, may_be_sheet});
            return leaf;
        };
        if (const std::string* ref = e.find_attribute("ref"))
        {
            for (const BooleanDef& other : def_.booleans)
            {
                if (other.name.empty() || other.name != *ref) continue;
                std::vector<std::uint32_t> parts;
                for (const BooleanDef::Part& p : other.parts)
                    parts.push_back(add(p.op, p.is_sheet).part);
                node = other.tree;
                renumber(node, parts);
                return node;
            }
            std::set<std::string> names;
            for (std::size_t i = 0; i < def_.ops.size(); ++i)
            {
                const DrawOp& op = def_.ops[i];
                if (!op.source.name.empty()) names.insert(op.source.name);
                if (op.source.name.empty() || op.source.name != *ref) continue;
                if (!is_part(op))
                    read_.fail(e, fmt::format("ref=\"{}\" is the <{}> in line {}, which has no "
                                              "surface of its own and cannot be a part",
                                              *ref, op.source.command, op.source.line));
                node.operands.push_back(add(i, is_sheet));
            }
            if (node.operands.empty())
                read_.fail(
                    e,
                    fmt::format(
                        "ref=\"{}\" is the fppg:name of no draw and the name of no "
                        "boolean before this one; there are: {}",
                        *ref, names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
        }
        else
        {
            const MkKind kind =
                e.find_attribute("mkbound") != nullptr ? MkKind::Bound : MkKind::Fluid;
            const std::vector<std::uint16_t> mks = mks_of(e, kind);
            for (std::size_t i = 0; i < def_.ops.size(); ++i)
            {
                const MkValue& mk = def_.ops[i].state->mk;
                if (mk.kind == kind && is_part(def_.ops[i]) &&
                    std::find(mks.begin(), mks.end(), mk.mk) != mks.end())
                    node.operands.push_back(add(i, is_sheet));
            }
            if (node.operands.empty())
                read_.fail(e, "names an mk with which nothing is drawn that has a surface");
        }
        if (node.operands.size() > 1) return node;
        BooleanNode only = node.operands[0];
        return only;
    }

    static void renumber(BooleanNode& node, const std::vector<std::uint32_t>& parts)
    {
        if (node.op == BooleanOp::Part) node.part = parts[node.part];
        for (BooleanNode& operand : node.operands) renumber(operand, parts);
    }

    static bool is_part(const DrawOp& op)
    {
        const auto* shape = std::get_if<Shape>(&op.what);
        return shape != nullptr && has_surface(*shape);
    }

    /// What stays of the result is of one kind, and all parts are drawn under the same clips.
    void check_boolean(const Element& e, const BooleanDef& boolean) const
    {
        const std::vector<char> stays = staying_parts(boolean.tree, boolean.parts.size());
        std::size_t last = 0;
        std::size_t first = SIZE_MAX;
        const auto place_of = [&](std::size_t part)
        {
            const SourceRef& at = def_.ops[boolean.parts[part].op].source;
            return fmt::format("the <{}> in line {}", at.command, at.line);
        };
        std::optional<MkKind> kind;
        if (boolean.mk) kind = MkKind::Bound;
        for (std::size_t p = 0; p < boolean.parts.size(); ++p)
        {
            const DrawOp& op = def_.ops[boolean.parts[p].op];
            first = std::min(first, boolean.parts[p].op);
            last = std::max(last, boolean.parts[p].op);
            if (!has_same_clips(*op.state, *def_.ops[boolean.parts[0].op].state))
                read_.fail(e,
                           fmt::format("{} is drawn under other clips than {}, expected the same",
                                       place_of(p), place_of(0)));
            if (stays[p] == 0 || boolean.mk) continue;
            const MkKind own = op.state->mk.kind;
            if (own == MkKind::Void)
                read_.fail(e, fmt::format("{} stays in the result and is drawn as void, expected "
                                          "a bound or a fluid (void is for what is taken away)",
                                          place_of(p)));
            if (kind && *kind != own)
                read_.fail(e,
                           fmt::format("{} is fluid and others that stay in the result are bound, "
                                       "or the other way round, expected one of both",
                                       place_of(p)));
            kind = own;
        }
        for (std::size_t i = first; i < last; ++i)
            if (std::holds_alternative<ResetOp>(def_.ops[i].what))
                read_.fail(e, fmt::format("the <resetdraw> in line {} lies between its parts",
                                          def_.ops[i].source.line));
    }

    void read_fluid_band(const Element& e) const
    {
        require_known(e, {"mkfluid", "width", "active", "balance", "mass", "packing"}, {});
        FluidBand band;
        band.line = e.line;
        band.mk = mks_of(e, MkKind::Fluid);
        band.width_dp = number_or(
            e, "width", band.width_dp, [](double v) { return v > 0; },
            "a width above 0 (times dp)");
        band.is_active = read_.flag_or(e, "active", true);
        band.balances = read_.flag_or(e, "balance", true);
        if (!band.is_active && e.find_attribute("mass") != nullptr)
            read_.fail(e,
                       "has mass and active=\"false\", expected one of them: the space between "
                       "walls is measured where fluid is relaxed");
        const std::string mass = read_.text_or(e, "mass", "dp");
        band.has_exact_mass = mass == "exact";
        if (mass != "exact" && mass != "dp")
            read_.fail(e,
                       fmt::format("mass=\"{}\" is unknown, expected exact (the mass of the space "
                                   "between walls) or dp (rhop0 dp^3 each)",
                                   mass));
        const std::string packing = read_.text_or(e, "packing", "stable");
        band.packs = packing == "stable";
        if (packing != "stable" && packing != "cubic")
            read_.fail(e,
                       fmt::format("packing=\"{}\" is unknown, expected stable (the lattice that "
                                   "is most stable under pressure) or cubic (the case's own)",
                                   packing));
        def_.fluid_bands.push_back(std::move(band));
    }

    CaseDef& def_;
};

/// GenCase passes over elements that it does not know, so a block in the wrong place would have no
/// effect and nobody would notice.
void refuse_stray_blocks(const Element& e, const AttributeReader& read)
{
    for (const Element& c : e.children)
    {
        if (c.kind != Element::Kind::Tag || c.name.starts_with('_')) continue;
        if (c.name == "fppg" && e.name != "casedef")
            read.fail(c, fmt::format("is in <{}>, expected directly in <casedef>", e.name));
        if (c.name == "bodyfitted" || c.name == "fluidband")
            read.fail(c, fmt::format("is in <{}>, expected in <casedef><fppg>", e.name));
        if (c.name != "fppg") refuse_stray_blocks(c, read);
    }
}

bool paints(const DrawOp& op)
{
    return std::holds_alternative<Shape>(op.what) || std::holds_alternative<Edit>(op.what);
}

/// Whether a draw is of a shape that has a surface to put particles on.
bool draws_surface(const DrawOp& op)
{
    const auto* shape = std::get_if<Shape>(&op.what);
    return op.state->draw_points && shape != nullptr && has_surface(*shape);
}

void warn_of_undrawn_mks(CaseDef& def)
{
    std::set<std::uint16_t> walls;
    std::set<std::uint16_t> fluids;
    for (const DrawOp& op : def.ops)
    {
        if (op.state->mk.kind == MkKind::Bound && draws_surface(op)) walls.insert(op.state->mk.mk);
        if (op.state->mk.kind == MkKind::Fluid && paints(op)) fluids.insert(op.state->mk.mk);
    }
    for (const BooleanDef& boolean : def.booleans)
        if (boolean.is_drawn && boolean.mk) walls.insert(*boolean.mk);
    const auto warn = [&](int line, const char* element, const char* type, int first,
                          const std::vector<std::uint16_t>& mks, const char* text)
    {
        std::vector<int> numbers;
        for (std::size_t i = 0; i < std::min(mks.size(), mks_shown); ++i)
            numbers.push_back(mks[i] - first);
        const std::string more =
            mks.size() > mks_shown ? fmt::format(" and {} more", mks.size() - mks_shown) : "";
        def.warnings.push_back(fmt::format("{}:{}: <{}>: {} {}{}: {}", def.file, line, element,
                                           type, fmt::join(numbers, ","), more, text));
    };
    std::map<int, std::vector<std::uint16_t>> missing_of_line;
    for (const auto& [mk, settings] : def.fit.of_mk)
        if (!walls.contains(mk)) missing_of_line[settings.line].push_back(mk);
    for (const auto& [line, missing] : missing_of_line)
        warn(line, "bodyfitted", "mkbound", def.mk_bound_first, missing,
             "nothing with a surface is drawn with it, so nothing is fitted.");
    for (const FluidBand& band : def.fluid_bands)
    {
        std::vector<std::uint16_t> missing;
        for (const std::uint16_t mk : band.mk)
            if (!fluids.contains(mk)) missing.push_back(mk);
        if (!missing.empty())
            warn(band.line, "fluidband", "mkfluid", def.mk_fluid_first, missing,
                 "nothing is drawn with it, so nothing is relaxed.");
        if (def.fit.is_empty())
            def.warnings.push_back(fmt::format(
                "{}:{}: <fluidband>: no wall is body-fitted, so nothing is relaxed; <bodyfitted /> "
                "in <fppg> or -fit asks for it.",
                def.file, band.line));
    }
}

} // namespace

const FitSettings* fit_settings(const FitDef& fit, std::uint16_t mk)
{
    const auto found = fit.of_mk.find(mk);
    if (found != fit.of_mk.end()) return &found->second;
    return fit.all ? &*fit.all : nullptr;
}

const FluidBand* fluid_band(const CaseDef& def, std::uint16_t mk)
{
    const auto found = std::find_if(
        def.fluid_bands.rbegin(), def.fluid_bands.rend(),
        [mk](const FluidBand& band)
        { return band.mk.empty() || std::binary_search(band.mk.begin(), band.mk.end(), mk); });
    return mk < def.mk_bound_first && found != def.fluid_bands.rend() ? &*found : nullptr;
}

bool CaseDef::fills_litres() const
{
    return std::any_of(ops.begin(), ops.end(),
                       [](const DrawOp& op)
                       {
                           const auto* edit = std::get_if<Edit>(&op.what);
                           const auto* fill =
                               edit != nullptr ? std::get_if<CavityFillOp>(edit) : nullptr;
                           return fill != nullptr && fill->measure == FillMeasure::Litres;
                       });
}

bool CaseDef::balances() const
{
    return !fit.is_empty() && norm(constants.rest_gravity()) > 0 && constants.rhop_gradient != 1 &&
           std::any_of(fluid_bands.begin(), fluid_bands.end(),
                       [](const FluidBand& band) { return band.is_active && band.balances; });
}

void read_fit(const Element& root, const AttributeReader& read, FitChoice choice, CaseDef& def)
{
    if (choice == FitChoice::Off) return;
    refuse_stray_blocks(root, read);
    const FitBlockReader reader(read, def);
    for (const Element& block : def.casedef.children)
        if (block.kind == Element::Kind::Tag && block.name == "fppg") reader.read_block(block);
    if ((choice == FitChoice::On || choice == FitChoice::Raw) && !def.fit.all)
        def.fit.all = FitSettings{};
    warn_of_undrawn_mks(def);
    settle_boundaries(read, def);
    find_driving_gravity(def);
    // Fluid that touches fitted walls is relaxed with them unless the case says otherwise.
    if (def.fluid_bands.empty() && !def.fit.is_empty()) def.fluid_bands.emplace_back();
    if (choice != FitChoice::Raw) return;
    if (def.fit.all) def.fit.all->relax.is_active = false;
    for (auto& of_mk : def.fit.of_mk) of_mk.second.relax.is_active = false;
    def.fluid_bands.clear();
}

} // namespace fppg
