#include "relax/part_pairs.h"

#include "core/parallel.h"
#include "meshes/crowded_points.h"
#include "meshes/point_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace fppg
{
namespace
{

constexpr int most_rounds_apart = 150;
/// Points this near to a pair give way, of the least distance.
constexpr double reach_of_pairs = 4;
/// Pairs are led so much farther apart than they must be: steps never quite arrive.
constexpr double margin_of_pairs = 1.01;
/// No step of a point is longer, of the least distance.
constexpr double longest_way_apart = 0.1;

/// The points that are near to pairs, which may move, before others that only push.
struct Crowd
{
    std::vector<std::uint32_t> points;
    std::size_t moving = 0;
};

Crowd find_crowd(const std::vector<Vec3>& places, std::size_t moving, double least, int threads)
{
    const std::vector<double> nearest = nearest_distances(places, least, threads);
    const double reach = reach_of_pairs * least;
    PointGrid pairs(reach, 64);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (nearest[i] < least) pairs.add(places[i]);
    Crowd out;
    if (pairs.points().empty()) return out;
    std::vector<char> is_near(places.size(), 0);
    parallel_for(
        places.size(), threads,
        [&](std::size_t i)
        { is_near[i] = static_cast<char>(pairs.has_nearer(places[i], reach) ? 1 : 0); },
        256);
    for (std::uint32_t i = 0; i < moving; ++i)
        if (is_near[i] != 0) out.points.push_back(i);
    out.moving = out.points.size();
    // Whoever moves does so by less than the margin between the two reaches.
    PointGrid movers(2 * least, out.moving);
    for (const std::uint32_t i : out.points) movers.add(places[i]);
    for (std::uint32_t i = 0; i < places.size(); ++i)
        if ((i >= moving || is_near[i] == 0) && movers.has_nearer(places[i], 2 * least))
            out.points.push_back(i);
    return out;
}

} // namespace

double part_pairs(std::vector<Vec3>& places, std::size_t moving, double least, const PutBeside& put,
                  int threads)
{
    const Crowd crowd = find_crowd(places, moving, least, threads);
    if (crowd.points.empty()) return least;
    const double wanted = margin_of_pairs * least;
    std::vector<Vec3> at;
    for (const std::uint32_t i : crowd.points) at.push_back(places[i]);
    std::vector<Vec3> best = at, next = at;
    double best_distance = 0;
    std::vector<double> nearest(crowd.moving);
    for (int round = 0; round <= most_rounds_apart; ++round)
    {
        PointGrid grid(wanted, at.size());
        for (const Vec3& p : at) grid.add(p);
        parallel_for(
            crowd.moving, threads,
            [&](std::size_t i)
            {
                Vec3 step;
                nearest[i] = wanted;
                grid.for_each_near(at[i], wanted,
                                   [&](std::uint32_t j, double squared)
                                   {
                                       if (i == j) return;
                                       const double distance = std::sqrt(squared);
                                       nearest[i] = std::min(nearest[i], distance);
                                       if (distance == 0) return;
                                       const double share = j < crowd.moving ? 0.5 : 1;
                                       step = step +
                                              (share * (wanted / distance - 1)) * (at[i] - at[j]);
                                   });
                const double length = norm(step);
                if (length > longest_way_apart * least)
                    step = (longest_way_apart * least / length) * step;
                next[i] = length > 0 ? put(crowd.points[i], at[i], at[i] + step) : at[i];
            },
            64);
        const double now = *std::min_element(nearest.begin(), nearest.end());
        if (round == 0 || now > best_distance)
        {
            best_distance = now;
            best = at;
        }
        if (now >= least) break;
        at.swap(next);
    }
    for (std::size_t i = 0; i < crowd.moving; ++i) places[crowd.points[i]] = best[i];
    return std::min(best_distance, least);
}

void put_back_crowded(std::vector<Vec3>& places, const std::vector<Vec3>& starts, double least,
                      int threads)
{
    bool is_changed = true;
    while (is_changed)
    {
        is_changed = false;
        const std::vector<double> nearest = nearest_distances(places, least, threads);
        for (std::size_t i = 0; i < places.size(); ++i)
        {
            if (nearest[i] >= least * (1 - 1e-9) || places[i] == starts[i]) continue;
            places[i] = starts[i];
            is_changed = true;
        }
    }
}

} // namespace fppg
