// plab-log: writes what happens in a server, line by line.
#include <signal.h>

#include <iostream>

#include "logger/follow.h"
#include "logger/options.h"

namespace
{

using namespace plab;

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

}  // namespace

int main(int argc, char** argv)
{
    logger::Options options;
    if (const auto parsed = logger::parse_options(argc, argv, options))
    {
        (parsed->exit_code == 0 ? std::cout : std::cerr) << parsed->text;
        return parsed->exit_code;
    }
    EndSignals signals;  // before the bus starts threads, which inherit the mask
    const logger::End end = logger::follow(options, [&] { return signals.came(); });
    for (const Error& error : end.errors) std::cerr << "plab-log: " << error.text() << "\n";
    return end.code;
}
