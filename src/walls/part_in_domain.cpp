#include "walls/part_in_domain.h"

#include "fppg/boolean.h"

#include "core/parallel.h"
#include "meshes/outline.h"
#include "scene/near_domain.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace fppg
{
namespace
{

/// The box touches nothing by intent.
constexpr double cut_merge_dp = 1e-6;

/// When a body is cut: of its area so many times as much is beyond as within, and so much.
struct CutRule
{
    double times = 1;
    double least_dp2 = least_beyond_dp2;
};
/// What is left of a round shape is laid on its facets, not on the exact surface, and has up to 8 %
/// fewer particles (a ball of 120 dp): only where the whole would take minutes.
constexpr CutRule rule_of_round{times_beyond_of_round, 5e6};

/// How much of the area of a mesh is left where it is cut by a rule; 1 where it is not.
double share_left(const SurfaceMesh& mesh, const Box3& box, const CutRule& rule, double dp,
                  int threads)
{
    const double least = rule.least_dp2 * dp * dp;
    const double all = std::accumulate(mesh.areas.begin(), mesh.areas.end(), 0.0);
    if (all < least) return 1;
    std::vector<double> within(mesh.facets.size());
    parallel_for(
        mesh.facets.size(), threads,
        [&](std::size_t f)
        {
            const auto& [a, b, c] = mesh.facets[f];
            const Vec3 corners[3] = {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
            within[f] = area_in_box(box, corners);
        },
        1024);
    const double inside = std::accumulate(within.begin(), within.end(), 0.0);
    return all - inside > std::max(rule.times * inside, least) ? inside / all : 1;
}

bool is_apart(const Box3& a, const Box3& b)
{
    for (int axis = 0; axis < 3; ++axis)
        if (a.max[axis] < b.min[axis] || a.min[axis] > b.max[axis]) return true;
    return false;
}

TriangleSoup soup_of_box(const Box3& box)
{
    const std::array<Vec3, 2> ends{box.min, box.max};
    TriangleSoup soup;
    for (int axis = 0; axis < 3; ++axis)
        for (std::size_t end = 0; end < 2; ++end)
        {
            const auto corner = [&](std::size_t u, std::size_t v)
            {
                Vec3 p;
                p[axis] = ends[end][axis];
                p[(axis + 1) % 3] = ends[u][(axis + 1) % 3];
                p[(axis + 2) % 3] = ends[v][(axis + 2) % 3];
                return p;
            };
            std::array<Vec3, 4> quad{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
            if (end == 0) std::swap(quad[1], quad[3]);
            for (const std::size_t i : {0, 1, 2, 0, 2, 3}) soup.vertices.push_back(quad[i]);
        }
    return soup;
}

/// The domain with its margin; in 2D all of the body's width.
Box3 box_to_lay(const Box3& bounds, const LatticeGrid& grid)
{
    Box3 box = box_near_domain(grid);
    if (!grid.is_2d) return box;
    box.min.y = std::min(box.min.y, bounds.min.y - grid.dp);
    box.max.y = std::max(box.max.y, bounds.max.y + grid.dp);
    return box;
}

} // namespace

double share_laid(const SurfaceMesh& mesh, bool is_round, const FitSettings& settings,
                  const LatticeGrid& grid, int threads)
{
    if (settings.place == Placement::Inside) return 1;
    Box3 bounds;
    for (const Vec3& v : mesh.vertices) bounds.add(v);
    if (is_apart(bounds, box_near_domain(grid))) return 0;
    return share_left(mesh, box_to_lay(bounds, grid), is_round ? rule_of_round : CutRule{}, grid.dp,
                      threads);
}

std::vector<std::uint32_t> cut_to_domain(FittedBody& body, const FitSettings& settings,
                                         const LatticeGrid& grid, int threads)
{
    if (settings.place == Placement::Inside) return {};
    Box3 bounds;
    for (const Vec3& v : body.mesh.vertices) bounds.add(v);
    if (is_apart(bounds, box_near_domain(grid)))
    {
        body.mesh = {};
        body.round = nullptr;
        return {};
    }
    if (share_laid(body.mesh, body.round != nullptr, settings, grid, threads) == 1) return {};
    const Box3 box = box_to_lay(bounds, grid);
    body.round = nullptr;
    MeshReport of_box;
    const SurfaceMesh around = repair_mesh(soup_of_box(box), {}, threads, of_box);
    const BooleanNode both{
        BooleanOp::Intersection, 0, {{BooleanOp::Part, 0, {}}, {BooleanOp::Part, 1, {}}}};
    BooleanMesh cut = boolean_mesh({{"body", &body.mesh, true}, {"domain", &around, false}}, both,
                                   {.merge_distance = cut_merge_dp * grid.dp}, threads);
    cut.report.facets_read = body.report.facets_read;
    cut.report.warnings = std::move(body.report.warnings);
    body.report = std::move(cut.report);
    body.mesh = std::move(cut.mesh);
    return std::move(cut.seams);
}

} // namespace fppg
