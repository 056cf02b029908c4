#pragma once

#include <array>
#include <cstddef>

namespace fppg
{

/// Keeps all signals from this thread, and from threads that it starts, while it lives: those are
/// for the thread of the program, or wait until it may take them. What a thread does to itself, as
/// reading a file that became shorter, is told to it: the system ends a program that blocks that.
/// Windows has none: it starts a thread for Ctrl-C.
class SignalsBlocked
{
public:
    SignalsBlocked();
    ~SignalsBlocked();
    SignalsBlocked(const SignalsBlocked&) = delete;
    SignalsBlocked& operator=(const SignalsBlocked&) = delete;

private:
    alignas(std::max_align_t) std::array<std::byte, 128> before_;
};

} // namespace fppg
