#pragma once

#include <string>

#include <fmt/format.h>

#include "fppg/vec.h"

namespace fppg
{

/// "near (x, y, z)"
inline std::string near(const Vec3& p)
{
    return fmt::format("near ({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

} // namespace fppg
