#pragma once

#include "files/helpers.h"
#include "files/vtk.h"
#include "fppg/compare.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace fppg
{

struct TestParticle
{
    Vec3 position;
    std::uint32_t id = 0;
    std::uint16_t mk = 0;
    float density = 1000;
    std::array<float, 3> velocity{};
};

inline void append_double(std::string& out, double value)
{
    const std::uint64_t swapped = __builtin_bswap64(std::bit_cast<std::uint64_t>(value));
    out.append(reinterpret_cast<const char*>(&swapped), sizeof swapped);
}

/// Writes a VTK file with double positions.
inline void write_particles(const std::string& path, const std::vector<TestParticle>& particles)
{
    const std::string n = std::to_string(particles.size());
    std::string bytes = std::string(vtk_head) + "POINTS " + n + " double\n";
    for (const TestParticle& p : particles)
        for (int axis = 0; axis < 3; ++axis) append_double(bytes, p.position[axis]);
    bytes += "\nPOINT_DATA " + n + "\nFIELD FieldData 4\nIdp 1 " + n + " unsigned_int\n";
    for (const TestParticle& p : particles) append_big_endian(bytes, p.id);
    bytes += "\nMk 1 " + n + " unsigned_short\n";
    for (const TestParticle& p : particles) append_big_endian(bytes, p.mk);
    bytes += "\nRhop 1 " + n + " float\n";
    for (const TestParticle& p : particles) append_big_endian(bytes, p.density);
    bytes += "\nVel 3 " + n + " float\n";
    for (const TestParticle& p : particles)
        for (const float v : p.velocity) append_big_endian(bytes, v);
    std::ofstream(path, std::ios::binary) << bytes << "\n";
}

/// Nodes of dp 1 in the order of x, y, z; the lower half in z has mk 10, the upper one mk 1.
inline std::vector<TestParticle> box_of(int nx, int ny, int nz)
{
    std::vector<TestParticle> out;
    for (int x = 0; x < nx; ++x)
        for (int y = 0; y < ny; ++y)
            for (int z = 0; z < nz; ++z)
                out.push_back({{double(x), double(y), double(z)},
                               static_cast<std::uint32_t>(out.size()),
                               static_cast<std::uint16_t>(2 * z < nz ? 10 : 1)});
    return out;
}

/// The same shaken by up to `most` along each axis, with some particles left out.
inline std::vector<TestParticle> shaken(std::vector<TestParticle> particles, double most)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> step(-most, most);
    std::vector<TestParticle> out;
    for (TestParticle& p : particles)
    {
        for (int axis = 0; axis < 3; ++axis) p.position[axis] += step(random);
        if (random() % 10 != 0) out.push_back(p);
    }
    return out;
}

/// What compare_results() says of two sets of particles.
inline Comparison compare_sets(const std::vector<TestParticle>& a,
                               const std::vector<TestParticle>& b,
                               const CompareOptions& options = {})
{
    const TestFolder folder;
    write_particles(folder / "a.vtk", a);
    write_particles(folder / "b.vtk", b);
    return compare_results(folder / "a.vtk", folder / "b.vtk", options);
}

} // namespace fppg
