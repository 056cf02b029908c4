#include "fppg/error.h"

#include "meshes/readers.h"
#include "meshes/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

namespace fppg
{
namespace
{

enum class Number : std::uint8_t
{
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Float32,
    Float64,
};

std::optional<Number> number_named(std::string_view name)
{
    struct Name
    {
        std::string_view name;
        Number number;
    };
    static constexpr std::array<Name, 16> names{{{"char", Number::Int8},
                                                 {"int8", Number::Int8},
                                                 {"uchar", Number::UInt8},
                                                 {"uint8", Number::UInt8},
                                                 {"short", Number::Int16},
                                                 {"int16", Number::Int16},
                                                 {"ushort", Number::UInt16},
                                                 {"uint16", Number::UInt16},
                                                 {"int", Number::Int32},
                                                 {"int32", Number::Int32},
                                                 {"uint", Number::UInt32},
                                                 {"uint32", Number::UInt32},
                                                 {"float", Number::Float32},
                                                 {"float32", Number::Float32},
                                                 {"double", Number::Float64},
                                                 {"float64", Number::Float64}}};
    for (const Name& n : names)
        if (n.name == name) return n.number;
    return std::nullopt;
}

std::size_t width_of(Number number)
{
    switch (number)
    {
        case Number::Int8:
        case Number::UInt8:
            return 1;
        case Number::Int16:
        case Number::UInt16:
            return 2;
        case Number::Float64:
            return 8;
        default:
            return 4;
    }
}

bool is_real(Number number)
{
    return number == Number::Float32 || number == Number::Float64;
}

struct Property
{
    std::string name;
    Number type = Number::Float32;
    std::optional<Number> count_type; ///< of a list
};

struct PlyElement
{
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

/// The numbers of one element, by property.
using Values = std::vector<std::vector<double>>;

enum class Encoding : std::uint8_t
{
    Text,
    Little,
    Big,
};

class PlyReader
{
public:
    PlyReader(std::string_view bytes, const std::string& path)
        : bytes_(bytes), path_(path), lines_(bytes, path)
    {
    }

    IndexedMesh read()
    {
        read_header();
        const bool has_vertices =
            std::any_of(elements_.begin(), elements_.end(),
                        [](const PlyElement& e) { return e.name == "vertex"; });
        if (!has_vertices)
            throw GeometryError(fmt::format("{}: its header has no element vertex", path_));
        at_ = lines_.offset();
        for (const PlyElement& element : elements_) read_element(element);
        check_end();
        return std::move(mesh_);
    }

private:
    void read_header()
    {
        if (lines_.next_word_of_line() != "ply")
            throw GeometryError(
                fmt::format("{}:1: is no PLY file: expected 'ply' on its first line", path_));
        lines_.next_line();
        bool has_format = false;
        for (;;)
        {
            if (lines_.is_at_end()) lines_.fail("the header has no 'end_header'");
            const std::string_view word = lines_.next_word_of_line();
            if (word == "end_header") break;
            if (word == "format")
            {
                read_format();
                has_format = true;
            }
            else if (word == "element")
            {
                PlyElement element;
                element.name = lines_.next_word_of_line();
                element.count = lines_.count("elements");
                elements_.push_back(std::move(element));
            }
            else if (word == "property")
                read_property();
            else if (word != "comment" && word != "obj_info" && !word.empty())
                lines_.fail_at(word, "format, element, property, comment or end_header");
            lines_.next_line();
        }
        if (!has_format) lines_.fail("the header has no line 'format'");
        lines_.next_line();
    }

    void read_format()
    {
        const std::string_view word = lines_.next_word_of_line();
        if (word == "ascii")
            encoding_ = Encoding::Text;
        else if (word == "binary_little_endian")
            encoding_ = Encoding::Little;
        else if (word == "binary_big_endian")
            encoding_ = Encoding::Big;
        else
            lines_.fail_at(word, "ascii, binary_little_endian or binary_big_endian");
    }

    Number read_type()
    {
        const std::string_view word = lines_.next_word_of_line();
        const auto number = number_named(word);
        if (!number) lines_.fail_at(word, "a type like float, int or uchar");
        return *number;
    }

    void read_property()
    {
        if (elements_.empty()) lines_.fail("a property comes before the first element");
        Property property;
        const std::size_t before = lines_.offset();
        if (lines_.next_word_of_line() == "list")
        {
            property.count_type = read_type();
            if (is_real(*property.count_type))
                lines_.fail("the length of a list is no whole number");
        }
        else
            lines_.seek(before);
        property.type = read_type();
        property.name = lines_.next_word_of_line();
        if (property.name.empty()) lines_.fail_at({}, "the name of the property");
        elements_.back().properties.push_back(std::move(property));
    }

