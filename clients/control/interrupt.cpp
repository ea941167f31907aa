#include "control/interrupt.h"

#include <atomic>
#include <csignal>

namespace plab::control
{
namespace
{

// A signal handler reaches nothing but static data.
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void note_interrupt(int signal)
{
    interrupted = true;
    (void)std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts()
{
    (void)std::signal(SIGINT, note_interrupt);
    (void)std::signal(SIGTERM, note_interrupt);
    (void)std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is seen when writing
    (void)std::signal(SIGXFSZ, SIG_IGN);  // so is a file at its limit
}

bool is_interrupted() { return interrupted; }

}  // namespace plab::control
