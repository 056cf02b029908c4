#include "core/byte_digest.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace fppg
{
namespace
{

constexpr std::size_t word = 8;

/// The factor of a word of the file, by its number (the finalizer of splitmix64).
std::uint64_t factor_of(std::uint64_t number)
{
    std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

std::uint64_t digest_of_word(std::uint64_t value, std::uint64_t number)
{
    const std::uint64_t factor = factor_of(number);
    return (value & 0xffffffffU) * factor + (value >> 32U) * std::rotl(factor, 32);
}

} // namespace

std::uint64_t byte_digest(std::uint64_t offset, const void* data, std::size_t bytes)
{
    static_assert(std::endian::native == std::endian::little);
    const char* next = static_cast<const char*>(data);
    std::uint64_t number = offset / word;
    std::uint64_t sum = 0;
    // Of words that the piece has in part, all other bytes count as zeros.
    for (std::size_t skipped = offset % word; bytes > 0; skipped = 0)
    {
        std::uint64_t value = 0;
        if (skipped == 0 && bytes >= word)
        {
            for (; bytes >= word; bytes -= word, next += word)
            {
                std::memcpy(&value, next, word);
                sum += digest_of_word(value, number++);
            }
            continue;
        }
        const std::size_t n = std::min(word - skipped, bytes);
        std::memcpy(reinterpret_cast<char*>(&value) + skipped, next, n);
        sum += digest_of_word(value, number++);
        next += n;
        bytes -= n;
    }
    return sum;
}

std::string digest_text(std::uint64_t digest, std::uint64_t size)
{
    return fmt::format("{:016x}-{}", digest, size);
}

} // namespace fppg
