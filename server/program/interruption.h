/// SIGINT, SIGTERM and SIGHUP as a flag that long work looks at, and the exit code that follows.
///
///   catch_signals();
///   while (!is_interrupted() && work()) {}
///   return is_interrupted() ? code_of_interruption() : 0;
#pragma once

#include <atomic>
#include <string>

namespace plab::program
{

/// From now on the first of these signals sets the flag. One that comes half a second after it or later ends the process as
/// usual, so that nobody is locked in; what comes sooner is the same signal once more (`timeout` sends it to the process and to
/// its group). SIGHUP stays ignored where it was (nohup). SIGPIPE and SIGXFSZ are ignored: who writes sees the error.
void catch_signals();

/// SIGPIPE and SIGXFSZ alone: for a program that has nothing yet to end in order.
void ignore_write_signals();

/// The handler also adds 1 to this descriptor of an eventfd, so that a loop that sleeps on it wakes. -1: none. It must stay
/// open until another one, or -1, is given.
void wake_on_signal(int eventfd);

/// The handler also calls this at the first signal; it may do only what a signal handler may. Null: nothing.
void call_on_signal(void (*hook)());

/// Costs a load.
bool is_interrupted();
/// The flag itself, for code that is given one and knows no signals.
const std::atomic<bool>& interruption();
/// 128 + the number of the first signal, as shells have it: 130 after Ctrl-C, 143 after SIGTERM; 0: none came.
int code_of_interruption();
/// "SIGINT", "SIGTERM", "SIGHUP"; "": none came.
std::string name_of_interruption();

}  // namespace plab::program
