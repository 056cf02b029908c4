#include "convert/columns.h"
#include "convert/formats.h"
#include "convert/hdf5_file.h"

#include <fmt/format.h>

#include <filesystem>

namespace fppg
{

namespace
{

std::vector<Column> columns_of(const ParticleFeed& feed)
{
    using enum ColumnType;
    std::vector<Column> columns{{"position", Field::Position, Float64},
                                {"velocity", Field::Velocity, Float32},
                                {"density", Field::Density, Float32},
                                {"mass", Field::Mass, Float64},
                                {"volume", Field::Volume, Float64},
                                {"spacing", Field::Spacing, Float64},
                                {"id", Field::Id, UInt32},
                                {"mk", Field::Mk, Int32},
                                {"type", Field::Type, UInt8}};
    if (feed.has_normals) columns.push_back({"normal", Field::Normal, Float32});
    if (feed.has_kinds) columns.push_back({"kind", Field::Kind, UInt8});
    columns.push_back({"vertex", Field::Index, Int64});
    return columns;
}

/// A reference to an array of the .h5.
std::string data_item(const Column& column, std::uint64_t n, const std::string& h5)
{
    using enum ColumnType;
    const bool is_real = column.type == Float32 || column.type == Float64;
    const char* type = is_real                 ? "Float"
                       : column.type == UInt8  ? "UChar"
                       : column.type == UInt32 ? "UInt"
                                               : "Int";
    return fmt::format(
        "<DataItem Dimensions=\"{}{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\">{}:/{}"
        "</DataItem>",
        n, column.is_vector() ? " 3" : "", type, width_of(column.type), h5, column.name);
}

std::string xdmf_text(const ParticleFeed& feed, const std::vector<Column>& columns,
                      const std::string& h5)
{
    const std::uint64_t n = feed.count;
    // meshio 5 reads no Time.
    const std::string time =
        feed.time > 0 ? fmt::format("<Time Value=\"{}\"/>\n", feed.time) : std::string();
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain>\n"
        "<Grid Name=\"particles\" GridType=\"Uniform\">\n{}"
        "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\">{}"
        "</Topology>\n<Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
        time, n, data_item(columns.back(), n, h5), data_item(columns.front(), n, h5));
    for (const Column& column : columns)
        if (column.field != Field::Position && column.field != Field::Index)
            text += fmt::format(
                "<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n",
                column.name, column.is_vector() ? "Vector" : "Scalar", data_item(column, n, h5));
    return text + "</Grid>\n</Domain></Xdmf>\n";
}

} // namespace

void write_xdmf(const ParticleFeed& feed, const std::string& path, int threads, ConvertedFiles& out)
{
    say_volumes(feed, out);
    const std::filesystem::path h5 = std::filesystem::path(path).replace_extension(".h5");
    const std::vector<Column> columns = columns_of(feed);
    std::vector<Hdf5Object> objects{{"", {{"time", feed.time}, {"dp", feed.dp}}, false, {}, 0, 0}};
    for (const Column& column : columns)
        objects.push_back({column.name, {}, true, column, feed.count, 0});
    OutputFile& numbers = out.files.emplace_back(h5.string());
    lay_out_hdf5(numbers, objects);
    std::vector<PlacedColumn> placed;
    for (std::size_t i = 1; i < objects.size(); ++i)
        placed.push_back({objects[i].column, objects[i].at});
    write_columns(numbers, feed, placed, threads);
    OutputFile& text = out.files.emplace_back(path);
    text.append(xdmf_text(feed, columns, h5.filename().string()));
}

} // namespace fppg
