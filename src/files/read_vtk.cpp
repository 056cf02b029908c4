#include "core/file_map.h"
#include "core/parallel.h"
#include "files/particle_readers.h"
#include "fppg/error.h"

#include <fmt/format.h>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <sstream>
#include <string_view>

namespace fppg
{

namespace
{

constexpr std::size_t particles_a_chunk = 65536;

/// Bytes of a number of this VTK type; 0 for an unknown one.
std::size_t width_of(std::string_view type)
{
    if (type == "unsigned_char" || type == "char") return 1;
    if (type == "unsigned_short" || type == "short") return 2;
    if (type == "unsigned_int" || type == "int" || type == "float") return 4;
    if (type == "unsigned_long" || type == "long" || type == "double") return 8;
    return 0;
}

/// An array as it lies in the file, big-endian.
struct VtkArray
{
    std::string type;
    std::uint64_t count = 0;
    std::string_view data;
};

/// The unsigned number of `width` bytes at `place`.
std::uint64_t big_endian_at(const char* place, std::size_t width)
{
    std::uint64_t bits = 0;
    for (std::size_t b = 0; b < width; ++b)
        bits = bits << 8U | static_cast<unsigned char>(place[b]);
    return bits;
}

class VtkWalk
{
public:
    VtkArray points, mk, type, kind, normal, wall_normal, distance;
    bool has_sizes = false; ///< an array NormalSize

    VtkWalk(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path)
    {
        if (!line().starts_with("# vtk DataFile")) fail("it does not begin as a VTK file does");
        line(); // title
        if (line() != "BINARY") fail("only binary VTK files are read, this one is ASCII");
        if (line() != "DATASET POLYDATA") fail("its data set is not POLYDATA");
        while (!is_at_end()) walk_part();
    }

    [[noreturn]] void fail(const std::string& text) const
    {
        throw IoError(fmt::format("cannot read '{}': {}", path_, text));
    }

private:
    std::string_view bytes_;
    const std::string& path_;
    std::size_t at_ = 0;
    std::uint64_t values_ = 0; ///< of every array of the present POINT_DATA or CELL_DATA
    bool is_of_points_ = false;

    bool is_at_end()
    {
        while (at_ < bytes_.size() && bytes_[at_] == '\n') ++at_;
        return at_ >= bytes_.size();
    }
    std::string line()
    {
        const std::size_t end = bytes_.find('\n', at_);
        if (end == std::string_view::npos || end - at_ > 1000)
            fail(fmt::format("a line is expected at byte {}", at_));
        std::string text(bytes_.substr(at_, end - at_));
        at_ = end + 1;
        return text;
    }
    /// Words of the next line that is not empty.
    std::istringstream words()
    {
        if (is_at_end()) fail("it ends where an array is expected");
        return std::istringstream(line());
    }
    VtkArray data(const std::string& number_type, std::uint64_t count, std::uint64_t components)
    {
        const std::size_t width = width_of(number_type);
        if (width == 0) fail(fmt::format("an array has the unknown type \"{}\"", number_type));
        const std::uint64_t left = (bytes_.size() - at_) / width;
        if (components == 0 || count > left / components)
            fail(
                fmt::format("it ends at byte {}, within an array of {} values that begins at "
                            "byte {}",
                            bytes_.size(), count, at_));
        VtkArray array{number_type, count, bytes_.substr(at_, count * components * width)};
        at_ += array.data.size();
        return array;
    }
    void keep(const std::string& name, const VtkArray& array, std::uint64_t components)
    {
        if (!is_of_points_) return;
        if (name == "Normal" && components == 3) normal = array;
        if (name == "WallNormal" && components == 3) wall_normal = array;
        if (components != 1) return;
        if (name == "Mk") mk = array;
        if (name == "Type") type = array;
        if (name == "Kind") kind = array;
        if (name == "Distance") distance = array;
        if (name == "NormalSize") has_sizes = true;
    }

