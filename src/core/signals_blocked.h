#pragma once

#include <pthread.h>
#include <signal.h>

namespace fppg
{

/// Keeps all signals from this thread, and from threads that it starts, while it lives: those are
/// for the thread of the program, or wait until it may take them. What a thread does to itself, as
/// reading a file that became shorter, is told to it: the system ends a program that blocks that.
class SignalsBlocked
{
public:
    SignalsBlocked()
    {
        sigset_t all;
        sigfillset(&all);
        for (const int own : {SIGBUS, SIGSEGV, SIGFPE, SIGILL, SIGSYS}) sigdelset(&all, own);
        pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalsBlocked(const SignalsBlocked&) = delete;
    SignalsBlocked& operator=(const SignalsBlocked&) = delete;

private:
    sigset_t before_{};
};

} // namespace fppg
