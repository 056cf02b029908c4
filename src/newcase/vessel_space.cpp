#include "newcase/vessel_space.h"

#include "fppg/shapes.h"

#include <algorithm>
#include <cmath>

namespace fppg
{

namespace
{

constexpr double most_nodes = 1.2e6;
constexpr std::uint32_t margin = 2; // nodes around the vessel
constexpr std::uint8_t in_solid = 1;
constexpr std::uint8_t at_surface = 2;
constexpr std::uint16_t never = 0xFFFF;

} // namespace

std::size_t VesselSpace::count() const
{
    return std::size_t{grid_.n[0]} * grid_.n[1] * grid_.n[2];
}

Vec3 VesselSpace::place(std::size_t node) const
{
    const std::size_t nz = grid_.n[2], ny = grid_.n[1];
    const std::size_t slab = node / (nz * ny), row = node / nz % ny;
    return grid_.origin + Vec3{static_cast<double>(slab), static_cast<double>(row),
                               static_cast<double>(node % nz)} *
                              grid_.dp;
}

template <typename Visit>
void VesselSpace::for_each_beside(std::size_t node, const Visit& visit) const
{
    const std::size_t nz = grid_.n[2], ny = grid_.n[1], slab = nz * ny;
    const std::size_t x = node / slab, y = node / nz % ny, z = node % nz;
    if (x > 0) visit(node - slab);
    if (x + 1 < grid_.n[0]) visit(node + slab);
    if (y > 0) visit(node - nz);
    if (y + 1 < ny) visit(node + nz);
    if (z > 0) visit(node - 1);
    if (z + 1 < nz) visit(node + 1);
}

VesselSpace::VesselSpace(const CasePlan& plan, std::size_t vessel)
{
    const Box3& box = plan.parts[vessel].box();
    const Vec3 size = box.max - box.min;
    grid_.dp = std::max(std::pow(size.x * size.y * size.z / most_nodes, 1.0 / 3),
                        std::max({size.x, size.y, size.z}) / 4000);
    for (int axis = 0; axis < 3; ++axis)
    {
        grid_.origin[axis] = box.min[axis] - margin * grid_.dp;
        grid_.n[static_cast<std::size_t>(axis)] =
            static_cast<std::uint32_t>(std::ceil(size[axis] / grid_.dp)) + 1 + 2 * margin;
    }
    state_.assign(count(), 0);
    of_floats_.assign(count(), 0);
    for (const NewPart& part : plan.parts)
        if (part.role != PartRole::Inlet)
            mark_part(part, plan.options->threads,
                      part.role == PartRole::Floating ? of_floats_ : state_);
    find_spills();
    find_largest();
}

void VesselSpace::mark_part(const NewPart& part, int threads, std::vector<std::uint8_t>& marks)
{
    mark_surface(part.tree->soup(), marks);
    if (!part.report.is_watertight) return;
    const SpanSet inside = inside_spans(part.tree->soup(), grid_, threads);
    for (std::size_t slab = 0; slab < inside.slabs.size(); ++slab)
        for (const Span& span : inside.slabs[slab])
        {
            const std::size_t column = ((inside.x_begin + slab) * grid_.n[1] + span.y) * grid_.n[2];
            for (std::uint32_t z = span.z_begin; z < span.z_end; ++z) marks[column + z] |= in_solid;
        }
}

/// Marks the nodes nearest to places a quarter of the spacing apart on all facets.
void VesselSpace::mark_surface(const TriangleSoup& soup, std::vector<std::uint8_t>& marks) const
{
    const auto mark = [&](const Vec3& p)
    {
        std::size_t node = 0;
        for (int axis = 0; axis < 3; ++axis)
        {
            const std::size_t n = grid_.n[static_cast<std::size_t>(axis)];
            const double at = std::round((p[axis] - grid_.origin[axis]) / grid_.dp);
            if (!(at >= 0 && at < static_cast<double>(n))) return;
            node = node * n + static_cast<std::size_t>(at);
        }
        marks[node] |= at_surface;
    };
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        const Vec3& a = soup.vertices[3 * f];
        const Vec3 u = soup.vertices[3 * f + 1] - a, v = soup.vertices[3 * f + 2] - a;
        const double step = grid_.dp / 4;
        const int m = std::max(1, static_cast<int>(std::ceil(norm(u) / step)));
        for (int i = 0; i <= m; ++i)
        {
            const double s = static_cast<double>(i) / m;
            const Vec3 from = a + s * u, way = (1 - s) * v;
            const int n = std::max(1, static_cast<int>(std::ceil(norm(way) / step)));
            for (int j = 0; j <= n; ++j) mark(from + (static_cast<double>(j) / n) * way);
        }
    }
}

/// From all nodes at the border inwards, the lowest way over first.
void VesselSpace::find_spills()
{
    const std::size_t nz = grid_.n[2], ny = grid_.n[1], slab = nz * ny;
    spill_.assign(count(), never);
    std::vector<std::vector<std::uint32_t>> waiting(nz);
    way_out_.assign(count(), 0);
    const auto reach = [&](std::size_t node, std::size_t height, std::size_t from)
    {
        if (state_[node] != 0 || spill_[node] != never) return;
        spill_[node] = static_cast<std::uint16_t>(std::max(height, node % nz));
        way_out_[node] = static_cast<std::uint32_t>(from);
        waiting[spill_[node]].push_back(static_cast<std::uint32_t>(node));
    };
    for (std::size_t node = 0; node < count(); ++node)
    {
        const std::size_t x = node / slab, y = node / nz % ny, z = node % nz;
        if (x == 0 || y == 0 || z == 0 || x + 1 == grid_.n[0] || y + 1 == ny || z + 1 == nz)
            reach(node, z, node);
    }
    for (std::size_t height = 0; height < nz; ++height)
        for (std::size_t k = 0; k < waiting[height].size(); ++k)
        {
            const std::size_t node = waiting[height][k];
            for_each_beside(node, [&](std::size_t beside) { reach(beside, height, node); });
        }
}

