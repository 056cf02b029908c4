// VTK XML, UnstructuredGrid with a vertex a particle, its arrays appended raw with UInt64 sizes:
// what VTK 9.1, ParaView 5.11, meshio and ReadVTK.jl (of TrixiParticles) all read.

#include "convert/columns.h"
#include "convert/formats.h"

#include <fmt/format.h>

#include <filesystem>

namespace fppg
{

namespace
{

struct VtuPart
{
    const char* section; ///< "PointData", "Points" or "Cells"
    Column column;
};

const char* vtk_name(ColumnType type)
{
    constexpr std::array names{"UInt8", "Int32", "UInt32", "Int64", "Float32", "Float64"};
    return names[static_cast<std::size_t>(type)];
}

/// velocity, density, pressure and particle_spacing are TrixiParticles' names; the type of pressure
/// is the type of all that it reads.
std::vector<VtuPart> parts_of(const ParticleFeed& feed, std::uint64_t n)
{
    using enum ColumnType;
    const ColumnType index = n < (std::uint64_t{1} << 31U) ? Int32 : Int64;
    std::vector<VtuPart> parts{
        {"PointData", {"velocity", Field::Velocity, Float32}},
        {"PointData", {"density", Field::Density, Float32}},
        {"PointData", {"pressure", Field::Pressure, Float64}},
        {"PointData", {"particle_spacing", Field::Spacing, Float64}},
        {"PointData", {"mass", Field::Mass, Float64}},
        {"PointData", {"volume", Field::Volume, Float64}},
        {"PointData", {"id", Field::Id, UInt32}},
        {"PointData", {"mk", Field::Mk, Int32}},
        {"PointData", {"type", Field::Type, UInt8}},
    };
    if (feed.has_normals) parts.push_back({"PointData", {"normal", Field::Normal, Float32}});
    if (feed.has_kinds) parts.push_back({"PointData", {"kind", Field::Kind, UInt8}});
    parts.push_back({"Points", {"Points", Field::Position, Float64}});
    parts.push_back({"Cells", {"connectivity", Field::Index, index}});
    parts.push_back({"Cells", {"offsets", Field::IndexAfter, index}});
    parts.push_back({"Cells", {"types", Field::One, UInt8}}); // VTK_VERTEX
    return parts;
}

/// The file before its appended data, and where each array's size stands in these.
std::string vtu_head(std::uint64_t n, const std::vector<VtuPart>& parts,
                     std::vector<std::uint64_t>& offsets)
{
    std::uint64_t at = 0;
    const auto array = [&](const Column& column, std::uint64_t count, const char* tuples)
    {
        offsets.push_back(at);
        std::string line = fmt::format(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"appended\" "
            "offset=\"{}\"/>\n",
            vtk_name(column.type), column.name, column.is_vector() ? 3 : 1, tuples, at);
        at += 8 + count * column.bytes_per_particle();
        return line;
    };
    std::string head =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<UnstructuredGrid>\n<FieldData>\n";
    head += array({"ndims", Field::One, ColumnType::Int32}, 1, " NumberOfTuples=\"1\"");
    head += array({"TimeValue", Field::One, ColumnType::Float64}, 1, " NumberOfTuples=\"1\"");
    head += array({"time", Field::One, ColumnType::Float64}, 1, " NumberOfTuples=\"1\"");
    head += fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", n, n);
    const char* section = "";
    for (const VtuPart& part : parts)
    {
        if (std::string_view(section) != part.section)
        {
            if (*section != '\0') head += fmt::format("</{}>\n", section);
            section = part.section;
            head += fmt::format("<{}>\n", section);
        }
        head += array(part.column, n, "");
    }
    head += fmt::format("</{}>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_",
                        section);
    offsets.push_back(at);
    return head;
}

/// Lays a file out and writes all but the particles.
std::vector<PlacedColumn> begin_vtu(OutputFile& file, const ParticleFeed& feed, std::uint64_t n)
{
    const std::vector<VtuPart> parts = parts_of(feed, n);
    std::vector<std::uint64_t> offsets;
    const std::string head = vtu_head(n, parts, offsets);
    const std::string tail = "\n</AppendedData>\n</VTKFile>\n";
    file.reserve(head.size() + offsets.back() + tail.size());
    file.write_at(0, head.data(), head.size());
    file.write_at(head.size() + offsets.back(), tail.data(), tail.size());
    const auto write_number = [&](std::size_t i, const auto& value)
    {
        const std::uint64_t size = sizeof value;
        file.write_at(head.size() + offsets[i], &size, 8);
        file.write_at(head.size() + offsets[i] + 8, &value, sizeof value);
    };
    write_number(0, std::int32_t{feed.is_2d ? 2 : 3});
    write_number(1, feed.time);
    write_number(2, feed.time);
    std::vector<PlacedColumn> columns;
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
        const std::uint64_t at = head.size() + offsets[i + 3];
        const std::uint64_t size = n * parts[i].column.bytes_per_particle();
        file.write_at(at, &size, 8);
        columns.push_back({parts[i].column, at + 8});
    }
    return columns;
}

} // namespace

void write_vtu(const ParticleFeed& feed, const std::string& path, int threads, ConvertedFiles& out)
{
    say_volumes(feed, out);
    OutputFile& file = out.files.emplace_back(path);
    write_columns(file, feed, begin_vtu(file, feed, feed.count), threads);
}

void write_trixi(const ParticleFeed& given, const std::string& path, int threads,
                 ConvertedFiles& out)
{
    const ParticleFeed feed = in_xy_plane(given, out);
    say_volumes(feed, out);
    out.losses.emplace_back(
        "TrixiParticles makes masses of density and spacing; pass \"mass\" to InitialCondition "
        "where volumes matter");
    const BodyOrder order = order_by_body(feed, threads);
    const std::filesystem::path stem = std::filesystem::path(path).replace_extension();
    std::vector<OutputFile> files;
    for (const FeedBody& body : feed.bodies)
        files.emplace_back(fmt::format("{}_{}.vtu", stem.string(), body.name));
    std::vector<BodyColumns> bodies(feed.bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i)
        bodies[i] = {&files[i], begin_vtu(files[i], feed, order.counts[i])};
    write_columns_by_body(feed, order, bodies, threads);
    for (OutputFile& file : files) out.files.push_back(std::move(file));
}

} // namespace fppg
