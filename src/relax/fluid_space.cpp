#include "relax/fluid_space.h"

#include "fppg/moving_parts.h"

#include "core/disjoint_set.h"
#include "core/parallel.h"
#include "fit/near_nodes.h"
#include "meshes/wall_ball.h"
#include "nodes/run_at.h"
#include "relax/cube_share.h"
#include "relax/fluid_near.h"
#include "relax/lattice_strips.h"
#include "relax/open_levels.h"
#include "relax/regions.h"
#include "relax/wall_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

namespace fppg
{
namespace
{

// Lengths in dp.
constexpr double pocket_moving = 2; ///< where one of two walls moves past the other
constexpr double touching = 0.05;   ///< between walls: none
constexpr double off_the_wall = 2;  ///< where the fluid is looked for that a place belongs to
constexpr double reach_of_cell = 0.87;
/// A node is added where so much of its cell is a fluid's, this far off walls, dp.
constexpr double least_owned = 0.8;
constexpr double off_added = 0.4;
/// At inlets, where fluid stays on the lattice, nodes alone make up the volume.
constexpr double least_owned_at_inlets = 0.5;
constexpr double off_added_at_inlets = 0.25;
/// A node on a face of a solid is asked so far before it whether another solid is there, dp.
constexpr double off_the_face = 1e-3;
/// Walls whose ball is smaller than this may both cut a cell.
constexpr double near_two_walls = 1.2;
/// A wall's point whose direction differs more from its facet's normal is on an edge.
constexpr double along_normal = 0.999;
/// Smaller pockets without a node are slits at edges, dp^3.
constexpr double least_pocket = 0.1;
constexpr std::size_t nodes_per_chunk = 64;

/// What lies on one side of a wall.
struct WallFront
{
    std::uint16_t fluid = 0; ///< mk; 0: none
    bool is_solid = false;
    bool is_pocket = false;
    double width_dp = 0; ///< of a pocket
};

/// What a cell of the lattice comes to.
struct CellSpace
{
    NodeIndex node;
    std::uint16_t fluid = 0; ///< mk of the node; 0: it has none
    std::uint16_t owner = 0; ///< mk of the fluid that its volume belongs to
    double owned = 0;        ///< dp^3
    double pocket = 0;       ///< dp^3
    Vec3 pocket_moment;      ///< its volume times its middle
    double narrowest_dp = pocket_moving;
    bool is_in_pocket = false; ///< its middle
};

class SpaceMeter
{
public:
    SpaceMeter(const CaseDef& def, RunField& field, const AllWalls& all, bool is_before_layers,
               int threads)
        : def_(def),
          field_(field),
          all_(all),
          is_before_layers_(is_before_layers),
          adds_nodes_(is_before_layers && !def.fills_litres()),
          pocket_(is_before_layers ? pocket_of_layers_dp : pocket_dp),
          threads_(threads),
          near_(field, def.mk_bound_first),
          moving_(mks_that_move(def)),
          sliding_(mks_that_slide(def))
    {
        const Vec3& gravity = def_.constants.gravity;
        if (norm(gravity) > 0) down_ = gravity / norm(gravity);
        const Vec3& stretch = field.grid.stretch;
        longest_ = std::max({stretch.x, stretch.y, stretch.z});
        volume_ = stretch.x * stretch.y * stretch.z;
        has_several_bodies_ =
            std::count_if(field.walls.bodies.begin(), field.walls.bodies.end(),
                          [](const FittedBody& body) { return !body.is_layer(); }) > 1;
        closest_ = [&](const Vec3& p, double within) { return all_.closest_point(p, within); };
    }

