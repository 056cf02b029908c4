#include "fppg/error.h"

#include "meshes/readers.h"
#include "meshes/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace fppg
{
namespace
{

class OffReader
{
public:
    OffReader(std::string_view bytes, const std::string& path) : lines_(bytes, path) {}

    IndexedMesh read()
    {
        read_header();
        pass_remarks();
        const std::uint64_t vertices = lines_.count("vertices");
        const std::uint64_t faces = lines_.count("faces");
        lines_.next_line(); // the number of edges, which many files leave at 0
        for (std::uint64_t i = 0; i < vertices; ++i)
        {
            expect_more("vertices", i, vertices);
            read_vertex();
        }
        for (std::uint64_t i = 0; i < faces; ++i)
        {
            expect_more("faces", i, faces);
            read_face();
        }
        pass_remarks();
        if (const std::string_view word = lines_.peek_word(); !word.empty())
            lines_.fail(fmt::format("has '{}' after the last of {} faces, expected its end",
                                    shown(word), faces));
        return std::move(mesh_);
    }

private:
    /// OFF, or with C (colours), N (normals), ST (texture places) before it.
    void read_header()
    {
        pass_remarks();
        const std::string_view word = lines_.next_word();
        std::string name(word);
        for (char& c : name) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
        std::string_view prefix = name;
        if (!prefix.ends_with("OFF")) lines_.fail_at(word, "OFF, COFF, NOFF or STOFF");
        prefix.remove_suffix(3);
        if (prefix.ends_with("N") && word[word.size() - 4] == 'n')
            lines_.fail("is an nOFF file of more than three dimensions, expected OFF");
        has_more_ = !prefix.empty();
        for (const std::string_view part : {"ST", "C", "N"})
            if (prefix.starts_with(part)) prefix.remove_prefix(part.size());
        if (!prefix.empty())
            lines_.fail_at(word, "OFF, COFF, NOFF or STOFF: vertices of three coordinates");
        const std::size_t before = lines_.offset();
        if (lines_.next_word() == "BINARY")
            lines_.fail("is a binary OFF file, expected one as text");
        lines_.seek(before);
    }

    /// Remarks and empty lines.
    void pass_remarks()
    {
        while (lines_.peek_word().starts_with('#'))
        {
            lines_.next_word();
            lines_.next_line();
        }
    }

    void expect_more(const char* what, std::uint64_t done, std::uint64_t wanted)
    {
        pass_remarks();
        if (lines_.peek_word().empty())
            lines_.fail(fmt::format("the file ends after {} of {} {}", done, wanted, what));
    }

    void read_vertex()
    {
        Vec3 p;
        const std::array<const char*, 3> names{"x", "y", "z"};
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = lines_.number(false, names[static_cast<std::size_t>(axis)]);
        mesh_.points.push_back(p);
        const std::string_view more = lines_.next_word_of_line();
        if (!has_more_ && !more.empty() && !more.starts_with('#'))
            lines_.fail(
                fmt::format("a vertex has '{}' after x, y and z, expected the end of the "
                            "line; files with colours or normals begin with COFF or NOFF",
                            shown(more)));
        lines_.next_line();
    }

    /// A colour may follow.
    void read_face()
    {
        const std::uint64_t corners = lines_.count("corners");
        if (corners == 0) lines_.fail("a face has 0 corners, expected 1 or more");
        cell_.clear();
        for (std::uint64_t i = 0; i < corners; ++i)
        {
            const std::int64_t index = lines_.integer("corners");
            if (index < 0 || static_cast<std::uint64_t>(index) >= mesh_.points.size())
                lines_.fail(fmt::format("a face names vertex {}, expected 0 to {}", index,
                                        static_cast<std::int64_t>(mesh_.points.size()) - 1));
            cell_.push_back(static_cast<std::uint64_t>(index));
        }
        lines_.next_line();
        (corners == 1 ? mesh_.vertices : corners == 2 ? mesh_.lines : mesh_.polygons).add(cell_);
    }

    TextLines lines_;
    bool has_more_ = false; ///< numbers behind the coordinates
    IndexedMesh mesh_;
    std::vector<std::uint64_t> cell_;
};

} // namespace

IndexedMesh read_off(std::string_view bytes, const std::string& path)
{
    return OffReader(bytes, path).read();
}

} // namespace fppg
