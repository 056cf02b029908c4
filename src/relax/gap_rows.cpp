#include "relax/gap_rows.h"

#include "fppg/moving_parts.h"

#include "core/parallel.h"
#include "meshes/point_grid.h"
#include "nodes/domain.h"
#include "nodes/run_at.h"
#include "offset/wall_depth.h"
#include "relax/all_walls.h"
#include "relax/wall_planes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace fppg
{
namespace
{

// Lengths in dp.
constexpr double narrowest_gap = 0.25;
constexpr double aside_of_gap = 0.6; ///< of two particles that face each other
constexpr double reach_of_gaps = sliding_pocket_of_layers_dp + 1.1;
constexpr double apart_in_gap = 0.7; ///< of its particles
constexpr double off_walls = 0.6;
constexpr double off_fluid = 0.7;
constexpr double beside_edge = 1.7; ///< and corner: particles on the faces that meet there
constexpr double in_plane = 0.1;
/// Cosine between the normals of walls that face each other.
constexpr double facing_walls = -0.9;

/// The middle of a gap.
struct GapPlace
{
    Vec3 place;
    Vec3 wall, to_mouth; ///< GapParticle
    double width = 0;    ///< metres; 0: no gap
    std::uint16_t mk = 0, other = 0;
};

/// A place, and where it is a period farther on.
std::vector<Vec3> images_of(const Vec3& place, const LatticeGrid& grid)
{
    std::vector<Vec3> out{place};
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto a = static_cast<std::size_t>(axis);
        if (!grid.is_periodic[a]) continue;
        const double period = grid.n[a] * grid.step(axis);
        for (const Vec3& p : std::vector<Vec3>(out))
            for (const double by : {-period, period})
            {
                out.push_back(p);
                out.back()[axis] += by;
            }
    }
    return out;
}

class GapFinder
{
public:
    GapFinder(const CaseDef& def, const RunField& field, int threads)
        : walls_(field.walls),
          dp_(field.grid.dp),
          moving_(mks_that_move(def)),
          sliding_(mks_that_slide(def)),
          grid_(reach_of_gaps * dp_, 0)
    {
        for (std::size_t i = 0; i < walls_.particles.size(); ++i)
        {
            const std::uint32_t b = walls_.particles.bodies[i];
            const FittedBody& body = walls_.bodies[b];
            if (!body.is_layer() || body.layer != 0 || walls_.bodies[body.owner].is_inside ||
                !is_steady(walls_.particles.mk[i]))
                continue;
            firsts_.push_back(static_cast<std::uint32_t>(i));
            grid_.add(walls_.particles.positions[i]);
        }
        normals_.resize(firsts_.size());
        parallel_for(
            firsts_.size(), threads,
            [&](std::size_t k) { normals_[k] = measure_normal(firsts_[k]); }, 256);
    }

    /// Apart from each other, over the ends of a period too, and from walls, in the order of wall
    /// particles.
    std::vector<GapPlace> find(const LatticeGrid& grid, int threads) const
    {
        std::vector<std::vector<GapPlace>> before(firsts_.size());
        parallel_for(
            firsts_.size(), threads, [&](std::size_t k) { before[k] = gaps_beside(k); }, 256);
        std::vector<GapPlace> out;
        PointGrid taken(dp_, 0);
        std::vector<std::uint32_t> taken_by; ///< per point of it, in out
        for (const std::vector<GapPlace>& gaps : before)
            for (const GapPlace& gap : gaps)
            {
                // Walls go on beyond a period.
                if (!is_in_domain(gap.place, grid)) continue;
                bool is_taken = grid_.has_nearer(gap.place, off_walls * dp_);
                taken.for_each_near(gap.place, apart_in_gap * dp_,
                                    [&](std::uint32_t at, double)
                                    {
                                        is_taken = true;
                                        GapPlace& by = out[taken_by[at]];
                                        if (by.to_mouth != Vec3{}) return;
                                        by.wall = gap.wall;
                                        by.to_mouth = gap.to_mouth;
                                    });
                if (is_taken) continue;
                for (const Vec3& p : images_of(gap.place, grid))
                {
                    taken.add(p);
                    taken_by.push_back(static_cast<std::uint32_t>(out.size()));
                }
                out.push_back(gap);
            }
        return out;
    }

    bool moves(std::uint16_t mk) const { return moving_.contains(mk); }

private:
    bool is_steady(std::uint16_t mk) const { return !moves(mk) || sliding_.contains(mk); }

    /// Those before the faces that a particle stands behind, and where several of them meet.
    ///
    /// k  index into firsts_
    std::vector<GapPlace> gaps_beside(std::size_t k) const
    {
        const std::uint32_t i = firsts_[k];
        const Vec3& p = walls_.particles.positions[i];
        std::vector<GapPlace> out;
        Vec3 to_mouth;
        for (const Vec3& normal : normals_of(k))
        {
            const GapPlace gap = gap_before(i, normal);
            if (!(gap.width > 0))
            {
                to_mouth = walls_.bodies[walls_.particles.bodies[i]].depth * normal;
                continue;
            }
            const std::size_t before = out.size();
            out.push_back(gap);
            for (std::size_t one = 0; one < before; ++one)
            {
                GapPlace corner = out[one];
                corner.place = corner.place + (gap.place - p);
                out.push_back(corner);
            }
        }
        for (GapPlace& gap : out)
        {
            gap.wall = p;
            gap.to_mouth = to_mouth;
        }
        return out;
    }

    /// Of its facet, to the surface; zero on edges and corners.
    Vec3 measure_normal(std::uint32_t i) const
    {
        const WallParticles& p = walls_.particles;
        if (p.kinds[i] != FitKind::Surface) return {};
        const FittedBody& body = walls_.bodies[p.bodies[i]];
        // Layers of round bodies have no facets.
        if (!body.mesh.normals.empty()) return body.mesh.normals[p.facets[i]];
        const Vec3 way = body.wall->at(p.positions[i]).nearest - p.positions[i];
        return norm(way) > 0 ? way / norm(way) : Vec3{};
    }

    /// Of the faces that a particle stands behind.
    std::vector<Vec3> normals_of(std::size_t k) const
    {
        if (normals_[k] != Vec3{}) return {normals_[k]};
        const std::uint32_t i = firsts_[k];
        std::vector<Vec3> out;
        const Vec3& p = walls_.particles.positions[i];
        grid_.for_each_near(
            p, beside_edge * dp_,
            [&](std::uint32_t at, double)
            {
                const std::uint32_t j = firsts_[at];
                const Vec3& n = normals_[at];
                const auto is_known = [&](const Vec3& known)
                { return dot(known, n) > -facing_walls; };
                if (walls_.particles.bodies[j] == walls_.particles.bodies[i] && n != Vec3{} &&
                    std::abs(dot(walls_.particles.positions[j] - p, n)) <= in_plane * dp_ &&
                    std::none_of(out.begin(), out.end(), is_known))
                    out.push_back(n);
            });
        return out;
    }

    /// The narrowest gap between the face with a normal that a particle stands behind and another
    /// wall.
    GapPlace gap_before(std::uint32_t i, const Vec3& normal) const
    {
        const WallParticles& all = walls_.particles;
        const std::uint16_t mk = all.mk[i];
        const Vec3 foot = all.positions[i] + walls_.bodies[all.bodies[i]].depth * normal;
        GapPlace out;
        grid_.for_each_near(foot, reach_of_gaps * dp_,
                            [&](std::uint32_t at, double)
                            {
                                const std::uint32_t j = firsts_[at];
                                const Vec3& facing = normals_[at];
                                if (facing != Vec3{} && dot(facing, normal) > facing_walls) return;
                                const Vec3 way = all.positions[j] - foot;
                                const double along = dot(way, normal);
                                const double gap = along - walls_.bodies[all.bodies[j]].depth;
                                const std::uint16_t other = all.mk[j];
                                const bool slides = other != mk && (moves(mk) || moves(other));
                                const double widest =
                                    slides ? sliding_pocket_of_layers_dp : pocket_of_layers_dp;
                                if (gap < narrowest_gap * dp_ || gap > widest * dp_ ||
                                    (out.width > 0 && gap >= out.width) ||
                                    norm(way - along * normal) > aside_of_gap * dp_)
                                    return;
                                out = {foot + (0.5 * gap) * normal, {}, {}, gap, mk, other};
                                if (!moves(mk) && moves(other)) std::swap(out.mk, out.other);
                            });
        return out;
    }

    const FittedWalls& walls_;
    double dp_;
    std::set<std::uint16_t> moving_;
    std::set<std::uint16_t> sliding_;
    std::vector<std::uint32_t> firsts_; ///< wall particles of first layers
    std::vector<Vec3> normals_;         ///< theirs
    PointGrid grid_;                    ///< of them
};

/// Takes out those in other solids, and those beside which fluid stands.
void leave_out_taken(const RunField& field, std::uint16_t first_bound, int threads,
                     std::vector<GapPlace>& gaps)
{
    if (gaps.empty()) return;
    const AllWalls walls(field.walls.bodies, field.grid, threads);
    const double near = off_fluid * field.grid.dp;
    PointGrid grid(near, gaps.size());
    for (const GapPlace& gap : gaps) grid.add(gap.place);
    std::vector<char> is_out(gaps.size(), 0);
    const auto leave_out = [&](std::uint32_t at, double) { is_out[at] = 1; };
    const VolumeParticles& volume = field.walls.volume;
    for (std::size_t i = 0; i < volume.size(); ++i)
        if (volume.mk[i] < first_bound) grid.for_each_near(volume.positions[i], near, leave_out);
    for (std::size_t k = 0; k < gaps.size(); ++k)
    {
        if (walls.is_in_solid(gaps[k].place)) is_out[k] = 1;
        const Vec3 at = field.grid.steps_to(gaps[k].place);
        for (int corner = 0; corner < 8; ++corner)
        {
            const Vec3 node{std::floor(at.x) + (corner & 1),
                            field.grid.is_2d ? 0 : std::floor(at.y) + (corner >> 1 & 1),
                            std::floor(at.z) + (corner >> 2)};
            const Run* run =
                run_at(field, {std::llround(node.x), std::llround(node.y), std::llround(node.z)});
            if (run != nullptr && !run->is_covered && run->mk < first_bound &&
                norm(field.grid.place(node) - gaps[k].place) < near)
                is_out[k] = 1;
        }
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < gaps.size(); ++k)
        if (is_out[k] == 0) gaps[kept++] = gaps[k];
    gaps.resize(kept);
}

} // namespace

