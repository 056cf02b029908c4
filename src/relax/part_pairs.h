#pragma once

#include "fppg/vec.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace fppg
{

/// The place that a point, by index, may have near to a wanted one, on a way from where it is.
using PutBeside = std::function<Vec3(std::size_t, const Vec3& from, const Vec3& to)>;

/// Moves points that are too near to others apart, a little at a time, and those beside them out of
/// their way; points far from such pairs stay.
///
/// places  metres; the first `moving` of them may move
/// least   distance to reach, metres
/// returns the least distance to others of a point that may move, at most `least`; it is never less
///         than before
double part_pairs(std::vector<Vec3>& places, std::size_t moving, double least, const PutBeside& put,
                  int threads);

/// Puts points that came nearer to another one than `least`, metres, back to where they started,
/// and so on until none is left but those that were so near at first.
///
/// starts  of each of the places
void put_back_crowded(std::vector<Vec3>& places, const std::vector<Vec3>& starts, double least,
                      int threads);

} // namespace fppg
