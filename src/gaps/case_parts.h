#pragma once

#include "fppg/case_def.h"
#include "fppg/motion_gaps.h"
#include "leak/case_solids.h"
#include "meshes/surface_gap.h"
#include "particles/motion_path.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// All that is drawn with one boundary mk.
struct CasePart
{
    std::uint16_t mkbound = 0;
    std::string name;
    std::vector<const CaseShape*> shapes;
    std::unique_ptr<GapTree> tree;
    /// Where it is at a time, as a map of its places at the start; without motion it stands.
    std::optional<MotionChain> motion;
    bool is_followed = true; ///< a file moves it otherwise

    Transform place(double time) const;
};

/// The boundary mks that draw surfaces, by mkbound.
std::vector<CasePart> case_parts(const CaseDef& def, const CaseSolids& solids,
                                 std::vector<std::string>& notes);

/// A case whose gaps are asked for.
struct GapCase
{
    CaseDef def;
    CaseSolids solids;
    std::vector<CasePart> parts;
    double end = 0;                 ///< seconds
    std::vector<std::string> notes; ///< what could not be judged
};

/// throws  as measure_motion_gaps()
GapCase read_gap_case(const std::string& definition, const MotionGapOptions& options);

/// Of a rotation and a move.
Transform inverse_of(const Transform& t);

} // namespace fppg
