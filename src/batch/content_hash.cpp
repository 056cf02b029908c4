#include "batch/content_hash.h"

#include "core/byte_digest.h"
#include "fppg/error.h"
#include "platform/regular_file.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

namespace fppg
{

std::string content_hash(const std::string& path)
{
    expect_regular_file(path);
    std::ifstream in(std::filesystem::path(path), std::ios::binary);
    if (!in) throw IoError(fmt::format("cannot read '{}'", path));
    std::uint64_t digest = 0;
    std::uint64_t size = 0;
    std::string block(1 << 20, '\0');
    while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0)
    {
        const auto n = static_cast<std::size_t>(in.gcount());
        digest += byte_digest(size, block.data(), n);
        size += n;
    }
    if (in.bad()) throw IoError(fmt::format("cannot read '{}'", path));
    return digest_text(digest, size);
}

} // namespace fppg
