#include "core/byte_digest.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <set>
#include <string>

namespace fppg
{
namespace
{

/// The digest by its definition, byte by byte.
std::uint64_t digest_of_bytes(const std::string& text)
{
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < text.size(); ++i) sum += byte_digest(i, &text[i], 1);
    return sum;
}

std::string random_text(std::size_t size)
{
    std::mt19937 random(7);
    std::string text(size, '\0');
    for (char& c : text) c = static_cast<char>(random());
    return text;
}

TEST(ByteDigest, IsTheSumOfThoseOfItsPieces)
{
    const std::string text = random_text(100);
    const std::uint64_t whole = byte_digest(0, text.data(), text.size());
    EXPECT_EQ(whole, digest_of_bytes(text));
    for (std::size_t cut = 0; cut <= text.size(); ++cut)
        EXPECT_EQ(byte_digest(cut, text.data() + cut, text.size() - cut) +
                      byte_digest(0, text.data(), cut),
                  whole)
            << cut;
}

TEST(ByteDigest, TakesNothingForZeros)
{
    const std::string zeros(37, '\0');
    EXPECT_EQ(byte_digest(3, zeros.data(), zeros.size()), 0U);
}

TEST(ByteDigest, TellsEveryBitAndPlaceApart)
{
    std::set<std::uint64_t> seen;
    for (std::uint64_t place = 0; place < 64; ++place)
        for (int bit = 0; bit < 8; ++bit)
        {
            const char c = static_cast<char>(1 << bit);
            EXPECT_TRUE(seen.insert(byte_digest(place, &c, 1)).second) << place << ' ' << bit;
        }
}

TEST(ByteDigest, ChangesWhereTwoSignsChange)
{
    const double before[] = {1.5, 2, 2.5};
    const double after[] = {-1.5, 2, -2.5};
    EXPECT_NE(byte_digest(0, before, sizeof before), byte_digest(0, after, sizeof after));
}

} // namespace
} // namespace fppg
