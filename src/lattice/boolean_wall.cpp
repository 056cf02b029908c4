#include "lattice/boolean_wall.h"

#include "fppg/error.h"

#include "core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>

namespace fppg
{
namespace
{

std::vector<Spans> by_slab(const SpanSet& set, const LatticeGrid& grid)
{
    std::vector<Spans> out(grid.n[0]);
    for (std::size_t i = 0; i < set.slabs.size(); ++i) out[set.x_begin + i] = set.slabs[i];
    return out;
}

} // namespace

FittedDraw fit_boolean(const std::vector<BooleanWallPart>& parts, const BooleanNode& tree,
                       const FitSettings& settings, const LatticeGrid& grid,
                       const std::vector<ClipPlane>& clips, int threads)
{
    std::deque<SurfaceMesh> meshes;
    std::vector<BooleanPart> operands;
    std::vector<std::string> warnings;
    std::size_t facets = 0;
    for (const BooleanWallPart& part : parts)
    {
        MeshReport report;
        try
        {
            meshes.push_back(take_in_mesh(part.soup, {}, threads, report));
        }
        catch (const GeometryError& e)
        {
            throw GeometryError(fmt::format("{}: {}", part.name, e.what()));
        }
        facets += report.facets_read;
        for (const std::string& w : report.warnings)
            warnings.push_back(fmt::format("{}: {}", part.name, w));
        operands.push_back({part.name, &meshes.back(), part.may_be_sheet});
    }
    BooleanMesh combined = boolean_mesh(operands, tree, {}, threads);
    warnings.insert(warnings.end(), combined.warnings.begin(), combined.warnings.end());
    if (combined.mesh.facets.empty())
        throw GeometryError("nothing is left of the combination of its parts");

    const std::vector<char> stays = staying_parts(tree, parts.size());
    FittedBody body;
    for (std::size_t p = parts.size(); p-- > 0;)
    {
        if (stays[p] == 0) continue;
        body.mk = parts[p].mk;
        body.is_solid = body.is_solid || parts[p].is_solid;
    }
    for (const std::uint32_t owner : combined.owners) body.facet_mk.push_back(parts[owner].mk);
    body.mesh = std::move(combined.mesh);
    body.report = std::move(combined.report);
    body.report.facets_read = facets;
    // Faults of the parts are told with their names.
    body.report.warnings.clear();
    body.features = find_features(body.mesh, feature_options(settings, grid), combined.seams);

    FittedDraw out = fit_body(std::move(body), settings, grid, clips, threads);
    out.warnings.insert(out.warnings.begin(), warnings.begin(), warnings.end());

    std::vector<SpanSet> sets;
    for (const SurfaceMesh& mesh : meshes) sets.push_back(solid_nodes(mesh, grid, threads));
    const SpanSet nodes = boolean_spans(sets, tree, threads);
    const std::vector<SpanSet> shares = share_out(nodes, sets, tree, threads);
    std::map<std::uint16_t, NodeShare> by_mk;
    out.volume.assign(grid.n[0], {});
    if (std::any_of(parts.begin(), parts.end(),
                    [](const BooleanWallPart& p) { return !p.is_solid; }))
        out.body.figures.filled = 0; // part of it is hollow
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
    return out;
}

} // namespace fppg
