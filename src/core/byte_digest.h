#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace fppg
{

/// What the bytes of a file at an offset add to its digest, modulo 2^64. The sum over pieces is the
/// same whatever they are and in whatever order they come; zeros add nothing. It tells changes
/// apart, it is no protection against somebody who wants two files to look alike.
///
/// Each four bytes, a number of 32 bits, are multiplied by one of 64 bits that their place in the
/// file gives (Carter and Wegman's hash of vectors).
std::uint64_t byte_digest(std::uint64_t offset, const void* data, std::size_t bytes);

/// Digest and size of a whole file: 16 hexadecimal digits, '-', and the size in bytes.
std::string digest_text(std::uint64_t digest, std::uint64_t size);

} // namespace fppg
