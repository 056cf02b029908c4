#include "platform/signals_blocked.h"

#include <pthread.h>
#include <signal.h>

#include <cstring>

namespace fppg
{

SignalsBlocked::SignalsBlocked()
{
    static_assert(sizeof(sigset_t) <= sizeof(before_));
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    for (const int own : {SIGBUS, SIGSEGV, SIGFPE, SIGILL, SIGSYS}) sigdelset(&all, own);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    std::memcpy(before_.data(), &before, sizeof before);
}

SignalsBlocked::~SignalsBlocked()
{
    sigset_t before;
    std::memcpy(&before, before_.data(), sizeof before);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

} // namespace fppg
