#include "fppg/error.h"

#include "core/finite_number.h"
#include "core/text.h"
#include "meshes/readers.h"
#include "meshes/text_lines.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace fppg
{
namespace
{

/// The cells of a line; a carriage return at its end is none of the last one.
std::vector<std::string_view> cells_of(std::string_view line)
{
    std::vector<std::string_view> cells;
    std::size_t begin = 0;
    while (begin <= line.size())
    {
        const std::size_t end = std::min(line.find(';', begin), line.size());
        cells.push_back(line.substr(begin, end - begin));
        begin = end + 1;
    }
    return cells;
}

class TableReader
{
public:
    TableReader(std::string_view bytes, const std::string& path) : lines_(bytes, path), path_(path)
    {
    }

    IndexedMesh read()
    {
        std::vector<double> xs = row(0);
        if (xs.size() < 2)
            fail(
                fmt::format("has {} values of x behind its first cell, expected 2 or more numbers "
                            "separated by ';'",
                            xs.size()));
        check_order(xs, "x");
        std::vector<double> ys;
        IndexedMesh mesh;
        while (!lines_.is_at_end())
        {
            if (is_rest_empty()) break;
            double y = 0;
            const std::vector<double> heights = row(xs.size(), &y);
            ys.push_back(y);
            check_order(ys, "y");
            for (std::size_t i = 0; i < xs.size(); ++i)
                mesh.points.push_back({xs[i], y, heights[i]});
        }
        if (ys.size() < 2)
            fail(fmt::format("the table has {} rows of heights, expected 2 or more", ys.size()));
        for (std::uint64_t j = 0; j + 1 < ys.size(); ++j)
            for (std::uint64_t i = 0; i + 1 < xs.size(); ++i)
            {
                const std::uint64_t p = j * xs.size() + i;
                mesh.polygons.add(std::array{p, p + 1, p + 1 + xs.size(), p + xs.size()});
            }
        return mesh;
    }

private:
    [[noreturn]] void fail(const std::string& text) const
    {
        throw GeometryError(fmt::format("{}:{}: {}", path_, line_, text));
    }

    bool is_rest_empty()
    {
        const std::size_t before = lines_.offset();
        const bool is_empty = lines_.next_word().empty();
        lines_.seek(before);
        return is_empty;
    }

    double number(std::string_view cell, std::size_t column) const
    {
        cell = trimmed(cell, " \t");
        if (cell.empty()) return 0;
        const std::optional<double> value = finite_signed_number(cell);
        if (!value)
            fail(
                fmt::format("expected a number in column {}, found '{}'", column + 1, shown(cell)));
        return *value;
    }

    /// The numbers of the next line behind its first cell, which is y where it is asked for.
    /// Numbers beyond `at_least` are not needed where that is not 0.
    std::vector<double> row(std::size_t at_least, double* y = nullptr)
    {
        ++line_;
        const std::vector<std::string_view> cells = cells_of(lines_.next_line());
        if (cells.size() < at_least + 1)
            fail(fmt::format("has {} cells, expected y and {} heights separated by ';'",
                             cells.size(), at_least));
        if (y != nullptr) *y = number(cells[0], 0);
        std::vector<double> values;
        const std::size_t end = at_least == 0 ? cells.size() : at_least + 1;
        for (std::size_t i = 1; i < end; ++i) values.push_back(number(cells[i], i));
        return values;
    }

    void check_order(const std::vector<double>& values, const char* axis) const
    {
        for (std::size_t i = 1; i < values.size(); ++i)
            if (values[i] < values[i - 1])
                fail(fmt::format("{} = {:g} follows {:g}, expected rising values", axis, values[i],
                                 values[i - 1]));
    }

    TextLines lines_;
    const std::string& path_;
    std::size_t line_ = 0;
};

} // namespace

IndexedMesh read_csv_bathymetry(std::string_view bytes, const std::string& path)
{
    return TableReader(bytes, path).read();
}

} // namespace fppg
