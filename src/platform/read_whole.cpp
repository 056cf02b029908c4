#include "platform/file_map.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace fppg
{

bool is_file(const std::string& path)
{
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored);
}

std::string read_whole(const std::string& path)
{
    std::ifstream in(std::filesystem::path(path), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

} // namespace fppg
