#include "fppg/error.h"
#include "fppg/files.h"

#include "files/vtk.h"

#include <fmt/format.h>

namespace fppg
{

void write_wall_particles_vtk(OutputFile& file, const WallParticles& particles)
{
    // VTK keeps indices and counts as signed 32-bit numbers, here two per particle.
    const std::size_t n = particles.size();
    if (n > 0x3FFFFFFF)
        throw IoError(fmt::format("{}: {} wall particles, VTK takes 1073741823", file.path(), n));
    std::string points;
    std::string vertices;
    std::string mk;
    std::string kind;
    for (std::size_t i = 0; i < n; ++i)
    {
        for (int axis = 0; axis < 3; ++axis)
            append_big_endian(points, static_cast<float>(particles.positions[i][axis]));
        append_big_endian(vertices, std::uint32_t{1});
        append_big_endian(vertices, static_cast<std::uint32_t>(i));
        append_big_endian(mk, std::uint32_t{particles.mk[i]});
        append_big_endian(kind, static_cast<std::uint32_t>(particles.kinds[i]));
    }
    file.append(fmt::format("{}POINTS {} float\n", vtk_head, n));
    file.append(points);
    file.append(fmt::format("\nVERTICES {} {}\n", n, 2 * n));
    file.append(vertices);
    file.append(fmt::format("\nPOINT_DATA {}\nSCALARS Mk int\nLOOKUP_TABLE default\n", n));
    file.append(mk);
    file.append(fmt::format("\nFIELD FieldData 1\nKind 1 {} int\n", n));
    file.append(kind);
    file.append("\n");
}

} // namespace fppg
