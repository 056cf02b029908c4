#pragma once

#include "fppg/balance.h"
#include "fppg/case_def.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"

#include "app/run_log.h"

#include <array>
#include <vector>

namespace fppg
{

std::array<double, 3> coordinates(const Vec3& p);

/// Prints limits, dp and nodes of the domain.
void log_domain(const CaseDef& def, RunLog& log);

/// Prints the volume of a cavity, and how far it was filled.
void log_fill(const CavityFilled& fill, RunLog& log);

/// Prints the blocks of particles, their sums, and the constants that follow from them, in the
/// words that callers of GenCase look for.
void log_particles(const CaseDef& def, const CaseParticles& particles,
                   const CaseConstants& constants, RunLog& log);

/// Prints what bringing fluid to rest came to.
void log_balance(const BalanceReport& report, RunLog& log);

/// What the summary of the zones of a case with `<vres>` says of one.
struct ZoneSummary
{
    double dp = 0; ///< metres
    int parent = -1;
    std::array<std::uint64_t, 4> counts{}; ///< fluid, fixed, moving, floating
    Box3 limits;                           ///< of its particles, metres
    CaseConstants constants;
};

/// Of the zone that def describes.
ZoneSummary summary_of_zone(const CaseDef& def, const CaseParticles& particles,
                            const CaseConstants& constants);

/// Prints the zones as a table, with their sums.
void log_zones(const std::vector<ZoneSummary>& zones, RunLog& log);

} // namespace fppg
