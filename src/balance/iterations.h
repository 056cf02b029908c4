#pragma once

#include <algorithm>
#include <cstddef>

namespace fppg
{

// How many iterations balance_fluid() makes.

/// Rows that do not fit a curved wall slide into better places for hundreds (cases/rest in layers
/// at dp 0.0125 m, mean speed after 0.3 s: 0.0007 m/s with 400, 0.0006 with 1000).
inline constexpr int most_iterations = 1000;
inline constexpr int least_most_iterations =
    100;                                 ///< of particles that would need more than most_work
inline constexpr double most_work = 1e8; ///< particles times iterations
/// Less is made all the same, however little it gains.
inline constexpr double least_work = 5e6;
/// Fluid of the case's own lattice that has settled by then keeps what it has.
inline constexpr int first_settled = 30;

/// The most that are made.
inline int last_iteration(std::size_t particles)
{
    return std::clamp(static_cast<int>(most_work / static_cast<double>(particles)),
                      least_most_iterations, most_iterations);
}

/// Those that most cases with curved walls take; where these are hard to fit it is up to twice as
/// many.
inline int usual_iterations(std::size_t particles)
{
    constexpr int of_many = 60;
    return std::clamp(static_cast<int>(least_work / static_cast<double>(particles)), of_many,
                      most_iterations);
}

} // namespace fppg
