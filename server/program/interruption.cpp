#include "program/interruption.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <utility>

namespace plab::program
{
namespace
{

constexpr std::int64_t kSameSignal = 500'000'000;  // ns

constexpr std::array<std::pair<int, const char*>, 3> kSignals{{{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}}};

// A signal handler may access only static data, and of these only lock-free ones.
std::atomic<bool> interrupted{false};
std::atomic<int> first_signal{0};
std::atomic<std::int64_t> first_time{0};  // ns
std::atomic<int> wake_descriptor{-1};
using Hook = void (*)();
std::atomic<Hook> on_first{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
              std::atomic<std::int64_t>::is_always_lock_free && std::atomic<Hook>::is_always_lock_free);

std::int64_t now()
{
    timespec t{};
    (void)clock_gettime(CLOCK_MONOTONIC, &t);  // async-signal-safe, by POSIX
    return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

/// Restores the default action and raises the signal, as if it had never been caught.
void end_by(int signal)
{
    struct sigaction usual
    {
    };
    usual.sa_handler = SIG_DFL;
    (void)sigaction(signal, &usual, nullptr);
    (void)raise(signal);
}

extern "C" void note_signal(int signal)
{
    const int error = errno;  // the interrupted code examines its own errno
    int none = 0;
    if (first_signal.compare_exchange_strong(none, signal))
    {
        first_time = now(), interrupted = true;
        if (const Hook hook = on_first) hook();
    }
    else if (const std::int64_t first = first_time; first != 0 && now() - first > kSameSignal)
        end_by(signal);
    if (const int descriptor = wake_descriptor; descriptor >= 0)
    {
        const std::uint64_t one = 1;
        [[maybe_unused]] const auto written = ::write(descriptor, &one, sizeof one);  // full: an earlier wake has not been read yet
    }
    errno = error;
}

void set_handler(int signal, void (*handler)(int))
{
    struct sigaction action
    {
    };
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    (void)sigaction(signal, &action, nullptr);
}

}  // namespace

void catch_signals()
{
    struct sigaction before
    {
    };
    const bool hangup_is_ignored = sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler == SIG_IGN;
    for (const auto& [signal, name] : kSignals)
        if (signal != SIGHUP || !hangup_is_ignored) set_handler(signal, note_signal);
    ignore_write_signals();
}

void ignore_write_signals()
{
    for (const int signal : {SIGPIPE, SIGXFSZ}) set_handler(signal, SIG_IGN);
}

void wake_on_signal(int eventfd) { wake_descriptor = eventfd; }

void call_on_signal(void (*hook)()) { on_first = hook; }

bool is_interrupted() { return interrupted.load(std::memory_order_relaxed); }

const std::atomic<bool>& interruption() { return interrupted; }

int code_of_interruption()
{
    const int signal = first_signal;
    return signal == 0 ? 0 : 128 + signal;
}

std::string name_of_interruption()
{
    for (const auto& [signal, name] : kSignals)
        if (signal == first_signal) return name;
    return {};
}

}  // namespace plab::program
