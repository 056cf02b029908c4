#pragma once

#include "fppg/compare.h"
#include "fppg/mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fppg
{

/// What compare_results() measures of each file, of one result alone.
struct MeasuredMk
{
    std::uint16_t mk = 0;
    int type = -1; ///< as ParticleType; -1: the file does not say
    std::uint64_t count = 0;
    std::uint64_t alone = 0; ///< without one within 2.6 dp, not in the statistics
    Statistics spacing_dp, shepard, distance_dp;
};

struct MeasuredResult
{
    std::string path; ///< of the particles
    double dp = 0;    ///< metres
    std::uint64_t np = 0;
    Box3 bounds;
    bool is_2d = false;
    std::vector<MeasuredMk> mks; ///< by mk
};

/// name      as read_particles() takes it
/// geometry  facets in the place of the particles; may be empty
/// throws    CompareError as compare_results()
/// cost      as compare_results(), half the time and memory
MeasuredResult measure_result(const std::string& name, const TriangleSoup& geometry,
                              std::uint64_t particles_at_once, int threads);

} // namespace fppg
