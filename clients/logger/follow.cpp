#include "logger/follow.h"

#include <chrono>

#include "logger/logger.h"

namespace plab::logger
{

End follow(const LoggerOptions& options, const link::Stop& interrupted)
{
    using Clock = std::chrono::steady_clock;
    constexpr link::Seconds kCheckInterval(0.1);  // how late an interruption may be seen
    const auto begin = Clock::now();
    const auto is_over = [&] { return options.duration && link::Seconds(Clock::now() - begin).count() >= *options.duration; };
    const auto stop = [&] { return interrupted() || is_over(); };

    auto output = Output::open(options.out);
    if (!output) return {1, output.errors()};
    auto session = link::Session::join(options.link);
    if (!session) return {1, session.errors()};
    const link::Seconds patience = options.timeout > 0 ? link::Seconds(options.timeout) : link::kLongestWait;
    if (auto found = session->find_server(options.link, patience, stop); !found) return interrupted() ? End{} : End{3, found.errors()};
    auto logger = Logger::make(*session, options, output.take());
    if (!logger) return {1, logger.errors()};
    while (!stop() && !logger->is_full())
    {
        const auto state = logger->step(kCheckInterval);
        if (state == Output::State::Closed) return {};
        if (state == Output::State::Broken) return {1, {reason(logger->output().why())}};
    }
    if (!logger->is_full() && logger->finish() == Output::State::Broken) return {1, {reason(logger->output().why())}};
    return {};
}

}  // namespace plab::logger
