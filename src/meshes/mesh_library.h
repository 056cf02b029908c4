#pragma once

#include "fppg/case_def.h"
#include "fppg/mesh.h"
#include "fppg/mesh_reading.h"

#include <deque>
#include <string>

namespace fppg
{

/// Where the files of a case are looked for.
enum class MeshPlaces
{
    WorkingDirectoryFirst, ///< as GenCase; then the folder of the definition
    /// The mesh that a case was made with, even where the working directory has another one of
    /// that name.
    DefinitionFirst,
};

/// A mesh file of a case.
struct LibraryMesh
{
    std::string name; ///< as the definition writes it
    MeshReading reading;
    std::string path; ///< where it was found
    MeshFile mesh;
};

/// The mesh files of a case, each read once for all stages. Not to be called from several threads
/// at a time.
class MeshLibrary
{
public:
    /// definition  the file that names them, for places and messages
    explicit MeshLibrary(std::string definition,
                         MeshPlaces places = MeshPlaces::WorkingDirectoryFirst)
        : definition_(std::move(definition)), places_(places)
    {
    }

    /// The file of a draw; stays where it is as long as the library.
    ///
    /// threads  number of threads; the result does not depend on it
    /// throws   IoError that names the places looked at; IoError, GeometryError as
    ///          read_mesh_file(), with the place of the draw
    const LibraryMesh& read(const SourceRef& source, const std::string& name,
                            const MeshReading& reading, int threads);

    /// The file as `<clipdomain>` leaves it, where the draw has one.
    ///
    /// domain  limits of the case, which the draw grows
    /// cut     holds what is left of a file that is cut
    const MeshFile& read_drawn(const SourceRef& source, const MeshFileOp& op, const Box3& domain,
                               MeshFile& cut, int threads = 1);

    /// Where a file lies.
    ///
    /// throws  IoError that names the places looked at
    std::string find(const SourceRef& source, const std::string& name) const;

private:
    std::string definition_;
    MeshPlaces places_;
    std::deque<LibraryMesh> meshes_;
};

} // namespace fppg
