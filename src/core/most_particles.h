#pragma once

#include <cmath>
#include <cstdint>

namespace fppg
{

/// Ids in Case.bi4 are 32-bit numbers, the last of which means none.
constexpr std::uint64_t most_particles = 4294967294U;
constexpr const char* most_particles_text = "4,294,967,294";

/// A particle distance with two digits, not below the one given.
inline double dp_rounded_up(double dp)
{
    const double digit = std::pow(10, std::floor(std::log10(dp)) - 1);
    return std::ceil(dp / digit * (1 - 1e-12)) * digit;
}

/// A particle distance that gives few enough where `dp` gives `count`: that of a case of surfaces
/// alone, as volumes need no larger one.
inline double dp_that_fits(double dp, double count, bool is_2d,
                           double most = static_cast<double>(most_particles))
{
    return dp_rounded_up(dp * std::pow(count / most, is_2d ? 1.0 : 1.0 / 2));
}

} // namespace fppg
