#include "relax/fit_count.h"

#include "core/parallel.h"
#include "meshes/point_grid.h"
#include "relax/kernel.h"
#include "relax/volume_forces.h"
#include "relax/wall_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fppg
{

namespace
{

/// A stretch of this many particles that together make up for less than half of one is even enough.
constexpr std::size_t even_stretch = 40;
/// Where the number is known, sums of less are those of the planes that stand for walls.
constexpr float least_excess = 0.04F;

/// The share of the kernel's integral that is farther than a radius, by the rule of rectangles.
double share_beyond(double radius, double h, bool is_2d)
{
    constexpr int steps = 200;
    const double width = (2 * h - radius) / steps;
    double sum = 0;
    for (int n = 0; width > 0 && n < steps; ++n)
    {
        const double r = radius + (n + 0.5) * width;
        const double w = wendland(r / h) * width;
        sum += is_2d ? wendland_alpha_2d(h) * w * 2 * std::numbers::pi * r
                     : wendland_alpha_3d(h) * w * 4 * std::numbers::pi * r * r;
    }
    return sum;
}

/// The Shepard sum over the nodes of the cubic lattice within a radius and from this one along x
/// on.
double lattice_sum(double h, double radius, int first_x, bool is_2d)
{
    const int reach = static_cast<int>(2 * h);
    double sum = 0;
    for (int x = std::max(first_x, -reach); x <= reach; ++x)
        for (int y = is_2d ? 0 : -reach; y <= (is_2d ? 0 : reach); ++y)
            for (int z = -reach; z <= reach; ++z)
                if (const double r = std::sqrt(x * x + y * y + z * z); r < radius)
                    sum += wendland(r / h);
    return (is_2d ? wendland_alpha_2d(h) : wendland_alpha_3d(h)) * sum;
}

/// How sums for the count are made.
struct CountSums
{
    VolumeForces wide;
    double radius = 0;  ///< of the particles that count, dp
    double cut_off = 0; ///< the share of the kernel beyond it, taken as even
    double even = 0;    ///< of the lattice, which the bulk beyond the band keeps
};

/// Beside walls with particles on their surface in 3D, sums are over particles nearer than this, in
/// h: lists end at 2 h, where a lattice has nodes, and chance says whether these are in them: 0.009
/// too much for each particle of a lattice that has them, which took particles out of water that
/// fits as it is.
constexpr double count_radius_h = 1.95;

/// How far behind walls with particles on them the medium begins for sums to be even beside flat
/// rows of a lattice: half a dp behind, which is right in the mean over all ways in which particles
/// may stand to one another, sums are 0.007 too large there, twice that along edges.
double behind_even_rows(const CountSums& sums, double h)
{
    const HalfSpace beyond(h, false);
    const double rest = sums.even - sums.cut_off - lattice_sum(h, sums.radius, -1, false);
    double near = 0;
    double far = beyond.reach() - 1;
    for (int n = 0; n < 50; ++n)
    {
        const double middle = (near + far) / 2;
        (beyond.share(1 + middle) > rest ? near : far) = middle;
    }
    return near;
}

/// At h 1.3 times as large: there the sum over even particles is the same to a few thousandths,
/// however they are arranged.
CountSums count_sums(const RelaxVolumeOptions& options)
{
    constexpr double wider = 1.3;
    const double h = wider * options.h_dp;
    const bool is_beside_rows = !options.is_2d && options.behind_wall_dp > 0;
    const double listed = list_radius(options.h_dp);
    CountSums out{VolumeForces(h, options.behind_wall_dp, options.is_2d),
                  is_beside_rows ? count_radius_h * options.h_dp : 2 * listed};
    out.cut_off = share_beyond(std::min(out.radius, listed), h, options.is_2d);
    out.even = lattice_sum(h, 2 * h, std::numeric_limits<int>::min(), options.is_2d);
    if (is_beside_rows) out.wide = VolumeForces(h, behind_even_rows(out, h), false);
    return out;
}

/// How far the Shepard sum of a particle is from that of the lattice. Near to a free surface, where
/// the sum tells nothing, it is 0.
double excess_at(const Band& band, std::uint32_t i, std::span<const std::uint32_t> near,
                 const CountSums& sums, std::vector<std::uint32_t>& counted)
{
    counted.clear();
    const auto radius = static_cast<float>(sums.radius);
    for (const std::uint32_t j : near)
    {
        if (j < band.moving && band.is_held[j] != 0) return 0;
        const float x = band.points.x[j] - band.points.x[i];
        const float y = band.points.y[j] - band.points.y[i];
        const float z = band.points.z[j] - band.points.z[i];
        if (x * x + y * y + z * z < radius * radius) counted.push_back(j);
    }
    const std::size_t n = counted.size();
    counted.resize(n + 7, i); // sums take them by eights
    return sums.wide.on(band, i, std::span(counted).first(n)).shepard + sums.cut_off - sums.even;
}

/// The place beside a particle that is farthest from others, among 26 directions (8 in 2D); the
/// particle's own where all are too near to others or to a wall, or no particle may come there.
Vec3 gap_beside(const Band& band, std::uint32_t i, std::span<const std::uint32_t> near,
                const RelaxVolumeOptions& options, const VolumeSurroundings& surroundings)
{
    constexpr double length = 0.75;
    constexpr double least_gap = 0.5;
    double widest = least_gap;
    Vec3 best = band.place(i);
    for (int number = 0; number < 27; ++number)
    {
        const int x = number % 3 - 1, y = number / 3 % 3 - 1, z = number / 9 - 1;
        Vec3 direction{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
        if (number == 13 || (options.is_2d && direction.y != 0)) continue;
        direction = direction / norm(direction);
        double gap = 2;
        for (const std::uint32_t j : near)
            gap = std::min(gap, norm(Vec3{double{band.points.x[j]} - double{band.points.x[i]},
                                          double{band.points.y[j]} - double{band.points.y[i]},
                                          double{band.points.z[j]} - double{band.points.z[i]}} -
                                     length * direction));
        // A gap must be wider by more than rounding, so that equal ones do not hang on it.
        if (gap < widest + 1e-3) continue;
        const Vec3 place = band.place(i) + (band.dp * length) * direction;
        const double off_walls =
            std::min(options.min_wall_distance_dp + 0.05,
                     static_cast<double>(band.wall_distances[i] - band.moved_by(i)));
        // Nearer than this a wall is met, and steps would become ever shorter.
        if (!is_way_free(band.place(i), place, std::max(off_walls, 1e-3) * band.dp,
                         surroundings.closest))
            continue;
        if (surroundings.may_come && !surroundings.may_come(band.sources[i], place)) continue;
        widest = gap;
        best = place;
    }
    return best;
}

/// Takes removed particles out of an array and puts inserted ones behind those that stay.
template <typename T, typename Value>
void change_array(std::vector<T>& array, const CountChange& change, const Value& inserted)
{
    const std::size_t moving = change.is_removed.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < moving; ++i)
        if (change.is_removed[i] == 0) array[kept++] = array[i];
    std::vector<T> come;
    for (const CountChange::Inserted& one : change.inserted) come.push_back(inserted(one));
    array.erase(array.begin() + static_cast<std::ptrdiff_t>(kept),
                array.begin() + static_cast<std::ptrdiff_t>(moving));
    // Room for no more than these: doubling would cost more than all that is done here.
    array.reserve(array.size() + come.size());
    array.insert(array.begin() + static_cast<std::ptrdiff_t>(kept), come.begin(), come.end());
}

} // namespace

namespace
{

/// So much of those that may move come or go at most for the number wanted, where others stay
/// around them: a few particles in a narrow place cannot make up for a body.
constexpr double most_change = 0.25;

/// Spreads what the number wanted differs from what fills the space evenly over all particles.
///
/// most  of a particle, for each of them
void add_bias(const Band& band, double wanted, double most, std::vector<float>& excess)
{
    double sum = 0;
    std::size_t count = 0;
    for (const float e : excess)
    {
        if (e == 0) continue;
        sum += static_cast<double>(e);
        ++count;
    }
    if (count == 0) return;
    const double too_many = static_cast<double>(band.moving) - wanted;
    const auto bias =
        static_cast<float>(std::clamp((too_many - sum) / static_cast<double>(count), -most, most));
    for (float& e : excess)
        if (e != 0) e += bias;
}

/// Takes or gives what the number is still off, where particles are the most crowded or the most
/// apart, each 2 dp from the others.
void make_up_rest(const Band& band, const NeighbourList& list, const std::vector<float>& excess,
                  const RelaxVolumeOptions& options, const VolumeSurroundings& surroundings,
                  CountChange& change)
{
    constexpr double apart = 2;
    const double now = static_cast<double>(band.moving + change.inserted.size()) -
                       static_cast<double>(change.removed);
    const double too_many = std::round(now - *options.wanted);
    if (too_many == 0) return;
    std::vector<std::size_t> rows; // a heap: only the first few are needed
    PointGrid changed(apart, change.removed + change.inserted.size());
    const auto place_of = [&](std::uint32_t i) {
        return Vec3{band.points.x[i], band.points.y[i], band.points.z[i]};
    };
    for (std::size_t row = 0; row < list.rows(); ++row)
    {
        const std::uint32_t i = list.point(row);
        if (i >= band.moving || excess[i] == 0) continue;
        if (change.is_removed[i] != 0)
            changed.add(place_of(i));
        else
            rows.push_back(row);
    }
    for (const CountChange::Inserted& one : change.inserted) changed.add(place_of(one.beside));
    const float sign = too_many > 0 ? 1.0f : -1.0f;
    const auto is_later = [&](std::size_t a, std::size_t b)
    {
        const float of_a = sign * excess[list.point(a)], of_b = sign * excess[list.point(b)];
        return of_a != of_b ? of_a < of_b : a > b;
    };
    std::make_heap(rows.begin(), rows.end(), is_later);
    auto left = static_cast<std::size_t>(std::abs(too_many));
    if (options.least_pair_dp > 0)
        left = std::min(left,
                        static_cast<std::size_t>(most_change * static_cast<double>(rows.size())));
    while (!rows.empty() && left > 0)
    {
        std::pop_heap(rows.begin(), rows.end(), is_later);
        const std::size_t row = rows.back();
        rows.pop_back();
        const std::uint32_t i = list.point(row);
        const Vec3 here = place_of(i);
        if (changed.has_nearer(here, apart)) continue;
        if (too_many > 0)
        {
            change.is_removed[i] = 1;
            ++change.removed;
        }
        else
        {
            const Vec3 place = gap_beside(band, i, list.neighbours(row), options, surroundings);
            if (place == band.place(i)) continue;
            change.inserted.push_back({i, place});
        }
        changed.add(here);
        --left;
    }
}

} // namespace

CountChange find_count_change(const Band& band, const NeighbourList& list,
                              const RelaxVolumeOptions& options,
                              const VolumeSurroundings& surroundings, bool is_last, int threads)
{
    const CountSums sums = count_sums(options);
    std::vector<float> excess(band.moving, 0.0f);
    parallel_for(
        list.rows(), threads,
        [&](std::size_t row)
        {
            thread_local std::vector<std::uint32_t> counted;
            const std::uint32_t i = list.point(row);
            if (i >= band.moving || band.is_held[i] != 0 || band.slides[i] != VolumeMotion::Free)
                return;
            excess[i] = static_cast<float>(excess_at(band, i, list.neighbours(row), sums, counted));
        },
        NeighbourList::rows_per_chunk);
    CountChange change;
    change.is_removed.assign(band.moving, 0);
    if (options.wanted)
        add_bias(band, *options.wanted,
                 options.least_pair_dp > 0 ? most_change : std::numeric_limits<double>::max(),
                 excess);
    double sum = 0;
    std::size_t highest = list.rows();
    std::size_t lowest = list.rows();
    std::size_t length = 0;
    for (std::size_t row = 0; row < list.rows() && !is_last; ++row)
    {
        const std::uint32_t at = list.point(row);
        if (at >= band.moving || excess[at] == 0) continue;
        ++length;
        sum += static_cast<double>(excess[at]);
        if (highest == list.rows() || excess[at] > excess[list.point(highest)]) highest = row;
        if (lowest == list.rows() || excess[at] < excess[list.point(lowest)]) lowest = row;
        if (std::abs(sum) < 0.5) continue;
        if (length > even_stretch && !options.wanted)
            sum = 0;
        else if (options.wanted &&
                 std::abs(excess[list.point(sum > 0 ? highest : lowest)]) < least_excess)
            sum = 0;
        else if (sum > 0)
        {
            change.is_removed[list.point(highest)] = 1;
            ++change.removed;
            sum -= 1;
        }
        else
        {
            const std::uint32_t i = list.point(lowest);
            const Vec3 place = gap_beside(band, i, list.neighbours(lowest), options, surroundings);
            if (!(place == band.place(i))) change.inserted.push_back({i, place});
            sum += 1;
        }
        length = 0;
        highest = lowest = list.rows();
    }
    if (options.wanted) make_up_rest(band, list, excess, options, surroundings, change);
    return change;
}

void change_count(Band& band, const CountChange& change)
{
    using Inserted = CountChange::Inserted;
    const auto place = [&](const Inserted& one) { return (one.place - band.origin) / band.dp; };
    const auto zero = [](const Inserted&) { return 0.0f; };
    change_array(band.points.x, change,
                 [&](const Inserted& one) { return static_cast<float>(place(one).x); });
    change_array(band.points.y, change,
                 [&](const Inserted& one) { return static_cast<float>(place(one).y); });
    change_array(band.points.z, change,
                 [&](const Inserted& one) { return static_cast<float>(place(one).z); });
    for (auto* array :
         {&band.velocities.x, &band.velocities.y, &band.velocities.z, &band.moved.y, &band.moved.z,
          &band.wall_distances, &band.wall_normals.x, &band.wall_normals.y, &band.wall_normals.z})
        change_array(*array, change, zero);
    // As if moved far from a wall that was near: walls are looked for before it moves.
    change_array(band.moved.x, change, [](const Inserted&) { return 1.0f; });
    const std::vector<std::uint32_t> sources = band.sources;
    change_array(band.sources, change, [&](const Inserted& one) { return sources[one.beside]; });
    change_array(band.is_inserted, change, [](const Inserted&) { return char{1}; });
    change_array(band.is_held, change, [](const Inserted&) { return char{0}; });
    change_array(band.slides, change, [](const Inserted&) { return VolumeMotion::Free; });
    change_array(band.light_looks, change, [](const Inserted&) { return char{0}; });
    change_array(band.meetings, change, [](const Inserted&) { return no_meeting; });
    band.volume_end += band.sources.size() - band.moving;
    band.moving = band.sources.size();
}

} // namespace fppg