/// Where the way out of a node is highest: the outermost place of that height.
Vec3 VesselSpace::spill_place(std::size_t node) const
{
    std::size_t last = node;
    while (true)
    {
        const std::size_t next = way_out_[last];
        if (next == last || spill_[next] < spill_[node]) return place(last);
        last = next;
    }
}

/// The largest set of joined nodes from which the way out leads over higher ones.
void VesselSpace::find_largest()
{
    const std::size_t nz = grid_.n[2];
    std::vector<std::uint8_t> seen(count(), 0);
    const auto holds = [&](std::size_t node)
    { return state_[node] == 0 && spill_[node] > node % nz && seen[node] == 0; };
    std::vector<std::uint32_t> room;
    for (std::size_t node = 0; node < count(); ++node)
    {
        if (!holds(node)) continue;
        room.assign(1, static_cast<std::uint32_t>(node));
        seen[node] = 1;
        for (std::size_t k = 0; k < room.size(); ++k)
            for_each_beside(room[k],
                            [&](std::size_t beside)
                            {
                                if (!holds(beside)) return;
                                seen[beside] = 1;
                                room.push_back(static_cast<std::uint32_t>(beside));
                            });
        if (room.size() > nodes_.size()) nodes_ = room;
    }
    if (nodes_.empty()) return;
    // Half of what surfaces pass through is room as well: nodes beside it that are in no solid.
    std::vector<std::uint8_t> counted(count(), 0);
    at_height_.assign(nz, 0);
    std::size_t low = nz, high = 0;
    std::uint16_t rim = 0;
    const auto add = [&](std::size_t node)
    {
        if (counted[node] != 0) return;
        counted[node] = 1;
        ++at_height_[node % nz];
    };
    for (const std::uint32_t node : nodes_)
    {
        add(node);
        low = std::min(low, node % nz);
        high = std::max(high, node % nz);
        rim = std::max(rim, spill_[node]);
        for_each_beside(node,
                        [&](std::size_t beside)
                        {
                            if (state_[beside] == at_surface) add(beside);
                        });
    }
    is_closed_ = rim == never;
    bottom_ = grid_.origin.z + (static_cast<double>(low) - 0.5) * grid_.dp;
    rim_ = grid_.origin.z + (static_cast<double>(is_closed_ ? high : rim) + 0.5) * grid_.dp;
    if (!is_closed_)
        rim_place_ = spill_place(*std::max_element(nodes_.begin(), nodes_.end(),
                                                   [&](std::uint32_t a, std::uint32_t b)
                                                   { return spill_[a] < spill_[b]; }));
}

double VesselSpace::volume_below(double z) const
{
    double nodes = 0;
    for (std::size_t k = 0; k < at_height_.size(); ++k)
    {
        const double low = grid_.origin.z + (static_cast<double>(k) - 0.5) * grid_.dp;
        nodes += at_height_[k] * std::clamp((z - low) / grid_.dp, 0.0, 1.0);
    }
    return nodes * std::pow(grid_.dp, 3);
}

double VesselSpace::level_of(double volume) const
{
    double low = bottom_, high = rim_;
    for (int k = 0; k < 60; ++k)
    {
        const double middle = (low + high) / 2;
        (volume_below(middle) < volume ? low : high) = middle;
    }
    return high;
}

Vec3 VesselSpace::seed(double level) const
{
    // Layers of nodes inwards from all that is not of the room.
    std::vector<std::uint8_t> is_room(count(), 0);
    for (const std::uint32_t node : nodes_) is_room[node] = of_floats_[node] == 0 ? 1 : 0;
    std::vector<std::uint32_t> now;
    for (const std::uint32_t node : nodes_)
    {
        if (is_room[node] == 0) continue;
        bool is_border = false;
        for_each_beside(node, [&](std::size_t beside) { is_border |= is_room[beside] == 0; });
        if (is_border) now.push_back(node);
    }
    std::vector<std::uint16_t> depth(count(), 0);
    std::uint16_t deepest = 0;
    for (std::uint16_t layer = 1; !now.empty(); ++layer)
    {
        std::vector<std::uint32_t> next;
        for (const std::uint32_t node : now) depth[node] = layer;
        for (const std::uint32_t node : now)
            for_each_beside(node,
                            [&](std::size_t beside)
                            {
                                if (is_room[beside] == 0 || depth[beside] != 0) return;
                                depth[beside] = static_cast<std::uint16_t>(layer + 1);
                                next.push_back(static_cast<std::uint32_t>(beside));
                            });
        deepest = layer;
        now = std::move(next);
    }
    // Below the level where that is not too near to walls.
    const double wanted = std::min<double>(4, deepest);
    std::size_t best = nodes_.front();
    double best_rank = -1;
    for (const std::uint32_t node : nodes_)
    {
        const bool is_below = place(node).z < level;
        const double rank = depth[node] + (is_below && depth[node] >= wanted ? 1e4 : 0);
        if (rank > best_rank)
        {
            best_rank = rank;
            best = node;
        }
    }
    return place(best);
}

} // namespace fppg
