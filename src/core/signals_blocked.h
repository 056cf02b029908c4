#pragma once

#include <pthread.h>
#include <signal.h>

namespace fppg
{

/// Keeps all signals from this thread, and from threads that it starts, while it lives: those are
/// for the thread of the program, or wait until it may take them.
class SignalsBlocked
{
public:
    SignalsBlocked()
    {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalsBlocked(const SignalsBlocked&) = delete;
    SignalsBlocked& operator=(const SignalsBlocked&) = delete;

private:
    sigset_t before_{};
};

} // namespace fppg
