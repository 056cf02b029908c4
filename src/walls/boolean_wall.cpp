#include "walls/boolean_wall.h"

#include "fppg/error.h"

#include "core/parallel.h"
#include "meshes/cad_surface.h"
#include "nodes/cell_nodes.h"
#include "walls/fit_shape.h"
#include "walls/thickened.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace fppg
{
namespace
{

/// The body of a combination, with its features.
FittedBody body_of(CombinedParts& combined, const FitSettings& settings, const LatticeGrid& grid,
                   int threads)
{
    const std::vector<BooleanWallPart>& parts = combined.parts;
    const std::vector<char> stays = staying_parts(*combined.tree, parts.size());
    BooleanMesh& result = combined.result;
    FittedBody body;
    for (std::size_t p = parts.size(); p-- > 0;)
    {
        if (stays[p] == 0) continue;
        body.mk = parts[p].mk;
        body.is_solid = body.is_solid || parts[p].is_solid;
    }
    body.facet_mk = mks_of_facets(combined);
    body.mesh = std::move(result.mesh);
    body.report = std::move(result.report);
    body.report.facets_read = combined.facets_read;
    // Faults of the parts are told with their names.
    body.report.warnings.clear();
    std::vector<CadSource> sources;
    for (const BooleanWallPart& part : parts)
        if (part.cad != nullptr) sources.push_back(*part.cad);
    if (!sources.empty())
        body.cad = std::make_shared<const CadSurface>(body.mesh, std::move(sources), threads);
    body.features =
        find_features(body.mesh, feature_options(settings, grid), result.seams, bends_of(body.cad));
    return body;
}

/// Gives the nodes inside to the first of their parts each.
void share_nodes(const std::vector<BooleanWallPart>& parts, const std::vector<SpanSet>& shares,
                 const std::vector<ClipPlane>& clips, const LatticeGrid& grid, int threads,
                 FittedDraw& out)
{
    std::map<std::uint16_t, NodeShare> by_mk;
    out.volume.assign(grid.n[0], {});
    if (std::any_of(parts.begin(), parts.end(),
                    [](const BooleanWallPart& p) { return !p.is_solid; }))
        out.body.measures.filled = 0; // part of it is hollow
    for (std::size_t p = 0; p < parts.size(); ++p)
    {
        if (shares[p].slabs.empty()) continue;
        const std::vector<Spans> own = by_slab(shares[p], grid);
        NodeShare& share = by_mk[parts[p].mk];
        share.mk = parts[p].mk;
        share.nodes.resize(grid.n[0]);
        parallel_for(grid.n[0], threads,
                     [&](std::size_t x)
                     {
                         share.nodes[x] = unite(share.nodes[x], own[x]);
                         if (!parts[p].is_solid) return;
                         Spans volume = subtract(own[x], out.zone[x]);
                         for (const ClipPlane& clip : clips)
                             apply_clip(volume, static_cast<std::uint32_t>(x), clip, grid);
                         out.volume[x] = unite(out.volume[x], volume);
                     });
    }
    for (auto& [mk, share] : by_mk)
        if (mk != out.body.mk) out.shares.push_back(std::move(share));
}

} // namespace

std::vector<BooleanWallPart> boolean_parts(const Scene& scene, const Combination& combination,
                                           PartsAs as, int threads)
{
    std::vector<BooleanWallPart> parts;
    for (std::size_t p = 0; p < combination.parts.size(); ++p)
    {
        ShapeMesh surface = surface_of_part(scene, combination, p, as, threads);
        const BooleanDef::Part& part = combination.boolean->parts[p];
        parts.push_back({name_of(combination.parts[p]->source), std::move(surface.soup),
                         combination.mks[p].mk, surface.is_solid, part.is_sheet, part.is_surface,
                         part.least_depth, std::move(surface.cad)});
    }
    return parts;
}

CombinedParts combine_parts(std::vector<BooleanWallPart> parts, const BooleanNode& tree, double dp,
                            int threads)
{
    CombinedParts out;
    out.parts = std::move(parts);
    out.tree = &tree;
    std::vector<BooleanPart> operands;
    for (const BooleanWallPart& part : out.parts)
    {
        MeshReport report;
        try
        {
            out.meshes.push_back(repair_mesh(
                part.soup, {.dp = dp, .is_solid = !part.may_be_sheet && !part.is_surface}, threads,
                report));
        }
        catch (const GeometryError& e)
        {
            throw GeometryError(fmt::format("{}: {}", part.name, e.what()));
        }
        out.facets_read += report.facets_read;
        for (const std::string& w : report.warnings)
            out.warnings.push_back(fmt::format("{}: {}", part.name, w));
        operands.push_back(
            {part.name, &out.meshes.back(), part.may_be_sheet, part.is_surface, part.least_depth});
    }
    out.result = boolean_mesh(operands, tree, {.dp = dp}, threads);
    out.warnings.insert(out.warnings.end(), out.result.warnings.begin(), out.result.warnings.end());
    if (out.result.mesh.facets.empty())
        throw NothingLeft("nothing is left of the combination of its parts");
    return out;
}

ShapeMesh shape_of(const CombinedParts& combined)
{
    ShapeMesh out;
    out.soup = soup_of(combined.result.mesh);
    const std::vector<char> stays = staying_parts(*combined.tree, combined.parts.size());
    for (std::size_t p = 0; p < stays.size(); ++p)
        out.is_solid = out.is_solid || (stays[p] != 0 && combined.parts[p].is_solid);
    return out;
}

std::vector<std::uint16_t> mks_of_facets(const CombinedParts& combined)
{
    std::vector<std::uint16_t> out;
    for (const std::uint32_t owner : combined.result.owners)
        out.push_back(combined.parts[owner].mk);
    return out;
}

bool is_hollowed_away(const Combination* combination, const GeometryError& error)
{
    return combination != nullptr && combination->hollowed != nullptr &&
           dynamic_cast<const NothingLeft*>(&error) != nullptr;
}

FittedDraw fit_boolean(CombinedParts&& combined, const FitSettings& settings,
                       const LatticeGrid& grid, const std::vector<ClipPlane>& clips, int threads)
{
    const std::vector<BooleanWallPart>& parts = combined.parts;
    const BooleanNode& tree = *combined.tree;
    if (settings.thickens && !parts[0].is_surface)
        if (const double thickness = thicken(grid, threads, combined.result.mesh); thickness > 0)
            combined.warnings.push_back(thickened_from(thickness, grid.dp));
    FittedDraw out =
        fit_body(body_of(combined, settings, grid, threads), settings, grid, clips, threads);
    out.warnings.insert(out.warnings.begin(), combined.warnings.begin(), combined.warnings.end());

    std::vector<SpanSet> sets;
    for (std::size_t p = 0; p < parts.size(); ++p)
        sets.push_back(parts[p].is_surface ? SpanSet{}
                                           : solid_nodes(combined.meshes[p], grid, threads));
    const SpanSet nodes = boolean_spans(sets, tree, threads);
    share_nodes(parts, share_out(nodes, sets, tree, threads), clips, grid, threads, out);
    return out;
}

} // namespace fppg
