#include "fppg/shapes.h"

#include "fppg/error.h"

#include "core/file_map.h"
#include "meshes/readers.h"

#include <fmt/format.h>

#include <algorithm>

namespace fppg
{
namespace
{

IndexedMesh read_vtk(std::string_view bytes, const std::string& path)
{
    const std::size_t first = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    if (first != std::string_view::npos && bytes[first] == '<') return read_vtk_xml(bytes, path);
    return read_vtk_legacy(bytes, path);
}

IndexedMesh read_indexed(std::string_view bytes, const std::string& path,
                         const MeshReading& reading, int threads)
{
    switch (reading.format)
    {
        case MeshFormat::Ply:
            return read_ply(bytes, path);
        case MeshFormat::CsvBathymetry:
            return read_csv_bathymetry(bytes, path);
        case MeshFormat::Bathymetry:
            return read_bathymetry(bytes, path, *reading.bathymetry, threads);
        default:
            return read_vtk(bytes, path);
    }
}

} // namespace

MeshFormat mesh_format_of(const std::string& path)
{
    const std::size_t dot = path.rfind('.');
    std::string ending = dot == std::string::npos ? "" : path.substr(dot + 1);
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c)
                   { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
    if (ending == "ply") return MeshFormat::Ply;
    if (ending == "vtk" || ending == "vtp" || ending == "vtu") return MeshFormat::Vtk;
    if (ending == "csv") return MeshFormat::CsvBathymetry;
    return MeshFormat::Stl;
}

IndexedMesh read_bathymetry_file(const std::string& path, const BathymetryGrid& grid, int threads)
{
    const FileMap file(path);
    if (file.bytes().empty()) throw GeometryError(path + ": is empty");
    return read_bathymetry(file.bytes(), path, grid, threads);
}

MeshFile read_mesh_file(const std::string& path, const MeshReading& reading, int threads)
{
    if (reading.format == MeshFormat::Stl) return read_stl(path, threads);
    const FileMap file(path);
    if (file.bytes().empty()) throw GeometryError(path + ": is empty");
    return build_mesh(read_indexed(file.bytes(), path, reading, threads), reading.shapes, path,
                      threads);
}

} // namespace fppg
