#pragma once

#include "fppg/vec.h"

#include <fmt/format.h>

#include <string>

namespace fppg
{

/// A place for messages: "(1, 0.5, 0)".
inline std::string text(const Vec3& p)
{
    return fmt::format("({:g}, {:g}, {:g})", p.x, p.y, p.z);
}

} // namespace fppg
