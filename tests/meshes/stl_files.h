#pragma once

#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace fppg::test
{

/// Three corners of one facet.
using Corners = std::array<float, 9>;

/// A file that is removed at the end of the test.
class TemporaryFile
{
public:
    explicit TemporaryFile(const std::string& content)
    {
        static int counter = 0;
        path_ = (std::filesystem::temp_directory_path() /
                 fmt::format("fppg_read_stl_{}_{}.stl", ::getpid(), counter++))
                    .string();
        std::ofstream(path_, std::ios::binary) << content;
    }
    ~TemporaryFile() { std::filesystem::remove(path_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

/// A binary STL file; `count` is what the header says.
inline std::string binary_stl(const std::vector<Corners>& facets, std::uint32_t count,
                              std::string header = "binary")
{
    header.resize(80, ' ');
    std::string bytes = header;
    const auto append = [&bytes](const void* data, std::size_t size)
    { bytes.append(static_cast<const char*>(data), size); };
    append(&count, 4);
    for (const Corners& corners : facets)
    {
        const std::array<float, 3> normal{0, 0, 0};
        const std::uint16_t attribute = 0x83E0;
        append(normal.data(), 12);
        append(corners.data(), 36);
        append(&attribute, 2);
    }
    return bytes;
}

inline std::string binary_stl(const std::vector<Corners>& facets)
{
    return binary_stl(facets, static_cast<std::uint32_t>(facets.size()));
}

/// The statements of one facet in ASCII.
inline std::string facet_text(const Corners& c)
{
    std::string text = "  facet normal 0 0 1\n    outer loop\n";
    for (std::size_t k = 0; k < 3; ++k)
        text += fmt::format("      vertex {:.9g} {:.9g} {:.9g}\n", c[3 * k], c[3 * k + 1],
                            c[3 * k + 2]);
    return text + "    endloop\n  endfacet\n";
}

inline std::string ascii_stl(const std::vector<Corners>& facets, const std::string& name = "part")
{
    std::string text = "solid " + name + "\n";
    for (const Corners& corners : facets) text += facet_text(corners);
    return text + "endsolid " + name + "\n";
}

/// Facets of which no two are alike and whose numbers need all digits.
inline std::vector<Corners> some_facets(std::size_t n)
{
    std::vector<Corners> facets(n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < 9; ++k)
            facets[i][k] =
                static_cast<float>(static_cast<double>((i * 9 + k) * 7919 % 10007) / 7.0 - 600.0);
    return facets;
}

} // namespace fppg::test
