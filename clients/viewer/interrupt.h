/// Ctrl-C and SIGTERM, asked for where the program can end in order: no handler, no global.
#pragma once

#include <csignal>

namespace plab::view
{

/// Blocks the signals in this thread and in those that it starts afterwards; so make it before the first thread.
class Interrupt
{
public:
    Interrupt()
    {
        sigset_t signals;
        (void)sigemptyset(&signals);
        // SIGPIPE too: a film's writer that has died is seen by write().
        for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) (void)sigaddset(&signals, signal);
        (void)sigprocmask(SIG_BLOCK, &signals, nullptr);
    }
    bool pending() const
    {
        sigset_t signals;
        return sigpending(&signals) == 0 && (sigismember(&signals, SIGINT) == 1 || sigismember(&signals, SIGTERM) == 1);
    }
};

}  // namespace plab::view
