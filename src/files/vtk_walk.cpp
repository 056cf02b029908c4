#include "files/vtk_walk.h"

#include "fppg/error.h"

#include <fmt/format.h>

namespace fppg
{

/// Bytes of a number of this VTK type; 0 for an unknown one.
std::size_t width_of_vtk_type(std::string_view type)
{
    if (type == "unsigned_char" || type == "char") return 1;
    if (type == "unsigned_short" || type == "short") return 2;
    if (type == "unsigned_int" || type == "int" || type == "float") return 4;
    if (type == "unsigned_long" || type == "long" || type == "double") return 8;
    return 0;
}

VtkWalk::VtkWalk(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path)
{
    if (!line().starts_with("# vtk DataFile")) fail("it does not begin as a VTK file does");
    line(); // title
    if (line() != "BINARY") fail("only binary VTK files are read, this one is ASCII");
    if (line() != "DATASET POLYDATA") fail("its data set is not POLYDATA");
    while (!is_at_end()) walk_part();
}

void VtkWalk::fail(const std::string& text) const
{
    throw IoError(fmt::format("cannot read '{}': {}", path_, text));
}

bool VtkWalk::is_at_end()
{
    while (at_ < bytes_.size() && bytes_[at_] == '\n') ++at_;
    return at_ >= bytes_.size();
}

std::string VtkWalk::line()
{
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos || end - at_ > 1000)
        fail(fmt::format("a line is expected at byte {}", at_));
    std::string text(bytes_.substr(at_, end - at_));
    at_ = end + 1;
    return text;
}

/// Words of the next line that is not empty.
std::istringstream VtkWalk::words()
{
    if (is_at_end()) fail("it ends where an array is expected");
    return std::istringstream(line());
}

VtkArray VtkWalk::data(const std::string& number_type, std::uint64_t count,
                       std::uint64_t components)
{
    const std::size_t width = width_of_vtk_type(number_type);
    if (width == 0) fail(fmt::format("an array has the unknown type \"{}\"", number_type));
    const std::uint64_t left = (bytes_.size() - at_) / width;
    if (components == 0 || count > left / components)
        fail(
            fmt::format("it ends at byte {}, within an array of {} values that begins at "
                        "byte {}",
                        bytes_.size(), count, at_));
    VtkArray array{number_type, count, bytes_.substr(at_, count * components * width)};
    at_ += array.data.size();
    return array;
}

void VtkWalk::keep(const std::string& name, const VtkArray& array, std::uint64_t components)
{
    if (!is_of_points_) return;
    if (name == "Normal" && components == 3) normal = array;
    if (name == "WallNormal" && components == 3) wall_normal = array;
    if (name == "Vel" && components == 3) velocity = array;
    if (components != 1) return;
    if (name == "Idp") idp = array;
    if (name == "Rhop") density = array;
    if (name == "Mk") mk = array;
    if (name == "Type") type = array;
    if (name == "Kind") kind = array;
    if (name == "Distance") distance = array;
    if (name == "Layer") layer = array;
    if (name == "NormalSize") has_sizes = true;
}

void VtkWalk::walk_part()
{
    std::istringstream text = words();
    std::string key;
    std::string name;
    std::string number_type;
    std::uint64_t n = 0;
    std::uint64_t width = 1;
    text >> key;
    if (key == "POINTS")
    {
        text >> n >> number_type;
        points = data(number_type, n, 3);
    }
    else if (key == "VERTICES" || key == "LINES" || key == "POLYGONS")
    {
        text >> n >> width;
        data("int", width, 1);
    }
    else if (key == "POINT_DATA" || key == "CELL_DATA")
    {
        text >> values_;
        is_of_points_ = key == "POINT_DATA";
    }
    else if (key == "SCALARS")
    {
        text >> name >> number_type;
        if (!(text >> width)) width = 1;
        words(); // LOOKUP_TABLE
        keep(name, data(number_type, values_, width), width);
    }
    else if (key == "VECTORS" || key == "NORMALS")
    {
        text >> name >> number_type;
        data(number_type, values_, 3);
    }
    else if (key == "FIELD")
    {
        std::uint64_t fields = 0;
        text >> name >> fields;
        for (; fields > 0; --fields)
        {
            std::istringstream field = words();
            field >> name >> width >> n >> number_type;
            keep(name, data(number_type, n, width), width);
        }
    }
    else
        fail(fmt::format("the part \"{}\" before byte {} is unknown", key.substr(0, 40), at_));
}

void VtkWalk::expect_integers(const char* name, const VtkArray& array) const
{
    if (array.count != points.count)
        fail(fmt::format("array {} has {} values for {} points", name, array.count, points.count));
    if (array.type == "float" || array.type == "double" || width_of_vtk_type(array.type) > 4)
        fail(fmt::format("array {} has the type {}, expected integers", name, array.type));
}

void VtkWalk::expect_floats(const char* name, const VtkArray& array) const
{
    if (array.count != points.count)
        fail(fmt::format("array {} has {} values for {} points", name, array.count, points.count));
    if (array.type != "float")
        fail(fmt::format("array {} has the type {}, expected float", name, array.type));
}

} // namespace fppg
