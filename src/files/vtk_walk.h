#pragma once

#include <bit>
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>

namespace fppg
{

/// Bytes of a number of this VTK type; 0 for an unknown one.
std::size_t width_of_vtk_type(std::string_view type);

/// An array as it lies in the file, big-endian.
struct VtkArray
{
    std::string type;
    std::uint64_t count = 0;
    std::string_view data;
};

/// The unsigned number of `width` bytes at `place`.
inline std::uint64_t big_endian_at(const char* place, std::size_t width)
{
    std::uint64_t bits = 0;
    for (std::size_t b = 0; b < width; ++b)
        bits = bits << 8U | static_cast<unsigned char>(place[b]);
    return bits;
}

inline float float_at(const char* place)
{
    return std::bit_cast<float>(static_cast<std::uint32_t>(big_endian_at(place, 4)));
}

/// The arrays of a legacy binary VTK file (POLYDATA) that particles have; those it lacks have no
/// type. Views of the file's bytes.
class VtkWalk
{
public:
    VtkArray points, idp, mk, type, kind, normal, wall_normal, distance, layer, density, velocity;
    bool has_sizes = false; ///< an array NormalSize

    /// bytes   the whole file; must outlive the object
    /// path    for messages; must outlive the object
    /// throws  IoError if the file is not whole or not of this format
    VtkWalk(std::string_view bytes, const std::string& path);

    [[noreturn]] void fail(const std::string& text) const;

    /// Checks that an array has a number of whole type, of 4 bytes at most, for every point.
    void expect_integers(const char* name, const VtkArray& array) const;
    /// Checks that an array has a float, or several, for every point.
    void expect_floats(const char* name, const VtkArray& array) const;

private:
    std::string_view bytes_;
    const std::string& path_;
    std::size_t at_ = 0;
    std::uint64_t values_ = 0; ///< of every array of the present POINT_DATA or CELL_DATA
    bool is_of_points_ = false;

    bool is_at_end();
    std::string line();
    std::istringstream words();
    VtkArray data(const std::string& number_type, std::uint64_t count, std::uint64_t components);
    void keep(const std::string& name, const VtkArray& array, std::uint64_t components);
    void walk_part();
};

} // namespace fppg
