#include "core/parallel.h"
#include "files/particle_readers.h"
#include "files/vtk_walk.h"
#include "platform/file_map.h"

#include <fmt/format.h>
#include <array>
#include <bit>
#include <limits>

namespace fppg
{

namespace
{

template <typename Integer>
void copy_integers(const VtkWalk& walk, const char* name, const VtkArray& array, std::size_t n,
                   std::vector<Integer>& out, int threads)
{
    walk.expect_integers(name, array);
    const std::size_t width = width_of_vtk_type(array.type);
    out.resize(n);
    const auto copy = [&](std::size_t i)
    {
        const std::uint64_t value = big_endian_at(array.data.data() + i * width, width);
        if (value > std::numeric_limits<Integer>::max())
            walk.fail(fmt::format("array {} has {} at point {}", name, value, i));
        out[i] = static_cast<Integer>(value);
    };
    parallel_for(n, threads, copy, particles_per_chunk);
}

void copy_floats(const VtkWalk& walk, std::size_t n, ParticleCloud& cloud, int threads)
{
    // Beside NormalSize, "Normal" is the way to the boundary's surface.
    const VtkArray& normal = walk.has_sizes ? walk.wall_normal : walk.normal;
    if (!normal.type.empty())
    {
        walk.expect_floats(walk.has_sizes ? "WallNormal" : "Normal", normal);
        cloud.normals.resize(n);
        const auto copy = [&](std::size_t i)
        {
            const char* place = normal.data.data() + 12 * i;
            cloud.normals[i] = {float_at(place), float_at(place + 4), float_at(place + 8)};
        };
        parallel_for(n, threads, copy, particles_per_chunk);
    }
    if (!walk.distance.type.empty())
    {
        walk.expect_floats("Distance", walk.distance);
        cloud.distances.resize(n);
        const auto copy = [&](std::size_t i)
        { cloud.distances[i] = float_at(walk.distance.data.data() + 4 * i); };
        parallel_for(n, threads, copy, particles_per_chunk);
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
    parallel_for(n, threads, copy, particles_per_chunk);
    copy_integers(walk, "Mk", walk.mk, n, cloud.mk, threads);
    if (!walk.type.type.empty()) copy_integers(walk, "Type", walk.type, n, cloud.type, threads);
    if (!walk.kind.type.empty()) copy_integers(walk, "Kind", walk.kind, n, cloud.kind, threads);
    if (!walk.layer.type.empty()) copy_integers(walk, "Layer", walk.layer, n, cloud.layer, threads);
    copy_floats(walk, n, cloud, threads);
}

} // namespace fppg
