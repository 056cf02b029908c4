#include "fppg/case_def.h"
#include "fppg/error.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"
#include "fppg/shapes.h"

#include "casedef/mesh_path.h"
#include "lattice/snap.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace fppg
{
namespace
{

/// Rounding of the place of a point, dp.
constexpr double place_tolerance = 1e-6;

std::string text(const Vec3& p)
{
    return fmt::format("({:g}, {:g}, {:g})", p.x, p.y, p.z);
}

/// Between the first and the last nodes, and in 2D in the plane.
bool is_in_domain(const Vec3& p, const LatticeGrid& grid)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const double index = (p[axis] - grid.origin[axis]) / grid.dp;
        if (!(index >= -place_tolerance &&
              index <= grid.n[static_cast<std::size_t>(axis)] - 1 + place_tolerance))
            return false;
    }
    return true;
}

/// The run that a node is in; null: nothing is there.
const Run* run_at(const RunField& field, const Node& n)
{
    if (!is_inside(n, field.grid)) return nullptr;
    const std::vector<Run>& slab = field.slabs[static_cast<std::size_t>(n.x)];
    const auto after =
        std::upper_bound(slab.begin(), slab.end(), std::pair(n.y, n.z),
                         [](const std::pair<std::int64_t, std::int64_t>& at, const Run& r)
                         { return std::tuple(at.first, at.second) < std::tuple(r.y, r.z_begin); });
    if (after == slab.begin()) return nullptr;
    const Run& r = *std::prev(after);
    return r.y == n.y && n.z < r.z_end ? &r : nullptr;
}

/// Whether a particle stands on a node.
bool is_taken(const RunField& field, const Node& n)
{
    const Run* r = run_at(field, n);
    return r != nullptr && !(field.walls.has_zones() && (r->mk & wall_zone_bit) != 0);
}

/// A node that points stand for.
struct WaterNode
{
    std::uint32_t y = 0;
    std::uint32_t z = 0;
    bool is_nearest = false; ///< of a point

    bool operator<(const WaterNode& o) const { return std::tie(y, z) < std::tie(o.y, o.z); }
};

/// The columns of sorted nodes, each from the lowest to the highest that is the nearest of a point.
Spans columns_of(const std::vector<WaterNode>& nodes)
{
    Spans spans;
    bool is_open = false; // the last span has grown up to the node before
    std::uint32_t end = 0;
    for (const WaterNode& n : nodes)
    {
        if (is_open && (n.y != spans.back().y || n.z > end)) is_open = false;
        end = n.z + 1;
        if (is_open && n.is_nearest)
            spans.back().z_end = end;
        else if (n.is_nearest)
        {
            spans.push_back({n.y, n.z, end});
            is_open = true;
        }
    }
    return spans;
}

/// Gives the fluid of points nodes, so that water columns count it as they count that of
/// `setfrdrawmode`: the nearest node of each point, and between such of a column the nodes within
/// dp of a point, so that uneven points leave no gaps. Nodes that carry an mk stay.
void mark_water(const std::vector<Vec3>& points, std::uint16_t mk, RunField& field)
{
    const LatticeGrid& grid = field.grid;
    std::vector<std::vector<WaterNode>> nodes(field.slabs.size());
    for (const Vec3& p : points)
    {
        const Node nearest = snap(p, grid);
        for (std::int64_t x = nearest.x - 1; x <= nearest.x + 1; ++x)
            for (std::int64_t y = nearest.y - 1; y <= nearest.y + 1; ++y)
                for (std::int64_t z = nearest.z - 1; z <= nearest.z + 1; ++z)
                {
                    const Node n{x, y, z};
                    const bool is_nearest = n == nearest;
                    if (!is_inside(n, grid) || run_at(field, n) != nullptr) continue;
                    if (is_nearest || norm(position(n, grid) - p) <= grid.dp)
                        nodes[static_cast<std::size_t>(x)].push_back({static_cast<std::uint32_t>(y),
                                                                      static_cast<std::uint32_t>(z),
                                                                      is_nearest});
                }
    }
    for (std::size_t x = 0; x < nodes.size(); ++x)
    {
        if (nodes[x].empty()) continue;
        std::stable_sort(nodes[x].begin(), nodes[x].end());
        paint(field.slabs[x], columns_of(nodes[x]), static_cast<std::uint16_t>(mk | wall_zone_bit));
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
        report.warnings.push_back(fmt::format(
            "{}: {} points stand nearer than dp/2 to a particle on the lattice, the first at {}.",
            at, near_nodes, text(first)));
    const auto before = [](const Vec3& a, const Vec3& b)
    { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
    std::vector<Vec3> sorted = field.walls.volume.positions;
    std::sort(sorted.begin(), sorted.end(), before);
    std::size_t twice = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i] == sorted[i - 1] && twice++ == 0) first = sorted[i];
    if (twice > 0)
        report.warnings.push_back(
            fmt::format("{}: {} points stand where another one stands already, the first at {}.",
                        at, twice, text(first)));
}

} // namespace

void add_point_files(const CaseDef& def, RunField& field, LatticeReport& report)
{
    for (const PointFile& file : def.point_files)
    {
        const std::string at = fmt::format("{}:{}: <{} file=\"{}\">", def.file, file.source.line,
                                           file.source.command, file.file);
        const std::string path = find_mesh_file(def, file.source, file.file);
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
        if (file.mk.kind == MkKind::Fluid) mark_water(points, file.mk.mk, field);
        report.log.push_back(
            fmt::format("{}: {} particles of mk {}", at, points.size(), file.mk.mk));
    }
}

} // namespace fppg