    FluidSpace run()
    {
        if (near_.is_empty()) return {};
        if (const std::optional<UpAxis> up = up_axis(def_.constants.rest_gravity()))
            levels_ = OpenLevels(field_, *up, def_.mk_bound_first, closest_, threads_);
        const std::vector<std::vector<NearNode>> found =
            find_near_nodes(all_.soup(), field_.grid, threads_);
        std::vector<NodeIndex> nodes;
        for (std::uint32_t x = 0; x < found.size(); ++x)
            for (const NearNode& n : found[x])
                if (near_.has(x, n.y, n.z)) nodes.push_back({x, n.y, n.z});
        std::vector<CellSpace> cells(nodes.size());
        parallel_for(
            nodes.size(), threads_, [&](std::size_t i) { cells[i] = measure(nodes[i]); },
            nodes_per_chunk);
        FluidSpace out;
        out.pocket_dp = pocket_;
        count_nodes(out);
        const double dp = field_.grid.dp;
        const LatticeStrips strips(def_, field_);
        if (adds_nodes_) add_nodes(strips, cells, out);
        std::map<std::uint16_t, double> near_walls; ///< nodes
        for (const CellSpace& cell : cells)
        {
            // A node in a pocket goes, and with it what it stood for.
            const bool stays = cell.fluid != 0 && !cell.is_in_pocket;
            const double owned = cell.owner != 0 ? cell.owned * dp * dp * dp : 0;
            const double stood_for = stays ? dp * dp * dp : 0;
            if (cell.owner != 0) out.missing[cell.owner] += owned;
            if (stays) out.missing[cell.fluid] -= stood_for;
            const Vec3 p = place_of(cell.node, field_.grid);
            if (strips.has_beside_buffer(p) || strips.has_beside_inlet(p))
                out.missing_at_zones += owned - stood_for;
            if (cell.fluid != 0 && volume_ != 1) near_walls[cell.fluid] += 1;
        }
        // Nodes far from all walls stand for their cells, which may be no dp^3.
        for (const auto& [mk, near] : near_walls)
            out.missing[mk] +=
                (volume_ - 1) * (static_cast<double>(out.nodes[mk]) - near) * dp * dp * dp;
        collect_pockets(cells, out);
        empty_pockets(cells, out);
        return out;
    }

private:
    std::uint16_t fluid_at(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        const Run* run = run_at(field_, {x, y, z});
        return run != nullptr && !run->is_covered && run->mk < def_.mk_bound_first
                   ? run->mk
                   : std::uint16_t{};
    }

    Vec3 in_nodes(const Vec3& p) const
    {
        Vec3 at = field_.grid.steps_to(p);
        if (field_.grid.is_2d) at.y = 0;
        return at;
    }

    Vec3 nearest_node(const Vec3& p) const
    {
        const Vec3 at = in_nodes(p);
        return {std::round(at.x), std::round(at.y), std::round(at.z)};
    }

    static Node nearest(const Vec3& at)
    {
        return {std::llround(at.x), std::llround(at.y), std::llround(at.z)};
    }

    std::uint16_t fluid_of(const Vec3& node) const
    {
        const Node at = nearest(node);
        return fluid_at(at.x, at.y, at.z);
    }

    /// A cell beside a wall whose fluid is looked for.
    struct CellAtWall
    {
        Vec3 node;
        Vec3 foot;              ///< of the wall
        Vec3 up;                ///< from there
        bool is_behind = false; ///< the wall, with its middle
    };

    /// The fluid to which a cell belongs, that is met on the way from a ball between two walls to
    /// where all walls are 2 dp away. Each step leads out of the narrowing between the walls that
    /// the ball touches, stays inside it, and so passes through none.
    std::uint16_t fluid_beside(const CellAtWall& cell, WallBall ball) const
    {
        constexpr int most_steps = 8;
        constexpr double parallel = 1e-3;
        const double far = off_the_wall * field_.grid.dp;
        Vec3 foot = cell.foot;
        for (int step = 0; step <= most_steps; ++step)
        {
            const std::uint16_t mk = fluid_at_place(cell, ball.center, &ball);
            const Vec3 away = 2 * ball.center - foot - ball.other;
            const double length = norm(away);
            if (mk != 0 || length < parallel * ball.radius) return mk;
            const Vec3 p = ball.center + (0.95 * ball.radius / length) * away;
            foot = closest_(p, far);
            const double distance = norm(p - foot);
            if (!(distance > 0 && distance < far * (1 - 1e-9)))
                return fluid_at_place(cell, p, nullptr);
            ball = largest_ball(foot, (p - foot) / distance, far, closest_);
            if (!(ball.radius < far * (1 - 1e-9)))
                return fluid_at_place(cell, ball.center, nullptr);
        }
        return 0;
    }

