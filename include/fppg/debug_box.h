#pragma once

#include "fppg/vec.h"

#include <array>
#include <optional>
#include <string>

namespace fppg
{

/// The box of `fillbox`, `redrawbox` or `redrawnearbox`, for the picture that GenCase v5.4.354
/// writes of all boxes of a command (found by experiment, 35 small cases).
struct DebugBox
{
    std::string command;         ///< whose boxes stand in one file
    int mk = 0;                  ///< absolute; 0 void
    std::array<Vec3, 8> corners; ///< by bits x, y, z, where the matrix puts them; with `full`
                                 ///< limits those of the box that is dp larger on all sides
    std::optional<Vec3> seed;    ///< of fillbox
};

} // namespace fppg