    /// The position of a property that must be there.
    std::size_t find(const PlyElement& element, std::initializer_list<std::string_view> names,
                     bool is_list) const
    {
        for (std::size_t i = 0; i < element.properties.size(); ++i)
        {
            const Property& p = element.properties[i];
            if (p.count_type.has_value() == is_list &&
                std::find(names.begin(), names.end(), p.name) != names.end())
                return i;
        }
        throw GeometryError(fmt::format("{}: its element {} has no {} {}", path_, element.name,
                                        is_list ? "list" : "property", *names.begin()));
    }

    void read_element(const PlyElement& element)
    {
        check_size(element);
        if (element.name == "vertex")
            read_vertices(element);
        else if (element.name == "face")
        {
            const std::size_t list = find(element, {"vertex_indices", "vertex_index"}, true);
            check_whole(element, list);
            for_each(element,
                     [&](const Values& values) { add_cell(mesh_.polygons, values[list]); });
        }
        else if (element.name == "tristrips")
        {
            const std::size_t list = find(element, {"vertex_indices", "vertex_index"}, true);
            check_whole(element, list);
            for_each(element, [&](const Values& values) { add_strips(values[list]); });
        }
        else
        {
            for_each(element, [](const Values&) {});
            if (element.count > 0)
                mesh_.warnings.push_back(fmt::format("{} elements '{}' are not used.",
                                                     element.count, shown(element.name)));
        }
    }

    void check_whole(const PlyElement& element, std::size_t list) const
    {
        if (is_real(element.properties[list].type))
            throw GeometryError(
                fmt::format("{}: the point numbers of its element {} have a type "
                            "that is no whole number",
                            path_, element.name));
    }

    /// Sizes are checked before memory is taken for them.
    void check_size(const PlyElement& element)
    {
        std::size_t least = 0;
        for (const Property& p : element.properties)
            least += encoding_ == Encoding::Text ? 1 : width_of(p.count_type.value_or(p.type));
        const std::size_t left = bytes_.size() - std::min(at_, bytes_.size());
        if (least == 0 && element.count > 0)
            throw GeometryError(
                fmt::format("{}: its element {} has no property", path_, element.name));
        if (element.count > 0 && element.count > left / least + 1)
            throw GeometryError(fmt::format(
                "{}: is truncated, or a count is wrong: {} elements '{}' need at least {} bytes "
                "each, {} bytes are left at byte {}",
                path_, element.count, shown(element.name), least, left, at_));
    }

    void read_vertices(const PlyElement& element)
    {
        const std::array<std::size_t, 3> axes{
            find(element, {"x"}, false), find(element, {"y"}, false), find(element, {"z"}, false)};
        mesh_.has_float32 = element.properties[axes[0]].type == Number::Float32;
        mesh_.points.reserve(element.count);
        for_each(element,
                 [&](const Values& v) {
                     mesh_.points.push_back({v[axes[0]][0], v[axes[1]][0], v[axes[2]][0]});
                 });
    }

    static std::uint64_t point_number(double value)
    {
        // A negative number is none of a point; it stays negative in the message. As a double the
        // largest whole number of a text is 2^63, which is none of 64 bits.
        constexpr double most = 9e18;
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::min(value, most)));
    }

    void add_cell(CellLists& cells, const std::vector<double>& numbers)
    {
        cell_.clear();
        for (const double n : numbers) cell_.push_back(point_number(n));
        cells.add(cell_);
    }

    /// -1 ends a strip.
    void add_strips(const std::vector<double>& numbers)
    {
        cell_.clear();
        for (const double n : numbers)
        {
            if (n >= 0)
            {
                cell_.push_back(point_number(n));
                continue;
            }
            if (!cell_.empty()) mesh_.strips.add(cell_);
            cell_.clear();
        }
        if (!cell_.empty()) mesh_.strips.add(cell_);
    }

    template <typename Body>
    void for_each(const PlyElement& element, const Body& body)
    {
        Values values(element.properties.size());
        for (std::uint64_t i = 0; i < element.count; ++i)
        {
            if (encoding_ == Encoding::Text)
                read_line(element, i, values);
            else
                for (std::size_t p = 0; p < values.size(); ++p)
                    read_binary(element, i, element.properties[p], values[p]);
            body(values);
        }
    }

