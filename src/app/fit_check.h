#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"
#include "fppg/lattice.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fppg
{

class RunLog;

/// Bodies that are off for the same reason, for one sentence about all of them.
class DeviationGroup
{
public:
    /// mk     of the body
    /// share  what came out over what was expected, less 1
    /// most   about this body, taken where none of the group is farther off
    void add(int mk, double share, std::string most);
    bool is_empty() const { return mks_.empty(); }
    /// "mk 50: +4.1 %; ..." of one body, "mk 50-52,60: -3.1 % to +9.2 %, the most at mk 60; ..."
    std::string text(const std::string& name_of_mk) const;

private:
    std::vector<int> mks_;
    double least_ = 0;
    double greatest_ = 0;
    int mk_of_most_ = 0;
    double most_ = 0;
    std::string text_of_most_;
};

/// Whether what came out is farther off than what is told of volumes and
/// masses, 1 %.
bool is_off(double share);

/// Compares the particles of every fitted body with its shape, for the whole of it: what the domain
/// and later draws cut off counts as if it were there. Writes both to the log: the particles on its
/// surface against one per dp^2 and, of solids, the volume that they and the nodes inside stand for
/// (half of dp^3 each on the surface) against that of the shape.
///
/// returns  a warning for each reason why bodies are off, by more than 2 % in number on the surface
///          or 1 % in volume, with their mks and the dp that would do
std::vector<std::string> check_fit(const FitDef& settings, const FittedWalls& walls,
                                   const LatticeGrid& grid, RunLog& log);

} // namespace fppg
