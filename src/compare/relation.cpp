#include "compare/relation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

constexpr std::uint64_t least_particles = 100;

/// Of the space that two boxes cover together, the part that is in both; they grow by dp, so that
/// flat ones have some.
double shared_part(Box3 a, Box3 b, double dp)
{
    double both = 1;
    double of_a = 1;
    double of_b = 1;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double low = std::max(a.min[axis], b.min[axis]);
        const double high = std::min(a.max[axis], b.max[axis]);
        both *= std::max(0.0, high - low + dp);
        of_a *= a.max[axis] - a.min[axis] + dp;
        of_b *= b.max[axis] - b.min[axis] + dp;
    }
    return both / (of_a + of_b - both);
}

} // namespace

bool is_on_lattice(const ParticleSource& source, double dp)
{
    constexpr std::size_t samples = 20000;
    constexpr std::size_t least_off = 20;
    constexpr double rounding = 1e-3;
    if (source.size() == 0) return true;
    const Vec3 origin = source.position(0);
    const std::size_t step = std::max<std::size_t>(1, source.size() / samples);
    std::size_t all = 0;
    std::size_t off = 0;
    for (std::size_t i = 0; i < source.size(); i += step, ++all)
    {
        const Vec3 from = (source.position(i) - origin) / dp;
        bool is_off = false;
        for (int axis = 0; axis < 3; ++axis)
            is_off = is_off || std::abs(from[axis] - std::round(from[axis])) > rounding;
        off += static_cast<std::size_t>(is_off);
    }
    return off < least_off || 1000 * off <= all;
}

std::string why_unrelated(const Comparison& comparison)
{
    const ComparedFile& a = comparison.files[0];
    const ComparedFile& b = comparison.files[1];
    if (std::min(a.np, b.np) < least_particles) return "";
    if (std::none_of(comparison.mks.begin(), comparison.mks.end(),
                     [](const MkComparison& of) { return of.count[0] > 0 && of.count[1] > 0; }))
        return "they have no mk in common";
    const double part = shared_part(a.bounds, b.bounds, comparison.dp);
    const bool has_other_dp = a.dp > 0 && b.dp > 0 && std::abs(a.dp - b.dp) > 1e-3 * a.dp;
    if (part >= (has_other_dp ? 0.5 : 0.1)) return "";
    return fmt::format(
        "the boxes around their particles share {:.2g} % of the space that they "
        "cover{}",
        100 * part,
        has_other_dp ? fmt::format(", and dp is {:g} m in one, {:g} m in the other", a.dp, b.dp)
                     : "");
}

} // namespace fppg
