/// SIGINT, SIGTERM and SIGHUP as a flag for long work, and the resulting exit code.
///
///   catch_signals();
///   while (!is_interrupted() && work()) {}
///   return is_interrupted() ? code_of_interruption() : 0;
#pragma once

#include <atomic>
#include <string>

namespace plab::program
{

/// From now on the first of these signals sets the flag. One that comes at least half a second later ends the process in the
/// default way, so that the user can always end it; an earlier one counts as the same signal (`timeout` sends it to the process
/// and to its group). SIGHUP stays ignored if it was (nohup). SIGPIPE and SIGXFSZ are ignored: the writing code gets the error.
void catch_signals();

/// Ignores only SIGPIPE and SIGXFSZ: for a program that does not need an orderly end yet.
void ignore_write_signals();

/// The handler also adds 1 to this descriptor of an eventfd, to wake a loop that sleeps on it. -1: none. It must stay open
/// until another one, or -1, is set.
void wake_on_signal(int eventfd);

/// The handler also calls this at the first signal; it may do only what a signal handler may. Null: nothing.
void call_on_signal(void (*hook)());

/// Costs one atomic load.
bool is_interrupted();
/// The flag itself, for code that does not use signals directly.
const std::atomic<bool>& interruption();
/// 128 + the number of the first signal, as in shells: 130 after Ctrl-C, 143 after SIGTERM; 0: there was none.
int code_of_interruption();
/// "SIGINT", "SIGTERM", "SIGHUP"; "": there was none.
std::string name_of_interruption();

}  // namespace plab::program
