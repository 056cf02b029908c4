#include "fppg/error.h"

#include "meshes/readers.h"
#include "meshes/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

namespace fppg
{
namespace
{

/// What only tells how a mesh looks, or names parts of it.
constexpr auto passed_over = std::to_array<std::string_view>(
    {"vt", "vn", "g", "o", "s", "mg", "usemtl", "mtllib", "usemap", "maplib", "lod", "bevel",
     "c_interp", "d_interp", "shadow_obj", "trace_obj"});

/// Of curves and surfaces that are no polygons.
constexpr auto free_forms = std::to_array<std::string_view>(
    {"vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv",
     "sp", "end", "con", "ctech", "stech"});

template <typename Words>
bool holds(const Words& words, std::string_view word)
{
    return std::find(words.begin(), words.end(), word) != words.end();
}

class ObjReader
{
public:
    ObjReader(std::string_view bytes, const std::string& path) : lines_(bytes, path) {}

    IndexedMesh read()
    {
        while (!lines_.peek_word().empty())
        {
            const std::string_view keyword = lines_.next_word();
            if (keyword == "v")
                read_vertex();
            else if (keyword == "f")
                read_cell(mesh_.polygons, 3, "a face");
            else if (keyword == "l")
                read_cell(mesh_.lines, 2, "a line");
            else if (keyword == "p")
                read_cell(mesh_.vertices, 1, "a point");
            else if (holds(free_forms, keyword))
                lines_.fail(
                    fmt::format("'{}' belongs to a free-form surface, expected polygons "
                                "(f); export the mesh as triangles",
                                keyword));
            else if (!keyword.starts_with('#') && !holds(passed_over, keyword))
                lines_.fail_at(keyword, "v, f, l, p or another keyword of an OBJ file");
            pass_line();
        }
        return std::move(mesh_);
    }

private:
    /// The next word of the line, which a '\' continues on the next one.
    std::string_view next_word()
    {
        std::string_view word = lines_.next_word_of_line();
        while (word == "\\")
        {
            lines_.next_line();
            word = lines_.next_word_of_line();
        }
        return word;
    }

    void pass_line()
    {
        while (lines_.next_line().ends_with('\\')) continue;
    }

    /// A weight or a colour may follow.
    void read_vertex()
    {
        Vec3 p;
        const std::array<const char*, 3> names{"x", "y", "z"};
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = lines_.number_of_line(false, names[static_cast<std::size_t>(axis)]);
        mesh_.points.push_back(p);
    }

    void read_cell(CellLists& cells, std::size_t at_least, const char* what)
    {
        cell_.clear();
        for (std::string_view word = next_word(); !word.empty() && !word.starts_with('#');
             word = next_word())
            cell_.push_back(index_of(word));
        if (cell_.size() < at_least)
            lines_.fail(
                fmt::format("{} of {} corners, expected {} or more", what, cell_.size(), at_least));
        cells.add(cell_);
    }

    /// The vertex of "v", "v/vt", "v//vn" or "v/vt/vn": from 1, or from the last one backwards
    /// below 0.
    std::uint64_t index_of(std::string_view corner) const
    {
        std::int64_t index = 0;
        const char* const end = corner.data() + corner.size();
        const auto [rest, status] = std::from_chars(corner.data(), end, index);
        const bool is_number = status == std::errc() && (rest == end || *rest == '/') &&
                               corner.find_first_not_of("-0123456789/") == std::string_view::npos;
        if (!is_number) lines_.fail_at(corner, "a corner as v, v/vt, v//vn or v/vt/vn");
        const auto count = static_cast<std::int64_t>(mesh_.points.size());
        const std::int64_t found = index < 0 ? count + index : index - 1;
        if (found < 0 || found >= count)
            lines_.fail(
                fmt::format("names vertex {}, expected 1 to {}, or -1 to -{}: those before "
                            "it",
                            index, count, count));
        return static_cast<std::uint64_t>(found);
    }

    TextLines lines_;
    IndexedMesh mesh_;
    std::vector<std::uint64_t> cell_;
};

} // namespace

IndexedMesh read_obj(std::string_view bytes, const std::string& path)
{
    return ObjReader(bytes, path).read();
}

} // namespace fppg
