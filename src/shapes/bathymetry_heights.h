#pragma once

#include "fppg/vec.h"

#include <vector>

namespace fppg
{

/// Heights on the nodes of a grid from scattered points, in three steps (found by experiment with
/// GenCase v5.4.354: the weights of all points were read off at every node of five sets of points):
/// 1. A node on a point (to 1e-6 of the spacing) takes its height. A node that has a point in each
///    of its four quadrants, axes included, takes the nearest of each: the two below are
///    interpolated at the node's x, and so the two above; between both heights it is interpolated
///    at the node's y. On points that are a lattice this is bilinear.
/// 2. A node that is left takes the height of the nearest point if that is not farther than
///    `spacing`.
/// 3. The nodes that are left are filled from their known neighbours (of eight), pass by pass: the
///    mean with the neighbours' distances as weights.
/// GenCase finds the quadrants' points only within the 3 x 3 cells of its own sorting of the points
/// and never in the first and last row of these cells; it takes step 2 and 3 for those nodes. Here
/// they are interpolated, so heights between points near the border of the data differ. Of 81 nodes
/// of one set of 34 random points 53 are equal, all of them away from the border.
///
/// points   at least one, finite
/// xs, ys   rising lines of the grid
/// spacing  metres, of the grid
/// returns  z[j * xs.size() + i] at (xs[i], ys[j]); the same for any number of threads
/// cost     O(nodes) where the points are spread evenly, and O(passes * nodes) outside them
std::vector<double> heights_at(const std::vector<Vec3>& points, const std::vector<double>& xs,
                               const std::vector<double>& ys, double spacing, int threads);

} // namespace fppg
