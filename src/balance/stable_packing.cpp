#include "balance/stable_packing.h"

#include "balance/lattice_fall.h"
#include "balance/lattice_stability.h"
#include "core/parallel_sort.h"
#include "meshes/point_grid.h"
#include "relax/cell_rows.h"
#include "relax/wall_planes.h"

#include <array>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>

namespace fppg
{
namespace
{

// Lengths in dp.
constexpr double reach_of_cover = 1.5;
constexpr double least_cover = 0.5; ///< at the border of the fluid
constexpr double touching = 0.01;   ///< from a wall that is met
constexpr double least_size = 3.01; ///< of a body, along each axis: more than three rows
/// A body that fills more than this of its bounds is a box: its lattice has the box's volume.
constexpr double box_fill = 0.97;
/// Bounds may be so many times as large as a body; the places of a lattice in them are made.
constexpr double most_box = 20;
/// Of all fluid that moves; where less can be packed, none is.
constexpr double least_packed = 0.95;
/// Lattices are tried until one has no more than so many places too many, over the number of
/// particles; the best is taken, by places that are too many, or too few times a cost.
constexpr double wanted_excess = 0.02;
constexpr double cost_of_crowding = 5;
constexpr int most_trials = 4;
/// Up to so many too many are left out of the highest rows, more all around at the border.
constexpr double most_excess = 0.06;
constexpr double most_strain = 0.07;
/// Places that are too many, over the number of particles, against the square of a strain.
constexpr double cost_of_excess = 0.02;
constexpr double cost_of_excess_squared = 4;
/// Of the last row of a body, beside walls: places along the axis that are the same; the cosine
/// between the axis and the way to a flat wall; how many are enough to know.
constexpr double same_row = 0.1;
constexpr double flat = 0.99;
constexpr std::size_t most_looked_at = 1000;
/// The most that a row of the highest ones gives up.
constexpr double most_thinned = 1.0 / 3;

/// Layers of rows between the bounds of a body of fluid.
struct Packing
{
    std::array<int, 3> axes{}; ///< of two directions along layers, in 2D one, and across
    std::array<double, 3> low{};
    std::array<double, 3> steps{}; ///< metres
    /// Rows between the bounds; the last of layers. In 2D the second is 0.
    std::array<int, 3> counts{};

    std::vector<Vec3> places(double y_of_2d) const;
    /// From a place to those within a reach, metres; itself first.
    std::vector<Vec3> offsets(double reach) const;
};

std::vector<Vec3> Packing::places(double y_of_2d) const
{
    std::vector<Vec3> out;
    const bool is_2d = counts[1] == 0;
    // Nested because a lattice has three directions. Every second place of a row is taken, by
    // turns: the nets of layers lie diagonally, so that rows are straight along the bounds of a
    // box.
    for (int k = 0; k < counts[2]; ++k)
        for (int j = 0; j < std::max(counts[1], 1); ++j)
            for (int i = (j + k) % 2; i < counts[0]; i += 2)
            {
                Vec3 at{0, y_of_2d, 0};
                at[axes[0]] = low[0] + (i + 0.5) * steps[0];
                if (!is_2d) at[axes[1]] = low[1] + (j + 0.5) * steps[1];
                at[axes[2]] = low[2] + (k + 0.5) * steps[2];
                out.push_back(at);
            }
    return out;
}

std::vector<Vec3> Packing::offsets(double reach) const
{
    std::vector<Vec3> out{{}};
    std::array<int, 3> n{};
    for (std::size_t d = 0; d < 3; ++d)
        n[d] = counts[1] == 0 && d == 1 ? 0 : static_cast<int>(reach / steps[d]);
    // Nested because a lattice has three directions.
    for (int k = -n[2]; k <= n[2]; ++k)
        for (int j = -n[1]; j <= n[1]; ++j)
            for (int i = -n[0]; i <= n[0]; ++i)
            {
                if ((i + j + k) % 2 != 0) continue;
                Vec3 at;
                at[axes[0]] = i * steps[0];
                if (n[1] > 0) at[axes[1]] = j * steps[1];
                at[axes[2]] = k * steps[2];
                if (norm(at) > 0 && norm(at) < reach) out.push_back(at);
            }
    return out;
}

/// How far places of a lattice sink until its midst is at rest under the pressures of its depth.
///
/// With a share d of particles too many, of the depth D, what is left of gravity is the fall F of
/// the lattice less 2 D d' + d. F is a + b D (by lattice_falls(): a by what the kernel's sums miss,
/// b by the fluid's compression, which lessens the volumes of particles), so d is a + b D / 3.
class Sinking
{
public:
    /// level, bottom  heights of the surface and of the lowest places, metres
    Sinking(const FluidAtRest& rest, const Packing& packing, double mass, double level,
            double bottom)
        : deepest_(level - bottom), level_(level)
    {
        const double first = 2 * rest.h + rest.dp; // from there on kernels do not reach the surface
        const std::array<double, 2> depths{first, std::max(deepest_, first + rest.dp)};
        const auto falls = lattice_falls(rest, packing.offsets(2 * rest.h), mass, depths);
        const double g2 = dot(rest.gravity, rest.gravity);
        const double of_first = dot(falls[0], rest.gravity) / g2;
        slope_ = (dot(falls[1], rest.gravity) / g2 - of_first) / (depths[1] - depths[0]);
        at_level_ = of_first - slope_ * first;
    }

