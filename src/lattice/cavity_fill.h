#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"

#include "nodes/spans.h"

#include <string>
#include <vector>

namespace fppg
{

/// What a fill says, without its place in the definition.
struct CavityFillReport
{
    CavityFilled filled;               ///< without line and log
    std::vector<std::string> log;      ///< volume of the cavity, level, what was filled; its gaps
    std::vector<std::string> warnings; ///< whole sentences
};

/// The nodes that a fill of a cavity paints; one entry per slab.
///
/// throws GeometryError, without the place of the draw: as find_cavity(), and for a cavity that is
///        not closed where the fill would run out, or whose volume it needs (percent); the text
///        says where the lowest way out is and where it is narrowest
std::vector<Spans> fill_cavity(const RunField& field, const CavityFillOp& op, int threads,
                               CavityFillReport& report);

} // namespace fppg
