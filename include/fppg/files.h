#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"
#include "fppg/particles.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// A file that is not there until it is whole: written under the temporary name
/// `.<name>.part-<process id>` in the same folder, given its name by commit(). Destroyed without
/// commit(): the temporary file is removed and an older file of that name is untouched. A signal
/// handler removes the temporary files of all objects by src/core/temporary_files.h; those of a
/// killed process go when the file is written the next time.
class OutputFile
{
public:
    /// throws IoError if the folder cannot be written or `path` is a folder
    explicit OutputFile(std::string path);
    /// A file that is not written: only its digest is made of what would be in it.
    static OutputFile not_written(std::string path);
    ~OutputFile();
    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&& other) noexcept;

    /// Reserves the whole file on the disk (zeros until written), so that a full disk is noticed
    /// before the work. Where the file system cannot reserve, only the size is set. throws IoError
    void reserve(std::uint64_t bytes);
    /// Writes at an offset; several threads may write different parts at once. throws IoError
    void write_at(std::uint64_t offset, const void* data, std::size_t bytes);
    /// Writes at the end of what append() wrote so far. throws IoError
    void append(const void* data, std::size_t bytes);
    void append(const std::string& text) { append(text.data(), text.size()); }
    /// Nothing more is written; holds no descriptor from here on. throws IoError
    void finish();
    /// Gives the file its name. throws IoError
    void commit();

    const std::string& path() const { return path_; }
    /// Where the file is until commit() gives it its name.
    const std::string& temporary_path() const { return temporary_path_; }
    /// Digest and size of a file that is not written, equal for equal bytes; else empty.
    std::string digest() const;

private:
    struct Digest
    {
        std::atomic<std::uint64_t> sum{0}; ///< of byte_digest()
        std::uint64_t reserved = 0;
    };

    OutputFile() = default;

    std::string path_;
    std::string temporary_path_;
    int descriptor_ = -1;
    int registry_slot_ = -1;
    std::uint64_t end_ = 0;
    std::unique_ptr<Digest> digest_; ///< null where the file is written

    void discard() noexcept;
};

/// What a file says of its maker.
struct FileOrigin
{
    std::string app_name;  ///< e.g. "GenCase v5.4 (fppg v0.1.0)"
    std::string date;      ///< of Case.xml: dd-mm-yyyy hh:mm:ss
    std::string case_name; ///< without folder
};

/// A bi4 file of this many bytes and more has 64-bit sizes; a reader takes 32-bit ones up to here.
constexpr std::uint64_t bi4_limit_of_32_bit_sizes = 4228102018U;

/// Writes `Case.bi4` (JBinaryData: one item JPartDataBi4 with PART_0000: Idp, Posd, Vel, Rhop, and
/// BoundNor where there are normals) as a stream: no array of all particles is made, pieces of
/// about one MiB are filled and written by `threads` threads at their offsets. The same input gives
/// the same bytes for any number of threads (Date is "???"), equal to those of GenCase v5.4.354 but
/// for AppName.
///
/// limit_of_32_bit_sizes  bytes from which the sizes of arrays take 64 bits
/// throws                 IoError if the file cannot be written, or from 4,294,967,295 particles on
void write_bi4(OutputFile& file, const CaseParticles& particles, const CaseConstants& constants,
               const FileOrigin& origin, int threads,
               std::uint64_t limit_of_32_bit_sizes = bi4_limit_of_32_bit_sizes);

enum class VtkSelection
{
    All,
    Bound,
    Fluid,
};

/// Writes particles as legacy binary VTK (POLYDATA, big-endian, POINTS float): All and Fluid with
/// Idp, Vel, Rhop, Type, Mk, Bound with Idp, Type, Mk, or where there are normals with Idp, Mk
/// (unsigned_short), Type, Normal, NormalSize. Streamed like write_bi4, with the bytes of
/// GenCase v5.4.354. Mk is unsigned_char, unsigned_short where a selected mk is above 255.
///
/// Of a case with fitted walls, All and Bound have behind these Kind (int, as FitKind; nodes are
/// Volume), Normal (3 float; zero for Volume), Distance (float, metres, negative inside;
/// distance_of_nodes for nodes) and Layer (int; 0: in no layer of a wall). Where Normal stands
/// there already, that of the wall is WallNormal.
///
/// throws  IoError if the file cannot be written, or from 2,147,483,648 selected particles on
void write_particles_vtk(OutputFile& file, const CaseParticles& particles,
                         const CaseConstants& constants, VtkSelection selection, int threads);

/// Writes `_MkCells.vtk`: the faces between cells (dp wide, centred on the nodes) of different mk,
/// merged into rectangles, each drawn 0.001 dp inside its own cell (nodes in the zone of a fitted
/// wall as those of its mk); CELL_DATA Mk (unsigned_short) and Type (unsigned_char, 0 fixed, 1
/// moving, 2 floating, 3 fluid). Between two cells that carry different mk both faces are drawn.
/// Normals point outwards. A 2-D field is drawn as the areas of its cells instead, at 0.001 dp
/// above its y. Made from runs: cost grows with the number of runs, not with nodes. The area
/// covered by each mk and direction is that of GenCase v5.4.354; its choice of rectangles is
/// another one.
///
/// type_of_mk  size 65536: the ParticleType of every mk
/// throws      IoError if the file cannot be written, or from 536,870,912 rectangles on
void write_cells_vtk(OutputFile& file, const RunField& field,
                     const std::vector<ParticleType>& type_of_mk, int threads);