    /// Metres.
    double at(double height) const
    {
        const double depth = std::clamp(level_ - height, 0.0, deepest_);
        return at_level_ * (deepest_ - depth) + slope_ / 6 * (deepest_ * deepest_ - depth * depth);
    }

private:
    double deepest_, level_;
    double at_level_ = 0; ///< over gravity
    double slope_ = 0;    ///< over gravity and metres
};

/// The counts to try for a length; the last is at least the next above the ideal one, so that there
/// is a lattice whose cells are no larger than those wanted.
struct Counts
{
    int first, last;
    Counts(double length, double step)
        : first(std::max(1, static_cast<int>(std::ceil(length / step * (1 - most_strain))))),
          last(static_cast<int>(
              std::max(std::ceil(length / step), std::floor(length / step * (1 + most_strain)))))
    {
    }
};

/// The lattice whose cells are nearest to the ideal ones and, by volume, a little smaller than
/// `cell`, so that there are a few places too many.
///
/// ratio  of the distance between layers to the step in them
/// cell   what a particle has, m^3 (2D: m^2)
Packing fit_packing(const FluidAtRest& rest, const Box3& bounds, int up, double ratio, double cell)
{
    Packing p;
    p.axes = {up == 0 ? 1 : 0, up == 2 ? 1 : 2, up};
    if (rest.is_2d) p.axes = {up == 0 ? 2 : 0, 1, up};
    std::array<double, 3> lengths{};
    for (std::size_t k = 0; k < 3; ++k)
    {
        p.low[k] = bounds.min[p.axes[k]];
        lengths[k] = bounds.max[p.axes[k]] - p.low[k];
    }
    const double step = rest.is_2d ? std::sqrt(cell / ratio) : std::cbrt(cell / ratio);
    const double along = step / (rest.is_2d ? 2 : std::numbers::sqrt2); // of straight rows
    const auto strain = [](double taken, double ideal)
    { return std::pow(std::log(taken / ideal), 2); };
    const Counts rows(lengths[0], along), columns(lengths[1], along),
        layers(lengths[2], ratio * step);
    Packing best = p;
    double least = std::numeric_limits<double>::infinity();
    // Nested because a lattice has three counts.
    for (int c = layers.first; c <= layers.last; ++c)
        for (int a = rows.first; a <= rows.last; ++a)
            for (int b = rest.is_2d ? 0 : columns.first; b <= (rest.is_2d ? 0 : columns.last); ++b)
            {
                p.counts = {a, b, c};
                p.steps = {lengths[0] / a, rest.is_2d ? 1 : lengths[1] / b, lengths[2] / c};
                const double excess = 1 - 2 * p.steps[0] * p.steps[1] * p.steps[2] / cell;
                if (excess < -1e-6) continue;
                const double cost = strain(p.steps[0], along) +
                                    (rest.is_2d ? 0 : strain(p.steps[1], along)) +
                                    strain(p.steps[2], ratio * step) + cost_of_excess * excess +
                                    cost_of_excess_squared * excess * excess;
                if (cost >= least) continue;
                least = cost;
                best = p;
            }
    return best;
}

/// How much of a body of fluid, as it was, is around a place: 1 in its midst, a half at its border.
class Cover
{
public:
    Cover(const FluidAtRest& rest, const std::vector<std::uint32_t>& body)
        : reach_(reach_of_cover * rest.dp), body_(body), grid_(reach_, body.size())
    {
        for (const std::uint32_t i : body) grid_.add(rest.positions[i]);
        const int n = static_cast<int>(reach_of_cover), across = rest.is_2d ? 0 : n;
        for (int x = -n; x <= n; ++x)
            for (int y = -across; y <= across; ++y)
                for (int z = -n; z <= n; ++z)
                    whole_ += weight(rest.dp * rest.dp * (x * x + y * y + z * z));
    }