    /// The fluid of the node nearest to a place, or to that under it in the level of the cell;
    /// with a ball that of any node around it which is not beyond the other wall that this touches.
    /// Fluid deeper than the cell may lie under a free surface.
    std::uint16_t fluid_at_place(const CellAtWall& cell, const Vec3& p, const WallBall* ball) const
    {
        const auto is_beyond = [&](const Vec3& node)
        {
            const Vec3 off = field_.grid.place(node) - ball->other;
            return dot(off, ball->center - ball->other) < 0;
        };
        const double before_wall = cell.is_behind ? 0.5 : 0;
        const Vec3 here = in_nodes(p);
        Vec3 under = here + std::max(0.0, dot(cell.node - here, down_)) * down_;
        if (dot(under - in_nodes(cell.foot), cell.up) < before_wall) under = here;
        for (const Vec3& at : {here, under})
        {
            const auto take = [&](const Vec3& node)
            {
                const std::uint16_t mk = fluid_of(node);
                const bool is_deeper = dot(node - cell.node, down_) > 0.5;
                const bool is_its =
                    !is_deeper ||
                    (!levels_.is_above(nearest(cell.node), nearest(node)) && is_under_roof(cell));
                return mk != 0 && is_its ? mk : std::uint16_t{};
            };
            std::uint16_t mk = take({std::round(at.x), std::round(at.y), std::round(at.z)});
            for (int i = 0; i < 8 && ball != nullptr && mk == 0; ++i)
            {
                const Vec3 node{std::floor(at.x) + (i & 1),
                                field_.grid.is_2d ? 0 : std::floor(at.y) + (i >> 1 & 1),
                                std::floor(at.z) + (i >> 2)};
                if (!is_beyond(node)) mk = take(node);
            }
            if (mk != 0) return mk;
        }
        return 0;
    }

    /// Whether a cell above fluid is under a roof: on the level way from the wall there is fluid,
    /// or a wall is above, before a node comes that is empty and far from all walls.
    bool is_under_roof(const CellAtWall& cell) const
    {
        constexpr double steep = 0.1;
        constexpr int most_steps = 3;
        const double dp = field_.grid.dp;
        const double down = dot(cell.up, down_);
        const Vec3 level = cell.up - down * down_;
        if (norm(level) < steep) return down > 0;
        for (int i = 1; i <= most_steps; ++i)
        {
            const Vec3 at = cell.node + (i / norm(level)) * level;
            if (fluid_of(at) != 0) return true;
            const Vec3 p = field_.grid.place(at);
            const Vec3 way = closest_(p, dp) - p;
            if (!(norm(way) < dp)) return false;
            if (dot(way, down_) < -0.5 * norm(way)) return true;
        }
        return down > steep;
    }

    /// Whether the wall at `near.point` is a face of a body without fluid inside, seen from behind.
    bool is_inside_of(const AllWalls::Closest& near, const Vec3& up, bool is_before) const
    {
        return !is_before && field_.walls.bodies[near.body].has_no_fluid_inside() &&
               std::abs(dot(up, near.normal)) >= along_normal;
    }

    /// is_inside  of a solid: it is only asked whether another wall cuts the same cube
    WallBall ball_at(const AllWalls::Closest& near, const Vec3& up, bool is_inside,
                     double side) const
    {
        const double most = is_inside ? near_two_walls * side : off_the_wall;
        return largest_ball(near.point, up, most * field_.grid.dp, closest_);
    }

