// plab-log: writes what happens in a server, line by line.
#include <signal.h>

#include <chrono>
#include <iostream>

#include "logger/logger.h"

namespace
{

using namespace plab;
using Clock = std::chrono::steady_clock;

/// SIGINT and SIGTERM, held back from all threads and asked for instead: no handler, no global.
class EndSignals
{
public:
    EndSignals()
    {
        (void)sigemptyset(&set_);
        (void)sigaddset(&set_, SIGINT);
        (void)sigaddset(&set_, SIGTERM);
        (void)pthread_sigmask(SIG_BLOCK, &set_, nullptr);
        (void)signal(SIGPIPE, SIG_IGN);  // a closed pipe is seen when writing
    }
    bool came()
    {
        const timespec none{};
        came_ = came_ || sigtimedwait(&set_, nullptr, &none) > 0;
        return came_;
    }

private:
    sigset_t set_{};
    bool came_ = false;
};

int fail(int code, const Errors& errors)
{
    for (const Error& error : errors) std::cerr << "plab-log: " << error.text() << "\n";
    return code;
}

int run(const logger::Options& options, EndSignals& signals)
{
    constexpr link::Seconds kLook(0.1);  // how late a signal may be seen
    const auto begin = Clock::now();
    const auto is_over = [&] { return options.duration && link::Seconds(Clock::now() - begin).count() >= *options.duration; };
    const auto stop = [&] { return signals.came() || is_over(); };

    auto output = logger::Output::open(options.out);
    if (!output) return fail(1, output.errors());
    auto session = link::Session::join(options.link);
    if (!session) return fail(1, session.errors());
    const link::Seconds patience = options.timeout > 0 ? link::Seconds(options.timeout) : link::kLongestWait;
    if (auto found = session->find_server(options.link, patience, stop); !found) return signals.came() ? 0 : fail(3, found.errors());
    auto logger = logger::Logger::make(*session, options, output.take());
    if (!logger) return fail(1, logger.errors());
    while (!stop() && !logger->is_full())
    {
        const auto state = logger->step(kLook);
        if (state == logger::Output::State::Closed) return 0;
        if (state == logger::Output::State::Broken) return fail(1, Errors{reason(logger->output().why())});
    }
    if (!logger->is_full() && logger->finish() == logger::Output::State::Broken) return fail(1, Errors{reason(logger->output().why())});
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    logger::Options options;
    if (const auto end = logger::parse_options(argc, argv, options))
    {
        (end->exit_code == 0 ? std::cout : std::cerr) << end->text;
        return end->exit_code;
    }
    EndSignals signals;  // before the bus starts threads, which inherit the mask
    return run(options, signals);
}
