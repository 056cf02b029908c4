#include "lattice/off_lattice_painter.h"

#include "fppg/particles.h"

#include "core/parallel.h"
#include "lattice/off_lattice_points.h"
#include "meshes/point_grid.h"
#include "nodes/snap.h"

#include <algorithm>
#include <tuple>

namespace fppg
{
namespace
{

/// Distance from the plane of a 2D case up to which particles are moved into it, dp.
constexpr double plane_distance_dp = 0.1;

bool is_in_off_lattice_domain(const Vec3& p, const LatticeGrid& grid)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const double last =
            grid.origin[axis] + (grid.n[static_cast<std::size_t>(axis)] - 1) * grid.step(axis);
        if (!(p[axis] >= grid.origin[axis] && p[axis] <= last + nearest_dp * grid.dp)) return false;
    }
    return true;
}

bool is_kept_by(const std::vector<Clip>& clips, const Vec3& p)
{
    return std::all_of(clips.begin(), clips.end(), [&](const Clip& clip) { return clip.keeps(p); });
}

/// Calls body(x, y, z, is_near) for the nodes of a particle that lie in the lattice; only the
/// nearest one may be far from it.
template <typename Body>
void for_each_node(const Vec3& p, const LatticeGrid& grid, const Body& body)
{
    const Node nearest = snap(p, grid);
    const double reach = nearest_dp * grid.dp;
    for (std::int64_t x = nearest.x - 1; x <= nearest.x + 1; ++x)
        for (std::int64_t y = nearest.y - 1; y <= nearest.y + 1; ++y)
            for (std::int64_t z = nearest.z - 1; z <= nearest.z + 1; ++z)
            {
                const Node n{x, y, z};
                if (!is_inside(n, grid)) continue;
                const Vec3 away = position(n, grid) - p;
                const bool is_near = dot(away, away) < reach * reach;
                if (n == nearest || is_near)
                    body(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                         static_cast<std::uint32_t>(z), is_near);
            }
}

/// 0 for empty nodes and those that particles of a wall stand in for.
std::uint16_t mk_at(const std::vector<Run>& runs, std::uint32_t y, std::uint32_t z)
{
    const auto after =
        std::upper_bound(runs.begin(), runs.end(), std::pair(y, z),
                         [](const std::pair<std::uint32_t, std::uint32_t>& at, const Run& r)
                         { return at.first < r.y || (at.first == r.y && at.second < r.z_begin); });
    if (after == runs.begin()) return 0;
    const Run& run = *std::prev(after);
    return run.y == y && z < run.z_end && !run.is_covered ? run.mk : std::uint16_t{0};
}

} // namespace

std::vector<Spans> emptied_by_cylinder(const CylinderOp& op, const std::vector<ClipPlane>& clips,
                                       const LatticeGrid& grid, int threads)
{
    const double wide = nearest_dp * grid.dp;
    const double length = norm(op.p1 - op.p0);
    const Vec3 axis = (op.p1 - op.p0) / length;
    const double radius = op.radius + wide;
    // The corners of a box around it.
    const double reach = radius + wide + grid.dp;
    std::array<std::int64_t, 3> begin{};
    std::array<std::int64_t, 3> end{};
    for (int k = 0; k < 3; ++k)
    {
        const auto i = static_cast<std::size_t>(k);
        const double low = (std::min(op.p0[k], op.p1[k]) - reach - grid.origin[k]) / grid.step(k);
        const double high = (std::max(op.p0[k], op.p1[k]) + reach - grid.origin[k]) / grid.step(k);
        const auto n = static_cast<double>(grid.n[i]);
        begin[i] = static_cast<std::int64_t>(std::clamp(low, 0.0, n));
        end[i] = static_cast<std::int64_t>(std::clamp(high + 1, 0.0, n));
    }
    const std::vector<Clip> kept(clips.begin(), clips.end());
    std::vector<Spans> nodes(grid.n[0]);
    parallel_for(
        nodes.size(), threads,
        [&](std::size_t slab)
        {
            const auto x = static_cast<std::int64_t>(slab);
            if (x < begin[0] || x >= end[0]) return;
            for (std::int64_t y = begin[1]; y < end[1]; ++y)
                for (std::int64_t z = begin[2]; z < end[2]; ++z)
                {
                    const Vec3 p = position({x, y, z}, grid);
                    const double along = dot(p - op.p0, axis);
                    if (along < -wide || along > length + wide) continue;
                    const Vec3 across = p - op.p0 - axis * along;
                    if (dot(across, across) <= radius * radius && is_kept_by(kept, p))
                        nodes[slab].push_back({static_cast<std::uint32_t>(y),
                                               static_cast<std::uint32_t>(z),
                                               static_cast<std::uint32_t>(z) + 1});
                }
            sort_and_join(nodes[slab]);
        },
        1);
    return nodes;
}