    /// What lies before the wall at `near.point`, seen along `cell.up`.
    ///
    /// is_before  whether that points to where the wall's facet looks
    /// ball       that of ball_at()
    WallFront front_of(const AllWalls::Closest& near, const CellAtWall& cell, bool is_before,
                       const WallBall& ball) const
    {
        const double dp = field_.grid.dp;
        const bool is_on_edge = std::abs(dot(cell.up, near.normal)) < along_normal;
        if (is_on_edge && all_.is_in_solid(ball.center)) return {0, true, false, 0};
        WallFront out;
        out.width_dp = 2 * ball.radius / dp;
        if (out.width_dp < touching) return out;
        if (ball.is_opposite && out.width_dp < width_of_pockets(near.mk, ball) * (1 - 1e-9))
            // The inside of a thin shell is no place for fluid.
            out.is_pocket = is_before || field_.walls.bodies[near.body].measures.volume <= 0;
        else
            out.fluid = ball.radius < off_the_wall * dp * (1 - 1e-9)
                            ? fluid_beside(cell, ball)
                            : fluid_at_place(cell, ball.center, nullptr);
        return out;
    }

    /// Below which width a place between a wall and that at the other side of a ball is a pocket.
    double width_of_pockets(std::uint16_t mk, const WallBall& ball) const
    {
        if (moving_.empty()) return pocket_;
        const std::uint16_t other = all_.closest(ball.other).mk;
        if (other == mk || !(moving_.contains(mk) || moving_.contains(other))) return pocket_;
        const auto is_steady = [&](std::uint16_t of)
        { return !moving_.contains(of) || sliding_.contains(of); };
        return is_before_layers_ && is_steady(mk) && is_steady(other) ? sliding_pocket_of_layers_dp
                                                                      : pocket_moving;
    }

    void add(const WallFront& front, const Vec3& middle, double volume, CellSpace& out) const
    {
        if (front.is_pocket)
        {
            out.pocket += volume;
            out.pocket_moment = out.pocket_moment + volume * middle;
            out.narrowest_dp = std::min(out.narrowest_dp, front.width_dp);
        }
        else if (front.fluid != 0)
        {
            out.owner = front.fluid;
            out.owned += volume;
        }
    }

    /// Whether the wall that a ball touches on one side of another cuts the cube about `p` as well.
    bool is_cut_again(const WallBall& ball, const Vec3& p, double side) const
    {
        const double half = 0.5 * side * field_.grid.dp;
        if (!(ball.radius < 2 * near_two_walls * half)) return false;
        const Vec3 normal = ball.center - ball.other;
        const double reach = half * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
        return std::abs(dot(p - ball.other, normal)) < reach;
    }

    /// Whether a place before a wall is in a solid that the wall runs into.
    bool is_in_other_solid(const Vec3& p) const
    {
        return has_several_bodies_ && all_.is_in_solid(p);
    }

    Vec3 stretched(const Vec3& v) const
    {
        const Vec3& s = field_.grid.stretch;
        return {v.x * s.x, v.y * s.y, v.z * s.z};
    }

    /// How much of a cell lies before a plane.
    ///
    /// normal    of unit length
    /// distance  of the plane from the middle, in sides of dp
    double share_before(const Vec3& normal, double distance) const
    {
        const bool is_2d = field_.grid.is_2d;
        if (field_.grid.stretch == Vec3{1, 1, 1})
            return share_of_cube_before(normal, distance, is_2d);
        const Vec3 scaled = stretched(normal);
        const double length = norm(scaled);
        return share_of_cube_before(scaled / length, distance / length, is_2d);
    }

