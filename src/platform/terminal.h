#pragma once

namespace fppg
{

enum class Stream
{
    In,
    Out,
    Error,
};

bool is_terminal(Stream stream);

/// Whether both streams end in one place, as on a terminal or after 2>&1.
bool are_one(Stream a, Stream b);

} // namespace fppg