std::vector<Spans> OffLatticePainter::draw(const std::vector<Vec3>& points,
                                           const std::vector<ClipPlane>& clips, std::uint16_t mk)
{
    const LatticeGrid& grid = field_->grid;
    const std::vector<Clip> kept(clips.begin(), clips.end());
    std::vector<Spans> nodes(field_->slabs.size());
    for (Vec3 p : points)
    {
        if (!is_kept_by(kept, p)) continue;
        if (grid.is_2d)
        {
            if (!(std::abs(p.y - grid.origin.y) <= plane_distance_dp * grid.dp)) continue;
            p.y = grid.origin.y;
        }
        if (!is_in_off_lattice_domain(p, grid)) continue;
        bool has_node = false;
        for_each_node(p, grid,
                      [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, bool)
                      {
                          has_node = true;
                          nodes[x].push_back({y, z, z + 1});
                          if (mk != 0) covered_.push_back({x, y, z, mk});
                      });
        if (mk == 0 || !has_node) continue;
        positions_.push_back(p);
        mk_.push_back(mk);
    }
    parallel_for(
        nodes.size(), threads_, [&](std::size_t x) { sort_and_join(nodes[x]); }, 16);
    return nodes;
}

void OffLatticePainter::reset()
{
    positions_.clear();
    mk_.clear();
    covered_.clear();
}

/// By node and mk, each once.
void OffLatticePainter::sort_claims()
{
    std::sort(covered_.begin(), covered_.end());
    covered_.erase(std::unique(covered_.begin(), covered_.end()), covered_.end());
}

bool OffLatticePainter::is_covered_by_another(const CoveredNode& claim) const
{
    return std::binary_search(covered_.begin(), covered_.end(), claim);
}

std::size_t OffLatticePainter::claim_of(std::uint32_t x, std::uint32_t y, std::uint32_t z) const
{
    const auto found = std::lower_bound(covered_.begin(), covered_.end(), std::tuple(x, y, z),
                                        [](const CoveredNode& c, const auto& at)
                                        { return std::tuple(c.x, c.y, c.z) < at; });
    return static_cast<std::size_t>(found - covered_.begin());
}