    /// A sum over the particles that `counts` is true for.
    ///
    /// counts  bool(std::uint32_t), of an index in FluidAtRest
    template <typename Counts>
    double at(const Vec3& place, const Counts& counts) const
    {
        double sum = 0;
        grid_.for_each_near(place, reach_,
                            [&](std::uint32_t k, double squared)
                            {
                                if (counts(body_[k])) sum += weight(squared);
                            });
        return sum / whole_;
    }

    /// Of a place where the cover is above 0.
    std::uint32_t nearest(const Vec3& place) const
    {
        return body_[grid_.nearest(place, reach_).value_or(0)];
    }

private:
    double weight(double squared) const
    {
        const double x = std::max(0.0, 1 - squared / (reach_ * reach_));
        return x * x * x;
    }

    double reach_;
    const std::vector<std::uint32_t>& body_;
    PointGrid grid_;
    double whole_ = 0;
};

/// Takes out what is too much, evenly, from the highest rows.
///
/// places  sorted by x, then y, then z
std::vector<Vec3> thin_out_top(std::vector<Vec3> places, const Packing& packing, std::size_t wanted)
{
    const int up = packing.axes[2];
    std::stable_sort(places.begin(), places.end(),
                     [&](const Vec3& a, const Vec3& b) { return a[up] > b[up]; });
    std::size_t excess = places.size() - wanted;
    std::vector<Vec3> out;
    for (std::size_t from = 0; from < places.size();)
    {
        std::size_t to = from;
        while (to < places.size() && places[to][up] > places[from][up] - packing.steps[2] / 2) ++to;
        const std::size_t n = to - from;
        const auto most =
            static_cast<std::size_t>(std::ceil(most_thinned * static_cast<double>(n)));
        const std::size_t less = std::min(excess, most);
        for (std::size_t k = 0; k < n; ++k)
            if ((k + 1) * less / n == k * less / n) out.push_back(places[from + k]);
        excess -= less;
        from = to;
    }
    return out;
}

bool is_before(const Vec3& a, const Vec3& b)
{
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// One body of fluid.
class BodyPacker
{
public:
    /// body  indices of its particles, ascending
    BodyPacker(FluidAtRest& rest, const std::vector<std::uint32_t>& body,
               const CaseParticles& particles, const PackedWalls& walls, int threads)
        : rest_(rest),
          body_(body),
          particles_(particles),
          walls_(walls),
          cover_(rest, body),
          threads_(threads)
    {
    }

    /// False where the body stays as it is.
    bool pack(int up, double ratio)
    {
        const Box3 bounds = own_bounds();
        const Vec3 size = bounds.max - bounds.min;
        if (box_of(size) > most_box * static_cast<double>(body_.size()) * own_cell()) return false;
        for (int axis = 0; axis < 3; ++axis)
            if (!(rest_.is_2d && axis == 1) && size[axis] < least_size * rest_.dp) return false;
        double cell = cell_of(size);
        Places best;
        double least_off = std::numeric_limits<double>::infinity();
        for (int k = 0; k < most_trials && least_off > wanted_excess; ++k)
        {
            Places places = choose(fit_packing(rest_, bounds, up, ratio, cell));
            if (places.inside == 0) break;
            const double excess =
                static_cast<double>(places.inside) / static_cast<double>(body_.size()) - 1;
            const double off = excess < 0 ? -cost_of_crowding * excess : excess;
            if (off < least_off && places.by_cover.size() >= body_.size())
            {
                least_off = off;
                best = std::move(places);
            }
            cell *= (1 + excess) / (1 + wanted_excess / 4);
        }
        if (best.by_cover.empty()) return false;
        take(fill(best));
        return true;
    }

private:
    struct Places
    {
        std::vector<Vec3> by_cover; ///< those that are covered at all, the most first
        std::size_t inside = 0;     ///< of them, at least half covered
        Packing packing;
    };

    /// Of the space that the body fills.
    Box3 own_bounds() const
    {
        Box3 nodes;
        for (const std::uint32_t i : body_) nodes.add(rest_.positions[i]);
        Box3 out = nodes;
        for (int axis = 0; axis < 3; ++axis)
        {
            const double half = rest_.dp / 2;
            out.min[axis] = wall_beside(nodes, axis, -1).value_or(nodes.min[axis] - half);
            out.max[axis] = wall_beside(nodes, axis, 1).value_or(nodes.max[axis] + half);
        }
        return out;
    }

    /// Where the space of the body ends at a flat wall across an axis, if most of its last row is
    /// beside one.
    ///
    /// side  1, or -1: below
    std::optional<double> wall_beside(const Box3& nodes, int axis, int side) const
    {
        if (rest_.is_2d && axis == 1) return std::nullopt;
        const double last = side > 0 ? nodes.max[axis] : nodes.min[axis];
        std::vector<std::uint32_t> row;
        for (const std::uint32_t i : body_)
            if (std::abs(rest_.positions[i][axis] - last) < same_row * rest_.dp) row.push_back(i);
        const std::size_t stride = 1 + row.size() / most_looked_at;
        std::vector<double> walls;
        std::size_t looked_at = 0;
        for (std::size_t k = 0; k < row.size(); k += stride, ++looked_at)
        {
            const Vec3& p = rest_.positions[row[k]];
            const Vec3 away = walls_.closest(p, reach_of_cover * rest_.dp) - p;
            const double distance = norm(away);
            if (distance <= reach_of_cover * rest_.dp && side * away[axis] > flat * distance)
                walls.push_back(p[axis] + away[axis]);
        }
        if (2 * walls.size() <= looked_at) return std::nullopt;
        std::sort(walls.begin(), walls.end());
        const std::size_t tenth = walls.size() / 10;
        if (walls[walls.size() - 1 - tenth] - walls[tenth] > same_row * rest_.dp)
            return std::nullopt;
        return walls[walls.size() / 2] - side * walls_.gap;
    }

    double own_cell() const { return std::pow(rest_.dp, rest_.is_2d ? 2 : 3); }
    double box_of(const Vec3& size) const { return size.x * size.z * (rest_.is_2d ? 1 : size.y); }

    /// What a particle has, m^3 or m^2.
    double cell_of(const Vec3& size) const
    {
        const auto n = static_cast<double>(body_.size());
        const double box = box_of(size);
        return n * own_cell() > box_fill * box ? box / n : own_cell();
    }

    std::vector<Vec3> sunk_places(const Packing& packing) const
    {
        const std::uint32_t first = body_.front();
        std::vector<Vec3> places = packing.places(rest_.positions[first].y);
        double level = rest_.levels[first], bottom = level;
        for (const std::uint32_t i : body_) level = std::max(level, rest_.levels[i]);
        for (const Vec3& p : places) bottom = std::min(bottom, rest_.height(p));
        const Sinking sinking(rest_, packing, rest_.masses[first], level, bottom);
        const Vec3 down = rest_.gravity / norm(rest_.gravity);
        for (Vec3& p : places) p = p + sinking.at(rest_.height(p)) * down;
        return places;
    }

    /// The places of a lattice that are in the fluid as it was, moved off walls.
    Places choose(const Packing& packing) const
    {
        const std::vector<Vec3> places = sunk_places(packing);
        struct Choice
        {
            double cover = 0;
            std::size_t place = 0;
            Vec3 at; ///< off walls
        };
        std::vector<Choice> choices(places.size());
        parallel_for(
            places.size(), threads_,
            [&](std::size_t k)
            {
                const double cover = cover_.at(places[k], [](std::uint32_t) { return true; });
                choices[k] = {cover, k, places[k]};
                if (cover <= 0) return;
                const Vec3 fluid = rest_.positions[cover_.nearest(places[k])];
                const Vec3 wall = walls_.closest(places[k], reach_of_cover * rest_.dp);
                const Vec3 away = places[k] - wall;
                const double distance = norm(away);
                if (distance < walls_.least_distance)
                    choices[k].at = wall + (walls_.least_distance / distance) * away;
                // Where fluid is nearer than the next wall, the way from it is free.
                const bool may_be_beyond = !(norm(fluid - places[k]) < distance);
                if (dot(away, fluid - wall) <= 0 ||
                    (may_be_beyond && !is_reached(fluid, choices[k].at)))
                    choices[k].cover = 0;
            },
            64);
        parallel_sort(choices, threads_,
                      [](const Choice& a, const Choice& b)
                      { return std::tuple(-a.cover, a.place) < std::tuple(-b.cover, b.place); });
        Places out;
        out.packing = packing;
        for (const Choice& choice : choices)
        {
            if (choice.cover <= 0) break;
            out.by_cover.push_back(choice.at);
            out.inside += choice.cover >= least_cover ? 1 : 0;
        }
        return out;
    }

    /// Whether fluid comes to a place: not through the floor between two teeth that stand in it.
    bool is_reached(const Vec3& fluid, const Vec3& place) const
    {
        return is_way_free(fluid, place, touching * rest_.dp, walls_.closest);
    }

    /// As many places as there are particles, by x, then y, then z within each row or layer.
    std::vector<Vec3> fill(const Places& places) const
    {
        const std::size_t n = body_.size();
        const auto most = n + static_cast<std::size_t>(most_excess * static_cast<double>(n));
        std::size_t taken = std::max(places.inside, n);
        if (taken > most) taken = n; // those at the border are left out, all around
        std::vector<Vec3> out(places.by_cover.begin(),
                              places.by_cover.begin() + static_cast<std::ptrdiff_t>(taken));
        std::sort(out.begin(), out.end(), is_before);
        return thin_out_top(std::move(out), places.packing, n);
    }

    const ParticleBlock* block_of(std::uint32_t i) const
    {
        for (const ParticleBlock& block : particles_.blocks)
            if (rest_.ids[i] >= block.begin && rest_.ids[i] < block.begin + block.count)
                return &block;
        return nullptr;
    }

    /// Gives each mk the places that are most in its own fluid.
    void take(std::vector<Vec3> places)
    {
        struct Place
        {
            Vec3 at;
            std::uint64_t id;
            double level;
            RestRole role;
        };
        std::vector<Place> taken;
        std::vector<std::uint32_t> left = body_;
        while (!left.empty())
        {
            const ParticleBlock* block = block_of(left.front());
            const auto is_own = [&](std::uint32_t i) { return block_of(i) == block; };
            std::vector<std::uint64_t> ids;
            for (const std::uint32_t i : left)
                if (is_own(i)) ids.push_back(rest_.ids[i]);
            std::sort(ids.begin(), ids.end());
            std::erase_if(left, is_own);
            if (!left.empty())
            {
                std::vector<std::pair<double, std::size_t>> shares;
                for (std::size_t k = 0; k < places.size(); ++k)
                {
                    const double all = cover_.at(places[k], [](std::uint32_t) { return true; });
                    shares.emplace_back(all > 0 ? -cover_.at(places[k], is_own) / all : 0, k);
                }
                std::sort(shares.begin(), shares.end());
                std::vector<Vec3> sorted;
                for (const auto& [share, k] : shares) sorted.push_back(places[k]);
                places = std::move(sorted);
                std::sort(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(ids.size()),
                          is_before);
            }
            for (std::size_t k = 0; k < ids.size(); ++k)
            {
                const std::uint32_t old = cover_.nearest(places[k]);
                taken.push_back({places[k], ids[k], rest_.levels[old], rest_.roles[old]});
            }
            places.erase(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(ids.size()));
        }
        PointArrays points;
        points.resize(taken.size());
        rest_.set_in_dp([&](std::size_t k) { return taken[k].at; }, threads_, points);
        const std::vector<std::uint32_t> order = morton_order(points, 2, threads_);
        for (std::size_t k = 0; k < body_.size(); ++k)
        {
            const Place& place = taken[order[k]];
            rest_.positions[body_[k]] = place.at;
            rest_.ids[body_[k]] = place.id;
            rest_.levels[body_[k]] = place.level;
            rest_.roles[body_[k]] = place.role;
        }
    }

    FluidAtRest& rest_;
    const std::vector<std::uint32_t>& body_;
    const CaseParticles& particles_;
    const PackedWalls& walls_;
    Cover cover_;
    int threads_;
};

/// Fluid that is joined, body by body; indices ascend.
std::vector<std::vector<std::uint32_t>> bodies_of(const FluidAtRest& rest)
{
    std::vector<std::uint32_t> fluid;
    PointGrid grid(joined_dp * rest.dp, rest.size());
    for (std::uint32_t i = 0; i < rest.size(); ++i)
    {
        if (!rest.moves(i)) continue;
        fluid.push_back(i);
        grid.add(rest.positions[i]);
    }
    std::vector<std::vector<std::uint32_t>> out;
    std::vector<char> is_seen(fluid.size(), 0);
    for (std::uint32_t first = 0; first < fluid.size(); ++first)
    {
        if (is_seen[first] != 0) continue;
        is_seen[first] = 1;
        std::vector<std::uint32_t> body{first};
        for (std::size_t k = 0; k < body.size(); ++k)
            grid.for_each_near(grid.points()[body[k]], joined_dp * rest.dp,
                               [&](std::uint32_t other, double)
                               {
                                   if (is_seen[other] != 0) return;
                                   is_seen[other] = 1;
                                   body.push_back(other);
                               });
        for (std::uint32_t& k : body) k = fluid[k];
        std::sort(body.begin(), body.end());
        out.push_back(std::move(body));
    }
    return out;
}

} // namespace

std::optional<FluidAtRest> packed_stably(const FluidAtRest& rest, const CaseParticles& particles,
                                         const PackedWalls& walls, int threads)
{
    const std::optional<int> up = vertical_axis(rest);
    if (!up || std::count(rest.roles.begin(), rest.roles.end(), RestRole::Held) > 0)
        return std::nullopt;
    const std::optional<LayeredLattice> lattice =
        most_stable_lattice({rest.h / rest.dp, rest.is_cubic, rest.is_2d});
    if (!lattice) return std::nullopt;
    FluidAtRest out = rest;
    std::size_t packed = 0, all = 0;
    for (const std::vector<std::uint32_t>& body : bodies_of(rest))
    {
        all += body.size();
        if (BodyPacker(out, body, particles, walls, threads).pack(*up, lattice->ratio))
            packed += body.size();
    }
    if (packed == 0 || static_cast<double>(packed) < least_packed * static_cast<double>(all))
        return std::nullopt;
    return out;
}

} // namespace fppg
