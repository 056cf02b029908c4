#include "fppg/error.h"

#include "meshes/readers.h"
#include "meshes/text_lines.h"

#include <fmt/format.h>
#include <tinyxml2.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cstring>

namespace fppg
{
namespace
{

using tinyxml2::XMLElement;

struct NumberType
{
    std::size_t width = 0;
    bool is_real = false;
    bool is_signed = false;
};

/// Types as `Float32`, `Int64`, `UInt8`; width 0 for one that is not known.
NumberType number_type(std::string_view name)
{
    const auto width_behind = [&](std::size_t letters) -> std::size_t
    {
        const std::string_view bits = name.substr(letters);
        return bits == "8" ? 1 : bits == "16" ? 2 : bits == "32" ? 4 : bits == "64" ? 8 : 0;
    };
    if (name.starts_with("Float"))
    {
        const std::size_t width = width_behind(5);
        return {width >= 4 ? width : 0, true, true};
    }
    if (name.starts_with("UInt")) return {width_behind(4), false, false};
    if (name.starts_with("Int")) return {width_behind(3), false, true};
    return {};
}

class VtkXmlReader
{
public:
    VtkXmlReader(std::string_view bytes, const std::string& path) : path_(path)
    {
        // What is appended raw is no XML: it is set aside before the rest is parsed.
        std::string text(bytes);
        const std::size_t tag = text.find("<AppendedData");
        if (tag != std::string::npos)
        {
            const std::size_t mark = text.find('>', tag);
            const std::size_t begin = mark == std::string::npos ? mark : text.find('_', mark);
            if (begin == std::string::npos)
                throw GeometryError(
                    fmt::format("{}: its AppendedData do not begin with '_'", path_));
            const std::size_t end = text.rfind("</AppendedData>");
            const std::size_t stop = end == std::string::npos || end < begin ? text.size() : end;
            appended_ = bytes.substr(begin + 1, stop - begin - 1);
            text.erase(begin, stop - begin);
            if (stop == end) end_is_there_ = true;
        }
        const tinyxml2::XMLError error = document_.Parse(text.data(), text.size());
        if (error != tinyxml2::XML_SUCCESS)
            throw GeometryError(fmt::format(
                "{}:{}: is not well-formed XML ({}){}", path_, document_.ErrorLineNum(),
                tinyxml2::XMLDocument::ErrorIDToName(error),
                appended_.empty() || end_is_there_ ? "" : "; its AppendedData do not end"));
    }

    IndexedMesh read()
    {
        const XMLElement* root = document_.RootElement();
        if (root == nullptr || std::string_view(root->Name()) != "VTKFile")
            throw GeometryError(
                fmt::format("{}: is no VTK XML file: its root is not <VTKFile>", path_));
        const std::string_view kind = text_of(*root, "type", "");
        if (kind != "PolyData" && kind != "UnstructuredGrid")
            fail(*root, fmt::format("its type is \"{}\", expected PolyData or UnstructuredGrid",
                                    shown(kind)));
        is_big_endian_ =
            std::string_view(text_of(*root, "byte_order", "LittleEndian")) == "BigEndian";
        header_width_ =
            std::string_view(text_of(*root, "header_type", "UInt32")) == "UInt64" ? 8 : 4;
        const std::string_view compressor = text_of(*root, "compressor", "");
        is_compressed_ = !compressor.empty();
        if (is_compressed_ && compressor != "vtkZLibDataCompressor")
            fail(*root, fmt::format("its data are compressed by \"{}\", expected none or "
                                    "vtkZLibDataCompressor",
                                    shown(compressor)));
        if (const XMLElement* data = root->FirstChildElement("AppendedData"))
            is_appended_raw_ = std::string_view(text_of(*data, "encoding", "raw")) == "raw";
        const XMLElement& set = child(*root, kind.data());
        for (const XMLElement* piece = set.FirstChildElement("Piece"); piece != nullptr;
             piece = piece->NextSiblingElement("Piece"))
            read_piece(*piece, kind == "PolyData");
        return std::move(mesh_);
    }

private:
    [[noreturn]] void fail(const XMLElement& e, const std::string& text) const
    {
        throw GeometryError(fmt::format("{}:{}: <{}>: {}", path_, e.GetLineNum(), e.Name(), text));
    }

