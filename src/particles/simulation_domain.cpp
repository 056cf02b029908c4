// Facts: DualSPHysics v5.4.3, JPartsLoad4::CalculeLimitsPos, JSph::ResizeMapLimits and
// JCaseEParms::CheckPosValue.
#include "particles/simulation_domain.h"

#include "core/finite_number.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

namespace fppg
{
namespace
{

/// The solver's border around particles, in h.
constexpr double border_h = 0.05;

/// Moves one limit of an axis out; the line that says so, or nothing.
std::optional<std::string> widen(Element& limit, int axis, bool is_min, double outermost,
                                 const CaseDef& def)
{
    Element::Attribute* own = nullptr;
    for (Element::Attribute& a : limit.attributes)
        if (a.name.size() == 1 && a.name[0] == "xyz"[axis]) own = &a;
    if (own == nullptr) return std::nullopt;
    const std::optional<double> given = finite_signed_number(own->value);
    const double way = is_min ? -1 : 1;
    if (!given || way * (outermost - *given) + border_h * def.h <= 0) return std::nullopt;
    const std::string wide = fmt::format("{:.10g}", outermost + way * def.grid.dp);
    std::string line = fmt::format(
        "{}:{}: <{}>: {} = {} m is within the particles of the walls, whose layers reach to {:.6g} "
        "m, and the solver would refuse them; {} is written instead.",
        def.file, limit.line, limit.name, own->name, own->value, outermost, wide);
    own->value = wide;
    return line;
}

void widen(Element& limit, const CaseParticles& particles, const CaseDef& def,
           std::vector<std::string>& lines)
{
    const bool is_min = limit.name == "posmin";
    if (!is_min && limit.name != "posmax") return;
    const Vec3& outermost = is_min ? particles.pos_min : particles.pos_max;
    for (int axis = 0; axis < 3; ++axis)
    {
        if (def.grid.is_2d && axis == 1) continue;
        if (auto line = widen(limit, axis, is_min, outermost[axis], def))
            lines.push_back(std::move(*line));
    }
}

/// usual     the limit without <simulationdomain>
/// outwards  the size of the domain without it, negative for the least limit
double limit_of(const Element& element, const std::string& path, int axis, double usual,
                double outwards)
{
    const std::string* given = element.find_attribute(std::string(1, "xyz"[axis]));
    std::string text;
    if (given != nullptr)
        for (const char c : *given)
            if (c != ' ' && c != '\t') text += static_cast<char>(std::tolower(c));
    if (text.empty() || text == "default") return usual;
    const bool is_relative = text.starts_with("default") && text.size() > 8;
    std::string_view number = text;
    if (is_relative) number.remove_prefix(8);
    const bool is_percent = is_relative && number.ends_with('%');
    if (is_percent) number.remove_suffix(1);
    const std::optional<double> value = finite_signed_number(number);
    if (!value)
        throw CaseError(path, element.line,
                        fmt::format("<{} {}=\"{}\">: expected default, default {} 10%, default {} "
                                    "0.5 or a number",
                                    element.name, "xyz"[axis], *given, outwards < 0 ? '-' : '+',
                                    outwards < 0 ? '-' : '+'));
    if (!is_relative) return *value;
    return usual + (is_percent ? outwards * *value / 100 : std::copysign(*value, outwards));
}

} // namespace

std::vector<std::string> widen_simulation_domain(const CaseParticles& particles, CaseDef& def)
{
    std::vector<std::string> lines;
    if (def.fit.is_empty() || def.vres.is_active() || particles.off_lattice.size() == 0)
        return lines;
    for (Element& parameters : def.execution)
        for (Element& domain : parameters.children)
        {
            if (domain.name != "simulationdomain") continue;
            for (Element& limit : domain.children) widen(limit, particles, def, lines);
        }
    return lines;
}

Box3 solver_domain(const Element& parameters, const std::string& path, const DomainFacts& facts)
{
    Box3 all = facts.particles;
    if (all.is_empty()) return all;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double wider =
            facts.is_periodic[static_cast<std::size_t>(axis)] ? facts.dp / 2 : border_h * facts.h;
        all.min[axis] -= wider;
        all.max[axis] += wider;
    }
    Box3 out = all;
    const Element* given = parameters.find_child("simulationdomain");
    for (const bool is_least : {true, false})
    {
        const Element* limit =
            given != nullptr ? given->find_child(is_least ? "posmin" : "posmax") : nullptr;
        for (int axis = 0; axis < 3 && limit != nullptr; ++axis)
        {
            if (facts.is_periodic[static_cast<std::size_t>(axis)] || (facts.is_2d && axis == 1))
                continue;
            const double size = all.max[axis] - all.min[axis];
            double& value = is_least ? out.min[axis] : out.max[axis];
            value = limit_of(*limit, path, axis, value, is_least ? -size : size);
        }
    }
    return out;
}

bool has_old_domain(const Element& parameters)
{
    return std::any_of(parameters.children.begin(), parameters.children.end(),
                       [](const Element& parameter)
                       {
                           const std::string* key = parameter.find_attribute("key");
                           return key != nullptr &&
                                  (*key == "IncZ" || key->starts_with("DomainFixed") ||
                                   key->starts_with("DomainParticles"));
                       });
}

std::optional<Box3> solver_domain(const CaseDef& def, const CaseParticles& particles)
{
    const auto parameters = std::find_if(def.execution.begin(), def.execution.end(),
                                         [](const Element& e) { return e.name == "parameters"; });
    const Element none;
    const Element& given = parameters == def.execution.end() ? none : *parameters;
    if (has_old_domain(given)) return std::nullopt;
    return solver_domain(given, def.file,
                         {{particles.pos_min, particles.pos_max},
                          def.grid.dp,
                          def.h,
                          def.grid.is_periodic,
                          def.grid.is_2d});
}

} // namespace fppg
