#include "fppg/error.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"
#include "fppg/scene.h"
#include "fppg/shapes.h"

#include "core/text.h"
#include "lattice/point_text.h"
#include "meshes/mesh_library.h"
#include "nodes/domain.h"
#include "nodes/run_at.h"
#include "nodes/snap.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace fppg
{
namespace
{

/// Whether a particle stands on a node.
bool is_taken(const RunField& field, const Node& n)
{
    const Run* r = run_at(field, n);
    return r != nullptr && !r->is_covered;
}

/// How near a point must be to a node that is water, dp.
constexpr double water_reach = 1.5;

/// A node near points, and on which of its sides they stand.
struct WaterNode
{
    std::uint32_t y = 0;
    std::uint32_t z = 0;
    unsigned sides = 0; ///< a bit an axis and direction; points up to dp/2 beyond count for both

    bool operator<(const WaterNode& o) const { return std::tie(y, z) < std::tie(o.y, o.z); }
};

/// Along the axes of gravity; across it all count.
unsigned sides_of(const Vec3& from_node, const Vec3& gravity, double dp)
{
    unsigned sides = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        if (gravity[axis] == 0) sides |= 3U << (2 * axis);
        if (from_node[axis] >= -dp / 2) sides |= 1U << (2 * axis);
        if (from_node[axis] <= dp / 2) sides |= 2U << (2 * axis);
    }
    return sides;
}

/// The empty nodes of a slab that have points above and below. `near` holds the indices of all
/// points whose nearest node is at most two slabs away.
Spans water_of(std::uint32_t x, const std::vector<const std::vector<std::uint32_t>*>& near,
               const std::vector<Vec3>& points, const Vec3& gravity, const RunField& field)
{
    constexpr unsigned all_sides = 63;
    const LatticeGrid& grid = field.grid;
    std::vector<WaterNode> nodes;
    const auto add_around = [&](const Vec3& point)
    {
        const Node nearest = snap(point, grid);
        for (std::int64_t y = nearest.y - 2; y <= nearest.y + 2; ++y)
            for (std::int64_t z = nearest.z - 2; z <= nearest.z + 2; ++z)
            {
                const Node n{x, y, z};
                const Vec3 away = point - position(n, grid);
                if (norm(away) > water_reach * grid.dp || !is_inside(n, grid)) continue;
                nodes.push_back({static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(z),
                                 sides_of(away, gravity, grid.dp)});
            }
    };
    for (const std::vector<std::uint32_t>* bucket : near)
        for (const std::uint32_t i : *bucket) add_around(points[i]);
    std::sort(nodes.begin(), nodes.end());
    Spans spans;
    for (auto n = nodes.begin(); n != nodes.end();)
    {
        const auto first = n;
        unsigned sides = 0;
        for (; n != nodes.end() && n->y == first->y && n->z == first->z; ++n) sides |= n->sides;
        if (sides == all_sides && run_at(field, {x, first->y, first->z}) == nullptr)
            spans.push_back({first->y, first->z, first->z + 1});
    }
    sort_and_join(spans);
    return spans;
}

/// Gives the fluid of points nodes, so that water columns count it as they count that of
/// `setfrdrawmode`: the nearest node of each point, and those between points less than 1.5 dp away,
/// so that uneven points leave no gaps. Nodes that carry an mk stay.
void mark_water(const std::vector<Vec3>& points, std::uint16_t mk, const Vec3& gravity,
                RunField& field)
{
    const std::size_t slabs = field.slabs.size();
    std::vector<std::vector<std::uint32_t>> of_slab(slabs);
    for (std::size_t i = 0; i < points.size(); ++i)
        of_slab[static_cast<std::size_t>(snap(points[i], field.grid).x)].push_back(
            static_cast<std::uint32_t>(i));
    for (std::size_t x = 0; x < slabs; ++x)
    {
        std::vector<const std::vector<std::uint32_t>*> near;
        for (std::size_t k = x < 2 ? 0 : x - 2; k <= std::min(x + 2, slabs - 1); ++k)
            if (!of_slab[k].empty()) near.push_back(&of_slab[k]);
        if (near.empty()) continue;
        paint(field.slabs[x], water_of(static_cast<std::uint32_t>(x), near, points, gravity, field),
              mk, true);
    }
    field.walls.has_point_water = true;
}

/// Warnings of points that stand on one another or on nodes: the solver stops on them.
void check_places(const std::string& at, const std::vector<Vec3>& points, const RunField& field,
                  LatticeReport& report)
{
    std::size_t near_nodes = 0;
    Vec3 first;
    for (const Vec3& p : points)
    {
        const Node n = snap(p, field.grid);
        if (!is_taken(field, n) || norm(position(n, field.grid) - p) >= 0.5 * field.grid.dp)
            continue;
        if (near_nodes++ == 0) first = p;
    }
    if (near_nodes > 0)
        report.warnings.push_back(
            fmt::format("{}: {} nearer than dp/2 to a particle on the lattice, the first at {}.",
                        at, counted(near_nodes, "point is", "points are"), text(first)));
    const auto before = [](const Vec3& a, const Vec3& b)
    { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
    std::vector<Vec3> sorted = field.walls.volume.positions;
    std::sort(sorted.begin(), sorted.end(), before);
    std::size_t twice = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i] == sorted[i - 1] && twice++ == 0) first = sorted[i];
    if (twice > 0)
        report.warnings.push_back(
            fmt::format("{}: {} at the place of another one, the first at {}.", at,
                        counted(twice, "point is", "points are"), text(first)));
}

} // namespace

void add_point_files(const Scene& scene, RunField& field, LatticeReport& report)
{
    const CaseDef& def = *scene.def;
    for (const PointFile& file : def.point_files)
    {
        const std::string at = fmt::format("{}:{}: <{} file=\"{}\">", def.file, file.source.line,
                                           file.source.command, file.file);
        const std::string path = scene.meshes->find(file.source, file.file);
        std::vector<Vec3> points;
        try
        {
            points = read_point_file(path);
        }
        catch (const GeometryError& e)
        {
            throw GeometryError(fmt::format("{}: {}", at, e.what()));
        }
        for (std::size_t i = 0; i < points.size(); ++i)
        {
            points[i] = file.transform(points[i]);
            if (is_in_domain(points[i], field.grid)) continue;
            const LatticeGrid& grid = field.grid;
            const Node last{grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1};
            throw GeometryError(fmt::format(
                "{}: point {} of {} is at {}, expected a place from {} to {}, inside the domain",
                at, i + 1, points.size(), text(points[i]), text(grid.origin),
                text(position(last, grid))));
        }
        const auto is_it = [&](const MeshFileUse& use) { return use.name == file.file; };
        if (std::none_of(report.mesh_files.begin(), report.mesh_files.end(), is_it))
            report.mesh_files.push_back({file.file, path, file.source.line});
        VolumeParticles& volume = field.walls.volume;
        volume.positions.insert(volume.positions.end(), points.begin(), points.end());
        volume.mk.insert(volume.mk.end(), points.size(), file.mk.mk);
        volume.distances.insert(volume.distances.end(), points.size(), distance_of_nodes);
        check_places(at, points, field, report);
        if (file.mk.kind == MkKind::Fluid)
            mark_water(points, file.mk.mk, def.constants.gravity, field);
        report.log.push_back(fmt::format(
            "{}: {} of mk {}", at, counted(points.size(), "particle", "particles"), file.mk.mk));
    }
}

} // namespace fppg