    static const char* text_of(const XMLElement& e, const char* name, const char* otherwise)
    {
        const char* value = e.Attribute(name);
        return value == nullptr ? otherwise : value;
    }

    const XMLElement& child(const XMLElement& e, const char* name) const
    {
        const XMLElement* found = e.FirstChildElement(name);
        if (found == nullptr) fail(e, fmt::format("the element <{}> is missing in it", name));
        return *found;
    }

    std::uint64_t count_of(const XMLElement& e, const char* name) const
    {
        const char* text = e.Attribute(name);
        if (text == nullptr) return 0;
        std::uint64_t value = 0;
        if (!tinyxml2::XMLUtil::ToUnsigned64(text, &value) || text[0] == '-')
            fail(e, fmt::format("{}=\"{}\" is invalid, expected a count", name, shown(text)));
        return value;
    }

    void read_piece(const XMLElement& piece, bool is_poly)
    {
        const std::size_t base = mesh_.points.size();
        read_points(piece);
        if (is_poly)
        {
            read_cells(piece, "Verts", "NumberOfVerts", mesh_.vertices, base);
            read_cells(piece, "Lines", "NumberOfLines", mesh_.lines, base);
            read_cells(piece, "Polys", "NumberOfPolys", mesh_.polygons, base);
            read_cells(piece, "Strips", "NumberOfStrips", mesh_.strips, base);
            return;
        }
        CellLists cells;
        read_cells(piece, "Cells", "NumberOfCells", cells, base);
        if (cells.size() == 0) return;
        const XMLElement& array = array_named(child(piece, "Cells"), "types");
        const std::vector<std::uint64_t> types = integers(array, cells.size());
        for (std::size_t i = 0; i < types.size(); ++i)
            if (types[i] > 255 || !add_vtk_cell(mesh_, static_cast<int>(types[i]), cells[i]))
                fail(array, fmt::format("cell {} has the type {}, expected a surface, a line or a "
                                        "point (types 1 to 9); take the surface out of the volume "
                                        "first",
                                        i, static_cast<std::int64_t>(types[i])));
    }

    void read_points(const XMLElement& piece)
    {
        const std::uint64_t n = count_of(piece, "NumberOfPoints");
        if (n == 0) return;
        const XMLElement& array = child(child(piece, "Points"), "DataArray");
        const NumberType type = type_of(array);
        const std::string_view components = text_of(array, "NumberOfComponents", "3");
        if (components != "3")
            fail(array, fmt::format("NumberOfComponents is {}, expected 3", shown(components)));
        mesh_.has_float32 = type.is_real && type.width == 4;
        const std::size_t base = mesh_.points.size();
        with_numbers(
            array, n, 3,
            [&](std::size_t i, auto value)
            { mesh_.points[base + i / 3][static_cast<int>(i % 3)] = static_cast<double>(value); },
            [&] { mesh_.points.resize(base + n); });
    }

    const XMLElement& array_named(const XMLElement& e, std::string_view name) const
    {
        for (const XMLElement* a = e.FirstChildElement("DataArray"); a != nullptr;
             a = a->NextSiblingElement("DataArray"))
            if (text_of(*a, "Name", "") == name) return *a;
        fail(e, fmt::format("there is no DataArray named {} in it", name));
    }

