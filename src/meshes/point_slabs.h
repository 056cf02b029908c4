#pragma once

#include "fppg/vec.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace fppg
{

/// Points between two planes across an axis, so that many can be worked on piece by piece.
struct PointSlab
{
    int axis = 0;
    /// Metres; of the first and the last slab without end.
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    std::vector<std::uint32_t> members; ///< by index, rising
};

/// Cuts points into slabs of about equal numbers, across the longest side of their box.
///
/// which     the points that count, by index, rising
/// about     points in a slab, above 0; more where they would be thinner than `thinnest`
/// thinnest  metres
/// cost      O(n), 4 bytes for each of them
std::vector<PointSlab> cut_into_slabs(const std::vector<Vec3>& points,
                                      const std::vector<std::uint32_t>& which, std::size_t about,
                                      double thinnest);

} // namespace fppg
