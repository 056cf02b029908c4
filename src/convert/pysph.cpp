// What pysph.solver.output.HDFOutput reads (PySPH 1.0): particles/NAME with the groups constants
// and arrays; every array says its name, type, default, stored and stride. solver_data holds t, dt
// and count as attributes.

#include "convert/columns.h"
#include "convert/formats.h"
#include "convert/hdf5_file.h"

namespace fppg
{

namespace
{

struct PysphArray
{
    Column column;
    const char* type;
};

/// Normals of walls have the names of the EDAC scheme. PySPH's own V is a number density, which its
/// schemes sum up, so volumes have another name.
std::vector<PysphArray> arrays_of(const ParticleFeed& feed)
{
    using enum ColumnType;
    std::vector<PysphArray> arrays{
        {{"x", Field::Position, Float64, 0}, "double"},
        {{"y", Field::Position, Float64, 1}, "double"},
        {{"z", Field::Position, Float64, 2}, "double"},
        {{"u", Field::Velocity, Float64, 0}, "double"},
        {{"v", Field::Velocity, Float64, 1}, "double"},
        {{"w", Field::Velocity, Float64, 2}, "double"},
        {{"rho", Field::Density, Float64}, "double"},
        {{"m", Field::Mass, Float64}, "double"},
        {{"h", Field::Smoothing, Float64}, "double"},
        {{"p", Field::Pressure, Float64}, "double"},
        {{"volume", Field::Volume, Float64}, "double"},
        {{"gid", Field::Id, UInt32}, "unsigned int"},
        {{"mk", Field::Mk, Int32}, "int"},
        {{"pid", Field::Zero, Int32}, "int"},
        {{"tag", Field::Zero, Int32}, "int"},
    };
    if (feed.has_kinds) arrays.push_back({{"kind", Field::Kind, Int32}, "int"});
    if (!feed.has_normals) return arrays;
    const char* const names[] = {"xn", "yn", "zn"};
    for (int axis = 0; axis < 3; ++axis)
        arrays.push_back({{names[axis], Field::Normal, Float64, axis}, "double"});
    return arrays;
}

Hdf5Object group(std::string path)
{
    Hdf5Object object;
    object.path = std::move(path);
    return object;
}

} // namespace

void write_pysph(const ParticleFeed& given, const std::string& path, int threads,
                 ConvertedFiles& out)
{
    const ParticleFeed feed = in_xy_plane(given, out);
    say_volumes(feed, out);
    const BodyOrder order = order_by_body(feed, threads);
    const std::vector<PysphArray> arrays = arrays_of(feed);
    std::vector<Hdf5Object> objects{group(""), group("solver_data"), group("particles")};
    objects[1].attributes = {{"t", feed.time}, {"dt", 0.0}, {"count", std::int64_t{0}}};
    std::vector<std::size_t> first;
    for (std::size_t b = 0; b < feed.bodies.size(); ++b)
    {
        const std::string name = "particles/" + feed.bodies[b].name;
        for (const char* end : {"", "/constants", "/arrays"}) objects.push_back(group(name + end));
        first.push_back(objects.size());
        for (const PysphArray& array : arrays)
            objects.push_back({name + "/arrays/" + array.column.name,
                               {{"name", array.column.name},
                                {"type", std::string(array.type)},
                                {"default", 0.0},
                                {"stored", std::int64_t{1}},
                                {"stride", std::int64_t{1}}},
                               true,
                               array.column,
                               order.counts[b],
                               0});
    }
    OutputFile& file = out.files.emplace_back(path);
    lay_out_hdf5(file, objects);
    std::vector<BodyColumns> bodies(feed.bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        bodies[b].file = &file;
        for (std::size_t i = 0; i < arrays.size(); ++i)
            bodies[b].columns.push_back({arrays[i].column, objects[first[b] + i].at});
    }
    write_columns_by_body(feed, order, bodies, threads);
}

} // namespace fppg
