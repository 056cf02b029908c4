#include "core/binary_items.h"

#include "fppg/error.h"

#include <fmt/format.h>

#include <cstring>

namespace fppg
{
namespace
{

constexpr std::size_t head_size = 64;

class ItemReader
{
public:
    ItemReader(std::string_view bytes, const std::string& path, std::string_view file_code)
        : bytes_(bytes), path_(path)
    {
        const std::string title = fmt::format("#FileJBD {} ", file_code);
        if (bytes_.size() < head_size || !bytes_.starts_with(title))
            fail(fmt::format("it does not begin as such a file does (#FileJBD {})", file_code));
        if (bytes_[60] % 10 != 0) fail("its byte order is not little-endian");
        has_64_bit_sizes_ = bytes_[61] != 0;
        at_ = head_size;
    }

    std::vector<BinaryItem> run()
    {
        std::vector<BinaryItem> out;
        do out.push_back(item(0));
        while (at_ < bytes_.size());
        return out;
    }

private:
    [[noreturn]] void fail(const std::string& text) const
    {
        throw IoError(fmt::format("cannot read '{}': {}", path_, text));
    }

    std::string_view take(std::uint64_t size)
    {
        if (size > bytes_.size() - at_)
            fail(fmt::format("it ends at byte {}, but {} more are announced at byte {}",
                             bytes_.size(), size, at_));
        const std::string_view part = bytes_.substr(at_, size);
        at_ += size;
        return part;
    }

    template <typename T>
    T number()
    {
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }

    std::string_view text() { return take(number<std::uint32_t>()); }

    std::uint64_t array_number()
    {
        return has_64_bit_sizes_ ? number<std::uint64_t>() : number<std::uint32_t>();
    }

    void expect_tag(std::string_view tag)
    {
        const std::size_t begin = at_;
        if (text() != tag) fail(fmt::format("the part at byte {} has another tag", begin));
    }

    BinaryItem item(int depth)
    {
        if (depth > 8) fail("its items are nested too deeply");
        BinaryItem out;
        number<std::uint32_t>(); // size of the definition
        expect_tag("\nITEM\n");
        out.name = text();
        take(8); // hidden flags
        text();  // formats of numbers
        text();
        const auto arrays = number<std::uint32_t>();
        const auto items = number<std::uint32_t>();
        const auto values_size = number<std::uint32_t>();
        const std::size_t values_end = at_ + values_size;
        if (values_size > 0)
        {
            expect_tag("\nVALUES");
            const auto count = number<std::uint32_t>();
            for (std::uint32_t i = 0; i < count; ++i) out.values.push_back(value());
            if (at_ != values_end) fail(fmt::format("the values before byte {} go on", at_));
        }
        for (std::uint32_t i = 0; i < arrays; ++i) out.arrays.push_back(array());
        for (std::uint32_t i = 0; i < items; ++i) out.items.push_back(item(depth + 1));
        return out;
    }

    BinaryValue value()
    {
        BinaryValue out;
        out.name = text();
        out.type = number<std::int32_t>();
        switch (out.type)
        {
            case 1:
                out.data = text();
                break;
            case 3:
            case 4:
                out.data = take(1);
                break;
            case 5:
            case 6:
                out.data = take(2);
                break;
            case 2:
            case 7:
            case 8:
            case 11:
                out.data = take(4);
                break;
            case 9:
            case 10:
            case 12:
                out.data = take(8);
                break;
            case 20:
            case 21:
            case 22:
                out.data = take(12);
                break;
            case 23:
                out.data = take(24);
                break;
            default:
                fail(fmt::format("the value {} has the unknown type {}", out.name, out.type));
        }
        return out;
    }

    BinaryArray array()
    {
        BinaryArray out;
        number<std::uint32_t>(); // size of the definition
        expect_tag("\nARRAY");
        out.name = text();
        number<std::int32_t>(); // hidden
        out.type = number<std::int32_t>();
        out.count = array_number();
        out.data = take(array_number());
        return out;
    }

    std::string_view bytes_;
    const std::string& path_;
    std::size_t at_ = 0;
    bool has_64_bit_sizes_ = false;
};

} // namespace

std::vector<BinaryItem> read_binary_items(std::string_view bytes, const std::string& path,
                                          std::string_view file_code)
{
    return ItemReader(bytes, path, file_code).run();
}

namespace
{

template <typename T>
double as_double(std::string_view data)
{
    T value;
    std::memcpy(&value, data.data(), sizeof value);
    return static_cast<double>(value);
}

std::optional<double> number_in(const BinaryValue& value)
{
    const auto has = [&](int type, std::size_t bytes)
    { return value.type == type && value.data.size() == bytes; };
    if (has(7, 4)) return as_double<std::int32_t>(value.data);
    if (has(8, 4)) return as_double<std::uint32_t>(value.data);
    if (has(9, 8)) return as_double<std::int64_t>(value.data);
    if (has(10, 8)) return as_double<std::uint64_t>(value.data);
    if (has(11, 4)) return as_double<float>(value.data);
    if (has(12, 8)) return as_double<double>(value.data);
    return {};
}

} // namespace

const BinaryValue* find_value(const std::vector<BinaryItem>& items, std::string_view name)
{
    for (const BinaryItem& item : items)
    {
        for (const BinaryValue& value : item.values)
            if (value.name == name) return &value;
        if (const BinaryValue* found = find_value(item.items, name)) return found;
    }
    return nullptr;
}

std::optional<double> find_number(const std::vector<BinaryItem>& items, std::string_view name)
{
    const BinaryValue* value = find_value(items, name);
    return value == nullptr ? std::nullopt : number_in(*value);
}

} // namespace fppg
