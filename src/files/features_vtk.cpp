#include "fppg/error.h"
#include "fppg/files.h"

#include "files/vtk_cells.h"

#include <fmt/format.h>

#include <vector>

namespace fppg
{
namespace
{

struct FeatureCells : VtkCells
{
    std::string body;
    std::string length;

    void begin_feature(std::size_t vertices, std::size_t body_index, const FittedBody& of,
                       double metres)
    {
        begin(vertices, of.mk);
        append_big_endian(body, static_cast<std::uint32_t>(body_index));
        append_big_endian(length, static_cast<float>(metres));
    }
};

/// The vertices that features use, in the order of their first use.
class PointList
{
public:
    void begin_body(const SurfaceMesh& mesh)
    {
        mesh_ = &mesh;
        index_.assign(mesh.vertices.size(), no_index);
    }
    std::uint32_t index_of(std::uint32_t vertex)
    {
        if (index_[vertex] == no_index)
        {
            index_[vertex] = count_++;
            for (int axis = 0; axis < 3; ++axis)
                append_big_endian(bytes_, static_cast<float>(mesh_->vertices[vertex][axis]));
        }
        return index_[vertex];
    }
    std::uint32_t count() const { return count_; }
    const std::string& bytes() const { return bytes_; }

private:
    const SurfaceMesh* mesh_ = nullptr;
    std::vector<std::uint32_t> index_; ///< per vertex of the mesh
    std::string bytes_;
    std::uint32_t count_ = 0;
};

} // namespace

void write_features_vtk(OutputFile& file, const FittedWalls& walls)
{
    // VTK keeps indices and counts as signed 32-bit numbers.
    std::uint64_t numbers = 0;
    for (const FittedBody& body : walls.bodies)
    {
        numbers += 2 * body.features.singular.size();
        for (const FeatureLine& line : body.features.lines) numbers += line.vertices.size() + 2;
    }
    if (numbers > 0x7FFFFFFF)
        throw IoError(fmt::format("{}: the feature lines need {} numbers, VTK takes 2147483647",
                                  file.path(), numbers));

    PointList points;
    FeatureCells vertices;
    FeatureCells lines;
    for (std::size_t b = 0; b < walls.bodies.size(); ++b)
    {
        const FittedBody& body = walls.bodies[b];
        points.begin_body(body.mesh);
        for (const std::uint32_t vertex : body.features.singular)
        {
            vertices.begin_feature(1, b, body, 0);
            append_big_endian(vertices.connectivity, points.index_of(vertex));
        }
        for (const FeatureLine& line : body.features.lines)
        {
            lines.begin_feature(line.vertices.size() + (line.is_closed ? 1 : 0), b, body,
                                line.length);
            for (const std::uint32_t vertex : line.vertices)
                append_big_endian(lines.connectivity, points.index_of(vertex));
            if (line.is_closed)
                append_big_endian(lines.connectivity, points.index_of(line.vertices.front()));
        }
    }

    file.append(fmt::format("{}POINTS {} float\n", vtk_head, points.count()));
    file.append(points.bytes());
    file.append("\n");
    vertices.write(file, "VERTICES");
    lines.write(file, "LINES");
    const std::uint64_t cells = vertices.cells + lines.cells;
    file.append(fmt::format("CELL_DATA {}\nSCALARS Mk int\nLOOKUP_TABLE default\n", cells));
    file.append(vertices.mk + lines.mk);
    file.append(fmt::format("\nFIELD FieldData 2\nBody 1 {} int\n", cells));
    file.append(vertices.body + lines.body);
    file.append(fmt::format("\nLength 1 {} float\n", cells));
    file.append(vertices.length + lines.length);
    file.append("\n");
}

} // namespace fppg