    void read_cells(const XMLElement& piece, const char* name, const char* count_name,
                    CellLists& cells, std::size_t base)
    {
        const std::uint64_t n = count_of(piece, count_name);
        if (n == 0) return;
        const XMLElement& e = child(piece, name);
        const XMLElement& offset_array = array_named(e, "offsets");
        const std::vector<std::uint64_t> ends = integers(offset_array, n);
        for (std::size_t i = 0; i < ends.size(); ++i)
            if (static_cast<std::int64_t>(ends[i]) <
                (i == 0 ? 0 : static_cast<std::int64_t>(ends[i - 1])))
                fail(offset_array, fmt::format("offset {} is {}, smaller than the one before", i,
                                               static_cast<std::int64_t>(ends[i])));
        std::vector<std::uint64_t> points;
        if (ends.back() > 0) points = integers(array_named(e, "connectivity"), ends.back());
        const std::size_t n_points = mesh_.points.size() - base;
        for (std::uint64_t& p : points)
        {
            if (p >= n_points)
                fail(e, fmt::format(
                            "its connectivity names point {}, expected a number from 0 to {}",
                            static_cast<std::int64_t>(p), static_cast<std::int64_t>(n_points) - 1));
            p += base;
        }
        std::uint64_t begin = 0;
        for (const std::uint64_t end : ends)
        {
            cells.add(std::span(points).subspan(begin, end - begin));
            begin = end;
        }
    }

    NumberType type_of(const XMLElement& array) const
    {
        const std::string_view name = text_of(array, "type", "");
        const NumberType type = number_type(name);
        if (type.width == 0)
            fail(array, fmt::format("its type is \"{}\", expected one like Float32 or Int64",
                                    shown(name)));
        return type;
    }

    std::vector<std::uint64_t> integers(const XMLElement& array, std::uint64_t n)
    {
        if (type_of(array).is_real) fail(array, "has a type that is no whole number");
        std::vector<std::uint64_t> out;
        with_numbers(
            array, n, 1,
            [&](std::size_t i, auto value)
            { out[i] = static_cast<std::uint64_t>(static_cast<std::int64_t>(value)); },
            [&] { out.resize(n); });
        return out;
    }