/// Writes the cells of `cellsout`: the same faces, of one mk where it is given, with CELL_DATA Mk
/// and ObjId (int; the number of the face among those of all mks).
///
/// returns  the number of faces; without any the file stays empty
std::uint64_t write_shown_cells_vtk(OutputFile& file, const RunField& field,
                                    std::optional<std::uint16_t> mk, int threads);

/// Writes points as legacy binary VTK (POINTS float, VERTICES); without any the origin alone, as
/// GenCase v5.4.354 does in `pointsmkout`.
void write_points_vtk(OutputFile& file, const std::vector<Vec3>& points);

/// Writes points as legacy binary VTK, POINTS double, with their z as SCALARS Height (float): as
/// VERTICES where the cells have one corner, else as POLYGONS.
void write_heights_vtk(OutputFile& file, const std::vector<Vec3>& points,
                       const std::vector<std::vector<std::uint32_t>>& cells);

/// Writes `_FreePt.vtk`: POINTS double, VERTICES, SCALARS Mk and a field Type (unsigned_char, 0
/// fixed, 1 moving, 2 floating, 3 fluid), with the bytes of GenCase v5.4.354. Mk is unsigned_char,
/// unsigned_short where one is above 255.
void write_off_lattice_points_vtk(OutputFile& file, const OffLatticePoints& points);

/// Polygons of one drawn object, for shape files.
struct ShapePolygons
{
    std::uint32_t object_id = 0;
    int mk = 0; ///< absolute; -1 void
    std::vector<Vec3> vertices;
    std::vector<std::vector<std::uint32_t>>
        polygons; ///< 1 index for a point, 2 for a line, 3 and more for a face
};

/// Writes shapes as legacy binary VTK: points of all objects in order, then VERTICES, LINES and
/// POLYGONS (a part that is empty is left out), with CELL_DATA Mk and ObjId (int).
void write_shapes_vtk(OutputFile& file, const std::vector<ShapePolygons>& shapes);

/// The same cells as VTK XML, .vtp (PolyData) or .vtu (UnstructuredGrid): version 1.0, appended raw
/// little-endian data with UInt64 sizes, Mk and ObjId Int32, points Float32.
void write_shapes_vtp(OutputFile& file, const std::vector<ShapePolygons>& shapes);
void write_shapes_vtu(OutputFile& file, const std::vector<ShapePolygons>& shapes);

/// The faces as binary STL, polygons cut from their first corner; lines and points are left out.
///
/// returns  the number of facets
std::uint64_t write_shapes_stl(OutputFile& file, const std::vector<ShapePolygons>& shapes);

/// Writes the feature lines and singular points of all fitted bodies as legacy binary VTK
/// (POLYDATA, big-endian, POINTS float: the mesh vertices that they use): VERTICES, one a singular
/// point, then LINES, one polyline a feature line, a closed one ending at its first vertex. Bodies
/// in their order in both. CELL_DATA Mk (int, absolute), Body (int, index in `walls`), Length
/// (float, metres; 0 for points). Walls without features give a file without cells.
///
/// throws  IoError if the file cannot be written, or from 2,147,483,648 numbers on
void write_features_vtk(OutputFile& file, const FittedWalls& walls);

/// Writes the particles of fitted walls as legacy binary VTK (POLYDATA, big-endian, POINTS float):
/// VERTICES, POINT_DATA Mk (int, absolute) and Kind (int, as FitKind).
///
/// throws  IoError if the file cannot be written, or from 1,073,741,824 particles on
void write_wall_particles_vtk(OutputFile& file, const WallParticles& particles);

/// Numbers as a list of ranges, e.g. "10-11,20"; they are sorted first, repeated ones count once.
std::string format_ranges(std::vector<int> numbers);

/// Writes the boxes of one zone of `<vres>`, or one box of each, as legacy binary VTK: LINES in 2D
/// and of all zones together, else POLYGONS, with CELL_DATA Zone (int); cells as in GenCase
/// v5.4.354.
void write_zone_vtk(OutputFile& file, const VresDef& vres, std::size_t id);
void write_zones_vtk(OutputFile& file, const VresDef& vres);

/// A line of `<vtkout>` in Case.xml.
struct VtkOutEntry
{
    std::string file;    ///< without folder
    std::string mk;      ///< list of ranges, e.g. "10-11,20"
    std::string mkbound; ///< or empty
    std::string mkfluid; ///< or empty
};

/// Writes `Case.xml`: the definition as read, then `<execution>` with particles, constants,
/// uservars, motion and vtkout, as described at the head of src/files/case_xml.cpp. Numbers have
/// as many digits as it takes to read them back exactly. throws IoError
void write_case_xml(OutputFile& file, const CaseDef& def, const CaseParticles& particles,
                    const CaseConstants& constants, const std::vector<VtkOutEntry>& vtk_out,
                    const FileOrigin& origin);

} // namespace fppg