std::vector<ClosedGap> close_gaps(const CaseDef& def, RunField& field, int threads)
{
    if (def.solver.boundary != 2) return {};
    const GapFinder finder(def, field, threads);
    std::vector<GapPlace> gaps = finder.find(field.grid, threads);
    leave_out_taken(field, def.mk_bound_first, threads, gaps);
    std::map<std::pair<std::uint16_t, std::uint16_t>, ClosedGap> closed;
    VolumeParticles& volume = field.walls.volume;
    for (const GapPlace& gap : gaps)
    {
        volume.positions.push_back(gap.place);
        volume.mk.push_back(gap.mk);
        volume.distances.push_back(static_cast<float>(0.5 * gap.width));
        field.walls.gaps.push_back({gap.place, gap.wall, gap.to_mouth});
        const double wide = gap.width / field.grid.dp;
        const bool slides = gap.mk != gap.other && finder.moves(gap.mk);
        const auto [lower, upper] = std::minmax(gap.mk, gap.other);
        const auto key = slides ? std::pair(gap.mk, gap.other) : std::pair(lower, upper);
        ClosedGap& of = closed
                            .try_emplace(key, ClosedGap{key.first, key.second, slides, 0, wide,
                                                        wide, gap.place})
                            .first->second;
        ++of.count;
        of.least_dp = std::min(of.least_dp, wide);
        of.most_dp = std::max(of.most_dp, wide);
    }
    std::vector<ClosedGap> out;
    for (const auto& [mks, of] : closed) out.push_back(of);
    return out;
}

} // namespace fppg