    /// Adds a cell about `p` with sides of `side` steps; cells that are cut otherwise than by one
    /// plane are cut up first.
    ///
    /// fluid  of the node in its middle; 0: none
    void add_cell(const Vec3& p, double side, std::uint16_t fluid, CellSpace& out) const
    {
        const double dp = field_.grid.dp;
        const bool is_2d = field_.grid.is_2d;
        const AllWalls::Closest near = all_.closest(p);
        const Vec3 off = p - near.point;
        Vec3 up = near.distance > 1e-9 * dp ? off / near.distance : near.normal;
        if (is_2d) up.y = 0;
        const bool is_before = near.is_outside || near.distance <= 1e-9 * dp;
        const bool is_cut = near.distance < reach_of_cell * side * dp * longest_;
        const double before = is_cut ? share_before(-1.0 * up, near.distance / dp / side) : 1;
        const bool is_inside = is_inside_of(near, up, is_before);
        const bool is_solid_behind = is_inside_of(near, -1.0 * up, !near.is_outside);
        WallFront own{0, true, false, 0};
        const Vec3 node = nearest_node(p);
        WallBall ball, behind;
        if (!is_inside || is_cut) ball = ball_at(near, up, is_inside, side);
        if (before < 1) behind = ball_at(near, -1.0 * up, is_solid_behind, side);
        if (!is_inside) own = front_of(near, {node, near.point, up, false}, is_before, ball);
        const bool is_whole = side == 1;
        if (is_whole) out.is_in_pocket = fluid != 0 && own.is_pocket && is_relaxed(fluid);
        if (is_whole && is_cut &&
            (std::abs(dot(up, near.normal)) < along_normal || is_cut_again(ball, p, side) ||
             (before < 1 && is_cut_again(behind, p, side))))
        {
            for (int part = 0; part < 8; ++part)
            {
                if (is_2d && (part & 2) != 0) continue;
                const Vec3 shift{(part & 1) - 0.5, is_2d ? 0 : (part >> 1 & 1) - 0.5,
                                 (part >> 2) - 0.5};
                add_cell(p + 0.5 * side * dp * stretched(shift), 0.5 * side, 0, out);
            }
            return;
        }
        const double volume = volume_ * (is_2d ? side * side : side * side * side);
        // Where the fluid itself stands it need not be looked for.
        if (fluid != 0 && !own.is_pocket && !own.is_solid)
            own.fluid = fluid;
        else if (own.fluid != 0 && is_in_other_solid(p + off_the_face * dp * up))
            own.fluid = 0;
        add(own, p, before * volume, out);
        if (before == 1 || is_solid_behind) return;
        const WallFront other =
            front_of(near, {node, near.point, -1.0 * up, true}, !near.is_outside, behind);
        if (other.fluid == 0 || !is_in_other_solid(near.point - (0.25 * side * dp) * up))
            add(other, p, (1 - before) * volume, out);
    }

    CellSpace measure(const NodeIndex& node) const
    {
        CellSpace out;
        out.node = node;
        out.fluid = fluid_at(node.x, node.y, node.z);
        add_cell(place_of(node, field_.grid), 1, out.fluid, out);
        return out;
    }

    bool is_relaxed(std::uint16_t mk) const
    {
        const FluidBand* band = fluid_band(def_, mk);
        return band != nullptr && band->is_active && !def_.solver.inout.fluids.contains(mk);
    }

    void count_nodes(FluidSpace& out) const
    {
        for (const std::vector<Run>& slab : field_.slabs)
            for (const Run& run : slab)
                if (!run.is_covered && run.mk < def_.mk_bound_first)
                    out.nodes[run.mk] += run.z_end - run.z_begin;
    }

