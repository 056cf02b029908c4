#include "fppg/error.h"

#include "core/text.h"
#include "meshes/readers.h"
#include "meshes/text_lines.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace fppg
{
namespace
{

/// Bytes of a number of this VTK type; 0 for one that is not known.
std::size_t width_of(std::string_view type)
{
    if (type == "unsigned_char" || type == "char") return 1;
    if (type == "unsigned_short" || type == "short") return 2;
    if (type == "unsigned_int" || type == "int" || type == "float") return 4;
    if (type == "unsigned_long" || type == "long" || type == "double" || type == "vtktypeint64" ||
        type == "vtkIdType")
        return 8;
    return 0;
}

class VtkLegacyReader
{
public:
    VtkLegacyReader(std::string_view bytes, const std::string& path)
        : bytes_(bytes), path_(path), lines_(bytes, path)
    {
    }

    IndexedMesh read()
    {
        read_header();
        for (;;)
        {
            const std::string_view key = lines_.next_word();
            if (key.empty()) break;
            if (key == "POINT_DATA" || key == "CELL_DATA") break; // what follows is not drawn
            read_part(key);
        }
        if (!has_points_) throw GeometryError(fmt::format("{}: has no part POINTS", path_));
        if (is_grid_) add_grid_cells();
        return std::move(mesh_);
    }

private:
    void read_header()
    {
        if (!lines_.next_line().starts_with("# vtk DataFile"))
            throw GeometryError(
                fmt::format("{}:1: is no VTK file: expected '# vtk DataFile Version ...'", path_));
        lines_.next_line(); // title
        const std::string_view encoding = lines_.next_word();
        if (encoding != "ASCII" && encoding != "BINARY")
            lines_.fail_at(encoding, "ASCII or BINARY");
        is_text_ = encoding == "ASCII";
        const std::string_view key = lines_.next_word();
        if (key != "DATASET") lines_.fail_at(key, "DATASET");
        const std::string_view kind = lines_.next_word();
        is_grid_ = kind == "UNSTRUCTURED_GRID";
        if (!is_grid_ && kind != "POLYDATA")
            lines_.fail_at(kind, "a data set POLYDATA or UNSTRUCTURED_GRID");
        lines_.next_line();
    }

    void read_part(std::string_view key)
    {
        if (key == "POINTS")
            read_points();
        else if (key == "VERTICES" && !is_grid_)
            read_cells(mesh_.vertices, "VERTICES");
        else if (key == "LINES" && !is_grid_)
            read_cells(mesh_.lines, "LINES");
        else if (key == "POLYGONS" && !is_grid_)
            read_cells(mesh_.polygons, "POLYGONS");
        else if (key == "TRIANGLE_STRIPS" && !is_grid_)
            read_cells(mesh_.strips, "TRIANGLE_STRIPS");
        else if (key == "CELLS" && is_grid_)
            read_cells(grid_cells_, "CELLS");
        else if (key == "CELL_TYPES" && is_grid_)
        {
            const std::uint64_t n = lines_.count("CELL_TYPES");
            types_ = integers("int", n, "CELL_TYPES");
        }
        else if (key == "METADATA")
        {
            // The block ends with an empty line.
            lines_.next_line();
            while (!lines_.is_at_end() && !trimmed(lines_.next_line()).empty()) continue;
        }
        else if (key == "FIELD")
            skip_fields();
        else
            lines_.fail_at(key, is_grid_ ? "POINTS, CELLS or CELL_TYPES"
                                         : "POINTS, VERTICES, LINES, POLYGONS or TRIANGLE_STRIPS");
    }

    void read_points()
    {
        const std::uint64_t n = lines_.count("POINTS");
        const std::string type(lines_.next_word());
        if (width_of(type) == 0) lines_.fail_at(type, "a type like float or double");
        lines_.next_line();
        check_size(n, 3, is_text_ ? 2 : width_of(type), "POINTS");
        mesh_.has_float32 = type == "float";
        mesh_.points.resize(n);
        if (is_text_)
        {
            for (Vec3& p : mesh_.points)
                for (int axis = 0; axis < 3; ++axis)
                    p[axis] = lines_.number(mesh_.has_float32, "POINTS");
        }
        else
        {
            std::size_t at = lines_.offset();
            for (Vec3& p : mesh_.points)
                for (int axis = 0; axis < 3; ++axis) p[axis] = real(type, at);
            lines_.seek(at);
        }
        has_points_ = true;
    }

    /// Throws where `n` times `components` numbers of at least `width` bytes cannot be there.
    void check_size(std::uint64_t n, std::uint64_t components, std::size_t width,
                    const char* part) const
    {
        // The last number of a text has no blank behind it.
        const std::uint64_t left = bytes_.size() - lines_.offset() + (is_text_ ? 1 : 0);
        if (n > left / width / components)
            throw GeometryError(fmt::format(
                "{}: is truncated, or a count is wrong: {} says {} times {} numbers, {} bytes are "
                "left at byte {}",
                path_, part, n, components, bytes_.size() - lines_.offset(), lines_.offset()));
    }

    std::uint64_t bits_at(std::size_t& at, std::size_t width) const
    {
        std::uint64_t bits = 0;
        for (std::size_t b = 0; b < width; ++b)
            bits = bits << 8U | static_cast<unsigned char>(bytes_[at++]);
        return bits;
    }

    std::int64_t integer(std::string_view type, std::size_t& at) const
    {
        const std::size_t width = width_of(type);
        const std::uint64_t bits = bits_at(at, width);
        if (type.starts_with("unsigned")) return static_cast<std::int64_t>(bits);
        if (width == 4) return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits));
        if (width == 2) return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
        if (width == 1) return static_cast<std::int8_t>(static_cast<std::uint8_t>(bits));
        return static_cast<std::int64_t>(bits);
    }

    double real(std::string_view type, std::size_t& at) const
    {
        if (type == "float")
            return static_cast<double>(
                std::bit_cast<float>(static_cast<std::uint32_t>(bits_at(at, 4))));
        if (type == "double") return std::bit_cast<double>(bits_at(at, 8));
        return static_cast<double>(integer(type, at));
    }

    std::vector<std::uint64_t> integers(const std::string& type, std::uint64_t n, const char* part)
    {
        if (width_of(type) == 0 || type == "float" || type == "double")
            lines_.fail_at(type, "a type of whole numbers like int or vtktypeint64");
        if (!is_text_) lines_.next_line();
        check_size(n, 1, is_text_ ? 2 : width_of(type), part);
        std::vector<std::uint64_t> out(n);
        if (is_text_)
        {
            for (auto& v : out) v = static_cast<std::uint64_t>(lines_.integer(part));
            return out;
        }
        std::size_t at = lines_.offset();
        for (auto& v : out) v = static_cast<std::uint64_t>(integer(type, at));
        lines_.seek(at);
        return out;
    }

    /// Since version 5.0 cells are an array of offsets and one of points; before, each cell is the
    /// number of its points and they.
    void read_cells(CellLists& cells, const char* part)
    {
        const std::uint64_t first = lines_.count(part);
        const std::uint64_t second = lines_.count(part);
        const std::size_t before = lines_.offset();
        lines_.next_line();
        if (bytes_.substr(lines_.offset()).starts_with("OFFSETS"))
        {
            lines_.next_word();
            std::string type(lines_.next_word());
            const std::vector<std::uint64_t> offsets = integers(type, first, part);
            const std::string_view key = lines_.next_word();
            if (key != "CONNECTIVITY") lines_.fail_at(key, "CONNECTIVITY");
            type = lines_.next_word();
            const std::vector<std::uint64_t> points = integers(type, second, part);
            for (std::size_t i = 1; i < offsets.size(); ++i)
            {
                if (offsets[i] < offsets[i - 1] || offsets[i] > points.size())
                    throw GeometryError(fmt::format(
                        "{}: offset {} of {} is {}, expected one from {} to {}", path_, i, part,
                        static_cast<std::int64_t>(offsets[i]), offsets[i - 1], points.size()));
                cells.add(std::span(points).subspan(offsets[i - 1], offsets[i] - offsets[i - 1]));
            }
            return;
        }
        lines_.seek(before);
        const std::vector<std::uint64_t> numbers = integers("int", second, part);
        std::size_t at = 0;
        for (std::uint64_t i = 0; i < first; ++i)
        {
            if (at >= numbers.size() || numbers[at] > numbers.size() - at - 1)
                throw GeometryError(fmt::format(
                    "{}: {} says {} cells in {} numbers; cell {} does not fit, expected a length "
                    "of 0 to {}",
                    path_, part, first, second, i,
                    static_cast<std::int64_t>(numbers.size() - std::min(numbers.size(), at)) - 1));
            cells.add(std::span(numbers).subspan(at + 1, numbers[at]));
            at += 1 + numbers[at];
        }
        if (at != numbers.size())
            throw GeometryError(fmt::format("{}: {} says {} cells in {} numbers; they end after {}",
                                            path_, part, first, second, at));
    }

    void skip_fields()
    {
        lines_.next_word();
        for (std::uint64_t n = lines_.count("FIELD"); n > 0; --n)
        {
            lines_.next_word();
            const std::uint64_t components = lines_.count("FIELD");
            const std::uint64_t tuples = lines_.count("FIELD");
            const std::string type(lines_.next_word());
            lines_.next_line();
            const std::size_t width = width_of(type);
            if (width == 0) lines_.fail_at(type, "a type like float or int");
            if (components == 0) continue;
            check_size(tuples, components, is_text_ ? 2 : width, "FIELD");
            if (is_text_)
                for (std::uint64_t i = 0; i < tuples * components; ++i) lines_.next_word();
            else
                lines_.seek(lines_.offset() + tuples * components * width);
        }
    }

    void add_grid_cells()
    {
        if (types_.size() != grid_cells_.size())
            throw GeometryError(fmt::format("{}: has {} CELLS and {} CELL_TYPES, expected as many",
                                            path_, grid_cells_.size(), types_.size()));
        for (std::size_t i = 0; i < types_.size(); ++i)
            if (types_[i] > 255 ||
                !add_vtk_cell(mesh_, static_cast<int>(types_[i]), grid_cells_[i]))
                throw GeometryError(fmt::format(
                    "{}: cell {} has the type {}, expected a surface, a line or a point (types 1 "
                    "to 9); take the surface out of the volume first",
                    path_, i, static_cast<std::int64_t>(types_[i])));
    }

    std::string_view bytes_;
    const std::string& path_;
    TextLines lines_;
    bool is_text_ = true;
    bool is_grid_ = false;
    bool has_points_ = false;
    IndexedMesh mesh_;
    CellLists grid_cells_;
    std::vector<std::uint64_t> types_;
};

} // namespace

IndexedMesh read_vtk_legacy(std::string_view bytes, const std::string& path)
{
    return VtkLegacyReader(bytes, path).read();
}

} // namespace fppg
