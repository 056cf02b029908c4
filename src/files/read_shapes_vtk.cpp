#include "core/float32.h"
#include "fppg/error.h"
#include "fppg/read_shapes.h"
#include "platform/file_map.h"

#include <fmt/format.h>
#include <bit>
#include <charconv>
#include <string_view>

namespace fppg
{

namespace
{

class ShapeWalk
{
public:
    ShapeWalk(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

    ShapePolygons run()
    {
        ShapePolygons out;
        if (!line().starts_with("# vtk DataFile")) fail("it does not begin as a VTK file does");
        line(); // title
        const std::string_view coding = word();
        if (coding != "BINARY" && coding != "ASCII") fail("it is neither ASCII nor BINARY");
        is_binary_ = coding == "BINARY";
        if (word() != "DATASET" || word() != "POLYDATA") fail("its data set is not POLYDATA");
        bool has_points = false;
        while (true)
        {
            const std::string_view part = word();
            if (part.empty() || part == "CELL_DATA" || part == "POINT_DATA") break;
            if (part == "POINTS")
            {
                read_points(out);
                has_points = true;
            }
            else if (part == "VERTICES" || part == "LINES")
                read_cells(out, false);
            else if (part == "POLYGONS")
                read_cells(out, true);
            else
                fail(
                    fmt::format("the part \"{}\" before byte {} is unknown, expected POINTS, "
                                "VERTICES, LINES or POLYGONS",
                                part.substr(0, 40), at_));
        }
        if (!has_points) fail("it has no POINTS");
        return out;
    }

private:
    [[noreturn]] void fail(const std::string& text) const
    {
        throw IoError(fmt::format("cannot read '{}': {}", path_, text));
    }

    std::string_view line()
    {
        const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
        const std::string_view text = bytes_.substr(at_, end - at_);
        at_ = std::min(end + 1, bytes_.size());
        return text;
    }

    /// The next word and the one blank behind it; empty at the end.
    std::string_view word()
    {
        const auto is_blank = [](char c) { return c == ' ' || (c >= 9 && c <= 13); };
        while (at_ < bytes_.size() && is_blank(bytes_[at_])) ++at_;
        const std::size_t begin = at_;
        while (at_ < bytes_.size() && !is_blank(bytes_[at_])) ++at_;
        const std::string_view text = bytes_.substr(begin, at_ - begin);
        if (at_ < bytes_.size()) ++at_;
        return text;
    }

    template <typename Number>
    Number text_number()
    {
        const std::string_view text = word();
        Number value{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size())
            fail(text.empty()
                     ? std::string("it ends where a number is expected")
                     : fmt::format("\"{}\" before byte {} is no number", text.substr(0, 40), at_));
        return value;
    }

    std::uint64_t bits(std::size_t width)
    {
        if (bytes_.size() - at_ < width)
            fail(fmt::format("it ends at byte {}, within an array", bytes_.size()));
        std::uint64_t value = 0;
        for (std::size_t b = 0; b < width; ++b)
            value = value << 8U | static_cast<unsigned char>(bytes_[at_++]);
        return value;
    }

    std::uint64_t whole_number() { return is_binary_ ? bits(4) : text_number<std::uint32_t>(); }

    void read_points(ShapePolygons& out)
    {
        const auto n = text_number<std::uint64_t>();
        const std::string_view type = word();
        if (type != "float" && type != "double")
            fail(fmt::format("its points have the type {}, expected float or double", type));
        // A coordinate takes four bytes, or a digit and a blank.
        if (n > bytes_.size()) fail(fmt::format("it is too short for its {} points", n));
        const auto coordinate = [&]
        {
            if (!is_binary_) return as_float32(text_number<double>());
            if (type == "float")
                return static_cast<double>(
                    std::bit_cast<float>(static_cast<std::uint32_t>(bits(4))));
            return as_float32(std::bit_cast<double>(bits(8)));
        };
        out.vertices.resize(n);
        for (Vec3& p : out.vertices)
        {
            for (int axis = 0; axis < 3; ++axis) p[axis] = coordinate();
            if (!is_finite(p)) fail("a coordinate is not finite");
        }
    }

    void read_cells(ShapePolygons& out, bool keep)
    {
        const auto cells = text_number<std::uint64_t>();
        const auto numbers = text_number<std::uint64_t>();
        std::uint64_t used = 0;
        for (std::uint64_t c = 0; c < cells; ++c)
        {
            const std::uint64_t size = whole_number();
            used += size + 1;
            if (used > numbers)
                fail(fmt::format("a cell before byte {} has {} corners, more than its part holds",
                                 at_, size));
            std::vector<std::uint32_t> polygon;
            for (std::uint64_t i = 0; i < size; ++i)
            {
                const std::uint64_t vertex = whole_number();
                if (vertex >= out.vertices.size())
                    fail(fmt::format("a cell names the point {}, of {}", vertex,
                                     out.vertices.size()));
                polygon.push_back(static_cast<std::uint32_t>(vertex));
            }
            if (keep && size >= 3) out.polygons.push_back(std::move(polygon));
        }
        if (used != numbers) fail("the numbers of a list of cells do not fit together");
    }

    std::string_view bytes_;
    const std::string& path_;
    std::size_t at_ = 0;
    bool is_binary_ = false;
};

} // namespace

std::vector<ShapePolygons> read_shapes_vtk(const std::string& path)
{
    const FileMap file(path);
    return {ShapeWalk(file.bytes(), path).run()};
}

} // namespace fppg
