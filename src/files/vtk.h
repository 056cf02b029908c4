#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

namespace fppg
{

/// The first lines of a legacy binary VTK file with polygonal data.
inline constexpr const char* vtk_head =
    "# vtk DataFile Version 3.0\nvtk output\nBINARY\nDATASET POLYDATA\n";

inline std::uint32_t big_endian(std::uint32_t value)
{
    static_assert(std::endian::native == std::endian::little, "legacy VTK is big-endian");
    return __builtin_bswap32(value);
}
inline std::uint32_t big_endian(float value)
{
    return big_endian(std::bit_cast<std::uint32_t>(value));
}
inline std::uint64_t big_endian(double value)
{
    return __builtin_bswap64(std::bit_cast<std::uint64_t>(value));
}
inline std::uint16_t big_endian(std::uint16_t value)
{
    return __builtin_bswap16(value);
}

/// Appends a number as VTK keeps it.
template <typename T>
void append_big_endian(std::string& out, T value)
{
    const auto swapped = big_endian(value);
    out.append(reinterpret_cast<const char*>(&swapped), sizeof swapped);
}

} // namespace fppg
