#include "fppg/exclusion_band.h"

#include "core/even_places.h"
#include "core/parallel.h"
#include "core/text.h"
#include "fit/closed_part.h"
#include "fit/left_out_nodes.h"
#include "fit/near_nodes.h"
#include "fit/wall_section.h"
#include "fppg/error.h"
#include "meshes/column_spans.h"
#include "meshes/inside_by_vote.h"
#include "meshes/inside_test.h"
#include "nodes/domain.h"
#include "nodes/spans.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace fppg
{

namespace
{

/// A lattice around the mesh whose nodes are those of the case's lattice, moved by whole steps.
struct WideGrid
{
    LatticeGrid grid;
    std::array<std::int64_t, 3> offset{0, 0, 0}; ///< of its node 0 in the lattice of the case
};

/// Nodes that the lattice may have beyond the domain along an axis; memory grows with them, however
/// little of the wall is there.
constexpr double most_beyond = 1 << 24;

/// The lattice itself where it holds the mesh and all nodes near it, else a larger one.
WideGrid widen(const LatticeGrid& lattice, const Box3& bounds)
{
    expect_near(bounds, lattice);
    WideGrid wide;
    wide.grid = lattice;
    for (int axis = 0; axis < 3; ++axis)
    {
        if (axis == 1 && lattice.is_2d) continue;
        const auto k = static_cast<std::size_t>(axis);
        const double low =
            std::floor((bounds.min[axis] - lattice.origin[axis]) / lattice.step(axis)) - 2;
        const double high =
            std::ceil((bounds.max[axis] - lattice.origin[axis]) / lattice.step(axis)) + 2;
        const double begin = std::min(low, 0.0);
        const double end = std::max(high + 1, static_cast<double>(lattice.n[k]));
        if (!(std::max(-begin, end - lattice.n[k]) < most_beyond))
            throw GeometryError(fmt::format(
                "the surface reaches from {:.6g} to {:.6g} m along {}, more than 2^24 dp of {:.6g} "
                "m beyond the domain",
                bounds.min[axis], bounds.max[axis], "xyz"[axis], lattice.dp));
        wide.offset[k] = static_cast<std::int64_t>(begin);
        wide.grid.n[k] = static_cast<std::uint32_t>(end - begin);
        wide.grid.origin[axis] = lattice.origin[axis] + begin * lattice.step(axis);
    }
    return wide;
}

/// The surface that nodes keep away from: facets, or in 2D the lines where they meet the plane.
struct Wall
{
    TriangleSoup soup;
    std::vector<Vec3> normals;     ///< of unit length
    std::vector<double> sizes;     ///< areas or lengths
    std::vector<char> is_bounding; ///< per facet of the soup
    double section_area = 0;       ///< 2D: within the lines that bound a volume
};

Wall whole_surface(const SurfaceMesh& mesh, const ClosedPart& part)
{
    Wall wall;
    wall.soup = soup_of(mesh);
    wall.normals = mesh.normals;
    wall.sizes = mesh.areas;
    wall.is_bounding = part.is_bounding;
    return wall;
}

Wall section_of(const SurfaceMesh& mesh, const ClosedPart& part, double plane_y)
{
    WallSection section = wall_section(mesh, plane_y);
    Wall wall;
    wall.soup = std::move(section.soup);
    wall.normals = std::move(section.normals);
    wall.sizes = std::move(section.lengths);
    for (const std::uint32_t facet : section.facets)
        wall.is_bounding.push_back(part.is_bounding[facet]);
    if (wall.soup.size() == 0) return wall;
    // Divergence in the plane: half the sum of place times outward normal times length.
    const Vec3 from = wall.soup.vertices[0];
    for (std::size_t i = 0; i < wall.soup.size(); ++i)
        if (wall.is_bounding[i] != 0)
            wall.section_area +=
                0.5 * dot(wall.soup.vertices[3 * i] - from, wall.normals[i]) * wall.sizes[i];
    return wall;
}

/// How much of a wall lies inside the body, from points spread evenly over it: each of the two
/// sides of a point counts one half.
double share_inside(const Wall& wall, const TriangleSoup& body, double dp, int threads)
{
    constexpr std::size_t samples = 4096;
    double total = 0;
    for (const double size : wall.sizes) total += size;
    std::vector<std::size_t> facet_of(samples, 0);
    double passed = 0;
    std::size_t next = 0;
    for (std::size_t f = 0; f < wall.sizes.size(); ++f)
    {
        passed += wall.sizes[f];
        for (; next < samples && (static_cast<double>(next) + 0.5) * total < passed * samples;
             ++next)
            facet_of[next] = f;
    }
    const InsideTest test(body, threads);
    std::vector<char> sides(samples, 0);
    parallel_for(
        samples, threads,
        [&](std::size_t i)
        {
            const Vec3* p = &wall.soup.vertices[3 * facet_of[i]];
            const Vec3 at = even_on_facet({p[0], p[1], p[2]}, static_cast<double>(i));
            for (const double way : {-1e-4, 1e-4})
                if (test.is_inside(at + way * dp * wall.normals[facet_of[i]])) ++sides[i];
        },
        64);
    std::size_t sum = 0;
    for (const char side : sides) sum += static_cast<std::size_t>(side);
    return static_cast<double>(sum) / (2 * samples);
}

/// What a signed volume of a body without holes counts more than once, less that counted below
/// zero, metres cubed: along lines in z that are spread evenly over the body's box. The columns of
/// the lattice would do this worse where facets are parallel to them.
double measure_overlap(const TriangleSoup& body, int threads)
{
    constexpr std::size_t samples = 1 << 15;
    const MeshQuery query(body, threads);
    Box3 box;
    for (const Vec3& p : body.vertices) box.add(p);
    const Vec3 size = box.max - box.min;
    std::vector<double> lengths(samples, 0);
    parallel_for(
        samples, threads,
        [&](std::size_t i)
        {
            const auto [u, v] = even_in_square(static_cast<double>(i), 0.5);
            const Vec3 at{box.min.x + size.x * u, box.min.y + size.y * v,
                          box.min.z - 0.01 * size.z};
            int sum = 0;
            double before = at.z;
            for (const Crossing& crossing : query.crossings(at, 2))
            {
                lengths[i] += (sum - (sum > 0 ? 1 : 0)) * (crossing.position - before);
                before = crossing.position;
                sum += crossing.step;
            }
        },
        256);
    double total = 0;
    for (const double length : lengths) total += length;
    return total / samples * size.x * size.y;
}

/// No node of a solid is nearer to its surface than this, 0.4 dp.
constexpr std::uint32_t least_node_distance = distance_units / 5 * 2;

/// Before layers, whose first particle is half a dp behind the surface, nodes stay from here on, so
/// that fluid has the volume that the wall leaves it: 0.1 dp.
constexpr std::uint32_t least_before_layers = distance_units / 10;

/// A number for each node such that those below any bound are spread evenly over any plane of the
/// lattice: the Kronecker sequence of the root of x^4 = x + 1, 2^32 a turn.
std::uint32_t even_rank(std::int64_t x, std::int64_t y, std::int64_t z)
{
    constexpr std::uint64_t a1 = 3518319155, a2 = 2882110345, a3 = 2360945575;
    return static_cast<std::uint32_t>(a1 * static_cast<std::uint64_t>(x) +
                                      a2 * static_cast<std::uint64_t>(y) +
                                      a3 * static_cast<std::uint64_t>(z));
}

/// Walks the near nodes of a slab together with its inside; body(node, is_inside).
template <typename Body>
void for_each_near_node(const std::vector<NearNode>& nodes, const std::vector<Span>& inside,
                        const Body& body)
{
    std::size_t i = 0;
    for (const NearNode& node : nodes)
    {
        while (i < inside.size() &&
               (inside[i].y < node.y || (inside[i].y == node.y && inside[i].z_end <= node.z)))
            ++i;
        body(node, i < inside.size() && inside[i].y == node.y && inside[i].z_begin <= node.z);
    }
}

std::uint64_t count_nodes(const std::vector<Span>& spans)
{
    std::uint64_t count = 0;
    for (const Span& s : spans) count += s.z_end - s.z_begin;
    return count;
}

/// The spans of a slab of the wide lattice that lie in the lattice of the case.
std::vector<Span> clip(const std::vector<Span>& spans, const WideGrid& wide,
                       const LatticeGrid& lattice)
{
    std::vector<Span> result;
    for (const Span& s : spans)
    {
        const std::int64_t y = s.y + wide.offset[1];
        const std::int64_t begin = std::max<std::int64_t>(s.z_begin + wide.offset[2], 0);
        const std::int64_t end = std::min<std::int64_t>(s.z_end + wide.offset[2], lattice.n[2]);
        if (y < 0 || y >= lattice.n[1] || begin >= end) continue;
        result.push_back({static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(begin),
                          static_cast<std::uint32_t>(end)});
    }
    return result;
}

std::string why_no_volume(const MeshReport& report)
{
    if (report.open_edges > 0) return counted(report.open_edges, "edge is open", "edges are open");
    if (report.non_manifold_edges > 0)
        return fmt::format("more than two facets meet at {}",
                           counted(report.non_manifold_edges, "edge", "edges"));
    if (report.clashing_edges > 0) return "it has one side only";
    return "the volumes of its parts cancel out";
}

void warn(const ClosedPart& part, const MeshReport& report, double area, double overlap,
          ExclusionBand& zone)
{
    if (!zone.has_inside)
        zone.warnings.push_back(fmt::format(
            "The mesh of {} facets bounds no volume: {}; its surface is covered on both sides and "
            "it has no inside.",
            report.facets_read, why_no_volume(report)));
    else if (zone.sheet_facets > 0)
        zone.warnings.push_back(fmt::format(
            "{} of {} facets bound no volume; they are covered as sheets and are not part of the "
            "inside.",
            zone.sheet_facets, part.is_bounding.size()));
    if (overlap > 1e-6 * zone.body_volume)
        zone.warnings.push_back(
            fmt::format("Parts of the mesh overlap; {:.3g} m3, {:.2g} % of the body, count once.",
                        overlap, 100 * overlap / zone.body_volume));
    if (zone.has_inside && part.hole_area > 0)
        zone.warnings.push_back(
            fmt::format("Holes of {:.3g} m2, {:.2g} % of the surface, count as closed.",
                        part.hole_area, 100 * part.hole_area / area));
    if (zone.disputed_nodes > 0)
        zone.warnings.push_back(
            fmt::format("Whether {} nodes are inside was resolved by the winding number of the "
                        "surface, as lines "
                        "through it disagree.",
                        zone.disputed_nodes));
}

/// Finds the zone of one wall.
class ZoneFinder
{
public:
    ZoneFinder(const SurfaceMesh& mesh, const MeshReport& report, const LatticeGrid& grid,
               const ExclusionBandOptions& options, int threads)
        : mesh_(mesh),
          report_(report),
          grid_(grid),
          options_(options),
          threads_(threads),
          // The nodes of a solid stop a fill themselves.
          within_(options.is_solid ? least_node_distance : half_dp),
          beyond_(options.is_before_layers ? least_before_layers : half_dp + 1)
    {
    }

    ExclusionBand run()
    {
        part_ = find_closed_part(mesh_);
        Wall wall =
            grid_.is_2d ? section_of(mesh_, part_, grid_.origin.y) : whole_surface(mesh_, part_);
        if (wall.soup.size() == 0) return {};
        wide_ = widen(grid_, report_.bounds);
        near_ = find_near_nodes(wall.soup, wide_.grid, threads_);
        measure(wall);
        // Of fine facets it is large; find_inside() makes it anew for the few meshes that need it.
        if (!grid_.is_2d) wall.soup = {};
        if (zone_.has_inside)
            find_inside(wall);
        else
            zone_.body_volume = 0;
        choose_clearances();
        take_nodes();
        double area = 0;
        for (const double a : mesh_.areas) area += a;
        warn(part_, report_, area, overlap_, zone_);
        return std::move(zone_);
    }

private:
    void measure(const Wall& wall)
    {
        zone_.sheet_facets = part_.sheet_facets;
        const double depth = grid_.is_2d ? grid_.dp : 1;
        for (std::size_t i = 0; i < wall.sizes.size(); ++i)
        {
            zone_.area += depth * wall.sizes[i];
            if (wall.is_bounding[i] == 0) zone_.sheet_area += depth * wall.sizes[i];
        }
        zone_.body_volume = grid_.is_2d ? wall.section_area * grid_.dp : part_.volume;
        zone_.has_inside = part_.volume > 0 && zone_.body_volume > 0;
        zone_.wall_share_inside = options_.share_inside;
    }

    void find_inside(Wall& wall)
    {
        const TriangleSoup bounding = soup_of_closed_part(mesh_, part_);
        InsideVote vote;
        if (part_.is_exact)
        {
            ColumnOptions column_options;
            column_options.measures_overlap = true;
            ColumnCuts cuts = cut_columns(bounding, wide_.grid, column_options, threads_);
            vote.inside = std::move(cuts.inside);
            vote.overlap = cuts.overlap;
        }
        else
            vote = vote_inside(bounding, wide_.grid, threads_);
        zone_.disputed_nodes = vote.disputed;
        overlap_ = vote.overlap;
        if (overlap_ != 0 && part_.is_exact && !grid_.is_2d)
            overlap_ = measure_overlap(bounding, threads_);
        zone_.body_volume -= overlap_;
        if (overlap_ != 0 || zone_.sheet_facets > 0)
        {
            if (!grid_.is_2d) wall.soup = soup_of(mesh_);
            zone_.wall_share_inside *= 2 * share_inside(wall, bounding, grid_.dp, threads_);
        }
        inside_ = std::move(vote.inside);
    }

    const std::vector<Span>& inside_of(std::size_t x) const
    {
        static const std::vector<Span> nothing;
        const bool has_slab = x >= inside_.x_begin && x - inside_.x_begin < inside_.slabs.size();
        return has_slab ? inside_.slabs[x - inside_.x_begin] : nothing;
    }

    std::uint32_t hash_of(std::size_t x, const NearNode& node) const
    {
        return even_rank(static_cast<std::int64_t>(x) + wide_.offset[0], node.y + wide_.offset[1],
                         node.z + wide_.offset[2]);
    }

    /// How near to the wall nodes are left out on both sides: as given, or so that the particles
    /// and the nodes that stay stand for the volume of the body.
    void choose_clearances()
    {
        if (options_.clearance_dp)
        {
            // Nodes at 0.5 dp inside are in the zone as well: no volume asks for them.
            const auto distance = static_cast<std::uint32_t>(
                std::floor(*options_.clearance_dp * distance_units + 0.5));
            within_.leave_out_below(std::max(distance, half_dp + 1));
            beyond_.leave_out_below(distance);
            return;
        }
        if (!zone_.has_inside) return;
        const NodeCounts counts = count_nodes_near();
        const auto particles = static_cast<double>(options_.wall_particles);
        const double cells = zone_.body_volume / dp3();
        const auto nodes = static_cast<double>(counts.in_body);
        within_.leave_out(nodes - (cells - particles * zone_.wall_share_inside), counts.always[1],
                          counts.by_distance[1]);
        beyond_.leave_out(cells + particles * (1 - zone_.wall_share_inside) - nodes,
                          counts.always[0], counts.by_distance[0]);
        settle_last_range();
    }

    /// Of one part of the slabs, or of all; of the two arrays the second entry is the inside's.
    struct NodeCounts
    {
        std::uint64_t in_body = 0;
        std::array<std::uint64_t, 2> always{};
        std::array<DistanceCounts, 2> by_distance{DistanceCounts(distance_ranges),
                                                  DistanceCounts(distance_ranges)};
    };
    static constexpr std::size_t most_parts = 32;

    /// Calls body(part, slab) for all slabs, those of a part one after another.
    template <typename Body>
    void for_each_slab(const Body& body) const
    {
        const std::size_t parts = std::min(near_.size(), most_parts);
        parallel_for(parts, threads_,
                     [&](std::size_t p)
                     {
                         const std::size_t end = (p + 1) * near_.size() / parts;
                         for (std::size_t x = p * near_.size() / parts; x < end; ++x) body(p, x);
                     });
    }

    NodeCounts count_nodes_near() const
    {
        std::vector<NodeCounts> parts(std::min(near_.size(), most_parts));
        for_each_slab(
            [&](std::size_t p, std::size_t x)
            {
                NodeCounts& counts = parts[p];
                counts.in_body += count_nodes(inside_of(x));
                for_each_near_node(
                    near_[x], inside_of(x),
                    [&](const NearNode& node, bool is_inside)
                    {
                        const LeftOutNodes& side = is_inside ? within_ : beyond_;
                        if (side.is_always_left_out(node.distance))
                            ++counts.always[is_inside];
                        else
                            ++counts.by_distance[is_inside][distance_range(node.distance)];
                    });
            });
        NodeCounts all;
        for (const NodeCounts& part : parts)
        {
            all.in_body += part.in_body;
            for (std::size_t side = 0; side < 2; ++side)
            {
                all.always[side] += part.always[side];
                for (std::size_t r = 0; r < distance_ranges; ++r)
                    all.by_distance[side][r] += part.by_distance[side][r];
            }
        }
        return all;
    }

    void settle_last_range()
    {
        std::vector<std::array<std::vector<std::uint64_t>, 2>> parts(
            std::min(near_.size(), most_parts));
        for_each_slab(
            [&](std::size_t p, std::size_t x)
            {
                for_each_near_node(
                    near_[x], inside_of(x),
                    [&](const NearNode& node, bool is_inside)
                    {
                        if ((is_inside ? within_ : beyond_).is_to_settle(node.distance))
                            parts[p][is_inside].push_back(
                                LeftOutNodes::key(node.distance, hash_of(x, node)));
                    });
            });
        for (std::size_t side = 0; side < 2; ++side)
        {
            std::vector<std::uint64_t> keys;
            for (const auto& part : parts)
                keys.insert(keys.end(), part[side].begin(), part[side].end());
            (side == 1 ? within_ : beyond_).settle(std::move(keys));
        }
    }

    void take_nodes()
    {
        std::vector<std::uint64_t> kept(near_.size(), 0);
        zone_.volume.slabs.resize(grid_.n[0]);
        zone_.zone.slabs.resize(grid_.n[0]);
        parallel_for(near_.size(), threads_,
                     [&](std::size_t x)
                     {
                         const std::vector<Span> left_out = left_out_of(x);
                         const std::vector<Span> volume = subtract(inside_of(x), left_out);
                         kept[x] = count_nodes(volume);
                         near_[x] = {}; // as much memory as the particles of the wall
                         const std::int64_t slab = static_cast<std::int64_t>(x) + wide_.offset[0];
                         if (slab < 0 || slab >= grid_.n[0]) return;
                         const auto s = static_cast<std::size_t>(slab);
                         zone_.volume.slabs[s] = clip(volume, wide_, grid_);
                         zone_.zone.slabs[s] = clip(left_out, wide_, grid_);
                     });
        trim(zone_.volume);
        trim(zone_.zone);
        zone_.clearance_inside_dp = within_.clearance();
        zone_.clearance_outside_dp = beyond_.clearance();
        if (!zone_.has_inside) return;
        for (const std::uint64_t count : kept) zone_.nodes += count;
        const double wall_cells =
            static_cast<double>(options_.wall_particles) * zone_.wall_share_inside;
        zone_.volume_error =
            (static_cast<double>(zone_.nodes) + wall_cells) * dp3() / zone_.body_volume - 1;
    }

    std::vector<Span> left_out_of(std::size_t x) const
    {
        std::vector<Span> out;
        for_each_near_node(near_[x], inside_of(x),
                           [&](const NearNode& node, bool is_inside)
                           {
                               const LeftOutNodes& side = is_inside ? within_ : beyond_;
                               if (side.is_left_out(node.distance, hash_of(x, node)))
                                   append_node(out, node.y, node.z);
                           });
        return out;
    }

    double dp3() const { return grid_.dp * grid_.dp * grid_.dp; }

    const SurfaceMesh& mesh_;
    const MeshReport& report_;
    const LatticeGrid& grid_;
    const ExclusionBandOptions& options_;
    int threads_;
    LeftOutNodes within_;
    LeftOutNodes beyond_;
    ClosedPart part_;
    WideGrid wide_;
    std::vector<std::vector<NearNode>> near_; ///< per slab of the wide grid
    SpanSet inside_;
    double overlap_ = 0; ///< cubic metres
    ExclusionBand zone_;
};

} // namespace

ExclusionBand exclusion_band(const SurfaceMesh& mesh, const MeshReport& report,
                             const LatticeGrid& grid, const ExclusionBandOptions& options,
                             int threads)
{
    if (options.clearance_dp && !(*options.clearance_dp >= 0.5 && *options.clearance_dp <= 1.0))
        throw GeometryError(
            fmt::format("a clearance of {:.6g} dp, expected 0.5 to 1", *options.clearance_dp));
    return ZoneFinder(mesh, report, grid, options, threads).run();
}

} // namespace fppg