    void read_line(const PlyElement& element, std::uint64_t i, Values& values)
    {
        if (lines_.peek_word().empty())
            lines_.fail(fmt::format("the file ends after {} of {} elements '{}'", i, element.count,
                                    shown(element.name)));
        // Empty lines between elements mean nothing.
        const std::string_view first = lines_.next_word();
        lines_.seek(lines_.offset() - first.size());
        for (std::size_t p = 0; p < values.size(); ++p)
        {
            const Property& property = element.properties[p];
            std::uint64_t n = 1;
            if (property.count_type)
            {
                const std::int64_t length = lines_.integer_of_line(property.name.c_str());
                // A list has at least two characters a number.
                if (length < 0 || static_cast<std::uint64_t>(length) > bytes_.size())
                    lines_.fail(
                        fmt::format("the list {} has {} numbers", shown(property.name), length));
                n = static_cast<std::uint64_t>(length);
            }
            values[p].resize(n);
            for (double& v : values[p])
                v = is_real(property.type)
                        ? lines_.number_of_line(property.type == Number::Float32,
                                                property.name.c_str())
                        : static_cast<double>(lines_.integer_of_line(property.name.c_str()));
        }
        if (const std::string_view rest = lines_.next_word_of_line(); !rest.empty())
            lines_.fail_at(rest, fmt::format("the end of element {} of {} '{}'", i + 1,
                                             element.count, shown(element.name)));
        lines_.next_line();
        at_ = lines_.offset();
    }

    void read_binary(const PlyElement& element, std::uint64_t i, const Property& property,
                     std::vector<double>& values)
    {
        double n = 1;
        if (property.count_type) n = take(element, i, *property.count_type);
        const std::size_t width = width_of(property.type);
        const std::size_t most = (bytes_.size() - at_) / width;
        if (n < 0 || n > static_cast<double>(most))
            throw GeometryError(
                fmt::format("{}: is truncated, or a count is wrong: element {} of {} '{}' has {} "
                            "numbers in {}, {} bytes are left at byte {}",
                            path_, i + 1, element.count, shown(element.name), n,
                            shown(property.name), bytes_.size() - at_, at_));
        values.resize(static_cast<std::size_t>(n));
        for (double& v : values) v = take(element, i, property.type);
    }

    double take(const PlyElement& element, std::uint64_t i, Number type)
    {
        const std::size_t width = width_of(type);
        if (bytes_.size() - at_ < width)
            throw GeometryError(
                fmt::format("{}: is truncated: it ends at byte {}, within element "
                            "{} of {} '{}'",
                            path_, bytes_.size(), i + 1, element.count, shown(element.name)));
        std::uint64_t bits = 0;
        for (std::size_t b = 0; b < width; ++b)
        {
            const std::size_t place = encoding_ == Encoding::Big ? b : width - 1 - b;
            bits = bits << 8U | static_cast<unsigned char>(bytes_[at_ + place]);
        }
        at_ += width;
        switch (type)
        {
            case Number::Int8:
                return static_cast<std::int8_t>(bits);
            case Number::UInt8:
                return static_cast<std::uint8_t>(bits);
            case Number::Int16:
                return static_cast<std::int16_t>(bits);
            case Number::UInt16:
                return static_cast<std::uint16_t>(bits);
            case Number::Int32:
                return static_cast<std::int32_t>(bits);
            case Number::UInt32:
                return static_cast<std::uint32_t>(bits);
            case Number::Float32:
                return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
            case Number::Float64:
                return std::bit_cast<double>(bits);
        }
        return 0;
    }

    void check_end()
    {
        if (encoding_ == Encoding::Text)
        {
            if (const std::string_view word = lines_.next_word(); !word.empty())
                lines_.fail(
                    fmt::format("found '{}' after the last element; a count of the header is "
                                "too small",
                                shown(word)));
        }
        else if (at_ < bytes_.size())
            mesh_.warnings.push_back(
                fmt::format("{} bytes after the last element are ignored.", bytes_.size() - at_));
    }

    std::string_view bytes_;
    const std::string& path_;
    TextLines lines_;
    Encoding encoding_ = Encoding::Text;
    std::vector<PlyElement> elements_;
    std::size_t at_ = 0; ///< in `bytes_`, behind the header
    IndexedMesh mesh_;
    std::vector<std::uint64_t> cell_;
};

} // namespace

IndexedMesh read_ply(std::string_view bytes, const std::string& path)
{
    return PlyReader(bytes, path).read();
}

} // namespace fppg
