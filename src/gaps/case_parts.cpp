#include "gaps/case_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace fppg
{

Transform CasePart::place(double time) const
{
    if (!motion) return {};
    return place_at(*motion, time).value_or(Transform{});
}

std::vector<CasePart> case_parts(const CaseDef& def, const CaseSolids& solids,
                                 std::vector<std::string>& notes)
{
    std::map<std::uint16_t, CasePart> parts;
    for (const CaseShape& shape : solids.shapes)
    {
        if (shape.kind != MkKind::Bound || shape.mk < def.mk_bound_first) continue;
        const auto mkbound = static_cast<std::uint16_t>(shape.mk - def.mk_bound_first);
        CasePart& part = parts[mkbound];
        part.mkbound = mkbound;
        part.name += (part.name.empty() ? "" : ", ") + shape.name;
        part.shapes.push_back(&shape);
    }
    const auto follow = [&](const Element& object, const MotionChain& chain)
    {
        const auto found = parts.find(static_cast<std::uint16_t>(number_or(object, "ref", -1)));
        if (found == parts.end()) return;
        found->second.motion = chain;
        found->second.is_followed = place_at(chain, 1e-6).has_value();
        if (!found->second.is_followed)
            notes.push_back(fmt::format(
                "mkbound {} is moved by a file or by what stands elsewhere for the solver: it is "
                "judged where it starts.",
                found->first));
    };
    for_each_moving(def.motion, follow);
    for (const FloatingDef& floating : def.floatings)
        for (const std::uint16_t mk : floating.mkbound)
            if (parts.contains(mk))
                notes.push_back(
                    fmt::format("mkbound {} floats: it is judged where it starts.", mk));
    std::vector<CasePart> out;
    for (auto& [mkbound, part] : parts)
    {
        TriangleSoup soup;
        for (const CaseShape* shape : part.shapes)
        {
            const std::vector<Vec3>& corners = shape->solid->soup().vertices;
            soup.vertices.insert(soup.vertices.end(), corners.begin(), corners.end());
        }
        if (soup.size() == 0) continue;
        part.tree = std::make_unique<GapTree>(std::move(soup));
        out.push_back(std::move(part));
    }
    return out;
}

} // namespace fppg