    /// Cells in pockets that touch make one.
    void collect_pockets(const std::vector<CellSpace>& cells, FluidSpace& out) const
    {
        std::vector<const CellSpace*> parts;
        for (const CellSpace& cell : cells)
            if (cell.pocket > 1e-6 || cell.is_in_pocket) parts.push_back(&cell);
        const auto key = [](const NodeIndex& n) { return std::tuple(n.x, n.y, n.z); };
        DisjointSets<std::size_t> sets(parts.size());
        for (std::size_t i = 0; i < parts.size(); ++i)
            for (int way = 0; way < 13; ++way) // those before it, of 26
            {
                const NodeIndex& n = parts[i]->node;
                const NodeIndex beside{n.x + static_cast<std::uint32_t>(way / 9 - 1),
                                       n.y + static_cast<std::uint32_t>(way / 3 % 3 - 1),
                                       n.z + static_cast<std::uint32_t>(way % 3 - 1)};
                const auto at = std::lower_bound(parts.begin(), parts.end(), beside,
                                                 [&](const CellSpace* c, const NodeIndex& other)
                                                 { return key(c->node) < key(other); });
                if (at != parts.end() && (*at)->node == beside)
                    sets.join(static_cast<std::size_t>(at - parts.begin()), i);
            }
        const double dp3 = field_.grid.dp * field_.grid.dp * field_.grid.dp;
        std::map<std::size_t, FluidPocket> found;
        std::map<std::size_t, double> weights;
        for (std::size_t i = 0; i < parts.size(); ++i)
        {
            const CellSpace& cell = *parts[i];
            const auto [at, is_new] = found.try_emplace(sets.find(i));
            FluidPocket& pocket = at->second;
            pocket.narrowest_dp =
                is_new ? cell.narrowest_dp : std::min(pocket.narrowest_dp, cell.narrowest_dp);
            pocket.volume += cell.pocket * dp3;
            // A node that leaves may have next to no volume.
            const double more = cell.is_in_pocket ? 1e-3 : 0;
            weights[at->first] += cell.pocket + more;
            pocket.center =
                pocket.center + cell.pocket_moment + more * place_of(cell.node, field_.grid);
            if (cell.is_in_pocket) ++pocket.nodes;
        }
        for (auto& [first, pocket] : found)
        {
            if (pocket.volume < least_pocket * dp3 && pocket.nodes == 0) continue;
            pocket.center = pocket.center / weights[first];
            out.pockets.push_back(pocket);
        }
        std::stable_sort(out.pockets.begin(), out.pockets.end(),
                         [](const FluidPocket& a, const FluidPocket& b)
                         { return a.volume > b.volume; });
    }

    /// Nodes without fluid in cells that are nearly all the fluid's: rows beside walls of shapes
    /// that were drawn up to a step before them. At inlets the solver wants those that are drawn.
    void add_nodes(const LatticeStrips& strips, std::vector<CellSpace>& cells, FluidSpace& out)
    {
        for (CellSpace& cell : cells)
        {
            const NodeIndex& n = cell.node;
            const Vec3 p = place_of(n, field_.grid);
            const bool stays = strips.has_beside_inlet(p);
            if (cell.fluid != 0 || cell.owned < (stays ? least_owned_at_inlets : least_owned) ||
                !is_relaxed(cell.owner) || run_at(field_, {n.x, n.y, n.z}) != nullptr ||
                strips.is_behind_inlet(p) ||
                all_.closest(p).distance <
                    (stays ? off_added_at_inlets : off_added) * field_.grid.dp)
                continue;
            paint(field_.slabs[n.x], {{n.y, n.z, n.z + 1}}, cell.owner);
            cell.fluid = cell.owner;
            ++out.nodes[cell.owner];
        }
    }

    void empty_pockets(const std::vector<CellSpace>& cells, FluidSpace& out)
    {
        std::vector<std::vector<Mover>> left(field_.slabs.size());
        for (const CellSpace& cell : cells)
        {
            if (!cell.is_in_pocket) continue;
            left[cell.node.x].push_back({cell.node, cell.fluid});
            out.pocket_places.push_back(place_of(cell.node, field_.grid));
            ++out.left_out[cell.fluid];
            --out.nodes[cell.fluid];
        }
        for (std::size_t x = 0; x < left.size(); ++x) cover(field_.slabs[x], left[x]);
    }

    const CaseDef& def_;
    RunField& field_;
    const AllWalls& all_;
    bool is_before_layers_;
    bool adds_nodes_;
    double pocket_; ///< width below which places between walls are pockets, dp
    int threads_;
    FluidNear near_;
    OpenLevels levels_;
    ClosestWallPoint closest_;
    std::set<std::uint16_t> moving_;  ///< mks
    std::set<std::uint16_t> sliding_; ///< of them
    bool has_several_bodies_ = false;
    Vec3 down_;          ///< along gravity; zero without
    double longest_ = 1; ///< step of the lattice, dp
    double volume_ = 1;  ///< of its cells, dp^3
};

} // namespace

FluidSpace measure_fluid_space(const CaseDef& def, RunField& field, const AllWalls& all,
                               bool is_before_layers, int threads)
{
    return SpaceMeter(def, field, all, is_before_layers, threads).run();
}

} // namespace fppg
