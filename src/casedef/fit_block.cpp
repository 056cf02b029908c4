#include "casedef/fit_block.h"

#include "fppg/fitted_walls.h"

#include "casedef/block_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <string_view>

namespace fppg
{
namespace
{

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
        require_known(block, {}, {"bodyfitted", "fluidband", "fill", "floatings", "points"});
        for (const Element& e : block.children)
        {
            if (is_remark(e)) continue;
            if (e.name == "bodyfitted") read_body_fitted(e);
            if (e.name == "fluidband") read_fluid_band(e);
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
            if (number + first >= wall_zone_bit)
                read_.fail(e, fmt::format("{} {} is mk {} and cannot be fitted, expected a number "
                                          "below {}",
                                          name, number, number + first, wall_zone_bit - first));
            mks.insert(static_cast<std::uint16_t>(number + first));
        }
        return {mks.begin(), mks.end()};
    }

    void read_body_fitted(const Element& e) const
    {
        require_known(e, {"mkbound", "featureangle", "density", "clearance", "plates"}, {"relax"});
        FitSettings s;
        s.line = e.line;
        s.feature_angle_deg = number_or(
            e, "featureangle", s.feature_angle_deg, [](double v) { return v >= 0 && v < 180; },
            "degrees from 0 to less than 180");
        s.density = is_first_of(e, "density", "area", "cell") ? FitDensity::Area : FitDensity::Cell;
        if (e.find_attribute("clearance") != nullptr && !is_word(e, "clearance", "auto"))
            s.clearance_dp = number_or(
                e, "clearance", 0, [](double v) { return v >= 0.5 && v <= 1; },
                "auto or 0.5 to 1 (times dp)");
        s.one_sheet = !is_first_of(e, "plates", "both", "one");
        bool has_relax = false;
        for (const Element& c : e.children)
        {
            if (is_remark(c)) continue;
            if (has_relax) read_.fail(c, "stands twice in <bodyfitted>, expected once at most");
            has_relax = true;
            s.relax = relax_of(c);
        }
        if (e.find_attribute("mkbound") != nullptr)
        {
            for (const std::uint16_t mk : mks_of(e, MkKind::Bound))
                def_.fit.of_mk.emplace_back(mk, s);
            return;
        }
        // What is for every mk comes after those before it, and so wins over them.
        def_.fit.of_mk.clear();
        def_.fit.all = s;
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

    void read_fluid_band(const Element& e) const
    {
        require_known(e, {"mkfluid", "width"}, {});
        FluidBand band;
        band.line = e.line;
        band.mk = mks_of(e, MkKind::Fluid);
        band.width_dp = number_or(
            e, "width", band.width_dp, [](double v) { return v > 0; },
            "a width above 0 (times dp)");
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
            read.fail(c, fmt::format("stands in <{}>, expected directly in <casedef>", e.name));
        if (c.name != "fppg") refuse_stray_blocks(c, read);
    }
}

bool paints(const DrawOp& op)
{
    return !std::holds_alternative<ResetOp>(op.what) &&
           !std::holds_alternative<ShapeOutOp>(op.what);
}

/// Whether a draw is of a shape that has a surface to put particles on.
bool has_surface(const DrawOp& op)
{
    return op.state->draw_points && (std::holds_alternative<FigureOp>(op.what) ||
                                     std::holds_alternative<SphereOp>(op.what) ||
                                     std::holds_alternative<CylinderOp>(op.what) ||
                                     std::holds_alternative<EllipsoidOp>(op.what) ||
                                     std::holds_alternative<MeshFileOp>(op.what));
}

/// An mk with the bit of the zones would be taken for one.
void refuse_high_mks(const CaseDef& def, const AttributeReader& read)
{
    for (const DrawOp& op : def.ops)
    {
        if (!paints(op) || op.state->mk.mk < wall_zone_bit) continue;
        Element at;
        at.name = op.source.command;
        at.line = op.source.line;
        read.fail(at, fmt::format("mkbound {} is mk {} and cannot stand in a case with body-fitted "
                                  "walls or <setfrdrawmode>, expected a number below {}",
                                  op.state->mk.mk_type, op.state->mk.mk,
                                  wall_zone_bit - def.mk_bound_first));
    }
}

void warn_of_undrawn_mks(CaseDef& def)
{
    std::set<std::uint16_t> walls;
    std::set<std::uint16_t> fluids;
    for (const DrawOp& op : def.ops)
    {
        if (op.state->mk.kind == MkKind::Bound && has_surface(op)) walls.insert(op.state->mk.mk);
        if (op.state->mk.kind == MkKind::Fluid && paints(op)) fluids.insert(op.state->mk.mk);
    }
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
    for (std::size_t i = 0; i < def.fit.of_mk.size();)
    {
        const int line = def.fit.of_mk[i].second.line;
        std::vector<std::uint16_t> missing;
        for (; i < def.fit.of_mk.size() && def.fit.of_mk[i].second.line == line; ++i)
            if (!walls.contains(def.fit.of_mk[i].first)) missing.push_back(def.fit.of_mk[i].first);
        if (!missing.empty())
            warn(line, "bodyfitted", "mkbound", def.mk_bound_first, missing,
                 "nothing with a surface is drawn with it, so nothing is fitted.");
    }
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
    const auto found = std::find_if(fit.of_mk.rbegin(), fit.of_mk.rend(),
                                    [mk](const auto& of_mk) { return of_mk.first == mk; });
    if (found != fit.of_mk.rend()) return &found->second;
    return fit.all ? &*fit.all : nullptr;
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
    const bool is_off_lattice =
        std::any_of(def.ops.begin(), def.ops.end(),
                    [](const DrawOp& op) { return op.state && op.state->off_lattice; });
    if (!def.fit.is_empty() || is_off_lattice) refuse_high_mks(def, read);
    if (choice != FitChoice::Raw) return;
    if (def.fit.all) def.fit.all->relax.is_active = false;
    for (auto& of_mk : def.fit.of_mk) of_mk.second.relax.is_active = false;
    def.fluid_bands.clear();
}

} // namespace fppg
