#pragma once

#include "files/vtk.h"
#include "fppg/files.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace fppg
{

/// Cells of one kind (VERTICES, LINES or POLYGONS) of a legacy VTK file, and the mk of each.
struct VtkCells
{
    std::string connectivity;
    std::string mk;
    std::uint64_t cells = 0;
    std::uint64_t numbers = 0; ///< indices and counts

    /// Begins a cell, whose corners are then to be appended to the connectivity.
    void begin(std::size_t corners, std::uint32_t of_mk)
    {
        append_big_endian(connectivity, static_cast<std::uint32_t>(corners));
        append_big_endian(mk, of_mk);
        numbers += corners + 1;
        ++cells;
    }

    /// Writes nothing where there is no cell.
    void write(OutputFile& file, const char* kind) const
    {
        if (cells == 0) return;
        file.append(fmt::format("{} {} {}\n", kind, cells, numbers));
        file.append(connectivity);
        file.append("\n");
    }
};

} // namespace fppg