    void walk_part()
    {
        std::istringstream text = words();
        std::string key;
        std::string name;
        std::string number_type;
        std::uint64_t n = 0;
        std::uint64_t width = 1;
        text >> key;
        if (key == "POINTS")
        {
            text >> n >> number_type;
            points = data(number_type, n, 3);
        }
        else if (key == "VERTICES" || key == "LINES" || key == "POLYGONS")
        {
            text >> n >> width;
            data("int", width, 1);
        }
        else if (key == "POINT_DATA" || key == "CELL_DATA")
        {
            text >> values_;
            is_of_points_ = key == "POINT_DATA";
        }
        else if (key == "SCALARS")
        {
            text >> name >> number_type;
            if (!(text >> width)) width = 1;
            words(); // LOOKUP_TABLE
            keep(name, data(number_type, values_, width), width);
        }
        else if (key == "VECTORS" || key == "NORMALS")
        {
            text >> name >> number_type;
            data(number_type, values_, 3);
        }
        else if (key == "FIELD")
        {
            std::uint64_t fields = 0;
            text >> name >> fields;
            for (; fields > 0; --fields)
            {
                std::istringstream field = words();
                field >> name >> width >> n >> number_type;
                keep(name, data(number_type, n, width), width);
            }
        }
        else
            fail(fmt::format("the part \"{}\" before byte {} is unknown", key.substr(0, 40), at_));
    }
};

template <typename Integer>
void copy_integers(const VtkWalk& walk, const char* name, const VtkArray& array, std::size_t n,
                   std::vector<Integer>& out, int threads)
{
    const std::size_t width = width_of(array.type);
    if (array.count != n)
        walk.fail(fmt::format("array {} has {} values for {} points", name, array.count, n));
    if (array.type == "float" || array.type == "double" || width > 4)
        walk.fail(fmt::format("array {} has the type {}, expected integers", name, array.type));
    out.resize(n);
    const auto copy = [&](std::size_t i)
    {
        const std::uint64_t value = big_endian_at(array.data.data() + i * width, width);
        if (value > std::numeric_limits<Integer>::max())
            walk.fail(fmt::format("array {} has {} at point {}", name, value, i));
        out[i] = static_cast<Integer>(value);
    };
    parallel_for(n, threads, copy, particles_a_chunk);
}

float float_at(const char* place)
{
    return std::bit_cast<float>(static_cast<std::uint32_t>(big_endian_at(place, 4)));
}

/// Checks that an array has a float, or several, for every point.
void expect_floats(const VtkWalk& walk, const char* name, const VtkArray& array, std::size_t n)
{
    if (array.count != n)
        walk.fail(fmt::format("array {} has {} values for {} points", name, array.count, n));
    if (array.type != "float")
        walk.fail(fmt::format("array {} has the type {}, expected float", name, array.type));
}

void copy_floats(const VtkWalk& walk, std::size_t n, ParticleCloud& cloud, int threads)
{
    // Beside NormalSize, "Normal" is the way to the boundary's surface.
    const VtkArray& normal = walk.has_sizes ? walk.wall_normal : walk.normal;
    if (!normal.type.empty())
    {
        expect_floats(walk, walk.has_sizes ? "WallNormal" : "Normal", normal, n);
        cloud.normals.resize(n);
        const auto copy = [&](std::size_t i)
        {
            const char* place = normal.data.data() + 12 * i;
            cloud.normals[i] = {float_at(place), float_at(place + 4), float_at(place + 8)};
        };
        parallel_for(n, threads, copy, particles_a_chunk);
    }
    if (!walk.distance.type.empty())
    {
        expect_floats(walk, "Distance", walk.distance, n);
        cloud.distances.resize(n);
        const auto copy = [&](std::size_t i)
        { cloud.distances[i] = float_at(walk.distance.data.data() + 4 * i); };
        parallel_for(n, threads, copy, particles_a_chunk);
    }
}

} // namespace

void read_particles_vtk(const std::string& path, ParticleCloud& cloud, int threads)
{
    const FileMap file(path);
    const VtkWalk walk(file.bytes(), path);
    const std::size_t n = walk.points.count;
    const bool is_double = walk.points.type == "double";
    if (n > 0 && !is_double && walk.points.type != "float")
        walk.fail(
            fmt::format("its points have the type {}, expected float or double", walk.points.type));
    if (walk.mk.type.empty()) walk.fail("it has no point data Mk");
    cloud.positions.resize(n);
    const auto copy = [&](std::size_t i)
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            const std::size_t place = 3 * i + static_cast<std::size_t>(axis);
            const char* data = walk.points.data.data();
            cloud.positions[i][axis] =
                is_double ? std::bit_cast<double>(big_endian_at(data + 8 * place, 8))
                          : static_cast<double>(float_at(data + 4 * place));
        }
    };
    parallel_for(n, threads, copy, particles_a_chunk);
    copy_integers(walk, "Mk", walk.mk, n, cloud.mk, threads);
    if (!walk.type.type.empty()) copy_integers(walk, "Type", walk.type, n, cloud.type, threads);
    if (!walk.kind.type.empty()) copy_integers(walk, "Kind", walk.kind, n, cloud.kind, threads);
    copy_floats(walk, n, cloud, threads);
}

} // namespace fppg
