#pragma once

#include "fppg/vec.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace fppg
{

/// The distance from each point to the nearest other one, or `reach` where none is nearer, metres.
std::vector<double> nearest_distances(const std::vector<Vec3>& points, double reach, int threads);

/// Which points have to go so that no two that stay are nearer than a distance to each other, but
/// for 1e-4 of it (rounding of files).
///
/// rank      per point: of two that are too near the one of lower rank stays, of equal ones the
///           first
/// may_stay  empty, or whether two points by index may be nearer than that
/// returns   per point 1: it goes
/// cost      O(n)
std::vector<char> find_crowded(const std::vector<Vec3>& points,
                               const std::vector<std::uint32_t>& rank, double distance,
                               const std::function<bool(std::size_t, std::size_t)>& may_stay,
                               int threads);

} // namespace fppg
