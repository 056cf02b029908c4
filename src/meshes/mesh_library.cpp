#include "meshes/mesh_library.h"

#include "fppg/domain_clip.h"
#include "fppg/error.h"
#include "fppg/shapes.h"

#include "core/nearby_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace fppg
{

std::string MeshLibrary::find(const SourceRef& source, const std::string& name) const
{
    std::error_code ignored;
    std::string beside = (std::filesystem::path(definition_).parent_path() / name).string();
    const bool is_here = std::filesystem::exists(name, ignored);
    if (is_here && places_ == MeshPlaces::WorkingDirectoryFirst) return name;
    if (std::filesystem::exists(beside, ignored)) return beside;
    if (is_here) return name;
    throw IoError(fmt::format("{}:{}: <{} file=\"{}\">: cannot open the file: there is no {}{}{}",
                              definition_, source.line, source.command, name, name,
                              beside == name ? "" : " and no " + beside,
                              what_lies_at({name, beside})));
}

const MeshFile& MeshLibrary::read_drawn(const SourceRef& source, const MeshFileOp& op,
                                        const Box3& domain, MeshFile& cut, int threads)
{
    const auto as_read = [&]() -> const MeshFile&
    { return read(source, op.file, op.reading, threads).mesh; };
    if (!op.clip_resize || op.advanced) return as_read();
    const Box3 box = clip_box(domain.min, domain.max, *op.clip_resize);
    const MeshFile& whole = read(source, op.file, reading_to_clip(op.reading), threads).mesh;
    if (is_within(whole, op.transform, box)) return as_read();
    cut = clip_to_box(whole, op.transform, box, op.reading);
    return cut;
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
    catch (const IoError& e)
    {
        throw IoError(fmt::format("{}:{}: <{} file=\"{}\">: {}", definition_, source.line,
                                  source.command, name, e.what()));
    }
}

} // namespace fppg
