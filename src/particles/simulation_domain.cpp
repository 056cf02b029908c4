#include "particles/simulation_domain.h"

#include "core/finite_number.h"

#include <fmt/format.h>

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

} // namespace fppg
