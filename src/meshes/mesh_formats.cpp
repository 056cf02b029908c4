#include "meshes/mesh_formats.h"

#include "fppg/error.h"
#include "fppg/shapes.h"

#include "core/text.h"
#include "meshes/read_step.h"
#include "meshes/readers.h"
#include "platform/file_map.h"

#include <algorithm>
#include <array>

namespace fppg
{

namespace
{

/// A kind of mesh files.
struct MeshFormatRow
{
    MeshFormat format;
    std::string_view name;    ///< of `<drawfileNAME>`; empty: other commands draw it
    std::string_view title;   ///< in help texts
    std::string_view endings; ///< of its files, in small letters, separated by blanks
    MeshFile (*read)(const std::string& path, const MeshReading& reading, int threads);
    bool is_own = false; ///< GenCase cannot read it
};

/// Reads a file by points and the cells that name them.
template <IndexedMesh (*Read)(std::string_view, const std::string&)>
MeshFile read_with(const std::string& path, const MeshReading& reading, int threads)
{
    const FileMap file(path);
    if (file.bytes().empty()) throw GeometryError(path + ": is empty");
    return build_mesh(Read(file.bytes(), path), reading.shapes, path, threads);
}

IndexedMesh read_vtk(std::string_view bytes, const std::string& path)
{
    const std::size_t first = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    if (first != std::string_view::npos && bytes[first] == '<') return read_vtk_xml(bytes, path);
    return read_vtk_legacy(bytes, path);
}

MeshFile read_stl_file(const std::string& path, const MeshReading&, int threads)
{
    return read_stl(path, threads);
}

MeshFile read_step_file(const std::string& path, const MeshReading& reading, int)
{
    return read_step(path, reading);
}

MeshFile read_heights(const std::string& path, const MeshReading& reading, int threads)
{
    return build_mesh(read_bathymetry_file(path, *reading.bathymetry, threads), reading.shapes,
                      path, threads);
}

/// All formats; the first one is that of files whose ending is not known.
constexpr auto table = std::to_array<MeshFormatRow>({
    {MeshFormat::Stl, "stl", "STL", "stl", read_stl_file},
    {MeshFormat::Ply, "ply", "PLY", "ply", read_with<read_ply>},
    {MeshFormat::Vtk, "vtk", "VTK (.vtk, .vtp, .vtu)", "vtk vtp vtu", read_with<read_vtk>},
    {MeshFormat::Obj, "obj", "OBJ", "obj", read_with<read_obj>, true},
    {MeshFormat::Off, "off", "OFF", "off", read_with<read_off>, true},
    {MeshFormat::Step, "step", "STEP", "step stp", read_step_file, true},
    {MeshFormat::CsvBathymetry, "csv", "CSV (heights)", "csv", read_with<read_csv_bathymetry>},
    {MeshFormat::Bathymetry, "", "", "", read_heights},
});

bool has_word(std::string_view words, std::string_view wanted)
{
    const std::vector<std::string_view> parts = split(words, ' ');
    return !wanted.empty() && std::find(parts.begin(), parts.end(), wanted) != parts.end();
}

const MeshFormatRow& row_of(MeshFormat format)
{
    return *std::find_if(table.begin(), table.end(),
                         [format](const MeshFormatRow& r) { return r.format == format; });
}

} // namespace

bool is_own_format(MeshFormat format)
{
    return row_of(format).is_own;
}

std::string_view mesh_format_name(MeshFormat format)
{
    return row_of(format).name;
}

std::string mesh_format_list()
{
    std::string out;
    for (const MeshFormatRow& row : table)
        if (!row.title.empty()) out += (out.empty() ? "" : ", ") + std::string(row.title);
    return out;
}

std::optional<MeshFormat> mesh_format_named(std::string_view name)
{
    for (const MeshFormatRow& row : table)
        if (!row.name.empty() && row.name == name) return row.format;
    return std::nullopt;
}

MeshFormat mesh_format_of(const std::string& path)
{
    const std::size_t dot = path.rfind('.');
    const std::string ending = dot == std::string::npos ? "" : lower_case(path.substr(dot + 1));
    for (const MeshFormatRow& row : table)
        if (has_word(row.endings, ending)) return row.format;
    return table[0].format;
}

IndexedMesh read_bathymetry_file(const std::string& path, const BathymetryGrid& grid, int threads)
{
    const FileMap file(path);
    if (file.bytes().empty()) throw GeometryError(path + ": is empty");
    return read_bathymetry(file.bytes(), path, grid, threads);
}

MeshFile read_mesh_file(const std::string& path, const MeshReading& reading, int threads)
{
    return row_of(reading.format).read(path, reading, threads);
}

} // namespace fppg
