#include "shapes/mesh_library.h"

#include "fppg/error.h"
#include "fppg/shapes.h"

#include <fmt/format.h>

#include <filesystem>

namespace fppg
{

std::string MeshLibrary::find(const SourceRef& source, const std::string& name) const
{
    std::error_code ignored;
    const std::string beside = (std::filesystem::path(definition_).parent_path() / name).string();
    const bool is_here = std::filesystem::exists(name, ignored);
    if (is_here && places_ == MeshPlaces::WorkingDirectoryFirst) return name;
    if (std::filesystem::exists(beside, ignored)) return beside;
    if (is_here) return name;
    throw IoError(fmt::format("{}:{}: <{} file=\"{}\">: cannot open the file: there is no {}{}",
                              definition_, source.line, source.command, name, name,
                              beside == name ? "" : " and no " + beside));
}

const LibraryMesh& MeshLibrary::read(const SourceRef& source, const std::string& name,
                                     const MeshReading& reading, int threads)
{
    for (const LibraryMesh& known : meshes_)
        if (known.name == name && known.reading == reading) return known;
    const std::string path = find(source, name);
    try
    {
        MeshFile mesh = read_mesh_file(path, reading, threads);
        return meshes_.emplace_back(LibraryMesh{name, reading, path, std::move(mesh)});
    }
    catch (const GeometryError& e)
    {
        throw GeometryError(
            fmt::format("{}:{}: <{}>: {}", definition_, source.line, source.command, e.what()));
    }
}

} // namespace fppg
