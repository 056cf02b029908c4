#include "normals/wet_surface.h"

#include "core/parallel.h"
#include "meshes/point_grid.h"
#include "meshes/small_pieces.h"
#include "offset/wall_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fppg
{
namespace
{

/// Fluid is looked for so far off a surface, dp.
constexpr double off_surface_dp = 1.2;
/// A side can be dry when the way to it is so much longer, or rises so much higher, dp.
constexpr double longer_way_dp = 10;
constexpr double higher_way_dp = 10;
/// Facets are judged in pieces of at most this length, dp.
constexpr double longest_piece_dp = 3;
/// Those that another wall covers in part are cut down to this length, dp, and then along its
/// border, which is found by halving a side so often.
constexpr double least_piece_dp = 0.25;
constexpr int border_halvings = 12;
/// Of facets smaller than this, dp, one in each cube of that edge is compared with its other side.
constexpr double small_piece_dp = 0.5;
/// Where another wall that covers a facet is looked for before it, dp, and how far from its corners
/// to its middle.
constexpr double cover_dp = 0.3;
constexpr double off_corner = 1e-3;
constexpr double opposing = -0.5;
/// Pieces of one side turn by less than 60 degrees from one to the next.
constexpr double same_facing = 0.5;

bool is_same_side(const FittedBody& a, const FittedBody& b)
{
    return a.is_layer() && a.owner == b.owner && a.wall->sign() == b.wall->sign();
}

constexpr char is_wet = 0;
constexpr char is_dry = 1;
constexpr char is_thin = 2; ///< wet, and so is the other side

/// Fluid so near to a side stands at it, dp.
constexpr double stands_at_dp = 3;

/// How a part of a wall moves.
enum class Moving
{
    No,
    KeepsSides,
    TurnsOver
};

/// Whether one side of a wall is dry beside the other.
bool is_dry_beside(const FluidWay::Way& here, const FluidWay::Way& there, Moving moving)
{
    if (!(here.length > there.length + longer_way_dp)) return false;
    const bool stays_so =
        moving == Moving::No || (moving == Moving::KeepsSides && there.length < stands_at_dp);
    if (!stays_so) return here.runs_out && !there.runs_out;
    return here.runs_out || here.rise > there.rise + higher_way_dp;
}

} // namespace

WetSurface::WetSurface(const RunField& field, const Setup& setup, int threads)
    : setup_(setup),
      reach_(setup.reach),
      dp_(field.grid.dp),
      closed_gaps_(2 * dp_, field.walls.gaps.size())
{
    for (const GapParticle& gap : field.walls.gaps) closed_gaps_.add(gap.place);
    find_walls(field.walls.bodies);
    cut_pieces(field.walls.bodies);
    if (pieces_.empty()) return;
    find_covered(threads);
    if (std::any_of(walls_.begin(), walls_.end(), [](const Wall& w) { return w.is_closed; }))
        judge(field, FluidWay(field, setup.first_bound, setup.gravity), threads);
    note_thin_walls(field);
    make_query(threads);
    pieces_ = {};
    facets_ = {};
}

/// Of the wet pieces; those of a facet that is wet all over are the facet.
void WetSurface::make_query(int threads)
{
    TriangleSoup wet;
    const auto add = [&](const std::array<Vec3, 3>& corners, const WallDepth* wall)
    {
        wet.vertices.insert(wet.vertices.end(), corners.begin(), corners.end());
        exact_walls_.push_back(wall->is_exact() ? wall : nullptr);
    };
    for (std::size_t f = 0; f < facets_.size(); ++f)
    {
        const auto begin = pieces_.begin() + static_cast<std::ptrdiff_t>(facets_[f].first_piece);
        const auto end =
            f + 1 < facets_.size()
                ? pieces_.begin() + static_cast<std::ptrdiff_t>(facets_[f + 1].first_piece)
                : pieces_.end();
        const auto dry =
            std::count_if(begin, end, [](const Piece& p) { return p.state == is_dry; });
        if (dry == 0)
            add(facets_[f].corners, walls_[begin->wall].depth);
        else
            for (auto piece = begin; piece != end; ++piece)
                if (piece->state != is_dry) add(piece->corners, walls_[piece->wall].depth);
        has_dry_sides_ = has_dry_sides_ || dry > 0;
    }
    if (wet.vertices.empty()) return;
    query_ = std::make_unique<MeshQuery>(std::move(wet), threads);
    query_->prepare_nearest();
}

/// The first layer on each side names the surface and the way to the fluid.
void WetSurface::find_walls(const std::vector<FittedBody>& bodies)
{
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
    {
        if (!bodies[b].is_layer()) continue;
        if (!is_same_side(bodies[b - 1], bodies[b]))
        {
            Wall wall;
            wall.body = bodies[b].owner;
            wall.depth = bodies[b].wall.get();
            wall.is_closed = bodies[wall.body].measures.volume > 0;
            wall.first = bodies[b].depth;
            wall.is_moving = setup_.is_moving[bodies[b].mk] != 0;
            wall.floats = setup_.floats[bodies[b].mk] != 0;
            for (const Vec3& v : wall.depth->mesh().vertices) wall.box.add(v);
            walls_.push_back(wall);
        }
        walls_.back().deepest = std::max(walls_.back().deepest, bodies[b].depth + 0.5 * dp_);
    }
    for (Wall& wall : walls_)
        for (std::uint32_t w = 0; w < walls_.size(); ++w)
            if (may_cover(walls_[w], wall.box) && walls_[w].body != wall.body &&
                walls_[w].is_moving == wall.is_moving && !wall.floats)
                wall.near.push_back(w);
}

/// What floats leaves the place where it stands at the start.
bool WetSurface::may_cover(const Wall& wall, const Box3& box) const
{
    const double room = wall.deepest + cover_dp * dp_;
    bool meet = !wall.floats;
    for (int axis = 0; axis < 3; ++axis)
        meet = meet && box.min[axis] <= wall.box.max[axis] + room &&
               wall.box.min[axis] <= box.max[axis] + room;
    return meet;
}

bool WetSurface::may_be_covered(const Piece& piece) const
{
    Box3 box;
    for (const Vec3& corner : piece.corners) box.add(corner);
    const std::vector<std::uint32_t>& near = walls_[piece.wall].near;
    return std::any_of(near.begin(), near.end(),
                       [&](std::uint32_t w) { return may_cover(walls_[w], box); });
}

void WetSurface::cut_pieces(const std::vector<FittedBody>& bodies)
{
    constexpr double whole = std::numeric_limits<double>::infinity();
    for (std::uint32_t w = 0; w < walls_.size(); ++w)
    {
        const Wall& wall = walls_[w];
        const FittedBody& owner = bodies[wall.body];
        const SurfaceMesh& mesh = wall.depth->mesh();
        for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        {
            Piece piece;
            piece.wall = w;
            for (std::size_t c = 0; c < 3; ++c) piece.corners[c] = mesh.vertices[mesh.facets[f][c]];
            piece.normal = wall.depth->sign() * mesh.normals[f];
            piece.mk = owner.facet_mk.empty() ? owner.mk : owner.facet_mk[f];
            piece.is_moving = setup_.is_moving[piece.mk] != 0;
            piece.turns_over = setup_.turns_over[piece.mk] != 0;
            facets_.push_back({piece.corners, pieces_.size()});
            const bool is_judged = wall.is_closed || may_be_covered(piece);
            add_pieces(piece, is_judged ? longest_piece_dp * dp_ : whole);
        }
    }
}

double WetSurface::Piece::length() const
{
    return std::max({norm(corners[1] - corners[0]), norm(corners[2] - corners[1]),
                     norm(corners[0] - corners[2])});
}

/// Across its longest side.
std::array<WetSurface::Piece, 2> WetSurface::Piece::halves() const
{
    std::size_t side = 0;
    double length = 0;
    for (std::size_t s = 0; s < 3; ++s)
    {
        const double l = norm(corners[(s + 1) % 3] - corners[s]);
        if (l <= length) continue;
        length = l;
        side = s;
    }
    const Vec3 at = 0.5 * (corners[side] + corners[(side + 1) % 3]);
    std::array<Piece, 2> out{*this, *this};
    out[0].corners[side] = at;
    out[1].corners[(side + 1) % 3] = at;
    return out;
}

void WetSurface::add_pieces(const Piece& whole, double longest)
{
    std::vector<Piece> todo{whole};
    while (!todo.empty())
    {
        const Piece now = todo.back();
        todo.pop_back();
        if (now.length() <= longest)
            pieces_.push_back(now);
        else
            for (const Piece& half : now.halves()) todo.push_back(half);
    }
}

/// Pieces that another wall covers in part are cut along its border.
void WetSurface::find_covered(int threads)
{
    if (walls_.size() < 2) return;
    std::vector<std::vector<Piece>> cut(pieces_.size());
    parallel_for(
        pieces_.size(), threads, [&](std::size_t i) { cut[i] = cut_at_covers(pieces_[i]); }, 64);
    std::vector<Piece> all;
    std::size_t facet = 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
    {
        while (facet < facets_.size() && facets_[facet].first_piece == i)
            facets_[facet++].first_piece = all.size();
        if (cut[i].empty())
            all.push_back(pieces_[i]);
        else
            all.insert(all.end(), cut[i].begin(), cut[i].end());
    }
    pieces_ = std::move(all);
}

/// Sets the state of a piece; returns the parts into which it was cut, none where it stays whole.
std::vector<WetSurface::Piece> WetSurface::cut_at_covers(Piece& piece) const
{
    std::vector<Piece> out;
    if (!may_be_covered(piece)) return out;
    std::vector<Piece> todo{piece};
    while (!todo.empty())
    {
        Piece now = todo.back();
        todo.pop_back();
        const Vec3 middle = now.middle();
        const bool is_middle_covered = is_covered(now, middle);
        now.state = is_middle_covered ? is_dry : is_wet;
        const bool is_mixed =
            std::any_of(now.corners.begin(), now.corners.end(),
                        [&](const Vec3& corner) {
                            return is_covered(now, corner + off_corner * (middle - corner)) !=
                                   is_middle_covered;
                        });
        if (!is_mixed)
            out.push_back(now);
        else if (now.length() > least_piece_dp * dp_)
            for (const Piece& half : now.halves()) todo.push_back(half);
        else
            cut_along_border(now, out);
    }
    if (out.size() > 1) return out;
    piece.state = out[0].state;
    return {};
}

/// Adds the parts of a small piece on both sides of the border of what covers it in part.
void WetSurface::cut_along_border(const Piece& piece, std::vector<Piece>& out) const
{
    const Vec3 middle = piece.middle();
    const auto is_dry_at = [&](const Vec3& p)
    { return is_covered(piece, p + off_corner * (middle - p)); };
    std::array<bool, 3> are_dry{};
    for (std::size_t k = 0; k < 3; ++k) are_dry[k] = is_dry_at(piece.corners[k]);
    std::size_t lone = 0; // the corner whose two sides the border crosses
    while (lone < 3 &&
           (are_dry[lone] == are_dry[(lone + 1) % 3] || are_dry[lone] == are_dry[(lone + 2) % 3]))
        ++lone;
    if (lone == 3) // its middle alone is covered, or is not
    {
        out.push_back(piece);
        return;
    }
    const Vec3& tip = piece.corners[lone];
    const Vec3& second = piece.corners[(lone + 1) % 3];
    const Vec3& third = piece.corners[(lone + 2) % 3];
    const auto border_towards = [&](const Vec3& end)
    {
        Vec3 from = tip;
        Vec3 to = end;
        for (int i = 0; i < border_halvings; ++i)
        {
            const Vec3 half = 0.5 * (from + to);
            (is_dry_at(half) == are_dry[lone] ? from : to) = half;
        }
        return 0.5 * (from + to);
    };
    const Vec3 on_second = border_towards(second);
    const Vec3 on_third = border_towards(third);
    const auto add = [&](const std::array<Vec3, 3>& corners, bool dry)
    {
        Piece part = piece;
        part.corners = corners;
        part.state = dry ? is_dry : is_wet;
        out.push_back(part);
    };
    add({tip, on_second, on_third}, are_dry[lone]);
    add({on_second, second, third}, !are_dry[lone]);
    add({on_second, third, on_third}, !are_dry[lone]);
}

void WetSurface::judge(const RunField& field, const FluidWay& way, int threads)
{
    const auto before = [&](const Piece& piece)
    { return piece.middle() + (off_surface_dp * dp_) * piece.normal; };
    std::vector<char> is_closed_in(65536, 0);
    parallel_for(
        pieces_.size(), threads,
        [&](std::size_t i)
        {
            if (is_closed(pieces_[i])) pieces_[i].way = way.to(before(pieces_[i]));
        },
        256);
    for (const Piece& piece : pieces_)
        if (is_closed(piece) && piece.is_moving && !piece.way.is_free) is_closed_in[piece.mk] = 1;
    // What others are too near to at the start gets free when it moves.
    std::vector<std::uint16_t> closed_in;
    for (std::size_t mk = 0; mk < is_closed_in.size(); ++mk)
        if (is_closed_in[mk] != 0) closed_in.push_back(static_cast<std::uint16_t>(mk));
    parallel_for(closed_in.size(), threads,
                 [&](std::size_t i)
                 {
                     const std::uint16_t mk = closed_in[i];
                     const FluidWay alone = FluidWay::around(field, setup_.first_bound, mk);
                     for (Piece& piece : pieces_)
                         if (is_closed(piece) && piece.mk == mk && !piece.way.is_free)
                             piece.way = alone.to(before(piece));
                 });
    compare_all_sides(way, threads);
    const auto is_reached = [](const Piece& p)
    { return p.state != is_dry && std::isfinite(p.way.length); };
    if (std::any_of(pieces_.begin(), pieces_.end(), is_reached))
        for (Piece& piece : pieces_)
            if (!std::isfinite(piece.way.length)) piece.state = is_dry;
    dry_to_the_rims();
    dry_beside_dry(threads);
}

/// Small pieces beside one another have the same sides.
void WetSurface::compare_all_sides(const FluidWay& way, int threads)
{
    const auto is_asked = [&](const Piece& piece)
    { return is_closed(piece) && piece.state != is_dry; };
    const double small = small_piece_dp * dp_;
    std::vector<SmallPiece> places(pieces_.size());
    parallel_for(
        pieces_.size(), threads,
        [&](std::size_t i)
        {
            const Piece& piece = pieces_[i];
            places[i] = {piece.middle(), piece.normal, piece.wall << 16 | piece.mk,
                         is_asked(piece) && piece.length() < small};
        },
        256);
    const PiecesToAsk asked = pieces_to_ask(places, small, threads);
    parallel_for(
        asked.order.size(), threads,
        [&](std::size_t i)
        {
            Piece& piece = pieces_[asked.order[i]];
            if (is_asked(piece)) compare_sides(piece, way);
        },
        64);
    for (std::size_t i = 0; i < pieces_.size(); ++i)
    {
        if (asked.for_each[i] == i) continue;
        Piece& piece = pieces_[i];
        const Piece& like = pieces_[asked.for_each[i]];
        piece.state = like.state;
        piece.thickness = like.thickness;
        piece.is_straight = like.is_straight;
        piece.is_other_covered = like.is_other_covered;
        piece.other_way = like.other_way;
    }
}

/// Of the closed gap before a place of a piece, and a little more, metres; 0: there is none.
double WetSurface::width_before(const Piece& piece, const Vec3& at) const
{
    constexpr double aside = 1.2; // dp, of a particle in it
    constexpr double more = 0.02; // dp
    double width = 0;
    if (closed_gaps_.points().empty()) return width;
    double nearest = aside * aside * dp_ * dp_;
    closed_gaps_.for_each_near(at, aside * dp_,
                               [&](std::uint32_t gap, double squared)
                               {
                                   const double to_middle =
                                       dot(closed_gaps_.points()[gap] - at, piece.normal);
                                   if (squared >= nearest || to_middle <= 0) return;
                                   nearest = squared;
                                   width = 2 * to_middle + more * dp_;
                               });
    return width;
}

/// Whether another wall begins right before a place of a piece, or behind a closed gap: a closed
/// one, or the layers of a sheet.
bool WetSurface::is_covered(const Piece& piece, const Vec3& at) const
{
    const Vec3 before = at + std::max(cover_dp * dp_, width_before(piece, at)) * piece.normal;
    const std::vector<std::uint32_t>& near = walls_[piece.wall].near;
    return std::any_of(
        near.begin(), near.end(),
        [&](std::uint32_t w)
        {
            const Wall& wall = walls_[w];
            if (!wall.box.has(before, wall.is_closed ? 0 : wall.deepest)) return false;
            const DepthPlace place = wall.depth->at(before);
            return place.depth > 0 &&
                   (wall.is_closed || (place.depth < wall.deepest && !place.is_beyond_rim));
        });
}

/// The other side of a thin wall is looked for half a reach and a reach under a piece.
void WetSurface::compare_sides(Piece& piece, const FluidWay& way) const
{
    const WallDepth& wall = *walls_[piece.wall].depth;
    const Vec3 middle = piece.middle();
    DepthPlace other;
    Vec3 other_normal = piece.normal;
    for (const double share : {0.5, 1.0})
    {
        if (dot(other_normal, piece.normal) <= opposing) continue;
        other = wall.at(middle - (share * reach_) * piece.normal);
        other_normal = wall.sign() * wall.mesh().normals[other.facet];
    }
    if (dot(other_normal, piece.normal) > opposing) return;
    piece.thickness = dot(middle - other.nearest, piece.normal);
    piece.is_straight =
        norm(middle - piece.thickness * piece.normal - other.nearest) < piece.thickness;
    // Particles nearer to one side are within reach of the other.
    if (!(piece.thickness < 2 * reach_)) return;
    Piece opposite = piece;
    opposite.normal = other_normal;
    piece.is_other_covered = is_covered(opposite, other.nearest);
    if (piece.is_other_covered) return;
    const FluidWay::Way there = way.to(other.nearest + (off_surface_dp * dp_) * other_normal);
    piece.other_way = there.length;
    if (!std::isfinite(piece.way.length) && !std::isfinite(there.length)) return;
    const Moving moving = !piece.is_moving   ? Moving::No
                          : piece.turns_over ? Moving::TurnsOver
                                             : Moving::KeepsSides;
    if (is_dry_beside(piece.way, there, moving))
        piece.state = is_dry;
    else if (!is_dry_beside(there, piece.way, moving))
        piece.state = is_thin;
}

/// Towards the rim of a tank the way to the outside is shorter. Its walls would look aslant to the
/// strip there instead of through themselves.
void WetSurface::dry_to_the_rims()
{
    std::vector<std::size_t> front;
    std::vector<std::size_t> candidates;
    PointGrid near(reach_, pieces_.size() / 4);
    for (std::size_t i = 0; i < pieces_.size(); ++i)
    {
        const Piece& piece = pieces_[i];
        if (piece.state == is_dry) front.push_back(i);
        if (piece.state != is_thin || !(piece.way.length > piece.other_way + 1)) continue;
        candidates.push_back(i);
        near.add(piece.middle());
    }
    while (!front.empty() && !candidates.empty())
    {
        const Piece from = pieces_[front.back()];
        front.pop_back();
        near.for_each_near(from.middle(), reach_,
                           [&](std::uint32_t c, double)
                           {
                               Piece& piece = pieces_[candidates[c]];
                               if (piece.state == is_dry || piece.wall != from.wall ||
                                   dot(piece.normal, from.normal) < same_facing)
                                   return;
                               piece.state = is_dry;
                               front.push_back(candidates[c]);
                           });
    }
}

/// Some pieces have no other side to be compared with: along the edges of a dry side, where no
/// place lies right behind them, and behind another wall, as one that parts a tank. They are dry
/// where they are far from the fluid and near to a dry piece.
void WetSurface::dry_beside_dry(int threads)
{
    const auto is_far_from_fluid = [](const Piece& piece)
    {
        return piece.way.length > longer_way_dp &&
               (piece.way.runs_out || (!piece.is_moving && piece.way.rise > higher_way_dp));
    };
    PointGrid dry(2 * reach_, pieces_.size() / 4);
    for (const Piece& piece : pieces_)
        if (piece.state == is_dry) dry.add(piece.middle());
    if (dry.points().empty()) return;
    parallel_for(
        pieces_.size(), threads,
        [&](std::size_t i)
        {
            Piece& piece = pieces_[i];
            if (is_closed(piece) && piece.state != is_dry &&
                (piece.thickness == 0 || piece.is_other_covered) && is_far_from_fluid(piece) &&
                dry.has_nearer(piece.middle(), 2 * reach_))
                piece.state = is_dry;
        },
        256);
}

void WetSurface::note_thin_walls(const RunField& field)
{
    const double enough = reach_ - 0.5 * field.grid.dp;
    const auto note = [&](const Piece& piece, std::vector<ThinWall>& walls)
    {
        const std::uint16_t mk = field.walls.bodies[walls_[piece.wall].body].mk;
        auto found = std::find_if(walls.begin(), walls.end(),
                                  [&](const ThinWall& wall) { return wall.mk == mk; });
        if (found == walls.end()) found = walls.insert(found, {mk, piece.thickness, 0});
        found->thickness = std::min(found->thickness, piece.thickness);
        found->area += 0.5 * norm(cross(piece.corners[1] - piece.corners[0],
                                        piece.corners[2] - piece.corners[0]));
    };
    for (const Piece& piece : pieces_)
    {
        if (!piece.is_straight || !(piece.thickness > 0)) continue;
        if (piece.state == is_thin && piece.thickness < enough) note(piece, thin_walls_);
        const double first = walls_[piece.wall].first;
        if (piece.state != is_dry && std::isfinite(piece.way.length) && first < 0.75 * dp_ &&
            piece.thickness < (1 - 1e-9) * (2 * first + least_pair_dp * dp_))
            note(piece, one_layer_walls_);
    }
}

Vec3 WetSurface::vector_from(const Vec3& p, double most) const
{
    if (query_ == nullptr) return {};
    const ClosestPoint near = query_->closest_point(p, most);
    if (!(near.distance <= most)) return {};
    const WallDepth* exact_wall = exact_walls_[near.facet];
    if (exact_wall == nullptr) return near.point - p;
    // From the facets to their exact surface. Its nearest place may be on a dry side.
    const Vec3 nearest = exact_wall->at(p).nearest;
    const bool is_wet_one = std::fabs(norm(nearest - p) - near.distance) <= 2 * exact_wall->chord();
    return (is_wet_one ? nearest : exact_wall->at(near.point).nearest) - p;
}

} // namespace fppg
