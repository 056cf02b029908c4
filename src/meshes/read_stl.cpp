#include "fppg/shapes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/float32.h"
#include "core/parallel.h"
#include "core/text.h"
#include "fppg/error.h"
#include "meshes/facet_checks.h"
#include "platform/file_map.h"

namespace fppg
{

namespace
{

static_assert(std::endian::native == std::endian::little,
              "binary STL is little-endian and is copied as it is");

constexpr std::size_t header_bytes = 84; // 80 of comment, 4 of count
constexpr std::size_t facet_bytes = 50;  // normal, three corners, two bytes of attribute
constexpr std::size_t text_bytes_per_chunk = std::size_t{1} << 20;

bool is_space(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/// True if `word` (lower case) stands at `at`, whatever its case, and ends there.
bool is_word_at(std::string_view text, std::size_t at, std::string_view word)
{
    if (text.size() - at < word.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i)
        if (lower_case(text[at + i]) != word[i]) return false;
    return at + word.size() == text.size() || is_space(text[at + word.size()]);
}

std::size_t skip_spaces(std::string_view text, std::size_t at)
{
    while (at < text.size() && is_space(text[at])) ++at;
    return at;
}

std::size_t skip_word(std::string_view text, std::size_t at)
{
    while (at < text.size() && !is_space(text[at])) ++at;
    return at;
}

/// True if the two words `facet normal`, with which every facet begins, stand at `at`.
bool is_facet_at(std::string_view text, std::size_t at)
{
    return is_word_at(text, at, "facet") && is_word_at(text, skip_spaces(text, at + 5), "normal");
}

/// Where the text breaks the rules; the line is counted only when the error is reported.
struct TextError
{
    std::size_t offset;
    std::string what;
};

/// What a chunk of text holds.
struct TextPart
{
    std::vector<Vec3> vertices;
    bool is_open = false;            ///< the last facet is not followed by `endsolid`
    std::size_t unclosed_solids = 0; ///< `solid` that follows a facet without `endsolid`
};

/// Reads ASCII STL from one position to another. Line ends mean nothing except that a name ends
/// with its line, so files on one line are read like all others.
class TextReader
{
public:
    explicit TextReader(std::string_view text) : text_(text) {}

    /// Reads whole statements that begin in [begin, end); a facet may reach beyond `end`.
    TextPart read(std::size_t begin, std::size_t end)
    {
        TextPart part;
        at_ = skip_spaces(text_, begin);
        while (at_ < end && at_ < text_.size())
        {
            if (is_word_at(text_, at_, "facet"))
            {
                read_facet(part.vertices);
                part.is_open = true;
            }
            else if (is_word_at(text_, at_, "endsolid"))
            {
                skip_name();
                part.is_open = false;
            }
            else if (is_word_at(text_, at_, "solid"))
            {
                skip_name();
                part.unclosed_solids += part.is_open ? 1 : 0;
                part.is_open = false;
            }
            else
                fail("expected 'facet', 'endsolid' or 'solid'");
            at_ = skip_spaces(text_, at_);
        }
        return part;
    }

private:
    [[noreturn]] void fail(const std::string& expectation) const
    {
        if (at_ >= text_.size())
            throw TextError{text_.size(), "the file ends inside a facet; " + expectation};
        const bool is_last = skip_word(text_, at_) == text_.size();
        throw TextError{at_, fmt::format("{}, found '{}'{}", expectation, found(),
                                         is_last ? ", with which the file ends" : "")};
    }

    std::string found() const
    {
        constexpr std::size_t longest = 40;
        std::string word(text_.substr(at_, skip_word(text_, at_) - at_));
        if (word.size() > longest) word = word.substr(0, longest) + "...";
        for (char& c : word)
            if (static_cast<unsigned char>(c) < 0x20) c = '?';
        return word;
    }

    void expect(std::string_view word)
    {
        at_ = skip_spaces(text_, at_);
        if (!is_word_at(text_, at_, word)) fail(fmt::format("expected '{}'", word));
        at_ += word.size();
    }

    /// Skips `solid` or `endsolid` and the name, which may hold any words and ends with the line,
    /// or, in a file on one line, where the next statement begins.
    void skip_name()
    {
        at_ = skip_word(text_, at_);
        while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r')
        {
            if (!is_space(text_[at_]))
            {
                if (is_facet_at(text_, at_) || is_word_at(text_, at_, "endsolid") ||
                    is_word_at(text_, at_, "solid"))
                    return;
                at_ = skip_word(text_, at_);
            }
            else
                ++at_;
        }
    }

    void read_facet(std::vector<Vec3>& vertices)
    {
        expect("facet");
        expect("normal");
        // The normal follows from the corners; what stands here is often wrong and never used.
        for (int i = 0; i < 3; ++i)
        {
            at_ = skip_spaces(text_, at_);
            if (at_ >= text_.size() || is_word_at(text_, at_, "outer"))
                fail("expected three numbers of the normal");
            at_ = skip_word(text_, at_);
        }
        expect("outer");
        expect("loop");
        for (int corner = 0; corner < 3; ++corner)
        {
            at_ = skip_spaces(text_, at_);
            if (is_word_at(text_, at_, "endloop"))
                fail(fmt::format("the facet has {} corners, expected 3", corner));
            expect("vertex");
            const double x = read_number();
            const double y = read_number();
            const double z = read_number();
            vertices.push_back({x, y, z});
        }
        at_ = skip_spaces(text_, at_);
        if (is_word_at(text_, at_, "vertex"))
            fail("the facet has more than 3 corners, expected 'endloop'");
        expect("endloop");
        expect("endfacet");
    }

    /// Rounded once, from the digits to float32, as a binary file would hold it.
    double read_number()
    {
        at_ = skip_spaces(text_, at_);
        const char* begin = text_.data() + at_;
        const char* const end = text_.data() + text_.size();
        if (end - begin > 1 && *begin == '+' && begin[1] != '-') ++begin;
        float value = 0;
        const auto [rest, status] = std::from_chars(begin, end, value);
        if (rest != begin && (rest == end || is_space(*rest)))
        {
            at_ = static_cast<std::size_t>(rest - text_.data());
            if (status == std::errc{}) return static_cast<double>(value);
            return out_of_range(begin, rest);
        }
        return odd_number();
    }

    /// Too small for float32 is rounded to it, too large is infinite.
    static double out_of_range(const char* begin, const char* end)
    {
        double value = 0;
        const auto result = std::from_chars(begin, end, value);
        if (result.ec == std::errc{})
            return std::abs(value) > std::numeric_limits<float>::max()
                       ? std::copysign(std::numeric_limits<double>::infinity(), value)
                       : as_float32(value);
        const std::string_view digits(begin, static_cast<std::size_t>(end - begin));
        const bool is_tiny = digits.find("e-") != std::string_view::npos ||
                             digits.find("E-") != std::string_view::npos;
        return is_tiny ? 0.0 : std::numeric_limits<double>::infinity();
    }

    double odd_number()
    {
        const std::string_view word = text_.substr(at_, skip_word(text_, at_) - at_);
        if (word.find(".#") != std::string_view::npos) // 1.#QNAN, 1.#INF of old Windows programs
        {
            at_ += word.size();
            return std::numeric_limits<double>::quiet_NaN();
        }
        const bool is_numeric =
            !word.empty() && (word[0] == '+' || word[0] == '-' || word[0] == '.' ||
                              (word[0] >= '0' && word[0] <= '9'));
        if (is_numeric && word.find(',') != std::string_view::npos)
            fail("expected a number with a decimal point, not a comma");
        if (is_numeric && word.find_first_of("dD") != std::string_view::npos)
            fail("expected a number with the exponent letter E, not D");
        fail("expected a number");
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

/// Lines end with LF, CR LF or CR; counted from 1.
std::size_t line_of(std::string_view text, std::size_t offset)
{
    std::size_t line = 1;
    for (std::size_t i = 0; i < offset; ++i)
        if (text[i] == '\n' || (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n')))
            ++line;
    return line;
}

/// Positions at which the text can be cut into independent parts: each but the first begins with
/// `facet normal`. They do not depend on the number of threads.
std::vector<std::size_t> cut_at_facets(std::string_view text)
{
    std::vector<std::size_t> cuts{0};
    for (std::size_t target = text_bytes_per_chunk; target < text.size();
         target += text_bytes_per_chunk)
    {
        std::size_t at = std::max(target, cuts.back() + 1);
        while (at < text.size() && !(is_space(text[at - 1]) && is_facet_at(text, at))) ++at;
        if (at >= text.size()) break;
        if (at > cuts.back()) cuts.push_back(at);
    }
    cuts.push_back(text.size());
    return cuts;
}

MeshFile read_text(std::string_view text, const std::string& path, int threads)
{
    const std::vector<std::size_t> cuts = cut_at_facets(text);
    std::vector<TextPart> parts(cuts.size() - 1);
    try
    {
        parallel_for(parts.size(), threads,
                     [&](std::size_t i)
                     { parts[i] = TextReader(text).read(cuts[i], cuts[i + 1]); });
    }
    catch (const TextError& error)
    {
        throw GeometryError(
            fmt::format("{}:{}: {}", path, line_of(text, error.offset), error.what));
    }
    std::size_t size = 0;
    std::size_t unclosed = parts.back().is_open ? 1 : 0;
    std::vector<std::size_t> begins;
    for (const TextPart& part : parts)
    {
        begins.push_back(size);
        size += part.vertices.size();
        unclosed += part.unclosed_solids;
    }
    MeshFile mesh;
    if (parts.size() == 1)
        mesh.soup.vertices = std::move(parts[0].vertices);
    else
    {
        mesh.soup.vertices.resize(size);
        parallel_for(parts.size(), threads,
                     [&](std::size_t i)
                     {
                         std::copy(
                             parts[i].vertices.begin(), parts[i].vertices.end(),
                             mesh.soup.vertices.begin() + static_cast<std::ptrdiff_t>(begins[i]));
                         parts[i].vertices = {};
                     });
    }
    if (mesh.soup.vertices.empty())
        throw GeometryError(path + ": is an ASCII STL file without any facet");
    if (unclosed > 0)
        mesh.warnings.push_back(
            fmt::format("{} not closed by 'endsolid'; the facets read so far are used.",
                        unclosed == 1 ? "A solid is" : fmt::format("{} solids are", unclosed)));
    return mesh;
}

std::uint32_t count_in_header(std::string_view bytes)
{
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    return count;
}

/// Decides whether the bytes after the last facet are padding, which is harmless, or a sign that
/// the count is wrong. Returns the warning, if any; throws GeometryError.
std::optional<std::string> check_binary_size(std::string_view bytes, const std::string& path)
{
    const std::size_t count = count_in_header(bytes);
    const std::size_t needed = header_bytes + facet_bytes * count;
    const std::size_t whole = (bytes.size() - header_bytes) / facet_bytes;
    if (needed > bytes.size())
        throw GeometryError(fmt::format(
            "{}: is truncated, or its count is wrong: {} facets need {} bytes, the file has {} "
            "bytes, room for {} whole facets",
            path, count, needed, bytes.size(), whole));
    const std::string_view rest = bytes.substr(needed);
    if (rest.empty()) return std::nullopt;
    const bool is_padding = rest.find_first_not_of('\0') == std::string_view::npos;
    const bool are_facets = rest.size() % facet_bytes == 0 && !is_padding;
    if (are_facets || (rest.size() > needed + 4096 && !is_padding))
        throw GeometryError(
            fmt::format("{}: the count is wrong, or this is no STL file: {} facets need {} bytes, "
                        "the file has {} bytes, room for {} facets",
                        path, count, needed, bytes.size(), whole));
    return fmt::format("{} bytes after the last of {} facets are ignored.", rest.size(), count);
}

MeshFile read_binary(std::string_view bytes, const std::string& path, int threads)
{
    MeshFile mesh;
    if (auto warning = check_binary_size(bytes, path)) mesh.warnings.push_back(std::move(*warning));
    const std::size_t count = count_in_header(bytes);
    if (count == 0) throw GeometryError(path + ": is a binary STL file without any facet");
    mesh.soup.vertices.resize(3 * count);
    parallel_for(
        (count + facets_per_block - 1) / facets_per_block, threads,
        [&](std::size_t block)
        {
            const std::size_t begin = block * facets_per_block;
            const std::size_t end = std::min(count, begin + facets_per_block);
            for (std::size_t i = begin; i < end; ++i)
            {
                std::array<float, 9> corners;
                std::memcpy(corners.data(), bytes.data() + header_bytes + facet_bytes * i + 12,
                            sizeof corners);
                for (std::size_t k = 0; k < 3; ++k)
                    mesh.soup.vertices[3 * i + k] = {static_cast<double>(corners[3 * k]),
                                                     static_cast<double>(corners[3 * k + 1]),
                                                     static_cast<double>(corners[3 * k + 2])};
            }
        });
    return mesh;
}

/// True if no byte is one that text never has.
bool is_text(std::string_view bytes)
{
    for (const char c : bytes)
        if (static_cast<unsigned char>(c) < 0x20 && !is_space(c)) return false;
    return true;
}

/// Whether the first facet of a text can be read: tells a text from a binary file whose header
/// imitates one.
bool has_readable_facet(std::string_view text)
{
    std::size_t at = 0;
    while (at < text.size() && !is_facet_at(text, at)) at = skip_spaces(text, skip_word(text, at));
    if (at >= text.size()) return false;
    try
    {
        TextReader(text).read(at, at + 1);
        return true;
    }
    catch (const TextError&)
    {
        return false;
    }
}

MeshFile read_bytes(std::string_view bytes, const std::string& path, int threads)
{
    if (bytes.empty()) throw GeometryError(path + ": is empty, expected an STL file");

    std::string_view text = bytes;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    constexpr std::string_view end_marks("\0\x1A", 2); // end marks of old systems
    while (!text.empty() && end_marks.find(text.back()) != std::string_view::npos)
        text.remove_suffix(1);
    const bool begins_as_text = is_word_at(text, skip_spaces(text, 0), "solid");
    const bool looks_as_text = is_text(text.substr(0, 1024));

    if (bytes.size() >= header_bytes)
    {
        const std::size_t count = count_in_header(bytes);
        const bool has_binary_size = bytes.size() == header_bytes + facet_bytes * count;
        // No text below 6 GB has the size that its bytes 80 to 83 would ask of a binary file.
        if (has_binary_size && !(begins_as_text && looks_as_text && has_readable_facet(text)))
            return read_binary(bytes, path, threads);
    }
    if (begins_as_text && looks_as_text) return read_text(text, path, threads);
    if (looks_as_text && is_text(bytes))
        throw GeometryError(
            fmt::format("{}: is no STL file: a text of {} bytes that does not begin with the word "
                        "'solid', or a binary file cut within its header of {} bytes",
                        path, bytes.size(), header_bytes));
    if (bytes.size() < header_bytes)
        throw GeometryError(
            fmt::format("{}: is no STL file, or truncated: {} bytes, the header of a binary file "
                        "alone has {}",
                        path, bytes.size(), header_bytes));
    return read_binary(bytes, path, threads);
}

} // namespace

MeshFile read_stl(const std::string& path, int threads)
{
    const FileMap file(path);
    MeshFile mesh = read_bytes(file.bytes(), path, threads);
    check_facets(mesh, path, true, threads);
    return mesh;
}

} // namespace fppg
