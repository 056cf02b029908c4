#pragma once

#include <string_view>

namespace fppg
{

/// Metres of a unit of length: m, cm, mm or in; 0: there is no such unit.
constexpr double metres_of_unit(std::string_view unit)
{
    return unit == "m" ? 1 : unit == "cm" ? 0.01 : unit == "mm" ? 0.001 : unit == "in" ? 0.0254 : 0;
}

} // namespace fppg
