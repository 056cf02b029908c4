#pragma once

#include <string>

namespace fppg
{

/// A short text that is another one when the bytes of the file are others: FNV-1a, 64 bits, and the
/// size. It tells changes apart, it is no protection against somebody who wants two files to look
/// alike.
///
/// throws IoError if the file cannot be read
std::string content_hash(const std::string& path);

} // namespace fppg
