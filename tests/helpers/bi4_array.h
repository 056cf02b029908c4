#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace fppg::test
{

/// The numbers of an array of Case.bi4; none without that array.
template <typename T>
std::vector<T> bi4_array(const std::string& bytes, const std::string& name)
{
    const std::string head =
        "\nARRAY" + std::string(1, static_cast<char>(name.size())) + std::string(3, '\0') + name;
    const std::size_t found = bytes.find(head);
    if (found == std::string::npos) return {};
    // Behind the name: hide, type, count, size of the data, data.
    const char* const fields = bytes.data() + found + head.size();
    std::uint32_t size = 0;
    std::memcpy(&size, fields + 12, sizeof size);
    std::vector<T> numbers(size / sizeof(T));
    std::memcpy(numbers.data(), fields + 16, size);
    return numbers;
}

} // namespace fppg::test
