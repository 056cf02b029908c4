#pragma once

#include <string>

namespace fppg
{

/// A short text that is another one when the bytes of the file are others: their byte_digest() and
/// the size.
///
/// throws IoError if the file cannot be read
std::string content_hash(const std::string& path);

} // namespace fppg