    /// Calls take(i, value) for the n times `components` numbers of an array, after `prepare`,
    /// which takes memory for them once they are known to be there.
    template <typename Take, typename Prepare>
    void with_numbers(const XMLElement& array, std::uint64_t n, std::uint64_t components,
                      const Take& take, const Prepare& prepare)
    {
        const NumberType type = type_of(array);
        const std::string_view format = text_of(array, "format", "ascii");
        if (format == "ascii")
        {
            const std::string_view text = array.GetText() == nullptr ? "" : array.GetText();
            if (n > (text.size() + 1) / 2 / components)
                fail(array, fmt::format("has {} bytes, too few for {} times {} numbers",
                                        text.size(), n, components));
            prepare();
            TextLines lines(text, path_);
            for (std::size_t i = 0; i < n * components; ++i)
            {
                if (lines.peek_word().empty())
                    fail(array, fmt::format("has {} numbers, expected {}", i, n * components));
                try
                {
                    if (type.is_real)
                        take(i, lines.number(type.width == 4, "the array"));
                    else
                        take(i, lines.integer("the array"));
                }
                catch (const GeometryError&)
                {
                    fail(array, fmt::format("number {} cannot be read", i));
                }
            }
            if (!lines.peek_word().empty())
                fail(array, fmt::format("has more than {} numbers", n * components));
            return;
        }
        const std::string data = bytes_of(array, format);
        if (data.size() / type.width / components < n || data.size() % type.width != 0)
            fail(array, fmt::format("has {} bytes of data, expected {} times {} numbers of {}",
                                    data.size(), n, components, type.width));
        prepare();
        for (std::size_t i = 0; i < n * components; ++i)
        {
            const std::uint64_t bits = bits_at(data, i * type.width, type.width);
            if (!type.is_real)
                take(i, type.is_signed ? sign_extended(bits, type.width)
                                       : static_cast<std::int64_t>(bits));
            else if (type.width == 4)
                take(i,
                     static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits))));
            else
                take(i, std::bit_cast<double>(bits));
        }
    }

    static std::int64_t sign_extended(std::uint64_t bits, std::size_t width)
    {
        const std::size_t unused = 64 - 8 * width;
        return static_cast<std::int64_t>(bits << unused) >> unused;
    }

    std::uint64_t bits_at(std::string_view data, std::size_t at, std::size_t width) const
    {
        std::uint64_t bits = 0;
        for (std::size_t b = 0; b < width; ++b)
            bits = bits << 8U |
                   static_cast<unsigned char>(data[at + (is_big_endian_ ? b : width - 1 - b)]);
        return bits;
    }

    /// Arrays may share appended data, but a small file whose many arrays all name one large block
    /// would take a time and memory that grow with the square of its size.
    void count_appended(const XMLElement& array, std::size_t bytes)
    {
        constexpr std::size_t most_shared = 16;
        constexpr std::size_t small = 1 << 16;
        taken_ += bytes;
        if (taken_ > most_shared * appended_.size() + small)
            fail(array, fmt::format("the arrays up to this one take {} bytes of appended data, "
                                    "more than {} times the {} that there are",
                                    taken_, most_shared, appended_.size()));
    }

    /// The data of an array, decoded and inflated.
    std::string bytes_of(const XMLElement& array, std::string_view format)
    {
        if (format == "binary")
        {
            const char* text = array.GetText();
            const std::string_view own = text == nullptr ? "" : text;
            return unpacked(array, own, true).data;
        }
        if (format != "appended")
            fail(array, fmt::format("its format is \"{}\", expected ascii, binary or appended",
                                    shown(format)));
        const std::uint64_t offset = count_of(array, "offset");
        if (offset > appended_.size())
            fail(array, fmt::format("its offset is {}, the appended data have {} bytes", offset,
                                    appended_.size()));
        Unpacked out = unpacked(array, appended_.substr(offset), !is_appended_raw_);
        count_appended(array, out.taken);
        return std::move(out.data);
    }

    /// Reads bytes from raw data or from base64.
    class ByteSource
    {
    public:
        ByteSource(std::string_view source, bool is_base64) : source_(source), is_base64_(is_base64)
        {
            if (!is_base64) return;
            while (at_ < source_.size() && is_blank(source_[at_])) ++at_;
        }

        /// The next n bytes, as one run of base64, which ends with its padding; fewer where the
        /// source ends.
        std::string take(std::uint64_t n)
        {
            if (!is_base64_)
            {
                const std::string_view found = source_.substr(at_, n);
                at_ += found.size();
                return std::string(found);
            }
            std::string out;
            if (n / 3 > source_.size()) return out;
            out.reserve(n + 2);
            while (out.size() < n && at_ + 4 <= source_.size() && take_four(out)) continue;
            if (out.size() > n) out.resize(n);
            return out;
        }

        std::size_t taken() const { return at_; }

    private:
        static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

        static int value(char c)
        {
            if (c >= 'A' && c <= 'Z') return c - 'A';
            if (c >= 'a' && c <= 'z') return c - 'a' + 26;
            if (c >= '0' && c <= '9') return c - '0' + 52;
            return c == '+' ? 62 : c == '/' ? 63 : -1;
        }

        bool take_four(std::string& out)
        {
            std::array<char, 4> four{};
            std::size_t n = 0;
            while (n < 4 && at_ < source_.size())
                if (const char c = source_[at_++]; !is_blank(c)) four[n++] = c;
            if (n < 4) return false;
            std::uint32_t bits = 0;
            int bytes = 3;
            for (std::size_t i = 0; i < 4; ++i)
            {
                int v = value(four[i]);
                if (v < 0)
                {
                    if (four[i] != '=' || i < 2) return false;
                    bytes = std::min(bytes, static_cast<int>(i) - 1);
                    v = 0;
                }
                bits = bits << 6U | static_cast<std::uint32_t>(v);
            }
            for (int b = 0; b < bytes; ++b)
                out.push_back(static_cast<char>(bits >> (16 - 8 * b) & 0xffU));
            return true;
        }

        std::string_view source_;
        bool is_base64_;
        std::size_t at_ = 0;
    };

    struct Unpacked
    {
        std::string data;
        std::size_t taken = 0; ///< bytes of the source
    };
    Unpacked unpacked(const XMLElement& array, std::string_view source, bool is_base64) const
    {
        ByteSource bytes(source, is_base64);
        const auto take = [&](std::uint64_t n)
        {
            std::string data = bytes.take(n);
            if (data.size() != n)
                fail(array,
                     fmt::format("is truncated: expected {} bytes, found {}", n, data.size()));
            return data;
        };
        if (!is_compressed_)
        {
            // Length and data are one run of base64.
            ByteSource peek(source, is_base64);
            const std::string head = peek.take(header_width_);
            if (head.size() != header_width_) fail(array, "is truncated within its length");
            const std::uint64_t n = bits_at(head, 0, header_width_);
            if (n > source.size())
                fail(array, fmt::format("is truncated, or its length is wrong: it says {} bytes, "
                                        "there are {} of text at most",
                                        n, source.size()));
            std::string data = take(header_width_ + n).substr(header_width_);
            return {std::move(data), bytes.taken()};
        }
        // Number of blocks, size of a block, size of the last one (0: whole), packed sizes.
        ByteSource peek(source, is_base64);
        const std::string head = peek.take(header_width_);
        if (head.size() != header_width_) fail(array, "is truncated within its number of blocks");
        const std::uint64_t n_blocks = bits_at(head, 0, header_width_);
        if (n_blocks == 0) return {};
        if (n_blocks > source.size())
            fail(array, fmt::format("says {} blocks, more than it has bytes", n_blocks));
        const std::string header = take(header_width_ * (3 + n_blocks));
        const auto field = [&](std::uint64_t i)
        { return bits_at(header, i * header_width_, header_width_); };
        std::string out;
        for (std::uint64_t i = 0; i < n_blocks; ++i) packed_sum(array, field(3 + i), source.size());
        std::uint64_t total = 0;
        for (std::uint64_t i = 0; i < n_blocks; ++i) total += field(3 + i);
        // The blocks together are one run of base64.
        const std::string packed = take(total);
        std::size_t at = 0;
        for (std::uint64_t i = 0; i < n_blocks; ++i)
        {
            const bool is_last = i + 1 == n_blocks;
            const std::uint64_t size = is_last && field(2) != 0 ? field(2) : field(1);
            inflate(array, std::string_view(packed).substr(at, field(3 + i)), size, out);
            at += field(3 + i);
        }
        return {std::move(out), bytes.taken()};
    }

    void packed_sum(const XMLElement& array, std::uint64_t size, std::size_t at_most) const
    {
        if (size > at_most)
            fail(array, fmt::format("has a block of {} bytes, more than the array has", size));
    }

    void inflate(const XMLElement& array, std::string_view packed, std::uint64_t size,
                 std::string& out) const
    {
        // zlib packs by a factor of 1032 at most.
        if (size > 1100 * (packed.size() + 10))
            fail(array, fmt::format("a block of {} bytes says that it unpacks to {}", packed.size(),
                                    size));
        const std::size_t before = out.size();
        out.resize(before + size);
        auto n = static_cast<uLongf>(size);
        const int status = ::uncompress(reinterpret_cast<Bytef*>(out.data() + before), &n,
                                        reinterpret_cast<const Bytef*>(packed.data()),
                                        static_cast<uLong>(packed.size()));
        if (status != Z_OK || n != size)
            fail(array, fmt::format("a block of {} bytes cannot be unpacked to {} bytes (zlib: {})",
                                    packed.size(), size, ::zError(status)));
    }

    const std::string& path_;
    tinyxml2::XMLDocument document_;
    std::string_view appended_;
    bool end_is_there_ = false;
    bool is_appended_raw_ = true;
    bool is_big_endian_ = false;
    bool is_compressed_ = false;
    std::size_t taken_ = 0; ///< of the appended data, by all arrays so far
    std::size_t header_width_ = 4;
    IndexedMesh mesh_;
};

} // namespace

IndexedMesh read_vtk_xml(std::string_view bytes, const std::string& path)
{
    return VtkXmlReader(bytes, path).read();
}

} // namespace fppg
