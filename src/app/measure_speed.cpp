#include "app/measure_speed.h"

#include "fppg/fit_mesh.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <numbers>

namespace fppg
{
namespace
{

/// Processor seconds of the ball on the machine of rates.h.
constexpr double reference_seconds = 0.232;

/// Of radius 1; rows of quads, cut in two.
TriangleSoup ball()
{
    constexpr int rows = 32;
    const auto at = [](int i, int j)
    {
        const double polar = std::numbers::pi * i / rows;
        const double around = std::numbers::pi * (j % (2 * rows)) / rows;
        return Vec3{std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                    std::cos(polar)};
    };
    TriangleSoup soup;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < 2 * rows; ++j)
        {
            if (i + 1 < rows)
                soup.vertices.insert(soup.vertices.end(),
                                     {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            if (i > 0)
                soup.vertices.insert(soup.vertices.end(),
                                     {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return soup;
}

double seconds_of_ball()
{
    FitMeshOptions options;
    options.dp = 0.014; // 64,000 particles
    const std::clock_t begin = std::clock();
    fit_mesh(ball(), options);
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

} // namespace

double measure_speed()
{
    double seconds = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 3; ++run) seconds = std::min(seconds, seconds_of_ball());
    return seconds / reference_seconds;
}

} // namespace fppg
