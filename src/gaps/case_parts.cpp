#include "gaps/case_parts.h"

#include "meshes/mesh_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace fppg
{

Transform inverse_of(const Transform& t)
{
    Transform out;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            out.linear[static_cast<std::size_t>(i)][j] = t.linear[static_cast<std::size_t>(j)][i];
    out.offset = -Vec3{dot(out.linear[0], t.offset), dot(out.linear[1], t.offset),
                       dot(out.linear[2], t.offset)};
    return out;
}

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

GapCase read_gap_case(const std::string& definition, const MotionGapOptions& options)
{
    CaseOptions case_options;
    if (options.dp > 0) case_options.dp = options.dp;
    case_options.evars = options.evars;
    case_options.meshes = std::make_shared<MeshLibrary>(definition, MeshPlaces::DefinitionFirst);
    GapCase out;
    out.def = read_case(definition, case_options);
    out.solids = case_solids(make_scene(out.def), options.threads);
    out.end = options.end > 0 ? options.end : time_max(out.def.execution, 0);
    out.notes = out.solids.notes;
    out.parts = case_parts(out.def, out.solids, out.notes);
    if (!(out.end > 0) && !out.def.motion.children.empty())
        out.notes.push_back(
            "The case has no TimeMax: parts are judged where they start; --end gives one.");
    return out;
}

} // namespace fppg