std::vector<char> OffLatticePainter::staying_particles(std::vector<char>& is_emptied) const
{
    std::vector<std::vector<std::uint32_t>> of_mk(65536);
    for (std::size_t i = 0; i < mk_.size(); ++i)
        of_mk[mk_[i]].push_back(static_cast<std::uint32_t>(i));
    std::vector<char> stays(positions_.size());
    is_emptied.assign(covered_.size(), 0);
    for (std::size_t mk = of_mk.size(); mk-- > 0;)
    {
        const std::vector<std::uint32_t>& particles = of_mk[mk];
        const auto nodes_of = [&](std::uint32_t particle, const auto& body)
        { for_each_node(positions_[particle], field_->grid, body); };
        parallel_for(
            particles.size(), threads_,
            [&](std::size_t i)
            {
                bool keeps = true;
                nodes_of(particles[i],
                         [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, bool is_near)
                         {
                             const std::uint16_t found = mk_at(field_->slabs[x], y, z);
                             const bool hides_elsewhere =
                                 !is_near && !of_mk[found].empty() &&
                                 (found > mk || !is_covered_by_another({x, y, z, found}));
                             keeps = keeps && (found == mk || hides_elsewhere ||
                                               is_emptied[claim_of(x, y, z)]);
                         });
                stays[particles[i]] = keeps;
            },
            1024);
        for (const std::uint32_t particle : particles)
            nodes_of(particle,
                     [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, bool)
                     {
                         if (mk_at(field_->slabs[x], y, z) == mk) is_emptied[claim_of(x, y, z)] = 1;
                     });
    }
    return stays;
}

void OffLatticePainter::finish()
{
    if (positions_.empty()) return;
    const LatticeGrid& grid = field_->grid;
    sort_claims();
    std::vector<char> is_emptied;
    const std::vector<char> stays = staying_particles(is_emptied);

    const double reach = nearest_dp * grid.dp;
    PointGrid points(reach, positions_.size());
    for (const Vec3& p : positions_) points.add(p);
    std::vector<char> is_last(positions_.size(), 0);
    parallel_for(
        positions_.size(), threads_,
        [&](std::size_t i)
        {
            if (!stays[i]) return;
            bool last = true;
            points.for_each_near(positions_[i], reach,
                                 [&](std::uint32_t other, double squared)
                                 {
                                     if (other > i && stays[other] && squared < reach * reach)
                                         last = false;
                                 });
            is_last[i] = last;
        },
        1024);

    // Nodes of particles that do not stay are empty, those of the others are hidden.
    std::vector<Spans> empty(field_->slabs.size());
    for (std::size_t i = 0; i < covered_.size(); ++i)
    {
        const CoveredNode& c = covered_[i];
        if (is_emptied[i]) empty[c.x].push_back({c.y, c.z, c.z + 1});
    }
    std::vector<std::vector<Run>> hidden(field_->slabs.size());
    VolumeParticles& out = field_->walls.volume;
    for (std::size_t i = 0; i < positions_.size(); ++i)
    {
        if (!is_last[i]) continue;
        for_each_node(
            positions_[i], grid,
            [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, bool)
            {
                // An emptied node is free for the particle of the lowest mk there.
                if (is_emptied[claim_of(x, y, z)] || mk_at(field_->slabs[x], y, z) == mk_[i])
                    hidden[x].push_back({y, z, z + 1, mk_[i]});
            });
        out.positions.push_back(positions_[i]);
        out.mk.push_back(mk_[i]);
        out.distances.push_back(distance_of_nodes);
    }
    std::vector<std::uint16_t>& mks = field_->walls.off_lattice_mks;
    mks = out.mk;
    std::sort(mks.begin(), mks.end());
    mks.erase(std::unique(mks.begin(), mks.end()), mks.end());
    parallel_for(
        field_->slabs.size(), threads_,
        [&](std::size_t x)
        {
            std::vector<Run>& slab = field_->slabs[x];
            sort_and_join(empty[x]);
            paint(slab, empty[x], 0);
            std::sort(
                hidden[x].begin(), hidden[x].end(),
                [](const Run& a, const Run& b)
                { return std::tuple(b.mk, a.y, a.z_begin) < std::tuple(a.mk, b.y, b.z_begin); });
            for (auto run = hidden[x].begin(); run != hidden[x].end();)
            {
                const std::uint16_t mk = run->mk;
                Spans spans;
                for (; run != hidden[x].end() && run->mk == mk; ++run)
                    spans.push_back({run->y, run->z_begin, run->z_end});
                sort_and_join(spans);
                paint(slab, spans, mk, true);
            }
        },
        16);
    reset();
}

} // namespace fppg
