#include "fppg/error.h"
#include "fppg/shapes.h"

#include "meshes/readers.h"
#include "meshes/text_lines.h"
#include "platform/file_map.h"

#include <fmt/format.h>

namespace fppg
{
namespace
{

/// Points in lines of three numbers, separated by blanks, commas or semicolons. A first line that
/// is no number is a heading; lines that begin with # are comments; empty ones mean nothing.
std::vector<Vec3> read_xyz(std::string_view bytes, const std::string& path)
{
    std::string text(bytes);
    for (char& c : text)
        if (c == ',' || c == ';') c = ' ';
    TextLines lines(text, path);
    std::vector<Vec3> points;
    bool is_heading_possible = true;
    while (!lines.peek_word().empty())
    {
        const std::string_view first = lines.next_word();
        const bool is_number =
            std::string_view("+-.0123456789").find(first[0]) != std::string_view::npos;
        if (first[0] == '#' || (is_heading_possible && !is_number))
        {
            is_heading_possible = is_heading_possible && first[0] == '#';
            lines.next_line();
            continue;
        }
        is_heading_possible = false;
        lines.seek(lines.offset() - first.size());
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis) p[axis] = lines.number_of_line(false, "a point x y z");
        if (const std::string_view more = lines.next_word_of_line(); !more.empty())
            lines.fail_at(more, "three numbers x y z a line");
        if (!is_finite(p)) lines.fail("a coordinate is not finite");
        lines.next_line();
        points.push_back(p);
    }
    return points;
}

} // namespace

std::vector<Vec3> read_points(std::string_view bytes, const std::string& path)
{
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    const std::string_view begin = first == std::string_view::npos ? bytes : bytes.substr(first);
    std::vector<Vec3> points;
    if (begin.starts_with("# vtk"))
        points = read_vtk_legacy(bytes, path).points;
    else if (begin.starts_with("<"))
        points = read_vtk_xml(bytes, path).points;
    else if (begin.starts_with("ply\n") || begin.starts_with("ply\r"))
        points = read_ply(bytes, path).points;
    else
        points = read_xyz(bytes, path);
    for (const Vec3& p : points)
        if (!is_finite(p))
            throw GeometryError(
                fmt::format("{}: a point has a coordinate that is not finite", path));
    if (points.empty()) throw GeometryError(fmt::format("{}: has no points", path));
    return points;
}

std::vector<Vec3> read_point_file(const std::string& path)
{
    const FileMap file(path);
    return read_points(file.bytes(), path);
}

} // namespace fppg
