#pragma once

#include "fppg/scene.h"

#include <string>
#include <vector>

namespace fppg
{

/// A shape file that `shapeout` asks for, before its shapes are made.
struct ShapeFileDraws
{
    std::string stem; ///< behind the case name: "_name_Actual", "_name_Dp"
    ShapeFormat format{};
    bool is_snapped = false;          ///< corners on the lattice
    double normal_dp = 0;             ///< length of the lines of savenormal; 0: none
    std::vector<const DrawOp*> draws; ///< that leave shapes in it

    std::string name() const; ///< with its ending, as ShapeFile::name
};

/// The shape files of a case in the order of their `shapeout`s; of two with one name the later one
/// counts.
std::vector<ShapeFileDraws> shape_file_draws(const Scene& scene);

} // namespace fppg
