#pragma once

#include "core/parallel.h"
#include "fppg/vec.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fppg
{

/// The median of the distances from some particles, evenly spread over the file, to the nearest
/// particle that is not at the same place; 1 where there is none.
///
/// position  of the particle of an index, metres
template <typename Position>
double typical_distance(std::size_t n, const Position& position, int threads)
{
    const std::size_t samples = std::min<std::size_t>(n, 65);
    if (samples == 0) return 1;
    std::vector<double> squares(samples);
    const auto find_nearest = [&](std::size_t s)
    {
        const Vec3 from = position(s * n / samples);
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < n; ++i)
        {
            const Vec3 way = position(i) - from;
            const double square = dot(way, way);
            if (square > 0 && square < nearest) nearest = square;
        }
        squares[s] = nearest;
    };
    parallel_for(samples, threads, find_nearest);
    std::nth_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(samples / 2),
                     squares.end());
    const double distance = std::sqrt(squares[samples / 2]);
    return std::isfinite(distance) ? distance : 1;
}

} // namespace fppg
