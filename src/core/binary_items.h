#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fppg
{

/// What a file of binary data (the container of .bi4 and .mbi4, described at the head of
/// src/files/bi4.cpp) holds. Texts and bytes are views of the file.
struct BinaryArray
{
    std::string_view name;
    int type = 0;            ///< 11 float, 12 double, 22 float3, 23 double3, 8 unsigned, ...
    std::uint64_t count = 0; ///< of elements; `data` may be of any size
    std::string_view data;
};

struct BinaryValue
{
    std::string_view name;
    int type = 0;
    std::string_view data;
};

struct BinaryItem
{
    std::string_view name;
    std::vector<BinaryValue> values;
    std::vector<BinaryArray> arrays;
    std::vector<BinaryItem> items;
};

/// The items of a file, one after the other up to its end.
///
/// bytes      the whole file; must outlive the result
/// path       for messages
/// file_code  what the head has to say, as "JPartDataBi4"
/// throws     IoError with the path where the file begins otherwise, ends too early or has a part
///            that is none
std::vector<BinaryItem> read_binary_items(std::string_view bytes, const std::string& path,
                                          std::string_view file_code);

/// The first value of that name in the items and those in them, or nullptr.
const BinaryValue* find_value(const std::vector<BinaryItem>& items, std::string_view name);

/// The same as a number, where it is one.
std::optional<double> find_number(const std::vector<BinaryItem>& items, std::string_view name);

} // namespace fppg
