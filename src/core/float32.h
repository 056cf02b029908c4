#pragma once

#include "fppg/vec.h"

namespace fppg
{

/// The nearest float32, ties to even. Through memory: at -O2 and above g++ 12 drops the rounding of
/// one or two of three coordinates that it takes together (seen in corners of facets and of meshes
/// cut at their domain).
inline double as_float32(double value)
{
    const volatile float f = static_cast<float>(value);
    return static_cast<double>(f);
}

inline Vec3 as_float32(const Vec3& p)
{
    return {as_float32(p.x), as_float32(p.y), as_float32(p.z)};
}

} // namespace fppg
