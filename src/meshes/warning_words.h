#pragma once

#include <cstddef>
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

/// "1 edge", "2 edges"
inline std::string counted(std::size_t n, const char* one, const char* many)
{
    return fmt::format("{} {}", n, n == 1 ? one : many);
}

} // namespace fppg
