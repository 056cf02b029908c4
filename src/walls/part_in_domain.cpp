#include "walls/part_in_domain.h"

#include "fppg/boolean.h"

#include "core/parallel.h"
#include "meshes/cut_at_plane.h"
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

/// What of the area of a facet is in a box.
double area_in(const Box3& box, const std::array<Vec3, 3>& corners)
{
    std::vector<Vec3> polygon(corners.begin(), corners.end());
    std::vector<Vec3> kept;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool is_lower : {true, false})
        {
            const double limit = is_lower ? box.min[axis] : box.max[axis];
            cut_at_plane(
                polygon,
                [&](const Vec3& p) { return is_lower ? p[axis] >= limit : p[axis] <= limit; },
                [&](const Vec3& a, const Vec3& b)
                { return a + ((limit - a[axis]) / (b[axis] - a[axis])) * (b - a); },
                kept);
            polygon.swap(kept);
        }
    Vec3 twice;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        twice = twice + cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    return 0.5 * norm(twice);
}

/// When a body is cut: of its area so many times as much is beyond as within, and so much.
struct CutRule
{
    double times = 1;
    double least_dp2 = least_beyond_dp2;
};
/// What is left of a round shape is laid on its facets, not on the exact surface, and has up to 8 %
/// fewer particles (a ball of 120 dp): only where the whole would take minutes.
constexpr CutRule rule_of_round{times_beyond_of_round, 5e6};

bool is_mostly_beyond(const SurfaceMesh& mesh, const Box3& box, const CutRule& rule, double dp,
                      int threads)
{
    const double least = rule.least_dp2 * dp * dp;
    const double all = std::accumulate(mesh.areas.begin(), mesh.areas.end(), 0.0);
    if (all < least) return false;
    std::vector<double> within(mesh.facets.size());
    parallel_for(
        mesh.facets.size(), threads,
        [&](std::size_t f)
        {
            const auto& [a, b, c] = mesh.facets[f];
            within[f] = area_in(box, {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
        },
        1024);
    const double inside = std::accumulate(within.begin(), within.end(), 0.0);
    return all - inside > std::max(rule.times * inside, least);
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

} // namespace

std::vector<std::uint32_t> cut_to_domain(FittedBody& body, const FitSettings& settings,
                                         const LatticeGrid& grid, int threads)
{
    if (settings.place == Placement::Inside || grid.is_2d) return {};
    const Box3 box = box_near_domain(grid);
    const CutRule rule = body.round != nullptr ? rule_of_round : CutRule{};
    if (!is_mostly_beyond(body.mesh, box, rule, grid.dp, threads)) return {};
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
